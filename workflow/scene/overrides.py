"""Changes to a scene from outside: `table.key=value` sets a value, a name of an effect removes its table."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from typing import Any

from contact1d.workflow.scene.problems import Problem, nearest, shown
from contact1d.workflow.scene.tables import EFFECTS


def apply_overrides(data: dict[str, Any], overrides: Iterable[str]) -> list[Problem]:
    """Set in `data` what each of `overrides` says, in order; returns the problems of those that say nothing.

    A value is read as TOML, or as bare text where it is not TOML; tables on the way that are absent are made.
    """
    return [problem for override in overrides if (problem := _apply(data, override))]


def set_values(data: dict[str, Any], values: Mapping[str, Any]) -> list[Problem]:
    """Set in `data` the value of each dotted key; None takes the key away. Returns the problems."""
    form = "write table.key, for example experiment.method"
    return [problem for path, value in values.items() if (problem := _set(data, path, value, f"set {path}", form))]


def remove_effects(data: dict[str, Any], names: Iterable[str]) -> list[Problem]:
    """Remove from `data` the table of each effect in `names`; returns the problems of those that cannot be removed."""
    problems = []
    for name in dict.fromkeys(names):
        if name in EFFECTS and name in data:
            del data[name]
            continue
        if name in EFFECTS:
            there = ", ".join(effect for effect in EFFECTS if effect in data) or "none"
            problems.append(Problem(f"without {name}", "the scene has no such table", hint=f"effects there: {there}"))
            continue
        meant = nearest(name, EFFECTS)
        hint = (f'did you mean "{meant}"? ' if meant else "") + f"effects: {', '.join(EFFECTS)}"
        problems.append(Problem(f"without {name}", "not an effect that can be removed", hint=hint))
    return problems


def _apply(data: dict[str, Any], override: str) -> Problem | None:
    path, equals, text = override.partition("=")
    where = f"set {shown(override)}"
    form = "write table.key=value, for example experiment.method=dynamic"
    if not equals or not text.strip():
        return Problem(where, "no value", hint=form)
    return _set(data, path, _parsed(text.strip()), where, form)


def _set(data: dict[str, Any], path: str, value: Any, where: str, form: str) -> Problem | None:
    keys = [key.strip() for key in path.split(".")]
    if not all(re.fullmatch(r"[A-Za-z0-9_-]+", key) for key in keys):
        return Problem(where, "not a path of keys", hint=form)
    table = data
    for depth, key in enumerate(keys[:-1], start=1):
        table = table.setdefault(key, {})
        if not isinstance(table, dict):
            return Problem(where, f"{'.'.join(keys[:depth])} is not a table", hint="set it as a whole")
    table[keys[-1]] = value
    return None


def _parsed(text: str) -> Any:
    try:
        values = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return values["value"] if len(values) == 1 else text
