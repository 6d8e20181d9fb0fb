"""Force curves of a paraboloid on a piezo and a cantilever, with noise: closed forms of Hertz, DMT, JKR and Maugis.

    K = 4E*/3, in units (πWR²/K)^(1/3) of a, πWR of F, (π²W²R/K²)^(1/3) of d, m = c/a, λ = 2σ₀ (R/πWK²)^(1/3):
    JKR      F = a³ − √(6a³),   d = a² − (2/3)√(6a)
    Maugis   F = a³ − λa² (√(m² − 1) + m² arcsec m),   d = a² − (4/3)λa √(m² − 1), and the gap at c is the range
    z = d + F/k, followed upwards and downwards: what a fold leaves unstable is jumped over.

Source: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

Array = np.ndarray[Any, np.dtype[np.float64]]
STATES, WIDEST = 6000, 12.0
"""States of a branch, and the largest radius in units of the theory."""


@dataclass(frozen=True)
class Sphere:
    """A paraboloid on a plane: E* [Pa], W [J/m²], R [m], and h₀ [m] of Maugis's."""

    modulus: float
    work: float
    radius: float
    range: float = 0.0

    @property
    def zero_load_radius(self) -> float:
        """a₀ of JKR [m]."""
        return float((4.5 * math.pi * self.work * self.radius**2 / self.modulus) ** (1.0 / 3.0))

    def branch(self, kind: str) -> tuple[Array, Array]:
        """Displacements [m] and forces [N] of all states of a theory, from the first touch on."""
        K, W, R = 4.0 * self.modulus / 3.0, self.work, self.radius
        lengths = (math.pi * W * R * R / K) ** (1.0 / 3.0), (math.pi**2 * W**2 * R / K**2) ** (1.0 / 3.0)
        force, a = math.pi * W * R, np.linspace(0.0, math.sqrt(WIDEST), STATES) ** 2
        if kind in ("Hertz", "DMT"):
            return lengths[1] * a**2, force * (a**3 - (2.0 if kind == "DMT" else 0.0))
        if kind == "JKR":
            return lengths[1] * (a**2 - 2.0 / 3.0 * np.sqrt(6.0 * a)), force * (a**3 - np.sqrt(6.0 * a**3))
        stress, a = W / self.range, a[1:]
        strength = 2.0 * stress * (R / (math.pi * W * K**2)) ** (1.0 / 3.0)
        m = np.array([brentq(_gap, 1.0 + 1e-13, 1e8, args=(one, strength), xtol=1e-14, rtol=1e-13) for one in a])
        root = np.sqrt(m**2 - 1.0)
        d = lengths[1] * (a**2 - 4.0 / 3.0 * strength * a * root)
        F = force * (a**3 - strength * a**2 * (root + m**2 * np.arctan(root)))
        c = np.linspace(0.0, m[0] * a[0] * lengths[0], 400, endpoint=False)
        before = c**2 / (2.0 * R) - 4.0 * stress * c / (math.pi * self.modulus) - self.range
        return np.concatenate([before, d]), np.concatenate([-math.pi * stress * c**2, F])


def _gap(m: float, a: float, strength: float) -> float:
    """Maugis's equation of the gap at c."""
    root = math.sqrt(m * m - 1.0)
    angle = math.atan(root)
    first = 0.5 * strength * a * a * (root + (m * m - 2.0) * angle)
    return first + 4.0 / 3.0 * strength**2 * a * (root * angle - m + 1.0) - 1.0


def measured(sphere: Sphere, kind: str, stiffness: float, positions: Array) -> Array:
    """F [N] at rising positions z [m] of the piezo, and then at the same positions falling, (2n,)."""
    d, F = sphere.branch(kind)
    z = d + F / stiffness
    start = -sphere.range if kind == "Maugis" else 0.0
    up, down, place = np.zeros_like(positions), np.zeros_like(positions), 0
    for i, wanted in enumerate(positions):
        if wanted >= start:
            while z[place] < wanted:
                place += 1
            up[i] = _between(z, F, max(place - 1, 0), wanted)
    place = z.size - 2
    for i, wanted in enumerate(positions[::-1]):
        while place >= 0 and z[place] > wanted:
            place -= 1
        if place < 0:
            break
        down[i] = _between(z, F, place, wanted)
    return np.concatenate([up, down])


def _between(z: Array, F: Array, low: int, wanted: float) -> float:
    rise = z[low + 1] - z[low]
    return float(F[low] + (wanted - z[low]) / rise * (F[low + 1] - F[low])) if rise else float(F[low])


def noise(draw: np.random.Generator, count: int, memory: float) -> Array:
    """Noise of unit variance: white, or a first-order autoregression with a memory [points]."""
    white = draw.standard_normal(count)
    kept = math.exp(-1.0 / memory) if memory else 0.0
    found = white.copy()
    for i in range(1, count):
        found[i] = kept * found[i - 1] + math.sqrt(1.0 - kept * kept) * white[i]
    return found
