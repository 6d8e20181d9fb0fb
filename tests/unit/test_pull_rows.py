"""One pull under heat over places that are given: its rows, when it has ended, and what it says the bodies held."""

from __future__ import annotations

import math
import threading
from contextlib import contextmanager
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from contact1d.workflow.deck.steps import DrawnOff, UnderLoad
from contact1d.workflow.experiments.pull_off.pulls import _pull, ramp_of, rate_of, spring_of
from contact1d.workflow.experiments.pull_off.thermal import _load, planned_thermal
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.given import Estimate, at, given_scene

HEAT: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}, "noise": {"temperature": 2e-3, "seed": 7}}
ESTIMATE = Estimate(largest=1.5, place=lambda force: 0.2, apart=lambda share: -0.5 * (1.0 - share) - 0.1)
"""The largest tension at −0.105 (99 % of it) and none from −0.595 on."""
BARRIER, NONE = -0.105, -0.595
DRAWN = [{"loading_rate": 1e-3}, {"velocity": 2e-3, "stiffness": 0.4}, {"velocity": 2e-3}]


def scene_of(drawn: dict[str, float]) -> Scene:
    return given_scene(**HEAT, experiment={"kind": "pull_off", "method": "dynamic", "preload": 0.1} | drawn)


def settings_of(scene: Scene, **changed: Any) -> Settings:
    return replace(settings_for(scene), **{"estimate": ESTIMATE, "time_step": 0.05} | changed)


@pytest.mark.parametrize("drawn", DRAWN)
@pytest.mark.parametrize("time_step", [0.05, 2.0])
def test_a_staircase_has_four_hundred_steps_to_the_largest_tension_or_ten_timesteps_each(
    drawn: dict[str, float], time_step: float
) -> None:
    """It ends at ten times that, and what brings the plate off for good: a load at the barrier, or the spring's end."""
    scene = scene_of(drawn)
    settings = settings_of(scene, time_step=time_step)
    spring = 0.0 if "loading_rate" in drawn else drawn.get("stiffness", 2.0)
    rate = drawn.get("loading_rate", 2e-3 * spring)
    assert (spring_of(scene, settings), rate_of(scene, settings)) == pytest.approx((spring, rate))
    ramp = ramp_of(scene, settings)
    steps = max(10, round(max(1.5 / 400.0, 10.0 * rate * time_step) / rate / time_step))
    assert (ramp.steps, ramp.spring) == (steps, spring)
    assert ramp.slack == (0.2 if spring else 0.0)
    assert ramp.rise == pytest.approx(rate * steps * time_step)
    needed = 1.5 * (BARRIER - NONE) + 50.0 * 2e-3
    far = spring * (BARRIER - NONE) + math.sqrt(2.0 * spring * needed)
    before = -spring * (0.2 - BARRIER)
    assert ramp.most == math.ceil((10.0 * 1.5 + 2.0 * far - before) / ramp.rise)


class Pulled:
    """Answers each row with the place that is given for its number in the pull, and 0.2 before it."""

    def __init__(self, scene: Scene, settings: Settings, place: Any, settling: float = 0.2) -> None:
        """`place` of a row's number, from 1 on [LU]; `settling`: lowest place before [LU]."""
        self.scene, self.settings, self.place, self.settling = scene, settings, place, settling
        self.deck = SimpleNamespace(scene=scene, settings=settings)
        self.begun: list[tuple[str, int | None]] = []
        self.batches: list[int] = []
        self.pulling: list[Any] = []
        self.before: list[Any] = []
        self.ended: list[str] = []
        self.phases: tuple[Any, ...] = ("a schedule",)

    @contextmanager
    def contact(self) -> Any:
        """This."""
        yield self

    def begin(self, name: str, expected_steps: int | None = None) -> None:
        """Note it."""
        self.begun.append((name, expected_steps))

    def rows(self, rows: Any) -> Any:
        """One after the other."""
        if self.begun[-1][0] != "pulling":
            self.before += rows
            return [at(self.settling if i == 3 else 0.2, 0.0) for i in range(len(rows))]
        self.batches.append(len(rows))
        found = []
        for row in rows:
            self.pulling.append(row)
            found.append(at(self.place(len(self.pulling)), 0.0))
        return found

    def write_state(self) -> None:
        """Note it."""
        self.ended.append("state")

    def finish(self) -> None:
        """Note it."""
        self.ended.append("end")


def pulled(place: Any, drawn: dict[str, float] = DRAWN[0], stop: bool = False, **more: Any) -> tuple[Pulled, Any]:
    scene = scene_of(drawn)
    settling = more.pop("settling", 0.2)
    one: Any = Pulled(scene, settings_of(scene, **more), place, settling)
    event = threading.Event()
    if stop:
        event.set()
    return one, _pull(one, event)


