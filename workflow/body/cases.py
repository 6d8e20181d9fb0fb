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
        """Contact modulus E* [FU/LU²] of the body: c with the MDR, 2c with the reduction of Geike and Popov.

        c = k/(n s) is the stiffness per length of the layer, with the stiffness k [FU/LU] of a particle to its bulk,
        the spacing s [LU], and n = 2 chains with springs, or 1 on a rigid lower body.
        """
        layer = self.scene.bulk_stiffness / (self.scene.chains * self.scene.bodies.spacing)
        return layer if self.scene.bodies.reduction == "mdr" else 2.0 * layer

    @property
    def radius(self) -> float | None:
        """Effective radius of curvature R [LU] of the contact: with the MDR that of the profile at its apex.

        With the reduction of Geike and Popov half of that for a parabola or a circle (two equal spheres), and None for
        any other profile. None, too, where the profile has no radius of curvature: a cone, a flat punch, a power.
        """
        curvature = self.scene.bodies.profile.curvature_radius
        if curvature is None or self.scene.bodies.reduction == "mdr":
            return curvature
        return 0.5 * curvature if self.kind in SPHERES else None

    @property
    def kind(self) -> str:
        """The kind of the profile, as a scene file names it: "parabola", "cone", "power", …"""
        return self.scene.bodies.profile.kind

    @property
    def force(self) -> float | None:
        """Force F [FU], compression positive, of the reported state: the result "force" of the run.

        None where the run has no such result, as a path, and where the bodies attract each other while the scene
        prescribes displacements: one force then belongs to two displacements, and determines no state.
        """
        if self.law.attracts(self.scene) and self.scene.experiment.places():
            return None
        return float(self.quantities["force"].value) if "force" in self.quantities else None

    @property
    def displacement(self) -> float | None:
        """Displacement d [LU], positive in compression, of the reported state of a scene that prescribes displacements.

        It is the result "displacement" where the run has one, else the largest prescribed displacement, in a tangential
        experiment the last one. None where the scene prescribes none, and wherever `force` is not None.
        """
        displacements = self.scene.experiment.places()
        if not displacements or self.force is not None:
            return None
        if "displacement" in self.quantities:
            return float(self.quantities["displacement"].value)
        return displacements[-1] if self.scene.experiment.goes_along else max(displacements)

    @property
    def work(self) -> float:
        """Work of adhesion W [FU/LU] ≥ 0: the result "work_of_adhesion" of the run where there is one.

        An interaction with attraction has it. Else the W that the scene gives in [adhesion]; 0 without [adhesion].
        """
        implied = self.quantities.get("work_of_adhesion")
        return self.scene.work_of_adhesion if implied is None else float(implied.value)

    @property
    def range(self) -> float:
        """Range h₀ [LU] of the attraction: given in [adhesion], or for JKR, which has none, assumed as 0.3 nm.

        Of an interaction with attraction it is that of Lennard-Jones surfaces with the same force-free distance r₀:
        r₀/1.026. 0 without attraction, and for JKR where the size of LU in metres is unknown.
        """
        return self.law.range_of(self.scene, ASSUMED_RANGE / self.scales.length if self.scales.known else 0.0)

    @property
    def law(self) -> type[Law]:
        """The class of the contact law of the scene, a subclass of `Law`; not an instance of it."""
        return law_of(self.scene)

    @property
    def is_elastic(self) -> bool:
        """Whether particles are pressed as linear springs without memory, as in the theories of Hertz and Sneddon.

        False with adhesion, an interaction that attracts, viscoelasticity, springs between neighbours, or noise; a
        repulsive interaction, friction, damping, a plate or a cantilever may be present.
        """
        return self.scene.keeps_springs and "pressed" in self.law.closed_forms and not self.law.attracts(self.scene)

    @property
    def sphere(self) -> tuple[float, float, float]:
        """Tuple (effective radius R [LU], contact modulus E* [FU/LU²], work of adhesion W [FU/LU], 0 without it).

        Raises:
            AssertionError: the body has no effective radius (`radius` is None), as a cone.
        """
        assert self.radius is not None
        return self.radius, self.contact_modulus, self.work

    @property
    def with_range(self) -> MaugisDugdale | None:
        """The contact by the theory of Maugis and Dugdale, by effective radius R, E*, W and the range h₀ of the case.

        None where the profile has no effective radius, W is 0, or h₀ is 0. The range of a scene with JKR is an assumed
        one, 0.3 nm, where the size of LU is known. A circle or an ellipsoid counts as the sphere with its radius at the
        apex.
        """
        if self.radius is None or not (self.work > 0.0 and self.range > 0.0):
            return None
        return MaugisDugdale(*self.sphere, self.range)

    @cached_property
    def body(self) -> PowerLaw | Ellipsoid:
        """The contact in closed form, with the contact modulus and W (0 without adhesion), without a range; cached.

        A `PowerLaw` of a cone and a power, an `Ellipsoid` of an ellipsoid and a circle; of any other profile the
        paraboloid of its effective radius.

        Raises:
            AssertionError: a profile of another kind without an effective radius, as a flat punch.
        """
        profile: Any = self.scene.bodies.profile
        material = self.contact_modulus, self.work
        if self.kind == "cone":
            return PowerLaw(profile.rise, 1.0, *material)
        if self.kind == "power":
            return PowerLaw(profile.height_there / profile.radius**profile.exponent, profile.exponent, *material)
        if self.kind == "ellipsoid":
            return Ellipsoid(profile.radius, profile.half_axis, *material)
        radius, _, _ = self.sphere
        return Ellipsoid(radius, radius, *material) if self.kind == "circle" else PowerLaw.sphere(radius, *material)

    @cached_property
    def contact_radius(self) -> float:
        """Contact radius a [LU] ≥ 0 that the closed form of the body (not the run) predicts for the state; cached.

        It is that at the displacement of the reported state where this is known, else under its force, without both at
        F = 0. It is at most the half-width of the body, and 0 where the closed form has no contact, as beyond pull-off.

        Raises:
            AssertionError: the profile has no closed form with a variable radius, as a flat punch.
        """
        try:
            if self.displacement is not None:
                return self.body.radius_at(self.displacement)
            return self.body.contact_radius(self.force or 0.0)
        except ValueError:
            return 0.0

    @cached_property
    def punch(self) -> tuple[FlatPunch, float]:
        """Tuple (contact of a flat punch in closed form, its displacement d [LU], positive in compression); cached.

        d is the force over the stiffness 2E*a of the punch where the force is known, below 0 for a tension; else the
        prescribed displacement, at least 0; 0 where neither is known. The profile must be a flat punch.
        """
        profile: Any = self.scene.bodies.profile
        punch = FlatPunch(profile.radius, self.contact_modulus, self.work)
        return punch, max(self.displacement or 0.0, 0.0) if self.force is None else self.force / punch.stiffness
