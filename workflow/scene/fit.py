"""Do the tables of a scene fit together? One rule per physical reason, each mistake with what to do about it.

Two bodies touch in one way only if the force f(r) = (A/a) exp(−r/a) − (B/b) exp(−r/b) repels at contact,
A/a > B/b, and attracts far off, b > a. It then vanishes once, at r₀ = ln(A b / (B a)) a b / (b − a).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any

from contact1d.workflow.scene.draft import ADD, Draft, missing
from contact1d.workflow.scene.effects import Plate
from contact1d.workflow.scene.fit_adhesion import adhesion, no_adhesion
from contact1d.workflow.scene.fit_friction import no_plane, tangential
from contact1d.workflow.scene.fit_slide import SLIDING_RULES
from contact1d.workflow.scene.fit_spacing import automatic_spacing
from contact1d.workflow.scene.problems import Problem, shown
from contact1d.workflow.scene.reduction import derived_for_spheres
from contact1d.workflow.scene.tables import EFFECTS, TIMED, default_method

NO_TIME = "its rows follow each other without time, each at rest"
EXCLUDED = {
    "load": {
        "cantilever": "only a slide is pulled through a spring",
        "friction": "nothing moves along x in it, so that friction does nothing",
    },
    "path": {
        "plate": "a path prescribes the plate's place, so the plate has no motion of its own",
        "cantilever": "only a slide is pulled through a spring",
        "friction": "nothing moves along x in it, so that friction does nothing",
    },
    "pull_off": {
        "cantilever": "only a slide is pulled through a spring",
        "friction": "nothing moves along x in it, so that friction does nothing",
    },
    "slide": {
        "adhesion": "it is that of a rigid plane, which drags nothing",
        "friction": "its friction is that of the particles' own forces",
    },
    "tangential": {
        "adhesion": "whether shear peels an edge that adheres or makes it slip is a criterion of its own (Savkoor and "
        "Briggs), which neither JKR nor Mindlin has",
        "neighbours": "friction remembers its way, and a minimiser, which such springs need, has no way",
        "damping": NO_TIME,
        "noise": NO_TIME,
        "plate": f"{NO_TIME}; a plate with inertia would swing past each, without damping for ever, and friction would "
        "remember how far",
        "cantilever": "only a slide is pulled through a spring",
    },
}
"""Effects that an experiment cannot have by any method, and why."""

NEEDED = {
    "load": ("damping", "plate"),
    "path": ("damping",),
    "pull_off": ("damping", "plate"),
    "slide": ("horizontal", "damping", "plate", "cantilever"),
    "tangential": (),
}
"""Effects that a dynamic experiment cannot do without."""


def _lower_body(draft: Draft) -> Iterator[Problem]:
    """Particles need an interaction; a rigid plane has none, neither holds anything nor pulls sideways."""
    if draft.lower in ("particles", "rigid_chain") and not draft.has("interaction"):
        yield Problem("interaction", "missing", hint='add [interaction], or use bodies.lower = "rigid_plane"')
    if draft.lower != "rigid_plane":
        yield from no_plane(draft)
        yield from no_adhesion(draft)
        return
    if draft.kind == "slide" or (draft.kind == "pull_off" and not draft.has("adhesion")):
        why = "hold" if draft.kind == "pull_off" else "drag"
        hint = 'use lower = "particles" and an [interaction]'
        hint += ", or add [adhesion] with work_of_adhesion" if draft.kind == "pull_off" else ""
        yield Problem("bodies.lower", f"a rigid plane cannot {why} the upper body", shown("rigid_plane"), hint)
        return
    if draft.has("interaction"):
        hint = 'remove it, or use bodies.lower = "particles"'
        yield Problem("interaction", 'not with bodies.lower = "rigid_plane", which is touched directly', hint=hint)
    if draft.has("horizontal"):
        hint = 'remove it, or use bodies.lower = "particles"'
        yield Problem("horizontal", "useless on a rigid plane, which never pulls a particle sideways", hint=hint)


def _law(draft: Draft) -> Iterator[Problem]:
    """The interaction repels near and attracts far, so that one distance is force-free; the cutoff is beyond it."""
    terms = [("interaction", term, key) for term in ("repulsion", "attraction") for key in ("amplitude", "range")]
    values = [draft.get(*term) for term in terms]
    if None in values:
        return
    A, a, B, b = values
    if b <= a:
        must = f"must be greater than the range of the repulsion, {a:g} (LU)"
        farther, nearer = float(f"{2.0 * a:.6g}"), float(f"{0.5 * b:.6g}")
        hint = f"the bodies would never attract each other: raise it to {farther:g}, or lower "
        hint += f"repulsion.range to {nearer:g}"
        ways = ({"interaction.attraction.range": farther}, {"interaction.repulsion.range": nearer})
        yield Problem("interaction.attraction.range", must, shown(b), hint, ways)
        return
    ratio = math.log(A) - math.log(a) - math.log(B) + math.log(b)
    if ratio <= 0:
        must = f"must be less than {A / a * b:.6g} (FU·LU), so that A/a > B/b and particles repel when they touch"
        weaker, stronger = float(f"{0.25 * A / a * b:.6g}"), float(f"{4.0 * B / b * a:.6g}")
        hint = f"lower it to {weaker:g}, or raise repulsion.amplitude to {stronger:g}"
        ways = ({"interaction.attraction.amplitude": weaker}, {"interaction.repulsion.amplitude": stronger})
        yield Problem("interaction.attraction.amplitude", must, shown(B), hint, ways)
        return
    r0 = ratio * a * b / (b - a)
    cutoff = draft.get("interaction", "cutoff", default="auto")
    if cutoff is not None and cutoff != "auto" and cutoff <= r0:
        must = f"must be greater than the force-free distance, {r0:.6g} (LU)"
        yield Problem("interaction.cutoff", must, shown(cutoff), 'raise it, or use "auto"')


def _tables_of_experiment(draft: Draft) -> Iterator[Problem]:
    """Each experiment and method has tables that it needs and tables that it cannot have."""
    present = tuple(name for name in EFFECTS if draft.has(name))
    kind = draft.kind
    if kind is None:
        if "noise" in present and "damping" not in present:
            yield missing("damping", "[noise]")
        return
    for name, why in EXCLUDED[kind].items():
        if name in present:
            other = next((one for one, excluded in EXCLUDED.items() if not excluded.keys() & {*present}), None)
            hint = "remove it" + (f', or use kind = "{other}"' if other else "")
            yield Problem(name, f"not in a {kind}: {why}", hint=hint)
    if not draft.sound("experiment", "method"):
        return
    rest = tuple(name for name in present if name not in EXCLUDED[kind])
    given = "dynamic" if kind == "slide" else draft.get("experiment", "method")
    method = given or default_method(rest)
    if method == "quasistatic":
        for name in TIMED:
            if name in rest:
                hint = 'remove it, or use experiment.method = "dynamic"'
                yield Problem(name, f"not in a quasistatic {kind}, which has no time in it", hint=hint)
        return
    cause = "" if given else ", made dynamic by " + ", ".join(f"[{name}]" for name in rest if name in TIMED)
    for name in NEEDED[kind]:
        if name not in present:
            also = " and by [noise]" if given and name == "damping" and "noise" in rest else ""
            yield missing(name, f"a {'' if kind == 'slide' else 'dynamic '}{kind}{cause}{also}")


def _plate_can_slide(draft: Draft) -> Iterator[Problem]:
    """A slide moves the plate along x, and particles follow it along x only where they are free to."""
    free = draft.get("plate", "free", default=Plate.model_fields["free"].default)
    if draft.kind == "slide" and draft.has("plate") and free is not None and "x" not in free:
        yield Problem("plate.free", 'must contain "x" in a slide', shown(free), 'write free = ["x", "z"]')
    if draft.kind != "slide" and draft.has("plate") and "x" in (free or ()) and not draft.has("horizontal"):
        hint = f'write plate.free = ["z"], or add {ADD["horizontal"]}'
        yield Problem("horizontal", 'missing, needed by plate.free with "x"', hint=hint)


def _something_holds(draft: Draft) -> Iterator[Problem]:
    """Without attraction nothing can be pulled: no pull-off, and no load that is not compressive."""
    if draft.has("interaction", "attraction") or draft.has("adhesion"):
        return
    if draft.kind == "pull_off" and draft.lower == "particles" and draft.has("interaction"):
        hint = "without it nothing holds the bodies together"
        yield Problem("interaction.attraction", "missing, needed by a pull_off", hint=hint)
    force = draft.get("experiment", "force")
    if draft.kind == "load" and force is not None and force <= 0:
        hint = "compression is positive; a tensile force needs interaction.attraction, or on a rigid plane [adhesion]"
        yield Problem("experiment.force", "must be greater than 0 (FU) without attraction", shown(force), hint)


def _punch(draft: Draft) -> Iterator[Problem]:
    """A flat punch is its chain: so many particles that half a spacing beyond the last one is its edge."""
    if draft.get("bodies", "profile", "kind") != "flat_punch":
        return
    radius, spacing = draft.get("bodies", "profile", "radius"), draft.get("bodies", "spacing")
    if radius is None or spacing in (None, "auto"):
        return
    wanted = 2.0 * (radius / spacing)
    if wanted == math.inf:
        hint = "make it smaller, or bodies.spacing wider"
        yield Problem("bodies.profile.radius", "more spacings than a number holds", shown(radius), hint)
        return
    count = max(3, round(wanted))
    if abs(wanted - count) > WHOLE_NUMBER_ERROR * count:
        must = "must be at least 1.5 spacings and a whole number of half spacings"
        must += f": the nearest is {0.5 * count * spacing:g} (LU)"
        yield Problem("bodies.profile.radius", must, shown(radius))
        return
    given = draft.get("bodies", "particles")
    if given not in (None, "auto", count):
        must = f"must be {count}, the radius times 2 over the spacing"
        yield Problem("bodies.particles", must, shown(given), 'change it, or use "auto"')


def _material(draft: Draft) -> Iterator[Problem]:
    """A material has one elasticity, and one way to the units."""
    automatic, given = _takes_stiffness(draft), draft.has("bodies", "bulk_stiffness")
    text, of_spacing = shown("auto") if given else None, draft.get("bodies", "spacing") == "auto"
    if not draft.has("material"):
        if automatic:
            hint = "[material] with E and ν of both bodies, from which it follows"
            hint = f"add {hint}" if of_spacing else f"give the stiffness (FU/LU), or {hint}"
            yield Problem("bodies.bulk_stiffness", "nothing to take it from" if given else "missing", text, hint)
        return
    has = {name: draft.has("material", name) for name in ("upper", "lower", "contact_modulus", *UNIT_KEYS)}
    if not (has["upper"] or has["lower"] or has["contact_modulus"]):
        if automatic:
            hint = "write material.upper and material.lower, or material.contact_modulus"
            hint += "" if of_spacing else "; or give the stiffness"
            yield Problem("bodies.bulk_stiffness", "nothing to take it from" if given else "missing", text, hint)
            return
        if has["length_unit"] and has["force_unit"] and not has["surface_energy"]:
            return  # numbers with units, and no more
    if has["contact_modulus"] and (has["upper"] or has["lower"]):
        hint = "give E*, or E and ν of both bodies"
        yield Problem("material.contact_modulus", "not together with upper or lower", hint=hint)
    elif not has["contact_modulus"] and not (has["upper"] and has["lower"]):
        absent = "lower" if has["upper"] else "upper"
        hint = "write upper and lower, each with youngs_modulus and poisson_ratio, or contact_modulus"
        yield Problem(f"material.{absent}", "missing", hint=hint)
    if has["surface_energy"]:
        yield from _jkr_units(draft, has)
        return
    if not has["length_unit"]:
        hint = "give one LU in metres, or surface_energy, from which a pull_off finds both units"
        yield Problem("material.length_unit", "missing", hint=hint)
    if has["force_unit"] and not automatic and draft.has("bodies", "bulk_stiffness"):
        hint = 'write bodies.bulk_stiffness = "auto", or leave out force_unit, which then follows from the stiffness'
        yield Problem("material.force_unit", "not together with a given bulk_stiffness", hint=hint)
    if automatic and not has["force_unit"]:
        message = 'missing, needed by bulk_stiffness = "auto"'
        yield Problem("material.force_unit", message, hint="give one FU in newtons")


def _takes_stiffness(draft: Draft) -> bool:
    """Whether the stiffness follows from the material: as written, or as nothing is."""
    return draft.has("bodies") and draft.get("bodies", "bulk_stiffness", default="auto") == "auto"


def _jkr_units(draft: Draft, has: Mapping[str, bool]) -> Iterator[Problem]:
    """γ and E* fix both units by F_A and a₀ of the run, so it must have these, and nothing else may fix them."""
    for name in ("length_unit", "force_unit"):
        if has[name]:
            hint = "remove one of the two: with surface_energy both units follow from F_A and a₀ of the run"
            yield Problem(f"material.{name}", "not together with surface_energy", hint=hint)
    if _takes_stiffness(draft):
        hint = "give the stiffness, or length_unit and force_unit in place of surface_energy"
        text = shown("auto") if draft.has("bodies", "bulk_stiffness") else None
        yield Problem("bodies.bulk_stiffness", "no units to take it by before the run", text, hint)
    if draft.kind in ("load", "slide", "tangential"):
        hint = 'use kind = "pull_off", whose results give length_unit and force_unit'
        yield Problem("material.surface_energy", f"not in a {draft.kind}, which finds no F_A and a₀", hint=hint)
    elif draft.kind == "path" and (
        (draft.lower == "rigid_plane" and not draft.has("adhesion"))
        or (draft.has("interaction") and not draft.has("interaction", "attraction"))
    ):
        hint = 'use length_unit, or lower = "particles" with an interaction.attraction'
        yield Problem("material.surface_energy", "useless: nothing attracts, so there is no F_A and no a₀", hint=hint)
    if draft.get("bodies", "profile", "kind") not in (None, "parabola", "circle"):
        hint = "JKR is for a sphere: use a parabola or a circle, or length_unit"
        yield Problem("material.surface_energy", "not with this profile", hint=hint)


UNIT_KEYS = ("length_unit", "force_unit", "surface_energy")
WHOLE_NUMBER_ERROR = 1e-9
"""Relative error up to which a number counts as whole."""

RULES: tuple[Callable[[Draft], Iterator[Problem]], ...] = (
    _lower_body,
    adhesion,
    tangential,
    automatic_spacing,
    _law,
    _tables_of_experiment,
    _plate_can_slide,
    _something_holds,
    _punch,
    _material,
    derived_for_spheres,
    *SLIDING_RULES,
)


def check_fit(data: Mapping[str, Any], unsound: frozenset[tuple[str | int, ...]] = frozenset()) -> list[Problem]:
    """Every breach of a rule across the tables of `data` that can be told in spite of the `unsound` values in it."""
    draft = Draft(data, unsound)
    return [problem for rule in RULES for problem in rule(draft)]
