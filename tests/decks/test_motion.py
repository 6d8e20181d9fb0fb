"""Claim: the particles of a deck rest, resist and move in LAMMPS as the scene's springs, drag and heat say.

References: closed forms, no golden text. A particle of mass m on a spring k with the drag γ that starts at rest length
with the velocity v₀ has u(t) = (v₀/ω) exp(−γt/2m) sin ωt, ω² = k/m − (γ/2m)²; so has the mean of many under thermal
forces of mean 0.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.decks.written import ANCHORS, Written, written
from tests.scenes import chains

PARTICLES, STIFFNESS, NEIGHBOURS, MASS, DRAG = 20, 0.83, 0.3, 1.0, 0.3
APART = "displace_atoms upper_body move 0 0 25 units box"
"""Far beyond the cutoff [LU]."""
KICK, TIMES = 0.1, 12
"""Velocity of every particle at the start [LU/TU], and places looked at, 1 TU apart: two periods, four decay times."""
INTEGRATION = 0.06
"""Over v₀/ω; 0.033 measured: in velocity Verlet the drag lags by half a time step of 0.2 TU. Half the drag: 0.2 off."""
COLD = 1e-7
"""k_BT [FU·LU]: a particle swings by 3e-4 LU, the mean of all by 4e-5 of the 0.1 LU of the motion."""
LINEAR = 0.1
"""Part of the tolerance that a spring's force may be off, for moves up to a spacing; a long bond is for 0.05."""
ROUND_OFF, LONG_BOND = 2e-13, 5e-12
"""Of a force [FU]: places up to 1e2 LU are read to 1e-14 LU; a long bond, here 1e4 LU, to 2e-12 LU."""


def chain(radius: float = 60.0, tolerance: float = 1e-3, **tables: Any) -> Written:
    bodies = {"particles": PARTICLES, "mass": MASS} | tables.pop("bodies", {})
    experiment = {"experiment": {"kind": "path", "displacements": [0.1]}}
    return written(chains(radius, STIFFNESS, bodies=bodies, accuracy={"tolerance": tolerance}, **experiment | tables))


