"""A scene that is not checked yet, as its rules see it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from contact1d.digits import apart
from contact1d.workflow.scene.experiments import KINDS
from contact1d.workflow.scene.kinds import Kind
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.si_text import split
from contact1d.workflow.scene.tables import (
    EFFECT_TABLES,
)

WHOLE_NUMBER_ERROR = 1e-9
"""Relative error of a quotient of two decimals up to which it counts as whole, or two lengths as equal."""
LONGEST_CELL = 1000
"""Most particles of a pair of chains that is suggested in place of one that does not close."""
DIGITS = 6
"""Of a number in a message, at least."""
PLANE = 'bodies.lower = "rigid_plane"'
PARTICLES = 'bodies.lower = "particles"'
GIVE_SPACING = "give bodies.spacing as a length (LU)"
ELASTICITY = "material.upper and material.lower with E and ν, or material.contact_modulus"
Row = tuple[str, object, str, str] | tuple[str, object, str, str, Mapping[str, float]]
Rows = Iterator[Row]
SAID_OF = {"miss": True, "not ": False, "only": False}
"""Whether messages that begin so are about a key that is absent; others may be about any."""


class Draft:
    """A scene that may have wrong values.

    A dotted path is `in` it where anything stands, right or wrong. By a path it gives what stands there or counts where
    nothing does, and None where that is not known or there is no such table.

    Attributes:
        kind, lower, profile: what the experiment, the lower body and the profile are; None if that is not known.
        experiment: the experiment's table, which declares what it needs; `Kind` if it is not known.
        on_plane, on_chain: whether the lower body is known to be a rigid plane, or to be of particles.
        effects: those whose tables are there.
    """

    def __init__(self, scene: Place) -> None:
        """Keep the scene."""
        self.scene = scene
        self.kind, self.lower, self.profile = self["experiment.kind"], self["bodies.lower"], self["bodies.profile.kind"]
        self.experiment = KINDS.get(self.kind, Kind)
        self.on_plane = self.lower == "rigid_plane"
        self.on_chain = not self.on_plane and self.lower is not None
        self.effects = tuple(name for name in EFFECT_TABLES if name in self)

    def __contains__(self, path: str) -> bool:
        """Whether something stands at `path`."""
        place = self.scene.at(path)
        return place is not None and not place.absent

    def __getitem__(self, path: str) -> Any:
        """See above."""
        place = self.scene.at(path)
        return place.value if place and place.sound else None

    def written(self, path: str, number: float) -> float | str:
        """A number for `path` to six digits, in the unit of the text that stands there."""
        place = self.scene.at(path)
        if not place or not place.source or not place.value:
            return float(f"{number:.{DIGITS}g}")
        given, unit = split(place.source.value)
        return f"{number / place.value * float(given):.{DIGITS}g}{unit}"


def limit(value: float, of: float) -> str:
    """The limit of a value that lies beyond it, as text that shows that."""
    return apart(value, of, DIGITS)[1]
