"""Claim: a ratio of two times is the slower over the quicker in the order that its name says.

No clock: the times are made up. What takes twice as long must come out as 2, never as 1/2.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from contact1d.workflow.cost import measure as per_step
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.progress import Lines
from contact1d.workflow.scene import Scene, read_scene

MakeScene = Callable[..., Scene]
ROUND_OFF = 1e-12
ALL, WITHOUT = 3.0, 2.0
"""Made-up processor time of a step with all effects and without one [µs]."""
STEPS, PART, SECONDS = 400, 100, 30.0
"""A phase, of which a quarter took half a minute."""


class Clockwork:
    """A session whose runs take the time that they are given."""

    def __init__(self, step: float) -> None:
        self.step, self.lammps_cpu_seconds = step, 0.0

    def execute(self, text: str) -> None:
        command, count = text.split()
        assert command == "run"
        self.lammps_cpu_seconds += 1e-6 * self.step * int(count)


def test_an_effect_costs_what_a_step_with_it_takes_over_one_without(
    make_scene: MakeScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = make_scene(neighbours={"stiffness": 0.1})

    @contextmanager
    def opened(deck: Deck, _: Path) -> Iterator[Clockwork]:
        yield Clockwork(ALL if deck.scene.effects == scene.effects else WITHOUT)

    monkeypatch.setattr(per_step, "opened", opened)
    costs = {cost.name: cost for cost in per_step.effect_costs(scene, tmp_path)}
    cost = costs["neighbours"]
    assert cost.ratio == pytest.approx(ALL / WITHOUT, rel=ROUND_OFF)
    assert (cost.with_us, cost.without_us) == pytest.approx((ALL, WITHOUT), rel=ROUND_OFF)


def test_the_table_of_a_slide_has_cantilever_plate_and_drag(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Which it could not run without: each is what it adds to a deck that stands."""
    slide = read_scene(Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "slide.toml")

    @contextmanager
    def opened(deck: Deck, _: Path) -> Iterator[Clockwork]:
        assert deck.head  # fits together
        yield Clockwork(float(len(deck.scene.effects)))

    monkeypatch.setattr(per_step, "opened", opened)
    costs = {cost.name: cost for cost in per_step.effect_costs(slide, tmp_path)}
    assert {name for name, cost in costs.items() if math.isfinite(cost.ratio)} == {"damping", "plate", "cantilever"}
    assert all(costs[name].with_us - costs[name].without_us == pytest.approx(1.0) for name in ("damping", "cantilever"))
    assert (costs["plate"].with_us, costs["plate"].without_us) == pytest.approx((4.0, 3.0))


def test_what_is_left_of_a_phase_takes_as_long_as_what_is_done(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quarter took half a minute, so that three of them are left: a minute and a half."""
    now = [0.0]
    monkeypatch.setattr("contact1d.workflow.engine.progress.time.monotonic", lambda: now[0])
    lines = Lines(sys.stdout, quiet=1.0)
    lines.phase("loading", STEPS)
    now[0] = SECONDS
    lines.advance(PART)
    assert "step 100 of 400, 3.33 a second, about 90 s left" in capsys.readouterr().out
