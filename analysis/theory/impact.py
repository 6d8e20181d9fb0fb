"""Impact of an elastic body of revolution without slip, and of a Kelvin-Voigt body, on a plane.

With the force F = d^p of z ~ r^n, p = 1 + 1/n, at unit mass and velocity. Without slip springs that touch are drawn
along by u, each from where the body was then, with G*/E* in chi and T the tangential force over G*/E*:

    d'' = -d^p,    u'' = -2 chi T,    T = int p d^(1/n) du (loading),    T = p d^(1/n) u - B(d) (unloading)

A spring that leaves takes its energy along; B(d) is that of the loading at the same d, passed at the mirrored time
(N. Maw, J. R. Barber, J. N. Fawcett, Wear 38 (1976) 101, of a sphere with slip). Springs with dashpots of a retardation
time tau push with u + tau u' (V. L. Popov, M. Hess, Method of Dimensionality Reduction, 2015, chapter 7):

    d'' = -(d^p + tau p d^(p-1) d') (approach),    d'' = -(d + tau d')^p (rebound),    until d + tau d' = 0

LAMMPS's `damping viscoelastic` has the force of the approach also in the rebound, until d = 0, or with `limit_damping`
until d + tau p d' = 0, where it becomes tensile.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

Rates = Callable[[float, Any], list[float]]


def full_stick(exponent: float, chi: float) -> float:
    """Return v_s'/v_s, the tangential velocity of the contact point after an impact without slip over that before it.

    Args:
        exponent: n of z ~ r^n, 1 or more.
        chi: (G*/E*) (1 + m l^2/I)/2, of the mass m, lever arm l and moment of inertia I.
    """
    power = 1.0 + 1.0 / exponent

    def stiffness(d: float) -> float:
        """Return p d^(1/n), dT/du, at a displacement d >= 0; 0 below."""
        return float(power * max(d, 0.0) ** (power - 1.0))

    def loading(_: float, y: Any) -> list[float]:
        """Return the rates of (d, d', u, u', T)."""
        return [y[1], -(max(y[0], 0.0) ** power), y[3], -2.0 * chi * y[-1], stiffness(y[0]) * y[3]]

    pressed = _motion(loading, [0.0, 1.0, 0.0, 1.0, 0.0], lambda y: y[1])
    last = float(pressed.t[-1])

    def unloading(time: float, y: Any) -> list[float]:
        """Return the rates of (u, u')."""
        d, _, place, _, force = pressed.sol(last - time)
        return [y[1], -2.0 * chi * (force + stiffness(d) * (y[0] - place))]

    return float(_motion(unloading, pressed.y[[2, 3], -1], lambda _: 1.0, time=last).y[1, -1])


def restitution(exponent: float, time: float, ends: float | None = None, accuracy: float | None = None) -> float:
    """Return v'/v of a Kelvin-Voigt body z ~ r^n after an impact, falling from 1 to 0 with a rising retardation time.

    Args:
        exponent: n, 1 or more.
        time: retardation time > 0, in the unit of `unit_time`.
        ends: None, or of LAMMPS's `damping viscoelastic` the end of the contact, d + ends tau p d' = 0: 0, or 1 with
            `limit_damping`.
        accuracy: tolerance of the equation of motion; None: 1e-11.
    """
    power = 1.0 + 1.0 / exponent

    def approach(_: float, y: Any) -> list[float]:
        """Return the rates of (d, d')."""
        d = max(y[0], 0.0)
        return [y[1], -(d**power) - time * power * d ** (power - 1.0) * y[1]]

    def rebound(_: float, y: Any) -> list[float]:
        """Return the rates of (d, d')."""
        return [y[1], -(max(y[0] + time * y[1], 0.0) ** power)]

    deepest = _motion(approach, [0.0, 1.0], lambda y: y[1], accuracy).y[0, -1]
    last = time if ends is None else ends * power * time
    rates = rebound if ends is None else approach
    return -float(_motion(rates, [deepest, 0.0], lambda y: y[0] + last * y[1], accuracy).y[1, -1])


@cache
def retardation(exponent: float, wanted: float) -> float:
    """Return the retardation time, in the unit of `unit_time`, of a Kelvin-Voigt body z ~ r^n with this restitution.

    Args:
        exponent: n, 1 or more.
        wanted: v'/v, greater than 0 and less than 1.
    """
    from scipy.optimize import brentq

    ends = 0.5**2 * (1.0 - wanted), 1.0 / wanted**2
    return float(brentq(lambda time: restitution(exponent, time) - wanted, *ends))


def nearest(times: Sequence[float], ends: float, share: float = 1e-3) -> tuple[float, list[float], list[float]]:
    """Return (factor, v'/v at each velocity with it, v'/v of the Kelvin-Voigt sphere there).

    The factor is that on eta = 2E* tau/m of LAMMPS's `damping viscoelastic` with the smallest largest difference.

    Args:
        times: retardation time tau > 0 at each velocity v, in the unit of `unit_time`, which falls with v^(1/5).
        ends: of the contact, as of `restitution`.
        share: accuracy of the factor.
    """
    from scipy.optimize import minimize_scalar

    def reached(factor: float, limit: float | None = ends) -> list[float]:
        """Return v'/v at each velocity with a factor on eta; with the limit None of the sphere."""
        return [restitution(2.0, factor * time, limit, 0.5 * share**2) for time in times]

    def missed(factor: float) -> float:
        """Return the largest difference at a factor on eta."""
        return max(abs(e - exact) for e, exact in zip(reached(factor), wanted, strict=True))

    wanted = reached(1.0, None)
    factor = minimize_scalar(missed, bounds=(0.0, 2.0), method="bounded", options={"xatol": share}).x
    return float(factor), reached(factor), wanted


def unit_time(exponent: float, force: float, mass: float, velocity: float) -> float:
    """Return the time D/v [time], D the displacement [length] where F(D) D = m v^2.

    Args:
        exponent: n of z ~ r^n.
        force: F at the displacement 1 [force].
        mass: m of the body [mass].
        velocity: v of the impact [length/time].
    """
    return float((mass * velocity**2 / force) ** (1.0 / (2.0 + 1.0 / exponent)) / velocity)


def _motion(
    rates: Rates,
    start: Sequence[float],
    ends: Callable[[Any], float],
    accuracy: float | None = None,
    time: float = math.inf,
) -> Any:
    """Return scipy's solution from `start` until `ends`, a function of the state, is 0, or until a time."""
    from scipy.integrate import solve_ivp

    def event(_: float, y: Any) -> float:
        """Return what is 0 at the end."""
        return ends(y)

    event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined] # scipy reads attributes of a function
    return solve_ivp(
        rates,
        (0.0, time),
        start,
        "DOP853",
        events=event,
        dense_output=True,
        **dict.fromkeys(("rtol", "atol"), accuracy or 1e-11),
    )
