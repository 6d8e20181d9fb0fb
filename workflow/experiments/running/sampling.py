"""Averages over a motion: samples a while apart, their standard error by blocks, mean profiles."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.settings.settings import Settings

CHUNK = 0.25
"""Time between two samples of a thermal contact over the settling time."""
FEWEST_STEPS = 20
SETTLING_LOOKS = 40
"""Looks (of a quarter of a settling time each) that a thermal contact has to forget its start."""
BLOCKS = 20
"""Blocks whose means give the standard error: each is long against the settling time."""


def chunk_steps(settings: Settings) -> int:
    """Timesteps between two samples of a thermal contact."""
    return max(FEWEST_STEPS, math.ceil(CHUNK * settings.settle_time / settings.time_step))


def sampled_phase(name: str, settings: Settings, load: float, samples: int, state: bool = False) -> Phase:
    """A planned phase of so many samples under a load [FU]."""
    return Phase(name, (UnderLoad(load, chunk_steps(settings)),) * samples, state)


def standard_error(samples: Sequence[float]) -> float:
    """Standard error of the mean of a correlated series, from the means of BLOCKS blocks."""
    means = [float(np.mean(block)) for block in np.array_split(np.asarray(samples), BLOCKS)]
    return float(np.std(means, ddof=1) / math.sqrt(BLOCKS))


def sample_columns(states: Sequence[State], loads: Sequence[float], settings: Settings) -> dict[str, tuple[float, ...]]:
    """The columns of samples.csv: time [TU], load and force [FU], displacement and contact radius [LU] of each state.

    Args:
        states: in order.
        loads: under which each was measured [FU].
        settings: with the length of a timestep.
    """
    radii = [state.radius for state in states]
    return {
        "time": tuple(state.step * settings.time_step for state in states),
        "load": tuple(loads),
        "displacement": tuple(state.displacement for state in states),
        "force": tuple(state.force for state in states),
        "contact_radius": tuple(math.nan if radius is None else radius.value for radius in radii),
    }


def mean_profile(profiles: Sequence[Profile]) -> Profile:
    """The average over time, particle by particle."""

    def mean(name: str) -> NDArray[np.float64]:
        return np.asarray(np.mean([getattr(profile, name) for profile in profiles], axis=0))

    return Profile(*(mean(name) for name in ("x", "z_lower", "z_upper", "pressure", "shear")))
