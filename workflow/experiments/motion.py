"""The motion of a slide in arrays: what each load step measured, summed up over time.

Energy: the cantilever's far end does the work W = ∫ F_c v dt. The baths take from what moves

    Q = ∫ (γ Σ v_i² + c V²) dt − v (N γ ΔX_p + c ΔX)    [with heat: what the thermostats say]

with X and X_p the positions of the plate and of its particles on average, and what is stored is
E = E_pot + E_kin + F_c²/2k − F_N d, d the displacement: W = Q + ΔE.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.contact import HEAT
from contact1d.workflow.continuation.state import State
from contact1d.workflow.model.dynamics import DriveLeg
from contact1d.workflow.model.motion import inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Slide

Array = NDArray[np.float64]
EVERY = 5
"""Timesteps from one sample of the means to the next; see `fragments/cantilever.lmp`."""


@dataclass(frozen=True)
class Motion:
    """What happened, from the moment at which the drive starts; arrays over that moment and the ends of all load steps.

    Attributes:
        legs: the drive's.
        leg: index of the leg that ends with, or contains, each load step's end; shape (n,).
        time: [TU].
        drive: position of the driven end [LU].
        place: of the plate [LU].
        friction: force of the lower body against +x [FU].
        pull: of the cantilever [FU].
        impulse: of the friction since the start [FU·TU].
        pulled: of the cantilever's force since the start [FU·TU].
        work, dissipated, stored: of the cantilever, by the drag, and stored, since the start [FU·LU].
        squares: ∫ V² dt of the plate [LU²/TU].
    """

    legs: tuple[DriveLeg, ...]
    leg: NDArray[np.int64]
    time: Array
    drive: Array
    place: Array
    friction: Array
    pull: Array
    impulse: Array
    pulled: Array
    work: Array
    dissipated: Array
    stored: Array
    squares: Array

    def of_leg(self, leg: int) -> slice:
        """The load steps of a leg, its start first."""
        rows = np.flatnonzero(self.leg == leg)
        return slice(max(int(rows[0]) - 1, 0), int(rows[-1]) + 1)


def motion_of(scene: Scene, settings: Settings, start: State, states: list[State]) -> Motion:
    """Sum up a slide from the state at which its drive starts and the states of all rows, or of the first ones."""
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)
    normal_force = scene.experiment.normal_force
    legs, every = settings.motion.drive, [start, *states]
    numbers = [i for i, leg in enumerate(legs) for _ in range(leg.rows)][: len(states)]
    span = np.asarray([legs[i].row_time for i in numbers])
    velocity = np.asarray([legs[i].velocity for i in numbers])

    def read(name: str) -> Array:
        return np.asarray([state.motion[name] for state in every])

    def summed(parts: Array) -> Array:
        return np.concatenate([[0.0], np.cumsum(parts)])

    count = np.floor(np.asarray([state.step for state in every]) / EVERY) + 1.0
    step = np.asarray([legs[i].time_step for i in numbers])

    def summed_over_rows(mean: int, ends: Array) -> Array:
        """Integral of each load step: samples at every fifth step up to its end, made the trapezoid rule."""
        means = np.diff(count * read(f"f_cantilever_means[{mean}]")) / np.diff(count)
        return np.asarray(means * span - 0.5 * EVERY * step * np.diff(ends))

    place = np.asarray([state.plate_x for state in every])
    pull = np.asarray([state.cantilever_force for state in every])
    speeds = read("vcm(plate,x)") ** 2 + read("vcm(plate,z)") ** 2
    force = summed_over_rows(1, pull)
    kinetic = summed_over_rows(2, read("cantilever_kinetic"))
    bodies, mass, c = scene.bodies, settings.motion.plate_mass, settings.motion.plate_damping
    drag = settings.chains.upper * settings.motion.damping
    heavy, heavy_plate = inertia(scene, settings)
    squares = 2.0 / heavy_plate * summed_over_rows(3, 0.5 * heavy_plate * speeds)
    momentum = settings.chains.upper * bodies.mass * read("vcm(upper,x)") + mass * read("vcm(plate,x)")
    carried, gone = np.diff(read("xcm(upper,x)")), np.diff(place)
    lag = velocity * span - carried, velocity * span - gone
    lost = 2.0 * settings.motion.damping / heavy * kinetic + c * squares
    told = [name for name in HEAT if name in states[-1].motion]
    if told:
        lost = np.asarray([sum(state.motion[name] for name in told) for state in states])
    moving = 0.5 * mass * speeds
    depth = np.asarray([state.displacement for state in every])
    energy = read("c_measuring_energy") + bodies.mass / heavy * read("cantilever_kinetic") + moving
    energy += 0.5 * pull**2 / scene.cantilever.stiffness - normal_force * depth
    return Motion(
        legs=legs,
        leg=np.asarray([-1, *numbers]),
        time=summed(span),
        drive=summed(velocity * span),
        place=place - place[0],
        friction=np.asarray([-bodies.own_spacing * float(state.profile.shear.sum()) for state in every]),
        pull=pull,
        impulse=summed(force + drag * lag[0] + c * lag[1]) - (momentum - momentum[0]),
        pulled=summed(force),
        work=summed(velocity * force),
        dissipated=summed(lost - velocity * (drag * carried + c * gone)),
        stored=energy - energy[0],
        squares=summed(squares),
    )
