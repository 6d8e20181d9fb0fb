"""The case of a finished run: the quantities from which a closed form makes its predictions.

F [FU], d [LU], a [LU]: force, compression positive, displacement and contact radius; E* is the contact modulus
[FU/LU²], R the radius of curvature [LU], W the work of adhesion [FU/LU], h₀ the range of the attraction [LU].
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from contact1d.analysis.theory.adhesion import MaugisDugdale
from contact1d.analysis.theory.indenters import Ellipsoid, FlatPunch, PowerLaw
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.law import Law
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.tables import SPHERES
from contact1d.workflow.units import UNKNOWN, Quantity, Scales

Values = dict[str, float]
ASSUMED_RANGE = 0.3e-9
"""Range h₀ [m] of an adhesion whose scene has none: an interatomic distance, typical of solids."""


@dataclass(frozen=True)
class Case:
    """Body, load and results of a finished run, in units of the model.

    Attributes:
        scene: the scene of the run.
        quantities: its results, of the body, by name.
        scales: LU and FU in SI, for the range that is assumed where the scene has none.
    """

    scene: Scene
    quantities: Mapping[str, Quantity]
    scales: Scales = UNKNOWN

    @property
    def contact_modulus(self) -> float:
        """E* [FU/LU²] of the body: that of the layer, c = k/χh, with the MDR; 2c with the paper's reduction."""
        layer = self.scene.bulk_stiffness / (self.scene.chains * self.scene.bodies.spacing)
        return layer if self.scene.bodies.reduction == "mdr" else 2.0 * layer

    @property
    def radius(self) -> float | None:
        """Effective radius R [LU] of a sphere on a plane, or of the paper's two equal spheres, R/2.

        None where the profile has no radius of curvature, and with the paper's reduction for any other body.
        """
        curvature = self.scene.bodies.profile.curvature_radius
        if curvature is None or self.scene.bodies.reduction == "mdr":
            return curvature
        return 0.5 * curvature if self.kind in SPHERES else None

    @property
    def kind(self) -> str:
        """The kind of the profile, as a scene has it: "parabola", "cone", "power", …"""
        return self.scene.bodies.profile.kind

    @property
    def force(self) -> float | None:
        """F [FU], compression positive, of the reported state; None where the run has no result "force".

        None also with adhesion where displacements are given: a force has two displacements, so that it determines no
        state.
        """
        if self.law.attracts(self.scene) and self.scene.experiment.places():
            return None
        return float(self.quantities["force"].value) if "force" in self.quantities else None

    @property
    def displacement(self) -> float | None:
        """d [LU] of the reported state where the scene gives it; None where it does not, or `force` is known.

        Of a path it is the largest, of `tangential` the last.
        """
        displacements = self.scene.experiment.places()
        if not displacements or self.force is not None:
            return None
        if "displacement" in self.quantities:
            return float(self.quantities["displacement"].value)
        return displacements[-1] if self.scene.experiment.goes_along else max(displacements)

    @property
    def work(self) -> float:
        """Work of adhesion W [FU/LU]: given, or implied by the interaction at the resulting radius.

        0 without adhesion.
        """
        implied = self.quantities.get("work_of_adhesion")
        return self.scene.work_of_adhesion if implied is None else float(implied.value)

    @property
    def range(self) -> float:
        """Range h₀ of the attraction [LU]: of the scene, or assumed as 0.3 nm.

        0 without attraction, or where LU is unknown. For an interaction it is that of Lennard-Jones surfaces with its
        force-free distance.
        """
        return self.law.range_of(self.scene, ASSUMED_RANGE / self.scales.length if self.scales.known else 0.0)

    @property
    def law(self) -> type[Law]:
        """The contact law of the scene, as a class."""
        return law_of(self.scene)

    @property
    def is_elastic(self) -> bool:
        """Whether the contact has linear springs alone: no attraction, no memory, no other effects."""
        return self.scene.keeps_springs and "pressed" in self.law.closed_forms and not self.law.attracts(self.scene)

    @property
    def sphere(self) -> tuple[float, float, float]:
        """(R [LU], E* [FU/LU²], W [FU/LU]) of a sphere, which the body must be."""
        assert self.radius is not None
        return self.radius, self.contact_modulus, self.work

    @property
    def with_range(self) -> MaugisDugdale | None:
        """The contact of an adhesive sphere whose attraction has a range, by Maugis and Dugdale.

        None for anything else.
        """
        if self.radius is None or not (self.work > 0.0 and self.range > 0.0):
            return None
        return MaugisDugdale(*self.sphere, self.range)

    @cached_property
    def body(self) -> PowerLaw | Ellipsoid:
        """The contact, in closed form, of a cone, a power, an ellipsoid or a circle.

        Of any other profile that of a paraboloid. With W where it adheres, without a range. The profile must then have
        a radius of curvature.
        """
        profile: Any = self.scene.bodies.profile
        if self.kind == "cone":
            return PowerLaw(profile.rise, 1.0, self.contact_modulus, self.work)
        if self.kind == "power":
            factor = profile.height_there / profile.radius**profile.exponent
            return PowerLaw(factor, profile.exponent, self.contact_modulus, self.work)
        if self.kind == "ellipsoid":
            return Ellipsoid(profile.radius, profile.half_axis, self.contact_modulus, self.work)
        radius, modulus, work = self.sphere
        if self.kind == "circle":
            return Ellipsoid(radius, radius, modulus, work)
        return PowerLaw.sphere(radius, modulus, work)

    @cached_property
    def contact_radius(self) -> float:
        """a [LU] of the reported state by its force or displacement, without one at F = 0; 0 of separated bodies."""
        try:
            if self.displacement is not None:
                return self.body.radius_at(self.displacement)
            return self.body.contact_radius(self.force or 0.0)
        except ValueError:
            return 0.0

    @cached_property
    def punch(self) -> tuple[FlatPunch, float]:
        """(Contact of a flat punch, its d [LU] ≥ 0 or F over its stiffness); d is 0 where neither is given."""
        profile: Any = self.scene.bodies.profile
        punch = FlatPunch(profile.radius, self.contact_modulus, self.work)
        return punch, max(self.displacement or 0.0, 0.0) if self.force is None else self.force / punch.stiffness
