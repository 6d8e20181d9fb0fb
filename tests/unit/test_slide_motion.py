"""Claims of what a slide's rows are summed up to: energy and momentum are conserved, means are over whole periods.

Reference: a motion that is given by formulas. Forces are what Newton's law asks for, integrals are done by quadrature
over fine steps; rows hold what LAMMPS would tell of it, running means over every fifth timestep.
"""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.workflow.experiments.slide.findings import energies, is_steady, means, outcome_of, slips_of, temperature
from contact1d.workflow.experiments.slide.motion import EVERY, Motion, motion_of
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.drive import DriveLeg
from contact1d.workflow.settings.inertia import inertia
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.unit.test_settings_similarity import SCENES

Array = NDArray[np.float64]
SAMPLED = 2e-4
"""Relative: trapezoids of five timesteps each."""
BEFORE = 40
"""Timesteps of the loading, whose means count no more."""


def scene_of(**slide: Any) -> Scene:
    """A dozen particles, with springs of their own to a plate that is drawn by a cantilever."""
    tables = SCENES["slide of few particles over another spacing"]
    return scene_from_dict(tables | {"experiment": tables["experiment"] | slide})


State = Any


class Given:
    """A motion in formulas of time [TU]: X of the plate, x of the particles' middle, all of both legs of the drive."""

    def __init__(self, scene: Scene, settings: Settings) -> None:
        self.scene, self.settings = scene, settings
        self.legs: tuple[DriveLeg, ...] = settings.drive
        self.ends = np.cumsum([leg.rows * leg.row_time for leg in self.legs])
        self.fast = 2.0 * np.pi * abs(self.legs[0].velocity) / scene.bodies.spacing  # once each spacing of the drive
        self.mass, (self.heavy, self.heavy_plate) = settings.plate_mass, inertia(scene, settings)

    def drive(self, t: Array) -> Array:
        """Place of the driven end [LU]."""
        starts = np.concatenate([[0.0], self.ends[:-1]])
        parts = (
            leg.velocity * np.clip(t - s, 0.0, e - s) for leg, s, e in zip(self.legs, starts, self.ends, strict=True)
        )
        return np.asarray(sum(parts))

    def velocity(self, t: Array) -> Array:
        """Of the driven end [LU/TU]."""
        return np.asarray([leg.velocity for leg in self.legs])[
            np.searchsorted(self.ends, t, side="left").clip(max=len(self.legs) - 1)
        ]

    def swing(self, t: Array, order: int = 0) -> Array:
        """A swing about the drive's place, and its derivatives."""
        w = self.fast
        return np.asarray([0.02 * (1.0 - np.cos(w * t)), 0.02 * w * np.sin(w * t), 0.02 * w**2 * np.cos(w * t)][order])

    def place(self, t: Array) -> Array:
        """X of the plate [LU]."""
        return self.drive(t) - self.swing(t)

    def particles(self, t: Array) -> Array:
        """x of the particles' middle [LU]: they swing by half as much again."""
        return self.drive(t) - 1.5 * self.swing(t)

    def pull(self, t: Array) -> Array:
        """Of the cantilever [FU]."""
        assert self.scene.cantilever is not None
        return self.scene.cantilever.stiffness * (0.2 + self.drive(t) - self.place(t))

    def kinetic(self, t: Array) -> Array:
        """Of the particles, with the mass that LAMMPS gives them [FU·LU]."""
        return 0.5 * self.heavy * self.settings.particles * (self.velocity(t) - 1.5 * self.swing(t, 1)) ** 2

    def speeds(self, t: Array) -> Array:
        """V² of the plate, which also moves up and down [LU²/TU²]."""
        return (self.velocity(t) - self.swing(t, 1)) ** 2 + (0.1 * self.swing(t, 1)) ** 2

    def kinetic_of_plate(self, t: Array) -> Array:
        """With the mass that LAMMPS gives it [FU·LU]."""
        return 0.5 * self.heavy_plate * self.speeds(t)

    def depth(self, t: Array) -> Array:
        """Displacement [LU]."""
        return 0.3 + 0.1 * self.swing(t)

    def friction(self, t: Array) -> Array:
        """By Newton's law of particles and plate, with drag against what moves with the drive [FU]."""
        own, settings = self.scene.bodies.mass * self.settings.particles, self.settings
        dragged = settings.particles * settings.damping * 1.5 + settings.plate_damping
        momentum = -(1.5 * own + self.mass) * self.swing(t, 2)
        return np.asarray(self.pull(t) + dragged * self.swing(t, 1) - momentum)


