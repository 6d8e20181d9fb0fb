"""History: a displacement or a force over time, on a rigid plane, of a body that may relax.
 d [LU] and F [FU] are positive in compression, a is the contact radius [LU], g the profile under the reduction. A leg
is a straight part of the history.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import vertex
from contact1d.analysis.polynomial import through
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.reduction import MARGIN, Reduction
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import phase_names
from contact1d.workflow.experiments.experiment import Scripted, finer_spacing
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.path import History as LoadHistory
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import History, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, LINE_PRESSURE, MEAN_PRESSURE, TIME


class HistoryExperiment(Scripted[History]):
    """d, F and a at the end, the peaks, the dissipated energy, and the time of contact."""

    main_results = ("peak_force", "peak_displacement", "displacement", "force", "contact_radius")
    curve_has_times = True

    def script(self, branch: Driver, scene: Scene) -> None:
        """Follow the load steps of all legs, from the first point of the history on.

        There are further ones on both sides of displacements at which the force jumps. The last state of a phase is
        marked "after_" and its name, that of the last phase "final".
        """
        branch.follow(branch.model.refined(_load_steps(scene)))

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of the last state, the peaks, and those of a whole contact, by name.

        Always "peak_force", "force" [FU] and "peak_displacement", "displacement" [LU]. In contact at the end, over a
        width above 0, "contact_radius" [LU] and "mean_pressure" [FU/LU²]; where the last load step separates the bodies
        "contact_radius" 0, uncertain by that before. Where the history ends with a hold "relaxation", by how much
        displacement [LU] or force [FU], whichever is not prescribed, has changed since its start, ≥ 0. Separated at the
        end, after a contact, "contact_time" [TU], and "dissipated_energy" [FU·LU] if they were apart at the beginning,
        too. Where the first unloading begins, with three states on each side, "unloading_stiffness" and
        "creep_corrected_stiffness" [FU/LU], but not of dashpots, whose force jumps there.
        """
        by_force, last = self.given(scene).force is not None, len(trace) - 1
        d, force = trace.displacement, trace.force
        results = {
            "peak_force": Reading(float(force.max()), FORCE, prescribed=by_force),
            "peak_displacement": Reading(
                float(d.max()), LENGTH, {"sampling": _peak_error(trace)}, prescribed=not by_force
            ),
            "displacement": Reading(float(d[last]), LENGTH, prescribed=not by_force, scale=float(np.abs(d).max())),
            "force": Reading(float(force[last]), FORCE, prescribed=by_force, scale=float(np.abs(force).max())),
        }
        parted = not touches(trace)[last]
        if not parted:
            results |= contact_at_end(trace)
        if trace.phase[-1].startswith("holding"):
            first = next((i for i in range(last, -1, -1) if not trace.phase[i].startswith("holding")), 0)
            results["relaxation"] = relaxation(trace, first, by_force)
        if parted and force.any():
            if not touches(trace)[0]:
                whole = _work(d, force) if law_of(scene).is_lossless else None
                results["dissipated_energy"] = Reading(float(np.trapezoid(force, d)), ENERGY, scale=whole)
            results["contact_time"] = contact_time(trace, _first_contact(trace, by_force))
            if radius := touches(trace)[last - 1] and trace.radius(last - 1):  # not yet apart?
                results["contact_radius"] = Reading(0.0, LENGTH, {"sampling": radius})
        return results if law_of(scene).jumps(scene) else results | _slopes(trace)

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with warnings of results that it lacks, and a check of the forces that are prescribed.

        "no_energy": there is no contact time, or no dissipated energy; "no_slope": there are no stiffnesses, since the
        force of dashpots jumps where an unloading begins.
        """
        given, scene = self.given(case.scene), case.scene
        missing, words = {"contact_time", "dissipated_energy"} - outcome.results.keys(), ""
        if len(missing) > 1:
            words = "the bodies touch at the end, or never, so there is neither a contact_time nor a dissipated_energy"
        elif missing:
            words = (
                "the history begins in contact, and the work up to there is unknown, so there is no dissipated_energy"
            )
        warnings = {"no_energy": words} if words else {}
        if law_of(scene).jumps(scene) and any(name.startswith("unloading") for name in _load_steps(scene).phases):
            warnings["no_slope"] = (
                "the force of a dashpot jumps where the unloading begins, so there is neither an unloading_stiffness "
                "nor a creep_corrected_stiffness"
            )
        pairs = []
        if given.force:
            wanted = np.interp(trace.time, given.times, [point.force for point in given.force])
            pairs = list(zip(wanted.tolist(), trace.force.tolist(), strict=True))
        checks = consistency.asked(scene, pairs, outcome.states)
        return outcome.adding(warnings=warnings, consistency=checks)

    def advice(self, scene: Scene) -> str:
        """Return the advice to use more load steps, or a smaller spacing, as a sentence without a full stop."""
        return f"Use more experiment.steps, or {finer_spacing(scene)}"


def contact_at_end(trace: Trace) -> dict[str, Reading]:
    """Return "contact_radius" [LU] and "mean_pressure" [FU/LU²] of the last state; {} without contact or width."""
    if not (radius := trace.radius(len(trace) - 1)):
        return {}
    pressure = float(trace.force[-1]) / (math.pi * radius**2)
    return {"contact_radius": Reading(radius, LENGTH), "mean_pressure": Reading(pressure, MEAN_PRESSURE)}


def relaxation(trace: Trace, first: int, by_force: bool) -> Reading:
    """Return the change ≥ 0 from state `first` to the last one of the displacement [LU], or of the force [FU].

    It is the one that is not prescribed; its scale is the largest value of the trace.
    """
    free, unit = (trace.displacement, LENGTH) if by_force else (trace.force, FORCE)
    return Reading(float(abs(free[-1] - free[first])), unit, scale=float(np.abs(free).max()))


def _load_steps(scene: Scene) -> LoadHistory:
    """Return the load steps of the legs, over times [TU] displacements [LU] or forces [FU], the first state included.

    Each leg has `experiment.steps` of them, or by default as many as the tolerance requires; by default they are dense
    behind each corner where the body relaxes. Phases are "loading", "unloading" and "holding", numbered where repeated;
    the end of each is marked "after_" and its name, that of the last "final". Two legs in the same direction are one
    phase.
    """
    given = scene.experiment
    assert isinstance(given, History)
    values = [point.force for point in given.force] if given.force else given.places()
    # The sampling error goes with the square of the steps' width, and 70 in a leg meet a tolerance of 1e-3.
    count = given.steps or math.ceil(70 * math.sqrt(1e-3 / scene.accuracy.tolerance))
    directions = {1.0: "loading", -1.0: "unloading", 0.0: "holding"}
    names, soonest = list[str](), law_of(scene).shortest_time(scene)
    times, wanted = [np.asarray(given.times[:1])], [np.asarray(values[:1])]
    for (before, after), (start, end) in zip(pairwise(given.times), pairwise(values), strict=True):
        parts = np.linspace(0.0, 1.0, count + 1)[1:]
        if soonest and not given.steps:
            first = min(1.0, 0.001 * soonest / (after - before))  # well below the shortest time of the body
            parts = np.union1d(parts, np.geomspace(first, 1.0, count // 2)).round(9)  # none as short as round-off
            parts = np.unique(parts[parts > 0.0])
        names += [directions[float(np.sign(end - start))]] * parts.size
        times.append(before + (after - before) * parts)
        wanted.append(start + (end - start) * parts)
    phases = tuple(phase_names([names[0], *names]))
    marks = {name: f"after_{name}" for name in phases} | {phases[-1]: "final"}
    return LoadHistory(phases, np.concatenate(times), np.concatenate(wanted), bool(given.force), marks)


def _peak_error(trace: Trace) -> float:
    """Return by how much [LU] ≥ 0 the largest displacement may be missed between states.

    It is how far the peak of a parabola through the state of the largest displacement and its neighbours lies above it;
    0 where that state is the first or the last one, or at a corner between phases.
    """
    d, top = trace.displacement, int(trace.displacement.argmax())
    if len(set(trace.phase[max(top - 1, 0) : top + 2])) > 1 or not 0 < top < len(trace) - 1:
        return 0.0
    return vertex(trace.time, d, top, 1)[1] - float(d[top])


def _slopes(trace: Trace) -> dict[str, Reading]:
    """Return "unloading_stiffness", dF/dd where the first unloading begins, and "creep_corrected_stiffness" [FU/LU].

    The latter, the elastic stiffness, is the ratio of the jumps of the rates, [Ḟ]/[ḋ], under a held force 1/(1/S +
    ḋ/|Ḟ|): G. Feng, A. H. W. Ngan, J. Mater. Res. 17 (2002) 660. By Oliver and Pharr it is 2 E* a. {} without an
    unloading, or with fewer than three states on either side of its start, the last one before it on both; the first is
    left out where the displacement does not change after the corner, the second where its rate does not jump.
    """
    count = 3  # states on each side of the corner, for a parabola whose slope is the rate there
    falls = [name.startswith("unloading") for name in trace.phase]
    first = falls.index(True) if True in falls else 0
    if first < count or first + count - 1 > len(trace) or not falls[first + count - 2]:
        return {}
    corner, time, d = first - 1, trace.time, trace.displacement
    near = range(corner - count + 1, corner + count)
    force = dict(zip(near, _forces_with_edges(trace, corner, near), strict=True))
    rates = []
    for side in (near[:count], near[count - 1 :]):
        times = np.asarray([time[i] - time[corner] for i in side])
        rates.append([float(through(times, np.asarray([column[i] for i in side]))[1]) for column in (force, d)])
    (force_before, d_before), (force_after, d_after) = rates
    stiffnesses = {"unloading_stiffness": _rate(force_after / d_after)} if d_after else {}
    if d_after != d_before:
        stiffnesses["creep_corrected_stiffness"] = _rate((force_after - force_before) / (d_after - d_before))
    return stiffnesses


def _rate(value: float, error: float = 1e-4) -> Reading:
    """Return a slope at a corner [FU/LU] as a reading, with a sampling error of `error` times its value.

    That is the least error of a parabola through a few states.
    """
    return Reading(value, LINE_PRESSURE, {"sampling": error * abs(value)})


def _forces_with_edges(trace: Trace, corner: int, states: Sequence[int]) -> list[float]:
    """Return the forces [FU] of states, one for each, with the part of the contact that whole particles miss.

    A sum over particles misses E* g′(a) y² at the edge, y the distance from the last cell to the edge. After the corner
    the edge moves with the displacement, y dy/dd = y/g′(a). Unchanged are the forces of a contact that reaches the end
    of its body, and of laws in which a particle may touch in part.

    Args:
        trace: with the states.
        corner: number of the state at which the unloading begins.
        states: numbers of the states.
    """
    law, force = trace.model.law, [float(trace.force[i]) for i in states]
    radius, modulus = trace.radius(corner) or 0.0, law.modulus
    if trace.model.shares_edges or radius >= law.profile.reach:
        return force
    corrected = []
    for i, summed in zip(states, force, strict=True):
        near = abs((trace.radius(i) or 0.0) - radius) < law.spacing
        reference = min(i, corner) if near else i
        edge = trace.radius(reference) or 0.0
        touching = np.flatnonzero(trace.profile(i).pressure)
        x = np.abs(trace.profile(i).x[touching[[0, -1]]]) if touching.size else np.full(2, edge - 0.5 * law.spacing)
        missed = edge - 0.5 * law.spacing - x
        low, high = law.profile.height(edge + 0.5 * law.spacing * np.asarray([-1.0, 1.0])).tolist()
        moved = float(trace.displacement[i] - trace.displacement[reference])
        edges = modulus * float(np.sum(0.5 * (high - low) / law.spacing * missed**2 + missed * moved))
        corrected.append(summed + edges)
    return corrected


def _work(d: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """Return the work ∫|F dd| [FU·LU] ≥ 0 along a path d [LU], F [FU], (m,) each, by the trapezoidal rule."""
    return float(np.sum(0.5 * np.abs((force[1:] + force[:-1]) * np.diff(d))))


def touches(trace: Trace, round_off: float = 1e-9) -> NDArray[np.bool_]:
    """Return in which states the bodies touch, (m,): |F| exceeds the share `round_off` of the largest |F|.

    False in all states where no state has a force.
    """
    return np.abs(trace.force) > round_off * float(np.abs(trace.force).max())


def _first_contact(trace: Trace, by_force: bool) -> float:
    """Return the time [TU] of the first contact, at d = 0, interpolated between two states.

    Where the scene prescribes forces (`by_force`) it is that of the last state before the first contact. It is the time
    of the first state of all where the history begins in contact.
    """
    first = int(np.argmax(touches(trace)))
    apart = np.flatnonzero(trace.force[:first] <= 0.0 if by_force else trace.displacement[: first + 1] <= 0.0)
    if not apart.size:
        return float(trace.time[0])
    if by_force:
        return float(trace.time[apart[-1]])
    near = slice(int(apart[-1]), int(apart[-1]) + 2)
    return float(np.interp(0.0, trace.displacement[near], trace.time[near]))


def contact_time(trace: Trace, touched: float = 0.0) -> Reading:
    """Return the time [TU] from first contact (at `touched` [TU]) to the final separation, with its sampling error.

    The bodies separate at the displacement of the model's separation where there is one. Else, with prescribed forces,
    at the first state without contact; under a tension halfway to that state; at a corner of the history at the last
    state in contact; otherwise as the pressure on the axis falls to 0, which is extrapolated by two load steps at most.
    The trace needs a state in contact and one after the last of them.
    """
    last, parted, d = max(1, int(np.flatnonzero(touches(trace))[-1])), trace.model.parted, trace.displacement
    if parted is not None:  # the particles next to the axis may be lost before
        last += int(np.argmax(d[last + 1 :] <= parted))
    time, end = trace.time[last : last + 2].tolist()
    part, doubt, round_off = 0.0, 0.0, 0.0 if parted is None else 1e-7
    if parted is not None:
        part = float((d[last] - parted) / (d[last] - d[last + 1])) if d[last] > d[last + 1] else 0.0
    elif trace.given == "force":
        part = 1.0
    elif trace.force[last] < 0.0:
        part = doubt = 0.5
    elif trace.phase[last + 1] == trace.phase[last]:  # else at a corner, where dashpots push no more
        ends = [end_of_pressure(trace, last, count) for count in (3, 5)]
        part, coarser = (min(max((moment - time) / (end - time), 0.0), 2.0) for moment in ends)
        doubt = abs(part - coarser)
    duration = time + part * (end - time) - touched
    return Reading(duration, TIME, {"sampling": MARGIN * doubt * (end - time) + round_off * duration})


def end_of_pressure(trace: Trace, last: int, count: int) -> float:
    """Return the time [TU] at which the pressure on the axis falls to 0, on a line through two states.

    Infinite where the pressure does not fall. The states are the last two, up to the state `last`, of its phase with
    `count` particles in contact on a side, where the pressure is extrapolated linearly in the height of the two
    particles next to the axis; where there are no two, the largest pressures of the state `last` and of the one before.
    """
    shown = []
    for i in range(last, -1, -1):
        profile = trace.profile(i)
        touching = np.flatnonzero((profile.x >= 0.0) & (profile.pressure != 0.0))
        if trace.phase[i] == trace.phase[last] and touching.size >= count:
            near, far = profile.pressure[touching[:2]].tolist()
            low, high = trace.model.shape.height(profile.x[touching[:2]]).tolist()
            shown.append((float(trace.time[i]), near + (near - far) * low / (high - low) if high > low else near))
        if len(shown) == 2:
            break
    else:
        shown = [(float(trace.time[i]), float(trace.profile(i).pressure.max())) for i in (last, last - 1)]
    (time, pressure), (start, before) = shown
    return time + pressure / (before - pressure) * (time - start) if before > pressure else math.inf
