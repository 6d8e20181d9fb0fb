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

from contact1d.potentials.table import write_table
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.experiments import planned
from contact1d.workflow.scene import EFFECTS, Scene
from contact1d.workflow.settings.settings import Settings, settings_for

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
PULL_OFF = {"kind": "pull_off", "preload": 1.0}
EMPTY = {"# Formula: -", "# Needs: -", "# Defines: -"}
"""Header lines that any fragment may have."""
FRAGMENTS = {name: (name,) for name in EFFECTS} | {"horizontal": ("horizontal", "far")}
STEPS = {
    "interaction": ("steps/measuring_opposite", "steps/measured_opposite"),
    "noise": ("steps/heat", "steps/heating"),
    "cantilever": ("steps/drive", "steps/told", "steps/measuring_energy", "steps/measured_energy"),
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
    fewer = replace(settings, far=0.0) if effect == "horizontal" else settings
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


def test_numbering_of_bond_types_follows_the_effects(make_scene: MakeScene) -> None:
    """Without neighbours the long bonds' type is the second."""
    scene = make_scene(**ALL | {"bodies": {"bulk_stiffness_tangential": 0.5}})
    first, second = decks(scene, "neighbours")
    assert difference(second, first) == Counter(["variable        far_bond_type index 2"])
    assert "variable        far_bond_type index 3" in first


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


def test_no_langevin_without_noise(make_scene: MakeScene) -> None:
    quiet, noisy = (make_scene(**TIMED, experiment=LOAD, noise=noise) for noise in (None, ALL["noise"]))
    assert "langevin" not in commands(text_of(quiet))
    assert commands(text_of(quiet)).count(" viscous ") == 3  # particles (anew with each load) and plate
    assert commands(text_of(noisy)).count(" langevin ") == 1
    assert commands(text_of(noisy)).count(" viscous ") == 1  # the plate's


def test_no_rigid_body_without_a_plate(make_scene: MakeScene) -> None:
    prescribed = make_scene(damping={"coefficient": 0.3})
    assert prescribed.method == "dynamic"
    assert not re.search(r"fix +\w+ \w+ (rigid|addforce)", commands(text_of(prescribed)))
    moving = commands(text_of(make_scene(**TIMED, experiment=LOAD)))
    assert len(re.findall(r"fix +\w+ \w+ rigid ", moving)) == 1


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
    assert settings.table is not None
    write_table(settings.table, settings.closest, tmp_path / "adhesive.table")
    assert (tmp_path / "adhesive.table").read_text().split("DOUBLE")[0].count("exp(") == 2


@pytest.mark.parametrize("timed", [False, True])
def test_on_a_rigid_plane_no_pair_style_and_no_lower_body(make_scene: MakeScene, tmp_path: Path, timed: bool) -> None:
    more = TIMED | {"experiment": LOAD} if timed else {}
    scene = make_scene(**PLANE, **more)
    text = commands(text_of(scene))
    for word in ("pair_style", "pair_coeff", "neighbor ", "binsize", "lower", "tally", "table"):
        assert word not in text
    assert len(re.findall(r"fix +rigid_plane_wall upper wall/harmonic ", text)) == 1
    write_system(Deck(scene, settings_for(scene)), tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["system.data"]
    style, column = ("bond", 2) if timed else ("atomic", 1)  # molecules are there for bonds only
    rows = (tmp_path / "system.data").read_text().split(f"Atoms # {style}\n\n")[1].split("\n\n")[0].splitlines()
    assert Counter(row.split()[column] for row in rows) == ({"2": 20, "4": 20} if timed else {"2": 20})


RELAXING = PLANE | {"neighbours": {"stiffness": 0.3}}
"""On a rigid plane particles find their own places only where neighbours pull them."""


@pytest.mark.parametrize("tables", [PLANE, PLANE | {"experiment": LOAD}])
def test_where_nothing_has_to_come_to_rest_nothing_is_minimised(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    """One run for a phase, one step for a row; no bonds, no anchors."""
    scene = make_scene(**tables)
    text = commands(text_of(scene))
    for word in ("minimi", "min_style", "bond_style", "anchors", "jump ", "displace_atoms"):
        assert word not in text
    phases = planned(scene, settings_for(scene))
    assert re.findall(r"^run +(.*)$", text, re.MULTILINE) == [
        "0 post no",
        *["${row_count} pre no post no"] * len(phases),
    ]
    counts = re.findall(r"^variable +row_count index (\d+)$", text, re.MULTILINE)
    assert [int(count) for count in counts] == [len(phase.rows) for phase in phases]


def test_neighbours_on_a_rigid_plane_bring_what_moves(make_scene: MakeScene) -> None:
    """And no line of rows that are steps is left."""
    relaxing = commands(text_of(make_scene(**RELAXING)))
    assert "minimize " in relaxing
    assert "sweep" not in relaxing


@pytest.mark.parametrize("tables", [{}, RELAXING, {"experiment": LOAD}, {"experiment": PULL_OFF}])
def test_a_quasistatic_deck_has_no_time_in_it(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    text = commands(text_of(make_scene(**tables)))
    for word in (" nve", "viscous", "langevin", "velocity", " rigid "):  # its timestep is that of FIRE, a minimiser
        assert word not in text
    assert re.findall(r"^run +(.*)$", text, re.MULTILINE) == ["0 post no"] * text.count("\nrun ")
    assert "minimize " in text


def test_a_dynamic_deck_minimises_nothing(make_scene: MakeScene) -> None:
    for tables in ({"damping": {"coefficient": 0.3}}, TIMED | {"experiment": LOAD}, ALL):
        text = commands(text_of(make_scene(**tables)))
        assert "minimize" not in text
        assert "min_style" not in text
        assert len(re.findall(r"^timestep ", text, re.MULTILINE)) == 1


@pytest.mark.parametrize("tables", [{}, PLANE, {"damping": {"coefficient": 0.3}}, TIMED | {"experiment": LOAD}, ALL])
def test_each_group_has_one_integrator_at_most(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    """Particles by nve where there is time, the plate by the rigid body where there is one, a driver by its way."""
    scene = make_scene(**tables)
    found = re.findall(r"^fix +\w+ (\w+) (nve|nvt|npt|nph|rigid|move)\b", commands(text_of(scene)), re.MULTILINE)
    stepped = [("upper", "move")] * (tables == PLANE)
    wanted = (
        stepped
        + [("plate", "rigid")] * (scene.plate is not None)
        + [("particles", "nve")] * (scene.method == "dynamic")
    )
    wanted += [("cantilever_driver", "move")] * 2 * (scene.cantilever is not None)  # at rest, and then not
    assert sorted(found) == sorted(wanted)


@pytest.mark.parametrize("tables", [{}, RELAXING, TIMED | {"experiment": LOAD}, ALL])
def test_measuring_is_on_only_while_a_state_is_measured(make_scene: MakeScene, tables: dict[str, Any]) -> None:
    """Every compute that a row makes is gone before the next; dumps are written at once and never stay."""
    head, begins, rows = commands(text_of(make_scene(**tables))).partition("variable        row_phase ")
    assert begins
    made = re.findall(r"^compute +(\w+)", rows, re.MULTILINE)
    gone = re.findall(r"^uncompute +(\w+)", rows, re.MULTILINE)
    assert made
    assert Counter(made) == Counter(gone)
    kept = re.findall(r"^compute +(\w+)", head, re.MULTILINE)
    assert kept == (["cantilever_swing", "cantilever_ride"] if tables is ALL else [])  # means on the way
    assert not re.search(r"^dump ", head + rows, re.MULTILINE)
    during = re.findall(r"^compute .*?^uncompute ", rows, re.MULTILINE | re.DOTALL)
    assert not any(re.search(r"^(minimize |run (?! *0 post no$))", part, re.MULTILINE) for part in during)


def test_commands_of_which_a_deck_has_one(make_scene: MakeScene) -> None:
    """Styles are set once, before what needs them."""
    text = commands(text_of(make_scene(**ALL | {"bodies": {"bulk_stiffness_tangential": 0.5}})))
    once = ("units", "dimension", "boundary", "atom_style", "pair_style", "bond_style", "read_data", "timestep")
    for command in once:
        assert len(re.findall(rf"^{command} ", text, re.MULTILINE)) == 1
    identities = re.findall(r"^(?:fix|group) +(\w+)", text.split("print ")[0], re.MULTILINE)
    assert max(Counter(identities).values()) == 1
