"""The rows of a tangential: those that the scene asks for, and those where a particle begins or ends to touch.

A row is one step of each particle's spring and slider, which is exact while a particle is touched all the way. Between
two rows of the scene displacement and place change together, along a straight way.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from contact1d.workflow.deck.lattice import places
from contact1d.workflow.deck.steps import Draw, Phase
from contact1d.workflow.scene import Scene, Tangential
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.settings.sliders import Sliders, Stop, sliders_of, stops

PRESSING, FORWARD, BACKWARD = "pressing", "forward", "backward"
MOST_TOUCHES = 1.0
"""Rows on the way between two of the scene, per 1/tolerance; a particle between two of them is moved from the first."""


def sliders(scene: Scene, settings: Settings) -> Sliders:
    """Those of the chain that runs."""
    return sliders_of(scene, places(settings.particles, scene.bodies.spacing))


def schedule(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The load comes on in one row, then a phase for each stretch to the right ("forward") or to the left."""
    way = passed(scene, settings)
    stretches: list[tuple[str, list[Draw]]] = [(PRESSING, [Draw(*way[0][0])])]
    direction = _first_direction([stop for stop, _ in way])
    for (before, _), (stop, _) in pairwise(way):
        if stop[1] != before[1]:
            direction = FORWARD if stop[1] > before[1] else BACKWARD
        if stretches[-1][0] != direction:
            stretches.append((direction, []))
        stretches[-1][1].append(Draw(*stop))
    counts: dict[str, int] = {}
    phases = []
    for name, rows in stretches:
        counts[name] = counts.get(name, 0) + 1
        numbered = name if counts[name] == 1 else f"{name}_{counts[name]}"
        phases.append(Phase(numbered, tuple(rows), state=name != PRESSING))
    return tuple(phases)


def passed(scene: Scene, settings: Settings) -> list[tuple[Stop, bool]]:
    """Displacement and place [LU] of every row in order, and whether the scene asks for it."""
    assert isinstance(scene.experiment, Tangential)
    chain = sliders(scene, settings)
    first, *others = stops(scene.experiment, chain)
    found, most = [(first, False)], _most(settings)
    before = first
    for stop in others:
        touches = chain.touches(before[0], stop[0])
        if len(touches) > most:
            touches = [touches[i] for i in np.linspace(0, len(touches) - 1, most).round().astype(int)]
        if stop[1] != before[1]:
            slope = (stop[1] - before[1]) / (stop[0] - before[0]) if touches else 0.0
            found += [((depth, before[1] + slope * (depth - before[0])), False) for depth in touches]
        found.append((stop, True))
        before = stop
    return found


def moved_too_far(scene: Scene, settings: Settings) -> float:
    """By how much [FU] tangential forces may be off: of particles that begin to touch between two rows on the way."""
    assert isinstance(scene.experiment, Tangential)
    chain, most, error = sliders(scene, settings), _most(settings), 0.0
    for before, stop in pairwise(stops(scene.experiment, chain)):
        touches = chain.touches(before[0], stop[0])
        if len(touches) > most:
            error += 2.0 * len(touches) * chain.tangential * abs(stop[1] - before[1]) / most
    return error


def _most(settings: Settings) -> int:
    return max(1, round(MOST_TOUCHES / settings.tolerance))


def _first_direction(way: list[Stop]) -> str:
    """That of the first move along x; "forward" where there is none."""
    moves = [after[1] - before[1] for before, after in pairwise(way)]
    return BACKWARD if next((move for move in moves if move), 1.0) < 0.0 else FORWARD
