"""What a key of a scene may hold, in words, from its type alone: "a number greater than 0 (LU), or "auto""."""

from __future__ import annotations

import types
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le
from pydantic import Discriminator, Tag

from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import Table, Unit, annotation_of, keys_of
from contact1d.workflow.scene.si_text import example


def unwrapped(annotation: object) -> tuple[Any, tuple[Any, ...]]:
    """The type inside `Annotated`, and its marks; a plain type has none."""
    if get_origin(annotation) is Annotated:
        inner, *marks = get_args(annotation)
        return inner, tuple(marks)
    return annotation, ()


def members(annotation: object) -> tuple[Any, ...]:
    """The members of a union but None, or the one type itself."""
    inner, _ = unwrapped(annotation)
    if get_origin(inner) in (Union, types.UnionType):
        found = _but_none(inner)
        return members(found[0]) if len(found) == 1 else found
    return (annotation,)


def branches(annotation: object) -> dict[str, Any]:
    """The members of a discriminated union by tag (the name that pydantic puts into its locations), or nothing."""
    inner, marks = unwrapped(annotation)
    if get_origin(inner) in (Union, types.UnionType) and len(found := _but_none(inner)) == 1:
        return branches(found[0])
    if not any(isinstance(mark, Discriminator) for mark in marks):
        return {}
    return {_tag(member): member for member in members(annotation)}


def table_of(annotation: object) -> type[Table] | None:
    """The table that this type is, or None for anything that is not one table."""
    inner = unwrapped(members(annotation)[0])[0]
    return inner if isinstance(inner, type) and issubclass(inner, Table) and len(members(annotation)) == 1 else None


def kinds_of(annotation: object) -> tuple[str, ...]:
    """The words allowed for `kind` in tables of this type, or nothing where a table has no kinds."""
    tables = [table for member in members(annotation) if (table := table_of(member)) and "kind" in keys_of(table)]
    return tuple(word for table in tables for word in words_of(annotation_of(table, "kind")))


def words_of(annotation: object) -> tuple[str, ...]:
    """All words that this type allows (of its `Literal` members), or nothing."""
    inner = [unwrapped(member)[0] for member in members(annotation)]
    return tuple(word for member in inner if get_origin(member) is Literal for word in get_args(member))


def statement(annotation: object) -> str:
    """What a value of this type must be, in words: continues "must be"."""
    choices = members(annotation)
    if len(choices) > 1:
        if all(table_of(choice) for choice in choices):
            return f"a table with kind = {_either(kinds_of(annotation))}"
        return ", or ".join(statement(choice) for choice in choices)
    inner, marks = unwrapped(choices[0])
    if get_origin(inner) is Literal:
        return _either(get_args(inner))
    if get_origin(inner) is tuple:
        return f"a list, each item {statement(get_args(inner)[0])}"
    if table := table_of(inner):
        if table.as_list:
            return f"a list [{', '.join(keys_of(table))}]"
        return f"a table with {', '.join(keys_of(table))}" if table.model_fields else "a table without keys"
    simple = {bool: "true or false", str: "text in quotes", int: "a whole number", float: "a number"}
    return simple[inner] + _range(marks) + _unit(marks)


def text_of(annotation: object) -> str:
    """An example of a text with a unit that a number of this type may be, "10 mm"; nothing where it has no unit."""
    for member in members(annotation):
        inner, marks = unwrapped(member)
        units = [mark for mark in marks if isinstance(mark, Unit) and mark.name != "1" and inner is float]
        text = (
            example(units[0].texts[0]) if units else text_of(get_args(inner)[0]) if get_origin(inner) is tuple else ""
        )
        if text:
            return text
    return ""


def described(annotation: object) -> str:
    """`statement`, and for a number that has a unit that it may as well be text: "…, or text such as "10 mm""."""
    text = text_of(annotation)
    return statement(annotation) + (f", or text such as {as_toml(text)}" if text else "")


def unit_of(annotation: object) -> str | None:
    """The model unit of a number (or of the items of a list of numbers), "1" without dimension; None if no number."""
    for member in members(annotation):
        inner, marks = unwrapped(member)
        names = [mark.name for mark in marks if isinstance(mark, Unit)]
        if names:
            return names[0]
        if get_origin(inner) is tuple:
            return unit_of(get_args(inner)[0])
    return None


def _but_none(union: object) -> tuple[Any, ...]:
    return tuple(member for member in get_args(union) if member is not type(None))


def _tag(member: object) -> str:
    tags = [mark.tag for mark in unwrapped(member)[1] if isinstance(mark, Tag)]
    return tags[0] if tags else kinds_of(member)[0]


def _either(words: tuple[str, ...]) -> str:
    quoted = [as_toml(word) for word in words]
    return quoted[0] if len(quoted) == 1 else f"{', '.join(quoted[:-1])} or {quoted[-1]}"


def _range(marks: tuple[Any, ...]) -> str:
    above = [f"{mark.gt:g}" for mark in marks if isinstance(mark, Gt)]
    least = [f"{mark.ge:.10g}" for mark in marks if isinstance(mark, Ge)]
    most = [f"{mark.le:.10g}" for mark in marks if isinstance(mark, Le)]
    if least and most:
        return f" from {least[0]} to {most[0]}"
    if above:
        return f" greater than {above[0]}" + "".join(f" and at most {bound}" for bound in most)
    return "".join([f" of at least {bound}" for bound in least] + [f" of at most {bound}" for bound in most])


def _unit(marks: tuple[Any, ...]) -> str:
    names = [mark.name for mark in marks if isinstance(mark, Unit) and mark.name != "1"]
    return f" ({names[0]})" if names else ""
