"""system.data: LAMMPS reads back bitwise what was assembled; types, bonds and masses are those of the scene."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Scene
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.system import System, assemble, write_data, write_system
from contact1d.workflow.engine.session import Session
from contact1d.workflow.model.settings import settings_for

MakeScene = Callable[..., Scene]
OpenDeck = Callable[[Scene], tuple[Deck, Session]]

READ = """units lj
dimension 3
boundary f f f
atom_style bond
atom_modify map yes
read_data system.data
comm_modify cutoff 5.0
variable all_mass atom mass
"""
PARTICLES = 20
CASES: dict[str, dict[str, Any]] = {
    "plain": {},
    "neighbours": {"neighbours": {"stiffness": 0.3}},
    "far": {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": 0.5}},
    "all": {
        "horizontal": {},
        "neighbours": {"stiffness": 0.3},
        "bodies": {"bulk_stiffness_tangential": 1.7, "spacing": 0.7, "mass": 0.3},
    },
    "plane": {"interaction": None, "bodies": {"lower": "rigid_plane"}, "neighbours": {"stiffness": 0.3}},
}


def system_of(scene: Any) -> System:
    """What write_system assembles, with a margin of its own."""
    both = bodies(scene, settings_for(scene))
    return assemble(both, scene.neighbours is not None, scene.bodies.mass, 2.5, (17.0, 11.0, 123.0))


def bonds_in(session: Session) -> list[list[int]]:
    """[atom, atom, type] of every bond as LAMMPS holds it, sorted."""
    session.execute("write_data back.data nocoeff")
    rows = (session.folder / "back.data").read_text().split("\nBonds\n\n")[1].splitlines()
    bonds = [[int(word) for word in row.split()[1:]] for row in rows]
    return sorted([*sorted(atoms), kind] for kind, *atoms in bonds)


@pytest.mark.parametrize("case", CASES)
def test_lammps_reads_back_what_was_assembled(make_scene: MakeScene, session: Session, case: str) -> None:
    """Positions bitwise, types, bonds, masses, box."""
    system = system_of(make_scene(**CASES[case]))
    write_data(system, "title", session.folder / "system.data")
    session.execute(READ)
    read = session.atoms("x", "v_all_mass")
    assert np.array_equal(read["x"], system.positions)
    assert np.array_equal(read["type"], system.types)
    assert read["v_all_mass"].tolist() == [system.masses[t - 1] for t in system.types]
    wanted = sorted([*sorted((a, b)), kind] for kind, a, b in system.bonds.tolist())
    assert bonds_in(session) == wanted
    edges = ("xlo", "ylo", "zlo", "xhi", "yhi", "zhi")
    assert session.values(*edges) == tuple(system.box.ravel())
    assert [file.name for file in session.folder.glob("*.part")] == []


def test_the_plate_has_its_mass(make_scene: MakeScene, open_deck: OpenDeck) -> None:
    """Shared out among the upper anchors, long bonds' ones included; particles have their own."""
    timed = {"damping": {"coefficient": "auto"}, "plate": {"mass": 37.0}}
    experiment = {"kind": "load", "force": 0.1}
    for case in ("plain", "all"):
        scene = make_scene(**CASES[case], **timed, experiment=experiment)
        _, session = open_deck(scene)
        assert session.value("mass(plate)") == pytest.approx(37.0, rel=1e-12)
        assert session.value("mass(upper)") == pytest.approx(PARTICLES * scene.bodies.mass, rel=1e-12)


def test_all_atoms_are_inside_the_box_with_room(make_scene: MakeScene, tmp_path: Path) -> None:
    """Also on a slide, whose plate moves by the distance along x."""
    slide = {
        "damping": {"coefficient": "auto"},
        "plate": {"free": ["x", "z"]},
        "horizontal": {},
        "cantilever": {"stiffness": 0.5, "velocity": 0.01},
        "experiment": {"kind": "slide", "normal_force": 0.1, "distance": 500.0},
    }
    system = system_of(make_scene())
    low, high = system.box
    assert (system.positions - low >= [17.0, 1.0, 123.0]).all()
    assert (high - system.positions >= [17.0, 1.0, 123.0]).all()
    scene = make_scene(**slide)
    write_system(Deck(scene, settings_for(scene)), tmp_path)
    box = [line.split() for line in (tmp_path / "system.data").read_text().splitlines() if line.endswith("xhi")]
    assert float(box[0][1]) >= 0.5 * PARTICLES + 500.0


TITLES = ["R = 1000 µm", "a # in it", "${undefined} $x", "ends with &", 'three """ quotes', "include nothing", "日本"]


@pytest.mark.parametrize("title", TITLES)
def test_a_title_is_only_a_title(make_scene: MakeScene, open_deck: OpenDeck, title: str) -> None:
    """Whatever it says, data file and deck are read alike."""
    _, session = open_deck(make_scene(title=title))
    assert session.value("count(all)") == 4 * PARTICLES
    assert (session.folder / "system.data").read_text(encoding="utf-8").splitlines()[0] == f"# {title}"
