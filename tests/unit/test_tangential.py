"""The experiment `tangential` from its schedule to its files; physics is in tests/validation/test_tangential.py."""

from __future__ import annotations

import csv
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import load_run, run
from contact1d.analysis import slip_plots
from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.mindlin import mindlin_path, mindlin_shear
from contact1d.analysis.slip import stick_margin
from contact1d.workflow.experiments.tangential.schedule import passed, schedule
from contact1d.workflow.scene import Scene, read_scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for

SHIPPED = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "mindlin.toml"
COLUMNS = {"tangential_displacement", "tangential_force", "normal_force", "displacement", "contact_radius",
           "stick_radius", "branch"}  # fmt: skip


def scene(**changes: Any) -> Scene:
    return read_scene(SHIPPED).with_(**changes)


def drawn(scene: Scene) -> list[tuple[str, list[tuple[float, float]]]]:
    phases = schedule(scene, settings_for(scene))
    return [(phase.name, [(row.displacement, row.place) for row in phase.rows]) for phase in phases]


def test_a_phase_for_each_stretch_and_first_the_load() -> None:
    places = [0.0, 0.1, 0.2, 0.1, 0.1, 0.3, 0.2]
    found = drawn(scene(experiment__displacements=places))
    names = [(name, [place for _, place in rows]) for name, rows in found]
    assert names == [
        ("pressing", [0.0]), ("forward", [0.0, 0.1, 0.2]), ("backward", [0.1, 0.1]), ("forward_2", [0.3]),
        ("backward_2", [0.2]),
    ]  # fmt: skip


def test_a_way_that_begins_to_the_left_is_backward_from_its_first_row() -> None:
    assert [name for name, _ in drawn(scene(experiment__displacements=[0.0, -0.1, 0.1]))] == [
        "pressing", "backward", "forward",
    ]  # fmt: skip


def test_rows_on_the_way_are_where_particles_begin_to_touch_on_a_straight_line() -> None:
    loads: Any = {"experiment": {"kind": "tangential", "normal_displacement": [0.1, 0.13], "displacements": [0.0, 0.3]}}
    changed = scene(**loads)
    rows = passed(changed, settings_for(changed))
    assert [asked for _, asked in rows] == [False, True, False, True]
    (depth, place), _ = rows[2]
    assert depth == pytest.approx(10.5**2 / 1000.0)
    assert place == pytest.approx(0.3 * (depth - 0.1) / 0.03)


def test_rows_on_the_way_are_no_more_than_the_tolerance_asks_for() -> None:
    loads: Any = {"experiment": {"kind": "tangential", "normal_displacement": [0.0, 0.9], "displacements": [0.0, 0.1]}}
    changed = scene(**loads, accuracy__tolerance=0.1)
    rows = passed(changed, settings_for(changed))
    assert len(rows) == 3 + 10


def test_what_too_few_rows_on_the_way_leave_is_claimed(tmp_path: Path) -> None:
    """Thirty particles on a side begin to touch on a way with ten rows; with all thirty the force is exact."""
    loads: Any = {"experiment": {"kind": "tangential", "normal_displacement": [0.0, 0.9], "displacements": [0.0, 0.3]}}
    fine, rough = (
        run(scene(**loads, bodies__particles=80, accuracy__tolerance=t), tmp_path / str(t), figures=False)
        for t in (1e-2, 0.1)
    )
    exact, less = fine.results["tangential_force"], rough.results["tangential_force"]
    assert exact.uncertainty < 1e-9 < abs(less.value - exact.value) < less.uncertainty


def test_files_of_a_run_and_the_same_run_from_its_folder(tmp_path: Path) -> None:
    done = run(scene(experiment__displacements=[0.0, 0.2, 0.1]), tmp_path)
    with (tmp_path / "curve.csv").open() as file:
        header = next(csv.reader(file))
    assert set(header) >= COLUMNS
    assert {"tangential.png", "stick_slip.png", "pressure.png"} <= {path.name for path in tmp_path.iterdir()}
    assert not (tmp_path / "friction.csv").exists()
    read = load_run(tmp_path)
    assert read == done
    assert read.friction.keys() == done.friction.keys()
    for name, column in done.friction.items():
        assert np.array_equal(read.friction[name], column)
    assert list(done.results)[:5] == [
        "normal_force", "tangential_force", "contact_radius", "stick_radius", "dissipated_energy",
    ]  # fmt: skip
    with (tmp_path / "shear_3d.csv").open() as file:
        table = list(csv.DictReader(file))
    for state in ("farthest", "final"):
        rows = [row for row in table if row["state"] == state]
        assert np.array_equal([float(row["shear_stress"]) for row in rows], read.body_shears[state].shear)
    for plot in (None, "stick_slip", "pressure", "shear_3d"):
        read.plot(plot)
    assert done.curve.branch.tolist() == ["forward", "forward", "backward"]
    assert done.results["dissipated_energy"].unit == "FU·LU"


