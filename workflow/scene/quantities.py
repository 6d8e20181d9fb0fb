"""Types of the values in a scene: for each, its range and its model unit in one name.

Model units: length LU (the spacing), force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, get_type_hints

from annotated_types import Ge, Gt, Le
from pydantic import BaseModel, ConfigDict, Discriminator, GetJsonSchemaHandler, Tag

TEXT_PATTERN = r"^[ \t]*[+\-−]?[0-9]*\.?[0-9]+.*[A-Za-zµμÅ°%]"
"""What a JSON schema asks of a text that is a number with a unit."""


@dataclass(frozen=True, slots=True)
class Unit:
    """Unit of a number, as metadata of its type; "1" marks a number without dimension.

    In a scene file it may as well be a text with any unit of the same dimension, or of those in `text` (units of SI).
    """

    name: str
    text: tuple[str, ...] = ()

    @property
    def texts(self) -> tuple[str, ...]:
        """The dimensions that a text may have, each by a unit; the first is the one that messages name."""
        return self.text or (self.name,)

    def __get_pydantic_json_schema__(self, core_schema: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """Return the schema of a number, or of such a text."""
        number = handler(core_schema)
        if self.name == "1":
            return number
        return {"anyOf": [number, {"type": "string", "pattern": TEXT_PATTERN}]}


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """What to do about a number that is not in its range, as metadata of its type."""

    hint: str


class Table(BaseModel):
    """A table of a scene: immutable, no unknown keys, no conversion between types, finite numbers only."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)

    as_list: ClassVar[bool] = False
    """Whether it is written as a list of its values."""


Length = Annotated[float, Gt(0), Unit("LU")]
Height = Annotated[float, Unit("LU")]
Ratio = Annotated[float, Gt(0), Unit("1")]
RatioOrZero = Annotated[float, Ge(0), Unit("1")]
Stiffness = Annotated[float, Gt(0), Unit("FU/LU")]
Mass = Annotated[float, Gt(0), Unit("MU")]
Energy = Annotated[float, Gt(0), Unit("FU·LU")]
LineEnergy = Annotated[float, Ge(0), Unit("FU/LU")]
Temperature = Annotated[float, Gt(0), Unit("FU·LU", text=("K", "J"))]
Velocity = Annotated[float, Gt(0), Unit("LU/TU")]
LoadingRate = Annotated[float, Gt(0), Unit("FU/TU")]
DriveVelocity = Annotated[float, Unit("LU/TU")]
DampingCoefficient = Annotated[float, Gt(0), Unit("FU·TU/LU")]
DampingCoefficientOrZero = Annotated[float, Ge(0), Unit("FU·TU/LU")]
Force = Annotated[float, Unit("FU")]
Compression = Annotated[float, Gt(0), Unit("FU")]
CompressionOrNone = Annotated[float, Ge(0), Unit("FU")]
Displacement = Annotated[float, Unit("LU")]
RelativeTolerance = Annotated[float, Ge(1e-7), Le(0.1), Unit("1")]
ParticleCount = Annotated[int, Ge(3), Le(10_000_000), Unit("1")]
RepeatCount = Annotated[int, Ge(1), Le(100_000), Unit("1")]
AnyParticleCount = Annotated[int, Ge(1), Le(10_000_000), Unit("1")]
StepCount = Annotated[int, Ge(1), Le(1_000_000), Unit("1")]
Seed = Annotated[int, Ge(1), Le(2**31 - 1), Unit("1")]


def _number_or_auto(value: object) -> str:
    return "auto" if isinstance(value, str) else "number"


# The discriminator makes one mistake one error: a string can only have meant "auto", all else only a number.
_Either = Discriminator(_number_or_auto)
_Auto = Annotated[Literal["auto"], Tag("auto")]
AutoLength = Annotated[Annotated[Length, Tag("number")] | _Auto, _Either]
AutoStiffness = Annotated[Annotated[Stiffness, Tag("number")] | _Auto, _Either]
AutoMass = Annotated[Annotated[Mass, Tag("number")] | _Auto, _Either]
AutoDamping = Annotated[Annotated[DampingCoefficient, Tag("number")] | _Auto, _Either]
AutoDampingOrZero = Annotated[Annotated[DampingCoefficientOrZero, Tag("number")] | _Auto, _Either]
AutoParticleCount = Annotated[Annotated[ParticleCount, Tag("number")] | _Auto, _Either]


def keys_of(table: type[Table]) -> dict[str, str]:
    """Field name of every key that may stand in `table`, in order: {key as written in TOML: name in Python}."""
    return {field.alias or name: name for name, field in table.model_fields.items()}


def annotation_of(table: type[Table], key: str) -> object:
    """Full type (with its `Annotated` marks) of the key `key` of `table`. Raises KeyError for an unknown key."""
    return _hints(table)[keys_of(table)[key]]


@cache
def _hints(table: type[Table]) -> dict[str, Any]:
    """Types of the fields, worked out once: that takes a millisecond, and every scene asks for some tens."""
    return get_type_hints(table, include_extras=True)
