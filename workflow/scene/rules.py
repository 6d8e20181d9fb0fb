"""What fits together in a scene: one table of rules, and one evaluation that reports every breach at once.

A rule is a row: the key that it speaks of, when it is broken, what is wrong, and what to do. What an experiment or an
effect needs and excludes is declared beside its keys (`experiments`, `effects`), and read here for all of them alike.

Two bodies touch in one way only if the force f(r) = (A/a) exp(−r/a) − (B/b) exp(−r/b) repels at contact,
A/a > B/b, and attracts far off, b > a. It then vanishes once, at r₀ = ln(A b / (B a)) a b / (b − a).
Two periodic chains of n and m particles close together only if n·s_lower = m·s_upper.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from typing import Any

from contact1d.workflow.scene.effects import Plate
from contact1d.workflow.scene.experiments import KINDS, Kind, Span
from contact1d.workflow.scene.material import ALIKE, SPHERES, wider_than_body
from contact1d.workflow.scene.problems import Problem, shown
from contact1d.workflow.scene.quantities import Keys
from contact1d.workflow.scene.tables import EFFECT_TABLES, TIMED, Bodies, default_method

WHOLE_NUMBER_ERROR = 1e-9
"""Relative error of a quotient of two decimals up to which it counts as whole, or two lengths as equal."""
LONGEST_CELL = 1000
"""Most particles of a pair of chains that is suggested in place of one that does not close."""


@dataclass(frozen=True)
class Draft:
    """A scene that may have wrong values: `data` as in the file, and the keys at which a value is `unsound`."""

    data: Mapping[str, Any]
    unsound: frozenset[Keys]

    def at(self, path: str) -> Any:
        """What stands at the dotted `path`, right or wrong; None if nothing does."""
        value: Any = self.data
        for key in path.split("."):
            value = value.get(key) if isinstance(value, Mapping) else None
        return value

    def has(self, *paths: str) -> bool:
        """Whether something, right or wrong, stands at one of the `paths`."""
        return any(self.at(path) is not None for path in paths)

    def sound(self, path: str) -> bool:
        """Whether what stands at `path`, if anything, is right, with all that is above and inside it."""
        keys = tuple(path.split("."))
        return not any(bad[: len(keys)] == keys[: len(bad)] for bad in self.unsound)

    def get(self, path: str, default: Any = None) -> Any:
        """The value at `path`, `default` where it is absent, None where it is unsound."""
        if not self.sound(path):
            return None
        value = self.at(path)
        return default if value is None else value

    def word(self, path: str, default: str | None = None) -> str | None:
        """The word at `path`, `default` where it is absent, None if it is not known."""
        found = self.get(path, default)
        return found if isinstance(found, str) else None

    @property
    def kind(self) -> str | None:
        """Kind of the experiment, None if that is not known."""
        return self.word("experiment.kind")

    @property
    def experiment(self) -> type[Kind]:
        """The experiment's table, which declares what it needs; `Kind` if it is not known."""
        return KINDS.get(self.kind or "", Kind)

    @property
    def lower(self) -> str | None:
        """What the lower body is, None if that is not known."""
        return self.word("bodies.lower", Bodies.model_fields["lower"].default) if self.has("bodies") else None

    @property
    def on_plane(self) -> bool:
        """Whether the lower body is a rigid plane."""
        return self.lower == "rigid_plane"

    @property
    def on_chain(self) -> bool:
        """Whether the lower body is known to be of particles."""
        return self.lower is not None and not self.on_plane

    @property
    def profile(self) -> str | None:
        """Kind of the profile, None if that is not known."""
        return self.word("bodies.profile.kind")

    @property
    def effects(self) -> tuple[str, ...]:
        """The effects whose tables are there."""
        return tuple(name for name in EFFECT_TABLES if self.has(name))


When = Callable[[Draft], "bool | Mapping[str, Any] | None"]


