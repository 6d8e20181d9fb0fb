"""Types of the values in a scene, each with its range and its unit in one name, and what follows from them.

Model units: length LU (the spacing), force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.

`keys_of` is the one reader of the tables' types, and a tree of `Place`s the one way through a scene: reading, checking,
conversion between units and rules ask it what stands at a key and what may stand there.
"""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property, reduce
from operator import or_
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from contact1d.workflow.scene.problems import Problem, path_of, shown
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
class Allowed:
    """What may stand at a key: a plain value, a list, a table, or a word; where it is several of these, any one.

    Attributes:
        type: of a plain value: bool, str, int or float.
        marks: what `Annotated` says of the value or the list.
        items: what may stand in the list.
        tables: by their `kind`; a table that has none by "".
        words: those that are allowed.
    """

    type: Any = None
    marks: tuple[Any, ...] = ()
    items: Allowed | None = None
    tables: Mapping[str, type[Table]] = field(default_factory=dict)
    words: tuple[str, ...] = ()

    def __or__(self, other: Allowed) -> Allowed:
        """Either of the two."""
        tables = {**self.tables, **other.tables}
        marks, words = self.marks + other.marks, self.words + other.words
        return Allowed(self.type or other.type, marks, self.items or other.items, tables, words)

    @cached_property
    def table(self) -> type[Table] | None:
        """The table that it must be, None if there are others or none."""
        return None if self.items else self.tables.get("")

    @cached_property
    def kinds(self) -> dict[str, type[Table]]:
        """The tables of a union by their `kind`."""
        return {kind: table for kind, table in self.tables.items() if kind}

    @cached_property
    def unit(self) -> Unit | None:
        """The unit of a number, or of the items of a list of numbers."""
        return next((mark for mark in self.marks if isinstance(mark, Unit)), self.items and self.items.unit)

    @cached_property
    def quantity(self) -> Unit | None:
        """The unit of a number that may have a dimension: counts have none."""
        return self.unit if self.type is float else None

    @cached_property
    def kind(self) -> Allowed:
        """What the `kind` of a table may be."""
        return Allowed(words=(*self.kinds,))

    def table_for(self, value: Mapping[str, Any]) -> type[Table] | None:
        """The table that `value` is meant to be, by its kind where there are several."""
        return next((table for kind, table in self.tables.items() if kind in ("", value.get("kind"))), None)


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
        return reduce(or_, (allowed_by(member, marks) for member in arguments if member is not type(None)))
    if origin is Literal:
        return Allowed(words=arguments)
    if origin is tuple:
        return Allowed(marks=marks, items=allowed_by(arguments[0]))
    if not issubclass(annotation, Table):
        return Allowed(annotation, marks)
    kind = annotation.model_fields.get("kind")
    return Allowed(tables={get_args(kind.annotation)[0] if kind else "": annotation})


class Place:
    """A position in a scene: a key of a table or an item of a list, the value there, and what may stand there.

    A scene is a tree of them, and what reads it asks this tree: spelling, units, types and rules alike.

    Attributes:
        value: what stands there; where nothing does, the default.
        allowed: what may stand there.
        key: the last of its `keys`.
        absent: whether nothing stands there.
        sound: whether no problem is in it.
        source: what was written, where the value follows from that: a text with a unit, or the name of a file.
    """

    __slots__ = ("_above", "_inside", "absent", "allowed", "key", "sound", "source", "value")

    def __init__(
        self, value: Any, allowed: Allowed, key: str | int = "", above: Place | None = None, absent: bool = False
    ) -> None:
        """The position `key` in the table or list `above`; without one the whole of something."""
        self.value, self.allowed, self.key, self._above, self.absent = value, allowed, key, above, absent
        self.source: Place | None = None
        self.sound, self._inside = True, None

    def __iter__(self) -> Iterator[Place]:
        """All places in it, a table before its content, which may be corrected meanwhile; absent keys, too."""
        for place in self.inside.values():
            yield place
            if place.inside:
                yield from place

    @property
    def inside(self) -> dict[str | int, Place]:
        """The places of its keys or items; of a table whose kind is not known that of the kind alone."""
        if self._inside is None:
            self._inside = self._places() if isinstance(self.value, dict | list | tuple) else {}
        return self._inside

    def _places(self) -> dict[str | int, Place]:
        value, allowed = self.value, self.allowed
        if not isinstance(value, dict):
            items = allowed.items
            return {i: Place(item, items, i, self) for i, item in enumerate(value)} if items else {}
        table = allowed.table_for(value)
        keys = {name: (key.allowed, key.default) for name, key in keys_of(table).items()} if table else {}
        if allowed.kinds:
            keys["kind"] = allowed.kind, None
        return {
            name: Place(value.get(name, default), inner, name, self, name not in value)
            for name, (inner, default) in keys.items()
        }

    @property
    def keys(self) -> Keys:
        """The keys from the top of the scene down to it."""
        return (*self._above.keys, self.key) if self._above else ()

    def at(self, *keys: str | int) -> Place | None:
        """The place at these keys from here; None where nothing may stand."""
        place: Place | None = self
        for key in keys:
            place = place.inside.get(key) if place else None
        return place

    def put(self, value: object) -> None:
        """Put a value there."""
        assert self._above is not None
        self._above.value[self.key] = self.value = value
        self.absent, self._inside = False, None

    def convert(self, number: float) -> None:
        """Put a number in the place of the text that means it."""
        self.source = self.source or Place(self.value, self.allowed, self.key, self._above)
        self.put(number)

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

    @property
    def written(self) -> Place:
        """What was written: the place itself, if its value follows from nothing else."""
        return self.source or self

    @property
    def path(self) -> str:
        """The dotted path of what was written."""
        return path_of(self.written.keys)

    @property
    def given(self) -> str | None:
        """What was written, or a number by default, as TOML; None where there is neither."""
        there = not self.written.absent or self.is_number
        return shown(self.written.value) if there else None

    def problem(self, message: str, hint: str = "") -> Problem:
        """What is wrong with it."""
        return Problem(self.path, message, self.given, hint)

    def doubt(self) -> None:
        """Take its value for no basis of anything else."""
        self.sound = False
        if self._above:
            self._above.doubt()

    def fault(self, message: str, hint: str = "") -> Problem:
        """Doubt it, and say what is wrong."""
        self.doubt()
        return self.problem(message, hint)


def places(table: type[Table], data: Mapping[str, Any]) -> Iterator[Place]:
    """The places of all numbers in `data`, a table of this type with the keys of a scene file: see `numbers_in`."""
    return numbers_in(Place(data, allowed_by(table)))


def numbers_in(whole: Place) -> Iterator[Place]:
    """Every place of a number, or of what stands there in its stead; an absent key where it is a number by default."""
    for place in whole:
        nothing = place.absent and not isinstance(place.value, float)
        if place.allowed.quantity and not nothing and not isinstance(place.value, Mapping | list | tuple):
            yield place


def tables_in(table: type[Table], path: str = "", kind: str = "") -> Iterator[tuple[str, str, type[Table]]]:
    """Every table inside `table`, that itself first and each kind of a union: dotted path, kind and type."""
    yield path, kind, table
    for name, key in keys_of(table).items():
        for one, inner in key.allowed.tables.items():
            yield from tables_in(inner, f"{path}.{name}" if path else name, one)
