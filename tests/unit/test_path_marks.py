"""What a path reads off its rows: marks of curves that are given, each part of a claim by itself, and its schedule."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import largest_tension
from contact1d.analysis.loop import loop_of
from contact1d.workflow.deck.steps import DisplaceInTime, Phase
from contact1d.workflow.experiments.path.between_rows import missed_between_rows
from contact1d.workflow.experiments.path.path import (
    _adhesion,
    _critical_radius,
    _cut_short,
    _dissipated,
    _drawn_off,
    _fixed_grips,
    _largest,
    _zero_load,
    path,
)
from contact1d.workflow.experiments.path.schedule import places, schedule
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.units import LENGTH, Quantity
from tests.given import Estimate, GivenContact, at, given_context, given_scene


def scene_of(*displacements: float, **tables: Any) -> Any:
    return given_scene(experiment={"kind": "path", "displacements": list(displacements)}, **tables)


SCENE = scene_of(0.0, 0.2, -0.2)


def contact(force: Any = lambda d: d, scene: Any = SCENE, **more: Any) -> Any:
    return GivenContact(force, scene=scene, **more)


def context(**more: Any) -> Any:
    return given_context(contact(**more))


def read(tension: list[float], **more: Any) -> Any:
    """What a branch with these tensions, a tenth of a LU apart, gives."""
    rows = [at(0.3 - 0.1 * i, -t, 5.0 - 0.4 * i, 0.05, **more) for i, t in enumerate(tension)]
    return rows, *_adhesion(context(), rows)


@pytest.mark.parametrize(
    ("tension", "there"),
    [
        ([-1.0, 0.5, 0.3], True), ([0.4, 0.5, 0.3], True), ([-1.0, 0.0, 0.5], False), ([0.5, 0.3, 0.1], False),
        ([-1.0, -0.5, -0.8], False), ([-1.0, 0.0, -0.8], False), ([-1.0, 0.2, 0.5, 0.45, 0.1], True),
    ],
)  # fmt: skip
def test_a_largest_tension_lies_between_rows_and_is_one(tension: list[float], there: bool) -> None:
    rows, quantities, warnings = read(tension, residual=1e-5)
    assert ("adhesion_force" in quantities) == ("critical_radius" in quantities) == there
    assert ("no_peak" in warnings) != there
    crosses = min(tension) * max(tension) <= 0.0
    assert ("zero_load_radius" in quantities) == crosses
    assert ("no_zero_load" in warnings) != crosses
    if not there:
        return
    own = context().deck
    force = [s.force for s in rows]
    peak = largest_tension([s.displacement for s in rows], force)
    found = quantities["adhesion_force"]
    assert found.value == peak.smooth
    missed = missed_between_rows(own.scene, own.settings, [s.displacement for s in rows]) * peak.smooth
    i = peak.index
    late = max(0.0, (force[i - 1] - force[i]) / 0.1) * 0.25 * 0.1
    left = 40 * 1e-5 + law_error(own.scene, own.settings, rows[i])
    assert found.uncertainty == pytest.approx(max(peak.uncertainty, missed) + late + left)


def test_the_larger_of_what_rows_and_estimate_miss_counts() -> None:
    """An estimate with a maximum as sharp as its table has more to miss than a smooth curve says; none has nothing."""
    tension = [0.1, 0.4, 0.5, 0.45, 0.2]
    rows = [at(0.3 - 0.1 * i, -t, 5.0 - 0.4 * i) for i, t in enumerate(tension)]
    peak = largest_tension([s.displacement for s in rows], [s.force for s in rows])
    found = []
    for force in ([0.0, -0.2, 0.0], [1.0, 0.5, 0.1]):
        estimate = Estimate(gap=np.asarray([0.0, 0.05, 0.1]), force=np.asarray(force))
        own = given_context(contact(estimate=estimate))
        quantities, _ = _adhesion(own, rows)
        share = missed_between_rows(own.deck.scene, own.deck.settings, [s.displacement for s in rows])
        error = quantities["adhesion_force"].uncertainty - law_error(own.deck.scene, own.deck.settings, rows[2])
        found.append((share * peak.smooth > peak.uncertainty, error - _cut_short(own.deck.settings, rows, 2)))
        assert found[-1][1] == pytest.approx(max(peak.uncertainty, share * peak.smooth))
    assert [larger for larger, _ in found] == [True, False]


def test_a_path_that_never_draws_the_bodies_apart_says_what_it_lacks() -> None:
    quantities, warnings = _adhesion(context(), [])
    assert quantities == {}
    assert set(warnings) == {"no_peak", "no_zero_load"}


def test_tension_that_is_cut_short_would_have_gone_on_to_rise_as_it_did() -> None:
    settings = context().deck.settings
    rows = [at(0.5, -9.0), at(0.4, -0.1), at(0.2, -0.5), at(-0.1, -0.2)]
    assert _cut_short(settings, rows, 2) == pytest.approx(0.4 / 0.2 * 0.25 * 0.3)
    assert _cut_short(settings, [rows[0], *rows[2:]], 1) == 0.0


def test_fixed_grips_let_go_between_the_last_row_that_is_held_and_the_next() -> None:
    rows = [at(0.3, -1.0), at(0.1, -1.2), at(-0.3, 0.0, None), at(-0.5, 0.0, None)]
    found = _fixed_grips(rows)["fixed_grips_displacement"]
    assert (found.value, found.uncertainty) == pytest.approx((-0.1, 0.2))
    assert _fixed_grips(rows[:2]) == _fixed_grips(rows[2:]) == {}


def test_the_radius_at_a_maximum_is_read_between_its_rows() -> None:
    """Each row has an uncertainty of its own; that of the middle one counts."""
    rows = [at(d, -1.0, a, u) for d, a, u in ((1.0, 7.0, 0.1), (0.0, 6.0, 0.2), (-2.0, 3.0, 0.4))]
    peak = largest_tension([1.0, 0.0, -2.0], [-0.5, -1.0, -0.2])
    on_row = _critical_radius(rows, replace(peak, position=0.0), has_edge=False)
    assert on_row is not None
    assert (on_row.value, on_row.uncertainty) == pytest.approx((6.0, 0.2 + 1.0))
    for position, value in ((0.5, 6.5), (-1.0, 4.5)):
        found = _critical_radius(rows, replace(peak, position=position), has_edge=False)
        assert found is not None
        assert (found.value, found.uncertainty) == pytest.approx((value, 0.2 + 1.0 + 0.1 * 4.0))
    for i in (0, 2):
        torn = [replace(row, rule=at(0.0, 0.0, None).rule) if n == i else row for n, row in enumerate(rows)]
        assert _critical_radius(torn, peak, has_edge=False) == Quantity(6.0, 6.0, LENGTH)
        assert _critical_radius(torn, peak, has_edge=True) == Quantity(6.0, 0.0, LENGTH)
    nowhere = [rows[0], at(0.0, -1.0, None), rows[2]]
    assert _critical_radius(nowhere, peak, has_edge=False) is None


def test_the_radius_at_no_load_is_known_to_an_eighth_of_what_it_changes_between_two_rows() -> None:
    rows = [at(1.0, 1.0, 8.0, 0.3), at(0.6, 0.5, 7.0, 0.1), at(0.2, -1.5, 3.0, 0.2), at(0.0, -2.0, 2.0, 0.9)]
    found = _zero_load(rows, [s.displacement for s in rows], [s.force for s in rows])
    assert found is not None
    assert (found.value, found.uncertainty) == pytest.approx((6.0, 0.2 + 0.5))
    jump = [at(1.0, 1.0, 8.0, 0.3), at(1.0, -1.0, 4.0, 0.1)]
    there = _zero_load(jump, [1.0, 1.0], [1.0, -1.0])
    assert there is not None
    assert (there.value, there.uncertainty) == pytest.approx((8.0, 0.3 + 0.5))
    ends = [at(1.0, 1.0, 8.0), at(0.0, -1.0, None)], [at(1.0, 1.0, None), at(0.0, -1.0, 4.0)]
    assert [_zero_load(pair, [1.0, 0.0], [1.0, -1.0]) for pair in ends] == [None, None]


def test_without_adhesion_the_deepest_row_counts() -> None:
    rows = [at(0.1, 0.5, 2.0, 0.1), at(0.3, 1.5, 3.0, 0.2, residual=1e-4), at(0.2, 1.0, 2.5, 0.3)]
    own = context()
    found = _largest(own, rows)
    left = 40 * 1e-4 + law_error(own.deck.scene, own.deck.settings, rows[1])
    assert (found["largest_force"].value, found["largest_force"].uncertainty) == pytest.approx((1.5, left))
    assert (found["largest_radius"].value, found["largest_radius"].uncertainty) == (3.0, 0.2)
    assert set(_largest(own, [at(0.3, 0.0, None)])) == {"largest_force"}


def test_the_branch_that_counts_is_the_last_one_apart() -> None:
    """A smooth curve says the same on the way down; where pairs snap, or an edge has no range, it does not."""
    smooth, snaps = (context(estimate=Estimate(snaps=snaps)).deck.settings for snaps in (False, True))
    names = [Phase(name, ()) for name in ("loading", "unloading", "loading_2", "unloading_2", "loading_3")]
    assert _drawn_off(SCENE, smooth, names) == "unloading_2"
    assert _drawn_off(SCENE, snaps, names[:3]) == "unloading"
    assert _drawn_off(SCENE, smooth, names[:1]) == "loading"
    assert _drawn_off(SCENE, snaps, names[:1]) == ""
    edge: Any = SimpleNamespace(adhesion=object())
    assert _drawn_off(edge, smooth, names[:1]) == ""
    assert _drawn_off(edge, smooth, names[:2]) == "unloading"


@pytest.mark.parametrize("heat", [False, True])
def test_an_area_is_claimed_to_its_rows_what_is_left_of_forces_and_the_laws_share(heat: bool) -> None:
    """Residuals of either sign add up as √N; what heat leaves of a mean adds up with N."""
    rows = [at(0.2, 1.0, residual=1e-5), at(0.1, -2.5, residual=3e-5), at(0.2, 0.5, residual=2e-5)]
    own = context()
    if heat:
        own.deck = SimpleNamespace(scene=SCENE.model_copy(update={"noise": object()}), settings=own.deck.settings)
    loop: Any = SimpleNamespace(area=-0.7, uncertainty=0.01, length=0.4)
    found = _dissipated(own, rows, loop)
    share = law_error(SCENE, own.deck.settings, rows[1]) / 2.5
    several = 40.0 if heat else math.sqrt(40.0)
    assert found.value == -0.7
    assert found.uncertainty == pytest.approx(0.01 + 0.4 * several * 2e-5 + share * 0.7, rel=1e-9)


def test_a_path_hands_over_what_was_asked_for() -> None:
    """Over snaps all rows tell the loop, the first one that was asked for on; else those that were asked for."""
    for snaps in (False, True):
        scene = scene_of(0.1, 0.3, -0.3, 0.1)
        one = contact(
            lambda d: d + 0.1 * math.sin(20.0 * d), scene, estimate=Estimate(snaps=snaps), longest_move=0.11,
            radius=lambda d: 4.0 + d, tolerance=1e-2,
        )  # fmt: skip
        found = path(given_context(one))
        way = [d for d, _ in places(scene, one.settings)]
        assert one.places == way
        assert one.waits is None
        assert [s.displacement for s in found.states] == [0.1, 0.3, -0.3, 0.1]
        assert found.radii == pytest.approx({"deepest": 4.3, "final": 4.1})
        assert found.profiles["final"] is found.states[-1].profile
        rows = one.states[way.index(0.1) :] if snaps else list(found.states)
        loop = loop_of([s.displacement for s in rows], [s.force for s in rows])
        assert loop is not None
        assert found.quantities["dissipated_energy"].value == loop.area
        assert found.compared_with == {"dissipated_energy": loop.whole}
        assert [p.name for p in found.phases] == ["loading", "unloading", "loading_2"]
        assert found.tables == {}


def test_a_path_in_time_waits_until_particles_are_at_rest_and_heat_has_no_rest() -> None:
    timed = {"damping": {"coefficient": "auto"}}
    way = {"kind": "path", "displacements": [0.0, 0.1], "method": "dynamic"}
    one = contact(scene=given_scene(**timed, experiment=way))
    path(given_context(one))
    limit = 0.1 * one.settings.tolerance * one.settings.force_scale
    assert [one.waits(at(0.0, 0.0, residual=share * limit)) for share in (0.99, 1.01)] == [True, False]
    hot = contact(scene=given_scene(**timed, noise={"temperature": 1e-6, "seed": 1}, experiment=way))
    found = path(given_context(hot))
    assert hot.waits is None
    assert len(found.states) == 2
    assert found.tables["means"]["displacement"] == (0.0, 0.1)
    through = contact(scene=SCENE, profile=lambda d: replace(at(0.0, 0.0).profile))
    through.row = lambda row: at(row.displacement, 0.0, depth=1e-6 if row.displacement < -0.1 else 0.0)
    with pytest.raises(UntrustedError):
        path(given_context(through))


def test_stretches_are_numbered_and_the_first_row_stands_in_the_first_that_has_any() -> None:
    def names(*displacements: float, **more: Any) -> list[tuple[str, int]]:
        scene = scene_of(*displacements)
        settings = contact(scene=scene, longest_move=10.0).settings
        phases = schedule(scene, settings)
        assert all(phase.state for phase in phases)
        return [(phase.name, len(phase.rows)) for phase in phases]

    assert names(0.0, 0.2, 0.1, 0.1, 0.3, 0.2, 0.4) == [
        ("loading", 2), ("unloading", 2), ("loading_2", 1), ("unloading_2", 1), ("loading_3", 1),
    ]  # fmt: skip
    assert names(-0.3, -0.4) == [("loading", 1), ("unloading", 1)]


@pytest.mark.parametrize("snaps", [False, True])
def test_a_way_is_walked_in_moves_that_are_no_longer_than_allowed(snaps: bool) -> None:
    """Coming apart over snaps √(8 tolerance) of the law's range; a move as long as allowed is one."""
    scene = scene_of(0.5, 0.75, -1.0)
    settings = contact(scene=scene, estimate=Estimate(snaps=snaps), longest_move=0.25, tolerance=0.02).settings
    assert settings.law is not None
    drop = math.sqrt(8.0 * 0.02) * settings.law.longest_range
    moves = max(1, math.ceil(1.75 / drop)) if snaps else 1
    expected = [0.25, 0.5, 0.75, *np.linspace(0.75, -1.0, moves + 1)[1:]]
    found = places(scene, settings)
    assert [d for d, _ in found] == pytest.approx(expected)
    assert [d for d, wanted in found if wanted] == [0.5, 0.75, -1.0]
    far = replace(settings, longest_move=0.5 * drop)
    assert len(places(scene_of(0.0, -1.0), far)) == 1 + (math.ceil(2.0 / drop) if snaps else 1)
    assert places(scene_of(-1.0), settings) == [(-1.0, True)]


@pytest.mark.parametrize("drag", [0.05, 3.0])
def test_rows_in_time_are_as_long_as_fourteen_decays_and_no_timestep_longer(drag: float) -> None:
    """The slower of 2m/γ and γ/k."""
    way = {"kind": "path", "displacements": [0.0, 0.1], "method": "dynamic"}
    scene = given_scene(damping={"coefficient": drag}, experiment=way)
    settings = replace(contact(scene=scene).settings, time_step=0.037)
    decay = max(2.0 * scene.bodies.mass / drag, drag / scene.bulk_stiffness)
    (phase,) = schedule(scene, settings)
    for row in phase.rows:
        assert isinstance(row, DisplaceInTime)
        assert (row.steps - 1) * 0.037 < 14.0 * decay <= row.steps * 0.037
