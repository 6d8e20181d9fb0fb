"""Every way in which LAMMPS can fail, made to happen: one clear error, files kept, the next session as good as new."""

from __future__ import annotations

import os
import pickle
import re
import resource
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from contact1d import EngineError
from contact1d.workflow.engine.session import Engine, Session

PAIR = """
units           lj
dimension       2
atom_style      bond
atom_modify     map array
region          box block 0 20 0 20 -0.5 0.5
create_box      1 box bond/types 1 extra/bond/per/atom 1
create_atoms    1 single 5.0 5.0 0.0
create_atoms    1 single 6.5 5.0 0.0
mass            1 1.0
pair_style      zero 5.0
pair_coeff      * *
bond_style      harmonic
bond_coeff      1 2.0 1.0
fix             move all nve
thermo          10
run             0
"""
OPEN_BOX = "change_box all boundary f f p\n"
ENDLESS = "thermo 1000000\nrun 2000000000"


@pytest.fixture(autouse=True)
def next_session_works(tmp_path: Path) -> Iterator[None]:
    """After each failure a session in the same folder has a right answer."""
    yield
    with Engine.session(tmp_path) as session:
        session.execute(PAIR)
        assert session.value("x[2]-x[1]") == 1.5


def failure(folder: Path, act: Callable[[Session], object], time_limit: float = 60.0) -> EngineError:
    """Return the error with which `act` fails in a session that holds two atoms; what must hold for every failure."""
    (folder / "kept.txt").write_text("kept")
    with pytest.raises(EngineError) as caught, Engine.session(folder, time_limit) as session:
        session.execute(PAIR, phase="preparing")
        act(session)
    error = caught.value
    wait_for(lambda: not Path(f"/proc/{session.pid}").exists())
    assert (folder / "kept.txt").read_text() == "kept"
    assert error.folder == folder
    assert "\n" not in str(error)
    assert str(folder) in str(error)
    return error


def wait_for(condition: Callable[[], bool]) -> None:
    """Wait until the condition comes true: a test has a time limit of its own."""
    while not condition():
        time.sleep(0.02)


def later(act: Callable[[], object], seconds: float = 0.7) -> None:
    """Do something while the main thread waits for LAMMPS."""
    timer = threading.Timer(seconds, act)
    timer.daemon = True
    timer.start()


COMMANDS = {
    "unknown command": ("error one hello", "LAMMPS stopped: Unknown command: error one hello, at: error one hello"),
    "bad argument": ("run ten", "Expected integer .*'ten'.*, at: run ten"),
    "undefined variable": ("print hello\npair_coeff 1 &\n 1 ${gone}", "variable gone, at: pair_coeff 1 1 \\${gone}"),
    "missing include": ("include gone.lmp", "Cannot open input script gone.lmp: No such file .*, at: include gone.lmp"),
    "bad style": ("fix 2 all nonsense", "Unrecognized fix style 'nonsense', at: fix 2 all nonsense"),
}


@pytest.mark.parametrize("case", COMMANDS)
def test_bad_command(tmp_path: Path, case: str) -> None:
    """The message is LAMMPS's own without source location or links, and quotes the command."""
    text, message = COMMANDS[case]
    error = failure(tmp_path, lambda session: session.execute("run 20\n" + text, phase="loading"))
    assert re.search(message, error.message), error.message
    assert not re.search(r"\.cpp|https?:|on proc", error.message)
    assert (error.phase, error.step) == ("loading", 20)
    assert error.log_tail


def test_bad_command_in_a_file(tmp_path: Path) -> None:
    """A deck that is run as a file fails alike; a file that is not there is named."""
    (tmp_path / "in.bad").write_text("run 5\nnonsense 1 2\n")
    error = failure(tmp_path, lambda session: session.run_file("in.bad", phase="deck"))
    assert error.message.endswith("at: nonsense 1 2")
    assert (error.phase, error.step) == ("deck", 5)
    assert "in.gone cannot be read" in failure(tmp_path, lambda session: session.run_file("in.gone")).message


def test_error_in_the_middle_of_a_run(tmp_path: Path) -> None:
    """What fails on one rank only (a bond that became too long) names the run, which LAMMPS itself does not quote."""
    act = "create_bonds single/bond 1 1 2\n" + OPEN_BOX + "velocity all set 20 0 0\nrun 1000"
    error = failure(tmp_path, lambda session: session.execute(act, phase="flying"))
    assert re.fullmatch(r"LAMMPS stopped: Bond atoms 1 2 missing on proc 0 at step \d+, at: run 1000", error.message)
    assert 0 < error.step < 1000
    assert f"step {error.step}" in error.message


def test_lost_atom(tmp_path: Path) -> None:
    """An atom that leaves the box is counted."""
    act = OPEN_BOX + "velocity all set 0 20 0\nset atom 1 vy 0\nrun 1000"
    error = failure(tmp_path, lambda session: session.execute(act, phase="flying"))
    assert "1 of 2 atoms left the box" in error.message
    assert error.message.endswith("at: run 1000")
    assert 0 < error.step < 1000
    assert "Lost atoms" in error.log_tail


def test_nan_positions(tmp_path: Path) -> None:
    """LAMMPS runs on with NaN if no neighbour list is due; the engine does not."""
    act = "create_bonds single/bond 1 1 2\nneigh_modify delay 1000 every 1000\ntimestep 1e150\nrun 5"
    error = failure(tmp_path, lambda session: session.execute(act, phase="exploding"))
    assert error.message == "the position of atom 1 (and of 1 more) is not a finite number"
    assert (error.phase, error.step) == ("exploding", 5)


