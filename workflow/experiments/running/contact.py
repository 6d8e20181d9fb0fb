"""A contact under way: rows of a schedule go to LAMMPS one by one, and each comes back as a measured state."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property, partial

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile, interpenetration, pressure_profile, smallest_distance
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.deck.datafile import PARTICLES
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import period
from contact1d.workflow.deck.steps import Displace, Draw, Phase, Row
from contact1d.workflow.engine.session import EngineError, Session
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.stepped import FRAMES, SteppedRows
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.centring import left_by_centring
from contact1d.workflow.settings.settings import Settings

Array = NDArray[np.float64]
ATOM_UNITS = {"x": "LU", "f": "FU", "v_opposite_x": "FU", "v_opposite_z": "FU"}
"""What is measured of every atom, and its unit."""
BATCH = 8
"""Rows that go to LAMMPS at a time where they are known beforehand: waking two processes takes as long as a row."""
HEAT = ("heat_particles", "heat_plate")
"""Energy that the heat baths of particles and plate took in a row [FU·LU]."""
MOTION = {
    "f_cantilever_means[1]": "FU", "f_cantilever_means[2]": "FU·LU", "f_cantilever_means[3]": "FU·LU",
    "c_measuring_energy": "FU·LU", "cantilever_kinetic": "FU·LU", "vcm(plate,x)": "LU/TU", "vcm(plate,z)": "LU/TU",
    "vcm(upper,x)": "LU/TU", "xcm(upper,x)": "LU",
}  # fmt: skip
"""Of a slide: means since the start over every fifth step of the cantilever's force and of the kinetic energies of
particles and plate; energies; velocities and places."""
MOST_REPEATS = 200
"""Repeats of a row after which it counts as never coming to rest: near a snap the motion is slower without end."""


@dataclass(frozen=True)
class State:
    """One measured state.

    Attributes:
        phase: name of its phase.
        displacement: [LU].
        force: of the contact on the plate, compression positive [FU]: the sum over the upper particles.
        profile: pressure and shear along x.
        smallest_distance: between particles of opposite bodies, or of a particle from the plane [LU].
        depth: how far an upper particle lies below the lower surface [LU]; 0 where none does.
        residual: largest unbalanced force of a particle along a direction in which it may move [FU].
        rule: what the contact radius is.
        pushed: force of other effects that presses the upper body onto the lower one [FU].
        plate_velocity: [LU/TU], 0 where the plate's place is prescribed.
        plate_x: place of the plate along x [LU], from where it stands in system.data.
        cantilever_force: [FU].
        step: LAMMPS timestep.
        motion: with a cantilever, what MOTION and HEAT name.
        number: of its row, over all phases.
    """

    phase: str
    displacement: float
    force: float
    profile: Profile
    smallest_distance: float
    depth: float
    residual: float
    rule: RadiusRule = field(repr=False, compare=False)
    pushed: float = 0.0
    plate_velocity: float = 0.0
    plate_x: float = 0.0
    cantilever_force: float = 0.0
    step: float = 0.0
    motion: Mapping[str, float] = field(default_factory=dict, compare=False)
    number: int = field(default=0, compare=False)

    @property
    def carried(self) -> float:
        """The load that the state balances [FU]: what the contact carries and nothing else presses."""
        return self.force - self.pushed

    @cached_property
    def radius(self) -> ContactRadius | None:
        """The contact radius; None where the bodies do not touch."""
        return self.rule.of(self.profile)

    @property
    def radius_or_spot(self) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension."""
        return self.radius or self.rule.or_spot(self.profile)


TOLD = "steps/told"
"""The fragment from which on a heat bath tells what energy it takes."""


