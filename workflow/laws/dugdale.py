"""The equations of the Maugis–Dugdale contact of any axisymmetric body: an attraction σ₀ over a range h₀ = W/σ₀.

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
import sys
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np

from contact1d.analysis.polynomial import gauss
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.numerics import value_at
from contact1d.workflow.laws.shape import Array, Profile, beside_kinks

DOUBLINGS = 200
"""Most doublings of a bracket, and most iterations of a root finder in it."""
INSIDE = 1.0 - 1e-6
"""Share of a body's half-width up to which an attraction may act: the transform of a circle is unbounded at its end."""
TINY = sys.float_info.min


@dataclass(frozen=True)
class Zone:
    """States of a contact; arrays (m,), or columns of the curve.

    Attributes:
        edge, reach: contact radius a and radius c of the attraction [LU], both 0 of bodies without a force between
            them.
        displacement, force: d [LU] and F [FU], compression positive.
    """

    edge: Array
    reach: Array
    displacement: Array
    force: Array


@dataclass(frozen=True, eq=False)
class Dugdale:
    """The equations of the contact of a body on a rigid plane.

    Attributes:
        profile, surface: transformed and actual profile, g and f [LU].
        modulus, stress: E* and σ₀ [FU/LU²].
        range: h₀ [LU].
        known: largest contact radius a that is needed [LU].
        nodes: points of a Gauss quadrature from 0 or a kink to the edge.
        tolerance: relative tolerance of a root; None: all digits.
    """

    profile: Profile
    surface: Profile
    modulus: float
    stress: float
    range: float
    known: float
    nodes: int = 48
    tolerance: float | None = None

    @property
    def end(self) -> float:
        """Half-width [LU] up to which an attraction may act, 1e-6 (relative) less than the body's; infinite of an
        unbounded body.
        """
        return self.profile.reach * INSIDE

    def widest(self) -> float:
        """Return the largest contact radius a [LU] whose attraction ends on the body, less 1e-6 (relative).

        Infinite of an unbounded body.

        Raises:
            SettingsError: even before contact the attraction exceeds the body.
        """
        if self.end == math.inf:
            return math.inf
        edge = value_at(self.edges, self.end)
        if math.isnan(edge):
            raise covered(self.end)
        return INSIDE * edge

    def edges(self, reach: Array) -> Array:
        """Return the contact radii a, (m,) [LU], in equilibrium, whose attraction ends at the radii c, (m,) [LU].

        NaN where it ends beyond c even before contact.
        """
        from scipy.optimize import elementwise

        def error(edge: Array, reach: Array) -> Array:
            """Return the gap at c less the range, (m,) [LU]."""
            width = np.sqrt((reach - edge) * (reach + edge))
            return self.gap_error(edge, width, self.smooth(edge, width))

        root = elementwise.find_root(error, (np.zeros_like(reach), reach), args=(reach,), maxiter=DOUBLINGS)
        return np.where(root.success, root.x, np.nan)

    @property
    def ratio(self) -> float:
        """Twice the attraction over the modulus, 2σ₀/E*, dimensionless."""
        return 2.0 * self.stress / self.modulus

    @cached_property
    def _areas(self) -> tuple[Array, Array]:
        """(Positions x [LU], rising from 0 to the largest needed radius `known`, dense near kinks; G = ∫₀ˣ g dx there
        [LU²]).

        g is the transformed profile.
        """
        x = np.concatenate([[0.0], np.geomspace(1e-6 * self.known, self.known, 2000)])
        x = beside_kinks(x, self.profile.kinks)
        return x, np.append(0.0, np.cumsum(self._integral(x[:-1], x[1:])))

    def _integral(self, low: Array, high: Array, nodes: int = 8) -> Array:
        """Return ∫ g dx of the transformed profile, (n,) [LU²], from positions `low` to `high`, (n,) [LU].

        By a Gauss quadrature of so many `nodes`.
        """
        node, weight = gauss(nodes)
        half = 0.5 * (high - low)
        return half * (self.profile.height(0.5 * (low + high)[:, None] + half[:, None] * node) @ weight)

    def area(self, x: Array) -> Array:
        """Return G(x) = ∫₀ˣ g dx of the transformed profile, (n,) [LU²], at positions x, 0 … `known`, (n,) [LU]."""
        knots, areas = self._areas
        cell = np.clip(np.searchsorted(knots, x, side="right") - 1, 0, knots.size - 1)
        return areas[cell] + self._integral(knots[cell], x)

    def _pressed(self, edge: Array, width: Array) -> Array:
        """Return ∫₀ᵃ g/√(c² − x²) dx of the transformed profile g, (n,) [LU], at `edge` a and `width` s, (n,) [LU].

        c² = a² + s². With x = c sin t the integral goes from 0 or a kink on in powers of √(t − t₀).
        """
        c = np.hypot(edge, width)
        kinks = [np.minimum(kink, edge) for kink in self.profile.kinks if kink < self.known]
        angles = [np.zeros_like(edge), *(np.arctan2(kink, np.sqrt((c - kink) * (c + kink))) for kink in kinks)]
        angles.append(np.arctan2(edge, width))
        node, weight = gauss(self.nodes)
        share, total = 0.5 * (node + 1.0), np.zeros_like(edge)
        for low, high in pairwise(angles):
            angle = low[:, None] + (high - low)[:, None] * share**2
            total += (high - low) * (self.profile.height(c[:, None] * np.sin(angle)) @ (share * weight))
        return total

    def gap_error(self, edge: Array, width: Array, displacement: Array) -> Array:
        """Return the gap at c less the range h₀, (m,) [LU], at `edge` a, `width` s and displacement d, (m,) [LU].

        c = √(a² + s²) is the radius up to which the attraction acts. The error is 0 in equilibrium, with d = g(a) −
        2σ₀s/E*.
        """
        c = np.hypot(edge, width)
        angle = np.arctan2(edge, width)
        # c − a without a difference of nearly equal numbers
        ahead = width * width / np.maximum(c + edge, TINY)
        elastic = displacement * angle - self._pressed(edge, width) - self.ratio * ahead
        return self.surface.height(c) - displacement + 2.0 / math.pi * elastic - self.range

    def smooth(self, edge: Array, width: Array) -> Array:
        """Return d, (m,) [LU], without a singular stress at `edge` a, with `width` s = √(c² − a²), (m,) [LU]."""
        return self.profile.height(edge) - self.ratio * width

    def states(self, edge: Array, width: Array) -> Zone:
        """Return the states (a, c, d, F), (m,) each, of contacts with `edge` a and `width` s = √(c² − a²), (m,) [LU].

        Their displacement d is that without a singular stress at a; the gap at c may differ from the range. F is
        positive in compression.
        """
        displacement = self.smooth(edge, width)
        return Zone(edge, np.hypot(edge, width), displacement, self.forces(edge, width, displacement))

    def equilibria(self, edge: Array) -> Zone:
        """Return the states (a, c, d, F), (m,) each, in equilibrium of contacts of the radii `edge` a, (m,) [LU].

        Raises:
            SettingsError: the attraction exceeds the body.
        """
        return self.states(edge, self.widths(edge))

    def forces(self, edge: Array, width: Array, displacement: Array) -> Array:
        """Return F, (m,) [FU], compression positive, at `edge` a, `width` s and displacement d, (m,) [LU].

        s = √(c² − a²), with the radius c up to which the attraction acts.
        """
        ring = 0.5 * ((edge**2 + width**2) * np.arctan2(width, edge) - edge * width)
        return 2.0 * self.modulus * (edge * displacement - self.area(edge)) - 4.0 * self.stress * ring

    def widths(self, edge: Array) -> Array:
        """Return s = √(c² − a²), (m,) [LU], in equilibrium of contacts of the radii `edge` a, (m,) [LU].

        c is the radius up to which the attraction acts.

        Raises:
            SettingsError: the attraction exceeds the body.
        """
        from scipy.optimize import elementwise  # which takes longer to import than a small run

        def error(width: Array, edge: Array) -> Array:
            """Return the gap at c less the range, (m,) [LU]."""
            return self.gap_error(edge, width, self.smooth(edge, width))

        most = np.sqrt((self.end - edge) * (self.end + edge))
        high = np.minimum(self.range / max(self.ratio, TINY) + math.sqrt(self.range * self.known), most)
        for _ in range(DOUBLINGS):
            short = error(high, edge) < 0.0
            if not short.any():
                break
            if (high >= most)[short].any():
                raise covered(self.end)
            high = np.where(short, np.minimum(2.0 * high, most), high)
        root = elementwise.find_root(
            error, (np.zeros_like(edge), high), args=(edge,), maxiter=DOUBLINGS, tolerances={"xrtol": self.tolerance}
        )
        return np.asarray(root.x)

    def before(self, reach: Array) -> Array:
        """Return d, (m,) [LU], in equilibrium of bodies that do not touch and attract each other up to a radius, (m,)
        [LU].

        −h₀ at the radius 0.
        """
        return self.surface.height(reach) - 2.0 / math.pi * self.ratio * reach - self.range


def covered(reach: float) -> SettingsError:
    """Return the error, to be raised, of an attraction that exceeds its body, which ends at `reach` [LU]."""
    return SettingsError(
        f"the attraction would reach beyond the body, which ends at {reach:.6g} LU: lower adhesion.range or "
        "adhesion.work_of_adhesion, or give a wider profile"
    )
