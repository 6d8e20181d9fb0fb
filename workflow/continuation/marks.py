"""Marks of a curve: the force maximum of an unloading, and displacement or radius as a function of the force.

A branch has falling displacements d [LU]; forces F [FU] are positive in compression, and the force maximum F_A is the
largest tension, −F. a is the contact radius [LU], a_cr at the force maximum and a₀ at F = 0. A limit point is a
displacement at which the force jumps, since the contact is lost.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import Peak, crossing, largest_tension, rivals, smooth_crossing
from contact1d.analysis.polynomial import gauss
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.continuation.trace import BRANCH_DISTANCE, Trace, slope
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

Array = NDArray[np.float64]
LAST = 1e-6
"""Distance from the limit point, over the path from F = 0 to there, within which the last load step represents it."""
MODEL_DIGITS = 1e-6
"""Relative error of the tables of the reduced model."""
TINY = float(np.finfo(np.float64).tiny)
POSITION_FACTOR = 2.0
"""Error of the position of the force maximum over the distance between those of two polynomials."""
_top, _crossed = lru_cache(maxsize=4)(largest_tension), lru_cache(maxsize=4)(smooth_crossing)
"""Marks of the last few curves: the budget evaluates a curve again with other radii."""


def unloading(branch: Trace, settings: Settings) -> dict[str, Reading]:
    """Return the results of a branch of falling displacement by name, with their errors; those it lacks are left out.

    "adhesion_force" F_A [FU] is the force maximum, as a positive tension, at the vertex of a smooth curve or at the
    last load step before a jump; "critical_radius" a_cr [LU] the radius there; "zero_load_radius" a₀ and
    "cohesive_radius" c [LU] the radii where the force crosses 0; "work_of_separation" [FU·LU] the work from there until
    the bodies are apart. A force maximum at an end of the branch counts only at the limit point of the contact.
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
    """Return {"work_of_separation": ∫ −F dd [FU·LU]} from F = 0 until the bodies part; {} where the branch ends before.

    The reduced model has the curve between the states, to which their interpolated difference is added, and the curve
    below the share `separated` of the force maximum. The error, "sampling", is the change with half the `nodes` of the
    quadrature and every second state. Where the contact ends at no fixed displacement the states alone are integrated.
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
        value, coarse = (
            float(np.trapezoid(tail[rows], path[rows])) for rows in (slice(None), _every_second(path.size))
        )
        return {"work_of_separation": Reading(value, ENERGY, {"sampling": abs(value - coarse)})}
    positions, forces = np.asarray([*held, (start, 0.0)]).T

    def work(nodes: int, every: int) -> float:
        """Return the work [FU·LU] by so many nodes and `every` second, third … state.

        By Gauss's quadrature over u, d = d_end + (d₀ − d_end) u²: a limit point has an infinite slope.
        """
        if (known := model.work(start, every)) is not None:
            return known
        u, weights = gauss(nodes)
        u = 0.5 * (u + 1.0)
        between = end + (start - end) * u**2
        chosen = [*range(0, len(positions) - 1, every), len(positions) - 1]
        off = forces[chosen] - model.held(positions[chosen])
        curve = model.held(between) + np.interp(between, positions[chosen], off, left=0.0)
        return -(start - end) * float(weights @ (u * curve))

    value = work(nodes, 1)
    missed = abs(value - work(nodes // 2, 2)) + MODEL_DIGITS * value
    return {"work_of_separation": Reading(value, ENERGY, {"sampling": missed})}


def _every_second(count: int) -> list[int]:
    """Return the indices 0, 2, 4, … of `count` states, and the last one."""
    return [*range(0, count - 1, 2), count - 1]


def _critical_radius(branch: Trace, peak: Peak, settings: Settings, missed: float) -> Reading:
    """Return the contact radius at the force maximum [LU]; errors: "sampling" and, where pairs snap, "instability".

    Another maximum that is lower by up to `missed` [FU] may be the highest: the radius there gives the latter. A jump
    comes anywhere before the next load step, after which there may be no contact radius.
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
        errors = {"sampling": POSITION_FACTOR * rate * peak.misplaced}
        error = POSITION_FACTOR * peak.misplaced
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
    """Return the contact radius where the force crosses 0, "zero_load_radius" [LU], by a parabola through three states.

    Also the outer radius c of a cohesive zone there, "cohesive_radius" [LU], where there is one. The error, "sampling",
    is the difference from a straight line. {} where the force never crosses 0, or only as the contact is lost.
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
        """Return a length of states [LU] where the force crosses 0, with its sampling error."""
        line = float(np.interp(position, [d[after], d[index]], [length(after), length(index)]))
        value = _through_nearest(branch, _crossed(d, force, 0.0), length)
        return Reading(value, LENGTH, {"sampling": abs(value - line)})

    readings = {"zero_load_radius": at_zero(branch.radius_or_spot)}
    if branch.reach(index) is not None:
        readings["cohesive_radius"] = at_zero(lambda state: branch.reach(state) or 0.0)
    return readings


def early_detachment(branch: Trace, peak: Peak, settings: Settings) -> float:
    """Return the displacement [LU] by which the load step after the force maximum may separate a pair before its limit.

    0 where no pair snaps.
    """
    d = branch.displacement
    return settings.premature_detachment(float(d[peak.index] - d[min(peak.index + 1, len(d) - 1)]))


def missed_tension(branch: Trace, peak: Peak, settings: Settings, positions: int = 200) -> float:
    """Return the tension [FU] ≥ 0 that premature detachment misses; 0 where the maximum is the first or the last state.

    It is the slope before the maximum times `early_detachment`, where pairs snap at least by how much the model exceeds
    the states at so many `positions` between the load steps around the maximum: just before a pair separates, its force
    may have passed its maximum.
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
    """Return the distance of the last state from the limit point, relative to the width of the branch.

    Infinite without one.
    """
    return abs(float(branch.displacement[-1]) - branch.limit) / max(float(np.ptp(branch.displacement)), TINY)


def peak_of(trace: Trace) -> Peak:
    """Return the force maximum of a trace of falling displacement, as a positive tension.

    Where the branch ends at the limit point (within 1e-6 of its width), at which the contact is lost, it is that of the
    last load step; its uncertainty is by how much the force there may exceed that: the change of the model over the
    same distance before.
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
    """Return da/dd at a state [LU/LU], from the nearest one beyond a share `least` of the path; 0 where none is."""
    return slope(trace.displacement, state, trace.radius_or_spot, least)


def radius_at(trace: Trace, position: float) -> float:
    """Return the contact radius [LU] ≥ 0 at a displacement [LU] of a sorted trace, by a parabola through three states.

    At the displacement of a state, its radius; where the three radii are equal, as of a body with an edge, this one.
    """
    return _through_nearest(trace, position, trace.radius_or_spot)


def _through_nearest(trace: Trace, position: float, length: Callable[[int], float]) -> float:
    """Return a length [LU] ≥ 0 at a displacement [LU] of a sorted trace, by a parabola through three states.

    `length`: function of a state's number [LU]. At the displacement of a state, its own length.
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

    x with S x + K x²/2 = ΔF: towards the force maximum the stiffness S = dF/dd falls with K = dS/dd, and x grows as a
    square root, up to √(2 |ΔF|/K). S and K are those of a parabola through up to two neighbours of the state, at
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
    """Return (signed distances [LU], dF/dd [FU/LU] from the state to each) of up to two neighbours of a state.

    The second is at least twice as far as the first. Neighbours nearer than 2 % of the farthest state are left out:
    there a change is smaller than its error. Both lists are empty where there are none.
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