@dataclass(frozen=True)
class Rule:
    """A row: where `when` holds of a draft, what stands at `key` is a problem.

    `when` may return facts, by name, which `message` and `fix` then contain in braces, and whose names the values of
    `ways` are: changes, by dotted keys, each of which makes a scene of it (to six digits).
    """

    key: str
    when: When
    message: str
    fix: str
    ways: tuple[tuple[str, str], ...] = ()

    def problem(self, draft: Draft) -> Problem | None:
        """The breach of this rule by `draft`, if it is one."""
        facts = self.when(draft)
        if not facts:
            return None
        named = facts if isinstance(facts, Mapping) else {}
        ways = tuple({key: float(f"{named[fact]:.6g}")} for key, fact in self.ways)
        message, fix = (text.format(**named) if named else text for text in (self.message, self.fix))
        return _problem(draft, self.key, message, fix, ways)


def _problem(draft: Draft, key: str, message: str, fix: str, ways: tuple[Mapping[str, object], ...] = ()) -> Problem:
    """A problem, with what stands there unless that is a table."""
    value = draft.at(key)
    return Problem(key, message, None if value is None or isinstance(value, Mapping) else shown(value), fix, ways)


# What an experiment or an effect declares


def _methods(draft: Draft) -> Iterator[Problem]:
    """Each experiment and method has effects that it needs and effects that it cannot have."""
    kind, experiment, present = draft.kind, draft.experiment, draft.effects
    if kind is None:
        if "noise" in present and "damping" not in present:
            yield _missing("damping", "[noise]")
        return
    for name in (name for name in experiment.excludes if name in present):
        other = next((one for one, table in KINDS.items() if not table.excludes.keys() & {*present}), None)
        fix = "remove it" + (f', or use kind = "{other}"' if other else "")
        yield _problem(draft, name, f"not in a {kind}: {experiment.excludes[name]}", fix)
    if not draft.sound("experiment.method"):
        return
    rest = tuple(name for name in present if name not in experiment.excludes)
    given = draft.get("experiment.method")
    method = experiment.only_method or given or default_method(rest)
    for name in (name for name in experiment.needs if name not in present):
        yield _missing(name, f"a {kind}")
    if method == "dynamic" and experiment.only_method is None:
        cause = "" if given else ", made dynamic by " + ", ".join(f"[{name}]" for name in rest if name in TIMED)
        for name in (name for name in experiment.needs_in_time if name not in present):
            also = " and by [noise]" if given and name == "damping" and "noise" in rest else ""
            yield _missing(name, f"a dynamic {kind}{cause}{also}")
    for name in (name for name in TIMED if method == "quasistatic" and name in rest):
        fix = 'remove it, or use experiment.method = "dynamic"'
        yield _problem(draft, name, f"not in a quasistatic {kind}, which has no time in it", fix)


def _missing(name: str, needed_by: str) -> Problem:
    return Problem(name, f"missing, needed by {needed_by}", hint=f"add {EFFECT_TABLES[name].how}")


def _one_of(draft: Draft) -> Iterator[Problem]:
    """Of some keys exactly one is there."""
    effects = {name: EFFECT_TABLES[name] for name in draft.effects if draft.sound(name)}
    for name, table in {**effects, "experiment": draft.experiment}.items():
        for keys, fix in table.one_of:
            given = [key for key in keys if draft.has(f"{name}.{key}")]
            if not given:
                yield _problem(draft, f"{name}.{keys[0]}", "missing", fix)
            for key in given[1:]:
                yield _problem(draft, f"{name}.{key}", f"not together with {given[0]}", fix)


def _excluded_by_effects(draft: Draft) -> Iterator[Problem]:
    """Effects that another one cannot have beside it, on the lower body that this one belongs to."""
    for effect in draft.effects if draft.on_plane else ():
        for name, why in EFFECT_TABLES[effect].excludes.items():
            if draft.has(name):
                yield _problem(draft, name, f"not with [{effect}]: {why}", f"remove [{name}], or [{effect}]")


