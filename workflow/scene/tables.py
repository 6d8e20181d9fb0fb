"""The typed scene: one frozen model per table of a scene file.

The physical system: elasticity, the reduction to one dimension, and LU and FU in metres and newtons.

    1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂,        1/G* = (2 − ν₁)/4G₁ + (2 − ν₂)/4G₂

The stiffness per length of the layer that the two chains make together is E* with the MDR and E*/2 with the reduction
of Geike and Popov (their Eq. 3: c_n = G/2(1 − ν), two equal spheres, E* = G/(1 − ν)). The tangential one is G*/E* of it
(Cattaneo and Mindlin; physics of both: K. L. Johnson, Contact Mechanics, 1985).

The paper's reduction takes the profile as drawn, z = c xⁿ, with the layer c_n. Under a force F the half-width of this
plane image, and the contact radius of the body with that profile on a plane (Galin; κ_n in `shapes`), are

    a = [(n + 1) F/(n c E*)]^{1/(n+1)}     and     a = [(n + 1) F/(2 n κ_n c E*)]^{1/(n+1)}

so that the image is (2κ_n)^{1/(n+1)} times as wide and has the inverse square of that as mean pressure. For two equal
spheres, for which it was derived, it has their force and displacement, and is 2 times as wide.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self, TypeVar, cast

from pydantic import AfterValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.errors import SettingsError
from contact1d.workflow.scene.effects import (
    Adhesion,
    Cantilever,
    Damping,
    Effect,
    Friction,
    Horizontal,
    Interaction,
    Neighbours,
    Noise,
    Plate,
    Viscoelasticity,
)
from contact1d.workflow.scene.experiments import Experiment, Impact
from contact1d.workflow.scene.kinds import Method
from contact1d.workflow.scene.materials import BY_NAME
from contact1d.workflow.scene.profiles import Profile
from contact1d.workflow.scene.quantities import (
    AllOr,
    AnyParticleCount,
    Auto,
    Displacement,
    Kilogram,
    Length,
    Mass,
    Metre,
    Newton,
    ParticleCount,
    Pascal,
    Poisson,
    RelativeTolerance,
    StateCount,
    Stiffness,
    SurfaceEnergy,
    Table,
    allowed_by,
    keys_of,
)
from contact1d.workflow.scene.shapes import Flat, Parabola

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


Reduction = Literal["geike_popov", "mdr"]
PARABOLA_SHARE = {"geike_popov": 1.0, "mdr": 0.5}
"""Radius of the plane parabola x²/2R₁ over that of the body that it represents: the MDR takes x²/2R to x²/R."""

SPHERES = ("parabola", "circle")
"""Profiles of which two make the pair of spheres of the paper."""
ALIKE = ("flat_punch", "flat")
"""Profiles that both reductions leave as they are: in model units, where springs are given, nothing differs."""
WIDER_THAN_SPHERES = 2.0
"""Half-width of the paper's image over the contact radius of its two equal spheres."""


E = TypeVar("E", bound=Effect)


class Elastic(Table):
    """An isotropic elastic body; a name such as "steel" stands for E and ν of a named material."""

    by_name = BY_NAME

    youngs_modulus: Pascal
    """Young's modulus E"""
    poisson_ratio: Poisson
    """Poisson's ratio ν"""
    yield_strength: Pascal | None = None
    """yield strength Y, for the validity check `yield` only: the body remains elastic"""

    @property
    def compliance(self) -> float:
        """Plane-strain compliance (1 − ν²)/E [1/Pa]."""
        return (1.0 - self.poisson_ratio**2) / self.youngs_modulus

    @property
    def tangential_compliance(self) -> float:
        """Tangential compliance (2 − ν)/4G = (2 − ν)(1 + ν)/2E [1/Pa]."""
        return (2.0 - self.poisson_ratio) * (1.0 + self.poisson_ratio) / (2.0 * self.youngs_modulus)

    @property
    def coupling_compliance(self) -> float:
        """Compliance (1 − 2ν)/4G = (1 + ν)(1 − 2ν)/2E [1/Pa] that couples normal and tangential displacements."""
        return (1.0 + self.poisson_ratio) * (1.0 - 2.0 * self.poisson_ratio) / (2.0 * self.youngs_modulus)


