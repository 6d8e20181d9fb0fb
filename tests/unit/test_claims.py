"""What a run says of how well it knows its numbers, and what it does before it gives up."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments.load.quasistatic import beside, moved_by
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome, in_words, unmet
from contact1d.workflow.experiments.running.prescribing import RETRY_SHARES, in_smaller_steps
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.slowness import slowness
from contact1d.workflow.experiments.running.trust import ThroughError
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.units import Quantity

MakeScene = Callable[..., Scene]
ROUND_OFF = 1e-6  # relative: at the vertex itself a square root is left with half of the digits
NOTHING = np.zeros(3)
PROFILE = Profile(NOTHING, NOTHING, NOTHING, NOTHING, NOTHING)
RULE: Any = None  # no radius is asked for here
LOAD = {"kind": "load", "force": 0.1}


def states(force: Callable[[float], float], *places: float) -> list[State]:
    return [State("pulling", d, force(d), PROFILE, 1.0, 0.0, 0.0, RULE) for d in places]


def bench_of(scene: Scene, folder: Path) -> RunContext:
    return RunContext(Deck(scene, settings_for(scene)), folder, Silent(), 1.0)


@pytest.mark.parametrize("short", [0.3, 0.03, 0.01])
@pytest.mark.parametrize("error", [1e-5, 1e-4, 5e-4])
def test_a_force_that_is_off_moves_a_place_as_on_a_parabola(short: float, error: float) -> None:
    """F = d² - 1 with its largest tension at d = 0; the place beyond which the load would not be held at all."""
    rows = states(lambda d: d**2 - 1.0, 0.9, 0.5, 0.2, short)
    moved = moved_by(rows, error, expected=10.0)
    exact = short - max(0.0, short**2 - error) ** 0.5
    assert moved == pytest.approx(exact, rel=ROUND_OFF) or moved >= exact
    assert moved <= error**0.5 * (1.0 + ROUND_OFF)


def test_where_few_states_tell_the_expected_stiffness_counts() -> None:
    assert moved_by(states(lambda d: d, 0.5), 1e-3, expected=2.0) == pytest.approx(5e-4)
    assert moved_by(states(lambda d: d, 0.0, 0.5), 1e-3, expected=2.0) == pytest.approx(1e-3)
    assert moved_by(states(lambda d: -(d**2), 2.0, 1.0, 0.5), 1e-3, expected=2.0) == pytest.approx(5e-4)


def test_states_that_all_but_coincide_are_not_beside_each_other() -> None:
    rows = states(lambda d: d, 0.0, 0.5, 0.9, 1.0 - 1e-9, 1.0)
    assert [state.displacement for state in beside(rows)] == [0.9, 0.5]
    assert beside(rows[:1]) == []


def test_a_radius_of_nothing_is_known_to_nothing(make_scene: MakeScene) -> None:
    scene = make_scene(experiment={"kind": "pull_off", "preload": 0.1})
    known = {"critical_radius": Quantity(0.0, 1.0, "LU"), "adhesion_force": Quantity(1.0, 1e-9, "FU")}
    assert (
        in_words(unmet(scene, Outcome(known, (), {}, {}, ())))
        == "critical_radius cannot be told from 0 and is known to 1 or worse"
    )


@pytest.mark.parametrize("carried", [*RETRY_SHARES, 0.0])
def test_a_search_takes_smaller_steps_before_it_gives_up(make_scene: MakeScene, tmp_path: Path, carried: float) -> None:
    tried = []

    def search(context: RunContext) -> Outcome:
        tried.append(context.deck.settings.increment())
        if tried[-1] > 1.001 * carried * tried[0]:
            raise ThroughError("the bodies went through each other")
        return Outcome({}, (), {}, {}, ())

    context = bench_of(make_scene(), tmp_path)
    deck = context.deck
    if carried:
        in_smaller_steps(search)(context)
        assert tried[-1] == pytest.approx(carried * tried[0])
        assert context.deck.settings.part == carried  # what in.lammps is written from
    else:
        with pytest.raises(ThroughError, match="16 times smaller did not help"):
            in_smaller_steps(search)(context)
        assert len(tried) == 1 + len(RETRY_SHARES)
        assert context.deck is deck


@pytest.mark.parametrize(
    ("tables", "told"),
    [
        ({"damping": {"coefficient": "auto"}, "plate": {}}, False),
        ({"damping": {"coefficient": 1e-4}, "plate": {"damping": 0.0}}, True),
        ({"damping": {"coefficient": 300.0}, "plate": {}}, True),
        ({"damping": {"coefficient": "auto"}, "plate": {"mass": 1e7}}, True),
        ({"damping": {"coefficient": 300.0}}, True),
        ({"damping": {"coefficient": 1.0}}, False),
    ],
)
def test_a_scene_that_will_take_long_says_so(make_scene: MakeScene, tables: dict[str, Any], told: bool) -> None:
    kind = LOAD if "plate" in tables else {"kind": "path", "displacements": [0.0, 0.05]}
    scene = make_scene(**tables, experiment=kind | {"method": "dynamic"})
    words = slowness(scene, settings_for(scene))
    assert bool(words) == told
    assert not told or ("times as long" in words and "[damping]" in words)
