"""What the model stands for in SI: the bodies' elasticity, and the metres and newtons behind LU and FU.

    1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂,        1/G* = (2 − ν₁)/4G₁ + (2 − ν₂)/4G₂

The stiffness per length of the layer that the two chains make together is E* with the MDR and E*/2 with the reduction
of Geike and Popov (their Eq. 3: c_n = G/2(1 − ν), two equal spheres, E* = G/(1 − ν)). The tangential one is G*/E* of it
(Cattaneo and Mindlin; physics of both: K. L. Johnson, Contact Mechanics, 1985).
"""

from __future__ import annotations

from typing import Annotated, Literal

from annotated_types import Gt, Le
from pydantic import Field

from contact1d.workflow.scene.quantities import Table, Unit

Reduction = Literal["geike_popov", "mdr"]
LAYER_SHARE = {"geike_popov": 0.5, "mdr": 1.0}
"""Stiffness per length of the layer over E*."""
PARABOLA_SHARE = {"geike_popov": 1.0, "mdr": 0.5}
"""Radius of the plane parabola x²/2R₁ over that of the body that it stands for: the MDR takes x²/2R to x²/R."""

Pascal = Annotated[float, Gt(0), Unit("Pa")]
SurfaceEnergy = Annotated[float, Gt(0), Unit("J/m²")]
Metre = Annotated[float, Gt(0), Unit("m")]
Newton = Annotated[float, Gt(0), Unit("N")]
Kilogram = Annotated[float, Gt(0), Unit("kg")]
Poisson = Annotated[float, Gt(-1), Le(0.5), Unit("1")]


class Elastic(Table):
    """An isotropic elastic body."""

    youngs_modulus: Pascal = Field(description="Young's modulus E")
    poisson_ratio: Poisson = Field(description="Poisson's ratio ν")

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

    upper: Elastic | None = Field(default=None, description="the upper body")
    lower: Elastic | None = Field(default=None, description="the lower body")
    contact_modulus: Pascal | None = Field(default=None, description="E*, in place of the two bodies")
    length_unit: Metre | None = Field(default=None, description="one LU in metres; absent: 1, where numbers have units")
    force_unit: Newton | None = Field(
        default=None, description='one FU in newtons, with bodies.bulk_stiffness = "auto"; absent: from the stiffness'
    )
    mass_unit: Kilogram | None = Field(
        default=None, description="one MU in kilograms, for masses, times and velocities with units"
    )
    surface_energy: SurfaceEnergy | None = Field(
        default=None,
        description="γ of one side, half the work of adhesion: both units then follow from the run by JKR (Eq. 9)",
    )

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
