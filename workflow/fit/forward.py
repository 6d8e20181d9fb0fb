"""The force that a contact model predicts at each position of the piezo.

With the profile's transform g, its integral G(a) = ∫₀ᵃ g dx, and the contact edge a

    Hertz   d = g(a),                    F = 2E*(a d − G)
    DMT     d = g(a),                    F lower by 2πWR
    Maugis  d = g(a) − (2σ₀/E*) √(c² − a²),  F lower by that of the cohesive zone up to c
    JKR     d = g(a) − √(2πaW/E*),       F = 2E*(a d − G)

An instrument of stiffness k_c has its contact point at z = d + F/k_c. A measured position z is prescribed, and F
follows from it on the branch of the contact: down to the least z, where dF/dd = −k_c and the contact snaps out. The
noise of the force does not enter the positions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from contact1d.analysis.polynomial import gauss
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.dugdale import Dugdale
from contact1d.workflow.laws.jkr import elongation
from contact1d.workflow.laws.shape import beside_kinks
from contact1d.workflow.scene import Scene, Shape

Array = NDArray[np.float64]
RANGE = "adhesion.range"
"""The key of h₀ in a scene."""
cached = lru_cache(maxsize=50)
"""Bodies and branches are cached: most steps of a fit change only what the measurement adds."""


@dataclass(frozen=True, eq=False)
class Body:
    """A profile and its transform at edges a, (n,) each, the first of them 0.

    Attributes:
        edges: a, rising [LU].
        heights: the transform g [LU].
        areas: its integral G [LU²].
        surface: the profile f [LU].
        radius: radius of curvature at the apex [LU]; None where it has none.
    """

    edges: Array
    heights: Array
    areas: Array
    surface: Array
    radius: float | None

    @classmethod
    @cached
    def of(cls, shape: Shape, depth: float, edges: int = 300, deepest: float = 8.0) -> Body:
        """Return the transformed profile at edges from 0 to `deepest` times `depth` in height, or to the body's end.

        It is cached: equal arguments return the same object.

        Args:
            shape: the profile.
            depth: range of the measured positions [LU].
            edges: number of edges above 0, in geometric progression over a factor of 500, between which a branch is
                cubic; more are at and beside kinks of the profile.
            deepest: least transformed height over `depth` at the last edge, unless the profile ends before.
        """
        last = depth
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) > deepest * depth:
            last *= 0.5
        while last < shape.reach and float(shape.transformed(np.array([last]))[0]) < deepest * depth:
            last *= 1.3
        a = np.append(0.0, np.geomspace(2e-3, 1.0, edges) * min(last, shape.reach))
        a = beside_kinks(a, shape.kinks, most_kinks=10)
        g, f = (np.append(0.0, height(a[1:])) for height in (shape.transformed, shape.height))
        node, weight = gauss(2)
        half = 0.5 * np.diff(a)
        inside = shape.transformed(a[:-1, None] + half[:, None] * (1.0 + node))
        areas = np.append(0.0, np.cumsum(half * (inside @ weight)))
        return cls(a, g, areas, f, shape.curvature_radius)


@dataclass(frozen=True)
class Branch:
    """The states of a contact along a rising path, (n,) each.

    Attributes:
        radii: a length that grows along the path [LU]: a, where the bodies attract each other only in contact.
        displacements: d [LU].
        forces: F [FU], compression positive.
    """

    radii: Array
    displacements: Array
    forces: Array

    def positions(self, stiffness: float) -> Array:
        """Return the positions z = d + F/k_c [LU] of the piezo for the states, from the contact point, (n,).

        `stiffness`: k_c of the instrument [FU/LU], maybe infinite (z = d).
        """
        return np.asarray(self.displacements + self.forces / stiffness)

    def forces_at(self, positions: Array, stiffness: float, held: bool, pitch: float = 1e-300) -> Array:
        """Return F [FU], compression positive, at positions z [LU] of the piezo from the contact point, (m,).

        Beyond the last state it is that of the last state. Below the least z of the branch the contact is lost: F falls
        to 0 over `pitch`, centred there. Where the bodies are `held`, F goes on below the least z with three times its
        mean slope from there to the state at which it has risen by a quarter of its magnitude (to the next state where
        F ≥ 0).

        Args:
            positions: z of the piezo from the contact point, (m,) [LU], in any order.
            stiffness: k_c [FU/LU] of the instrument; infinite: d is prescribed.
            held: whether the bodies are in contact at all positions.
            pitch: distance of positions [LU] over which a contact is lost: least squares need a finite slope.
        """
        z = self.positions(stiffness)
        least = min(int(np.argmin(z)), z.size - 4)  # four states are left of an adhesion that is far too strong
        a, z, F = self.radii[least:], np.maximum.accumulate(z[least:]), self.forces[least:]
        forces, below = _between(a, z, F, positions), positions < z[0]
        if not held:
            return np.asarray(np.clip(0.5 + (positions - z[0]) / pitch, 0.0, 1.0) * forces)
        # No model has a contact below the least z. Its continuation is three times as steep as the branch's first
        # quarter, so that a point there pulls the parameters back.
        quarter = np.searchsorted(F, F[0] + 0.25 * abs(F[0])) if F[0] < 0.0 else 1
        quarter = int(min(max(quarter, 1), z.size - 1))
        slope = 3.0 * (F[quarter] - F[0]) / max(z[quarter] - z[0], 1e-6 * (z[-1] - z[0]), 1e-300)
        most = 1e100  # of an adhesion that is far too strong, whose square is still a number
        with np.errstate(over="ignore"):
            return np.where(below, np.clip(F[0] + slope * (positions - z[0]), -most, most), forces)

    def snap_out(self, stiffness: float) -> tuple[float, float]:
        """Return (position z [LU] of the piezo from the contact point, force [FU], compression positive) at snap-out.

        This is the state of the least z; of Hertz's contact it is (0, 0).

        `stiffness`: k_c of the instrument [FU/LU], maybe infinite.
        """
        z = self.positions(stiffness)
        least = int(np.argmin(z))
        return float(z[least]), float(self.forces[least])


def _between(a: Array, z: Array, F: Array, positions: Array) -> Array:
    """Return F at positions z, (m,), both cubic in a between the states (n,) of a branch; constant beyond its ends.

    Lengths [LU] and forces [FU]; a and z are rising. Straight lines are not smooth enough: under correlated noise the
    differences of neighbouring points count.
    """
    i = np.clip(np.searchsorted(z, positions) - 1, 0, a.size - 2)
    width = np.diff(a)[i]
    cubic = [_cubic(values[i], values[i + 1], slope[i] * width, slope[i + 1] * width)
             for values, slope in ((z, np.gradient(z, a)), (F, np.gradient(F, a)))]  # fmt: skip
    (z0, z1, z2, z3), (f0, f1, f2, f3) = cubic
    with np.errstate(divide="ignore", invalid="ignore"):
        t = np.clip((positions - z[i]) / (z[i + 1] - z[i]), 0.0, 1.0)
        for _ in range(2):  # steps of Newton: from the straight start the error is below 1e-9 of the cell
            slope = z1 + t * (2.0 * z2 + 3.0 * t * z3)
            t = t - np.where(slope > 0.0, (z0 + t * (z1 + t * (z2 + t * z3)) - positions) / slope, 0.0)
    t = np.nan_to_num(np.clip(t, 0.0, 1.0))
    return np.asarray(f0 + t * (f1 + t * (f2 + t * f3)))


def _cubic(start: Array, end: Array, leaving: Array, arriving: Array) -> tuple[Array, Array, Array, Array]:
    """Return the coefficients of t⁰, t¹, t², t³ of the cubic Hermite polynomial from t = 0 to 1.

    In the unit of the ends, with the shape of the arguments.

    Args:
        start: value at t = 0.
        end: value at t = 1.
        leaving: slope by t at t = 0.
        arriving: slope by t at t = 1.
    """
    rise = end - start
    return start, leaving, 3.0 * rise - 2.0 * leaving - arriving, leaving + arriving - 2.0 * rise


def jkr(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Return the states of JKR's contact at the edges a of a body, from a = d = F = 0 on, unstable ones included.

    d = g(a) − √(2πaW/E*) [LU] and F = 2E*(a d − G) [FU], compression positive, with the transform g of the body and its
    integral G.

    `modulus`: E* [FU/LU²]; `work`: W [FU/LU]; `reach` is ignored.
    """
    a, d = body.edges, body.heights - elongation(body.edges, modulus, work)
    return Branch(a, d, 2.0 * modulus * (a * d - body.areas))


