"""Claim: a deck's particles move as the scene's springs, drag and thermostat say, by Newton's law and no golden text.

Reference: closed forms. A particle of mass m on a spring k with the drag γ that starts at rest length with the velocity
v₀ has u(t) = (v₀/ω) exp(−γt/2m) sin ωt, ω² = k/m − (γ/2m)²; so has the mean of many under thermal forces of mean 0.
Verlet's method is stable up to ω Δt = 2.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.session import Session
from contact1d.workflow.model.settings import settings_for
from tests.scenes import LAW, chains
from validation.references.interaction import Exponential, PairInteraction

OpenDeck = Callable[[Scene], tuple[Deck, Session]]
PARTICLES, STIFFNESS, TANGENTIAL, MASS, DRAG = 60, 0.83, 0.5, 1.0, 0.3
APART = 30.0
"""Distance that the bodies are moved apart by [LU], far beyond the cutoff."""
KICK, TIMES = 0.1, 12
"""Velocity of every particle at the start [LU/TU], and places looked at, 1 TU apart: two periods, four decay times."""
INTEGRATION = 0.06
"""Over v₀/ω; 0.033 measured: in velocity Verlet the drag lags by half a time step of 0.2 TU. Half the drag: 0.2 off."""
COLD = 1e-7
"""k_BT [FU·LU]: a particle swings by 3e-4 LU, the mean of all by 4e-5 of the 0.1 LU of the motion."""
LINEAR = 0.1
"""Part of the tolerance that a spring's force may be off, for moves up to a spacing; a long bond is for 0.05."""
TOLERANCE = 1e-2
WEAK = 1e-3
"""Drag of a particle that allows any time step, as a plate without drag does, so that the stiffness decides."""
STABLE = 1.0
"""ω Δt of the stiffest motion: half of Verlet's limit."""


def timed(drag: float = DRAG, **tables: Any) -> Scene:
    """Two chains in time, whose plate bears no load."""
    bodies = {"particles": PARTICLES, "mass": MASS} | tables.pop("bodies", {})
    return read_scene(
        chains(
            1000.0,
            STIFFNESS,
            bodies=bodies,
            damping={"coefficient": drag},
            plate={"damping": 0.0},
            accuracy={"tolerance": TOLERANCE},
            experiment={"kind": "load", "method": "dynamic", "force": 0.0},
            **tables,
        )
    )


@pytest.mark.parametrize("tables", [{}, {"noise": {"temperature": COLD, "seed": 5}}], ids=["damping", "noise"])
def test_a_kicked_particle_swings_and_comes_to_rest_as_its_drag_says(
    open_deck: OpenDeck, tables: dict[str, Any]
) -> None:
    """With the thermostat as without: its friction is the scene's [damping]."""
    deck, session = open_deck(timed(**tables))
    session.execute(f"displace_atoms upper_body move 0.0 0.0 {APART} units box", phase="swinging")
    lower = slice(0, PARTICLES)  # whose anchors stand still
    start = session.atoms("x")["x"][lower, 2]
    session.execute(f"velocity particles set 0.0 0.0 {KICK}")
    stride = round(1.0 / deck.settings.motion.time_step)
    found = []
    for _ in range(TIMES):
        session.execute(f"run {stride} post no")
        found.append(float(np.mean(session.atoms("x")["x"][lower, 2] - start)))
    time = deck.settings.motion.time_step * stride * np.arange(1, TIMES + 1)
    decay = 0.5 * DRAG / MASS
    omega = math.sqrt(STIFFNESS / MASS - decay**2)
    exact = KICK / omega * np.exp(-decay * time) * np.sin(omega * time)
    assert np.abs(np.array(found) - exact).max() < INTEGRATION * KICK / omega


@pytest.mark.parametrize("tangential", [TANGENTIAL, STIFFNESS, 2.0])
def test_bulk_springs_are_linear_and_do_not_mix_the_directions(open_deck: OpenDeck, tangential: float) -> None:
    """Moves up to a spacing, along both at once."""
    scene = timed(bodies={"bulk_stiffness_tangential": tangential}, horizontal={})
    _, session = open_deck(scene)
    session.execute(f"displace_atoms upper_body move 0.0 0.0 {APART} units box", phase="pushing")
    x = z = 0.0
    for to_x, to_z in ((0.5, 0.0), (1.0, 1.0), (-1.0, 0.5), (0.0, -1.0)):
        move = f"displace_atoms particles move {to_x - x} 0.0 {to_z - z} units box\nrun 0 post no"
        session.execute(move)
        x, z = to_x, to_z
        force = session.atoms("f")["f"][:PARTICLES]
        expected = np.array([-tangential * x, -STIFFNESS * z])
        size = max(tangential, STIFFNESS) * math.hypot(x, z)
        assert np.abs(force[:, [0, 2]] - expected).max() < LINEAR * TOLERANCE * size


@pytest.mark.parametrize("stiffness", [STIFFNESS, 0.1, 0.01])
@pytest.mark.parametrize("neighbours", [0.0, 3.0])
def test_the_stiffest_motion_is_stable(stiffness: float, neighbours: float) -> None:
    """An opposite pair that swings against each other at its force-free distance; neighbours in opposite phase."""
    tables: dict[str, Any] = {"neighbours": {"stiffness": neighbours}} if neighbours else {}
    settings = settings_for(timed(WEAK, bodies={"bulk_stiffness": stiffness}, **tables))
    law = PairInteraction(Exponential(*LAW[:2]), Exponential(*LAW[2:]))
    pair = -float(law.force_slope(np.asarray(law.force_free_distance())))
    stiffest = stiffness + 4.0 * neighbours + 2.0 * pair
    assert settings.motion.time_step * math.sqrt(stiffest / MASS) < STABLE
