"""A run folder is complete: `lmp -in in.lammps` in it gives bitwise the curve and the states that the program gave."""

from __future__ import annotations

import json
import os
import pickle
import re
import shutil
import subprocess
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from typer.testing import CliRunner

from contact1d import Run, load_run, read_scene, run
from contact1d.__main__ import app

Array = NDArray[np.float64]

ROOT = Path(__file__).parents[2]
LMP = Path(sys.executable).with_name("lmp")
READ = ("in.lammps", "system.data", "interaction.table", "adhesion.cells")
"""What a deck may read; everything else in a folder is a result."""
HARMLESS = (
    "force values in table DOUBLE_EXPONENTIAL are inconsistent with -dE/dr",  # the largest tension is an …
    "Should only be flagged at inflection points",  # … inflection point
    "No pairwise cutoff or binsize set. Atom sorting therefore disabled",  # nothing to sort on a rigid plane
    "Compute force/tally only called from pair style",  # as it should be
    "Stress was not tallied by pair style",  # the bodies are out of each other's reach
    "No fixes with time integration, atoms won't move",  # they are measured at rest
    "Attempting to displace atoms in rigid bodies",  # a search goes back; the body is set up anew in the next run, …
    "Changing velocities of atoms in rigid bodies",  # … as this says as well
    "Too many warnings",  # of these, one for every measurement
)
"""LAMMPS's warnings that mean nothing here."""

SUM = 1e-12
"""A sum over the particles, by LAMMPS and by numpy in their own orders; relative."""
PLACE = 1e-6
"""Relative: a place in the dump has as many digits."""
NEAREST = 1.0
"""The interpolated radius lies within a spacing of the particle under the largest tension."""

BODY = {"particles": 40, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 0.83}
PAIR = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}
STICKY: dict[str, Any] = {"bodies": BODY, "interaction": PAIR, "neighbours": {"stiffness": 0.3}}
PLANE: dict[str, Any] = {"bodies": BODY | {"lower": "rigid_plane"}}
MICRO = {"particles": 40, "spacing": 1e-6, "profile": {"kind": "parabola", "radius": 1e-4}, "bulk_stiffness": 8e5}
STUCK: dict[str, Any] = {
    "bodies": BODY | {"lower": "rigid_plane", "reduction": "mdr"}, "adhesion": {"work_of_adhesion": 2e-3},
}  # fmt: skip
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
COARSE: dict[str, Any] = {"accuracy": {"tolerance": 2e-2}}
SCENES: dict[str, dict[str, Any]] = {
    "load": STICKY | {"experiment": {"kind": "load", "force": 0.5}},
    "load_thermal": STICKY
    | TIMED
    | COARSE
    | {"noise": {"temperature": 1e-4, "seed": 7}, "experiment": {"kind": "load", "force": 0.5}},
    "path": STICKY
    | {"horizontal": {}, "experiment": {"kind": "path", "displacements": {"from": -0.6, "to": 0.3, "steps": 30}}},
    "cohesive": STUCK
    | {"adhesion": {"work_of_adhesion": 2e-3, "range": 0.02}, "experiment": {"kind": "pull_off", "preload": 0.5}},
    "pull_off": STICKY | {"experiment": {"kind": "pull_off", "preload": 0.5}},
    "pull_off_dynamic": STICKY | TIMED | COARSE | {"experiment": {"kind": "pull_off", "preload": 0.5}},
    "units": {
        "bodies": MICRO | {"lower": "rigid_plane"},
        "experiment": {"kind": "path", "displacements": {"from": 0.0, "to": 5e-7, "steps": 5}},
    },
    "plane_adhesion": STUCK | {"experiment": {"kind": "pull_off", "preload": 0.5}},
    "plane_load": PLANE | {"neighbours": {"stiffness": 0.2}, "experiment": {"kind": "load", "force": 0.5}},
    "slide": {
        "bodies": BODY | {"particles": 60, "profile": {"kind": "parabola", "radius": 30.0}, "bulk_stiffness": 2.0},
        "interaction": {
            "repulsion": {"amplitude": 1.0, "range": 0.5},
            "attraction": {"amplitude": 0.5, "range": 1.0},
        },
        "horizontal": {},
        "damping": {"coefficient": "auto"},
        "plate": {"free": ["x", "z"]},
        "cantilever": {"stiffness": 20.0, "velocity": 0.05},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 3.0},
    }
    | COARSE,
}


@pytest.fixture(scope="module", params=SCENES)
def finished(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Run:
    """One run of each kind, shared by the tests of this file."""
    scene = read_scene({"title": request.param} | SCENES[request.param])
    return run(scene, tmp_path_factory.mktemp(request.param), figures=False)


def lmp(folder: Path) -> subprocess.CompletedProcess[str]:
    """`cd folder && lmp -in in.lammps`; UCX_TLS leaves no network listener open."""
    environment = os.environ | {"UCX_TLS": "self,sm", "OMP_NUM_THREADS": "1"}
    command = [str(LMP), "-in", "in.lammps"]
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)