class Contact:
    """A deck that is being run. It keeps its schedule: `phases` is what in.lammps must hold to repeat it."""

    def __init__(self, deck: Deck, session: Session, meanwhile: Callable[[Settings], object] | None = None) -> None:
        """Run the deck's head: bodies, effects, method; `meanwhile` works something out of the settings."""
        self.deck = deck
        self.scene: Scene = deck.scene
        self.settings = deck.settings
        self.session = session
        self._phases: list[Phase] = []
        self._unfinished = ""
        self._written = False
        self._latest: list[State] = []
        self._tells = False
        self.rows_seconds = 0.0  # wall time of the rows in LAMMPS
        self._rule = RadiusRule(deck.scene, deck.settings.tolerance)
        self._pushes = tuple(part.pushes for part in deck.parts if part.pushes)
        session.execute(deck.head, phase="setting up", meanwhile=partial(self._look_ahead, meanwhile))
        self._stepped = SteppedRows(deck, session) if deck.stepped else None

    @property
    def phases(self) -> tuple[Phase, ...]:
        """The schedule so far."""
        return tuple(self._phases)

    def begin(self, name: str, fragments: tuple[str, ...] = (), expected_steps: int | None = None) -> None:
        """Begin a phase."""
        end = "variable        row_phase delete\n" if self._phases else ""
        self._phases.append(Phase(name, (), begin=fragments))
        self._unfinished += end + self.deck.begin(name, fragments)
        self._tells = self._tells or TOLD in fragments
        self.session.execute("", phase=name, expected_steps=expected_steps)

    def row(self, row: Row) -> State:
        """Run one row of the current phase and measure.

        Raises:
            EngineError: LAMMPS failed, or lost particles.
        """
        return self.rows((row,))[0]

    def rows(self, rows: Sequence[Row]) -> list[State]:
        """Run rows of the current phase, which are known beforehand, and measure each. See `row`."""
        found: list[State] = []
        size = BATCH if self._stepped is None else self._stepped.at_once
        if self._stepped is not None:
            rows = [self.deck.as_listed(row) for row in rows]
        before = self.session.lammps_seconds
        for start in range(0, len(rows), size):
            batch = rows[start : start + size]
            first = sum(len(phase.rows) for phase in self._phases)
            self._phases[-1] = replace(self._phases[-1], rows=(*self._phases[-1].rows, *batch))
            stepped = self._stepped
            self._latest = self._measured(batch, first) if stepped is None else self._steps(stepped, batch, first)
            found += self._latest
        self.rows_seconds += self.session.lammps_seconds - before
        return found

    def _measured(self, rows: Sequence[Row], first: int) -> list[State]:
        texts = []
        for row in rows:
            texts.append(self._unfinished + self.deck.values(row, not self._written) + self.deck.row(type(row)))
            self._written = self._written or self.deck.keeps
            self._unfinished = self.deck.row_end + self.deck.forget(type(row))
        names = self._values()
        readings = self.session.measure_rows(texts, tuple(names), tuple(ATOM_UNITS), meanwhile=self._look_back)
        units, phase, states = self.deck.units, self._phases[-1].name, []
        for number, reading in enumerate(readings, first):
            numbers = {name: units.from_deck(v, names[name]) for name, v in zip(names, reading.values, strict=True)}
            atoms = {n: units.from_deck(rows, ATOM_UNITS.get(n, "1")) for n, rows in reading.atoms.items()}
            states.append(self._state(phase, numbers, atoms, number))
        return states

    def _steps(self, stepped: SteppedRows, rows: Sequence[Row], first: int) -> list[State]:
        began = self.session.timestep
        self.session.measure(self._unfinished + self.deck.in_one_run(rows), meanwhile=self._look_back)
        self._unfinished = ""
        spacing, residual, phase = self.scene.bodies.spacing, stepped.round_off, self._phases[-1].name
        states = []
        for i, (row, profile) in enumerate(zip(rows, stepped.profiles(rows), strict=True)):
            assert isinstance(row, Displace | Draw)
            place = row.place if isinstance(row, Draw) else 0.0
            force, closest = spacing * float(profile.pressure.sum()), float(profile.z_upper.min())
            measured = (phase, row.displacement, force, profile, closest, 0.0, residual, self._rule)
            states.append(State(*measured, plate_x=place, step=float(began + i + 1), number=first + i))
        return states

    def _look_ahead(self, more: Callable[[Settings], object] | None) -> None:
        left_by_centring(self.scene, self.settings)  # which every outcome asks for
        if more:
            more(self.settings)

    def _look_back(self) -> None:
        """Work out the radii of the rows before, which their states keep: LAMMPS is busy with the next ones."""
        for state in self._latest:
            with suppress(ValueError):  # told where the radius is asked for
                _ = state.radius

    def write_state(self) -> None:
        """Write the state that the last row left to states.lammpstrj; it ends the phase."""
        self._phases[-1] = replace(self._phases[-1], state=True)
        self._unfinished += self.deck.state(first=not self._written)
        self._written = True

    def finish(self) -> None:
        """Run what is left of the last row; what its states were made of is not kept."""
        self.session.execute(self._unfinished, phase=self._phases[-1].name)
        self._unfinished = ""
        (self.session.folder / FRAMES).unlink(missing_ok=True)

    def replay(self, phases: Sequence[Phase], at_rest: Callable[[State], bool] | None = None) -> list[State]:
        """Run a whole schedule; one state for each row. A row that does not end `at_rest` is repeated until it does."""
        states = []
        for phase in phases:
            steps = sum(getattr(row, "steps", 0) for row in phase.rows)
            self.begin(phase.name, phase.begin, steps or None)
            if at_rest is None:
                states += self.rows(phase.rows)
            else:
                states += [self._rested(row, at_rest) for row in phase.rows]
            if phase.state:
                self.write_state()
        self.finish()
        return states

    def _rested(self, row: Row, at_rest: Callable[[State], bool]) -> State:
        state, repeats = self.row(row), 0
        while not at_rest(state) and repeats < MOST_REPEATS:
            state, repeats = self.row(row), repeats + 1
        return state

    def _values(self) -> dict[str, str]:
        """What is measured beside the atoms, and its unit."""
        names = {"plate_displacement": "LU", "step": "1"}
        if self.scene.plate is not None:
            names["plate_velocity"] = "LU/TU"
        if self.scene.cantilever is not None:
            names |= {"cantilever_plate": "LU", "cantilever_force": "FU"} | MOTION
            if self.scene.noise is not None and self._tells:
                names |= dict.fromkeys(HEAT if self.settings.plate_damping > 0.0 else HEAT[:1], "FU·LU")
        return names | dict.fromkeys(self._pushes, "FU")

    def _state(self, phase: str, numbers: dict[str, float], atoms: dict[str, Array], number: int) -> State:
        upper = atoms["type"] == PARTICLES["upper"]
        lower = atoms["type"] == PARTICLES["lower"]
        here = int(upper.sum() + lower.sum())
        opposite = 0 if self.scene.bodies.lower == "rigid_plane" else self.settings.lower_particles
        if here < self.settings.particles + opposite:
            # LAMMPS looks for lost atoms when it makes a new neighbour list, and a row may end before.
            message = f"atoms are missing: only {here} particles are left in the box"
            raise EngineError(message, phase, int(numbers["step"]), self.session.folder, "")
        place, force = atoms["x"], atoms["f"]
        x, z = place[upper, 0], place[upper, 2]
        if lower.any():
            x_low, z_low = self._surface(place[lower, 0], place[lower, 2])
            closest = smallest_distance(x, z, x_low, z_low)
            depth = interpenetration(x, z, x_low, z_low).depth
            z_below = np.interp(x, x_low, z_low)
        else:
            # The plane's own softness lets a particle dip into it: the surface is where the particle is.
            closest, depth = float(max(z.min(), 0.0)), 0.0
            if self.scene.stands:
                z = np.where(atoms["v_opposite_z"][upper] != 0.0, 0.0, z)
                force = np.zeros_like(force)  # of its own a particle has no motion
            z_below = np.minimum(z, 0.0)
        profile = pressure_profile(
            x, z, z_below, atoms["v_opposite_x"][upper], atoms["v_opposite_z"][upper], self.scene.bodies.own_spacing
        )
        free = [0, 2] if self.scene.horizontal is not None else [2]
        moving = upper if self.scene.bodies.lower == "rigid_chain" else upper | lower
        return State(
            phase=phase,
            displacement=numbers["plate_displacement"],
            force=float(atoms["v_opposite_z"][upper].sum()),
            profile=profile,
            smallest_distance=closest,
            depth=depth,
            residual=float(np.abs(force[moving][:, free]).max()),
            rule=self._rule,
            pushed=float(sum(numbers[name] for name in self._pushes)),
            plate_velocity=-numbers.get("plate_velocity", 0.0),
            plate_x=numbers.get("cantilever_plate", 0.0),
            cantilever_force=numbers.get("cantilever_force", 0.0),
            step=numbers["step"],
            motion={name: numbers[name] for name in (*MOTION, *HEAT) if name in numbers},
            number=number,
        )

    def _surface(self, x: Array, z: Array) -> tuple[Array, Array]:
        """Places of the lower particles, of one without an end with what follows on both sides."""
        if not self.scene.bodies.periodic:
            return x, z
        length = period(self.scene, self.settings)
        return np.concatenate([x - length, x, x + length]), np.tile(z, 3)
