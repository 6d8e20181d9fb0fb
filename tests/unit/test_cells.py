"""Claims of what cells leave open: marks of any curve F(d) by its own vertex, rows, cells and edges written out.

Reference: curves whose vertex is known, JKR's closed forms, Kendall's punch.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq

from contact1d.analysis.held import held_radius
from contact1d.analysis.pressure import Profile
from contact1d.workflow.settings.adhesion import AdhesiveEstimate
from contact1d.workflow.settings.cells import (
    _largest_tension,
    _read_off,
    _vertex,
    left_by_cells,
    read_off_cells,
)
from contact1d.workflow.settings.centring import expected
from contact1d.workflow.settings.settings import settings_for
from tests.unit.test_adhesion_estimate import A, E, R, W, estimate, jkr, radius_under, scene

Array = NDArray[np.float64]
EXACT = 1e-9
"""Relative: fits through 61 places of a polynomial of their own degree."""


def way(found: AdhesiveEstimate) -> tuple[float, float]:
    """(place of the largest tension, its distance from fixed grips)."""
    place = found.displacement_at(-found.pull_off_force())
    return place, place - found.fixed_grips[1]


@pytest.mark.parametrize("share", [-0.09, -0.03, 0.0, 0.05, 0.09])
@pytest.mark.parametrize("quartic", [0.0, 3.0])
def test_a_vertex_is_found_where_it_is(share: float, quartic: float) -> None:
    found = estimate(scene())
    middle, far = way(found)
    place = middle + share * far

    def forces(d: Array) -> Array:
        assert np.abs(d - middle).max() <= 0.2 * far * (1.0 + EXACT)  # no further is it looked at
        t = (d - place) / far
        return np.asarray(-0.3 + t**2 + quartic * t**4)

    assert _vertex(found, forces) == pytest.approx((0.3, place), rel=EXACT)
    if not quartic:

        def nearer(d: Array) -> Array:
            assert np.abs(d - middle).max() <= 0.1 * far * (1.0 + EXACT)
            assert d.size < 100
            return forces(d)

        assert _largest_tension(found, nearer) == pytest.approx((0.3, place), rel=EXACT)


@pytest.mark.parametrize("by", [_largest_tension, _vertex])
def test_without_a_vertex_nearby_the_place_is_on_the_way_or_its_middle(by: Any) -> None:
    found = estimate(scene())
    middle, far = way(found)
    for slope in (-1.0, -0.3, 0.3, 1.0):  # far beyond an end: that end; a crest or a straight line: the middle
        tension, place = by(found, lambda d, s=slope: -0.3 + (d - middle - s * far) ** 2)
        if by is _largest_tension:
            assert abs(place - middle) == pytest.approx(0.1 * far)
            assert (place - middle) * slope > 0.0
        else:
            assert place == middle
        assert tension == pytest.approx(0.3 - (place - middle - slope * far) ** 2, rel=EXACT)
    for bend in (-1.0, 0.0):
        tension, place = by(found, lambda d, b=bend: -0.3 + 2.0 * (d - middle) + b * (d - middle) ** 2)
        assert (tension, place) == (pytest.approx(0.3, rel=EXACT), middle)


@pytest.mark.parametrize("by", [_largest_tension, _vertex])
def test_a_punchs_largest_tension_is_where_it_lets_go(by: Any) -> None:
    found = estimate(scene(profile={"kind": "flat_punch", "radius": A}))
    last = -math.sqrt(2.0 * math.pi * A * W / E)
    tension, place = by(found, lambda d: np.where(d > found.fixed_grips[1], 2.0 * E * A * d, 0.0))
    assert (tension, place) == pytest.approx((-2.0 * E * A * last, last), rel=1e-6)


def test_what_rows_of_a_pull_read_off_a_smooth_curve_is_its_vertex() -> None:
    found = estimate(scene())
    zero, last = found.displacement_at(0.0), found.fixed_grips[1]
    for share in (2.0 / 48.0, 0.3, 0.55, 0.71, 47.0 / 48.0):
        place = zero + share * (last - zero)

        asked: list[Array] = []

        def forces(d: Array, place: float = place, asked: list[Array] = asked) -> Array:
            assert d.size < 60  # rows of a pull-off are some tens
            asked.append(d)
            return np.asarray(-0.3 + ((d - place) / (zero - last)) ** 2)

        read = _read_off(found, forces)
        assert read == pytest.approx((0.3, place), rel=1e-7)
        rows, step = asked[0], (zero - last) / 48.0
        beside = np.clip(place + step * np.array([-0.5, -0.25, 0.0, 0.25, 0.5]), rows.min(), zero)
        both = np.concatenate([rows, beside])
        assert np.abs(asked[1][:, None] - both).min(axis=1) == pytest.approx(0.0, abs=1e-6 * step)
        assert np.abs(both[:, None] - asked[1]).min(axis=1) == pytest.approx(0.0, abs=1e-6 * step)
    for end in (zero + 1.0, last - 1.0):  # no crest among the rows
        rising = _read_off(found, lambda d, p=end: (d - p) ** 2)
        assert rising == _largest_tension(found, lambda d, p=end: (d - p) ** 2)


def held_forces(d: float, edge: float, x: Array, s: float) -> Array:
    """Forces of cells of a paraboloid, by the formulas of a cell: q, φ, and the middle of the share φ of it."""

    def lets_go(a: float) -> float:
        least = (math.pi * W * R**2 / (8.0 * E)) ** (1.0 / 3.0)
        return jkr(max(a, least))[0]

    forces = []
    for at in np.abs(x).tolist():
        inner, own, outer = (lets_go(at + part * s) for part in (-0.5, 0.0, 0.5))
        q = min(max((d - inner) / (outer - inner), 0.0), 1.0) if outer > inner else float(at < edge)
        middle = min(max((own - inner) / (outer - inner), 0.1), 0.9) if outer > inner else 0.5
        bend = min(max((0.5 - middle) / (middle * (1.0 - middle)), -1.0), 1.0)
        share = q + bend * q * (1.0 - q)
        fall = (at**2 - (at - 0.5 * s) ** 2) / R
        forces.append(E * s * share * (d - at**2 / R + fall * (1.0 - share)))
    return np.asarray(forces)


@pytest.mark.parametrize("force", [-1.0, 0.0, 4.0])
@pytest.mark.parametrize("spacing", [0.3, 0.9])
def test_a_radius_is_read_off_no_better_than_at_the_worst_place_of_its_edge(force: float, spacing: float) -> None:
    of = scene(spacing, experiment={"kind": "load", "force": force})
    settings = settings_for(of)
    a = radius_under(force)
    x = spacing * (np.arange(-60, 60) + 0.5)
    none, worst = np.zeros_like(x), 0.0
    for edge in np.linspace(a - spacing, a, 81).tolist():
        held = held_radius(Profile(x, none, none, held_forces(jkr(edge)[0], edge, x, spacing), none))
        worst = max(worst, held.uncertainty)
    assert set(told := read_off_cells(of, settings)) == {"contact_radius"}
    assert 0.7 * worst <= told["contact_radius"] <= worst * (1.0 + 1e-3)


def test_only_of_a_load_is_a_radius_read_off() -> None:
    of = scene()
    assert read_off_cells(of, settings_for(of)) == {}


@pytest.mark.parametrize("phase", [0.0, 0.25, 0.5, 0.9])
@pytest.mark.parametrize("spacing", [0.2, 1.0, 3.0])
def test_forces_of_cells_are_those_of_their_formulas(spacing: float, phase: float) -> None:
    of = scene(spacing)
    found = estimate(of)
    x = spacing * (np.arange(-40, 40) + phase)
    cells = found.cells(x, of.bodies)
    for a in (2.8, 4.4, 7.77, 12.3):
        d = jkr(a)[0]
        forces = held_forces(d, a, x, spacing)
        told = float(cells.forces(np.asarray([d]), E * spacing)[0])
        assert told == pytest.approx(forces.sum(), abs=2e-4 * np.abs(forces).sum())  # of a flat least between places


def test_cells_without_adhesion_are_springs_that_let_go_at_touch() -> None:
    of = scene(0.7, adhesion={"work_of_adhesion": 0.0}, experiment={"kind": "load", "force": 3.0})
    x = 0.7 * np.arange(-30.0, 31.0)
    cells = estimate(of).cells(x, of.bodies)
    for d in (-0.2, 1e-6, 0.3, 1.7):
        springs = E * 0.7 * np.maximum(d - x**2 / R, 0.0).sum()
        assert float(cells.forces(np.asarray([d]), E * 0.7)[0]) == pytest.approx(springs, rel=EXACT)


def test_cells_of_a_punch_let_go_all_at_once() -> None:
    of = scene(0.5, profile={"kind": "flat_punch", "radius": A})
    found = estimate(of)
    x = 0.5 * (np.arange(-10, 10) + 0.5)
    cells = found.cells(x, of.bodies)
    last = found.fixed_grips[1]
    for d, held in ((last * 1.001, 0.0), (last * 0.999, 1.0), (0.3, 1.0)):
        assert cells.shares(np.asarray([d])).tolist() == [[held] * 20]
        assert float(cells.forces(np.asarray([d]), 0.5 * E)[0]) == pytest.approx(held * 2.0 * A * E * d, rel=1e-6)


@pytest.mark.parametrize(
    ("displacements", "passed"),
    [
        ([0.2], ""), ([0.3], "zero"), ([0.3, -0.09], "zero"), ([0.3, -0.12], "zero tension"), ([0.2, -0.12], "tension"),
        ([-0.05, 0.3, 0.1], "zero"), ([0.2, -0.12, 0.1], "tension"),
    ],
)  # fmt: skip
def test_of_a_path_only_what_it_passes_is_expected(displacements: list[float], passed: str) -> None:
    """JKR's own: F = 0 at d = a²/R − √(2πWa/E*) = 0.264, the largest tension at −0.105."""
    of = scene(experiment={"kind": "path", "displacements": displacements})
    names = {"zero": {"zero_load_radius"}, "tension": {"adhesion_force", "critical_radius"}}
    wanted = set().union(*(names[word] for word in passed.split()))
    settings = settings_for(of)
    for told in (expected(of, settings), left_by_cells(of, settings)):
        assert set(told) == wanted


def test_a_path_just_to_no_force_passes_it() -> None:
    zero = estimate(scene()).displacement_at(0.0)
    of = scene(experiment={"kind": "path", "displacements": [zero]})
    settings = settings_for(of)
    assert isinstance(settings.estimate, AdhesiveEstimate)
    just = of.with_({"experiment.displacements": [settings.estimate.displacement_at(0.0)]})
    assert set(expected(just, settings)) == {"zero_load_radius"}


def test_a_chain_that_is_narrower_than_its_contact_has_no_more_cells_than_particles() -> None:
    """20 particles of a contact 60 wide: what is left open is the force of all that is missing."""
    of = scene(0.3, particles=20, experiment={"kind": "load", "force": 4.0})
    settings = settings_for(of)
    a = radius_under(4.0)
    assert 2.0 * a > 0.3 * 40
    x = 0.3 * (np.arange(20) - 9.5)
    cells = estimate(of).cells(x, of.bodies)
    place = brentq(lambda d: float(cells.forces(np.asarray([d]), 0.3 * E)[0]) - 4.0, jkr(a)[0], 10.0)
    assert place > jkr(a)[0]
    assert left_by_cells(of, settings)["displacement"] > 0.5 * (place - jkr(a)[0])
