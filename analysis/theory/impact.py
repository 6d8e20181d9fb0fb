"""Oblique impact without slip: the contact point of an elastic body of revolution that sticks to a plane.

With the force F = d^p of z ~ r^n, p = 1 + 1/n, at unit mass and velocity, and G*/E* taken into the tangential force T,
springs that touch are drawn along by u, each from where the body was then:

    d'' = -d^p,    u'' = -2 chi T,    T = int p d^(1/n) du (loading),    T = p d^(1/n) u - B(d) (unloading)

A spring that leaves takes its energy along; B(d) is that of the loading at the same d, passed at the mirrored time
(N. Maw, J. R. Barber, J. N. Fawcett, Wear 38 (1976) 101, of a sphere with slip).
"""

from __future__ import annotations


def full_stick(exponent: float, chi: float) -> float:
    """Return v_s'/v_s, the tangential velocity of the contact point after an impact without slip over that before it.

    Args:
        exponent: n of z ~ r^n, 1 or more.
        chi: (G*/E*) (1 + m l^2/I)/2, of the mass m, lever arm l and moment of inertia I.
    """
    from scipy.integrate import solve_ivp

    power, exact = 1.0 + 1.0 / exponent, dict.fromkeys(("rtol", "atol"), 1e-10)

    def stiffness(d: float) -> float:
        """Return p d^(1/n), dT/du, at a displacement d >= 0; 0 below."""
        return float(power * max(d, 0.0) ** (power - 1.0))

    def loading(_: float, y: list[float]) -> list[float]:
        """Return the rates of (d, d', u, u', T)."""
        d, velocity, _, slip, force = y
        return [velocity, -(max(d, 0.0) ** power), slip, -2.0 * chi * force, stiffness(d) * slip]

    def rests(_: float, y: list[float]) -> float:
        """Return d', 0 where the body turns."""
        return y[1]

    rests.terminal = True  # type: ignore[attr-defined]
    pressed = solve_ivp(
        loading, (0.0, 2.0 * power), [0.0, 1.0, 0.0, 1.0, 0.0], events=rests, dense_output=True, **exact
    )
    last = float(pressed.t[-1])

    def unloading(time: float, y: list[float]) -> list[float]:
        """Return the rates of (u, u')."""
        d, _, place, _, force = pressed.sol(last - time)
        return [y[1], -2.0 * chi * (force + stiffness(d) * (y[0] - place))]

    return float(solve_ivp(unloading, (0.0, last), pressed.y[[2, 3], -1], **exact).y[1, -1])
