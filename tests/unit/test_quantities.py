"""Quantities calculate, are written with prefixes, and texts with units of the model become SI."""

import math

import pint
import pytest

from contact1d import Quantity
from contact1d.workflow.units import UNKNOWN, Scales

FORCE, RADIUS = Quantity(1e-3, 1e-5, "N"), Quantity(1e-4, 1e-7, "m")
SCALES = Scales(2e-9, 3e-6, mass=1e-18)


def test_a_mean_pressure_has_the_unit_of_its_formula_and_the_sum_of_both_uncertainties() -> None:
    pressure = FORCE / (math.pi * RADIUS**2)
    assert pressure.unit == "Pa"
    assert pressure.value == pytest.approx(1e-3 / (math.pi * 1e-8), rel=1e-12)
    assert pressure.uncertainty / pressure.value == pytest.approx(0.01 + 2 * 0.001, rel=2e-3)  # to first order
    assert str(pressure.to("kPa")) == "31.83 ± 0.38 kPa"


@pytest.mark.parametrize(
    ("found", "unit", "value"),
    [
        (FORCE * RADIUS, "J", 1e-7), (2 * FORCE + FORCE, "N", 3e-3), (FORCE - FORCE, "N", 0.0),
        (FORCE / FORCE, "1", 1.0), (1 / RADIUS, "1/m", 1e4), (RADIUS**3, "m³", 1e-12),
        (Quantity(3.0, 0.0, "FU·LU") / Quantity(1.5, 0.0, "LU"), "FU", 2.0),
    ],
)  # fmt: skip
def test_units_follow_from_the_operation(found: Quantity, unit: str, value: float) -> None:
    assert (found.unit, found.value) == (unit, pytest.approx(value, rel=1e-12, abs=1e-18))


def test_a_force_and_a_length_have_no_sum() -> None:
    with pytest.raises(pint.DimensionalityError):
        FORCE + RADIUS
    with pytest.raises(pint.DimensionalityError):
        FORCE.to("m")


@pytest.mark.parametrize(
    ("quantity", "text"),
    [
        (Quantity(2.74e-7, 1.6e-9, "J"), "274.0 ± 1.6 nJ"), (Quantity(1.4834, 2.9e-5, "FU"), "1.483400 ± 0.000029 FU"),
        (Quantity(10.0, 0.0, "N"), "10 N"),
        (Quantity(-1e-26, 5.3e-22, "J"), "0 ± 530 yJ"), (Quantity(0.0, 1e-14, "FU"), "(0.0 ± 1.0)e-14 FU"),
        (Quantity(1e13, 2e9, "FU"), "(1.00000 ± 0.00020)e+13 FU"), (Quantity(12345.0, 120.0, "LU"), "12340 ± 120 LU"),
        (Quantity(0.3, 0.01, "1"), "0.300 ± 0.010"),
    ],
)  # fmt: skip
def test_a_quantity_is_written_with_a_prefix_and_two_digits_of_its_uncertainty(quantity: Quantity, text: str) -> None:
    assert str(quantity) == text


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("-3e-4 FU is never reached: about 2 FU", "-900 pN is never reached: about 6 µN"),
        ("must be greater than 5.00021 (LU) here, not 5 LU", "must be greater than 10.0004 nm here, not 10 nm"),
        ("must be greater than 0 (LU)", "must be greater than 0 (m)"),
        ("give a force (FU) or 2.5 FU/LU", "give a force (N) or 3.75 kN/m"),
        ("in 30 LUmps of 5 FULL", "in 30 LUmps of 5 FULL"),
    ],
)
def test_numbers_of_the_model_in_a_message_become_si(text: str, shown: str) -> None:
    assert SCALES.in_words(text) == shown
    assert UNKNOWN.in_words(text) == text
