"""The theories of an adhesive contact, JKR, DMT, Maugis and Dugdale: which one holds, and whether a chain is a model.

Radius and force of the body before any run, by the method of dimensionality reduction: with E* per
length, g(x) = |x| ∫ f′/√(x² − r²) dr and Heß's rule at the edge, d = g(a) − √(2πaW/E*),

    F(a) = 2 E* [a d − ∫₀ᵃ g dx]

which is JKR's for a sphere and exact for any axisymmetric body with one contact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

from contact1d.analysis.theory.adhesion import MaugisDugdale, Theory, Verdict, of_tabor, valid_theory
from contact1d.digits import apart
from contact1d.workflow.body.validity import beyond_jkr
from contact1d.workflow.identify.contact import AskedContact
from contact1d.workflow.identify.interaction import LARGEST_RADIUS_SHARE, IdentifyError
from contact1d.workflow.units import prefixed


@dataclass(frozen=True)
class Theories:
    """An adhesive sphere by every theory, in SI.

    Args:
        sphere: the contact with a range of the attraction, by Maugis and Dugdale.
        load: force [N], positive in compression; None: 0.
    """

    sphere: MaugisDugdale
    load: float | None

    @property
    def tabor(self) -> float:
        """The Tabor parameter μ = (R W²/(E*² h₀³))^(1/3) of the sphere, dimensionless, > 0."""
        return self.sphere.tabor

    @cached_property
    def verdict(self) -> Verdict:
        """The simplest theory that holds under the load (0 where none is given), with the reason; cached.

        One of no contact, rigid sphere (Bradley), Hertz, JKR, DMT and Maugis-Dugdale.
        """
        return valid_theory(
            self.tabor, (self.load or 0.0) / (math.pi * self.sphere.work_of_adhesion * self.sphere.radius)
        )

    @cached_property
    def values(self) -> Mapping[str, Mapping[str, float]]:
        """By theory ("JKR", "DMT", "Maugis-Dugdale") pull-off force and contact radii of the sphere in SI; cached.

        Keys are `adhesion_force` [N], a positive magnitude, `zero_load_radius`, `critical_radius` under load control
        and, only with a given load, `loaded_radius` [m].
        """
        return {
            str(name): {
                "adhesion_force": contact.pull_off_force(), "zero_load_radius": contact.zero_load_radius(),
                "critical_radius": contact.critical_radius(),
                **({} if self.load is None else {"loaded_radius": contact.contact_radius(self.load)}),
            }
            for name, contact in self.sphere.theories.items()
        }  # fmt: skip

    @property
    def holding(self) -> str:
        """The theory, as a key of `values`, that holds at any load by the Tabor parameter μ.

        "DMT" below 0.1, "JKR" above 5, else "Maugis-Dugdale".
        """
        return str(of_tabor(self.tabor))


def limitations(contact: AskedContact, theories: Theories) -> dict[str, str]:
    """Return the limitations of a chain as a model of an adhesive sphere: name and message; empty where there are none.

    Names are `below_an_atom` (a₀ below 0.3 nm), `roughness` (above a tenth of the elastic stretch at pull-off) and
    `tabor` (the range, assumed or of two chains, is too large for JKR).

    Raises:
        IdentifyError: a chain is no model of the contact: its roughness exceeds the elastic stretch at pull-off.
    """
    atom = 0.3e-9  # diameter [m]
    held, doubts = theories.values[theories.holding], {}
    if held["zero_load_radius"] < atom:
        doubts["below_an_atom"] = (
            f"the contact is narrower than an atom: {theories.holding} has a zero-load radius of "
            f"{prefixed(held['zero_load_radius'], 'm')}, and an atom's diameter is {prefixed(atom, 'm')}. Continuum "
            "theory does not hold; use an atomistic model"
        )
    # Fuller and Tabor (1975): the pull-off force falls with the roughness over the stretch at which an asperity as
    # blunt as the sphere separates, to about a third at 1 and to zero at 3; sharper asperities separate earlier.
    jkr, roughness = theories.sphere.theories[Theory.JKR], contact.roughness or 0.0
    stretch = -jkr.displacement(jkr.fixed_grips_radius())
    lengths = f"asperities of {prefixed(roughness, 'm')} against an elastic stretch of {prefixed(stretch, 'm')}"
    if roughness > stretch:
        raise IdentifyError(
            f"the surfaces are too rough for the adhesion of a smooth sphere: {lengths} at pull-off, even of an "
            "asperity as blunt as the sphere, so that few asperities adhere at a time (Fuller and Tabor). A scene is "
            f"offered up to a roughness of {_down(stretch)} m"
        )
    if roughness > 0.1 * stretch:
        doubts["roughness"] = f"{lengths} at pull-off: the pull-off force is below that of a smooth sphere"
    assumed = "range" not in contact.given
    if (assumed or contact.is_of_particles) and (words := beyond_jkr(theories.sphere, assumed)):
        doubts["tabor"] = words
    return doubts


def _down(value: float) -> str:
    """Return a value > 0 as text, rounded down to three significant digits, without trailing zeros."""
    digits = 10.0 ** (math.floor(math.log10(value)) - 2)
    return f"{math.floor(value / digits) * digits:.3g}"


def require_size(contact: AskedContact, radius: float) -> None:
    """Check that a contact radius [m] is at most 0.6 of the radius of a sphere; any other body passes.

    Of two curved bodies it is the smaller radius that counts. Nothing is returned.

    Raises:
        IdentifyError: it is larger; the message has the largest share.
    """
    sphere = contact.radius and contact.shape.steepest.curvature_radius
    if sphere and radius > LARGEST_RADIUS_SHARE * sphere:
        share, most = apart(radius / sphere, LARGEST_RADIUS_SHARE, 2)
        raise IdentifyError(
            f"the contact radius is {prefixed(radius, 'm')}, {share} of the sphere's: the "
            f"theory is for a << R, here up to {most}. Use a larger "
            "radius, a larger contact modulus, a smaller load or less attraction"
        )
