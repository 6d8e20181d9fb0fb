"""Closed forms of bodies pressed on a plane without adhesion: Hertz, Sneddon, Galin (`analysis.theory.sneddon`).

Under a given force F they say d, a, F/πa², p(0) and dF/dd = 2E*a; at a given displacement F, a and the pressures.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.theory import sneddon
from contact1d.workflow.body.closed_form import Case, ClosedForm
from contact1d.workflow.scene import Circle, Cone, Ellipsoid, FlatPunch, Parabola, Power

Array = NDArray[np.float64]
HALVINGS = 120
"""Of the bracket of a radius: below round-off. (`scipy.optimize` takes longer to import than a small run.)"""
INSIDE = 1.0 - 1e-12
"""Of a sphere's radius, up to which its contact is looked for: the transform has no bound at the rim."""
POINTS = 200
"""Of Gauss's quadrature of a smooth function: its error is below round-off."""


class Indenter(Protocol):
    """d and F of a contact radius a."""

    def displacement(self, contact_radius: Any) -> Any:
        """d(a) [LU]."""

    def force(self, contact_radius: Any) -> Any:
        """F(a) [FU]."""


def _contact_radius(case: Case, indenter: Indenter, reach: float = math.inf) -> float:
    """a [LU] of the reported state, from its force or its displacement; `reach`: what it is below [LU]."""
    if case.force is not None:
        curve, wanted = indenter.force, case.force
    else:
        curve, wanted = indenter.displacement, case.displacement or 0.0
    if not wanted > 0.0:
        return 0.0
    low, high = 0.0, min(case.scene.bodies.spacing, reach)
    while high < reach and float(curve(high)) < wanted:
        high = min(2.0 * high, reach)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(curve(middle)) < wanted else (low, middle)
    return 0.5 * (low + high)


def _said(case: Case, a: float, d: float, force: float, central: float | None = None) -> dict[str, float]:
    """What is known of a contact with a [LU], d [LU], F [FU], p(0) [FU/LU²]."""
    said = {
        "displacement": d, "force": force, "contact_radius": a, "largest_force": force, "largest_radius": a,
        "contact_stiffness": 2.0 * case.contact_modulus * a,
    }  # fmt: skip
    if a > 0.0:
        said["mean_pressure"] = force / (math.pi * a**2)
    if central is not None:
        said |= {"peak_pressure": central, "central_pressure": central}
    # what the scene gives is no prediction
    given = ("force",) if case.force is not None else ("displacement",)
    return {name: value for name, value in said.items() if name not in given}


def _power(case: Case) -> sneddon.PowerLaw:
    profile = case.scene.bodies.profile
    if isinstance(profile, Cone):
        return sneddon.cone(profile.slope, case.contact_modulus)
    if isinstance(profile, Power):
        coefficient = profile.height_there / profile.radius**profile.exponent
        return sneddon.PowerLaw(coefficient, profile.exponent, case.contact_modulus)
    assert case.radius is not None
    return sneddon.paraboloid(case.radius, case.contact_modulus)


def _power_values(case: Case) -> Mapping[str, float]:
    """p(0) = E* κ_n c a^{n−1}/π · n/(n−1) for n > 1; a cone's has no bound."""
    body = _power(case)
    a, n = _contact_radius(case, body), body.exponent
    central = None
    if n > 1.0:
        rise = sneddon.galin_factor(n) * body.coefficient * a ** (n - 1.0)
        central = case.contact_modulus * rise * n / (math.pi * (n - 1.0))
    return _said(case, a, float(body.displacement(a)), float(body.force(a)), central)


def _hertz_pressure(case: Case, r: Array) -> Array:
    """p₀ √(1 − r²/a²), p₀ = 2E*a/πR."""
    assert case.radius is not None
    a = _contact_radius(case, _power(case))
    peak = 2.0 * case.contact_modulus * a / (math.pi * case.radius)
    return peak * np.sqrt(np.maximum(0.0, 1.0 - (r / a) ** 2))


def _cone_pressure(case: Case, r: Array) -> Array:
    profile = case.scene.bodies.profile
    assert isinstance(profile, Cone)
    a = _contact_radius(case, _power(case))
    return sneddon.cone_pressure(np.maximum(r, 1e-12 * a), a, profile.slope, case.contact_modulus)


