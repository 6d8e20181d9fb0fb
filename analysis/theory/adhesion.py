"""Which theory of an adhesive sphere holds, and those of an attraction with a range: DMT, Maugis and Dugdale.

The Tabor parameter mu = (R W^2/(E*^2 h_0^3))^(1/3) is the elastic displacement of the surfaces at pull-off, of the
order of (R W^2/E*^2)^(1/3), over the range h_0 = W/sigma_0 of the attraction, 0.974 z_0 of a Lennard-Jones surface: JKR
(`indenters`) holds for a large one, DMT for a small one, Maugis and Dugdale between the two. The map is that of K. L.
Johnson, J. A. Greenwood, J. Colloid Interface Sci. 192 (1997) 326, after D. Tabor, ibid. 58 (1977) 2: the zones are
theirs. Their figure was not at hand: each boundary is a criterion written out below, not read off it, and how small is
negligible is a convention in all but one. The lines mu = 5 (JKR) and mu = 0.1 (DMT) are common usage and independent of
the load, which the criteria behind them are not. What they cost, against Maugis and Dugdale: at mu = 5 JKR's contact
radius is 0.8 % too large at F = 0 and its pull-off 0.3 % too small; at mu = 0.1 DMT's radius is 6 % too small at F = 0
(8 % at -pi W R, 2 % at 40 pi W R) and its pull-off 3 % too large. The rest is computed, with 5 % as negligible: the
compression over h_0 for the rigid sphere, the load that attraction adds over F for Hertz. F positive in compression; a
<< R. Any consistent units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np

from contact1d.analysis.theory.indenters import Contact, PowerLaw, require_positive
from contact1d.digits import apart

LENNARD_JONES_STRESS = 16.0 / (9.0 * math.sqrt(3.0))
"""1.026: the force maximum of the 9-3 surface law of Lennard-Jones over W/z_0; taken as sigma_0, z_0 is 1.026 h_0."""
LAMBDA_OVER_TABOR = 2.0 * math.cbrt(9.0 / (16.0 * math.pi))
"""1.127: lambda over the Tabor parameter mu."""
LARGEST_CRITICAL_RADIUS = 1.5
"""A above that of every pull-off: JKR's, the largest, is (3/2)^(1/3) = 1.145."""
ROOT = 4.0 * np.finfo(np.float64).eps
"""Relative tolerance of a root: the least that the root finder takes."""
FLAT_MINIMUM = 1e-9
"""Absolute, in A: how near the search for a lowest value comes; its error there is the square of this."""
JKR_TABOR = 5.0
"""JKR above: the edge is stretched by Delta_l = sqrt(2 pi a W/E*), 3.9 mu h_0 at F = 0, which is 20 h_0: the range is
negligible. A convention."""
DMT_TABOR = 0.1
"""DMT below: the same stretch, for DMT's a, is less than h_0/3 at F = 0: attraction deforms little. A convention."""
RIGID_COMPRESSION = 0.05
"""Rigid (Bradley) below: Hertz's compression under F + 2 pi W R over h_0. The 5 % is a convention."""
HERTZ_ADHESION_SHARE = 0.05
"""Hertz below: the load that attraction adds, (4 E* a^3/3R - F)/F. The 5 % is a convention. For DMT it means
F/(pi W R) > 40, for JKR F/(pi W R) > 2520: its attraction grows with the contact. A radius is then 1.6 % off."""


@dataclass(frozen=True)
class Dmt(Contact):
    """DMT: a stiff sphere that adheres to a flat, F(a) = 4 E* a^3/3R - 2 pi W R: Hertz, pressed by attraction outside.

    Valid for a Tabor parameter below about 0.1. Source: B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid
    Interface Sci. 53 (1975) 314, in the form of D. Maugis, J. Colloid Interface Sci. 150 (1992) 243.

    Args:
        radius: effective radius R [length].
        contact_modulus: E* [stress].
        work_of_adhesion: W = 2 gamma [force/length].

    Raises:
        ValueError: if one of them is not positive.
    """

    radius: float
    contact_modulus: float
    work_of_adhesion: float

    def __post_init__(self) -> None:
        """Check the signs."""
        require_positive(**vars(self))

    @property
    def _load(self) -> float:
        """pi W R [force], the unit of N."""
        return math.pi * self.work_of_adhesion * self.radius

    @property
    def _length(self) -> float:
        """(pi W R^2/K)^(1/3) [length], the unit of A."""
        return math.cbrt(0.75 * self._load * self.radius / self.contact_modulus)

    def force(self, contact_radius: float) -> float:
        """Return F(a) = 4 E* a^3/3R - 2 pi W R [force]; a >= 0 [length]. At a = 0 that of rigid spheres (Bradley)."""
        return 4.0 * self.contact_modulus * contact_radius**3 / (3.0 * self.radius) - 2.0 * self._load

    def displacement(self, contact_radius: float) -> float:
        """Return d(a) = a^2/R [length], that of Hertz; a >= 0 [length]."""
        return contact_radius**2 / self.radius


