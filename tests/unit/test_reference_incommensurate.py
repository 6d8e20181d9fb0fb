"""The reference of incommensurate chains, against minimising without it and against its limits."""

from __future__ import annotations

import numpy as np
import pytest

from validation.references.incommensurate import shared_corrugation, threshold
from validation.references.prandtl_tomlinson import corrugation, slow_friction

LAW, LOAD = (1.0, 0.5, 0.5, 1.0), 0.2
STIFF, BELOW = 0.2, 0.06
"""Springs along x above and below the threshold [FU/LU]."""
FINE = 1e-3
"""Step of the heights and places that are tried [LU]."""


def test_the_mean_of_the_springs_forces_is_the_load() -> None:
    """A particle that follows the body, by the lowest energy on a grid of places and heights."""
    wells = shared_corrugation(LAW, 1.0, LOAD, 1.0, STIFF)
    mean = float(wells.heights[0] + 0.0)
    z = np.arange(0.55, 0.95, FINE)
    x = np.arange(-0.5, 0.5, 10.0 * FINE)
    row = np.arange(-40.0, 41.0)
    r = np.hypot(x[:, None, None] - row, z[None, :, None])
    pairs = (np.exp(-2.0 * r) - 0.5 * np.exp(-r)).sum(axis=2)

    def load(place: float) -> float:
        """Mean force of the springs [FU], if it is LOAD where a particle is at this height."""
        forces = []
        for body in np.linspace(-0.5, 0.5, 20, endpoint=False):
            energy = pairs + LOAD * z + 0.5 * (z - place) ** 2 + 0.5 * STIFF * (x[:, None] - body) ** 2
            _, lowest = np.unravel_index(int(energy.argmin()), energy.shape)
            forces.append(LOAD + z[lowest] - place)
        return float(np.mean(forces))

    heights = [mean - 0.02, mean + 0.02]
    # the height at which the mean force is the load lies where the reference has it
    assert load(heights[0]) > LOAD > load(heights[1])


def test_soft_springs_carry_one_load_each() -> None:
    assert threshold(LAW, 1.0, LOAD, 1e-3) == pytest.approx(corrugation(LAW, 1.0, LOAD).steepest, rel=1e-3)


def test_one_height_for_all_raises_the_threshold() -> None:
    """On the top a particle presses its spring: 0.1225 FU/LU in place of 0.1075, with springs of 1 FU/LU."""
    assert threshold(LAW, 1.0, LOAD, 1.0) == pytest.approx(0.1225, abs=1e-4)
    assert slow_friction(shared_corrugation(LAW, 1.0, LOAD, 1.0, BELOW), BELOW) == pytest.approx(4.908e-3, rel=1e-3)
    assert slow_friction(shared_corrugation(LAW, 1.0, LOAD, 1.0, STIFF), STIFF) == 0.0


def test_a_spring_that_stands_still_adds_its_energy() -> None:
    """U′ of the held particle against a difference of energies, minimised on a fine grid."""
    wells, x, step = corrugation(LAW, 1.0, LOAD, 1.0, 0.7), 0.3, 1e-3
    z = np.linspace(0.5, 1.1, 60_001)

    def energy(place: float) -> float:
        r = np.hypot(place - np.arange(-60.0, 61.0)[:, None], z)
        return float(((np.exp(-2.0 * r) - 0.5 * np.exp(-r)).sum(axis=0) + LOAD * z + 0.5 * (z - 0.7) ** 2).min())

    slope = (energy(x + step) - energy(x - step)) / (2.0 * step)
    assert float(wells.slope(np.asarray(x))) == pytest.approx(slope, rel=1e-4)
