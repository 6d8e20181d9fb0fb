"""A session of the engine: commands in, numbers and arrays out, counted and timed, in the right folder."""

from __future__ import annotations

import math
import os
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

from contact1d.workflow.engine.process import worker_environment
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

ROUND_OFF = 1e-13
STEP_ERROR = 1e-4  # velocity Verlet: the frequency is off by (ω dt)²/24 = 3e-7, over 10³ steps a phase of 1e-6


def open_oscillator(session: Session) -> None:
    """Bring the oscillator into a session."""
    session.execute(OSCILLATOR, phase="preparing")


def test_values_are_variables_formulas_and_thermo_keywords(tmp_path: Path) -> None:
    """A name of a variable, a formula over it, a keyword, an element; in one call in the order asked."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        energy = 2.0 * (1.5**2 + 0.25**2)
        assert session.value("energy") == pytest.approx(energy, rel=ROUND_OFF)
        values = session.values("2*v_energy", "step", "x[1]")
        assert values == pytest.approx((2.0 * energy, 0.0, 1.5), rel=ROUND_OFF)


def test_dynamics_are_those_of_the_equation_of_motion(tmp_path: Path) -> None:
    """The distance is 1.5 cos(√8 t)."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("run 1000", phase="swinging")
        assert session.value("x[1]-x[2]") == pytest.approx(1.5 * math.cos(math.sqrt(8.0)), abs=STEP_ERROR)


def test_atoms_come_by_id_and_stay_after_the_session(tmp_path: Path) -> None:
    """Rows are sorted, arrays are copies, and properties, computes, their columns and variables all work."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("run 1000")
        atoms = session.atoms("x", "c_moved", "c_moved[1]", "v_double", "f")
    assert list(atoms["id"]) == [1, 2]
    assert list(atoms["type"]) == [1, 1]
    assert atoms["x"].shape == (2, 3)
    np.testing.assert_array_equal(atoms["v_double"], 2.0 * atoms["x"][:, 0])
    np.testing.assert_array_equal(atoms["c_moved[1]"], atoms["c_moved"][:, 0])
    np.testing.assert_allclose(atoms["x"][:, 0] - atoms["c_moved"][:, 0], [1.5, 0.0], atol=ROUND_OFF)
    np.testing.assert_allclose(atoms["f"][0], -atoms["f"][1], atol=ROUND_OFF)


def test_many_atoms_are_sorted_without_ghosts(tmp_path: Path) -> None:
    """Rows of a periodic crystal that LAMMPS has reordered: as many as there are atoms, ids ascending."""
    crystal = """
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
    with Engine.session(tmp_path) as session:
        session.execute(crystal)
        identity = session.atoms()["id"]
    np.testing.assert_array_equal(identity, np.arange(1, 257))


def test_measure_is_execute_then_read(tmp_path: Path) -> None:
    """One round trip gives what three calls give."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        reading = session.measure("run 10", ("energy", "step"), ("x",))
        assert reading.values == session.values("energy", "step")
        assert reading.values[1] == 10.0
        np.testing.assert_array_equal(reading.atoms["x"], session.atoms("x")["x"])


def test_what_is_done_meanwhile_is_done_while_lammps_is_at_work(tmp_path: Path) -> None:
    lines = {}
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        log = tmp_path / "log.lammps"

        def look() -> None:
            lines["meanwhile"] = log.read_text().count("Loop time")

        before = log.read_text().count("Loop time")
        (step,) = session.measure("run 20000", ("step",), meanwhile=look).values
        assert step == 20000.0
        assert lines["meanwhile"] == before
        assert log.read_text().count("Loop time") == before + 1


def test_steps_count_runs_and_minimiser_iterations(tmp_path: Path) -> None:
    """Runs add up, also when the step counter is set back in between; minimisation counts its iterations."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("run 7\nreset_timestep 0\nrun 5\nreset_timestep 3")
        session.execute("run 2")
        assert (session.steps, session.timestep) == (14, 5)
        session.execute("minimize 0.0 1e-10 100 1000")
        iterations = session.timestep - 5
        assert 0 < iterations < 100
        assert session.steps == 14 + iterations


