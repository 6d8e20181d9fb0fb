"""What rows miss of a maximum between them: the sum over particles one by one, at every place, in four shifts of rows.

Reference: loops over particles and places, with the force between two entries of the estimate's table on a line.
"""

from __future__ import annotations

from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import largest_tension
from contact1d.workflow.experiments.path.between_rows import missed_between_rows

REST, RADIUS = 0.3, 100.0
GAP = np.linspace(0.05, 1.2, 47)
FORCE = 3.0 * np.exp(-GAP / 0.1) - 0.9 * np.exp(-GAP / 0.25)


def force_of(gap: float) -> float:
    """Between two entries on a line; the first one nearer than the table, and none beyond it."""
    if gap > GAP[-1]:
        return 0.0
    i = min(max(int(np.searchsorted(GAP, gap)), 1), len(GAP) - 1)
    part = min(max((gap - GAP[i - 1]) / (GAP[i] - GAP[i - 1]), 0.0), 1.0)
    return float(FORCE[i - 1] + part * (FORCE[i] - FORCE[i - 1]))


def missed(particles: int, spacing: float, rows: list[float], between: int = 32) -> float:
    """1.5 times the share by which the worst of four shifted sets of rows misses the highest of all places."""

    def force(d: float) -> float:
        places = [(i - (particles - 1) / 2.0) * spacing for i in range(particles)]
        return sum(force_of(REST + x**2 / (2.0 * RADIUS) - d) for x in places)

    if len(rows) < 2:
        return 0.0
    fine = [a + (b - a) * n / between for a, b in pairwise(rows) for n in range(between)]
    fine.append(rows[-1])
    curve = [force(d) for d in fine]
    top = min(range(len(fine)), key=lambda i: curve[i])
    if curve[top] >= 0.0:
        return 0.0
    increment = 0.5 * (fine[max(top - between, 0)] - fine[min(top + between, len(fine) - 1)])
    shares = []
    for shift in (0.0, 0.25, 0.5, 0.75):
        read = largest_tension(rows, [force(d + shift * increment) for d in rows]).smooth
        shares.append(abs(read / -curve[top] - 1.0))
    return 1.5 * max(shares)


def asked(particles: int, spacing: float, rows: list[float]) -> float:
    profile = SimpleNamespace(height=lambda x: x**2 / (2.0 * RADIUS))
    estimate = SimpleNamespace(profile=profile, rest=REST, gap=GAP, force=FORCE)
    scene: Any = SimpleNamespace(bodies=SimpleNamespace(spacing=spacing))
    settings: Any = SimpleNamespace(estimate=estimate, particles=particles)
    return missed_between_rows(scene, settings, rows)


@pytest.mark.parametrize(("particles", "spacing"), [(8, 1.0), (7, 1.0), (12, 2.5), (9, 0.25), (2, 1.0), (1, 1.0)])
@pytest.mark.parametrize(
    "rows",
    [
        np.linspace(0.2, -0.6, 9).tolist(),
        np.linspace(0.2, -0.6, 23).tolist(),
        [0.2, 0.05, 0.0, -0.08, -0.1, -0.2, -0.24, -0.5],
        [0.2, -0.1],
        [-0.2, -0.3, -0.5, -0.6],
        [0.3, 0.2, 0.1, 0.05],
        [-0.03, -0.05],
        [-2.0, -3.0],
        [-0.1],
    ],
)
def test_a_share_is_that_of_the_sum_over_all_particles(particles: int, spacing: float, rows: list[float]) -> None:
    assert asked(particles, spacing, rows) == pytest.approx(missed(particles, spacing, rows), rel=1e-9, abs=1e-12)


def test_of_many_pairs_there_are_fewer_places_between_two_rows_and_two_at_least() -> None:
    """Four million forces in all; particles far out are felt by nobody, and cost as much."""
    rows = np.linspace(0.2, -0.6, 9).tolist()
    for particles, between in ((2 * 20_000, 22), (2 * 200_000, 2)):
        assert 2 <= between == max(2, 4_000_000 // (9 * particles // 2)) < 32
        near = missed(400, 1.0, rows, between)
        assert asked(particles, 1.0, rows) == pytest.approx(near, rel=1e-9)
    assert missed(400, 1.0, rows, 22) != pytest.approx(missed(400, 1.0, rows, 44), rel=1e-6)
