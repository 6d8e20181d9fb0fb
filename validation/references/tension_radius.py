"""Contact radius as the radius of maximum tensile stress: half the distance of the two deepest dips of the pressure.

p_i = F_z,i / s; on each side of x = 0 the vertex of the parabola through the lowest particle and its two neighbours (or
of a higher polynomial through more of them).
"""

import math
from collections.abc import Iterator

import numpy as np
from scipy.optimize import brentq

from validation.references.interaction import Floats
from validation.references.model import ChainModel
from validation.references.solver import State

PARABOLA = 3
"""Points of the interpolating polynomial by default."""
NEGLIGIBLE = 1e-12
"""Tension below this share of the largest pressure is round-off and counts as none."""
WINDOW = 4.0
"""Width w of the window over the spacing: with 3 to 12 the same to 1e-6, and the end of the chain is not felt."""
ROOT = 1e-12
"""Error of the place of a largest tension over the spacing."""


def tension_radius(places: Floats, pressure: Floats, stencil: int = PARABOLA) -> float:
    """Return the mean over both sides of |x| at the largest tension [LU]; NaN where a side carries no tension.

    A dip is not symmetric, so the vertex moves a little with the place of the particles in it: with the parabola by
    some 0.01 s where the dip is ten spacings wide, with more points by much less. Where particles snap, the pressure
    jumps beside its lowest value; then no polynomial helps and the radius is uncertain by half a spacing.

    Args:
        places: x of the particles, ascending, not necessarily even, shape (N,), N >= 3 [LU].
        pressure: compression positive, shape (N,) [FU/LU].
        stencil: points of the polynomial, odd, 3 the parabola; fewer near the ends of the chain.

    Raises:
        ValueError: if the largest tension is at an end of the chain, which is then too short.
    """
    radii = []
    for lowest in _lowest(places, pressure):
        if lowest is None:
            return math.nan
        if lowest in (0, places.size - 1):
            raise ValueError("the largest tension is at the end of the chain: the chain is too short")
        reach = min(stencil // 2, lowest, places.size - 1 - lowest)
        window = slice(lowest - reach, lowest + reach + 1)
        radii.append(abs(_vertex(places[window], pressure[window])))
    return 0.5 * (radii[0] + radii[1])


def band_limited_radius(places: Floats, pressure: Floats) -> float:
    """Return the mean over both sides of |x| at the largest tension of p(x) = sum p_i sinc(t_i) exp(-t_i^2/2w^2) [LU].

    t_i = (x - x_i)/s. It passes through all particles, and what a smooth pressure loses by it falls exponentially with
    the width of its dips, with no order to choose. Measured on the closed form of independent pairs, relative errors at
    contact radii of 3.5, 5, 7, 10 and 12 s: 6e-5, 5e-7, 2e-9, 2e-10, 2e-10 (`tension_radius` with 9 points: 1e-3,
    3e-5, 2e-6, 3e-7, 4e-8). For even particles.

    Args:
        places: x of the particles, evenly ascending, shape (N,), N >= 3 [LU].
        pressure: compression positive, shape (N,) [FU/LU].

    Raises:
        ValueError: if a side carries no tension, or its largest tension is at an end of the chain.
    """
    spacing = (places[-1] - places[0]) / (places.size - 1)

    def slope(x: float) -> float:
        t = (x - places) / spacing
        away = np.where(t == 0.0, 1.0, t)
        wave = np.where(t == 0.0, 0.0, (np.cos(math.pi * t) - np.sinc(t)) / away) - np.sinc(t) * t / WINDOW**2
        return float(pressure @ (wave * np.exp(-0.5 * (t / WINDOW) ** 2)))

    radii = []
    for lowest in _lowest(places, pressure):
        if lowest is None or lowest in (0, places.size - 1):
            raise ValueError("each side must have its largest tension inside the chain")
        radii.append(abs(float(brentq(slope, places[lowest - 1], places[lowest + 1], xtol=ROOT * spacing))))
    return 0.5 * (radii[0] + radii[1])


def _lowest(places: Floats, pressure: Floats) -> Iterator[int | None]:
    """Where the tension is largest on either side; None where a side has none."""
    for side in (np.flatnonzero(places <= 0.0), np.flatnonzero(places >= 0.0)):
        lowest = int(side[np.argmin(pressure[side])])
        yield lowest if -pressure[lowest] > NEGLIGIBLE * np.max(np.abs(pressure)) else None


def state_radius(model: ChainModel, state: State, stencil: int = PARABOLA) -> float:
    """Return the radius of maximum tensile stress of an equilibrium [LU]; NaN where a side carries no tension.

    The pressure of a particle belongs to its undeformed place x_i: its cell of the bulk, which does not move along x.

    Args:
        model: the model of the state.
        state: one equilibrium.
        stencil: points of the polynomial, see `tension_radius`.

    Raises:
        ValueError: if the chain is too short.
    """
    return tension_radius(model.places(), state.pair_force[:, 1] / model.spacing, stencil)


def _vertex(x: Floats, p: Floats) -> float:
    """Return the x of the lowest point of the polynomial through all points, between the neighbours of the middle."""
    middle = x.size // 2
    t = (x - x[middle]) / (x[middle + 1] - x[middle - 1])
    curve = np.polynomial.Polynomial.fit(t, p, x.size - 1)
    flat = curve.deriv().roots()
    candidates = flat.real[(np.abs(flat.imag) < 1e-9) & (flat.real >= t[middle - 1]) & (flat.real <= t[middle + 1])]
    return float(x[middle] + (x[middle + 1] - x[middle - 1]) * min(candidates, key=curve, default=0.0))
