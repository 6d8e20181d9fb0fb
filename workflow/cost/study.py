"""A cost study: reference, every knob turned from the base, effects left out, combinations; then orders and advice.

What a tolerance chooses is good in every scene of a study of many (`workflow.model.settings`); one scene may
need less. Errors are those of the main results, relative to a reference of much higher accuracy; the largest stands for
a variant.
"""

from __future__ import annotations

import math
import tempfile
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.workflow.cost.knobs import (
    Change,
    Knob,
    at_tolerance,
    base_change,
    is_sampled,
    knobs_of,
    left_out,
    main_results,
    with_method,
)
from contact1d.workflow.cost.measure import Measured, Prepared, effect_costs, measure, run_once, without_effects
from contact1d.workflow.cost.report import (
    AS_IT_IS,
    BASE,
    COMBINED,
    EFFECT,
    Advice,
    CostRecord,
    EffectCost,
    KnobRecord,
    Order,
    VariantRecord,
    power,
)
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import RunError
from contact1d.workflow.model.settings import Settings, SettingsError, settings_for
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.units import Quantity

REFERENCE_TOLERANCES = (1e-7, 1e-6, 1e-5)
"""Tried in turn, without time where the scene is at rest without it."""
REFERENCE_SHARES = (0.1, 0.3)
"""Of the scene's own tolerance, tried in turn where the result exists in time only."""
NOISY_SHARE = 0.25
"""The same with noise: sixteen times as many samples, as far as the program takes them."""


@dataclass(frozen=True)
class Planned:
    """A variant before it runs: its record without numbers, and how it is made."""

    record: VariantRecord
    change: Change


def _plan(label: str, group: str, change: Change, value: float = math.nan, **more: Any) -> Planned:
    keys = change.overrides + tuple(f"without {effect}" for effect in change.without)
    return Planned(VariantRecord(label, group, value, scene_keys=keys, **more), change)


def cost_of(scene: Scene, name: str, folder: Path, repeats: int, workers: int, progress: Progress) -> CostRecord:
    """Measure what accuracy costs in a scene.

    Args:
        scene: to be studied.
        name: of it, for the record.
        folder: where run folders may stand for a while; it exists.
        repeats: rounds of measurement.
        workers: runs at a time.
        progress: is told what begins, and of each run that ends.

    Raises:
        SettingsError: the scene leads to no computable system.
        RunError: no reference could be computed.
    """
    started = time.perf_counter()
    own = settings_for(scene)
    with tempfile.TemporaryDirectory(prefix=".cost-", dir=folder) as place:
        runs = Path(place)
        progress.phase("reference")
        label, reference = reference_of(scene, runs)
        change = base_change(scene)
        knobs = knobs_of(scene, own)
        planned = _planned(scene, knobs, change)
        progress.phase("runs", repeats * len(planned))
        records = _measured(scene, planned, runs, repeats, workers, progress, reference)
        records = _against_own(records, knobs)
        if not is_sampled(scene):
            found = [
                _plan(label, COMBINED, one, details=text) for label, text, one in combinations(knobs, records, change)
            ]
            if found:
                progress.phase("combinations", repeats * len(found))
                records += _measured(scene, found, runs, repeats, workers, progress, reference)
        progress.phase("effects, step by step")
        effects = _with_changes(effect_costs(scene, runs), records)
    base = next(one for one in records if one.knob == BASE)
    competing = [one for one in records if one.competes]
    front = pareto_front([one.cpu_s for one in competing], [one.error for one in competing])
    return CostRecord(
        title=scene.title,
        scene=name,
        method=scene.method,
        tolerance=scene.accuracy.tolerance,
        effects=scene.effects,
        reference=label,
        reference_values={key: one.value for key, one in reference.items()},
        reference_uncertainties={key: one.uncertainty / abs(one.value) for key, one in reference.items()},
        base=base.label,
        base_error=base.error,
        repeats=repeats,
        knobs=tuple(_knob_record(knob, records, 0.0 if knob.own_reference else base.error, scene) for knob in knobs),
        variants=tuple(one for one in records if one.knob == AS_IT_IS or not one.failure),
        effect_costs=effects,
        left_out=left_out(scene),
        pareto=tuple(competing[i].label for i in front),
        advice=tuple(advise(target, competing, is_sampled(scene)) for target in TARGETS),
        versions=versions(),
        wall_s=time.perf_counter() - started,
    )


