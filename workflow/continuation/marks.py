"""Marks of a curve: the force maximum of an unloading, and displacement or radius as a function of the force.

A branch has falling displacements d [LU]; forces F [FU] are positive in compression, and the force maximum F_A is the
largest tension, −F. a is the contact radius [LU], a_cr at the force maximum and a₀ at F = 0. A limit point is a
displacement at which the force jumps, since the contact is lost.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from contact1d.analysis.curve_marks import Peak, crossing, largest_tension, rivals, smooth_crossing
from contact1d.analysis.polynomial import gauss
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.continuation.trace import BRANCH_DISTANCE, Trace, slope
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

LAST = 1e-6
"""Distance from the limit point, over the path from F = 0 to there, within which the last load step represents it."""
MODEL_DIGITS = 1e-6
"""Relative error of the tables of the reduced model."""
TINY = sys.float_info.min
POSITION_FACTOR = 2.0
"""Error of the position of the force maximum over the distance between those of two polynomials."""
_top, _crossed = lru_cache(maxsize=4)(largest_tension), lru_cache(maxsize=4)(smooth_crossing)
"""Marks of the last few curves: the budget evaluates a curve again with other radii."""


def unloading(branch: Trace, settings: Settings) -> dict[str, Reading]:
    """Return the results of a branch of falling displacement by name, with their errors; those it lacks are left out.

    "adhesion_force" [FU] is the force maximum, a tension > 0, at the vertex of a smooth curve or at the last load step
    before a jump; it is left out where it is the first state, or the last one and not at the limit point, where the
    contact is lost. "critical_radius" [LU] is the contact radius there; "zero_load_radius" [LU] that where the force
    crosses 0, and "cohesive_radius" [LU] the outer radius of the attraction there, if this reaches beyond the edge;
    "work_of_separation" [FU·LU], only with an adhesion force, the work from there until the bodies are apart.
    """
    readings: dict[str, Reading] = {}
    peak, last = peak_of(branch), len(branch) - 1
    if peak.tension > 0.0 and peak.index > 0 and (peak.index < last or _distance_from_limit(branch) <= LAST):
        sampled = max(peak.uncertainty, branch.search.doubt.get("sampling", 0.0))
        errors = {"sampling": sampled, "instability": missed_tension(branch, peak, settings)}
        readings["adhesion_force"] = Reading(peak.smooth, FORCE, errors)
        if branch.radius(peak.index) is not None:
            readings["critical_radius"] = _critical_radius(branch, peak, settings, sum(errors.values()))
    zero = _zero_load(branch)
    if "adhesion_force" in readings and zero:
        zero |= _separation(branch, peak)
    return readings | zero


def _separation(branch: Trace, peak: Peak, separated: float = 0.02, nodes: int = 128) -> dict[str, Reading]:
    """Return {"work_of_separation": ∫ −F dd [FU·LU]} from F = 0 until the bodies part.

    {} where the branch ends before: still in contact, not at the limit point, and with more than `separated` of the
    maximum, or without a state between F = 0 and separation. The reduced model has the curve between the states, to
    which their interpolated difference is added, and the curve below the last one. The error, "sampling", is the change
    with half the `nodes` of the quadrature and every second state. Where the contact ends at no fixed displacement
    (forces that depend on time) the states alone are integrated.
    """
    model = branch.model
    d, force = branch.lists
    start, end = _crossed(d, force, 0.0), model.apart
    held = [(position, load) for position, load in zip(d[::-1], force[::-1], strict=True) if end <= position < start]
    lost = branch.radius(len(branch) - 1) is None or _distance_from_limit(branch) <= LAST
    if not held or not (lost or abs(force[-1]) <= separated * peak.tension):
        return {}
    if model.parted is None:  # the contact ends at no fixed displacement
        after = next(i for i, position in enumerate(d) if position < start)
        tail, path = np.asarray([0.0, *force[after:]]), np.asarray([start, *d[after:]])
        value, coarse = (float(np.trapezoid(tail[rows], path[rows])) for rows in (slice(None), _each(2, path.size)))
        return {"work_of_separation": Reading(value, ENERGY, {"sampling": abs(value - coarse)})}
    positions, forces = np.asarray([*held, (start, 0.0)]).T

    def work(nodes: int, every: int) -> float:
        """Return the work [FU·LU] with this number of nodes, from states 0, `every`, 2 `every`, … and the last one.

        Where the contact law knows the work, it is the law's.

        By Gauss's quadrature over u, d = d_end + (d₀ − d_end) u²: a limit point has an infinite slope.
        """
        if (known := model.work(start, every)) is not None:
            return known
        u, weights = gauss(nodes)
        u = 0.5 * (u + 1.0)
        between = end + (start - end) * u**2
        chosen = _each(every, len(positions))
        off = forces[chosen] - model.held(positions[chosen])
        curve = model.held(between) + np.interp(between, positions[chosen], off, left=0.0)
        return -(start - end) * float(weights @ (u * curve))

    value = work(nodes, 1)
    missed = abs(value - work(nodes // 2, 2)) + MODEL_DIGITS * value
    return {"work_of_separation": Reading(value, ENERGY, {"sampling": missed})}


def _each(step: int, count: int) -> list[int]:
    """Return the indices 0, `step`, 2 `step`, … below the last of `count` states, and the last one; [−1] for 0."""
    return [*range(0, count - 1, step), count - 1]


def _critical_radius(branch: Trace, peak: Peak, settings: Settings, missed: float) -> Reading:
    """Return the contact radius at the force maximum [LU]; errors: "sampling", and where pairs snap "instability".

    The latter is the largest difference from the radius at another maximum, lower by at most `missed` [FU], that may be
    the highest. Before a jump the radius is that of the last load step, and may change up to the next one; of a smooth
    curve it is interpolated. Where a state has no contact radius, 0 ± 1.5 spacings counts.
    """
    d, i = branch.displacement, peak.index
    jumps = i + 1 < len(d) and peak.position == d[i]
    if jumps:
        radius = branch.radius_or_spot(i)
        rate = abs(radius - branch.radius_or_spot(i - 1)) / max(float(d[i - 1] - d[i]), TINY)
        errors = {"sampling": rate * float(d[i] - d[i + 1])}
    else:
        near = int(np.argmin(np.abs(d - peak.position)))
        rate = abs(radius_rate(branch, near))
        radius = radius_at(branch, peak.position)
        error = POSITION_FACTOR * peak.misplaced
        errors = {"sampling": rate * error}
        positions = np.asarray([d[near], peak.position, peak.position - error, peak.position + error], dtype=np.float64)
        if (known := branch.model.radii(positions)) is not None:  # of a stiff contact it rises from 0 as a root
            nearest, expected, *ends = known.tolist()
            radius = branch.radius_or_spot(near) + expected - nearest
            top = branch.model.critical_radius or 0.0
            changes = [abs(radius - top), *(abs(expected - end) for end in ends)]
            errors = {"sampling": max(changes) + MODEL_DIGITS * radius}
    if settings.snaps:
        maxima = rivals(*branch.lists, peak)
        radii = [branch.radius_or_spot(i) for i, excess in maxima.items() if excess > -missed]
        errors["instability"] = max((abs(rival - radius) for rival in radii), default=0.0)
    return Reading(radius, LENGTH, errors)


def _zero_load(branch: Trace) -> dict[str, Reading]:
    """Return {"zero_load_radius": contact radius [LU] where the force crosses 0}, by a parabola through three states.

    With "cohesive_radius" [LU], the outer radius of a cohesive zone there, where there is one. The error, "sampling",
    is the difference from a straight line. {} where the force never crosses 0, or only as the contact is lost. Of
    several crossings the first counts.
    """
    d, force = branch.lists
    try:
        index, position = crossing(d, force, 0.0)
    except ValueError:
        return {}
    after = min(index + 1, len(d) - 1)
    if branch.radius(after) is None:
        return {}

    def at_zero(length: Callable[[int], float]) -> Reading:
        """Return a length of states [LU] ≥ 0 where the force crosses 0, with its sampling error.

        `length`: function of a state's number [LU].
        """
        line = float(np.interp(position, [d[after], d[index]], [length(after), length(index)]))
        value = _through_nearest(branch, _crossed(d, force, 0.0), length)
        return Reading(value, LENGTH, {"sampling": abs(value - line)})

    readings = {"zero_load_radius": at_zero(branch.radius_or_spot)}
    if branch.reach(index) is not None:
        readings["cohesive_radius"] = at_zero(lambda state: branch.reach(state) or 0.0)
    return readings


def early_detachment(branch: Trace, peak: Peak, settings: Settings) -> float:
    """Return how far [LU of gap] ≥ 0 before its limit point the load step after the force maximum may separate a pair.

    Of a maximum at the last state, due to the residual force alone. 0 where no pair snaps.
    """
    d = branch.displacement
    move = float(d[peak.index] - d[min(peak.index + 1, len(d) - 1)])
    return settings.law.premature_detachment(move, settings.forces.residual)


def missed_tension(branch: Trace, peak: Peak, settings: Settings, positions: int = 200) -> float:
    """Return the tension [FU] ≥ 0 that premature detachment misses at the force maximum `peak` of a branch.

    It is the slope before the maximum times the displacement by which the next load step may separate a pair early;
    where pairs snap, and the curve jumps after the maximum, at least by how much the largest tension of the reduced
    model at so many `positions` from the state before to the one after it exceeds its larger one at the maximum and the
    state before: just before a pair separates, its force may have passed its maximum. 0 where the maximum is the first
    or the last state.
    """
    d, force, i = branch.displacement, branch.force, peak.index
    if not 0 < i < len(d) - 1:
        return 0.0
    rise = max(0.0, float(force[i - 1] - force[i]) / max(float(d[i - 1] - d[i]), TINY))
    hidden = 0.0
    if settings.snaps and peak.position == d[i]:
        held = branch.model.held(np.append(d[i - 1 : i + 1], np.linspace(d[i - 1], d[i + 1], positions)))
        hidden = float(held[:2].min() - held.min())
    return max(rise * early_detachment(branch, peak, settings), hidden)


def _distance_from_limit(branch: Trace) -> float:
    """Return |distance| of the last state from the limit point over the width of the branch in displacement.

    Infinite without a limit point of the reduced model below the first state.
    """
    return abs(float(branch.displacement[-1]) - branch.limit) / max(float(np.ptp(branch.displacement)), TINY)


def peak_of(trace: Trace) -> Peak:
    """Return the force maximum (largest tension) of a trace of falling displacement, as a positive tension.

    Its tension is below 0 where all states are under compression. Where the maximum is the last state, and this is at
    the limit point (within 1e-6 of the width of the branch), at which the contact is lost, its uncertainty is by how
    much the force there may exceed it: the change of the reduced model over the same distance before.
    """
    peak = _top(*trace.lists)
    last = len(trace) - 1
    left = _distance_from_limit(trace)
    if peak.index < last or left > LAST:
        return peak
    d = float(trace.displacement[-1])
    gained = float(np.ptp(trace.model.held(np.asarray([d, 2.0 * d - trace.limit]))))
    missed = max(left * peak.tension, 1.1 * gained)  # the gain to first order, and a margin
    return Peak(last, peak.tension, missed, peak.tension, peak.position, 0.0)


def radius_rate(trace: Trace, state: int, least: float = 0.0) -> float:
    """Return da/dd at a state [LU/LU], from the nearest one beyond a share `least` of the distance of the farthest.

    0 where there is none. A state without contact radius counts with 0.
    """
    return slope(trace.displacement, state, trace.radius_or_spot, least)


def radius_at(trace: Trace, position: float) -> float:
    """Return the contact radius [LU] ≥ 0 at a displacement [LU] of a sorted trace, by a parabola through three states.

    They are the nearest one and its neighbours; beyond the ends of the trace it is extrapolated. At the displacement of
    a state, its radius; where the three radii are equal, as of a body with an edge, this one. A state without contact
    radius counts with 0.
    """
    return _through_nearest(trace, position, trace.radius_or_spot)


def _through_nearest(trace: Trace, position: float, length: Callable[[int], float]) -> float:
    """Return a length [LU] ≥ 0 at a displacement [LU] of a sorted trace, by a parabola through three states.

    They are the nearest one and its neighbours, fewer where the trace has fewer. `length`: function of a state's number
    [LU]. At the displacement of a state it is its own length, where all three are equal that one.
    """
    near = int(np.argmin(np.abs(trace.displacement - position)))
    first = min(max(near - 1, 0), max(len(trace) - 3, 0))
    states = range(first, min(first + 3, len(trace)))
    if position == trace.displacement[near] or len(states) < 2:
        return length(near)
    radii = [length(i) for i in states]
    if min(radii) == max(radii):  # a body that ends at an edge
        return radii[0]
    d = trace.displacement[list(states)]
    weights = [np.prod([(position - d[k]) / (d[j] - d[k]) for k in range(len(d)) if k != j]) for j in range(len(d))]
    return max(0.0, float(sum(weight * radius for weight, radius in zip(weights, radii, strict=True))))


def displacement_under(trace: Trace, state: int, force: float, expected: float) -> float:
    """Return the displacement [LU] at which the curve through a state carries a force [FU] near that of the state.

    d + x, with S x + K x²/2 = ΔF: towards the force maximum the stiffness S = dF/dd falls with K = dS/dd, and x grows
    as a square root, up to √(2 |ΔF|/K). S and K are those of a parabola through two neighbours of the state, at
    distances that differ by a factor of two at least; S is at most the `expected` stiffness [FU/LU]. With fewer
    neighbours the step is straight, with the smaller of that and the one known slope.
    """
    d, missing = float(trace.displacement[state]), force - float(trace.force[state])
    distances, slopes = _neighbours(trace, state)
    expected = max(expected, TINY)
    if len(distances) < 2:
        known = [expected, *(abs(slope) for slope in slopes if slope)]
        return d + missing / min(known)
    bend = 2.0 * (slopes[0] - slopes[1]) / (distances[0] - distances[1])
    stiffness = min(expected, slopes[0] - 0.5 * bend * distances[0])
    if bend <= 0.0:
        return d + missing / (stiffness if stiffness > 0.0 else expected)
    root = stiffness**2 + 2.0 * bend * missing
    if stiffness <= 0.0 or root <= 0.0:
        return d + math.copysign(math.sqrt(2.0 * abs(missing) / bend), missing)
    return d + 2.0 * missing / (stiffness + math.sqrt(root))


def _neighbours(trace: Trace, state: int) -> tuple[list[float], list[float]]:
    """Return (signed distances [LU], mean dF/dd [FU/LU] from the state to each) of up to two neighbours of a state.

    The nearest comes first; the second is at least twice as far. Neighbours nearer than 2 % of the farthest state are
    left out: there a change is smaller than its error. Both lists are empty where there are none.
    """
    displacements = trace.displacement - trace.displacement[state]
    least = BRANCH_DISTANCE * float(np.abs(displacements).max())
    distances: list[float] = []
    slopes: list[float] = []
    for neighbour in np.argsort(np.abs(displacements), kind="stable"):
        distance = float(displacements[neighbour])
        if distance != 0.0 and abs(distance) >= least and len(distances) < 2:
            distances.append(distance)
            slopes.append(float(trace.force[neighbour] - trace.force[state]) / distance)
            least = 2.0 * abs(distance)
    return distances, slopes
