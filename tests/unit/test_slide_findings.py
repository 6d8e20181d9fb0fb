"""What is read off a slide whose motion is given in arrays: means of the right leg, doubts, steadiness.

Means over blocks are those of `analysis.friction`, which has tests of its own; here it counts over what they are taken.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis import friction
from contact1d.workflow.experiments.slide.findings import (
    _doubts,
    _scales,
    energies,
    is_steady,
    means,
    slips_of,
    temperature,
)
from contact1d.workflow.experiments.slide.motion import Motion
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.drive import DriveLeg
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.units import ENERGY, FORCE, NUMBER, Quantity
from tests.given import at
from tests.unit.test_settings_similarity import SCENES

SPACING, SPEED, ROWS = 2.0, 0.5, 16
"""A period takes 4 TU, and has sixteen rows."""
SETTINGS: Any = SimpleNamespace(tolerance=1e-2, plate_mass=3.0, particles=3)


def scene(noise: Any = None, free: tuple[str, ...] = ("x", "z")) -> Any:
    return SimpleNamespace(
        bodies=SimpleNamespace(spacing=SPACING, mass=2.0), noise=noise, plate=SimpleNamespace(free=free),
        cantilever=SimpleNamespace(stiffness=0.5),
    )  # fmt: skip


def way(*legs: tuple[float, float], place: Any = None) -> Motion:
    """Legs of (velocity, periods of 4 TU); random forces, and a plate that follows the drive."""
    rng = np.random.default_rng(7)
    drives = tuple(DriveLeg(velocity, round(periods * ROWS), 10, 0.025) for velocity, periods in legs)
    numbers = [i for i, leg in enumerate(drives) for _ in range(leg.rows)]
    n = len(numbers) + 1
    time = 0.25 * np.arange(n)
    drive = np.concatenate([[0.0], np.cumsum([0.25 * drives[i].velocity for i in numbers])])
    integrals = {
        name: np.cumsum(1.0 + 0.3 * rng.standard_normal(n))
        for name in ("impulse", "pulled", "work", "dissipated", "stored", "squares")
    }
    return Motion(
        legs=drives, leg=np.asarray([-1, *numbers]), time=time, drive=drive,
        place=drive if place is None else np.asarray(place(time, drive)),
        friction=1.0 + 0.3 * rng.standard_normal(n), pull=1.0 + 0.3 * rng.standard_normal(n), **integrals,
    )  # fmt: skip


def expected(motion: Motion, rows: slice, sign: float, heat: bool) -> dict[str, tuple[float, float]]:
    """Mean friction and pull of these rows."""
    time, rates = motion.time[rows], (sign * motion.friction[rows], sign * motion.pull[rows])
    blocks = friction.block_means(time, sign * motion.impulse[rows], 4.0, None if heat else rates[0])
    mean = friction.mean_of(blocks)
    if heat:
        sampled = friction.sampled_mean(time, rates[0], 4.0)
        mean = mean if mean.error <= sampled.error else sampled
    pulled = friction.block_means(time, sign * motion.pulled[rows], 4.0, None if heat else rates[1])[mean.first :]
    pull = float(pulled.mean())
    return {
        "mean_friction": (mean.value, mean.error + 3e-3 * abs(mean.value)),
        "mean_cantilever_force": (pull, friction.interval(pulled) + 3e-3 * abs(pull)),
    }


@pytest.mark.parametrize("heat", [False, True])
@pytest.mark.parametrize(
    ("legs", "rows", "sign"),
    [
        ([(SPEED, 6)], slice(0, 97), 1.0),
        ([(SPEED, 3)], slice(0, 49), 1.0),
        ([(SPEED, 4), (-SPEED, 5)], slice(64, 145), -1.0),
        ([(SPEED, 5), (0.0, 2)], slice(0, 81), 1.0),
        ([(0.0, 1), (-SPEED, 5), (0.0, 2)], slice(16, 97), -1.0),
    ],
)  # fmt: skip
def test_means_are_those_of_the_last_leg_that_moves(
    legs: list[tuple[float, float]], rows: slice, sign: float, heat: bool
) -> None:
    motion = way(*legs)
    found = means(scene(object() if heat else None), SETTINGS, motion)
    for name, (value, error) in expected(motion, rows, sign, heat).items():
        assert (found[name].value, found[name].uncertainty) == pytest.approx((value, error), rel=1e-9)
    first = sum(velocity != 0.0 for velocity, _ in legs) == 1
    assert ("static_friction" in found) == first
    if first:
        top, missed = friction.largest_before(sign * motion.friction[rows], sign * motion.place[rows], SPACING)
        static = found["static_friction"]
        assert (static.value, static.uncertainty) == pytest.approx((top, missed + 3e-3 * abs(top)))


def test_what_a_leg_is_too_short_for_it_does_not_have() -> None:
    """Two periods make no mean; a plate that did not come a spacing far has no static friction."""
    assert means(scene(), SETTINGS, way((0.0, 3))) == {}
    assert set(means(scene(), SETTINGS, way((SPEED, 2)))) == {"static_friction"}
    assert set(means(scene(), SETTINGS, way((SPEED, 1)))) == {"static_friction"}  # a spacing, and no less
    assert means(scene(), SETTINGS, way((SPEED, 1), place=lambda t, d: 0.99 * d)) == {}
    early = way((SPEED, 2), (SPEED, 3))
    cut = {name: getattr(early, name)[:33] for name in vars(early) if name != "legs"}
    assert set(means(scene(), SETTINGS, replace(early, **cut))) == {"static_friction"}


@pytest.mark.parametrize("free", [("x", "z"), ("z",)])
def test_the_temperature_is_that_of_the_last_leg(free: tuple[str, ...]) -> None:
    motion = way((SPEED, 5), (-SPEED, 3))
    found = temperature(scene(object(), free), SETTINGS, motion)["plate_temperature"]
    time = motion.time[80:]
    squares, speeds = (friction.block_means(time, v[80:], 12.0 / 20.0) for v in (motion.squares, motion.place))
    assert squares.size == 20
    blocks = 3.0 * (squares - speeds.mean() ** 2) / len(free)
    assert (found.value, found.uncertainty) == pytest.approx((blocks.mean(), friction.interval(blocks)))
    still: Any = SimpleNamespace(noise=object(), plate=None)
    assert temperature(still, SETTINGS, motion) == {}


def test_energies_are_those_of_the_end_and_claim_what_is_missing() -> None:
    motion = way((SPEED, 2))
    found = energies(motion)
    work, dissipated, stored = (float(values[-1]) for values in (motion.work, motion.dissipated, motion.stored))
    assert [q.value for q in found.values()] == [work, dissipated, stored]
    assert {q.uncertainty for q in found.values()} == {abs(work - dissipated - stored)}


def jumping(time: Any, drive: Any, size: float = SPACING) -> Any:
    """A plate that sticks, and jumps by `size` each time the drive has gone as far: late by half of it on the mean."""
    return size * np.floor(np.abs(drive) / size + 1e-9) * np.where(drive < 0.0, -1.0, 1.0)


def test_slips_are_those_of_all_legs_that_move() -> None:
    motion = way((SPEED, 3), (0.0, 1), (-SPEED, 2), place=jumping)
    found = slips_of(scene(), motion)
    expected = friction.slips(motion.time[:49], motion.place[:49], SPACING, SPEED)
    expected += friction.slips(motion.time[64:], motion.place[64:], SPACING, SPEED)
    assert [s.time for s in found] == [s.time for s in expected]
    assert len(found) >= 4
    cut = {name: getattr(motion, name)[:40] for name in vars(motion) if name != "legs"}
    assert len(slips_of(scene(), replace(motion, **cut))) == 2


def test_a_slide_is_steady_where_plate_and_drive_go_as_far_but_for_a_tenth_or_a_slip() -> None:
    for share, steady in ((1.0, True), (0.91, True), (0.89, False), (1.09, True), (1.11, False)):
        told = is_steady(scene(), SETTINGS, way((SPEED, 6), place=lambda t, d, share=share: share * d))
        assert (told == "") == steady
        assert steady or f"plate moves at {share * SPEED:.3g} LU/TU and the drive at 0.5" in told


def test_the_run_in_is_left_out_of_what_is_compared() -> None:
    """A plate that stood still for the first two of ten periods, and then went with the drive."""
    motion = way((SPEED, 10), place=lambda t, d: np.maximum(0.0, d - 4.0))
    blocks = np.asarray([5.0, 5.0, *np.full(8, 1.0)])
    motion = replace(motion, impulse=np.concatenate([[0.0], np.cumsum(np.repeat(blocks, ROWS) * 0.25)]))
    assert is_steady(scene(), SETTINGS, motion) == ""
    later = replace(motion, impulse=1.0 * motion.time)
    assert "the last 36 TU" in is_steady(scene(), SETTINGS, later)


@pytest.mark.parametrize(("slips", "steady"), [(2, True), (1, False)])
def test_a_plate_may_be_behind_by_its_largest_slip_of_several(slips: int, steady: bool) -> None:
    """Over the last three of four periods it goes 1.2 spacings less than the drive, in jumps of 1.3 or of one alone."""
    jumps = [1.3, 0.5] if slips == 2 else [1.8]
    moments = np.linspace(6.0, 15.0, slips)

    def place(time: Any, drive: Any) -> Any:
        return SPACING * sum(jump * (time > moment) for jump, moment in zip(jumps, moments, strict=True))

    told = is_steady(scene(), SETTINGS, way((SPEED, 4), place=place))
    assert (told == "") == steady


@pytest.mark.parametrize(("periods", "words"), [(1, "1 whole period of"), (2, "2 whole periods of"), (0.5, "0 whole")])
def test_too_few_periods_are_counted(periods: float, words: str) -> None:
    told = is_steady(scene(), SETTINGS, way((SPEED, periods)))
    assert f"the drive's way of {2.0 * periods:.3g} LU has {words}" in told
    assert "a mean needs 3" in told
    assert is_steady(scene(), SETTINGS, way((SPEED, 3))) == ""


def test_a_plate_that_moved_by_less_than_a_spacing_does_not_slide() -> None:
    for share, told in ((0.99, True), (1.0, False), (1.01, False)):
        motion = way((SPEED, 4), place=lambda t, d, share=share: SPACING * share * d / d[-1])
        assert ("which is no sliding yet" in is_steady(scene(), SETTINGS, motion)) == told


REAL = scene_from_dict(SCENES["slide of few particles over another spacing"])


def doubted(motion: Motion, quantities: dict[str, Quantity], missing: float = 0.0) -> set[str]:
    """Names of what is doubted, beyond what is of any scene."""
    settings = settings_for(REAL)
    known = {"cantilever_work": Quantity(1.0, missing, ENERGY)} | quantities
    states = (at(0.0, 1.0), at(0.0, 1.0))
    return set(_doubts(REAL, settings, motion, known, states)) & {"unsteady", "drag", "energy"}


FOUND = {"mean_friction": Quantity(1.0, 0.1, FORCE)}


def test_drag_that_is_more_than_the_friction_is_told() -> None:
    settings = settings_for(REAL)
    drag = settings.particles * settings.damping + settings.plate_damping
    for share, told in ((0.99, True), (1.01, False)):
        motion = way((0.1, 2), (-SPEED, 4))
        motion = replace(motion, friction=motion.friction * -share * drag * SPEED / np.abs(motion.friction).max())
        assert ("drag" in doubted(motion, FOUND)) == told


def test_a_leg_that_moves_without_a_mean_is_told() -> None:
    loud = {"friction": np.full(33, 1e3)}
    moving, resting = replace(way((SPEED, 2)), **loud), replace(way((0.0, 2)), **loud)
    assert doubted(moving, {}) == {"unsteady"}
    assert doubted(moving, FOUND) == doubted(resting, {}) == doubted(resting, FOUND) == set()


def test_what_an_error_is_compared_with_is_the_largest_of_its_kind_on_the_way() -> None:
    motion = replace(way((SPEED, 2)), friction=np.asarray([0.5, -3.0, 1.0]), work=np.asarray([0.0, 2.0]),
                     dissipated=np.asarray([0.0, -7.0, 1.0]), stored=np.asarray([4.0]))  # fmt: skip
    known = {"mean_friction": Quantity(1.0, 0.1, FORCE), "slips": Quantity(1.0, 0.0, NUMBER),
             "stored_energy": Quantity(1.0, 0.1, ENERGY)}  # fmt: skip
    assert _scales(known, motion) == {"mean_friction": 3.0, "stored_energy": 7.0}
    for missing, told in ((5e-3 * 7.0 * 0.99, False), (5e-3 * 7.0 * 1.01, True)):
        assert ("energy" in doubted(motion, FOUND, missing)) == told
