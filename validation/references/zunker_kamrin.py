"""The rule of `mdr` in LAMMPS for two equal elastic spheres that adhere, step by step, without its code.

Each sphere is pressed on a plane between them, by half of the overlap: by the method of dimensionality reduction

    g(x) = 2 R - 2 sqrt(R^2 - x^2),    F_0(a) = 2 E* [a g(a) - int_0^a g dx],    a_0 = g^-1(d)

of R and E* = E/(1 - nu^2) of one sphere. A radius a_A is kept, at most `cap` times the largest a_0. While d is the
largest so far or a_0 >= a_A there is no tension, F = F_0(a_0), and a_A becomes `factor` a_0; otherwise
F = F_0(a_A) - 2 E* a_A (g(a_A) - d), where a_A recedes to g(a) - d = sqrt(2 pi a gamma/E*), the rule of Hess. The
contact ends at d = 0. In LAMMPS factor = cap = 0.99, so that tension needs a step in which a_0 falls by more than 1 %:
below d = step/(1 - 0.99^2) = 50 steps. With a factor of 1 a_A stays, and tension begins 1 % below the largest a_0; the
authors' first rule had a cap of 1, too.
Sources: W. Zunker, K. Kamrin, J. Mech. Phys. Solids 183 (2024) 105492; LAMMPS pull requests 4409, 4522.
"""

import math
from dataclasses import dataclass

from validation.references.numerics import root


@dataclass
class Adhering:
    """Two spheres, untouched.

    Args:
        radius, modulus, gamma: R, E* and gamma of one sphere.
        factor, cap: 0.99, or 1.
        held: a_A.
        deepest: largest d.
    """

    radius: float
    modulus: float
    gamma: float
    factor: float = 0.99
    cap: float = 0.99
    held: float = 0.0
    deepest: float = 0.0

    def depth(self, a: float) -> float:
        """g(a)."""
        return 2.0 * (self.radius - math.sqrt(self.radius**2 - a**2))

    def pressed(self, a: float) -> float:
        """F_0(a)."""
        arc = a * math.sqrt(self.radius**2 - a**2) + self.radius**2 * math.asin(a / self.radius)
        return 2.0 * self.modulus * (a * (self.depth(a) - 2.0 * self.radius) + arc)

    def stretch(self, a: float) -> float:
        """sqrt(2 pi a gamma/E*)."""
        return math.sqrt(2.0 * math.pi * a * self.gamma / self.modulus)

    def force(self, overlap: float) -> float:
        """F at the next overlap of the pair."""
        d = 0.5 * overlap
        if d <= 0.0:
            self.held = 0.0
            return 0.0
        self.deepest = max(d, self.deepest)
        free, largest = (math.sqrt(self.radius**2 - (self.radius - 0.5 * one) ** 2) for one in (d, self.deepest))
        self.held = min(self.held, self.cap * largest)
        if d == self.deepest or free >= self.held:
            self.held = self.factor * free
            return self.pressed(free)
        if self.depth(self.held) - self.stretch(self.held) > d:
            self.held = root(lambda a: self.depth(a) - self.stretch(a) - d, free, self.held)
        return self.pressed(self.held) - 2.0 * self.modulus * self.held * (self.depth(self.held) - d)


def pull_off(contact: Adhering, deepest: float, step: float) -> float:
    """Largest tension where spheres are pressed to an overlap and drawn apart in steps."""
    count = round(deepest / step)
    return -min(contact.force(step * i) for i in [*range(count + 1), *range(count - 1, -1, -1)])


def restitution(contact: Adhering, mass: float, velocity: float, step: float) -> float:
    """e of an impact by velocity Verlet, with the effective mass of the pair."""
    d, v, force = 0.0, velocity, 0.0
    while d > 0.0 or v > 0.0:
        v -= 0.5 * step * force / mass
        d += step * v
        force = contact.force(d)
        v -= 0.5 * step * force / mass
    return -v / velocity