@dataclass(frozen=True)
class MaugisDugdale(Dmt):
    """Maugis-Dugdale: a sphere whose attraction is a constant stress sigma_0 in a ring a < r < c; from DMT to JKR.

    With K = 4E*/3, in the units of Maugis: A = a/(pi W R^2/K)^(1/3), C = c in the same unit, N = F/(pi W R),
    D = d/(pi^2 W^2 R/K^2)^(1/3), lambda = 2 sigma_0 (R/(pi W K^2))^(1/3), S = sqrt(C^2-A^2), phi = arccos(A/C):

        (lambda/2) [A S + (C^2 - 2A^2) phi] + (4 lambda^2/3) [S phi - C + A] = 1     gap at c times sigma_0 is W
        N = A^3 - lambda [A S + C^2 phi],     D = A^2 - (4/3) lambda S

    which is Maugis' form in m = C/A, written so that it also holds at A = 0. Limits: lambda -> 0 N = A^3 - 2, D = A^2
    (DMT); lambda -> infinity N = A^3 - A sqrt(6A), D = A^2 - (2/3) sqrt(6A) (JKR); lambda = 1.127 mu. Valid for
    a << R, c << R, and from first touch on (states before touch are left out; their tension is less). Source: D.
    Maugis, J. Colloid Interface Sci. 150 (1992) 243.

    Args:
        radius, contact_modulus, work_of_adhesion: as of `Dmt`.
        range_of_attraction: h_0 = W/sigma_0 [length]; of a Lennard-Jones surface 0.974 z_0, z_0 where two surfaces are
            free of force. lambda was tried from 1e-6 to 1e4.

    Raises:
        ValueError: if one of them is not positive.
    """

    range_of_attraction: float

    @classmethod
    def reduced(cls, tabor: float) -> MaugisDugdale:
        """The contact of one `tabor` number mu > 0 in the units of Maugis: a is A, F is N, d is D."""
        return cls(1.0, 0.75, 1.0 / math.pi, math.cbrt((0.75 * math.pi) ** -2) / tabor)

    @property
    def tabor(self) -> float:
        """mu = (R W^2/(E*^2 h_0^3))^(1/3)."""
        ratio = self.work_of_adhesion / self.contact_modulus
        return math.cbrt(self.radius * ratio**2 / self.range_of_attraction**3)

    @property
    def transition(self) -> float:
        """lambda = 1.127 mu."""
        return LAMBDA_OVER_TABOR * self.tabor

    @property
    def theories(self) -> dict[Theory, Contact]:
        """The contact by JKR and DMT, which know no range, and by this one."""
        pair = self.radius, self.contact_modulus, self.work_of_adhesion
        return {Theory.JKR: PowerLaw.sphere(*pair), Theory.DMT: Dmt(*pair), Theory.MAUGIS: self}

    def ring_width(self, contact_radius: float) -> float:
        """Return c - a, the root of the adhesion equation [length]; a >= 0 [length]."""
        return self._length * _ring_width(self.transition, contact_radius / self._length)

    def force(self, contact_radius: float) -> float:
        """Return F, N = A^3 - lambda [A S + C^2 phi] [force]; a >= 0 [length]."""
        return self._load * _reduced(self.transition, contact_radius / self._length)[0]

    def displacement(self, contact_radius: float) -> float:
        """Return d, D = A^2 - (4/3) lambda S [length]; a >= 0 [length]."""
        return self._length**2 / self.radius * _reduced(self.transition, contact_radius / self._length)[1]

    def critical_radius(self) -> float:
        """Return a where a fixed load pulls off [length]; 0 where F rises from first touch on."""
        return self._length * _lowest(self.transition, 0)

    def fixed_grips_radius(self) -> float:
        """Return a where a prescribed displacement pulls off [length]."""
        return self._length * _lowest(self.transition, 1)


def _reduced(transition: float, a: float) -> tuple[float, float]:
    """N and D at A."""
    u = _ring_width(transition, a)
    s = math.sqrt(u * (2.0 * a + u))
    return a**3 - transition * (a * s + (a + u) ** 2 * math.atan2(s, a)), a**2 - 4.0 / 3.0 * transition * s


def _adhesion_excess(transition: float, a: float, u: float) -> float:
    """Return (lambda/2) [A S + (C^2-2A^2) phi] + (4 lambda^2/3) [S phi - C + A] - 1 for C = a + u: rises with u."""
    s = math.sqrt(u * (2.0 * a + u))
    phi = math.atan2(s, a)
    elastic = a * s + (s**2 - a**2) * phi
    return 0.5 * transition * elastic + 4.0 / 3.0 * transition**2 * (s * phi - u) - 1.0


