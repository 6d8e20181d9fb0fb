"""Rules across the tables of a scene, by subject, and one evaluation that reports every violation at once.

A rule is a row: the key that it speaks of, whether it is broken, what is wrong, what to do, and at times the changes by
dotted keys that would each make a scene of it. What an experiment or an effect needs and excludes is declared beside
its keys (`experiments`, `effects`), and read here for all of them alike.

Two bodies touch in one way only if the force f(r) = (A/a) exp(−r/a) − (B/b) exp(−r/b) repels at contact,
A/a > B/b, and attracts far off, b > a. It then vanishes once, at r₀ = ln(A b / (B a)) a b / (b − a).
Two periodic chains of n and m particles close together only if n·s_lower = m·s_upper.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise

from contact1d.digits import apart
from contact1d.workflow.scene.body_rules import (
    counter_body,
    lower_body,
    material,
    open_spacing,
    periodic,
    punch,
    reduction,
)
from contact1d.workflow.scene.draft import (
    DIGITS,
    PARTICLES,
    PLANE,
    SAID_OF,
    WHOLE_NUMBER_ERROR,
    Draft,
    Row,
    Rows,
    limit,
)
from contact1d.workflow.scene.experiments import KINDS
from contact1d.workflow.scene.kinds import Cycles, Span
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


def _attraction(d: Draft) -> Rows:
    pulls_off, attracts = d.kind == "pull_off", "interaction.attraction" in d
    held = attracts or ("adhesion" in d and "adhesion" not in d.experiment.excludes)
    force = d[f"experiment.{d.experiment.load_key}"]
    yield ("interaction.attraction",
           pulls_off and d.lower == "particles" and "interaction" in d and "adhesion" not in d,
           "missing, needed by a pull_off", "add interaction.attraction with amplitude and range")
    for key, tensile in (
        ("force", "a tensile force needs interaction.attraction, or on a rigid plane [adhesion]"),
        ("normal_force", "a force of 0 or a tensile one needs interaction.attraction"),
    ):
        yield (f"experiment.{key}", key == d.experiment.load_key and force is not None and force <= 0 and not held,
               "must be greater than 0 (FU) without attraction: compression is positive", f"raise it; {tensile}")
    for key in ("work_of_adhesion", "surface_energy"):
        yield (f"adhesion.{key}", pulls_off and d[f"adhesion.{key}"] == 0.0,
               "must be greater than 0 (FU/LU) in a pull_off, else nothing holds the bodies together",
               'raise it, or use kind = "load" or "path"')
    adheres = d.on_plane and "adhesion" in d
    yield ("bodies.reduction", adheres and d["bodies.reduction"] == "geike_popov",
           'must be "mdr" with [adhesion], whose contact edge is that of a contact of three dimensions',
           'write reduction = "mdr"')
    yield ("adhesion.range", adheres and "adhesion.range" in d and d.profile == "flat_punch",
           "not with a flat punch, whose edge has no attraction beyond it", "remove it: a punch is Kendall's")
    timed = [name for name in TIMED if name in d]
    yield ("adhesion.range", adheres and "adhesion.range" in d and bool(timed or d["experiment.method"] == "dynamic"),
           f"only of contacts at rest, not {f'with [{timed[0]}]' if timed else 'in time'}",
           'remove it, or use method = "quasistatic" without [plate], [damping] and [noise]')
    rated, pulled = adheres and "adhesion.rate" in d, d.kind == "pull_off" and "experiment.velocity" in d
    yield ("adhesion.rate", rated and "adhesion.range" in d, "not together with a range: it is that of JKR's edge",
           "give one of the two")
    yield ("adhesion.rate", rated and not (pulled or (d.kind == "history" and "experiment.displacement" in d)),
           "only in a pull_off with a velocity, or in a history of displacements: other states have no time",
           'remove it, or give experiment.velocity with kind = "pull_off"')
    yield ("adhesion.rate", rated and bool(timed or d["experiment.method"] == "dynamic" or "experiment.cycles" in d),
           "only of one pull in equilibrium, whose edge alone takes time",
           'remove it, or use method = "quasistatic" without cycles, [plate], [damping] and [noise]')
    yield ("adhesion.rate", rated and d.profile == "flat_punch",
           "not with a flat punch, whose edge does not move before it is lost", "remove it")
    yield ("experiment.force", adheres and d.kind == "history" and "experiment.force" in d,
           "not with [adhesion], under which a force has two displacements", "give experiment.displacement")
    yield ("damping", adheres and d.kind == "path",
           "not with [adhesion] in a path, which under displacement control has no dynamics",
           'remove it: method = "quasistatic" is the same without time')


def _plate(d: Draft) -> Rows:
    slides, free = d.experiment.motion_is_result, d["plate.free"]
    yield ("plate.free", slides and free is not None and "x" not in free,
           'must contain "x" in a slide', 'write free = ["x", "z"]')
    yield ("horizontal", not slides and "x" in (free or ()),
           'missing, needed by plate.free with "x"',
           f'write plate.free = ["z"], or add {EFFECT_TABLES["horizontal"].how}')
    yield ("plate", d.kind == "impact",
           "missing, needed by an impact: it has the mass of the body", "add [plate] with mass")
    yield ("plate.mass", d.kind == "impact" and d["plate.mass"] == "auto",
           "must be given in an impact (MU): it is that of the body", "give its mass")
    held = d.kind == "hold"
    yield ("plate", held and "experiment.displacement" in d,
           "not with a displacement that is held: the plate has no motion of its own", "remove it, or give a force")
    yield ("plate", held and "experiment.force" in d,
           "missing, needed by a force that is held", f"add {EFFECT_TABLES['plate'].how}")


def _normal_loads(d: Draft) -> Rows:
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


def _relaxing(d: Draft) -> Rows:
    """A body that relaxes, and the times of a history."""
    shares = [term["share"] for term in d["viscoelasticity.terms"] or []]
    whole = math.fsum(shares)
    yield ("viscoelasticity.terms", whole > 1.0 + WHOLE_NUMBER_ERROR,
           f"the shares of the instantaneous modulus must add up to 1 at most, not {apart(whole, 1.0, DIGITS)[0]}",
           "lower one of them")
    points = d["experiment.displacement"] or d["experiment.force"] if d.kind == "history" else None
    if not points:
        return
    key = "experiment.displacement" if "experiment.displacement" in d else "experiment.force"
    times, values = zip(*((point["time"], point[key.partition(".")[2]]) for point in points), strict=True)
    back = next((i for i in range(1, len(times)) if times[i] <= times[i - 1]), 0)
    yield (key, back, f"times must rise; {times[back]:.6g} follows {times[back - 1]:.6g}",
           "each point is later than the one before; a jump is a leg as short as you want")
    yield (key, max(values) <= 0.0, "must be greater than 0 somewhere, else the bodies never touch", "raise it")
    retarded, steps = d["viscoelasticity.retardation_time"], d["experiment.steps"]
    yield (key, retarded is not None and values[0] > 0.0,
           "must begin apart with a retardation_time: dashpots resist a jump without bound", "begin with 0 or less")
    longest = max(after - before for before, after in pairwise(times)) / (steps or 1)
    shortest = min([retarded] if retarded else [term["time"] for term in d["viscoelasticity.terms"] or []], default=0.0)
    yield ("experiment.steps", steps is not None and "experiment.force" in d and longest > shortest > 0.0,
           "a load step under a given force would take {} (TU), longer than the shortest time of the body, {}".format(
               *apart(longest, shortest, DIGITS)), "give more steps, or leave it to the program")


def _pull_off(d: Draft) -> Rows:
    if d.kind != "pull_off":
        return
    rate, velocity = "experiment.loading_rate" in d, "experiment.velocity" in d
    thermal = "noise" in d and d["experiment.method"] != "quasistatic"
    yield ("experiment.loading_rate", thermal and not velocity,
           "missing, needed by a pull_off with [noise]",
           "give the rate (FU/TU) at which the load decreases, or the velocity (LU/TU) of a spring that retracts the "
           "plate, or remove [noise]")
    yield ("experiment.velocity", rate, "not together with a loading_rate", "remove one of the two")
    yield ("experiment.velocity", "noise" not in d and "adhesion.rate" not in d,
           "only with [noise], or with adhesion.rate: otherwise a pull-off does not depend on it",
           "remove it, or add one of these")
    yield ("experiment.stiffness", not velocity,
           "only with a velocity: it is that of the spring",
           "remove it, or give the velocity of its far end")


# What an experiment or an effect declares


def _needed(name: str, by: str) -> Row:
    return name, True, f"missing, needed by {by}", f"add {EFFECT_TABLES[name].how}"


def _methods(d: Draft) -> Rows:
    """Each experiment and method has effects that it needs and effects that it cannot have."""
    kind, experiment, given = d.kind, d.experiment, d["experiment.method"]
    if kind is None:
        if "noise" in d:
            yield _needed("damping", "[noise]")
        return
    excluded = experiment.excludes
    others = (one for one, table in KINDS.items() if not table.excludes.keys() & {*d.effects})
    other = next((f', or use kind = "{one}"' for one in others), "")
    for name, why in excluded.items():
        yield (name, True, f"not in a {kind}: {why}", f"remove it{other}")
    if given is None and "experiment.method" in d:
        return
    rest = tuple(name for name in d.effects if name not in excluded)
    method = experiment.only_method or given or default_method(rest)
    for name in experiment.needs:
        yield _needed(name, f"a {kind}")
    if method == "dynamic" and experiment.only_method is None:
        cause = "" if given else ", made dynamic by " + ", ".join(f"[{name}]" for name in rest if name in TIMED)
        for name in experiment.needs_in_time:
            also = " and by [noise]" if given and name == "damping" and "noise" in rest else ""
            yield _needed(name, f"a dynamic {kind}{cause}{also}")
    for name in TIMED:
        yield (name, method == "quasistatic" and name in rest,
               f"not in a quasistatic {kind}, which does not depend on time",
               'remove it, or use experiment.method = "dynamic"')


def _declared_keys(d: Draft) -> Rows:
    """Of some keys exactly one is there; some are only with noise, or only with a lower body of particles."""
    effects = {name: EFFECT_TABLES[name] for name in d.effects if d[name] is not None}
    profile = keys_of(Bodies)["profile"].allowed.kinds.get(d.profile, Table)
    for name, table in {**effects, "experiment": d.experiment, "bodies.profile": profile}.items():
        for keys, fix in table.one_of:
            given = [key for key in keys if f"{name}.{key}" in d]
            yield (f"{name}.{keys[0]}", not given, "missing", fix)
            for key in given[1:]:
                yield (f"{name}.{key}", True, f"not together with {given[0]}", fix)
    for key in d.experiment.only_with_noise:
        yield (f"experiment.{key}", "noise" not in d,
               "only with [noise]: without thermal fluctuations all repeats are equal",
               "remove it, or add [noise] with temperature and seed")
    yield ("experiment.cycles", d.kind == "pull_off" and "noise" in d,
           "not with [noise], whose pulls are repeated with other seeds", "remove it, and give experiment.repeats")
    yield ("experiment.preload", d.kind == "pull_off" and "experiment.cycles" in d and d["experiment.preload"] == 0.0,
           "must be greater than 0 (FU) with cycles, whose bodies are pressed together again", "raise it")
    listed = any(f"bodies.profile.{key}" in d for key in "rxz")
    yield ("bodies.profile.file", listed,
           "not together with the lists r and z", "give one of the two")
    yield ("bodies.profile.scale", listed and "bodies.profile.file" not in d,
           "not together with the lists r and z, which have units of their own", "it belongs to a file: remove it")
    yield ("bodies.profile.units", listed and "bodies.profile.file" not in d,
           "not together with the lists r and z, which have units of their own", "it belongs to a file: remove it")
    yield ("bodies.profile.x", "bodies.profile.r" in d and "bodies.profile.x" in d,
           "not together with r", "give one of the two")
    for key in ("upper_particles", "upper_spacing", "upper_offset", "periodic"):
        path = f"bodies.{key}"
        yield (path, d.on_plane and d[path] is not False,
               f"not with {PLANE}, which has no particles", f"remove it, or use {PARTICLES}")


def _beside_effects(d: Draft) -> Rows:
    """Effects that another one cannot have beside it, on the lower body that this one belongs to."""
    for effect in d.effects if d.on_plane else ():
        for name, why in EFFECT_TABLES[effect].excludes.items():
            yield (name, True, f"not with [{effect}]: {why}", f"remove [{name}], or [{effect}]")
# fmt: on


RULES = (
    lower_body,
    _interaction,
    _attraction,
    _plate,
    _normal_loads,
    _relaxing,
    open_spacing,
    punch,
    material,
    counter_body,
    reduction,
    _pull_off,
    periodic,
    _methods,
    _declared_keys,
    _beside_effects,
)


def check_fit(scene: Place) -> None:
    """Report every violation of a rule across the tables of a scene that does not depend on values that are doubted."""
    draft = Draft(scene)
    for key, broken, message, fix, *ways in (row for rows in RULES for row in rows(draft)):
        place = scene.at(key)
        if broken and place and SAID_OF.get(message[:4], place.absent) == place.absent:
            changes = tuple({path: draft.written(path, number)} for way in ways for path, number in way.items())
            texts = (f"{one:g}" if isinstance(one, float) else one for way in changes for one in way.values())
            given = None if isinstance(place.value, Mapping) else place.given
            scene.problems.append(Problem(key, message, given, fix.format(*texts) if ways else fix, changes))
