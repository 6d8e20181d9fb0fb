"""What contacts cost is summed up, also of one that failed; a planned way keeps the states that a scene asks for."""

from __future__ import annotations

from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase, displacements
from contact1d.workflow.experiments.running import run_context
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.way import kept_states, kept_way, planned_way
from contact1d.workflow.settings.settings import settings_for
from tests.given import at, given_scene


class Told:
    """Keeps notes."""

    def __init__(self) -> None:
        """None so far."""
        self.notes: list[str] = []

    def note(self, text: str) -> None:
        """One more."""
        self.notes.append(text)


@pytest.fixture
def context(monkeypatch: pytest.MonkeyPatch) -> RunContext:
    """Of contacts that take 2 s, 3 s of the processor, 1.5 s of rows and 7 steps each, the second in another phase."""
    opened: list[Any] = []

    @contextmanager
    def session(folder: Path, limit: float, progress: Any, ranks: int) -> Any:
        opened.append((folder, limit, ranks))
        yield SimpleNamespace(
            lammps_seconds=2.0, lammps_cpu_seconds=3.0, steps=7, phase=f"phase {len(opened)}", timestep=10 * len(opened)
        )

    monkeypatch.setattr(run_context.Engine, "session", session)
    monkeypatch.setattr(run_context, "Contact", lambda deck, session, meanwhile: SimpleNamespace(rows_seconds=1.5))
    scene = given_scene()
    progress: Any = Told()
    return RunContext(Deck(scene, settings_for(scene)), Path("nowhere"), progress, 60.0, ranks=2)


def sums(context: RunContext) -> tuple[float, ...]:
    return context.rows_seconds, context.lammps_seconds, context.lammps_cpu_seconds, context.steps


def test_times_and_steps_of_contacts_one_after_the_other_add_up(context: RunContext) -> None:
    assert (context.phase, context.timestep, context.left) == ("start", 0, None)
    with context.contact():
        pass
    assert sums(context) == (1.5, 2.0, 3.0, 7)
    with pytest.raises(RuntimeError), context.contact("again"):
        raise RuntimeError
    assert sums(context) == (3.0, 4.0, 6.0, 14)
    assert (context.phase, context.timestep) == ("phase 2", 20)
    told: Any = context.progress
    assert told.notes == ["again"]


def test_a_contact_that_does_not_begin_has_no_rows(context: RunContext, monkeypatch: pytest.MonkeyPatch) -> None:
    def fails(*_: Any) -> None:
        raise RuntimeError("no bodies")

    monkeypatch.setattr(run_context, "Contact", fails)
    with pytest.raises(RuntimeError, match="no bodies"), context.contact():
        pass
    assert sums(context) == (0.0, 2.0, 3.0, 7)


def test_all_numbers_of_a_contact_beside_are_added_and_none_has_any_at_first(context: RunContext) -> None:
    assert sums(context) == (0.0, 0.0, 0.0, 0)
    assert context.workers == 1
    assert context.retries
    assert RunContext(context.deck, context.folder, context.progress, 1.0).ranks == 1


PHASES = (Phase("loading", displacements([0.0, 0.1, 0.2])), Phase("unloading", displacements([0.1, 0.0]), state=True))


def test_a_way_keeps_what_is_asked_for_and_all_where_nothing_is() -> None:
    none, some = given_scene(), given_scene(output={"states": 2})
    assert planned_way(none, PHASES) is PHASES
    kept = planned_way(some, PHASES)
    assert [phase.kept for phase in kept] != [None, None]
    count = sum(sum(phase.kept or ()) for phase in kept)
    assert 2 <= count <= 3
    states = tuple(at(0.0, 0.0, number=n) for n in range(5))
    outcome = Outcome({}, states, {}, {}, kept)
    assert kept_states(none, outcome) is None
    flags = [flag for phase in kept for flag in phase.kept or ()]
    assert kept_states(some, outcome) == [n for n in range(5) if flags[n]]
    whole = Outcome({}, states, {}, {}, PHASES)
    assert kept_states(some, whole) == [0, 1, 2, 3, 4]
    plain: Any = SimpleNamespace(deck=SimpleNamespace(scene=none))
    assert kept_way(plain, whole) is whole
