"""How long a chain is that follows from its contact: what is felt, and what comes back from a free end."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.settings.chain import chain_length, decay_length, reflected
from contact1d.workflow.settings.settings import settings_for
from tests.unit.test_estimate import RADIUS, REST, estimate, parabola, scene_of


def linear_chain(particles: int, stiffness: float, neighbours: float, pushed: int) -> Any:
    """Moves of a chain whose particle `pushed` bears a force of 1."""
    matrix = np.diag(np.full(particles, stiffness))
    for i in range(particles - 1):
        matrix[i : i + 2, i : i + 2] += neighbours * np.array([[1.0, -1.0], [-1.0, 1.0]])
    return np.linalg.solve(matrix, np.eye(particles)[pushed])


@pytest.mark.parametrize("neighbours", [0.2, 5.0, 80.0])
def test_a_push_dies_away_over_the_decay_length(neighbours: float) -> None:
    scene = parabola(neighbours={"stiffness": neighbours})
    moves = linear_chain(401, 1.0, neighbours, 200)
    assert moves[203] / moves[202] == pytest.approx(math.exp(-1.0 / decay_length(scene)), rel=1e-6)
    assert decay_length(parabola()) == 0.0


def test_the_softest_direction_reaches_furthest() -> None:
    bodies = {"particles": 60, "bulk_stiffness": 1.0, "bulk_stiffness_tangential": 0.2}
    both = scene_of(RADIUS, neighbours={"stiffness": 5.0}, horizontal={}, bodies=bodies)
    along = linear_chain(401, 0.2, 5.0, 200)
    assert along[203] / along[202] == pytest.approx(math.exp(-1.0 / decay_length(both)), rel=1e-6)


def test_what_comes_back_from_a_free_end_is_what_is_said() -> None:
    neighbours, particles = 40.0, 60
    scene = parabola(neighbours={"stiffness": neighbours})
    found = settings_for(scene)
    edge = found.estimate.half_width(
        found.largest_displacement, float(found.estimate.gap[int(found.estimate.force.argmin())])
    )
    middle = particles // 2 + round(edge - 0.5)
    short, endless = (linear_chain(particles, 1.0, neighbours, middle)[middle], None)
    endless = linear_chain(801, 1.0, neighbours, 400)[400]
    beyond = particles / 2 - (middle + 0.5 - particles / 2)
    there = reflected(scene, found.estimate, found.largest_displacement, particles)
    other = math.exp(-2.0 * (particles - beyond) / decay_length(scene))
    assert short / endless - 1.0 - other == pytest.approx(there, rel=0.2)  # the edge is no particle
    assert reflected(parabola(), found.estimate, found.largest_displacement, particles) == 0.0


@pytest.mark.parametrize("share", [1e-2, 1e-4])
@pytest.mark.parametrize("neighbours", [None, 30.0])
def test_an_automatic_chain_ends_where_nothing_is_felt_and_nothing_comes_back(
    share: float, neighbours: float | None
) -> None:
    scene = parabola() if neighbours is None else parabola(neighbours={"stiffness": neighbours})
    found = estimate(0.5)
    largest = found.displacement_at(0.1)
    particles = chain_length(scene, found, largest, share)
    gap = REST + (0.5 * (particles - 1)) ** 2 / (2.0 * RADIUS) - largest
    there = abs(float(np.interp(gap, found.gap, found.force, right=0.0)))
    assert there <= share * float(np.abs(found.force[found.gap > REST - largest]).max())
    back = reflected(scene, found, largest, particles)
    assert back <= share
    nearer = (0.6 * particles / 2) ** 2 / (2.0 * RADIUS) + REST - largest
    felt = abs(float(np.interp(nearer, found.gap, found.force, right=0.0)))
    tight = felt > share * float(np.abs(found.force[found.gap > REST - largest]).max())
    assert tight or back > share**2  # and it is not much longer than that
