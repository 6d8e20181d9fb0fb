"""Removing an effect removes exactly its lines, its variables and its part of a shared slot.

Decks are compared as text, with the same settings and the same schedule: what is left must be the deck of the scene
without the effect, in the same order. `Deck` is asked directly, so that effects may also go which an experiment needs.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from contact1d import Scene
from contact1d.potentials.table import write_table
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.experiments import planned
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.scene import EFFECTS

MakeScene = Callable[..., Scene]

ROOT = Path(__file__).parents[2] / "lammps_inputs" / "fragments"
ALL: dict[str, Any] = {
    "neighbours": {"stiffness": 0.3},
    "horizontal": {},
    "damping": {"coefficient": "auto"},
    "noise": {"temperature": 1e-3, "seed": 1},
    "plate": {"free": ["x", "z"]},
    "cantilever": {"stiffness": 0.5, "velocity": 0.01},
    "experiment": {"kind": "slide", "normal_force": 0.1, "distance": 5.0},
}
PLANE: dict[str, Any] = {"interaction": None, "bodies": {"lower": "rigid_plane"}}
TANGENTIAL = {"kind": "tangential", "normal_force": 0.1, "displacements": {"from": 0.0, "to": 0.01, "steps": 3}}
ON_PLANES: dict[str, Any] = {
    "friction": PLANE | {"friction": {"coefficient": 0.3}, "experiment": TANGENTIAL},
    "adhesion": {
        "interaction": None,
        "bodies": {"lower": "rigid_plane", "reduction": "mdr"},
        "adhesion": {"work_of_adhesion": 5e-4},
    },
}
"""What stands on a rigid plane only, each effect with the scene that it is taken from."""
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
LOAD = {"kind": "load", "force": 0.1}
EMPTY = {"# Formula: -", "# Needs: -", "# Defines: -"}
"""Header lines that any fragment may have."""
FRAGMENTS = {name: (name,) for name in EFFECTS} | {"horizontal": ("horizontal", "far")}
STEPS = {
    "interaction": ("steps/measuring_opposite", "steps/measured_opposite"),
    "noise": ("steps/heat", "steps/heating"),
    "cantilever": ("steps/drive", "steps/tallied_heat", "steps/measuring_energy", "steps/measured_energy"),
}


def lines_of(deck: str) -> list[str]:
    """Lines with something on them, without the one that lists the effects."""
    return [line for line in deck.splitlines() if line and not line.startswith("# effects: ")]


def fragment_lines(*names: str) -> Counter[str]:
    return Counter(line for name in names for line in (ROOT / f"{name}.lmp").read_text(encoding="utf-8").splitlines())


def needs(*names: str) -> set[str]:
    return {word for name in names for word in header(name, "Needs")}


def header(name: str, key: str) -> list[str]:
    """Words of one line of a fragment's header, explanations in brackets left out."""
    lines = (ROOT / f"{name}.lmp").read_text(encoding="utf-8").splitlines()
    found = next(line for line in lines if line.startswith(f"# {key}: "))
    return [word for word in re.sub(r"\(.*?\)", "", found).split()[2:] if word != "-"]


def difference(first: str, second: str) -> Counter[str]:
    return Counter(lines_of(first)) - Counter(lines_of(second))


def without(scene: Scene, effect: str) -> Scene:
    """The scene with one table less, whatever the rules across tables say."""
    return scene.model_copy(update={effect: None})


class Unchecked(Deck):
    """A deck whose schedule may need the effect that is taken away."""

    def _check_schedule(self, phases: object) -> None: ...


def decks(scene: Scene, effect: str) -> tuple[str, str]:
    """The deck with and without an effect; same settings, same schedule."""
    settings: Settings = settings_for(scene)
    fewer = replace(settings, chains=replace(settings.chains, far=0.0)) if effect == "horizontal" else settings
    phases = planned(scene, settings)
    short = phases
    if effect == "cantilever":
        short = tuple(replace(phase, begin=()) for phase in phases)
    return Deck(scene, settings).text(phases), Unchecked(without(scene, effect), fewer).text(short)


def is_slot(line: str, effect: str) -> bool:
    """Shared slots that an effect fills."""
    slots = {"interaction": "pair_style ", "friction": "atom_style "}
    return effect in slots and line.startswith(slots[effect])


def is_rest_of(rest: list[str], whole: list[str]) -> bool:
    """Whether `rest` is `whole` with lines left out, in the same order."""
    remaining = iter(whole)
    return all(line in remaining for line in rest)


