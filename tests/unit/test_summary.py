"""What a terminal shows."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.cli.summary import pressure_plot, quantities
from contact1d.workflow.units import Scales, rounded


@pytest.mark.parametrize(
    ("value", "uncertainty", "text"),
    [
        (1.48341, 0.00012, "1.48341 ± 0.00012"),
        (28.7, 1.04, "28.7 ± 1.0"),
        (1234.5, 120.0, "1230 ± 120"),
        (1.0, 0.0, "1 ± 0"),
    ],
)
def test_the_value_has_as_many_places_as_its_uncertainty(value: float, uncertainty: float, text: str) -> None:
    assert rounded(value, uncertainty) == text


def test_only_quantities_are_listed() -> None:
    document = {"adhesion_force": {"value": 2.0, "uncertainty": 0.1, "unit": "FU"}, "status": "done", "timing": {}}
    (line,) = quantities(document)
    assert "adhesion force" in line
    assert line.endswith("2.00 ± 0.10 FU")


def entry(value: float, si: float | None = None) -> dict[str, Any]:
    found: dict[str, Any] = {"value": value, "uncertainty": 0.01 * value, "unit": "LU"}
    return found if si is None else found | {"si": {"value": si, "uncertainty": 0.01 * si, "unit": "m"}}


def test_a_result_stands_in_si_with_the_closed_form_beside_it() -> None:
    said = {"value": 1.0, "unit": "LU", "si": {"value": 1.1e-4, "unit": "m"}, "deviation": 0.00123}
    forms = [{"name": "Hertz", "source": "", "applies": "", "values": {"contact_radius": said}}]
    document = {"reduction": "mdr", "contact_radius": entry(1.0, 1.1e-4), "theory": forms}
    reduction, line = quantities(document)
    assert "mdr" in reduction
    assert "LU" not in line
    assert "110.0 ± 1.1 µm" in line
    assert line.endswith("Hertz 110 µm (+0.12 %)")


def profile(pressure: np.ndarray) -> Profile:
    x = np.linspace(-10.0, 10.0, len(pressure))
    zero = np.zeros_like(x)
    return Profile(x, zero, zero, pressure, zero)


def test_the_plot_shows_compression_above_and_tension_below_the_axis() -> None:
    x = np.linspace(-10.0, 10.0, 81)
    lines = pressure_plot(profile(np.where(np.abs(x) < 4.0, 1.0, -0.5) * (np.abs(x) < 8.0)), 6.0)
    axis = next(i for i, line in enumerate(lines) if "─" in line)
    assert any("█" in line for line in lines[:axis])
    assert any("█" in line for line in lines[axis + 1 :])
    assert next(line for line in lines if "^" in line).count("^") == 2


def test_the_plot_is_in_si_where_units_are_known() -> None:
    x = np.linspace(-10.0, 10.0, 81)
    units = Scales(1e-6, 1e-3)  # 1 FU/LU is 1 kN/m
    lines = pressure_plot(profile(np.where(np.abs(x) < 4.0, 2.0, 0.0)), 3.0, units)
    assert lines[0].split()[0] == "2"
    assert lines[-1].split()[0] == "kN/m"
    assert "µm" in lines[-1]