class Material(Table):
    """Elasticity of the bodies; optionally the units of the model, or the surface energy that they follow from."""

    upper: Elastic | Literal["rigid"] | None = None
    """the upper body, or "rigid": of infinite modulus, which one of the two bodies may be"""
    lower: Elastic | Literal["rigid"] | None = None
    """the lower body, or "rigid" """
    contact_modulus: Pascal | None = None
    """contact modulus E*, in place of upper and lower"""
    length_unit: Metre | None = None
    """one LU in metres; absent: 1 where the scene has numbers with units"""
    force_unit: Newton | None = None
    """one FU in newtons, with bodies.bulk_stiffness = "auto"; absent: 1 where the scene has numbers with units; with a
    given bulk_stiffness it follows from that and E*
    """
    mass_unit: Kilogram | None = None
    """one MU in kilograms; absent: 1 where masses, times or velocities have units"""
    surface_energy: SurfaceEnergy | None = None
    """γ of one side, half the work of adhesion, in a scene without units: LU and FU then follow from pull-off force and
    zero-load radius of the run by JKR (Eq. 9 of the paper)
    """

    @property
    def elastic(self) -> dict[str, Elastic]:
        """The given bodies that are not rigid, and so have a compliance, by "upper" and "lower".

        Empty without any, as where E* is given in place of them.
        """
        bodies = {"upper": self.upper, "lower": self.lower}
        return {name: body for name, body in bodies.items() if isinstance(body, Elastic)}

    def effective_modulus(self) -> float:
        """Return the contact modulus E* [Pa]: as given, else of both bodies, 1/E* = Σ (1 − ν²)/E.

        Of a rigid one and the other that of the other alone. ZeroDivisionError where neither E* nor an elastic body is
        given.
        """
        return self.contact_modulus or 1.0 / sum(body.compliance for body in self.elastic.values())

    def tangential_share(self) -> float:
        """Return the tangential over the normal contact modulus, G*/E*, dimensionless, of the bodies that are elastic.

        1 if only E* is known, so that bulk springs are equally stiff in both directions.
        """
        bodies = self.elastic.values()
        tangential = sum(body.tangential_compliance for body in bodies)
        return sum(body.compliance for body in bodies) / tangential if bodies else 1.0

    def dundurs(self) -> float:
        """Return Dundurs' β = Σ ±(1 + ν)(1 − 2ν)/2E over Σ (1 − ν²)/E, positive of a softer upper body.

        0 of elastically similar bodies, whose normal and tangential displacements are not coupled, and if only E* is
        known.
        """
        signs = {"upper": 1.0, "lower": -1.0}
        coupled = sum(signs[name] * body.coupling_compliance for name, body in self.elastic.items())
        return coupled * self.effective_modulus() if self.elastic else 0.0

    def layer_stiffness(self, reduction: Reduction) -> float:
        """Return the stiffness per length [Pa] of the layer of both chains.

        It is E* with the MDR, E*/2 by the paper's reduction.
        """
        return (0.5 if reduction == "geike_popov" else 1.0) * self.effective_modulus()


def default_reduction(has_material: bool, lower: str, profile: str) -> Reduction:
    """Return the reduction of a scene that names none: "geike_popov", the paper's, for its own plane model alone.

    That is a parabola on a lower body other than a rigid plane, without a material; "mdr" for all others.
    """
    return "mdr" if has_material or lower == "rigid_plane" or profile != "parabola" else "geike_popov"