def _only_with_noise(draft: Draft) -> Iterator[Problem]:
    """Keys of a thermal experiment."""
    for key in draft.experiment.only_with_noise if not draft.has("noise") else ():
        if draft.has(f"experiment.{key}"):
            fix = "remove it, or add [noise] with temperature and seed"
            message = "only with [noise]: without thermal fluctuations each repetition ends alike"
            yield _problem(draft, f"experiment.{key}", message, fix)


def _beside_particles(draft: Draft) -> Iterator[Problem]:
    """Keys of a lower body of particles."""
    for key in ("upper_particles", "upper_spacing", "upper_offset", "periodic") if draft.on_plane else ():
        if draft.has(f"bodies.{key}") and draft.get(f"bodies.{key}") is not False:
            message = 'not with bodies.lower = "rigid_plane", which has no particles'
            yield _problem(draft, f"bodies.{key}", message, 'remove it, or use bodies.lower = "particles"')


# Conditions that work out facts


def _inert_plane(d: Draft) -> bool:
    """A rigid plane neither drags a slide nor holds a pull-off without adhesion."""
    return d.on_plane and (d.experiment.motion_is_result or (d.kind == "pull_off" and not d.has("adhesion")))


def _law(d: Draft, broken: str) -> Mapping[str, float] | None:
    """What the interaction's terms and cutoff allow, if it is `broken` by them, each only if those before are right."""
    terms = [(term, key) for term in ("repulsion", "attraction") for key in ("amplitude", "range")]
    A, a, B, b = (d.get(f"interaction.{term}.{key}") for term, key in terms)
    if None in (A, a, B, b):
        return None
    ratio = math.log(A) - math.log(a) - math.log(B) + math.log(b)
    facts = {"a": a, "longer": 2.0 * a, "shorter": 0.5 * b, "most": A / a * b}
    facts |= {"weaker": 0.25 * A / a * b, "stronger": 4.0 * B / b * a}
    if b <= a or ratio <= 0.0:
        return facts if broken == ("range" if b <= a else "amplitude") else None
    cutoff, r_0 = d.get("interaction.cutoff", "auto"), ratio * a * b / (b - a)
    return {"r_0": r_0} if broken == "cutoff" and cutoff not in (None, "auto") and cutoff <= r_0 else None


def _pulled_apart(d: Draft, key: str) -> bool:
    """Whether a normal force does not compress, where nothing attracts."""
    force = d.get(f"experiment.{key}") if d.experiment.load_key == key else None
    attracts = d.has("interaction.attraction") or (d.has("adhesion") and "adhesion" not in d.experiment.excludes)
    return force is not None and force <= 0 and not attracts


def _no_work(d: Draft, key: str) -> bool:
    """Whether an adhesion without energy is to hold a pull-off."""
    return d.kind == "pull_off" and d.get(f"adhesion.{key}") == 0.0


def _punch(d: Draft, broken: str) -> Mapping[str, float] | None:
    """What the chain of a flat punch may be, if its `size`, its `edge` or its number of `particles` is broken."""
    radius, spacing = d.get("bodies.profile.radius"), d.get("bodies.spacing")
    if d.profile != "flat_punch" or radius is None or spacing in (None, "auto"):
        return None
    width = 2.0 * (radius / spacing)
    if width == math.inf:
        return {"width": width} if broken == "size" else None
    count = max(3, round(width))
    between = abs(width - count) > WHOLE_NUMBER_ERROR * count
    other = not between and d.get("bodies.particles") not in (None, "auto", count)
    found = "edge" if between else "particles" if other else None
    return {"nearest": 0.5 * count * spacing, "count": count} if broken == found else None


def _normal_load(d: Draft, key: str) -> Any:
    """The normal load of a tangential, if it is given by `key` alone; else None."""
    other = {"normal_force": "normal_displacement", "normal_displacement": "normal_force"}[key]
    alone = d.experiment.goes_along and not d.has(f"experiment.{other}")
    return d.get(f"experiment.{key}") if alone else None


