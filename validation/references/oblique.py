"""Oblique impact of an elastic body of revolution with Coulomb's friction, by superposition of normal contacts.

Within Cattaneo and Mindlin's assumption a tangential force is a sum of normal forces (Jaeger 1993, Ciavarella 1998).
Let w(p) be the place of the contact point at which the ring that touches at the depth p has no shear: a line that ends
at (d, u), nowhere steeper than lambda = mu E*/G*. With kappa = G*/E*

    F_t(d, u) = kappa int_0^d F_n'(p) dw(p),    dw/dp = +-lambda where the ring slips

A way with |du| <= lambda dd adds to the line (no slip); any other cuts it where a ray of slope +-lambda from the new
end meets it, so that F_t = mu [F_n(d) - F_n(c)] of the outer rings and what was held within c. For an impact

    m d'' = -F_n(d),    u'' = -F_t (1/m + l^2/I),    l the lever arm of the contact point [length]

v_s'/v_s depends on chi = kappa (1 + m l^2/I)/2, psi = (kappa/mu)(v_s/v_n) and the profile alone: u = lambda y gives
y'' = -(2 chi/m) F_t/mu, y'(0) = psi v_n. Without slip (mu = inf) rings that leave take their shear along:

    F_t = 2 G* [a u - int_0^a w dx],    w(d) the u at which the ring was touched

Sliding throughout, v_s'/v_s = 1 - 4 chi/psi, is exact from psi = max(1, 4 chi - 1) on.
Sources: J. Jaeger, Arch. Appl. Mech. 63 (1993) 254; M. Ciavarella, Int. J. Solids Struct. 35 (1998) 2349; N. Maw, J. R.
Barber, J. N. Fawcett, Wear 38 (1976) 101; K. L. Johnson, Contact Mechanics (1985), 11.4. Any consistent units.
"""

import math
from dataclasses import dataclass, field
from typing import Any

from scipy.integrate import RK45, solve_ivp

from validation.references import impact
from validation.references.numerics import Function
from validation.references.relaxing import Power, sphere

TINY = 1e-300
"""In place of a d of 0, where a = 0."""
PARABOLOID = sphere(1.0)
Point = tuple[float, float, float]


@dataclass
class Superposition:
    """A contact along any path of (d, u), from (0, 0).

    Args:
        normal: F_n(d) [force], 0 for d <= 0.
        steepest: lambda = mu E*/G* = mu/kappa [1].
        ratio: kappa [1].
        points: (p, w, F_t within p) of the line, with rising p.
    """

    normal: Function
    steepest: float = 1.0
    ratio: float = 1.0
    points: list[Point] = field(default_factory=lambda: [(0.0, 0.0, 0.0)])

    def after(self, d: float, u: float) -> tuple[int, list[Point]]:
        """How many points a straight way to (d, u) leaves, and those that it adds, the last with F_t [force]."""
        points, count = self.points, len(self.points)
        while count and abs(u - points[count - 1][1]) > self.steepest * (d - points[count - 1][0]):
            count -= 1
        if not count:  # all rings slip
            side = math.copysign(self.steepest, u - points[0][1])
            return 0, [(0.0, u - side * d, 0.0), (d, u, self.ratio * side * self.normal(d))]
        p, w, held = points[count - 1]
        added = []
        if count < len(points):
            slope = (points[count][1] - w) / (points[count][0] - p)
            rays = [(self.steepest * (d - p) - side * (u - w), self.steepest - side * slope) for side in (1.0, -1.0)]
            way = min(inside / closes for inside, closes in rays if closes > 0.0)
            held += self.ratio * slope * (self.normal(p + way) - self.normal(p))
            p, w = p + way, w + slope * way
            added = [(p, w, held)]
        if d > p:
            held += self.ratio * (u - w) / (d - p) * (self.normal(d) - self.normal(p))
        return count, [*added, (d, u, held)]

    def move(self, d: float, u: float) -> float:
        """F_t [force] after a straight way to (d, u)."""
        count, added = self.after(d, u)
        self.points[count:] = added
        return added[-1][2]


def rebound(psi: float, chi: float, normal: Function, lasts: float, steps: int = 1000) -> float:
    """v_s'/v_s of an impact of m = v_n = 1.

    Args:
        psi: (kappa/mu)(v_s/v_n).
        chi: kappa (1 + m l^2/I)/2.
        normal: F_n(d) [force], 0 for d <= 0.
        lasts: about how long the impact is [time].
        steps: of an impact; w is straight within each, an error of the order of 1/steps^2.
    """
    contact = Superposition(normal)

    def change(_: float, y: Any) -> list[float]:
        d, u = float(y[0]), float(y[2])
        force = contact.after(d, u)[1][-1][2] if d > 0.0 else 0.0
        return [y[1], -normal(d), y[3], -2.0 * chi * force]

    motion = RK45(change, 0.0, [0.0, 1.0, 0.0, psi], math.inf, max_step=lasts / steps, rtol=1e-9, atol=1e-12)
    motion.step()
    while motion.y[0] > 0.0:
        contact.move(float(motion.y[0]), float(motion.y[2]))
        motion.step()
    return float(motion.y[3] / psi)


def of_power(psi: float, chi: float, body: Power = PARABOLOID, steps: int = 1000) -> float:
    """The same of f(r) = c r^n, in closed form while the contact slides throughout."""
    if psi >= max(1.0, 4.0 * chi - 1.0):
        return 1.0 - 4.0 * chi / psi
    lasts = impact.elastic(body, 1.0, 1.0, 1.0).contact_time
    return rebound(psi, chi, lambda d: body.volume(body.radius(d)), lasts, steps)


def sticking(chi: float, body: Power = PARABOLOID) -> float:
    """v_s'/v_s without slip, of f(r) = c r^n.

    d(t) is that of a normal impact, the same forwards and backwards: the ring at the edge at t was touched at
    T - t, T the duration. With S = int_0^a w dx the first half has S' = u a', the second that S(T - t).
    """
    half = 0.5 * impact.elastic(body, 1.0, 1.0, 1.0).contact_time

    def change(t: float, y: Any) -> list[float]:
        a = body.radius(y[0])
        held = y[4] if t <= half else inwards.sol(2.0 * half - t)[4]
        growth = a * y[1] / (body.exponent * max(y[0], TINY))
        return [y[1], -body.volume(a), y[3], -4.0 * chi * (a * y[2] - held), y[2] * growth]

    given = {"method": "DOP853", "rtol": 1e-10, "atol": 1e-13, "dense_output": True}
    inwards = solve_ivp(change, (0.0, half), [0.0, 1.0, 0.0, 1.0, 0.0], **given)
    return float(solve_ivp(change, (half, 2.0 * half), inwards.y[:, -1], **given).y[3, -1])
