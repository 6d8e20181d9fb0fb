"""Claims of the estimate that chooses settings: its sums are those of independent pairs, its widths the profile's.

References: `FoldedPairs` with scipy's quadrature, closed forms of a parabola and of springs on a plane, chains of
springs solved as linear equations.
"""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from scipy.integrate import simpson
from scipy.optimize import brentq, minimize_scalar

from contact1d.analysis.reference.folded_pairs import FoldedPairs
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.centring import _Row
from contact1d.workflow.settings.estimate import (
    ContactEstimate,
    NotCarriedError,
    particles_estimate,
    plane_estimate,
    row_force,
)
from contact1d.workflow.settings.registry import largest_holding_force, slide_cutoff
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.stability.pairs import ATTRACTION, LAW, REPULSION, STEEPEST
from tests.scenes import chains

SHORT = DoubleExponential(Exponential(*REPULSION), Exponential(*ATTRACTION))
RADIUS, CUTOFF = 400.0, 0.4
PHASES = (0.5, 0.25, 0.0)
GRID = 2e-3
"""Of a force: straight lines between 4000 distances, and 401 places."""
FLAT = 2e-2
"""Relative, of a place beside a flat top, or of a slope between two places of a grid."""
PLACES = 0.05
"""Relative, of a tension at one of 400 places."""
HEIGHTS = 0.15
"""Relative, of a force that falls by exp(2π) in a spacing of height, at heights 2 % apart."""
REST = LAW.force_free_distance()


def parabola(**more: Any) -> Scene:
    return scene_from_dict(
        chains(
            RADIUS, law=(*REPULSION, *ATTRACTION), bodies={"particles": 60, "bulk_stiffness": 1.0},
            experiment={"kind": "load", "force": 0.1},
        )
        | more
    )  # fmt: skip


def scene_of(radius: float, **tables: Any) -> Scene:
    return scene_from_dict({"experiment": {"kind": "load", "force": 0.1}} | chains(radius, **tables))


def estimate(ratio: float) -> ContactEstimate:
    return particles_estimate(SHORT, parabola().bodies, 1.0, 2.0 * STEEPEST / ratio, CUTOFF, REST)


def smeared(ratio: float, d: float) -> float:
    """∫ f(r(x)) dx of pairs at the displacement d, each on its branch that comes from afar."""
    pairs = FoldedPairs(LAW, 2.0 * STEEPEST / ratio, np.zeros(1))
    end = math.sqrt(2.0 * RADIUS * max(0.0, d + CUTOFF - REST))
    x = np.linspace(0.0, end, 2001)
    return float(2.0 * simpson(pairs.loading(d - x**2 / (2.0 * RADIUS)), x=x))


@pytest.mark.parametrize("d", [-0.02, 0.0, 0.01, 0.05])
def test_the_force_is_that_of_independent_pairs_smeared_along_x(d: float) -> None:
    largest = estimate(0.5).pull_off_force()
    assert estimate(0.5).contact_force(d) == pytest.approx(smeared(0.5, d), abs=GRID * largest)


def test_the_largest_tension_and_its_inverse_are_those_of_the_smeared_pairs() -> None:
    found = estimate(0.5)
    top = minimize_scalar(lambda d: smeared(0.5, d), bounds=(-0.1, 0.02), method="bounded")
    assert found.pull_off_force() == pytest.approx(-top.fun, rel=GRID)
    for force in (0.0, 0.2, 1.0):
        place = brentq(lambda d, f=force: smeared(0.5, d) - f, top.x, 0.2)
        assert found.displacement_at(force) == pytest.approx(place, rel=FLAT)
    assert 0.5 * found.pull_off_force() == pytest.approx(-found.contact_force(found.parted(0.5)), rel=PLACES)
    assert found.parted(0.5) < top.x


