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
import sys
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

from contact1d.analysis.theory.indenters import Contact, PowerLaw, require_positive
from contact1d.digits import apart

LENNARD_JONES_STRESS = 16.0 / (9.0 * math.sqrt(3.0))
"""1.026: the force maximum of the 9-3 surface law of Lennard-Jones over W/z_0; taken as sigma_0, z_0 is 1.026 h_0."""
LAMBDA_OVER_TABOR = 2.0 * math.cbrt(9.0 / (16.0 * math.pi))
"""Maugis' parameter lambda over the Tabor parameter mu, 1.127."""
JKR_TABOR = 5.0
"""Tabor parameter above which JKR holds: the edge is stretched by Delta_l = sqrt(2 pi a W/E*), 3.9 mu h_0 at F = 0,
which is 20 h_0: the range is negligible. A convention."""
DMT_TABOR = 0.1
"""Tabor parameter below which DMT holds: that stretch, for DMT's a, is less than h_0/3 at F = 0, so that attraction
deforms little. A convention."""
RIGID_COMPRESSION = 0.05
"""Hertz's compression under F + 2 pi W R over h_0 below which the sphere is rigid (Bradley). A convention."""
HERTZ_ADHESION_SHARE = 0.05
"""Load that attraction adds, (4 E* a^3/3R - F)/F, below which Hertz holds. A convention: for DMT it means
F/(pi W R) > 40, for JKR, whose attraction grows with the contact, F/(pi W R) > 2520. A radius is then 1.6 % off."""


@dataclass(frozen=True)
class Dmt(Contact):
    """The DMT theory of a stiff sphere that adheres to a flat, F(a) = 4 E* a^3/3R - 2 pi W R.

    The contact is that of Hertz, under the load and the attraction outside of it.

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
        """Raise ValueError for a parameter that is not positive and finite.

        Of MaugisDugdale the range of attraction is one of them.
        """
        require_positive(**vars(self))

    @property
    def _load(self) -> float:
        """pi W R [force], by which a force is divided to give N = F/(pi W R)."""
        return math.pi * self.work_of_adhesion * self.radius

    @property
    def _length(self) -> float:
        """(pi W R^2/K)^(1/3) with K = 4E*/3 [length], by which a radius is divided to give A."""
        return math.cbrt(0.75 * self._load * self.radius / self.contact_modulus)

    def force(self, contact_radius: float) -> float:
        """Return F(a) = 4 E* a^3/3R - 2 pi W R [force], positive in compression; a >= 0 [length].

        At a = 0 it is that of rigid spheres (Bradley), the pull-off force with a negative sign.
        """
        return 4.0 * self.contact_modulus * contact_radius**3 / (3.0 * self.radius) - 2.0 * self._load

    def displacement(self, contact_radius: float) -> float:
        """Return d(a) = a^2/R [length], that of Hertz, positive in approach; a >= 0 [length]."""
        return contact_radius**2 / self.radius


@dataclass(frozen=True)
class MaugisDugdale(Dmt):
    """The Maugis-Dugdale theory of a sphere with a constant stress sigma_0 in a ring a < r < c; from DMT to JKR.

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
        """Return the contact of a `tabor` parameter mu > 0 in units in which a is A, F is N and d is D of Maugis.

        R = 1, E* = 3/4, W = 1/pi. Raises ValueError for a negative mu, ZeroDivisionError for 0.
        """
        return cls(1.0, 0.75, 1.0 / math.pi, math.cbrt((0.75 * math.pi) ** -2) / tabor)

    @property
    def tabor(self) -> float:
        """The Tabor parameter mu = (R W^2/(E*^2 h_0^3))^(1/3), dimensionless."""
        ratio = self.work_of_adhesion / self.contact_modulus
        return math.cbrt(self.radius * ratio**2 / self.range_of_attraction**3)

    @property
    def transition(self) -> float:
        """The parameter lambda = 1.127 mu of Maugis, dimensionless."""
        return LAMBDA_OVER_TABOR * self.tabor

    @property
    def theories(self) -> dict[Theory, Contact]:
        """The contacts by theory, in the order JKR, DMT, Maugis-Dugdale, all with the same R, E* and W.

        The first two have no range of the attraction; the last is this contact itself.
        """
        sphere = self.radius, self.contact_modulus, self.work_of_adhesion
        return {Theory.JKR: PowerLaw.sphere(*sphere), Theory.DMT: Dmt(*sphere), Theory.MAUGIS: self}

    def force(self, contact_radius: float) -> float:
        """Return F = pi W R N [force], positive in compression, N = A^3 - lambda [A S + C^2 phi]; a >= 0 [length].

        A and C are the radii of contact and ring over (pi W R^2/K)^(1/3), K = 4E*/3, S = sqrt(C^2-A^2), phi =
        arccos(A/C).

        Raises:
            ValueError: if a is negative.
        """
        return self._load * _reduced(self.transition, contact_radius / self._length)[0]

    def displacement(self, contact_radius: float) -> float:
        """Return d = (pi^2 W^2 R/K^2)^(1/3) D [length], positive in approach, D = A^2 - (4/3) lambda S.

        A = a/(pi W R^2/K)^(1/3) and C are the radii of contact and ring, K = 4E*/3, S = sqrt(C^2-A^2); a >= 0 [length].

        Raises:
            ValueError: if a is negative.
        """
        return self._length**2 / self.radius * _reduced(self.transition, contact_radius / self._length)[1]

    def critical_radius(self) -> float:
        """Return the contact radius a at which a fixed load pulls off, where F(a) is lowest [length].

        0 where F rises from first touch on, as at a small lambda.
        """
        return self._length * _lowest(self.transition, 0)

    def fixed_grips_radius(self) -> float:
        """Return the contact radius a at which a prescribed displacement pulls off, where d(a) is lowest [length].

        0 where d rises from first touch on.
        """
        return self._length * _lowest(self.transition, 1)


