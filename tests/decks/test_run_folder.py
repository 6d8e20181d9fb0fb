"""A run folder is complete: `lmp -in in.lammps` in it gives bitwise the curve and the states that the program gave.

With `[output] states` it has a frame for each row of the curve, or some of them, by the deck's own dump.
"""

import pickle
import re
import shutil
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import ase.io
import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run, load_run, run, write_deck
from contact1d.analysis.atoms import atoms
from contact1d.analysis.curve import read_states
from tests.command import contact1d
from tests.decks.written import lmp
from tests.scenes import ROOT, chains, read_json

Array = NDArray[np.float64]

READ = ("in.lammps", "system.data", "interaction.table", "neighbours.moves", "adhesion.cells")
"""What a deck may read; everything else in a folder is a result."""
HARMLESS = (
    "force values in table DOUBLE_EXPONENTIAL are inconsistent with -dE/dr",  # the largest tension is an …
    "Should only be flagged at inflection points",  # … inflection point
    "No pairwise cutoff or binsize set. Atom sorting therefore disabled",  # nothing to sort on a rigid plane
    "No fixes with time integration, atoms won't move",  # they are measured at rest
    "Attempting to displace atoms in rigid bodies",  # a search goes back; the body is set up anew in the next run, …
    "Changing velocities of atoms in rigid bodies",  # … as this says as well
    "Too many warnings",  # of these, one for every measurement
)
"""LAMMPS's warnings that mean nothing here."""

SUM = 1e-12
"""A sum over the particles, by LAMMPS and by numpy in their own orders; relative."""
SINGLE = 1e-6
"""Relative: states.npz is in single precision."""
NEAREST = 1.0
"""The interpolated radius lies within a spacing of the particle under the largest tension."""

BODY = {"particles": 40, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 100.0}, "bulk_stiffness": 0.83}
PAIR = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}
STICKY: dict[str, Any] = {"bodies": BODY, "interaction": PAIR, "neighbours": {"stiffness": 0.3}}
MICRO = {"particles": 40, "spacing": 1e-6, "profile": {"kind": "parabola", "radius": 1e-4}, "bulk_stiffness": 8e5}
STUCK: dict[str, Any] = {
    "bodies": BODY | {"lower": "rigid_plane", "reduction": "mdr"}, "adhesion": {"work_of_adhesion": 2e-3},
}  # fmt: skip
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
COARSE: dict[str, Any] = {"accuracy": {"tolerance": 2e-2}}
HEAT = {"accuracy": {"tolerance": 5e-2}, "noise": {"temperature": 1e-4, "seed": 7}}
PULL_OFF = {"kind": "pull_off", "preload": 0.5}
SCENES: dict[str, dict[str, Any]] = {
    "load_thermal": STICKY | TIMED | HEAT | {"experiment": {"kind": "load", "force": 0.5}},
    "path": STICKY | {"horizontal": {}, "experiment": {"kind": "path", "displacements": [-0.05, 0.1, 0.0]}},
    "pull_off": STICKY | {"experiment": PULL_OFF},
    "pull_off_dynamic": STICKY | TIMED | {"accuracy": {"tolerance": 5e-2}} | {"experiment": PULL_OFF},
    "units": {
        "bodies": MICRO | {"lower": "rigid_plane"},
        "experiment": {"kind": "path", "displacements": {"from": 0.0, "to": 5e-7, "steps": 5}},
    },
    "plane_adhesion": STUCK | {"experiment": PULL_OFF},
    "slide": chains(
        30.0, 2.0, (1.0, 0.5, 0.5, 1.0), title="slide", bodies={"particles": 60}, horizontal={},
        damping={"coefficient": "auto"}, plate={"free": ["x", "z"]}, cantilever={"stiffness": 20.0, "velocity": 0.05},
        experiment={"kind": "slide", "normal_force": 1.0, "distance": 3.0}, **COARSE,
    ),
    "tangential": {
        "bodies": STUCK["bodies"] | {"particles": "auto"},
        "friction": {"coefficient": 0.3},
        "experiment": {"kind": "tangential", "normal_force": [4.0, 2.0, 3.0], "displacements": [0.1, 0.2, 0.0]},
    },
}  # fmt: skip
"""Every way to move, both methods, chains and plane, rows that are steps of one run and rows that are not."""
FEW = 6
USUAL = [(name, None) for name in ("load_thermal", "path", "pull_off", "slide")]
KEEPING = [(name, "all") for name in ("pull_off", "pull_off_dynamic", "plane_adhesion", "tangential", "units")]
SOME = [("pull_off", FEW), ("plane_adhesion", FEW)]
Make = Callable[[tuple[str, Any]], Run]


