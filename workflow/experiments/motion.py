"""The motion of a slide as a series: what each load step measured, summed up over time, and what is read off it.

Energy: the cantilever's far end does the work W = ∫ F_c v dt. The baths take from what moves

    Q = ∫ (γ Σ v_i² + c V²) dt − v (N γ ΔX_p + c ΔX)    [with heat: what the thermostats say]

with X and X_p the positions of the plate and of its particles on average, and what is stored is
E = E_pot + E_kin + F_c²/2k − F_N d, d the displacement: W = Q + ΔE.
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
from contact1d.workflow.model.motion import cantilever_swing, inertia
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Cantilever, Scene
from contact1d.workflow.units import ENERGY, FORCE, NUMBER

EVERY = 5
"""Timesteps from one sample of the means to the next; see `fragments/cantilever.lmp`."""
SETTINGS_SHARE = 0.3
"""Of the tolerance: what cutoff and timesteps leave open at most; against the integrator 0.05 was measured."""
STEADY = 0.1
"""Way of plate and drive after the run-in may differ by this share, or by one slip, where sliding counts as steady."""
TEMPERATURE_BLOCKS = 20
"""Parts of the last leg whose spread gives the error of its temperature."""
FORCES = ("friction", "cantilever_force")
"""What is reported as static and as mean."""
DIRECTIONS = 2
"""Along which the plate is free: a slide needs both, x and z."""


@dataclass(frozen=True)
class Motion:
    """A slide by the legs of its drive.

    Attributes:
        scene, settings: of the slide.
        series: at the moment at which the drive starts, and at the ends of all load steps; see `motion_of`.
        energies: work of the cantilever, dissipated and stored energy since the start, by name [FU·LU].
    """

    scene: Scene
    settings: Settings
    series: Series
    energies: Mapping[str, Array]

    @cached_property
    def legs(self) -> list[tuple[float, Series]]:
        """Of each leg that has begun the velocity of the drive [LU/TU], and its load steps, its start first."""
        drive = self.settings.motion.drive
        starts = accumulate((leg.rows for leg in drive), initial=0)
        return [
            (leg.velocity, self.series.chosen(slice(start, start + leg.rows + 1)))
            for leg, start in zip(drive, starts, strict=False)
            if start < len(self.series) - 1
        ]

    @property
    def moving(self) -> list[tuple[float, Series]]:
        """The legs on which the drive moves."""
        return [leg for leg in self.legs if leg[0]]

    @cached_property
    def slips(self) -> list[friction.Slip]:
        """Of all legs."""
        spacing = self.scene.bodies.spacing
        return list(chain(*(friction.slips(leg["time"], leg["plate_x"], spacing, v) for v, leg in self.moving)))

    @property
    def period(self) -> float:
        """In which the drive passes a spacing on the last leg that moves [TU]."""
        return self.scene.bodies.spacing / abs(self.moving[-1][0])

    @cached_property
    def periods(self) -> Series:
        """Means over whole periods of that leg."""
        return self.moving[-1][1].periods(self.period)

    @cached_property
    def steady(self) -> friction.Mean:
        """Its friction after the run-in, by the balance of momentum; with noise by the records, if more certain.

        Raises:
            ValueError: see `mean_of`.
        """
        _, leg = self.moving[-1]
        means = [friction.mean_of(self.periods["friction"])]
        if not leg.smooth:
            means.append(friction.sampled_mean(leg["time"], leg["friction"], self.period))
        return min(means, key=lambda mean: mean.error)

    @cached_property
    def largest(self) -> dict[str, float]:
        """Largest friction and energy, by their unit: means may vanish beside the one, energies beside the other."""
        columns = {FORCE: [self.series["friction"]], ENERGY: list(self.energies.values())}
        return {unit: max(1e-300, float(np.abs(each).max())) for unit, each in columns.items()}

    @cached_property
    def results(self) -> dict[str, Result]:
        """What the slide gives."""
        found = self._energies() | {"slips": Result(float(len(self.slips)), NUMBER, {"statistics": 0.0})}
        if self.moving:
            found |= self._means() | self._static()
        if not self.series.smooth:
            found |= self._temperature()
        return {name: replace(one, scale=self.largest.get(one.unit)) for name, one in found.items()}

    def _energies(self) -> dict[str, Result]:
        """At the end; the residual of the balance is the uncertainty of each."""
        ends = {name: float(values[-1]) for name, values in self.energies.items()}
        errors = {"solver": abs(ends["cantilever_work"] - ends["dissipated_energy"] - ends["stored_energy"])}
        return {name: Result(end, ENERGY, errors, prescribed=name == "stored_energy") for name, end in ends.items()}

    def _means(self) -> dict[str, Result]:
        """Over whole periods of the last leg that moves, where it has enough of them."""
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
            values = {f"mean_{name}": math.copysign(1.0, velocity) * float(blocks.mean(name)) for name in FORCES}
            return {name: Reading(value, FORCE, {"solver": share * abs(value)}) for name, value in values.items()}

        return measured(Series(steady), read, friction.interval, {"sampling": Series(sparse)})

    def _static(self) -> dict[str, Result]:
        """The largest forces before the plate has moved by one spacing, where there is no other leg."""
        (velocity, leg), *others = self.moving
        sign, spacing = math.copysign(1.0, velocity), self.scene.bodies.spacing
        place = sign * leg["plate_x"]
        if others or place[-1] - place[0] < spacing:
            return {}
        share, found = SETTINGS_SHARE * self.settings.tolerance, {}
        for name in FORCES:
            top, missed = friction.largest_before(sign * leg[name], place, spacing)
            found[f"static_{name}"] = Result(top, FORCE, {"sampling": missed, "solver": share * abs(top)})
        return found

    def _temperature(self) -> dict[str, Result]:
        """M ⟨(V − ⟨V⟩)²⟩ of the plate's free directions in the last leg [FU·LU]; slips are part of it."""
        _, leg = self.legs[-1]
        mass = self.settings.motion.plate_mass

        def read(blocks: Series) -> dict[str, Reading]:
            energy = mass * (blocks.mean("square") - blocks.mean("velocity") ** 2) / DIRECTIONS
            return {"plate_temperature": Reading(float(energy), ENERGY)}

        return measured(leg.periods(float(np.ptp(leg["time"])) / TEMPERATURE_BLOCKS), read, friction.interval)

    @property
    def unsteady(self) -> str:
        """Why a slide of one leg is none, or not yet a steady one; "" where it is."""
        ((velocity, leg),) = self.moving
        time, place, count = leg["time"], leg["plate_x"], len(self.periods)
        if count < friction.FEWEST_PERIODS:
            periods = "1 whole period" if count == 1 else f"{count} whole periods"
            return (
                f"no steady sliding yet: the drive distance of {leg['drive'][-1]:.3g} LU has {periods} of "
                f"the spacing, and a mean needs {friction.FEWEST_PERIODS}"
            )
        if place[-1] < self.scene.bodies.spacing:
            return f"the plate moved by {place[-1]:.3g} LU only, which is not yet sliding{self._swing}"
        while_ = self.period * self.steady.blocks.size
        start = time[-1] - while_
        way = float(place[-1] - np.interp(start, time, place))
        sizes = [slip.size for slip in self.slips if slip.time > start]
        one = max(sizes) if len(sizes) > 1 else 0.0
        if abs(way - velocity * while_) > max(STEADY * velocity * while_, one):
            return (
                f"no steady sliding yet: over the last {while_:.3g} TU the plate moves at {way / while_:.3g} LU/TU and "
                f"the drive at {velocity:.3g}{self._swing}"
            )
        return ""

    @property
    def _swing(self) -> str:
        """That the period of the plate on its cantilever is longer than the slide; "" where it is not."""
        swing, time = cantilever_swing(self.scene, self.settings), self.series["time"][-1]
        if swing < time:
            return ""
        return (
            f". The plate of {self.settings.motion.plate_mass:.3g} MU on its cantilever has a period of {swing:.3g} TU,"
            f" and the drive moved for {time:.3g} TU: a lower cantilever.velocity or a lighter plate.mass helps, too"
        )