@pytest.mark.parametrize("drawn", DRAWN[:2])
@pytest.mark.parametrize("held", [0, 5, 21])
def test_a_pull_ends_where_its_plate_left_the_barrier_last(held: int, drawn: dict[str, float]) -> None:
    """It had left it before, and come back; the tension is that between the last row held and the next.

    Rows go on until the mean tension on its way takes more to bring it back than heat and attraction have.
    """

    def place(number: int) -> float:
        if number == held + 1:
            return ESTIMATE.parted(0.99)  # the very barrier, which it does not hold at
        return -0.2 if number in (2, 4) else 0.1 if number <= held else -0.7

    one, found = pulled(place, drawn)
    ramp = ramp_of(one.scene, one.settings)
    assert found.seed == 7
    assert found.time == pytest.approx((held + 0.5) * ramp.steps * 0.05)
    assert found.force == pytest.approx(ramp.tension(held + 0.5, BARRIER))
    assert found.held == 2 * SETTLING_LOOKS + held - 1
    assert found.phases == ("a schedule",)
    assert len(found.states) == 2 * SETTLING_LOOKS + len(one.pulling)
    assert one.pulling == [ramp.row(n) for n in range(1, len(one.pulling) + 1)]
    needed, last, size = 1.5 * (BARRIER - NONE) + 50.0 * 2e-3, len(one.pulling), one.batches[0]
    mean = [0.5 * (ramp.tension(n, BARRIER) + ramp.tension(n, -0.7)) for n in (last - size, last)]
    assert mean[0] * (BARRIER + 0.7) <= needed < mean[1] * (BARRIER + 0.7)
    look = chunk_steps(one.settings)
    assert one.begun == [
        ("loading", SETTLING_LOOKS * look), ("settling", SETTLING_LOOKS * look), ("pulling", ramp.most * ramp.steps),
    ]  # fmt: skip
    assert one.before == [UnderLoad(0.1, look)] * SETTLING_LOOKS + [UnderLoad(0.0, look)] * SETTLING_LOOKS
    assert one.ended == ["state", "end"]


@pytest.mark.parametrize(("time_step", "rows"), [(0.05, 8), (0.03, 6), (0.004, 1)])
def test_rows_go_together_up_to_eight_hundred_timesteps_and_eight_of_them(time_step: float, rows: int) -> None:
    """75, 125 and 938 timesteps each."""
    one, _ = pulled(lambda n: 0.1 if n <= 10 else -1e3, time_step=time_step)
    steps = ramp_of(one.scene, one.settings).steps
    assert rows == min(8, max(1, 800 // steps))
    assert set(one.batches) == {rows}
    assert len(one.pulling) >= 11


def test_bodies_that_do_not_part_are_told_at_the_end_of_the_staircase() -> None:
    for drawn, key in zip(DRAWN[:2], ("loading_rate", "velocity"), strict=True):
        scene = scene_of(drawn)
        one: Any = Pulled(scene, settings_of(scene), lambda n: 0.1)
        ramp = ramp_of(scene, one.settings)
        tension = f"{ramp.tension(ramp.most, BARRIER):.4g}"
        with pytest.raises(UntrustedError, match=rf"did not part up to a tension of {tension} FU.*experiment\.{key}"):
            _pull(one, threading.Event())
        assert len(one.pulling) == ramp.most


def test_heat_that_parts_the_bodies_alone_and_a_pull_that_is_stopped_give_nothing() -> None:
    pulled(lambda n: -1e3, settling=NONE + 1e-6)
    with pytest.raises(UntrustedError, match="heat alone parts the bodies"):
        pulled(lambda n: -1e3, settling=NONE - 1e-6)
    with pytest.raises(UntrustedError, match="another pull failed"):
        pulled(lambda n: -1e3, stop=True)


def test_the_load_of_a_row_is_what_it_gives_or_its_springs_at_the_end() -> None:
    assert _load(UnderLoad(-0.3, 10), at(-5.0, 0.0)) == -0.3
    assert _load(DrawnOff(0.4, -2.0, 10), at(-0.5, 0.0)) == pytest.approx(-0.6)


def test_a_planned_pull_goes_a_tenth_beyond_the_largest_tension() -> None:
    for drawn in DRAWN:
        scene = scene_of(drawn)
        settings = settings_of(scene)
        loading, settling, pulling = planned_thermal(scene, settings)
        ramp, look = ramp_of(scene, settings), chunk_steps(settings)
        assert loading.rows == (UnderLoad(0.1, look),) * SETTLING_LOOKS
        assert settling.rows == (UnderLoad(0.0, look),) * SETTLING_LOOKS
        count = len(pulling.rows)
        assert pulling.rows == tuple(ramp.row(n) for n in range(1, count + 1))
        assert ramp.tension(count - 1, BARRIER) < 1.1 * 1.5 <= ramp.tension(count, BARRIER) * (1.0 + 1e-12)
        assert [phase.state for phase in (loading, settling, pulling)] == [False, False, True]
