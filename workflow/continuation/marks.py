"""Marks of a curve: the force maximum of an unloading, and displacement or radius as a function of the force."""

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
SEPARATED = 0.02
"""Force over the force maximum below which bodies count as separated: the model has the rest."""
NODES, MODEL_DIGITS = 128, 1e-6
"""Of the quadrature of a work; half of them, and of the states, say how well it is known; error of the
model's own tables, relative."""
HIDDEN = 200
"""Positions of the model between the load steps around a jump."""
TINY = float(np.finfo(np.float64).tiny)
SURELY = 1.1
"""Error of the force at a limit point over what it gains up to there, to first order."""
PLACE_FACTOR = 2.0
"""Error of the position of the force maximum over the distance between those of two polynomials."""
_top, _crossed = lru_cache(maxsize=4)(largest_tension), lru_cache(maxsize=4)(smooth_crossing)
"""Of the last few curves: the budget has one read again with other radii."""


def unloading(branch: Trace, settings: Settings) -> dict[str, Reading]:
    """F_A, a_cr, a₀ and the work of separation of a branch of falling displacement, those of the four that it has.

    F_A is the force maximum, at the vertex of a smooth curve or at the last row before a jump, and a_cr the radius
    there; a₀ is the radius where the force crosses 0. A force maximum at an end of the branch is none, but at the
    limit point of the contact.
    """
    found: dict[str, Reading] = {}
    peak, last = peak_of(branch), len(branch) - 1
    if peak.tension > 0.0 and peak.index > 0 and (peak.index < last or _distance_from_limit(branch) <= LAST):
        sampled = max(peak.uncertainty, branch.search.doubt.get("sampling", 0.0))
        errors = {"sampling": sampled, "instability": cut_short(branch, peak, settings)}
        found["adhesion_force"] = Reading(peak.smooth, FORCE, errors)
        if branch.radius(peak.index) is not None:
            found["critical_radius"] = _critical_radius(branch, peak, settings, sum(errors.values()))
    zero = _zero_load(branch)
    if "adhesion_force" in found and zero:
        zero |= _separation(branch, peak)
    return found | zero


