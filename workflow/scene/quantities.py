"""Types of the values in a scene, each with its range and unit in one name, and the tree of places of a scene.

Model units: length LU (the spacing), force FU, mass MU, time TU = √(MU·LU/FU), temperature as energy k_BT in FU·LU.

Only `keys_of` reads the types of the tables, and every module goes through a scene by a tree of `Place`s: reading,
checking, conversion between units and rules ask it for the value at a key and the values that are allowed there.
"""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache, cached_property, reduce
from operator import or_
from typing import Annotated, Any, ClassVar, Literal, TypeVar, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, MinLen
from pydantic import BaseModel, ConfigDict, Field

from contact1d.workflow.scene.problems import Problem, keys_in, path_of, shown
from contact1d.workflow.scene.si_text import NUMBER
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
        """Units, one for each dimension that a text with a unit may have: `text`, or `name` alone where that is empty.

        Messages name the first.
        """
        return self.text or (self.name,)

    @property
    def bases(self) -> frozenset[str]:
        """The names of those of LU, FU and MU that determine its size in SI; all three for TU.

        Empty for a unit of SI and for a number without dimension.
        """
        return frozenset(SI[self.name].powers) if self.name in SI else frozenset()


@dataclass(frozen=True, slots=True)
class OutOfRange:
    """The suggested fix for a number that is out of its range, as metadata of its type."""

    hint: str