def rows_of(given: Given, potential: Any = lambda t: 0.0 * t) -> tuple[State, list[State]]:
    """What the rows tell, the one before the drive starts first."""
    leg = [leg for leg in given.legs for _ in range(leg.rows)]
    steps = BEFORE + np.concatenate([[0], np.cumsum([one.steps for one in leg])])
    ends = np.concatenate([[0.0], np.cumsum([one.row_time for one in leg])])
    sampled = np.concatenate([[0.0], *(
        end + one.time_step * np.arange(EVERY, one.steps + 1, EVERY) for one, end in zip(leg, ends, strict=False)
    )])  # fmt: skip
    counts = (steps - BEFORE) // EVERY + 1
    before = BEFORE // EVERY

    def running(values: Array, junk: float) -> Array:
        """Means since the first timestep of all, with something else before the drive."""
        sums = np.cumsum(values)[counts - 1] + junk * before
        return np.asarray(sums / (counts + before))

    told = [running(of(sampled), 7.0) for of in (given.pull, given.kinetic, given.kinetic_of_plate)]
    states = []
    for i, t in enumerate(ends):
        at = np.asarray([t])
        velocity, turn = given.velocity(at), given.swing(at, 1)
        motion = {f"f_cantilever_means[{n + 1}]": float(told[n][i]) for n in range(3)} | {
            "c_measuring_energy": float(np.asarray(potential(at))[0]),
            "cantilever_kinetic": float(given.kinetic(at)[0]),
            "vcm(plate,x)": float((velocity - turn)[0]),
            "vcm(plate,z)": float((0.1 * turn)[0]),
            "vcm(upper,x)": float((velocity - 1.5 * turn)[0]),
            "xcm(upper,x)": float(given.particles(at)[0]) + 3.0,
        }
        count = given.settings.particles
        x = np.arange(count) - 0.5 * (count - 1)
        shear = np.full(count, -given.friction(at)[0] / count / given.scene.bodies.own_spacing)
        states.append(SimpleNamespace(
            motion=motion, step=float(steps[i]), plate_x=float(given.place(at)[0]) + 0.5, radius=None,
            cantilever_force=float(given.pull(at)[0]), displacement=float(given.depth(at)[0]),
            profile=Profile(x, 0.0 * x, 0.0 * x + 0.2, np.exp(-x**2), shear), force=1.0, smallest_distance=0.2,
        ))  # fmt: skip
    return states[0], states[1:]


def integral(given: Given, of: Any, ends: Array) -> Array:
    """By trapezoids of a thousandth of each row."""
    fine = np.interp(np.arange(1000 * (ends.size - 1) + 1) / 1000.0, np.arange(ends.size), ends)
    middle = 0.5 * (fine[1:] + fine[:-1])
    sums = np.concatenate([[0.0], np.cumsum(of(middle) * np.diff(fine))])
    return np.asarray(sums[::1000])


@pytest.fixture(scope="module")
def given() -> Given:
    scene = scene_of()
    return Given(scene, settings_for(scene))


@pytest.fixture(scope="module")
def motion(given: Given) -> Motion:
    return motion_of(given.scene, given.settings, *rows_of(given))


def near(ours: Array, known: Array, size: float = 0.0) -> None:
    assert ours == pytest.approx(known, abs=SAMPLED * max(size, float(np.ptp(known))))


