"""The force that a contact model predicts at each position of the piezo.

With the profile's transform g, its integral G(a) = ∫₀ᵃ g dx, and the contact edge a

    Hertz   d = g(a),                    F = 2E*(a d − G)
    DMT     the same,                    F lower by 2πWR
    Maugis  d = g(a) − (2σ₀/E*) √(c² − a²),  F lower by that of the cohesive zone up to c
    JKR     d = g(a) − √(2πaW/E*),       F = 2E*(a d − G)

An instrument of stiffness k_c has its contact point at z = d + F/k_c. A measured position z is prescribed, and F
follows from it on the branch that is held: down to the least z, where dF/dd = −k_c and the contact snaps out. The
noise of the force is in no displacement.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.dugdale import Dugdale
from contact1d.workflow.laws.jkr import elongation
from contact1d.workflow.scene import Scene, Shape

Array = NDArray[np.float64]
RANGE = "adhesion.range"
"""The key of h₀."""
EDGES = 300
"""Edges a between which a branch is cubic, in geometric progression over SPAN."""
THINNED, NODES, BEFORE = 3, 20, 40
"""Of Maugis's equations: every how many edges has a root, nodes of a quadrature, and places before contact."""
ROOT = 1e-9
"""Relative error of s."""
NEWTON = 2
"""Steps to the place of a position between two of them: from a straight start the error is below 1e-9 of the cell."""
SPAN = 2e-3
"""The first of them over the last."""
DEEPEST = 8.0
"""Transformed height of the last edge over the range of positions of the data."""
STEEP = 3.0
"""Slope of the continuation below the least z over that of the branch's first quarter: no model holds a contact there,
so that a point there pulls the parameters back."""
kept = lru_cache(maxsize=50)
"""Bodies and branches are remembered: most steps of a fit change only what the measurement adds."""


@dataclass(frozen=True, eq=False)
class Body:
    """A profile's transform at EDGES: a, g and G [LU, LU, LU²], the profile f [LU], the radius at its apex [LU]."""

    edges: Array
    heights: Array
    areas: Array
    surface: Array
    radius: float | None

    @classmethod
    @kept
    def of(cls, shape: Shape, depth: float) -> Body:
        """The profile up to where its transform is DEEPEST times `depth` [LU], or to its end."""
        last = depth
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) > DEEPEST * depth:
            last *= 0.5
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) < DEEPEST * depth:
            last *= 1.3
        a = np.append(0.0, np.geomspace(SPAN, 1.0, EDGES) * min(last, shape.reach))
        g, f = (np.append(0.0, height(a[1:])) for height in (shape.transformed, shape.height))
        # ∫ g dx of a power between two edges is (g₂x₂ − g₁x₁)/(1 + n), n = log(g₂/g₁)/log(x₂/x₁), up to the first as
        # beyond it.
        with np.errstate(divide="ignore", invalid="ignore"):
            n = np.where(g[1:-1] > 0.0, np.log(g[2:] / g[1:-1]) / np.log(a[2] / a[1]), math.inf)
        n = np.append(n[0], n)
        steps = np.where(np.isfinite(n), np.diff(g * a) / (1.0 + n), 0.5 * (g[1:] + g[:-1]) * np.diff(a))
        areas = np.append(0.0, np.cumsum(steps))
        return cls(a, g, areas, f, shape.curvature_radius)


@dataclass(frozen=True)
class Branch:
    """Displacements and forces [LU, FU] along a path of states, and a length that grows along it [LU]: a, where bodies
    touch at once.
    """

    radii: Array
    displacements: Array
    forces: Array

    def positions(self, stiffness: float) -> Array:
        """z = d + F/k_c [LU] of the states, with an instrument of this stiffness [FU/LU]."""
        return np.asarray(self.displacements + self.forces / stiffness)

    def at(self, positions: Array, stiffness: float, held: bool, pitch: float = 1e-300) -> Array:
        """F [FU] at positions z [LU] of an instrument of this stiffness [FU/LU], contact point at 0.

        Args:
            positions: of the piezo.
            stiffness: k_c; infinite: d is prescribed.
            held: whether the contact holds at all of them, so that it is continued below its least z;
                else it is lost there.
            pitch: distance of positions [LU], over which a contact is lost: of a step no least squares sees a slope.
        """
        z = self.positions(stiffness)
        least = min(int(np.argmin(z)), z.size - 4)  # of an adhesion that is known to be too strong the rest matters not
        a, z, F = self.radii[least:], np.maximum.accumulate(z[least:]), self.forces[least:]
        found, below = _between(a, z, F, positions), positions < z[0]
        if not held:
            return np.asarray(np.clip(0.5 + (positions - z[0]) / pitch, 0.0, 1.0) * found)
        at = np.searchsorted(F, F[0] + 0.25 * abs(F[0])) if F[0] < 0.0 else 1
        at = int(min(max(at, 1), z.size - 1))
        slope = STEEP * (F[at] - F[0]) / max(z[at] - z[0], 1e-300)
        return np.where(below, F[0] + slope * (positions - z[0]), found)

    def snap_out(self, stiffness: float) -> tuple[float, float]:
        """Position z [LU] and force [FU] at which the contact is lost."""
        z = self.positions(stiffness)
        least = int(np.argmin(z))
        return float(z[least]), float(self.forces[least])


