"""Claims of lengths, forces and stiffnesses that settings go by: each against the law's own minimum, root or series.

The law of a pair is written out; its minimum and roots are scipy's.
"""

from __future__ import annotations

import math
import os
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar

from contact1d import Scene, read_scene
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.law import NotCarriedError
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.model.chain import require_apex, require_memory, require_travel
from contact1d.workflow.model.cutoff import innermost_distance, thermal_motion
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.settings import Settings, settings_for
from tests.scenes import LAW, chains

SPRING, SPACING = 0.7, 0.8
LOAD = {"kind": "load", "force": 0.4}
GRID = 2e-3
"""Relative: between 2000 distances, or 4000."""
EXACT = 1e-9


def scene(**tables: Any) -> Scene:
    bodies = {"spacing": SPACING} | tables.pop("bodies", {})
    return read_scene(chains(100.0, SPRING, **{"experiment": LOAD} | tables, bodies=bodies))


def pair(r: float) -> float:
    return LAW[0] / LAW[1] * math.exp(-r / LAW[1]) - LAW[2] / LAW[3] * math.exp(-r / LAW[3])


FREE = float(brentq(pair, 0.01, 1.0))
STRONGEST = minimize_scalar(pair, bounds=(FREE, 2.0), method="bounded")
REPULSION = {"repulsion": {"amplitude": LAW[0], "range": LAW[1]}}


def test_a_force_is_judged_by_the_largest_tension_of_a_pair_and_without_one_by_the_deepest_particle() -> None:
    assert settings_for(scene()).forces.scale == pytest.approx(-STRONGEST.fun, rel=GRID)
    alone = settings_for(scene(interaction=REPULSION))
    assert alone.forces.scale == pytest.approx(alone.largest_displacement * 0.5 * SPRING, rel=EXACT)
    apart = settings_for(scene(interaction=REPULSION, experiment={"kind": "path", "displacements": [-0.1]}))
    assert apart.forces.scale == pytest.approx(1e-3 * SPACING * 0.5 * SPRING, rel=EXACT)
    assert settings_for(scene()).forces.residual == pytest.approx(
        CALIBRATION.residual * 1e-3 * -STRONGEST.fun, rel=GRID
    )


def test_the_strongest_place_is_that_of_a_row() -> None:
    def row(r: float) -> float:
        distance = np.hypot(r, SPACING * np.arange(-20, 21))
        return float(sum(pair(d) * r / d for d in distance if d <= settings.forces.cutoff))

    settings = settings_for(scene())
    found = minimize_scalar(row, bounds=(FREE, 2.0), method="bounded")
    distance, tension = settings.strongest
    assert tension == pytest.approx(-found.fun, rel=GRID)
    assert distance == pytest.approx(found.x, abs=2.0 * settings.forces.cutoff / 4000.0)
    assert settings_for(scene(interaction=REPULSION)).strongest[1] == 0.0
    plane = scene(interaction=None, bodies={"lower": "rigid_plane"})
    assert settings_for(plane).strongest == (0.0, 0.0)


@pytest.mark.parametrize("tables", [{}, {"interaction": REPULSION}])
def test_bodies_are_never_moved_further_than_particles_stand_in_order(tables: dict[str, Any]) -> None:
    """`closest` is a fifth of the free distance, or of a repulsion's range; a move is a quarter of it at most."""
    settings = settings_for(scene(**tables))
    closest = 0.2 * (LAW[1] if tables else FREE)
    assert settings.forces.closest == pytest.approx(closest, rel=1e-6)
    assert settings.increments.longest_move == pytest.approx(0.25 * closest, rel=1e-6)
    assert settings.forces.rest == pytest.approx(settings.forces.cutoff if tables else FREE, rel=1e-6)
    for distance in (0.0, 0.5 * closest, closest, 10.0 * closest, math.inf):
        for part in (1.0, 0.25):
            step = settings.in_smaller_steps(part).increment(distance)
            assert 0.0 < step <= part * max(settings.increments.smooth_step, settings.increments.loading_step)
            assert step <= max(0.25 * distance, 0.2 * part * settings.increments.longest_move) * (1.0 + EXACT)
    assert settings.in_smaller_steps(0.5).gentle
    assert not settings.gentle