def motion_of(scene: Scene, settings: Settings, load: float, states: Sequence[State]) -> Motion:
    """Sum up a slide from the state at which its drive starts and those of all load steps, or of the first ones.

    Args:
        scene: with a cantilever.
        settings: with its drive.
        load: normal force [FU].
        states: the first one is that at which the drive starts.

    Returns:
        A series of the columns of friction.csv, and integrals over time of friction and cantilever force [FU·TU], of
        the plate's velocity [LU] and its square [LU²/TU].
    """
    bodies, moving, drive = scene.bodies, settings.motion, settings.motion.drive
    rows = [leg for leg in drive for _ in range(leg.rows)][: len(states) - 1]
    span, velocity, step = recorded(rows, ("row_time", "velocity", "time_step")).values()
    names = ("plate_x", "displacement", "force", "cantilever_force", "step")
    place, depth, normal, pull, steps = recorded(states, names).values()

    def read(name: str) -> Array:
        return np.asarray([state.motion[name] for state in states])

    def summed(parts: Array) -> Array:
        return np.concatenate([[0.0], np.cumsum(parts)])

    count = np.floor(steps / EVERY) + 1.0

    def summed_over_rows(mean: int, ends: Array) -> Array:
        """Integral of each load step: samples at every fifth step up to its end, made the trapezoid rule."""
        means = np.diff(count * read(f"f_cantilever_means[{mean}]")) / np.diff(count)
        return np.asarray(means * span - 0.5 * EVERY * step * np.diff(ends))

    drag, c, mass = settings.chains.upper * moving.damping, moving.plate_damping, moving.plate_mass
    heavy, heavy_plate = inertia(scene, settings)
    speeds = read("vcm(plate,x)") ** 2 + read("vcm(plate,z)") ** 2
    pulled, kinetic = summed_over_rows(1, pull), summed_over_rows(2, read("cantilever_kinetic"))
    squares = 2.0 / heavy_plate * summed_over_rows(3, 0.5 * heavy_plate * speeds)
    lost = 2.0 * moving.damping / heavy * kinetic + c * squares
    if heat := [name for name in HEAT if name in states[-1].motion]:
        lost = np.asarray([sum(state.motion[name] for name in heat) for state in states[1:]])
    driven, gone, carried = summed(velocity * span), place - place[0], read("xcm(upper,x)")
    momentum = settings.chains.upper * bodies.mass * read("vcm(upper,x)") + mass * read("vcm(plate,x)")
    dragged = drag * (driven - carried) + c * (driven - gone) - momentum
    energy = read("c_measuring_energy") + bodies.mass / heavy * read("cantilever_kinetic") + 0.5 * mass * speeds
    energy += 0.5 * pull**2 / scene.the(Cantilever).stiffness - load * depth
    energies = {
        "cantilever_work": summed(velocity * pulled),
        "dissipated_energy": summed(lost - velocity * np.diff(drag * carried + c * gone)),
        "stored_energy": energy - energy[0],
    }
    columns = {
        "time": summed(span),
        "drive": driven,
        "plate_x": gone,
        "plate_z": -depth,
        "friction": np.asarray([-bodies.own_spacing * float(state.profile.shear.sum()) for state in states]),
        "normal_force": normal,
        "cantilever_force": pull,
        "cantilever_work": energies["cantilever_work"],
    }
    integrals = {
        "friction": summed(pulled) + dragged - dragged[0],
        "cantilever_force": summed(pulled),
        "velocity": gone,
        "square": summed(squares),
    }
    series = Series(columns, integrals, smooth=not heat)  # under heat a force says little of the time around it
    return Motion(scene, settings, series, energies)
