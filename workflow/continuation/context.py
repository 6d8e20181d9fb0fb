"""Where contacts are opened: one deck, one run folder, the LAMMPS process, and the time spent in it."""

from __future__ import annotations

import math
import shutil
import threading
from collections.abc import Callable, Iterator, Sequence
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
from contact1d.workflow.continuation.trace import Array, Search, Trace, of_states
from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Fly, Launch, Phase, numbered
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.engine.session import Engine
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import History
from contact1d.workflow.model.free import FLIGHT, STRETCHES, is_over, stretch
from contact1d.workflow.model.reduced import reduced

MOST_STRETCHES = 100
"""How long an impact lasts at most, over the time of a fall to the deepest displacement."""
ASIDE = ".aside"
"""Folder of a context aside, in the run folder."""


class Clock:
    """What contacts took, also those of other threads.

    Attributes:
        lammps_seconds, lammps_cpu_seconds: in LAMMPS.
        rows_seconds: of the first, what load steps took: without the deck's head and the files of states.
        steps: timesteps.
    """

    def __init__(self) -> None:
        """Begin at 0."""
        self.lammps_seconds = self.lammps_cpu_seconds = self.rows_seconds = 0.0
        self.steps = 0
        self._lock = threading.Lock()

    @property
    def taken(self) -> tuple[float, float, float, int]:
        """What `add` takes."""
        return self.lammps_seconds, self.lammps_cpu_seconds, self.rows_seconds, self.steps

    def add(self, lammps: float, cpu: float, rows: float, steps: int) -> None:
        """Add what another one took."""
        with self._lock:
            self.lammps_seconds += lammps
            self.lammps_cpu_seconds += cpu
            self.rows_seconds += rows
            self.steps += steps


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
        clock: what all contacts so far took.
        phase, timestep: where the latest contact is or ended.
        through: whether a search goes through all of the tension: it rises again after its first maximum.
        left: what a run that failed had so far, if that is worth looking at; its quantities are no results.
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

    @contextmanager
    def contact(self, purpose: str = "", meanwhile: Callable[[], object] | None = None) -> Iterator[Contact]:
        """A fresh contact at displacement 0, in a LAMMPS instance of its own; `purpose` is shown to the user.

        What `meanwhile` does costs no time: LAMMPS reads the bodies then.
        """
        if purpose:
            self.progress.note(purpose)
        with Engine.session(self.folder, self.time_limit, self.progress, self.ranks) as session:
            contact: Contact | None = None
            try:
                contact = Contact(self.deck, session, meanwhile)
                yield contact
            finally:
                rows = contact.rows_seconds if contact else 0.0
                self.clock.add(session.lammps_seconds, session.lammps_cpu_seconds, rows, session.steps)
                self.phase, self.timestep = session.phase, session.timestep

    @contextmanager
    def aside(self, deck: Deck) -> Iterator[RunContext]:
        """A context of another deck in a folder of its own, which goes at the end; its time counts here."""
        folder = self.folder / ASIDE
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
        own = RunContext(deck, folder, self.progress, self.time_limit, workers=self.workers, ranks=self.ranks)
        try:
            write_system(deck, folder)
            yield own
        finally:
            self.add_time_of(own)
            shutil.rmtree(folder, ignore_errors=True)

    def add_time_of(self, other: RunContext) -> None:
        """Add the time used by another context, possibly in another thread."""
        self.clock.add(*other.clock.taken)


