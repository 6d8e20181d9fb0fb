"""Numbers beside a limit show on which side of it they are, and computed ones have no round-off error in their text."""

import math
import re

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from contact1d import SceneError, read_scene, sphere
from contact1d.digits import apart, cleaned
from tests.scenes import chains

numbers = st.floats(allow_nan=False, allow_infinity=False, allow_subnormal=False)


@given(value=numbers, by=st.floats(-1e-3, 1e-3), least=st.integers(1, 6))
def test_two_numbers_as_text_are_in_the_order_of_the_numbers(value: float, by: float, least: int) -> None:
    limit = value * (1.0 + by)
    assume(limit != value)
    one, other = map(float, apart(value, limit, least))
    assert (one > other) == (value > limit)
    assert (one < other) == (value < limit)


def test_numbers_have_no_more_digits_than_it_takes() -> None:
    assert apart(0.3, 0.1) == ("0.3", "0.1")
    assert apart(0.10003, 0.1) == ("0.10003", "0.1")
    assert apart(4.96, 5.0, 2) == ("4.96", "5")
    assert apart(2.0, 2.0) == ("2", "2")


@given(digits=st.integers(1, 10**11), power=st.integers(-20, 20), units=st.integers(-20, 20))
def test_a_number_of_few_digits_is_itself_again(digits: int, power: int, units: int) -> None:
    exact = float(f"{digits}e{power}")
    assert cleaned(exact * (1.0 + units * 2.0**-52)) == exact


def test_a_slope_just_above_its_limit_is_stated_above_it() -> None:
    """Hertz: F = 4 E* a³/3R, and the slope is a/R."""
    slope, radius = 0.10003, 1.0
    ball = sphere(radius, contact_modulus=1.0, tolerance=1e-5)
    message = ball.load(4.0 / 3.0 * slope**3 * radius**2).warnings["slope"]
    stated, limit = map(float, re.findall(r"(?<![\w.])\d[\d.]*(?=[ ,:;])", message)[:2])
    assert stated == pytest.approx(slope, rel=1e-4)
    assert stated > limit


@given(by=st.floats(1e-12, 1e-3))
def test_a_cutoff_just_below_its_limit_is_refused_with_a_limit_above_it(by: float) -> None:
    least = math.log(4.0) * 0.26  # r₀ = ln(A b/(B a)) a b/(b − a)
    cutoff, scene = least * (1.0 - by), chains(9.0, experiment={"kind": "load", "force": 1.0})
    scene["interaction"]["cutoff"] = cutoff
    with pytest.raises(SceneError, match=r"the force-free distance, ([\d.]+) \(LU\)") as caught:
        read_scene(scene)
    (limit,) = re.findall(r"distance, ([\d.]+)", str(caught.value))
    assert cutoff < float(limit) == pytest.approx(least, rel=1e-5)  # six digits at least
