"""Claim: with [noise] every free coordinate has its thermal variance, and a held one does not move at all.

Reference (equipartition; exact for linear springs). Without neighbour springs ⟨u_z²⟩ = k_BT/k and ⟨u_x²⟩ = k_BT/k_t for
every particle away from the contact, u counted from the particle's place in its bulk, and ⟨v²⟩ = k_BT/m along every
free direction. With them the normal modes of a chain of N particles with free ends, of stiffness k + 4 k_n
sin²(πq/2N) and shape φ_q(i) ∝ cos(πq(i + 1/2)/N), give

    ⟨u_i²⟩ = k_BT Σ_q φ_q(i)² / (k + 4 k_n sin²(πq/2N)),        inside a long chain k_BT / √(k (k + 4 k_n)),
    ⟨u_i u_(i+1)⟩ = k_BT Σ_q φ_q(i) φ_q(i+1) / (k + 4 k_n sin²(πq/2N)).

What limits the tolerance: statistics. Each number must lie within 4 of its own sample's standard errors, from time
blocks long against the relaxation (and, for independent particles, from the spread between particles). The
integrator's bias,
0.4 (ωΔt)² = the scene's tolerance of 1e-3, is below half a standard error. Seeds are fixed: a failure is no bad luck.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import read_scene
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.engine.session import Session
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains

Array = NDArray[np.float64]

SIGMAS = 4.0
"""Standard errors: one test in 16 000 would fail by chance, and the seeds are fixed."""
LARGEST_ERROR = 0.02
"""Relative standard error that a sample must reach: a test that could not tell 10 % is none. Measured: 0.3–1.7 %."""
INTEGRATOR = 1e-3
"""Relative bias of a variance: the tolerance of the scene, from which the time step follows."""
TEMPERATURE, STIFFNESS, TANGENTIAL, MASS, DAMPING = 0.01, 0.83, 0.5, 1.0, 1.5
PARTICLES = 100
SAMPLES, BLOCKS, INTERVAL = 800, 20, 1.5
"""Samples, blocks that they fall into, and the time between two samples [TU]: 0.8 relaxation times γ/k of u, so that a
block is 33 of them long."""
APART = 30.0
"""Distance that the bodies are moved apart by [LU], far beyond the cutoff."""


@dataclass(frozen=True)
class Sample:
    """Displacements from the places in the bulk and velocities; shape (samples, 2 bodies × N, 3) [LU], [LU/TU]."""

    displacement: Array
    velocity: Array


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Sample]:
    """`sample(neighbours=…, tangential=…)`: the deck's head, the bodies moved apart, and a long run at T; once each."""

    @cache
    def taken(neighbours: float = 0.0, tangential: float | None = None) -> Sample:
        scene = chains(
            1000.0,
            STIFFNESS,
            bodies={"particles": PARTICLES, "mass": MASS},
            damping={"coefficient": DAMPING},
            noise={"temperature": TEMPERATURE, "seed": 20},
            plate={},
            experiment={"kind": "load", "method": "dynamic", "force": 0.0},
        )
        if neighbours:
            scene["neighbours"] = {"stiffness": neighbours}
        if tangential is not None:
            scene["horizontal"] = {}
            scene["bodies"]["bulk_stiffness_tangential"] = tangential
        checked = read_scene(scene)
        deck = Deck(checked, settings_for(checked))
        folder = tmp_path_factory.mktemp("noise")
        write_system(deck, folder)
        with RunContext(deck, folder, Silent(), 300.0).contact() as contact:
            return drawn(contact.session, deck.settings.motion.time_step)

    return taken


def drawn(session: Session, time_step: float) -> Sample:
    """Let the particles forget their start, then take SAMPLES."""
    session.execute(f"displace_atoms upper_body move 0.0 0.0 {APART} units box", phase="sampling")
    start = session.atoms("x")["x"]
    stride = round(INTERVAL / time_step)
    session.execute(f"run {20 * stride} post no")
    count = 2 * PARTICLES
    upper = np.arange(PARTICLES, count)
    displacement, velocity = [], []
    for _ in range(SAMPLES):
        session.execute(f"run {stride} pre yes post no")
        reading = session.atoms("x", "v")
        moved = reading["x"][:count] - start[:count]
        # The plate is free, and the particles of the upper body go with it: all its anchors move alike.
        moved[upper, 2] -= reading["x"][count + PARTICLES, 2] - start[count + PARTICLES, 2]
        displacement.append(moved)
        velocity.append(reading["v"][:count])
    return Sample(np.array(displacement), np.array(velocity))


