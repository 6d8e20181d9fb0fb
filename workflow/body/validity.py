"""Whether the theory behind a run holds: quantities of a contact against the limits of half-space elasticity.

Slope of the profile at the contact edge: the half-space theory is for small slopes (K. L. Johnson, Contact Mechanics,
1985, section 4.1), and a paraboloid is a ball for a << R only. Tabor parameter: JKR has no range of the attraction
(D. Maugis, 1992). Pressure: a ball yields where p(0) exceeds 1.60 Y (Johnson, section 6.1; ν = 0.3), a cone and a punch
at once. Contact radius over the half-width of the body: the half-space is much wider than the contact. The checks are
for the widest state of a run, that of the pressure for the state of the largest force.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from contact1d.analysis.theory.adhesion import JKR_TABOR, MaugisDugdale, Theory, of_tabor
from contact1d.analysis.theory.indenters import Ellipsoid, PowerLaw
from contact1d.digits import apart, digits_apart
from contact1d.workflow.body.cases import ASSUMED_RANGE, Case
from contact1d.workflow.body.derived import pressures_of
from contact1d.workflow.body.reading import image_ratio
from contact1d.workflow.body.traction import is_of_a_body
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import MEAN_PRESSURE, Quantity, Scales, prefixed

RADII = ("contact_radius", "largest_radius", "zero_load_radius", "critical_radius", "peak_contact_radius")
SINGULAR = ("cone", "flat_punch", "truncated_cone", "truncated_parabola")
"""Profiles with a singular pressure."""
PRESSURES = ("central_pressure", "peak_pressure")


@dataclass(frozen=True)
class Check:
    """A quantity of the contact and its limit.

    Attributes:
        name: name of the warning.
        quantity: symbol of the quantity, as "p(0)/Y".
        value, limit: its value, and the largest one for which the theory holds; for the Tabor parameter the smallest.
        holds: whether the theory holds.
        message: the warning, with the size of the error where it is known.
    """

    name: str
    quantity: str
    value: float
    limit: float
    holds: bool
    message: str

    def entry(self) -> dict[str, Any]:
        """Return "name", "quantity", "value", "limit" and "holds" of the check, as results.json has it.

        The message is left out. A value that is not finite is None.
        """
        value = self.value if math.isfinite(self.value) else None
        return {"name": self.name, "quantity": self.quantity, "value": value, "limit": self.limit, "holds": self.holds}


def checks(scene: Scene, outcome: Outcome, quantities: Mapping[str, Quantity], scales: Scales) -> list[Check]:
    """Return the checks of a run at its widest state, in the order slope, half-width, Tabor parameter, yield.

    Each is left out where it does not apply. [] where no state and no result has a contact radius above 0, and where
    the run represents no axisymmetric body: with noise, in a slide, of a flat profile, on a rigid chain, and with the
    reduction of Geike and Popov, unless two equal spheres stand for it.

    Args:
        scene: the scene of the run.
        outcome: its outcome.
        quantities: its results, of the body, by name.
        scales: sizes of LU and FU in SI.
    """
    if not is_of_a_body(scene):
        return []
    radii = [state.radius.value / image_ratio(scene) for state in outcome.states if state.radius]
    radius = max([*radii, *(quantities[name].value for name in RADII if name in quantities)], default=0.0)
    if radius <= 0.0:
        return []
    case = Case(scene, quantities, scales)
    return [
        *_slope(case, radius), *_half_width(case, radius), *_tabor(case), *_yield(case, outcome), *_similarity(case),
    ]  # fmt: skip


def _similarity(case: Case, limit: float = 0.1) -> Iterator[Check]:
    """Yield one check of |β| of Dundurs in a contact with friction: normal and tangential displacements are coupled.

    Nothing without friction, or where the material is not known. The limit is a convention; the message is there also
    where the check holds.
    """
    scene = case.scene
    if scene.friction is None or scene.material is None or not scene.material.elastic:
        return
    beta = abs(scene.material.dundurs())
    value, most = apart(beta, limit)
    message = (
        f"the bodies are not elastically similar: Dundurs' |β| is {value}, and the theory, which does not couple "
        f"normal and tangential displacements, is exact for 0 and used below {most}"
    )
    yield Check("similarity", "|β|", beta, limit, beta <= limit, message)


def _slope(case: Case, radius: float, limit: float = 0.1) -> Iterator[Check]:
    """Yield one check of the slope of the profile (dimensionless, not transformed) at a contact radius [LU].

    Nothing of a plane body. Of two curved bodies it is the slope of the steeper one; beyond the end of the body that at
    its end. The limit is a convention; the message is there also where it holds.
    """
    profile = case.scene.bodies.profile.steepest
    if profile.is_plane:
        return
    around = np.asarray([1.0 - 1e-6, 1.0]) * min(radius, profile.reach)
    low, high = profile.height(around)
    slope = float((high - low) / np.diff(around)[0])
    value, most = apart(slope, limit)
    message = (
        f"the slope of the profile at the contact edge is {value}, and the theory of the elastic half-space is "
        f"for slopes below {most}{_difference_of_ball(case, radius)}"
    )
    yield Check("slope", "f'(a)", slope, limit, slope <= limit, message)


def _difference_of_ball(case: Case, radius: float) -> str:
    """Return in words how the contact radius of a ball differs from a paraboloid's under the same force.

    The text, to be appended to a sentence, begins with "; " and has the difference in per cent. The force is that of
    the paraboloid at the contact radius [LU], 0 at least. "" for other profiles than a parabola, and for one with a
    counter_radius.
    """
    profile = case.scene.bodies.profile
    if profile.kind != "parabola" or profile.counter_radius is not None:  # two balls are no profile here
        return ""
    r, e, w = case.sphere
    force = max(PowerLaw.sphere(r, e, w).force(radius), 0.0)
    less = 1.0 - Ellipsoid(r, r, e, w).contact_radius(force) / PowerLaw.sphere(r, e, w).contact_radius(force)
    return (
        f"; a ball of this radius has a contact radius {less:.1%} smaller than the paraboloid: profile.kind = "
        '"circle" is the ball'
    )


def _half_width(case: Case, radius: float, limit: float = 0.5) -> Iterator[Check]:
    """Yield one check of a contact radius [LU] over the half-width of the body, dimensionless.

    The half-width of a paraboloid is its radius of curvature. Nothing for any other unbounded body, as a blunt
    cone, and for a body with an edge. The limit is a convention; the message is there also where the check holds.
    """
    profile = case.scene.bodies.profile
    width = profile.half_width
    if width is None or profile.has_edge:
        return
    share = radius / width
    value, most = apart(share, limit)
    message = (
        f"the contact radius is {value} of the half-width of the body, and the theory of the elastic half-space is "
        f"for bodies much wider than the contact, here less than {most}"
    )
    yield Check("body_size", "a/half-width", share, limit, share <= limit, message)


def beyond_jkr(sphere: MaugisDugdale, assumed: bool) -> str:
    """Return a message with the error of JKR's pull-off force for a sphere with a range; "" where JKR holds.

    JKR holds for a Tabor parameter above 5. `assumed`: whether the range is an assumed one, 0.3 nm, which the message
    then says.
    """
    valid = of_tabor(sphere.tabor)
    if valid is Theory.JKR:
        return ""
    error = sphere.theories[Theory.JKR].pull_off_force() / sphere.pull_off_force() - 1.0
    value, limit = apart(sphere.tabor, JKR_TABOR, 2)
    where = f" with an assumed range of the attraction of {prefixed(ASSUMED_RANGE, 'm')}" if assumed else ""
    return (
        f"the Tabor parameter is {value}{where}, where {valid} holds, and JKR above {limit}: the "
        f"results are JKR's, whose pull-off force is {abs(error):.1%} {'larger' if error > 0.0 else 'smaller'} than "
        f"that of Maugis and Dugdale{': give adhesion.range' * assumed}"
    )


def _tabor(case: Case) -> Iterator[Check]:
    """Yield one check that the Tabor parameter of a scene with [adhesion] is one of JKR, above 5.

    Nothing for a profile without an effective radius, or without [adhesion]. With a range in the scene the check always
    holds, as its law is right for any Tabor parameter; without one 0.3 nm is assumed, or nothing is yielded where the
    size of LU is unknown.
    """
    sphere = case.with_range
    if sphere is not None and case.scene.work_of_adhesion:
        message = "" if case.law.range_of(case.scene, 0.0) else beyond_jkr(sphere, True)
        yield Check("tabor", "Tabor parameter", sphere.tabor, JKR_TABOR, not message, message)


def _yield(case: Case, outcome: Outcome, limit: float = 1.6) -> Iterator[Check]:
    """Yield one check of the largest pressure over the yield strength, dimensionless; a ball yields from `limit` on.

    The strength is that of the weaker body; the pressure is the largest one of the results, of the state of the largest
    force, and in closed form of a preload, 0 without any of these. Of a cone and a punch in full contact the value is
    infinite, and the check fails. Nothing where no yield strength is given, or the size of the units in SI is unknown.
    The message is there also where the check holds.
    """
    material, scales = case.scene.material, case.scales
    bodies = () if material is None else material.elastic.values()
    strength = min((body.yield_strength or math.inf for body in bodies), default=math.inf)
    if math.isinf(strength) or not scales.known:
        return
    largest = {"largest": max(outcome.states, key=lambda state: state.force)}
    deepest = pressures_of(case.scene, replace(outcome, marked=largest)).get("largest")
    sources = [deepest.results, case.quantities] if deepest else [case.quantities]
    pressures = [results[name].value for results in sources for name in PRESSURES if name in results]
    if case.radius is not None and "preload" in case.quantities:
        pressures.append(case.body.central_pressure(case.body.contact_radius(case.quantities["preload"].value)))
    pressure = max(pressures, default=0.0) * scales.factor(MEAN_PRESSURE)
    share, digits = pressure / strength, digits_apart(pressure, limit * strength, 4)
    reached = f"the largest pressure is {prefixed(pressure, 'Pa', digits)}"
    shape, radii = case.scene.bodies.profile, (case.quantities[name].value for name in RADII if name in case.quantities)
    if case.kind in SINGULAR or (shape.has_edge and max(radii, default=0.0) >= shape.reach):
        share, reached = math.inf, "a tip or an edge yields at once"
    message = (
        f"{reached}, and a smooth elastic ball yields from {limit:g} times the yield strength on, "
        f"{prefixed(limit * strength, 'Pa', digits)} (Poisson's ratio near 0.3): pressures are those of an elastic body"
    )
    yield Check("yield", "largest pressure/Y", share, limit, share <= limit, message)
