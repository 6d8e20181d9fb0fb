"""History: a displacement or a force over time, on a rigid plane, of a body that may relax."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import groupby, pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import vertex
from contact1d.analysis.polynomial import through
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.reduction import MARGIN
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.experiments.experiment import FINER_SPACING, Scripted
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.path import History as Moments
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import History, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, LINE_PRESSURE, MEAN_PRESSURE, TIME

STEPS, FOR_TOLERANCE = 70, 1e-3
"""Load steps of a leg at a tolerance; they miss a part that goes with the square of their width."""
SOONEST = 0.001
"""First of the load steps that become longer and longer, over the shortest time of the body."""
NOTHING = 1e-9
"""Force over the largest one below which it is round-off of a displacement."""
RATES = 3
"""States on one side of a corner that give the rates there."""
SAMPLED, DIGITS = 1e-4, 1e-7
"""Errors at least, relative, of the rates that a few states show, and of a time that is found between two."""
MOST_BEYOND = 2.0
"""Load steps from the last state that presses to where the body has parted, at most: its particles part before."""
ROUNDED = 9
"""Decimals of parts of a leg: none is as short as round-off."""
PHASES = {1.0: "loading", -1.0: "unloading", 0.0: "holding"}


class HistoryExperiment(Scripted[History]):
    """d, F and a at the end, the peaks, what is lost, and how long the bodies touch."""

    main_results = ("peak_force", "peak_displacement", "displacement", "force", "contact_radius")

    def is_sampled(self, scene: Scene) -> bool:
        """Always."""
        return True

    def script(self, branch: Driver, scene: Scene) -> None:
        """All of it; the end of each leg is reported."""
        branch.follow(branch.model.refined(_moments(scene)))

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """See the class."""
        by_force, last = self.given(scene).force is not None, len(trace) - 1
        d, force = trace.displacement, trace.force
        found = {
            "peak_force": Reading(float(force.max()), FORCE, prescribed=by_force),
            "peak_displacement": Reading(float(d.max()), LENGTH, {"sampling": _above(trace)}, prescribed=not by_force),
            "displacement": Reading(float(d[last]), LENGTH, prescribed=not by_force, scale=float(np.abs(d).max())),
            "force": Reading(float(force[last]), FORCE, prescribed=by_force, scale=float(np.abs(force).max())),
        }
        parted = not touches(trace)[last]
        if not parted and (radius := trace.radius(last)):
            found["contact_radius"] = Reading(radius, LENGTH)
            found["mean_pressure"] = Reading(float(force[last]) / (math.pi * radius**2), MEAN_PRESSURE)
        if trace.phase[-1].startswith("holding"):
            free, unit = (d, LENGTH) if by_force else (force, FORCE)
            first = next((i for i in range(last, -1, -1) if not trace.phase[i].startswith("holding")), 0)
            found["relaxation"] = Reading(float(abs(free[last] - free[first])), unit, scale=float(np.abs(free).max()))
        if parted and force.any():
            if not touches(trace)[0]:
                whole = _work(d, force) if law_of(scene).is_lossless else None
                found["dissipated_energy"] = Reading(float(np.trapezoid(force, d)), ENERGY, scale=whole)
            found["contact_time"] = lost(trace, _touched(trace, by_force))
            if radius := touches(trace)[last - 1] and trace.radius(last - 1):  # not yet apart?
                found["contact_radius"] = Reading(0.0, LENGTH, {"sampling": radius})
        return found if law_of(scene).jumps(scene) else found | _slopes(trace)

    def asked(self, trace: Trace, scene: Scene) -> Sequence[tuple[float, float]]:
        """The force of each load step."""
        given = self.given(scene)
        if not given.force:
            return ()
        wanted = np.interp(trace.time, given.times, [point.force for point in given.force])
        return list(zip(wanted.tolist(), trace.force.tolist(), strict=True))

    def finish(self, outcome: Outcome, scene: Scene, settings: Settings) -> Outcome:
        """The time of each state, and why a number is missing."""
        found, words = {"contact_time", "dissipated_energy"} - outcome.results.keys(), ""
        if len(found) > 1:
            words = "the bodies touch at the end, or never, so there is neither a contact_time nor a dissipated_energy"
        elif found:
            words = "the history begins in contact, and what that took is not known, so there is no dissipated_energy"
        missing = {"no_energy": words} if words else {}
        if law_of(scene).jumps(scene) and any(name.startswith("unloading") for name in _moments(scene).phases):
            missing["no_slope"] = (
                "the force of a dashpot jumps where the unloading begins, so there is neither an unloading_stiffness "
                "nor a creep_corrected_stiffness"
            )
        outcome = replace(outcome, warnings={**outcome.warnings, **missing})
        return replace(outcome, columns={"time": tuple(one.time for one in outcome.states)})

    def advice(self, scene: Scene) -> str:
        """Lattice and load steps limit it."""
        return f"Use more experiment.steps, or {FINER_SPACING}"


def _moments(scene: Scene) -> Moments:
    """The load steps of the legs, dense behind each corner where the body relaxes."""
    given = scene.experiment
    assert isinstance(given, History)
    values = [point.force for point in given.force] if given.force else given.places()
    count = given.steps or math.ceil(STEPS * math.sqrt(FOR_TOLERANCE / scene.accuracy.tolerance))
    names, soonest = list[str](), law_of(scene).shortest_time(scene)
    times, wanted = [np.asarray(given.times[:1])], [np.asarray(values[:1])]
    for (before, after), (start, end) in zip(pairwise(given.times), pairwise(values), strict=True):
        parts = np.linspace(0.0, 1.0, count + 1)[1:]
        if soonest and not given.steps:
            first = min(1.0, SOONEST * soonest / (after - before))
            parts = np.union1d(parts, np.geomspace(first, 1.0, count // 2)).round(ROUNDED)
            parts = np.unique(parts[parts > 0.0])
        names += [PHASES[float(np.sign(end - start))]] * parts.size
        times.append(before + (after - before) * parts)
        wanted.append(start + (end - start) * parts)
    phases = _numbered([names[0], *names])
    marks = {name: f"after_{name}" for name in phases} | {phases[-1]: "final"}
    return Moments(phases, np.concatenate(times), np.concatenate(wanted), bool(given.force), marks)


def _numbered(names: list[str]) -> tuple[str, ...]:
    """Names of phases, each with a number where it comes again."""
    counts: dict[str, int] = {}
    found: list[str] = []
    for name, same in groupby(names):
        counts[name] = counts.get(name, 0) + 1
        found += [name if counts[name] == 1 else f"{name}_{counts[name]}"] * len(list(same))
    return tuple(found)


def _above(trace: Trace) -> float:
    """How far [LU] the largest displacement may lie above that of all states, within a phase, by a parabola there."""
    d, top = trace.displacement, int(trace.displacement.argmax())
    if len(set(trace.phase[max(top - 1, 0) : top + 2])) > 1 or not 0 < top < len(trace) - 1:
        return 0.0
    return vertex(trace.time, d, top, 1)[1] - float(d[top])


def _slopes(trace: Trace) -> dict[str, Reading]:
    """dF/dd where the first unloading begins, and what it is without the creep of the moment before.

    The body's own is the ratio of the jumps of the rates, [Ḟ]/[ḋ], under a held force 1/(1/S + ḋ/|Ḟ|): G. Feng,
    A. H. W. Ngan, J. Mater. Res. 17 (2002) 660. Oliver and Pharr have 2 E* a of it.
    """
    falls = [name.startswith("unloading") for name in trace.phase]
    first = falls.index(True) if True in falls else 0
    if first < RATES or first + RATES - 1 > len(trace) or not falls[first + RATES - 2]:
        return {}
    corner, time, d = first - 1, trace.time, trace.displacement
    near = range(corner - RATES + 1, corner + RATES)
    force = dict(zip(near, _whole(trace, corner, near), strict=True))
    rates = []
    for side in (near[:RATES], near[RATES - 1 :]):
        at = np.asarray([time[i] - time[corner] for i in side])
        rates.append([float(through(at, np.asarray([one[i] for i in side]))[1]) for one in (force, d)])
    (force_before, d_before), (force_after, d_after) = rates
    found = {"unloading_stiffness": _rate(force_after / d_after)} if d_after else {}
    if d_after != d_before:
        found["creep_corrected_stiffness"] = _rate((force_after - force_before) / (d_after - d_before))
    return found


def _rate(value: float) -> Reading:
    """A slope at a corner [FU/LU], with the discretisation error of a few states."""
    return Reading(value, LINE_PRESSURE, {"sampling": SAMPLED * abs(value)})


def _whole(trace: Trace, corner: int, states: Sequence[int]) -> list[float]:
    """F [FU] of states of the body: a sum over particles misses E* g′(a) y² at its edge, y from the last cell to there.

    Its slope has a whole number of particles, and not as many as fit into the contact. Behind the corner the edge goes
    with the displacement, y dy/dd = y/g′(a). The end of a body is that of a particle, and some laws have parts of one.
    """
    law, force = trace.model.law, [float(trace.force[i]) for i in states]
    radius, modulus = trace.radius(corner) or 0.0, law.stiffness / law.spacing
    if trace.model.shares_edges or radius >= law.profile.reach:
        return force
    found = []
    for i, own in zip(states, force, strict=True):
        near = abs((trace.radius(i) or 0.0) - radius) < law.spacing
        at = min(i, corner) if near else i
        edge = trace.radius(at) or 0.0
        touching = np.flatnonzero(trace.profile(i).pressure)
        x = np.abs(trace.profile(i).x[touching[[0, -1]]]) if touching.size else np.full(2, edge - 0.5 * law.spacing)
        missed = edge - 0.5 * law.spacing - x
        low, high = law.profile.height(edge + 0.5 * law.spacing * np.asarray([-1.0, 1.0])).tolist()
        moved = float(trace.displacement[i] - trace.displacement[at])
        found.append(own + modulus * float(np.sum(0.5 * (high - low) / law.spacing * missed**2 + missed * moved)))
    return found


def _work(d: NDArray[np.float64], force: NDArray[np.float64]) -> float:
    """∫|F dd| [FU·LU]."""
    return float(np.sum(0.5 * np.abs((force[1:] + force[:-1]) * np.diff(d))))


def touches(trace: Trace) -> NDArray[np.bool_]:
    """In which states the bodies press or hold each other by more than round-off."""
    return np.abs(trace.force) > NOTHING * float(np.abs(trace.force).max())


def _touched(trace: Trace, by_force: bool) -> float:
    """When the bodies touch first [TU]: at d = 0, or with the first force that is given."""
    first = int(np.argmax(touches(trace)))
    apart = np.flatnonzero(trace.force[:first] <= 0.0 if by_force else trace.displacement[: first + 1] <= 0.0)
    if not apart.size:
        return float(trace.time[0])
    if by_force:
        return float(trace.time[apart[-1]])
    near = slice(int(apart[-1]), int(apart[-1]) + 2)
    return float(np.interp(0.0, trace.displacement[near], trace.time[near]))


def lost(trace: Trace, touched: float = 0.0) -> Reading:
    """How long after a moment they part for good [TU]: at a displacement that is known, or as the pressure falls to 0.

    A tension ends somewhere in its load step.
    """
    last, place, d = max(1, int(np.flatnonzero(touches(trace))[-1])), trace.model.parted, trace.displacement
    if place is not None:  # the particles next to the axis may be lost before
        last += int(np.argmax(d[last + 1 :] <= place))
    time, end = trace.time[last : last + 2].tolist()
    part, doubt, digits = 0.0, 0.0, 0.0 if place is None else DIGITS
    if place is not None:
        part = float((d[last] - place) / (d[last] - d[last + 1])) if d[last] > d[last + 1] else 0.0
    elif trace.given == "force":
        part = 1.0
    elif trace.force[last] < 0.0:
        part = doubt = 0.5
    elif trace.phase[last + 1] == trace.phase[last]:  # else at a corner, where dashpots push no more
        ends = [fallen(trace, last, count) for count in (3, 5)]
        part, other = (min(max((one - time) / (end - time), 0.0), MOST_BEYOND) for one in ends)
        doubt = abs(part - other)
    found = time + part * (end - time)
    return Reading(found - touched, TIME, {"sampling": MARGIN * doubt * (end - time) + digits * (found - touched)})


def fallen(trace: Trace, last: int, count: int) -> float:
    """When the pressure on the axis falls to 0 [TU], on a line through the last two states that show it.

    A pressure there is straight over the height between the two particles next to the axis; of so few as `count` on a
    side the next one counts whole. Where no such states are, the two up to the `last` that touches.
    """
    shown = []
    for i in range(last, -1, -1):
        profile = trace.profile(i)
        beside = np.flatnonzero((profile.x >= 0.0) & (profile.pressure != 0.0))
        if trace.phase[i] == trace.phase[last] and beside.size >= count:
            near, far = profile.pressure[beside[:2]].tolist()
            low, high = trace.model.shape.height(profile.x[beside[:2]]).tolist()
            shown.append((float(trace.time[i]), near + (near - far) * low / (high - low) if high > low else near))
        if len(shown) == 2:
            break
    else:
        shown = [(float(trace.time[i]), float(trace.profile(i).pressure.max())) for i in (last, last - 1)]
    (time, here), (start, before) = shown
    return time + here / (before - here) * (time - start) if before > here else math.inf
