"""The way of a slide's drive in rows and timesteps: Δt divides every leg, and every row has as many of them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from contact1d.workflow.scene import Scene, Slide

MOST_ROWS, FEWEST_ROWS = 50, 20
"""Measured states per spacing of the drive's way."""
USUAL_STEPS = 10
"""Timesteps of a row below which measuring takes longer than moving, so that there are fewer rows."""
FEWEST_STEPS = 5
"""Timesteps of a row are a multiple of it: the means of the cantilever are over every fifth one."""

ROUND_OFF = 1e-9


@dataclass(frozen=True)
class DriveLeg:
    """A leg of the drive.

    Attributes:
        velocity: [LU/TU]; 0 where it rests.
        rows: measured states.
        steps: timesteps of each row, a multiple of FEWEST_STEPS.
        time_step: [TU]; rows × steps of it are the leg's time exactly.
    """

    velocity: float
    rows: int
    steps: int
    time_step: float

    @property
    def row_time(self) -> float:
        """Time of a row [TU]."""
        return self.steps * self.time_step


def drive_steps(scene: Scene, longest: float) -> tuple[DriveLeg, ...]:
    """The legs of a slide, with timesteps of at most `longest` [TU]; none of anything else."""
    experiment, cantilever = scene.experiment, scene.cantilever
    if not isinstance(experiment, Slide) or cantilever is None:
        return ()
    found = []
    for leg in experiment.legs(cantilever.velocity):
        time = leg.distance / (abs(leg.velocity) or cantilever.velocity)
        spacings = leg.distance / scene.bodies.spacing
        each = min(MOST_ROWS, max(FEWEST_ROWS, int(time / spacings / longest / USUAL_STEPS)))
        rows = max(1, math.ceil(each * spacings - ROUND_OFF))
        steps = FEWEST_STEPS * max(1, math.ceil(time / rows / longest / FEWEST_STEPS - ROUND_OFF))
        found.append(DriveLeg(leg.velocity, rows, steps, time / rows / steps))
    return tuple(found)
