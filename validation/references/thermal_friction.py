"""One particle on a periodic row under heat, pulled by a spring: Smoluchowski's equation, no dynamics, no chance.

At each x the height takes its share by Boltzmann's weight, which leaves a free energy in place of min_z,

    A(x) = −kT ln ∫ exp(−[Σ_j V(√((x − j s)² + z²)) + F_N z]/kT) dz

and a mean height z(x), which it climbs against its drag. Overdamped, with the drag along x against what moves with the
drive, y = x − v t has the density p(y, t) of

    ∂p/∂t = ∂/∂y { μ [ (A′ + k y + γ v z′²) p + kT ∂p/∂y ] },    μ = (1 + m (A″ + k)/γ²)/γ(1 + z′²),    at x = y + v t,

and ⟨F⟩ = −k ⟨y⟩ over a period. μ has inertia to its first order (Wilemski 1976): m max|A″| ≪ γ². Fluxes as of
Scharfetter and Gummel, which keep Boltzmann's density exactly; implicit in time. Beside it the textbook's law (Sang,
Dubé and Grant 2001): slips over a barrier ∝ (1 − F/F_c)^{3/2} come at a force that is lower by
F_c [(kT/ΔE₀) ln X]^{2/3}, and so is the mean.
"""

import math

import numpy as np
from scipy.linalg import solve_banded
from scipy.optimize import brentq

from validation.references.detachment import garg, implicit
from validation.references.interaction import Floats, LawNumbers, PairInteraction
from validation.references.prandtl_tomlinson import HARMONICS, POINTS, Corrugation, slow_friction

HEIGHTS, REACH = 1200, 30.0
"""Of the integral over z; and the longer range times it, beyond which rows are left out."""
PLACES, FINER = 240, 4
"""Places of the density for each spacing, and timesteps while the drive passes one of them."""
FORGOTTEN, MOST_PERIODS = 6.0, 500
"""Times γ/k after which the density, which begins as that of the drive at rest, has forgotten that; and a bound."""
SAME = 1e-4
"""Change of ⟨F⟩ over F_max from period to period that counts as none."""
ROOM = 8.0
"""Standard deviations of the spring's own heat to each side of where the corrugation can hold the particle."""


def free_corrugation(
    law: LawNumbers, spacing: float, normal_force: float, temperature: float
) -> tuple[Corrugation, Corrugation]:
    """A(x) and z(x), by their harmonics, of the law A, a, B, b over a row of this spacing [LU].

    Args:
        law: A [FU·LU], a [LU], B [FU·LU], b [LU].
        spacing: [LU].
        normal_force: compression positive [FU].
        temperature: kT [FU·LU].
    """
    pair = PairInteraction.of(*law)
    reach = math.ceil(REACH * pair.longest_range / spacing)
    row = spacing * np.arange(-reach, reach + 1)[:, None]
    x = spacing * np.arange(POINTS // 2 + 1) / POINTS
    z = np.linspace(0.05 * pair.shortest_range, 8.0 * pair.longest_range + 40.0 * temperature / normal_force, HEIGHTS)
    energy = np.array([pair.energy(np.hypot(place - row, z)).sum(axis=0) + normal_force * z for place in x])
    lowest = energy.min(axis=1, keepdims=True)
    weights = np.exp(-(energy - lowest) / temperature)
    free = lowest[:, 0] - temperature * np.log(weights.sum(axis=1))
    return _by_harmonics(free, spacing), _by_harmonics((weights @ z) / weights.sum(axis=1), spacing)


def _by_harmonics(half: Floats, spacing: float) -> Corrugation:
    """An even function by its values from 0 to half of the spacing."""
    waves = np.fft.rfft(np.concatenate([half, half[-2:0:-1]])) / POINTS * 2.0
    return Corrugation(spacing, np.real(waves[1 : HARMONICS + 1]), float(half[-1]))


def thermal_friction(
    wells: Corrugation,
    heights: Corrugation,
    stiffness: float,
    drag: float,
    temperature: float,
    velocity: float,
    mass: float = 0.0,
    places: int = PLACES,
    finer: int = FINER,
) -> float:
    """⟨F⟩ [FU] at k [FU/LU], γ [FU·TU/LU], kT [FU·LU], v [LU/TU] and m [MU], in the state that repeats itself.

    Raises:
        ArithmeticError: it does not come to that.
    """
    s, moments = wells.spacing, finer * places
    half = math.ceil((wells.largest_force / stiffness + s + ROOM * math.sqrt(temperature / stiffness)) / s * places)
    h, step = s / places, s / velocity / moments
    y = h * np.arange(-half, half + 1, dtype=np.float64)
    between = y[1:] - 0.5 * h
    period = s * np.arange(moments) / moments  # the drive goes on by an entry at a time
    climb = heights.slope(period) ** 2
    slopes = wells.slope(period) + drag * velocity * climb
    mobility = (1.0 + mass * (wells.curvature(period) + stiffness) / drag**2) / (1.0 + climb)
    entries = finer * np.arange(-half, half) + finer // 2  # FINER is even: midway between places
    spring = stiffness * between
    share = temperature / drag / h**2 * step
    energy = 0.5 * stiffness * y**2 + wells.energy(y)
    p = np.exp(-(energy - energy.min()) / temperature)
    p /= p.sum()
    means = [math.inf]
    least = math.ceil(FORGOTTEN * drag / stiffness * velocity / s)
    while len(means) <= MOST_PERIODS:
        total = 0.0
        for moment in range(1, moments + 1):
            here = (entries + moment) % moments
            step_ahead = implicit(share * mobility[here], h / temperature * (slopes[here] + spring))
            p = solve_banded((1, 1), step_ahead, p, check_finite=False)
            total -= stiffness * float(p @ y)
        means.append(total / moments)
        if len(means) > least and abs(means[-1] - means[-2]) < SAME * wells.largest_force:
            return means[-1]
    raise ArithmeticError(f"the density does not repeat itself within {MOST_PERIODS} periods of the drive")


def textbook_friction(wells: Corrugation, stiffness: float, drag: float, temperature: float, velocity: float) -> float:
    """⟨F⟩ [FU] by the (ln v)^{2/3} law; NaN where its logarithm is none, v being too fast.

    Slow without heat it is `slow_friction`; heat takes from the force at which it slips, and from the mean as much.
    """
    place = brentq(wells.curvature, 0.55 * wells.spacing, 0.98 * wells.spacing)
    h = 1e-3 * wells.spacing
    bend = abs(float(wells.slope(np.array([place + h, place, place - h])) @ [1.0, -2.0, 1.0])) / h**2
    largest = wells.largest_force
    return slow_friction(wells, stiffness) - (largest - garg(largest, bend, drag, temperature, stiffness * velocity))