@pytest.mark.parametrize("force", [-0.3, 0.0, 0.5])
def test_the_stiffness_under_a_force_is_the_slope_of_the_smeared_pairs(force: float) -> None:
    found = estimate(0.5)
    top = minimize_scalar(lambda d: smeared(0.5, d), bounds=(-0.1, 0.02), method="bounded").x
    place = brentq(lambda d: smeared(0.5, d) - force, top, 0.2)
    slope = (smeared(0.5, place + 1e-5) - smeared(0.5, place - 1e-5)) / 2e-5
    assert found.stiffness_under(force) == pytest.approx(slope, rel=2 * FLAT)


@pytest.mark.parametrize(("height", "width"), [(0.5, math.sqrt(400.0)), (-0.1, 1.0), (0.0, 1.0), (2e4, 4000.0)])
def test_the_half_width_is_the_parabolas(height: float, width: float) -> None:
    assert estimate(0.5).half_width(height - CUTOFF + REST, CUTOFF) == pytest.approx(width, rel=1e-6)


def test_a_body_that_ends_is_no_wider_than_itself() -> None:
    punch = scene_of(RADIUS, bodies={"profile": {"kind": "flat_punch", "radius": 10.0}, "particles": 20})
    found = plane_estimate(punch.bodies, 1.0, 0.5)
    assert found.half_width(3.0, 0.0) == 10.0
    assert found.contact_force(0.2) == pytest.approx(20 * 0.5 * 0.2)
    pairs = particles_estimate(SHORT, punch.bodies, 1.0, 1.0, CUTOFF, REST)
    with pytest.raises(NotCarriedError):
        pairs.displacement_at(1e6)


def test_springs_on_a_plane_are_as_stiff_as_their_closed_form() -> None:
    found = plane_estimate(parabola().bodies, 1.0, 0.5)
    for d in (0.1, 1.0):
        force = 0.5 * 4.0 / 3.0 * math.sqrt(2.0 * RADIUS) * d**1.5
        assert found.contact_force(d) == pytest.approx(force, rel=GRID)
        assert found.displacement_at(force) == pytest.approx(d, rel=GRID)


def test_pairs_snap_where_their_closed_form_folds() -> None:
    found, fold = estimate(3.0), FoldedPairs(LAW, 2.0 * STEEPEST / 3.0, np.zeros(1)).fold
    assert fold is not None
    assert found.snaps
    assert not estimate(0.9).snaps
    gap, lost = found.snap
    held = FoldedPairs(LAW, 2.0 * STEEPEST / 3.0, np.zeros(1))
    before, behind = (
        float(LAW.force(held.distance(np.array([fold.gap_off]), np.array([joined])))[0]) for joined in (True, False)
    )
    assert gap == pytest.approx(fold.gap_off, rel=FLAT)
    assert lost == pytest.approx(behind - before, rel=FLAT)
    width = math.sqrt(2.0 * RADIUS * (0.02 + gap - REST))
    assert found.stuck_stiffness(0.02) == pytest.approx(2.0 * width * found.stiffness, rel=FLAT)
    assert found.stuck_stiffness(-10.0) == pytest.approx(2.0 * found.stiffness)
    assert estimate(0.9).snap[1] == 0.0


@pytest.mark.parametrize("particles", [12, 13])
def test_teeth_are_as_far_apart_as_the_heights_of_neighbours(particles: int) -> None:
    """The last pairs to let go are the innermost, which are nearest to each other in height."""
    steep = particles_estimate(
        SHORT, scene_of(0.5, bodies={"particles": 13}).bodies, 1.0, 2.0 * STEEPEST / 30.0, CUTOFF, REST
    )
    nearest = 1.0 if particles % 2 else 2.0  # (1² − 0²)/2R, and (1.5² − 0.5²)/2R
    assert steep.tooth(particles) == pytest.approx(nearest, rel=FLAT)
    assert estimate(0.3).tooth(3) == math.inf


