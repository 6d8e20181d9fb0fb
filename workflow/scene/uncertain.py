"""Numbers of a scene with an uncertainty: "10 ± 0.1 mm", "70 GPa ± 5 %", at a coverage of 95 %.

What follows ± is kept as a share of the value, which no change of units alters. The model is run with the value alone;
the error budget then moves each such number both ways (`continuation.budget`).
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from copy import copy
from fractions import Fraction
from typing import Any

from contact1d.workflow.scene.problems import keys_in
from contact1d.workflow.scene.quantities import Place, Table, keys_of, numbers_in
from contact1d.workflow.scene.si_text import NUMBER, UnitTextError, quantity, si_value, split

SIGN = re.compile(r"\s*(?:±|\+/?-)\s*")
TOGETHER = re.compile(r"\((.*)\)(.*)")
"""Value and uncertainty with one unit: (10 ± 0.1) mm."""
EXACT = (
    "accuracy.tolerance", "bodies.spacing", "bodies.upper_spacing", "bodies.upper_offset", "interaction.cutoff",
    "material.length_unit", "material.force_unit", "material.mass_unit", "bodies.profile.scale",
)  # fmt: skip
"""Numbers that choose how a contact is calculated or written, and are no property of it."""


def take_shares(scene: Place) -> dict[str, float]:
    """Return the 95 % half-width of each number with ± over its magnitude (relative), by dotted key; empty without any.

    The scene keeps the value alone, in place. In Python a number may be a pair of value and half-width, each a text or
    a number. Errors are reported: a text that cannot be read is left out and remains; a number that may have no
    uncertainty, or one of half of its value or more, or 0 or less, is among the results nevertheless.
    """
    shares = {}
    for place in numbers_in(scene):
        parts = _parts(place.value)
        if parts is None:
            continue
        place.source, path = copy(place), place.path
        try:
            value, share = _read(place, *parts)
        except UnitTextError as error:
            place.fault(str(error))
            continue
        place.put(value)
        if isinstance(place.keys[-1], int) or path in EXACT:
            place.fault("has no uncertainty", "write the value alone")
        elif not 0 < 2 * share < 1:
            place.fault("must have an uncertainty greater than 0 and less than half of its value")
        shares[path] = float(share)
    return shares


def _parts(value: object) -> tuple[Any, Any] | None:
    """Return (value, half-width) as written in a text with ± (or +- or +/-) or a list of two; None for anything else.

    The unit of "(10 ± 0.1) mm" is then behind both. An item of a list may have any type; nothing is checked.
    """
    if isinstance(value, str) and len(parts := SIGN.split(value)) == 2 and parts[0]:
        if match := TOGETHER.fullmatch(value.strip()):
            parts = [f"{part}{match[2]}" for part in SIGN.split(match[1])]
        return parts[0], parts[1]
    return (value[0], value[1]) if isinstance(value, list) and len(value) == 2 else None


def _read(place: Place, value: Any, spread: Any) -> tuple[Any, Fraction]:
    """Return (value as a scene has it, half-width over the magnitude of the value, exact).

    The value is a float if neither has a unit, or of a plain value with a half-width in %. Of "10 ± 0.1 mm" it is the
    text "10 mm", with the unit of the half-width. A value that is no plain number is returned as written; with "%" it
    is not checked. The magnitude of a temperature is the absolute one, 293.15 K of "20 °C". The second is 0 for a value
    of 0, except with "%", and negative for a negative half-width.

    Args:
        place: key of the number.
        value: as written.
        spread: half-width as written, with a unit, "%" or neither.

    Raises:
        UnitTextError: the half-width has no number; or without "%" the value is no number or quantity, a unit does not
            fit the key, the value has a unit and the half-width has none, or the half-width is a temperature in °C or
            °F.
    """
    number, half, text, units = _plain(value), _plain(spread), str(spread).strip(), place.unit.texts
    if not any(map(str.isdigit, text)):
        raise UnitTextError('must have a number behind ±, as in "10 ± 0.1 mm" or "10 mm ± 1 %"')
    if text.endswith("%"):
        share = _plain(text[:-1])
        if share is None:
            raise UnitTextError("must have a number before %")
        return value if number is None else float(number), share / 100
    if number is not None and half is not None:
        return float(number), half / abs(number) if number else Fraction(0)
    if half is not None:
        raise UnitTextError(f'must have a unit or % behind ± as well: write "{value} ± {spread} %"')
    if number is not None:  # 10 ± 0.1 mm
        value = f"{value} {split(text)[1]}"
    if quantity(text)[1].zero:
        raise UnitTextError("must have the uncertainty of a temperature in K, or in %")
    size = si_value(str(value), *units)[0]
    return value, si_value(text, *units)[0] / abs(size) if size else Fraction(0)


def _plain(value: Any) -> Fraction | None:
    """Return a finite number, or that of a text without a unit, as the fraction of its decimals; None for all else.

    None for booleans, infinity and NaN, too.
    """
    if isinstance(value, int | float) and not isinstance(value, bool):
        return Fraction(repr(value)) if value - value == 0 else None
    plain = str(value).strip().replace("−", "-")
    return Fraction(plain) if NUMBER.fullmatch(plain) else None


def with_shares(tables: dict[str, Any], shares: Mapping[str, float]) -> dict[str, Any]:
    """Return the tables with ± at the numbers of these dotted keys, "10.0 ± 1.0 %"; they are changed in place.

    `shares`: half-widths over the values (relative). Keys that the tables do not have are left out.
    """
    for path, share in shares.items():
        *above, key = keys_in(path)
        table: Any = tables
        with suppress(LookupError):
            for name in above:
                table = table[name]
            table[key] = f"{table[key]!r} ± {100.0 * share!r} %"
    return tables


def moved(part: Any, keys: Sequence[Any], factor: float) -> Any:
    """Return a copy of a table, list of tables or number with the number at these keys times a factor.

    It is not checked. The original is unchanged; without keys it is itself the number. An index beyond the end of a
    list changes nothing; KeyError for a key that the table does not have.
    """
    if not keys:
        return factor * part
    first, *rest = keys
    if isinstance(part, tuple):
        return tuple(moved(entry, rest, factor) if i == first else entry for i, entry in enumerate(part))
    kind: type[Table] = type(part)
    field = keys_of(kind)[first].field
    return part.model_copy(update={field: moved(getattr(part, field), rest, factor)})
