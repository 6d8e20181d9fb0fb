"""Rules of adhesion on a rigid plane: whom it acts between, and what of it is given."""

from __future__ import annotations

from collections.abc import Iterator

from contact1d.workflow.scene.draft import Draft
from contact1d.workflow.scene.problems import Problem, shown
from contact1d.workflow.scene.tables import Bodies

KEYS = ("work_of_adhesion", "surface_energy")
NOT_WITH = {
    "neighbours": "JKR's contact is a row of independent springs, and neighbours would tie them together",
    "noise": "particles that stand still in their body have no heat of their own",
}
"""Effects that adhesion on a plane cannot have, and why."""


def no_adhesion(draft: Draft) -> Iterator[Problem]:
    """Between two chains it is the interaction that attracts."""
    if draft.lower is not None and draft.has("adhesion"):
        hint = 'use interaction.attraction, or bodies.lower = "rigid_plane"'
        yield Problem("adhesion", "not between two chains, which attract each other by the interaction", hint=hint)


def adhesion(draft: Draft) -> Iterator[Problem]:
    """One energy, the reduction that it belongs to, springs that know nothing of each other."""
    if not draft.has("adhesion"):
        return
    given = [key for key in KEYS if draft.has("adhesion", key)]
    if draft.sound("adhesion") and len(given) != 1:
        what, hint = ("not together with work_of_adhesion", "one is twice the other: remove one")
        if not given:
            what, hint = "missing", "give W, or with surface_energy γ of one side, half of it"
        yield Problem(f"adhesion.{KEYS[bool(given)]}", what, hint=hint)
    for key in given:
        if draft.kind == "pull_off" and draft.get("adhesion", key) == 0.0:
            hint = 'nothing would hold the bodies together: raise it, or use kind = "load" or "path"'
            yield Problem(f"adhesion.{key}", "must be greater than 0 (FU/LU) in a pull_off", shown(0.0), hint)
    if draft.lower != "rigid_plane":
        return
    reduction = draft.get("bodies", "reduction", default=Bodies.model_fields["reduction"].default)
    if reduction == "geike_popov":
        must = 'must be "mdr" with [adhesion], whose edge is that of a contact of three dimensions'
        yield Problem("bodies.reduction", must, shown(reduction), 'write reduction = "mdr"')
    if draft.kind == "path" and draft.has("damping"):
        hint = 'remove it: method = "quasistatic" is the same without time'
        yield Problem(
            "damping", "not with [adhesion] in a path: where the plate's place is given nothing moves", hint=hint
        )
    for name, why in NOT_WITH.items():
        if draft.has(name):
            yield Problem(name, f"not with [adhesion]: {why}", hint=f"remove it, or [adhesion] and [{name}] apart")