def reference_of(scene: Scene, folder: Path) -> tuple[str, dict[str, Quantity]]:
    """Label and main results of the reference: the tightest that works, without time where time is no physics.

    Raises:
        RunError: none works.
    """
    own, failures = scene.accuracy.tolerance, []
    candidates: list[tuple[str, Change]] = []
    if scene.noise is not None:
        seed = Change((f"noise.seed={scene.noise.seed + 1}",))
        candidates.append(("with noise of another seed", at_tolerance(scene, NOISY_SHARE * own) + seed))
    elif not scene.experiment.motion_is_result:
        still = with_method(scene, "quasistatic") if scene.method == "dynamic" else Change()
        candidates += [("quasistatic", at_tolerance(scene, t) + still) for t in REFERENCE_TOLERANCES if t < own]
    if scene.noise is None and scene.method == "dynamic":
        candidates += [("dynamic", at_tolerance(scene, share * own)) for share in REFERENCE_SHARES]
    for text, change in candidates:
        changed = change.scene(scene)
        done = run_once(Prepared(text, changed, settings_for(changed)), folder / "reference", fresh=False)
        main = main_results(changed, done.quantities)
        if main:
            return f"{text}, accuracy.tolerance = {changed.accuracy.tolerance:g}", main
        failures.append(done.failure or "it has no main result other than 0")
    raise RunError(f"no reference of higher accuracy could be computed: {failures[-1] if failures else ''}", folder)


def _planned(scene: Scene, knobs: Sequence[Knob], base: Change) -> list[Planned]:
    found = [_plan("the scene as it is", AS_IT_IS, Change()), _plan("base", BASE, base)]
    for knob in knobs:
        for level in knob.levels:
            whole = knob.name == "tolerance" or knob.alternative
            change = level.change if whole else base + level.change
            details = _choice(scene, change) if knob.name == "tolerance" else ""
            found.append(
                _plan(level.label, knob.name, change, level.value, details=details, own_reference=knob.own_reference)
            )
    changes, _ = without_effects(scene)
    return found + [_plan(f"without {effect}", EFFECT, one, same_physics=False) for effect, one in changes.items()]


def _choice(scene: Scene, change: Change) -> str:
    try:
        changed = change.scene(scene)
        return choice(changed, settings_for(changed))
    except (SceneError, SettingsError):  # which the run will tell
        return ""


def _measured(
    scene: Scene,
    planned: Sequence[Planned],
    folder: Path,
    repeats: int,
    workers: int,
    progress: Progress,
    reference: Mapping[str, Quantity],
) -> list[VariantRecord]:
    ready, failures = [], {}
    for one in planned:
        try:
            changed = one.change.scene(scene)
            ready.append(Prepared(one.record.label, changed, settings_for(changed)))
        except (SceneError, SettingsError) as error:
            failures[one.record.label] = Measured(failure=str(error))
    done = (measure(ready, folder, repeats, workers, progress) if ready else {}) | failures
    return [_record(one.record, done[one.record.label], reference, is_sampled(scene)) for one in planned]


def _record(
    planned: VariantRecord, measured: Measured, reference: Mapping[str, Quantity], noisy: bool
) -> VariantRecord:
    record = replace(
        planned,
        cpu_s=measured.cpu_s,
        cpu_runs=measured.cpu_runs,
        total_s=measured.total_s,
        steps=measured.steps,
        memory_mb=measured.memory_mb,
        failure=measured.failure,
    )
    if measured.failure:
        return record
    found = measured.quantities
    if not record.same_physics:
        return replace(record, values={name: found[name].value for name in reference if name in found})
    return judged(record, found, reference, noisy)


def judged(
    record: VariantRecord, quantities: Mapping[str, Quantity], reference: Mapping[str, Quantity], noisy: bool
) -> VariantRecord:
    """The record with its errors; one that lacks a main result has failed.

    Args:
        record: a variant that ran.
        quantities: that it found.
        reference: main results of the reference.
        noisy: whether uncertainties are standard errors, from which those of the errors follow (`is_sampled`).
    """
    if missing := [name for name in reference if name not in quantities]:
        return replace(record, failure=f"found no {' and no '.join(missing)}")
    values = {name: quantities[name].value for name in reference}
    errors = {name: abs(values[name] / reference[name].value - 1.0) for name in reference}
    worst = max(errors, key=lambda name: errors[name])
    spread = 0.0
    if noisy:
        both = math.hypot(quantities[worst].uncertainty, reference[worst].uncertainty)
        spread = both / abs(reference[worst].value)
    return replace(record, values=values, errors=errors, error=errors[worst], spread=spread)


