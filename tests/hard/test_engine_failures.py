"""Every way in which LAMMPS can fail, made to happen: one clear error, files kept, the next session as good as new."""

import os
import pickle
import re
import resource
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from contact1d import EngineError
from contact1d.workflow.engine.session import Engine, Session

ATOMS = """
units           lj
atom_modify     map array
region          box block 0 20 0 20 -0.5 0.5
create_box      1 box bond/types 1 extra/bond/per/atom 1
create_atoms    1 single 5.0 5.0 0.0
create_atoms    1 single 15.0 5.0 0.0
mass            1 1.0
pair_style      zero 12.0
pair_coeff      * *
bond_style      harmonic
bond_coeff      1 2.0 1.0
fix             move all nve
thermo          10
run             0
"""
PAIR = f"dimension 2\natom_style bond\n{ATOMS.replace('15.0', '6.5')}"
APART = f"atom_style bond\nprocessors * 1 1\n{ATOMS}"
"""Each atom on a rank of its own, where there are two."""
OPEN_BOX = "change_box all boundary f f p\n"


@pytest.fixture(autouse=True)
def next_session_works(tmp_path: Path) -> Iterator[None]:
    """After each failure a session in the same folder has a right answer."""
    yield
    with Engine.session(tmp_path) as session:
        session.execute(PAIR)
        assert session.values("x[2]-x[1]") == (1.5,)


def failure(folder: Path, act: Callable[[Session], object], ranks: int = 1) -> EngineError:
    """The error with which `act` fails in a session that holds two atoms; what must hold for every failure."""
    (folder / "kept.txt").write_text("kept")
    with pytest.raises(EngineError) as caught, Engine.session(folder, ranks=ranks) as session:
        session.execute(PAIR if ranks == 1 else APART, phase="preparing")
        act(session)
    error = caught.value
    while Path(f"/proc/{session.pid}").exists():  # ends by the time limit of a test
        time.sleep(0.02)
    assert (folder / "kept.txt").read_text() == "kept"
    assert error.folder == folder
    assert "\n" not in str(error)
    assert str(folder) in str(error)
    return error


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("error one hello", "LAMMPS stopped: Unknown command: error one hello, at: error one hello"),
        ("print hello\npair_coeff 1 &\n 1 ${gone}", r"variable gone, at: pair_coeff 1 1 \${gone}"),
        ("include gone.lmp", "Cannot open input script gone.lmp: No such file .*, at: include gone.lmp"),
    ],
)
def test_the_message_is_lammps_own_without_source_location_or_links_and_quotes_the_command(
    text: str, message: str, tmp_path: Path
) -> None:
    error = failure(tmp_path, lambda session: session.execute("run 20\n" + text, phase="loading"))
    assert re.search(message, error.message), error.message
    assert not re.search(r"\.cpp|https?:|on proc", error.message)
    assert (error.phase, error.step) == ("loading", 20)
    assert error.log_tail


def test_bad_command_in_a_file(tmp_path: Path) -> None:
    """A deck that is run as a file fails alike."""
    (tmp_path / "in.bad").write_text("run 5\nnonsense 1 2\n")
    error = failure(tmp_path, lambda session: session.execute("include in.bad", phase="deck"))
    assert error.message.endswith("at: nonsense 1 2")
    assert (error.phase, error.step) == ("deck", 5)


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        # On one rank only, where LAMMPS itself does not quote the run.
        ("create_bonds single/bond 1 1 2\nvelocity all set 20 0 0", "Bond atoms 1 2 missing on proc 0 at step"),
        ("velocity all set 0 20 0\nset atom 1 vy 0", "1 of 2 atoms left the box"),
    ],
)
def test_an_error_in_the_middle_of_a_run_names_the_run_and_its_step(setting: str, message: str, tmp_path: Path) -> None:
    error = failure(tmp_path, lambda session: session.execute(f"{OPEN_BOX}{setting}\nrun 1000", phase="flying"))
    assert error.message.startswith(f"LAMMPS stopped: {message}")
    assert error.message.endswith("at: run 1000")
    assert 0 < error.step < 1000
    assert "Lost atoms" in error.log_tail or f"step {error.step}" in error.message