def test_steps_of_a_search_are_shares_of_the_way_and_of_the_longest_range() -> None:
    smooth = settings_for(scene())
    assert smooth.is_smooth
    steps = smooth.increments
    assert steps.smooth_step == pytest.approx(CALIBRATION.smooth_increment * LAW[3], rel=EXACT)
    way = CALIBRATION.loading_increment * smooth.largest_displacement
    assert steps.loading_step == pytest.approx(min(way, 0.25 * LAW[3]), rel=EXACT)
    assert steps.displacement_step == min(steps.loading_step, steps.longest_move)
    far = settings_for(scene(experiment={"kind": "path", "displacements": [60.0]}))
    assert far.increments.loading_step == pytest.approx(0.25 * LAW[3], rel=EXACT)
    back = settings_for(scene(experiment={"kind": "path", "displacements": [-0.1]}))
    assert back.increments.loading_step == pytest.approx(0.25 * LAW[3], rel=EXACT)
    plane = {"interaction": None, "bodies": {"lower": "rigid_plane"}}
    for deepest, step in ((1e3 * SPACING, 0.1 * SPACING), (-1.0, 0.1 * SPACING), (0.02, None)):
        on_plane = settings_for(scene(**plane, experiment={"kind": "path", "displacements": [deepest]}))
        wanted = step or CALIBRATION.loading_increment * 0.02
        assert on_plane.increments.loading_step == pytest.approx(wanted, rel=EXACT)
        assert on_plane.increments.smooth_step == 0.0
        assert not on_plane.is_smooth


@pytest.mark.parametrize("displacement", [-0.3, 0.0, 0.2])
def test_the_innermost_distance_is_that_of_a_pair_on_its_springs(displacement: float) -> None:
    settings = settings_for(scene(bodies={"spacing": 5.0}))
    exact = brentq(lambda r: r - 2.0 * pair(r) / SPRING - settings.forces.rest + displacement, 0.01, 3.0)
    found = innermost_distance(settings.law, settings.forces.cutoff, displacement)
    assert found == pytest.approx(exact, rel=1e-5)  # the row's others are far away


def test_a_table_follows_the_law_from_where_the_coldest_and_the_hottest_particles_come() -> None:
    """0.8 of the innermost distance; with heat five standard deviations √(2kT/k) nearer, down to `closest`."""
    cold = settings_for(scene())
    near = innermost_distance(cold.law, cold.forces.cutoff, cold.largest_displacement)
    assert cold.forces.table_from == pytest.approx(0.8 * near, rel=EXACT)
    heat = {"damping": {"coefficient": 0.3}, "plate": {}, "experiment": LOAD | {"method": "dynamic"}}
    for temperature in (1e-5, 10.0):
        of = scene(noise={"temperature": temperature, "seed": 1}, **heat)
        warm = settings_for(of)
        motion = 5.0 * math.sqrt(2.0 * temperature / SPRING)
        assert thermal_motion(of) == pytest.approx(motion, rel=EXACT)
        assert warm.forces.table_from == pytest.approx(max(warm.forces.closest, 0.8 * (near - motion)), rel=EXACT)
    pressed = settings_for(scene(experiment={"kind": "path", "displacements": [30.0]}))
    assert pressed.forces.table_from == pytest.approx(0.2 * pressed.forces.closest, rel=EXACT)


ON_PLANE = {"interaction": None, "bodies": {"lower": "rigid_plane"}}
TIMED = {"damping": {"coefficient": 0.3}, "plate": {"mass": 7.0}, "experiment": LOAD | {"method": "dynamic"}}
HEAT = TIMED | {"noise": {"temperature": 1e-3, "seed": 1}}


@pytest.mark.parametrize("timed", [{}, TIMED])
def test_on_a_plane_the_plane_alone_has_the_scenes_spring(timed: dict[str, Any]) -> None:
    """In time, too: nothing acts on a particle apart from its body."""
    forces = settings_for(scene(**ON_PLANE, **timed)).forces
    assert (forces.bulk_stiffness, forces.plane_stiffness) == (SPRING, SPRING)
    assert settings_for(scene(**timed)).forces.plane_stiffness == 0.0


