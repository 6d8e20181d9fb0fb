"""The error budget: the error of each result by source, found by perturbing the one reader of the results.

    solver           the reader on forces ± ε, also tilted about the last mark: ε is the residual of a minimiser or a
    motion, and the error of table, cutoff and a plane of finite stiffness
    sampling         error of the reader's polynomials and of the search; where the scene gives the steps, the reader on
                     the model with these steps beside the model with dense ones
    discretisation   the reader on the model with its apex elsewhere between particles, or on three spacings; and on
                     radii changed by the error of interpolation between particles
    time             of a motion: the reader on the same in longer timesteps, with larger masses where none are given
    instability      premature detachment of particles, and other maxima of the force (the reader's own)
    input            the reader on the model of each scene that this one may mean: numbers with ± and deviations of a
                     measured profile both ways, independent ones added in squares; other curves through its points

Nothing here depends on the experiment: whatever a script passes and a reader reads has all of these.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.marks import displacement_under
from contact1d.workflow.continuation.model_branch import MOST_NUMBERS
from contact1d.workflow.continuation.outcome import LATTICE, Result, in_squares
from contact1d.workflow.continuation.reduction import MARGIN, WAYS, Reader, Reduction, Values, values_of
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
STEP_MARGIN, PATH_MARGIN = 1.25, 1.5
"""Error over the change with dense steps, which have errors, too; the second where a search ends elsewhere."""
BY_CHANCE = 0.5
"""Least error of a row over those beside it."""
SHIFTS = (0.0, 0.25, 0.5, 0.75)
"""Shifts of a path's steps over their width, of which the worst counts where the model is no copy of the deck."""
FEWEST = 200
"""Particles that the model of a plane keeps for dense positions."""
BEFORE = 1e-3
"""Distance of two displacements that show the stiffness of the model, over its path."""
REACHED = 1.1
"""Of a displacement, over that of a force that was missed to first order: nothing else may err."""


def curve_errors(
    case: Reduction, trace: Trace, solver: Array, repeated: Mapping[str, Sequence[Trace]] | None = None
) -> dict[str, Values]:
    """By column of curve.csv, the errors of its rows by source, (m,).

    Args:
        case: scene, settings, script and reader.
        trace: of all states that were passed.
        solver: ε of each.
        repeated: see `budgeted`.
    """
    rows, repeated = case.along(trace), repeated or {}
    measured = {"force": trace.force, "displacement": trace.displacement}
    lattice = rows.followed(measured) if "time" in repeated else rows.lattice
    inputs = rows.inputs if case.is_open else {}
    found: dict[str, Values] = {"force": {"solver": solver}}
    if trace.given != "displacement":
        softness = 1.0 / _stiffness(case, trace.displacement)
        found["displacement"] = {"solver": solver * softness}
    for name, errors in found.items():
        if name in lattice:
            errors[LATTICE] = _beside(lattice[name])
        if name in inputs:
            errors["input"] = inputs[name]
        for source, others in repeated.items():
            errors[source] = MARGIN * sum(_off(trace, other, name) for other in others)
    if trace.given == "load":  # a force that is off moves the body
        moved = {source: error * softness for source, error in found["force"].items()}
        held = {source: found["force"][source] for source in ("solver", *repeated)}
        found = {"force": held, "displacement": moved | found["displacement"]}
    return found


def of_rows(errors: Mapping[str, Values], chosen: NDArray[np.bool_]) -> dict[str, Values]:
    """The same of the rows that are reported."""
    return {name: {source: error[chosen] for source, error in one.items()} for name, one in errors.items()}


def _off(trace: Trace, other: Trace, name: str) -> Array:
    """By how much the states of another trace are off at the same times, or one by one, (m,)."""
    values = getattr(other, name)
    there = np.interp(trace.time, other.time, values) if trace.time.any() else values
    return np.asarray(np.abs(getattr(trace, name) - there))


