"""Claim: pressure and shear of a line load are exact for what its cubics meet exactly, and of third order for others.

References: Sneddon's and Mindlin's closed forms, and quadrature of the line load's slope (`validation.references.mdr`).
"""

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

from contact1d.analysis.abel import FEWEST, LineLoad, line_load
from contact1d.analysis.shear import kinks_of, shear_load
from validation.references.mdr import ReducedContact
from validation.references.mindlin import mindlin_shear

Array = NDArray[np.float64]
LOGARITHM = 1e-11
"""Of a cone's, which grows towards the axis."""
RATE = 0.4
"""Of the exponent: the edge lies anywhere between two places, so that the constant varies along a ladder."""
POWERS = 1e-9
"""Relative: a cubic in powers of x, a hundred spacings from the axis, loses (x/h)³ of round-off."""
E = 0.7
A, MU, PEAK = 20.0, 0.3, 2.0
"""a, μ, p0; the line load of Hertz's pressure p0 √(1 − r²/a²) is (π/2) p0 (a² − x²)/a."""
R = np.linspace(0.0, 0.999 * A, 300)
EXACT = 1e-10 * MU * PEAK
"""Of the shear: zones of a parabola are parabolas, which splines have exactly."""


def places(count: int, spacing: float = 1.0) -> Array:
    return spacing * (np.arange(count) - 0.5 * (count - 1))


def radii(edge: float) -> Array:
    """From the axis to near the edge, where a root or a pole is steepest."""
    return edge * np.concatenate([np.linspace(0.0, 0.99, 34), [0.999, 0.99999]])


@pytest.mark.parametrize("count", [12, 41])
def test_cone(count: int) -> None:
    x, a, slope = places(count), 0.4 * count, 0.1
    found = line_load(x, np.maximum(0.0, 0.5 * math.pi * E * slope * (a - np.abs(x))), a, apex=True)
    r = radii(a)[1:]
    assert found.pressure(r) == pytest.approx(0.5 * E * slope * np.arccosh(a / r), rel=LOGARITHM)
    assert found.has_apex
    assert found.pressure(0.0) == math.inf


@pytest.mark.parametrize("count", [6, 41, 200])
def test_flat_punch_ends_in_a_pole(count: int) -> None:
    x, a = places(count), 0.5 * count
    found = line_load(x, np.full(count, 2.0), a, jump=None)
    r = radii(a)
    assert found.pressure(r) == pytest.approx(2.0 / (math.pi * np.sqrt(a**2 - r**2)), rel=POWERS)


def test_fourth_power_converges_with_the_third_order() -> None:
    """q = a⁴ − x⁴: p = (4/π) √(a² − r²) (r² + (a² − r²)/3)."""
    a, worst = 1.0, []
    counts = np.array([20, 40, 80, 160, 320])
    for count in counts:
        x = places(int(count), 2.3 / count)
        r = np.linspace(0.0, 0.9, 40)
        s2 = a**2 - r**2
        exact = 4.0 / math.pi * np.sqrt(s2) * (r**2 + s2 / 3.0)
        found = line_load(x, np.maximum(0.0, a**4 - x**4), a).pressure(r)
        worst.append(float(np.abs(found - exact).max() / exact.max()))
    assert worst[1] < 1e-3
    rate = -float(np.polyfit(np.log(counts), np.log(worst), 1)[0])
    assert rate == pytest.approx(3.0, abs=RATE)