def _against_own(records: Sequence[VariantRecord], knobs: Sequence[Knob]) -> list[VariantRecord]:
    """Errors of the knobs that the reference does not have, against the finest level that ran."""
    finest: dict[str, VariantRecord] = {}
    for knob in (one for one in knobs if one.own_reference):
        ran = [one for one in records if one.knob == knob.name and not one.failure]
        if ran:
            finest[knob.name] = (min if knob.finer == "smaller" else max)(ran, key=lambda one: one.value)
    return [_relative(one, finest[one.knob]) if one.knob in finest and not one.failure else one for one in records]


def _relative(one: VariantRecord, finest: VariantRecord) -> VariantRecord:
    errors = {name: abs((one.values or {})[name] / value - 1.0) for name, value in (finest.values or {}).items()}
    return replace(one, errors=errors, error=float("nan") if one is finest else max(errors.values()))


def _knob_record(knob: Knob, records: Sequence[VariantRecord], floor: float, scene: Scene) -> KnobRecord:
    order = None
    if knob.has_order and not is_sampled(scene):
        mine = [one for one in records if one.knob == knob.name and not one.failure]
        h = [one.value if knob.finer == "smaller" else 1.0 / one.value for one in mine]
        order = fit_order(h, [one.error for one in mine], floor if knob.name != "tolerance" else 0.0)
    return KnobRecord(knob.name, knob.meaning, knob.finer, knob.own, knob.own_reference, order)


def _with_changes(effects: Sequence[EffectCost], records: Sequence[VariantRecord]) -> tuple[EffectCost, ...]:
    """The costs with what leaving an effect out does to the main results."""
    scene = next(one for one in records if one.knob == AS_IT_IS)
    left = {one.label: one for one in records if one.knob == EFFECT and not one.failure}
    found = []
    for effect in effects:
        without = left.get(f"without {effect.name}")
        if without is None or not scene.values:
            found.append(effect)
            continue
        values = without.values or {}
        changes = {name: value / scene.values[name] - 1.0 for name, value in values.items() if name in scene.values}
        found.append(replace(effect, changes=changes))
    return tuple(found)


FLOOR_FACTOR = 5.0
"""An error below this many floors belongs to the other settings, not to the knob."""
ASYMPTOTIC = 0.1
"""Errors above it are too large for a leading term to prevail."""
ROUND_OFF = 1e-9
"""Errors below it are those of the reference and of round-off."""
FEWEST_POINTS = 3
"""Points below which a slope would have no standard error."""