def _beside(errors: Array) -> Array:
    """Errors of rows (m,), at least BY_CHANCE of their neighbours': one that changes its sign is small by chance."""
    padded = np.pad(errors, 1)
    return np.maximum(errors, BY_CHANCE * np.maximum(padded[:-2], padded[2:]) * (errors > 0.0))


def sampling_errors(case: Reduction, trace: Trace) -> Values:
    """Sampling error of each result by the steps of the scene, from the model with the same and with dense steps."""
    model, found = case.model, dict[str, float]()
    step = float(np.median(np.abs(np.diff(trace.displacement)))) if len(trace) > 1 else 0.0
    is_copy = case.scene.is_stepped
    while is_copy and model.dense * len(trace) * model.x.size > MOST_NUMBERS and model.x.size > FEWEST:
        model = model.resized(2.0)  # steps miss the same on a coarser lattice
    for share in SHIFTS[:1] if is_copy else SHIFTS:
        dense = case.values(model, model.dense, share * step)
        same = case.values(model, 1, share * step) if share or model is not case.model else case.own
        for name in same.keys() | dense.keys():
            missed = abs(same.get(name, 0.0) - dense.get(name, 0.0))
            found[name] = max(found.get(name, 0.0), (STEP_MARGIN if is_copy else PATH_MARGIN) * missed)
    return found


@dataclass(frozen=True)
class ForceErrors:
    """Errors of the forces of states, (m,) [FU].

    Attributes:
        common: alike at neighbouring states: what residual forces add up to at most, table, cutoff, a plane not rigid.
        turning: what a path back may have otherwise than the path there: residual forces are of either sign.
        law: of that, the largest part that is the interaction's or the plane's own [FU].
        anchor: displacement [LU] about which an error may change sign: that of the last marked state.
    """

    common: Array
    turning: Array
    law: float
    anchor: float


def force_errors(
    scene: Scene, settings: Settings, states: Sequence[State], marked: Collection[State], left: float | None = None
) -> ForceErrors:
    """Of states, by their displacement between `marked` ones; `left`: in place of residual forces [FU]."""
    count = float(settings.chains.upper)
    law = {state.displacement: settings.forces.error(scene, state.profile) for state in marked}
    own = {
        state.displacement: law[state.displacement] + (count * state.residual if left is None else left)
        for state in marked
    }
    positions = sorted(own)
    displacement = np.asarray([state.displacement for state in states])
    common = np.interp(displacement, positions, [own[position] for position in positions])
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
    """The results with their errors.

    Args:
        case: scene, settings, script and reader.
        trace: what was measured.
        force_error: ε of each state.
        sampled: whether the scene gives the steps.
        length: over which a tilt of the force is ε [LU]; 0 for none.
        repeated: by the source of the error that they show, the same measured in other ways: "time" of a motion.
    """
    readings = case.read(trace)
    values = values_of(readings)
    solver = _changes(case.read, values, _off_balance(case, trace, force_error, sampled, length))
    read = _changes(case.read, values, misread(trace))
    between = sampling_errors(case, trace) if sampled else {}
    repeated = repeated or {}
    again = {
        source: [_changes(case.read, values, [other], missing=True) for other in others]
        for source, others in repeated.items()
    }
    late = _changes(case.read, values, [trace.perturbed(moved=_late(case, trace))]) if trace.given == "" else {}
    lattice = case.followed(values) if "time" in repeated else case.lattice
    inputs = case.inputs if case.is_open else {}
    found = {}
    for name, one in readings.items():
        errors = {"solver": solver[name], LATTICE: lattice.get(name, 0.0) + read[name]}
        errors |= {source: MARGIN * sum(one[name] for one in changes) for source, changes in again.items()}
        errors |= {"time": max(errors.get("time", 0.0), MARGIN * late[name])} if late else {}
        for source, error in one.errors.items():
            errors[source] = errors.get(source, 0.0) + error
        if name in inputs:
            errors["input"] = errors.get("input", 0.0) + inputs[name]
        if name in between:
            errors["sampling"] = max(errors.get("sampling", 0.0), between[name])
        given = in_squares(case.moves, name)
        found[name] = Result(one.value, one.unit, errors, one.scale, one.prescribed, read[name], given)
    return found


