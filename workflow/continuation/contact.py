"""A contact in LAMMPS: it runs load steps of a schedule and returns a measured, accepted state of each."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Array, Profile, penetration_depth, pressure_profile, smallest_distance
from contact1d.workflow.continuation.state import State, radius_rule
from contact1d.workflow.continuation.trust import is_converged, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies, period
from contact1d.workflow.deck.parts import plane_depth
from contact1d.workflow.deck.steps import Displace, Draw, Phase, Row, swept
from contact1d.workflow.deck.system import ANCHORS, PARTICLES
from contact1d.workflow.engine.failure import NOT_FINITE
from contact1d.workflow.engine.frames import last_frames
from contact1d.workflow.engine.progress import Meanwhile
from contact1d.workflow.engine.session import EngineError, Session

ATOM_UNITS = {"x": "LU", "v_opposite_x": "FU", "v_opposite_z": "FU"}
"""Quantities that are measured of every atom, and their units; beside them is the force on it, `Contact.force_name`."""
BATCH = 8
"""Load steps that go to LAMMPS at a time where they are known beforehand: waking two processes takes as long as one."""
HEAT = ("heat_particles", "heat_plate")
"""Energy that the heat baths of particles and plate took in a load step [FU·LU]."""
MOTION = {
    "f_cantilever_means[1]": "FU", "f_cantilever_means[2]": "FU·LU", "f_cantilever_means[3]": "FU·LU",
    "measuring_energy": "FU·LU", "cantilever_kinetic": "FU·LU", "vcm(plate,x)": "LU/TU", "vcm(plate,z)": "LU/TU",
    "vcm(upper,x)": "LU/TU", "xcm(upper,x)": "LU",
}  # fmt: skip
"""Of a slide: means since the start over every fifth step of the cantilever's force and of the kinetic energies of
particles and plate; energies; velocities and positions."""
PLACE, SLIP_VELOCITY = "xcm(plate,x)", "vcm(plate,x)"
"""LAMMPS's names of the position and velocity along x of the contact point of a body that hits obliquely."""
HEAT_FRAGMENT = "steps/tallied_heat"
"""The fragment after which a heat bath reports the energy that it takes."""
FRAMES = "rows.bin"
"""File of a frame for each load step of a single run: id, z, force along z, and along x if that is prescribed."""
MOST_NUMBERS = 1_000_000
"""Largest count of numbers in the frames that are read at once, to bound the memory."""


