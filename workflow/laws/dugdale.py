"""The equations of Maugis and Dugdale's contact of any axisymmetric body: an attraction σ₀ over a range h₀ = W/σ₀.

With the transformed profile g(x), springs E* per length, contact up to a and attraction up to c ≥ a, s² = c² − a²,

    q = E* (d − g)  for |x| < a,      q = −2σ₀ √(c² − x²)  for a < |x| < c
    d = g(a) − (2σ₀/E*) s                                       no stress is singular at a
    h₀ = f(c) − d + (2/π) [∫₀ᵃ (d − g)/√(c² − x²) dx − (2σ₀/E*)(c − a)]      the gap at c is the range
    F = 2E* [a d − G(a)] − 4σ₀ ∫ₐᶜ √(c² − x²) dx,   G = ∫₀ g dx

Before contact a = 0, and the gap alone decides: d = f(c) − (4σ₀/πE*) c − h₀. As c → a this is JKR's (`adhesion`).
Source: D. Maugis, J. Colloid Interface Sci. 150 (1992) 243, for a paraboloid; the equations are Abel transforms.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import gauss
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.shape import Profile, beside_kinks

Array = NDArray[np.float64]
NODES, PANEL = 48, 8
"""Of Gauss's quadrature from 0 or a kink to the edge, and of one between two positions of G."""
FIRST, PLACES = 1e-6, 2000
"""Positions between which G is one quadrature each, and the first of them over the last."""
DOUBLINGS = 200
"""Most of a bracket, and of cuts of it."""
INSIDE = 1.0 - 1e-6
"""Of a body, up to which an attraction may reach: the transform of a circle has no bound at its end."""
TINY = float(np.finfo(np.float64).tiny)


@dataclass(frozen=True)
class Zone:
    """States of a contact; arrays (m,), or columns of the curve.

    Attributes:
        edge, reach: a and c [LU], both 0 of bodies that do not feel each other.
        displacement, force: [LU], [FU].
    """

    edge: Array
    reach: Array
    displacement: Array
    force: Array


