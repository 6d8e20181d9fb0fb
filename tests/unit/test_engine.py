"""A session of the engine: commands in, numbers and arrays out, counted, timed and heard of, in the right folder."""

import io
import math
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any
from unittest.mock import Mock

import numpy as np
import pytest

from contact1d.workflow.engine.frames import last_frames
from contact1d.workflow.engine.process import worker_environment
from contact1d.workflow.engine.progress import Lines, choose_progress
from contact1d.workflow.engine.session import Engine, Session

OSCILLATOR = """
units           lj
dimension       2
atom_style      bond
region          box block -20 20 -5 5 -0.5 0.5
create_box      1 box bond/types 1 extra/bond/per/atom 1
create_atoms    1 single 1.5 0.25 0.0
create_atoms    1 single 0.0 0.0 0.0
mass            1 1.0
create_bonds    single/bond 1 1 2
pair_style      zero 8.0
pair_coeff      * *
bond_style      harmonic
bond_coeff      1 2.0 0.0
variable        energy equal &
                ebond
variable        double atom 2*x
compute         moved all displace/atom
fix             move all nve
timestep        0.001
thermo          1000
thermo_modify   norm no
run             0
"""
"""Two atoms on a linear spring of energy 2 r²: a force of 4 r on reduced mass 1/2, so ω² = 8."""
CRYSTAL = """
units lj
lattice fcc 0.8
region box block 0 4 0 4 0 4
create_box 1 box
create_atoms 1 box
mass 1 1.0
pair_style lj/cut 2.5
pair_coeff * * 1.0 1.0
velocity all create 3.0 1
fix move all nve
atom_modify sort 10 2.0
run 100
"""

ROUND_OFF = 1e-13
STEP_ERROR = 1e-4  # velocity Verlet: the frequency is off by (ω dt)²/24 = 3e-7, over 10³ steps a phase of 1e-6
LONG = 2_000_000  # more than half a second on a machine of 2025: several looks at the clock


def open_oscillator(session: Session) -> None:
    """Bring the oscillator into a session."""
    session.execute(OSCILLATOR, phase="preparing")


def test_values_and_atoms_come_as_they_are_asked_for_and_stay_after_the_session(tmp_path: Path) -> None:
    """Names of variables, formulas, keywords; properties, computes and their columns, rows by id; a text in quotes.

    The distance is 1.5 cos(√8 t).
    """
    here = Path.cwd()
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        energy = 2.0 * (1.5**2 + 0.25**2)
        values = session.values("energy", "2*v_energy", "step", "x[1]")
        assert values == pytest.approx((energy, 2.0 * energy, 0.0, 1.5), rel=ROUND_OFF)
        asked = ("x", "c_moved", "c_moved[1]", "v_double", "f")
        reading = session.measure(
            'print """first\nsecond"""\nrun 1000\nwrite_data a.data', ("x[1]-x[2]", "step"), asked
        )
        assert reading.values == session.values("x[1]-x[2]", "step")
        assert Path.cwd() == here
    assert (tmp_path / "a.data").is_file()
    assert "first\nsecond\n" in (tmp_path / "log.lammps").read_text()
    assert reading.values == pytest.approx((1.5 * math.cos(math.sqrt(8.0)), 1000.0), abs=STEP_ERROR)
    atoms = reading.atoms
    assert atoms["x"].shape == (2, 3)
    np.testing.assert_array_equal(atoms["v_double"], 2.0 * atoms["x"][:, 0])
    np.testing.assert_array_equal(atoms["c_moved[1]"], atoms["c_moved"][:, 0])
    np.testing.assert_allclose(atoms["x"][:, 0] - atoms["c_moved"][:, 0], [1.5, 0.0], atol=ROUND_OFF)
    np.testing.assert_allclose(atoms["f"][0], -atoms["f"][1], atol=ROUND_OFF)


def test_many_atoms_are_sorted_without_ghosts(tmp_path: Path) -> None:
    """Rows of a periodic crystal that LAMMPS has reordered: as many as there are atoms, ids ascending."""
    with Engine.session(tmp_path) as session:
        read = session.measure(CRYSTAL, atoms=("id",)).atoms
    np.testing.assert_array_equal(read["id"], np.arange(1, 257))
    assert {*read["type"]} == {1}


def test_steps_count_runs_and_minimiser_iterations_and_times_are_those_inside_lammps(tmp_path: Path) -> None:
    """Also where the step counter is set back or cleared, and of every turn of a loop in a file of the folder."""
    loop = "variable turn loop 4\nlabel again\nrun 10\nreset_timestep 0\nnext turn\njump SELF again\n"
    (tmp_path / "in.loop").write_text(loop)
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("include in.loop", phase="looping")
        assert (session.steps, session.phase) == (40, "looping")
        session.execute("run 7\nreset_timestep 3\nrun 2")
        assert (session.steps, session.timestep) == (49, 5)
        session.execute("minimize 0.0 1e-10 100 1000")
        iterations = session.timestep - 5
        assert 0 < iterations < 100
        before = session.lammps_seconds
        session.execute("clear\n" + OSCILLATOR + "run 50000")
        assert session.steps == 49 + iterations + 50_000
        spent = session.lammps_seconds
        assert spent > before
        assert 0.0 < session.lammps_cpu_seconds <= 1.5 * spent + 0.1
        session.values("energy")
        assert session.lammps_seconds == spent


