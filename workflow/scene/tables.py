"""The typed scene: one frozen model per table of a scene file."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self, cast

from pydantic import AfterValidator, ConfigDict, Field, model_validator
from pydantic_core import PydanticCustomError

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
)
from contact1d.workflow.scene.experiments import Experiment, Method
from contact1d.workflow.scene.material import PARABOLA_SHARE, Material, Reduction, default_reduction
from contact1d.workflow.scene.problems import tables_as_toml
from contact1d.workflow.scene.profiles import Flat, Parabola, Profile
from contact1d.workflow.scene.quantities import (
    AllOr,
    AnyParticleCount,
    Auto,
    Displacement,
    Length,
    Mass,
    ParticleCount,
    RelativeTolerance,
    StateCount,
    Stiffness,
    Table,
    allowed_by,
    keys_of,
)

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Bodies(Table):
    """The two bodies: chains of particles, each particle held to its own bulk by a spring."""

    particles: Auto[ParticleCount]
    """particles per body, or of the lower one, or "auto": as many as the contact needs"""
    given_spacing: Auto[Length] = Field(alias="spacing")
    """distance of neighbouring particles, or on a rigid plane "auto": so near that all results keep
    `accuracy.tolerance`
    """
    profile: Profile
    """shape of the upper body"""
    reduction: Reduction = cast("Reduction", None)
    """how the plane model stands for a 3D one: "geike_popov" (profile as drawn) or "mdr" (transformed); absent: "mdr"
    with a material, on a rigid plane and for every profile but a parabola, else "geike_popov"
    """
    bulk_stiffness: Auto[Stiffness] = "auto"
    """stiffness of each particle to its bulk, normal direction, or "auto": from the material"""
    bulk_stiffness_tangential: Stiffness | None = None
    """stiffness of each particle to its bulk, along x; absent: as in normal direction, or with E and ν of both
    bodies G*/E* of that
    """
    mass: Mass = 1.0
    """mass of a particle; matters only where something moves in time"""
    lower: Literal["particles", "rigid_plane", "rigid_chain"] = "particles"
    """lower body: "particles" like the upper one, a "rigid_plane", or a "rigid_chain" of particles without springs"""
    periodic: bool = False
    """whether both bodies, which are flat, go on for ever along x"""
    upper_particles: AnyParticleCount | None = None
    """particles of the upper body; absent: as many as the lower one has"""
    upper_spacing: Length | None = None
    """distance of neighbouring particles of the upper body; absent: the spacing"""
    upper_offset: Displacement | None = None
    """place of the upper body's middle along x; absent: 0, and in a slide such that its particles begin between
    those of the lower one
    """

    def height(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height [LU] of the upper chain above its apex at the places `x` [LU], as its reduction has it."""
        return self.profile.transformed(x) if self.reduction == "mdr" else self.profile.height(x)

    @property
    def reach(self) -> float:
        """Half-width [LU] within which the profile is a body at all; of a flat body half of its chain."""
        if isinstance(self.profile, Flat):
            count = self.upper_particles or self.particles
            return 0.5 * float(count) * self.own_spacing if count != "auto" else math.inf
        return self.profile.reach

    @property
    def spacing(self) -> float:
        """Distance [LU] of neighbouring particles; "auto" is a number once `settings.spacing.with_spacing` chose it."""
        assert self.given_spacing != "auto", "no spacing was chosen yet"
        return self.given_spacing

    @property
    def own_spacing(self) -> float:
        """Distance [LU] of neighbouring particles of the upper body."""
        return self.upper_spacing or self.spacing

    @property
    def plane_radius(self) -> float | None:
        """Radius R₁ [LU] of the plane parabola x²/2R₁ that stands for one of R, R or with the MDR R/2; else None."""
        return PARABOLA_SHARE[self.reduction] * self.profile.radius if isinstance(self.profile, Parabola) else None


class Accuracy(Table):
    """How exact the results are to be; chooses every numerical setting that the scene leaves open."""

    tolerance: RelativeTolerance = 1e-3
    """relative error allowed in the main results"""


class Output(Table):
    """What is kept besides the results."""

    states: AllOr[StateCount]
    """how many states of the whole way states.lammpstrj holds, each with all atoms' places and the force of the
    opposite body on them: so many, evenly among the rows of curve.csv, or "all" of these; without this table it has
    the reported states only
    """


