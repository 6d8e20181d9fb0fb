"""Cattaneo and Mindlin: two spheres pressed together by N and displaced along each other by u, with Coulomb's friction.

    F_x = mu N [1 - (1 - u/u*)^(3/2)],    c/a = (1 - u/u*)^(1/2),    u* = mu (E*/G*) d

From the edge inwards the contact slips, out to c it sticks. After a reversal at u_m the same curve runs back at twice
its size, F = F_m - 2 T((u_m - u)/2) (Mindlin and Deresiewicz), and where it meets the way by which it came, it goes on
along that (Masing's rules, which hold under a constant N). A body's stick zone is a smaller contact of its own: that
holds for any shape (Ciavarella, Jaeger), and in the method of dimensionality reduction spring by spring.

Sources: K. L. Johnson, Contact Mechanics (1985), sections 7.2 and 7.4; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20
(1953) 327; V. L. Popov, M. Hess, Method of Dimensionality Reduction (2015), chapter 5. Any consistent units.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from contact1d.analysis.theory.adhesive_pair import Floats


def stiffness_ratio(moduli: tuple[float, float], poisson_ratios: tuple[float, float]) -> float:
    """Return G*/E*, 1/G* = sum (2 - nu)/4G, 1/E* = sum (1 - nu^2)/E, G = E/2(1 + nu); 2(1 - nu)/(2 - nu) for equals.

    Args:
        moduli: E of both bodies [stress].
        poisson_ratios: nu of both bodies [1].
    """
    normal = tangential = 0.0
    for modulus, poisson in zip(moduli, poisson_ratios, strict=True):
        shear_modulus = modulus / (2.0 * (1.0 + poisson))
        normal += (1.0 - poisson**2) / modulus
        tangential += (2.0 - poisson) / (4.0 * shear_modulus)
    return normal / tangential


def sliding_displacement(friction: float, ratio: float, displacement: float) -> float:
    """Return u* = mu d/(G*/E*) [length], from which on all slips: mu `friction`, G*/E* `ratio`, d `displacement`."""
    return friction * displacement / ratio


def mindlin_force(place: Floats | float, normal_force: float, friction: float, sliding: float) -> Floats:
    """Return F_x on the first way out [force], mu N from u* on, odd in u; shape of `place`.

    Args:
        place: u [length].
        normal_force: N [force].
        friction: mu.
        sliding: u* [length].
    """
    u = np.asarray(place, dtype=np.float64)
    left = np.maximum(1.0 - np.abs(u) / sliding, 0.0)
    return np.asarray(friction * normal_force * np.sign(u) * (1.0 - left**1.5))


def mindlin_stick_radius(place: Floats | float, contact_radius: float, sliding: float) -> Floats:
    """Return c on the first way out [length], 0 from u* on; arguments as of `mindlin_force`."""
    left = np.maximum(1.0 - np.abs(np.asarray(place, dtype=np.float64)) / sliding, 0.0)
    return np.asarray(contact_radius * np.sqrt(left))


def _turns(places: Sequence[float]) -> list[list[float]]:
    """Return at each place the turns that are still remembered there, the last one last; none on the first way out.

    A turn is forgotten where the way goes beyond the one before it, or of the first one beyond its mirror image.
    """
    turns: list[float] = []
    here, direction, found = 0.0, 0.0, []
    for place in places:
        if place != here:
            onwards = math.copysign(1.0, place - here)
            if direction and onwards != direction:
                turns.append(here)
            direction, here = onwards, place
            while turns and (place - (turns[-2] if len(turns) > 1 else -turns[-1])) * direction > 0.0:
                del turns[-2:]
        found.append(list(turns))
    return found


def mindlin_path(places: Sequence[float], normal_force: float, friction: float, sliding: float) -> list[float]:
    """Return F_x [force] at each of the places, reached one after the other from 0 under a constant load.

    From turn to turn T(u_1) + 2 T((u_2 - u_1)/2) + ... Arguments as of `mindlin_force`.
    """

    def way(u: float) -> float:
        return float(mindlin_force(u, normal_force, friction, sliding))

    found = []
    for place, turns in zip(places, _turns(places), strict=True):
        stops = [*turns, place]
        found.append(way(stops[0]) + sum(2.0 * way(0.5 * (b - a)) for a, b in pairwise(stops)))
    return found


def mindlin_stick_path(places: Sequence[float], contact_radius: float, sliding: float) -> list[float]:
    """Return c [length] at each of the places, as `mindlin_path` goes: after a turn all sticks again.

    Arguments as of `mindlin_stick_radius`.
    """
    found = []
    for place, turns in zip(places, _turns(places), strict=True):
        way = 0.5 * (place - turns[-1]) if turns else place
        found.append(float(mindlin_stick_radius(way, contact_radius, sliding)))
    return found


def mindlin_loop_area(amplitude: float, normal_force: float, friction: float, sliding: float) -> float:
    """Return the energy that a cycle between u_m and -u_m dissipates [force length]: 8 int_0^u_m T du - 4 u_m T(u_m).

    Args:
        amplitude: u_m <= u* [length].
        normal_force, friction, sliding: as of `mindlin_force`.
    """
    left = max(1.0 - amplitude / sliding, 0.0)
    whole = friction * normal_force * (amplitude - 0.4 * sliding * (1.0 - left**2.5))
    return float(8.0 * whole - 4.0 * amplitude * friction * normal_force * (1.0 - left**1.5))


def mindlin_shear(
    places: Floats, contact_radius: float, stick_radius: float, friction: float, peak_pressure: float
) -> Floats:
    """Return q(r) = mu p0 [sqrt(1 - r^2/a^2) - (c/a) sqrt(1 - r^2/c^2)] of the first way out [stress], 0 beyond a.

    Args:
        places: r [length].
        contact_radius, stick_radius: a and c [length].
        friction: mu.
        peak_pressure: p0 [stress].
    """
    r = np.asarray(places, dtype=np.float64)
    outer = np.sqrt(np.maximum(1.0 - (r / contact_radius) ** 2, 0.0))
    inner = np.sqrt(np.maximum(stick_radius**2 - r**2, 0.0)) / contact_radius
    return np.asarray(friction * peak_pressure * (outer - inner))


def raised_load_force(
    place: float, turn: float, loads: tuple[float, float], slidings: tuple[float, float], friction: float
) -> float:
    """Return F_x where the load was raised from N1 to N2 at u_1, and the way went on to u (Mindlin and Deresiewicz).

    What slipped before sticks anew, and slip begins at the new edge: F = T_1(u_1) + T_2(u - u_1), until it is back at
    the old one, at u - u_1 = u*_2 - u*_1; from there on F = T_2(u), as if N2 had been there from the beginning.

    Args:
        place: u >= u_1 [length].
        turn: u_1 <= u*_1 [length], where the load was raised.
        loads: N1 < N2 [force].
        slidings: u* under each [length].
        friction: mu.
    """
    if place - turn >= slidings[1] - slidings[0]:
        return float(mindlin_force(place, loads[1], friction, slidings[1]))
    first = float(mindlin_force(turn, loads[0], friction, slidings[0]))
    return first + float(mindlin_force(place - turn, loads[1], friction, slidings[1]))
