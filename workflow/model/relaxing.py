"""Springs with a memory in time on a rigid plane: the material law stays local, since line force and displacement of a
circular contact are Abel transforms of its pressure and surface displacement (Popov and Heß 2015, chapter 7).

    f = k (part u + Σ share_j s_j),   s_j′ = u′ − s_j/time_j             Prony's series of the instantaneous modulus
    f = k (u + T u′)                                                    Kelvin and Voigt

In contact u = d − g(x); a particle leaves where f would be below 0, and then its surface comes back with f = 0, and may
be touched again. Over a load step of the time Δ along which u changes evenly

    s_j ← s_j e^(−Δ/τ) + Δu τ/Δ (1 − e^(−Δ/τ))

Exact for one circular contact of a body with a constant Poisson's ratio (Lee and Radok 1960, Ting 1966).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.scene import Viscoelasticity

Array = NDArray[np.float64]
SUDDEN, MOMENTS = 1e-6, 200
"""Time over the shortest one of a body in which something happens at once; steps of the creep of one spring."""


class Memory:
    """The state of particles in time: how far each surface is pressed in, and what its arms remember.

    Attributes:
        place: displacement of the body [LU].
        surface: u of each particle, (n,) [LU].
    """

    def __init__(self, law: Viscoelasticity, heights: Array) -> None:
        """Untouched, above particles at undeformed heights (n,) [LU]."""
        terms = law.terms or ()
        self._lasting, self._retarded, self._heights = law.lasting, law.retardation_time or 0.0, heights
        self._share, self._time = (np.asarray([getattr(term, key) for term in terms]) for key in ("share", "time"))
        self._arms = np.zeros((len(terms), heights.size))
        self.place, self.surface = 0.0, np.zeros_like(heights)

    def _ahead(self, time: float) -> tuple[float, Array, Array, Array]:
        """Response, free surfaces (n,) [LU], decay and gain of each arm after a time [TU]."""
        if self._retarded:
            none = np.empty(0)
            return 1.0, self.surface * np.exp(-time / self._retarded), none, none
        age = time / self._time
        decay, gain = np.exp(-age), -np.expm1(-age) / age
        response = self._lasting + float(self._share @ gain)
        past = (self._share * decay) @ self._arms - float(self._share @ gain) * self.surface
        return response, -past / response, decay, gain

    def pressed(self, place: float, time: float) -> tuple[Array, Array]:
        """Forces over stiffness as the body comes to a displacement [LU] after a time [TU], and its overlaps.

        Both (n,) [LU]; overlaps go on below 0 where nothing touches, so that they tell where the contact ends.
        """
        response, free, *_ = self._ahead(time)
        overlap = place - self._heights
        if self._retarded:
            push = overlap + self._retarded * (place - self.place) / time
            margin = np.minimum(overlap - free, push)
            return np.where(margin > 0.0, push, 0.0), margin
        return response * np.maximum(overlap - free, 0.0), overlap - free

    def under(self, load: float, counts: Array, time: float) -> float:
        """Displacement [LU] after a time [TU] at which forces over stiffness, `counts` of each, make a `load` ≥ 0 [LU].

        Each is straight, slope (place − base), beyond where it is touched.
        """
        slope, free, *_ = self._ahead(time)
        rate = self._retarded / time
        slope, base = slope + rate, (self._heights + (rate * self.place if rate else free)) / (1.0 + rate)
        touch = np.maximum(base, self._heights + free)
        order = np.argsort(touch)
        starts, slopes = touch[order], slope * np.cumsum(counts[order])
        wanted = (load + slope * np.cumsum((counts * base)[order])) / slopes
        last = int(np.argmax(wanted <= np.append(starts[1:], np.inf)))
        return float(max(wanted[last], starts[last]))

    def go(self, place: float, time: float) -> None:
        """Bring the body to a displacement [LU], evenly over a time [TU]."""
        _, free, decay, gain = self._ahead(time)
        after = np.maximum(place - self._heights, free)
        self._arms = decay[:, None] * self._arms + gain[:, None] * (after - self.surface)
        self.place, self.surface = place, after


def creep(law: Viscoelasticity | None, time: float) -> float:
    """Displacement of a spring after a time [TU] under a load, over that at once; 1 of one that is elastic."""
    if law is None or law.retardation_time or time <= 0.0:
        return 1.0
    spring, alone = Memory(law, np.zeros(1)), np.ones(1)
    moments = time * np.geomspace(SUDDEN * min(1.0, law.shortest_time / time), 1.0, MOMENTS)
    for step in np.diff(moments, prepend=0.0).tolist():
        spring.go(spring.under(1.0, alone, step), step)
    return spring.place
