"""A scene that is being checked: what stands where, and which of it can be relied on."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from contact1d.workflow.scene.problems import Problem
from contact1d.workflow.scene.tables import Bodies

ADD = {
    "damping": '[damping] with coefficient = "auto"',
    "plate": '[plate] with mass = "auto"',
    "cantilever": "[cantilever] with stiffness and velocity",
    "friction": "[friction] with its coefficient",
    "horizontal": "[horizontal], an empty table: without it particles cannot follow a plate along x",
}
"""How to add a table that is missing."""


@dataclass(frozen=True)
class Draft:
    """A scene that may have wrong values: `data` as in the file, and the keys at which a value is `unsound`."""

    data: Mapping[str, Any]
    unsound: frozenset[tuple[str | int, ...]]

    def has(self, *keys: str) -> bool:
        """Whether something, right or wrong, stands at `keys`."""
        value: Any = self.data
        for key in keys:
            value = value.get(key) if isinstance(value, Mapping) else None
        return value is not None

    def sound(self, *keys: str) -> bool:
        """Whether what stands at `keys`, if anything, is right, with all that is above and inside it."""
        return not any(bad[: len(keys)] == keys[: len(bad)] for bad in self.unsound)

    def get(self, *keys: str, default: Any = None) -> Any:
        """The value at `keys`, `default` where it is absent, None where it is unsound."""
        if not self.sound(*keys):
            return None
        value: Any = self.data
        for key in keys:
            value = value.get(key) if isinstance(value, Mapping) else None
        return default if value is None else value

    @property
    def kind(self) -> str | None:
        """Kind of the experiment, None if that is not known."""
        kind = self.get("experiment", "kind")
        return kind if isinstance(kind, str) else None

    @property
    def lower(self) -> str | None:
        """What the lower body is, None if that is not known."""
        lower = self.get("bodies", "lower", default=Bodies.model_fields["lower"].default)
        return lower if isinstance(lower, str) and self.has("bodies") else None


def missing(name: str, needed_by: str) -> Problem:
    """The problem of a table that is missing."""
    return Problem(name, f"missing, needed by {needed_by}", hint=f"add {ADD[name]}")