@pytest.mark.parametrize(("neighbours", "timed"), [(0.3, {}), (40.0, {}), (0.3, TIMED), (0.3, HEAT), (None, HEAT)])
def test_plane_and_bond_in_series_are_the_scenes_spring_and_neighbours_and_heat_see_it_but_for_the_tolerance(
    neighbours: float | None, timed: dict[str, Any]
) -> None:
    springs = None if neighbours is None else {"stiffness": neighbours}
    forces = settings_for(scene(**ON_PLANE, **timed, neighbours=springs)).forces
    series = 1.0 / (1.0 / forces.plane_stiffness + 1.0 / forces.bulk_stiffness)
    assert series == pytest.approx(SPRING, rel=EXACT)
    softer = (SPRING + 4.0 * (neighbours or 0.0)) / forces.plane_stiffness
    assert softer == pytest.approx(1e-3, rel=EXACT)


def test_a_long_bond_is_as_long_as_its_bend_allows_and_only_where_two_stiffnesses_differ() -> None:
    """A move of a spacing across it bends its force by s/2L, a twentieth of the tolerance."""
    both = {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": 1.1}}
    for tolerance in (1e-2, 1e-4):
        far = settings_for(scene(**both, accuracy={"tolerance": tolerance})).chains.far
        assert 0.5 * SPACING / far == pytest.approx(0.05 * tolerance, rel=EXACT)
    assert settings_for(scene(bodies={"bulk_stiffness_tangential": 1.1})).chains.far == 0.0
    assert settings_for(scene(horizontal={}, bodies={"bulk_stiffness_tangential": SPRING})).chains.far == 0.0


def sharp(particles: Any, power: float) -> Scene:
    body = {"particles": particles, "profile": {"kind": "parabola", "radius": power}, "spacing": SPACING}
    return scene(bodies=body)


def test_an_apex_may_stand_a_thousand_times_the_reach_of_all_forces_above_its_neighbours() -> None:
    """The height half a spacing beside the apex of an even chain; an odd one has a particle there."""
    cutoff = 3.0
    for even, radius in ((True, 0.0), (False, 1e-9)):
        found = []
        for height in (0.99e3 * cutoff, 1.01e3 * cutoff):
            of = sharp(40 if even else 41, (0.5 * SPACING) ** 2 / (2.0 * height) if even else radius)
            try:
                require_apex(of, 40 if even else 41, cutoff)
                found.append(True)
            except SettingsError as error:
                assert f"{height:.4g} LU from its apex" in str(error)
                assert f"{0.5 * SPACING:.4g} LU from it" in str(error)
                found.append(False)
        assert found == ([True, False] if even else [True, True])
    require_apex(sharp(40, (0.5 * SPACING) ** 2 / (2.0 * 700.0)), 40, 0.0)  # without forces, the spacing


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize(("cutoff", "reach"), [(3.0, 3.0), (0.1, SPACING)])
def test_a_body_goes_as_far_as_is_said_and_no_further(side: float, cutoff: float, reach: float) -> None:
    of = scene()
    require_travel(of, side * 0.999e9 * reach, cutoff)
    with pytest.raises(SettingsError, match=f"at most {1e9 * reach:.3g} LU are possible".replace("+", r"\+")):
        require_travel(of, side * 1.001e9 * reach, cutoff)


def test_a_system_is_refused_that_the_machine_has_no_memory_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """2 kB for each particle, and 8 bytes for each of the pairs within reach, at most all of them."""
    memory = {"SC_PHYS_PAGES": 1, "SC_PAGE_SIZE": 0}
    monkeypatch.setattr(os, "sysconf", lambda name: memory[name])
    of, plane = scene(), scene(interaction=None, bodies={"lower": "rigid_plane"})
    for tables, particles, cutoff, needed in (
        (of, 1000, 4.0, 1000 * (2000.0 + 8.0 * (2.0 * 4.0 / SPACING + 2.0))),
        (of, 5, 40.0, 5 * (2000.0 + 8.0 * 5.0)),
        (plane, 1000, 0.0, 1000 * 2000.0),
    ):
        memory["SC_PAGE_SIZE"] = round(needed)
        require_memory(tables, particles, cutoff)
        memory["SC_PAGE_SIZE"] = round(0.999 * needed)
        with pytest.raises(SettingsError, match="need about") as caught:
            require_memory(tables, particles, cutoff)
        stated, there = map(float, re.findall(r"(\S+) GB", str(caught.value)))
        assert there < stated == pytest.approx(needed / 1e9, rel=0.05)  # two digits at least
    memory["SC_PAGE_SIZE"] = 10**12
    require_memory(of, 10_000_000, 1.0)
    with pytest.raises(SettingsError, match="more than 1e\\+07"):
        require_memory(of, 10_000_001, 1.0)


def slid(rows: int, steps: int, time: float, drag: float) -> tuple[Scene, Settings]:
    of = read_scene(
        chains(
            30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": drag},
            plate={"free": ["x", "z"], "mass": 5.0, "damping": 0.1}, cantilever={"stiffness": 0.5, "velocity": 0.1},
            bodies={"mass": 1.0, "upper_offset": 0.5},
            experiment={"kind": "slide", "normal_force": 1.0, "distance": 7.0},
        )
    )  # fmt: skip
    settings = settings_for(of)
    step = time / rows / steps
    leg = replace(settings.motion.drive[0], rows=rows, steps=steps, time_step=step)
    return of, replace(settings, motion=replace(settings.motion, drive=(leg,), time_step=step))


def test_with_its_own_mass_a_drag_of_half_a_step_before_is_exact_to_second_order() -> None:
    """Rows of LAMMPS's scheme, each with the right velocity at its start, beside the closed form exp(−γ t/m)."""
    drag, rows, time = 0.4, 3, 1.5
    errors = []
    for steps in (5, 10, 20):
        of, settings = slid(rows, steps, time, drag)
        mass = inertia(of, settings)[0]
        v = 1.0
        for _ in range(rows):
            a = -drag * v / mass
            for _ in range(steps):
                half = v + 0.5 * settings.motion.time_step * a
                a = -drag * half / mass
                v = half + 0.5 * settings.motion.time_step * a
        errors.append(abs(v - math.exp(-drag * time)))
    rates = np.log2(np.asarray(errors[:-1]) / errors[1:])
    assert rates == pytest.approx([2.0, 2.0], abs=0.3)
    assert errors[0] < 1e-3


def test_without_a_drive_and_under_heat_masses_are_the_scenes_own() -> None:
    of = scene(damping={"coefficient": 0.3}, plate={"mass": 7.0}, experiment=LOAD | {"method": "dynamic"})
    assert inertia(of, settings_for(of)) == (1.0, 7.0)


@pytest.mark.parametrize(("share", "snaps", "toothed"), [(0.2, False, False), (0.5, False, True), (0.7, True, True)])
def test_pairs_that_nearly_snap_let_go_one_by_one_and_weak_ones_together(
    share: float, snaps: bool, toothed: bool
) -> None:
    law = (0.18 * share, 0.03, 0.09 * share, 0.06)
    path = {"kind": "path", "displacements": [0.05]}
    settings = settings_for(read_scene(chains(10.0, law=law, bodies={"particles": 12}, experiment=path)))
    assert (settings.snaps, settings.has_several_maxima, settings.is_smooth) == (snaps, toothed, not snaps)


@pytest.mark.parametrize("profile", [{"kind": "circle", "radius": 4.0}, {"kind": "flat_punch", "radius": 4.0}])
def test_bodies_that_end_carry_any_load_below_the_one_that_is_named(profile: dict[str, Any]) -> None:
    estimate = settings_for(scene(bodies={"profile": profile}, experiment=LOAD)).law
    with pytest.raises(NotCarriedError) as caught:
        estimate.displacement_at(1e9)
    most = caught.value.most
    for share in (0.1, 0.5, 0.9, 0.99):
        assert estimate.contact_force(estimate.displacement_at(share * most)) == pytest.approx(share * most, rel=1e-3)
    with pytest.raises(NotCarriedError):
        estimate.displacement_at(1.01 * most)


def test_what_never_snaps_lets_go_at_the_end_of_its_forces_and_loses_nothing() -> None:
    estimate = settings_for(scene()).law
    assert estimate.snap == (float(estimate.gap[-1]), 0.0)


def test_where_pairs_snap_a_search_moves_by_a_quarter_of_the_smallest_distance() -> None:
    settings = settings_for(read_scene(chains(10.0, law=(0.36, 0.03, 0.18, 0.06), experiment=LOAD)))
    assert settings.snaps
    for distance in (2.0 * settings.forces.closest, 8.0 * settings.forces.closest):
        near = min(settings.increments.loading_step, max(settings.increments.displacement_step, 0.25 * distance))
        assert settings.increment(distance) == pytest.approx(near, rel=EXACT)
    assert settings.increment(1.001 * settings.forces.closest) < settings.increments.loading_step
