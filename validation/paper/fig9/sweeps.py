"""The slides of the study are those of the sweeps that ship with the program, one run for each point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from validation.doors import Scene, sweep_points

LOAD, RADIUS = "friction_over_load", "friction_over_radius"
PARTICLE, VELOCITY, STIFFNESS = "friction_of_one_particle", "friction_over_velocity", "friction_over_stiffness"
FLATS, LATTICES, TEMPERATURE = "friction_of_flats", "friction_of_lattices", "friction_over_temperature"
SWEEPS = (TEMPERATURE, VELOCITY, LOAD, RADIUS, FLATS, STIFFNESS, PARTICLE, LATTICES)
"""Those with the longest runs come first."""
Place = tuple[float, ...]


@dataclass(frozen=True)
class Slides:
    """The points of a sweep: names of their runs and scenes, by the values of the axes that have several."""

    names: dict[Place, str]
    scenes: dict[Place, Scene]

    @property
    def every(self) -> list[str]:
        """The names of all runs."""
        return list(self.names.values())


@cache
def slides(sweep: str) -> Slides:
    """The slides of a shipped sweep."""
    scenes = sweep_points(sweep)
    return Slides({place: "_".join([sweep, *(f"{value:g}" for value in place)]) for place in scenes}, scenes)
