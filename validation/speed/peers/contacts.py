"""The two contacts that every solver computes, in one set of numbers, with their closed forms: nm and µN.

A steel-like sphere: R = 6.1 µm, E* = 200 GPa, and for JKR W = 2 J/m², which makes F_A = 57.5 µN and a_0 = 174 nm.
One µN/nm² is 10^12 Pa, one µN/nm is 10^3 J/m². Displacements are prescribed, compression is positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from validation.references.hertz import hertz_contact_radius, hertz_force
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
"""Unit of displacement a_0²/R [nm]: 4.96. JKR has F = 0 at 1/3 of it, F_A at -0.132; fixed grips let go at -0.276."""
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
    grid: int = 0
    tolerance: float = 0.0
    tabor: float = math.inf


@dataclass(frozen=True)
class Curve:
    """What a solver computed.

    Args:
        displacement: d of every point, zero at first touch of the undeformed bodies [nm].
        force: F [µN].
        radius: a, NaN where the solver has none [nm].
        seconds: processor time of the whole curve, one thread, without start_up [s].
        start_up: of what is done once for any number of curves, without imports [s].
        limit: the same curve in the solver's own continuum limit: F [µN] and a [nm].
        parts: other times of the same curve, by name [s].
    """

    displacement: Array
    force: Array
    radius: Array
    seconds: float
    start_up: float
    limit: tuple[Array, Array]
    parts: dict[str, float] = field(default_factory=dict)


def displacements(contact: str, way: tuple[float, float] = ADHESIVE_WAY) -> Array:
    """Return the prescribed d of `contact`, "hertz" (loading) or "jkr" (unloading on `way`), shape (POINTS,) [nm]."""
    return np.linspace(DEPTH / POINTS, DEPTH, POINTS) if contact == "hertz" else np.linspace(*way, POINTS)


def closed_form(contact: str, displacement: Array) -> tuple[Array, Array]:
    """Return F [µN] and a [nm] of Hertz or JKR, shape of `displacement` [nm].

    Raises:
        ValueError: for a contact of another name, or a d at which JKR's bodies have parted.
    """
    if contact == "hertz":
        return hertz_force(displacement, RADIUS, CONTACT_MODULUS), hertz_contact_radius(displacement, RADIUS)
    if contact != "jkr":
        raise ValueError(f"the contacts are hertz and jkr, not {contact!r}")
    a = np.linspace(JKR.fixed_grips_radius(), 2.0 * A_0, 50_000)  # between these, linear interpolation costs 1e-8 F_A
    d = JKR.displacement(a)
    if np.min(displacement) < d[0] or np.max(displacement) > d[-1]:
        raise ValueError(f"JKR's stable branch is taken from {d[0]:.4g} to {d[-1]:.4g} nm")
    radius = np.interp(displacement, d, a)
    return JKR.force(radius), radius


def law_range(tabor: float) -> float:
    """Return z_0 = (R W²/E*²)^(1/3)/µ of the law V = -W exp(-gap/z_0) beside a hard wall [nm]; 0.17 at µ = 5."""
    return math.cbrt(RADIUS * WORK_OF_ADHESION**2 / CONTACT_MODULUS**2) / tabor


def errors(contact: str, curve: Curve) -> dict[str, float]:
    """Return the errors of a curve, each relative, against its own limit ("limit") and the closed form ("theory").

    For both: "force", rms of F - F_ref over the largest |F_ref| of Hertz, or over F_A; "worst", the largest of it;
    "radius", rms of a - a_ref over a_0, NaN where there is none; "displacement", rms of d - d_ref at the same F where
    that is compressive, over a_0²/R. Hertz also has "relative" and "worst_relative", where
    every point counts by its own F; JKR "pull_off", the largest tension over that of the reference, less 1 (a peak
    between two points makes up to 1e-3 of it against the closed form), and, over a_0²/R, where F_A and F = 0 are:
    "pull_off_place" and "zero_load_place".
    """
    found: dict[str, float] = {}
    held = curve.displacement >= (1.0 + 1e-9) * ADHESIVE_WAY[1]  # where JKR has a force
    theory = closed_form(contact, curve.displacement[held])
    for name, kept, (force, radius) in (("limit", slice(None), curve.limit), ("theory", held, theory)):
        off = (curve.force[kept] - force) / (np.abs(force).max() if contact == "hertz" else F_A)
        found[f"{name}_force"] = _rms(off)
        found[f"{name}_worst"] = float(np.abs(off).max())
        found[f"{name}_radius"] = _rms((curve.radius[kept] - radius) / A_0)
        found[f"{name}_displacement"] = _displacement_error(contact, curve.displacement[kept], curve.force[kept], force)
        if contact == "hertz":
            found[f"{name}_relative"] = _rms(curve.force / force - 1.0)
            found[f"{name}_worst_relative"] = float(np.abs(curve.force / force - 1.0).max())
        else:
            wanted = -F_A if name == "theory" else float(force.min())
            found[f"{name}_pull_off"] = float(curve.force.min() / wanted - 1.0)
    if contact == "jkr":
        lowest = int(np.argmin(curve.force))
        found["pull_off_place"] = float(curve.displacement[lowest] / DEPTH)
        ends = slice(lowest, None, -1)
        found["zero_load_place"] = float(np.interp(0.0, curve.force[ends], curve.displacement[ends]) / DEPTH)
    return found


def _displacement_error(contact: str, displacement: Array, force: Array, wanted: Array) -> float:
    """Rms of d - d_ref(F) over a_0²/R; d_ref between the points by a spline over F, over F^(2/3) for Hertz."""
    kept = wanted > 0.0
    place, force, wanted = displacement[kept], force[kept], wanted[kept]
    if contact == "hertz":
        force, wanted = np.maximum(force, 0.0) ** (2.0 / 3.0), wanted ** (2.0 / 3.0)
    rising = np.argsort(wanted)
    return _rms((place - CubicSpline(wanted[rising], place[rising])(force)) / DEPTH)


def reduced_distance(curve: Curve) -> float:
    """Return the rms of F/F_A - (4x³ - 4x^(3/2)), x = a/a_0, F_A and a_0 the curve's own, over a_cr < a < a(1.5 F_A).

    It is the error of the one-dimensional reduction where F_A and a_0 were identified.
    """
    pull_off, lowest = -float(curve.force.min()), int(np.argmin(curve.force))
    force, radius = curve.force[: lowest + 1] / pull_off, curve.radius[: lowest + 1]
    zero = float(np.interp(0.0, force[::-1], radius[::-1]))
    x = radius / zero
    kept = force < 1.5
    return _rms((force - (4.0 * x**3 - 4.0 * x**1.5))[kept])


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
