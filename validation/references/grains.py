"""Two spheres that meet head-on: exact answers, and the laws that LAMMPS's granular models state.

In units of E*, R and m of the pair, k = (4/3) E* sqrt(R), d the overlap:

    Kelvin-Voigt, exact       loading F = k (d^1.5 + 1.5 A sqrt(d) d'), unloading F = k (d + A d')+^1.5
    viscoelastic              F = k d^1.5 + eta m sqrt(R d) d'; the same up to the largest overlap with eta m = 2 E* A
    tsuji, coeff_restitution  F = k d^1.5 + alpha sqrt(m k) d^0.25 d'

A model ends at d = 0, with `limit_damping` where F falls to 0. JKR by the contact radius a:

    d = a^2/R - sqrt(2 pi W a/E*),    F = 4 E* a^3/(3 R) - sqrt(8 pi W E* a^3)

Spheres touch at d = 0 and separate where d(a) is stationary (fixed grips), or where F(a) is (fixed load).
Sources: Johnson, Kendall and Roberts (1971); Brilliantov et al. (1996); Tsuji et al. (1992); Marshall (2009); the free
surface of an unloaded Kelvin-Voigt body lags: Ting (1966). Motion is integrated to a relative error of 1e-10.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq, minimize_scalar

K = 4.0 / 3.0
"""k of E* = R = 1."""
RELATIVE, ABSOLUTE = 1e-10, 1e-13
LONGEST = 100.0
"""Time within which an impact at velocity 1 is over."""
LONGEST_STEP = 0.05
Force = Callable[[float, float], float]


@dataclass(frozen=True)
class Impact:
    """What comes of an impact at velocity 1, m = 1: restitution, contact time, largest force and overlap."""

    restitution: float
    contact_time: float
    peak_force: float
    peak_overlap: float


def kelvin_voigt(A: float) -> Impact:
    """Exact; A = retardation time over (m²/(E*² R v))^(1/5)."""

    def force(d: float, rate: float) -> float:
        root = math.sqrt(max(d, 0.0))
        return K * (root**3 + 1.5 * A * root * rate) if rate > 0.0 else K * float(max(d + A * rate, 0.0) ** 1.5)

    return _impact(force, lambda d, rate: d + A * rate if rate < 0.0 else 1.0)


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


def _dashpot(damping: Callable[[float], float], limited: bool) -> Impact:
    def force(d: float, rate: float) -> float:
        depth = max(d, 0.0)
        total = float(K * depth**1.5 + damping(depth) * rate)
        return max(total, 0.0) if limited else total

    def left(d: float, rate: float) -> float:
        if rate > 0.0:
            return 1.0
        return float(K * max(d, 0.0) ** 1.5 + damping(max(d, 0.0)) * rate) if limited else d

    return _impact(force, left)


def _impact(force: Force, left: Force) -> Impact:
    """Motion m d'' = -F from d = 0 at rate 1 until `left` falls to 0."""

    def ends(_: float, y: list[float]) -> float:
        return left(y[0], y[1])

    ends.terminal, ends.direction = True, -1.0  # type: ignore[attr-defined]
    done = solve_ivp(
        lambda _, y: (y[1], -force(y[0], y[1])), (0.0, LONGEST), (0.0, 1.0), "DOP853", events=ends,
        rtol=RELATIVE, atol=ABSOLUTE, max_step=LONGEST_STEP, dense_output=True,
    )  # fmt: skip
    time = float(done.t_events[0][0])

    def peak(value: Callable[[float], float]) -> float:
        """The largest value, near the largest of the steps."""
        at = max(done.t, key=value)
        found = minimize_scalar(
            lambda t: -value(t), bounds=(max(0.0, at - LONGEST_STEP), min(time, at + LONGEST_STEP)), method="bounded",
            options={"xatol": 1e-9},
        )  # fmt: skip
        return -float(found.fun)

    overlap = peak(lambda t: float(done.sol(t)[0]))
    return Impact(-float(done.y_events[0][0][1]), time, peak(lambda t: force(*map(float, done.sol(t)))), overlap)


@dataclass(frozen=True)
class Spheres:
    """An adhesive contact by JKR.

    Args:
        work_of_adhesion: W; E* = R = 1.
    """

    work_of_adhesion: float

    def overlap(self, radius: float) -> float:
        """d(a)."""
        return radius**2 - math.sqrt(2.0 * math.pi * self.work_of_adhesion * radius)

    def force(self, radius: float) -> float:
        """F(a), positive in compression."""
        return K * radius**3 - math.sqrt(8.0 * math.pi * self.work_of_adhesion * radius**3)

    def pull_off(self) -> float:
        """F_A = (3/2) pi W R."""
        return 1.5 * math.pi * self.work_of_adhesion

    @property
    def fixed_grips(self) -> float:
        """Radius at which spheres separate that are drawn apart by displacement."""
        return float((math.pi * self.work_of_adhesion / 8.0) ** (1.0 / 3.0))

    @property
    def fixed_load(self) -> float:
        """Radius of the pull-off force, at which LAMMPS separates them."""
        return float((9.0 * math.pi * self.work_of_adhesion / 8.0) ** (1.0 / 3.0))

    def force_at(self, overlap: float) -> float:
        """F of the contact at an overlap, as long as grips hold it; 0 beyond."""
        if overlap < self.overlap(self.fixed_grips):
            return 0.0
        radius = brentq(lambda a: self.overlap(a) - overlap, self.fixed_grips, 10.0, xtol=1e-15)
        return self.force(float(radius))

    def lost(self, last: float) -> float:
        """Energy lost by spheres that touch at d = 0 and separate at the radius `last`: ∫ F dd along the contact."""
        first = (2.0 * math.pi * self.work_of_adhesion) ** (1.0 / 3.0)
        slope = math.sqrt(2.0 * math.pi * self.work_of_adhesion)
        value, _ = quad(lambda a: self.force(a) * (2.0 * a - 0.5 * slope / math.sqrt(a)), last, first)
        return -float(value)

    def sticking_velocity(self) -> float:
        """Below it spheres of effective mass 1 do not separate."""
        return math.sqrt(2.0 * self.lost(self.fixed_grips))
