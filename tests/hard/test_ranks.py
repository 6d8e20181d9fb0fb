"""Several MPI ranks: the numbers of one, and every way in which one of them can fail ends all, in words."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from contact1d import EngineError, read_scene, run
from contact1d.__main__ import app
from contact1d.workflow.engine import launcher
from contact1d.workflow.engine.launcher import RanksError
from contact1d.workflow.engine.process import stop_idle
from contact1d.workflow.engine.session import Engine
from tests.scenes import chains
from tests.slurm import slurm

SAME = 1e-10
"""Relative: sums in another order, and what a minimiser makes of that. Found: 1e-11."""
BODIES = {"particles": 200}
TIMED = {"damping": {"coefficient": "auto"}, "plate": {"mass": 200.0}}
SCENES: dict[str, dict[str, Any]] = {
    "load": chains(1000.0, bodies=BODIES, experiment={"kind": "load", "force": 1.0}),
    "load in time": chains(1000.0, bodies=BODIES, **TIMED, experiment={"kind": "load", "force": 1.0}),
    "pull_off": chains(
        1000.0, bodies=BODIES, neighbours={"stiffness": 0.3}, horizontal={},
        experiment={"kind": "pull_off", "preload": 1.0},
    ),
    "path": chains(
        1000.0, bodies=BODIES,
        experiment={"kind": "path", "displacements": {"from": -0.5, "to": 0.3, "steps": 8, "return": True}},
    ),
}  # fmt: skip
ENDLESS = """
units           lj
processors      * 1 1
region          box block 0 20 0 20 0 20
create_box      1 box
create_atoms    1 single 5.0 5.0 5.0
create_atoms    1 single 15.0 5.0 5.0
mass            1 1.0
pair_style      zero 2.0
pair_coeff      * *
fix             move all nve
thermo          1000000
"""
ENDLESS_RUN = "run 2000000000"


def alive(pid: int) -> bool:
    """Whether a process runs; one that only waits to be collected does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except (FileNotFoundError, ProcessLookupError):
        return False