def _reduced(transition: float, a: float) -> tuple[float, float]:
    """Return N = F/(pi W R), positive in compression, and D, positive in approach, in the units of Maugis.

    Both are dimensionless, D is d/(pi^2 W^2 R/K^2)^(1/3) with K = 4E*/3.

    Args:
        transition: lambda of Maugis.
        a: contact radius A >= 0 in the unit of Maugis.

    Raises:
        ValueError: if a is negative.
    """
    u = _ring_width(transition, a)
    s = math.sqrt(u * (2.0 * a + u))
    return a**3 - transition * (a * s + (a + u) ** 2 * math.atan2(s, a)), a**2 - 4.0 / 3.0 * transition * s


def _adhesion_excess(transition: float, a: float, u: float) -> float:
    """Return (lambda/2) [A S + (C^2-2A^2) phi] + (4 lambda^2/3) [S phi - C + A] - 1 for C = a + u: rises with u.

    S = sqrt(C^2-A^2), phi = arccos(A/C). It is 0 where the adhesion equation of Maugis holds; all numbers are
    dimensionless, in his units.

    Args:
        transition: lambda of Maugis.
        a: contact radius A.
        u: width of the ring, C - A.
    """
    s = math.sqrt(u * (2.0 * a + u))
    phi = math.atan2(s, a)
    elastic = a * s + (s**2 - a**2) * phi
    return 0.5 * transition * elastic + 4.0 / 3.0 * transition**2 * (s * phi - u) - 1.0


def _ring_width(transition: float, a: float) -> float:
    """Return u = C - A >= 0 of one contact radius A, in the unit of Maugis; it is widest at A = 0.

    There the equation is quadratic in C, (pi/4) lambda C^2 + (4 lambda^2/3)(pi/2 - 1) C = 1; the root is written
    without a difference of large numbers.

    Args:
        transition: lambda of Maugis.
        a: contact radius A in the unit of Maugis.

    Raises:
        ValueError: if a is negative.
    """
    from scipy.optimize import brentq  # which takes longer to import than a small run

    if a < 0.0:
        raise ValueError(f"contact_radius must not be negative, got {a}")
    quadratic, linear = 0.25 * math.pi * transition, 4.0 / 3.0 * transition**2 * (0.5 * math.pi - 1.0)
    widest = 2.0 / (linear + math.sqrt(linear**2 + 4.0 * quadratic))
    if a == 0.0:
        return widest
    high = widest * (1.0 + 1e-9)  # above the root by more than round-off
    least = 4.0 * sys.float_info.epsilon  # relative tolerance that brentq accepts
    return float(brentq(lambda u: _adhesion_excess(transition, a, u), 0.0, high, xtol=1e-300, rtol=least))