def fit_order(h: Sequence[float], errors: Sequence[float], floor: float = 0.0) -> Order | None:
    """Least squares of ln error = p ln h + c.

    Args:
        h: what goes to zero as the knob gets finer, > 0.
        errors: relative, of the same length; NaN where there is none.
        floor: error that is left where this knob has none: points within FLOOR_FACTOR times it are left out.

    Returns:
        The order with its standard error, √(Σ residual²/(n − 2)/Σ(x − x̄)²), or None with fewer than FEWEST_POINTS
        points between the floor and ASYMPTOTIC.
    """
    used = [
        (math.log(one), math.log(error))
        for one, error in zip(h, errors, strict=True)
        if math.isfinite(error) and max(FLOOR_FACTOR * floor, ROUND_OFF) < error < ASYMPTOTIC
    ]
    if len(used) < FEWEST_POINTS or len({x for x, _ in used}) < FEWEST_POINTS:
        return None
    x, y = np.asarray(used).T
    spread = float(np.sum((x - x.mean()) ** 2))
    slope = float(np.sum((x - x.mean()) * (y - y.mean()))) / spread
    residual = y - y.mean() - slope * (x - x.mean())
    return Order(slope, math.sqrt(float(np.sum(residual**2)) / (len(used) - 2) / spread), len(used))


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Indices of the points that no other beats in both cost and error, the cheapest first; NaN is no point."""
    order = sorted(
        (i for i in range(len(costs)) if math.isfinite(costs[i]) and math.isfinite(errors[i])),
        key=lambda i: (costs[i], errors[i]),
    )
    front: list[int] = []
    for i in order:
        if not front or errors[i] < errors[front[-1]]:
            front.append(i)
    return front


TABLE, FIGURE = "cost.csv", "cost.png"


TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
KNOB_SHARE = 0.25
"""Part of a tolerance that one knob of a combination may use up."""
WORTHWHILE_SAVING = 0.9
"""CPU time over that of what the tolerance chooses, below which something is worth saying: medians differ by less."""


def combinations(
    knobs: Sequence[Knob], records: Sequence[VariantRecord], base: Change
) -> Iterator[tuple[str, str, Change]]:
    """For each tolerance, every knob at its coarsest value with an error within KNOB_SHARE of it."""
    turned = [knob for knob in knobs if not knob.own_reference and not knob.alternative]
    for target in TARGETS:
        change = base
        found: list[str] = []
        for knob in turned:
            level = _coarsest(knob, records, KNOB_SHARE * target)
            if level is not None:
                change += knob.levels[level].change
                found.append(knob.levels[level].label)
        if found:
            yield f"combined for {power(target)}", ", ".join(found), change


def _coarsest(knob: Knob, records: Sequence[VariantRecord], error: float) -> int | None:
    """Index of the coarsest level within that error; of a knob without a scale of errors, of the cheapest one."""
    measured = {one.label: one for one in records if one.knob == knob.name and one.competes and one.error <= error}
    within = [i for i, level in enumerate(knob.levels) if level.label in measured]
    if not within:
        return None
    if knob.name == "damping":
        return min(within, key=lambda i: measured[knob.levels[i].label].cpu_s)
    return (max if knob.finer == "smaller" else min)(within, key=lambda i: knob.levels[i].value)


def choice(scene: Scene, settings: Settings) -> str:
    """What the settings of a scene are, in the words of the knobs."""
    words = []
    if settings.table is not None and scene.interaction is not None:
        words.append(f"table of {settings.table.points} points")
        if scene.interaction.attraction is not None:
            words.append(f"cutoff {settings.cutoff:.3g} LU")
    words.append(f"chain of {settings.particles} particles")
    if scene.method == "dynamic":
        words.append(f"time step {settings.time_step:.3g} TU")
    else:
        words.append(f"residual {settings.force_tolerance / settings.force_scale:.0e}")
        if not scene.experiment.way_is_given:
            step = settings.smooth_step if settings.is_smooth else settings.displacement_step
            words.append(f"increment {step:.3g} LU")
    return ", ".join(words)


def advise(tolerance: float, variants: Sequence[VariantRecord], noisy: bool) -> Advice:
    """One line: what `[accuracy] tolerance` chooses and what that was measured to be, and what reaches it for less.

    Args:
        tolerance: that is asked for.
        variants: that compete.
        noisy: whether errors have a standard error.
    """
    chosen = next((one for one in variants if one.knob == "tolerance" and math.isclose(one.value, tolerance)), None)
    reaching = sorted((one for one in variants if one.bound <= tolerance), key=lambda one: one.cpu_s)
    if chosen is None:
        text = f"tolerance {power(tolerance)}: was not run"
    else:
        text = f"tolerance {power(tolerance)}: chooses {chosen.details}: {_in_words(chosen)}"
        text += "" if chosen in reaching else ", which is not enough"
    limit = WORTHWHILE_SAVING * chosen.cpu_s if chosen in reaching and chosen is not None else math.inf
    less = [one for one in reaching if one.cpu_s < limit]
    if less:
        text += f"; {'cheaper' if limit < math.inf else 'the cheapest'} in this scene: {said(less[0])}"
    elif limit < math.inf:
        text += "; nothing else that was tried is clearly cheaper"
    else:
        best = min(variants, key=lambda one: one.bound, default=None)
        nearest = "" if best is None else f" (best {best.bound:.1e}{', by its noise' if noisy else ''}: {best.label})"
        text += f"; not reached by any setting tried{nearest}"
    return Advice(tolerance, text, "" if chosen is None else chosen.label, reaching[0].label if reaching else "")


def said(one: VariantRecord) -> str:
    """Label, what it is made of if the label does not say it, error and CPU time."""
    details = f" ({one.details})" if one.details and one.knob != "tolerance" else ""
    return f"{one.label}{details}, {_in_words(one)}"


def _in_words(one: VariantRecord) -> str:
    spread = f" ± {one.spread:.0e}" if one.spread else ""
    return f"error {one.error:.1e}{spread} in {one.cpu_s:.2g} s of CPU"
