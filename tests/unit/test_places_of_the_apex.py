"""Claims of what the lattice leaves open: sums over particles wherever the apex stands, written out; and of teeth.

References: springs on a plane and pairs of particles, added up one by one and solved by scipy; Mindlin's spring sliders
(`validation.references`); scipy's own search for peaks.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from contact1d.workflow.model.centring import expected, left_by_centring
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar
from scipy.signal import find_peaks

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.model.pairs import particles_estimate
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene, scene_from_dict
from tests.scenes import chains
from validation.hard.cases import ATTRACTION, LAW, REPULSION, STEEPEST

Array = NDArray[np.float64]
RADIUS, SPACING, SPRING = 40.0, 0.8, 0.7
OTHERS = (0.25, 0.0)
MARGIN = 1.25
"""Claim over the change."""
SHARE = 0.02
"""Of a difference between two places of the apex: places are found to a thousandth of a step."""


def plane(experiment: dict[str, Any], radius: float = RADIUS, **tables: Any) -> Scene:
    bodies = {"spacing": SPACING, "lower": "rigid_plane"}
    return scene_from_dict(chains(radius, SPRING, bodies=bodies, interaction=None, experiment=experiment, **tables))


def springs(phase: float, d: float) -> float:
    x = SPACING * (np.arange(-200.0, 200.0) + phase)
    return float(SPRING * np.maximum(d - x**2 / RADIUS, 0.0).sum())  # on a plane by the method of reduction, x²/R


def changes(of: Any) -> float:
    """The largest change of a quantity of a phase from that of an even chain, 1/2."""
    return max(abs(of(phase) - of(0.5)) for phase in OTHERS)


@pytest.mark.parametrize("force", [0.02, 0.3, 5.0])
def test_a_load_on_a_plane_leaves_open_what_springs_added_up_do(force: float) -> None:
    scene = plane({"kind": "load", "force": force})
    settings = settings_for(scene)
    left, told = left_by_centring(scene, settings), expected(scene, settings)

    def place(phase: float) -> float:
        return float(brentq(lambda d: springs(phase, d) - force, 1e-6, 30.0))

    def radius(phase: float) -> float:
        return math.sqrt(RADIUS * place(phase))

    assert told["displacement"] == pytest.approx(place(0.5), rel=1e-4)
    assert told["contact_radius"] == pytest.approx(radius(0.5), rel=1e-4)
    assert left["displacement"] == pytest.approx(MARGIN * changes(place), rel=SHARE)
    assert left["contact_radius"] == pytest.approx(MARGIN * changes(radius), rel=SHARE)


@pytest.mark.parametrize("deepest", [0.1, 1.3])
def test_a_path_on_a_plane_leaves_open_its_largest_force(deepest: float) -> None:
    scene = plane({"kind": "path", "displacements": [0.0, deepest, 0.05]})
    left = left_by_centring(scene, settings_for(scene))
    assert set(left) == {"largest_force"}
    assert left["largest_force"] == pytest.approx(MARGIN * changes(lambda phase: springs(phase, deepest)), rel=SHARE)


def test_what_stands_on_its_own_places_leaves_nothing_open() -> None:
    load = {"kind": "load", "force": 0.3}
    given = chains(RADIUS, SPRING, bodies={"particles": 41, "lower": "rigid_plane"}, interaction=None, experiment=load)
    punch = {"profile": {"kind": "flat_punch", "radius": 8.0}, "lower": "rigid_plane"}
    for tables in (given, chains(RADIUS, SPRING, bodies=punch, interaction=None, experiment=load)):
        scene = scene_from_dict(tables)
        assert left_by_centring(scene, settings_for(scene)) == {}


@pytest.mark.parametrize("stiffness", [0.7, 6.0])
def test_a_pull_off_leaves_open_what_pairs_added_up_do(stiffness: float) -> None:
    """Short ranges, a sharp body: a few particles make the whole of the adhesion."""
    scene = scene_from_dict(chains(6.0, stiffness, experiment={"kind": "pull_off", "preload": 0.3}))
    settings = settings_for(scene)
    estimate = settings.estimate
    left, told = left_by_centring(scene, settings), expected(scene, settings)

    def force(phase: float, d: float) -> float:
        gap = estimate.rest + (np.arange(-100.0, 100.0) + phase) ** 2 / 12.0 - d
        return float(np.interp(gap, estimate.gap, estimate.force, right=0.0).sum())

    def top(phase: float) -> tuple[float, float]:
        places = np.linspace(-1.0, 1.0, 4001)
        first = places[int(np.argmin([force(phase, d) for d in places]))]
        found = minimize_scalar(lambda d: force(phase, d), bounds=(first - 2e-3, first + 2e-3), method="bounded",
                                options={"xatol": 1e-9})  # fmt: skip
        return float(found.x), -float(found.fun)

    def zero(phase: float) -> float:
        return float(brentq(lambda d: force(phase, d), top(phase)[0], 2.0))

    def zero_radius(phase: float) -> float:
        edge = float(estimate.gap[int(estimate.force.argmin())])
        return float(np.sqrt(max(0.0, 12.0 * (edge - estimate.rest + zero(phase)))))

    assert told["adhesion_force"] == pytest.approx(top(0.5)[1], rel=1e-4)
    assert told["zero_load_radius"] == pytest.approx(zero_radius(0.5), rel=1e-3)
    assert left["adhesion_force"] == pytest.approx(MARGIN * changes(lambda phase: top(phase)[1]), rel=SHARE)
    assert left["zero_load_radius"] == pytest.approx(MARGIN * changes(zero_radius), rel=SHARE)


@pytest.mark.parametrize("force", [0.02, 0.3, 20.0])
def test_friction_leaves_open_what_sliders_added_up_do(force: float) -> None:
    """Out to a quarter and past all of it: the tangential force of a straight way, by each particle's own slider."""
    coefficient, along = 0.3, [0.01, 0.05]
    scene = plane(
        {"kind": "tangential", "normal_force": force, "displacements": along}, friction={"coefficient": coefficient}
    )
    settings = settings_for(scene)
    left, told = left_by_centring(scene, settings), expected(scene, settings)

    def tangential(phase: float) -> float:
        d = float(brentq(lambda d: springs(phase, d) - force, 1e-6, 30.0))
        x = SPACING * (np.arange(-200.0, 200.0) + phase)
        normal = SPRING * np.maximum(d - x**2 / RADIUS, 0.0)
        return float(np.minimum(scene.tangential_stiffness * along[-1], coefficient * normal).sum())

    assert told["normal_force"] == pytest.approx(force, rel=1e-6)
    assert told["tangential_force"] == pytest.approx(tangential(0.5), rel=1e-6)
    others = [abs(tangential(phase) - tangential(0.5)) for phase in (0.375, 0.25, 0.125, 0.0)]
    assert left["tangential_force"] == pytest.approx(MARGIN * max(others), rel=SHARE, abs=1e-9 * force)


