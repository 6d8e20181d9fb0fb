"""Whether a chain can stand for a contact: attraction too far-reaching, surfaces too rough, a contact too small."""

from __future__ import annotations

import math

from contact1d.analysis.theory.jkr import Jkr
from contact1d.workflow.identify.contact import AskedContact
from contact1d.workflow.identify.material import LARGEST_RADIUS_SHARE
from contact1d.workflow.identify.target import IdentifyError
from contact1d.workflow.identify.theories import Theories
from contact1d.workflow.units import prefixed

LEAST_TABOR = 0.5
"""Tabor's μ below which no chain is offered: JKR's F_A is there 10 % below that of Maugis and Dugdale."""
ATOM = 0.3e-9
"""Diameter of an atom [m]: a contact that is narrower is none of a continuum."""
ROUGH_SHARE, TOO_ROUGH_SHARE = 0.1, 1.0
"""Roughness over the stretch δ_c at which a summit as blunt as the sphere lets go. Fuller and Tabor (1975): what holds
falls with it, to a third or so at 1 and to nothing at 3; summits that are sharper let go sooner."""


def judged(contact: AskedContact, theories: Theories) -> dict[str, str]:
    """What limits a chain as a stand-in for an adhesive sphere.

    Raises:
        IdentifyError: it cannot stand for it.
    """
    held = theories.values[theories.holding]
    if held["zero_load_radius"] < ATOM:
        raise IdentifyError(
            f"the contact is narrower than an atom: {theories.holding} has a zero-load radius of "
            f"{prefixed(held['zero_load_radius'], 'm')}, and an atom's diameter is {prefixed(ATOM, 'm')}. No continuum "
            "theory and no chain says anything of it; atoms do"
        )
    if theories.tabor < LEAST_TABOR:
        raise IdentifyError(_no_chain(theories))
    doubts = {}
    stretch, roughness = -_let_go(contact), contact.roughness or 0.0
    beside = f"summits of {prefixed(roughness, 'm')} beside a stretch of {prefixed(stretch, 'm')}"
    if roughness > TOO_ROUGH_SHARE * stretch:
        raise IdentifyError(
            f"the surfaces are too rough to hold as a smooth sphere does: {beside} at which even one as blunt as the "
            "sphere lets go, so that most have parted when the last hold (Fuller and Tabor). Up to a roughness of "
            f"{_down(TOO_ROUGH_SHARE * stretch)} m there is a scene"
        )
    if roughness > ROUGH_SHARE * stretch:
        doubts["roughness"] = f"{beside} at which the contact parts: it holds less than a smooth sphere's"
    if theories.holding != "JKR":
        doubts["tabor"] = (
            f"{theories.verdict.reason}. The scene has JKR's law, whose pull-off force is {-theories.jkr_error:.1%} "
            f"below that of {theories.holding} with this range"
        )
    return doubts


def _no_chain(theories: Theories) -> str:
    """That μ is too small, with the values that hold."""
    jkr, dmt = (theories.values[name]["adhesion_force"] for name in ("JKR", "DMT"))
    between = ""
    if theories.holding != "DMT":
        held = theories.values[theories.holding]
        between = (
            f", or nearer {prefixed(held['adhesion_force'], 'N')} and {prefixed(held['zero_load_radius'], 'm')} by "
        )
        between += "Maugis and Dugdale, between it and JKR"
    return (
        f"DMT holds, and no chain stands for it: Tabor's μ is {theories.tabor:.2g}, so that the attraction reaches "
        f"farther than it stretches the bodies. F_A = 2πWR = {prefixed(dmt, 'N')}, a_0 = "
        f"{prefixed(theories.values['DMT']['zero_load_radius'], 'm')}{between}. A chain would have JKR's F_A, "
        f"{prefixed(jkr, 'N')}, which is {-theories.jkr_error:.0%} too small here; from μ = {LEAST_TABOR:g} on there "
        "is a scene"
    )


def _let_go(contact: AskedContact) -> float:
    """Displacement of JKR's sphere where it parts under fixed grips [m], < 0."""
    assert contact.radius is not None
    jkr = Jkr(contact.radius, contact.contact_modulus, contact.work_of_adhesion)
    return float(jkr.displacement(jkr.critical_radius_fixed_grips()))


def _down(value: float) -> str:
    """Three digits, rounded down."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / digits) * digits:.3g}"


def require_size(contact: AskedContact, radius: float) -> None:
    """Refuse a contact under an atom, and one that is wide beside its sphere."""
    if radius < ATOM:
        raise IdentifyError(
            f"the contact radius is {prefixed(radius, 'm')}, less than an atom's diameter: no theory holds"
        )
    if contact.radius is not None and radius > LARGEST_RADIUS_SHARE * contact.radius:
        raise IdentifyError(
            f"the contact radius is {prefixed(radius, 'm')}, {radius / contact.radius:.2g} of the sphere's: the "
            f"theory is for contacts small beside the sphere, here up to {LARGEST_RADIUS_SHARE:g} of it. A larger "
            "radius, a larger contact modulus, a smaller load or less attraction has that"
        )
