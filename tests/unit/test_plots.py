"""Figures: what is drawn is what was measured, beside theories written out here, in the units that its axes say."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, run
from contact1d.analysis import figures, plots
from contact1d.analysis.chart import Axis, Chart, Panel, Series
from contact1d.workflow.units import Scales, scale_of
from tests.command import contact1d
from tests.pages import figures_on
from tests.scenes import STEEL_ON_GLASS, chains

ROUND_OFF = 1e-12  # relative; closed forms of a few operations
GRID = 2e-3  # of F_A; the theory is drawn with 400 points
SPACING = 1.0
SCALES = Scales(2e-9, 3e-6)
BEGINS = {"png": b"\x89PNG\r\n\x1a\n", "svg": b"<?xml", "pdf": b"%PDF"}
"""How a file of each format begins."""


def drawn(chart: Chart, scales: Scales | None = None) -> list[Any]:
    """The panels of a chart, in units of SI if they are known, as they are drawn."""
    figure = plots.draw(chart.written(scales.written, scales.in_words) if scales else chart.written(scale_of))
    figure.draw_without_rendering()
    return list(figure.axes)


def lines(axis: Any) -> dict[str, np.ndarray]:
    """Points of each line with a label."""
    found = {line.get_label(): np.asarray(line.get_xydata()) for line in axis.get_lines()}
    return {label: points for label, points in found.items() if label and not label.startswith("_")}


@pytest.fixture(scope="module")
def pulled() -> Run:
    pull = {"kind": "pull_off", "preload": 0.2}
    tables = chains(50.0, bodies={"particles": 40}, accuracy={"tolerance": 1e-2}, experiment=pull)
    return run(tables)


def test_the_line_load_is_a_step_for_each_particle_with_the_contact_radius_marked(pulled: Run) -> None:
    radii = {"zero_load": pulled.results.zero_load_radius.value, "critical": pulled.results.critical_radius.value}
    for axis, (state, radius) in zip(pulled.plot("pressure").axes, radii.items(), strict=True):
        name = state.replace("_", " ")
        assert axis.get_title(loc="left").startswith(f"{name} state, contact radius a = {radius:.4g} LU")
        places = {place for line in axis.get_lines() if line.get_linestyle() == "--" for place in line.get_xdata()}
        assert sorted(places) == pytest.approx([-radius, radius])
        compression, tension = ({*map(tuple, np.asarray(part.get_xy()))} for part in axis.patches)
        shown = pulled.profiles[state]
        for x, p in zip(shown.x, shown.pressure, strict=True):
            if abs(p) > 0.01 * np.abs(shown.pressure).max():
                assert {(x - 0.5, p), (x + 0.5, p)} <= (compression if p > 0.0 else tension)
        assert axis.get_ylabel() == "line load (FU/LU)"


def test_jkr_over_displacement_obeys_its_own_equations(pulled: Run) -> None:
    """Two spheres of R: effective radius R/2, radii a/2, E* and W from F_A and a₀ (Johnson, Kendall, Roberts 1971)."""
    tension, effective = pulled.results.adhesion_force.value, 25.0
    radius = pulled.results.zero_load_radius.value / 2.0
    work = tension / (1.5 * math.pi * effective)
    modulus = 4.5 * math.pi * work * effective**2 / radius**3
    a = np.linspace(0.05, 1.3, 400) * radius
    displacement = a**2 / effective - np.sqrt(2.0 * math.pi * a * work / modulus)
    force = 4.0 * modulus * a**3 / (3.0 * effective) - np.sqrt(8.0 * math.pi * modulus * work * a**3)
    drawn = lines(pulled.plot("force_displacement").axes[0])["JKR, same $F_A$ and $a_0$"]
    shown = (displacement >= pulled.curve.displacement.min()) & (drawn[:, 1].max() * (1.0 + ROUND_OFF) >= force)
    np.testing.assert_allclose(drawn, np.column_stack([displacement, force])[shown], atol=ROUND_OFF)
    assert force.min() == pytest.approx(-tension, abs=GRID * tension)


@pytest.mark.parametrize("reduction", ["mdr", "geike_popov"])
def test_hertz_is_the_integral_of_the_springs_under_the_parabola(reduction: str) -> None:
    """∫ c (d − x²/2R₁) dx over |x| < √(2R₁d), with c = k/s; x²/R by the MDR and x²/2R as drawn."""
    bodies = {"lower": "rigid_plane", "spacing": 0.5, "reduction": reduction}
    path = {"kind": "path", "displacements": [0.0, 0.5, 1.0, 2.0]}
    done = run(chains(100.0, 0.8, interaction=None, bodies=bodies, experiment=path))
    half = 50.0 if reduction == "mdr" else 100.0
    d, force = lines(done.plot("force_displacement").axes[0])["Hertz"].T
    expected = 0.8 / 0.5 * 4.0 / 3.0 * np.sqrt(2.0 * half) * d**1.5
    assert d[-1] == pytest.approx(2.0, rel=ROUND_OFF)
    np.testing.assert_allclose(force, expected, rtol=10.0 * ROUND_OFF, atol=ROUND_OFF)
    a, again = lines(done.plot("force_radius").axes[0])["Hertz"].T
    np.testing.assert_allclose(a, np.sqrt(2.0 * half * d), rtol=10.0 * ROUND_OFF)
    np.testing.assert_array_equal(again, force)


def test_force_over_radius_is_normalised_and_leaves_out_what_has_no_radius(pulled: Run) -> None:
    adhesion, zero_load = pulled.results.adhesion_force.value, pulled.results.zero_load_radius.value
    found = lines(pulled.plot("force_radius").axes[0])
    points = found["unloading"][np.isfinite(found["unloading"][:, 0])]
    rows = (pulled.curve.branch == "unloading") & (pulled.curve.contact_radius > 0.0)
    rows = np.flatnonzero(rows)[np.argsort(pulled.curve.contact_radius[rows])]
    np.testing.assert_allclose(points[:, 0] * zero_load, pulled.curve.contact_radius[rows], rtol=ROUND_OFF)
    np.testing.assert_allclose(points[:, 1] * adhesion, pulled.curve.force[rows], rtol=ROUND_OFF)
    assert set(found) == {"loading", "unloading", "JKR"}  # a theory of two dimensions has no place beside a body
    jkr = found["JKR"]
    np.testing.assert_allclose(jkr[:, 1], 4.0 * jkr[:, 0] ** 3 - 4.0 * jkr[:, 0] ** 1.5, atol=ROUND_OFF)
    assert jkr[:, 1].min() == pytest.approx(-1.0, abs=GRID)


HELD = chains(
    200.0, 1.0, title="held", interaction=None, damping={"coefficient": 0.3},
    bodies={"particles": 41, "lower": "rigid_plane", "mass": 1.0},
)  # fmt: skip


@pytest.mark.parametrize("kind", ["force", "displacement"])
def test_a_hold_is_drawn_over_time(kind: str, tmp_path: Path) -> None:
    """What is free over the time of its states; in a whole file and on the page."""
    held = {"force": {"displacement": 0.5}, "displacement": {"force": 4.0}}[kind] | {"kind": "hold", "duration": 5.0}
    plate = {"plate": {"mass": 20.0}} if kind == "displacement" else {}
    done = run(HELD | plate | {"experiment": held}, tmp_path / "run")
    (axis,) = done.plot().axes
    assert axis.get_xlabel() == "time (TU)"
    assert axis.get_ylabel().startswith(kind)
    np.testing.assert_array_equal(lines(axis)["holding"], np.column_stack([done.curve.time, done.curve[kind]]))
    file = (done.folder / f"{kind}_time.png").read_bytes()
    assert file.startswith(BEGINS["png"])
    assert file[-8:-4] == b"IEND"
    assert (done.folder / "force_displacement.png").is_file() == (kind == "displacement")  # it is held otherwise
    page = tmp_path / "r.html"
    assert contact1d("report", done.folder, "--out", page).exit_code == 0
    assert f"{kind.capitalize()} over time" in [chart["title"] for chart in figures_on(page)["charts"]]


def test_the_pull_off_force_is_drawn_across_with_its_uncertainty(pulled: Run) -> None:
    tension = pulled.results.adhesion_force
    (axis,) = pulled.plot("force_displacement").axes
    (across,) = (points for name, points in lines(axis).items() if name.startswith("$F_A$"))
    np.testing.assert_array_equal(across, [[axis.get_xlim()[i], -tension.value] for i in (0, 1)])
    (band,) = axis.patches
    ends = np.asarray(band.get_xy())[:, 1]
    spread = tension.uncertainty
    assert [ends.min(), ends.max()] == pytest.approx([-tension.value - spread, -tension.value + spread], rel=1e-9)


def test_particles_within_the_stick_radius_stick_and_the_others_slip() -> None:
    """Of a loop: at its end c < a. No shear exceeds μp."""
    bodies = {"lower": "rigid_plane", "reduction": "mdr", "bulk_stiffness_tangential": 0.4}
    move = {"kind": "tangential", "normal_force": 40.0, "displacements": [0.0, 0.2, 0.4, 0.2, 0.1]}
    scene = chains(1000.0, 0.5, interaction=None, bodies=bodies, friction={"coefficient": 0.3}, experiment=move)
    done = run(scene)
    radii = {"farthest": done.curve.stick_radius[2], "final": done.results.stick_radius.value}
    assert 0.0 < radii["final"] < done.results.contact_radius.value
    for axis, (state, radius) in zip(done.plot("stick_slip").axes, radii.items(), strict=True):
        assert axis.get_title(loc="left").startswith(f"{state} state, u = ")
        sticks, slips = (
            {place for place, shear in part.get_xy() if shear != 0.0} for part in axis.patches if part.get_label()
        )
        assert max(map(abs, sticks)) == pytest.approx(radius, abs=SPACING)
        assert min(map(abs, slips)) == pytest.approx(radius, abs=SPACING)
        bound = lines(axis)["±μp"]
        shear = max(abs(part.get_xy()[:, 1]).max() for part in axis.patches if part.get_label())
        assert shear <= np.abs(bound[:, 1]).max() * (1.0 + ROUND_OFF)
    marks = [text.get_text() for text in done.plot("shear_3d").axes[-1].get_legend().get_texts()]
    assert f"stick radius c = {done.results.stick_radius.value:.4g} LU" in marks


def test_axes_words_and_ticks_are_in_si() -> None:
    """What a figure holds are the numbers that its ticks show; an axis without a unit stays as it is."""
    line = Series(np.array([0.0, 40.0]), np.array([0.0, 5.0]), "W = 1 FU/LU")
    panels = [
        Panel(Axis("pressure", "FU/LU²"), [line], "a = 15 LU, F = 2e-05 FU"),
        Panel(Axis("force $F/F_A$"), [line]),
    ]
    axis, bare = drawn(Chart(Axis("displacement", "LU", ", compression positive"), panels), SCALES)
    assert bare.get_xlabel() == "displacement (nm), compression positive"
    assert (axis.get_ylabel(), bare.get_ylabel()) == ("pressure (TPa)", "force $F/F_A$")
    assert axis.get_title(loc="left") == "a = 30 nm, F = 60 pN"
    assert axis.get_legend().get_texts()[0].get_text() == "W = 1.5 kN/m"
    labels = [float(text.get_text().replace("\N{MINUS SIGN}", "-")) for text in bare.get_xticklabels()]
    assert labels == pytest.approx(list(bare.get_xticks()))
    assert list(axis.get_lines()[0].get_xdata()) == pytest.approx([0.0, 80.0])


def test_a_pressure_without_bound_does_not_hide_the_rest() -> None:
    """A punch's at its edge."""
    r = np.linspace(0.0, 0.999, 200)
    columns = {"r": r, "pressure": 1.0 / np.sqrt(1.0 - r**2), "pressure_uncertainty": 0.0 * r}
    (axis,) = drawn(figures.body("pressure", {"final": columns}, {"final": {"contact radius a": 1.0}}, {}), SCALES)
    assert axis.get_ylim()[1] < 10.0 * SCALES.written(10.0, "FU/LU²")[0]
    assert axis.get_xlim()[1] >= 1.0 * SCALES.written(1.0, "LU")[0]


def test_figures_come_in_the_format_that_is_asked_for(tmp_path: Path) -> None:
    """A new run in the same folder takes those of another format away; a body's pressure is in SI."""
    for form in ("pdf", "svg"):
        done = run(STEEL_ON_GLASS, tmp_path / "run", figures=form)
        found = {path for path in done.folder.iterdir() if path.suffix[1:] in BEGINS}
        names = ("force_displacement", "force_radius", "pressure", "pressure_3d")
        assert {path.name for path in found} == {f"{name}.{form}" for name in names}
        assert all(path.read_bytes().startswith(BEGINS[form]) for path in found)
    figure = done.plot("pressure_3d")
    assert figure.get_suptitle() == "Steel on glass"
    assert figure.axes[0].get_ylabel() == "pressure (MPa)"
    assert done.results.peak_pressure.value == pytest.approx(done.body_pressures["final"].pressure[0], rel=1e-9)