def _other_number_of_loads(d: Draft, key: str) -> Mapping[str, int] | None:
    load, rows = _normal_load(d, key), d.get("experiment.displacements")
    if not isinstance(load, list) or rows is None:
        return None
    count = len(Span.model_validate(rows).values() if isinstance(rows, Mapping) else rows)
    return {"count": count, "given": len(load)} if len(load) != count else None


def _no_normal_load(d: Draft, key: str) -> bool:
    load = _normal_load(d, key)
    return load is not None and max(load if isinstance(load, list) else [load]) <= 0.0


def _auto_spacing(d: Draft) -> bool:
    """Whether the spacing is left to the program, on a lower body that allows it."""
    return d.get("bodies.spacing") == "auto" and d.lower in (None, "rigid_plane")


def _tied_to_one_spacing(d: Draft) -> Mapping[str, str] | None:
    """Numbers, or a motion, that belong to particles of one mass and one distance."""
    tied = [f"[{name}]" for name in ("neighbours", "damping", "noise", "plate") if d.has(name)]
    tied += ['method = "dynamic"'] if d.get("experiment.method") == "dynamic" else []
    return {"what": tied[0]} if _auto_spacing(d) and tied else None


def _stiffness_is_auto(d: Draft) -> bool:
    """Whether the stiffness follows from the material: as written, or as nothing is."""
    return d.has("bodies") and d.get("bodies.bulk_stiffness", "auto") == "auto"


def _elastic(d: Draft) -> bool:
    return d.has("material.upper", "material.lower", "material.contact_modulus")


def _units_alone(d: Draft) -> bool:
    """Whether the material says what LU and FU are, and no more."""
    both = d.has("material.length_unit") and d.has("material.force_unit")
    return not _elastic(d) and both and not d.has("material.surface_energy")


def _stiffness_from_nothing(d: Draft) -> bool:
    return _stiffness_is_auto(d) and not _elastic(d)


def _stands_for_body(d: Draft) -> bool:
    """Whether the material must be whole: it is there, and for more than units."""
    return d.has("material") and not _stiffness_from_nothing(d) and not _units_alone(d)


def _one_elastic(d: Draft, absent: str) -> bool:
    """Whether a body's elasticity is missing: the other's is there, or for the upper one nothing is."""
    if not _stands_for_body(d) or d.has("material.contact_modulus", f"material.{absent}"):
        return False
    return d.has("material.upper") if absent == "lower" else True


def _units_by_run(d: Draft) -> bool:
    """Whether γ and E* fix both units by F_A and a₀ of the run."""
    return _stands_for_body(d) and d.has("material.surface_energy")


def _unit_beside_run(d: Draft, key: str) -> bool:
    return _units_by_run(d) and d.has(f"material.{key}")


def _units_given(d: Draft) -> bool:
    return _stands_for_body(d) and not d.has("material.surface_energy")


def _nothing_attracts(d: Draft) -> bool:
    plane = d.on_plane and not d.has("adhesion")
    return plane or (d.has("interaction") and not d.has("interaction.attraction"))


def _paper_reduction(d: Draft) -> Mapping[str, str] | None:
    """What the paper's reduction makes of a body that it was not derived for."""
    profile = d.get("bodies.profile")
    chosen = d.get("bodies.reduction") == "geike_popov" and d.has("material")
    if not chosen or not isinstance(profile, Mapping) or profile.get("kind") in SPHERES:
        return None
    if (factor := wider_than_body(profile)) is not None:
        off = (
            f"{factor:.4g} times this body's contact radius under the same force, {factor**-2:.4g} of its mean pressure"
        )
    elif profile.get("kind") in ALIKE:
        off = "half of this body's force at the same displacement"
    else:
        off = "the contact of another body"
    return {"off": off}


