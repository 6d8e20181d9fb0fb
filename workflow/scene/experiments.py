"""The five experiments of a scene: load, path, pull_off, slide, tangential.

A prescribed path from d₀ to d₁ in n steps holds d_i = (d₀ (n − i) + d₁ i)/n for i = 0…n, and back in the same places.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal, Self

from annotated_types import MinLen
from pydantic import Discriminator, Field, Tag, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import (
    Compression,
    CompressionOrNone,
    Displacement,
    DriveVelocity,
    Force,
    Length,
    LoadingRate,
    RepeatCount,
    StepCount,
    Stiffness,
    Table,
    Velocity,
)

Method = Literal["quasistatic", "dynamic"]
_METHOD = (
    '"quasistatic" (no time) or "dynamic" (as in the paper); absent: "dynamic" with [plate], [damping] or [noise], '
    'else "quasistatic"'
)


class Span(Table):
    """Evenly spaced displacements from one place to another, by default there and back."""

    from_: Displacement = Field(alias="from", description="displacement at the start")
    to: Displacement = Field(description="displacement at the turning point")
    steps: StepCount = Field(description="number of steps of one leg")
    return_: bool = Field(default=True, alias="return", description="whether to go back to the start as well")

    @model_validator(mode="after")
    def _ends_differ(self) -> Self:
        if self.from_ == self.to:
            raise PydanticCustomError("scene", '"from" and "to" must differ')
        return self

    def values(self) -> list[float]:
        """Displacements [LU] in order: steps + 1 on the way there, then `steps` back; the turning point once."""
        n = self.steps
        between = [(self.from_ * (n - i) + self.to * i) / n for i in range(1, n)]
        there = [self.from_, *between, self.to]
        return there + there[-2::-1] if self.return_ else there


def _list_or_table(value: object) -> str:
    return "table" if isinstance(value, Mapping | Span) else "list"


# strict=False on the tuple alone: TOML has lists, a frozen table holds a tuple. Its numbers stay strict.
_Listed = Annotated[tuple[Displacement, ...], Field(strict=False), MinLen(1), Tag("list")]
Displacements = Annotated[_Listed | Annotated[Span, Tag("table")], Discriminator(_list_or_table)]


def _list_or_number(value: object) -> str:
    return "list" if isinstance(value, list | tuple) else "number"


_Loads = Annotated[tuple[CompressionOrNone, ...], Field(strict=False), MinLen(1), Tag("list")]
NormalForces = Annotated[Annotated[Compression, Tag("number")] | _Loads, Discriminator(_list_or_number)]
NormalDisplacements = Annotated[Annotated[Displacement, Tag("number")] | _Listed, Discriminator(_list_or_number)]


class Kind(Table):
    """What is done. Each kind says here what other rooms must know of it.

    Attributes:
        way_is_given: the scene prescribes the whole way, so that nothing is searched for and no state is ambiguous.
        motion_is_result: the motion itself is looked at, so that the scene exists in time only and its drag is its own.
        draws_off: the plate is drawn off through a spring along z.
        goes_along: the scene also prescribes places along x, on a plane, and has no other method.
    """

    way_is_given: ClassVar[bool] = False
    motion_is_result: ClassVar[bool] = False
    goes_along: ClassVar[bool] = False

    @property
    def draws_off(self) -> bool:
        """See above."""
        return False

    @property
    def drawing_stiffness(self) -> float:
        """Stiffness [FU/LU] of a spring that draws the plate off along z; 0 without one."""
        return 0.0

    @property
    def compression(self) -> float | None:
        """Largest force [FU] that presses the bodies together; None where displacements are prescribed."""
        return None

    def places(self) -> list[float]:
        """Prescribed displacements [LU] in order, none where a force is prescribed."""
        return []

    @property
    def way(self) -> float:
        """How far [LU] the bodies are drawn along each other."""
        return 0.0


class Load(Kind):
    """Equilibrium under a normal force."""

    kind: Literal["load"] = Field(description="equilibrium under a force")
    force: Force = Field(description="normal force on the upper body, compression positive")
    method: Method | None = Field(default=None, description=_METHOD)

    @property
    def compression(self) -> float:
        """The force, if it compresses."""
        return max(self.force, 0.0)


class Path(Kind):
    """Prescribed displacements of the upper body."""

    way_is_given: ClassVar[bool] = True

    kind: Literal["path"] = Field(description="prescribed displacement, there and back")
    displacements: Displacements = Field(description="displacements, compression positive: a list or an even span")
    method: Method | None = Field(default=None, description=_METHOD)

    def places(self) -> list[float]:
        """Displacements [LU] in the order in which they are visited, the turning point of a span once."""
        listed = self.displacements
        return listed.values() if isinstance(listed, Span) else list(listed)


class PullOff(Kind):
    """Compression by a preload, then the largest tension that the contact holds."""

    kind: Literal["pull_off"] = Field(description="compress by the preload, then the largest tension held")
    preload: Compression = Field(description="compressive force F_D before the pull")
    loading_rate: LoadingRate | None = Field(
        default=None, description="with [noise]: rate at which the load is drawn off until the bodies part"
    )
    velocity: Velocity | None = Field(
        default=None,
        description="with [noise], in place of loading_rate: velocity at which the far end of a spring draws the plate "
        "off",
    )
    stiffness: Stiffness | None = Field(
        default=None, description="with velocity: of that spring; absent: that of the contact without load"
    )
    repeats: RepeatCount | None = Field(
        default=None, description="with [noise]: how often, each time with the next seed; absent: once"
    )
    method: Method | None = Field(default=None, description=_METHOD)

    @property
    def compression(self) -> float:
        """F_D."""
        return self.preload

    @property
    def draws_off(self) -> bool:
        """Whether a velocity is given."""
        return self.velocity is not None

    @property
    def drawing_stiffness(self) -> float:
        """Of the spring, where it is given."""
        return self.stiffness or 0.0


class Leg(Table):
    """A part of a slide's path, written [velocity, distance]."""

    as_list: ClassVar[bool] = True

    velocity: DriveVelocity = Field(description="velocity of the driven end; negative: back, 0: it rests")
    distance: Length = Field(
        description="way of the driven end; where it rests, it does so as long as cantilever.velocity takes for that"
    )

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: Any) -> dict[str, Any]:
        """A list of two numbers, or a table."""
        pair = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
        return {"anyOf": [pair, handler.resolve_ref_schema(handler(core))]}