@pytest.mark.parametrize(("ranks", "atom"), [(1, "atom 1 (and of 1 more)"), (2, "atom 2")])
def test_a_position_that_is_no_number_is_found_on_any_rank(ranks: int, atom: str, tmp_path: Path) -> None:
    """LAMMPS runs on with NaN if no neighbour list is due; the engine does not."""
    act = "neigh_modify every 1000 delay 1000\nrun 0\n"
    act += "create_bonds single/bond 1 1 2\ntimestep 1e150\nrun 5" if ranks == 1 else (
        "group second id 2\nfix push second addforce 1e308 1e308 1e308\ntimestep 1e100\nrun 5"
    )  # fmt: skip
    error = failure(tmp_path, lambda session: session.execute(act, phase="exploding"), ranks)
    assert error.message.startswith(f"the position of {atom} is not a finite number")
    assert (error.phase, error.step) == ("exploding", 5)


@pytest.mark.parametrize("place", [5.0, 15.0])
def test_an_error_on_one_rank_is_that_of_the_run(place: float, tmp_path: Path) -> None:
    """`error->one`: the others wait for it in the middle of a step, and would wait for good."""
    alone = f"variable bad atom 1.0/(x-{place})\ncompute bad all reduce sum v_bad\nthermo_style custom c_bad\nrun 0"
    assert "LAMMPS stopped: Divide by 0" in failure(tmp_path, lambda session: session.execute(alone), 2).message


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda session: session.values("step", "exp(1000)"), "the value of 'exp(1000)' is inf, not a finite number"),
        (lambda session: session.values("1/0"), "LAMMPS stopped: Divide by 0 in variable formula, at: 1/0"),
        (lambda session: session.values("f_gone[1]"), "at: f_gone[1]"),
        (
            lambda session: session.measure("variable huge atom exp(1000*(id-1))", atoms=("v_huge",)),
            "the v_huge of atom 2 is not a finite number",
        ),
        (lambda session: session.measure("", atoms=("mass",)), "mass"),
        (lambda session: session.measure("", atoms=("f_move",)), "f_move"),
        (lambda session: session.measure("", atoms=("c_thermo_pe",)), "thermo_pe"),
        (lambda session: session.measure("", atoms=("x[1]",)), "x[1]"),
    ],
)
def test_what_is_not_finite_or_not_there_is_refused_by_name(
    ask: Callable[[Session], object], message: str, tmp_path: Path
) -> None:
    assert message in failure(tmp_path, ask).message


def test_a_process_that_was_killed_while_idle_is_replaced(tmp_path: Path) -> None:
    with Engine.session(tmp_path) as session:
        pass
    os.kill(session.pid, signal.SIGKILL)
    time.sleep(0.1)
    with Engine.session(tmp_path) as later_session:
        assert later_session.pid != session.pid


def test_a_process_that_may_have_no_more_memory_ends_in_an_error_of_its_own(tmp_path: Path) -> None:
    def grow(session: Session) -> None:
        used = int(Path(f"/proc/{session.pid}/statm").read_text().split()[0]) * os.sysconf("SC_PAGESIZE")
        resource.prlimit(session.pid, resource.RLIMIT_AS, (used + 50_000_000, used + 50_000_000))
        session.execute("create_atoms 1 random 3000000 1 NULL", phase="growing")

    error = failure(tmp_path, grow)
    assert error.phase == "growing"
    assert re.search(r"allocat|memory|crashed|bad_alloc", error.message)


def test_whoever_catches_the_error_inside_the_session_gets_another_one_and_no_wrong_number(tmp_path: Path) -> None:
    def again(session: Session) -> None:
        with pytest.raises(EngineError):
            session.execute("nonsense")
        session.values("step")

    assert failure(tmp_path, again).message.startswith("the session is over: LAMMPS stopped: Unknown command")


def test_the_error_crosses_processes() -> None:
    """Pools send exceptions by pickle."""
    error = EngineError("cause", "loading", 7, Path("folder"), "tail")
    copy = pickle.loads(pickle.dumps(error))
    assert str(copy) == str(error) == "phase 'loading', step 7: cause (files kept in folder)"
    assert (copy.step, copy.log_tail) == (7, "tail")
