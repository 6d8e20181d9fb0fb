"""Every number of every table with a unit takes a text, and every unit has words."""

from __future__ import annotations

import tomllib
from typing import Any, get_args, get_origin

import pytest

from contact1d.workflow.scene import Scene, Slide, Tangential, read_scene
from contact1d.workflow.scene.places import places, powers
from contact1d.workflow.scene.quantities import Table, Unit, annotation_of, keys_of
from contact1d.workflow.scene.si_text import UnitTextError, in_words, si_value
from contact1d.workflow.scene.wording import members, statement, table_of, text_of, unit_of, unwrapped
from contact1d.workflow.units import SI
from tests.scenes import STEEL_ON_GLASS
from tests.unit.test_scene_units import SLIDE

TANGENTIAL = """
title = "Mindlin in SI"
[bodies]
particles = "auto"
spacing = "4 µm"
profile = { kind = "parabola", radius = "10 mm" }
lower = "rigid_plane"
[material]
upper = { youngs_modulus = "210 GPa", poisson_ratio = 0.3 }
lower = { youngs_modulus = "70 GPa", poisson_ratio = 0.22 }
[friction]
coefficient = 0.3
[experiment]
kind = "tangential"
normal_force = ["10 N", "11 N", "12 N"]
displacements = ["0 nm", "100 nm", "0.2 µm"]
"""
PRANDTL_TOMLINSON = """
title = "PT"
[bodies]
particles = 32
upper_particles = 1
spacing = "0.3 nm"
upper_offset = "10 pm"
lower = "rigid_chain"
periodic = true
profile = { kind = "flat" }
bulk_stiffness = "1 N/m"
mass = "1e-25 kg"
[interaction]
repulsion  = { amplitude = "0.3 eV", range = "0.15 nm" }
attraction = { amplitude = "0.15 eV", range = "0.3 nm" }
[horizontal]
[damping]
coefficient = "auto"
[plate]
mass = "auto"
free = ["x", "z"]
damping = 0.0
[cantilever]
stiffness = "0.05 N/m"
velocity = "1 m/s"
[experiment]
kind = "slide"
normal_force = "0.1 nN"
path = [["1 m/s", "1 nm"], ["2 m/s", "3 nm"]]
"""


def test_tables_on_the_plane_and_rows_of_an_experiment_take_texts() -> None:
    experiment = read_scene(TANGENTIAL).experiment
    assert isinstance(experiment, Tangential)
    assert experiment.normal_force == (10.0, 11.0, 12.0)
    assert experiment.displacements == (0.0, 1e-7, 2e-7)
    adhesive = read_scene(STEEL_ON_GLASS, ["adhesion.surface_energy=50 mJ/m²"])
    assert adhesive.adhesion is not None
    assert adhesive.adhesion.work == 0.1
    sliding = read_scene(PRANDTL_TOMLINSON).experiment
    assert isinstance(sliding, Slide)
    assert [(leg.velocity, leg.distance) for leg in sliding.legs(0.0)] == [(1.0, 1e-9), (2.0, 3e-9)]


def tables(annotation: object) -> set[type[Table]]:
    """All tables inside a type."""
    found: set[type[Table]] = set()
    for member in members(annotation):
        inner = unwrapped(member)[0]
        if get_origin(inner) is tuple:
            found |= set().union(*(tables(item) for item in get_args(inner) if item is not Ellipsis))
        elif table := table_of(member):
            found |= {table}.union(*(tables(annotation_of(table, key)) for key in keys_of(table)))
    return found


def test_every_number_with_a_unit_takes_a_text_in_every_table() -> None:
    """Also in tables that are not here yet: a number whose unit its type does not say in a way that is read fails."""
    known = tables(Scene)
    assert len(known) > 20
    for table in known:
        for key in keys_of(table):
            annotation = annotation_of(table, key)
            if unit_of(annotation) in (None, "1"):
                continue
            text = text_of(annotation)
            assert text, (table, key)
            data = {
                key: [text]
                if "a list" in statement(annotation) and "a number" not in statement(annotation)[:9]
                else text
            }
            assert [place.value for place in places(table, data) if place.is_text] == [text], (table, key)


def units_of(table: Any) -> set[str]:
    return {place.unit.name for place in places(Scene, table)}


def test_every_unit_of_a_scene_has_words() -> None:
    found = units_of(SLIDE) | units_of(tomllib.loads(STEEL_ON_GLASS)) | {name for name in SI if name != "1"}
    assert {"LU", "FU", "MU", "FU·LU", "FU/LU", "LU/TU", "FU·TU/LU", "Pa", "1"} <= found
    for name in found:
        words = in_words(name)
        assert words.startswith(("a ", "an ")), name
        if name != "1":
            assert "quantity in" not in words, name
            with pytest.raises(UnitTextError, match="is an electric charge"):
                si_value("1 C", name)


def test_powers_of_the_model_units_are_read_off_the_name() -> None:
    assert powers("FU·TU/LU") == {"FU": 1, "TU": 1, "LU": -1}
    assert powers("FU/LU²") == {"FU": 1, "LU": -2}
    assert powers("J/m²") == {}
    assert Unit("FU·LU", text=("K", "J")).texts == ("K", "J")
