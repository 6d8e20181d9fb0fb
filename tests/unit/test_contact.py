"""What a contact makes of the numbers that LAMMPS gives back, and what it asks for: a session that answers from arrays.

References: loops over all pairs of particles, and text of the deck itself.
"""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import period
from contact1d.workflow.deck.steps import Displace, Phase, UnderLoad
from contact1d.workflow.engine.session import EngineError, Reading
from contact1d.workflow.experiments.running.contact import ATOM_UNITS, HEAT, MOTION, TOLD, Contact, State
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.given import PROFILE, at, given_scene
from tests.unit.test_settings_similarity import SCENES

TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
ANCHOR = 4
"""A type of atoms that are no particles."""


class Session:
    """Keeps what it is asked for, and answers with given numbers and atoms."""

    folder = Path("nowhere")
    lammps_seconds = 0.0
    timestep = 0

    def __init__(self, scene: Scene, atoms: dict[str, Any] | None = None, **numbers: float) -> None:
        """`atoms`: arrays by name; `numbers`: by name, 0 for others."""
        self.scene, self.atoms, self.numbers = scene, atoms, numbers
        self.executed: list[tuple[str, str | None, int | None]] = []
        self.batches: list[list[str]] = []

    def execute(self, text: str, phase: str | None = None, expected_steps: int | None = None, **_: Any) -> None:
        """Note it."""
        self.executed.append((text, phase, expected_steps))

    def measure_rows(self, texts: Any, values: Any, atoms: Any, meanwhile: Any) -> list[Reading]:
        """The same for each."""
        meanwhile()
        assert set(atoms) == set(ATOM_UNITS)
        self.batches.append(list(texts))
        self.lammps_seconds += 0.5 * len(texts)
        self.asked = list(values)
        found = tuple(self.numbers.get(name, 0.0) for name in values)
        return [Reading(found, self.atoms or {}) for _ in texts]


def opened(scene: Scene, atoms: dict[str, Any] | None = None, **numbers: float) -> tuple[Contact, Session]:
    session: Any = Session(scene, atoms, **numbers)
    contact = Contact(Deck(scene, settings_for(scene)), session)
    contact.begin("loading")
    return contact, session


def atoms_of(scene: Scene, sag: float = 0.0, missing: int = 0) -> dict[str, Any]:
    """Random places and forces of both bodies and of anchors; upper particles lie `sag` lower."""
    settings, rng = settings_for(scene), np.random.default_rng(11)
    n, m = settings.particles, 0 if scene.bodies.lower == "rigid_plane" else settings.lower_particles
    x = (np.arange(n) - 0.5 * (n - 1)) * scene.bodies.own_spacing
    below = (np.arange(m) - 0.5 * (m - 1)) * scene.bodies.spacing
    upper = np.column_stack([x, 0.0 * x, 0.5 + 0.1 * rng.random(n) - sag])
    lower = np.column_stack([below + 0.1 * rng.random(m), 0.0 * below, 0.1 * rng.random(m)])
    place = np.concatenate([upper[missing:], lower, upper + 7.0])
    kind = np.concatenate([np.full(n - missing, 2.0), np.full(m, 1.0), np.full(n, float(ANCHOR))])
    size = len(kind)
    return {
        "x": place, "type": kind, "f": rng.standard_normal((size, 3)),
        "v_opposite_x": rng.standard_normal(size), "v_opposite_z": rng.standard_normal(size),
    }  # fmt: skip


def slow_distance(upper: Any, lower: Any) -> float:
    return min(math.hypot(a[0] - b[0], a[2] - b[2]) for a in upper for b in lower)


def slow_height(x: float, lower: Any) -> float:
    """Of the straight lines between the lower particles, and level beyond the last ones."""
    order = sorted(lower, key=lambda p: p[0])
    if x <= order[0][0]:
        return float(order[0][2])
    for a, b in pairwise(order):
        if x <= b[0]:
            return float(a[2] + (x - a[0]) / (b[0] - a[0]) * (b[2] - a[2]))
    return float(order[-1][2])


SLIDE = scene_from_dict(SCENES["slide of few particles over another spacing"])
RIGID = given_scene(bodies={"particles": 40, "lower": "rigid_chain"})
SIDEWAYS = given_scene(horizontal={})