def _separation(branch: Trace, peak: Peak) -> dict[str, Reading]:
    """∫ −F dd from F = 0 until nothing is felt; none where the branch ends before.

    The reduced model has the curve between the states; the difference from it is interpolated.
    """
    model = branch.model
    d, force = branch.lists
    start, end = _crossed(d, force, 0.0), model.apart
    held = [(one, own) for one, own in zip(d[::-1], force[::-1], strict=True) if end <= one < start]
    lost = branch.radius(len(branch) - 1) is None or _distance_from_limit(branch) <= LAST
    if not held or not (lost or abs(force[-1]) <= SEPARATED * peak.tension):
        return {}
    if model.parted is None:  # it goes on for as long as it takes
        after = next(i for i, one in enumerate(d) if one < start)
        pulled, way = np.asarray([0.0, *force[after:]]), np.asarray([start, *d[after:]])
        value, other = (float(np.trapezoid(pulled[rows], way[rows])) for rows in (slice(None), _every_other(way.size)))
        return {"work_of_separation": Reading(value, ENERGY, {"sampling": abs(value - other)})}
    at, own = np.asarray([*held, (start, 0.0)]).T

    def work(nodes: int, every: int) -> float:
        """By Gauss's quadrature over u, d = d_end + (d₀ − d_end) u²: a limit point has an infinite slope."""
        if (known := model.work(start, every)) is not None:
            return known
        u, weights = gauss(nodes)
        u = 0.5 * (u + 1.0)
        places = end + (start - end) * u**2
        others = [*range(0, len(at) - 1, every), len(at) - 1]
        off = own[others] - model.held(at[others])
        curve = model.held(places) + np.interp(places, at[others], off, left=0.0)
        return -(start - end) * float(weights @ (u * curve))

    value = work(NODES, 1)
    missed = abs(value - work(NODES // 2, 2)) + MODEL_DIGITS * value
    return {"work_of_separation": Reading(value, ENERGY, {"sampling": missed})}


def _every_other(count: int) -> list[int]:
    """Numbers of every other of so many states, and of the last."""
    return [*range(0, count - 1, 2), count - 1]


def _critical_radius(branch: Trace, peak: Peak, settings: Settings, missed: float) -> Reading:
    """a at the force maximum; where that may be another one by `missed` [FU], the radius may be the one there.

    A jump comes anywhere before the next load step, and may leave nothing to read a radius off.
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
        errors = {"sampling": PLACE_FACTOR * rate * peak.misplaced}
        by = PLACE_FACTOR * peak.misplaced
        places = np.asarray([d[near], peak.position, peak.position - by, peak.position + by], dtype=np.float64)
        if (known := branch.model.radii(places)) is not None:  # of a stiff contact it rises from 0 as a root
            here, there, *ends = known.tolist()
            radius = branch.radius_or_spot(near) + there - here
            top = branch.model.critical_radius or 0.0
            errors = {"sampling": max(abs(radius - top), *(abs(there - end) for end in ends)) + MODEL_DIGITS * radius}
    if settings.snaps:
        teeth = rivals(*branch.lists, peak)
        others = [branch.radius_or_spot(i) for i, excess in teeth.items() if excess > -missed]
        errors["instability"] = max((abs(other - radius) for other in others), default=0.0)
    return Reading(radius, LENGTH, errors)


def _zero_load(branch: Trace) -> dict[str, Reading]:
    """a where the force crosses 0, by a parabola, and how far an attraction with a range goes there, c.

    A straight line estimates the error. None where the force never crosses 0, or only as the contact is lost.
    """
    d, force = branch.lists
    try:
        index, place = crossing(d, force, 0.0)
    except ValueError:
        return {}
    after = min(index + 1, len(d) - 1)
    if branch.radius(after) is None:
        return {}

    def there(length: Callable[[int], float]) -> Reading:
        line = float(np.interp(place, [d[after], d[index]], [length(after), length(index)]))
        value = _through_nearest(branch, _crossed(d, force, 0.0), length)
        return Reading(value, LENGTH, {"sampling": abs(value - line)})

    found = {"zero_load_radius": there(branch.radius_or_spot)}
    if branch.reach(index) is not None:
        found["cohesive_radius"] = there(lambda state: branch.reach(state) or 0.0)
    return found


def early_loss(branch: Trace, peak: Peak, settings: Settings) -> float:
    """How far [LU] before its limit the force maximum may have been lost, in the move after it."""
    d = branch.displacement
    return settings.premature_detachment(float(d[peak.index] - d[min(peak.index + 1, len(d) - 1)]))


def cut_short(branch: Trace, peak: Peak, settings: Settings) -> float:
    """Tension [FU] that is missed by that: it would have gone on to rise as it did.

    Also where the model has its maximum between the load steps around the last one that is held: just before a pair
    separates its force may have passed its own.
    """
    d, force, i = branch.displacement, branch.force, peak.index
    if not 0 < i < len(d) - 1:
        return 0.0
    rise = max(0.0, float(force[i - 1] - force[i]) / max(float(d[i - 1] - d[i]), TINY))
    hidden = 0.0
    if settings.snaps and peak.position == d[i]:
        held = branch.model.held(np.append(d[i - 1 : i + 1], np.linspace(d[i - 1], d[i + 1], HIDDEN)))
        hidden = float(held[:2].min() - held.min())
    return max(rise * early_loss(branch, peak, settings), hidden)


def _distance_from_limit(branch: Trace) -> float:
    """Of the last load step, over the whole branch; infinite where no limit point is known."""
    return abs(float(branch.displacement[-1]) - branch.limit) / max(float(np.ptp(branch.displacement)), TINY)


def peak_of(trace: Trace) -> Peak:
    """The force maximum by falling displacement; at the limit point, where a contact is lost at once, its force.

    Up to there it gains as much as the model has over the same distance before.
    """
    found = _top(*trace.lists)
    last = len(trace) - 1
    left = _distance_from_limit(trace)
    if found.index < last or left > LAST:
        return found
    d = float(trace.displacement[-1])
    gained = float(np.ptp(trace.model.held(np.asarray([d, 2.0 * d - trace.limit]))))
    missed = max(left * found.tension, SURELY * gained)
    return Peak(last, found.tension, missed, found.tension, found.position, 0.0)


def radius_rate(trace: Trace, state: int, least: float = 0.0) -> float:
    """da/dd at a state, from the nearest other one that is farther than a share `least` of the whole path."""
    return slope(trace.displacement, state, trace.radius_or_spot, least)


def radius_at(trace: Trace, position: float) -> float:
    """Contact radius [LU] at a displacement [LU] of a sorted trace, by a parabola through the three nearest states."""
    return _through_nearest(trace, position, trace.radius_or_spot)


def _through_nearest(trace: Trace, position: float, length: Callable[[int], float]) -> float:
    near = int(np.argmin(np.abs(trace.displacement - position)))
    first = min(max(near - 1, 0), max(len(trace) - 3, 0))
    at = range(first, min(first + 3, len(trace)))
    if position == trace.displacement[near] or len(at) < 2:
        return length(near)
    radii = [length(i) for i in at]
    if min(radii) == max(radii):  # a body that ends at an edge
        return radii[0]
    d = trace.displacement[list(at)]
    weights = [np.prod([(position - d[k]) / (d[j] - d[k]) for k in range(len(d)) if k != j]) for j in range(len(d))]
    return max(0.0, float(sum(weight * radius for weight, radius in zip(weights, radii, strict=True))))


def displacement_under(trace: Trace, state: int, force: float, expected: float) -> float:
    """Displacement [LU] at which the curve through a state carries a force [FU] that is near to its own.

    x with S x + K x²/2 = ΔF: towards the force maximum the stiffness S = dF/dd falls as K = dS/dd says, and x
    grows as a square root, up to √(2 |ΔF|/K). S and K are those of a parabola through up to two states beside it,
    one at least twice as far off as the other; S is at most `expected` [FU/LU], which counts alone where there are
    no such states.
    """
    own, missing = float(trace.displacement[state]), force - float(trace.force[state])
    ways, slopes = _beside(trace, state)
    expected = max(expected, TINY)
    if len(ways) < 2:
        known = [expected, *(abs(slope) for slope in slopes if slope)]
        return own + missing / min(known)
    bend = 2.0 * (slopes[0] - slopes[1]) / (ways[0] - ways[1])
    stiffness = min(expected, slopes[0] - 0.5 * bend * ways[0])
    if bend <= 0.0:
        return own + missing / (stiffness if stiffness > 0.0 else expected)
    root = stiffness**2 + 2.0 * bend * missing
    if stiffness <= 0.0 or root <= 0.0:
        return own + math.copysign(math.sqrt(2.0 * abs(missing) / bend), missing)
    return own + 2.0 * missing / (stiffness + math.sqrt(root))


def _beside(trace: Trace, state: int) -> tuple[list[float], list[float]]:
    """Distances [LU] of up to two states beside one, and dF/dd [FU/LU] up to each.

    Nearer than BRANCH_DISTANCE of the path they say less than their own errors.
    """
    away = trace.displacement - trace.displacement[state]
    least = BRANCH_DISTANCE * float(np.abs(away).max())
    ways: list[float] = []
    slopes: list[float] = []
    for other in np.argsort(np.abs(away), kind="stable"):
        way = float(away[other])
        if way != 0.0 and abs(way) >= least and len(ways) < 2:
            ways.append(way)
            slopes.append(float(trace.force[other] - trace.force[state]) / way)
            least = 2.0 * abs(way)
    return ways, slopes
