"""A change of a scene that may help: values by dotted keys, and effects that are left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from contact1d.workflow.scene.problems import as_toml

STEP = 3.0
"""Factor of a change to a load, a stiffness, an amplitude or a way."""


@dataclass(frozen=True)
class Change:
    """Values by dotted keys, and effects that are left out."""

    values: Mapping[str, object] = field(default_factory=dict)
    without: tuple[str, ...] = ()

    @property
    def overrides(self) -> tuple[str, ...]:
        """The values as `read_scene` takes them."""
        return tuple(
            f"{key}={value if isinstance(value, str) else as_toml(value)}" for key, value in self.values.items()
        )

    def __str__(self) -> str:
        """As options of `contact1d run`."""
        return " ".join([*(f"--without {name}" for name in self.without), *(f"--set {one}" for one in self.overrides)])

    def then(self, other: Change) -> Change:
        """Both; of two values for a key the other's."""
        return Change({**self.values, **other.values}, tuple(dict.fromkeys((*self.without, *other.without))))

    def touches(self, other: Change) -> bool:
        """Whether both change the same."""
        return bool(self.values.keys() & other.values.keys() or set(self.without) & set(other.without))


def rounded(value: float) -> float:
    """Three digits."""
    return float(f"{value:.3g}") if math.isfinite(value) else value
