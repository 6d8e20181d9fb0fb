"""Numbers beside a limit show on which side of it they are, and computed ones have no round-off error in their text."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from contact1d import SceneError, read_scene, run
from contact1d.digits import apart, cleaned
from contact1d.workflow.units import Scales

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


CONTACT: dict[str, Any] = {
    "title": "near a limit",
    "bodies": {"particles": "auto", "spacing": "auto", "bulk_stiffness": "auto", "lower": "rigid_plane"},
    "material": {"contact_modulus": 1.0, "length_unit": 1.0, "force_unit": 1.0},
}
RADIUS, SLOPE, TABOR, ASSUMED = 1.0, 0.10003, 4.998, 0.3e-9


def stated(name: str, **tables: Any) -> list[float]:
    """The numbers in a warning of a run."""
    bodies = CONTACT["bodies"] | {"profile": {"kind": "parabola", "radius": RADIUS}}
    message = run(CONTACT | tables | {"bodies": bodies}).warnings[name]
    return [float(number) for number in re.findall(r"(?<![\w.])\d[\d.]*(?:e[+-]\d+)?(?=[ ,:;])", message)]


def test_a_slope_just_above_its_limit_is_stated_above_it() -> None:
    force = 4.0 / 3.0 * SLOPE**3 * RADIUS**2  # Hertz: F = 4 E* a³/3R, and the slope is a/R
    tables = {"experiment": {"kind": "load", "force": force}, "accuracy": {"tolerance": 1e-5}}
    slope, limit = stated("slope", **tables)[:2]
    assert slope == pytest.approx(SLOPE, rel=1e-4)
    assert slope > limit


def test_a_tabor_parameter_just_below_its_limit_is_stated_below_it() -> None:
    work = ((TABOR * ASSUMED) ** 3 / RADIUS) ** 0.5  # µ = (R W²/E*² h₀³)^(1/3)
    pull = {"kind": "pull_off", "preload": work * RADIUS}
    tabor, limit = stated("tabor", experiment=pull, adhesion={"work_of_adhesion": work})[:2]
    assert tabor == pytest.approx(TABOR, rel=1e-3)
    assert tabor < limit


@given(by=st.floats(1e-12, 1e-3))
def test_a_cutoff_just_below_its_limit_is_refused_with_a_limit_above_it(by: float) -> None:
    law = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}
    least = math.log(4.0) * 0.26  # r₀ = ln(A b/(B a)) a b/(b − a)
    cutoff = least * (1.0 - by)
    bodies = {"particles": 20, "spacing": 1.0, "bulk_stiffness": 0.83, "profile": {"kind": "parabola", "radius": 9.0}}
    experiment = {"kind": "load", "force": 1.0}
    scene = {"title": "near", "bodies": bodies, "interaction": law | {"cutoff": cutoff}, "experiment": experiment}
    with pytest.raises(SceneError, match=r"the force-free distance, ([\d.]+) \(LU\)") as caught:
        read_scene(scene)
    (limit,) = re.findall(r"distance, ([\d.]+)", str(caught.value))
    assert cutoff < float(limit) == pytest.approx(least, rel=1e-5)  # six digits at least


def test_a_text_in_si_keeps_the_digits_that_it_had() -> None:
    words = Scales(1e-9, 1e-6).in_words("the chain is 10.0004 LU wide, and the profile ends at 10 LU")
    assert words == "the chain is 10.0004 nm wide, and the profile ends at 10 nm"
