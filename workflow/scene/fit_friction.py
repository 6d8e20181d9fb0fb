"""Rules of friction: whom it acts between, and what a tangential needs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from contact1d.workflow.scene.draft import Draft, missing
from contact1d.workflow.scene.experiments import Span
from contact1d.workflow.scene.problems import Problem, shown


def no_plane(draft: Draft) -> Iterator[Problem]:
    """Coulomb's friction is that of a rigid plane: between two chains friction comes from the interaction."""
    if draft.lower is None:
        return
    if draft.kind == "tangential":
        must = 'must be "rigid_plane" in a tangential, whose friction is Coulomb\'s'
        hint = 'between two chains friction comes from the interaction: use kind = "slide"'
        yield Problem("bodies.lower", must, shown(draft.lower), hint)
    elif draft.has("friction"):
        hint = 'remove it, or use bodies.lower = "rigid_plane" and kind = "tangential"'
        yield Problem("friction", "not between two chains, whose friction comes from the interaction", hint=hint)


def tangential(draft: Draft) -> Iterator[Problem]:
    """A tangential has friction, and one normal load, or one for each of its rows."""
    if draft.kind != "tangential":
        return
    if not draft.has("friction"):
        yield missing("friction", "a tangential")
    keys = ("normal_force", "normal_displacement")
    force, displacement = (draft.has("experiment", key) for key in keys)
    if force == displacement:
        what, key = ("not together with normal_force", keys[1]) if force else ("missing", keys[0])
        hint = "give one of normal_force and normal_displacement"
        yield Problem(f"experiment.{key}", what, hint=hint)
        return
    key = keys[0] if force else keys[1]
    given, rows = draft.get("experiment", key), _rows(draft)
    if given is None:
        return
    if isinstance(given, list) and rows is not None and len(given) != rows:
        must = f"must be one number or as many as there are displacements, {rows}"
        yield Problem(f"experiment.{key}", must, f"{len(given)} of them")
    if max(given if isinstance(given, list) else [given]) <= 0.0:
        hint = "the bodies would never touch"
        yield Problem(f"experiment.{key}", "must be greater than 0 somewhere", shown(given), hint)


def _rows(draft: Draft) -> int | None:
    """How many rows the displacements of a tangential are; None where that is not known."""
    places = draft.get("experiment", "displacements")
    if isinstance(places, Mapping):
        return len(Span.model_validate(places).values())
    return len(places) if isinstance(places, list) else None
