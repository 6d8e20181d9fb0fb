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
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.workflow.cost.knobs import (
    Keys,
    Knob,
    Level,
    Order,
    at_tolerance,
    base_keys,
    changed,
    is_sampled,
    knobs_of,
    main_results,
    with_method,
)
from contact1d.workflow.cost.measure import (
    EffectCost,
    Measured,
    Prepared,
    effect_costs,
    measure,
    run_once,
    without_effects,
)
from contact1d.workflow.cost.report import AS_IT_IS, BASE, COMBINED, EFFECT, Advice, CostRecord, Variant, power
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
Results = Mapping[str, Quantity]


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
    (knobs, left_out), noisy = knobs_of(scene, settings_for(scene)), is_sampled(scene)
    with tempfile.TemporaryDirectory(prefix=".cost-", dir=folder) as place:
        runs = Path(place)
        progress.phase("reference")
        label, reference = reference_of(scene, runs)

        def run_all(phase: str, planned: Sequence[Variant]) -> list[Variant]:
            progress.phase(phase, repeats * len(planned))
            ready, done = _prepared(scene, planned)
            done |= measure(ready, runs, repeats, workers, progress) if ready else {}
            ran = []
            for one in planned:
                details = choice(*ready[one.label]) if one.knob == "tolerance" and one.label in ready else one.details
                ran.append(judged(replace(one, **vars(done[one.label]), details=details), reference, noisy))
            return ran

        variants = _against_own(run_all("runs", list(_planned(scene, knobs))), knobs, noisy)
        found = [] if noisy else list(combinations(knobs, variants, base_keys(scene)))
        variants += run_all("combinations", found) if found else []
        progress.phase("effects, step by step")
        effects = _with_changes(effect_costs(scene, runs), variants)
    base = next(one for one in variants if one.knob == BASE)
    competing = [one for one in variants if one.competes]
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
        knobs=knobs if noisy else tuple(_with_order(knob, variants, base.error) for knob in knobs),
        variants=tuple(one for one in variants if one.knob == AS_IT_IS or not one.failure),
        effect_costs=effects,
        left_out=left_out,
        pareto=tuple(competing[i].label for i in front),
        advice=tuple(advise(target, competing, noisy) for target in TARGETS),
        versions=versions(),
        wall_s=time.perf_counter() - started,
    )


def reference_of(scene: Scene, folder: Path) -> tuple[str, dict[str, Quantity]]:
    """Label and main results of the reference: the tightest that works, without time where time is no physics.

    Raises:
        RunError: none works.
    """
    own, failures = scene.accuracy.tolerance, []
    candidates: list[tuple[str, Keys]] = []
    if scene.noise is not None:
        seed = f"noise.seed={scene.noise.seed + 1}"
        candidates.append(("with noise of another seed", (*at_tolerance(scene, NOISY_SHARE * own), seed)))
    elif not scene.experiment.motion_is_result:
        still = with_method(scene, "quasistatic") if scene.method == "dynamic" else ()
        candidates += [("quasistatic", at_tolerance(scene, t) + still) for t in REFERENCE_TOLERANCES if t < own]
    if scene.noise is None and scene.method == "dynamic":
        candidates += [("dynamic", at_tolerance(scene, share * own)) for share in REFERENCE_SHARES]
    for text, keys in candidates:
        other = changed(scene, keys)
        done = run_once((other, settings_for(other)), folder / "reference", fresh=False)
        if main := main_results(other, done.quantities):
            return f"{text}, accuracy.tolerance = {other.accuracy.tolerance:g}", main
        failures.append(done.failure or "it has no main result other than 0")
    raise RunError(f"no reference of higher accuracy could be computed: {failures[-1] if failures else ''}", folder)