@pytest.fixture(scope="module")
def make(tmp_path_factory: pytest.TempPathFactory) -> Make:
    """The run of a scene and its `[output] states`, each once."""
    kept: dict[tuple[str, Any], Run] = {}

    def made(case: tuple[str, Any]) -> Run:
        if case not in kept:
            name, states = case
            tables = {"title": name} | SCENES[name] | ({"output": {"states": states}} if states else {})
            kept[case] = run(tables, tmp_path_factory.mktemp(name), figures=False)
        return kept[case]

    return made


def repeat(folder: Path) -> None:
    """`cd folder && lmp -in in.lammps`, without a warning that means something."""
    said = [line for line in lmp(folder).splitlines() if line.startswith("WARNING")]
    assert [line for line in said if not any(words in line for words in HARMLESS)] == []


def curve(folder: Path) -> tuple[list[str], Array]:
    """Phases, and (displacement, force) of every line of curve.txt."""
    rows = [line.split() for line in (folder / "curve.txt").read_text().splitlines()]
    assert rows[0] == ["#", "phase", "displacement[LU]", "force[FU]"]
    return [row[0] for row in rows[1:]], np.asarray([row[1:] for row in rows[1:]], dtype=float)


@pytest.mark.parametrize("case", [*USUAL, *KEEPING, *SOME], ids=str)
def test_lmp_repeats_the_run_bitwise(make: Make, case: tuple[str, Any], tmp_path: Path) -> None:
    """In a copy that has only what a deck reads, and states of another run; the folder has nothing left over."""
    folder = make(case).folder
    for name in READ:
        if (folder / name).exists():
            shutil.copy(folder / name, tmp_path / name)
    (tmp_path / "states.lammpstrj").write_text("what another run has left\n")
    repeat(tmp_path)
    for name in ("curve.txt", "states.lammpstrj"):
        assert (tmp_path / name).read_bytes() == (folder / name).read_bytes(), name
    names = {path.name for path in folder.iterdir()}
    assert not [name for name in names if name.endswith(".part") or name.startswith("saved")]
    assert {"in.lammps", "system.data", "curve.txt", "states.lammpstrj", "curve.csv", "results.json"} <= names
    assert ("interaction.table" in names) == ("interaction" in SCENES[case[0]])
    assert read_json(folder / "results.json") == make(case).document


def test_the_stiffness_of_neighbours_is_told_once(tmp_path: Path) -> None:
    """With k_n changed in in.lammps alone a deck gives the forces of a scene with that k_n."""
    decks = [
        write_deck(SCENES["path"] | {"title": "k_n", "neighbours": {"stiffness": k}}, tmp_path / str(k))
        for k in (0.3, 0.5)
    ]
    text, given = (decks[0] / "in.lammps").read_text(), "neighbours_bond_coefficient index "
    (decks[0] / "in.lammps").write_text(text.replace(f"{given}0.15", f"{given}0.25"))
    for deck in decks:
        repeat(deck)
    changed, forces = (curve(deck)[1] for deck in decks)
    assert changed == pytest.approx(forces, rel=SUM)


PASSING = ("path", "slide", "pull_off", "tangential")
"""Experiments whose deck may have rows that are no results: between two places, while loading, after the loss."""


