"""The two contacts that every solver computes, in one set of numbers, with their closed forms: nm and µN.

A steel-like sphere: R = 6.1 µm, E* = 200 GPa, and for JKR W = 2 J/m², which makes F_A = 57.5 µN and a_0 = 174 nm.
One µN/nm² is 10^12 Pa, one µN/nm is 10^3 J/m². Displacements are prescribed, compression is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from validation.references.hertz import hertz_force
from validation.references.indenters import jkr

Array = NDArray[np.float64]

RADIUS = 6100.0
"""Effective R [nm]."""
CONTACT_MODULUS = 0.2
"""E* [µN/nm²]."""
WORK_OF_ADHESION = 2e-3
"""W = 2 gamma [µN/nm]."""
POINTS = 50
"""Displacements of a curve."""
JKR = jkr(RADIUS, CONTACT_MODULUS, WORK_OF_ADHESION)
F_A, A_0 = JKR.pull_off_force(), JKR.zero_load_radius()
DEPTH = A_0**2 / RADIUS
"""Unit of displacement a_0²/R [nm]: 4.96. JKR has F = 0 at 1/3 of it, F_A at -0.132; fixed grips end at -0.276."""
ADHESIVE_WAY = (DEPTH, -0.25 * DEPTH)
"""First and last displacement of the adhesive curve, an unloading [nm]: from F = 3.3 F_A, past F_A, until just before
the bodies part under fixed grips, where dF/dd has no bound and an error in F would mean nothing."""


@dataclass(frozen=True)
class Setting:
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


def elements(tolerance: float, *grids: tuple[int, float]) -> dict[str, tuple[Setting, ...]]:
    """Settings of boundary elements: five grids for Hertz; for JKR points along a side and Tabor's µ of each."""
    return {
        "hertz": tuple(Setting(f"{n}²", n, 1e-3) for n in (16, 24, 32, 48, 64)),
        "jkr": tuple(Setting(f"{n}², µ = {tabor:g}", n, tolerance, tabor) for n, tabor in grids),
    }


@dataclass(frozen=True)
class Curve:
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
        return hertz_force(displacement, RADIUS, CONTACT_MODULUS)
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
        "limit_pull_off": float(curve.force.min() / curve.limit.min() - 1.0),
        "theory_force": _rms((curve.force - closed_form(contact, curve.displacement))[held] / F_A),
    }


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
