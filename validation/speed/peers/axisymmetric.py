"""The continuum limit of the boundary elements: a sphere with a hard wall and V = -W exp(-gap/z_0), ring by ring.

Rings of constant pressure on a half-space, a ring the difference of two discs (`references.rings`). The rings in
contact are prescribed and the displacement is found, by Newton's method, so that the curve goes round its folds and a
grid has nothing to pin: the outermost ring in contact is just about to part, q_c + sigma(0) = 0, and beyond it
q_i + sigma(g_i) = 0. It knows nothing of the peers.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache

import numpy as np

from validation.references.rings import pressed_down
from validation.speed.clock import spent
from validation.speed.peers.contacts import (
    A_0,
    CONTACT_MODULUS,
    RADIUS,
    WORK_OF_ADHESION,
    Array,
    Curve,
    Setting,
    closed_form,
    law_range,
)  # fmt: skip

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


@lru_cache(maxsize=8)
def curve(tabor: float) -> tuple[Array, Array]:
    """Return d [nm] and F [µN] of one Tabor number, the contact radius falling."""
    z, stress = law_range(tabor), WORK_OF_ADHESION / law_range(tabor)
    edges = np.linspace(0.0, REACH * A_0, RINGS + 1)
    places, area = 0.5 * (edges[1:] + edges[:-1]), np.pi * np.diff(edges**2)
    stiffness = np.linalg.inv(np.diff(pressed_down(places, edges), axis=1) / CONTACT_MODULUS)
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
            d += float(step[0])
            gap[count:] += step[1:]
            if np.abs(step).max() < CONVERGED * z:
                break
        else:
            raise RuntimeError(f"no equilibrium with {count} of {RINGS} rings in contact, Tabor {tabor}")
        found.append((d, float(force @ area)))
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
    return np.asarray(-(x[:, None] ** 2 + x[None, :] ** 2) / (2.0 * RADIUS))
