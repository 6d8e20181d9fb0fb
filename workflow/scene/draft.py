"""A scene that is not checked yet, as its rules see it, and what a rule is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cache
from typing import Any

from contact1d.digits import apart
from contact1d.workflow.scene.experiments import KINDS
from contact1d.workflow.scene.kinds import Kind
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.si_text import split
from contact1d.workflow.scene.tables import EFFECT_TABLES, TIMED

WHOLE_NUMBER_ERROR = 1e-9
"""Relative error of a quotient of two decimals up to which it counts as whole, or two lengths as equal."""
LONGEST_CELL = 1000
"""Most particles of a pair of chains that is suggested in place of one that does not close."""
TIED = ("neighbours", "damping", "noise", "plate")
"""Effects whose stiffness, drag or mass is that of particles at one spacing."""
DIGITS = 6
"""Of a number in a message, at least."""
PLANE = 'bodies.lower = "rigid_plane"'
PARTICLES = 'bodies.lower = "particles"'
GIVE_SPACING = "give bodies.spacing as a length (LU)"
ELASTICITY = "material.upper and material.lower with E and ν, or material.contact_modulus"
Row = tuple[str, object, str, str] | tuple[str, object, str, str, Mapping[str, float]]
"""A rule: its keys, between blanks; when it is broken, in words for `Draft.holds` or calculated; what is wrong and what
to do, after such words with {facts} of the draft; and at times the changes by dotted keys that would each make a scene.
"""
Rows = Iterator[Row]
TERMS = {
    "on_plane": "bodies.lower=rigid_plane",
    "on_chain": "bodies.lower=particles|bodies.lower=rigid_chain",
    # a rigid plane neither drags a slide nor holds a pull-off without adhesion
    "touched": "on_plane !motion_is_result !experiment.kind=pull_off|adhesion",
    "unattracted": "!on_plane|!adhesion on_plane|interaction on_plane|!interaction.attraction",
    "elastic": "material.upper|material.lower|material.contact_modulus",
    # a material of nothing but units says nothing of the bodies
    "judged": "material elastic|!bodies.bulk_stiffness=auto elastic|!material.length_unit|!material.force_unit|"
    "material.surface_energy",
}
"""Conditions that have a word of their own in others: facts, each made of those before it."""
VALUES: Mapping[str, Any] = {"0": 0.0, "true": True, "false": False}
"""Values in a condition that are no text."""
KNOWN = "*"
"""Any value that can be relied on."""


@cache
def _read(conditions: str) -> list[list[tuple[str, str | None, bool]]]:
    """Alternatives of each condition: its word, the value that is wanted, and whether it must hold."""
    found = []
    for words in conditions.split():
        parts = [(word, *word.removeprefix("!").partition("=")) for word in words.split("|")]
        found.append([(name, text if equal else None, word[0] != "!") for word, name, equal, text in parts])
    return found


class Draft:
    """A scene that may have wrong values.

    A dotted path is `in` it where anything stands, right or wrong. By a path it gives what stands there or counts where
    nothing does, and None where that is not known or there is no such table.

    Attributes:
        kind, lower, profile: what the experiment, the lower body and the profile are; None if that is not known.
        experiment: the experiment's table, which declares what it needs; `Kind` if it is not known.
        facts: what conditions call by a word and no path has, `TERMS` too; a text is that of messages.
        effects: those whose tables are there.
    """

    def __init__(self, scene: Place) -> None:
        """Keep the scene."""
        self.scene = scene
        self.kind, self.lower, self.profile = self["experiment.kind"], self["bodies.lower"], self["bodies.profile.kind"]
        self.experiment = KINDS.get(str(self.kind), Kind)
        self.effects = tuple(name for name in EFFECT_TABLES if name in self)
        self.facts = {
            "kind": self.kind,
            "in_time": self._first(TIMED, "with [{}]", "in time"),
            "tied": self._first(() if self.experiment.is_massless else TIED, "[{}]", 'method = "dynamic"'),
            "motion_is_result": self.experiment.motion_is_result,
            "goes_along": self.experiment.goes_along,
            "finds_pull_off": self.experiment.finds_pull_off,
        }
        for name, conditions in TERMS.items():
            self.facts[name] = self.holds(conditions)

    def _first(self, effects: Sequence[str], text: str, dynamic: str) -> str:
        """The first of these effects that is there, else the method if that is dynamic, in words; else none."""
        named = (text.format(name) for name in effects if name in self)
        return next(named, dynamic if self["experiment.method"] == "dynamic" else "")

    def __contains__(self, path: str) -> bool:
        """Whether something stands at `path`."""
        place = self.scene.at(path)
        return place is not None and not place.absent

    def __getitem__(self, path: str) -> Any:
        """See above."""
        place = self.scene.at(path)
        return place.value if place and place.sound else None

    def holds(self, conditions: str) -> bool:
        """Whether all `conditions` hold, between blanks; of alternatives, between bars, one does.

        A condition is one of the `facts`, a path at which something stands, or a path with "=" and the value that is
        known to be there or in the list there. With "!" before it, it must not hold.
        """
        return all(any(self._is(*one) for one in alternatives) for alternatives in _read(conditions))

    def _is(self, name: str, text: str | None, wanted: bool) -> bool:
        if text is not None:
            known, value = self[name], VALUES.get(text, text)
            found = known is not None and (
                text == KNOWN or known == value or (isinstance(known, list | tuple) and value in known)
            )
        else:
            found = bool(self.facts[name]) if name in self.facts else name in self
        return found == wanted

    def written(self, path: str, number: float) -> float | str:
        """A number for `path` to six digits, in the unit of the text that stands there."""
        place = self.scene.at(path)
        text = place.source.value if place and place.source and place.value else None
        if not isinstance(text, str):  # a number, or in Python a pair of it and its uncertainty
            return float(f"{number:.{DIGITS}g}")
        given, unit = split(text)
        return f"{number / self[path] * float(given):.{DIGITS}g}{unit}"


Rule = Row | Callable[[Draft], Rows]
"""A row, or rows that need numbers."""


def limit(value: float, of: float) -> str:
    """The limit of a value that lies beyond it, as text that shows that."""
    return apart(value, of, DIGITS)[1]
