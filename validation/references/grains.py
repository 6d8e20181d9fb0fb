"""Two spheres that meet: exact answers head-on, and the laws that LAMMPS's granular models state.

In units of E*, R and m of the pair, k = (4/3) E* sqrt(R), d the overlap:

    Kelvin-Voigt, exact       `impact.kelvin_voigt`
    viscoelastic              F = k d^1.5 + eta m sqrt(R d) d'; the same up to the largest overlap with eta m = 2 E* A
    tsuji, coeff_restitution  F = k d^1.5 + alpha sqrt(m k) d^0.25 d'

    mindlin, mindlin_rescale             F_t = 2 G* a s, s' = v_s
    mindlin/force, mindlin_rescale/force F_t' = 2 G* a v_s; cut off at mu F_n, rescale: s or F_t falls as a does

A model ends at d = 0, with `limit_damping` where F falls to 0. Spheres that adhere are `impact.Adhesive`: they touch at
d = 0 and separate where d(a) is stationary (fixed grips), or where F(a) is (fixed load).
Sources: Johnson, Kendall and Roberts (1971); Brilliantov et al. (1996); Tsuji et al. (1992); Marshall (2009); the free
surface of an unloaded Kelvin-Voigt body lags: Ting (1966).
"""

import math
from typing import Any

from validation.references import impact, numerics, relaxing
from validation.references.impact import Bounce

K = 4.0 / 3.0
"""k of E* = R = 1."""
LONGEST = 100.0
"""Time within which an impact at velocity 1 is over."""
VERLET = 20_000
"""Steps of an elastic impact."""


class Impact(Bounce):
    """What comes of an impact at velocity 1, m = 1."""

    @property
    def peak_overlap(self) -> float:
        """Largest d."""
        return self.peak_displacement


def kelvin_voigt(A: float) -> Impact:
    """Exact; A = retardation time over (m²/(E*² R v))^(1/5)."""
    return Impact(**vars(impact.kelvin_voigt(relaxing.KelvinVoigt(relaxing.sphere(1.0), A), 1.0, 1.0)))


def viscoelastic(damping: float, limited: bool) -> Impact:
    """`hertz … damping viscoelastic`; damping = eta."""
    return _dashpot(lambda d: damping * math.sqrt(d), limited)


def restoring(alpha: float, limited: bool) -> Impact:
    """`damping tsuji` and `coeff_restitution`, with their alpha."""
    return _dashpot(lambda d: alpha * math.sqrt(K) * d**0.25, limited)


def tsuji(e: float) -> float:
    """Alpha as a polynomial of e, as LAMMPS has it up to 2025 (Marshall's); m stands for the effective mass."""
    return 1.2728 - 4.2783 * e + 11.087 * e**2 - 22.348 * e**3 + 27.467 * e**4 - 18.022 * e**5 + 4.8218 * e**6


def coeff_restitution(e: float) -> float:
    """Alpha that gives e where the contact ends at d = 0."""
    return -math.sqrt(5.0) * math.log(e) / math.hypot(math.pi, math.log(e))


def _dashpot(damping: numerics.Function, limited: bool) -> Impact:
    def force(y: Any) -> float:
        depth = max(float(y[0]), 0.0)
        return float(K * depth**1.5 + damping(depth) * y[1])

    def acting(y: Any) -> float:
        return max(force(y), 0.0) if limited else force(y)

    def left(_: float, y: Any) -> float:
        return 1.0 if y[1] > 0.0 else force(y) if limited else float(y[0])

    done = impact.motion(lambda _, y: [y[1], -acting(y)], [0.0, 1.0], 1.0, LONGEST, left)
    end = done.t[-1]
    overlap = impact.peak(lambda t: done.sol(t)[0], end)
    return Impact(-done.y[1, -1], end, impact.peak(lambda t: acting(done.sol(t)), end), overlap, math.sqrt(overlap))


def mindlin(psi: float, chi: float, by_force: bool, rescaled: bool) -> float:
    """v_s'/v_s of the models of Mindlin by velocity Verlet, elastic, in the units of `oblique.rebound`."""
    step = kelvin_voigt(0.0).contact_time / VERLET
    d, a, v, slip, held, force, shear = 0.0, 0.0, 1.0, psi, 0.0, 0.0, 0.0
    while d > 0.0 or v > 0.0:
        v, slip = v - 0.5 * step * force, slip - step * chi * shear
        d = max(d + step * v, 0.0)
        last, a = a, math.sqrt(d)
        held = held * (a / last if rescaled and a < last else 1.0) + step * slip * (2.0 * a if by_force else 1.0)
        force, stiffness = K * a**3, 1.0 if by_force else 2.0 * a
        shear = max(-force, min(stiffness * held, force))
        held = shear / stiffness if a else 0.0
        v, slip = v - 0.5 * step * force, slip - step * chi * shear
    return slip / psi