def wider_than_body(profile: Mapping[str, Any]) -> float | None:
    """Return the half-width of the paper's image over the contact radius of the body on a plane under the same force.

    (2κ_n)^{1/(n+1)} for z ∝ xⁿ, dimensionless; None for punches, flats, measured and unknown profiles, and for a power
    without an exponent.

    Args:
        profile: with the keys of a scene file; KeyError without "kind". Of a circle or an ellipsoid the factor is that
            of its parabola.
    """
    exponents = {"cone": 1.0, "parabola": 2.0, "circle": 2.0, "ellipsoid": 2.0, "power": profile.get("exponent")}
    n = exponents.get(profile["kind"])
    if n is None:
        return None
    from contact1d.analysis.theory.indenters import galin_factor  # it loads numpy, which a scene can do without

    return float((2.0 * galin_factor(n)) ** (1.0 / (n + 1.0)))


class Bodies(Table):
    """The two bodies: chains of particles, each particle held to its own bulk by a spring."""

    particles: Auto[ParticleCount]
    """particles of each body, with upper_particles those of the lower one, or "auto": as many as the contact needs"""
    given_spacing: Auto[Length] = Field(alias="spacing")
    """distance of neighbouring particles, or on a rigid plane "auto": so small that the estimated discretisation error
    meets `accuracy.tolerance`
    """
    profile: Profile
    """shape of the upper body"""
    reduction: Reduction = cast("Reduction", None)
    """reduction of the contact to one dimension: "geike_popov" (profile as given) or "mdr" (transformed profile);
    absent: "mdr" with a material, or a rigid plane, or a profile other than a parabola, else "geike_popov"
    """
    bulk_stiffness: Auto[Stiffness] = "auto"
    """normal stiffness of each particle to its bulk, or "auto": from the material"""
    bulk_stiffness_tangential: Stiffness | None = None
    """tangential stiffness of each particle to its bulk; absent: the normal one, times the ratio G*/E* of tangential
    and normal contact modulus where E and ν of both bodies are known
    """
    mass: Mass = 1.0
    """mass of a particle; has an effect in a dynamic run only, and none in an impact"""
    lower: Literal["particles", "rigid_plane", "rigid_chain"] = "particles"
    """lower body: "particles" like the upper one, a "rigid_plane", or a "rigid_chain" of particles without springs"""
    periodic: bool = False
    """whether both bodies are flat and periodic along x, in a slide"""
    upper_particles: AnyParticleCount | None = None
    """particles of the upper body; absent: as many as the lower one has, with particles = "auto" as many as the contact
    needs
    """
    upper_spacing: Length | None = None
    """distance of neighbouring particles of the upper body; absent: the spacing"""
    upper_offset: Displacement | None = None
    """position of the middle of the upper body along x; absent: 0, in a slide such that its particles start between
    those of the lower body
    """

    def height(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the height [LU] of the upper chain above its apex at the positions `x` [LU]; same shape.

        It is that of the profile after the MDR transform where the reduction is the MDR, else as drawn.
        """
        return self.profile.transformed(x) if self.reduction == "mdr" else self.profile.height(x)

    @property
    def reach(self) -> float:
        """Half-width [LU] within which the profile is a body at all; infinite for a parabola, cone or power.

        The radius of a circle, a punch, or an ellipsoid across the load; the last point of a measured profile. Of a
        periodic flat body half of its chain, infinite where its number of particles is automatic; AssertionError there
        where no spacing was chosen yet.
        """
        if isinstance(self.profile, Flat):
            count = self.upper_particles or self.particles
            return 0.5 * float(count) * self.own_spacing if count != "auto" else math.inf
        return self.profile.reach

    @property
    def own_count(self) -> int | None:
        """Particles of the upper chain of a flat punch, as many as fit into it; None for bodies without an edge.

        Of a periodic flat body their given number; OverflowError where that is automatic. AssertionError where no
        spacing was chosen yet.
        """
        return round(2.0 * self.reach / self.own_spacing) if self.profile.has_edge else None

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU] off the axis, rising, at which the slope or the curvature of the profile jumps."""
        return self.profile.kinks

    @property
    def spacing(self) -> float:
        """Distance [LU] of neighbouring particles, where bodies differ of the lower one; AssertionError if "auto"."""
        assert self.given_spacing != "auto", "no spacing was chosen yet"
        return self.given_spacing

    @property
    def own_spacing(self) -> float:
        """Distance [LU] of neighbouring particles of the upper body, as given, else the common one.

        AssertionError where that is still "auto".
        """
        return self.upper_spacing or self.spacing

    @property
    def plane_radius(self) -> float | None:
        """Radius R₁ [LU] of the plane parabola x²/2R₁ that represents a parabola of radius R: R, or with the MDR R/2.

        Of two curved bodies 1/R = 1/R₁ + 1/R₂ of both radii. None for other profiles, also for a circle.
        """
        profile = self.profile
        return PARABOLA_SHARE[self.reduction] * profile.curvature_radius if isinstance(profile, Parabola) else None


class Accuracy(Table):
    """Accuracy of the results, for which the program chooses every numerical setting that the scene leaves open."""

    tolerance: RelativeTolerance = 1e-3
    """relative error allowed in the main results"""


class Output(Table):
    """Additional output of a run."""

    states: AllOr[StateCount]
    """number of states in states.lammpstrj, evenly among the load steps of curve.csv, or "all" of these; each has the
    positions of all atoms and the force of the opposite body on each particle; without this table the file has the
    reported states only
    """


def _one_line(title: str) -> str:
    """Return the title, unchanged, if it is one line.

    Raises:
        PydanticCustomError: it is empty or blank, or has a line break or another unprintable character.
    """
    if not title.strip() or not title.isprintable():
        raise PydanticCustomError("scene", "must be one line of text, not empty")
    return title


class Tables(Table):
    """The tables of a scene, each right by itself; `read`, whose `Scene` this is, checks that they fit together."""

    title: Annotated[str, AfterValidator(_one_line)]
    """title of the scene, one line"""
    bodies: Bodies
    """the two bodies"""
    interaction: Interaction | None = None
    """forces between opposite bodies"""
    neighbours: Neighbours | None = None
    """springs between neighbouring particles"""
    horizontal: Horizontal | None = None
    """particles may also move along x"""
    adhesion: Adhesion | None = None
    """adhesion to a rigid plane"""
    viscoelasticity: Viscoelasticity | None = None
    """a body that relaxes, on a rigid plane"""
    friction: Friction | None = None
    """friction on a rigid plane"""
    damping: Damping | None = None
    """viscous damping of particles"""
    noise: Noise | None = None
    """thermal forces"""
    plate: Plate | None = None
    """the upper plate moves under a force"""
    cantilever: Cantilever | None = None
    """the plate is pulled through a spring"""
    material: Material | None = None
    """the material in SI"""
    accuracy: Accuracy = Accuracy()
    """accuracy of the results"""
    output: Output | None = None
    """additional output"""
    experiment: Experiment
    """the experiment"""

    @model_validator(mode="after")
    def _choose_reduction(self) -> Self:
        """Return this scene, or where it gives no reduction of its bodies a copy that has one.

        In the copy it still counts as not given. It is "geike_popov" for a parabola without a material on another body
        than a rigid plane, "mdr" for all others.
        """
        bodies = self.bodies
        if bodies.reduction is not None:
            return self
        chosen = default_reduction(self.material is not None, bodies.lower, bodies.profile.kind)
        resolved = bodies.model_copy(update={"reduction": chosen})
        resolved.model_fields_set.discard("reduction")
        return self.model_copy(update={"bodies": resolved})

    def __repr__(self) -> str:
        """Return one line: title, kind of profile, names of effects and kind of experiment, in <Scene …>."""
        effects = f", {', '.join(self.effects)}" if self.effects else ""
        return f"<Scene {self.title!r}: {self.bodies.profile.kind}{effects}; {self.experiment.kind}>"

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects whose tables this scene has, in the order of the scene's fields; empty without any.

        That is also their order in a deck: interaction, neighbours, horizontal, adhesion, viscoelasticity, friction,
        damping, noise, plate, cantilever.
        """
        return tuple(name for name in EFFECTS if getattr(self, name) is not None)

    @property
    def present(self) -> tuple[Effect, ...]:
        """The tables of the effects that this scene has, in the order of `effects`; empty without any."""
        return tuple(getattr(self, name) for name in self.effects)

    @property
    def is_modelled(self) -> bool:
        """Whether the reduced model has all effects of this scene: False with [neighbours] or [noise], else True."""
        return all(effect.is_modelled for effect in self.present)

    @property
    def keeps_springs(self) -> bool:
        """Whether the line load inside a contact is that of independent linear springs, wherever its edge is.

        False with [neighbours], [viscoelasticity] or [noise], else True.
        """
        return all(effect.keeps_springs for effect in self.present)

    def the(self, kind: type[E]) -> E:
        """Return the table of the effect of this class; StopIteration where the scene has none."""
        return next(effect for effect in self.present if isinstance(effect, kind))

    @property
    def temperature(self) -> float:
        """Temperature as k_BT [FU·LU]; 0 without noise."""
        return self.noise.temperature if self.noise else 0.0

    @property
    def work_of_adhesion(self) -> float:
        """Work of adhesion W on a rigid plane [FU/LU]; 0 without adhesion."""
        return self.adhesion.work if self.adhesion else 0.0

    @property
    def bulk_stiffness(self) -> float:
        """Stiffness k [FU/LU] of each particle to its bulk along z: given, else that of the material.

        Two chains in series, or one on a rigid plane or chain, make the layer c: k = 2 c h or c h, with the spacing h;
        c is E* with the MDR and E*/2 with "geike_popov". AssertionError where the scene has no material or this lacks
        the size of LU or FU, or where the spacing is still "auto".
        """
        given = self.bodies.bulk_stiffness
        if given != "auto":
            return given
        assert self.material is not None
        assert self.material.length_unit is not None
        assert self.material.force_unit is not None
        layer = self.material.layer_stiffness(self.bodies.reduction) * self.material.length_unit**2
        return self.chains * layer * self.bodies.spacing / self.material.force_unit

    @property
    def tangential_stiffness(self) -> float:
        """Stiffness [FU/LU] of each particle to its bulk along x: given, else G*/E* times the normal stiffness.

        Equal to the normal stiffness where E and ν are not known. AssertionError where the normal one is not known.
        """
        given = self.bodies.bulk_stiffness_tangential
        if given is not None:
            return given
        return self.bulk_stiffness * (1.0 if self.material is None else self.material.tangential_share())

    @property
    def relaxation(self) -> Viscoelasticity:
        """[viscoelasticity], with the retardation time [TU] in place of a `restitution`; StopIteration without any.

        Raises:
            SettingsError: no retardation time has this restitution.
        """
        from contact1d.analysis.theory.impact import retardation

        effect, degree = self.the(Viscoelasticity), self.bodies.profile.degree
        if effect.restitution is None or degree is None:
            return effect
        try:
            time = self.impact_time * retardation(degree, effect.restitution)
        except ValueError:
            raise SettingsError(
                f"a restitution of {effect.restitution:.12g} is too near to 0 or 1, or beyond: no retardation time of "
                "this body has it. Use a value between, or less uncertainty of it"
            ) from None
        return effect.model_copy(update={"retardation_time": time, "restitution": None})

    @property
    def impact_time(self) -> float:
        """Unit of time [TU] of the impact of a body z ∝ |x|ⁿ at its velocity v: D/v, where F(D) D = m v²."""
        import numpy as np  # a scene can do without it

        from contact1d.analysis.theory.impact import unit_time

        impact, degree = self.experiment, self.bodies.profile.degree
        assert degree is not None
        assert isinstance(impact, Impact)
        # F = 2E* n/(n + 1) a d at a displacement d, here that of a contact radius of one spacing.
        a, modulus = self.bodies.spacing, self.bulk_stiffness / self.bodies.spacing
        d = float(self.bodies.profile.transformed(np.asarray([a]))[0])
        force = 2.0 * modulus * degree / (degree + 1.0) * a * d / d ** (1.0 + 1.0 / degree)
        return unit_time(degree, force, self.impact_mass, impact.velocity)

    @property
    def is_oblique(self) -> bool:
        """Whether the scene is an impact with a tangential velocity or a spin."""
        return self.experiment.is_oblique

    @property
    def spin_ratio(self) -> float:
        """m l²/I of an oblique impact, with the lever arm l of the contact point, the mass m and moment of inertia I.

        0 of any other scene.
        """
        if not self.is_oblique:
            return 0.0
        plate = self.the(Plate)
        if plate.moment_of_inertia == "auto":
            return 2.5  # of a solid ball
        return self.impact_mass * self.lever_arm**2 / plate.moment_of_inertia

    @property
    def impact_mass(self) -> float:
        """Mass m [MU] of the body in an impact; StopIteration without a plate, AssertionError where it is automatic."""
        mass = self.the(Plate).mass
        assert mass != "auto"
        return mass

    @property
    def slip_mass(self) -> float:
        """Mass m/(1 + m l²/I) [MU] by which friction accelerates the contact point in an impact."""
        return self.impact_mass / (1.0 + self.spin_ratio)

    @property
    def lever_arm(self) -> float:
        """Distance l [LU] of the contact point from the centre of mass of an oblique impact: given, else the ball's."""
        given = self.the(Plate).lever_arm
        radius = self.bodies.profile.ball_radius if given == "auto" else given
        assert radius is not None
        return radius

    @property
    def slip_velocity(self) -> float:
        """Velocity of the contact point along x [LU/TU] before an oblique impact, v_t − l ω; else 0."""
        impact = self.experiment
        if not isinstance(impact, Impact) or not impact.is_oblique:
            return 0.0
        return (impact.tangential_velocity or 0.0) - self.lever_arm * (impact.spin or 0.0)

    @property
    def chains(self) -> int:
        """Number of chains that share the deformation: 2 with a lower body of particles, 1 on a rigid one."""
        return 2 if self.bodies.lower == "particles" else 1

    @property
    def stands(self) -> bool:
        """Whether particles are fixed in the upper body, on a rigid plane that has their springs.

        That is on any rigid plane without [neighbours] and [noise], which need particles that move by themselves.
        """
        return self.bodies.lower == "rigid_plane" and not any(effect.needs_bonds for effect in self.present)

    @property
    def is_stepped(self) -> bool:
        """Whether particles follow the plate without relaxation, so that load steps are timesteps of one run.

        That is in a quasi-static run on a rigid plane without [neighbours] ([noise] makes a run dynamic).
        """
        return self.stands and self.method == "quasistatic"

    @property
    def method(self) -> Method:
        """The experiment's only method, "dynamic" or "quasistatic", else the given one, else by the effects.

        By these it is "dynamic" with a plate, damping, noise or a cantilever.
        """
        return self.experiment.given_method or default_method(self.effects)


WHOLE = allowed_by(Tables)
"""The values that a scene may have at its keys."""
EFFECT_TABLES: dict[str, type[Effect]] = {
    name: table for name, key in keys_of(Tables).items() if (table := key.allowed.table) and issubclass(table, Effect)
}
EFFECTS = tuple(EFFECT_TABLES)
"""Names of all effects in deck order, which is that of the scene's fields; each is also the name of its scene table."""

TIMED = tuple(name for name, kind in EFFECT_TABLES.items() if kind.timed)
"""Effects that exist in time only, so that a quasistatic run cannot have them."""


def default_method(effects: tuple[str, ...]) -> Method:
    """Return the method of a scene that names none and has these `effects`.

    "dynamic" with a plate, damping, noise or a cantilever, else "quasistatic".
    """
    return "dynamic" if set(TIMED) & set(effects) else "quasistatic"