def check(products: Array, expected: float) -> None:
    """The mean of `products` (samples, particles) is `expected` within SIGMAS standard errors from time blocks."""
    means = np.array([block.mean() for block in np.split(products, BLOCKS)])
    error = float(means.std(ddof=1) / np.sqrt(BLOCKS))
    assert error < LARGEST_ERROR * expected
    assert abs(float(products.mean()) - expected) < SIGMAS * error + INTEGRATOR * expected


def modes(neighbours: float) -> tuple[Array, Array]:
    """Stiffness of each normal mode of a chain with free ends, and its shape φ_q(i), columns q, of unit length."""
    q = np.arange(PARTICLES)
    shape = np.cos(np.pi * q[None, :] * (np.arange(PARTICLES)[:, None] + 0.5) / PARTICLES)
    shape /= np.sqrt((shape**2).sum(axis=0))
    return STIFFNESS + 4.0 * neighbours * np.sin(np.pi * q / (2 * PARTICLES)) ** 2, shape


def test_held_directions_stay_exactly_where_they_are(sample: Callable[..., Sample]) -> None:
    taken = sample(0.3)
    for held in (0, 1):
        assert not taken.displacement[:, :, held].any()
        assert not taken.velocity[:, :, held].any()


def test_chain_with_neighbour_springs(sample: Callable[..., Sample]) -> None:
    neighbours = 0.3
    taken = sample(neighbours)
    stiffness, shape = modes(neighbours)
    z = taken.displacement[:, :, 2]
    exact = TEMPERATURE * (shape**2 / stiffness).sum(axis=1)
    middle = slice(20, PARTICLES - 20)
    check(z[:, middle] ** 2, float(exact[middle].mean()))
    assert exact[PARTICLES // 2] == pytest.approx(TEMPERATURE / np.sqrt(STIFFNESS * (STIFFNESS + 4.0 * neighbours)))
    check(z[:, :PARTICLES] ** 2, float(exact.mean()))
    check(z[:, PARTICLES:] ** 2, float(exact.mean()))
    beside = TEMPERATURE * (shape[:-1] * shape[1:] / stiffness).sum(axis=1)
    check(z[:, : PARTICLES - 1] * z[:, 1:PARTICLES], float(beside.mean()))
    ends = z[:, [0, PARTICLES - 1, PARTICLES, 2 * PARTICLES - 1]] ** 2
    check_ends(ends, float(exact[0]))
    check(taken.velocity[:, :, 2] ** 2, TEMPERATURE / MASS)


def check_ends(squares: Array, expected: float) -> None:
    """The four end particles move further than the others, as said by the modes: as `check`, with fewer particles."""
    means = np.array([block.mean() for block in np.split(squares, BLOCKS)])
    error = float(means.std(ddof=1) / np.sqrt(BLOCKS))
    assert abs(float(squares.mean()) - expected) < SIGMAS * error


def test_both_directions(sample: Callable[..., Sample]) -> None:
    """Different stiffnesses, by a long bond; and still nothing leaves the plane."""
    taken = sample(tangential=TANGENTIAL)
    check(taken.displacement[:, :, 0] ** 2, TEMPERATURE / TANGENTIAL)
    check(taken.displacement[:, :, 2] ** 2, TEMPERATURE / STIFFNESS)
    check(taken.velocity[:, :, 0] ** 2, TEMPERATURE / MASS)
    mixed = taken.displacement[:, :, 0] * taken.displacement[:, :, 2]
    assert abs(mixed.mean()) < SIGMAS * mixed.std() / np.sqrt(mixed.size)
    assert not taken.displacement[:, :, 1].any()
