"""What runs of slides say together: the slow limit, how ⟨F⟩ falls with the velocity, where sticking ends."""

from collections.abc import Mapping, Sequence
from functools import cache
from typing import NamedTuple

import numpy as np

from validation.doors import Quantity, Run, Scene, sweep_points
from validation.study import found

LOAD, RADIUS = "friction_over_load", "friction_over_radius"
PARTICLE, VELOCITY, STIFFNESS = "friction_of_one_particle", "friction_over_velocity", "friction_over_stiffness"
FLATS, LATTICES, TEMPERATURE = "friction_of_flats", "friction_of_lattices", "friction_over_temperature"
SWEEPS = (TEMPERATURE, VELOCITY, LOAD, RADIUS, FLATS, STIFFNESS, PARTICLE, LATTICES)
"""Those with the longest runs come first."""
Place = tuple[float, ...]


class Slides(NamedTuple):
    """The points of a sweep: names of their runs and scenes, by the values of the axes that have several."""

    names: dict[Place, str]
    scenes: dict[Place, Scene]

    @property
    def every(self) -> list[str]:
        """The names of all runs."""
        return list(self.names.values())

    def by(self, axis: int) -> dict[float, dict[float, str]]:
        """Names of the runs over two axes, by the values of one of them, rising, then by those of the other."""
        return {
            value: {place[1 - axis]: name for place, name in sorted(self.names.items()) if place[axis] == value}
            for value in sorted({place[axis] for place in self.names})
        }


@cache
def slides(sweep: str) -> Slides:
    """The slides of a shipped sweep."""
    scenes = sweep_points(sweep)
    return Slides({place: "_".join([sweep, *(f"{value:g}" for value in place)]) for place in scenes}, scenes)


STICKS, CRITICAL, SLIDES = 2.0 / 3.0, 0.8, 1.0
"""⟨F⟩ goes to its limit, or to 0, as v to this power: where slips are, at the threshold, where all is smooth."""


def mean(run: Run) -> float:
    """⟨F⟩ of a run [FU]; NaN where it failed."""
    return found(run, "mean_friction").value


def static(run: Run) -> float:
    """The largest friction before the plate has moved by a spacing [FU]; NaN where the run failed."""
    return found(run, "static_friction").value


def slow_limit(friction: Mapping[float, float], power: float = STICKS) -> Quantity:
    """F_0 of ⟨F⟩ = F_0 + C v^p + D v through three velocities [LU/TU].

    Which power follows v^p is not known to be 1: it is uncertain by what it is off the line in v^p through the two
    slowest.
    """
    velocities = np.asarray(sorted(friction))
    values = np.asarray([friction[v] for v in velocities])
    terms = np.column_stack([np.ones(3), velocities**power, velocities])
    limit, line = (np.linalg.solve(terms[:n, :n], values[:n])[0] for n in (3, 2))
    return Quantity(limit, abs(limit - line), "FU")


def exponent(friction: Mapping[float, float]) -> float:
    """d ln⟨F⟩/d ln v between the two slowest velocities."""
    slow, fast = sorted(friction)[:2]
    return float(np.log(friction[fast] / friction[slow]) / np.log(fast / slow))


def threshold(stiffness: Sequence[float], exponents: Sequence[float], unit: str = "1") -> Quantity:
    """The stiffness at which ⟨F⟩ falls as at a threshold: between the last one where it falls slower and the next."""
    sticking = [k for k, p in zip(stiffness, exponents, strict=True) if p < CRITICAL]
    sliding = [k for k in stiffness if k not in sticking]
    low, high = max(sticking, default=stiffness[0]), min(sliding, default=stiffness[-1])
    return Quantity(0.5 * (low + high), 0.5 * abs(high - low), unit)
