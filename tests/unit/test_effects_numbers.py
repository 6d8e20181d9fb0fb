"""Claim: the numbers that effects put into a deck are the scene's physics, whatever it counts particles and anchors in.

References: the scene's own values, sums over the atoms that system.data has.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.reference.jkr import work_of_adhesion
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects import contributions
from contact1d.workflow.deck.effects.base import Contribution
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.scenes import chains

LOAD = {"kind": "load", "method": "dynamic", "force": 0.5}
HOT = {"damping": {"coefficient": 0.3}, "noise": {"temperature": 1e-3, "seed": 7}, "experiment": LOAD}
SLIDE = chains(
    30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": 0.3},
    plate={"free": ["x", "z"], "mass": 6.0, "damping": 0.2}, cantilever={"stiffness": 0.5, "velocity": 0.1},
    bodies={"mass": 0.5, "particles": 60, "upper_particles": 12, "upper_offset": 0.5, "spacing": 0.8},
    experiment={"kind": "slide", "normal_force": 1.0, "path": [[0.1, 3.0], [-0.2, 1.0]]},
)  # fmt: skip
UPPER_ANCHOR, UPPER_FAR = "4", "6"
"""Atom types of system.data."""


def brought(tables: dict[str, Any], name: str) -> tuple[Scene, Contribution]:
    scene = scene_from_dict(tables)
    return scene, {part.name: part for part in contributions(scene, settings_for(scene))}[name]


def types(tables: dict[str, Any], folder: Path) -> list[str]:
    """The type of each atom, by its number less 1."""
    scene = scene_from_dict(tables)
    write_system(Deck(scene, settings_for(scene)), folder)
    atoms = (folder / "system.data").read_text(encoding="utf-8").partition("Atoms")[2].partition("Bonds")[0]
    rows = [words for words in map(str.split, atoms.splitlines()) if words and words[0].isdigit()]
    return [words[2] for words in sorted(rows, key=lambda words: int(words[0]))]  # number, molecule, type, place


@pytest.mark.parametrize("bodies", [
    {"particles": 40}, {"particles": 60, "upper_particles": 12, "lower": "rigid_chain", "upper_offset": 0.5},
    {"particles": 60, "upper_particles": 12, "upper_offset": 0.5},
])  # fmt: skip
def test_the_plates_heat_goes_to_an_anchor_of_the_plate(bodies: dict[str, Any], tmp_path: Path) -> None:
    tables = SLIDE | {"noise": {"temperature": 1e-3, "seed": 7}, "bodies": SLIDE["bodies"] | bodies}
    if "upper_offset" not in bodies:
        tables["bodies"].pop("upper_particles")
    scene, noise = brought(tables, "noise")
    number = int(noise.variables["noise_plate_id"])
    kinds = types(tables, tmp_path)
    assert kinds[number - 1] == UPPER_ANCHOR
    assert UPPER_ANCHOR not in kinds[: number - 1]
    settings = settings_for(scene)
    # m/γ of a particle; of the plate its mass over its drag, as one anchor's share of the mass is that atom's own.
    assert float(noise.variables["noise_damp"]) == pytest.approx(0.5 / 0.3)
    anchors = kinds.count(UPPER_ANCHOR)
    assert float(noise.variables["noise_plate_damp"]) == pytest.approx(6.0 / anchors / 0.2)
    assert settings.particles == anchors


def test_heat_is_told_in_a_slide_only_and_the_plate_without_drag_has_none() -> None:
    _, noise = brought(SLIDE | {"noise": {"temperature": 1e-3, "seed": 7}}, "noise")
    assert noise.fragments == ("noise", "noise_plate", "noise_calm")  # the last until the drive starts
    assert noise.step_begin == ("steps/heat", "steps/heat_plate")
    assert noise.step_end == ("steps/heating_plate",)
    for plate in ({}, {"mass": 5.0}):
        _, noise = brought(chains(100.0, bodies={"mass": 0.5}, plate=plate, **HOT), "noise")
        assert noise.fragments == ("noise",)
        assert (noise.step_begin, noise.step_end) == ((), ())
        assert (noise.variables["noise_seed"], float(noise.variables["noise_temperature"])) == ("7", 1e-3)


@pytest.mark.parametrize("tangential", [0.83, 1.4])
@pytest.mark.parametrize("hot", [False, True])
def test_the_drag_of_all_anchors_is_the_plates(tangential: float, hot: bool, tmp_path: Path) -> None:
    """Long bonds have anchors of their own on the plate; with noise the thermostat brings the drag."""
    tables = SLIDE | {"bodies": SLIDE["bodies"] | {"bulk_stiffness": 0.83, "bulk_stiffness_tangential": tangential}}
    if hot:
        tables |= {"noise": {"temperature": 1e-3, "seed": 7}}
    _, plate = brought(tables, "plate")
    kinds = types(tables, tmp_path)
    anchors = kinds.count(UPPER_ANCHOR) + kinds.count(UPPER_FAR)
    assert kinds.count(UPPER_FAR) == (0 if tangential == 0.83 else 12)
    assert anchors * float(plate.variables["plate_damping_per_anchor"]) == pytest.approx(0.0 if hot else 0.2)
    assert plate.variables["plate_free_x"] == "on"
    straight = {"plate": {"free": ["z"], "damping": 0.2}, "cantilever": None, "experiment": LOAD}
    assert brought({k: v for k, v in (tables | straight).items() if v is not None}, "plate")[1].variables[
        "plate_free_x"
    ] == "off"  # fmt: skip


def test_the_bath_goes_with_the_drive_and_drags_at_all_that_moves() -> None:
    """F = γ v on a particle, c v on the plate, with all legs of the drive and their timesteps."""
    scene, cantilever = brought(SLIDE, "cantilever")
    assert float(cantilever.variables["cantilever_drag"]) == 0.3
    assert float(cantilever.variables["cantilever_plate_drag"]) == 0.2
    assert cantilever.variables["cantilever_velocity"] == "0.1 -0.2"
    steps = [float(step) for step in cantilever.variables["cantilever_time_step"].split()]
    assert steps == [leg.time_step for leg in settings_for(scene).drive]


def test_bonds_have_half_of_their_stiffness_for_lammps_has_the_energy_without_a_half() -> None:
    """K (r − r₀)² = k (r − r₀)²/2."""
    tables = chains(
        100.0, 0.83, horizontal={}, neighbours={"stiffness": 0.3}, experiment=LOAD | {"method": "quasistatic"},
        bodies={"particles": 30, "bulk_stiffness_tangential": 1.5},
    )  # fmt: skip
    assert float(brought(tables, "neighbours")[1].variables["neighbours_bond_coefficient"]) == 0.15
    scene, sideways = brought(tables, "horizontal")
    settings = settings_for(scene)
    assert float(sideways.variables["far_bond_coefficient"]) == pytest.approx(0.5 * (1.5 - 0.83))
    assert float(sideways.variables["far_length"]) == settings.far > 1e3
    assert sideways.variables["far_bond_type"] == "3"
    # A long bond is no reason for cells that a hundred of would not span the box.
    assert float(sideways.variables["far_bin"]) == pytest.approx(settings.far / 100.0)
    alone = {name: table for name, table in tables.items() if name != "neighbours"}
    assert brought(alone, "horizontal")[1].variables["far_bond_type"] == "2"


def test_a_contact_on_the_plane_is_lost_where_fixed_grips_let_go() -> None:
    """d = −(3/4) (π² W² R/E*²)^(1/3) of JKR, and touch is at 0 but for round-off."""
    surface = 0.0025
    tables = {
        "title": "JKR",
        "bodies": {
            "particles": "auto", "spacing": 0.2, "profile": {"kind": "parabola", "radius": 100.0}, "reduction": "mdr",
            "lower": "rigid_plane", "bulk_stiffness": 0.4,
        },
        "adhesion": {"surface_energy": surface}, "experiment": {"kind": "pull_off", "preload": 2.0},
    }  # fmt: skip
    _, adhesion = brought(tables, "adhesion")
    work, modulus = work_of_adhesion(surface), 0.4 / 0.2
    lost = -0.75 * (np.pi**2 * work**2 * 100.0 / modulus**2) ** (1.0 / 3.0)
    assert float(adhesion.variables["adhesion_last"]) == pytest.approx(lost, rel=1e-5)
    assert float(adhesion.variables["adhesion_stiffness"]) == 0.4
    assert -1e-6 < float(adhesion.variables["adhesion_touch"]) < 0.0
