"""A cost study: the reference, every setting changed from the base, effects left out; then errors and orders.

The settings of a tolerance suffice for every scene of a study of many (`workflow.model.settings`); one scene may
need less. Errors are those of the main results, relative to a reference of much higher accuracy; the largest represents
a variant.
"""

from __future__ import annotations

import math
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import numpy as np

from contact1d.workflow.cost.knobs import (
    Keys,
    Knob,
    Order,
    at_tolerance,
    base_keys,
    changed,
    is_sampled,
    knobs_of,
    main_results,
    with_method,
)
from contact1d.workflow.cost.measure import effect_costs, measure, run_once, without_effects
from contact1d.workflow.cost.report import AS_IT_IS, BASE, EFFECT, CostRecord, Variant
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import RunError
from contact1d.workflow.model.settings import Settings, SettingsError, settings_for
from contact1d.workflow.runs.report import versions
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.units import Quantity

REFERENCE_TOLERANCES = (1e-7, 1e-6, 1e-5)
"""Tried in turn, without time where the scene is at rest without it."""
REFERENCE_SHARES = (0.1, 0.3)
"""Of the scene's own tolerance, tried in turn where the result exists in time only."""
NOISY_SHARE = 0.25
"""The same with noise: sixteen times as many samples, as far as the program takes them."""
KNOB_SHARE = 0.25
"""Part of the tolerance that one setting may use up, so that several may be changed at once. Where results are averages
over a motion it is the whole tolerance, since standard errors count."""
Results = Mapping[str, Quantity]


def cost_of(scene: Scene, name: str, folder: Path, repeats: int, workers: int, progress: Progress) -> CostRecord:
    """Measure the cost of accuracy in a scene.

    Args:
        scene: to be studied.
        name: of it, for the record.
        folder: where run folders may represent a while; it exists.
        repeats: rounds of measurement.
        workers: runs at a time.
        progress: informed of what begins, and of each run that ends.

    Raises:
        SettingsError: the scene leads to no computable system.
        RunError: no reference could be computed.
    """
    (knobs, left_out), noisy = knobs_of(scene, settings_for(scene)), is_sampled(scene)
    with tempfile.TemporaryDirectory(prefix=".cost-", dir=folder) as place:
        runs = Path(place)
        progress.phase("reference")
        label, reference = reference_of(scene, runs)
        planned, ready = [], {}
        for one in _planned(scene, knobs):
            with suppress(SceneError, SettingsError):
                other = changed(scene, one.scene_keys)
                ready[one.label] = other, settings_for(other)
                planned.append(replace(one, details=choice(*ready[one.label])))
        progress.phase("runs", repeats * len(ready))
        done = measure(ready, runs, repeats, workers, progress)
        progress.phase("effects, step by step")
        effects = effect_costs(scene, runs)
    ran = [replace(one, **vars(done[one.label])) for one in planned]
    variants = judged_by_group(ran, knobs, reference, noisy)
    base_error = next((one.error for one in variants if one.knob == BASE), math.nan)
    return CostRecord(
        title=scene.title,
        scene=name,
        reference=label,
        reference_values={key: one.value for key, one in reference.items()},
        base_error=base_error,
        limit=scene.accuracy.tolerance * (1.0 if noisy else KNOB_SHARE),
        knobs=knobs if noisy else tuple(_with_order(knob, variants, base_error) for knob in knobs),
        variants=tuple(one for one in variants if one.knob == AS_IT_IS or not one.failure),
        effect_costs=effects,
        left_out=left_out,
        versions=versions(),
    )


def reference_of(scene: Scene, folder: Path) -> tuple[str, dict[str, Quantity]]:
    """Label and main results of the reference: the tightest that works, without time where time is no physics.

    Raises:
        RunError: none works.
    """
    own, failure = scene.accuracy.tolerance, ""
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
        failure = done.failure or "it has no main result other than 0"
    raise RunError(f"no reference of higher accuracy could be computed: {failure}", folder)


def _planned(scene: Scene, knobs: Sequence[Knob]) -> Iterator[Variant]:
    yield Variant(knob=AS_IT_IS, value="as it is")
    yield Variant(knob=BASE, scene_keys=base_keys(scene))
    for knob in knobs:
        for h, value, keys in knob.levels:
            yield Variant(knob=knob.name, value=value, h=h, scene_keys=keys)
    for effect, keys in without_effects(scene).items():
        yield Variant(knob=EFFECT, value=effect, scene_keys=keys)


