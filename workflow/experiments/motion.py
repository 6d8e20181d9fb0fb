"""The motion of a slide as a series: measurements of each load step, integrals over time, and the results of both.

Energy: the cantilever's far end does the work W = ∫ F_c v dt. The baths take from what moves

    Q = ∫ (γ Σ v_i² + c V²) dt − v (N γ ΔX_p + c ΔX)    [under noise: the energy that the thermostats report]

with X and X_p the positions of the plate and of its particles on average; the stored energy is
E = E_pot + E_kin + F_c²/2k − F_N d, d the displacement: W = Q + ΔE.

F_c is the force of the cantilever, v the velocity of the drive, γ and c the drag of a particle and of the plate, N the
number of particles.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import accumulate, chain

import numpy as np

from contact1d.analysis import friction
from contact1d.workflow.continuation.contact import HEAT
from contact1d.workflow.continuation.outcome import Reading, Result
from contact1d.workflow.continuation.state import State
from contact1d.workflow.experiments.series import Array, Series, measured, recorded
from contact1d.workflow.model.dynamics import DriveLeg
from contact1d.workflow.model.motion import cantilever_swing, inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Cantilever, Scene
from contact1d.workflow.units import ENERGY, FORCE, NUMBER

SETTINGS_SHARE = 0.3
"""Error of cutoff and timesteps at most, over the tolerance; against the integrator 0.05 was measured."""
FORCES = ("friction", "cantilever_force")
"""Columns that are reported as static and as mean."""


@dataclass(frozen=True)
class Motion:
    """A slide by the legs of its drive.

    Attributes:
        scene, settings: of the slide.
        series: records at the start of the drive and at the ends of all load steps, as `motion_of` has them.
        energies: "cantilever_work", "dissipated_energy" and "stored_energy" since the start, (n,) [FU·LU].
    """

    scene: Scene
    settings: Settings
    series: Series
    energies: Mapping[str, Array]

    @cached_property
    def legs(self) -> list[tuple[float, Series]]:
        """List of (velocity of the drive [LU/TU], records) of each leg that has a load step at least, in order; cached.

        The records go from the start of the leg to its end, both included, or to the end of the run. The velocity has a
        sign, and is 0 where the drive rests.
        """
        drive = self.settings.motion.drive
        starts = accumulate((leg.rows for leg in drive), initial=0)
        return [
            (leg.velocity, self.series.chosen(slice(start, start + leg.rows + 1)))
            for leg, start in zip(drive, starts, strict=False)
            if start < len(self.series) - 1
        ]

    @property
    def moving(self) -> list[tuple[float, Series]]:
        """The legs on which the drive moves, each as (velocity [LU/TU], records); [] where it has not moved yet."""
        return [leg for leg in self.legs if leg[0]]

    @cached_property
    def slips(self) -> list[friction.Slip]:
        """The slips of the plate on the legs on which the drive moves, in order; [] for none; cached.

        Each has the time of its end [TU], the position of the plate at its beginning and its signed size [LU].
        """
        spacing = self.scene.bodies.spacing
        return list(chain(*(friction.slips(leg["time"], leg["plate_x"], spacing, v) for v, leg in self.moving)))

    @property
    def period(self) -> float:
        """Time [TU] in which the drive passes a spacing of the particles on the last leg on which it moves.

        Raises:
            IndexError: the drive has not moved.
        """
        return self.scene.bodies.spacing / abs(self.moving[-1][0])

    @cached_property
    def periods(self) -> Series:
        """Means over whole periods of the last leg on which the drive moves, in order; cached.

        The last period ends with the leg. The columns are "friction" and "cantilever_force" [FU], "velocity" [LU/TU] of
        the plate along x and "square" [LU²/TU²], of its velocity along x and z; they are empty for a leg shorter than a
        period.

        Raises:
            IndexError: the drive has not moved.
        """
        return self.moving[-1][1].periods(self.period)

    @cached_property
    def steady(self) -> friction.Mean:
        """Mean friction [FU] with its error, positive against +x, after the run-in of the last leg that moves; cached.

        It is that by the balance of momentum; with noise that of the friction at single times, if its error is smaller.

        Raises:
            ValueError: the leg has fewer than three whole periods.
            IndexError: the drive has not moved.
        """
        _, leg = self.moving[-1]
        means = [friction.mean_of(self.periods["friction"])]
        if not leg.smooth:
            means.append(friction.sampled_mean(leg["time"], leg["friction"], self.period))
        return min(means, key=lambda mean: mean.error)

    @cached_property
    def largest(self) -> dict[str, float]:
        """Largest |friction| [FU] and |energy| [FU·LU] of the slide, by "FU" and "FU·LU"; at least 1e-300; cached.

        They are the scales of results near 0.
        """
        columns = {FORCE: [self.series["friction"]], ENERGY: list(self.energies.values())}
        return {unit: max(1e-300, float(np.abs(values).max())) for unit, values in columns.items()}

    @cached_property
    def results(self) -> dict[str, Result]:
        """The results of the slide by name, as far as the drive has moved, with errors by source; cached.

        Always "slips" (a number), "cantilever_work", "dissipated_energy" and "stored_energy" [FU·LU]. With three whole
        periods on the last leg that moves "mean_friction" and "mean_cantilever_force"; where the drive moves on one leg
        only, and the plate by a spacing, "static_friction" and "static_cantilever_force" [FU]. With noise
        "plate_temperature" [FU·LU].
        """
        results = self._energies() | {"slips": Result(float(len(self.slips)), NUMBER, {"statistics": 0.0})}
        if self.moving:
            results |= self._means() | self._static()
        if not self.series.smooth:
            results |= self._temperature()
        return {name: replace(result, scale=self.largest.get(result.unit)) for name, result in results.items()}

    def _energies(self) -> dict[str, Result]:
        """Return "cantilever_work", "dissipated_energy" and "stored_energy" [FU·LU] of the whole drive up to its end.

        They are counted from its start. The residual of their balance is the error of each.
        """
        ends = {name: float(values[-1]) for name, values in self.energies.items()}
        errors = {"solver": abs(ends["cantilever_work"] - ends["dissipated_energy"] - ends["stored_energy"])}
        return {name: Result(end, ENERGY, errors, prescribed=name == "stored_energy") for name, end in ends.items()}

    def _means(self) -> dict[str, Result]:
        """Return "mean_friction" and "mean_cantilever_force" [FU], positive against and along the motion of the drive.

        They are means over whole periods of the last leg on which the drive moves, after its run-in; {} where it has
        fewer than three periods.

        Raises:
            IndexError: the drive has not moved.
        """
        velocity, leg = self.moving[-1]
        if len(self.periods) < friction.FEWEST_PERIODS:
            return {}
        share = SETTINGS_SHARE * self.settings.tolerance
        run_in, by_half = slice(self.steady.first, None), leg.every_second().periods(self.period)
        steady = {**self.periods.chosen(run_in).columns, "friction": self.steady.blocks}
        sparse = by_half.chosen(run_in).columns
        if self.steady.missed:
            sparse = steady | {"friction": self.steady.blocks + self.steady.missed}

        def read(blocks: Series) -> dict[str, Reading]:
            """Return "mean_friction" and "mean_cantilever_force" of blocks [FU], positive against and along the drive.

            Their error is a share of the tolerance.
            """
            values = {f"mean_{name}": math.copysign(1.0, velocity) * float(blocks.mean(name)) for name in FORCES}
            return {name: Reading(value, FORCE, {"solver": share * abs(value)}) for name, value in values.items()}

        return measured(Series(steady), read, friction.interval, {"sampling": Series(sparse)})

    def _static(self) -> dict[str, Result]:
        """Return "static_friction" and "static_cantilever_force" [FU], the largest until the plate moved by a spacing.

        They are positive against and along the motion of the drive. {} where the drive moves on more than one leg, or
        the plate is at the end less than a spacing from its start, in the direction of the drive.

        Raises:
            ValueError: the drive has not moved.
        """
        (velocity, leg), *later = self.moving
        sign, spacing = math.copysign(1.0, velocity), self.scene.bodies.spacing
        position = sign * leg["plate_x"]
        if later or position[-1] - position[0] < spacing:
            return {}
        share, results = SETTINGS_SHARE * self.settings.tolerance, {}
        for name in FORCES:
            top, missed = friction.largest_before(sign * leg[name], position, spacing)
            results[f"static_{name}"] = Result(top, FORCE, {"sampling": missed, "solver": share * abs(top)})
        return results

    def _temperature(self) -> dict[str, Result]:
        """Return "plate_temperature", M ⟨(V − ⟨V⟩)²⟩/2 [FU·LU], of the plate's motion along x and z in the last leg.

        It is an energy, k_BT. M is the mass of the plate, V its velocity, along z with the mean 0. Slips are part of
        it. The last leg may be one on which the drive rests.
        """
        _, leg = self.legs[-1]
        mass, count = self.settings.motion.plate_mass, 20

        def read(blocks: Series) -> dict[str, Reading]:
            """Return {"plate_temperature": mean kinetic energy of the plate [FU·LU] in one direction of motion}.

            `blocks`: means of the plate's velocity along x, and of its squares along x and z together.
            """
            energy = mass * (blocks.mean("square") - blocks.mean("velocity") ** 2) / 2
            return {"plate_temperature": Reading(float(energy), ENERGY)}

        return measured(leg.periods(float(np.ptp(leg["time"])) / count), read, friction.interval)

    @property
    def unsteady(self) -> str:
        """Message why the plate does not slide, or not yet steadily, on the one leg on which the drive moves.

        "" where it does. It does not where the leg has fewer than three periods, the plate has moved along +x by less
        than a spacing, or its distance after the run-in differs from that of the drive by more than 10 %, and by more
        than the largest of several slips.

        Raises:
            ValueError: the drive moves on no leg, or on several.
        """
        ((velocity, leg),) = self.moving
        time, position, count = leg["time"], leg["plate_x"], len(self.periods)
        if count < friction.FEWEST_PERIODS:
            periods = "1 whole period" if count == 1 else f"{count} whole periods"
            return (
                f"no steady sliding yet: the drive distance of {leg['drive'][-1]:.3g} LU has {periods} of "
                f"the spacing, and a mean needs {friction.FEWEST_PERIODS}"
            )
        if position[-1] < self.scene.bodies.spacing:
            return f"the plate moved by {position[-1]:.3g} LU only, which is not yet sliding{self._swing}"
        duration = self.period * self.steady.blocks.size
        start = time[-1] - duration
        distance = float(position[-1] - np.interp(start, time, position))
        sizes = [slip.size for slip in self.slips if slip.time > start]
        slip = max(sizes) if len(sizes) > 1 else 0.0
        if abs(distance - velocity * duration) > max(0.1 * velocity * duration, slip):  # 10 %, or one slip
            return (
                f"no steady sliding yet: over the last {duration:.3g} TU the plate moves at {distance / duration:.3g} "
                f"LU/TU and the drive at {velocity:.3g}{self._swing}"
            )
        return ""

    @property
    def _swing(self) -> str:
        """End of a message, from ". " on: the plate's period on its cantilever is as long as the slide; else ""."""
        swing, time = cantilever_swing(self.scene, self.settings), self.series["time"][-1]
        if swing < time:
            return ""
        return (
            f". The plate of {self.settings.motion.plate_mass:.3g} MU on its cantilever has a period of {swing:.3g} TU,"
            f" and the drive moved for {time:.3g} TU: a lower cantilever.velocity or a lighter plate.mass helps, too"
        )


