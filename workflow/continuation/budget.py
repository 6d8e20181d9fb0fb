"""The error budget: the error of each result by source, found by perturbing the one reader of the results.

    solver           the reader on forces ± ε, also tilted about the last mark: ε is the residual of a minimiser or a
                     motion, and the error of table, cutoff and a plane of finite stiffness
    sampling         error of the reader's polynomials and of the search; where the scene gives the steps, the reader on
                     the model with these steps and with dense ones
    discretisation   the reader on the model with its apex elsewhere between particles, or on three spacings; and on
                     radii changed by the error of interpolation between particles
    time             of a motion: the reader on the motion in longer timesteps, with larger masses where none are given
    instability      premature detachment of particles, and other maxima of the force (in the reader itself)
    input            the reader on the model of each scene that this one may mean: numbers with ± and deviations of a
                     measured profile in both directions, independent ones added in squares; other curves through its
                     points

Nothing here depends on the experiment: the states of any script and the results of any reader have all of these.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.marks import displacement_under
from contact1d.workflow.continuation.model_branch import MOST_NUMBERS
from contact1d.workflow.continuation.outcome import LATTICE, Result, in_squares
from contact1d.workflow.continuation.reduction import MARGIN, SIGNS, Reader, Reduction, Values, values_of
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.laws.numerics import value_at
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]


def curve_errors(
    case: Reduction, trace: Trace, solver: Array, repeated: Mapping[str, Sequence[Trace]] | None = None
) -> dict[str, Values]:
    """Return the errors ≥ 0 of the points of curve.csv, (m,), by column and source: "force" [FU], "displacement" [LU].

    Both columns have "solver", at displacements that of the force over the stiffness dF/dd, and the sources of
    `repeated`: |difference| from each trace, summed, times 1.25. "discretisation" (mostly not where the scene gives
    the particles) and "input" (with uncertain inputs) are at the column that is not prescribed: at prescribed
    displacements "force", and there is no column "displacement"; under forces over time, and under a load,
    "displacement"; in free motion both.

    Args:
        case: the experiment on the reduced model of the scene.
        trace: of all states that were passed.
        solver: error of the force of each state, (m,) [FU].
        repeated: traces of repeated measurements, by the source of the error that they show: "time" of a motion.
    """
    rows, repeated = case.along(trace), repeated or {}
    measured = {"force": trace.force, "displacement": trace.displacement}
    lattice = rows.lattice_in_time(measured) if "time" in repeated else rows.lattice
    columns: dict[str, Values] = {"force": {"solver": solver}}
    if trace.given != "displacement":
        softness = 1.0 / _stiffness(case, trace.displacement)
        columns["displacement"] = {"solver": solver * softness}
    for name, errors in columns.items():
        if name in lattice:
            errors[LATTICE] = _above_neighbours(lattice[name])
        if name in rows.inputs:
            errors["input"] = rows.inputs[name]
        for source, traces in repeated.items():
            errors[source] = MARGIN * sum(_differences(trace, repetition, name) for repetition in traces)
    if trace.given == "load":  # an error of the force moves the body
        moved = {source: error * softness for source, error in columns["force"].items()}
        held = {source: columns["force"][source] for source in ("solver", *repeated)}
        columns = {"force": held, "displacement": moved | columns["displacement"]}
    return columns


def of_rows(errors: Mapping[str, Values], chosen: NDArray[np.bool_]) -> dict[str, Values]:
    """Return a copy of errors with only the points that are reported, by column and source, in the units of `errors`.

    `chosen`: (m,), true for a point that is reported.
    """
    return {name: {source: error[chosen] for source, error in column.items()} for name, column in errors.items()}


def _differences(trace: Trace, repetition: Trace, name: str) -> Array:
    """Return |difference| ≥ 0 of a column of a repeated trace from that of `trace`, (m,), in the column's unit.

    `name`: "force" [FU] or "displacement" [LU]. Where `trace` has times they are taken at the same times, by linear
    interpolation; else state by state.
    """
    values = getattr(repetition, name)
    expected = np.interp(trace.time, repetition.time, values) if trace.time.any() else values
    return np.asarray(np.abs(getattr(trace, name) - expected))


def _above_neighbours(errors: Array, share: float = 0.5) -> Array:
    """Return errors, (m,), raised to at least a `share` of their larger neighbour, in the same unit; 0 stays 0.

    An error is small where its sign changes.
    """
    padded = np.pad(errors, 1)
    return np.maximum(errors, share * np.maximum(padded[:-2], padded[2:]) * (errors > 0.0))


def sampling_errors(case: Reduction, trace: Trace, fewest: int = 200) -> Values:
    """Return the sampling error of each result, ≥ 0, by name in its unit, for displacements that the scene gives.

    It is |change| of the result on the reduced model from these load steps to dense ones: in a quasi-static run on a
    rigid plane, where the model has the particles of LAMMPS, times 1.25; else times 1.5, the largest of four, with the
    steps shifted by 0, ¼, ½ and ¾ of their median, but for a free motion, which begins at the first touch. A result
    that one of both lacks counts as 0 there. On the plane the spacing is doubled where there are too many forces, down
    to about `fewest` particles: steps miss as much on any.
    """
    model, errors = case.model, dict[str, float]()
    step = float(np.median(np.abs(np.diff(trace.displacement)))) if len(trace) > 1 else 0.0
    is_copy = case.scene.is_stepped
    margin = 1.25 if is_copy else 1.5  # dense steps have errors, too, and a search may end elsewhere
    while is_copy and model.dense * len(trace) * model.x.size > MOST_NUMBERS and model.x.size > fewest:
        model = model.resized(2.0)
    for shift in range(4 if trace.given and not is_copy else 1):
        share = shift / 4.0
        dense = case.values(model, model.dense, share * step)
        sparse = case.values(model, 1, share * step) if share or model is not case.model else case.results
        for name in sparse.keys() | dense.keys():
            missed = abs(sparse.get(name, 0.0) - dense.get(name, 0.0))
            errors[name] = max(errors.get(name, 0.0), margin * missed)
    return errors


@dataclass(frozen=True)
class ForceErrors:
    """The errors of the forces of states, (m,) [FU], ≥ 0.

    Attributes:
        common: similar at neighbouring states: the error by table and cutoff, or by the finite stiffness of a plane,
            plus the largest sum of residual forces.
        turning: may differ between loading and unloading: residual forces are of either sign.
        law: the largest part of `common` that is due to the interaction or the plane [FU].
        anchor: displacement [LU] about which an error may change sign: that of the last marked state.
    """

    common: Array
    turning: Array
    law: float
    anchor: float


def force_errors(
    scene: Scene, settings: Settings, states: Sequence[State], marked: Collection[State], left: float | None = None
) -> ForceErrors:
    """Return the errors of the contact forces of states [FU], ≥ 0.

    `common`, (m,), of the interaction or plane plus the sum of residual forces, is known for the `marked` states,
    interpolated over displacement between them and constant beyond. `turning`, (m,), is √N times the residual force of
    each state, of N upper particles. `law` is the largest error of the interaction or plane of a marked state, `anchor`
    the displacement [LU] of the last one.

    Args:
        scene: of the run.
        settings: of the run.
        states: whose errors are required, (m,).
        marked: states with profiles, one at least.
        left: error [FU] that replaces the sum of the residual forces of a marked state; None: that sum.
    """
    count = float(settings.chains.upper)
    law = {state.displacement: settings.forces.error(scene, state.profile) for state in marked}
    errors = {
        state.displacement: law[state.displacement] + (count * state.residual if left is None else left)
        for state in marked
    }
    positions = sorted(errors)
    displacement = np.asarray([state.displacement for state in states])
    common = np.interp(displacement, positions, [errors[position] for position in positions])
    turning = np.sqrt(count) * np.asarray([state.residual for state in states])
    return ForceErrors(common, turning, max(law.values()), list(marked)[-1].displacement)


def budgeted(
    case: Reduction,
    trace: Trace,
    force_error: ForceErrors,
    sampled: bool = False,
    length: float = 0.0,
    repeated: Mapping[str, Sequence[Trace]] | None = None,
) -> dict[str, Result]:
    """Return the results of a trace by name, each with its errors by source, in its own unit.

    Every result has "solver" and "discretisation". "input" is there with uncertain inputs, "sampling" where `sampled`,
    the sources of `repeated`, in free motion "time", and any source of the function that reads results.

    Args:
        case: the experiment on the reduced model of the scene, with the function that reads results.
        trace: of the measured states.
        force_error: error ε of the force of each state [FU].
        sampled: whether the scene gives the load steps.
        length: displacement [LU] from the last marked state at which an error that changes sign there reaches ε; 0:
            no such error.
        repeated: traces of repeated measurements, by the source of the error that they show: "time" of a motion.
    """
    readings = case.read(trace)
    values = values_of(readings)
    solver = _changes(case.read, values, _perturbed(case, trace, force_error, sampled, length))
    read = reading_errors(case, trace, values)
    between = sampling_errors(case, trace) if sampled else {}
    repeated = repeated or {}
    repeated_errors = _repetition_errors(case, trace, values, repeated)
    lattice = case.lattice_in_time(values) if "time" in repeated else case.lattice
    results = {}
    for name, reading in readings.items():
        errors = {"solver": solver[name], LATTICE: lattice.get(name, 0.0) + read[name]}
        errors |= {source: changes[name] for source, changes in repeated_errors.items()}
        for source, error in reading.errors.items():
            errors[source] = errors.get(source, 0.0) + error
        if name in case.inputs:
            errors["input"] = errors.get("input", 0.0) + case.inputs[name]
        if name in between:
            errors["sampling"] = max(errors.get("sampling", 0.0), between[name])
        given = in_squares(case.moves, name)
        results[name] = Result(
            reading.value, reading.unit, errors, reading.scale, reading.prescribed, read[name], given
        )
    return results


def _repetition_errors(
    case: Reduction, trace: Trace, values: Values, repeated: Mapping[str, Sequence[Trace]]
) -> dict[str, Values]:
    """Return the errors that repeated traces show, ≥ 0, by source and result, in its unit.

    It is the sum over the repetitions of the changes of a result, times 1.25; a result that a repetition lacks counts
    as 0 there. {} without repetitions, but of a free motion there is always "time": at least the change, times 1.25, if
    the position after separation is wrong by that of a timestep.
    """
    errors = dict[str, Values]()
    for source, traces in repeated.items():
        changes = [_changes(case.read, values, [repetition], missing=True) for repetition in traces]
        errors[source] = {name: MARGIN * sum(change[name] for change in changes) for name in values}
    if trace.given == "":
        late = _changes(case.read, values, [trace.perturbed(moved=_detachment_errors(case, trace))])
        known = errors.get("time", {})
        errors["time"] = {name: max(known.get(name, 0.0), MARGIN * change) for name, change in late.items()}
    return errors


def _perturbed(case: Reduction, trace: Trace, force_error: ForceErrors, sampled: bool, length: float) -> list[Trace]:
    """Return two to eight traces that differ from `trace` by the errors of its forces, in pairs: less, and plus.

    First ε = `common` is added to all forces; where `length` [LU] > 0, then ε times the distance in displacement from
    the last marked state over `length`, at most ±1; where `sampled`, then `turning` with the sign of the step in
    displacement. In these traces, states that were to carry a force are also moved up, as far as they may be from the
    displacement of that force. Where forces have an error by the interaction or the plane, the last two have all radii
    narrower and wider by it, relative to the pull-off force, or without attraction to the largest |force|.
    """
    shapes = [force_error.common]
    if length > 0.0:
        shapes.append(force_error.common * np.clip((trace.displacement - force_error.anchor) / length, -1.0, 1.0))
    if sampled:
        shapes.append(force_error.turning * np.sign(np.diff(trace.displacement, prepend=trace.displacement[:1])))
    missed = _target_errors(case, trace, force_error.common)
    traces = [trace.perturbed(sign * shape, moved=missed) for shape in shapes for sign in SIGNS]
    # A contact is wider or narrower by no more than the relative change of the interaction.
    strength = case.settings.law.pull_off_force() or float(np.max(np.abs(trace.force), initial=0.0))
    if force_error.law > 0.0 and strength > 0.0:
        traces += [trace.perturbed(radius_factor=1.0 + sign * force_error.law / strength) for sign in SIGNS]
    return traces


def reading_errors(case: Reduction, trace: Trace, values: Values) -> Values:
    """Return by how much `values`, the results of a trace, change with contact radii that are read off by more, ≥ 0."""
    return _changes(case.read, values, misread(trace))


def misread(trace: Trace) -> list[Trace]:
    """Return two traces with contact radii increased by their uncertainties: all of them, and with alternating sign.

    In the second, the first state has the plus sign. Results change with radii to first order: smaller radii change
    them by as much.
    """
    alternating = np.asarray((-1.0) ** np.arange(len(trace)))
    return [trace.perturbed(radius_shift=shift) for shift in (1.0, alternating)]


def _detachment_errors(case: Reduction, trace: Trace) -> Array:
    """Return the error [LU] ≥ 0 of the position of a free body, (m,), whose contact is lost within a timestep.

    ½ |ΔF| Δt/M (t − t₀), with ΔF the force at the limit point, the timestep Δt, the mass M of the body and t₀ the last
    time with a force; 0 up to t₀, and everywhere without a limit point. The change with another timestep may vanish,
    since the contact is lost elsewhere in it.
    """
    model, motion = case.model, case.settings.motion
    if not model.limits:
        return np.zeros(len(trace))
    jump = value_at(model.held, model.apart + _short_step(model))
    passed = trace.time - trace.time[trace.force != 0.0].max(initial=0.0)
    return np.asarray(0.5 * abs(jump) * motion.time_step / motion.plate_mass * np.maximum(passed, 0.0))


def _short_step(model: Particles) -> float:
    """Return a thousandth of the displacement [LU] of the model from separation to the largest one that is expected."""
    return 1e-3 * (model.deepest - model.apart)


def _target_errors(case: Reduction, trace: Trace, error: Array, margin: float = 1.1) -> Array:
    """Return how far [LU] ≥ 0 states may be from the displacement of the force that they were to carry, (m,).

    0 for states that were to carry none. Each is the distance for the difference from that force plus `error`, under a
    load for the larger of both, times `margin`, since the distance is of first order and nothing else may be in error.
    `error`: of the force of each state, (m,) [FU].
    """
    distances = np.zeros(len(trace))
    for i, wanted in trace.wanted.items():
        force, d = float(trace.force[i]), float(trace.displacement[i])
        parts = abs(wanted - force), float(error[i])
        off = max(parts) if trace.given == "load" else sum(parts)  # an unbalanced load is both
        stiffness = value_at(partial(_stiffness, case), d)
        distances[i] = margin * abs(displacement_under(trace, i, force - off, stiffness) - d)
    return distances


def _stiffness(case: Reduction, displacement: Array) -> Array:
    """Return dF/dd [FU/LU] > 0 of the reduced model in unloading at displacements (m,) [LU], one for each.

    It is at least the contact stiffness of one particle. Where the force has several maxima, it is that of all pairs in
    contact at the largest expected displacement, everywhere.
    """
    settings, model = case.settings, case.model
    if settings.has_several_maxima:
        return np.full_like(displacement, settings.law.stuck_stiffness(settings.largest_displacement))
    step = abs(_short_step(model)) or model.law.spacing
    rise = model.held(displacement) - model.held(displacement - step)
    return np.maximum(rise / step, model.law.stiffness)


def _changes(read: Reader, values: Values, perturbed: list[Trace], missing: bool = False) -> Values:
    """Return the largest |change| of each value over the perturbed traces, by name in its unit; 0 without traces.

    Where a perturbed trace gives no such result, it has not changed, or with `missing` counts as 0 there.
    """
    changes = dict.fromkeys(values, 0.0)
    for trace in perturbed:
        results = values_of(read(trace))
        for name, value in values.items():
            changes[name] = max(changes[name], abs(results.get(name, 0.0 if missing else value) - value))
    return changes