@pytest.mark.parametrize("sag", [0.0, 0.52])
@pytest.mark.parametrize("scene", [given_scene(), SLIDE, RIGID, SIDEWAYS], ids=["chains", "slide", "rigid", "sideways"])
def test_a_state_is_what_particles_say_and_anchors_do_not(scene: Scene, sag: float) -> None:
    atoms = atoms_of(scene, sag)
    contact, _ = opened(scene, atoms, plate_displacement=0.25, plate_velocity=-0.5, step=30.0, cantilever_plate=1.5,
                        cantilever_force=0.75)  # fmt: skip
    state = contact.row(Displace(0.25))
    upper, lower = atoms["type"] == 2, atoms["type"] == 1
    assert (state.displacement, state.step, state.phase) == (0.25, 30.0, "loading")
    assert state.plate_velocity == (0.5 if scene.plate is not None else 0.0)
    assert (state.plate_x, state.cantilever_force) == ((1.5, 0.75) if scene.cantilever is not None else (0.0, 0.0))
    assert state.force == pytest.approx(atoms["v_opposite_z"][upper].sum())
    assert state.carried == state.force
    assert state.smallest_distance == pytest.approx(slow_distance(atoms["x"][upper], atoms["x"][lower]))
    order = np.argsort(atoms["x"][upper, 0])
    spacing = scene.bodies.own_spacing
    assert state.profile.pressure == pytest.approx(atoms["v_opposite_z"][upper][order] / spacing)
    assert state.profile.shear == pytest.approx(atoms["v_opposite_x"][upper][order] / spacing)
    heights = [slow_height(p[0], atoms["x"][lower]) for p in atoms["x"][upper][order]]
    assert state.profile.z_lower == pytest.approx(heights)
    ends = atoms["x"][lower, 0].min(), atoms["x"][lower, 0].max()
    gaps = [p[2] - h for p, h in zip(atoms["x"][upper][order], heights, strict=True) if ends[0] <= p[0] <= ends[1]]
    assert state.depth == pytest.approx(max(0.0, -min(gaps)))
    assert (state.depth > 0.0) == (sag > 0.0)
    free = [0, 2] if scene.horizontal is not None else [2]
    moving = upper if scene.bodies.lower == "rigid_chain" else upper | lower
    assert state.residual == pytest.approx(np.abs(atoms["f"][moving][:, free]).max())


def test_a_body_without_an_end_goes_on_on_both_sides() -> None:
    tables = SCENES["slide of few particles over another spacing"]
    bodies = tables["bodies"] | {"periodic": True, "particles": 20, "profile": {"kind": "flat"}}
    bodies = {name: value for name, value in bodies.items() if not name.startswith("upper")}
    scene = scene_from_dict(tables | {"bodies": bodies})
    contact, _ = opened(scene)
    x, z = np.asarray([1.0, 2.0, 5.0]), np.asarray([0.1, 0.2, 0.3])
    wide, high = contact._surface(x, z)
    length = period(scene, contact.settings)
    assert wide == pytest.approx([*(x - length), *x, *(x + length)])
    assert high == pytest.approx([*z, *z, *z])
    same, _ = opened(SLIDE)
    assert same._surface(x, z)[0] is x


@pytest.mark.parametrize("lowest", [0.02, -0.02])
def test_on_a_plane_a_particle_that_dips_stands_on_it(lowest: float) -> None:
    """A soft plane lets it down; nothing lies below it, and no distance is less than none."""
    tables = SCENES["plane"] | {"neighbours": {"stiffness": 0.3}}
    scene = scene_from_dict(tables)
    atoms = atoms_of(scene)
    kind, place = atoms["type"], atoms["x"]
    place[kind == 2, 2] += lowest - place[kind == 2, 2].min()
    contact, _ = opened(scene, atoms)
    if contact.deck.stepped or scene.stands:
        pytest.fail("a scene whose particles move is meant")
    state = contact.row(Displace(0.1))
    assert state.smallest_distance == pytest.approx(max(lowest, 0.0))
    assert state.depth == 0.0
    assert state.profile.z_lower.min() == pytest.approx(min(lowest, 0.0))
    assert state.profile.z_lower.max() == 0.0
    assert state.residual == pytest.approx(np.abs(atoms["f"][kind == 2][:, 2]).max())


def test_a_particle_that_is_gone_gives_no_state() -> None:
    for missing in (0, 1):
        contact, _ = opened(given_scene(), atoms_of(given_scene(), missing=missing), step=70.0)
        if missing:
            with pytest.raises(EngineError, match="only 79 particles are left"):
                contact.row(Displace(0.1))
        else:
            contact.row(Displace(0.1))


def test_rows_that_are_known_go_eight_at_a_time_and_are_counted_over_all_phases() -> None:
    scene = given_scene()
    contact, session = opened(scene, atoms_of(scene))
    first = contact.rows([Displace(0.01 * i) for i in range(19)])
    assert [len(batch) for batch in session.batches] == [8, 8, 3]
    assert contact.rows_seconds == 9.5
    contact.write_state()
    contact.begin("unloading", ("steps/turn",), 40)
    second = contact.rows([Displace(0.0), Displace(-0.1)])
    assert [s.number for s in (*first, *second)] == list(range(21))
    assert {s.phase for s in second} == {"unloading"}
    assert [(p.name, len(p.rows), p.state, p.begin) for p in contact.phases] == [
        ("loading", 19, True, ()), ("unloading", 2, False, ("steps/turn",)),
    ]  # fmt: skip
    assert session.executed[-1] == ("", "unloading", 40)
    assert contact.rows_seconds == 10.5
    text = session.batches[-1][0]
    assert text.count("row_phase delete") == 1
    assert "row_phase index unloading" in text
    assert "row_phase delete" not in session.batches[0][0]


