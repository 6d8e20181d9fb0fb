"""Rules across tables for what slides: the way of the drive, what holds the bodies, chains that close on themselves.

Two periodic chains of n and m particles close together only if n·s_lower = m·s_upper.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING

from contact1d.workflow.scene.problems import Problem, shown

if TYPE_CHECKING:
    from contact1d.workflow.scene.draft import Draft

CLOSED = 1e-9
"""Relative difference of two lengths up to which chains count as closing together."""
LONGEST_CELL = 1000
"""Most particles of a pair of chains that is looked for in place of one that does not close."""


def way_of_slide(draft: Draft) -> Iterator[Problem]:
    """A slide has one distance or a path."""
    if draft.kind != "slide":
        return
    has = [name for name in ("distance", "path") if draft.has("experiment", name)]
    if not has:
        hint = "must be a number greater than 0 (LU), or give a path = [[velocity, distance], …]"
        yield Problem("experiment.distance", "missing", hint=hint)
    if len(has) == 2:
        yield Problem("experiment.path", "not together with a distance", hint="remove one of the two")


def slide_is_held(draft: Draft) -> Iterator[Problem]:
    """Without attraction only a compressive force keeps the bodies together."""
    force = draft.get("experiment", "normal_force")
    if draft.kind != "slide" or force is None or force > 0 or draft.has("interaction", "attraction"):
        return
    hint = "compression is positive; a force of 0 or a pull needs interaction.attraction"
    yield Problem("experiment.normal_force", "must be greater than 0 (FU) without attraction", shown(force), hint)


def periodic_bodies(draft: Draft) -> Iterator[Problem]:
    """Only flat chains that close together go on for ever, and only their sliding is looked at."""
    profile, periodic = draft.get("bodies", "profile", "kind"), draft.get("bodies", "periodic")
    if profile == "flat" and not periodic and draft.sound("bodies", "periodic"):
        hint = 'write periodic = true, or use kind = "flat_punch", which has an end'
        yield Problem("bodies.profile.kind", "needs bodies.periodic", shown("flat"), hint)
    if not periodic:
        return
    if profile not in (None, "flat"):
        hint = 'use profile = { kind = "flat" }, or leave periodic out'
        yield Problem("bodies.periodic", "not with a body that is not flat: it would end nowhere", hint=hint)
    if draft.kind not in (None, "slide"):
        yield Problem("bodies.periodic", f"not in a {draft.kind}", hint='remove it, or use kind = "slide"')
    normal, tangential = (draft.get("bodies", f"bulk_stiffness{end}") for end in ("", "_tangential"))
    if isinstance(normal, float | int) and isinstance(tangential, float | int) and tangential > normal:
        must = f"must be at most bulk_stiffness, {normal:g} (FU/LU), with bodies.periodic"
        hint = "what is stiffer along x hangs on far anchors along x, and a periodic body has no such place"
        yield Problem("bodies.bulk_stiffness_tangential", must, shown(tangential), hint)
    yield from _closing(draft)


def _closing(draft: Draft) -> Iterator[Problem]:
    """n·s_lower = m·s_upper, or the nearest numbers that do."""
    count, spacing = draft.get("bodies", "particles"), draft.get("bodies", "spacing")
    if count == "auto":
        hint = "a flat body without end has no contact that could tell: give a number"
        yield Problem("bodies.particles", "must be a number with bodies.periodic", shown("auto"), hint)
        return
    upper = draft.get("bodies", "upper_particles", default=count)
    pitch = draft.get("bodies", "upper_spacing", default=spacing)
    if None in (count, spacing, upper, pitch) or "auto" in (spacing, pitch) or upper == 1:
        return
    if abs(count * spacing - upper * pitch) <= CLOSED * count * spacing:
        return
    ratio = Fraction(pitch / spacing).limit_denominator(LONGEST_CELL)
    nearest = count * spacing / upper
    pair = f"upper_spacing = {nearest:.10g} with these numbers of particles"
    if 0 < ratio.numerator <= LONGEST_CELL:
        cells = max(1, round(upper / ratio.denominator))
        pair += (
            f", or particles = {cells * ratio.numerator} and upper_particles = {cells * ratio.denominator} with "
            f"upper_spacing = {ratio.numerator / ratio.denominator * spacing:.10g}"
        )
    message = f"do not close: {count} · {spacing:g} LU below and {upper} · {pitch:g} LU above"
    yield Problem("bodies.upper_spacing", f"periodic chains {message}", shown(pitch), f"the nearest that do: {pair}")


def rigid_chain(draft: Draft) -> Iterator[Problem]:
    """What is placed beside or instead of particles belongs to a lower body of particles."""
    if draft.lower != "rigid_plane":
        return
    for key in ("upper_particles", "upper_spacing", "upper_offset", "periodic"):
        if draft.has("bodies", key) and draft.get("bodies", key) is not False:
            hint = 'remove it, or use bodies.lower = "particles" or "rigid_chain"'
            yield Problem(f"bodies.{key}", 'not with bodies.lower = "rigid_plane", which has no particles', hint=hint)


def thermal_pull_off(draft: Draft) -> Iterator[Problem]:
    """Under heat a pull-off depends on how long it waits, and only then has it a rate and repeats."""
    if draft.kind != "pull_off":
        return
    timeless = draft.get("experiment", "method") == "quasistatic"
    has = [key for key in ("loading_rate", "velocity") if draft.has("experiment", key)]
    if draft.has("noise") and not timeless and not has:
        hint = "give the force per time by which the load is drawn off, in FU/TU, or a velocity (LU/TU) at which a "
        hint += "spring draws the plate off, or remove [noise]"
        yield Problem("experiment.loading_rate", "missing, needed by a pull_off with [noise]", hint=hint)
    if len(has) == 2:
        yield Problem("experiment.velocity", "not together with a loading_rate", hint="remove one of the two")
    if draft.has("experiment", "stiffness") and "velocity" not in has:
        hint = "remove it, or give the velocity at which its far end is drawn off"
        yield Problem("experiment.stiffness", "only with a velocity: it is that of the spring", hint=hint)
    for key in ("loading_rate", "velocity", "stiffness", "repeats"):
        if draft.has("experiment", key) and not draft.has("noise"):
            hint = "remove it, or add [noise] with temperature and seed"
            yield Problem(f"experiment.{key}", "only with [noise]: without heat each pull ends alike", hint=hint)


SLIDING_RULES = (thermal_pull_off, way_of_slide, slide_is_held, periodic_bodies, rigid_chain)