def test_a_row_pulls_with_all_its_particles() -> None:
    r = np.array([0.05, 0.3, 0.9, 2.0])  # the last at the cutoff itself
    wide = DoubleExponential(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
    expected = np.zeros(4)
    for j in range(-9, 10):
        distance = np.sqrt(r**2 + (0.5 * j) ** 2)
        force = 0.18 / 0.13 * np.exp(-distance / 0.13) - 0.09 / 0.26 * np.exp(-distance / 0.26)
        expected += np.where(distance <= 2.0, force * r / distance, 0.0)
    assert row_force(wide, r, 0.5, 2.0) == pytest.approx(expected, rel=1e-12)


def row(phase: float, ratio: float = 0.5, deepest: float = 0.05) -> tuple[_Row, ContactEstimate]:
    found = estimate(ratio)
    return _Row(found, phase, deepest), found


@pytest.mark.parametrize("phase", PHASES)
def test_a_chain_at_a_phase_is_the_sum_over_its_particles(phase: float) -> None:
    chain, found = row(phase)
    for d in (-0.01, 0.0, 0.03, 0.05):
        heights = (np.arange(-400, 400) + phase) ** 2 / (2.0 * RADIUS)
        exact = float(np.interp(REST + heights - d, found.gap, found.force, right=0.0).sum())
        assert chain.force(d) == pytest.approx(exact, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("phase", PHASES)
def test_marks_of_a_chain_at_a_phase_are_those_of_independent_pairs(phase: float) -> None:
    chain, _ = row(phase)
    pairs = FoldedPairs(LAW, 2.0 * STEEPEST / 0.5, (np.arange(-100, 100) + phase) ** 2 / (2.0 * RADIUS))
    top = minimize_scalar(lambda d: float(pairs.loading(d)), bounds=(-0.05, 0.01), method="bounded")
    place, tension = chain.largest_tension()
    assert tension == pytest.approx(-top.fun, rel=GRID)
    assert place == pytest.approx(top.x, abs=FLAT * ATTRACTION[1])
    for force in (0.0, 0.2):
        exact = brentq(lambda d, f=force: float(pairs.loading(d)) - f, top.x, 0.1)
        assert chain.crossing(force) == pytest.approx(exact, abs=1e-2 * ATTRACTION[1])


@pytest.mark.parametrize("move", [1e-3, 3e-3])
def test_a_pair_lets_go_where_a_move_carries_it_beyond_its_unstable_place(move: float) -> None:
    """Reference: both roots of G(r) = r − 2 f(r)/k next to its fold, at the gap where they are a move apart."""
    found = estimate(3.0)
    stiffness = 2.0 * STEEPEST / 3.0

    def gap(r: float) -> float:
        return float(r - 2.0 * LAW.force(np.asarray([r]))[0] / stiffness)

    fold = minimize_scalar(lambda r: -gap(r), bounds=(0.5 * REST, REST + ATTRACTION[1]), method="bounded",
                           options={"xatol": 1e-13}).x  # fmt: skip

    def apart(early: float) -> float:
        inner, outer = (
            brentq(lambda r: gap(r) - gap(fold) + early, *ends) for ends in ((0.5 * fold, fold), (fold, 1.3 * fold))
        )
        return float(outer - inner) - move

    early = brentq(apart, 1e-12, 1e-3)
    assert found.let_go_early(move, 0.0) == pytest.approx(early, rel=0.1)  # the fold's third derivative
    assert found.let_go_early(move, 1e-6) > found.let_go_early(move, 0.0)
    assert found.let_go_early(0.0, 1e-6) == pytest.approx(20.0 * 2.0 * 1e-6 / stiffness)  # what a relaxation leaves
    assert estimate(0.5).let_go_early(move, 1e-6) == 0.0


@pytest.mark.parametrize(("spacing", "load"), [(1.0, 0.0), (1.0, 0.2), (0.8, 0.0), (0.8, 0.5)])
def test_a_row_holds_a_particle_with_the_slope_of_its_energy(spacing: float, load: float) -> None:
    """Reference: U(x, z) = Σ V(r) over the row, differences of it, and the height that the load has in a hollow."""
    law = DoubleExponential(Exponential(1.0, 0.5), Exponential(0.5, 1.0))
    row = spacing * np.arange(-80.0, 81.0)

    def energy(x: float, z: float) -> float:
        return float(law.energy(np.hypot(x - row, z)).sum())

    def lift(z: float) -> float:
        return (energy(0.5 * spacing, z - 1e-6) - energy(0.5 * spacing, z + 1e-6)) / 2e-6 - load

    heights = np.geomspace(0.02, 9.0, 2000)
    outermost = heights[np.flatnonzero([lift(z) >= 0.0 for z in heights])[-1]]
    slopes = [(energy(x + 1e-6, outermost) - energy(x - 1e-6, outermost)) / 2e-6 for x in np.linspace(0.0, spacing, 41)]
    found = largest_holding_force(law, spacing, load)
    assert found == pytest.approx(max(np.abs(slopes)), rel=HEIGHTS)
    cutoff = slide_cutoff(law, spacing, load, 1e-3)
    assert 0.5 * math.exp(-cutoff) == pytest.approx(0.1 * 1e-3 * found, rel=1e-9)
    assert slide_cutoff(law, spacing, load, 1e9) == 1.0  # never below the longest range,
    assert slide_cutoff(law, spacing, load, 1e-30) == 40.0  # nor beyond the reach of the sums


def timed(**more: Any) -> Settings:
    return settings_for(scene_from_dict(chains(RADIUS, **more)))


def test_drag_that_stops_a_particle_within_a_step_shortens_the_step() -> None:
    load = {"kind": "load", "method": "dynamic", "force": 0.5}
    heavy = timed(damping={"coefficient": 500.0}, plate={}, experiment=load)
    assert heavy.time_step == pytest.approx(0.2 / 500.0)
    plate = timed(damping={"coefficient": 0.1}, plate={"mass": 2.0, "damping": 4000.0}, experiment=load)
    assert plate.time_step == pytest.approx(0.2 * 2.0 / 4000.0)
    assert plate.plate_damping == 4000.0


def test_a_given_drag_is_used_as_it_is_and_an_automatic_one_follows_the_load() -> None:
    load = {"kind": "load", "method": "dynamic", "force": 0.5}
    given = timed(damping={"coefficient": 0.3}, plate={}, experiment=load)
    assert (given.damping, given.damped_stiffness) == (0.3, 0.0)
    assert given.plate_damping > 0.0  # what is missing to the critical drag
    chosen = timed(damping={"coefficient": "auto"}, plate={}, experiment=load)
    assert chosen.damped_stiffness > 0.0
    total = given.particles * given.damping + given.plate_damping
    assert total == pytest.approx(chosen.particles * chosen.damping, rel=1e-9)
    path = timed(
        damping={"coefficient": "auto"}, experiment={"kind": "path", "method": "dynamic", "displacements": [0.1]}
    )
    assert path.damping == pytest.approx(math.sqrt(path.bulk_stiffness * 1.0))
    assert path.plate_damping == 0.0


def test_goes_to_another_process_with_what_it_was_made_of() -> None:
    """`contact1d cost` sends settings to its workers, after their estimate was asked for this and that."""
    scene = scene_from_dict({
        "title": "sent",
        "bodies": {
            "particles": 41, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 0.83,
            "reduction": "geike_popov",
        },
        "interaction": {
            "repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26},
        },
        "experiment": {"kind": "load", "force": 0.5},
    })  # fmt: skip
    here = settings_for(scene).estimate
    asked = here.displacement_at(0.5), here.tooth(41), here.pull_off_force()
    there = pickle.loads(pickle.dumps(here))
    assert (there.displacement_at(0.5), there.tooth(41), there.pull_off_force()) == asked