@pytest.mark.parametrize("case", [*USUAL, *KEEPING], ids=str)
def test_numbers_can_be_read_off_the_curve(make: Make, case: tuple[str, Any]) -> None:
    """Every state of the results is a line, bitwise and in order; the largest tension, the last state, the mean."""
    finished = make(case)
    phases, rows = curve(finished.folder)
    kind, results, states = finished.document["experiment"], finished.model.results, finished.outcome.states
    assert len(rows) == len(states) or kind in PASSING
    lines = iter(zip(phases, rows.tolist(), strict=True))
    for state in states:
        force = next(f for phase, (d, f) in lines if (phase, d) == (state.phase, state.displacement))
        assert force == pytest.approx(state.force, rel=SUM, abs=SUM)
    if kind == "load":
        wanted = rows[[phase == "sampling" for phase in phases]].mean(axis=0)
        assert [results[name].value for name in ("displacement", "force")] == pytest.approx(wanted, rel=SUM)
    if kind == "pull_off":
        adhesion, held = results["adhesion_force"], rows[[phase in ("unloading", "pulling") for phase in phases], 1]
        bend = float(np.abs(np.diff(held, 2)).max())  # the quantity is the vertex between rows: an eighth of it at most
        assert -held.min() - adhesion.uncertainty - SUM <= adhesion.value
        assert adhesion.value <= -held.min() + 0.25 * bend + adhesion.uncertainty + SUM
        loaded = rows[[phase == "loading" for phase in phases], 1]
        assert loaded[-1] == pytest.approx(results["preload"].value, rel=SUM)


def test_the_frames_of_a_pull_off_are_those_of_its_radii_and_profiles_with_action_and_reaction(make: Make) -> None:
    """The first is the zero-load state, the second the critical one."""
    finished = make(("pull_off", None))
    for index, (radius, state) in enumerate((("zero_load_radius", "zero_load"), ("critical_radius", "critical"))):
        frame, profile = atoms(finished.folder, index), finished.profiles[state]
        upper = (frame.arrays["body"] == "upper") & (frame.arrays["role"] == "particle")
        force = frame.arrays["opposite_force"]
        assert np.abs(force.sum(axis=0)).max() < SUM * np.abs(force).sum()
        place = abs(frame.positions[upper, 0][force[upper, 2].argmin()])
        assert finished.results[radius].value == pytest.approx(place, abs=NEAREST)
        np.testing.assert_allclose(frame.positions[upper, 2], profile.z_upper, rtol=SUM)
        np.testing.assert_allclose(force[upper, 2], profile.pressure, atol=SUM)


@pytest.mark.parametrize("case", [("load_thermal", None), ("units", "all")], ids=str)
def test_a_run_read_from_its_folder_is_the_one_that_was_made(make: Make, case: tuple[str, Any]) -> None:
    """From memory, from the files and through a pickle it has one face, to the last bit."""
    finished = make(case)
    for loaded in (load_run(str(finished.folder)), pickle.loads(pickle.dumps(finished))):
        assert loaded == finished
        for name in ("scene", "results", "warnings", "timing"):
            assert getattr(loaded, name) == getattr(finished, name), name
        assert repr(loaded) == repr(finished)
        for table, columns in finished.tables.items():
            for name, column in columns.items():
                np.testing.assert_array_equal(loaded.tables[table][name], column)
        assert loaded.tables.keys() == finished.tables.keys()


@pytest.mark.parametrize("case", KEEPING, ids=str)
def test_each_row_of_the_curve_is_a_frame_with_types_places_and_forces_that_ase_finds(
    make: Make, case: tuple[str, Any]
) -> None:
    """Plain `ase.io.read`, no format and no column named; states.npz, that the page moves through, is all of it."""
    whole = make(case)
    frames = ase.io.read(whole.folder / "states.lammpstrj", index=":")
    assert len(frames) == len(whole.curve.force)
    for frame, force in zip(frames, whole.curve.force, strict=True):
        upper = frame.arrays["type"] == 2
        assert frame.get_forces()[upper, 2].sum() == pytest.approx(force, rel=SUM, abs=SUM)
        assert not frame.get_forces()[:, 1].any()
    np.testing.assert_allclose(atoms(whole.folder).positions, frames[-1].positions, rtol=SUM)
    np.testing.assert_array_equal(atoms(whole.folder).arrays["opposite_force"], frames[-1].get_forces())
    kept, largest = read_states(whole.folder / "states.npz"), float(np.abs(whole.curve.force).max())
    assert kept.rows.tolist() == list(range(len(whole.curve.force)))
    np.testing.assert_allclose(frames[-1].positions[upper, 0], kept.x[-1], rtol=SINGLE)
    carried = whole.scene.bodies.own_spacing * kept.pressure.sum(axis=1)
    np.testing.assert_allclose(carried, whole.curve.force, rtol=SINGLE, atol=SINGLE * largest)


