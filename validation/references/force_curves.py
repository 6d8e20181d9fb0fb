"""Force curves of a paraboloid on a piezo and a cantilever, with noise: closed forms of Hertz, DMT, JKR and Maugis.

    JKR      F = a³ − √(6a³),   d = a² − (2/3)√(6a),   in units of `maugis` of a, F and d; Maugis's as there
    z = d + F/k, followed upwards and downwards: what a fold leaves unstable is jumped over.

Source: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from validation.references.maugis import Paraboloid
from validation.references.numerics import Floats

STATES, WIDEST = 6000, 12.0
"""States of a branch, and the largest radius in units of the theory."""


class Sphere(NamedTuple):
    """A paraboloid on a plane: E* [Pa], W [J/m²], R [m], and h₀ [m] of Maugis's."""

    modulus: float
    work: float
    radius: float
    range: float = 0.0

    @property
    def zero_load_radius(self) -> float:
        """a₀ of JKR [m]."""
        return float((4.5 * math.pi * self.work * self.radius**2 / self.modulus) ** (1.0 / 3.0))

    def branch(self, kind: str) -> tuple[Floats, Floats]:
        """Displacements [m] and forces [N] of all states of a theory, from the first touch on."""
        theory = Paraboloid(self.radius, self.modulus, self.work, self.range or 1.0)
        unit, a = theory.unit_radius**2 / self.radius, np.linspace(0.0, math.sqrt(WIDEST), STATES) ** 2
        if kind in ("Hertz", "DMT"):
            d, F = a**2, a**3 - (2.0 if kind == "DMT" else 0.0)
        elif kind == "JKR":
            d, F = a**2 - 2.0 / 3.0 * np.sqrt(6.0 * a), a**3 - np.sqrt(6.0 * a**3)
        else:
            touching = theory.reduced.of_radii(a[1:])
            zone = theory.reduced.alone(np.linspace(0.0, touching.c[0], 400, endpoint=False))
            d = np.concatenate([zone.displacement, touching.displacement])
            F = np.concatenate([zone.load, touching.load])
        return unit * d, theory.unit_force * F


def measured(sphere: Sphere, kind: str, stiffness: float, positions: Floats) -> Floats:
    """F [N] at rising positions z [m] of the piezo, and then at the same positions falling, (2n,)."""
    d, F = sphere.branch(kind)
    z, last = d + F / stiffness, d.size - 2
    start = -sphere.range if kind == "Maugis" else 0.0
    inwards = np.searchsorted(np.maximum.accumulate(z), positions).clip(1, last + 1) - 1
    outwards = np.searchsorted(np.minimum.accumulate(z[::-1])[::-1], positions[::-1], side="right") - 1
    up = np.where(positions >= start, _between(z, F, inwards, positions), 0.0)
    return np.concatenate([up, np.where(outwards >= 0, _between(z, F, outwards.clip(0, last), positions[::-1]), 0.0)])


def _between(z: Floats, F: Floats, low: NDArray[np.intp], wanted: Floats) -> Floats:
    rise = z[low + 1] - z[low]
    share = np.divide(wanted - z[low], rise, out=np.zeros_like(wanted), where=rise != 0.0)
    return F[low] + share * (F[low + 1] - F[low])


def noise(draw: np.random.Generator, count: int, memory: float) -> Floats:
    """Noise of unit variance: white, or a first-order autoregression with a memory [points]."""
    white = draw.standard_normal(count)
    kept = math.exp(-1.0 / memory) if memory else 0.0
    white[1:] *= math.sqrt(1.0 - kept * kept)
    return np.asarray(lfilter([1.0], [1.0, -kept], white))
