"""A load that is held in time or under heat: which loads lead to it, what is doubted, how many samples are taken.

The way to a tension is counted out from the overshoot of a linear oscillator, exp(−πζ/√(1 − ζ²)), so that no swing goes
beyond the largest tension.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve import SAMPLE_TABLE
from contact1d.workflow.deck.steps import Row, UnderLoad
from contact1d.workflow.experiments.load.dynamic import _blocks, _joined, _settled, _thermal_outcome, load_dynamic
from contact1d.workflow.experiments.load.quasistatic import moved_by
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.sampling import chunk_steps, standard_error
from contact1d.workflow.experiments.running.trust import ThroughError, UntrustedError
from tests.given import PROFILE, Estimate, GivenContact, X, at, given_context, given_scene

TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
LARGEST = 2.0


def scene_of(force: float, **tables: Any) -> Any:
    return given_scene(**TIMED, **tables, experiment={"kind": "load", "force": force, "method": "dynamic"})


def ratio_of(past: float) -> float:
    """The damping ratio of an oscillator that shoots past its place by this share."""
    return -math.log(past) / math.hypot(math.pi, math.log(past)) if past else 1.5


def contact(force: float, past: float = 0.0, most: float = LARGEST, **more: Any) -> Any:
    """F = 2 (d² − 1) up to a tension of `most`; a drag that lets a plate shoot past by this share."""
    scene = more.pop("scene", None) or scene_of(force)
    plain = GivenContact(lambda d: 0.0, scene=scene)
    mass = plain.settings.plate_mass + plain.settings.particles * scene.bodies.mass
    known = {
        "estimate": Estimate(largest=LARGEST), "largest_displacement": 3.0, "tolerance": 1e-2, "damped_stiffness": 0.0,
        "damping": 0.0, "plate_damping": ratio_of(past) * 2.0 * math.sqrt(2.0 * mass),
    }  # fmt: skip
    return GivenContact(
        lambda d: LARGEST * (d**2 - 1.0), scene=scene, radius=lambda d: 4.0 + 2.0 * d,
        place=lambda load: None if -load > most else math.sqrt(max(0.0, 1.0 + load / LARGEST)), **known | more,
    )  # fmt: skip


def loads_of(one: Any, load: float) -> list[float]:
    found: Any = _settled(given_context(one), one, load)
    assert found[1].load == load
    assert [s.force for s in found[0]] == pytest.approx([row.load for row in one.holds])
    return [row.load for row in one.holds]


@pytest.mark.parametrize("past", [0.0, 0.2, 0.5, 0.9])
@pytest.mark.parametrize("load", [0.7, 0.0, -0.9, -1.9, -1.9995])
def test_a_tension_comes_on_so_gently_that_no_swing_goes_beyond_the_largest_one(load: float, past: float) -> None:
    expected = [max(load, 0.0)]
    while expected[-1] > load:
        gentle = (past * expected[-1] - LARGEST) / (1.0 + past)
        assert gentle + past * (gentle - expected[-1]) == pytest.approx(-LARGEST)
        expected.append(load if expected[-1] - gentle <= 1e-3 * LARGEST else max(load, gentle))
    one = contact(load, past)
    assert loads_of(one, load) == pytest.approx(expected)
    assert [phase.name for phase in one.phases] == ["loading", "unloading"][: 1 + (load < 0.0)]


def test_the_drag_of_a_swing_is_the_one_under_the_largest_tension() -> None:
    """Automatic drag follows the root of the stiffness under the load that comes; K = 2 at rest, less under tension."""
    one = contact(-1.5)
    mass = one.settings.plate_mass + one.settings.particles * one.scene.bodies.mass
    soft = Estimate(largest=LARGEST, stiffness=lambda load: 2.0 + 0.9 * load)
    drag = 0.8 * 2.0 * math.sqrt(2.0 * mass) / one.settings.particles
    one = contact(-1.5, estimate=soft, damped_stiffness=2.0, damping=drag, plate_damping=0.0)
    ratio = 0.8 * math.sqrt(0.2 / 2.0)
    past = math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))
    assert loads_of(one, -1.5)[:2] == pytest.approx([0.0, -LARGEST / (1.0 + past)])


def test_a_load_that_is_lost_on_the_way_is_named() -> None:
    one = contact(-1.9, 0.2, most=1.0)
    with pytest.raises(UntrustedError, match=r"cannot hold -1\.667 FU: the bodies part"):
        loads_of(one, -1.9)
    assert [phase.name for phase in one.phases] == ["loading", "unloading"]
    none = contact(-1.0, most=-0.1)
    with pytest.raises(UntrustedError, match="cannot hold 0 FU"):
        loads_of(none, -1.0)
    assert [phase.name for phase in none.phases] == ["loading"]


@pytest.mark.parametrize(("share", "most", "told"), [(0.89, 0.0, False), (0.91, 1.83, True), (0.91, 1.9, False)])
def test_a_tension_near_the_largest_is_doubted_where_no_more_is_held(share: float, most: float, told: bool) -> None:
    """Twice the tolerance more is tried first, from nine tenths of the largest tension on."""
    load = -share * LARGEST
    first, second = contact(load, most=most), contact(load)
    context: Any = given_context(first, second) if most else given_context(second)
    found = load_dynamic(context)
    assert ("near_pull_off" in found.warnings) == told
    if most:
        assert first.holds[-1].load == pytest.approx(1.02 * load)
    assert second.holds[-1].load == load
    assert second.ended == [second.phases[-1].name]
    assert second.phases[-1].state
    last = found.states[-1]
    error = abs(last.force - load) + law_error(second.scene, second.settings, last)
    assert found.quantities["force"].uncertainty == pytest.approx(error)
    assert found.quantities["displacement"].uncertainty == pytest.approx(moved_by(found.states, error, 2.0))


def test_bodies_that_go_through_while_more_is_tried_are_told_so() -> None:
    first = contact(-1.9)
    first.row = lambda row: at(1.0, row.load, depth=1e-6)
    context: Any = given_context(first, contact(-1.9))
    with pytest.raises(ThroughError):
        load_dynamic(context)


class Swinging(GivenContact):
    """Samples of displacement and force that are given, again and again."""

    def row(self, row: Row) -> State:
        """The next."""
        assert isinstance(row, UnderLoad)
        n = len(self.states)
        swing = float(self.swings[n % len(self.swings)])
        rule: Any = RadiusRule(self.scene, self.settings.tolerance)
        found = at(0.1 + swing, row.load + self.missed + swing, rule=rule, step=float(n), number=n)
        self.states.append(found)
        return found

    swings: Any = np.zeros(1)
    missed = 0.0


def sampled(swing: float, missed: float = 0.0) -> tuple[Swinging, Any]:
    scene = scene_of(0.3, noise={"temperature": 1e-6, "seed": 1})
    one = Swinging(lambda d: 0.0, scene=scene, tolerance=1e-2, rest=0.4, largest_displacement=-0.5)
    swings = np.random.default_rng(5).standard_normal(200)
    one.swings = swing * (swings - swings.mean())
    one.missed = missed
    context: Any = given_context(one)
    return one, load_dynamic(context)


def test_samples_are_taken_until_the_mean_is_known_to_the_tolerance_of_the_way() -> None:
    """Of rest or displacement, whichever is longer: 0.005 LU; two hundred at a time, and two thousand at most."""
    one, found = sampled(0.01)
    error = standard_error([s.displacement for s in one.states[40:]])
    assert len(one.states) == 40 + 200
    assert error < 0.005
    assert "statistics" not in found.warnings
    assert [(p.name, p.state) for p in one.phases] == [("settling", False), ("sampling", True)]
    assert found.states == tuple(one.states)
    assert found.quantities["force"].uncertainty == pytest.approx(standard_error([s.force for s in one.states[40:]]))
    factor = 0.0045 / error
    assert len(sampled(0.01 * factor)[0].states) == 240
    again, _ = sampled(0.01 * factor * 1.2)
    assert len(again.states) == 440
    most, found = sampled(3.0)
    assert len(most.states) == 2040
    assert "statistics" in found.warnings
    assert found.tables[SAMPLE_TABLE]["load"] == (0.3,) * 2040
    assert most.expected == [count * chunk_steps(most.settings) for count in (40, 200)]


def test_a_mean_force_may_miss_its_load_by_five_standard_errors() -> None:
    one, _ = sampled(1e-3)
    forces = np.asarray([s.force for s in one.states[40:]])
    error, mean = standard_error(forces.tolist()), float(forces.mean()) - 0.3
    for side in (-1.0, 1.0):
        sampled(1e-3, side * 4.99 * error - mean)
        with pytest.raises(UntrustedError, match=r"misses the load 0\.3 FU by 5\.0 standard errors"):
            sampled(1e-3, side * 5.01 * error - mean)


def test_bodies_that_reach_each_other_no_more_have_parted() -> None:
    one: Any = contact(0.3)
    cutoff = one.settings.cutoff
    near = at(0.0, 0.0, smallest_distance=cutoff)
    assert _joined(one, near) is near
    with pytest.raises(UntrustedError, match="parted under the load and the noise"):
        _joined(one, at(0.0, 0.0, smallest_distance=1.001 * cutoff))
    one.settings = replace(one.settings, law=None)
    assert _joined(one, at(0.0, 0.0, smallest_distance=1.001 * cutoff)).force == 0.0


def test_blocks_are_twenty_of_one_size() -> None:
    samples: Any = list(range(215))
    blocks = _blocks(samples)
    assert [len(block) for block in blocks] == [10] * 20
    assert [one for block in blocks for one in block] == samples[:200]
    assert [len(block) for block in _blocks(samples[:20])] == [1] * 20


def held(edge: float) -> Any:
    """Pressed in the middle, largest tension at the edge; nothing at all without one."""
    pressure = np.where(np.abs(X) < edge - 1.0, 1.0, -0.6 * np.exp(-((np.abs(X) - edge) ** 2))) if edge else 0.0 * X
    return replace(PROFILE, pressure=pressure)


@pytest.mark.parametrize("edges", [[7.2] * 19 + [7.6], [0.0] * 19 + [7.2], [0.0] * 18 + [7.2, 7.5], [0.0] * 20])
def test_the_radius_of_a_mean_is_as_sure_as_its_blocks_agree(edges: list[float]) -> None:
    """s/√n of those that have one; a single one says nothing of how they scatter."""
    scene = scene_of(2.0, noise={"temperature": 1e-6, "seed": 1})
    one: Any = GivenContact(lambda d: 0.0, scene=scene)
    rule = RadiusRule(scene, one.settings.tolerance)
    states = [at(0.1, 2.0, profile=held(edge)) for edge in edges]
    context: Any = given_context(one)
    found = _thermal_outcome(context, one, tuple(states), states, (2.0, 0.1), standard_error([0.1] * 20))
    assert "statistics" not in found.warnings  # as well as it was to be
    mean = rule.of(replace(PROFILE, pressure=np.mean([s.profile.pressure for s in states], axis=0)))
    if mean is None:
        assert math.isnan(found.radii["final"])
        assert "no_radius" in found.warnings
        assert "contact_radius" not in found.quantities
        return
    values = [float(known.value) for s in states if (known := rule.of(s.profile)) is not None]
    spread = float(np.std(values, ddof=1)) / math.sqrt(len(values)) if len(values) > 1 else mean.value
    assert "no_radius" not in found.warnings
    assert found.radii["final"] == mean.value
    radius, pressure = (found.quantities[name] for name in ("contact_radius", "mean_pressure"))
    assert (radius.value, radius.uncertainty) == pytest.approx((mean.value, mean.uncertainty + spread))
    share = 2.0 * radius.uncertainty / radius.value + 0.1 / 2.0
    assert pressure.uncertainty == pytest.approx(abs(pressure.value) * share)