def test_the_shear_in_three_dimensions_is_mindlins_out_and_back(tmp_path: Path) -> None:
    """Of the run's own a and c, exactly: springs of a parabola have no lattice in between."""
    done = run(scene(experiment__displacements=[0.0, 0.2, 0.05]), tmp_path, figures=False)
    a, c = done.curve.contact_radius, done.friction["stick_radius"]
    peak = 2.0 * a[0] / (math.pi * 1000.0)  # p0 = 2E*a/πR, E* = 1
    out, back = done.body_shears["farthest"], done.body_shears["final"]
    there = mindlin_shear(out.r, a[1], c[1], 0.3, peak)
    assert out.shear == pytest.approx(there, abs=1e-6 * 0.3 * peak)
    returned = mindlin_shear(back.r, a[1], c[1], 0.3, peak) - 2.0 * mindlin_shear(back.r, a[1], c[2], 0.3, peak)
    assert back.shear == pytest.approx(returned, abs=1e-6 * 0.3 * peak)
    assert (out.stick, back.stick) == (c[1], c[2])


def test_no_shear_in_three_dimensions_where_there_is_no_such_body(tmp_path: Path) -> None:
    drawn: Any = {"bodies.reduction": "geike_popov", "experiment.displacements": [0.1]}
    punch: Any = {"bodies.profile": {"kind": "flat_punch", "radius": 10.0}, "experiment.displacements": [0.1]}
    for i, changes in enumerate((drawn, punch)):
        done = run(read_scene(SHIPPED).with_(changes), tmp_path / str(i), figures=False)
        assert done.body_shears == {}
        assert not (done.folder / "shear_3d.csv").exists()


def test_with_a_material_forces_and_ways_are_in_si(tmp_path: Path) -> None:
    body = {"youngs_modulus": 1e9, "poisson_ratio": 0.3}
    material = {"upper": body, "lower": body, "length_unit": 1e-6, "force_unit": 1e-3}
    automatic: Any = {"bodies.bulk_stiffness": "auto", "bodies.bulk_stiffness_tangential": None, "material": material}
    done = run(read_scene(SHIPPED).with_(automatic | {"experiment.displacements": [0.0, 0.1]}), tmp_path, figures=False)
    force = done.results["tangential_force"]
    assert force.si is not None
    assert force.si.value == pytest.approx(1e-3 * force.value)
    with (tmp_path / "curve.csv").open() as file:
        row = list(csv.DictReader(file))[-1]
    assert float(row["tangential_force_N"]) == pytest.approx(1e-3 * force.value)
    assert float(row["stick_radius_m"]) == pytest.approx(1e-6 * done.results["stick_radius"].value)


def test_what_the_lattice_leaves_open_is_part_of_what_a_run_claims(tmp_path: Path) -> None:
    """Whether the middle of the contact is on a particle or between two: an odd chain is within the claim."""
    places = [0.0, 0.2, 0.05]
    even = run(scene(experiment__displacements=places), tmp_path / "even", figures=False)
    odd = run(scene(experiment__displacements=places, bodies__particles=75), tmp_path / "odd", figures=False)
    for name in ("tangential_force", "contact_radius", "stick_radius", "dissipated_energy"):
        one, other = even.results[name], odd.results[name]
        assert abs(one.value - other.value) <= one.uncertainty + other.uncertainty
        assert one.uncertainty > other.uncertainty


