"""What the lattice leaves open: by how much results change with the place of the contact's centre between particles.

A chain "auto" is as long as the contact needs and even, so that the apex lies between two particles. Nobody asked for
that: on a particle, or a quarter of the spacing off it, the same body has another force

    F(d) = Σ_i f(r_i),    G(r_i) = r₀ + h((i + φ) s) − d,    φ = 1/2, 1/4, 0

The differences between these sums are those of the estimate's independent pairs: of contacts many spacings wide they
are exponentially small where the pairs' force is smooth, and algebraically on a rigid plane. Where the number of
particles is given, these particles are the body that was asked for, and the lattice leaves nothing open but what is
read off between them; a flat punch has its edge particles where it ends, and one way to stand only.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import fitting, lowest_minimum
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import compressive_radius
from contact1d.workflow.scene import Load, Scene, Tangential
from contact1d.workflow.settings.cells import expected_of_adhesion, left_by_cells, read_off_cells
from contact1d.workflow.settings.estimate import ContactEstimate
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.settings.shape import places_within
from contact1d.workflow.settings.sliders import Sliders, sliders_of, stops

Array = NDArray[np.float64]
OWN, OTHERS = 0.5, (0.25, 0.0)
"""Places of the apex between particles over the spacing: of an even chain, and those that it is held against."""
WIDE, DEGREE = 3.0, 4
"""Steps of the first look, on both sides of the largest tension, and degree of the polynomial that places it."""
OVERREACH = 0.1
"""Way beyond the deepest place of the estimate that is looked at, over that place and a spacing."""
MORE = (0.375, 0.25, 0.125, 0.0)
"""Such places where friction makes several edges, the errors of which may cancel at two places."""
FEWEST = 4.0
"""Least half-width up to which they are, over the spacing."""
OVER_DEEPEST = 1.5
"""Depth up to which friction's particles are counted, over the estimate's: few carry a load deeper than many."""
MARGIN = 1.25
"""Claim over the change of the estimate, which knows no neighbours; measured against chains of both parities: 1.01."""
POINTS = (200, 40, 40, 40)
"""Displacements at which a sum is looked at, each time between those next to the one looked for."""


@lru_cache(maxsize=4)  # asked for ahead, while LAMMPS is at work
def left_by_centring(scene: Scene, settings: Settings) -> Mapping[str, float]:
    """By the names of results, the largest change [its unit]."""
    if scene.adheres and scene.adhesion is not None:
        return left_by_cells(scene, settings)
    if scene.bodies.particles != "auto" or scene.bodies.profile.has_edge:
        return {}
    phases = MORE if isinstance(scene.experiment, Tangential) else OTHERS
    own, *others = (_marks(scene, settings, phase) for phase in (OWN, *phases))
    return {name: MARGIN * max(abs(other[name] - value) for other in others) for name, value in own.items()}


def expected(scene: Scene, settings: Settings) -> Mapping[str, float]:
    """By the names of results, what the estimate makes of them [its unit]: what such a change is to be held against."""
    if scene.adheres and scene.adhesion is not None:
        return expected_of_adhesion(scene, settings)
    sizes = _marks(scene, settings, OWN)
    if isinstance(scene.experiment, Tangential):
        chain = _chain(scene, settings, OWN)
        sizes |= chain.sizes(stops(scene.experiment, chain))
    return sizes


def read_off(scene: Scene, settings: Settings) -> Mapping[str, float]:
    """By the names of radii, how uncertain they are as they are read off particles [LU]; of a load and of friction."""
    if scene.bodies.profile.has_edge:
        return {}
    if scene.adheres and scene.adhesion is not None:
        return read_off_cells(scene, settings)
    if isinstance(scene.experiment, Tangential):
        chain = _chain(scene, settings, OWN)
        return chain.read_off(stops(scene.experiment, chain))
    if not isinstance(scene.experiment, Load):
        return {}
    row = _Row(settings.estimate, OWN, settings.largest_displacement)
    return {"contact_radius": compressive_radius(row.profile(row.crossing(scene.experiment.force))).uncertainty}


def _marks(scene: Scene, settings: Settings, phase: float) -> dict[str, float]:
    """The results of a chain that stands so, as far as they are the scene's."""
    estimate, experiment = settings.estimate, scene.experiment
    edge = float(estimate.gap[int(estimate.force.argmin())])
    deepest = settings.largest_displacement

    def radius(displacement: float) -> float:
        return estimate.half_width(displacement, edge)

    if experiment.motion_is_result:
        return {}
    if isinstance(experiment, Tangential):
        chain = _chain(scene, settings, phase)
        way = stops(experiment, chain)
        found = chain.at_end(way)
        return found | {"contact_radius": radius(way[-1][0]) if found["normal_force"] > 0.0 else 0.0}
    row = _Row(estimate, phase, deepest)
    if isinstance(experiment, Load):
        place = row.crossing(experiment.force)
        return {"displacement": place, "contact_radius": radius(place)}
    if not scene.adheres:
        return {"largest_force": row.force(deepest)}
    place, tension = row.largest_tension()
    zero = row.crossing(0.0)
    return {"adhesion_force": tension, "critical_radius": radius(place), "zero_load_radius": radius(zero)}


