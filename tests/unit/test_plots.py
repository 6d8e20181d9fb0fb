"""Figures: what is drawn is what was measured, beside theories written out here; every file is whole."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, read_scene, run
from contact1d.analysis import figures, plots
from contact1d.analysis.chart import Axis, Chart
from contact1d.analysis.curve import Columns
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.report.report import report
from contact1d.workflow.units import scale_of
from tests.scenes import chains

ROUND_OFF = 1e-12  # relative; closed forms of a few operations
GRID = 2e-3  # of F_A; the theory is drawn with 400 points
SPACING = 1.0
PNG = b"\x89PNG\r\n\x1a\n"


def profile(depth: float) -> Profile:
    x = np.arange(-60.0, 61.0)
    pressure = depth * np.exp(-(x**2) / 200.0) - 0.02 * np.exp(-((np.abs(x) - 28.0) ** 2) / 50.0)
    return Profile(x, 0.0 * x, 0.0 * x, pressure, 0.0 * x)


@pytest.fixture
def curve() -> Columns:
    down, up = np.linspace(-0.1, 0.3, 30), np.linspace(0.3, -0.3, 40)
    displacement = np.concatenate([down, up])
    radius = np.concatenate([100.0 * np.sqrt(down + 0.1), 60.0 * np.sqrt(up + 0.3)])
    radius[-1] = math.nan
    force = np.concatenate([4.0 * down - 0.5, 5.0 * up])
    branch = np.array(["loading"] * 30 + ["unloading"] * 40)
    return Columns(
        {"displacement": displacement, "force": force, "contact_radius": radius, "branch": branch,
         "contact_radius_uncertainty": np.zeros(70)}
    )  # fmt: skip


LEGS = [("loading", np.arange(30)), ("unloading", np.arange(30, 70))]


def drawn(chart: Chart) -> list[Any]:
    """The panels of a chart, as they are drawn."""
    return list(plots.draw(chart.written(scale_of)).axes)


def lines(axis: Any) -> dict[str, np.ndarray]:
    """Points of each line with a label."""
    found = {line.get_label(): np.asarray(line.get_xydata()) for line in axis.get_lines()}
    return {label: points for label, points in found.items() if label and not label.startswith("_")}


def edges(radius: float) -> ContactRadius:
    return ContactRadius(radius, 0.0, -radius, radius, False)


def test_every_particle_that_carries_pressure_is_a_step_of_its_sign() -> None:
    shown = profile(0.05)
    (axis,) = drawn(figures.pressure({"zero_load": shown}, {"zero_load": edges(28.0)}))
    steps = [np.asarray(part.get_xy()) for part in axis.patches]
    colours = [tuple(part.get_facecolor()) for part in axis.patches]
    assert len(set(colours)) == len(steps) == 2  # compression, tension
    for x, p in zip(shown.x, shown.pressure, strict=True):
        if abs(p) > 0.01 * shown.pressure.max():
            own = steps[0 if p > 0.0 else 1]
            here = own[(np.abs(own[:, 0] - x) <= 0.5) & (own[:, 1] == p)]
            assert sorted({*here[:, 0]}) == [x - 0.5, x + 0.5]
    assert axis.get_ylabel() == "line load (FU/LU)"
    assert axis.get_xlabel() == "x (LU)"


def test_the_contact_radius_is_marked_on_both_sides_and_named() -> None:
    radii = {"zero_load": 28.25, "critical": 15.5}
    profiles = {"zero_load": profile(0.05), "critical": profile(-0.01)}
    axes = drawn(figures.pressure(profiles, {name: edges(radius) for name, radius in radii.items()}))
    for axis, (name, radius) in zip(axes, radii.items(), strict=True):
        places = {place for line in axis.get_lines() if line.get_linestyle() == "--" for place in line.get_xdata()}
        assert places == {-radius, radius}
        assert name.replace("_", " ") in axis.get_title(loc="left")
        assert f"{radius:.4g} LU" in axis.get_title(loc="left")


@pytest.mark.parametrize("radii", [{}, {"final": edges(0.0)}])
def test_a_state_without_contact_says_so(radii: dict[str, ContactRadius]) -> None:
    x = np.arange(5.0)
    (axis,) = drawn(figures.pressure({"final": Profile(x, x, x, 0.0 * x, x)}, radii))
    assert axis.get_title(loc="left") == "final state, no contact"


def test_states_that_part_are_left_out_and_the_others_shown_where_they_touch() -> None:
    held = profile(0.05)
    seen = figures.seen({"final": held, "parted": replace(held, pressure=1e-6 * held.pressure)})
    assert list(seen) == ["final"]
    carries = np.abs(held.pressure) > 0.01 * held.pressure.max()
    assert np.abs(held.x[carries]).max() < seen["final"].x.max() < held.x.max()


def test_the_branches_are_drawn_as_measured(curve: Columns) -> None:
    force = Axis("force", "FU"), curve.force, ()
    (axis,) = drawn(figures.path(Axis("displacement", "LU"), curve.displacement, LEGS, force))
    found = lines(axis)
    assert set(found) == {"loading", "unloading"}
    points = np.column_stack([curve.displacement, curve.force])
    np.testing.assert_array_equal(found["loading"], points[:30])
    np.testing.assert_array_equal(found["unloading"], points[30:])
    assert "(LU)" in axis.get_xlabel()
    assert "(FU)" in axis.get_ylabel()


@pytest.fixture(scope="module")
def pulled(tmp_path_factory: pytest.TempPathFactory) -> Run:
    pull = {"kind": "pull_off", "preload": 0.2}
    tables = chains(50.0, bodies={"particles": 40}, accuracy={"tolerance": 1e-2}, experiment=pull)
    return run(read_scene(tables), tmp_path_factory.mktemp("pulled"), figures=False)


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
def test_hertz_is_the_integral_of_the_springs_under_the_parabola(reduction: str, tmp_path: Path) -> None:
    """∫ c (d − x²/2R₁) dx over |x| < √(2R₁d), with c = k/s; x²/R by the MDR and x²/2R as drawn."""
    bodies = {"lower": "rigid_plane", "spacing": 0.5, "reduction": reduction}
    path = {"kind": "path", "displacements": [0.0, 0.5, 1.0, 2.0]}
    done = run(read_scene(chains(100.0, 0.8, interaction=None, bodies=bodies, experiment=path)), tmp_path / "run",
               figures=False)  # fmt: skip
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


HELD = {
    "title": "held",
    "bodies": {"particles": 41, "spacing": 1.0, "lower": "rigid_plane", "bulk_stiffness": 1.0, "mass": 1.0,
               "profile": {"kind": "parabola", "radius": 200.0}},
    "damping": {"coefficient": 0.3},
}  # fmt: skip


@pytest.mark.parametrize("kind", ["force", "displacement"])
def test_a_hold_is_drawn_over_time(kind: str, tmp_path: Path) -> None:
    """What is free over the time of its states; in a file and on the page."""
    held = {"force": {"displacement": 0.5}, "displacement": {"force": 4.0}}[kind] | {"kind": "hold", "duration": 5.0}
    plate = {"plate": {"mass": 20.0}} if kind == "displacement" else {}
    done = run(read_scene(HELD | plate | {"experiment": held}), tmp_path / "run")
    (axis,) = done.plot().axes
    assert axis.get_xlabel() == "time (TU)"
    assert axis.get_ylabel().startswith(kind)
    np.testing.assert_array_equal(lines(axis)["holding"], np.column_stack([done.curve.time, done.curve[kind]]))
    assert (done.folder / f"{kind}_time.png").read_bytes().startswith(PNG)
    assert (done.folder / "force_displacement.png").is_file() == (kind == "displacement")  # it is held otherwise
    page = report([done.folder], tmp_path / "r.html").read_text()
    assert f'"title": "{kind.capitalize()} over time"' in page


def test_the_pull_off_force_is_drawn_across_with_its_uncertainty(pulled: Run) -> None:
    tension = pulled.results.adhesion_force
    (axis,) = pulled.plot("force_displacement").axes
    (across,) = (points for name, points in lines(axis).items() if name.startswith("$F_A$"))
    np.testing.assert_array_equal(across, [[axis.get_xlim()[i], -tension.value] for i in (0, 1)])
    (band,) = axis.patches
    ends = np.asarray(band.get_xy())[:, 1]
    spread = tension.uncertainty
    assert [ends.min(), ends.max()] == pytest.approx([-tension.value - spread, -tension.value + spread], rel=1e-9)


def test_each_cycle_of_a_pull_off_has_its_own_legs(tmp_path: Path) -> None:
    pull = {"kind": "pull_off", "preload": 0.2, "cycles": 2}
    tables = chains(50.0, bodies={"particles": 40}, accuracy={"tolerance": 1e-2}, experiment=pull)
    done = run(read_scene(tables), tmp_path / "run", figures=False)
    legs = [line for line in done.plot().axes[0].get_lines() if line.get_label() in ("loading", "unloading")]
    assert [line.get_label() for line in legs] == ["loading", "unloading"] * 2
    for number, line in enumerate(legs):
        rows = (done.curve.cycle == 1 + number // 2) & (done.curve.branch == line.get_label())
        np.testing.assert_array_equal(line.get_xdata(), np.sort(done.curve.displacement[rows]))


def test_particles_within_the_stick_radius_stick_and_the_others_slip(tmp_path: Path) -> None:
    """Of a loop: at its end c < a. No shear exceeds μp."""
    bodies = {"lower": "rigid_plane", "reduction": "mdr", "bulk_stiffness_tangential": 0.4}
    move = {"kind": "tangential", "normal_force": 40.0, "displacements": [0.0, 0.2, 0.4, 0.2, 0.1]}
    scene = chains(1000.0, 0.5, interaction=None, bodies=bodies, friction={"coefficient": 0.3}, experiment=move)
    done = run(read_scene(scene), tmp_path / "run", figures=False)
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


def test_every_figure_is_a_whole_file(curve: Columns, tmp_path: Path) -> None:
    for name, chart in {
        "pressure": figures.pressure({"final": profile(0.05)}, {"final": edges(28.0)}),
        "force_time": figures.path(Axis("time", "TU"), curve.displacement, LEGS, (Axis("force"), curve.force, ())),
        "detachments": figures.detachments(curve.force),
    }.items():
        plots.save_figure(plots.draw(chart.written(scale_of)), tmp_path / f"{name}.png")
    files = sorted(tmp_path.iterdir())
    assert [f.name for f in files] == ["detachments.png", "force_time.png", "pressure.png"]
    for file in files:
        data = file.read_bytes()
        assert data.startswith(PNG)
        assert data[-8:-4] == b"IEND"