BODIES: dict[str, dict[str, Any]] = {
    "guided": {"neighbours": {"stiffness": NEIGHBOURS}},
    "free": {"neighbours": {"stiffness": NEIGHBOURS}, "horizontal": {}},
    "softer along x": {
        "neighbours": {"stiffness": NEIGHBOURS}, "horizontal": {}, "bodies": {"bulk_stiffness_tangential": 0.5},
    },
    "stiffer along x": {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": 1.4}},
}  # fmt: skip


@pytest.mark.parametrize("name", BODIES)
def test_undeformed_bodies_are_at_rest_and_as_stiff_as_the_scene_says(name: str) -> None:
    """A particle that moves by 1 LU pulls with its own spring and those of its neighbours, direction by direction.

    LAMMPS reads places bitwise as they are written; ends are not pulled inward, a curved chain is not pulled straight.
    """
    tables = BODIES[name]
    deck = chain(**tables)
    moves = [(particle, axis) for particle in (0, 7) for axis in ((0, 2) if "horizontal" in tables else (2,))]
    commands = [f"{APART}\nrun 0 post no"]
    for particle, axis in moves:
        move = [float(axis == i) for i in range(3)]
        there, back = (f"displace_atoms one move {s * move[0]} 0 {s * move[2]} units box" for s in (1, -1))
        commands.append(f"group one id {PARTICLES + 1 + particle}\n{there}\nrun 0 post no")
        commands.append(f"{back}\ngroup one delete")
    rest, *moved = deck.after(*commands)
    particles = slice(0, 2 * PARTICLES)
    assert {*rest[particles, 0]} == {1.0, 2.0}
    raised = np.concatenate([deck.atoms[kind] for kind in sorted(deck.atoms)])
    assert np.array_equal(rest[:PARTICLES, 1:4], raised[:PARTICLES])
    far = "bulk_stiffness_tangential" in tables.get("bodies", {})
    assert np.abs(rest[particles, 4:]).max() <= (LONG_BOND if far else ROUND_OFF)
    along = tables.get("bodies", {}).get("bulk_stiffness_tangential", STIFFNESS)
    spring = NEIGHBOURS if "neighbours" in tables else 0.0
    for (particle, axis), found in zip(moves, moved[::2], strict=True):
        wanted = np.zeros((2 * PARTICLES, 3))
        beside = [i for i in (particle - 1, particle + 1) if 0 <= i < PARTICLES]
        wanted[PARTICLES + particle, axis] = -((along if axis == 0 else STIFFNESS) + len(beside) * spring)
        wanted[[PARTICLES + i for i in beside], axis] = spring
        # Moved across itself by 1 LU and at most 1 LU more for the anchor's shift, a long bond bends by u²/2L.
        allowed = abs(along - STIFFNESS) * 2.0**2 / (2.0 * deck.number("far_length")) if far else ROUND_OFF
        assert np.abs((found - rest)[particles, 4:] - wanted).max() <= allowed


def test_without_horizontal_a_particle_keeps_its_place() -> None:
    """The guide takes every force along x, and none along z."""
    (moved,) = chain(**BODIES["guided"]).after(
        f"{APART}\ngroup one id 25\ndisplace_atoms one move 0.5 0 0.5 units box\nrun 0 post no"
    )
    assert not moved[: 2 * PARTICLES, 4:6].any()
    assert moved[24, 6] == pytest.approx(-0.5 * (STIFFNESS + 2.0 * NEIGHBOURS), abs=ROUND_OFF)


@pytest.mark.parametrize("tangential", [0.5, 2.0])
def test_bulk_springs_are_linear_and_do_not_mix_the_directions(tangential: float) -> None:
    """Moves up to a spacing, along both at once."""
    deck = chain(1000.0, 1e-2, bodies={"bulk_stiffness_tangential": tangential}, horizontal={})
    places = [(0.5, 0.0), (1.0, 1.0), (-1.0, 0.5), (0.0, -1.0)]
    steps = np.diff([(0.0, 0.0), *places], axis=0)
    moves = [f"displace_atoms particles move {x} 0 {z} units box\nrun 0 post no" for x, z in steps]
    for (x, z), found in zip(places, deck.after(APART, *moves)[1:], strict=True):
        expected = [-tangential * x, -STIFFNESS * z]
        size = max(tangential, STIFFNESS) * math.hypot(x, z)
        assert np.abs(found[:PARTICLES, [4, 6]] - expected).max() < LINEAR * 1e-2 * size


@pytest.mark.parametrize("tables", [{}, {"noise": {"temperature": COLD, "seed": 5}}], ids=["damping", "noise"])
def test_a_kicked_particle_swings_and_comes_to_rest_as_its_drag_says(tables: dict[str, Any]) -> None:
    """With the thermostat as without: its friction is the scene's [damping]. Anchors of the lower body stand still."""
    load = {"kind": "load", "method": "dynamic", "force": 0.0}
    deck = chain(
        1000.0, 1e-2, bodies={"particles": 60}, damping={"coefficient": DRAG}, plate={"damping": 0.0}, experiment=load,
        **tables,
    )  # fmt: skip
    stride = round(1.0 / deck.number("time_step"))
    start, _, *moving = deck.after(APART, f"velocity particles set 0.0 0.0 {KICK}", *[f"run {stride} post no"] * TIMES)
    found = np.array([(state - start)[:60, 3].mean() for state in moving])
    time = deck.number("time_step") * stride * np.arange(1, TIMES + 1)
    decay = 0.5 * DRAG / MASS
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    exact = KICK / omega * np.exp(-decay * time) * np.sin(omega * time)
    assert np.abs(found - exact).max() < INTEGRATION * KICK / omega


@pytest.mark.parametrize("title", ["a # in it, R = 1000 µm, ends with &", '${undefined} $x three """ quotes 日本'])
def test_a_title_is_only_a_title(title: str) -> None:
    """Whatever it says, data file and deck are read alike."""
    deck = chain(title=title)
    (state,) = deck.after("run 0")
    assert len(state) == 4 * PARTICLES
    assert deck.files["system.data"].splitlines()[0] == f"# {title}"


@pytest.mark.parametrize("particles", [4, 401])
def test_anchors_of_a_plate_are_hardly_no_line_and_all_atoms_have_room(particles: int) -> None:
    """LAMMPS refuses a rigid body whose least moment of inertia is below 1e-7 of the largest; a line's is 0."""
    slide = {"kind": "slide", "normal_force": 0.1, "distance": 500.0}
    deck = chain(
        1e9, bodies={"particles": 2000, "upper_particles": particles}, horizontal={}, damping={"coefficient": "auto"},
        plate={"free": ["x", "z"]}, cantilever={"stiffness": 0.5, "velocity": 0.01}, experiment=slide,
    )  # fmt: skip
    apart = deck.atoms[ANCHORS] - deck.atoms[ANCHORS].mean(axis=0)
    moments = np.linalg.eigvalsh(np.eye(3) * (apart**2).sum() - apart.T @ apart)
    assert 1e-6 < moments[0] / moments[-1] < 1e-5
    places = np.concatenate([*deck.atoms.values()])
    assert (places - deck.box[0] >= [500.0, 0.999, 30.0]).all()
    assert (deck.box[1] - places >= [500.0, 0.999, 30.0]).all()