def test_what_is_no_line_load_is_refused() -> None:
    few = 2 * FEWEST - 2
    for x, q, words in (
        (places(few), np.ones(few), "needs 3 positions on each side"), (places(10), np.ones(9), "equally long"),
        (places(12) + 3e-6, np.ones(12), "the same on both sides"),
        (places(12) + np.where(np.arange(12) == 8, 1e-3, 0.0), np.ones(12), "the same on both sides"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=words):
            line_load(x, q, 3.0, jump=None)
    with pytest.raises(ValueError, match="3 positions on each side"):
        shear_load(places(10), np.ones(10), 1.2)


def test_the_pressure_of_any_cubics_is_that_of_quadrature() -> None:
    """−(1/π) ∫ q′(r cosh t) dt from piece to piece, and the pole of the jump; also on a break and on the axis."""
    random = np.random.default_rng(2)
    for pieces in (1, 2, 5):
        breaks = np.append(0.0, np.cumsum(random.uniform(0.3, 1.0, pieces)))
        load = LineLoad(breaks, random.normal(size=(4, pieces)))
        load.coefficients[1, 0] = 0.0
        slopes = [np.polynomial.Polynomial(column).deriv() for column in load.coefficients.T]
        for r in (*breaks[1:-1], *random.uniform(0.01, breaks[-1], 4), 0.0):
            total = 0.0
            for low, high, slope in zip(breaks, breaks[1:], slopes, strict=False):
                if r == 0.0:
                    total += quad(lambda x, s=slope: s(x) / x, max(low, 1e-300), high)[0]
                elif high > r:
                    ends = math.acosh(max(low, r) / r), math.acosh(high / r)
                    total += quad(lambda t, s=slope, r=r: s(r * math.cosh(t)), *ends)[0]
            exact = (load.at_edge / math.sqrt(breaks[-1] ** 2 - r**2) - total) / math.pi
            assert float(load.pressure(r)) == pytest.approx(exact, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("particles", [6, 40])
@pytest.mark.parametrize("exponent", [1.05, 1.5, 2.4])
def test_springs_of_a_known_shape_have_its_pressure_whatever_their_number(exponent: float, particles: int) -> None:
    """z = rⁿ/2: p(r) by quadrature; on the axis (E*/π) n g(a)/(n − 1)a, which polynomials in x miss for n < 2."""
    exact = ReducedContact(lambda r: 0.5 * exponent * r ** (exponent - 1.0), E)
    x = np.arange(-particles - 2, particles + 3) / particles
    rise, depth = exact.profile(1.0), exact.displacement(1.0)
    load = E * np.maximum(0.0, depth - rise * np.abs(x) ** exponent)
    found = line_load(x, load, 1.0, body=lambda x: E * rise * x**exponent)
    r = np.asarray([0.01, 0.3, 0.9])
    assert found.pressure(r) == pytest.approx([exact.pressure(at, 1.0) for at in r.tolist()], rel=1e-8)
    assert found.pressure(0.0) == pytest.approx(E / math.pi * exponent / (exponent - 1.0) * rise, rel=1e-8)


def line(edge: float, x: Array) -> Array:
    return MU * 0.5 * math.pi * PEAK * np.maximum(edge**2 - x**2, 0.0) / A


@pytest.mark.parametrize("count", [46, 47])
@pytest.mark.parametrize("stick", [0.0, 5.2, 10.5, 11.0])
def test_the_shear_on_the_way_out_is_mindlins(count: int, stick: float) -> None:
    """What differs between both sides cancels, and a kink without places on both sides is left out."""
    x = places(count)
    values, kinks = line(A, x) - line(stick, x) + 0.1 * np.tanh(x), [0.7, stick, 18.4] if stick else []
    found = shear_load(x, values, A, kinks).pressure(R)
    assert found == pytest.approx(mindlin_shear(R, A, max(stick, 1e-300), MU, PEAK), abs=EXACT)


def test_the_shear_after_a_turn_is_that_of_the_way_out_less_twice_a_smaller_one() -> None:
    """Two kinks: at the new edge of what sticks, and at the old one inside."""
    x, old, new = places(60), 7.3, 13.4
    values = line(A, x) - line(old, x) - 2.0 * (line(A, x) - line(new, x))
    found = shear_load(x, values, A, [old, new]).pressure(R)
    expected = mindlin_shear(R, A, old, MU, PEAK) - 2.0 * mindlin_shear(R, A, new, MU, PEAK)
    assert found == pytest.approx(expected, abs=EXACT)


@pytest.mark.parametrize(
    ("stick", "contact", "kinks"),
    [
        (
            [20.0, 15.0, 10.0, 19.0, 14.0, 9.0, 20.0, 12.0], [20.0] * 8,
            [[], [15.0], [10.0], [10.0, 19.0], [10.0, 14.0], [9.0], [9.0], [9.0, 12.0]],
        ),
        ([9e-6, 4e-6, 7e-6, 4e-6, 4e-6], [9e-6] * 5, [[], [4e-6], [4e-6, 7e-6], [4e-6], [4e-6]]),
        ([0.0, 4.0, 5.0, 5.0], [3.0, 6.0, 8.0, 5.0], [[], [3.0, 4.0], [3.0, 4.0, 5.0], [3.0, 4.0]]),
    ],
)  # fmt: skip
def test_kinks_stay_where_the_zone_that_sticks_grows_and_go_where_it_comes_back(
    stick: list[float], contact: list[float], kinks: list[list[float]]
) -> None:
    assert kinks_of(stick, contact) == kinks
