"""The undeformed bodies: at rest in LAMMPS to round-off, and as stiff as the scene says, direction by direction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import product
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Scene, read_scene
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.steps import DisplaceInTime
from contact1d.workflow.engine.session import Session
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains

MakeScene = Callable[..., Scene]
OpenDeck = Callable[[Scene], tuple[Deck, Session]]

Array = NDArray[np.float64]
NORMAL = 0.83
TANGENTIAL = {"equal": NORMAL, "softer": 0.5, "stiffer": 1.4}
NEIGHBOURS = 0.3
RADIUS = {"flat": 1e12, "curved": 60.0}

ROUND_OFF = 2e-13
"""Of a force [FU]: places up to 1e2 LU are read to 1e-14 LU, and three springs of about 1 FU/LU pull on a particle."""
WALL_ROUND_OFF = 1e-12
"""Of the force of a plane [FU], a difference of distances from 1e3 LU below it."""
TO_REST = 2000
"""Timesteps of a drag that is near critical, some 20 to a time constant, in which a motion is gone."""
LONG_BOND_ROUND_OFF = 5e-12
"""Of a force [FU]: the length of a long bond, here 1e4 LU, is a double to 2e-12 LU."""
PARTICLES = 20

BODIES = [
    pytest.param(shape, horizontal, tangential, id=f"{shape}-{'xz' if horizontal else 'z'}-{tangential}")
    for shape, horizontal, tangential in product(RADIUS, (False, True), TANGENTIAL)
]


def tables(shape: str, horizontal: bool, tangential: str, **more: Any) -> dict[str, Any]:
    """Scene tables of one case; accuracy 1e-3 makes long bonds 1e4 LU long."""
    chosen: dict[str, Any] = {
        "bodies": {
            "particles": PARTICLES,
            "profile": {"kind": "parabola", "radius": RADIUS[shape]},
            "bulk_stiffness": NORMAL,
            "bulk_stiffness_tangential": TANGENTIAL[tangential],
        },
        "neighbours": {"stiffness": NEIGHBOURS},
        "accuracy": {"tolerance": 1e-3},
    }
    if horizontal:
        chosen["horizontal"] = {}
    return chosen | more


def apart(deck: Deck, session: Session) -> dict[str, Array]:
    """Move the upper body out of reach and return places and forces."""
    height = 4.0 * max(deck.settings.forces.cutoff, 1.0)
    session.execute(f"displace_atoms upper_body move 0 0 {height!r} units box\nrun 0")
    return session.atoms("x", "f")


def rest_error(deck: Deck) -> float:
    """What may be left at rest [FU]: round-off, larger where positions are those of far anchors."""
    return ROUND_OFF if deck.settings.chains.far == 0.0 else LONG_BOND_ROUND_OFF


@pytest.mark.parametrize(("shape", "horizontal", "tangential"), BODIES)
def test_undeformed_bodies_are_in_equilibrium(
    make_scene: MakeScene, open_deck: OpenDeck, shape: str, horizontal: bool, tangential: str
) -> None:
    """No pull inward at the ends, no offset by curvature: no force on any particle along a direction it may move in."""
    deck, session = open_deck(make_scene(**tables(shape, horizontal, tangential)))
    read = apart(deck, session)
    particles = read["type"] <= 2
    assert particles.sum() == 2 * PARTICLES
    assert (deck.settings.chains.far > 0) == (horizontal and tangential != "equal")
    assert np.abs(read["f"][particles]).max() <= rest_error(deck)


@pytest.mark.parametrize(("shape", "horizontal", "tangential"), BODIES)
def test_without_neighbours_nothing_pulls_either(
    make_scene: MakeScene, open_deck: OpenDeck, shape: str, horizontal: bool, tangential: str
) -> None:
    """Anchors stand where particles do."""
    deck, session = open_deck(make_scene(**tables(shape, horizontal, tangential, neighbours=None)))
    read = apart(deck, session)
    allowed = LONG_BOND_ROUND_OFF if deck.settings.chains.far else 0.0
    assert np.abs(read["f"][read["type"] <= 2]).max() <= allowed
    for body in bodies(deck.scene, deck.settings):
        assert np.array_equal(body.anchors, body.particles)


@pytest.mark.parametrize("shape", RADIUS)
def test_a_chain_on_a_rigid_plane_is_in_equilibrium(make_scene: MakeScene, open_deck: OpenDeck, shape: str) -> None:
    """Its bulk springs are stiffer than the scene's, and the anchors account for it."""
    scene_tables = tables(shape, False, "equal", interaction=None)
    scene_tables["bodies"]["lower"] = "rigid_plane"
    deck, session = open_deck(make_scene(**scene_tables))
    assert deck.settings.forces.bulk_stiffness > NORMAL
    read = apart(deck, session)
    assert set(read["type"]) == {2, 4}
    assert np.abs(read["f"][read["type"] == 2]).max() <= ROUND_OFF


def test_shifts_are_those_of_the_continuous_chain(make_scene: MakeScene) -> None:
    """Inside, an anchor is offset by k_n/k times the second difference, s²/R; at the ends by k_n/k spacings along x."""
    scene = make_scene(**tables("curved", True, "equal"))
    upper = bodies(scene, settings_for(scene))[1]
    shift = upper.anchors - upper.particles
    ratio = NEIGHBOURS / NORMAL
    assert shift[1:-1, 2] == pytest.approx(-ratio / 60.0, rel=1e-11)
    assert shift[1:-1, 0] == pytest.approx(0.0, abs=ROUND_OFF)
    assert shift[[0, -1], 0] == pytest.approx([-ratio, ratio], rel=1e-12)
    assert not shift[:, 1].any()