def warnings(screen: str) -> list[str]:
    """LAMMPS's warnings but for the harmless ones."""
    lines = [line for line in screen.splitlines() if line.startswith("WARNING")]
    return [line for line in lines if not any(words in line for words in HARMLESS)]


def curve(folder: Path) -> tuple[list[str], Array]:
    """Phases, and (displacement, force) of every line of curve.txt."""
    rows = [line.split() for line in (folder / "curve.txt").read_text().splitlines()]
    assert rows[0] == ["#", "phase", "displacement[LU]", "force[FU]"]
    return [row[0] for row in rows[1:]], np.asarray([row[1:] for row in rows[1:]], dtype=float)


def test_lmp_repeats_the_run_bitwise(finished: Run, tmp_path: Path) -> None:
    """In a copy that has only what a deck reads."""
    for name in READ:
        if (finished.folder / name).exists():
            shutil.copy(finished.folder / name, tmp_path / name)
    done = lmp(tmp_path)
    assert done.returncode == 0, done.stdout[-2000:]
    assert warnings(done.stdout) == []
    for name in ("curve.txt", "states.lammpstrj"):
        assert (tmp_path / name).read_bytes() == (finished.folder / name).read_bytes(), name


BEND = 0.25
"""A maximum between rows exceeds the largest row by at most an eighth of the second difference there; twice that."""
PASSING = ("path", "slide", "pull_off")
"""Experiments whose deck may have rows that are no results: between two places, while loading, after the loss."""


def test_curve_txt_holds_the_states_of_the_results(finished: Run) -> None:
    """Every state of the results is a line, bitwise and in order; where no row only passes, every line is a state."""
    phases, rows = curve(finished.folder)
    states = finished.outcome.states
    assert len(rows) == len(states) or finished.document["experiment"] in PASSING
    lines = iter(zip(phases, rows.tolist(), strict=True))
    for state in states:
        force = next(f for phase, (d, f) in lines if (phase, d) == (state.phase, state.displacement))
        assert force == pytest.approx(state.force, rel=SUM, abs=SUM)
    if "final" in finished.outcome.profiles:
        place = finished.outcome.profiles["final"].x.max()
        atoms = finished.atoms()
        assert atoms.positions[atoms.arrays["type"] == 2, 0].max() == pytest.approx(place, rel=PLACE)


def value(finished: Run, name: str) -> tuple[float, float]:
    quantity = finished.document[name]
    return quantity["value"], quantity["uncertainty"]


def test_numbers_can_be_read_off_the_curve(finished: Run) -> None:
    """By eye, so to say: the largest tension, the last state, the mean of the samples."""
    phases, rows = curve(finished.folder)
    kind = finished.document["experiment"]
    samples = rows[[phase == "sampling" for phase in phases]]
    if kind == "load":
        wanted = samples.mean(axis=0) if len(samples) else rows[-1]
        assert [value(finished, name)[0] for name in ("displacement", "force")] == pytest.approx(wanted, rel=SUM)
    if "adhesion_force" in finished.document:
        adhesion, uncertainty = value(finished, "adhesion_force")
        held = rows[[phase in ("unloading", "pulling") for phase in phases], 1]
        largest = -float(held.min())
        # The quantity is the vertex between rows: at most one bend of the curve above the largest row.
        bend = BEND * float(np.abs(np.diff(held, 2)).max(initial=0.0))
        assert largest - uncertainty - SUM <= adhesion <= largest + bend + uncertainty + SUM
    if "preload" in finished.document:
        loaded = rows[[phase == "loading" for phase in phases], 1]
        assert loaded[-1] == pytest.approx(value(finished, "preload")[0], rel=SUM)
    if "largest_force" in finished.document:
        assert rows[:, 1].max() == pytest.approx(value(finished, "largest_force")[0], rel=SUM)


def frames(folder: Path) -> list[Array]:
    """Atoms of every dump frame, columns id type x y z fx fz."""
    found = []
    for text in (folder / "states.lammpstrj").read_text().split("ITEM: TIMESTEP")[1:]:
        title, rows = text.split("ITEM: ATOMS ")[1].split("\n", 1)
        assert title.split() == ["id", "type", "x", "y", "z", "opposite_fx", "opposite_fz"]
        found.append(np.asarray([row.split() for row in rows.splitlines()], dtype=float))
    return found


