"""Where contacts are opened: one deck, one run folder, the LAMMPS process, and the time spent in it."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from types import TracebackType
from typing import Self

from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import State
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.engine.progress import Progress
from contact1d.workflow.engine.session import Engine
from contact1d.workflow.model.reduced import Reduced, reduced


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
        lammps_seconds, lammps_cpu_seconds, steps: summed over all contacts so far.
        rows_seconds: of the first, what load steps took: without the deck's head and the files of states.
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
    lammps_seconds: float = field(default=0.0, init=False)
    lammps_cpu_seconds: float = field(default=0.0, init=False)
    rows_seconds: float = field(default=0.0, init=False)
    steps: int = field(default=0, init=False)
    phase: str = field(default="start", init=False)
    timestep: int = field(default=0, init=False)
    left: Outcome | None = field(default=None, init=False)
    through: bool = field(default=False, init=False)
    _lock: threading.Lock = field(default_factory=threading.Lock, init=False, repr=False)

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
                self.rows_seconds += contact.rows_seconds if contact else 0.0
                self.lammps_seconds += session.lammps_seconds
                self.lammps_cpu_seconds += session.lammps_cpu_seconds
                self.steps += session.steps
                self.phase, self.timestep = session.phase, session.timestep

    def add_time_of(self, other: RunContext) -> None:
        """Add the time used by a parallel context, possibly in another thread."""
        with self._lock:
            self.lammps_seconds += other.lammps_seconds
            self.lammps_cpu_seconds += other.lammps_cpu_seconds
            self.rows_seconds += other.rows_seconds
            self.steps += other.steps


class ContactBranch:
    """States of one contact, from its approach on; driven by a script.

    Attributes:
        context: where contacts are opened.
        contact: the one that runs.
        model: the reduced one.
        loading, falling: states of rising, and then of falling displacement, as they were measured.
        marked: states that are reported, by name.
    """

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact; what `meanwhile` does costs no time: LAMMPS reads the bodies then."""
        self.context, self._meanwhile = context, meanwhile
        self.scene, self.settings = context.deck.scene, context.deck.settings
        self.model: Reduced = reduced(self.scene, self.settings)
        self.loading: list[State] = []
        self.falling: list[State] = []
        self.marked: dict[str, State] = {}
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
    def states(self) -> list[State]:
        """All states, in order."""
        return [*self.loading, *self.falling]

    @property
    def scale(self) -> float:
        """The force maximum that is expected [FU]."""
        return self.settings.estimate.pull_off_force()

    def begin(self, name: str) -> None:
        """Begin a phase."""
        self.contact.begin(name)

    def mark(self, name: str) -> None:
        """Report the last state."""
        self.marked[name] = self.states[-1]
        self.contact.write_state()

    def finish(self) -> None:
        """End the schedule."""
        self.contact.finish()
