"""A cost study: reference, every knob turned from the base, effects left out, combinations; then orders and advice."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from contact1d.workflow.cost.advice import TARGETS, advise, choice, combinations
from contact1d.workflow.cost.change import Change, at_tolerance, base_change, with_method
from contact1d.workflow.cost.errors import is_sampled, judged, main_results
from contact1d.workflow.cost.knobs import Knob, knobs_of, left_out
from contact1d.workflow.cost.measure import Measured, Prepared, measure, run_once
from contact1d.workflow.cost.orders import fit_order, pareto_front
from contact1d.workflow.cost.per_step import effect_costs, without_effects
from contact1d.workflow.cost.record import CostRecord, EffectCost, KnobRecord, VariantRecord
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.errors import RunError
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.settings.settings import SettingsError, settings_for
from contact1d.workflow.units import Quantity

REFERENCE_TOLERANCES = (1e-7, 1e-6, 1e-5)
"""Tried in turn, without time where the scene is at rest without it."""
REFERENCE_SHARES = (0.1, 0.3)
"""Of the scene's own tolerance, tried in turn where the result exists in time only."""
NOISY_SHARE = 0.25
"""The same with noise: sixteen times as many samples, as far as the program takes them."""
AS_IT_IS, BASE, EFFECT, COMBINED = "scene", "base", "effect", "combined"
"""Knobs, in a manner of speaking, of variants that belong to none."""


@dataclass(frozen=True)
class Planned:
    """A variant before it runs, and the knob that it belongs to, if any."""

    label: str
    change: Change
    group: str
    value: float = float("nan")
    same_physics: bool = True
    own_reference: bool = False
    details: str = ""


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
                Planned(label, one, COMBINED, details=text) for label, text, one in combinations(knobs, records, change)
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
    found = [Planned("the scene as it is", Change(), AS_IT_IS), Planned("base", base, BASE)]
    for knob in knobs:
        whole = knob.name == "tolerance" or knob.name.startswith("method")
        found += [
            Planned(
                level.label,
                level.change if whole else base + level.change,
                knob.name,
                level.value,
                own_reference=knob.own_reference,
                details=_choice(scene, level.change) if knob.name == "tolerance" else "",
            )
            for level in knob.levels
        ]
    changes, _ = without_effects(scene)
    found += [Planned(f"without {effect}", one, EFFECT, same_physics=False) for effect, one in changes.items()]
    return found


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
            ready.append(Prepared(one.label, changed, settings_for(changed)))
        except (SceneError, SettingsError) as error:
            failures[one.label] = Measured(failure=str(error))
    done = (measure(ready, folder, repeats, workers, progress) if ready else {}) | failures
    return [_record(one, done[one.label], reference, is_sampled(scene)) for one in planned]


def _record(one: Planned, measured: Measured, reference: Mapping[str, Quantity], noisy: bool) -> VariantRecord:
    record = VariantRecord(
        label=one.label,
        knob=one.group,
        value=one.value,
        details=one.details,
        scene_keys=one.change.overrides + tuple(f"without {effect}" for effect in one.change.without),
        same_physics=one.same_physics,
        own_reference=one.own_reference,
        cpu_s=measured.cpu_s,
        cpu_runs=measured.cpu_runs,
        total_s=measured.total_s,
        steps=measured.steps,
        memory_mb=measured.memory_mb,
        failure=measured.failure,
    )
    if measured.failure:
        return record
    if not one.same_physics:
        return replace(
            record, values={name: measured.quantities[name].value for name in reference if name in measured.quantities}
        )
    return judged(record, measured.quantities, reference, noisy)


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