def _ring_width(transition: float, a: float) -> float:
    """Return u = C - A >= 0 of one contact radius A; it is widest at A = 0, where the equation is quadratic in C.

    There (pi/4) lambda C^2 + (4 lambda^2/3)(pi/2 - 1) C = 1; the root is written without a difference of large numbers.
    """
    from scipy.optimize import brentq  # which takes longer to import than a small run

    if a < 0.0:
        raise ValueError(f"contact_radius must not be negative, got {a}")
    quadratic, linear = 0.25 * math.pi * transition, 4.0 / 3.0 * transition**2 * (0.5 * math.pi - 1.0)
    widest = 2.0 / (linear + math.sqrt(linear**2 + 4.0 * quadratic))
    if a == 0.0:
        return widest
    high = widest * (1.0 + 1e-9)  # above the root by more than round-off
    return float(brentq(lambda u: _adhesion_excess(transition, a, u), 0.0, high, xtol=1e-300, rtol=ROOT))


@lru_cache(maxsize=256)
def _lowest(transition: float, which: int) -> float:
    """Return A of the lowest N or D of one lambda; the search is on 0..1.5, and the end A = 0 is compared."""
    from scipy.optimize import minimize_scalar

    def curve(a: float) -> float:
        return _reduced(transition, a)[which]

    bounds, options = (0.0, LARGEST_CRITICAL_RADIUS), {"xatol": FLAT_MINIMUM}
    found = minimize_scalar(curve, bounds=bounds, method="bounded", options=options)
    return float(found.x) if found.fun < curve(0.0) else 0.0


class Theory(StrEnum):
    """The zones of the map."""

    APART = "no contact"
    RIGID = "rigid sphere (Bradley)"
    HERTZ = "Hertz"
    JKR = "JKR"
    DMT = "DMT"
    MAUGIS = "Maugis-Dugdale"


@dataclass(frozen=True)
class Verdict:
    """A zone of the map and why.

    Args:
        theory: which theory holds.
        reason: one sentence with the number that decided.
    """

    theory: Theory
    reason: str


def of_tabor(tabor: float) -> Theory:
    """The theory for mu at any load: DMT below 0.1, JKR above 5, else Maugis and Dugdale's."""
    if tabor < DMT_TABOR:
        return Theory.DMT
    return Theory.JKR if tabor > JKR_TABOR else Theory.MAUGIS


def valid_theory(tabor: float, reduced_load: float) -> Verdict:
    """Return the simplest valid theory; tested in the order apart, rigid, Hertz, JKR, DMT, Maugis and Dugdale.

    With N = F/(pi W R): rigid where Hertz's compression under F + 2 pi W R, mu [(3 pi/4)(N + 2)]^(2/3) h_0, is small;
    Hertz where (A^3 - N)/N is, the load that attraction adds, by the theory that goes with mu.

    Args:
        tabor: mu > 0 [1].
        reduced_load: N, positive in compression [1].

    Raises:
        ValueError: if mu is not positive and finite, or the load not finite.
    """
    if not (math.isfinite(tabor) and tabor > 0.0 and math.isfinite(reduced_load)):
        raise ValueError(f"tabor must be positive and both numbers finite, got {tabor} and {reduced_load}")
    contacts, usual = MaugisDugdale.reduced(tabor).theories, of_tabor(tabor)
    jkr = contacts[Theory.JKR].pull_off_force()
    largest = max(jkr, contacts[Theory.DMT if usual is Theory.DMT else Theory.MAUGIS].pull_off_force())
    if reduced_load < -largest:
        found, limit = apart(-reduced_load, largest)
        return Verdict(Theory.APART, f"a tension of {found} πWR exceeds the pull-off force {limit} πWR")
    compression = tabor * math.cbrt(0.75 * math.pi * (reduced_load + 2.0)) ** 2
    if compression < RIGID_COMPRESSION:
        found, limit = apart(compression, RIGID_COMPRESSION, 2)
        return Verdict(Theory.RIGID, f"the compression is {found} h₀, less than {limit}: F_A = 2πWR")
    if reduced_load > 0.0:
        share = (contacts[usual].contact_radius(reduced_load) ** 3 - reduced_load) / reduced_load
        if share < HERTZ_ADHESION_SHARE:
            return Verdict(
                Theory.HERTZ, f"attraction adds {share:.1%} to the load, less than {HERTZ_ADHESION_SHARE:.0%}"
            )
    if usual is Theory.JKR and reduced_load >= -jkr:
        return Verdict(usual, f"{apart(tabor, JKR_TABOR)[0]} is above {JKR_TABOR:g}: the range is negligible")
    if usual is Theory.DMT:
        return Verdict(usual, f"{apart(tabor, DMT_TABOR)[0]} is below {DMT_TABOR:g}: attraction deforms little")
    reason = f"{tabor:.3g} is between {DMT_TABOR:g} and {JKR_TABOR:g}: neither DMT nor JKR"
    if usual is Theory.JKR:
        reason = "the tension exceeds JKR's pull-off force, 1.5 πWR, and not yet that of a finite range"
    return Verdict(Theory.MAUGIS, reason)
