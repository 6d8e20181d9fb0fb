"""The place of a minimum against the same choices made slowly, by numpy's fits, finite differences and plain loops.

What is chosen, and why, is told in `analysis.extremum`; here each quantity is worked out in another way: a highest
divided difference is the leading coefficient of a fit, noise is counted by `np.diff`, a shift by noise is what a unit
of each sample moves.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.typing import NDArray
from scipy.special import binom
from scipy.stats import norm

from contact1d.analysis.extremum import (
    Stencil,
    _fitted,
    _interpolated,
    _is_smooth,
    _minimum,
    _misfit,
    _noise,
    _smoothest,
    place_of_minimum,
)

Array = NDArray[np.float64]
FITS = 1e-5
"""Of a spacing and of a claim: fits of degree 20, and the quantile of a normal law in four digits."""
SPACING, FAR = 0.25, 40.0


def lowest(x: Array, y: Array, degree: int, low: float, high: float) -> tuple[float, float]:
    """Place of the lowest minimum of a fit between two places, and the norm of what a unit of each sample moves it."""
    law = Polynomial.fit(x, y / np.abs(y).max(), degree)
    slope = law.deriv()
    level = [root.real for root in slope.roots() if abs(root.imag) < 1e-9 * np.ptp(x) and low <= root.real <= high]
    places = [place for place in level if slope.deriv()(place) > 0.0]
    if not places:
        return math.nan, math.nan
    place = min(places, key=law)
    pushes = [Polynomial.fit(x, unit, degree).deriv()(place) for unit in np.eye(x.size)]
    return place, float(np.linalg.norm(pushes)) / slope.deriv()(place) / float(np.abs(y).max())


def noise_of(y: Array, index: int) -> float:
    near = y[max(0, index - 20) : index + 21]
    middle = norm.ppf(0.75)
    orders = range(2, min(12, near.size - 1) + 1)
    return min((np.median(np.abs(np.diff(near, n))) / middle / math.sqrt(binom(2 * n, n)) for n in orders), default=0.0)


def smoothest(x: Array, y: Array, index: int, size: int) -> list[int]:
    """Where the rows of so many samples begin, by their leading coefficients; three times as much for each aside."""
    costs = {}
    for low in range(x.size - size + 1):
        if low <= index < low + size:
            t = (x[low : low + size] - x[index]) / np.ptp(x)
            leading = np.linalg.solve(np.vander(t), y[low : low + size])[0]
            costs[low] = abs(leading) * 3.0 ** abs(low + size // 2 - index)
    return sorted(costs, key=lambda low: costs[low])


def is_smooth(x: Array, y: Array, index: int, noise: float) -> bool:
    """Differences of even order, over that of a sawtooth of height 1, fall to 0.6 of those before, or are noise."""
    near = slice(max(0, index - 10), index + 11)
    t = (x[near] - x[index]) / np.diff(x[near]).mean()
    before = math.inf
    for order in (2, 4, 6, 8):
        fits = [
            np.linalg.solve(np.vander(t[i : i + order + 1]), y[near][i : i + order + 1])[0]
            for i in range(t.size - order)
        ]
        rough = np.abs(fits).max() * math.factorial(order) / binom(order, order // 2)
        if rough > 0.6 * before and rough > 2.0 * noise:
            return False
        before = rough
    return True


def converging(x: Array, y: Array, index: int, noise: float) -> tuple[float, float] | None:
    room = min(index, x.size - 1 - index)
    if room < 5 or not is_smooth(x, y, index, noise):
        return None
    rows = []
    for beside in (b for b in (3, 5, 10) if b <= room):
        near = slice(index - beside, index + beside + 1)
        rows.append(lowest(x[near], y[near], 2 * beside, x[index - 1], x[index + 1]))
    best, change = None, 0.0
    for (old, _), (place, shift) in pairwise(rows):
        if math.isnan(old + place):
            break
        change = max(abs(place - old), 0.2 * change)
        claim = 2.0 * change + 2.0 * noise * shift
        if best is not None and claim >= best[1]:
            break
        best = place, claim
    return best


def interpolated(x: Array, y: Array, index: int, noise: float) -> tuple[float, float]:
    low, high = x[index - 1], x[index + 1]
    several = []
    for size in (min(7, x.size), min(5, x.size)):
        several.append([
            lowest(x[i : i + size], y[i : i + size], size - 1, low, high) for i in smoothest(x, y, index, size)[:2]
        ])  # fmt: skip
    (place, shift), *others = several[0][0], several[1][0], *several[0][1:]
    if math.isnan(place):
        left, right = abs(y[index - 1] - y[index]), abs(y[index + 1] - y[index])
        return float(0.5 * (x[index] + (x[index + 1] if right > left else x[index - 1]))), 0.5 * (high - low)
    apart = max(high - low if math.isnan(other) else abs(place - other) for other, _ in others)
    shoulder = min(y[:index].max(), y[index + 1 :].max()) - y[index]
    steep = min(1.0, (max(y[index - 1], y[index + 1]) - y[index]) / shoulder) if shoulder > 0.0 else 1.0
    farther = max(high - place, place - low)
    return place, max(apart + 2.0 * noise * shift, min(steep * (high - low), farther))


def misfit(x: Array, y: Array, degree: int) -> float:
    return math.sqrt(np.sum((Polynomial.fit(x, y, degree)(x) - y) ** 2) / max(1, x.size - degree - 1))


def fitted(x: Array, y: Array, first: int, last: int, noise: float) -> tuple[float, float]:
    beside = max(2, (last - first + 1) // 2)
    windows = []
    for left in (0, beside, 2 * beside):
        windows.append(slice(max(0, first - left), min(x.size, last + 1 + 2 * beside - left)))
    misfits = [misfit(x[window], y[window], 4) for window in windows]
    best = windows[int(np.argmin(misfits))]
    (place, shift), (other, _) = (lowest(x[best], y[best], degree, x[first], x[last]) for degree in (4, 3))
    extent = x[last] - x[first]
    if math.isnan(place):
        return 0.5 * (x[first] + x[last]), 0.5 * extent
    apart = 0.5 * extent if math.isnan(other) else abs(place - other)
    return place, max(apart + 2.0 * noise * shift, extent if min(misfits) > 2.0 * noise else 0.0)


def slowly(x: Array, y: Array, candidates: NDArray[np.intp]) -> tuple[float, float, bool]:
    """(place, claim, whether it is at an end)."""
    index = int(min(candidates, key=lambda i: y[i]))
    end = x.size - 1
    if index in (0, end):
        return float(x[index]), (x[-1] - x[0]) / end, True
    noise = noise_of(y, index)
    likely = [int(i) for i in candidates if y[i] <= y[index] + 5.0 * noise]
    first, last = likely[0], likely[-1]
    if last - first <= 3:
        place, claim = converging(x, y, index, noise) or interpolated(x, y, index, noise)
    else:
        place, claim = fitted(x, y, first, last, noise)
    beyond = (first > 0 and first == candidates[0]) or (last < end and last == candidates[-1])
    extent = x[last] - x[first]
    least = extent if beyond else 0.25 * extent if last - first >= 2 else 0.0
    return place, max(claim, least), first == 0 or last == end


def rows(seed: int) -> Iterator[tuple[Array, Array]]:
    """Dips of any width, place and unevenness: smooth, noisy, in steps, cut off, with a jump; long and short."""
    random = np.random.default_rng(seed)
    for number in range(30):
        count = int(random.integers(3, 50)) if number % 3 else int(random.integers(3, 12))
        t = np.arange(count) - random.uniform(0.0, count - 1.0)
        t = t + (number % 2) * random.uniform(-0.2, 0.2, count)
        width = np.exp(random.uniform(math.log(0.4), math.log(12.0)))
        y = -1.0 / np.cosh(t / width) + random.uniform(-0.03, 0.03) * t
        kind = number % 5
        if kind == 1:
            y = y + 10.0 ** random.uniform(-6.0, -1.0) * random.normal(size=count)
        elif kind == 2:
            y = y + random.uniform(0.1, 1.0) * (t > random.uniform(-1.5, 1.5))
        elif kind == 3:
            y = np.maximum(y, -random.uniform(0.3, 0.95)) + 1e-3 * random.normal(size=count)
        elif kind == 4:
            y = np.round(16.0 * y) / 16.0 + 1e-5 * random.normal(size=count)
        yield FAR + SPACING * t, y


@pytest.mark.parametrize("seed", range(12))
def test_the_place_of_a_minimum_and_its_claim_are_those_of_the_same_choices_made_slowly(seed: int) -> None:
    random = np.random.default_rng(100 + seed)
    for x, y in rows(seed):
        ends = np.sort(random.choice(x.size + 1, 2, replace=False)) if random.uniform() < 0.4 else (0, x.size)
        candidates = np.arange(*ends)
        place, claim, at_end = slowly(x, y, candidates)
        found = place_of_minimum(x, y, candidates)
        assert found.position == pytest.approx(place, abs=FITS * SPACING)
        assert found.uncertainty == pytest.approx(claim, rel=2.0 * FITS, abs=FITS * SPACING)
        assert found.at_end == at_end


SEEDS = pytest.mark.parametrize("seed", [10, 11])


@SEEDS
def test_noise_is_that_of_the_differences_that_see_least_signal(seed: int) -> None:
    for x, y in rows(seed):
        for index in (1, x.size // 2, x.size - 2):
            assert _noise(y, index) == pytest.approx(noise_of(y, index), rel=2.0 * FITS, abs=1e-12)


@SEEDS
def test_of_all_rows_about_a_sample_the_smoothest_come_first(seed: int) -> None:
    random = np.random.default_rng(200 + seed)
    for x, y in rows(seed):
        index = int(random.integers(1, x.size - 1))
        for size in {3, 5, 7} & {*range(x.size + 1)}:
            chosen = _smoothest(x, y, index, size)
            assert [stencil.low for stencil in chosen] == smoothest(x, y, index, size)
            assert {(stencil.size, stencil.degree) for stencil in chosen} == {(size, size - 1)}


@SEEDS
def test_samples_are_smooth_where_differences_of_even_order_fall_or_are_noise(seed: int) -> None:
    random, told = np.random.default_rng(300 + seed), set[bool]()
    for x, y in rows(seed):
        if x.size > 11:
            index = int(random.integers(5, x.size - 5))
            for doubt in (0.0, 1e-4, 0.01, 0.1):
                told.add(_is_smooth(x, y, index, doubt))
                assert _is_smooth(x, y, index, doubt) == is_smooth(x, y, index, doubt)
    assert told == {True, False}


@SEEDS
def test_a_flat_part_has_the_minimum_of_the_quartic_that_fits_best(seed: int) -> None:
    random = np.random.default_rng(400 + seed)
    for x, y in rows(seed):
        if x.size > 5:
            first = int(random.integers(0, x.size - 4))
            last = int(random.integers(first + 4, min(x.size, first + 12)))
            for noise in (0.0, 0.01):
                found = _fitted(x, y, first, last, noise)
                assert (found.position, found.uncertainty) == pytest.approx(fitted(x, y, first, last, noise), rel=FITS)


@SEEDS
def test_a_dip_is_where_the_smoothest_samples_say_and_as_uncertain_as_others_differ(seed: int) -> None:
    random = np.random.default_rng(500 + seed)
    for x, y in rows(seed):
        index = int(random.integers(1, x.size - 1)) if random.uniform() < 0.5 else int(np.argmin(y[1:-1])) + 1
        found = _interpolated(x, y, index, 0.01)
        assert not found.at_end
        assert (found.position, found.uncertainty) == pytest.approx(interpolated(x, y, index, 0.01), rel=FITS)


@pytest.mark.parametrize("unit", [2.0**-12, 1.0, 2.0**12])
def test_a_fit_leaves_the_same_in_any_unit_of_length_and_its_minimum_moves_by_as_much_as_each_sample_does(
    unit: float,
) -> None:
    random = np.random.default_rng(9)
    for _ in range(40):
        count = int(random.integers(6, 20))
        x = np.cumsum(random.uniform(0.5, 1.5, count))
        y = (x - x.mean()) ** 2 * (1.0 + 0.02 * x) + 0.2 * random.normal(size=count) + 5.0
        window = Stencil(int(random.integers(0, count - 5)), 5, int(random.integers(2, 5)))
        inside = slice(window.low, window.low + 5)
        expected = misfit(x[inside], y[inside], window.degree)
        assert _misfit(unit * x, y, window) == pytest.approx(expected, abs=1e-8)
        whole = Stencil(0, count, 4)
        place, shift = lowest(x, y, 4, x[0], x[-1])
        found = _minimum(unit * x, y, whole, unit * x[0], unit * x[-1])
        assert found == pytest.approx((unit * place, unit * shift), rel=FITS, nan_ok=True)
        if not math.isnan(place):
            near = _minimum(unit * x, y, whole, unit * x[0], unit * x[-1], unit * (place + 0.01))
            assert near == pytest.approx(found, rel=FITS)