@pytest.mark.parametrize("particles", [3, 4, 12, 13])
@pytest.mark.parametrize("ratio", [0.3, 0.9, 2.0, 6.0, 30.0])
@pytest.mark.parametrize("radius", [0.5, 4.0, 40.0])
def test_teeth_are_the_peaks_of_the_tension_summed_over_all_particles(
    particles: int, ratio: float, radius: float
) -> None:
    """A peak is one from which the tension falls by 1e-4 of the largest, between F = 0 and where nothing is felt."""
    law = DoubleExponential(Exponential(*REPULSION), Exponential(*ATTRACTION))
    body = scene_from_dict(chains(radius, bodies={"particles": 13}, experiment={"kind": "load", "force": 0.1})).bodies
    rest = LAW.force_free_distance()
    found = particles_estimate(law, body, 1.0, 2.0 * STEEPEST / ratio, 0.4, rest)
    x = np.arange(particles) - 0.5 * (particles - 1)
    places = np.linspace(found.displacement_at(0.0), rest - float(found.gap[-1]), 2000)
    gaps = rest + body.height(x)[:, None] - places
    tension = -np.interp(gaps, found.gap, found.force, right=0.0).sum(axis=0)
    padded = np.concatenate([[-1e9], tension, [-1e9]])
    peaks, _ = find_peaks(padded, prominence=1e-4 * float(tension.max()))
    falls = [peak for peak in peaks - 1 if tension[peak] - tension[peak:].min() > 1e-4 * float(tension.max())]
    expected_distance = math.inf if len(falls) < 2 else float(np.min(-np.diff(places[falls])))
    assert found.tooth(particles) == pytest.approx(expected_distance, rel=1e-9)