def test_nan_values_and_arrays(tmp_path: Path) -> None:
    """A number that is not finite is never returned; the name is."""
    error = failure(tmp_path, lambda session: session.values("step", "exp(1000)"))
    assert error.message == "the value of 'exp(1000)' is inf, not a finite number"
    huge = "variable huge atom exp(1000*(id-1))"
    error = failure(tmp_path, lambda session: session.measure(huge, atoms=("v_huge",)))
    assert error.message == "the v_huge of atom 2 is not a finite number"
    error = failure(tmp_path, lambda session: session.value("1/0"))
    assert error.message == "LAMMPS stopped: Divide by 0 in variable formula, at: 1/0"


@pytest.mark.parametrize("name", ["gone", "mass", "c_gone", "f_move", "f_gone", "v_step", "c_thermo_pe", "x[1]"])
def test_unknown_array(tmp_path: Path, name: str) -> None:
    """What is not a per-atom array is refused by name."""
    assert name.removeprefix("c_") in failure(tmp_path, lambda session: session.atoms(name)).message


def test_unknown_value(tmp_path: Path) -> None:
    """What is neither a variable nor a formula is refused by name."""
    assert failure(tmp_path, lambda session: session.value("gone")).message.endswith("at: gone")
    assert failure(tmp_path, lambda session: session.value("f_gone[1]")).message.endswith("at: f_gone[1]")


SIGNALS = {
    signal.SIGKILL: r"was killed \(SIGKILL\), most often because the machine was out of memory",
    signal.SIGSEGV: r"crashed \(SIGSEGV\)",
    signal.SIGABRT: r"crashed \(SIGABRT\)",
}


@pytest.mark.parametrize("number", SIGNALS)
def test_crash_in_the_middle_of_a_run(tmp_path: Path, number: signal.Signals) -> None:
    """The signal is named, and the step that was reached is known although the process is gone."""

    def run(session: Session) -> None:
        later(lambda: os.kill(session.pid, number))
        session.execute(ENDLESS, phase="running")

    error = failure(tmp_path, run)
    assert re.search(SIGNALS[number], error.message)
    assert error.phase == "running"
    assert error.step > 0
    assert "run 2000000000" in error.log_tail


def test_crash_between_requests(tmp_path: Path) -> None:
    """A worker that died while nobody asked is noticed at the next request, or replaced at the next session."""

    def act(session: Session) -> None:
        os.kill(session.pid, signal.SIGKILL)
        session.value("step")

    assert "SIGKILL" in failure(tmp_path, act).message
    with Engine.session(tmp_path) as session:
        pass
    os.kill(session.pid, signal.SIGKILL)
    time.sleep(0.1)
    with Engine.session(tmp_path) as later_session:
        assert later_session.pid != session.pid


def test_out_of_time(tmp_path: Path) -> None:
    """A run without end is stopped, and the log up to there is on disk."""
    error = failure(tmp_path, lambda session: session.execute(ENDLESS, phase="running"), time_limit=1.0)
    assert error.message == "the run took longer than its time limit of 1 s"
    assert error.step > 1000
    assert "run 2000000000" in error.log_tail


def test_a_process_that_hangs(tmp_path: Path) -> None:
    """A worker that does not even run is stopped too."""

    def hang(session: Session) -> None:
        os.kill(session.pid, signal.SIGSTOP)
        session.value("step")

    assert "time limit of 1 s" in failure(tmp_path, hang, time_limit=1.0).message


def test_out_of_memory(tmp_path: Path) -> None:
    """A process that may have no more memory ends in an error of its own."""

    def grow(session: Session) -> None:
        used = int(Path(f"/proc/{session.pid}/statm").read_text().split()[0]) * os.sysconf("SC_PAGESIZE")
        resource.prlimit(session.pid, resource.RLIMIT_AS, (used + 50_000_000, used + 50_000_000))
        session.execute("create_atoms 1 random 3000000 1 NULL", phase="growing")

    error = failure(tmp_path, grow)
    assert error.phase == "growing"
    assert re.search(r"allocat|memory|crashed|bad_alloc", error.message)


def test_a_failed_session_stays_failed(tmp_path: Path) -> None:
    """Whoever catches the error inside the block gets another one, not a wrong number."""

    def again(session: Session) -> None:
        with pytest.raises(EngineError):
            session.execute("nonsense")
        session.value("step")

    assert failure(tmp_path, again).message.startswith("the session is over: LAMMPS stopped: Unknown command")


def test_ctrl_c_ends_the_run(tmp_path: Path) -> None:
    """KeyboardInterrupt reaches the caller at once and the worker is gone; the worker itself ignores the signal."""
    with pytest.raises(KeyboardInterrupt), Engine.session(tmp_path) as session:
        session.execute(PAIR)
        os.kill(session.pid, signal.SIGINT)
        assert session.value("step") == 0.0
        later(lambda: os.kill(os.getpid(), signal.SIGINT))
        session.execute(ENDLESS)
    assert not Path(f"/proc/{session.pid}").exists()


def test_the_error_crosses_processes() -> None:
    """Pools send exceptions by pickle."""
    error = EngineError("cause", "loading", 7, Path("folder"), "tail")
    copy = pickle.loads(pickle.dumps(error))
    assert str(copy) == str(error) == "phase 'loading', step 7: cause (files kept in folder)"
    assert (copy.step, copy.log_tail) == (7, "tail")