class Slide(Kind):
    """Sliding under a normal force, pulled through the cantilever; always dynamic."""

    way_is_given: ClassVar[bool] = True
    motion_is_result: ClassVar[bool] = True

    kind: Literal["slide"] = Field(description="normal force and cantilever; always dynamic")
    normal_force: Force = Field(
        description="force held while sliding, compression positive; 0 or a pull where bodies attract each other"
    )
    distance: Length | None = Field(
        default=None, description="way of the driven end of the cantilever at cantilever.velocity; absent with a path"
    )
    path: Annotated[tuple[Leg, ...], Field(strict=False), MinLen(1)] | None = Field(
        default=None, description="legs [velocity, distance] of the driven end in place of one distance"
    )

    def legs(self, velocity: float) -> tuple[Leg, ...]:
        """The legs; `velocity` [LU/TU] is the cantilever's."""
        return self.path or (Leg(velocity=velocity, distance=self.distance or 0.0),)

    @property
    def compression(self) -> float:
        """The normal force, if it compresses."""
        return max(self.normal_force, 0.0)

    @property
    def way(self) -> float:
        """How far the driven end goes to one side at most."""
        place, farthest = 0.0, self.distance or 0.0
        for leg in self.path or ():
            place += leg.distance * ((leg.velocity > 0.0) - (leg.velocity < 0.0))
            farthest = max(farthest, abs(place))
        return farthest


class Tangential(Kind):
    """Normal load, then tangential displacement along x, with Coulomb's friction on a rigid plane."""

    way_is_given: ClassVar[bool] = True
    goes_along: ClassVar[bool] = True

    kind: Literal["tangential"] = Field(description="normal load, then displacement along x with friction")
    normal_force: NormalForces | None = Field(
        default=None, description="compressive force: one, or one for each of the displacements"
    )
    normal_displacement: NormalDisplacements | None = Field(
        default=None,
        description="in place of the force: displacement in normal direction, compression positive; one, or one for "
        "each of the displacements",
    )
    displacements: Displacements = Field(
        description="displacements along x, from 0 on where the load comes on: a list or an even span"
    )

    @property
    def compression(self) -> float | None:
        """The largest normal force; None where displacements are given."""
        forces = self.normal_force
        return None if forces is None else max(forces) if isinstance(forces, tuple) else forces

    def places(self) -> list[float]:
        """Normal displacements [LU] of the rows, none where forces are given."""
        given = self.normal_displacement
        return [] if given is None else list(given) if isinstance(given, tuple) else [given] * len(self.along())

    def along(self) -> list[float]:
        """Displacements along x [LU] of the rows."""
        listed = self.displacements
        return listed.values() if isinstance(listed, Span) else list(listed)

    def normal_forces(self) -> list[float]:
        """Normal forces [FU] of the rows, none where displacements are given."""
        forces = self.normal_force
        return [] if forces is None else list(forces) if isinstance(forces, tuple) else [forces] * len(self.along())

    @property
    def way(self) -> float:
        """The farthest of the displacements."""
        return max(map(abs, self.along()))


Experiment = Annotated[Load | Path | PullOff | Slide | Tangential, Discriminator("kind")]
