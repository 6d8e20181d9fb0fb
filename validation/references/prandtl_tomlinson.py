"""One particle on a periodic row, pulled by a spring: Prandtl and Tomlinson, with the corrugation that there is.

A particle pressed by F_N onto a rigid row of spacing s stands at each x as low as it can,

    U(x) = min_z Σ_j V(√((x − j s)² + z²)) + F_N z

and slides by m x″ = −U′(x) + k (v t − x) − γ (x′ − v), k = 1/(1/k_c + 1/k_t). With η = max(−U″)/k it sticks and slips
where η > 1. For slow drives it follows a minimum of U + k (x − X)²/2 until that vanishes, and comes to rest in the next
one: ⟨F⟩ is then the energy lost in that over s. A sinusoid has ⟨F⟩/F_max = 0, 0.2015, 0.5710 at η = 1, 2, 5.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from validation.references.interaction import Floats, LawNumbers, PairInteraction
from validation.references.numerics import root

POINTS = 128
"""Places in a period at which the corrugation is computed; its harmonics fall by a factor of ten each, or faster."""
HARMONICS = 24
HEIGHTS = 400
"""Heights among which the innermost minimum is looked for; each is 2 % above the one before, a share of any range."""


@dataclass(frozen=True)
class Corrugation:
    """U(x) by its harmonics: U = Σ c_n cos(2π n x/s) [FU·LU]; `coefficients` c_1, c_2, …

    height: of the particle in the hollow, x = s/2 [LU].
    heights: harmonics of its height, z = h_0 + Σ h_n cos(2π n x/s) [LU].
    """

    spacing: float
    coefficients: Floats
    height: float = math.nan
    heights: Floats = field(default_factory=lambda: np.empty(0))

    def energy(self, x: Floats | float) -> Floats:
        """U(x) [FU·LU]."""
        return self._sum(x, lambda angle, n: np.cos(angle))

    def slope(self, x: Floats | float) -> Floats:
        """U′(x) [FU]: the force that holds a particle back."""
        return self._sum(x, lambda angle, n: -n * np.sin(angle))

    def curvature(self, x: Floats | float) -> Floats:
        """U″(x) [FU/LU]."""
        return self._sum(x, lambda angle, n: -(n**2) * np.cos(angle))

    @property
    def largest_force(self) -> float:
        """F_max = max U′ [FU]."""
        return float(np.max(self.slope(self._places)))

    @property
    def steepest(self) -> float:
        """max(−U″) [FU/LU]: below a spring of it the particle sticks and slips."""
        return float(np.max(-self.curvature(self._places)))

    @property
    def _places(self) -> Floats:
        return np.linspace(0.0, self.spacing, 20_001)

    def _sum(self, x: Floats | float, term: Callable[[Floats | float, float], Floats]) -> Floats:
        wave = 2.0 * math.pi / self.spacing
        total = np.zeros_like(x)
        for n, c in enumerate(self.coefficients, 1):
            total = total + c * term(n * wave * x, n * wave)
        return total


def corrugation(
    law: LawNumbers,
    spacing: float,
    normal_force: float,
    stiffness: float = 0.0,
    place: float = 0.0,
) -> Corrugation:
    """U(x) of the law A, a, B, b over a row of this spacing [LU] under a force [FU], compression positive.

    With a stiffness [FU/LU] the force is the normal force at the height `place` [LU] and grows by so much above it:
    that of a spring whose far end stands still.

    Raises:
        ArithmeticError: the row does not hold the force.
    """
    pair = PairInteraction.of(*law)
    reach = math.ceil(60.0 * pair.longest_range / spacing)
    row = spacing * np.arange(-reach, reach + 1)[:, None]
    half = POINTS // 2 + 1  # from the top to the hollow; the other half of the period mirrors it
    places, z = spacing * np.arange(half) / POINTS, np.empty(half)
    grid = np.geomspace(1e-2 * pair.shortest_range, 20.0 * pair.longest_range, HEIGHTS)

    def slope(x: float, heights: Floats) -> Floats:
        """dU/dz."""
        r = np.hypot(x - row, heights)
        return np.asarray(normal_force + stiffness * (heights - place) - (pair.force(r) * heights / r).sum(axis=0))

    # mypy infers no type of a lambda that has a default, which binds x of this turn.
    for i, x in enumerate(places):  # the innermost minimum: the slope rises through 0
        slopes = slope(x, grid)
        above = np.flatnonzero((slopes[:-1] < 0.0) & (slopes[1:] >= 0.0))
        if above.size == 0:
            raise ArithmeticError(f"the row does not hold {normal_force:g} FU")
        ends = grid[above[0] : above[0] + 2].tolist()
        # mypy cannot infer the type of a lambda with a default.
        z[i] = root(lambda height, x=x: slope(x, np.array([height]))[0], *ends)  # type: ignore[misc]
    energy = pair.energy(np.hypot(places - row, z)).sum(axis=0) + normal_force * z + 0.5 * stiffness * (z - place) ** 2
    waves, heights = (np.real(np.fft.hfft(values, POINTS)[:half]) / POINTS * 2.0 for values in (energy, z))
    heights[0] *= 0.5
    return Corrugation(spacing, waves[1 : HARMONICS + 1], float(z[-1]), heights[: HARMONICS + 1])


def slow_friction(wells: Corrugation, stiffness: float) -> float:
    """⟨F⟩ [FU] in the limit of a slow drive and strong damping, by the energy that each slip loses over s.

    0 where η = max(−U″)/k ≤ 1.
    """
    if wells.steepest <= stiffness:
        return 0.0
    s = wells.spacing
    x = np.linspace(0.5 * s, 1.5 * s, 200_001)  # from the hollow on; the slip begins where U″ = −k first
    begin = float(x[np.flatnonzero(wells.curvature(x) <= -stiffness)[0]])
    drive = begin + float(wells.slope(begin)) / stiffness
    beyond = np.linspace(begin + 1e-6 * s, begin + (2.0 + 2.0 * wells.largest_force / stiffness / s) * s, 400_001)
    rest = wells.slope(beyond) - stiffness * (drive - beyond)
    end = float(beyond[np.flatnonzero((rest[:-1] < 0.0) & (rest[1:] >= 0.0))[0] + 1])

    def total(place: float) -> float:
        return float(wells.energy(place)) + 0.5 * stiffness * (drive - place) ** 2

    return (total(begin) - total(end)) / s / max(1, round((end - begin) / s))


def moving_friction(
    wells: Corrugation,
    stiffness: float,
    mass: float,
    drag: float,
    velocity: float,
    periods: int,
    dropped: int = 2,
    time_step: float = 0.02,
) -> float:
    """⟨F⟩ [FU] by the equation of motion (velocity Verlet) over whole periods of the drive, the first ones dropped."""
    wave = 2.0 * math.pi / wells.spacing
    waves = [(n * wave, -c * n * wave) for n, c in enumerate(wells.coefficients[:8].tolist(), 1)]
    steps = math.ceil(wells.spacing / velocity / time_step)
    dt = wells.spacing / velocity / steps
    x, speed, total = 0.5 * wells.spacing, 0.0, 0.0
    start = x

    def held(place: float) -> float:
        return math.fsum(amplitude * math.sin(k * place) for k, amplitude in waves)

    force = held(x)
    for step in range(1, periods * steps + 1):
        acceleration = (
            -force + stiffness * (start + velocity * (step - 1) * dt - x) - drag * (speed - velocity)
        ) / mass
        speed += 0.5 * dt * acceleration
        x += dt * speed
        force = held(x)
        pull = stiffness * (start + velocity * step * dt - x)
        # implicit in the drag, which is linear
        speed = (speed + 0.5 * dt * (pull - force + drag * velocity) / mass) / (1.0 + 0.5 * dt * drag / mass)
        if step > dropped * steps:
            total += force
    return total / ((periods - dropped) * steps)
