"""A path under heat: at each place the particles forget how they came, and their mean over time is the state.

⟨F⟩(d) = A′(d), A the free energy of the particles at the displacement d
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from contact1d.workflow.deck.steps import DisplaceInTime
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.sampling import (
    SETTLING_LOOKS,
    chunk_steps,
    mean_profile,
    standard_error,
)
from contact1d.workflow.settings.settings import Settings

SAMPLES = 200
"""States of each place that the mean is over."""
APART = 0.5
"""Time between two of them over that of a particle's slowest decay, at least."""
CERTAIN = 2.0
"""Error of a mean that is reported over its standard error: the largest of many means is one that chance made large."""


def thermal_rows(settings: Settings, decay: float, places: Sequence[tuple[float, bool]]) -> tuple[DisplaceInTime, ...]:
    """The rows at each of the places [LU]: all that forget, and where the state is wanted those that are averaged.

    Args:
        settings: of the scene.
        decay: time constant of a particle [TU].
        places: displacement [LU], and whether the scene asks for it.
    """
    look = max(chunk_steps(settings), math.ceil(APART * decay / settings.time_step))
    return tuple(
        DisplaceInTime(float(place), look)
        for place, wanted in places
        for _ in range(SETTLING_LOOKS + (SAMPLES if wanted else 0))
    )


def averaged(states: Sequence[State], places: Sequence[tuple[float, bool]]) -> list[State]:
    """One state for each place: the mean of its samples, or the last one on the way between two that are wanted.

    What is left of a force on a particle, `residual`, is then what its mean is uncertain by: CERTAIN standard errors of
    the whole force over their number.
    """
    found, first = [], 0
    for _, wanted in places:
        end = first + SETTLING_LOOKS + (SAMPLES if wanted else 0)
        samples, last = states[first + SETTLING_LOOKS : end], states[end - 1]
        first = end
        if not wanted:
            found.append(last)
            continue
        forces = [one.force for one in samples]
        found.append(
            replace(
                last,
                force=float(np.mean(forces)),
                profile=mean_profile([one.profile for one in samples]),
                smallest_distance=min(one.smallest_distance for one in samples),
                depth=max(one.depth for one in samples),
                residual=CERTAIN * standard_error(forces) / last.profile.x.size,
            )
        )
    return found
