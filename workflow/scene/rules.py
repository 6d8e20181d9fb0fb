"""Rules across the tables of a scene, by subject, and one evaluation that reports every violation at once.

A rule is a row: its key, whether it is broken, what is wrong, what to do, and at times the changes by dotted keys each
of which makes the scene valid. What an experiment or an effect needs and excludes is declared with its keys
(`experiments`, `effects`), and read here for all of them.

Two bodies have a single equilibrium distance only if the force f(r) = (A/a) exp(−r/a) − (B/b) exp(−r/b) repels at
contact, A/a > B/b, and attracts at large distances, b > a. It then vanishes once, at
r₀ = ln(A b / (B a)) a b / (b − a).
Two periodic chains of n and m particles close together only if n·s_lower = m·s_upper.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

from contact1d.digits import apart
from contact1d.workflow.scene.body_rules import BODY_RULES
from contact1d.workflow.scene.draft import (
    DIGITS,
    PARTICLES,
    PLANE,
    WHOLE_NUMBER_ERROR,
    Draft,
    Row,
    Rows,
    Rule,
    limit,
)
from contact1d.workflow.scene.experiments import KINDS
from contact1d.workflow.scene.kinds import UNMOVED, Cycles, Span, with_article
from contact1d.workflow.scene.problems import Problem
from contact1d.workflow.scene.quantities import Place, Table, keys_of
from contact1d.workflow.scene.tables import (
    EFFECT_TABLES,
    TIMED,
    Bodies,
    default_method,
)

# fmt: off


def _interaction(d: Draft) -> Rows:
    """Yield the rules b > a and A/a > B/b of an attraction, and that a cutoff exceeds the force-free distance.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix), and for the first two a fifth item,
    changes by dotted key [model units] each of which helps; unbroken ones are yielded, too. No rule where amplitudes or
    ranges are unknown; only the first, of the range, where that is broken; none of a cutoff that is "auto" or wrong.
    """
    attraction, repulsion = "interaction.attraction", "interaction.repulsion"
    A, a, B, b = (d[f"{term}.{key}"] for term in (repulsion, attraction) for key in ("amplitude", "range"))
    if None in (A, a, B, b):
        return
    yield (f"{attraction}.range", b <= a,
           f"must be greater than the range of the repulsion, {limit(b, a)} (LU), else the bodies never attract each "
           "other",
           f"raise it to {{}}, or lower {repulsion}.range to {{}}",
           {f"{attraction}.range": 2.0 * a, f"{repulsion}.range": 0.5 * b})
    if b <= a:
        return
    most, least = A / a * b, B / b * a
    ratio = math.log(A) - math.log(a) - math.log(B) + math.log(b)
    yield (f"{attraction}.amplitude", ratio <= 0.0,
           f"must be less than {limit(B, most)} (FU·LU), so that A/a > B/b and particles repel when they touch",
           f"lower it to {{}}, or raise {repulsion}.amplitude to {{}}",
           {f"{attraction}.amplitude": 0.25 * most, f"{repulsion}.amplitude": 4.0 * least})
    cutoff, r_0 = d["interaction.cutoff"], ratio * a * b / (b - a)
    if cutoff not in (None, "auto"):
        yield ("interaction.cutoff", ratio > 0.0 and cutoff <= r_0,
               f"must be greater than the force-free distance, {limit(cutoff, r_0)} (LU)", 'raise it, or use "auto"')


def _tension(d: Draft) -> Rows:
    """Yield the rule that a single force of the experiment that is ≤ 0 needs attraction between the bodies.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix). It is yielded always, and is broken for
    a known force or preload ≤ 0 (not compressive) with neither interaction.attraction nor an [adhesion] that the
    experiment allows.
    """
    key, adheres = f"experiment.{d.experiment.load_key}", "adhesion" in d and "adhesion" not in d.experiment.excludes
    tensile = "a tensile force needs interaction.attraction, or on a rigid plane [adhesion]"
    if d.experiment.motion_is_result:
        tensile = "a force of 0 or a tensile one needs interaction.attraction"
    yield (key, d[key] is not None and d[key] <= 0.0 and not adheres and "interaction.attraction" not in d,
           "must be greater than 0 (FU) without attraction: compression is positive", f"raise it; {tensile}")


def _normal_loads(d: Draft) -> Rows:
    """Yield the rules of the points of cycles, and of the normal forces or displacements of a tangential path.

    Points are a multiple of 4; normal loads are one, or as many as there are displacements; and one is above 0. A rule
    is (dotted key, whether it is broken, what is wrong, suggested fix); unbroken ones are yielded, too. Only the first,
    of the points, for other experiments, and where it is broken or normal loads are unknown or given twice.
    """
    given = [key for key in ("experiment.normal_force", "experiment.normal_displacement") if key in d]
    points = d["experiment.cycles.points"] or 0
    fewer = 4 * max(1, points // 4)
    yield ("experiment.cycles.points", points % 4,
           "must be a multiple of 4, so that a quarter of a cycle is a whole number of load steps",
           f"the nearest are {fewer} and {fewer + 4}")
    load = d[given[0]] if d.experiment.goes_along and len(given) == 1 and not points % 4 else None
    if load is None:
        return
    loads, cycles = load if isinstance(load, list) else [load], d["experiment.cycles"]
    rows, table = (cycles, Cycles) if cycles else (d["experiment.displacements"], Span)
    count = len(table.model_validate(rows).values() if isinstance(rows, Mapping) else rows or loads)
    yield (given[0], loads is load and len(loads) != count,
           f"must be one number or as many as there are displacements, {count}; these are {len(loads)}",
           "give one for each displacement, or one for all")
    yield (given[0], max(loads) <= 0.0, "must be greater than 0 somewhere, else the bodies never touch", "raise it")


def _shares(d: Draft) -> Rows:
    """Yield the rule that the shares of a Prony series add up to 1 at most, within 1e-9, whether or not it is broken.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix).
    """
    total = math.fsum(term["share"] for term in d["viscoelasticity.terms"] or [])
    yield ("viscoelasticity.terms", total > 1.0 + WHOLE_NUMBER_ERROR,
           f"the shares of the instantaneous modulus must add up to 1 at most, not {apart(total, 1.0, DIGITS)[0]}",
           "lower one of them")


def _history(d: Draft) -> Rows:
    """Yield the rules of a history, of its times, its largest value, its first value and its load steps.

    Times rise, a value is greater than 0, bodies with a retardation time begin apart, and load steps under a force are
    no longer than the shortest time of a viscoelastic body. A rule is (dotted key, whether it is broken, what is wrong,
    suggested fix); unbroken ones are yielded, too. No rule for another experiment, or for a history without known
    points.
    """
    given = [key for key in ("displacement", "force") if d.kind == "history" and d[f"experiment.{key}"]]
    if not given:
        return
    key = f"experiment.{given[0]}"
    times, values = zip(*((point["time"], point[given[0]]) for point in d[key]), strict=True)
    wrong = next((i for i in range(1, len(times)) if times[i] <= times[i - 1]), 0)
    yield (key, wrong, f"times must rise; {times[wrong]:.6g} TU follows {times[wrong - 1]:.6g} TU",
           "each point is later than the one before; a jump is a leg as short as you want")
    yield (key, max(values) <= 0.0, "must be greater than 0 somewhere, else the bodies never touch", "raise it")
    retarded, steps = d["viscoelasticity.retardation_time"], d["experiment.steps"]
    yield (key, retarded is not None and values[0] > 0.0,
           "must begin apart with a retardation_time: dashpots resist a jump without bound", "begin with 0 or less")
    longest = max(after - before for before, after in pairwise(times)) / (steps or 1)
    shortest = min([retarded] if retarded else [term["time"] for term in d["viscoelasticity.terms"] or []], default=0.0)
    yield ("experiment.steps", steps is not None and "force" in given and longest > shortest > 0.0,
           "a load step under a given force would take {} (TU), longer than the shortest time of the body, {}".format(
               *apart(longest, shortest, DIGITS)), "give more steps, or leave it to the program")


def _needed(name: str, by: str) -> Row:
    """Return the rule (name, True, what is wrong, suggested fix) of an effect `name` that is needed.

    It always counts as broken, and is reported only where the scene lacks the effect. `by`: what needs it, in words.

    Raises:
        KeyError: there is no such effect.
    """
    return name, True, f"missing, needed by {by}", f"add {EFFECT_TABLES[name].how}"


def _excluded(d: Draft) -> Rows:
    """Yield a rule for each effect that the experiment excludes, then for effects that exclude each other on a plane.

    A rule is (name of the effect, True, what is wrong, suggested fix): it always counts as broken, and is reported only
    where the scene has the effect, which is not asked here. None of the former where the experiment is unknown, none of
    the latter where the lower body is no rigid plane.
    """
    possible = (kind for kind, table in KINDS.items() if not table.excludes.keys() & {*d.effects})
    alternative = next((f', or use kind = "{kind}"' for kind in possible), "")
    for name, reason in d.experiment.excludes.items() if d.kind else ():
        yield (name, True, f"not in {with_article(d.kind)}: {reason}", f"remove it{alternative}")
    for effect in d.effects if d.holds("on_plane") else ():
        for name, reason in EFFECT_TABLES[effect].excludes.items():
            yield (name, True, f"not with [{effect}]: {reason}", f"remove [{name}], or [{effect}]")


def _methods(d: Draft) -> Rows:
    """Yield the rules of effects that an experiment and its method need, and of those that exist in time only.

    A rule is (name of the effect, whether it is broken, what is wrong, suggested fix). Those of needed effects always
    count as broken, and are reported only where the scene lacks these; the others are broken where a quasi-static scene
    has the effect. No rule where the experiment or its method is unknown.
    """
    kind, experiment, given = d.kind, d.experiment, d["experiment.method"]
    if kind is None or (given is None and "experiment.method" in d):
        return
    allowed = tuple(name for name in d.effects if name not in experiment.excludes)
    method = experiment.only_method or given or default_method(allowed)
    for name in experiment.needs:
        yield _needed(name, with_article(kind))
    if method == "dynamic" and experiment.only_method is None:
        cause = "" if given else ", made dynamic by " + ", ".join(f"[{name}]" for name in allowed if name in TIMED)
        for name in experiment.needs_in_time:
            also = " and by [noise]" if given and name == "damping" and "noise" in allowed else ""
            yield _needed(name, f"a dynamic {kind}{cause}{also}")
    for name in TIMED:
        yield (name, method == "quasistatic" and name in allowed,
               f"not in a quasistatic {kind}, which does not depend on time",
               'remove it, or use experiment.method = "dynamic"')


def _declared_keys(d: Draft) -> Rows:
    """Yield the rules of keys of which exactly one must be given, in effects, the experiment and the profile.

    A rule is (dotted key, whether it is broken, what is wrong, suggested fix): one of the first key, broken where none
    is given, and a broken one for each further key that is given.
    """
    effects = {name: EFFECT_TABLES[name] for name in d.effects if d[name] is not None}
    profile = keys_of(Bodies)["profile"].allowed.kinds.get(d.profile, Table)
    for name, table in {**effects, "experiment": d.experiment, "bodies.profile": profile}.items():
        for keys, fix in table.one_of:
            given = [key for key in keys if f"{name}.{key}" in d]
            yield (f"{name}.{keys[0]}", not given, "missing", fix)
            for key in given[1:]:
                yield (f"{name}.{key}", True, f"not together with {given[0]}", fix)


ADHERES = "on_plane adhesion"
LISTED = "bodies.profile.r|bodies.profile.x|bodies.profile.z"
RULES: tuple[Rule, ...] = (
    *BODY_RULES,
    _interaction,
    _tension,
    # What holds the bodies together, and the edge of an adhesive contact
    ("interaction.attraction", "experiment.kind=pull_off bodies.lower=particles interaction !adhesion",
     "missing, needed by a pull_off", "add interaction.attraction with amplitude and range"),
    *((f"adhesion.{key}", f"experiment.kind=pull_off adhesion.{key}=0",
       "must be greater than 0 (FU/LU) in a pull_off, else nothing holds the bodies together",
       'raise it, or use kind = "load" or "path"')
      for key in ("work_of_adhesion", "surface_energy")),
    ("bodies.reduction", f"{ADHERES} bodies.reduction=geike_popov",
     'must be "mdr" with [adhesion], whose contact edge is that of a contact of three dimensions',
     'write reduction = "mdr"'),
    ("adhesion.range", f"{ADHERES} bodies.profile.kind=flat_punch",
     "not with a flat punch, whose edge has no attraction beyond it", "remove it: a punch is Kendall's"),
    ("adhesion.range", f"{ADHERES} in_time", "only of contacts at rest, not {in_time}",
     'remove it, or use method = "quasistatic" without [plate], [damping] and [noise]'),
    ("adhesion.rate", f"{ADHERES} adhesion.range",
     "not together with a range: it is that of JKR's edge", "give one of the two"),
    ("adhesion.rate",
     f"{ADHERES} !experiment.kind=pull_off|!experiment.velocity !experiment.kind=history|!experiment.displacement",
     "only in a pull_off with a velocity, or in a history of displacements: other states have no time",
     'remove it, or give experiment.velocity with kind = "pull_off"'),
    ("adhesion.rate", f"{ADHERES} in_time|experiment.cycles",
     "only of one pull in equilibrium, whose edge alone takes time",
     'remove it, or use method = "quasistatic" without cycles, [plate], [damping] and [noise]'),
    ("adhesion.rate", f"{ADHERES} bodies.profile.kind=flat_punch",
     "not with a flat punch, whose edge does not move before it is lost", "remove it"),
    ("experiment.force", f"{ADHERES} experiment.kind=history",
     "not with [adhesion], under which a force has two displacements", "give experiment.displacement"),
    ("damping", f"{ADHERES} experiment.kind=path",
     "not with [adhesion] in a path, which under displacement control has no dynamics",
     'remove it: method = "quasistatic" is the same without time'),
    # What moves by itself, in time
    ("plate.free", "motion_is_result plate.free=z !plate.free=x",
     'must contain "x" in a slide', 'write free = ["x", "z"]'),
    ("horizontal", "!motion_is_result plate.free=x",
     'missing, needed by plate.free with "x"', f'write plate.free = ["z"], or add {EFFECT_TABLES["horizontal"].how}'),
    ("plate", "experiment.kind=impact",
     "missing, needed by an impact: it has the mass of the body", "add [plate] with mass"),
    ("plate.mass", "experiment.kind=impact plate.mass=auto",
     "must be given in an impact (MU): it is that of the body", "give its mass"),
    ("viscoelasticity.restitution", "!experiment.kind=impact", "only in an impact", "give terms or a retardation_time"),
    ("viscoelasticity.restitution", "experiment.kind=impact !bodies.profile.kind=parabola !bodies.profile.kind=cone "
     "!bodies.profile.kind=power", "only of a parabola, a cone or a power", "give a retardation_time"),
    ("friction", "experiment.kind=impact !oblique", f"not in an impact at a right angle: {UNMOVED}",
     "remove it, or give experiment.tangential_velocity or experiment.spin"),
    ("friction", "oblique", "missing, needed by an impact with tangential velocity or spin",
     f"add {EFFECT_TABLES['friction'].how}, or remove experiment.tangential_velocity and experiment.spin"),
    *((name, "oblique", f"not with a tangential velocity or a spin: how friction acts on {bodies} has no agreed theory",
       "remove it, or give the normal velocity alone")
      for name, bodies in (("adhesion", "an adhesive edge"), ("viscoelasticity", "a body that relaxes"))),
    ("plate.damping", "oblique !plate.damping=auto", "not with a tangential velocity or a spin: the body is free",
     "remove it"),
    ("plate.lever_arm", "oblique plate.lever_arm=auto !bodies.profile.kind=parabola !bodies.profile.kind=circle",
     "must be given for this profile (LU): the distance of the contact point from the centre of mass", "give it"),
    *((key, f"!oblique !{key}=auto", "only in an impact with tangential velocity or spin",
       "remove it, or give experiment.tangential_velocity or experiment.spin")
      for key in ("plate.lever_arm", "plate.moment_of_inertia")),
    ("plate", "experiment.kind=hold experiment.displacement",
     "not with a displacement that is held: the plate has no motion of its own", "remove it, or give a force"),
    ("plate", "experiment.kind=hold experiment.force",
     "missing, needed by a force that is held", f"add {EFFECT_TABLES['plate'].how}"),
    ("damping", "noise !kind", "missing, needed by [noise]", f"add {EFFECT_TABLES['damping'].how}"),
    _normal_loads,
    _shares,
    _history,
    # How the bodies are pulled apart, and how often
    ("experiment.loading_rate", "noise !experiment.method=quasistatic !experiment.velocity",
     "missing, needed by a pull_off with [noise]",
     "give the rate (FU/TU) at which the load decreases, or the velocity (LU/TU) of a spring that retracts the "
     "plate, or remove [noise]"),
    ("experiment.velocity", "experiment.loading_rate", "not together with a loading_rate", "remove one of the two"),
    ("experiment.velocity", "experiment.kind=pull_off !noise !adhesion.rate",
     "only with [noise], or with adhesion.rate: otherwise a pull-off does not depend on it",
     "remove it, or add one of these"),
    ("experiment.stiffness", "!experiment.velocity",
     "only with a velocity: it is that of the spring", "remove it, or give the velocity of its far end"),
    ("experiment.cycles", "experiment.kind=pull_off noise",
     "not with [noise], whose pulls are repeated with other seeds", "remove it, and give experiment.repeats"),
    ("experiment.loading_rate experiment.stiffness experiment.repeats", "!noise",
     "only with [noise]: without thermal fluctuations all repeats are equal",
     "remove it, or add [noise] with temperature and seed"),
    # What an experiment or an effect declares
    _excluded,
    _methods,
    _declared_keys,
    # The points of a profile, from a file or from lists
    ("bodies.profile.file", LISTED, "not together with the lists r and z", "give one of the two"),
    ("bodies.profile.scale bodies.profile.units", f"{LISTED} !bodies.profile.file",
     "not together with the lists r and z, which have units of their own", "it belongs to a file: remove it"),
    ("bodies.profile.x", "bodies.profile.r", "not together with r", "give one of the two"),
    # What only a lower body of particles has
    *((f"bodies.{key}", f"on_plane !bodies.{key}=false",
       f"not with {PLANE}, which has no particles", f"remove it, or use {PARTICLES}")
      for key in ("upper_particles", "upper_spacing", "upper_offset", "periodic")),
)
# fmt: on


ABOUT_ABSENT = {"miss": True, "not ": False, "only": False}
"""Whether messages that begin with these letters are about an absent key; others may be about any."""


def check_fit(scene: Place) -> None:
    """Report every violation of a rule across the tables of a scene, in its problems, and return nothing.

    A rule that depends on a value with an error of its own is left out.
    """
    draft = Draft(scene)
    for rule in RULES:
        for row in rule(draft) if callable(rule) else [rule]:
            _check(draft, *row)


def _check(draft: Draft, keys: str, broken: object, message: str, fix: str, *edits: Mapping[str, float]) -> None:
    """Report a rule that is broken, as a problem at each of its keys; return nothing.

    A message that begins with "missing" is for keys that the scene lacks, one that begins with "not" or "only" for
    those that it has; others are for both. Keys that no table has are left out.

    Args:
        draft: the scene.
        keys: dotted keys, between blanks.
        broken: conditions in words (`Draft.holds`), or whether the rule is broken.
        message: what is wrong, after conditions in words with {name} of a fact.
        fix: suggested fix, with {} for each number of `edits`, or {name}.
        edits: changes by dotted key [model units], each of which makes the scene valid.
    """
    if not (draft.holds(broken) if isinstance(broken, str) else broken):
        return
    if isinstance(broken, str):
        message, fix = (text.format_map(draft.facts) for text in (message, fix))
    changes = tuple({path: draft.written(path, number)} for edit in edits for path, number in edit.items())
    if edits:
        values = (value for change in changes for value in change.values())
        texts = (f"{value:g}" if isinstance(value, float) else value for value in values)
        fix = fix.format(*texts)
    for key in keys.split():
        place = draft.scene.find(key)
        if place and ABOUT_ABSENT.get(message[:4], place.absent) == place.absent:
            given = None if isinstance(place.value, Mapping) else place.given
            draft.scene.problems.append(Problem(key, message, given, fix, changes))
