"""Which theory of an adhesive sphere holds: Tabor's mu = (R W^2/(E*^2 z_0^3))^(1/3) and the load F/(pi W R) decide.

mu is the elastic stretch of the surfaces before they part over the range z_0 of the attraction. The map is that of
K. L. Johnson, J. A. Greenwood, J. Colloid Interface Sci. 192 (1997) 326, after D. Tabor, ibid. 58 (1977) 2: the zones
are theirs. Their figure was not at hand: each boundary is a criterion written out below, not read off it, and how
small is negligible is a convention in all but one. The lines mu = 5 (JKR) and mu = 0.1 (DMT) are common usage and
independent of the load, which the criteria behind them are not. What they cost, against Maugis and Dugdale: at mu = 5
JKR's contact radius is 0.7 % too large at F = 0 and its pull-off 0.3 % too small; at mu = 0.1 DMT's radius is 6 % too
small at F = 0 (8 % at -pi W R, 2 % at 40 pi W R) and its pull-off 3 % too large. The rest is computed, with 5 % as
negligible: the compression over z_0 for the rigid sphere, the load that attraction adds over F for Hertz. F positive in
compression.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

from contact1d.analysis.theory.maugis_dugdale import (
    MaugisDugdale,
    dmt_contact_radius,
    jkr_contact_radius,
    maugis_parameter_of_tabor,
)

JKR_TABOR = 5.0
"""JKR above: the edge is stretched by Delta_l = sqrt(2 pi a W/E*), 3.9 mu z_0 at F = 0, which is 20 z_0: the range is
negligible. A convention."""
DMT_TABOR = 0.1
"""DMT below: the same stretch, for DMT's a, is less than z_0/3 at F = 0: attraction deforms little. A convention."""
RIGID_COMPRESSION = 0.05
"""Rigid (Bradley) below: Hertz's compression under F + 2 pi W R over z_0. The 5 % is a convention."""
HERTZ_ADHESION_SHARE = 0.05
"""Hertz below: the load that attraction adds, (4 E* a^3/3R - F)/F. The 5 % is a convention. For DMT it means
F/(pi W R) > 40, for JKR F/(pi W R) > 2520: its attraction grows with the contact. A radius is then 1.6 % off."""
JKR_PULL_OFF = 1.5
"""F_A/(pi W R) of JKR: the exact limit, not a convention."""


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


def tabor_number(radius: float, contact_modulus: float, work_of_adhesion: float, range_of_attraction: float) -> float:
    """Return mu = (R W^2/(E*^2 z_0^3))^(1/3) [1].

    Args:
        radius: effective R [length].
        contact_modulus: E* [stress].
        work_of_adhesion: W = 2 gamma [force/length].
        range_of_attraction: z_0, the force-free distance of two surfaces [length]; for another law than that of
            Lennard-Jones a distance of the order of W over the largest tension, which moves mu by a factor near 1.

    Raises:
        ValueError: if one of them is not positive.
    """
    if not min(radius, contact_modulus, work_of_adhesion, range_of_attraction) > 0.0:
        raise ValueError("radius, contact_modulus, work_of_adhesion and range_of_attraction must be positive")
    return math.cbrt(radius * work_of_adhesion**2 / (contact_modulus**2 * range_of_attraction**3))


def rigid_compression(tabor: float, reduced_load: float) -> float:
    """Return d/z_0 = mu [(3 pi/4)(F/(pi W R) + 2)]^(2/3), Hertz's compression under F + 2 pi W R.

    Args:
        tabor: mu [1].
        reduced_load: F/(pi W R) >= -2 [1].
    """
    return tabor * math.cbrt(0.75 * math.pi * (reduced_load + 2.0)) ** 2


def adhesion_share(tabor: float, reduced_load: float) -> float:
    """Return (A^3 - N)/N, the load that attraction adds to N = F/(pi W R) > 0, over N.

    A, which is a over (pi W R^2/K)^(1/3), is that of the theory that goes with mu: DMT, Maugis and Dugdale, or JKR.

    Args:
        tabor: mu [1].
        reduced_load: F/(pi W R) > 0 [1].
    """
    if tabor < DMT_TABOR:
        radius = dmt_contact_radius(reduced_load)
    elif tabor > JKR_TABOR:
        radius = jkr_contact_radius(reduced_load)
    else:
        radius = MaugisDugdale(maugis_parameter_of_tabor(tabor)).contact_radius(reduced_load)
    return (radius**3 - reduced_load) / reduced_load


def valid_theory(tabor: float, reduced_load: float) -> Verdict:
    """Return the simplest theory that holds; asked in the order apart, rigid, Hertz, JKR, DMT, Maugis and Dugdale.

    Args:
        tabor: mu > 0 [1].
        reduced_load: F/(pi W R), positive in compression [1].

    Raises:
        ValueError: if mu is not positive and finite, or the load not finite.
    """
    if not (math.isfinite(tabor) and tabor > 0.0 and math.isfinite(reduced_load)):
        raise ValueError(f"tabor must be positive and both numbers finite, got {tabor} and {reduced_load}")
    pull_off = _pull_off(tabor)
    if reduced_load < -pull_off:
        return Verdict(
            Theory.APART, f"a tension of {-reduced_load:.3g} πWR exceeds the pull-off force {pull_off:.3g} πWR"
        )
    compression = rigid_compression(tabor, reduced_load)
    if compression < RIGID_COMPRESSION:
        return Verdict(
            Theory.RIGID, f"the compression is {compression:.2g} z₀, less than {RIGID_COMPRESSION}: F_A = 2πWR"
        )
    if reduced_load > 0.0 and (share := adhesion_share(tabor, reduced_load)) < HERTZ_ADHESION_SHARE:
        return Verdict(Theory.HERTZ, f"attraction adds {share:.1%} to the load, less than {HERTZ_ADHESION_SHARE:.0%}")
    if tabor > JKR_TABOR and reduced_load >= -JKR_PULL_OFF:
        return Verdict(Theory.JKR, f"Tabor's number {tabor:.3g} is above {JKR_TABOR:g}: the range is negligible")
    if tabor < DMT_TABOR:
        return Verdict(Theory.DMT, f"Tabor's number {tabor:.3g} is below {DMT_TABOR:g}: attraction deforms little")
    return Verdict(Theory.MAUGIS, _transition_reason(tabor))


def _pull_off(tabor: float) -> float:
    """Return F_A/(pi W R) of the theory that goes with mu: 2 below the zone of Maugis and Dugdale, theirs above."""
    if tabor < DMT_TABOR:
        return 2.0
    return max(JKR_PULL_OFF, MaugisDugdale(maugis_parameter_of_tabor(tabor)).pull_off_load())


def _transition_reason(tabor: float) -> str:
    """Return why neither limit holds."""
    if tabor > JKR_TABOR:
        return f"the tension exceeds JKR's pull-off force, {JKR_PULL_OFF} πWR, and not yet that of a finite range"
    return f"Tabor's number {tabor:.3g} is between {DMT_TABOR:g} and {JKR_TABOR:g}: neither DMT nor JKR"