class ContactBranch:
    """States of one contact, from its approach on; driven by a script.

    Attributes:
        context: where contacts are opened.
        contact: the one that runs.
        model: the reduced one.
        states: of all load steps, in order.
        legs: number of the leg of each; see `Trace`.
        searches: what the search for a force maximum leaves open, by the leg's number.
        marked: states that are reported, by name.
        unbalance: force [FU] that the last state leaves unbalanced; None: what its residual forces add up to.
        moves: whether the states are those of a motion, and no equilibria.
        wanted: force [FU] that a state was to carry, by its number.
        given: see `Trace`.
    """

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact; what `meanwhile` does costs no time: LAMMPS reads the bodies then."""
        self.context, self._meanwhile = context, meanwhile
        self.scene, self.settings = context.deck.scene, context.deck.settings
        self.model: Particles = reduced(self.scene, self.settings)
        self.states: list[State] = []
        self.legs: list[int] = []
        self.searches: dict[int, Search] = {}
        self.marked: dict[str, State] = {}
        self.unbalance: float | None = None
        self.moves = False
        self.wanted: dict[int, float] = {}
        self.given = "displacement"
        self._direction, self._turned, self._phase = 0, False, ""
        self._open = ExitStack()

    def __enter__(self) -> Self:
        """Open it."""
        self.contact: Contact = self._open.enter_context(self.context.contact(meanwhile=self._meanwhile))
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        """Close it."""
        self._open.__exit__(kind, error, traceback)

    @property
    def phases(self) -> tuple[Phase, ...]:
        """The schedule so far."""
        return self.contact.phases

    @property
    def leg(self) -> list[State]:
        """The states of the leg under way."""
        return [state for state, leg in zip(self.states, self.legs, strict=True) if leg == self._number]

    @property
    def scale(self) -> float:
        """The force maximum that is expected [FU]."""
        return self.settings.law.pull_off_force()

    def checks(self, case: Reduction, doubt: float) -> dict[str, Agreement]:
        """Whether the states contradict what is known; `doubt`: what is uncertain of their energies, relative."""
        return consistency.balance(self.scene, self.states)

    def trace(self) -> Trace:
        """What a reader sees."""
        step = self.settings.motion.time_step if self.moves else 0.0
        found = of_states(self.states, self.model, self.legs, self.searches, step)
        return replace(found, wanted=self.wanted, given=self.given)

    def begin(self, name: str) -> None:
        """Begin a phase with the next load step: "loading" for the second time is "loading_2"."""
        self._phase = name

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | None = None) -> None:
        """Go to displacements [LU]. Raises UntrustedError under load control."""
        raise UntrustedError('a plate under a load has no prescribed displacement: use method = "quasistatic"')

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold for a time. Raises UntrustedError where load steps take none."""
        raise UntrustedError('a load step at rest takes no time: use method = "dynamic"')

    def follow(self, history: History) -> None:
        """Go through a history. Raises UntrustedError where load steps are not planned (`planned`)."""
        raise UntrustedError('a history needs springs on a rigid plane: use lower = "rigid_plane"')

    def fly(self, velocity: float) -> None:
        """Come down at a velocity [LU/TU]: equal stretches of time, until the body flies off or sticks.

        Raises:
            UntrustedError: the bodies neither part nor stick in MOST_STRETCHES times the time of a fall.
        """
        self.moves, self.given, steps = True, "", stretch(self.settings, velocity)
        self._turn(rises=True)
        for name, row in (("touching", Launch(velocity, steps)), ("impact", Fly(steps))):
            self.begin(name)
            self._enter()
            self._keep(self.contact.rows([row], moving=True))
        while not is_over([one.displacement for one in self.states], [one.force for one in self.states]):
            if len(self.states) > MOST_STRETCHES * STRETCHES:
                raise UntrustedError("the body does not end its impact: use shorter times of [viscoelasticity]")
            self._keep(self.contact.rows([Fly(steps)] * FLIGHT, moving=True))

    def mark(self, name: str) -> None:
        """Report the last state."""
        self.marked[name] = self.states[-1]
        self.contact.write_state()

    def finish(self) -> None:
        """End the schedule."""
        self.contact.finish()

    @property
    def _number(self) -> int:
        return self.legs[-1] if self.legs else -1

    @property
    def _last(self) -> State:
        return self.states[-1]

    def _turn(self, rises: bool) -> bool:
        """Whether a leg of rising or falling displacement begins with the next load step, which is not under way."""
        direction = 1 if rises else -1
        turned, self._direction = direction != self._direction, direction
        self._turned = self._turned or turned
        return turned

    def _keep(self, states: Sequence[State]) -> None:
        """Add states of the leg under way, or the first ones of the next."""
        self.legs += [self._number + self._turned] * len(states)
        self.states += states
        self._turned = False

    def _came(self, force: float) -> None:
        """Note that the last state was to carry a force [FU]; NaN: to be at a displacement."""
        if not math.isnan(force):
            self.wanted[len(self.states) - 1] = force

    def _enter(self) -> None:
        """Begin the phase that the script has named, before its first load step."""
        if self._phase:
            name, self._phase = self._phase, ""
            self.contact.begin(numbered(name, [phase.name for phase in self.contact.phases]))
