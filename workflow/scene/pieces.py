"""Profiles made of pieces: blunt and truncated ones, whose slope is linear between radii, and the hyperboloid.

Where the slope of a body is p + q r between two radii, the MDR transform of `shapes` is elementary:

    x ∫ (p + q r)/√(x² − r²) dr = x [p arcsin(r/x) − q √(x² − r²)]

Sources: V. L. Popov, M. Heß, E. Willert, Handbook of Contact Mechanics (2019), chapter 2.5; of the hyperboloid
J. A. Greenwood, K. L. Johnson, J. Phys. D 31 (1998) 3279, there with adhesion.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, Literal

from contact1d.workflow.scene.quantities import Length
from contact1d.workflow.scene.shapes import Flanked, Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

Piece = tuple[float, float, float]
"""First radius [LU] of a piece, p and q [1/LU] of its slope p + q r."""


class Pieces(Shape):
    """A body whose slope is linear in r between radii; each kind tells the pieces."""

    @property
    @abstractmethod
    def pieces(self) -> tuple[Piece, ...]:
        """The pieces from the axis on; first radii rise from 0, and the last piece has no end."""

    def _ends(self, x: Array) -> tuple[Array, Array, Array, Array]:
        """Return (|x|, first and last radius of each piece, no larger than |x|, slopes p and q of each): (n, pieces).

        `x`: positions [LU], (n,).
        """
        import numpy as np

        first, p, q = np.array(self.pieces).T
        ends = np.minimum(np.append(first, np.inf), np.abs(x)[:, None])
        return np.abs(x), ends, p, q

    def height(self, x: Array) -> Array:
        """Return the height z = ∫ (p + q r) dr [LU] at positions x [LU]; same shape."""
        import numpy as np

        _, ends, p, q = self._ends(np.ravel(x))
        rise = p * np.diff(ends) + 0.5 * q * np.diff(ends**2)
        return np.asarray(rise.sum(axis=1).reshape(np.shape(x)))

    def transformed(self, x: Array) -> Array:
        """Return the height g(x) [LU] after the MDR transform at positions x [LU]; same shape."""
        import numpy as np

        position, ends, p, q = self._ends(np.ravel(x))
        share = ends / np.where(position > 0.0, position, 1.0)[:, None]
        root = np.sqrt((1.0 - share) * (1.0 + share))
        # √(1 − s²) falls by the difference of s² over the sum of the roots, which far from a piece loses no digits.
        roots = root[:, :-1] + root[:, 1:]
        fall = np.diff(share**2) / np.where(roots > 0.0, roots, 1.0)
        parts = p * np.diff(np.arcsin(share)) + q * position[:, None] * fall
        return np.asarray((position * parts.sum(axis=1)).reshape(np.shape(x)))

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU] at which two pieces meet, rising."""
        return tuple(radius for radius, _, _ in self.pieces[1:])

    @property
    def slope_jumps(self) -> tuple[float, ...]:
        """Radii [LU] at which two pieces meet with different slopes, rising."""
        met = zip(self.pieces, self.pieces[1:], strict=False)
        slopes = {r: (before + rise * r, after + more * r) for (_, before, rise), (r, after, more) in met}
        return tuple(r for r, pair in slopes.items() if not math.isclose(*pair, abs_tol=1e-9 * sum(map(abs, pair))))


class BluntCone(Pieces, Flanked):
    """Profile of the upper body: a cone whose tip is a paraboloid, to which the flank is tangent."""

    kind: Literal["blunt_cone"]
    """a paraboloid, from the radius R s on its tangent cone"""
    tip_radius: Length
    """radius of curvature R of the tip"""

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The paraboloid of slope r/R out to the radius R s, and the cone of slope s."""
        return (0.0, 0.0, 1.0 / self.tip_radius), (self.rise * self.tip_radius, self.rise, 0.0)

    @property
    def curvature_radius(self) -> float:
        """The radius of curvature R [LU] of the tip."""
        return self.tip_radius


class TruncatedCone(Pieces, Flanked):
    """Profile of the upper body: a cone with a land, a flat end."""

    kind: Literal["truncated_cone"]
    """plane out to the land's radius, and a cone from there"""
    land_radius: Length
    """radius of the land"""

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The land, and the cone of slope s."""
        return (0.0, 0.0, 0.0), (self.land_radius, self.rise, 0.0)


class TruncatedParabola(Pieces):
    """Profile of the upper body: a paraboloid with a land, a flat end: a worn ball."""

    kind: Literal["truncated_parabola"]
    """plane out to the land's radius b, and z = (x² − b²)/2R from there"""
    radius: Length
    """radius of curvature R of the paraboloid"""
    land_radius: Length
    """radius b of the land"""

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The land, and the paraboloid of slope r/R."""
        return (0.0, 0.0, 0.0), (self.land_radius, 0.0, 1.0 / self.radius)


class RoundedPunch(Pieces):
    """Profile of the upper body: a flat punch whose edge is rounded."""

    kind: Literal["rounded_punch"]
    """plane out to the radius b, and z = (|x| − b)²/2R from there"""
    radius: Length
    """radius b of the plane part"""
    edge_radius: Length
    """radius of curvature R of the edge"""

    @property
    def pieces(self) -> tuple[Piece, ...]:
        """The plane part, and the edge of slope (r − b)/R."""
        return (0.0, 0.0, 0.0), (self.radius, -self.radius / self.edge_radius, 1.0 / self.edge_radius)


class Hyperboloid(Flanked):
    """Profile of the upper body: a hyperboloid, z = R s² (√(1 + x²/(R s)²) − 1)."""

    kind: Literal["hyperboloid"]
    """z = R s² (√(1 + x²/(R s)²) − 1), a paraboloid at the tip and a cone far from it"""
    tip_radius: Length
    """radius of curvature R of the tip"""

    def height(self, x: Array) -> Array:
        """Return the height z [LU] at positions x [LU], without a difference of large numbers; same shape."""
        root = (1.0 + (x / (self.tip_radius * self.rise)) ** 2) ** 0.5
        return x**2 / (self.tip_radius * (root + 1.0))

    def transformed(self, x: Array) -> Array:
        """Return the height g = s x arctan(x/(R s)) [LU] after the MDR transform at positions x [LU]; same shape."""
        import numpy as np

        return self.rise * x * np.arctan(x / (self.tip_radius * self.rise))

    @property
    def curvature_radius(self) -> float:
        """The radius of curvature R [LU] of the tip."""
        return self.tip_radius