class Table(BaseModel):
    """A table of a scene: immutable, no unknown keys, no conversion between types, finite numbers only.

    The text below a key is its description here, in the documentation and in the schema.

    Attributes:
        as_list: whether the table is written as a list of its values.
        one_of: sets of keys of which exactly one must be given, each with the suggested fix.
        by_name: tables that a name may stand for, each name as `problems.plain` writes it.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", strict=True, allow_inf_nan=False, defer_build=True, use_attribute_docstrings=True
    )

    as_list: ClassVar[bool] = False
    one_of: ClassVar[tuple[tuple[tuple[str, ...], str], ...]] = ()
    by_name: ClassVar[Mapping[str, Mapping[str, Any]]] = {}

    def __dir__(self) -> list[str]:
        """Return the names for completion: keys, properties and methods; none of pydantic or with a leading "_"."""
        return [name for name in super().__dir__() if name[0] != "_" and name not in vars(BaseModel)]


POSITIVE, DIMENSIONLESS = Gt(0), Unit("1")

Length = Annotated[float, POSITIVE, Unit("LU")]
SignedLength = Annotated[float, Unit("LU")]
Ratio = Annotated[float, POSITIVE, DIMENSIONLESS]
RatioOrZero = Annotated[float, Ge(0), DIMENSIONLESS]
Stiffness = Annotated[float, POSITIVE, Unit("FU/LU")]
Mass = Annotated[float, POSITIVE, Unit("MU")]
Energy = Annotated[float, POSITIVE, Unit("FU·LU")]
LineEnergy = Annotated[float, Ge(0), Unit("FU/LU", text=("J/m²",))]
Temperature = Annotated[float, POSITIVE, Unit("FU·LU", text=("K", "J"))]
Velocity = Annotated[float, POSITIVE, Unit("LU/TU")]
LoadingRate = Annotated[float, POSITIVE, Unit("FU/TU")]
Duration = Annotated[float, POSITIVE, Unit("TU")]
Time = Annotated[float, Unit("TU")]
DriveVelocity = Annotated[float, Unit("LU/TU")]
Spin = Annotated[float, Unit("1/TU")]
MomentOfInertia = Annotated[float, POSITIVE, Unit("MU·LU²")]
DampingCoefficient = Annotated[float, POSITIVE, Unit("FU·TU/LU")]
DampingCoefficientOrZero = Annotated[float, Ge(0), Unit("FU·TU/LU")]
Force = Annotated[float, Unit("FU")]
Compression = Annotated[float, POSITIVE, Unit("FU")]
CompressionOrNone = Annotated[float, Ge(0), Unit("FU")]
Displacement = Annotated[float, Unit("LU")]
RelativeTolerance = Annotated[float, Ge(1e-7), Le(0.1), DIMENSIONLESS]
ParticleCount = Annotated[int, Ge(3), Le(10_000_000), DIMENSIONLESS]
RepeatCount = Annotated[int, Ge(1), Le(100_000), DIMENSIONLESS]
AnyParticleCount = Annotated[int, Ge(1), Le(10_000_000), DIMENSIONLESS]
StepCount = Annotated[int, Ge(1), Le(1_000_000), DIMENSIONLESS]
CycleCount = Annotated[int, Ge(1), Le(1000), DIMENSIONLESS]
StateCount = Annotated[int, Ge(2), Le(1_000_000), DIMENSIONLESS]
Seed = Annotated[int, Ge(1), Le(2**31 - 1), DIMENSIONLESS]
Pascal = Annotated[float, POSITIVE, Unit("Pa")]
SurfaceEnergy = Annotated[float, POSITIVE, Unit("J/m²")]
Metre = Annotated[float, POSITIVE, Unit("m")]
Newton = Annotated[float, POSITIVE, Unit("N")]
Kilogram = Annotated[float, POSITIVE, Unit("kg")]
Poisson = Annotated[float, Gt(-1), Le(0.5), DIMENSIONLESS]


T = TypeVar("T")
Other = TypeVar("Other")


Auto = Annotated[T | Literal["auto"], Field()]
AllOr = Annotated[T | Literal["all"], Field()]
# strict=False on the tuple alone: TOML has lists, a frozen table holds a tuple. Its items stay strict.
Listed = Annotated[tuple[T, ...], Field(strict=False), MinLen(1)]
OneOrMore = Annotated[T | Listed[Other], Field()]


@dataclass(frozen=True)
class Allowed:
    """The values that a key allows: a plain value, a list, a table, or a word; where several are given, any of these.

    Attributes:
        type: type of a plain value: bool, str, int or float.
        marks: metadata in `Annotated` of the value or the list.
        items: values that the list allows.
        tables: tables by their `kind`; a table without one by "".
        words: words that are allowed.
    """

    type: Any = None
    marks: tuple[Any, ...] = ()
    items: Allowed | None = None
    tables: Mapping[str, type[Table]] = field(default_factory=dict)
    words: tuple[str, ...] = ()

    def __or__(self, second: Allowed) -> Allowed:
        """Return a new `Allowed` of the values that at least one of the two allows.

        It has the words, tables and marks of both, those of self first. Of two plain types, and of two lists, that of
        self alone is kept; of two tables of one kind that of `second`.
        """
        tables = {**self.tables, **second.tables}
        marks, words = self.marks + second.marks, self.words + second.words
        return Allowed(self.type or second.type, marks, self.items or second.items, tables, words)

    @cached_property
    def table(self) -> type[Table] | None:
        """The only table, one without a `kind`, that the value may be; cached.

        None where tables are distinguished by their kind, where no table is allowed, and where a list is allowed.
        """
        return None if self.items else self.tables.get("")

    @property
    def kinds(self) -> Mapping[str, type[Table]]:
        """The tables that the value may be, by their `kind`; empty where a table without a kind is allowed, or none."""
        return {} if "" in self.tables else self.tables

    @cached_property
    def unit(self) -> Unit | None:
        """The unit of a number, or where it has none that of the items of a list; None without any; cached.

        A number without dimension has the unit named "1".
        """
        units = (mark for mark in self.marks if isinstance(mark, Unit))
        return next(units, self.items.unit if self.items else None)

    @cached_property
    def quantity(self) -> Unit | None:
        """The unit of a number with decimals (float), named "1" without a dimension; cached.

        Also where words or lists are allowed besides the number. None for whole numbers, for lists alone, for what is
        no number, and for a float without a unit in its type.
        """
        return self.unit if self.type is float else None

    def table_for(self, value: Mapping[str, Any]) -> type[Table] | None:
        """Return the class of table that `value` is meant to be: the only one allowed, whatever its kind, or by "kind".

        None where that is missing or unknown, or where no table is allowed.
        """
        alone = len(self.tables) == 1
        return next((table for kind, table in self.tables.items() if alone or kind == value.get("kind")), None)


@dataclass(frozen=True)
class Key:
    """A key of a table: its field in Python, allowed values, default (None: none), and description."""

    field: str
    allowed: Allowed
    default: Any
    description: str


@cache
def keys_of(table: type[Table]) -> dict[str, Key]:
    """Return every key allowed in `table`, a `Key` by its name in TOML, in the order of the fields.

    The default of a required key is `PydanticUndefined`. Cached, since a scene needs some tens: the dict is shared and
    must not be changed.
    """
    keys = {}
    for name, given in table.model_fields.items():
        allowed, text = allowed_by(given.annotation, (*given.metadata,)), " ".join(str(given.description).split())
        keys[given.alias or name] = Key(name, allowed, given.get_default(), text)
    return keys


def allowed_by(annotation: Any, marks: tuple[Any, ...] = ()) -> Allowed:
    """Return the values that a type of a field allows, without None, which is the type of an absent key.

    `annotation`: type of a field; `marks`: metadata of it in addition to its own. Of a union each member has the marks;
    a list has them itself, and its items have their own; a Literal and a table keep none.
    """
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


@dataclass(slots=True, eq=False)
class Place:
    """A place in a scene: a key of a table or an item of a list, with its value and the allowed values.

    A scene is a tree of places, which all checks read: of spelling, units, types and rules.

    Attributes:
        value: the value in the scene; without one, the default.
        allowed: the values that are allowed.
        key: the last of its `keys`.
        above: the place of the table or list that contains it; None for the whole.
        absent: whether the scene has no value here.
        sound: whether its value, and all values in it, are free of errors.
        source: the place as written, where the value follows from a text with a unit or the name of a file.
        problems: the problems of the scene.
    """

    value: Any
    allowed: Allowed
    key: str | int = ""
    above: Place | None = None
    absent: bool = False
    sound: bool = True
    source: Place | None = None
    problems: list[Problem] = field(init=False)
    _inside: dict[Any, Place] | None = None

    def __post_init__(self) -> None:
        """Set `problems` to the list of `above`, which all places of the scene share; without `above` to a new one."""
        self.problems = self.above.problems if self.above else []

    def __iter__(self) -> Iterator[Place]:
        """Yield the `Place` of every key and item inside, at all depths, without itself; a table before its content.

        A value may be corrected with `put` meanwhile: then the new content follows. Absent keys are among them, and the
        items of a list that is a default.
        """
        for place in self.inside.values():
            yield place
            if place.inside:
                yield from place

    @property
    def inside(self) -> dict[Any, Place]:
        """The places of the allowed keys of a table by name, or of the items of a list by index; {} for a plain value.

        Absent keys are among them, with their default as value; unknown keys are not. Of a table whose kind is unknown
        there is only that of "kind". Cached until `put`.
        """
        if self._inside is None:
            value, allowed = self.value, self.allowed
            self._inside = {}
            if isinstance(value, dict):
                table = allowed.table_for(value)
                self._inside = {
                    name: Place(value.get(name, key.default), key.allowed, name, self, name not in value)
                    for name, key in (keys_of(table) if table else {}).items()
                }
                if allowed.kinds:
                    self._inside["kind"] = self.kind
            elif allowed.items and isinstance(value, list | tuple):
                self._inside = {i: Place(item, allowed.items, i, self) for i, item in enumerate(value)}
        return self._inside

    @property
    def kind(self) -> Place:
        """A new place of the key "kind", which selects a table out of several; its value is None where that is absent.

        This place must have a dict as value, else AttributeError.
        """
        return Place(
            self.value.get("kind"), Allowed(words=(*self.allowed.kinds,)), "kind", self, "kind" not in self.value
        )

    @property
    def keys(self) -> Keys:
        """The keys from the top of the scene down to this place, indices as int; empty for the whole scene."""
        return (*self.above.keys, self.key) if self.above else ()

    def find(self, path: str) -> Place | None:
        """Return the place at a dotted path of keys below this one, also of an absent key; None if no such key exists.

        An item of a list is found by its index, "viscoelasticity.terms[0].share".
        """
        place: Place | None = self
        for key in keys_in(path):
            place = place.inside.get(key) if place else None
        return place

    def put(self, value: object) -> None:
        """Set the value of this place, in place, also in the dict or list of the scene that contains it.

        It then counts as present, and the places inside are made anew. AssertionError for the whole scene.
        """
        assert self.above is not None
        self.above.value[self.key] = self.value = value
        self.absent, self._inside = False, None

    @property
    def unit(self) -> Unit:
        """The unit of a number with decimals, "1" without a dimension; AssertionError where none is allowed."""
        unit = self.allowed.quantity
        assert unit is not None
        return unit

    @property
    def is_text(self) -> bool:
        """Whether the value is a text that must mean a number with a unit.

        It has digits, and is neither a plain number nor an allowed word; whether the unit is right is not checked.
        """
        value = self.value
        digits = isinstance(value, str) and value not in self.allowed.words and any(map(str.isdigit, value))
        return digits and not NUMBER.fullmatch(value.strip())

    @property
    def is_number(self) -> bool:
        """Whether the value is an int or float other than 0; False for booleans and texts.

        0 is excluded because it is the same in all units.
        """
        return isinstance(self.value, int | float) and not isinstance(self.value, bool) and self.value != 0

    @property
    def path(self) -> str:
        """The dotted path of this place in the scene, "bodies.profile.radius"; "" for the whole scene.

        Where the value was read from elsewhere in the scene (`source`), the path of that: the key `file` for points of
        a file.
        """
        return path_of((self.source or self).keys)

    @property
    def given(self) -> str | None:
        """The value as written in the scene, as TOML of at most 60 characters.

        Of a value that follows from a text with a unit, or from a file, it is that text or the name of the file. Of an
        absent key it is a default number other than 0, else None.
        """
        return None if self.absent and not self.is_number else shown((self.source or self).value)

    def report(self, message: str, hint: str = "") -> None:
        """Add a problem at this place to those of the scene: what is wrong, and as `hint` the suggested fix.

        The place still counts as sound.
        """
        self.problems.append(Problem(self.path, message, self.given, hint))

    def doubt(self) -> None:
        """Mark this place, and all that contain it, as not sound, so that no further check depends on its value."""
        self.sound = False
        if self.above:
            self.above.doubt()

    def fault(self, message: str, hint: str = "") -> None:
        """Mark this place, and all that contain it, as not sound, and report a problem of it.

        `message`: what is wrong; `hint`: suggested fix.
        """
        self.doubt()
        self.report(message, hint)


def places(table: type[Table], data: Mapping[str, Any]) -> Iterator[Place]:
    """Yield the place (key, value and unit) of each number in `data`, a dict of a table with the keys of a scene file.

    Absent keys are among them where a number is their default; counts and lists are not, items of lists are. A text or
    a word in place of a number with decimals is yielded as well. `Place.put` changes `data`.
    """
    return numbers_in(Place(data, allowed_by(table)))


def numbers_in(whole: Place) -> Iterator[Place]:
    """Yield every place of a number with decimals, or of a value in place of one, inside `whole`, in order.

    Absent keys are among them where a number is their default; whole numbers and lists are not, items of lists are. A
    text with a unit and a word such as "auto" are values in place of a number.
    """
    for place in whole:
        if place.allowed.quantity and not place.inside and (isinstance(place.value, float) or not place.absent):
            yield place


def tables_in(table: type[Table], path: str = "", kind: str = "") -> Iterator[tuple[str, str, type[Table]]]:
    """Yield (dotted path, kind, type) of every table inside `table`, itself first, and of each kind of a union.

    The kind is "" of a table without one. Tables that are items of lists are left out. `path`, `kind`: of `table`
    itself.
    """
    yield path, kind, table
    for name, key in keys_of(table).items():
        for inner_kind, inner in key.allowed.tables.items():
            yield from tables_in(inner, f"{path}.{name}" if path else name, inner_kind)