def _planned(scene: Scene, knobs: Sequence[Knob]) -> Iterator[Variant]:
    base = base_keys(scene)
    yield Variant(label="the scene as it is", knob=AS_IT_IS)
    yield Variant(label="base", knob=BASE, scene_keys=base)
    for knob in knobs:
        for value, label, keys in knob.levels:
            whole = knob.name == "tolerance" or knob.alternative
            known: dict[str, Any] = {"value": value, "own_reference": knob.own_reference}
            yield Variant(label=label, knob=knob.name, scene_keys=keys if whole else base + keys, **known)
    for effect, keys in without_effects(scene)[0].items():
        yield Variant(label=f"without {effect}", knob=EFFECT, scene_keys=keys)


def _prepared(scene: Scene, planned: Sequence[Variant]) -> tuple[dict[str, Prepared], dict[str, Measured]]:
    """By their labels the variants that can run, and the failures of those that can't."""
    ready, failures = {}, {}
    for one in planned:
        try:
            other = changed(scene, one.scene_keys)
            ready[one.label] = other, settings_for(other)
        except (SceneError, SettingsError) as error:
            failures[one.label] = Measured(failure=str(error))
    return ready, failures


def judged(one: Variant, reference: Results, noisy: bool) -> Variant:
    """A variant that ran with its values and errors; one that lacks a main result has failed.

    Args:
        one: with its quantities.
        reference: main results of the reference.
        noisy: whether uncertainties are standard errors, from which those of the errors follow (`is_sampled`).
    """
    if one.failure:
        return one
    found = {name: one.quantities[name] for name in reference if name in one.quantities}
    values = {name: quantity.value for name, quantity in found.items()}
    if not one.same_physics:
        return replace(one, values=values)
    if missing := [name for name in reference if name not in found]:
        return replace(one, failure=f"found no {' and no '.join(missing)}")
    errors = {name: abs(values[name] / reference[name].value - 1.0) for name in reference}
    worst = max(errors, key=lambda name: errors[name])
    both = math.hypot(found[worst].uncertainty, reference[worst].uncertainty) / abs(reference[worst].value)
    return replace(one, values=values, errors=errors, error=errors[worst], spread=both if noisy else 0.0)


def _ran(knob: Knob, variants: Sequence[Variant]) -> list[Variant]:
    return [one for one in variants if one.knob == knob.name and not one.failure]


def _against_own(variants: Sequence[Variant], knobs: Sequence[Knob], noisy: bool) -> list[Variant]:
    """Errors of the knobs that the reference does not have, against the finest level that ran, which has none."""
    found = {one.label: one for one in variants}
    for knob in (one for one in knobs if one.own_reference):
        ran = sorted(_ran(knob, variants), key=lambda one: knob.coarseness(one.value))
        for one in ran:
            finest = {name: ran[0].quantities[name] for name in one.values}
            again = judged(one, finest, noisy)
            found[one.label] = replace(again, error=math.nan) if one is ran[0] else again
    return list(found.values())


def _with_order(knob: Knob, variants: Sequence[Variant], base_error: float) -> Knob:
    """The knob with the order of its error, where it has one; the base's own error limits what is turned from it."""
    ran = _ran(knob, variants) if knob.has_order else []
    floor = 0.0 if knob.own_reference or knob.name == "tolerance" else base_error
    order = fit_order([knob.coarseness(one.value) for one in ran], [one.error for one in ran], floor)
    return replace(knob, order=order)


def _with_changes(effects: Sequence[EffectCost], variants: Sequence[Variant]) -> tuple[EffectCost, ...]:
    """The costs with what leaving an effect out does to the main results."""
    own = next(one for one in variants if one.knob == AS_IT_IS).values
    left = {one.label: one.values for one in variants if one.knob == EFFECT}
    return tuple(
        replace(effect, changes={name: value / own[name] - 1.0 for name, value in values.items() if name in own})
        for effect in effects
        for values in [left.get(f"without {effect.name}", {})]
    )


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
    x, y = np.asarray(h, dtype=float), np.asarray(errors, dtype=float)
    used = (y > max(FLOOR_FACTOR * floor, ROUND_OFF)) & (y < ASYMPTOTIC)
    if len(np.unique(x[used])) < FEWEST_POINTS:
        return None
    (slope, _), covariance = np.polyfit(np.log(x[used]), np.log(y[used]), 1, cov=True)
    return Order(float(slope), math.sqrt(covariance[0, 0]), int(used.sum()))


