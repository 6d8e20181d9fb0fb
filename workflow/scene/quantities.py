"""Types of the values in a scene, each with its range and its unit in one name, and what follows from them.

Model units: length LU (the spacing), force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.

`keys_of` is the one reader of the tables' types, and `walk` the one walker of a scene: reading, checking, conversion
between units, the schema and the documentation use both.
"""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from contact1d.workflow.units import SI

Keys = tuple[str | int, ...]
"""Keys from the top of a scene down to a value; an item of a list by its index."""


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

    @property
    def bases(self) -> frozenset[str]:
        """Which of LU, FU and MU must be known for its size in SI; none of a unit of SI."""
        return frozenset(SI[self.name].powers) if self.name in SI else frozenset()


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """What to do about a number that is not in its range, as metadata of its type."""

    hint: str


class Table(BaseModel):
    """A table of a scene: immutable, no unknown keys, no conversion between types, finite numbers only.

    The text below a key says what it is, to readers of this file, of the documentation and of the schema alike.

    Attributes:
        as_list: it is written as a list of its values.
        one_of: sets of keys of which exactly one must be there, with what to do otherwise.
        by_name: tables that a name may stand for, each name as `problems.plain` has it.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )

    as_list: ClassVar[bool] = False
    one_of: ClassVar[tuple[tuple[tuple[str, ...], str], ...]] = ()
    by_name: ClassVar[Mapping[str, Mapping[str, Any]]] = {}

    def __dir__(self) -> list[str]:
        """Names for completion: keys and what can be asked, without those of pydantic."""
        return [name for name in super().__dir__() if name[0] != "_" and name not in vars(BaseModel)]


Length = Annotated[float, Gt(0), Unit("LU")]
Height = Annotated[float, Unit("LU")]
SignedRadius = Annotated[float, Unit("LU")]
Ratio = Annotated[float, Gt(0), Unit("1")]
RatioOrZero = Annotated[float, Ge(0), Unit("1")]
Stiffness = Annotated[float, Gt(0), Unit("FU/LU")]
Mass = Annotated[float, Gt(0), Unit("MU")]
Energy = Annotated[float, Gt(0), Unit("FU·LU")]
LineEnergy = Annotated[float, Ge(0), Unit("FU/LU", text=("J/m²",))]
Temperature = Annotated[float, Gt(0), Unit("FU·LU", text=("K", "J"))]
Velocity = Annotated[float, Gt(0), Unit("LU/TU")]
LoadingRate = Annotated[float, Gt(0), Unit("FU/TU")]
Duration = Annotated[float, Gt(0), Unit("TU")]
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
CycleCount = Annotated[int, Ge(1), Le(1000), Unit("1")]
StateCount = Annotated[int, Ge(2), Le(1_000_000), Unit("1")]
Seed = Annotated[int, Ge(1), Le(2**31 - 1), Unit("1")]
Pascal = Annotated[float, Gt(0), Unit("Pa")]
SurfaceEnergy = Annotated[float, Gt(0), Unit("J/m²")]
Metre = Annotated[float, Gt(0), Unit("m")]
Newton = Annotated[float, Gt(0), Unit("N")]
Kilogram = Annotated[float, Gt(0), Unit("kg")]
Poisson = Annotated[float, Gt(-1), Le(0.5), Unit("1")]


T = TypeVar("T")
Other = TypeVar("Other")


def either(special: str, types: Any, otherwise: str) -> Discriminator:
    """Which of two tagged types a value is meant to be, so that one mistake is one error."""
    return Discriminator(lambda value: special if isinstance(value, types) else otherwise)


_NumberOr = Annotated[Annotated[T, Tag("number")] | Annotated[Other, Tag("word")], either("word", str, "number")]
Auto = _NumberOr[T, Literal["auto"]]
AllOr = _NumberOr[T, Literal["all"]]
# strict=False on the tuple alone: TOML has lists, a frozen table holds a tuple. Its items stay strict.
Listed = Annotated[tuple[T, ...], Field(strict=False), MinLen(1)]
OneOrMore = Annotated[
    Annotated[T, Tag("number")] | Annotated[Listed[Other], Tag("list")], either("list", (list, tuple), "number")
]


@dataclass(frozen=True)
class Choice:
    """One of the types that a value may have.

    Attributes:
        type, marks: the type, and what its `Annotated` says of it.
        items: what may stand in it, if it is a list.
        table, kind: the table that it is, if it is one, and its word for `kind`, if it has one.
        words: those that it allows.
        unit: of a number.
    """

    type: Any
    marks: tuple[Any, ...]
    items: Allowed | None
    table: type[Table] | None
    kind: str | None
    words: tuple[Any, ...]
    unit: Unit | None


@dataclass(frozen=True)
class Allowed:
    """The allowed values of a key: one or more types."""

    choices: tuple[Choice, ...]

    @property
    def table(self) -> type[Table] | None:
        """The table that it must be, None if there are others or none."""
        return self.choices[0].table if len(self.choices) == 1 else None

    @property
    def kinds(self) -> dict[str, type[Table]]:
        """The tables of a union by their `kind`."""
        return {choice.kind: choice.table for choice in self.choices if choice.kind and choice.table}

    @property
    def words(self) -> tuple[Any, ...]:
        """All words that are allowed."""
        return tuple(word for choice in self.choices for word in choice.words)

    @property
    def unit(self) -> Unit | None:
        """The unit of a number, or of the items of a list of numbers."""
        units = (choice.unit or (choice.items.unit if choice.items else None) for choice in self.choices)
        return next((unit for unit in units if unit), None)

    @property
    def quantity(self) -> Unit | None:
        """The unit of a number that may have a dimension: counts have none."""
        return next((choice.unit for choice in self.choices if choice.type is float), None)

    def table_for(self, value: Mapping[str, Any]) -> type[Table] | None:
        """The table that `value` is meant to be, by its kind where there are several."""
        tables = {choice.kind: choice.table for choice in self.choices if choice.table}
        return next((table for kind, table in tables.items() if len(tables) == 1 or kind == value.get("kind")), None)


@dataclass(frozen=True)
class Key:
    """A key of a table: its field in Python, allowed values, description, and default (None: none)."""

    field: str
    allowed: Allowed
    description: str
    default: Any


@cache
def keys_of(table: type[Table]) -> dict[str, Key]:
    """Every key allowed in `table`, as written in TOML, in order; cached, since every scene needs some tens."""
    hints = get_type_hints(table, include_extras=True)
    return {
        field.alias or name: Key(
            name, allowed_by(hints[name]), " ".join((field.description or "").split()), field.get_default()
        )
        for name, field in table.model_fields.items()
    }


def allowed_by(annotation: Any, marks: tuple[Any, ...] = ()) -> Allowed:
    """What a type allows, without None: a key that may be absent has it."""
    origin, arguments = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return allowed_by(arguments[0], (*arguments[1:], *marks))
    if origin in (Union, types.UnionType):
        members = [allowed_by(member, marks) for member in arguments if member is not type(None)]
        return Allowed(tuple(choice for member in members for choice in member.choices))
    items = allowed_by(arguments[0]) if origin is tuple else None
    table = annotation if isinstance(annotation, type) and issubclass(annotation, Table) else None
    kind = str(get_args(table.model_fields["kind"].annotation)[0]) if table and "kind" in table.model_fields else None
    unit = next((mark for mark in marks if isinstance(mark, Unit)), None)
    return Allowed((Choice(annotation, marks, items, table, kind, arguments if origin is Literal else (), unit),))


@dataclass(frozen=True)
class Place:
    """A position in a scene: its `keys`, its value, and what is allowed; `absent`: the default without a value."""

    keys: Keys
    value: Any
    allowed: Allowed
    absent: bool = False

    @property
    def unit(self) -> Unit:
        """The unit of a number."""
        unit = self.allowed.quantity
        assert unit is not None
        return unit

    @property
    def is_text(self) -> bool:
        """Whether it is a text that can only have meant a number with a unit: one with digits, and no plain number."""
        if not isinstance(self.value, str) or self.value in self.allowed.words or not any(map(str.isdigit, self.value)):
            return False
        try:
            float(self.value)
        except ValueError:
            return True
        return False

    @property
    def is_number(self) -> bool:
        """Whether it is a number other than 0, which is the same in all units."""
        return isinstance(self.value, int | float) and not isinstance(self.value, bool) and self.value != 0

    def put(self, data: Any, value: object) -> None:
        """Put another value in its place in `data`."""
        for key in self.keys[:-1]:
            data = data[key]
        data[self.keys[-1]] = value


def walk(allowed: Allowed, value: Any, keys: Keys = (), absent: bool = False) -> Iterator[Place]:
    """Every position in `value`, a table before its content, which may be corrected meanwhile; absent keys, too."""
    yield Place(keys, value, allowed, absent)
    if isinstance(value, Mapping) and (table := allowed.table_for(value)):
        for name, key in keys_of(table).items():
            yield from walk(key.allowed, value.get(name, key.default), (*keys, name), name not in value)
    elif isinstance(value, list | tuple):
        for items in (choice.items for choice in allowed.choices if choice.items):
            for i, item in enumerate(value):
                yield from walk(items, item, (*keys, i))


def places(table: type[Table], data: Mapping[str, Any]) -> Iterator[Place]:
    """Every place of a number in `data`, a table of this type with the keys of a scene file; absent keys by default."""
    for place in walk(allowed_by(table), data):
        nothing = place.absent and not isinstance(place.value, float)
        if place.allowed.quantity and not nothing and not isinstance(place.value, Mapping | list | tuple):
            yield place


def tables_in(table: type[Table], path: str = "") -> Iterator[tuple[str, Choice]]:
    """Every table inside `table`, with its dotted path, that itself first and each kind of a union."""
    yield path, allowed_by(table).choices[0]
    for name, key in keys_of(table).items():
        for choice in key.allowed.choices:
            if choice.table:
                yield from tables_in(choice.table, f"{path}.{name}" if path else name)