def ranks_of(launched: int) -> list[int]:
    """Process ids of the ranks below a launcher."""
    parents = {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            parents[int(stat.parent.name)] = int(stat.read_text().rpartition(")")[2].split()[1])
        except (FileNotFoundError, ProcessLookupError):
            continue
    proxies = [pid for pid, parent in parents.items() if parent == launched]
    return sorted(pid for pid, parent in parents.items() if parent in proxies)


def wait_for_the_end_of(ranks: list[int]) -> None:
    """Ranks that live on end this test by its time limit."""
    while any(map(alive, ranks)):
        time.sleep(0.02)


@pytest.mark.parametrize("name", SCENES)
def test_two_ranks_have_the_numbers_of_one(tmp_path: Path, name: str) -> None:
    one, two = (run(SCENES[name], tmp_path / str(ranks), figures=False, ranks=ranks) for ranks in (1, 2))
    assert two.results.keys() == one.results.keys()
    for key, quantity in one.results.items():
        if key != "dissipated_energy":  # of a way that dissipates nothing: what is left of a difference
            assert two.results[key].value == pytest.approx(quantity.value, rel=SAME), key
    assert two.document["timing"]["steps"] == one.document["timing"]["steps"]


def test_the_deck_by_hand_on_two_ranks_has_the_same_rows(tmp_path: Path) -> None:
    """`mpiexec -n 2 lmp -in in.lammps`: loops, variables and what is printed are those of one."""
    run(SCENES["pull_off"], tmp_path, figures=False)
    program = np.loadtxt(tmp_path / "curve.csv", delimiter=",", skiprows=1, usecols=(0, 1))
    bin_ = Path(sys.executable).parent
    hand = [str(bin_ / "mpiexec"), "-n", "2", str(bin_ / "lmp"), "-in", "in.lammps", "-screen", "none"]
    subprocess.run(hand, cwd=tmp_path, env=os.environ | {"UCX_TLS": "self,sm"}, check=True, capture_output=True)
    rows = np.loadtxt(tmp_path / "curve.txt", usecols=(1, 2))
    assert rows == pytest.approx(program, rel=SAME, abs=SAME)


@pytest.mark.parametrize("which", [0, 1])
def test_a_rank_that_is_killed_ends_the_others_in_words(tmp_path: Path, which: int) -> None:
    with (
        pytest.raises(EngineError, match="one of its 2 ranks was killed") as caught,
        Engine.session(tmp_path, ranks=2) as session,
    ):
        session.execute(ENDLESS)
        ranks = ranks_of(session.pid)
        assert len(ranks) == 2
        threading.Timer(0.5, os.kill, (ranks[which], signal.SIGKILL)).start()
        session.execute(ENDLESS_RUN, phase="on and on")
    assert caught.value.phase == "on and on"
    wait_for_the_end_of(ranks)


@pytest.mark.parametrize("place", [5.0, 15.0])
def test_an_error_on_one_rank_is_that_of_the_run(tmp_path: Path, place: float) -> None:
    """`error->one`: the others wait for it in the middle of a step, and would wait for good."""
    alone = f"variable bad atom 1.0/(x-{place})\ncompute bad all reduce sum v_bad\nthermo_style custom c_bad\nrun 0"
    with (
        pytest.raises(EngineError, match="LAMMPS stopped: Divide by 0"),
        Engine.session(tmp_path, ranks=2) as session,
    ):
        session.execute(ENDLESS)
        ranks = ranks_of(session.pid)
        session.execute(alone)
    wait_for_the_end_of(ranks)


def test_a_position_that_is_no_number_is_found_on_any_rank(tmp_path: Path) -> None:
    with (
        pytest.raises(EngineError, match="position of atom 2 is not"),
        Engine.session(tmp_path, ranks=2) as session,
    ):
        session.execute(ENDLESS)
        session.execute("neigh_modify every 1000 delay 1000\nrun 0\ngroup second id 2\n")
        session.execute("fix push second addforce 1e308 1e308 1e308\ntimestep 1e100\nrun 5")


def test_ranks_out_of_time_are_ended(tmp_path: Path) -> None:
    with (
        pytest.raises(EngineError, match="longer than its time limit"),
        Engine.session(tmp_path, 3.0, ranks=2) as session,
    ):
        session.execute(ENDLESS)
        ranks = ranks_of(session.pid)
        session.execute(ENDLESS_RUN)
    wait_for_the_end_of(ranks)


def test_ranks_are_kept_for_the_next_session_and_end_with_the_program(tmp_path: Path) -> None:
    pids = []
    for _ in range(2):
        with Engine.session(tmp_path, ranks=2) as session:
            session.execute(ENDLESS)
            pids.append(session.pid)
    assert pids[0] == pids[1]
    ranks = ranks_of(pids[0])
    stop_idle()
    wait_for_the_end_of(ranks)


PARENT = """
import sys
from pathlib import Path
from contact1d.workflow.engine.session import Engine
with Engine.session(Path(sys.argv[1]), ranks=2) as session:
    session.execute(sys.argv[2])
    print(session.pid, flush=True)
    session.execute(sys.argv[3])
"""


def test_ranks_end_with_a_parent_that_is_killed(tmp_path: Path) -> None:
    command = [sys.executable, "-c", PARENT, str(tmp_path), ENDLESS, ENDLESS_RUN]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as parent:
        assert parent.stdout is not None
        ranks = ranks_of(int(parent.stdout.readline()))
        assert len(ranks) == 2
        parent.kill()
    wait_for_the_end_of(ranks)


REFUSED = {
    "noise": (SCENES["load in time"] | {"noise": {"temperature": 0.001, "seed": 1}}, "its own random forces"),
    "plane": (
        {**SCENES["load"], "interaction": None, "bodies": {**SCENES["load"]["bodies"], "lower": "rigid_plane"}},
        "on a rigid plane",
    ),
    "far": (
        {**SCENES["load"], "horizontal": {}, "bodies": {**SCENES["load"]["bodies"], "bulk_stiffness_tangential": 2.0}},
        "stiffer along x",
    ),
    "many": (
        SCENES["load"] | {"bodies": SCENES["load"]["bodies"] | {"particles": 120}},
        "at most 2, 50 particles each",
    ),
}


@pytest.mark.parametrize("name", REFUSED)
def test_ranks_that_are_no_use_are_refused_before_anything_is_written(tmp_path: Path, name: str) -> None:
    scene, words = REFUSED[name]
    tables = {key: table for key, table in scene.items() if table is not None}
    with pytest.raises(RanksError, match=words):
        run(tables, tmp_path / "run", figures=False, ranks=5)
    assert not (tmp_path / "run").exists()


def test_the_command_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = tmp_path / "scene.toml"
    file.write_text(str(read_scene(SCENES["load"])))
    monkeypatch.setattr(launcher, "find_spec", lambda name: None)
    result = CliRunner().invoke(app, ["run", str(file), "--out", str(tmp_path / "out"), "--ranks", "2"])
    assert (result.exit_code, (tmp_path / "out").exists()) == (2, False)
    assert "pip install 'contact1d[cluster]'" in result.output


@pytest.mark.cluster
@pytest.mark.parametrize("nodes", [1, 2])
def test_in_a_job_of_slurm_the_ranks_have_its_nodes(tmp_path: Path, nodes: int) -> None:
    script, scene, said = tmp_path / "job.sh", tmp_path / "scene.toml", tmp_path / "said"
    scene.write_text(str(read_scene(SCENES["load"])))
    here = run(SCENES["load"], tmp_path / "here", figures=False)
    command = f"{sys.executable} -m contact1d run {scene} --out {tmp_path}/there --no-figures --ranks 2"
    script.write_text(f"#!/bin/bash\n{command} >{said} 2>&1\n")
    with slurm(tmp_path / "slurm", nodes) as environment:
        job = ["sbatch", "--wait", "--ntasks=2", f"--nodes={nodes}", f"--output={tmp_path}/job.out", str(script)]
        subprocess.run(job, env=environment, check=False, timeout=120)
        log = "".join((tmp_path / "slurm" / f"node{number}.log").read_text() for number in range(1, nodes + 1))
    # The script is a step of the first node; ranks on two nodes are one more, of both.
    assert len(re.findall(r"launch task", log)) == (2 if nodes == 2 else 0), log
    assert (tmp_path / "there" / "results.json").is_file(), said.read_text()
    document = json.loads((tmp_path / "there" / "results.json").read_text())
    assert document["status"] == "done"
    assert document["force"]["value"] == pytest.approx(here.results.force.value, rel=SAME)