def _off_balance(case: Reduction, trace: Trace, force_error: ForceErrors, sampled: bool, length: float) -> list[Trace]:
    """The trace with forces that are off by ε both ways, or by a part of it that changes its sign; see `budgeted`."""
    shapes = [force_error.common]
    if length > 0.0:
        shapes.append(force_error.common * np.clip((trace.displacement - force_error.anchor) / length, -1.0, 1.0))
    if sampled:
        shapes.append(force_error.turning * np.sign(np.diff(trace.displacement, prepend=trace.displacement[:1])))
    missed = _missed(case, trace, force_error.common)
    traces = [trace.perturbed(sign * shape, moved=missed) for shape in shapes for sign in WAYS]
    # Where an interaction is so much stronger or weaker, a contact is as much wider or narrower at most.
    strength = case.settings.law.pull_off_force() or float(np.max(np.abs(trace.force), initial=0.0))
    if force_error.law > 0.0 and strength > 0.0:
        traces += [trace.perturbed(radius_factor=1.0 + sign * force_error.law / strength) for sign in WAYS]
    return traces


def misread(trace: Trace) -> list[Trace]:
    """The trace with radii that are read too large by their uncertainties: all of them, or every other one.

    Results go with radii to first order: those that are too small change them by as much.
    """
    other = np.asarray((-1.0) ** np.arange(len(trace)), dtype=np.float64)
    return [trace.perturbed(radius_shift=shift) for shift in (1.0, other)]


def _late(case: Reduction, trace: Trace) -> Array:
    """How far [LU] a free body is off, (m,), whose contact is lost at once somewhere in a timestep: ½ ΔF Δt/M (t − t₀).

    Any other timestep has its own place there, so that a difference of two may vanish.
    """
    model, motion = case.model, case.settings.motion
    if not model.limits:
        return np.zeros(len(trace))
    jump = float(model.held(np.asarray([model.apart + BEFORE * (model.deepest - model.apart)]))[0])
    passed = trace.time - trace.time[trace.force != 0.0].max(initial=0.0)
    return np.asarray(0.5 * abs(jump) * motion.time_step / motion.plate_mass * np.maximum(passed, 0.0))


def _missed(case: Reduction, trace: Trace, error: Array) -> Array:
    """How far [LU] states that were to carry a force are from it, at most, (m,); 0 of others."""
    found = np.zeros(len(trace))
    for i, wanted in trace.wanted.items():
        force, d = float(trace.force[i]), float(trace.displacement[i])
        parts = abs(wanted - force), float(error[i])
        off = max(parts) if trace.given == "load" else sum(parts)  # what a load does not balance is both
        stiffness = float(_stiffness(case, np.asarray([d]))[0])
        found[i] = REACHED * abs(displacement_under(trace, i, force - off, stiffness) - d)
    return found


def _stiffness(case: Reduction, displacement: Array) -> Array:
    """dF/dd [FU/LU] at displacements (m,) [LU] of the model, at least that of a particle."""
    settings, model = case.settings, case.model
    if settings.has_several_maxima:
        return np.full_like(displacement, settings.law.stuck_stiffness(settings.largest_displacement))
    step = BEFORE * abs(model.deepest - model.apart) or model.law.spacing
    rise = model.held(displacement) - model.held(displacement - step)
    return np.maximum(rise / step, model.law.stiffness)


def _changes(read: Reader, values: Values, perturbed: list[Trace], missing: bool = False) -> Values:
    """The largest change of each value; where `missing` counts, one that a perturbed reader lacks is 0."""
    found = dict.fromkeys(values, 0.0)
    for trace in perturbed:
        others = values_of(read(trace))
        for name, value in values.items():
            found[name] = max(found[name], abs(others.get(name, 0.0 if missing else value) - value))
    return found
