"""Prandtl and Tomlinson's particle under heat by an ensemble of its equations of motion: inertia, height and plate.

A particle (x, z) hangs by springs k on the plate (X, Z), which has the normal force and is pulled by the cantilever:

    m x″ = −∂V/∂x − k (x − X) − γ (x′ − v) + ξ,    m z″ = −∂V/∂z − k (z − Z) − γ z′ + ξ′,
    M X″ = k (x − X) + k_c (v t − X),              M Z″ = k (z − Z) − F_N,

V(x, z) the sum over a periodic row, ξ of the variance 2γkT. Splitting BAOAB (Leimkuhler and Matthews 2013): kicks, half
drifts, and the drag with its heat exactly. ⟨F⟩ is the mean of ∂V/∂x over time and copies, its error that over copies.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from validation.references.interaction import Floats, LawNumbers, PairInteraction

WAVES, PLACES, HEIGHTS = 6, 64, 4000
"""Harmonics of V along x, places that they are found from, and heights of the table."""
REACH = 30.0
"""Longer range of the law times it, beyond which rows are left out."""


class PulledParticle(NamedTuple):
    """What slides.

    Attributes:
        law: A [FU·LU], a [LU], B [FU·LU], b [LU] of the row.
        spacing: of the row [LU].
        normal_force: compression positive [FU].
        stiffness: k, of the particle's springs along x and z [FU/LU].
        cantilever: k_c [FU/LU].
        mass, plate_mass: m, M [MU].
        drag: γ [FU·TU/LU].
        temperature: kT [FU·LU].
    """

    law: LawNumbers
    spacing: float
    normal_force: float
    stiffness: float
    cantilever: float
    mass: float
    plate_mass: float
    drag: float
    temperature: float

    @property
    def moving_mass(self) -> float:
        """Of the particle, and of the plate as it follows it, by the springs of both in series [MU]."""
        return self.mass + self.plate_mass / (1.0 + self.cantilever / self.stiffness) ** 2


def ensemble_friction(
    body: PulledParticle, velocity: float, copies: int, periods: int, time_step: float, seed: int
) -> tuple[float, float]:
    """⟨F⟩ and its standard error [FU], the first period of each copy left out; v [LU/TU], Δt [TU]."""
    generator, forces = np.random.default_rng(seed), _forces(body)
    steps = math.ceil(body.spacing / velocity / time_step)
    dt = body.spacing / velocity / steps
    damped = math.exp(-body.drag / body.mass * dt)
    kicked = math.sqrt(body.temperature / body.mass * (1.0 - damped**2))
    phase = body.spacing * generator.uniform(size=copies)  # the copies are all over the period from the start
    place = np.array([phase, np.full(copies, body.law[1]), phase, np.full(copies, body.law[1])])
    speed = np.zeros((4, copies))
    speed[0] = speed[2] = velocity
    masses = np.array([body.mass, body.mass, body.plate_mass, body.plate_mass])[:, None]
    drive, total = phase.copy(), np.zeros(copies)
    force, held = forces(place, drive)
    for step in range(1, periods * steps + 1):
        speed += 0.5 * dt * force / masses
        place += 0.5 * dt * speed
        speed[0] = velocity + damped * (speed[0] - velocity) + kicked * generator.standard_normal(copies)
        speed[1] = damped * speed[1] + kicked * generator.standard_normal(copies)
        place += 0.5 * dt * speed
        drive += velocity * dt
        force, held = forces(place, drive)
        speed += 0.5 * dt * force / masses
        if step > steps:
            total += held
    means = total / ((periods - 1) * steps)
    return float(means.mean()), float(means.std(ddof=1) / math.sqrt(copies))


def _forces(body: PulledParticle) -> Callable[[Floats, Floats], tuple[Floats, Floats]]:
    """Forces on x, z, X, Z and that of the row against +x, by V(x, z) = V_0(z) + Σ V_n(z) cos(2πn x/s)."""
    pair, s = PairInteraction.of(*body.law), body.spacing
    count = math.ceil(REACH * pair.longest_range / s)
    x, z = s * np.arange(PLACES) / PLACES, np.linspace(0.2 * pair.shortest_range, 12.0 * pair.longest_range, HEIGHTS)
    energy, slope = np.zeros((PLACES, HEIGHTS)), np.zeros((PLACES, HEIGHTS))
    for row in range(-count, count + 1):
        r = np.hypot((x - s * row)[:, None], z)
        potential, force, _ = pair.evaluate(r)
        energy += potential
        slope -= force * z / r
    waves = np.real(np.fft.rfft(energy, axis=0))[: WAVES + 1] * 2.0 / PLACES
    steep = np.real(np.fft.rfft(slope, axis=0))[: WAVES + 1] * 2.0 / PLACES
    steep[0] *= 0.5
    first, step = z[0], z[1] - z[0]
    numbers = 2.0 * math.pi / s * np.arange(1, WAVES + 1)[:, None]

    def forces(place: Floats, drive: Floats) -> tuple[Floats, Floats]:
        at = (place[1] - first) / step
        low = at.astype(np.int64)
        part = at - low
        energies = waves[1:, low] * (1.0 - part) + waves[1:, low + 1] * part
        slopes = steep[:, low] * (1.0 - part) + steep[:, low + 1] * part
        angle = numbers * place[0]
        held = -(numbers * energies * np.sin(angle)).sum(axis=0)
        down = slopes[0] + (slopes[1:] * np.cos(angle)).sum(axis=0)
        along, up = body.stiffness * (place[0] - place[2]), body.stiffness * (place[1] - place[3])
        pull = body.cantilever * (drive - place[2])
        return np.array([-held - along, -down - up, along + pull, up - body.normal_force]), held

    return forces