def test_a_history_that_is_not_kept_gives_no_number(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from contact1d import RunError
    from contact1d.workflow.experiments.tangential import tangential

    monkeypatch.setattr(tangential, "AS_PREDICTED", -1.0)
    with pytest.raises(RunError, match="LAMMPS has lost its history"):
        run(scene(experiment__displacements=[0.1]), tmp_path, figures=False)


def test_cattaneo_and_mindlin_stand_beside_the_results(tmp_path: Path) -> None:
    """By a load or by its displacement, on a way with a turn; not of a cone, nor of a load that changes."""
    places = [0.0, 0.2, 0.05]
    done = run(scene(experiment__displacements=places), tmp_path / "load", figures=False)
    (theory,) = done.document["theory"]
    assert theory["name"] == "Cattaneo and Mindlin"
    depth = (30.0 / math.sqrt(1000.0)) ** (2.0 / 3.0)
    sliding = 0.3 / 0.8 * depth
    expected = mindlin_path(places, 40.0, 0.3, sliding)[-1]
    assert theory["values"]["tangential_force"]["value"] == pytest.approx(expected, rel=1e-12)
    c = math.sqrt(1000.0 * depth) * math.sqrt(1.0 - 0.075 / sliding)
    assert theory["values"]["stick_radius"]["value"] == pytest.approx(c, rel=1e-12)
    ours = done.results["tangential_force"]
    assert abs(ours.value - expected) <= ours.uncertainty
    assert theory["values"]["tangential_force"]["deviation"] == pytest.approx(ours.value / expected - 1.0, rel=1e-9)
    pressed: Any = {"kind": "tangential", "normal_displacement": depth, "displacements": places}
    theories = run(scene(experiment=pressed), tmp_path / "place", figures=False).document["theory"]
    by_place = next(one["values"] for one in theories if one["name"] == "Cattaneo and Mindlin")
    assert by_place["normal_force"]["value"] == pytest.approx(40.0, rel=1e-12)
    assert by_place["tangential_force"]["value"] == pytest.approx(expected, rel=1e-12)
    for other in ({"bodies.profile": {"kind": "cone", "slope": 0.02}}, {"experiment.normal_force": [40.0, 30.0, 30.0]}):
        changed = scene(experiment__displacements=places).with_(other)
        assert run(changed, tmp_path / "other", figures=False).document["theory"] == []


def test_the_figure_of_the_way_has_all_branches_and_the_theory() -> None:
    places = np.array([0.0, 0.1, 0.2, 0.1, 0.2])
    columns = {"tangential_displacement": places, "tangential_force": 2.0 * places, "normal_force": np.full(5, 3.0)}
    branches = np.array(["forward", "forward", "forward", "backward", "forward"])
    (axis,) = slip_plots.tangential_figure(columns, branches, 2.0 * places).axes
    drawn = [(line.get_label(), np.asarray(line.get_xdata()).tolist()) for line in axis.get_lines()]
    assert ("forward", [0.0, 0.1, 0.2]) in drawn
    assert ("backward", [0.2, 0.1]) in drawn
    assert any(x == [0.1, 0.2] for _, x in drawn)
    assert ("Cattaneo–Mindlin", places.tolist()) in drawn
    columns["normal_force"] = np.array([1.0, 2.0, 3.0, 2.0, 1.0])
    upper, lower = slip_plots.tangential_figure(columns, branches).axes
    assert list(lower.get_lines()[0].get_ydata()) == [1.0, 2.0, 3.0, 2.0, 1.0]
    assert upper.get_ylabel() == "tangential force (FU)"


def test_the_figure_of_a_state_tells_what_sticks_from_what_slips() -> None:
    x = np.arange(-9.5, 10.0)
    pressure = np.maximum(1.0 - (x / 8.0) ** 2, 0.0)
    profile = Profile(x, 0.0 * x, 0.0 * x, pressure, -np.minimum(0.1, 0.3 * pressure))
    margin = stick_margin(profile, 0.3, 1)
    (axis,) = slip_plots.stick_slip_figure(
        {"final": profile}, 0.3, {"final": margin}, {"final": 6.53}, {"final": 0.2}
    ).axes
    sticking, slipping = (len(found.get_segments()) for found in axis.collections[:2])
    assert sticking == int((margin > 0.0).sum())
    assert slipping == int((pressure > 0.0).sum()) - sticking
    assert "u = 0.2 LU, stick radius c = 6.53 LU" in axis.get_title(loc="left")


def test_no_theory_beside_what_it_does_not_describe(tmp_path: Path) -> None:
    cone = {"kind": "cone", "slope": 0.02}
    done = run(scene(bodies__profile=cone, experiment__displacements=[0.0, 0.1]), tmp_path, figures=False)
    labels = [line.get_label() for line in done.plot().axes[0].get_lines()]
    assert "Cattaneo–Mindlin" not in labels


def test_the_scene_of_the_how_to_runs(tmp_path: Path) -> None:
    """In SI: 10 N on steel, drawn to and fro by less than sliding needs."""
    page = (Path(__file__).parents[2] / "docs" / "how_to" / "shear.md").read_text(encoding="utf-8")
    done = run(page.split("```toml\n")[1].split("```")[0], tmp_path, figures=False)
    force, stick = done.results["tangential_force"], done.results["stick_radius"]
    assert done.warnings == {}
    assert force.si is not None
    assert 0.0 < force.si.value < 3.0
    assert 0.0 < stick.value < done.results["contact_radius"].value


def test_a_scene_of_friction_is_written_and_read_again() -> None:
    varied: Any = {"experiment.normal_force": [1.0, 2.0], "experiment.displacements": [0.0, 0.1]}
    for one in (scene(), read_scene(SHIPPED).with_(varied)):
        assert read_scene(str(one)) == one
        assert scene_from_dict(one.model_dump(by_alias=True)) == one
