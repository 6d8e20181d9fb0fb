"""The context in which contacts are opened: one deck, one run folder, the LAMMPS process, and the time spent in it.

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression.
"""

from __future__ import annotations

import math
import shutil
import threading
from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import TracebackType
from typing import Self

from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.outcome import Agreement, Outcome
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Search, Trace, of_states
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Fly, Row, launch, numbered
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Meanwhile, Progress
from contact1d.workflow.engine.session import Engine
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Array, History
from contact1d.workflow.model.free import FLIGHT, STRETCHES, is_over, stretch
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

ASIDE = ".aside"
"""Folder of a context aside, in the run folder."""


class Clock:
    """The time that contacts took, also those of other threads.

    Attributes:
        times: "lammps_s" and "lammps_cpu_s" in LAMMPS, by the clock and on its processors [s]; "rows_s", the part of
            lammps_s in load steps, without the deck's head and the files of states [s]; "steps", of timesteps.
    """

    def __init__(self) -> None:
        """Begin with no time and no timesteps; a lock makes additions from several threads safe."""
        self.times: dict[str, float] = {"lammps_s": 0.0, "lammps_cpu_s": 0.0, "rows_s": 0.0, "steps": 0}
        self._lock = threading.Lock()

    def add(self, times: Mapping[str, float]) -> None:
        """Add the times [s] and the timesteps of a contact, by name, to the sums; threads may add at the same time."""
        with self._lock:
            for name, time in times.items():
                self.times[name] += time


@dataclass
class RunContext:
    """Opens contacts of one deck, one after the other, in one folder.

    Attributes:
        deck: what is run.
        folder: the run folder; system.data and the table are in it.
        progress: informed of phases and steps.
        time_limit: for each contact [s].
        retries: whether a search in which bodies went through each other restarts in smaller steps.
        workers: contacts that an experiment may have open at a time.
        ranks: of MPI, for each of them.
        clock: the time that all contacts took so far.
        phase, timestep: of the latest contact, now or at its end.
        through: whether a search covers the whole tension: it rises again after its first maximum.
        left: the outcome of a run that failed, as far as it is of use; its quantities are no results. None: nothing.
    """

    deck: Deck
    folder: Path
    progress: Progress
    time_limit: float
    retries: bool = True
    workers: int = 1
    ranks: int = 1
    clock: Clock = field(default_factory=Clock, init=False)
    phase: str = field(default="start", init=False)
    timestep: int = field(default=0, init=False)
    left: Outcome | None = field(default=None, init=False)
    through: bool = field(default=False, init=False)

    @property
    def inputs(self) -> tuple[Scene, Settings]:
        """The scene that is run, and its settings."""
        return self.deck.scene, self.deck.settings

    @contextmanager
    def contact(self, purpose: str = "", meanwhile: Meanwhile = None) -> Iterator[Contact]:
        """Yield a contact at displacement 0 in a new LAMMPS instance, which is closed at the end of the `with` block.

        Its time is then added to `clock`, and its last phase and timestep are kept, also after an error. `purpose` is
        shown to the user, "" is not. `meanwhile` is called while LAMMPS reads the bodies.

        Raises:
            EngineError: LAMMPS failed.
        """
        if purpose:
            self.progress.note(purpose)
        with Engine.session(self.folder, self.time_limit, self.progress, self.ranks) as session:
            contact: Contact | None = None
            try:
                contact = Contact(self.deck, session, meanwhile)
                yield contact
            finally:
                self.clock.add(session.taken | {"rows_s": contact.rows_seconds if contact else 0.0})
                self.phase, self.timestep = session.phase, session.timestep

    @contextmanager
    def aside(self, deck: Deck) -> Iterator[RunContext]:
        """Yield a context of another deck in the folder ".aside" of the run folder, which is deleted at the end.

        An earlier folder of this name is deleted first. Time limit, workers and ranks are those of this context; the
        time of its contacts is added to `clock` at the end, also after an error.
        """
        folder = self.folder / ASIDE
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        context = RunContext(deck, folder, self.progress, self.time_limit, workers=self.workers, ranks=self.ranks)
        try:
            write_system(deck, folder)
            yield context
        finally:
            self.clock.add(context.clock.times)
            shutil.rmtree(folder, ignore_errors=True)