def _thermal(d: Draft) -> bool:
    return d.has("noise") and d.get("experiment.method") != "quasistatic"


def _stiffer_tangentially(d: Draft) -> Mapping[str, float] | None:
    normal, tangential = d.get("bodies.bulk_stiffness"), d.get("bodies.bulk_stiffness_tangential")
    both = isinstance(normal, float | int) and isinstance(tangential, float | int)
    return {"normal": normal} if d.get("bodies.periodic") and both and tangential > normal else None


def _open_chains(d: Draft) -> Mapping[str, Any] | None:
    """n·s_lower = m·s_upper is broken; the nearest numbers that keep it."""
    count, spacing = d.get("bodies.particles"), d.get("bodies.spacing")
    upper, pitch = d.get("bodies.upper_particles", count), d.get("bodies.upper_spacing", spacing)
    numbers = (count, spacing, upper, pitch)
    if not d.get("bodies.periodic") or None in numbers or "auto" in numbers or upper == 1:
        return None
    if abs(count * spacing - upper * pitch) <= WHOLE_NUMBER_ERROR * count * spacing:
        return None
    ratio = Fraction(pitch / spacing).limit_denominator(LONGEST_CELL)
    pair = f"upper_spacing = {count * spacing / upper:.10g} with these numbers of particles"
    if 0 < ratio.numerator <= LONGEST_CELL:
        cells = max(1, round(upper / ratio.denominator))
        pair += (
            f", or particles = {cells * ratio.numerator} and upper_particles = {cells * ratio.denominator} with "
            f"upper_spacing = {ratio.numerator / ratio.denominator * spacing:.10g}"
        )
    return {"count": count, "spacing": spacing, "upper": upper, "pitch": pitch, "pair": pair}


def _free(d: Draft) -> Any:
    """Directions in which the plate may move; nothing where that is not known."""
    return d.get("plate.free", Plate.model_fields["free"].default) if d.has("plate") else None