def test_sums_over_the_rows_are_the_integrals_over_time(given: Given, motion: Motion) -> None:
    ends = motion.time
    assert ends[-1] == pytest.approx(given.ends[-1], rel=1e-12)
    assert motion.drive == pytest.approx(given.drive(ends), abs=1e-9)
    assert motion.place == pytest.approx(given.place(ends) - given.place(ends[:1]), abs=1e-9)
    assert motion.friction == pytest.approx(given.friction(ends), rel=1e-9)
    assert motion.pull == pytest.approx(given.pull(ends), rel=1e-9)
    near(motion.pulled, integral(given, given.pull, ends))
    near(motion.squares, integral(given, given.speeds, ends))
    near(motion.work, integral(given, lambda t: given.velocity(t) * given.pull(t), ends))
    near(motion.impulse, integral(given, given.friction, ends))


def test_what_the_drag_takes_is_what_it_takes_from_each_that_moves(given: Given, motion: Motion) -> None:
    """∫ Σ γ v (v − V_drive) + c (V (V − V_drive) + V_z²) dt, V_drive that of the drive."""
    settings = given.settings

    def power(t: Array) -> Array:
        drive, turn = given.velocity(t), given.swing(t, 1)
        of_plate = (drive - turn) ** 2 + (0.1 * turn) ** 2
        own = settings.particles * settings.damping
        along = own * drive * (drive - 1.5 * turn) + settings.plate_damping * drive * (drive - turn)
        return own * (drive - 1.5 * turn) ** 2 + settings.plate_damping * of_plate - along

    near(motion.dissipated, integral(given, power, motion.time), size=3.0 * float(np.ptp(motion.squares)))


def test_what_is_stored_is_that_of_springs_masses_and_the_load(given: Given) -> None:
    scene = given.scene
    assert scene.cantilever is not None
    stiffness, load = scene.cantilever.stiffness, 1.0
    found = motion_of(scene, given.settings, *rows_of(given, lambda t: 0.4 * given.swing(t)))
    t = found.time
    moving = 0.5 * scene.bodies.mass * given.kinetic(t) / (0.5 * given.heavy) + 0.5 * given.mass * given.speeds(t)
    energy = 0.4 * given.swing(t) + moving + 0.5 * given.pull(t) ** 2 / stiffness - load * given.depth(t)
    assert found.stored == pytest.approx(energy - energy[0], rel=1e-9, abs=1e-12)


def test_baths_tell_what_they_took(given: Given) -> None:
    start, states = rows_of(given)
    for number, state in enumerate(states):
        state.motion |= {"heat_particles": 0.5 * number, "heat_plate": 0.25}
    found = motion_of(given.scene, given.settings, start, states)
    drags = given.settings.particles * given.settings.damping, given.settings.plate_damping
    taken = np.diff(np.concatenate([[0.0], np.cumsum([0.5 * n + 0.25 for n in range(len(states))])]))
    moved = (np.diff(place(found.time)) for place in (given.particles, given.place))
    along = given.legs[0].velocity * sum(drag * way for drag, way in zip(drags, moved, strict=True))
    assert np.diff(found.dissipated) == pytest.approx(taken - along)


def test_a_slide_that_ended_early_is_its_first_rows(given: Given, motion: Motion) -> None:
    start, states = rows_of(given)
    found = motion_of(given.scene, given.settings, start, states[:30])
    for name in ("time", "drive", "place", "impulse", "work", "dissipated", "stored", "leg"):
        assert getattr(found, name) == pytest.approx(getattr(motion, name)[:31]), name