@dataclass(frozen=True, eq=False)
class Dugdale:
    """A body on a rigid plane.

    Attributes:
        profile, surface: g and f [LU].
        modulus, stress: E*, σ₀ [FU/LU²].
        range: h₀ [LU].
        known: the largest a that is asked for [LU].
        nodes: of the quadrature of a gap.
        tolerance: relative, of a root; None: to all digits.
    """

    profile: Profile
    surface: Profile
    modulus: float
    stress: float
    range: float
    known: float
    nodes: int = NODES
    tolerance: float | None = None

    @property
    def end(self) -> float:
        """Where the body ends [LU]."""
        return self.profile.reach * INSIDE

    def widest(self) -> float:
        """Largest a [LU] whose attraction ends on the body. Raises SettingsError where there is none."""
        from scipy.optimize import elementwise

        if self.end == math.inf:
            return math.inf

        def error(edge: Array) -> Array:
            width = np.sqrt((self.end - edge) * (self.end + edge))
            return self.gap_error(edge, width, self.profile.height(edge) - self.ratio * width)

        if float(error(np.zeros(1))[0]) < 0.0:
            raise covered(self.end)
        found = elementwise.find_root(error, (np.zeros(1), np.full(1, self.end)), maxiter=DOUBLINGS)
        return INSIDE * float(found.x[0])

    @property
    def ratio(self) -> float:
        """2σ₀/E* [1]."""
        return 2.0 * self.stress / self.modulus

    @cached_property
    def _areas(self) -> tuple[Array, Array]:
        """Positions [LU] from 0 on, dense beside kinks, and G there [LU²]."""
        x = np.concatenate([[0.0], np.geomspace(FIRST * self.known, self.known, PLACES)])
        x = beside_kinks(x, self.profile)
        return x, np.append(0.0, np.cumsum(self._integral(x[:-1], x[1:])))

    def _integral(self, low: Array, high: Array) -> Array:
        """∫ g dx between positions [LU²]."""
        node, weight = gauss(PANEL)
        half = 0.5 * (high - low)
        return np.asarray(half * (self.profile.height(0.5 * (low + high)[:, None] + half[:, None] * node) @ weight))

    def area(self, x: Array) -> Array:
        """G(x) = ∫₀ˣ g [LU²] at positions ≥ 0 [LU], (n,), as far as the body is known."""
        places, areas = self._areas
        cell = np.clip(np.searchsorted(places, x, side="right") - 1, 0, places.size - 1)
        return np.asarray(areas[cell] + self._integral(places[cell], x))

    def _pressed(self, edge: Array, width: Array) -> Array:
        """∫₀ᵃ g/√(c² − x²) dx [LU], c² = a² + s²; with x = c sin t, from 0 or a kink on in powers of √(t − t₀)."""
        c = np.hypot(edge, width)
        kinks = [np.minimum(kink, edge) for kink in self.profile.kinks if kink < self.known]
        angles = [np.zeros_like(edge), *(np.arctan2(one, np.sqrt((c - one) * (c + one))) for one in kinks)]
        angles.append(np.arctan2(edge, width))
        node, weight = gauss(self.nodes)
        share, total = 0.5 * (node + 1.0), np.zeros_like(edge)
        for low, high in pairwise(angles):
            angle = low[:, None] + (high - low)[:, None] * share**2
            total += (high - low) * (self.profile.height(c[:, None] * np.sin(angle)) @ (share * weight))
        return total

    def gap_error(self, edge: Array, width: Array, displacement: Array) -> Array:
        """Gap at c less the range [LU] at a, s and d [LU]; 0 of a state, for which d is that of the edge, too."""
        c = np.hypot(edge, width)
        angle = np.arctan2(edge, width)
        # c − a without a difference of numbers that are nearly the same
        ahead = width * width / np.maximum(c + edge, TINY)
        elastic = displacement * angle - self._pressed(edge, width) - self.ratio * ahead
        return np.asarray(self.surface.height(c) - displacement + 2.0 / math.pi * elastic - self.range)

    def states(self, edge: Array, width: Array) -> Zone:
        """The states of contacts with these a and s [LU]."""
        displacement = self.profile.height(edge) - self.ratio * width
        return Zone(edge, np.hypot(edge, width), displacement, self.forces(edge, width, displacement))

    def forces(self, edge: Array, width: Array, displacement: Array) -> Array:
        """F [FU] at a, s and d [LU]."""
        ring = 0.5 * ((edge**2 + width**2) * np.arctan2(width, edge) - edge * width)
        return np.asarray(2.0 * self.modulus * (edge * displacement - self.area(edge)) - 4.0 * self.stress * ring)

    def widths(self, edge: Array) -> Array:
        """s [LU] of contacts of radius a [LU]. Raises SettingsError where the attraction reaches past the body."""
        from scipy.optimize import elementwise  # which takes longer to import than a small run

        def error(width: Array, edge: Array) -> Array:
            return self.gap_error(edge, width, self.profile.height(edge) - self.ratio * width)

        most = np.sqrt((self.end - edge) * (self.end + edge))
        high = np.minimum(self.range / max(self.ratio, TINY) + math.sqrt(self.range * self.known), most)
        for _ in range(DOUBLINGS):
            short = error(high, edge) < 0.0
            if not short.any():
                break
            if (high >= most)[short].any():
                raise covered(self.end)
            high = np.where(short, np.minimum(2.0 * high, most), high)
        found = elementwise.find_root(
            error, (np.zeros_like(edge), high), args=(edge,), maxiter=DOUBLINGS, tolerances={"xrtol": self.tolerance}
        )
        return np.asarray(found.x)

    def before(self, reach: Array) -> Array:
        """d [LU] of bodies that attract each other up to c [LU] and do not touch."""
        return np.asarray(self.surface.height(reach) - 2.0 / math.pi * self.ratio * reach - self.range)


def covered(reach: float) -> SettingsError:
    """The error of an attraction that reaches past its body, which ends there [LU]."""
    return SettingsError(
        f"the attraction would reach beyond the body, which ends at {reach:.6g} LU: lower adhesion.range or "
        "adhesion.work_of_adhesion, or give a wider profile"
    )
