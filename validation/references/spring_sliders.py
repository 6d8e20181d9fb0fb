"""Coulomb's friction on a rigid plane, particle by particle: springs whose ends slide where their force is too large.

    f_i = k_n max(0, d - h_i),    s_i <- clip(s_i + k_t du, +-mu f_i)

on straight ways from one (d, u) to the next; exact, one particle after the other in plain numbers. While a particle is
touched its limit changes evenly, so that a force which has reached it stays there; a particle that leaves loses its
force, one that touches begins with none. What is dissipated follows from the balance of energy, work less what the
springs hold.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field


@dataclass
class SpringSliders:
    """One chain on a plane with friction, at rest and untouched, d = u = 0.

    Args:
        heights: h_i >= 0 of the particles above the apex [LU].
        normal, tangential: k_n and k_t [FU/LU].
        friction: mu.

    Attributes:
        displacement, place: d and u now [LU].
        forces: s_i [FU].
        work: done by the ends of the springs along x so far [FU LU].
    """

    heights: Sequence[float]
    normal: float
    tangential: float
    friction: float
    displacement: float = 0.0
    place: float = 0.0
    forces: list[float] = field(default_factory=list)
    work: float = 0.0

    def __post_init__(self) -> None:
        """No particle has a force yet."""
        self.forces = [0.0] * len(self.heights)

    def move(self, displacement: float, place: float) -> None:
        """Go straight to d and u [LU]."""
        for i, height in enumerate(self.heights):
            before, after = self.displacement - height, displacement - height
            if before <= 0.0 and after <= 0.0:
                continue
            begin = -before / (after - before) if before < 0.0 else 0.0
            end = before / (before - after) if after < 0.0 else 1.0
            self._pass(i, (place - self.place) * (end - begin), self._limit(before), self._limit(after))
        self.displacement, self.place = displacement, place

    def _limit(self, overlap: float) -> float:
        return self.friction * self.normal * max(overlap, 0.0)

    def _pass(self, i: int, way: float, limit: float, next_limit: float) -> None:
        """A particle that is touched from the begin to the end of its way."""
        start = self.forces[i]
        wanted = start + self.tangential * way
        end = min(max(wanted, -next_limit), next_limit)
        if wanted == end:
            self.work += 0.5 * (start + end) * way
        else:
            side = 1.0 if wanted > end else -1.0
            # start + k way t = side (limit + (next_limit - limit) t)
            part = (side * limit - start) / (self.tangential * way - side * (next_limit - limit))
            part = min(max(part, 0.0), 1.0)
            middle = side * (limit + (next_limit - limit) * part)
            self.work += 0.5 * way * (part * (start + middle) + (1.0 - part) * (middle + end))
        self.forces[i] = end

    @property
    def normal_force(self) -> float:
        """sum f_i [FU]."""
        return sum(self.normal * max(self.displacement - height, 0.0) for height in self.heights)

    @property
    def tangential_force(self) -> float:
        """sum s_i [FU]."""
        return sum(self.forces)

    @property
    def dissipated(self) -> float:
        """Work less sum s_i^2/2 k_t [FU LU]."""
        return self.work - sum(force**2 for force in self.forces) / (2.0 * self.tangential)


def displacement_under(force: float, heights: Sequence[float], normal: float) -> float:
    """Return the d [LU] at which sum k_n max(0, d - h_i) is a force > 0 [FU], from the lowest particle upwards."""
    total = 0.0
    ordered = sorted(heights)
    for count, height in enumerate(ordered, 1):
        total += height
        found = (force / normal + total) / count
        if count == len(ordered) or found <= ordered[count]:
            return found
    raise ValueError("there are no particles")
