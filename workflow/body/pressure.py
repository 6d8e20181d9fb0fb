"""The pressure p(r) under the body of three dimensions, from the line load of a run; and what else is the body's own.

p(r) is the inverse Abel transform of the line load (`analysis.abel`). Its error: what every second particle alone
would have told, and the edge's. Stiffness: springs E* per length that touch over 2a make dF/dd = 2E*a, which is Galin's
and Sneddon's relation of any axisymmetric body.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.abel import FEWEST, LineLoad, line_load
from contact1d.analysis.held import whole_cells
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.body.closed_form import Case
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.scene.material import WIDER_THAN_SPHERES
from contact1d.workflow.units import ENERGY, LINE_PRESSURE, MEAN_PRESSURE, Quantity

Array = NDArray[np.float64]
MOST = 1000
"""Particles on a side that are used, and radii that p is given at; of more, every second, third …"""
REPORTED = ("deepest", "final", "zero_load")
"""States whose pressure is a result, the first that a run has."""
ERRORS = ("displacement", "contact_radius", "largest_force", "largest_radius", "zero_load_radius")
"""Results whose relative uncertainty, that of the lattice included, is the pressure's, too."""
TIP, KINK = 1e-3, 0.5
"""A profile has an apex where so little of a spacing off the axis its slope is that share of the one to a spacing."""
PERIODIC = ("flat",)
"""Profiles of no body that ends."""


@dataclass(frozen=True, eq=False)
class BodyPressure:
    """p(r) of one state; arrays (n,).

    Attributes:
        r: from 0 (under an apex, where p has no bound, from the first particle) to the last particle inside [LU].
        pressure: compression positive [FU/LU²].
        uncertainty: of it [FU/LU²].
        contact_radius: of the body [LU]; where bodies attract, tension reaches beyond it.
    """

    r: Array
    pressure: Array
    uncertainty: Array
    contact_radius: float


def is_of_a_body(scene: Scene) -> bool:
    """Whether the line load of a run is that of a body of three dimensions, and known without noise."""
    bodies = scene.bodies
    stands = bodies.reduction == "mdr" or stands_for_spheres(scene)
    one_body = bodies.profile.kind not in PERIODIC and bodies.lower in ("particles", "rigid_plane")
    return stands and one_body and scene.noise is None and not isinstance(scene.experiment, Slide)


def body_pressures(scene: Scene, profiles: Mapping[str, Profile]) -> dict[str, BodyPressure]:
    """p(r) of the reported states in which the bodies touch over a width; none where there is no body for them."""
    if not is_of_a_body(scene):
        return {}
    rule = RadiusRule(scene, scene.accuracy.tolerance)
    found = {}
    for name, profile in profiles.items():
        radius = rule.of(profile)
        if radius is not None and radius.value > 0.0 and (made := _pressure(scene, profile, radius)) is not None:
            found[name] = made
    return found


def _pressure(scene: Scene, profile: Profile, radius: ContactRadius) -> BodyPressure | None:
    """p(r) of a state; None where too few particles carry it, or they do not stand alike on both sides."""
    wider = WIDER_THAN_SPHERES if stands_for_spheres(scene) else 1.0
    held = scene.adhesion is not None and scene.adheres
    x, q = profile.x / wider, wider * (whole_cells(profile, radius) if held else profile.pressure)
    jumps = scene.bodies.profile.has_edge or held
    edge = radius.value / wider if jumps or scene.interaction is None else None
    tip, beside = scene.bodies.height(np.array([TIP, 1.0]) * scene.bodies.spacing)
    apex = bool(tip > KINK * TIP * beside)
    side = x[x.size // 2 :]
    stride = -(-side.size // MOST)
    try:
        fine = _load(x, q, stride, edge, jumps, apex)
    except ValueError:
        return None
    inside = side[:: -(-side.size // MOST)]
    inside = inside[(inside > 0.0) & (inside < fine.edge * (1.0 - 1e-9))]
    r = inside if fine.has_apex else np.concatenate([[0.0], inside])
    p = fine.pressure(r)
    try:
        spread = np.abs(p - _load(x, q, 2 * stride, edge, jumps, apex).pressure(r))
    except ValueError:
        spread = np.abs(p)
    spread = np.where(np.isfinite(spread), spread, np.abs(p))
    relative = radius.uncertainty / radius.value
    return BodyPressure(r, p, spread + relative * np.abs(p), radius.value / wider)


def _load(x: Array, q: Array, stride: int, edge: float | None, jumps: bool, apex: bool) -> LineLoad:
    """The line load through every `stride`-th particle on either side. Raises ValueError as `line_load`."""
    half = x.size // 2
    if -(-(x.size - half) // stride) < FEWEST:
        raise ValueError("too few particles")
    right = np.arange(half, x.size)[::stride]
    left = x.size - 1 - right[::-1]
    chosen = np.concatenate([left[left < right[0]], right])
    return line_load(x[chosen], q[chosen], edge, ends_at_zero=not jumps, apex=apex)


def _at(pressure: BodyPressure, place: int, unknown: float) -> Quantity:
    """The pressure at one place; `unknown`: relative, what it is uncertain by besides."""
    p = float(pressure.pressure[place])
    return Quantity(p, float(pressure.uncertainty[place]) + unknown * abs(p), MEAN_PRESSURE)


def with_body(scene: Scene, outcome: Outcome) -> Outcome:
    """The outcome with what is the body's own: p(0), the largest pressure, stiffness, energy of adhesion.

    `peak_pressure` is left out where the pressure has no bound: at a cone's tip, at a flat punch's edge.
    """
    if not is_of_a_body(scene):
        return outcome
    found = outcome.quantities
    made: dict[str, Quantity] = {}
    unknown = sum(
        found[name].uncertainty / abs(found[name].value) for name in ERRORS if name in found and found[name].value
    )
    state = next((name for name in REPORTED if name in outcome.profiles), "")
    if state and (pressure := body_pressures(scene, {state: outcome.profiles[state]}).get(state)):
        bounded = pressure.r[0] == 0.0
        if bounded:
            made["central_pressure"] = _at(pressure, 0, unknown)
        if bounded and not scene.bodies.profile.has_edge:
            made["peak_pressure"] = _at(pressure, int(pressure.pressure.argmax()), unknown)
    force = found.get("force") or found.get("largest_force")
    radius = found.get("contact_radius") or found.get("largest_radius")
    if radius is not None and force is not None and radius.value > 0.0:
        if "mean_pressure" not in found:
            mean = force.value / (math.pi * radius.value**2)
            share = 2.0 * radius.uncertainty / radius.value + force.uncertainty / max(abs(force.value), 1e-300)
            made["mean_pressure"] = Quantity(mean, abs(mean) * share, MEAN_PRESSURE)
        if scene.interaction is None and Case(scene, found).is_elastic:
            layer = scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
            made["contact_stiffness"] = Quantity(
                2.0 * layer * radius.value, 2.0 * layer * radius.uncertainty, LINE_PRESSURE
            )
    width = found.get("zero_load_radius") or found.get("contact_radius")
    if width is not None and scene.adhesion is not None:
        energy = math.pi * width.value**2 * scene.adhesion.work
        made["adhesion_energy"] = Quantity(energy, 2.0 * energy * width.uncertainty / max(width.value, 1e-300), ENERGY)
    elif width is not None and "separation_energy" in found:
        line = found["separation_energy"]
        made["adhesion_energy"] = Quantity(
            2.0 * width.value * line.value,
            2.0 * (width.value * line.uncertainty + width.uncertainty * line.value),
            ENERGY,
        )
    return replace(outcome, derived={**outcome.derived, **made})
