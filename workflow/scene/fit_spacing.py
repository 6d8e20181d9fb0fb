"""Rules of `bodies.spacing = "auto"`: a contact whose continuum tells how fine is fine enough, all of it per length."""

from __future__ import annotations

from collections.abc import Iterator

from contact1d.workflow.scene.draft import Draft
from contact1d.workflow.scene.problems import Problem, shown

OF_ONE_PARTICLE = ("neighbours", "damping", "noise", "plate")
"""Effects whose numbers, or the motion that they make, belong to particles of one mass and one distance."""


def automatic_spacing(draft: Draft) -> Iterator[Problem]:
    """On a rigid plane, at rest, with particles and stiffness that follow from it."""
    if draft.get("bodies", "spacing") != "auto":
        return
    give = "give a length (LU)"
    if draft.lower not in (None, "rigid_plane"):
        must = f"must be a length (LU) with bodies.lower = {shown(draft.lower)}, whose forces belong to its particles"
        hint = f'{give}; "auto" is for lower = "rigid_plane", where the results have a limit for ever nearer ones'
        yield Problem("bodies.spacing", must, shown("auto"), hint)
        return
    count = draft.get("bodies", "particles", default="auto")
    if count not in (None, "auto"):
        must = 'must be "auto" with spacing = "auto"'
        yield Problem("bodies.particles", must, shown(count), f"write it, or {give} for bodies.spacing")
    stiffness = draft.get("bodies", "bulk_stiffness", default="auto")
    if stiffness not in (None, "auto"):
        must = 'must be "auto" with spacing = "auto": the stiffness of a particle is E* times the spacing'
        hint = f"write it, and [material] with E and ν of both bodies or contact_modulus, or {give} for bodies.spacing"
        yield Problem("bodies.bulk_stiffness", must, shown(stiffness), hint)
    if draft.has("bodies", "bulk_stiffness_tangential"):
        what = 'not with spacing = "auto": it belongs to one particle'
        hint = f"remove it: it follows from ν of material.upper and lower; or {give} for bodies.spacing"
        yield Problem("bodies.bulk_stiffness_tangential", what, hint=hint)
    if draft.get("bodies", "profile", "kind") == "flat":
        hint = f'{give}, or use kind = "flat_punch"'
        yield Problem("bodies.spacing", "must be a length (LU) of a flat body without an edge", shown("auto"), hint)
    present = [name for name in OF_ONE_PARTICLE if draft.has(name)]
    if present or draft.get("experiment", "method") == "dynamic":
        what = f"[{present[0]}]" if present else 'method = "dynamic"'
        must = f"must be a length (LU) with {what}: masses, drags and springs between particles belong to one spacing"
        yield Problem("bodies.spacing", must, shown("auto"), f"{give}, or remove {what}")