@lru_cache(maxsize=256)
def _lowest(transition: float, component: int) -> float:
    """Return A of the lowest N (component 0) or D (1) of one lambda, between 0 and 1.5, in the unit of Maugis.

    It is 0 where N or D rises from A = 0 on. The largest such A is JKR's, (3/2)^(1/3) = 1.145. The result is cached.
    """
    from scipy.optimize import minimize_scalar

    def curve(a: float) -> float:
        """Return N or D, by `component`, at the contact radius A; dimensionless."""
        return _reduced(transition, a)[component]

    options = {"xatol": 1e-9}  # of A; the lowest value is off by the square of it
    minimum = minimize_scalar(curve, bounds=(0.0, 1.5), method="bounded", options=options)
    return float(minimum.x) if minimum.fun < curve(0.0) else 0.0


class Theory(StrEnum):
    """The zones of the map of adhesion, by the name of the theory."""

    APART = "no contact"
    RIGID = "rigid sphere (Bradley)"
    HERTZ = "Hertz"
    JKR = "JKR"
    DMT = "DMT"
    MAUGIS = "Maugis-Dugdale"


@dataclass(frozen=True)
class Verdict:
    """A zone of the map with the reason.

    Args:
        theory: the theory that holds.
        reason: one sentence with the deciding number.
    """

    theory: Theory
    reason: str


def of_tabor(tabor: float) -> Theory:
    """Return the theory for a Tabor parameter mu at any load: DMT below 0.1, JKR above 5, else Maugis-Dugdale.

    At 0.1 and 5 themselves it is Maugis-Dugdale.
    """
    if tabor < DMT_TABOR:
        return Theory.DMT
    return Theory.JKR if tabor > JKR_TABOR else Theory.MAUGIS


def valid_theory(tabor: float, reduced_load: float) -> Verdict:
    """Return the simplest valid theory with its reason, one sentence in the numbers of the contact.

    Tested in the order apart, rigid, Hertz, JKR, DMT, Maugis-Dugdale. With N = F/(pi W R): apart where the tension
    exceeds both the pull-off force of JKR, 1.5 pi W R, and that of Maugis-Dugdale, or of DMT for mu < 0.1; rigid where
    Hertz's compression under F + 2 pi W R, mu [(3 pi/4)(N + 2)]^(2/3) h_0, is below 0.05 h_0; Hertz where N > 0 and
    (A^3 - N)/N, the load that attraction adds by the theory that goes with mu, is below 0.05; then JKR for mu > 5,
    unless the tension exceeds its pull-off force, and DMT for mu < 0.1; in all other cases Maugis-Dugdale.

    Args:
        tabor: mu > 0, dimensionless.
        reduced_load: N, positive in compression, dimensionless.

    Raises:
        ValueError: if mu is not positive and finite, or the load not finite.
    """
    if not (math.isfinite(tabor) and tabor > 0.0 and math.isfinite(reduced_load)):
        raise ValueError(f"tabor must be positive and both numbers finite, got {tabor} and {reduced_load}")
    contacts, usual = MaugisDugdale.reduced(tabor).theories, of_tabor(tabor)
    jkr = contacts[Theory.JKR].pull_off_force()
    largest = max(jkr, contacts[Theory.DMT if usual is Theory.DMT else Theory.MAUGIS].pull_off_force())
    if reduced_load < -largest:
        tension, limit = apart(-reduced_load, largest)
        return Verdict(Theory.APART, f"a tension of {tension} πWR exceeds the pull-off force {limit} πWR")
    compression = tabor * math.cbrt(0.75 * math.pi * (reduced_load + 2.0)) ** 2
    if compression < RIGID_COMPRESSION:
        value, limit = apart(compression, RIGID_COMPRESSION, 2)
        return Verdict(Theory.RIGID, f"the compression is {value} h₀, less than {limit}: F_A = 2πWR")
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