def test_a_worker_is_used_again_and_knows_nothing_of_before_and_a_session_that_is_over_refuses(tmp_path: Path) -> None:
    """The second session has the same process, a fresh LAMMPS and fresh counts, also after an exception between."""
    with pytest.raises(NotADirectoryError, match="does not exist"), Engine.session(tmp_path / "absent"):
        pass
    with pytest.raises(ZeroDivisionError), Engine.session(tmp_path) as first:
        open_oscillator(first)
        first.execute("run 10")
        raise ZeroDivisionError
    with Engine.session(tmp_path) as second:
        assert second.pid == first.pid
        assert (second.steps, second.timestep, second.lammps_seconds) == (0, 0, 0.0)
        open_oscillator(second)
        assert second.values("step") == (0.0,)
    with pytest.raises(RuntimeError, match="the session is over"):
        second.execute("run 0")


def test_sessions_may_be_open_side_by_side(tmp_path: Path) -> None:
    """Nested sessions and threads each have a LAMMPS of their own."""

    def swing(steps: int) -> float:
        folder = tmp_path / str(steps)
        folder.mkdir()
        with Engine.session(folder) as session:
            open_oscillator(session)
            return session.measure(f"run {steps}", ("step",)).values[0]

    with Engine.session(tmp_path) as outer, ThreadPoolExecutor(2) as pool:
        open_oscillator(outer)
        assert list(pool.map(swing, range(10, 14))) == [10.0, 11.0, 12.0, 13.0]
        assert outer.values("step") == (0.0,)


LEAK = 2_000_000  # bytes that 100 sessions may add: pools of the allocators fill up in the first few


def test_sessions_do_not_leak(tmp_path: Path) -> None:
    """Memory and open files of a worker are the same after many sessions."""

    def usage() -> tuple[int, int]:
        with Engine.session(tmp_path) as session:
            open_oscillator(session)
            pages = int(Path(f"/proc/{session.pid}/statm").read_text().split()[1])
            return pages * os.sysconf("SC_PAGESIZE"), len(list(Path(f"/proc/{session.pid}/fd").iterdir()))

    memory, files = [usage() for _ in range(20)][-1]
    later = [usage() for _ in range(100)][-1]
    assert later[0] - memory < LEAK
    assert later[1] == files


@pytest.mark.parametrize(
    ("environ", "transports"),
    [
        ({}, "self,sm"),
        ({"SLURM_NNODES": "2"}, None),
        ({"SLURM_NNODES": "2", "SLURM_STEP_NUM_NODES": "1"}, "self,sm"),
        ({"UCX_TLS": "tcp"}, "tcp"),
    ],
)
def test_environment_of_a_worker(environ: dict[str, str], transports: str | None) -> None:
    """Memory only on one node unless set otherwise, one thread, and never a rank of the launcher's."""
    environment = worker_environment(environ | {"PMI_RANK": "1", "PMIX_RANK": "1", "OMP_NUM_THREADS": "8", "A": "b"})
    assert environment.get("UCX_TLS") == transports
    assert (environment["OMP_NUM_THREADS"], environment["A"]) == ("1", "b")
    assert not [key for key in environment if key.startswith("PMI")]


def test_a_long_run_is_heard_of_while_it_lasts(tmp_path: Path) -> None:
    """Steps arrive in several parts, none negative, and add up to the steps of the session."""
    progress = Mock()
    with Engine.session(tmp_path, progress=progress) as session:
        open_oscillator(session)
        session.execute(f"run {LONG}", phase="running", expected_steps=LONG)
        session.execute("reset_timestep 0\nrun 10")
        assert session.steps == LONG + 10
    assert [told.args for told in progress.phase.mock_calls] == [("preparing", None), ("running", LONG)]
    advances = [told.args[0] for told in progress.advance.mock_calls]
    assert len(advances) >= 3
    assert min(advances) > 0
    assert sum(advances) == LONG + 10


def test_a_pipe_gets_lines_and_what_is_left_of_a_phase_takes_as_long_as_what_is_done(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A quarter took half a minute, so that three of them are left: a minute and a half."""
    assert isinstance(choose_progress(io.StringIO()), Lines)
    now = [0.0]
    monkeypatch.setattr("contact1d.workflow.engine.progress.time.monotonic", lambda: now[0])
    lines = Lines(sys.stdout, quiet=1.0)
    lines.phase("loading", 400)
    now[0] = 30.0
    lines.advance(100)
    assert "step 100 of 400, 3.33 a second, about 90 s left" in capsys.readouterr().out


def test_frames_that_are_not_whole_or_have_atoms_in_another_order_are_refused(tmp_path: Path) -> None:
    """A frame is a header, here of 52 bytes, and rows (id, columns…), which come back by their ids."""
    first, second = [[2, 5.0, 6.0], [1, 3.0, 4.0]], [[2, 9.0, 10.0], [1, 7.0, 8.0]]

    def read(*frames: list[list[float]], cut: int = 0) -> list[Any]:
        whole = b"".join(bytes(52) + np.asarray(rows).tobytes() for rows in frames)
        (tmp_path / "a.bin").write_bytes(whole[: len(whole) - cut])
        found: list[Any] = last_frames(tmp_path / "a.bin", len(frames), 2, 3, 0)[0].tolist()
        return found

    whole = [[[3.0, 4.0], [5.0, 6.0]], [[7.0, 8.0], [9.0, 10.0]]]
    assert read(first, second) == whole
    assert read(first, second, first)[1:] == whole[::-1]
    for start, part in ((100, slice(None)), (0, slice(1, 2))):
        more, end = last_frames(tmp_path / "a.bin", 3 - start // 100, 2, 3, start, part)
        assert (more[0].tolist(), end) == (whole[1], 300)
    for cut in (1, 40, 60, 110):
        with pytest.raises(ValueError, match=r"are not 2 frames|change their order"):
            read(first, second, cut=cut)
    with pytest.raises(ValueError, match="change their order"):
        read(first, second[::-1])
