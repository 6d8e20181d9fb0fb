"""A scene that is not checked yet, as its rules read it, and the type of a rule."""

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
AT_ONE_SPACING = ("neighbours", "damping", "noise", "plate")
"""Effects whose stiffness, drag or mass is that of particles at one spacing."""
DIGITS = 6
"""Smallest number of digits of a number in a message."""
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
    "plane_contact": "on_plane !motion_is_result !experiment.kind=pull_off|adhesion",
    "oblique": "experiment.tangential_velocity|experiment.spin",
    "no_attraction": "!on_plane|!adhesion on_plane|interaction on_plane|!interaction.attraction",
    "elastic": "material.upper|material.lower|material.contact_modulus",
    # a material with nothing but units does not describe the bodies
    "describes_bodies": "material elastic|!bodies.bulk_stiffness=auto "
    "elastic|!material.length_unit|!material.force_unit|material.surface_energy",
}
"""Conditions with a name that other conditions use as a fact; each is made of those before it."""
VALUES: Mapping[str, Any] = {"0": 0.0, "true": True, "false": False}
"""Values in a condition that are no text."""
KNOWN = "*"
"""Stands for any value that is known."""


@cache
def _read(conditions: str) -> list[list[tuple[str, str | None, bool]]]:
    """Return for each condition, between blanks, its alternatives, between bars: (name, value, whether it must hold).

    The value is the text after "=", None where the name alone is given; a name with "!" before it must not hold.
    Cached: the lists are shared.
    """
    alternatives = []
    for words in conditions.split():
        parts = [(word, *word.removeprefix("!").partition("=")) for word in words.split("|")]
        alternatives.append([(name, text if equal else None, word[0] != "!") for word, name, equal, text in parts])
    return alternatives


class Draft:
    """A scene that may have wrong values.

    A dotted path is `in` it if the scene has a value there, right or wrong. The item of a path is the value or the
    default, and None where that is unknown or there is no such table.

    Attributes:
        kind, lower, profile: the kinds of the experiment, the lower body and the profile; None if unknown.
        experiment: the experiment's table, which declares what it needs; `Kind` if unknown.
        facts: conditions by a name that is no path, with `TERMS`; a text is that of messages.
        effects: names of the effects whose tables the scene has.
    """

    def __init__(self, scene: Place) -> None:
        """Read the kinds, effects and facts of a scene that may have wrong values; later changes are not followed."""
        self.scene = scene
        self.kind, self.lower, self.profile = self["experiment.kind"], self["bodies.lower"], self["bodies.profile.kind"]
        self.experiment = KINDS.get(str(self.kind), Kind)
        self.effects = tuple(name for name in EFFECT_TABLES if name in self)
        self.facts = {
            "kind": self.kind,
            "in_time": self._first(TIMED, "with [{}]", "in time"),
            "needs_spacing": self._first(
                () if self.experiment.is_massless else AT_ONE_SPACING, "[{}]", 'method = "dynamic"'
            ),
            "motion_is_result": self.experiment.motion_is_result,
            "goes_along": self.experiment.goes_along,
            "finds_pull_off": self.experiment.finds_pull_off,
        }
        for name, conditions in TERMS.items():
            self.facts[name] = self.holds(conditions)

    def _first(self, effects: Sequence[str], text: str, dynamic: str) -> str:
        """Return `text`, in place of {} the name of the first of these effects, in their order, that the scene has.

        Else `dynamic`, where the scene names the dynamic method, else "".
        """
        named = (text.format(name) for name in effects if name in self)
        return next(named, dynamic if self["experiment.method"] == "dynamic" else "")

    def __contains__(self, path: str) -> bool:
        """Return whether the scene has a value, right or wrong, at the dotted key `path`; a default is none."""
        place = self.scene.find(path)
        return place is not None and not place.absent

    def __getitem__(self, path: str) -> Any:
        """Return the value at the dotted key `path`, in model units once texts are converted, or its default.

        None where it is wrong, or there is no such key. An absent key that is required counts as wrong once tables are
        checked; before that it is `PydanticUndefined`.
        """
        place = self.scene.find(path)
        return place.value if place and place.sound else None

    def holds(self, conditions: str) -> bool:
        """Return whether all `conditions`, between blanks, hold: of alternatives, between bars, one at least.

        A condition is a fact by its name (`facts`); a dotted key, which must have a value, right or wrong; or a key
        with "=" and the value that it, or its default, must have, or that its list must contain. "=*" stands for any
        value that is right; a value that is wrong or missing equals none. With "!" before it, it must not hold. True
        without conditions.
        """
        return all(any(self._is(*condition) for condition in alternatives) for alternatives in _read(conditions))

    def _is(self, name: str, text: str | None, wanted: bool) -> bool:
        """Return whether a condition on the key or fact `name` holds if `wanted`, or does not hold if not `wanted`.

        `text`: required value of the key, "*" for any that is right; None: the fact is true, or the scene has the key.
        """
        if text is not None:
            known, value = self[name], VALUES.get(text, text)
            is_true = known is not None and (
                text == KNOWN or known == value or (isinstance(known, list | tuple) and value in known)
            )
        else:
            is_true = bool(self.facts[name]) if name in self.facts else name in self
        return is_true == wanted

    def written(self, path: str, number: float) -> float | str:
        """Return a `number` in model units as it would be written at the dotted key `path`, with six digits.

        Where the value there was a text with a unit, it is a text in that unit, "2 mm"; else a float.
        """
        place = self.scene.find(path)
        text = place.source.value if place and place.source and place.value else None
        if not isinstance(text, str):  # a number, or in Python a pair of it and its uncertainty
            return float(f"{number:.{DIGITS}g}")
        given, unit = split(text)
        return f"{number / self[path] * float(given):.{DIGITS}g} {unit}"


Rule = Row | Callable[[Draft], Rows]
"""A row, or rows that need numbers."""


def limit(value: float, of: float) -> str:
    """Return the number `of`, the limit that `value` exceeds, as text with six digits, without zeros at its end.

    Where these do not show which one is larger, with as many significant digits as do, up to 17.
    """
    return apart(value, of, DIGITS)[1]
