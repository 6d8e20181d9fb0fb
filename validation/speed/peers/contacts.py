"""The two contacts that every solver computes, in one set of numbers, with their closed forms: nm and µN.

A steel-like sphere: R = 6.1 µm, E* = 200 GPa, and for JKR W = 2 J/m², which makes F_A = 57.5 µN and a_0 = 174 nm.
One µN/nm² is 10^12 Pa, one µN/nm is 10^3 J/m². Displacements are prescribed, compression is positive.

The continuum limit of the boundary elements: a sphere with a hard wall and V = -W exp(-gap/z_0), ring by ring.

Rings of constant pressure on a half-space, a ring the difference of two discs (`references.rings`). The rings in
contact are prescribed and the displacement is found, by Newton's method, so that the curve goes round its folds and a
grid has nothing to pin: the outermost ring in contact is just about to part, q_c + sigma(0) = 0, and beyond it
q_i + sigma(g_i) = 0. It knows nothing of the peers.
"""

import math
from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from validation.references import hertz, indenters, rings
from validation.speed.clock import spent

Array = NDArray[np.float64]

RADIUS = 6100.0
"""Effective R [nm]."""
CONTACT_MODULUS = 0.2
"""E* [µN/nm²]."""
WORK_OF_ADHESION = 2e-3
"""W = 2 gamma [µN/nm]."""
POINTS = 50
"""Displacements of a curve."""
JKR = indenters.jkr(RADIUS, CONTACT_MODULUS, WORK_OF_ADHESION)
F_A, A_0 = JKR.pull_off_force(), JKR.zero_load_radius()
DEPTH = A_0**2 / RADIUS
"""Unit of displacement a_0²/R [nm]: 4.96. JKR has F = 0 at 1/3 of it, F_A at -0.132; fixed grips end at -0.276."""
ADHESIVE_WAY = (DEPTH, -0.25 * DEPTH)
"""First and last displacement of the adhesive curve, an unloading [nm]: from F = 3.3 F_A, past F_A, until just before
the bodies part under fixed grips, where dF/dd has no bound and an error in F would mean nothing."""
RINGS = 1000
"""Rings out to REACH. With 700, F_A is 0.2 % larger at Tabor 5 and within 1e-4 at Tabor 1 to 3: it falls as the square
of their width, to 1.012 of JKR's at Tabor 5."""
REACH = 2.0
"""Radius of the outermost ring over a_0."""
DEEPEST, LEAST = 1.45, 0.2
"""Contact radii of the curve, first and last, over a_0."""
STEPS = 60
CONVERGED = 1e-10
"""Last step of Newton's method over z_0."""
LONGEST_STEP = 0.5
"""The same, of one step: the law is followed by its tangent no further."""


class Setting(NamedTuple):
    """One way to run a solver.

    Args:
        name: as it stands in the table.
        grid: points along a side, or particles in a_0.
        tolerance: of the solver, in its own terms.
        tabor: of the finite-range law; infinite for JKR itself or where there is no adhesion.
    """

    name: str
    grid: int
    tolerance: float
    tabor: float = math.inf


def elements(tolerance: float, grids: Sequence[tuple[int, float]]) -> dict[str, tuple[Setting, ...]]:
    """Settings of boundary elements: five grids for Hertz; for JKR points along a side and Tabor's µ of each."""
    return {
        "hertz": tuple(Setting(f"{n}²", n, 1e-3) for n in (16, 24, 32, 48, 64)),
        "jkr": tuple(Setting(f"{n}², µ = {tabor:g}", n, tolerance, tabor) for n, tabor in grids),
    }


class Curve(NamedTuple):
    """What a solver computed.

    Args:
        displacement: d of every point, zero at first touch of the undeformed bodies [nm].
        force: F [µN].
        seconds: processor time of the whole curve, one thread, without imports and what is done once for all [s].
        limit: F of the same curve in the solver's own continuum limit [µN].
    """

    displacement: Array
    force: Array
    seconds: float
    limit: Array


def displacements(contact: str) -> Array:
    """Return the prescribed d of `contact`, "hertz" (loading) or "jkr" (unloading), shape (POINTS,) [nm]."""
    return np.linspace(DEPTH / POINTS, DEPTH, POINTS) if contact == "hertz" else np.linspace(*ADHESIVE_WAY, POINTS)


def closed_form(contact: str, displacement: Array) -> Array:
    """Return F [µN] of Hertz or JKR, shape of `displacement` [nm], at which JKR's bodies must hold each other."""
    if contact == "hertz":
        return hertz.hertz_force(displacement, RADIUS, CONTACT_MODULUS)
    a = np.linspace(JKR.fixed_grips_radius(), 2.0 * A_0, 50_000)  # between these, linear interpolation costs 1e-8 F_A
    return JKR.force(np.interp(displacement, JKR.displacement(a), a))