def motion_of(scene: Scene, settings: Settings, load: float, states: Sequence[State]) -> Motion:
    """Return the motion of a slide from the state at which its drive starts and those of the load steps after it.

    Its series has the columns of friction.csv, (n,): "time" [TU], "drive" and "plate_x" [LU] and "cantilever_work"
    [FU·LU], counted from the start of the drive, "plate_z" [LU], the displacement with a negative sign, "friction",
    positive against +x, "normal_force", positive in compression, and "cantilever_force" [FU]. It has integrals over
    time of friction and cantilever force [FU·TU], of the plate's velocity along x [LU] and of its squared velocity
    along x and z [LU²/TU].

    Args:
        scene: with a cantilever.
        settings: with its drive.
        load: normal force [FU], compression positive.
        states: the state at which the drive starts, and those of all load steps or of the first ones.
    """
    bodies, moving, drive = scene.bodies, settings.motion, settings.motion.drive
    rows = [leg for leg in drive for _ in range(leg.rows)][: len(states) - 1]
    span, velocity = recorded(rows, ("row_time", "velocity")).values()
    names = ("plate_x", "displacement", "force", "cantilever_force")
    plate, depth, normal, pull = recorded(states, names).values()
    drag, c, mass = settings.chains.upper * moving.damping, moving.plate_damping, moving.plate_mass
    inertia_of_particle, inertia_of_plate = inertia(scene, settings)
    plate_velocity = _read(states, "vcm(plate,x)")
    speeds = plate_velocity**2 + _read(states, "vcm(plate,z)") ** 2
    pulled = _integrals(states, rows, 1, pull)
    kinetic = _integrals(states, rows, 2, _read(states, "cantilever_kinetic"))
    squares = 2.0 / inertia_of_plate * _integrals(states, rows, 3, 0.5 * inertia_of_plate * speeds)
    lost = 2.0 * moving.damping / inertia_of_particle * kinetic + c * squares
    if heat := [name for name in HEAT if name in states[-1].motion]:
        lost = np.asarray([sum(state.motion[name] for name in heat) for state in states[1:]])
    driven, moved, carried = _summed(velocity * span), plate - plate[0], _read(states, "xcm(upper,x)")
    momentum = settings.chains.upper * bodies.mass * _read(states, "vcm(upper,x)") + mass * plate_velocity
    dragged = drag * (driven - carried) + c * (driven - moved) - momentum
    energy = _read(states, "measuring_energy")
    energy = energy + bodies.mass / inertia_of_particle * _read(states, "cantilever_kinetic") + 0.5 * mass * speeds
    energy += 0.5 * pull**2 / scene.the(Cantilever).stiffness - load * depth
    energies = {
        "cantilever_work": _summed(velocity * pulled),
        "dissipated_energy": _summed(lost - velocity * np.diff(drag * carried + c * moved)),
        "stored_energy": energy - energy[0],
    }
    columns = {
        "time": _summed(span),
        "drive": driven,
        "plate_x": moved,
        "plate_z": -depth,
        "friction": np.asarray([-bodies.own_spacing * float(state.profile.shear.sum()) for state in states]),
        "normal_force": normal,
        "cantilever_force": pull,
        "cantilever_work": energies["cantilever_work"],
    }
    integrals = {
        "friction": _summed(pulled) + dragged - dragged[0],
        "cantilever_force": _summed(pulled),
        "velocity": moved,
        "square": _summed(squares),
    }
    series = Series(columns, integrals, smooth=not heat)  # with noise a force says little of the time around it
    return Motion(scene, settings, series, energies)


