"""What a sweep leaves to look at: its table as Parquet, its figures, its charts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d import sweep
from contact1d.workflow.sweep.axes import read_sweep
from contact1d.workflow.sweep.table import PARQUET, TABLE, write_parquet
from contact1d.workflow.units import UNKNOWN
from tests.sweeps import FORCE, RADIUS, Here, axis, plane, rows


def test_parquet_says_the_same_as_the_table(tmp_path: Path) -> None:
    from pyarrow import parquet

    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, Here(), figures=False)
    write_parquet(tmp_path)
    read = parquet.read_table(tmp_path / PARQUET).to_pydict()
    assert read["displacement"] == [float(row["displacement"]) for row in rows(tmp_path)]


def test_seeds_are_averaged_and_lines_told_apart(tmp_path: Path) -> None:
    from contact1d.workflow.sweep.figures import lines_of, sweep_figure

    plan = read_sweep(plane(axis(FORCE, 0.5, 1.0), axis(RADIUS, 50.0, 100.0), axis("noise.seed", 1, 2)))
    (tmp_path / TABLE).write_text(
        f"{FORCE},{RADIUS},noise.seed,status,reason,run,displacement,displacement_uncertainty\n"
        "0.5,50.0,1,done,,,1.0,0.1\n0.5,50.0,2,done,,,3.0,0.1\n1.0,50.0,1,done,,,4.0,0.2\n0.5,100.0,1,done,,,5.0,0.1\n"
        "1.0,100.0,1,failed,why,,,\n"
    )
    figure = sweep_figure(plan, "displacement", "LU", lines_of(tmp_path, plan, ["displacement"])["displacement"])
    first, second = figure.axes[0].containers
    np.testing.assert_allclose(first[0].get_ydata(), [2.0, 4.0])
    np.testing.assert_allclose(second[0].get_ydata(), [5.0])
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == [
        "radius of curvature R at the apex = 50.0", "radius of curvature R at the apex = 100.0",
    ]  # fmt: skip
    assert figure.axes[0].get_ylabel() == "displacement (LU)"


def test_closed_forms_are_the_lines_of_a_sweeps_figures_and_the_runs_points_on_them(tmp_path: Path) -> None:
    """Hertz over the force for two radii: in the figure and on the page, in the colours of the runs beside them."""
    from contact1d.workflow.report.charts import charts_of
    from contact1d.workflow.sweep.figures import lines_of, sweep_figure

    bodies = {
        "particles": "auto", "spacing": 1.0, "lower": "rigid_plane", "reduction": "mdr", "bulk_stiffness": 0.5,
        "profile": {"kind": "parabola", "radius": 1000.0},
    }  # fmt: skip
    base = {"title": "load", "bodies": bodies, "experiment": {"kind": "load", "force": 1.0}}
    forces, radii = [10.0, 20.0, 40.0], [500.0, 1000.0]
    axes = [{"key": "experiment.force", "values": forces}, {"key": "bodies.profile.radius", "values": radii}]
    tables = {"title": "Hertz", "base": base, "axes": axes}
    done = sweep(tables, tmp_path / "s", workers=1, figures="svg")
    assert (done.folder / "displacement.svg").is_file()
    plan = read_sweep(tables)
    lines = lines_of(done.folder, plan, ["displacement"])["displacement"]
    assert [line.labels for line in lines] == [(str(radius),) for radius in radii]
    for line, radius in zip(lines, radii, strict=True):
        hertz = [(0.75 * force / 0.5 / radius**0.5) ** (2.0 / 3.0) for force in forces]
        x, beside = line.forms["Hertz"]
        assert x.tolist() == forces
        assert beside == pytest.approx(hertz, rel=1e-9)  # of the force that is held
    figure = sweep_figure(plan, "displacement", "LU", lines)
    labels = [text.get_text() for text in figure.axes[0].get_legend().get_texts()]
    assert labels == ["Hertz", *(f"radius of curvature R at the apex = {radius}" for radius in radii)]
    (chart,) = charts_of({"": ({"displacement": figure}, UNKNOWN)})
    assert (chart["layout"]["xaxis"]["type"], chart["title"]) == (
        "linear",
        "Displacement over normal force on the upper body: Hertz",
    )
    drawn = {kind: [trace for trace in chart["data"] if trace["mode"] == kind] for kind in ("markers", "lines")}
    colours = {kind: {trace["line"]["color"] for trace in traces} for kind, traces in drawn.items()}
    assert len(colours["markers"]) == 2
    assert colours["markers"] <= colours["lines"]
    first = next(trace for trace in drawn["lines"] if len(trace["x"]) > 10 * len(forces))
    between = float(np.interp(30.0, first["x"], first["y"]))
    assert between == pytest.approx((0.75 * 30.0 / 0.5 / radii[0] ** 0.5) ** (2.0 / 3.0), rel=1e-3)
