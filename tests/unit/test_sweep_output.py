"""What a sweep leaves to look at: its table, also as Parquet, its figures, its charts."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest

from contact1d import sweep
from contact1d.workflow.sweep.axes import read_sweep
from contact1d.workflow.sweep.table import PARQUET, TABLE, read_table, write_parquet
from tests.sweeps import FORCE, RADIUS, Here, axis, plane, rows


def test_parquet_says_the_same_as_the_table(tmp_path: Path) -> None:
    from pyarrow import parquet

    sweep(plane(axis(FORCE, 0.5, 1.0)), tmp_path, Here(), figures=False)
    write_parquet(tmp_path)
    read = parquet.read_table(tmp_path / PARQUET).to_pydict()
    assert read["displacement"] == [float(row["displacement"]) for row in rows(tmp_path)]


def test_a_text_is_no_formula_for_a_spreadsheet_and_comes_back(tmp_path: Path) -> None:
    """In results.csv each begins with an apostrophe; numbers stay numbers, negative ones, too."""
    from pyarrow import parquet

    titles = ["=1+1", "+A1", "-2 nm", "@now", "'=1", "\t=1", "\uff1d1", "it's", "'quoted'", "-5"]
    done = sweep(plane(axis("title", *titles), axis(FORCE, 0.5)), tmp_path, Here(), figures=False)
    with (tmp_path / TABLE).open(newline="") as file:
        cells = [row["title"] for row in csv.DictReader(file)]
    assert cells == [*(f"'{title}" for title in titles[:7]), *titles[7:]]
    write_parquet(tmp_path)
    for read in (
        [row["title"] for row in read_table(tmp_path)],
        done.table()["title"].tolist(),
        parquet.read_table(tmp_path / PARQUET).to_pydict()["title"],
    ):
        assert read == titles
    assert done.table()[FORCE].tolist() == [0.5] * len(titles)


def test_seeds_are_averaged_and_lines_told_apart(tmp_path: Path) -> None:
    from contact1d.workflow.sweep.figures import sweep_charts

    plan = read_sweep(plane(axis(FORCE, 0.5, 1.0), axis(RADIUS, 50.0, 100.0), axis("noise.seed", 1, 2)))
    (tmp_path / TABLE).write_text(
        f"{FORCE},{RADIUS},noise.seed,status,reason,run,displacement,displacement_uncertainty\n"
        "0.5,50.0,1,done,,,1.0,0.1\n0.5,50.0,2,done,,,3.0,0.1\n1.0,50.0,1,done,,,4.0,0.2\n0.5,100.0,1,done,,,5.0,0.1\n"
        "1.0,100.0,1,failed,why,,,\n"
    )
    chart = sweep_charts(tmp_path, plan, {"displacement": "LU"})["displacement"]
    (panel,) = chart.panels
    first, second = panel.series
    np.testing.assert_allclose(first.y, [2.0, 4.0])
    np.testing.assert_allclose(first.dy, [1.0, 0.2])  # (3 − 1)/2 of two seeds, the uncertainty of one
    np.testing.assert_allclose(second.y, [5.0])
    assert panel.legend == ["radius of curvature R at the apex = 50.0", "radius of curvature R at the apex = 100.0"]
    assert panel.y.label == "displacement (LU)"


def test_closed_forms_are_the_lines_of_a_sweeps_figures_and_the_runs_points_on_them(tmp_path: Path) -> None:
    """Hertz over the force for two radii: in the figure and on the page, in the colours of the runs beside them."""
    from contact1d.workflow.report.charts import charts_of
    from contact1d.workflow.sweep.figures import sweep_charts

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
    found = sweep_charts(done.folder, read_sweep(tables), {"displacement": "LU"})
    (panel,) = found["displacement"].panels
    labels = [f"radius of curvature R at the apex = {radius}" for radius in radii]
    assert panel.legend == ["Hertz", *labels]
    beside = [one for one in panel.series if one.name == "Hertz"]
    for line, radius in zip(beside, radii, strict=True):
        hertz = [(0.75 * force / 0.5 / radius**0.5) ** (2.0 / 3.0) for force in forces]
        at = [int(np.argmin(np.abs(line.x - force))) for force in (forces[0], forces[-1])]
        assert line.x[at] == pytest.approx([forces[0], forces[-1]])
        assert line.y[at] == pytest.approx([hertz[0], hertz[-1]], rel=1e-9)  # of the force that is held
    (chart,) = charts_of({"": found})
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


def test_many_lines_are_named_by_their_ends_and_words_stand_at_their_places(tmp_path: Path) -> None:
    from contact1d.workflow.report.charts import charts_of
    from contact1d.workflow.sweep.figures import sweep_charts

    radii = [100.0 * i for i in range(1, 13)]
    plan = read_sweep(plane(axis("title", "one", "two"), axis(RADIUS, *radii)))
    rows = [f"{title},{radius},done,,,{radius + i},0.1\n" for i, title in enumerate(("one", "two")) for radius in radii]
    header = f"title,{RADIUS},status,reason,run,displacement,displacement_uncertainty\n"
    (tmp_path / TABLE).write_text(header + "".join(rows))
    found = sweep_charts(tmp_path, plan, {"displacement": "LU"})
    (panel,) = found["displacement"].panels
    ends = [f"radius of curvature R at the apex = {radius}" for radius in (*radii[:3], *radii[-3:])]
    assert panel.legend == ends
    assert len({one.name for one in panel.series}) == len(radii)
    (chart,) = charts_of({"": found})
    assert [trace["name"] for trace in chart["data"] if trace["showlegend"]] == [
        end.replace(" = ", "\u00a0=\u00a0") for end in ends
    ]
    assert chart["layout"]["xaxis"]["ticktext"] == ["one", "two"]
