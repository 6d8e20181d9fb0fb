"""Figures of the body, and units of SI at the axes of any figure."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from contact1d import Run, run
from contact1d.analysis.figures import body_pressure_figure
from contact1d.analysis.plots import in_si, new_figure
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.units import Scales, scale_of

SCALES = Scales(2e-9, 3e-6)
FORMATS = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}
"""How a file of each format begins."""


def test_axes_words_and_ticks_are_in_si() -> None:
    figure = new_figure((4.0, 3.0))
    axis = figure.subplots()
    axis.plot([0.0, 40.0], [0.0, 5.0])
    axis.set_xlabel("displacement (LU), compression positive")
    axis.set_ylabel("pressure (FU/LU²)")
    axis.set_title("a = 15 LU, F = 2e-05 FU", loc="left")
    in_si(figure, SCALES)
    assert axis.get_xlabel() == "displacement (nm), compression positive"
    assert axis.get_ylabel() == "pressure (TPa)"
    assert axis.get_title(loc="left") == "a = 30 nm, F = 60 pN"
    figure.draw_without_rendering()
    labels = [float(text.get_text().replace("\N{MINUS SIGN}", "-")) for text in axis.get_xticklabels()]
    assert labels == pytest.approx([2.0 * place for place in axis.get_xticks()])
    line = axis.get_lines()[0]
    assert list(line.get_xdata()) == [0.0, 40.0]


def test_axes_without_a_unit_stay_as_they_are() -> None:
    figure = new_figure((4.0, 3.0))
    axis = figure.subplots()
    axis.set_xlabel(r"contact radius $a/a_0$")
    in_si(figure, SCALES)
    assert axis.get_xlabel() == r"contact radius $a/a_0$"


@pytest.mark.parametrize(
    ("value", "unit", "written"),
    [(1.1e-4, "m", (1e6, "µm")), (1e-9, "m", (1e9, "nm")), (2.6e8, "Pa", (1e-6, "MPa")), (0.0, "N", (1.0, "N")),
     (3e-16, "J", (1e18, "aJ")), (-2e-3, "N", (1e3, "mN")), (1e40, "N", (1.0, "N")), (1000.0, "N", (1e-3, "kN"))],
)  # fmt: skip
def test_a_number_is_written_with_the_prefix_of_its_size(value: float, unit: str, written: tuple[float, str]) -> None:
    factor, name = scale_of(value, unit)
    assert (pytest.approx(factor, rel=1e-12), name) == written


def test_a_pressure_without_bound_does_not_hide_the_rest() -> None:
    r = np.linspace(0.0, 0.999, 200)
    figure = body_pressure_figure({"final": (r, 1.0 / np.sqrt(1.0 - r**2), 0.0 * r, 1.0)}, {})
    assert figure.axes[0].get_ylim()[1] < 10.0
    assert figure.axes[0].get_xlim()[1] >= 1.0


def test_a_pressure_that_is_infinite_on_the_axis_is_drawn_without_it() -> None:
    r = np.linspace(0.0, 0.9, 20)
    with np.errstate(divide="ignore"):
        p = np.arccosh(1.0 / r)
    figure = body_pressure_figure({"final": (r, p, 0.0 * r, 1.0)}, {"final": ("theory", r[1:], p[1:])})
    assert np.isfinite(figure.axes[0].get_lines()[0].get_ydata()).all()
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()][:2] == ["this run", "theory"]


def pressed(folder: Path, form: bool | str) -> Run:
    scene = {
        "title": "Steel on glass",
        "bodies": {"particles": "auto", "spacing": 2.0, "profile": {"kind": "parabola", "radius": 10000.0},
                   "bulk_stiffness": "auto", "lower": "rigid_plane"},
        "material": {"contact_modulus": 55e9, "length_unit": 1e-6, "force_unit": 1.0},
        "experiment": {"kind": "load", "force": 1.0},
    }  # fmt: skip
    return run(scene_from_dict(scene), folder, figures=form)


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