@pytest.mark.parametrize("case", SOME, ids=str)
def test_some_states_are_frames_of_all_and_the_results_are_those_without_any(make: Make, case: tuple[str, Any]) -> None:
    """So many frames as asked for, first and last among them, and bitwise the numbers of a run that keeps none."""
    some, whole = make(case), make((case[0], "all"))
    assert some.results == whole.results
    if case[0] == "pull_off":
        assert some.results == make(("pull_off", None)).results
    frames, every = (
        (kept.folder / "states.lammpstrj").read_text().split("ITEM: TIMESTEP\n")[1:] for kept in (some, whole)
    )
    assert len(frames) == FEW
    assert (frames[0], frames[-1]) == (every[0], every[-1])
    assert frames == [frame for frame in every if frame in frames]


QUICK = {
    "pull_off": ["bodies.particles=60", "experiment.preload=0.3"],
    "slide": ["experiment.distance=0.5"],
}


@pytest.mark.parametrize("name", QUICK)
def test_deck_of_a_shipped_scene_runs_under_lmp(name: str, tmp_path: Path) -> None:
    """`contact1d deck SCENE --out DIR`, then `lmp -in in.lammps` there: no error, every row measured and finite."""
    scene = ROOT / "lammps_inputs" / "scenes" / f"{name}.toml"
    small = [word for change in QUICK[name] for word in ("--set", change)]
    written = contact1d("deck", scene, "--out", tmp_path / "deck", *small)
    assert written.exit_code == 0, written.output
    lmp(tmp_path / "deck")
    phases, rows = curve(tmp_path / "deck")
    planned = re.findall(r"^# phase (\w+): (\d+) rows$", (tmp_path / "deck" / "in.lammps").read_text(), re.MULTILINE)
    assert Counter(phases) == {name: int(count) for name, count in planned}
    assert np.isfinite(rows).all()
    assert (tmp_path / "deck" / "states.lammpstrj").stat().st_size > 0


@pytest.mark.parametrize(
    ("bodies", "tables", "far"),
    [
        ({}, {"interaction": PAIR}, -3000.0),
        ({"lower": "rigid_chain"}, {"interaction": PAIR}, -60.0),
        ({"lower": "rigid_plane"}, {"neighbours": {"stiffness": 0.2}}, -3000.0),
    ],
)
def test_a_path_far_apart_stays_in_the_box(
    bodies: dict[str, Any], tables: dict[str, Any], far: float, tmp_path: Path
) -> None:
    """No particle is lost, in the run or by `lmp`, and nothing pulls at that distance."""
    path = {"kind": "path", "displacements": [0.0, far]}
    finished = run({"title": "far", "bodies": BODY | bodies, "experiment": path} | tables, tmp_path, figures=False)
    assert finished.curve.displacement[-1] == pytest.approx(far, rel=1e-12)
    assert finished.curve.force[-1] == 0.0
    repeat(finished.folder)


def test_a_dump_that_is_cut_short_or_lacks_a_column_is_refused_and_atoms_come_by_their_ids(
    make: Make, tmp_path: Path
) -> None:
    """They have no energy and no element."""
    folder, dump = make(("pull_off", None)).folder, tmp_path / "states.lammpstrj"
    lines = (folder / "states.lammpstrj").read_text().splitlines(keepends=True)
    second = lines.index("ITEM: TIMESTEP\n", 1)
    first = "".join(lines[:second])
    with pytest.raises(FileNotFoundError, match="no folder of a finished run"):
        atoms(tmp_path)
    with pytest.raises(IndexError, match="holds 2 states"):
        atoms(folder, 2)
    for text, told in (
        (first[: len(first) // 10], "cut short"),
        (first[:-1], "cut short"),
        (first.replace("opposite_fx opposite_fz", "fx fz"), "no column opposite_fx, opposite_fz"),
    ):
        dump.write_text(text)
        with pytest.raises(ValueError, match=told):
            atoms(tmp_path)
    dump.write_text("".join(lines[:9] + lines[9:second][::-1]))
    state, reference = atoms(tmp_path), atoms(folder, 0)
    assert state.calc is None
    assert set(state.get_chemical_symbols()) == {"X"}
    for name, values in reference.arrays.items():
        np.testing.assert_array_equal(state.arrays[name], values)
