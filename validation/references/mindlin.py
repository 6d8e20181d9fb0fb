"""Cattaneo and Mindlin on the first way out, after a cycle and under a raised load, and the shear of the body.

    F_x = mu N [1 - (1 - u/u*)^(3/2)],    c/a = (1 - u/u*)^(1/2),    u* = mu (E*/G*) d

Sources: K. L. Johnson, Contact Mechanics (1985), sections 7.2 and 7.4; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20
(1953) 327. Any consistent units.
"""

import numpy as np

from validation.references.interaction import Floats


def mindlin_force(place: Floats | float, normal_force: float, friction: float, sliding: float) -> Floats:
    """Return F_x on the first way out [force], mu N from u* on, odd in u; shape of `place`.

    Args:
        place: u [length].
        normal_force: N [force].
        friction: mu.
        sliding: u* [length].
    """
    left = np.maximum(1.0 - np.abs(place) / sliding, 0.0)
    return np.asarray(friction * normal_force * np.sign(place) * (1.0 - left**1.5))


def mindlin_stick_radius(place: Floats | float, contact_radius: float, sliding: float) -> Floats:
    """Return c on the first way out [length], 0 from u* on; arguments as of `mindlin_force`."""
    return np.asarray(contact_radius * np.sqrt(np.maximum(1.0 - np.abs(place) / sliding, 0.0)))


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
    outer = np.sqrt(np.maximum(1.0 - (places / contact_radius) ** 2, 0.0))
    inner = np.sqrt(np.maximum(stick_radius**2 - places**2, 0.0)) / contact_radius
    return friction * peak_pressure * (outer - inner)


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
