"""Every set of effects: it either runs in LAMMPS, row by row and as a deck with bitwise the same states, or is refused.

Seven experiments with their methods, two lower bodies, every set of up to MOST effects and every larger one that is
allowed; so every effect alone (with what it requires) and every pair of effects is among them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from itertools import combinations, cycle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.state import State
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import DisplaceInTime, Draw, Fly, Launch, Phase, Spend, UnderLoad, displacements
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import Engine
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import EFFECTS, Scene, SceneError

MakeScene = Callable[..., Scene]

TABLES: dict[str, dict[str, Any]] = {
    "interaction": {
        "repulsion": {"amplitude": 0.18, "range": 0.13},
        "attraction": {"amplitude": 0.09, "range": 0.26},
    },
    "neighbours": {"stiffness": 0.3},
    "horizontal": {},
    "adhesion": {"work_of_adhesion": 5e-4},
    "viscoelasticity": {"terms": [{"share": 0.4, "time": 1.0}, {"share": 0.3, "time": 10.0}]},
    "friction": {"coefficient": 0.3},
    "damping": {"coefficient": "auto"},
    "noise": {"temperature": 1e-3, "seed": 1},
    "plate": {},
    "cantilever": {"stiffness": 0.5, "velocity": 0.01},
}
EXPERIMENTS: dict[str, dict[str, Any]] = {
    "load": {"force": 0.1},
    "path": {"displacements": [0.0, 0.05]},
    "pull_off": {"preload": 0.1},
    "slide": {"normal_force": 0.1, "distance": 2.0},
    "tangential": {"normal_force": 0.1, "displacements": [0.0, 0.01, -0.02]},
    "history": {"displacement": [[0.0, 0.0], [1.0, 0.05], [2.0, 0.0]]},
    "impact": {"velocity": 0.1},
}
METHODS: dict[str, tuple[str, ...]] = dict.fromkeys(EXPERIMENTS, ("quasistatic", "dynamic")) | {
    "slide": ("dynamic",),
    "tangential": ("quasistatic",),
    "history": ("quasistatic",),
    "impact": ("dynamic",),
}
STEPS = 25
MOST = 3
SUM = 1e-12
"""The force on the plate is a sum over 20 particles, by LAMMPS and by numpy in their own orders."""
Case = tuple[str, str, str, frozenset[str]]


def fits(kind: str, method: str, lower: str, effects: frozenset[str]) -> bool:
    """What physics allows, told independently of the program's rules.

    Particles act on each other through an interaction; a rigid plane is touched, holds nothing and pulls nothing along
    x. Damping, noise, plate and cantilever exist in time only. Time needs damping to come to rest; a plate moves where
    a force is prescribed, and not where its place is. Noise needs an average, which a load, a path and a slide take. A
    cantilever slides a plate, whose particles have to follow it along x. Coulomb's friction is a rigid plane's, in a
    tangential and alone: its history has no minimum to be found, and no time. An energy of adhesion is a rigid
    plane's, too, of particles that stand still in their body: alone, and in time with the plate that they belong to.
    Memory is of such particles, over a history or in an impact, which nothing else slows.
    """
    if kind in ("history", "impact") or "viscoelasticity" in effects:
        moved = {"history": set(), "impact": {"plate"}}.get(kind)
        one = effects - (moved or set()) in (set(), {"adhesion"}, {"viscoelasticity"})
        return moved is not None and lower == "rigid_plane" and one and effects >= moved
    if "adhesion" in effects:
        alone = lower == "rigid_plane" and kind in ("load", "path", "pull_off")
        moved = effects == {"adhesion", "damping", "plate"} and kind != "path"
        return alone and (effects == {"adhesion"} if method == "quasistatic" else moved)
    if kind == "tangential" or "friction" in effects:
        return kind == "tangential" and lower == "rigid_plane" and effects == {"friction"}
    timed = effects & {"damping", "noise", "plate", "cantilever"}
    if lower == "rigid_plane":
        held = kind in ("load", "path") and not effects & {"interaction", "horizontal"}
    else:
        held = "interaction" in effects
    if method == "quasistatic":
        return held and not timed
    forced = kind != "path"
    averaged = kind in ("load", "path", "slide")
    return (
        held
        and "damping" in effects
        and ("plate" in effects) == forced
        and ("cantilever" in effects) == (kind == "slide")
        and (averaged or "noise" not in effects)
        and (kind != "slide" or "horizontal" in effects)
    )


def cases() -> Iterator[Case]:
    for kind, methods in METHODS.items():
        for method in methods:
            for lower in ("particles", "rigid_plane"):
                for count in range(len(EFFECTS) + 1):
                    for chosen in map(frozenset, combinations(EFFECTS, count)):
                        if count <= MOST or fits(kind, method, lower, chosen):
                            yield kind, method, lower, chosen


def label(case: Case) -> str:
    kind, method, lower, effects = case
    return "-".join([kind, method, lower, *(name for name in EFFECTS if name in effects)])


def scene_of(make_scene: MakeScene, case: Case, **bodies: Any) -> Scene:
    kind, method, lower, effects = case
    tables: dict[str, Any] = {name: TABLES[name] if name in effects else None for name in EFFECTS}
    if "plate" in effects:
        tables["plate"] = {"slide": {"free": ["x", "z"]}, "impact": {"mass": 1.0}}.get(kind, TABLES["plate"])
    experiment = {"kind": kind} | EXPERIMENTS[kind] | ({"method": method} if len(METHODS[kind]) > 1 else {})
    reduction = {"reduction": "mdr"} if "adhesion" in effects else {}
    return make_scene(**tables, experiment=experiment, bodies={"lower": lower} | reduction | bodies)


ALL = list(cases())
ALLOWED = [case for case in ALL if fits(*case)]


def phases_of(kind: str, method: str, relaxes: bool) -> tuple[Phase, ...]:
    """A few rows of each kind of step that the experiment uses, forth and back, with a state after each phase."""
    if kind == "tangential":
        return (
            Phase("forward", (Draw(0.05, 0.0), Draw(0.05, 0.01), Draw(0.1, 0.02)), state=True),
            Phase("backward", (Draw(0.1, -0.01), Draw(-0.02, -0.02)), state=True),
        )
    if kind == "impact":
        return Phase("touching", (Launch(0.1, STEPS),)), Phase("impact", (Fly(STEPS),) * 3, state=True)
    if relaxes:
        return (
            Phase("loading", (Spend(0.0, 0.1, 0.0), Spend(0.02, 0.5, 0.04), Spend(0.05, 2.0, 0.015)), state=True),
            Phase("unloading", (Spend(0.01, 1.0, -0.04), Spend(-0.02, 0.3, -0.1)), state=True),
        )
    if method == "quasistatic":
        return (
            Phase("loading", displacements((0.0, 0.02, 0.05)), state=True),
            Phase("unloading", displacements((0.01, -0.02)), state=True),
        )
    if kind == "path":
        return (
            Phase("loading", (DisplaceInTime(0.0, STEPS), DisplaceInTime(0.03, STEPS)), state=True),
            Phase("unloading", (DisplaceInTime(0.01, STEPS),), state=True),
        )
    begin = ("steps/drive",) if kind == "slide" else ()
    name = "sliding" if kind == "slide" else "unloading"
    return (
        Phase("loading", (UnderLoad(0.1, STEPS),) * 2, state=True),
        Phase(name, (UnderLoad(0.05, STEPS), UnderLoad(0.0, STEPS)), state=True, begin=begin),
    )


def replayed(contact: Contact, phases: tuple[Phase, ...]) -> list[State]:
    """The states of all rows, whether they can be trusted or not: so few particles carry no contact."""
    states: list[State] = []
    for phase in phases:
        contact.begin(phase.name, phase.begin)
        states += contact.rows(phase.rows, trusted=False)
        if phase.state:
            contact.write_state()
    contact.finish()
    return states


def prepared(deck: Deck, folder: Path) -> Path:
    folder.mkdir()
    write_system(deck, folder)
    return folder


@pytest.mark.parametrize("case", ALLOWED, ids=label)
def test_allowed_sets_run(make_scene: MakeScene, tmp_path: Path, case: Case) -> None:
    """Row by row as the program does, and as one deck: the same files, bitwise; every number is finite."""
    scene = scene_of(make_scene, case)
    assert set(scene.effects) == case[3]
    assert scene.method == case[1]
    deck = Deck(scene, settings_for(scene))
    phases = phases_of(case[0], case[1], "viscoelasticity" in case[3])
    context = RunContext(deck, prepared(deck, tmp_path / "rows"), Silent(), 60.0)
    with context.contact() as contact:
        states = replayed(contact, phases)
    rows = [row for phase in phases for row in phase.rows]
    assert len(states) == len(rows)
    for state in states:
        assert np.isfinite([state.displacement, state.force, state.residual, state.smallest_distance]).all()
    if case[1] == "quasistatic" or case[0] == "path":
        assert [state.displacement for state in states] == pytest.approx([row.displacement for row in rows], abs=1e-12)
    folder = prepared(deck, tmp_path / "deck")
    (folder / "in.lammps").write_text(deck.text(phases), encoding="utf-8")
    with Engine.session(folder) as session:
        session.run_file("in.lammps")
    for name in ("curve.txt", "states.lammpstrj"):
        assert (folder / name).read_bytes() == (tmp_path / "rows" / name).read_bytes()
    table = [line.split() for line in (folder / "curve.txt").read_text().splitlines()[1:]]
    assert [row[0] for row in table] == [state.phase for state in states]
    assert [float(row[1]) for row in table] == [state.displacement for state in states]
    measured = [float(row[2]) for row in table]
    assert measured == pytest.approx([state.force for state in states], rel=SUM, abs=SUM)


BOTH_WAYS = [0.5, 1.4]
"""Tangential stiffness [FU/LU]; the normal one is 0.83."""
LONG = [case for case in ALLOWED if case[3] >= {"horizontal", "neighbours"}]


def run_a_little(scene: Scene, case: Case, folder: Path) -> None:
    deck = Deck(scene, settings_for(scene))
    with RunContext(deck, prepared(deck, folder / "rows"), Silent(), 60.0).contact() as contact:
        states = replayed(contact, phases_of(case[0], case[1], "viscoelasticity" in case[3]))
    assert np.isfinite([state.force for state in states]).all()


@pytest.mark.parametrize(
    ("case", "tangential"),
    [pytest.param(case, k, id=f"{label(case)}-{k}") for case, k in zip(LONG, cycle(BOTH_WAYS), strict=False)],
)
def test_sets_with_long_bonds_run(make_scene: MakeScene, tmp_path: Path, case: Case, tangential: float) -> None:
    """Normal and tangential stiffness differ, either way."""
    scene = scene_of(make_scene, case, bulk_stiffness_tangential=tangential)
    assert settings_for(scene).chains.far > 0
    run_a_little(scene, case, tmp_path)


@pytest.mark.parametrize("tangential", BOTH_WAYS)
@pytest.mark.parametrize("tolerance", [1e-2, 1e-6])
def test_long_bonds_of_any_accuracy(make_scene: MakeScene, tmp_path: Path, tolerance: float, tangential: float) -> None:
    """A long bond is 10/tolerance spacings long."""
    bodies = {"bulk_stiffness_tangential": tangential}
    scene = make_scene(horizontal={}, bodies=bodies, accuracy={"tolerance": tolerance})
    run_a_little(scene, ("path", "quasistatic", "particles", frozenset()), tmp_path)


def test_all_other_sets_are_refused(make_scene: MakeScene) -> None:
    """Each with a SceneError, and none of the allowed ones."""
    accepted = []
    for case in ALL:
        with suppress(SceneError):
            scene_of(make_scene, case)
            accepted.append(case)
    assert list(map(label, accepted)) == list(map(label, ALLOWED))


def test_every_effect_and_every_pair_is_among_the_runs() -> None:
    """All pairs but those of a cantilever with a rigid plane's missing lower body are allowed somewhere.

    Friction, memory and an energy of adhesion stand alone.
    """
    run = {pair for case in ALLOWED for pair in combinations(EFFECTS, 2) if set(pair) <= case[3]}
    alone = ("adhesion", "friction", "viscoelasticity")
    assert run == set(combinations([name for name in EFFECTS if name not in alone], 2)) | {
        ("adhesion", "damping"), ("adhesion", "plate"), ("viscoelasticity", "plate"),
    }  # fmt: skip
    sets = [case[3] for case in ALLOWED]
    required = {"noise": {"damping", "plate"}, "plate": {"damping"}, "horizontal": {"interaction"}}
    for name in ("interaction", "neighbours", "horizontal", "adhesion", "friction", "damping", "noise", "plate"):
        assert frozenset({name} | required.get(name, set())) in sets
    assert frozenset({"interaction", "horizontal", "damping", "plate", "cantilever"}) in sets
