"""Claim: what is read off a row of numbers depends on no unit, on no origin of places, and not on left and right.

Units change by powers of two, so that not a bit of the result may differ but its exponent; places shift by whole
numbers on a grid of eighths, and mirror images are the same but for round-off.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import largest_tension, promised, rivals, smooth_crossing, work_of
from contact1d.analysis.extremum import Place, place_of_minimum
from contact1d.analysis.friction import block_means, largest_before, mean_of, slips
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius, held_radius, tensile_radius

Array = NDArray[np.float64]
LENGTH, FORCE = 2.0**-7, 2.0**9
SHIFT = 512.0
ROUND_OFF = 1e-6
"""Of a spacing: a place that far from the origin has lost nine digits of a small difference of heights."""


def dips() -> Iterator[Array]:
    """Rows with one lowest sample: smooth, skewed, narrow, snapped, short, flat at the bottom, and noisy ones."""
    random = np.random.default_rng(5)
    t = np.arange(41.0) - 20.3
    for width in (0.7, 2.0, 6.0):
        yield -1.0 / np.cosh(t / width)
        yield -np.exp(t / width - np.exp(t / width))
        yield -1.0 / np.cosh(t / width) + 1e-3 * random.normal(size=t.size)
        yield np.where(t > 0.0, 0.2, -1.0) * np.exp(-np.abs(t) / (5.0 * width))
    for count in (3, 4, 5, 6, 7, 9, 11):
        yield np.cosh(0.3 * (np.arange(count) - 0.5 * count + 0.2))
    yield (t / 20.0) ** 8 + 1e-3 * random.normal(size=t.size)


def moved(place: Place) -> tuple[float, float, bool]:
    return place.position, place.uncertainty, place.at_end


@pytest.mark.parametrize("y", list(dips()))
def test_the_place_of_a_minimum(y: Array) -> None:
    x, every = np.arange(y.size) / 8.0, np.arange(y.size)
    here = moved(place_of_minimum(x, y, every))
    place, doubt, at_end = moved(place_of_minimum(LENGTH * x, FORCE * y, every))
    assert (place, doubt, at_end) == (LENGTH * here[0], LENGTH * here[1], here[2])
    for other, sign in ((x + SHIFT, 1.0), (-x[::-1], -1.0)):
        values = y if sign > 0.0 else y[::-1]
        place, doubt, at_end = moved(place_of_minimum(other, values, every))
        assert sign * (place - other[0 if sign > 0.0 else -1]) == pytest.approx(here[0], abs=ROUND_OFF / 8.0)
        assert doubt == pytest.approx(here[1], rel=1e-3, abs=ROUND_OFF / 8.0)
        assert at_end == here[2]


def pressures() -> Iterator[tuple[Callable[[Profile], ContactRadius], Array]]:
    """Of contacts under tension, without, and held up to an edge; somewhat askew, few particles and many."""
    for count in (5, 8, 15, 41):
        t = np.arange(count) - 0.5 * count + 0.3
        half = 0.37 * count
        yield tensile_radius, 1.0 - 1.2 * (t / half) ** 2 * np.exp(1.0 - (t / half) ** 4)
        yield compressive_radius, np.maximum(0.0, 1.0 - (t / half) ** 2)
        yield compressive_radius, np.maximum(0.0, 1.0 - np.abs(t / half)) ** 0.5
        yield held_radius, np.where(np.abs(t) < half, 0.7 - (t / half) ** 2, 0.0)
        yield compressive_radius, np.zeros(count)
        yield held_radius, np.zeros(count)


@pytest.mark.parametrize(("radius", "p"), list(pressures()))
def test_the_radius_of_a_contact(radius: Callable[[Profile], ContactRadius], p: Array) -> None:
    def found(x: Array, pressure: Array) -> ContactRadius:
        zero = np.zeros_like(x)
        return radius(Profile(x, zero, zero, pressure, zero))

    x = np.arange(p.size) / 8.0
    here, scaled = found(x, p), found(LENGTH * x, FORCE * p)
    for name in ("value", "uncertainty", "left", "right"):
        assert getattr(scaled, name) == LENGTH * getattr(here, name)
    assert scaled.reaches_end == here.reaches_end
    away, mirrored = found(x + SHIFT, p), found(-x[::-1], p[::-1])
    for other in (away, mirrored):
        assert other.value == pytest.approx(here.value, abs=ROUND_OFF / 8.0)
        assert other.uncertainty == pytest.approx(here.uncertainty, rel=1e-3, abs=ROUND_OFF / 8.0)
        assert other.reaches_end == here.reaches_end
    assert (away.left - SHIFT, away.right - SHIFT) == pytest.approx((here.left, here.right), abs=ROUND_OFF / 8.0)
    assert (-mirrored.right, -mirrored.left) == pytest.approx((here.left, here.right), abs=ROUND_OFF / 8.0)


def curves() -> Iterator[tuple[list[float], list[float]]]:
    """Unloading branches, displacements falling on a grid of eighths: smooth, with a jump, and a sawtooth."""
    random = np.random.default_rng(8)
    d = np.cumsum(random.integers(1, 9, size=40))[::-1] / 8.0
    middle = d[20]
    yield d.tolist(), (-np.exp(-(((d - middle - 0.1) / 5.0) ** 2)) + 0.3).tolist()
    yield d.tolist(), np.where(d > middle, -0.3 + 0.05 * (d - middle), 0.2).tolist()
    yield d.tolist(), (random.uniform(size=40) - 0.5).tolist()


@pytest.mark.parametrize(("d", "force"), list(curves()))
def test_the_marks_of_a_curve(d: list[float], force: list[float]) -> None:
    peak = largest_tension(d, force)
    there = [peak.position + 0.25]
    crossed = smooth_crossing(d, force, 0.0)
    for length, scale, shift in ((LENGTH, FORCE, 0.0), (1.0, 1.0, SHIFT)):
        places, forces = [length * x + shift for x in d], [scale * f for f in force]
        other = largest_tension(places, forces)
        exactly = 0.0 if shift == 0.0 else ROUND_OFF
        assert other.index == peak.index
        assert other.position - shift == pytest.approx(length * peak.position, rel=exactly, abs=exactly)
        assert other.misplaced == pytest.approx(length * peak.misplaced, rel=exactly, abs=exactly)
        for name in ("tension", "uncertainty", "smooth"):
            assert getattr(other, name) == pytest.approx(scale * getattr(peak, name), rel=exactly, abs=exactly)
        told = promised(places, forces, [length * there[0] + shift])
        assert told == pytest.approx(scale * promised(d, force, there), rel=exactly, abs=exactly, nan_ok=True)
        assert smooth_crossing(places, forces, 0.0) - shift == pytest.approx(length * crossed, rel=exactly, abs=exactly)
        expected = {tooth: scale * more for tooth, more in rivals(d, force, peak).items()}
        assert rivals(places, forces, other) == pytest.approx(expected, rel=exactly, abs=exactly)
        back = work_of([*d, *d[::-1][1:]], [*force, *(0.5 * f for f in force[::-1][1:])])
        moved_back = work_of([*places, *places[::-1][1:]], [*forces, *(0.5 * f for f in forces[::-1][1:])])
        assert back is not None
        assert moved_back is not None
        work = length * scale
        assert moved_back.length == length * back.length
        for name in ("area", "uncertainty", "whole"):
            assert getattr(moved_back, name) == pytest.approx(work * getattr(back, name), rel=exactly)


def test_the_means_of_a_slide() -> None:
    """Times, forces and lengths in other units, and a drive to the other side."""
    random = np.random.default_rng(2)
    time = np.arange(2001) / 64.0
    walk = np.cumsum(random.uniform(size=2001)) / 2001.0 * 31.0
    mean = mean_of(block_means(time, walk, 1.5))
    scaled = mean_of(block_means(LENGTH * time, LENGTH * FORCE * walk, LENGTH * 1.5))
    assert (scaled.value, scaled.error, scaled.first) == (FORCE * mean.value, FORCE * mean.error, mean.first)
    place = np.floor(time) + np.clip(20.0 * (time % 1.0) - 19.0, 0.0, 1.0) + 0.25
    here = slips(time, place, 1.0, 1.0)
    there = slips(FORCE * time, LENGTH * place, LENGTH, LENGTH / FORCE)
    other_way = slips(time, -place, 1.0, -1.0)
    assert [(s.time, s.place, s.size) for s in there] == [
        (FORCE * s.time, LENGTH * s.place, LENGTH * s.size) for s in here
    ]
    assert [(s.time, s.place, s.size) for s in other_way] == [(s.time, -s.place, -s.size) for s in here]
    friction = np.sin(time)
    top, missed = largest_before(friction, place, 1.0)
    assert largest_before(FORCE * friction, LENGTH * place + SHIFT, LENGTH) == (FORCE * top, FORCE * missed)