def test_times_are_those_inside_lammps(tmp_path: Path) -> None:
    """Wall and processor time grow with a run and not with waiting."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        before = session.lammps_seconds
        session.execute("run 50000")
        spent = session.lammps_seconds
        assert spent > before
        assert 0.0 < session.lammps_cpu_seconds <= 1.5 * spent + 0.1
        session.value("energy")
        assert session.lammps_seconds == spent


def test_a_file_of_the_folder_may_loop(tmp_path: Path) -> None:
    """`label`, `next` and `jump SELF` work in `run_file`, and the steps of every turn count."""
    loop = "variable turn loop 4\nlabel again\nrun 10\nreset_timestep 0\nnext turn\njump SELF again\n"
    (tmp_path / "in.loop").write_text(OSCILLATOR + loop)
    with Engine.session(tmp_path) as session:
        session.run_file("in.loop", phase="looping")
        assert session.steps == 40
        assert session.phase == "looping"


def test_triple_quotes_span_lines(tmp_path: Path) -> None:
    """A quoted text goes to the log as it stands."""
    with Engine.session(tmp_path) as session:
        session.execute('print """first\nsecond"""')
    assert "first\nsecond\n" in (tmp_path / "log.lammps").read_text()


def test_clear_starts_over_within_a_session(tmp_path: Path) -> None:
    """`clear` frees the step counter that the worker looks at; a second deck then counts on."""
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("run 10")
        session.execute("clear\n" + OSCILLATOR + "run 5")
        assert session.steps == 15


def test_the_current_folder_of_the_parent_stays(tmp_path: Path) -> None:
    """File names in commands belong to the run folder, and only there."""
    here = Path.cwd()
    with Engine.session(tmp_path) as session:
        open_oscillator(session)
        session.execute("write_data written.data")
        assert Path.cwd() == here
    assert (tmp_path / "written.data").is_file()


def test_a_missing_folder_is_a_mistake_of_the_caller(tmp_path: Path) -> None:
    """No folder is made silently."""
    with pytest.raises(NotADirectoryError, match="does not exist"), Engine.session(tmp_path / "absent"):
        pass


def test_a_worker_is_used_again_and_knows_nothing_of_before(tmp_path: Path) -> None:
    """The second session has the same process, a fresh LAMMPS and fresh counts, also after an exception between."""
    with pytest.raises(ZeroDivisionError), Engine.session(tmp_path) as first:
        open_oscillator(first)
        first.execute("run 10")
        raise ZeroDivisionError
    with Engine.session(tmp_path) as second:
        assert second.pid == first.pid
        assert (second.steps, second.timestep, second.lammps_seconds) == (0, 0, 0.0)
        open_oscillator(second)
        assert second.value("step") == 0.0


def test_sessions_may_be_open_side_by_side(tmp_path: Path) -> None:
    """Two nested sessions and four threads each have a LAMMPS of their own."""

    def swing(steps: int) -> float:
        folder = tmp_path / str(steps)
        folder.mkdir()
        with Engine.session(folder) as session:
            open_oscillator(session)
            return session.measure(f"run {steps}", ("step",)).values[0]

    with Engine.session(tmp_path) as outer:
        open_oscillator(outer)
        assert swing(3) == 3.0
        assert outer.value("step") == 0.0
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(swing, range(10, 18))) == [float(steps) for steps in range(10, 18)]


LEAK = 4_000_000  # bytes that 200 sessions may add: pools of the allocators fill up in the first few


def test_sessions_do_not_leak(tmp_path: Path) -> None:
    """Memory and open files of a worker are the same after many sessions."""

    def usage() -> tuple[int, int]:
        with Engine.session(tmp_path) as session:
            open_oscillator(session)
            pages = int(Path(f"/proc/{session.pid}/statm").read_text().split()[1])
            return pages * os.sysconf("SC_PAGESIZE"), len(list(Path(f"/proc/{session.pid}/fd").iterdir()))

    for _ in range(20):
        usage()
    memory, files = usage()
    for _ in range(200):
        later = usage()
    assert later[0] - memory < LEAK
    assert later[1] == files


def test_a_session_after_its_end_refuses(tmp_path: Path) -> None:
    """Its worker may belong to somebody else by then."""
    with Engine.session(tmp_path) as session:
        pass
    with pytest.raises(RuntimeError, match="the session is over"):
        session.execute("run 0")


@pytest.mark.parametrize(
    ("environ", "transports"),
    [
        ({}, "self,sm"),
        ({"SLURM_NNODES": "1"}, "self,sm"),
        ({"SLURM_NNODES": "2"}, None),
        ({"SLURM_NNODES": "2", "SLURM_STEP_NUM_NODES": "1"}, "self,sm"),
        ({"UCX_TLS": "tcp"}, "tcp"),
    ],
)
def test_environment_of_a_worker(environ: dict[str, str], transports: str | None) -> None:
    """Memory only on one node unless told otherwise, one thread, and never a rank of the launcher's."""
    environment = worker_environment(environ | {"PMI_RANK": "1", "PMIX_RANK": "1", "OMP_NUM_THREADS": "8", "A": "b"})
    assert environment.get("UCX_TLS") == transports
    assert environment["OMP_NUM_THREADS"] == "1"
    assert environment["A"] == "b"
    assert not [key for key in environment if key.startswith("PMI")]
