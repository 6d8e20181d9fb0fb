"""What the spacing leaves open of an adhesive contact on a rigid plane: sums over cells beside JKR's own integral.

The particles' sum misses the integral by what the middle of a cell misses of its mean, and of its edge. How much, and
how that changes with the place of the contact's centre between particles, is told by the very law of the deck.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import largest_tension
from contact1d.analysis.held import held_radius
from contact1d.analysis.polynomial import fitting, lowest_minimum
from contact1d.analysis.pressure import Profile
from contact1d.workflow.scene import Load, Path, Scene
from contact1d.workflow.settings.adhesion import AdhesiveEstimate, Cells, elongation
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.settings.shape import places_within

Array = NDArray[np.float64]
BESIDE, ASIDE, POINTS = 0.1, 0.3, 61
"""Ways on both sides of JKR's largest tension, and of another force, over the distance from fixed grips, and places."""
OWN, PHASES = 0.5, (0.25, 0.0)
"""Places of the apex between particles over the spacing: of an even chain, and those that it is held against."""
EDGES = 8
"""Places of an edge in its cell, of which nobody knows it beforehand."""
NEAR, DEGREE = 0.2, 4
"""Such a way for a polynomial of that degree."""
JUST_HELD = 1e-9
"""Way before the place at which a punch lets go of all at once, over that place."""
PULLING_STEPS = 48
"""Rows from F = 0 to where fixed grips let go."""
CLOSER = (0.5, -0.5, 0.25, -0.25, 0.0)
"""Rows beside the largest tension, over the increment to there, and at it in the end."""
LAST = 1e-9
"""How much of the way from F = 0 to where fixed grips let go is left before it."""
MARGIN = 1.25
"""Claim over the difference of the sums."""


def left_by_cells(scene: Scene, settings: Settings) -> dict[str, float]:
    """By the names of results, the largest change [its unit]; with given particles that of their own places only."""
    estimate = settings.estimate
    assert isinstance(estimate, AdhesiveEstimate)
    own = OWN if settings.particles % 2 == 0 else 0.0
    phases = (own, *PHASES) if scene.bodies.particles == "auto" and not scene.bodies.profile.has_edge else (own,)
    left: dict[str, float] = {}
    for by_rows in (False, True):
        whole = _marks(scene, settings, estimate, None, by_rows)
        for phase in phases:
            sums = _marks(scene, settings, estimate, _cells(scene, settings, estimate, phase), by_rows)
            both = whole.keys() & sums.keys()
            left |= {name: max(left.get(name, 0.0), MARGIN * abs(sums[name] - whole[name])) for name in both}
    return left


def expected_of_adhesion(scene: Scene, settings: Settings) -> dict[str, float]:
    """By the names of results, JKR's own [its unit]."""
    assert isinstance(settings.estimate, AdhesiveEstimate)
    return _marks(scene, settings, settings.estimate, None)