def test_what_is_sent_is_the_schedule_that_the_deck_repeats() -> None:
    """Row by row: its numbers, its step, and in between the end of the one before."""
    scene = given_scene()
    contact, session = opened(scene, atoms_of(scene))
    deck, rows = contact.deck, [Displace(0.1), Displace(0.2)]
    contact.rows(rows)
    contact.write_state()
    contact.begin("unloading")
    contact.row(Displace(0.0))
    contact.write_state()
    contact.finish()
    kind = Displace
    between = deck.row_end + deck.forget(kind)
    assert session.batches[0] == [
        deck.begin("loading") + deck.values(rows[0], True) + deck.row(kind),
        between + deck.values(rows[1], True) + deck.row(kind),
    ]
    again = "variable        row_phase delete\n" + deck.begin("unloading")
    assert session.batches[1] == [
        between + deck.state(first=True) + again + deck.values(Displace(0.0), False) + deck.row(kind)
    ]
    assert session.executed[-1][:2] == (between + deck.state(first=False), "unloading")


def test_a_schedule_is_run_as_it_is_written() -> None:
    scene = given_scene(**TIMED, experiment={"kind": "load", "force": 0.3, "method": "dynamic"})
    contact, session = opened(scene, atoms_of(scene))
    phases = (Phase("settling", (UnderLoad(0.3, 20),) * 2), Phase("sampling", (UnderLoad(0.3, 30),) * 3, state=True))
    states = contact.replay(phases)
    assert len(states) == 5
    assert [one for one in session.executed if one[1] in ("settling", "sampling")][:2] == [
        ("", "settling", 40), ("", "sampling", 90),
    ]  # fmt: skip
    assert [(p.name, p.state) for p in contact.phases] == [("loading", False), ("settling", False), ("sampling", True)]
    still = given_scene()
    resting, quiet = opened(still, atoms_of(still))
    resting.replay((Phase("down", (Displace(0.1),)),))
    assert ("", "down", None) in quiet.executed


@pytest.mark.parametrize("told", [False, True])
@pytest.mark.parametrize("drag", [0.0, 0.1])
def test_heat_is_asked_for_once_its_baths_tell_it(told: bool, drag: float) -> None:
    tables = SCENES["slide of few particles over another spacing"]
    scene = scene_from_dict(tables | {"noise": {"temperature": 1e-3, "seed": 1},
                                      "plate": tables["plate"] | {"damping": drag}})  # fmt: skip
    contact, session = opened(scene, atoms_of(scene))
    contact.begin("sliding", (TOLD,) if told else ())
    contact.begin("sliding_2")
    state = contact.row(UnderLoad(1.0, 10))
    expected = set(HEAT[: 1 + (drag > 0.0)]) if told else set()
    assert set(session.asked) & set(HEAT) == expected == set(state.motion) - set(MOTION)
    assert set(MOTION) <= set(state.motion)
    cold, asked = opened(SLIDE, atoms_of(SLIDE))
    cold.begin("sliding", (TOLD,))
    cold.row(UnderLoad(1.0, 10))
    assert not set(asked.asked) & set(HEAT)


def test_what_other_effects_press_is_not_carried() -> None:
    scene = given_scene()
    contact, _ = opened(scene, atoms_of(scene), first=0.25, second=-1.0)
    contact._pushes = ("first", "second")
    state = contact.row(Displace(0.1))
    assert state.pushed == -0.75
    assert state.carried == state.force + 0.75


def test_a_state_without_a_radius_is_a_spot() -> None:
    none, known = at(0.0, 0.0, None), at(0.0, 0.0, 3.0)
    assert none.radius is None
    assert none.radius_or_spot.value == 0.0
    assert known.radius_or_spot is known.radius
    assert isinstance(State("a", 0.0, 1.0, PROFILE, 0.1, 0.0, 0.0, none.rule).radius_or_spot.uncertainty, float)


def test_in_time_particles_on_a_plane_that_sticks_stand_on_it_where_they_carry() -> None:
    """A pull as well as a push; they have no motion of their own that could be left unbalanced."""
    tables = SCENES["JKR on the plane"]
    scene = scene_from_dict(tables | TIMED | {
        "bodies": tables["bodies"] | {"particles": 20},
        "experiment": {"kind": "pull_off", "preload": 0.3, "method": "dynamic"},
    })  # fmt: skip
    atoms = atoms_of(scene)
    upper = np.flatnonzero(atoms["type"] == 2)
    atoms["v_opposite_z"][upper] = np.where(np.arange(20) < 5, 0.0, np.where(np.arange(20) < 10, 0.25, -2.0))
    contact, _ = opened(scene, atoms)
    assert scene.stands
    state = contact.row(UnderLoad(0.3, 10))
    assert state.residual == 0.0
    assert state.profile.z_upper == pytest.approx([*atoms["x"][upper[:5], 2], *[0.0] * 15])
    assert not state.profile.z_lower.any()
    assert state.force == pytest.approx(5 * 0.25 - 20.0)