PLANE = 'bodies.lower = "rigid_plane"'
GIVE_SPACING = "give bodies.spacing as a length (LU)"
ELASTICITY = "material.upper and material.lower with E and ν, or material.contact_modulus"
RULES = (
    # The lower body
    Rule("interaction", lambda d: d.on_chain and not d.has("interaction"),
         "missing, needed by a lower body of particles", f"add [interaction], or use {PLANE}"),
    Rule("interaction", lambda d: d.on_plane and d.has("interaction") and not _inert_plane(d),
         f"not with {PLANE}, which is touched directly", 'remove it, or use bodies.lower = "particles"'),
    Rule("horizontal", lambda d: d.on_plane and d.has("horizontal") and not _inert_plane(d),
         "useless on a rigid plane, which never pulls a particle tangentially",
         'remove it, or use bodies.lower = "particles"'),
    Rule("bodies.lower", lambda d: _inert_plane(d) and d.experiment.motion_is_result,
         "a rigid plane cannot drag the upper body", 'use lower = "particles" and an [interaction]'),
    Rule("bodies.lower", lambda d: _inert_plane(d) and d.kind == "pull_off",
         "a rigid plane cannot hold the upper body",
         'add [adhesion] with work_of_adhesion, or use lower = "particles" and an [interaction]'),
    Rule("bodies.lower", lambda d: d.on_chain and d.experiment.goes_along,
         'must be "rigid_plane" in a tangential, whose friction is Coulomb\'s',
         'between two chains friction comes from the interaction: use kind = "slide"'),
    Rule("friction", lambda d: d.on_chain and d.has("friction") and not d.experiment.goes_along,
         "not between two chains, whose friction comes from the interaction",
         f'remove it, or use {PLANE} and kind = "tangential"'),
    Rule("adhesion", lambda d: d.on_chain and d.has("adhesion"),
         "not between two chains, which attract each other by the interaction",
         f"use interaction.attraction, or {PLANE}"),
    # The interaction
    Rule("interaction.attraction.range", partial(_law, broken="range"),
         "must be greater than the range of the repulsion, {a:g} (LU), else the bodies never attract each other",
         "raise it to {longer:g}, or lower interaction.repulsion.range to {shorter:g}",
         (("interaction.attraction.range", "longer"), ("interaction.repulsion.range", "shorter"))),
    Rule("interaction.attraction.amplitude", partial(_law, broken="amplitude"),
         "must be less than {most:.6g} (FU·LU), so that A/a > B/b and particles repel when they touch",
         "lower it to {weaker:g}, or raise interaction.repulsion.amplitude to {stronger:g}",
         (("interaction.attraction.amplitude", "weaker"), ("interaction.repulsion.amplitude", "stronger"))),
    Rule("interaction.cutoff", partial(_law, broken="cutoff"),
         "must be greater than the force-free distance, {r_0:.6g} (LU)", 'raise it, or use "auto"'),
    # What holds the bodies together
    Rule("interaction.attraction",
         lambda d: d.kind == "pull_off" and d.lower == "particles" and d.has("interaction")
         and not d.has("interaction.attraction", "adhesion"),
         "missing, needed by a pull_off", "add interaction.attraction with amplitude and range"),
    Rule("experiment.force", partial(_pulled_apart, key="force"),
         "must be greater than 0 (FU) without attraction: compression is positive",
         "raise it; a tensile force needs interaction.attraction, or on a rigid plane [adhesion]"),
    Rule("experiment.normal_force", partial(_pulled_apart, key="normal_force"),
         "must be greater than 0 (FU) without attraction: compression is positive",
         "raise it; a force of 0 or a tensile one needs interaction.attraction"),
    *(Rule(f"adhesion.{key}", partial(_no_work, key=key),
           "must be greater than 0 (FU/LU) in a pull_off, else nothing holds the bodies together",
           'raise it, or use kind = "load" or "path"') for key in ("work_of_adhesion", "surface_energy")),
    # Adhesion on a plane
    Rule("bodies.reduction",
         lambda d: d.on_plane and d.has("adhesion") and d.get("bodies.reduction") == "geike_popov",
         'must be "mdr" with [adhesion], whose contact edge is that of a contact of three dimensions',
         'write reduction = "mdr"'),
    Rule("damping", lambda d: d.on_plane and d.has("adhesion") and d.kind == "path" and d.has("damping"),
         "not with [adhesion] in a path: under displacement control nothing moves",
         'remove it: method = "quasistatic" is the same without time'),
    # A plate that moves along x
    Rule("plate.free", lambda d: d.experiment.motion_is_result and _free(d) is not None and "x" not in _free(d),
         'must contain "x" in a slide', 'write free = ["x", "z"]'),
    Rule("horizontal",
         lambda d: not d.experiment.motion_is_result and "x" in (_free(d) or ()) and not d.has("horizontal"),
         'missing, needed by plate.free with "x"',
         f'write plate.free = ["z"], or add {EFFECT_TABLES["horizontal"].how}'),
    # The loads of a tangential
    *(Rule(f"experiment.{key}", partial(_other_number_of_loads, key=key),
           "must be one number or as many as there are displacements, {count}; these are {given}",
           "give one for each displacement, or one for all") for key in ("normal_force", "normal_displacement")),
    *(Rule(f"experiment.{key}", partial(_no_normal_load, key=key),
           "must be greater than 0 somewhere, else the bodies never touch",
           "raise it") for key in ("normal_force", "normal_displacement")),
    # A spacing that is left to the program
    Rule("bodies.spacing", lambda d: d.get("bodies.spacing") == "auto" and d.on_chain,
         "must be a length (LU) with a lower body of particles, whose forces belong to its particles",
         f'{GIVE_SPACING}; "auto" is for lower = "rigid_plane", where the results converge with the spacing'),
    Rule("bodies.particles", lambda d: _auto_spacing(d) and d.get("bodies.particles", "auto") not in (None, "auto"),
         'must be "auto" with spacing = "auto"', f"write it, or {GIVE_SPACING}"),
    Rule("bodies.bulk_stiffness",
         lambda d: _auto_spacing(d) and d.get("bodies.bulk_stiffness", "auto") not in (None, "auto"),
         'must be "auto" with spacing = "auto": the stiffness of a particle is E* times the spacing',
         f"write it, and {ELASTICITY}; or {GIVE_SPACING}"),
    Rule("bodies.bulk_stiffness_tangential", lambda d: _auto_spacing(d) and d.has("bodies.bulk_stiffness_tangential"),
         'not with spacing = "auto": it belongs to one particle',
         f"remove it: it follows from ν of material.upper and lower; or {GIVE_SPACING}"),
    Rule("bodies.spacing", lambda d: _auto_spacing(d) and d.profile == "flat",
         "must be a length (LU) of a flat body without an edge", f'{GIVE_SPACING}, or use kind = "flat_punch"'),
    Rule("bodies.spacing", _tied_to_one_spacing,
         "must be a length (LU) with {what}: masses, drags and springs between particles belong to one spacing",
         GIVE_SPACING + ", or remove {what}"),
    # A flat punch, whose edge is half a spacing beyond its last particle
    Rule("bodies.profile.radius", partial(_punch, broken="size"),
         "is more spacings than a number holds", "make it smaller, or bodies.spacing wider"),
    Rule("bodies.profile.radius", partial(_punch, broken="edge"),
         "must be at least 1.5 spacings and a whole number of half spacings", "the nearest is {nearest:g} (LU)"),
    Rule("bodies.particles", partial(_punch, broken="particles"),
         "must be {count}, the radius times 2 over the spacing", 'write {count} or "auto"'),
    # The material: one elasticity, and one way to the units
    Rule("bodies.bulk_stiffness", lambda d: _stiffness_from_nothing(d),
         "must be given (FU/LU): the scene has no elasticity to take it from",
         f"give a number, or {ELASTICITY}"),
    Rule("material.contact_modulus",
         lambda d: _stands_for_body(d) and d.has("material.contact_modulus")
         and d.has("material.upper", "material.lower"),
         "not together with upper or lower", "give E*, or E and ν of both bodies"),
    *(Rule(f"material.{body}", partial(_one_elastic, absent=body),
           "missing", "write upper and lower, each with youngs_modulus and poisson_ratio, or contact_modulus")
      for body in ("upper", "lower")),
    Rule("material.length_unit", lambda d: _units_given(d) and not d.has("material.length_unit"),
         "missing", "give one LU in metres, or surface_energy, from which a pull_off finds both units"),
    Rule("material.force_unit",
         lambda d: _units_given(d) and d.has("material.force_unit") and not _stiffness_is_auto(d)
         and d.has("bodies.bulk_stiffness"),
         "not together with a given bulk_stiffness, from which it follows",
         'remove it, or write bodies.bulk_stiffness = "auto"'),
    Rule("material.force_unit",
         lambda d: _units_given(d) and _stiffness_is_auto(d) and not d.has("material.force_unit"),
         'missing, needed by bulk_stiffness = "auto"', "give one FU in newtons"),
    *(Rule(f"material.{unit}", partial(_unit_beside_run, key=unit),
           "not together with surface_energy, with which both units follow from F_A and a₀ of the run",
           "remove one of the two") for unit in ("length_unit", "force_unit")),
    Rule("bodies.bulk_stiffness", lambda d: _units_by_run(d) and _stiffness_is_auto(d),
         "no units to take it by before the run",
         "give the stiffness (FU/LU), or length_unit and force_unit in place of surface_energy"),
    Rule("material.surface_energy",
         lambda d: _units_by_run(d) and d.kind is not None and not d.experiment.finds_pull_off,
         "not in this experiment, which finds no F_A and a₀",
         'use kind = "pull_off", whose results give length_unit and force_unit'),
    Rule("material.surface_energy", lambda d: _units_by_run(d) and d.kind == "path" and _nothing_attracts(d),
         "useless: nothing attracts, so there is no F_A and no a₀",
         'use length_unit, or lower = "particles" with an interaction.attraction'),
    Rule("material.surface_energy", lambda d: _units_by_run(d) and d.profile not in (None, *SPHERES),
         "not with this profile: JKR is for a sphere", "use a parabola or a circle, or length_unit"),
    Rule("bodies.reduction", _paper_reduction,
         "was derived for two equal spheres; with this profile it has {off}",
         'write "mdr", which has force, displacement and radius of any axisymmetric body, or leave it out'),
    # A pull-off with thermal fluctuations
    Rule("experiment.loading_rate",
         lambda d: d.kind == "pull_off" and _thermal(d)
         and not d.has("experiment.loading_rate", "experiment.velocity"),
         "missing, needed by a pull_off with [noise]",
         "give the rate (FU/TU) at which the load is drawn off, or a velocity (LU/TU) at which a spring draws the "
         "plate off, or remove [noise]"),
    Rule("experiment.velocity",
         lambda d: d.kind == "pull_off" and d.has("experiment.loading_rate") and d.has("experiment.velocity"),
         "not together with a loading_rate", "remove one of the two"),
    Rule("experiment.stiffness",
         lambda d: d.kind == "pull_off" and d.has("experiment.stiffness") and not d.has("experiment.velocity"),
         "only with a velocity: it is that of the spring",
         "remove it, or give the velocity at which its far end is drawn off"),
    # A held displacement
    Rule("plate", lambda d: d.kind == "hold" and d.has("plate") and d.has("experiment.displacement"),
         "not with a displacement that is held: the plate has no motion of its own", "remove it, or give a force"),
    Rule("plate", lambda d: d.kind == "hold" and not d.has("plate") and d.has("experiment.force"),
         "missing, needed by a force that is held", f"add {EFFECT_TABLES['plate'].how}"),
    # Periodic bodies
    Rule("bodies.profile.kind",
         lambda d: d.profile == "flat" and not d.get("bodies.periodic") and d.sound("bodies.periodic"),
         "needs bodies.periodic", 'write periodic = true, or use kind = "flat_punch", which has an edge'),
    Rule("bodies.periodic", lambda d: d.get("bodies.periodic") and d.profile not in (None, "flat"),
         "not with a body that is not flat: it would end nowhere",
         'use profile = { kind = "flat" }, or leave periodic out'),
    Rule("bodies.periodic", lambda d: d.get("bodies.periodic") and d.kind not in (None, "slide"),
         "only in a slide", 'remove it, or use kind = "slide"'),
    Rule("bodies.bulk_stiffness_tangential", _stiffer_tangentially,
         "must be at most bulk_stiffness, {normal:g} (FU/LU), with bodies.periodic",
         "lower it: what is stiffer along x hangs on far anchors along x, and a periodic body has none"),
    Rule("bodies.particles", lambda d: d.get("bodies.periodic") and d.get("bodies.particles") == "auto",
         "must be a number with bodies.periodic",
         "give a number: no contact says how many particles a flat body without end needs"),
    Rule("bodies.upper_spacing", _open_chains,
         "periodic chains do not close: {count} · {spacing:g} LU below and {upper} · {pitch:g} LU above",
         "the nearest that do: {pair}"),
)  # fmt: skip


def check_fit(data: Mapping[str, Any], unsound: frozenset[Keys] = frozenset()) -> list[Problem]:
    """Every breach of a rule across the tables of `data` that can be found in spite of the `unsound` values in it."""
    draft = Draft(data, unsound)
    declared = (_methods, _one_of, _excluded_by_effects, _only_with_noise, _beside_particles)
    return [
        *(problem for rule in RULES if (problem := rule.problem(draft))),
        *(problem for read in declared for problem in read(draft)),
    ]
