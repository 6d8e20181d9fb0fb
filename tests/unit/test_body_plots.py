"""Figures of the body, and units of SI, words and ends of the axes of any figure."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, read_scene, run
from contact1d.analysis import figures, plots
from contact1d.analysis.chart import Axis, Chart, Panel, Series
from contact1d.workflow.units import Scales, scale_of

SCALES = Scales(2e-9, 3e-6)
FORMATS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}
"""How a file of each format begins."""


def drawn(chart: Chart) -> list[Any]:
    """The panels of a chart with units of SI, as they are drawn."""
    figure = plots.draw(chart.written(SCALES.written, SCALES.in_words))
    figure.draw_without_rendering()
    return list(figure.axes)


def test_axes_words_and_ticks_are_in_si() -> None:
    """What a figure holds are the numbers that its ticks show."""
    line = Series(np.array([0.0, 40.0]), np.array([0.0, 5.0]), "W = 1 FU/LU")
    panel = Panel(Axis("pressure", "FU/LU²"), [line], "a = 15 LU, F = 2e-05 FU")
    (axis,) = drawn(Chart(Axis("displacement", "LU", ", compression positive"), [panel]))
    assert axis.get_xlabel() == "displacement (nm), compression positive"
    assert axis.get_ylabel() == "pressure (TPa)"
    assert axis.get_title(loc="left") == "a = 30 nm, F = 60 pN"
    assert axis.get_legend().get_texts()[0].get_text() == "W = 1.5 kN/m"
    labels = [float(text.get_text().replace("\N{MINUS SIGN}", "-")) for text in axis.get_xticklabels()]
    assert labels == pytest.approx(list(axis.get_xticks()))
    assert list(axis.get_lines()[0].get_xdata()) == pytest.approx([0.0, 80.0])


def test_axes_without_a_unit_stay_as_they_are() -> None:
    panel = Panel(Axis("force $F/F_A$"), [Series(np.ones(2), np.ones(2))])
    (axis,) = drawn(Chart(Axis(r"contact radius $a/a_0$"), [panel]))
    assert axis.get_xlabel() == r"contact radius $a/a_0$"


@pytest.mark.parametrize(("log", "numbers"), [(False, (-3.0, 5.0)), (True, (0.01, 300.0)), (False, (0.5, 0.5 + 1e-13))])
def test_an_axis_ends_around_its_numbers_and_a_line_across_at_its_ends(log: bool, numbers: tuple[float, float]) -> None:
    across = Series(np.array([-np.inf, np.inf]), np.full(2, numbers[0]))
    line = Series(np.array(numbers), np.array(numbers))
    (axis,) = drawn(Chart(Axis("x", log=log), [Panel(Axis("y"), [line, across])]))
    low, high = axis.get_xlim()
    assert low < numbers[0] <= numbers[1] < high
    assert list(axis.get_lines()[1].get_xdata()) == [low, high]


@pytest.mark.parametrize(
    ("value", "unit", "written"),
    [(1.1e-4, "m", (1e6, "µm")), (1e-9, "m", (1e9, "nm")), (2.6e8, "Pa", (1e-6, "MPa")), (0.0, "N", (1.0, "N")),
     (3e-16, "J", (1e18, "aJ")), (-2e-3, "N", (1e3, "mN")), (1e40, "N", (1.0, "N")), (1000.0, "N", (1e-3, "kN"))],
)  # fmt: skip
def test_a_number_is_written_with_the_prefix_of_its_size(value: float, unit: str, written: tuple[float, str]) -> None:
    factor, name = scale_of(value, unit)
    assert (pytest.approx(factor, rel=1e-12), name) == written


def pressure(r: np.ndarray[Any, Any], p: np.ndarray[Any, Any], **theory: figures.Theory) -> Any:
    columns = {"r": r, "pressure": p, "pressure_uncertainty": 0.0 * r}
    (axis,) = drawn(figures.body("pressure", {"final": columns}, {"final": {"contact radius a": 1.0}}, theory))
    return axis


def test_a_pressure_without_bound_does_not_hide_the_rest() -> None:
    r = np.linspace(0.0, 0.999, 200)
    axis = pressure(r, 1.0 / np.sqrt(1.0 - r**2))
    factor = SCALES.written(10.0, "FU/LU²")[0]
    assert axis.get_ylim()[1] < 10.0 * factor
    assert axis.get_xlim()[1] >= 1.0 * SCALES.written(1.0, "LU")[0]


def test_a_pressure_that_is_infinite_on_the_axis_is_drawn_without_it() -> None:
    r = np.linspace(0.0, 0.9, 20)
    with np.errstate(divide="ignore"):
        p = np.arccosh(1.0 / r)
    axis = pressure(r, p, final=("theory", r[1:], p[1:]))
    assert all(np.isfinite(line.get_ydata()).all() for line in axis.get_lines()[:2])
    assert [text.get_text() for text in axis.get_legend().get_texts()][:2] == ["theory", "this run"]


def pressed(folder: Path, form: bool | str) -> Run:
    scene = {
        "title": "Steel on glass",
        "bodies": {"particles": "auto", "spacing": 2.0, "profile": {"kind": "parabola", "radius": 10000.0},
                   "bulk_stiffness": "auto", "lower": "rigid_plane"},
        "material": {"contact_modulus": 55e9, "length_unit": 1e-6, "force_unit": 1.0},
        "experiment": {"kind": "load", "force": 1.0},
    }  # fmt: skip
    return run(read_scene(scene), folder, figures=form)


@pytest.mark.parametrize("form", FORMATS)
def test_figures_come_in_the_format_that_is_asked_for(tmp_path: Path, form: str) -> None:
    """A new run in the same folder takes those of another format away."""
    pressed(tmp_path / "run", "png" if form != "png" else True)
    found = pressed(tmp_path / "run", form)
    figures = {path.name for path in found.folder.iterdir() if path.suffix[1:] in FORMATS}
    assert figures == {f"{name}.{form}" for name in ("force_displacement", "force_radius", "pressure", "pressure_3d")}
    for name in figures:
        assert (found.folder / name).read_bytes().startswith(FORMATS[form])
    figure = found.plot("pressure_3d")
    assert figure.get_suptitle() == "Steel on glass"
    assert figure.axes[0].get_ylabel() == "pressure (MPa)"
    assert math.isclose(found.results.peak_pressure.value, found.body_pressures["final"].pressure[0], rel_tol=1e-9)