def _chain(scene: Scene, settings: Settings, phase: float) -> Sliders:
    """The particles with friction of a chain that stands so; under a small load the nearest ones carry all of it."""
    estimate = settings.estimate
    edge = float(estimate.gap[int(estimate.force.argmin())])
    widest = estimate.half_width(OVER_DEEPEST * settings.largest_displacement, edge)
    reach = min(max(widest, FEWEST * estimate.spacing), scene.bodies.reach)
    return sliders_of(scene, places_within(reach, estimate.spacing, phase))


class _Row:
    """The sum over particles whose apex stands at a phase between two of them."""

    def __init__(self, estimate: ContactEstimate, phase: float, deepest: float) -> None:
        """Keep places and heights [LU] of particles within reach at the deepest displacement, and which is whose."""
        self.estimate = estimate
        reach = estimate.half_width(deepest, float(estimate.gap[-1]))
        self.x = places_within(reach, estimate.spacing, phase)
        heights = estimate.rest + estimate.profile.height(np.abs(self.x))
        self.heights, self.own = np.unique(heights, return_inverse=True)
        self.lowest = estimate.rest - float(estimate.gap[-1])
        self.highest = deepest + OVERREACH * (abs(deepest) + estimate.spacing)

    def forces(self, displacements: Array) -> Array:
        """F(d) [FU] at each of the displacements [LU]."""
        each = np.interp(self.heights[:, None] - displacements, self.estimate.gap, self.estimate.force, right=0.0)
        return np.asarray(np.ascontiguousarray(each.T[:, self.own]).sum(axis=1))

    def profile(self, displacement: float) -> Profile:
        """Forces [FU] in place of pressures at a displacement [LU], and particles beside the contact."""
        each = np.interp(self.heights - displacement, self.estimate.gap, self.estimate.force, right=0.0)[self.own]
        beside = self.estimate.spacing * np.arange(1, 3)
        x = np.concatenate([self.x[0] - beside[::-1], self.x, self.x[-1] + beside])
        none = np.zeros_like(x)
        return Profile(x, none, none, np.pad(each, 2), none)

    def force(self, displacement: float) -> float:
        """F(d) [FU] at a displacement [LU]."""
        return float(self.forces(np.asarray([displacement]))[0])

    def largest_tension(self) -> tuple[float, float]:
        """(displacement [LU], tension [FU]) where the tension is largest."""
        low, high = self.lowest, self.highest
        for points in POINTS:
            places, step = np.linspace(low, high, points, retstep=True)
            forces = self.forces(places)
            top = int(np.argmin(forces))
            low, high = float(places[top] - step), float(places[top] + step)
        place, tension = float(places[top]), -float(forces[top])
        return place if self.estimate.snaps else self._vertex(place), tension

    def _vertex(self, near: float) -> float:
        """The place of the largest tension by a polynomial through WIDE steps on both sides of `near` [LU].

        The estimate is a row of straight lines, whose corners would place a flat top by chance.
        """
        width = WIDE * (self.highest - self.lowest) / POINTS[0]
        t = np.linspace(-1.0, 1.0, POINTS[-1])
        best, _ = lowest_minimum(fitting(t, DEGREE) @ self.forces(near + width * t), -1.0, 1.0)
        return near if np.isnan(best) else near + width * best

    def crossing(self, force: float) -> float:
        """Largest displacement [LU] at which the force is `force` [FU]; that of the largest tension if none is."""
        low, high = self.lowest, self.highest
        for points in POINTS:
            places, step = np.linspace(low, high, points, retstep=True)
            below = np.flatnonzero(self.forces(places) < force)
            if below.size == 0:
                return self.largest_tension()[0]
            low = float(places[below[-1]])
            high = low + float(step)
        ends = self.forces(np.asarray([low, high]))
        return float(np.interp(force, ends, [low, high]))