class ContactBranch:
    """The states of one contact, from its approach on; driven by a script.

    A leg is a part of the path between two turns of the loading. Displacements and forces are positive in compression.

    Attributes:
        context: opens contacts.
        contact: the one that runs.
        scene, settings: of its deck.
        model: the particles of the reduced model.
        states: of all load steps, in order.
        legs: number of the leg of each state, from 0 on.
        searches: for a force maximum, by the number of the leg.
        marked: states that are reported, by name.
        unbalance: unbalanced force of the last state [FU]; None: the sum of its residual forces.
        moves: whether the states are those of a motion, and no equilibria.
        wanted: force [FU] that a state was to carry, by its number.
        given: what is prescribed: "displacement", "force" over time, a "load", or "" of a free motion.
    """

    unbalance: float | None = None
    moves, given = False, "displacement"
    _direction, _turned, _phase = 0, False, ""

    def __init__(self, context: RunContext, meanwhile: Meanwhile = None) -> None:
        """Prepare a contact without states; LAMMPS starts with the `with` statement.

        `meanwhile` is called while LAMMPS reads the bodies. The reduced model is made here.
        """
        self.context, self._meanwhile = context, meanwhile
        self.scene, self.settings = context.inputs
        self.model: Particles = reduced(self.scene, self.settings)
        self.states: list[State] = []
        self.legs: list[int] = []
        self.searches: dict[int, Search] = {}
        self.marked: dict[str, State] = {}
        self.wanted: dict[int, float] = {}
        self._open = ExitStack()

    def __enter__(self) -> Self:
        """Open the contact in a new LAMMPS instance, and return this object.

        Raises:
            EngineError: LAMMPS failed.
        """
        self.contact: Contact = self._open.enter_context(self.context.contact(meanwhile=self._meanwhile))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Close the contact and its LAMMPS instance; an error of the `with` block goes on."""
        self._open.__exit__(kind, error, traceback)

    @property
    def leg(self) -> list[State]:
        """The states since the loading last turned, in order, as a new list; empty before the first load step."""
        return self.of_leg(self._number)

    def of_leg(self, number: int) -> list[State]:
        """Return the states of the leg of a number, from 0 on, in order; empty without any."""
        return [state for state, leg in zip(self.states, self.legs, strict=True) if leg == number]

    @property
    def scale(self) -> float:
        """The expected force maximum (largest tension) by the contact law [FU], positive; 0 without attraction."""
        return self.settings.law.pull_off_force()

    def checks(self, case: Reduction, doubt: float) -> dict[str, Agreement]:
        """Return {"balance": agreement} of the contact force with the forces that LAMMPS adds up on the plate.

        {} where LAMMPS has no such sum. `case`, the experiment on the reduced model, and `doubt`, the relative
        uncertainty of energies, are ignored here; a contact that is planned on a rigid plane has further checks.
        """
        return consistency.balance(self.scene, self.states)

    def trace(self) -> Trace:
        """Return all states with displacements [LU], forces [FU] and times [TU], from which results are read.

        Times are 0 of equilibria, in a history on a rigid plane those of the history; of a motion in LAMMPS they are
        the number of its timestep times the timestep.

        Raises:
            IndexError: there are no states.
        """
        step = self.settings.motion.time_step if self.moves else 0.0
        trace = of_states(self.states, self.model, self.legs, self.searches, step)
        return replace(trace, wanted=self.wanted, given=self.given)

    def begin(self, name: str) -> None:
        """Begin a phase of this name with the next load step; where the name is taken it gets a number, "loading_2"."""
        self._phase = name

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | None = None) -> None:
        """Raise UntrustedError, always: under load control no displacement is prescribed.

        Other branches override it.
        """
        raise UntrustedError('a plate under a load has no prescribed displacement: use method = "quasistatic"')

    def follow(self, history: History) -> None:
        """Raise UntrustedError, always: these load steps are not planned on a rigid plane, where it is overridden."""
        raise UntrustedError('a history needs springs on a rigid plane: use lower = "rigid_plane"')

    def fly(self, velocity: float, longest: int = 100) -> None:
        """Move freely from displacement 0 with an impact velocity [LU/TU], positive in approach, up to the rebound.

        It ends when the bodies have separated, or when the body moves down again. The states, at equal intervals of
        time, 60 in the time of a free motion to the largest expected displacement, are kept in the phases "touching"
        (the first) and "impact".

        Raises:
            UntrustedError: neither happens in `longest` times that time, bodies went through each other, or the
                contact reaches the end of the chain.
        """
        self.moves, self.given, steps = True, "", stretch(self.settings, velocity)
        self._turn(rises=True)
        for name, row in (("touching", launch(self.scene, velocity, steps)), ("impact", Fly(steps))):
            self.begin(name)
            self._move([row])
        while not is_over([state.displacement for state in self.states], [state.force for state in self.states]):
            if len(self.states) > longest * STRETCHES:
                raise UntrustedError("the body does not end its impact: use shorter times of [viscoelasticity]")
            self._move([Fly(steps)] * FLIGHT)

    def mark(self, name: str) -> None:
        """Report the last state under a name, and have its atoms written to states.lammpstrj.

        Raises:
            IndexError: there are no states.
        """
        self.marked[name] = self.states[-1]
        self.contact.write_state()

    def finish(self) -> None:
        """Run the LAMMPS commands that remain after the last load step; no further load steps follow."""
        self.contact.finish()

    @property
    def _number(self) -> int:
        """How often the loading has turned before the last state, from 0 on; −1 before the first load step."""
        return self.legs[-1] if self.legs else -1

    @property
    def _last(self) -> State:
        """The state of the last load step; IndexError where there is none."""
        return self.states[-1]

    def _turn(self, rises: bool) -> bool:
        """Record the direction of the next load steps; return whether it differs from the one before, True at first.

        Where it differs, the next states have the next number in `legs`. `rises`: whether the displacement, or the
        load, rises next.
        """
        direction = 1 if rises else -1
        turned, self._direction = direction != self._direction, direction
        self._turned = self._turned or turned
        return turned

    def _append(self, states: Sequence[State]) -> None:
        """Add states to those so far, all with the last number in `legs`, or after a turn of the loading the next."""
        self.legs += [self._number + self._turned] * len(states)
        self.states += states
        self._turned = False

    def _move(self, rows: Sequence[Row]) -> None:
        """Run load steps in time and keep their states, which need not be at rest.

        Raises:
            UntrustedError: bodies went through each other, or the contact reaches the end of the chain.
        """
        self._begin_phase()
        self._append(self.contact.rows(rows, moving=True))

    def _record_target(self, force: float) -> None:
        """Record in `wanted` the force [FU], compression positive, that the last state was to carry; not NaN."""
        if not math.isnan(force):
            self.wanted[len(self.states) - 1] = force

    def _begin_phase(self) -> None:
        """Begin in LAMMPS the phase that was named since the last load step, numbered where the name is taken.

        Nothing where none was named since.
        """
        if self._phase:
            name, self._phase = self._phase, ""
            self.contact.begin(numbered(name, [phase.name for phase in self.contact.phases]))
