"""Cattaneo and Mindlin: two spheres under a normal load N, displaced tangentially by u, with Coulomb's friction.

    F_x = mu N [1 - (1 - u/u*)^(3/2)],    c/a = (1 - u/u*)^(1/2),    u* = mu (E*/G*) d

The contact sticks up to c and slips between c and the edge. After a reversal at u_m the curve returns at twice its
size, F = F_m - 2 T((u_m - u)/2) (Mindlin and Deresiewicz), and where it meets an earlier branch it continues along that
(Masing's rules, valid under a constant N). The stick zone is itself a smaller contact: that holds for any shape
(Ciavarella, Jaeger), and in the method of dimensionality reduction for each spring.

Sources: K. L. Johnson, Contact Mechanics (1985), sections 7.2 and 7.4; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20
(1953) 327; V. L. Popov, M. Hess, Method of Dimensionality Reduction (2015), chapter 5. Any consistent units.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise


def sliding_displacement(friction: float, ratio: float, displacement: float) -> float:
    """Return u* = mu d/(G*/E*) [length], where full slip begins.

    mu is `friction`, G*/E* `ratio`, both dimensionless, and d the normal `displacement` [length].
    """
    return friction * displacement / ratio


def _amplitudes(positions: Sequence[float]) -> list[list[float]]:
    """Return a list for each position: the first remembered turn, then half of each later distance [length].

    A turn is a position at which the motion reverses. Later distances are those from turn to turn and from the last
    turn to the position, with their signs. Without a turn the list has the position alone. A turn and the one before it
    are forgotten where the path comes back to the latter, the first one where it reaches its mirror image, but for
    round-off.

    Args:
        positions: of the path, which begins at 0 [length].
    """
    turns: list[float] = []
    current, direction, amplitudes = 0.0, 0.0, []
    for position in positions:
        if position != current:
            onwards = math.copysign(1.0, position - current)
            if direction and onwards != direction:
                turns.append(current)
            direction, current, round_off = onwards, position, 1e-9 * abs(position)
            while turns and direction * (position - (turns[-2] if len(turns) > 1 else -turns[-1])) >= -round_off:
                del turns[-2:]
        stops = [*turns, position]
        amplitudes.append([stops[0], *(0.5 * (b - a) for a, b in pairwise(stops))])
    return amplitudes


def mindlin_path(positions: Sequence[float], normal_force: float, friction: float, sliding: float) -> list[float]:
    """Return F_x [force], with the sign of u in loading, at positions reached in turn from 0 under a constant N.

    One value for each position, [] without any. T(u) = mu N (1 - (1 - |u|/u*)^(3/2)) sign(u), of spheres, is the
    initial loading, ±mu N from |u| = u* on; over the turns u_1 ... u_n that count F_x = T(u_1) + 2 T((u_2 - u_1)/2) +
    ... + 2 T((u - u_n)/2). A turn and the one before it count no more once the path comes back to the latter, nor the
    first turn once the path reaches -u_1: closed loops leave no trace.

    Args:
        positions: u [length].
        normal_force: N [force].
        friction: mu.
        sliding: u* > 0 [length], from which on all slips.

    Raises:
        ZeroDivisionError: u* = 0, with any position.
    """

    def force(distance: float) -> float:
        """Return T(u) [force] of a displacement u from 0 [length], with its sign; ±mu N from |u| = u* on."""
        left = max(1.0 - abs(distance) / sliding, 0.0)
        return friction * normal_force * math.copysign(1.0 - left**1.5, distance)

    return [force(first) + sum(2.0 * force(half) for half in later) for first, *later in _amplitudes(positions)]


def mindlin_cycle_energy(amplitude: float, normal_force: float, friction: float, sliding: float) -> float:
    """Return the energy [force length] that a closed cycle u_m -> -u_m -> u_m dissipates under a constant load, >= 0.

    By Masing's rules oint F_x du = 8 int_0^u_m T du - 4 u_m T(u_m), with T = mu N (1 - (1 - u/u*)^(3/2)) and s = c/a at
    u_m

        W = (4/5) mu N u* (1 - s)^3 (1 + 3 s + s^2),    s^2 = 1 - u_m/u*,    for u_m <= u*,
        W = 4 mu N (u_m - (4/5) u*)                                          beyond, where all slips.

    For small amplitudes W = mu N u_m^3/(2 u*^2), where the difference of the integrals would lose digits.
    By the force amplitude F = mu N (1 - s^3) this is Mindlin and Deresiewicz's

        W = (24/5) mu N u* {1 - s^5 - (5/6) (1 - s^3) (1 + s^2)},
        (24/5) mu N u* = 9 mu^2 N^2/(10 a) [(2 - nu_1)/G_1 + (2 - nu_2)/G_2],    u* = (3 mu N/16 a) [the same].

    Args:
        amplitude: u_m >= 0 [length].
        normal_force: N [force].
        friction: mu.
        sliding: u* > 0 [length].

    Raises:
        ZeroDivisionError: u* = 0.

    Source: R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327; K. L. Johnson, Contact Mechanics (1985),
    Eq. (7.57).

        >>> round(mindlin_cycle_energy(0.4, 1.0, 1.0, 1.0), 6), round(mindlin_cycle_energy(1.5, 1.0, 1.0, 1.0), 6)
        (0.035948, 2.8)
    """
    (stick,) = mindlin_stick_path([amplitude], 1.0, sliding)
    slipping = min(amplitude / sliding, 1.0) / (1.0 + stick)  # 1 - s, with all its digits
    partial = 0.8 * sliding * slipping**3 * (1.0 + 3.0 * stick + stick**2)
    return friction * normal_force * (partial + 4.0 * max(amplitude - sliding, 0.0))


def mindlin_stick_path(positions: Sequence[float], contact_radius: float, sliding: float) -> list[float]:
    """Return the radius c of the stick zone [length] at each of the positions of a path from 0 under a constant load.

    In loading c² = a² (1 - |u|/u*). After a reversal at u_m all sticks again, c = a, and then c² = a² (1 - |u -
    u_m|/2u*), until the path comes back to the turn before u_m, from which on c is as without both; c is 0 in full
    slip. [] without positions.

    Args:
        positions: u, reached one after the other [length].
        contact_radius: a [length].
        sliding: u* [length], from which on all slips.

    Raises:
        ZeroDivisionError: u* = 0, with any position.
    """
    return [contact_radius * math.sqrt(max(1.0 - abs(half[-1]) / sliding, 0.0)) for half in _amplitudes(positions)]
