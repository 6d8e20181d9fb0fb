"""The force of a body that relaxes, pressed by a rigid one along a measured history of displacements.

    F(t) = ∫₀^t₁ φ(t − s) dP(d(s)),    ∫_t₁^t φ(t − s) d′(s) ds = 0,    φ(t) = 1 − Σ g (1 − e^(−t/τ))

P(d) is the force of the contact with the instantaneous modulus. Until the largest displacement t₁ = t (E. H. Lee,
J. R. M. Radok, J. Appl. Mech. 27 (1960) 438), then it is when the contact was as wide before (T. C. T. Ting, J. Appl.
Mech. 33 (1966) 845). Between measured points displacements and P are linear in time.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from contact1d.workflow.fit.curve import Indices
from contact1d.workflow.fit.forward import Branch

Array = NDArray[np.float64]
Terms = Sequence[tuple[float, float]]
"""Share g and relaxation time τ [s] of each term of Prony's series."""


def relaxed(branch: Branch, terms: Terms, times: Array, displacements: Array) -> tuple[Array, Array]:
    """Return (F [FU], compression positive; stiffness dF/dd of a fast change [FU/LU]) at each time, (n,) each.

    0 where the bodies are apart: before the displacement first exceeds 0, and after the loss of the contact.

    Args:
        branch: the contact with the instantaneous modulus, without adhesion.
        terms: of the material; shares whose sum exceeds 1 are reduced in proportion.
        times: rising, (n,) [s].
        displacements: of the rigid body, with one maximum but for noise, (n,) [LU].
    """
    d = displacements
    total = max(1.0, sum(share for share, _ in terms))
    elastic = np.where(d > 0.0, branch.forces_at(d, math.inf, held=False), 0.0)
    slopes = np.gradient(branch.forces, branch.radii) / np.gradient(branch.displacements, branch.radii)
    stiffness = np.where(d > 0.0, np.interp(d, branch.displacements, slopes), 0.0)
    parts = [(1.0 - sum(share for share, _ in terms) / total, math.inf, (elastic, d))]
    for share, time in terms:
        parts.append((share / total, time, (_remembered(times, elastic, time), _remembered(times, d, time))))
    force, now = (np.sum([share * memory[column] for share, _, memory in parts], axis=0) for column in (0, 1))
    top, first = int(np.argmax(d)), max(0, int(np.argmax(d > 0.0)) - 1)
    later = slice(top + 1, None)
    t = times[later]

    def carried(i: Indices, column: int) -> Array:
        """Return Σ share · e^(−(t − tᵢ)/τ) · memory at the points i, one for each of the later times t, (m,).

        `column`: 0 for the memory of P, 1 for that of the displacement.
        """
        sums: Array = np.sum([g * np.exp((times[i] - t) / tau) * memory[column][i] for g, tau, memory in parts], axis=0)
        return sums

    # ∫ φ(t − s) d′(s) ds from a point to t falls with the point: it is positive where the contact is wider at t.
    low, high = np.full(t.size, first), np.full(t.size, top)
    while (high - low > 1).any():
        middle = (low + high) // 2
        wider = now[later] - carried(middle, 1) > 0.0
        low, high = np.where(wider, middle, low), np.where(wider, high, middle)
    inside, outside = (now[later] - carried(end, 1) for end in (low, high))
    with np.errstate(divide="ignore", invalid="ignore"):
        fraction = np.clip(np.nan_to_num(inside / (inside - outside)), 0.0, 1.0)
    held = now[later] - carried(np.full(t.size, first), 1) > 0.0
    force[later] = np.where(held, (1.0 - fraction) * carried(low, 0) + fraction * carried(high, 0), 0.0)
    stiffness[later] = np.where(held, (1.0 - fraction) * stiffness[low] + fraction * stiffness[high], 0.0)
    return force, stiffness


def _remembered(times: Array, values: Array, time: float) -> Array:
    """Return ∫ e^(−(t − s)/τ) x′(s) ds up to each time, (n,), of values x that are linear between times.

    Args:
        times: rising, (n,).
        values: x, of which the first is taken for 0, (n,).
        time: τ.
    """
    span = np.diff(times) / time
    band = np.ones((2, times.size))
    band[1, :-1] = -np.exp(-span)
    gains = np.where(span > 1e-9, -np.expm1(-span) / np.maximum(span, 1e-300), 1.0) * np.diff(values)
    return np.asarray(solve_banded((1, 0), band, np.append(0.0, gains)))