def law_range(tabor: float) -> float:
    """Return z_0 = (R W²/E*²)^(1/3)/µ of the law V = -W exp(-gap/z_0) beside a hard wall [nm]; 0.17 at µ = 5."""
    return math.cbrt(RADIUS * WORK_OF_ADHESION**2 / CONTACT_MODULUS**2) / tabor


def errors(contact: str, curve: Curve) -> dict[str, float]:
    """Return the errors of a curve, each relative, against its own limit ("limit") and JKR itself ("theory").

    "force": rms of F - F_ref over the largest F_ref of Hertz, or over F_A. Hertz also has "relative", where every point
    counts by its own F; JKR "pull_off", the largest tension over that of the limit, less 1.
    """
    off = curve.force - curve.limit
    if contact == "hertz":
        return {"limit_force": _rms(off / curve.limit.max()), "limit_relative": _rms(curve.force / curve.limit - 1.0)}
    held = curve.displacement >= (1.0 + 1e-9) * ADHESIVE_WAY[1]  # where JKR has a force
    return {
        "limit_force": _rms(off / F_A),
        "limit_pull_off": curve.force.min() / curve.limit.min() - 1.0,
        "theory_force": _rms((curve.force - closed_form(contact, curve.displacement))[held] / F_A),
    }


@lru_cache(maxsize=8)
def curve(tabor: float) -> tuple[Array, Array]:
    """Return d [nm] and F [µN] of one Tabor number, the contact radius falling."""
    z, stress = law_range(tabor), WORK_OF_ADHESION / law_range(tabor)
    edges = np.linspace(0.0, REACH * A_0, RINGS + 1)
    places, area = 0.5 * (edges[1:] + edges[:-1]), np.pi * np.diff(edges**2)
    stiffness = np.linalg.inv(np.diff(rings.pressed_down(places, edges), axis=1) / CONTACT_MODULUS)
    height = places**2 / (2.0 * RADIUS)
    columns = stiffness.sum(axis=1)
    touching = np.unique(np.linspace(DEEPEST, LEAST, STEPS) * RINGS / REACH).astype(int)[::-1]
    found = []
    start = places[touching[0]]
    gap = np.maximum(height - start**2 / (2.0 * RADIUS), 0.0)
    d = start**2 / RADIUS - np.sqrt(2.0 * np.pi * WORK_OF_ADHESION * start / CONTACT_MODULUS)
    for count in touching:
        gap[:count] = 0.0
        for _ in range(400):
            force = stiffness @ (gap - height + d)
            pull = stress * np.exp(-gap / z)
            rest = (force + pull)[count - 1 :]
            slope = stiffness[count - 1 :, count - 1 :].copy()
            slope[np.diag_indices_from(slope)] -= pull[count - 1 :] / z
            slope[:, 0] = columns[count - 1 :]  # the gap of the last ring in contact is 0; d is unknown in its place
            step = np.linalg.solve(slope, -rest)
            step *= min(1.0, LONGEST_STEP * z / np.abs(step).max())
            d += step[0]
            gap[count:] += step[1:]
            if np.abs(step).max() < CONVERGED * z:
                break
        else:
            raise RuntimeError(f"no equilibrium with {count} of {RINGS} rings in contact, Tabor {tabor}")
        found.append((d, force @ area))
    places, forces = np.asarray(found).T
    return places, forces


def limit(tabor: float, displacement: Array) -> Array:
    """Return F [µN] at `displacement` [nm] on the branch that unloading follows."""
    d, force = curve(tabor)
    last = int(np.argmin(d)) + 1
    return np.interp(displacement, d[:last][::-1], force[:last][::-1])


def timed(contact: str, setting: Setting, solve: Callable[[], tuple[Array, Array]]) -> Curve:
    """Return the curve of a boundary-element code, beside its own limit; `solve` returns d [nm] and F [µN]."""
    began = spent()
    d, force = solve()
    seconds = spent() - began
    return Curve(d, force, seconds, closed_form(contact, d) if contact == "hertz" else limit(setting.tabor, d))


def heights(side: float, grid: int) -> Array:
    """Return -r²/2R of the pixels of a square, no pixel at the apex, shape (grid, grid) [nm]."""
    x = (np.arange(grid) + 0.5) * side / grid - 0.5 * side
    return -(x[:, None] ** 2 + x[None, :] ** 2) / (2.0 * RADIUS)


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
