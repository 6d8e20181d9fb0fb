"""The rows of a prescribed path: those that the scene asks for, and those on the way between two of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from contact1d.workflow.deck.steps import DisplaceInTime, Phase, Row, displacements
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

RELAXATIONS = 14.0
"""Time that a dynamic path gives the particles at each displacement, over the time constant of their slowest decay."""
ROUND_OFF = 1e-9


def schedule(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """One phase for each stretch of rising ("loading") or falling ("unloading") displacement."""
    values = [value for value, _ in places(scene, settings)]
    stretches: list[tuple[str, list[float]]] = [("loading", [values[0]])]
    for before, value in pairwise(values):
        branch = "loading" if value > before else "unloading"
        if stretches[-1][0] != branch:
            stretches.append((branch, []))
        stretches[-1][1].append(value)
    stretches = [(branch, rows) for branch, rows in stretches if rows]
    counts: dict[str, int] = {}
    phases = []
    for branch, rows in stretches:
        counts[branch] = counts.get(branch, 0) + 1
        name = branch if counts[branch] == 1 else f"{branch}_{counts[branch]}"
        phases.append(Phase(name, _rows(scene, settings, rows), state=True))
    return tuple(phases)


def places(scene: Scene, settings: Settings) -> list[tuple[float, bool]]:
    """Displacements [LU] of all rows, and whether the scene asks for them or they lie on the way between two of those.

    The way starts at 0, where the bodies stand in system.data, unless the first displacement draws them apart.
    """
    found: list[tuple[float, bool]] = []
    before = 0.0
    for value in scene.experiment.places():
        moves = max(1, math.ceil((value - before) / settings.longest_move - ROUND_OFF))
        found += [(before + (value - before) * i / moves, False) for i in range(1, moves)]
        found.append((value, True))
        before = value
    return found


def _rows(scene: Scene, settings: Settings, places: Sequence[float]) -> tuple[Row, ...]:
    if scene.method == "quasistatic":
        return displacements(places)
    steps = math.ceil(RELAXATIONS * _decay(scene, settings) / settings.time_step)
    return tuple(DisplaceInTime(float(place), steps) for place in places)


def _decay(scene: Scene, settings: Settings) -> float:
    """Time constant [TU] with which a particle on its bulk spring comes to rest: 2m/γ, overdamped γ/k."""
    mass, stiffness = scene.bodies.mass, scene.bulk_stiffness
    return max(2.0 * mass / settings.damping, settings.damping / stiffness)
