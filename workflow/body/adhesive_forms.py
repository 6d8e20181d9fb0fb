"""Closed forms of bodies that adhere to a plane: JKR, its like for other profiles, and a sphere's with a range.

Each says F_A, the radii there and at F = 0, and of a load or the deepest place of a path d, F and a.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.theory.adhesive_power import AdhesivePower
from contact1d.workflow.body.closed_form import Case, ClosedForm
from contact1d.workflow.scene import Cone, FlatPunch, Parabola, Power

Array = NDArray[np.float64]


def _work(case: Case) -> float:
    """W [FU/LU]; 0 without."""
    return 0.0 if case.scene.adhesion is None else case.scene.adhesion.work


def _power(case: Case) -> AdhesivePower:
    profile = case.scene.bodies.profile
    if isinstance(profile, Cone):
        coefficient, exponent = profile.slope, 1.0
    elif isinstance(profile, Power):
        coefficient, exponent = profile.height_there / profile.radius**profile.exponent, profile.exponent
    else:
        assert case.radius is not None
        coefficient, exponent = 0.5 / case.radius, 2.0
    return AdhesivePower(coefficient, exponent, case.contact_modulus, _work(case))


def _values(case: Case) -> Mapping[str, float]:
    body = _power(case)
    said = {
        "adhesion_force": body.pull_off_force(), "critical_radius": body.critical_radius(),
        "zero_load_radius": body.zero_load_radius(),
        "fixed_grips_displacement": body.displacement(body.fixed_grips_radius()),
    }  # fmt: skip
    held = case.force is None or case.force >= -body.pull_off_force()
    reported = body.contact_radius(case.force or 0.0) if held else 0.0
    said["adhesion_energy"] = math.pi * reported**2 * _work(case)
    if isinstance(case.scene.bodies.profile, Parabola) and _reported_radius(case) > 0.0:
        said["central_pressure"] = said["peak_pressure"] = float(_jkr_pressure(case, np.zeros(1))[0])
    if case.force is not None and held:
        a = reported
        said |= {
            "displacement": body.displacement(a), "contact_radius": a, "mean_pressure": case.force / (math.pi * a**2),
        }  # fmt: skip
    return said


def _punch_values(case: Case) -> Mapping[str, float]:
    """F_A = √(8πE*Wa³); before that F = 2E*ad."""
    profile = case.scene.bodies.profile
    assert isinstance(profile, FlatPunch)
    a, e = profile.radius, case.contact_modulus
    said = {"adhesion_force": math.sqrt(8.0 * math.pi * e * _work(case) * a**3)}
    return said if case.force is None else said | {"displacement": case.force / (2.0 * e * a)}


def _reported_radius(case: Case) -> float:
    """a [LU] of the reported state: under a load, at the deepest place of a path, at F = 0; 0 where nothing holds."""
    body, place = _power(case), case.displacement
    if place is not None:
        return body.radius_at(place) if place >= body.displacement(body.fixed_grips_radius()) else 0.0
    force = case.force or 0.0
    return body.contact_radius(force) if force >= -body.pull_off_force() else 0.0


def _jkr_pressure(case: Case, r: Array) -> Array:
    """p = (2E*a/πR) √(1 − r²/a²) − √(2E*W/πa)/√(1 − r²/a²), in the reported state."""
    e, a = case.contact_modulus, _reported_radius(case)
    assert case.radius is not None
    if a == 0.0:
        return np.zeros_like(r)
    root = np.sqrt(np.maximum(1.0 - (r / a) ** 2, 0.0))
    with np.errstate(divide="ignore"):
        tension = math.sqrt(2.0 * e * _work(case) / (math.pi * a)) / root
    return np.where(root > 0.0, 2.0 * e * a / (math.pi * case.radius) * root - tension, 0.0)


def _applies(profile: type, words: str) -> Callable[[Case], str]:
    """Applies to a body of that profile on a plane with an energy of adhesion."""

    def applies(case: Case) -> str:
        return words if isinstance(case.scene.bodies.profile, profile) and _work(case) > 0.0 else ""

    return applies


def _tabor(case: Case) -> float:
    """µ = (R W²/E*² z₀³)^{1/3} of a sphere whose range z₀ the scene knows; 0 of any other."""
    adhesion = case.scene.adhesion
    if adhesion is None or adhesion.range is None or case.radius is None or not _work(case) > 0.0:
        return 0.0
    return math.cbrt(case.radius * (_work(case) / case.contact_modulus) ** 2) / adhesion.range


def _with_a_range(case: Case) -> str:
    """Tabor's number and what follows from it."""
    if (tabor := _tabor(case)) == 0.0 or not isinstance(case.scene.bodies.profile, Parabola):
        return ""
    from contact1d.analysis.theory.tabor import valid_theory  # scipy's solvers take longer than a small run

    verdict = valid_theory(tabor, 0.0)
    return f"a paraboloid with a range; Tabor's number is {tabor:.3g}, where {verdict.theory} holds"


def _values_with_a_range(case: Case) -> Mapping[str, float]:
    """Maugis and Dugdale's results in the scene's units: πWR, and (πWR²/K)^{1/3} with K = 4E*/3."""
    from contact1d.analysis.theory.maugis_dugdale import MaugisDugdale, maugis_parameter_of_tabor

    contact = MaugisDugdale(maugis_parameter_of_tabor(_tabor(case)))
    assert case.radius is not None
    load = math.pi * _work(case) * case.radius
    length = math.cbrt(0.75 * load * case.radius / case.contact_modulus)
    said = {
        "adhesion_force": load * contact.pull_off_load(), "critical_radius": length * contact.critical_radius(),
        "zero_load_radius": length * contact.zero_load_radius(),
    }  # fmt: skip
    if case.force is not None and case.force >= -said["adhesion_force"]:
        a = contact.contact_radius(case.force / load)
        said["contact_radius"] = length * a
        said["displacement"] = length**2 / case.radius * float(contact.displacement(a))
    return said


ADHESIVE = (
    ClosedForm("JKR", "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301",
               _applies(Parabola, "a paraboloid that adheres, without a range"), _values, _jkr_pressure),
    ClosedForm("Maugis and Barquins, cone", "D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981) L95",
               _applies(Cone, "a cone that adheres, without a range"), _values),
    ClosedForm("Popov and Heß, power", "V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, section 4.4",
               _applies(Power, "a power of the radius that adheres, without a range"), _values),
    ClosedForm("Kendall, flat punch", "K. Kendall, J. Phys. D 4 (1971) 1186",
               _applies(FlatPunch, "a flat punch that adheres, without a range"), _punch_values),
    ClosedForm("Maugis and Dugdale", "D. Maugis, J. Colloid Interface Sci. 150 (1992) 243", _with_a_range,
               _values_with_a_range),
)  # fmt: skip
"""Of bodies with [adhesion]."""
