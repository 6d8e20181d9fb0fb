"""The rows of a prescribed path: those that the scene asks for, and those on the way between two of them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from contact1d.workflow.deck.steps import DisplaceInTime, Phase, Row, displacements
from contact1d.workflow.experiments.path.thermal import thermal_rows
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

RELAXATIONS = 14.0
"""Time that a dynamic path gives the particles at each displacement, over the time constant of their slowest decay."""
ROUND_OFF = 1e-9
EARLINESS = 8.0
"""Square of the longest move of bodies that part over the range squared, per unit of tolerance."""


def schedule(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """One phase for each stretch of rising ("loading") or falling ("unloading") displacement."""
    all_ = places(scene, settings)
    stretches: list[tuple[str, list[tuple[float, bool]]]] = [("loading", [all_[0]])]
    for before, place in pairwise(all_):
        branch = "loading" if place[0] > before[0] else "unloading"
        if stretches[-1][0] != branch:
            stretches.append((branch, []))
        stretches[-1][1].append(place)
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

    The way starts at 0, where the bodies stand in system.data, unless the first displacement draws them apart: from
    there it is the state that comes from far away.
    """
    found: list[tuple[float, bool]] = []
    before = 0.0
    for value in scene.experiment.places():
        longest = settings.longest_move if value > before else _longest_drop(settings)
        moves = max(1, math.ceil(abs(value - before) / longest - ROUND_OFF))
        if not found and value < before:
            moves = 1
        found += [(before + (value - before) * i / moves, False) for i in range(1, moves)]
        found.append((value, True))
        before = value
    return found


def _longest_drop(settings: Settings) -> float:
    """Longest move [LU] by which bodies that part keep the particles that the law still holds: inf where none snaps.

    A move h puts a stuck pair h further apart before it relaxes. It lets go where that is beyond the unstable place
    next to it, which is 2 √(2 e/|G″|) away at a gap e before the fold of G(r): too early by e = h² |G″|/8. With |G″| of
    the ratio of the stiffnesses over the range b, and a loop as wide as some of that ratio times b,
    h = √(8 tolerance) b leaves a share of `tolerance` of the loop.
    """
    if settings.law is None or settings.is_smooth:
        return math.inf
    return min(settings.longest_move, math.sqrt(EARLINESS * settings.tolerance) * settings.law.longest_range)


def _rows(scene: Scene, settings: Settings, places: Sequence[tuple[float, bool]]) -> tuple[Row, ...]:
    if scene.noise is not None:
        return thermal_rows(settings, _decay(scene, settings), places)
    if scene.method == "quasistatic":
        return displacements([place for place, _ in places])
    steps = math.ceil(RELAXATIONS * _decay(scene, settings) / settings.time_step)
    return tuple(DisplaceInTime(float(place), steps) for place, _ in places)


def _decay(scene: Scene, settings: Settings) -> float:
    """Time constant [TU] with which a particle on its bulk spring comes to rest: 2m/γ, overdamped γ/k."""
    mass, stiffness = scene.bodies.mass, scene.bulk_stiffness
    return max(2.0 * mass / settings.damping, settings.damping / stiffness)