def pareto_front(costs: Sequence[float], errors: Sequence[float]) -> list[int]:
    """Indices of the points that no other beats in both cost and error, the cheapest first; NaN is no point."""
    finite = [i for i, pair in enumerate(zip(costs, errors, strict=True)) if all(map(math.isfinite, pair))]
    front: list[int] = []
    for i in sorted(finite, key=lambda i: (costs[i], errors[i])):
        if not front or errors[i] < errors[front[-1]]:
            front.append(i)
    return front


TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
KNOB_SHARE = 0.25
"""Part of a tolerance that one knob of a combination may use up."""
WORTHWHILE_SAVING = 0.9
"""CPU time over that of what the tolerance chooses, below which something is worth saying: medians differ by less."""


def combinations(knobs: Sequence[Knob], variants: Sequence[Variant], base: Keys) -> Iterator[Variant]:
    """For each tolerance, every knob at its coarsest value with an error within KNOB_SHARE of it."""
    for target in TARGETS:
        turned = (knob for knob in knobs if not knob.own_reference and not knob.alternative)
        levels = [level for knob in turned if (level := _coarsest(knob, variants, KNOB_SHARE * target))]
        if levels:
            keys = base + tuple(key for level in levels for key in level.keys)
            details = ", ".join(level.label for level in levels)
            yield Variant(label=f"combined for {power(target)}", knob=COMBINED, scene_keys=keys, details=details)


def _coarsest(knob: Knob, variants: Sequence[Variant], error: float) -> Level | None:
    """The coarsest level within that error; of a knob without a scale of errors, the cheapest one."""
    cpu = {one.label: one.cpu_s for one in variants if one.knob == knob.name and one.competes and one.error <= error}
    within = [level for level in knob.levels if level.label in cpu]
    if knob.name == "damping":
        return min(within, key=lambda level: cpu[level.label], default=None)
    return max(within, key=lambda level: knob.coarseness(level.value), default=None)


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


def advise(tolerance: float, variants: Sequence[Variant], noisy: bool) -> Advice:
    """One line: what `[accuracy] tolerance` chooses and what that was measured to be, and what reaches it for less.

    Args:
        tolerance: that is asked for.
        variants: that compete.
        noisy: whether errors have a standard error.
    """
    chosen = next((one for one in variants if one.knob == "tolerance" and math.isclose(one.value, tolerance)), None)
    reaching = sorted((one for one in variants if one.bound <= tolerance), key=lambda one: one.cpu_s)
    limit, text = math.inf, f"tolerance {power(tolerance)}: "
    if chosen is None:
        text += "was not run"
    else:
        limit = WORTHWHILE_SAVING * chosen.cpu_s if chosen in reaching else math.inf
        enough = "" if chosen in reaching else ", which is not enough"
        text += f"chooses {chosen.details}: {chosen.in_words}{enough}"
    if reaching and reaching[0].cpu_s < limit:
        best = reaching[0]
        details = f" ({best.details})" if best.details and best.knob != "tolerance" else ""
        comparison = "cheaper" if limit < math.inf else "the cheapest"
        text += f"; {comparison} in this scene: {best.label}{details}, {best.in_words}"
    elif reaching:
        text += "; nothing else that was tried is clearly cheaper"
    else:
        nearest = min(variants, key=lambda one: one.bound, default=None)
        noise = ", by its noise" if noisy else ""
        best_of = "" if nearest is None else f" (best {nearest.bound:.1e}{noise}: {nearest.label})"
        text += f"; not reached by any setting tried{best_of}"
    return Advice(tolerance, text, "" if chosen is None else chosen.label, reaching[0].label if reaching else "")