def read_off_cells(scene: Scene, settings: Settings) -> dict[str, float]:
    """By the names of radii of a load, how uncertain they are as they are read off particles [LU]."""
    estimate = settings.estimate
    assert isinstance(estimate, AdhesiveEstimate)
    if not isinstance(scene.experiment, Load):
        return {}
    spacing = scene.bodies.spacing
    x = places_within(spacing * (settings.particles // 2), spacing, OWN)
    cells, none, worst = estimate.cells(x, estimate.profile), np.zeros_like(x), 0.0
    edge = estimate.half_width(estimate.displacement_at(scene.experiment.force), estimate.rest)
    edges = np.asarray(edge - spacing * np.arange(EDGES) / EDGES, dtype=np.float64)
    places = estimate.profile.height(edges) - elongation(edges, estimate.modulus, estimate.work)
    for lengths in cells.lengths(places):  # a radius is the same in any unit of force
        worst = max(worst, held_radius(Profile(x, none, none, lengths, none)).uncertainty)
    return {"contact_radius": worst}


def _cells(scene: Scene, settings: Settings, estimate: AdhesiveEstimate, phase: float) -> Cells:
    spacing = scene.bodies.spacing
    reach = min(spacing * (settings.particles // 2), scene.bodies.reach)
    return estimate.cells(places_within(reach, spacing, phase), estimate.profile)


def _marks(
    scene: Scene, settings: Settings, estimate: AdhesiveEstimate, cells: Cells | None, by_rows: bool = False
) -> dict[str, float]:
    """The results by the sum over cells, or by JKR's integral for none; `by_rows`: see `_read_off`."""

    def forces(displacements: Array) -> Array:
        if cells is None:
            return estimate.contact_forces(displacements)
        return cells.forces(displacements, estimate.stiffness)

    def place_of(force: float) -> float:
        expected = estimate.displacement_at(force)
        places = expected + ASIDE * (expected - estimate.fixed_grips[1]) * np.linspace(-1.0, 1.0, POINTS)
        found = forces(places)
        top = int(np.argmin(found))
        return float(np.interp(force, found[top:], places[top:]))

    def radius(displacement: float) -> float:
        return estimate.half_width(displacement, estimate.rest)

    if isinstance(scene.experiment, Load):
        place = place_of(scene.experiment.force)
        return {"displacement": place, "contact_radius": radius(place)}
    zero = place_of(0.0)
    by = _largest_tension if not by_rows else _read_off if cells else _vertex
    tension, place = by(estimate, forces)
    marks = {"adhesion_force": tension, "critical_radius": radius(place), "zero_load_radius": radius(zero)}
    if isinstance(scene.experiment, Path):  # which goes no further than it says
        places = scene.experiment.places()
        passed = {"zero_load_radius": max(places) >= estimate.displacement_at(0.0)}
        passed |= dict.fromkeys(("adhesion_force", "critical_radius"), min(places) <= place)
        marks = {name: value for name, value in marks.items() if passed[name]}
    return marks


def _largest_tension(estimate: AdhesiveEstimate, forces: Callable[[Array], Array]) -> tuple[float, float]:
    """(tension [FU], displacement [LU]) where it is largest, by a parabola; a punch's is where it lets go."""
    expected, last = estimate.displacement_at(-estimate.pull_off_force()), estimate.fixed_grips[1]
    width = BESIDE * (expected - last)
    if width <= 0.0:
        held = last + JUST_HELD * abs(last)
        return -float(forces(np.asarray([held]))[0]), held
    t = np.linspace(-1.0, 1.0, POINTS)
    c = fitting(t, 2) @ forces(expected + width * t)
    best = float(np.clip(-0.5 * c[1] / c[2], -1.0, 1.0)) if c[2] > 0.0 else 0.0
    return -float(c @ best ** np.arange(3)), expected + width * best


def _read_off(estimate: AdhesiveEstimate, forces: Callable[[Array], Array]) -> tuple[float, float]:
    """The same as rows of a pull-off have it: where a contact is a few cells wide each that lets go makes a crest."""
    zero, last = estimate.displacement_at(0.0), estimate.fixed_grips[1]
    rows = pulling_rows(zero, last)
    before = largest_tension(rows.tolist(), forces(rows).tolist())
    if not 0 < before.index < len(rows) - 1:
        return _largest_tension(estimate, forces)
    beside = np.clip(before.position + (zero - last) / PULLING_STEPS * np.asarray(CLOSER), rows[-1], zero)
    rows = np.unique(np.concatenate([rows, beside]))[::-1]
    peak = largest_tension(rows.tolist(), forces(rows).tolist())
    return peak.smooth, peak.position


def _vertex(estimate: AdhesiveEstimate, forces: Callable[[Array], Array]) -> tuple[float, float]:
    """The same of a smooth curve, that is known by straight lines: by a polynomial through many of them."""
    expected, last = estimate.displacement_at(-estimate.pull_off_force()), estimate.fixed_grips[1]
    width = NEAR * (expected - last)
    if width <= 0.0:
        return _largest_tension(estimate, forces)
    t = np.linspace(-1.0, 1.0, POINTS)
    c = fitting(t, DEGREE) @ forces(expected + width * t)
    best, _ = lowest_minimum(c, -1.0, 1.0)
    best = 0.0 if np.isnan(best) else best
    return -float(c @ best ** np.arange(DEGREE + 1)), expected + width * best


def pulling_rows(zero: float, last: float) -> Array:
    """Displacements [LU] of the rows from F = 0 to just before fixed grips let go."""
    return np.asarray(np.linspace(zero, zero + (1.0 - LAST) * (last - zero), PULLING_STEPS + 1)[1:])