def test_means_are_over_whole_periods_and_energies_claim_what_is_missing(given: Given, motion: Motion) -> None:
    found = means(given.scene, given.settings, motion)
    period = given.scene.bodies.spacing / given.legs[0].velocity
    fine = np.linspace(period, 2.0 * period, 4001)
    for name, of in (("mean_friction", given.friction), ("mean_cantilever_force", given.pull)):
        known = float(np.trapezoid(of(fine), fine) / period)
        assert abs(found[name].value - known) <= found[name].uncertainty
        assert found[name].uncertainty < 0.01 * given.settings.tolerance * 100.0 * abs(known)
    top = found["static_friction"]
    assert abs(top.value - float(given.friction(np.linspace(0.0, period, 4001)).max())) <= top.uncertainty
    kept = energies(motion)
    missing = kept["cantilever_work"].value - kept["dissipated_energy"].value - kept["stored_energy"].value
    assert [known.uncertainty for known in kept.values()] == pytest.approx([abs(missing)] * 3)
    assert kept["cantilever_work"].value == pytest.approx(motion.work[-1])
    assert slips_of(given.scene, motion) == []
    assert is_steady(given.scene, given.settings, motion) == ""


def test_a_drive_to_the_left_has_the_same_friction(given: Given, motion: Motion) -> None:
    """Friction, means and pull are those against the motion."""
    leg = replace(given.legs[0], velocity=-given.legs[0].velocity)
    turned = replace(motion, legs=(leg,), **{
        name: -getattr(motion, name) for name in ("drive", "place", "friction", "pull", "impulse", "pulled")
    })  # fmt: skip
    ours, theirs = (means(given.scene, given.settings, one) for one in (motion, turned))
    for name, known in ours.items():
        assert theirs[name].value == pytest.approx(known.value), name
        assert theirs[name].uncertainty == pytest.approx(known.uncertainty), name


def test_the_temperature_of_a_plate_is_the_square_of_its_swing(given: Given, motion: Motion) -> None:
    """M ⟨(V − ⟨V⟩)²⟩ over both directions, of a swing whose speed's amplitude is 0.02 ω along x and a tenth in z."""
    scene = given.scene.model_copy(update={"noise": SimpleNamespace(temperature=1.0)})
    found = temperature(scene, given.settings, motion)["plate_temperature"]
    known = given.mass * 0.5 * (0.02 * given.fast) ** 2 * 1.01 / 2.0
    assert found.value == pytest.approx(known, rel=0.1)
    assert abs(found.value - known) <= found.uncertainty
    assert temperature(given.scene, given.settings, motion) == {}


def test_what_is_handed_over_is_compared_with_the_largest_of_the_way(given: Given) -> None:
    start, states = rows_of(given)
    deck: Any = SimpleNamespace(scene=given.scene, settings=given.settings)
    found = outcome_of(deck, start, states, ())
    known = motion_of(given.scene, given.settings, start, states)
    assert found.compared_with["mean_friction"] == pytest.approx(np.abs(known.friction).max())
    largest = max(np.abs(values).max() for values in (known.work, known.dissipated, known.stored))
    assert found.compared_with["cantilever_work"] == pytest.approx(largest)
    assert "slips" not in found.compared_with
    columns = found.friction
    assert {len(column) for column in columns.values()} == {len(states)}
    assert columns["time"][-1] == pytest.approx(known.time[-1])
    assert columns["plate_z"] == pytest.approx([-state.displacement for state in states])
    told = known.work[-1] - known.dissipated[-1] - known.stored[-1]
    assert ("energy" in found.warnings) == (abs(told) > 5e-3 * largest)


@pytest.mark.parametrize(("share", "doubted"), [(0.7, False), (1.5, True)])
def test_an_energy_that_is_missing_is_compared_with_the_largest_of_the_three(
    given: Given, share: float, doubted: bool
) -> None:
    """It is put into what is stored, evenly over the way, and taken to the bound of half a percent."""
    start, states = rows_of(given)
    known = motion_of(given.scene, given.settings, start, states)
    largest = max(np.abs(values).max() for values in (known.work, known.dissipated, known.stored))
    told = known.work[-1] - known.dissipated[-1] - known.stored[-1]
    extra = -share * 5e-3 * largest + told
    for state, part in zip(states, np.linspace(0.0, extra, len(states)), strict=True):
        state.motion["c_measuring_energy"] += part
    deck: Any = SimpleNamespace(scene=given.scene, settings=given.settings)
    assert ("energy" in outcome_of(deck, start, states, ()).warnings) == doubted