def _read(states: Sequence[State], name: str) -> Array:
    """Return a measured quantity of the motion in all states, (n,), by its name in LAMMPS, in units of the scene.

    Raises:
        KeyError: a state lacks it.
    """
    return np.asarray([state.motion[name] for state in states])


def _summed(parts: Array) -> Array:
    """Return the cumulative sums of parts (n,) in their unit, with 0 first, (n + 1,)."""
    return np.concatenate([[0.0], np.cumsum(parts)])


def _integrals(states: Sequence[State], rows: Sequence[DriveLeg], mean: int, ends: Array) -> Array:
    """Return the integral over each load step, (n,), of a quantity whose mean LAMMPS measures, in its unit times TU.

    Args:
        states: at the start and at the ends of the load steps, (n + 1,).
        rows: the leg of each load step, (n,).
        mean: number of the quantity in LAMMPS: 1 the cantilever's force, 2 the kinetic energy of the particles, 3 that
            of the plate; a mean since the start over every fifth timestep.
        ends: the quantity itself at each state, (n + 1,).
    """
    every = 5
    span, step = recorded(rows, ("row_time", "time_step")).values()
    count = np.floor(recorded(states, ("step",))["step"] / every) + 1.0
    means = np.diff(count * _read(states, f"f_cantilever_means[{mean}]")) / np.diff(count)
    return means * span - 0.5 * every * step * np.diff(ends)
