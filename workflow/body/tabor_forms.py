"""Which theory is laid beside a sphere that an interaction holds, by Tabor's μ: JKR, Maugis and Dugdale, or DMT.

W is what the interaction implies (`implied`), z₀ its force-free distance; μ = (R W²/E*² z₀³)^{1/3} above 5 is JKR,
below 0.1 DMT, between them Maugis and Dugdale.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from contact1d.analysis.theory.dmt import Dmt
from contact1d.analysis.theory.jkr import Jkr
from contact1d.workflow.body.closed_form import Case, ClosedForm
from contact1d.workflow.scene import Parabola

JKR_ABOVE, DMT_BELOW = 5.0, 0.1
"""Tabor's μ beyond which a limit holds (`analysis.theory.tabor`)."""
MAUGIS_UNIT = 4.0 / 3.0
"""K/E*."""


def _work(case: Case) -> float | None:
    """W [FU/LU] that the interaction implies, at the radius that the run found."""
    return float(case.quantities["work_of_adhesion"]) if "work_of_adhesion" in case.quantities else None


def tabor(case: Case) -> float | None:
    """μ of a sphere with an interaction; None for anything else."""
    terms, radius, work = case.scene.interaction, case.radius, _work(case)
    if terms is None or terms.attraction is None or radius is None or not work:
        return None
    a, b = terms.repulsion.range, terms.attraction.range
    force_free = math.log(terms.repulsion.amplitude * b / (terms.attraction.amplitude * a)) * a * b / (b - a)
    return math.cbrt(radius * work**2 / (case.contact_modulus**2 * force_free**3))


def _is_sphere(case: Case) -> bool:
    """Whether a paraboloid was transformed, so that E* and R are its own, and no noise hides what it does."""
    bodies, scene = case.scene.bodies, case.scene
    alone = not (scene.neighbours or scene.noise)
    return isinstance(bodies.profile, Parabola) and bodies.reduction == "mdr" and alone and scene.adheres


def _by_tabor(holds: Callable[[float], bool]) -> Callable[[Case], str]:
    def applies(case: Case) -> str:
        mu = tabor(case)
        if not _is_sphere(case) or mu is None or not holds(mu):
            return ""
        return f"Tabor's μ = {mu:.3g}, with the W that the interaction implies and its force-free distance as range"

    return applies


def _jkr(case: Case) -> Jkr:
    radius, work = case.radius, _work(case)
    assert radius is not None
    assert work is not None
    return Jkr(radius, case.contact_modulus, work)


def _jkr_values(case: Case) -> Mapping[str, float]:
    body = _jkr(case)
    said = {
        "adhesion_force": body.pull_off_force(), "zero_load_radius": body.zero_load_radius(),
        "critical_radius": body.critical_radius(),
    }  # fmt: skip
    if case.force is not None and case.force > -body.pull_off_force():
        a = float(body.contact_radius(case.force))
        said |= {"contact_radius": a, "displacement": float(body.displacement(a))}
    return said


def _dmt_values(case: Case) -> Mapping[str, float]:
    jkr = _jkr(case)
    body = Dmt(jkr.radius, jkr.contact_modulus, jkr.work_of_adhesion)
    said = {"adhesion_force": body.pull_off_force(), "zero_load_radius": body.zero_load_radius()}
    if case.force is not None and case.force > -body.pull_off_force():
        a = float(body.contact_radius(case.force))
        said |= {"contact_radius": a, "displacement": float(body.displacement(a))}
    return said


def _maugis_values(case: Case) -> Mapping[str, float]:
    """In the units of Maugis: a/(πWR²/K)^{1/3}, F/πWR."""
    from contact1d.analysis.theory.maugis_dugdale import MaugisDugdale, maugis_parameter_of_tabor

    mu, sphere = tabor(case), _jkr(case)
    assert mu is not None
    body, R, W = MaugisDugdale(maugis_parameter_of_tabor(mu)), sphere.radius, sphere.work_of_adhesion
    length = math.cbrt(math.pi * W * R**2 / (MAUGIS_UNIT * sphere.contact_modulus))
    force = math.pi * W * R
    said = {
        "adhesion_force": force * body.pull_off_load(), "zero_load_radius": length * body.zero_load_radius(),
        "critical_radius": length * body.critical_radius(),
    }  # fmt: skip
    if case.force is not None and case.force > -force * body.pull_off_load():
        said["contact_radius"] = length * body.contact_radius(case.force / force)
    return said


JKR_SOURCE = "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301"
BY_TABOR = (
    ClosedForm("JKR", JKR_SOURCE, _by_tabor(lambda mu: mu > JKR_ABOVE), _jkr_values),
    ClosedForm("Maugis-Dugdale", "D. Maugis, J. Colloid Interface Sci. 150 (1992) 243",
               _by_tabor(lambda mu: DMT_BELOW <= mu <= JKR_ABOVE), _maugis_values),
    ClosedForm("DMT", "B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314",
               _by_tabor(lambda mu: mu < DMT_BELOW), _dmt_values),
)  # fmt: skip
"""Of spheres that an interaction holds."""
