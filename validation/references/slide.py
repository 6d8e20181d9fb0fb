"""A slide by velocity Verlet in numpy: the whole model of particles, plate and cantilever, written independently.

Upper particle i, at p_i = (x_i, z_i), hangs by springs (k_t, k_n) on its place a_i + (X, Z) in the plate; a lower one
on its own place, or is held there. Opposite particles at a distance r < r_c repel each other with
f(r) = (A/a) exp(−r/a) − (B/b) exp(−r/b).

    m p″ = F_springs + F_opposite − γ (p′ − v),    M X″ = Σ k_t (x_i − a_i − X) + k_c (v t − X) − c (X′ − v)

and the same along z with the normal force, and no v there. A lower particle's drag is against rest: its v is 0.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from validation.references.interaction import Floats, LawNumbers

SETTLING = 2000
"""Spans of 200 steps within which bodies come to rest."""


@dataclass(frozen=True)
class SlideModel:
    """A slide.

    Attributes:
        lower, upper: undeformed places x, z of the particles, shape (n, 2) [LU].
        law: A [FU·LU], a [LU], B [FU·LU], b [LU].
        cutoff: r_c [LU].
        normal_stiffness, tangential_stiffness: k_n, k_t [FU/LU].
        mass, plate_mass: m, M [MU].
        drag, plate_drag: γ, c [FU·TU/LU].
        cantilever_stiffness, velocity: k_c [FU/LU], v [LU/TU].
        normal_force: compression positive [FU].
        rigid: whether the lower particles are held.
        period: after which both bodies repeat themselves along x [LU]; 0: they end.
        neighbours: stiffness of springs between neighbours, of bodies that end [FU/LU].
    """

    lower: Floats
    upper: Floats
    law: LawNumbers
    cutoff: float
    normal_stiffness: float
    tangential_stiffness: float
    mass: float
    plate_mass: float
    drag: float
    plate_drag: float
    cantilever_stiffness: float
    velocity: float
    normal_force: float
    rigid: bool = False
    period: float = 0.0
    neighbours: float = 0.0


@dataclass(frozen=True)
class Trace:
    """What the slide does: times [TU], friction [FU], place of the plate [LU], impulse of the friction [FU·TU]."""

    time: Floats
    friction: Floats
    place: Floats
    impulse: Floats


class Integrator:
    """The state of a slide on its way: u of the lower, upper particles and the plate from their undeformed places."""

    def __init__(self, model: SlideModel) -> None:
        """At rest in the undeformed places."""
        self.model = model
        self.lower, self.upper = np.zeros_like(model.lower), np.zeros_like(model.upper)
        self.plate = np.zeros(2)
        self.speeds = [np.zeros_like(model.lower), np.zeros_like(model.upper), np.zeros(2)]
        self.friction = 0.0

    def run(self, steps: int, time_step: float, velocity: float, start: float = 0.0, every: int = 1) -> Trace:
        """Move on for so many steps; the drive has come to `start` [LU] and goes on at `velocity` [LU/TU].

        Measured every `every` steps; the impulse of the friction [FU·TU] is summed over every step.
        """
        rows, impulse = [], 0.0
        model = self.model
        drags = (model.drag / model.mass, model.drag / model.mass, model.plate_drag / model.plate_mass)
        accelerations = self._accelerations(start, velocity)
        for step in range(1, steps + 1):
            before = self.friction
            for place, speed, acceleration, drag in zip(self._places(), self.speeds, accelerations, drags, strict=True):
                speed += 0.5 * time_step * (acceleration - drag * speed)
                place += time_step * speed
            accelerations = self._accelerations(start + velocity * step * time_step, velocity)
            for speed, acceleration, drag in zip(self.speeds, accelerations, drags, strict=True):
                speed += 0.5 * time_step * acceleration
                speed /= 1.0 + 0.5 * time_step * drag  # the drag is that of the new velocity: second order
            impulse += 0.5 * time_step * (before + self.friction)
            if step % every == 0:
                rows.append((step * time_step, self.friction, self.plate[0], impulse))
        return Trace(*(np.asarray(column) for column in zip(*rows, strict=True)))

    def settle(self, time_step: float, residual: float, drag: float | None = None) -> None:
        """Move with the drive at rest until nothing moves any more: momentum and forces below `residual` [FU].

        `drag`: of particles on the way [FU·TU/LU], in place of the model's.
        """
        own = self.model
        self.model = model = replace(own, drag=own.drag if drag is None else drag)
        try:
            for _ in range(SETTLING):
                self.run(200, time_step, 0.0)
                _, upper, plate = self._accelerations(0.0, 0.0)
                forces = np.concatenate([model.mass * upper.ravel(), model.plate_mass * plate])
                if max(np.abs(forces).max(), np.abs(self.speeds[2]).max() * model.plate_mass) < residual:
                    return
        finally:
            self.model = own
        raise ArithmeticError("the bodies do not come to rest")

    def _places(self) -> tuple[Floats, Floats, Floats]:
        return self.lower, self.upper, self.plate

    def _accelerations(self, drive: float, velocity: float) -> tuple[Floats, Floats, Floats]:
        """Of lower particles, upper particles and plate, without the drag at their own velocities [LU/TU²]."""
        model = self.model
        stiffness = np.asarray([model.tangential_stiffness, model.normal_stiffness])
        on_upper, on_lower = self._opposite()
        self.friction = -on_upper[:, 0].sum()
        held = stiffness * (self.upper - self.plate)
        upper = on_upper - held + self._neighbours(self.upper)
        lower = on_lower - stiffness * self.lower + self._neighbours(self.lower)
        if model.rigid:
            lower = np.zeros_like(lower)
        upper[:, 0] += model.drag * velocity
        along = model.cantilever_stiffness * (drive - self.plate[0]) + model.plate_drag * velocity
        plate = held.sum(axis=0) + np.asarray([along, -model.normal_force])
        return lower / model.mass, upper / model.mass, plate / model.plate_mass

    def _neighbours(self, moved: Floats) -> Floats:
        """Forces of the springs between neighbours, which are at rest in the undeformed chain."""
        force = np.zeros_like(moved)
        if self.model.neighbours:
            pull = self.model.neighbours * np.diff(moved, axis=0)
            force[:-1] += pull
            force[1:] -= pull
        return force

    def _opposite(self) -> tuple[Floats, Floats]:
        """Forces on the upper and on the lower particles."""
        model = self.model
        A, a, B, b = model.law
        apart = (model.upper + self.upper)[:, None, :] - (model.lower + self.lower)[None, :, :]
        images = [0.0]
        if model.period:
            apart[..., 0] -= model.period * np.round(apart[..., 0] / model.period)
            most = math.ceil(model.cutoff / model.period)
            images = [model.period * n for n in range(-most, most + 1)]
        on_upper, on_lower = np.zeros_like(self.upper), np.zeros_like(self.lower)
        for image in images:
            there = apart + np.asarray([image, 0.0])
            r = np.hypot(there[..., 0], there[..., 1])
            force = np.where(r < model.cutoff, (A / a * np.exp(-r / a) - B / b * np.exp(-r / b)) / r, 0.0)
            pairs = force[..., None] * there
            on_upper += pairs.sum(axis=1)
            on_lower -= pairs.sum(axis=0)
        return on_upper, on_lower