def test_radii_can_be_read_off_the_dump(finished: Run) -> None:
    """The first frame of a pull-off is the zero-load state, the second the critical one; a load has its last."""
    found = frames(finished.folder)
    names = {"pull_off": ("zero_load_radius", "critical_radius"), "load": ("contact_radius",)}
    if finished.document["scene"]["bodies"]["lower"] == "rigid_plane" or "noise" in finished.document["effects"]:
        return
    for frame, name in zip(found, names.get(finished.document["experiment"], ()), strict=False):
        upper = frame[frame[:, 1] == 2]
        place = abs(upper[upper[:, 6].argmin(), 2])
        assert value(finished, name)[0] == pytest.approx(place, abs=NEAREST)


def test_the_folder_has_nothing_left_over(finished: Run) -> None:
    """No search's saved state, no half-written file; results.json is what was returned."""
    names = {path.name for path in finished.folder.iterdir()}
    assert not [name for name in names if name.endswith(".part") or name.startswith("saved")]
    assert {"in.lammps", "system.data", "curve.txt", "states.lammpstrj", "curve.csv", "results.json"} <= names
    assert ("interaction.table" in names) == ("interaction" in finished.document["effects"])
    assert json.loads((finished.folder / "results.json").read_text()) == finished.document


def test_a_run_read_from_its_folder_is_the_one_that_was_made(finished: Run) -> None:
    """From memory, from the files and through a pickle it has one face, to the last bit."""
    titles = [axis.get_title() for axis in finished.plot().axes]
    for loaded in (load_run(str(finished.folder)), pickle.loads(pickle.dumps(finished))):
        assert loaded == finished
        for name in ("scene", "status", "results", "warnings", "timing"):
            assert getattr(loaded, name) == getattr(finished, name), name
        assert (repr(loaded), loaded._repr_html_()) == (repr(finished), finished._repr_html_())
        assert loaded.tables.keys() == finished.tables.keys()
        assert list(loaded.profiles) == list(finished.profiles)
        for table, columns in finished.tables.items():
            assert list(loaded.tables[table]) == list(columns)
            for name, column in columns.items():
                np.testing.assert_array_equal(loaded.tables[table][name], column)
        assert [axis.get_title() for axis in loaded.plot().axes] == titles


QUICK = {
    "hertz_plane": ["experiment.displacements.steps=4", "bodies.particles=160"],
    "load": ["bodies.particles=60"],
    "paper": ["bodies.particles=60"],
    "path_hysteresis": ["experiment.displacements.steps=4", "bodies.particles=60"],
    "prandtl_tomlinson": ["experiment.distance=1.0"],
    "pull_off": ["bodies.particles=60"],
    "pull_off_dynamic": ["bodies.particles=20"],
    "slide": ["experiment.distance=1.0"],
    "thermal_load": ["bodies.particles=20"],
}
SHIPPED = sorted(path.stem for path in (ROOT / "lammps_inputs" / "scenes").glob("*.toml"))


@pytest.mark.parametrize("name", SHIPPED)
def test_deck_of_a_shipped_scene_runs_under_lmp(name: str, tmp_path: Path) -> None:
    """`contact1d deck SCENE --out DIR`, then `lmp -in in.lammps` there: no error, every row measured and finite."""
    scene = ROOT / "lammps_inputs" / "scenes" / f"{name}.toml"
    small = [word for change in QUICK.get(name, []) for word in ("--set", change)]
    written = CliRunner().invoke(app, ["deck", str(scene), "--out", str(tmp_path / "deck"), *small])
    assert written.exit_code == 0, written.output
    done = lmp(tmp_path / "deck")
    assert done.returncode == 0, done.stdout[-2000:]
    assert warnings(done.stdout) == []
    phases, rows = curve(tmp_path / "deck")
    planned = re.findall(r"^# phase (\w+): (\d+) rows$", (tmp_path / "deck" / "in.lammps").read_text(), re.MULTILINE)
    assert Counter(phases) == {name: int(count) for name, count in planned}
    assert np.isfinite(rows).all()
    assert (tmp_path / "deck" / "states.lammpstrj").stat().st_size > 0


@pytest.mark.parametrize("far", [-60.0, -3000.0])
@pytest.mark.parametrize(
    "tables",
    [STICKY, STICKY | {"bodies": BODY | {"lower": "rigid_chain"}}, PLANE, PLANE | {"neighbours": {"stiffness": 0.2}}],
    ids=["two chains", "rigid chain", "plane", "plane with neighbours"],
)
def test_a_path_far_apart_stays_in_the_box(tables: dict[str, Any], far: float, tmp_path: Path) -> None:
    """No particle is lost, in the run or by `lmp`, and nothing pulls at that distance."""
    path = {"experiment": {"kind": "path", "displacements": [0.0, far]}}
    finished = run(read_scene({"title": "far"} | tables | path), tmp_path, figures=False)
    assert finished.curve.displacement[-1] == pytest.approx(far, rel=1e-12)
    assert finished.curve.force[-1] == 0.0
    assert lmp(finished.folder).returncode == 0
