"""What a thermostat costs and how true it is: the variance of free particles over equipartition, at equal steps.

Away from the contact a chain is made of springs, whose matrix K = k + k_n (second difference with free ends) gives

    ⟨u_i²⟩ = k_BT (K⁻¹)_ii,      u_i a particle's displacement along z from its place in the bulk.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.cost.change import Change
from contact1d.workflow.cost.per_step import opened
from contact1d.workflow.cost.record import Sampling
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.session import Session
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import settings_for

Array = NDArray[np.float64]
SCHEMES = ("langevin", "gjf")
FACTORS = (1.0, 2.0, 4.0, 8.0)
"""Time steps over the scene's own."""
STEPS, STRIDE, BLOCKS = 60_000, 50, 20
"""Steps of each scheme, between two samples, and blocks whose means give the standard error."""
FORGET = 0.1
"""Part of the steps that come before the first sample."""
APART = 10.0
"""Distance that the bodies are moved apart by, over cutoff and largest displacement."""


def samplings(scene: Scene, folder: Path, steps: int = STEPS) -> tuple[Sampling, ...]:
    """Every scheme at every time step, for a scene with noise; none for another."""
    if scene.noise is None:
        return ()
    own = settings_for(scene).time_step
    return tuple(_sampled(scene, s, f * own, folder / f"{s}_{f:g}", steps) for s in SCHEMES for f in FACTORS)


def _sampled(scene: Scene, scheme: str, time_step: float, folder: Path, steps: int) -> Sampling:
    change = Change(settings=(("thermostat", scheme), ("time_step", time_step)))
    deck = Deck(scene, change.chosen(scene))
    assert scene.noise is not None
    expected = scene.noise.temperature * _flexibility(deck)
    with opened(deck, folder) as session:
        rest = _parted(session, deck)
        session.execute(f"run {int(FORGET * steps)} post no")
        before = session.lammps_cpu_seconds
        squares = _squares(session, rest, deck.settings.particles * scene.chains, steps // STRIDE)
        cpu = session.lammps_cpu_seconds - before
    means = [float(block.mean()) for block in np.array_split(squares / expected, BLOCKS)]
    error = float(np.std(means, ddof=1)) / np.sqrt(BLOCKS)
    return Sampling(scheme, time_step, 1e6 * cpu / steps, float(np.mean(means)), float(error))


def _parted(session: Session, deck: Deck) -> Array:
    """Move the bodies out of each other's reach, and say where along z [LU] all atoms are at rest there."""
    far = APART * (deck.settings.cutoff + abs(deck.settings.largest_displacement) + deck.scene.bodies.spacing)
    session.execute(f"displace_atoms upper_body move 0.0 0.0 {far!r} units box")
    return session.atoms("x")["x"][:, 2]


def _squares(session: Session, rest: Array, count: int, samples: int) -> Array:
    """u² [LU²] of the first `count` atoms, the particles; the next ones are their anchors. Shape (samples, count)."""
    found = []
    for _ in range(samples):
        session.execute(f"run {STRIDE} pre no post no")  # a set-up would add an error of its own, of gjf above all
        moved = session.atoms("x")["x"][:, 2] - rest
        found.append((moved[:count] - moved[count : 2 * count]) ** 2)
    return np.array(found)


def _flexibility(deck: Deck) -> float:
    """Mean of (K⁻¹)_ii [LU/FU]."""
    springs = deck.scene.neighbours
    matrix = deck.settings.bulk_stiffness * np.eye(deck.settings.particles)
    if springs is not None:
        ends = np.diff(np.eye(deck.settings.particles), axis=0)
        matrix += springs.stiffness * ends.T @ ends
    return float(np.mean(np.diag(np.linalg.inv(matrix))))


def sampling_rows(found: Sequence[Sampling]) -> list[tuple[str, ...]]:
    """The cells of SAMPLING_COLUMNS."""
    return [
        (one.scheme, f"{one.time_step:.3g} TU", f"{one.us_per_step:.1f} µs", f"{one.variance:.4f} ± {one.error:.4f}")
        for one in found
    ]


SAMPLING_COLUMNS = ("thermostat", "time step", "a step", "variance over equipartition")