@pytest.mark.parametrize("noise", [True, False], ids=["noise", "still"])
@pytest.mark.parametrize("effect", EFFECTS)
def test_one_effect_off(make_scene: MakeScene, effect: str, noise: bool) -> None:
    """From a slide with every effect, and from one without noise, in which damping has lines of its own."""
    scene = make_scene(**ON_PLANES.get(effect, ALL if noise else ALL | {"noise": None}))
    if effect not in scene.effects:
        return
    first, second = decks(scene, effect)
    removed, added = difference(first, second), difference(second, first)
    own = fragment_lines(effect)
    variables = needs(effect)
    if effect == "damping" and noise:
        assert not removed  # the Langevin thermostat has it
        assert not added
        return
    steps = fragment_lines(*STEPS.get(effect, ()))
    for line in removed:
        if line in own or line in steps or is_slot(line, effect):
            continue
        match = re.match(r"variable +(\w+) index ", line)
        assert match is not None, line
        assert match[1] in variables, line
    for line, count in own.items():
        assert removed[line] >= count or line in EMPTY
    if effect == "horizontal":
        assert list(added) == ["variable        guide_x index 0.0"]
    elif effect == "cantilever":
        assert list(added) == ["thermo_style    custom step c_measuring_total"]  # the energy is not asked for
    elif effect == "friction":
        assert list(added) == ["atom_style      atomic"]
    elif effect == "noise":
        extra = set(added) - set(fragment_lines("damping"))
        assert [line.split()[1] for line in extra] == ["damping_coefficient"]
        assert set(added) == extra | set(fragment_lines("damping"))
    else:
        assert not added
        assert is_rest_of(lines_of(second), lines_of(first))


@pytest.mark.parametrize("stiffness", [0.5, 1.4])
def test_long_bonds_go_with_the_horizontal_effect(make_scene: MakeScene, stiffness: float) -> None:
    """With k_t ≠ k_n: its second fragment goes, and the bulk bond is that of the normal direction again."""
    plate = {"free": ["x", "z"], "damping": 4.0}
    still = ALL | {"noise": None}  # with noise the drag comes with its heat, to one anchor
    scene = make_scene(**still | {"plate": plate, "bodies": {"bulk_stiffness_tangential": stiffness}})
    first, second = decks(scene, "horizontal")
    removed, added = difference(first, second), difference(second, first)
    lines = fragment_lines("horizontal", "far")
    names = {line.split()[1] for line in removed if line not in lines}
    softer = {"bulk_bond_coefficient"} if stiffness < 0.83 else set()
    drag = {"plate_damping_per_anchor"}  # twice as many anchors share the plate's drag
    assert names == needs("far") | softer | drag
    assert {line.split()[1] for line in added} == {"guide_x"} | softer | drag
    assert not set(fragment_lines("far")) - set(removed) - EMPTY


def text_of(scene: Scene) -> str:
    settings = settings_for(scene)
    return Deck(scene, settings).text(planned(scene, settings))


def commands(deck: str) -> str:
    """The deck without comments."""
    return "\n".join(line for line in deck.splitlines() if not line.startswith("#"))


@pytest.mark.parametrize("effect", EFFECTS)
def test_a_scene_that_never_had_the_effect_has_none_of_its_lines(make_scene: MakeScene, effect: str) -> None:
    """Through the front door, settings and all: no line, fix, compute or variable of an absent effect."""
    base: dict[str, Any] = PLANE if effect == "interaction" else {}
    timed = TIMED | {"experiment": LOAD} if effect not in ("damping", "plate") else {}
    scene = make_scene(**base, **timed)
    assert effect not in scene.effects
    text = text_of(scene)
    assert effect not in text.splitlines()[1]
    shared = set(fragment_lines("steps/measuring"))  # a cantilever measures the energy as well
    own = set(fragment_lines(*FRAGMENTS[effect], *STEPS.get(effect, ()))) - EMPTY - shared
    assert not own & set(lines_of(text))
    of_plane = {"opposite_x", "opposite_z"} if effect == "interaction" else set()
    of_guide = {"guide_x"} if effect == "horizontal" else set()
    of_bodies = {"plate_displacement"}
    for name in {*header(effect, "Needs"), *header(effect, "Defines")} - of_plane - of_guide - of_bodies:
        assert not re.search(rf"\b(?:\w_)?{name}\b", commands(text))


def test_no_attraction_in_the_table_without_attraction(make_scene: MakeScene, tmp_path: Path) -> None:
    """Nor in its header; the deck's head differs in numbers only."""
    repulsive = {"repulsion": {"amplitude": 0.18, "range": 0.13}}
    scene, adhesive = make_scene(interaction=repulsive), make_scene()
    write_system(Deck(scene, settings_for(scene)), tmp_path)
    header, rows = (tmp_path / "interaction.table").read_text().split("DOUBLE_EXPONENTIAL")
    assert header.count("exp(") == 1
    forces = [float(row.split()[3]) for row in rows.splitlines()[3:]]
    assert min(forces) > 0
    numbers = re.compile(r"(?<= )-?\d\S*")
    settings = settings_for(adhesive)
    heads = Deck(scene, settings_for(scene)).head, Deck(adhesive, settings).head
    assert numbers.sub("…", heads[0]) == numbers.sub("…", heads[1])
    assert settings.forces.table is not None
    write_table(settings.forces.table, settings.forces.closest, tmp_path / "adhesive.table")
    assert (tmp_path / "adhesive.table").read_text().split("DOUBLE")[0].count("exp(") == 2
