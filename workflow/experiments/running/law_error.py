"""What table and cutoff, or a plane that is not quite rigid, change in the force of a state."""

from __future__ import annotations

import math

import numpy as np

from contact1d.analysis.pressure import Profile
from contact1d.potentials import DoubleExponential
from contact1d.potentials.table import Table
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

TAIL = 10.0
"""Force of the tail beyond the cutoff, summed over particles, over the force at the cutoff times a particle's share."""
BEYOND = 5.0
"""Ranges of the law beyond the cutoff up to which its tail is summed: all but a share exp(-5) of it."""
GIVES = 2.0
"""Error of an equilibrium over that of the force on particles held in place: they follow it, and a table's error, here
at the distances that happen to be there, is half of what it is between two entries on average."""


def law_share(scene: Scene, settings: Settings) -> float:
    """Relative error of a force that table and cutoff, or a plane that is not quite rigid, may cause, before a run."""
    if settings.table is None or settings.law is None:
        return _plane_share(scene, settings)
    tail = TAIL * abs(float(settings.law.force(settings.cutoff)))
    return (tail + settings.table.error_beyond(settings.table_from)) / settings.force_scale


def law_error(scene: Scene, settings: Settings, state: State) -> float:
    """Error of the force of a measured state that table and cutoff, or the plane, cause [FU].

    GIVES Σ |F_table(r) - f(r)| |z|/r over the pairs of opposite particles, F_table = 0 beyond the cutoff.
    """
    if settings.table is None or settings.law is None:
        return _plane_share(scene, settings) * abs(state.force)
    return GIVES * _left_out(settings.law, settings.table, state.profile)


def _plane_share(scene: Scene, settings: Settings) -> float:
    neighbours = 0.0 if scene.neighbours is None else scene.neighbours.stiffness
    return 4.0 * neighbours / settings.plane_stiffness


def _left_out(law: DoubleExponential, table: Table, profile: Profile) -> float:
    """Σ |F_table(r) - f(r)| |z|/r [FU] of a profile, offset by offset along the chain: memory for one row of pairs."""
    reach = table.cutoff + BEYOND * law.longest_range
    x, lower, upper = profile.x, profile.z_lower, profile.z_upper
    spacing = float(x[-1] - x[0]) / (len(x) - 1)
    near = np.flatnonzero(upper - lower < reach)
    total = 0.0
    for offset in range(-math.ceil(reach / spacing), math.ceil(reach / spacing) + 1):
        first = near[(near + offset >= 0) & (near + offset < len(x))]
        across, up = x[first + offset] - x[first], upper[first] - lower[first + offset]
        r = np.maximum(np.hypot(across, up), table.core)
        kept = np.where(r <= table.cutoff, table.force(np.minimum(r, table.cutoff)), 0.0)
        total += float(np.sum(np.where(r < reach, np.abs(kept - law.force(r)) * np.abs(up) / r, 0.0)))
    return total