def hertz(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Return the states of Hertz's contact, without adhesion, at the edges a of a body, from a = d = F = 0 on.

    d = g(a) [LU] and F = 2E*(a d − G) ≥ 0 [FU], compression positive, with the transform g of the body and its integral
    G.

    `modulus`: E* [FU/LU²]; `work` and `reach` are ignored.
    """
    return jkr(body, modulus, 0.0, reach)


def dmt(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Return the states of the DMT contact: a and d [LU] of Hertz, and F = F_Hertz − 2πWR [FU], compression positive.

    The first state is a = d = 0 with F = −2πWR. `modulus`: E* [FU/LU²]; `work`: W [FU/LU]; `reach` is ignored, since
    the attraction is outside of the contact.

    Raises:
        AssertionError: the body has no radius of curvature R at its apex.
    """
    assert body.radius is not None
    branch = hertz(body, modulus, work, reach)
    return replace(branch, forces=branch.forces - 2.0 * math.pi * work * body.radius)


@dataclass(frozen=True, eq=False)
class SplineProfile:
    """A profile of cubics for `laws.dugdale`, extrapolated beyond its last edge."""

    height: Callable[[Array], Array]
    reach: float = math.inf
    kinks: tuple[float, ...] = ()


@dataclass(frozen=True, eq=False, kw_only=True)
class CohesiveZone(Dugdale):
    """The equations of Maugis and Dugdale with the integral G of a `Body`.

    Attributes:
        areas: positions [LU] and G there [LU²].
    """

    areas: tuple[Array, Array]

    def area(self, x: Array) -> Array:
        """Return G = ∫₀ˣ g dx [LU²] at positions x (n,) [LU], (n,), linear between the edges.

        Beyond the last edge it is that of the last edge.
        """
        return np.interp(x, *self.areas)


def maugis(body: Body, modulus: float, work: float, reach: float) -> Branch:
    """Return the states of the Maugis–Dugdale contact, by rising extent: an attraction σ₀ = W/h₀ up to the gap h₀.

    First 40 states before contact, whose `radii` are the radius c of the attraction, explicit in c; then states in
    contact at a third of the edges of the body, whose `radii` are a + s, s = √(c² − a²) a root to 1e-9. d [LU] and F
    [FU], compression positive.

    `modulus`: E* [FU/LU²]; `work`: W [FU/LU]; `reach`: h₀ > 0 [LU].
    """
    a = np.concatenate([[0.0], body.edges[1::3]])  # a third of the edges is enough
    profile, surface = (SplineProfile(CubicSpline(body.edges, heights)) for heights in (body.heights, body.surface))
    nodes, areas = 20, (body.edges, body.areas)
    law = CohesiveZone(profile, surface, modulus, work / reach, reach, float(a[-1]), nodes, 1e-9, areas=areas)
    s = law.widths(a)
    held = law.states(a, s)
    c = s[0] * np.linspace(0.0, 1.0, 40, endpoint=False)
    before, contact = (c, law.before(c), -math.pi * law.stress * c * c), (s[0] + a, held.displacement, held.force)
    return Branch(*(np.concatenate(columns) for columns in zip(before, contact, strict=True)))


@dataclass(frozen=True)
class ContactModel:
    """A contact model of a fit.

    Attributes:
        name: its name in messages and fit.json.
        branch: function of a body, E* [FU/LU²], W [FU/LU] and the range h₀ [LU] that returns the states.
        needs: what a scene must have for it: a work of adhesion W, the range h₀ of that, the radius R of the body.
        limits: names of the models between which it lies; since its fit takes long, it starts from theirs.
    """

    name: str
    branch: Callable[[Body, float, float, float], Branch]
    needs: frozenset[str] = frozenset()
    limits: tuple[str, ...] = ()

    def applies(self, scene: Scene) -> bool:
        """Return whether a scene has a nonzero value of each of W, h₀ and R that the model needs; True for Hertz.

        Maugis needs the work of adhesion W and its range h₀, JKR W, DMT W and a radius of curvature R at the apex.
        """
        given = {
            "W": scene.work_of_adhesion,
            "h₀": law_of(scene).range_of(scene, 0.0),
            "R": scene.bodies.profile.curvature_radius,
        }
        return all(given[name] for name in self.needs)

    def depends_on(self, key: str) -> bool:
        """Return whether the forces of the model depend on the number at a dotted key of a scene.

        False for `adhesion.range` in models without h₀ (all but Maugis) and for other keys of [adhesion] in models
        without W (Hertz); True for any other key, known or not.
        """
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
"""The contact models by name; the first that applies to a scene is the one that it means."""