@pytest.mark.parametrize("axis", [0, 2])
@pytest.mark.parametrize("tangential", TANGENTIAL)
@pytest.mark.parametrize("neighbours", [None, NEIGHBOURS])
@pytest.mark.parametrize("particle", [0, 7])
def test_stiffness_against_one_particle(
    make_scene: MakeScene, open_deck: OpenDeck, axis: int, tangential: str, neighbours: float | None, particle: int
) -> None:
    """One particle moved by 1 LU along x or z: restoring force k_t or k_n and k_n on its neighbours, no other."""
    springs = None if neighbours is None else {"stiffness": neighbours}
    deck, session = open_deck(make_scene(**tables("curved", True, tangential, neighbours=springs)))
    before = apart(deck, session)["f"]
    move = [0.0, 0.0, 0.0]
    move[axis] = 1.0
    number = PARTICLES + 1 + particle
    session.execute(f"group moved id {number}\ndisplace_atoms moved move {move[0]} 0 {move[2]} units box\nrun 0")
    change = (session.atoms("f")["f"] - before)[: 2 * PARTICLES]
    own = TANGENTIAL[tangential] if axis == 0 else NORMAL
    spring = neighbours or 0.0
    beside = [i for i in (particle - 1, particle + 1) if 0 <= i < PARTICLES]
    wanted = np.zeros((2 * PARTICLES, 3))
    wanted[PARTICLES + particle, axis] = -(own + len(beside) * spring)
    wanted[[PARTICLES + i for i in beside], axis] = spring
    allowed = ROUND_OFF
    if deck.settings.chains.far:
        # Moved across itself by 1 LU and at most 1 LU more for the anchor's shift, a long bond bends by u²/2L.
        allowed = abs(TANGENTIAL[tangential] - NORMAL) * 2.0**2 / (2 * deck.settings.chains.far)
    assert np.abs(change - wanted).max() <= allowed


def test_without_horizontal_a_particle_keeps_its_place(make_scene: MakeScene, open_deck: OpenDeck) -> None:
    """The guide takes every force along x, and none along z."""
    deck, session = open_deck(make_scene(**tables("curved", False, "softer")))
    apart(deck, session)
    session.execute("group moved id 25\ndisplace_atoms moved move 0.5 0 0.5 units box\nrun 0")
    force = session.atoms("f")["f"][: 2 * PARTICLES]
    assert not force[:, :2].any()
    assert force[24, 2] == pytest.approx(-0.5 * (NORMAL + 2 * NEIGHBOURS), abs=ROUND_OFF)


def test_a_plane_in_time_has_the_scenes_own_spring_for_each_particle(
    make_scene: MakeScene, open_deck: OpenDeck
) -> None:
    """A plate lowered by d: F_i = k max(0, d − x²/R) on every particle, which is fixed in its body."""
    still = {"experiment": {"kind": "path", "displacements": [0.0]}, "damping": {"coefficient": "auto"}}
    scene_tables = tables("curved", False, "equal", interaction=None, neighbours=None) | still
    scene_tables["bodies"]["lower"] = "rigid_plane"
    deck, session = open_deck(make_scene(**scene_tables))
    down = DisplaceInTime(0.3, TO_REST)
    session.execute(deck.values(down, first=True) + deck.begin("down") + deck.row(DisplaceInTime))
    read = session.atoms("x", "v_opposite_z")
    x = (np.arange(PARTICLES) - 9.5) * 1.0
    wanted = NORMAL * np.maximum(0.0, 0.3 - x**2 / 60.0)
    assert 4 < (wanted > 0).sum() < PARTICLES
    force = read["v_opposite_z"][read["type"] == 2]
    assert np.abs(force - wanted).max() <= WALL_ROUND_OFF


def test_bodies_at_displacement_zero(make_scene: MakeScene) -> None:
    """The apexes are the force-free distance apart, opposite particles in planes ε apart."""
    scene = make_scene(bodies={"particles": 21})
    settings = settings_for(scene)
    lower, upper = bodies(scene, settings)
    assert lower.particles[10].tolist() == [0.0, 0.0, 0.0]
    assert settings.forces.table is not None
    assert upper.particles[10].tolist() == [0.0, settings.forces.table.plane_offset, settings.forces.rest]
    assert settings.forces.rest == pytest.approx(0.360437, abs=1e-6)
    assert upper.particles[:, 2] - settings.forces.rest == pytest.approx(lower.particles[:, 0] ** 2 / 200.0, abs=1e-14)
    assert np.array_equal(lower.particles[:, 0], upper.particles[:, 0])
    fewer = replace(settings, chains=replace(settings.chains, upper=5, lower=5))
    assert bodies(scene, fewer)[0].particles.shape == (5, 3)


@pytest.mark.parametrize("particles", [4, 40, 401])
@pytest.mark.parametrize("spacing", [1e-3, 1.0])
def test_anchors_of_a_plate_are_hardly_no_line(particles: int, spacing: float) -> None:
    """LAMMPS refuses a rigid body whose least moment of inertia is below 1e-7 of the largest; a line's is 0."""
    load = {"kind": "load", "method": "dynamic", "force": 0.5}
    law = (0.18, 0.13 * spacing, 0.09, 0.26 * spacing)
    body = {"particles": particles, "spacing": spacing}
    scene = read_scene(
        chains(1e9 * spacing, law=law, bodies=body, plate={}, damping={"coefficient": 0.3}, experiment=load)
    )
    anchors = bodies(scene, settings_for(scene))[1].anchors
    apart = anchors - anchors.mean(axis=0)
    moments = np.linalg.eigvalsh(np.eye(3) * (apart**2).sum() - apart.T @ apart)
    assert 1e-6 < moments[0] / moments[-1] < 1e-5