def _one_line(title: str) -> str:
    if not title.strip() or not title.isprintable():
        raise PydanticCustomError("scene", "must be one line of text, not empty")
    return title


class Tables(Table):
    """The tables of a scene, each right by itself; `read`, whose `Scene` this is, checks that they fit together."""

    model_config = ConfigDict(defer_build=True)  # built once, by that

    title: Annotated[str, AfterValidator(_one_line)]
    """what the scene shows, one line"""
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
    """what the model stands for in SI"""
    accuracy: Accuracy = Accuracy()
    """how exact"""
    output: Output | None = None
    """what is kept besides the results"""
    experiment: Experiment
    """what is done"""

    @model_validator(mode="after")
    def _choose_reduction(self) -> Self:
        """The scene whose bodies have a reduction, which counts as not given where it is by default (`Scene.with_`)."""
        bodies = self.bodies
        if bodies.reduction is not None:
            return self
        chosen = default_reduction(self.material is not None, bodies.lower, bodies.profile.kind)
        resolved = bodies.model_copy(update={"reduction": chosen})
        resolved.model_fields_set.discard("reduction")
        return self.model_copy(update={"bodies": resolved})

    def __repr__(self) -> str:
        """One line: title, profile, effects and experiment; `print` shows the whole scene."""
        effects = f", {', '.join(self.effects)}" if self.effects else ""
        return f"<Scene {self.title!r}: {self.bodies.profile.kind}{effects}; {self.experiment.kind}>"

    def __str__(self) -> str:
        """The scene file: TOML with defaults written out, that reads back as an equal scene."""
        return tables_as_toml(self.model_dump(by_alias=True, exclude_none=True))

    @property
    def effects(self) -> tuple[str, ...]:
        """Names of the effects that this scene has, in deck order."""
        return tuple(name for name in EFFECTS if getattr(self, name) is not None)

    @property
    def bulk_stiffness(self) -> float:
        """Stiffness k [FU/LU] of each particle to its bulk: the given one, else the material's.

        Two chains in series, or one on a rigid plane, make the layer c: k = 2 c h or c h, with the spacing h.
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
        """Stiffness [FU/LU] of each particle to its bulk along x: the given one, else G*/E* of the normal one."""
        given = self.bodies.bulk_stiffness_tangential
        if given is not None:
            return given
        return self.bulk_stiffness * (1.0 if self.material is None else self.material.tangential_share())

    @property
    def chains(self) -> int:
        """How many chains share the deformation: two, or one on a rigid plane or a rigid chain."""
        return 2 if self.bodies.lower == "particles" else 1

    @property
    def adheres(self) -> bool:
        """Whether the bodies hold each other: by an attraction, or by an energy on a rigid plane."""
        attracts = self.interaction is not None and self.interaction.attraction is not None
        return attracts or (self.adhesion is not None and self.adhesion.work > 0.0)

    @property
    def stands(self) -> bool:
        """Whether particles stand still in the upper body, on a rigid plane that has their springs."""
        return self.is_stepped or self.adhesion is not None

    @property
    def is_stepped(self) -> bool:
        """Whether particles have no place to find: alone at rest on a rigid plane, they have what the plate's gives."""
        alone = self.bodies.lower == "rigid_plane" and self.neighbours is None
        return alone and self.method == "quasistatic"

    @property
    def method(self) -> Method:
        """The method given, else "dynamic" if a plate, damping or noise is there, else "quasistatic"."""
        return self.experiment.given_method or default_method(self.effects)


WHOLE = allowed_by(Tables)
"""What a scene is."""
EFFECT_TABLES: dict[str, type[Effect]] = {
    name: table for name, key in keys_of(Tables).items() if (table := key.allowed.table) and issubclass(table, Effect)
}
EFFECTS = tuple(EFFECT_TABLES)
"""Names of all effects in deck order, which is that of the scene's fields; each is also the name of its scene table."""

TIMED = tuple(name for name, kind in EFFECT_TABLES.items() if kind.timed)
"""Effects that exist in time only, so that a quasistatic run cannot have them."""


def default_method(effects: tuple[str, ...]) -> Method:
    """Method of a scene that names none and has these `effects`; a slide is always dynamic besides."""
    return "dynamic" if set(TIMED) & set(effects) else "quasistatic"