class Contact:
    """A running deck. It records its schedule: `phases` is the content of in.lammps that repeats it.

    Attributes:
        deck, scene, settings: of the contact.
        session: LAMMPS.
        rows_seconds: time in LAMMPS for load steps [s].
    """

    def __init__(self, deck: Deck, session: Session, meanwhile: Meanwhile = None) -> None:
        """Set up the bodies in the LAMMPS session, by the first commands of the deck.

        `meanwhile` is called while LAMMPS reads the bodies.

        Raises:
            EngineError: LAMMPS failed.
        """
        self.deck, self.scene, self.settings, self.session = deck, deck.scene, deck.settings, session
        self.rows_seconds = 0.0  # wall time of the rows in LAMMPS
        self._phases: list[Phase] = []
        self._unfinished = ""
        self._written = self._heat_is_reported = False
        self._latest: list[State] = []
        self._rule = radius_rule(deck.scene, deck.settings.tolerance)
        self._pushes = tuple(part.pushes for part in deck.parts if part.pushes)
        session.execute(deck.head, phase="setting up", meanwhile=meanwhile)
        if deck.stepped:
            self._x = bodies(deck.scene, deck.settings)[0].particles[:, 0]
            self._nothing = np.zeros_like(self._x)
            self._read = 0  # bytes of the frames' file

    @property
    def phases(self) -> tuple[Phase, ...]:
        """The load steps so far as named phases, in order, the current one included; () before the first phase."""
        return tuple(self._phases)

    def begin(self, name: str, fragments: tuple[str, ...] = (), expected_steps: int | None = None) -> None:
        """Begin a phase of load steps; its `fragments` of LAMMPS commands, by name, run with its first load step.

        `expected_steps`: timesteps of the whole phase, shown as progress; None where unknown. The `name` is used as it
        is.
        """
        end = "variable        row_phase delete\n" if self._phases else ""
        self._phases.append(Phase(name, (), begin=fragments))
        self._unfinished += end + self.deck.begin(name, fragments)
        self._heat_is_reported = self._heat_is_reported or HEAT_FRAGMENT in fragments
        self.session.execute("", phase=name, expected_steps=expected_steps)

    def begin_phase(self, phase: Phase) -> Sequence[Row]:
        """Begin a phase and return its load steps, none of which has been run."""
        self.begin(phase.name, phase.begin, sum(getattr(row, "steps", 0) for row in phase.rows) or None)
        return phase.rows

    def row(self, row: Row, trusted: bool = True) -> State:
        """Run one load step of the current phase and return its measured state.

        `trusted`: whether the state must be a result, and is checked.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
            UntrustedError: where `trusted`: bodies went through each other, particles are not at rest (unless there
                is a plate or noise), or the contact reaches the end of the chain.
        """
        return self.rows((row,), trusted)[0]

    def rows(self, rows: Sequence[Row], trusted: bool = True, moving: bool = False) -> list[State]:
        """Run load steps of the current phase, known beforehand, and return the measured state of each, in order.

        Args:
            rows: all of the same class; [] for none. Where all load steps are one run (quasi-static on a rigid plane)
                only displacements (`Displace`) are run, others are left out.
            trusted: whether each state must be a result, and is checked; False for states before equilibrium.
            moving: whether the motion itself is examined, so that nothing has to be at rest.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
            UntrustedError: where `trusted`: bodies went through each other, particles are not at rest (unless
                `moving`, with a plate or noise), or the contact reaches the end of the chain.
        """
        states, size = list[State](), BATCH
        if self.deck.stepped:
            positions = np.asarray([row.displacement for row in rows if isinstance(row, Displace)])
            rows, size = swept(self.deck.as_read({"displacement": positions})), self._at_once
        before = self.session.lammps_seconds
        for start in range(0, len(rows), size):
            batch, name = rows[start : start + size], self._phases[-1].name
            first = sum(len(phase.rows) for phase in self._phases)
            self._phases[-1] = replace(self._phases[-1], rows=(*self._phases[-1].rows, *batch))
            if self.deck.stepped:
                text, self._unfinished = self._unfinished + self.deck.in_one_run(batch), ""
                self._latest = self._states_of_run(text, [(name, row) for row in batch], first, self._compute_radii)
            else:
                self._latest = self._measured(batch, first)
            for state in self._latest if trusted else ():
                require_trust(self.scene, self.settings, state, moving)
            states += self._latest
        self.rows_seconds += self.session.lammps_seconds - before
        return states

    def write_state(self) -> None:
        """Have the atoms of the last load step written to states.lammpstrj, at the latest by `finish`.

        The phase ends with this state.
        """
        self._phases[-1] = replace(self._phases[-1], state=True)
        self._unfinished += self.deck.state(first=not self._written)
        self._written = True

    def finish(self) -> None:
        """Run the LAMMPS commands that remain after the last load step, and delete the file of frames, if any."""
        self.session.execute(self._unfinished, phase=self._phases[-1].name)
        self._unfinished = ""
        (self.session.folder / FRAMES).unlink(missing_ok=True)

    def replay(self, phases: Sequence[Phase], relaxed: bool = False, meanwhile: Meanwhile = None) -> list[State]:
        """Run all load steps of `phases`, finish the contact, and return one state for each load step, in order.

        Args:
            phases: one at least, with load steps, the first of the contact.
            relaxed: whether a load step in time is repeated until at rest; its last state is returned. Ignored
                where all load steps are one run (quasi-static on a rigid plane).
            meanwhile: called while LAMMPS runs, where all load steps are one run; else ignored.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
            UntrustedError: a state is no result; not checked where all load steps are one run, nor with noise
                unless `relaxed`.
        """
        if self.deck.stepped:
            self._phases, named = [*phases], [(phase.name, row) for phase in phases for row in phase.rows]
            self.session.execute("", phase=phases[0].name)
            states = self._states_of_run(self.deck.schedule(phases), named, 0, meanwhile)
            self.rows_seconds = self.session.lammps_seconds
            (self.session.folder / FRAMES).unlink(missing_ok=True)
            return states
        states = []
        trusted = not self.scene.noise
        for phase in phases:
            rows = self.begin_phase(phase)
            states += [self._relaxed(row) for row in rows] if relaxed else self.rows(rows, trusted)
            if phase.state:
                self.write_state()
        self.finish()
        return states

    def _relaxed(self, row: Row, most: int = 200) -> State:
        """Run a load step, repeat it until it is relaxed, `most` times at the most, and return its last state.

        Relaxed means that no particle's residual force exceeds a tenth of the tolerance. Near an instability the motion
        slows without bound.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
            UntrustedError: the last state is no result; without plate and noise also where it is not relaxed.
        """
        state, repeats = self.row(row, trusted=False), 0
        while not is_converged(self.settings, state) and repeats < most:
            state, repeats = self.row(row, trusted=False), repeats + 1
        require_trust(self.scene, self.settings, state)
        return state

    def _measured(self, rows: Sequence[Row], first: int) -> list[State]:
        """Run load steps one by one and return the state of each, in order, in LU, FU and TU; nothing is checked.

        `first`: number of the first one over all phases.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
        """
        texts = []
        for row in rows:
            texts.append(self._unfinished + self.deck.values(row, not self._written) + self.deck.row(type(row)))
            self._written = self._written or self.deck.keeps
            self._unfinished = self.deck.row_end(type(row))
        names = self._values()
        kinds = ATOM_UNITS | {self.force_name: "FU"}
        readings = self.session.measure_rows(texts, tuple(names), tuple(kinds), meanwhile=self._compute_radii)
        units, phase, settings, states = self.deck.units, self._phases[-1].name, self.settings, list[State]()
        for number, (row, reading) in enumerate(zip(rows, readings, strict=True), first):
            numbers = {name: units.from_deck(v, names[name]) for name, v in zip(names, reading.values, strict=True)}
            atoms = {n: units.from_deck(rows, kinds.get(n, "1")) for n, rows in reading.atoms.items()}
            state = self._state(phase, numbers, atoms, number)
            if self.scene.plate and self.scene.stands:
                drag = settings.drag(getattr(row, "damping", None)) * state.plate_velocity
                pushed = state.force - getattr(row, "load", 0.0) + drag
                state = replace(state, missing=numbers["plate_force"] - pushed)
            states.append(state)
        return states

    @property
    def _at_once(self) -> int:
        """The number of load steps whose frames are read at a time: 10⁶ over the number of particles, one at least."""
        return max(1, MOST_NUMBERS // len(self._x))

    def _states_of_run(
        self, text: str, rows: Sequence[tuple[str, Row]], first: int, meanwhile: Meanwhile
    ) -> list[State]:
        """Run load steps that are one run on a rigid plane, a timestep each without relaxation; return their states.

        Args:
            text: LAMMPS commands of the run.
            rows: the load steps, each with the name of its phase.
            first: number of the first one over all phases.
            meanwhile: called while LAMMPS runs.

        Raises:
            EngineError: LAMMPS failed, particles were lost, or a number is not finite.
        """
        began = self.session.timestep
        self.session.measure(text, meanwhile=meanwhile)
        spacing, settings, states = self.scene.bodies.spacing, self.settings, list[State]()
        # The wall's force is a difference of distances from far below.
        depth = plane_depth(self.scene, settings)
        round_off = sys.float_info.epsilon * depth * settings.forces.plane_stiffness
        for start in range(0, len(rows), self._at_once):
            batch = rows[start : start + self._at_once]
            profiles, end = self._profiles(len(rows), slice(start, start + len(batch)))
            for i, ((phase, row), profile) in enumerate(zip(batch, profiles, strict=True), start):
                assert isinstance(row, Displace | Draw)
                force, closest = spacing * float(profile.pressure.sum()), float(profile.z_upper.min())
                states.append(
                    State(phase, row.displacement, force, profile, self._rule, closest, 0.0, round_off,
                          plate_x=getattr(row, "place", 0.0), step=float(began + i + 1), number=first + i)
                )  # fmt: skip
        self._read = end
        return states

    def _profiles(self, count: int, part: slice) -> tuple[list[Profile], int]:
        """Return (pressure profiles of a part of the last `count` load steps, bytes of the file of frames read so far).

        x [LU] is from the middle of the body. Surfaces of particles are at their heights [LU], of loaded ones at 0, on
        the plane; shear is 0 unless the scene prescribes positions along x. Pressure and shear are in FU/LU.

        Raises:
            EngineError: particles were lost, or a number is not finite.
        """
        path, along = self.session.folder / FRAMES, self.scene.experiment.goes_along
        try:
            frames, end = last_frames(path, count, len(self._x), 4 if along else 3, self._read, part)
        except ValueError:
            raise self._lost("atoms are missing", self.session.timestep) from None
        if not np.isfinite(frames).all():
            raise self._lost(NOT_FINITE, self.session.timestep)
        units, spacing, none = self.deck.units, self.scene.bodies.spacing, self._nothing
        heights = units.from_deck(frames[:, :, 0], "LU")
        pressures = units.from_deck(frames[:, :, 1], "FU") / spacing
        surfaces = np.where(pressures != 0.0, 0.0, heights)
        shears = units.from_deck(frames[:, :, 2], "FU") / spacing if along else np.broadcast_to(none, pressures.shape)
        return [Profile(self._x, none, z, p, q) for z, p, q in zip(surfaces, pressures, shears, strict=True)], end

    def _compute_radii(self) -> None:
        """Compute and cache the contact radii of the latest load steps, while LAMMPS runs the next ones.

        A radius that cannot be read is left out; the error comes where it is used.
        """
        for state in self._latest:
            with suppress(ValueError):  # reported where the radius is asked for
                _ = state.radius

    @property
    def force_name(self) -> str:
        """The LAMMPS name of the force on every atom: with an interaction that before springs were off to measure."""
        return "f_measuring_residual" if self.scene.interaction else "f"

    def _values(self) -> dict[str, str]:
        """Return {LAMMPS name: unit of the model} of the numbers that are measured, besides those of atoms.

        Always the plate's displacement "LU" and the timestep "1"; with a plate, a cantilever, heat baths or other
        effects theirs, too.
        """
        names = {"plate_displacement": "LU", "step": "1"}
        if self.scene.plate:
            names |= {"plate_velocity": "LU/TU", "plate_force": "FU"}
        if self.scene.is_oblique:
            names |= {PLACE: "LU", SLIP_VELOCITY: "LU/TU"}
        if self.scene.cantilever:
            names |= {"cantilever_plate": "LU", "cantilever_force": "FU"} | MOTION
            if self._heat_is_reported:
                names |= dict.fromkeys(HEAT if self.settings.motion.plate_damping > 0.0 else HEAT[:1], "FU·LU")
        return names | dict.fromkeys(self._pushes, "FU")

    def _lost(self, message: str, step: int) -> EngineError:
        """Return (not raise) the error of this message at a timestep, with the phase and the folder of the run."""
        return EngineError(message, self._phases[-1].name, step, self.session.folder, "")

    def _state(self, phase: str, numbers: dict[str, float], atoms: dict[str, Array], number: int) -> State:
        """Return the state of a load step, in LU, FU and TU.

        On a rigid plane the surface of a particle that lies below it is at the particle, and the depth 0; where
        particles are fixed in the upper body, that of a loaded particle is on the plane and the residual 0.

        Args:
            phase: its name.
            numbers: measured quantities by the names of `_values`, all of them, in LU, FU and TU.
            atoms: arrays by the names of `ATOM_UNITS` and `force_name`, and "type", a row for each atom.
            number: of the load step over all phases.

        Raises:
            EngineError: particles are missing.
        """
        upper, lower = (atoms["type"] == PARTICLES[body] for body in ("upper", "lower"))
        count = int(upper.sum() + lower.sum())
        opposite = 0 if self.scene.bodies.lower == "rigid_plane" else self.settings.chains.lower
        if count < self.settings.chains.upper + opposite:
            # LAMMPS looks for lost atoms when it makes a new neighbour list, and a load step may end before.
            raise self._lost(f"atoms are missing: only {count} particles are left in the box", int(numbers["step"]))
        position, force = atoms["x"], atoms[self.force_name]
        plate_x = numbers.get(PLACE, numbers.get("cantilever_plate", 0.0))
        x, z = position[upper, 0] - numbers.get(PLACE, 0.0), position[upper, 2]
        if lower.any():
            x_low, z_low = self._surface(position[lower, 0], position[lower, 2])
            closest = smallest_distance(x, z, x_low, z_low)
            depth = penetration_depth(x, z, x_low, z_low)
            z_below = np.interp(x, x_low, z_low)
        else:
            # A particle penetrates a plane of finite stiffness: the surface is at the particle.
            closest, depth = float(max(z.min(), 0.0)), 0.0
            if self.scene.stands:
                z = np.where(atoms["v_opposite_z"][upper] != 0.0, 0.0, z)
                force = np.zeros_like(force)  # a particle has no motion relative to its support
            z_below = np.minimum(z, 0.0)
        profile = pressure_profile(
            x, z, z_below, atoms["v_opposite_x"][upper], atoms["v_opposite_z"][upper], self.scene.bodies.own_spacing
        )
        free = [0, 2] if self.scene.horizontal else [2]
        moving = upper if self.scene.bodies.lower == "rigid_chain" else upper | lower
        return State(
            phase=phase,
            displacement=numbers["plate_displacement"],
            force=float(atoms["v_opposite_z"][upper].sum()),
            profile=profile,
            rule=self._rule,
            smallest_distance=closest,
            depth=depth,
            residual=float(np.abs(force[moving][:, free]).max()),
            missing=self._missing(atoms, upper),
            pushed=float(sum(numbers[name] for name in self._pushes)),
            plate_velocity=-numbers.get("plate_velocity", 0.0),
            plate_x=plate_x,
            cantilever_force=numbers.get("cantilever_force", 0.0),
            step=numbers["step"],
            motion={name: numbers[name] for name in (*MOTION, *HEAT, SLIP_VELOCITY) if name in numbers},
            number=number,
        )

    def _missing(self, atoms: dict[str, Array], upper: NDArray[np.bool_]) -> float | None:
        """Return the sum of contact and spring forces on the upper particles along z [FU], 0 in equilibrium.

        Compression of the contact is positive. None where it may differ from 0 or is unknown: without springs of the
        upper particles, in a dynamic run, and with [horizontal] whose springs have another stiffness along x.
        """
        springs = atoms["type"] == ANCHORS["upper"]
        if not springs.any() or self.scene.method != "quasistatic" or self.settings.chains.far:
            return None
        stretch = float(np.sum(atoms["x"][springs, 2] - atoms["x"][upper, 2]))
        return float(atoms["v_opposite_z"][upper].sum()) + self.settings.forces.bulk_stiffness * stretch

    def _surface(self, x: Array, z: Array) -> tuple[Array, Array]:
        """Return positions x and heights z of the lower particles [LU], (k,) each; (3k,) of a periodic chain.

        Those of a periodic chain are followed by their copies on both sides: x less a period, x, x plus a period.
        """
        if not self.scene.bodies.periodic:
            return x, z
        length = period(self.scene, self.settings)
        return np.concatenate([x - length, x, x + length]), np.tile(z, 3)