def _between(a: Array, z: Array, F: Array, positions: Array) -> Array:
    """F at z, both cubic in a between its places: under correlated noise the differences of neighbours count."""
    i = np.clip(np.searchsorted(z, positions) - 1, 0, a.size - 2)
    width = np.diff(a)[i]
    cubic = [_cubic(values[i], values[i + 1], slope[i] * width, slope[i + 1] * width)
             for values, slope in ((z, np.gradient(z, a)), (F, np.gradient(F, a)))]  # fmt: skip
    (z0, z1, z2, z3), (f0, f1, f2, f3) = cubic
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.clip((positions - z[i]) / (z[i + 1] - z[i]), 0.0, 1.0)
        for _ in range(NEWTON):
            slope = z1 + t * (2.0 * z2 + 3.0 * t * z3)
            t = t - np.where(slope > 0.0, (z0 + t * (z1 + t * (z2 + t * z3)) - positions) / slope, 0.0)
    t = np.nan_to_num(np.clip(t, 0.0, 1.0))
    return np.asarray(f0 + t * (f1 + t * (f2 + t * f3)))


def _cubic(start: Array, end: Array, leaving: Array, arriving: Array) -> tuple[Array, Array, Array, Array]:
    """The coefficients of Hermite's cubic from 0 to 1."""
    rise = end - start
    return start, leaving, 3.0 * rise - 2.0 * leaving - arriving, leaving + arriving - 2.0 * rise


def jkr(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Adhesion of no range."""
    a, d = body.edges, body.heights - elongation(body.edges, modulus, work)
    return Branch(a, d, 2.0 * modulus * (a * d - body.areas))


def hertz(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Without adhesion."""
    return jkr(body, modulus, 0.0, reach)


def dmt(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Adhesion of long range, which adds 2πWR to the load."""
    assert body.radius is not None
    free = hertz(body, modulus, work, reach)
    return replace(free, forces=free.forces - 2.0 * math.pi * work * body.radius)


@dataclass(frozen=True, eq=False)
class Curve:
    """A profile by cubics, for `laws.dugdale`; it goes on beyond its last place."""

    height: Callable[[Array], Array]
    reach: float = math.inf
    kinks: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class Zone(Dugdale):
    """Its equations with the integral G of a body that is known already: places [LU], G [LU²]."""

    areas: tuple[Array, Array]

    def area(self, x: Array) -> Array:
        """See `Dugdale`."""
        return np.interp(x, *self.areas)


def maugis(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Dugdale's stress σ₀ = W/h₀ over the range h₀ around the contact (`laws.dugdale`), by a rising path.

    Its states before contact, a = 0, are explicit in c; of a contact s = √(c² − a²) is a root for each a.
    """
    a = np.concatenate([[0.0], body.edges[1::THINNED]])
    profile, surface = (Curve(CubicSpline(body.edges, heights)) for heights in (body.heights, body.surface))
    law = Zone(
        profile, surface, modulus, work / reach, reach, float(a[-1]), NODES, ROOT, areas=(body.edges, body.areas)
    )
    s = law.widths(a)
    held = law.states(a, s)
    c = s[0] * np.linspace(0.0, 1.0, BEFORE, endpoint=False)
    early, late = (c, law.before(c), -math.pi * law.stress * c * c), (s[0] + a, held.displacement, held.force)
    return Branch(*(np.concatenate(both) for both in zip(early, late, strict=True)))


@dataclass(frozen=True)
class ContactModel:
    """A contact model.

    Attributes:
        name: what it is called.
        branch: its states, of a body, E* [FU/LU²], W [FU/LU] and the range h₀ [LU].
        needs: what a scene must have for it: a work of adhesion W, the range h₀ of that, the radius R of the body.
        limits: the models between which it lies, whose fits are the starts of its own, which takes long.
    """

    name: str
    branch: Callable[[Body, float, float, float], Branch]
    needs: frozenset[str] = frozenset()
    limits: tuple[str, ...] = ()

    def applies(self, scene: Scene) -> bool:
        """Whether a scene has what it needs."""
        known = {
            "W": scene.work_of_adhesion,
            "h₀": law_of(scene).range_of(scene, 0.0),
            "R": scene.bodies.profile.curvature_radius,
        }
        return all(known[name] for name in self.needs)

    def depends_on(self, key: str) -> bool:
        """Whether its forces depend on the number at a key of a scene."""
        return not key.startswith("adhesion.") or ("h₀" if key == RANGE else "W") in self.needs


LAWS = {
    law.name: law
    for law in (
        ContactModel("Maugis", maugis, frozenset({"W", "h₀"}), limits=("JKR", "DMT")),
        ContactModel("JKR", jkr, frozenset({"W"})),
        ContactModel("DMT", dmt, frozenset({"W", "R"})),
        ContactModel("Hertz", hertz),
    )
}
"""By name; the first that applies is the one that a scene means."""
