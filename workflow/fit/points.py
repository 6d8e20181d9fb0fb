"""The segments of a measured curve and the signs of its columns, as its words state them and its numbers show them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pandas import Series

from contact1d.workflow.fit.curve import APPROACH, HOLD, RETRACT, SEGMENTS, ForceCurve
from contact1d.workflow.fit.headings import SEGMENT_WORDS, DataError, meanings, words_in

Array = NDArray[np.float64]
Kinds = NDArray[np.int_]
FIRST, PAUSE, LAST = range(len(SEGMENTS))
"""Indices of approach, hold and retraction in `SEGMENTS`."""


def told_kinds(cells: Series[str]) -> Kinds | None:
    """Return the index in `SEGMENTS` of each point, (n,), from the cells of a column `segment`; −1 of one to leave out.

    Two numbers, or True and False, are approach and retraction, three are approach, hold and retraction, in the order
    of their first points; None for one number or more than three. A hold before the approach or after the retraction
    is left out.

    Raises:
        DataError: a word is unknown, or the segments are in another order.
    """
    cells = cells.astype(str).str.lower()
    words = [*cells.unique()]
    if all(word.strip("-+.0123456789") in ("", "true", "false") for word in words):
        names = {2: [APPROACH, RETRACT], len(SEGMENTS): [*SEGMENTS]}.get(len(words), [HOLD])
    else:
        names = [next(iter(meanings(words_in(word), SEGMENT_WORDS)), "") for word in words]
    if "" in names:
        known = "; ".join(f"{name}: {', '.join(words.split())}" for name, words in SEGMENT_WORDS.items())
        raise DataError(f"column segment has the word '{words[names.index('')]}'; known are {known}")
    if {*names} == {HOLD}:
        return None
    kinds = np.array(cells.map(dict(zip(words, map(SEGMENTS.index, names), strict=False))), dtype=int)
    moving = np.flatnonzero(kinds != PAUSE)
    kinds[: moving[0]] = -1
    if kinds[moving[-1]] == LAST:
        kinds[moving[-1] + 1 :] = -1
    if (np.diff(kinds[kinds >= 0]) < 0).any():
        raise DataError("column segment: the approach must come before the retraction, with at most one hold between")
    return kinds


def _flat_top(x: Array, width: float) -> NDArray[np.intp]:
    """Return the indices of the numbers within `width` of the largest one of x (n,); empty unless these are constant.

    Then less than 1.5 times as many numbers are within four times the width; at a parabola there are twice as many.
    """
    near, wide = (np.flatnonzero(x >= x.max() - factor * width) for factor in (1.0, 4.0))
    return near if wide.size < 1.5 * near.size else near[:0]


def hold_in(z: Array, F: Array, fewest: int = 10) -> slice:
    """Return the points of a hold, of which z or F is constant at its largest value, the longer one; empty without one.

    It has `fewest` points or more after the approach, and z moves by less than 0.4 of its distance in as many points
    of the approach: by more where a force is cut.

    `z`, `F`: positions, rising towards the sample, and forces in the order of time, (n,).
    """
    runs = [slice(0, 0)]
    for x in (z, F):
        noise = float(np.median(np.abs(np.diff(x, 2))))  # 1.7 standard deviations, if it is white
        flat = _flat_top(x, 0.005 * float(np.ptp(x)) + 4.0 * noise)
        if flat.size >= fewest and flat[0]:
            run = slice(int(flat[0]), int(flat[-1]) + 1)
            share = (run.stop - run.start) / run.start
            path = 2.0 * np.ptp(z[run]) - abs(z[run.stop - 1] - z[run.start])  # there and back
            runs += [run] * bool(path < 0.4 * share * np.ptp(z[: run.start]))
    return max(runs, key=lambda run: run.stop - run.start)


def require_signs(along: str, z: Array, F: Array, reverse: set[str], blocks: int = 20) -> None:
    """Check that the columns `along` and "F" have the signs that `reverse` says; nothing is returned.

    The force changes most where the bodies touch, and is largest there. Signs that the curve leaves open are accepted,
    as of one in tension throughout.

    Args:
        along: name of the column of the positions.
        z, F: positions and forces as in the file, (n,), the approach first.
        reverse: columns whose sign is opposite, by the fit file.
        blocks: number of parts of the curve whose mean forces are compared.

    Raises:
        DataError: a sign is another one, with the line to write; the curve has no contact, or both columns seem to be
            swapped.
    """
    span, noise = float(np.ptp(F)), float(np.std(np.diff(F)))
    if (
        np.ptp([block.mean() for block in np.array_split(F, blocks)]) <= 2.0 * noise
    ):  # a contact changes the mean by more
        raise DataError(f"the force does not exceed its noise: the curve has no contact, or {along} and F are swapped")
    away = np.abs(z - z[0])
    if not away.any():
        raise DataError(f"{along} is constant: give the positions of the piezo, or the indentation")
    turn = hold_in(away, np.abs(F - F[0])).start or int(np.argmax(away)) + 1
    z, F = z[:turn], F[:turn]
    low, high = (float(np.ptp(F[np.abs(z - end) <= 0.25 * np.ptp(z)])) for end in (z.min(), z.max()))
    opposite = {along: low > high} if max(low, high) > 1.5 * min(low, high) else {}
    # A ramp is a straight line over time, and the force of a contact is none.
    with np.errstate(invalid="ignore"):  # of a constant force
        straightness = np.abs(np.corrcoef([np.arange(z.size), z, F])[0])
    if opposite.get(along) and 1.0 - straightness[2] < 0.5 * (1.0 - straightness[1]):
        raise DataError(f"{along} and F seem to be swapped: exchange their names")
    F = F[np.argsort(-z if opposite.get(along, along in reverse) else z, kind="stable")]
    end = float(F[-2:].mean())
    change = end - float(np.array_split(F, blocks)[0].mean())
    if abs(change) > 0.2 * span and min(end - F.min(), F.max() - end) < 0.05 * span + 2.0 * noise:
        opposite["F"] = change < 0.0
    columns = {name for name in (along, "F") if opposite.get(name, name in reverse)}
    if columns != reverse:
        names = ", ".join(f'"{name}"' for name in sorted(columns)[::-1])
        advice = f"write reverse = [{names}]" if names else "leave reverse out"
        raise DataError(
            f"{' and '.join(sorted(columns ^ reverse)[::-1])} with the opposite sign"
            f"{'' if along in opposite else f', or {along} alone'}: {along} must grow towards the sample, and F be "
            f"positive in compression; {advice}"
        )


def in_time(
    along: str, z: Array, F: Array, kinds: Kinds | None, beside_each_other: bool, least: int = 5
) -> tuple[NDArray[np.intp], Kinds]:
    """Return (indices of the points in the order of time, index in `SEGMENTS` of each then), (n,) each.

    Without `kinds` the turn is the hold, else at the largest position; a turn within `least` points of an end leaves
    one segment. A hold within given segments becomes one of its own.

    Args:
        along: name of the column of the positions.
        z, F: positions, rising towards the sample, and forces, (n,).
        kinds: index in `SEGMENTS` of each point, (n,); None where the file has none.
        beside_each_other: whether segments were side by side: then one may be in the opposite order.
        least: number of points after or before the turn of a curve that are no segment.

    Raises:
        DataError: positions fall on the approach or rise on the retraction.
    """
    order, hold = np.arange(z.size), hold_in(z, F)
    if kinds is None:
        turn = int(np.argmax(z)) + 1
        kinds = np.where(order < (z.size if turn > z.size - least else turn if turn > least else 0), FIRST, LAST)
    for kind in np.intersect1d(kinds, [FIRST, LAST]):
        points = order[kinds == kind]
        distance = (1 - kind) * float(z[points[-1]] - z[points[0]])
        if beside_each_other and distance < 0.0:
            order[points] = points[::-1]
        elif distance < 0.5 * np.ptp(z[points]):
            raise DataError(
                f"{along} {'rises' if kind else 'falls'} in the segment {SEGMENTS[kind]}: the lines of the approach "
                "must come first, and a column segment name them so"
            )
    if hold.start and PAUSE not in kinds and FIRST not in kinds[hold.stop :]:
        kinds = np.where(order < hold.start, FIRST, np.where(order < hold.stop, PAUSE, LAST))
    return order, kinds


def averaged(curve: ForceCurve, most: int = 20_000) -> ForceCurve:
    """Return a curve of about `most` points at most: means of equal groups of neighbours within each segment.

    A fit of so many takes some seconds, and they are every few nanometres in any experiment. The line of a group is
    that of its first point.
    """
    count = curve.positions.size
    starts = np.concatenate([curve.of(name)[:: -(-count // most)] for name in SEGMENTS])
    sizes = np.diff([*starts, count])
    z, F = (np.add.reduceat(x, starts) / sizes for x in (curve.positions, curve.forces))
    t = None if curve.times is None else np.add.reduceat(curve.times, starts) / sizes
    return ForceCurve(z, F, curve.kinds[starts], curve.lines[starts], t)


def require_whole(curve: ForceCurve, along: str, fewest: int = 6, gap: float = 8.0) -> None:
    """Check that a force is not cut at an end of its range, and that positions have no gaps; nothing is returned.

    Equal forces at an end are no cut in a hold, or where the force comes near them gradually, as at a smooth minimum.

    Args:
        curve: as it was read.
        along: the column of its positions, for the message.
        fewest: number of points of equal force, within 1e-4 of the range, at an end of it that are no measurement,
            unless that end is the baseline.
        gap: distance of neighbouring positions over its median that is a gap, where it also exceeds a tenth of the
            range of positions.

    Raises:
        DataError: with the number of points, or the line before the gap.
    """
    F = curve.forces[curve.kinds != PAUSE]
    span, steps = float(np.ptp(F)), np.abs(np.diff(F))
    digit = float(np.min(steps, where=steps > 0.0, initial=span))
    for sign, name in ((1.0, "largest"), (-1.0, "least")):
        flat = _flat_top(sign * F, 1e-4 * span + digit)
        if flat.size >= fewest and abs(F[flat].mean() - curve.baseline) > 0.05 * span:
            raise DataError(
                f"the force is saturated: {flat.size} points have its {name} value; lower the trigger force or the "
                "gain, or leave these lines out; if the load was held, write hold for them in a column segment"
            )
    for points in (segment.points for segment in curve.segments):
        distances = np.abs(np.diff(curve.positions[points]))
        widest = int(np.argmax(distances))
        if distances[widest] > max(gap * float(np.median(distances)), 0.1 * curve.depth):
            line = curve.lines[points][widest]
            raise DataError(
                f"has a gap in {along} after line {line}: give the points between, or the curve up to there"
            )