@dataclass(frozen=True)
class _Round:
    """A whole sphere of radius c, `flat` times as high: d and F of the sphere times that."""

    sphere: sneddon.Sphere
    flat: float

    def displacement(self, contact_radius: Any) -> Any:
        """(b/c) a artanh(a/c)."""
        return self.flat * self.sphere.displacement(contact_radius)

    def force(self, contact_radius: Any) -> Any:
        """(b/c) E* [(c² + a²) artanh(a/c) − ac]."""
        return self.flat * self.sphere.force(contact_radius)


def _round(case: Case) -> _Round:
    profile = case.scene.bodies.profile
    if isinstance(profile, Ellipsoid):
        body = sneddon.Sphere(profile.radius, case.contact_modulus)
        return _Round(body, profile.half_axis / profile.radius)
    assert case.radius is not None
    return _Round(sneddon.Sphere(case.radius, case.contact_modulus), 1.0)


def _round_values(case: Case) -> Mapping[str, float]:
    """p(0) = (E*/π) (b/c) ∫₀^a g′/x dx, g′ = artanh(x/c) + xc/(c² − x²): by quadrature, its first part has no form."""
    body = _round(case)
    c = body.sphere.radius
    a = _contact_radius(case, body, INSIDE * c)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    x = 0.5 * a * (nodes + 1.0)
    rate = body.flat * 0.5 * a * float(weights @ (np.arctanh(x / c) / x + c / (c**2 - x**2)))
    return _said(case, a, float(body.displacement(a)), float(body.force(a)), case.contact_modulus / math.pi * rate)


def _punch_values(case: Case) -> Mapping[str, float]:
    """F = 2E*ad, p(0) = E*d/πa; at its edge the pressure has no bound."""
    profile = case.scene.bodies.profile
    assert isinstance(profile, FlatPunch)
    a, e = profile.radius, case.contact_modulus
    d = case.force / (2.0 * e * a) if case.force is not None else max(case.displacement or 0.0, 0.0)
    said = _said(case, a, d, 2.0 * e * a * d) | {"central_pressure": e * d / (math.pi * a)}
    return {name: value for name, value in said.items() if name not in ("contact_radius", "largest_radius")}


def _punch_pressure(case: Case, r: Array) -> Array:
    profile = case.scene.bodies.profile
    assert isinstance(profile, FlatPunch)
    d = (case.force or 0.0) / (2.0 * case.contact_modulus * profile.radius) or case.displacement or 0.0
    return sneddon.FlatPunch(profile.radius, case.contact_modulus).pressure(r, d)


def _elastic(profile: type, words: str) -> Callable[[Case], str]:
    """Applies to a body of that profile, pressed and nothing else, whose reduction keeps it."""

    def applies(case: Case) -> str:
        bodies = case.scene.bodies
        stands = bodies.reduction == "mdr" or (case.radius is not None and case.scene.interaction is None)
        pressed = case.force is not None or case.displacement is not None
        return words if isinstance(bodies.profile, profile) and stands and pressed and case.is_elastic else ""

    return applies


INDENTERS = (
    ClosedForm("Hertz", "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, section 4.2",
               _elastic(Parabola, "a paraboloid, pressed without adhesion"), _power_values, _hertz_pressure),
    ClosedForm("Sneddon, cone", "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47",
               _elastic(Cone, "a cone, pressed without adhesion"), _power_values, _cone_pressure),
    ClosedForm("Sneddon, flat punch", "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47",
               _elastic(FlatPunch, "a flat punch, pressed without adhesion"), _punch_values, _punch_pressure),
    ClosedForm("Sneddon, sphere", "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47",
               _elastic(Circle, "a whole sphere, pressed without adhesion"), _round_values),
    ClosedForm("Sneddon, ellipsoid", "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47: his sphere, flattened",
               _elastic(Ellipsoid, "a whole ellipsoid, pressed without adhesion"), _round_values),
    ClosedForm("Galin, power", "L. A. Galin 1953; I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47",
               _elastic(Power, "a power of the radius, pressed without adhesion"), _power_values),
)  # fmt: skip
"""Of bodies pressed on a plane or on a body that repels only."""
