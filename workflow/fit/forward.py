"""The force that a contact model predicts at each position of the piezo.

With the profile's transform g, its integral G(a) = ∫₀ᵃ g dx, and the contact edge a

    Hertz   d = g(a),                    F = 2E*(a d − G)
    DMT     the same,                    F lower by 2πWR
    JKR     d = g(a) − √(2πaW/E*),       F = 2E*(a d − G)

An instrument of stiffness k_c has its contact point at z = d + F/k_c. A measured position z is prescribed, and F follows
from it on the branch that is held: down to the least z, where dF/dd = −k_c and the contact snaps out. The noise of the
force is in no displacement.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.scene import Shape

Array = NDArray[np.float64]
EDGES = 1500
"""Edges a between which a branch is straight, in geometric progression over SPAN: the error of F is below 1e-5 of it."""
SPAN = 2e-3
"""The first of them over the last."""
DEEPEST = 8.0
"""Transformed height of the last edge over the range of positions of the data."""
STEEP = 3.0
"""Slope of the continuation below the least z over that of the branch's first quarter: no model holds a contact there,
so that a point there pulls the parameters back."""


@dataclass(frozen=True)
class Body:
    """A profile's transform at EDGES: a, g and G [LU, LU, LU²]; and the radius of curvature at its apex [LU]."""

    edges: Array
    heights: Array
    areas: Array
    radius: float | None

    @classmethod
    def of(cls, shape: Shape, depth: float) -> Body:
        """The profile up to where its transform is DEEPEST times `depth` [LU], or to its end."""
        last = depth
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) > DEEPEST * depth:
            last *= 0.5
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) < DEEPEST * depth:
            last *= 1.3
        a = np.geomspace(SPAN, 1.0, EDGES) * min(last, shape.reach)
        g = shape.transformed(a)
        # ∫ g dx of a power between two edges is (g₂x₂ − g₁x₁)/(1 + n), n = log(g₂/g₁)/log(x₂/x₁).
        with np.errstate(divide="ignore", invalid="ignore"):
            n = np.where(g[:-1] > 0.0, np.log(g[1:] / g[:-1]) / np.log(a[1] / a[0]), math.inf)
        steps = (g[1:] * a[1:] - g[:-1] * a[:-1]) / (1.0 + n)
        first = a[0] * g[0] / (1.0 + n[0])
        areas = first + np.concatenate([[0.0], np.cumsum(np.where(np.isfinite(n), steps, 0.5 * (g[1:] + g[:-1]) * np.diff(a)))])
        zero = np.zeros(1)
        return cls(*(np.concatenate([zero, one]) for one in (a, g, areas)), shape.curvature_radius)


@dataclass(frozen=True)
class Branch:
    """Displacements and forces [LU, FU] of a contact by increasing displacement, and its radii a [LU].

    `snaps`: whether the force at the first of them vanishes at once.
    """

    radii: Array
    displacements: Array
    forces: Array

    def at(self, positions: Array, stiffness: float, held: bool) -> Array:
        """F [FU] at positions z [LU] of an instrument of this stiffness [FU/LU], contact point at 0.

        Args:
            positions: of the piezo.
            stiffness: k_c; infinite: d is prescribed.
            held: whether the contact is known to hold at all of them, so that it is continued below its least z;
                else it is lost there.
        """
        z = self.displacements + self.forces / stiffness
        least = int(np.argmin(z))
        z, F = np.maximum.accumulate(z[least:]), self.forces[least:]
        found = np.interp(positions, z, F, left=0.0)
        below = positions < z[0]
        if held and below.any():
            at = np.searchsorted(F, F[0] + 0.25 * abs(F[0])) if F[0] < 0.0 else 1
            at = int(min(max(at, 1), z.size - 1))
            slope = STEEP * (F[at] - F[0]) / max(z[at] - z[0], 1e-300)
            found = np.where(below, F[0] + slope * (positions - z[0]), found)
        return np.asarray(found)

    def snap_out(self, stiffness: float) -> tuple[float, float]:
        """Position z [LU] and force [FU] at which the contact is lost."""
        z = self.displacements + self.forces / stiffness
        least = int(np.argmin(z))
        return float(z[least]), float(self.forces[least])


Law = Callable[[Body, float, float, float], Branch]
"""A contact model: the branch of a body, E* [FU/LU²], W [FU/LU] and the range h₀ [LU]."""


def hertz(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Without adhesion."""
    return Branch(body.edges, body.heights, 2.0 * modulus * (body.edges * body.heights - body.areas))


def dmt(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Adhesion of long range, which adds 2πWR to the load."""
    assert body.radius is not None
    free = hertz(body, modulus, work, reach)
    return Branch(free.radii, free.displacements, free.forces - 2.0 * math.pi * work * body.radius)


def jkr(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Adhesion of no range."""
    a = body.edges
    d = body.heights - np.sqrt(2.0 * math.pi * work / modulus * a)
    return Branch(a, d, 2.0 * modulus * (a * d - body.areas))


LAWS: Mapping[str, Law] = {"Hertz": hertz, "DMT": dmt, "JKR": jkr}
