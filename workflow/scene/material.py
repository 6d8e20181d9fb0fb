"""What the model stands for: elasticity, the reduction to a plane model, and the metres and newtons behind LU and FU.

    1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂,        1/G* = (2 − ν₁)/4G₁ + (2 − ν₂)/4G₂

The stiffness per length of the layer that the two chains make together is E* with the MDR and E*/2 with the reduction
of Geike and Popov (their Eq. 3: c_n = G/2(1 − ν), two equal spheres, E* = G/(1 − ν)). The tangential one is G*/E* of it
(Cattaneo and Mindlin; physics of both: K. L. Johnson, Contact Mechanics, 1985).

The paper's reduction takes the profile as drawn, z = c xⁿ, with the layer c_n. Under a force F it is wide

    a = [(n + 1) F/(n c E*)]^{1/(n+1)},     the body of that profile on a plane (Galin; κ_n in `profiles`) has
    a = [(n + 1) F/(2 n κ_n c E*)]^{1/(n+1)}

so that the image is (2κ_n)^{1/(n+1)} times as wide and has the inverse square of that as mean pressure. For two equal
spheres, for which it was derived, force and displacement are theirs, and the image is 2 times as wide.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

from contact1d.workflow.scene.profiles import galin_factor
from contact1d.workflow.scene.quantities import (
    Kilogram,
    Metre,
    Newton,
    Pascal,
    Poisson,
    SurfaceEnergy,
    Table,
)

Reduction = Literal["geike_popov", "mdr"]
LAYER_SHARE = {"geike_popov": 0.5, "mdr": 1.0}
"""Stiffness per length of the layer over E*."""
PARABOLA_SHARE = {"geike_popov": 1.0, "mdr": 0.5}
"""Radius of the plane parabola x²/2R₁ over that of the body that it stands for: the MDR takes x²/2R to x²/R."""

SPHERES = ("parabola", "circle")
"""Profiles of which two make the pair of spheres of the paper."""
ALIKE = ("flat_punch", "flat")
"""Profiles that both reductions leave as they are: in model units, where springs are given, nothing differs."""
WIDER_THAN_SPHERES = 2.0
"""Half-width of the paper's image over the contact radius of its two equal spheres."""


class Elastic(Table):
    """An isotropic elastic body."""

    youngs_modulus: Pascal
    """Young's modulus E"""
    poisson_ratio: Poisson
    """Poisson's ratio ν"""

    @property
    def compliance(self) -> float:
        """(1 − ν²)/E [1/Pa]."""
        return (1.0 - self.poisson_ratio**2) / self.youngs_modulus

    @property
    def tangential_compliance(self) -> float:
        """(2 − ν)/4G = (2 − ν)(1 + ν)/2E [1/Pa]."""
        return (2.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio) / (2.0 * self.youngs_modulus)


class Material(Table):
    """What the model stands for in SI: elasticity, and either the units or the surface energy."""

    upper: Elastic | None = None
    """the upper body"""
    lower: Elastic | None = None
    """the lower body"""
    contact_modulus: Pascal | None = None
    """E*, in place of the two bodies"""
    length_unit: Metre | None = None
    """one LU in metres; absent: 1, where numbers have units"""
    force_unit: Newton | None = None
    """one FU in newtons, with bodies.bulk_stiffness = "auto"; absent: from the stiffness"""
    mass_unit: Kilogram | None = None
    """one MU in kilograms, for masses, times and velocities with units"""
    surface_energy: SurfaceEnergy | None = None
    """γ of one side, half the work of adhesion: both units then follow from the run by JKR (Eq. 9)"""

    def effective_modulus(self) -> float:
        """E* [Pa]."""
        if self.contact_modulus is not None:
            return self.contact_modulus
        assert self.upper is not None
        assert self.lower is not None
        return 1.0 / (self.upper.compliance + self.lower.compliance)

    def tangential_share(self) -> float:
        """G*/E*; 1 where only E* is known, so that the bulk springs are the same in both directions."""
        if self.upper is None or self.lower is None:
            return 1.0
        normal = self.upper.compliance + self.lower.compliance
        return normal / (self.upper.tangential_compliance + self.lower.tangential_compliance)

    def layer_stiffness(self, reduction: Reduction) -> float:
        """Stiffness per length of the layer that both chains make [Pa]."""
        return LAYER_SHARE[reduction] * self.effective_modulus()


def default_reduction(has_material: bool, lower: str, profile: str) -> Reduction:
    """The reduction of a scene that names none: the paper's for its own plane model alone."""
    return "mdr" if has_material or lower == "rigid_plane" or profile != "parabola" else "geike_popov"


def wider_than_body(profile: Mapping[str, Any]) -> float | None:
    """Half-width of the paper's image over the contact radius of that body on a plane, under the same force.

    Args:
        profile: with the keys of a scene file. Of a circle or an ellipsoid the factor is that of its parabola.

    Returns:
        (2κ_n)^{1/(n+1)}; None where no closed form tells.
    """
    exponents = {"cone": 1.0, "parabola": 2.0, "circle": 2.0, "ellipsoid": 2.0, "power": profile.get("exponent")}
    n = exponents.get(str(profile.get("kind")))
    if isinstance(n, bool) or not isinstance(n, int | float) or not n >= 1.0:
        return None
    return float((2.0 * galin_factor(n)) ** (1.0 / (n + 1.0)))