def judged_by_group(ran: Sequence[Variant], knobs: Sequence[Knob], reference: Results, noisy: bool) -> list[Variant]:
    """The variants with errors against the reference; of settings that it does not have against the finest level, which
    has none; without an effect against the scene as it is, which is the first.
    """
    against = {EFFECT: ran[0].quantities}
    for knob in knobs:
        if levels := [one for one in ran if one.knob == knob.name and knob.own_reference and not one.failure]:
            against[knob.name] = min(levels, key=lambda one: one.h).quantities
    return [
        one if one.quantities is (best := against.get(one.knob)) else judged(one, reference, noisy, best) for one in ran
    ]


def judged(one: Variant, reference: Results, noisy: bool, against: Results | None = None) -> Variant:
    """A variant with its errors; one that lacks a main result has failed.

    Args:
        one: with its quantities.
        reference: main results of the reference.
        noisy: whether uncertainties are standard errors, from which those of the errors follow (`is_sampled`).
        against: in place of the reference's, results from which errors count.
    """
    if one.failure:
        return one
    found, best = one.quantities, reference if against is None else against
    if missing := [name for name in reference if name not in found or name not in best]:
        return replace(one, failure=f"found no {' and no '.join(missing)}")
    errors = {name: abs(found[name].value / best[name].value - 1.0) for name in reference}
    worst = max(errors, key=errors.__getitem__)
    both = math.hypot(found[worst].uncertainty, best[worst].uncertainty) / abs(best[worst].value)
    return replace(one, errors=errors, spread=both if noisy else 0.0)


def _with_order(knob: Knob, variants: Sequence[Variant], base_error: float) -> Knob:
    """The setting with the order of its error, where it has one; the base's error limits what is changed from it."""
    ran = [one for one in variants if one.knob == knob.name and knob.has_order]
    floor = 0.0 if knob.own_reference or knob.name == "accuracy.tolerance" else base_error
    return replace(knob, order=fit_order([one.h for one in ran], [one.error for one in ran], floor))


FLOOR_FACTOR = 5.0
"""An error below this many floors belongs to the other settings, not to this setting."""
ASYMPTOTIC = 0.1
"""Errors above it are too large for a leading term to prevail."""
ROUND_OFF = 1e-9
"""Errors below it are those of the reference and of round-off."""
FEWEST_POINTS = 3
"""Points below which a slope would have no standard error."""


def fit_order(h: Sequence[float], errors: Sequence[float], floor: float = 0.0) -> Order | None:
    """Least squares of ln error = p ln h + c.

    Args:
        h: what goes to zero as the setting gets finer, > 0.
        errors: relative, of the same length; NaN where there is none.
        floor: error that is left where this setting has none: points within FLOOR_FACTOR times it are left out.

    Returns:
        The order with its standard error, √(Σ residual²/(n − 2)/Σ(x − x̄)²), or None with fewer than FEWEST_POINTS
        points between the floor and ASYMPTOTIC.
    """
    x, y = np.array(h), np.array(errors)
    used = (y > max(FLOOR_FACTOR * floor, ROUND_OFF)) & (y < ASYMPTOTIC)
    if len(np.unique(x[used])) < FEWEST_POINTS:
        return None
    (slope, _), covariance = np.polyfit(np.log(x[used]), np.log(y[used]), 1, cov=True)
    return Order(float(slope), math.sqrt(covariance[0, 0]))


def choice(scene: Scene, settings: Settings) -> str:
    """The settings of a scene as text."""
    words = []
    if settings.forces.table is not None and scene.interaction is not None:
        words.append(f"table of {settings.forces.table.points} points")
        if scene.interaction.attraction is not None:
            words.append(f"cutoff {settings.forces.cutoff:.3g} LU")
    words.append(f"chain of {settings.chains.upper} particles")
    if scene.method == "dynamic":
        words.append(f"time step {settings.motion.time_step:.3g} TU")
    else:
        words.append(f"residual {settings.forces.residual / settings.forces.scale:.0e}")
        if not scene.experiment.way_is_given:
            step = settings.increments.smooth_step if settings.is_smooth else settings.increments.displacement_step
            words.append(f"increment {step:.3g} LU")
    return scales_of(scene, {}).in_words(", ".join(words))
