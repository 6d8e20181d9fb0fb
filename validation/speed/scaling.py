"""What a run costs beside LAMMPS, how cost and memory grow with the particles, and what MPI ranks save.

Outside LAMMPS: wall time of a run minus what its results.json says was spent inside LAMMPS, of the command and of later
runs in one Python process. Cost per particle and step: processor time of Python and LAMMPS together over particles of
both bodies and steps (time steps, or force evaluations at rest). Every size has a process of its own, in which a small
run came first. The bodies are scaled so that the contact covers the same share of the chain.
"""

import json
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Collection, Mapping
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from contact1d import read_scene, run
from validation.doors import Scene, shipped
from validation.hard.cases import PAPER_LAW
from validation.row import Row, at_most
from validation.speed.clock import peak_memory, spent
from validation.study import Bench, Lines, Study

REPEATS = 7
COMMAND = {"figures": 1.5, "no-figures": 0.6}
"""Asked of `contact1d run pull_off.toml` outside LAMMPS [s]."""
LATER = 0.05
"""Asked of a later run in Python, without figures, outside LAMMPS [s]."""
IN_PYTHON = ("load", "pull_off", "hertz_plane")
SPREAD, MEMORY = 2.0, 8.0
"""Asked of the largest cost per particle and step over the smallest, and of the memory at the largest size [GB]."""
STEPS = {200: 40, 2_000: 20, 20_000: 8, 200_000: 2, 1_000_000: 1}
"""Displacements there, and as many back, by particles per body."""
QUICK = 20_000
"""Largest size of the quick form."""
DEEPEST = 0.015
"""Largest displacement [LU]: less than the longest move between two states, so that no state comes in between."""
EVALUATIONS = re.compile(r"Iterations, force evaluations = \d+ (\d+)")
METHODS = ("quasistatic", "dynamic")
SAME = 1e-6
"""Forces on one rank and on several, over the largest: the order of the sums, and where the minimiser stops."""
ASKED = "asked for"


def scaled_scene(particles: int, method: str, steps: int | None = None) -> Scene:
    """A path of a few load steps of two chains; R grows with N², so that heights along the chain are the same."""
    wanted = steps or next((count for size, count in reversed(STEPS.items()) if particles >= size), STEPS[200])
    return read_scene({
        "title": f"{particles} particles per body",
        "bodies": {
            "particles": particles, "spacing": 1.0, "bulk_stiffness": 0.83,
            "profile": {"kind": "parabola", "radius": 1000.0 * (particles / 200) ** 2},
        },
        "interaction": PAPER_LAW,
        "neighbours": {"stiffness": 0.3},
        "experiment": {
            "kind": "path", "method": method, "displacements": {"from": 0.0, "to": DEEPEST, "steps": wanted},
        },
        **({"damping": {"coefficient": "auto"}} if method == "dynamic" else {}),
    })  # fmt: skip


def steps_of(folder: Path, results: Mapping[str, Any]) -> int:
    """Time steps of a run, or the force evaluations of its minimisations, as its log counts them."""
    if results["method"] == "dynamic":
        return int(results["timing"]["steps"])
    return sum(int(count) for count in EVALUATIONS.findall((folder / "log.lammps").read_text()))


def one(particles: int, method: str) -> dict[str, float]:
    """Cost per particle and step [ns] and memory [bytes] of one run in this process, after a small one."""
    with tempfile.TemporaryDirectory() as folder:
        run(scaled_scene(20, method), Path(folder) / "first", figures=False)
        began = spent()
        results = run(scaled_scene(particles, method), Path(folder) / "run", figures=False).document
        cost = 1e9 * (spent() - began) / (2 * particles * steps_of(Path(folder) / "run", results))
    return {"cost": cost, "memory": peak_memory()}


def spread(costs: Collection[float]) -> float:
    """Largest cost over the smallest."""
    return max(costs) / min(costs)


def size_rows(found: Mapping[str, Mapping[int, Mapping[str, float]]]) -> Lines:
    """By method and size: how much the cost varies, and the most memory."""
    for method, sizes in found.items():
        costs, size = [each["cost"] for each in sizes.values()], max(sizes)
        sizes_in_words = f"N = {min(sizes)} to {size} particles per body"
        words = f"CPU time per particle and step, {method}, largest over smallest for {sizes_in_words}"
        yield at_most(words, spread(costs), SPREAD, ASKED, "processor caches", "set bound")
        words, memory = f"memory of program and LAMMPS [GB], {method}, N = {size}", sizes[size]["memory"] / 1e9
        yield at_most(words, memory, MEMORY, ASKED, "–", "set bound")


def measure_scaling(bench: Bench) -> Lines:
    """Each size and method in a process of its own."""
    found: dict[str, dict[int, dict[str, float]]] = {method: {} for method in METHODS}
    for method, sizes in found.items():
        for size in [size for size in STEPS if bench.full or size <= QUICK]:
            code = f"import json; from validation.speed.scaling import one; print(json.dumps(one({size}, {method!r})))"
            done = subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.PIPE, text=True)
            sizes[size] = json.loads(done.stdout)
    return size_rows(found)


def measure_outside(bench: Bench) -> Lines:
    """Medians of the wall time outside LAMMPS, of the command and of later runs in Python."""

    def outside(words: str, limit: float, timed: Callable[[], float]) -> Row:
        value = statistics.median(timed() for _ in range(REPEATS))
        return at_most(
            f"wall time outside LAMMPS [s]: {words}", value, limit, ASKED, "imports; files and figures", "set bound"
        )

    def command(figures: str) -> float:
        program, folder = Path(sys.executable).with_name("contact1d"), bench.folder / "run"
        words: list[str | Path] = [program, "run", shipped("scenes/pull_off.toml"), f"--{figures}", "--out", folder]
        started = time.perf_counter()
        subprocess.run(words, check=True, capture_output=True)
        inside = json.loads((folder / "results.json").read_text())["timing"]["lammps_s"]
        return time.perf_counter() - started - float(inside)

    def later(name: str) -> float:
        started = time.perf_counter()
        timing = run(read_scene(shipped(f"scenes/{name}.toml")), bench.folder / "run", figures=False).timing
        return time.perf_counter() - started - float(timing["lammps_s"])

    for words, limit in COMMAND.items():
        yield outside(f"contact1d run pull_off.toml --{words}", limit, partial(command, words))
    for name in IN_PYTHON:
        later(name)
        yield outside(f"a later run of {name}.toml in Python, no figures", LATER, partial(later, name))


def measure_ranks(bench: Bench) -> Lines:
    """One large contact on one MPI rank and on two, by turns: the same forces, and no more time."""
    for method in METHODS:
        for size in (10_000, 100_000, 1_000_000) if bench.full else (10_000,):
            scene, forces = scaled_scene(size, method, 1), {}
            times: dict[int, list[float]] = {1: [], 2: []}
            for count in times:
                run(scaled_scene(1000, method), bench.folder / "first", figures=False, ranks=count)
            for _ in range(3):
                for count in times:
                    done = run(scene, bench.folder / str(count), figures=False, ranks=count)
                    times[count].append(float(done.timing["rows_s"]))
                    forces[count] = np.asarray(done.curve.force)
            alone, shared = (statistics.median(each) for each in times.values())
            off = float(np.abs(forces[1] - forces[2]).max() / np.abs(forces[1]).max())
            words = f"{method}, {size} particles per body"
            yield at_most(f"difference of the forces on two MPI ranks and on one, over the largest force: {words}", off,
                          SAME, "the same contact", "order of the sums")  # fmt: skip
            yield at_most("wall time of the load steps on two MPI ranks over that on one: "
                          f"{words} ({alone:.3g} s on one)",
                          shared / alone, 1.0, "no more time", "what two processors share", "set bound")  # fmt: skip


OUTSIDE = Study("outside", "Wall time outside LAMMPS", "What does the program cost beside the solver?", measure_outside)
SCALING = Study("scaling", "Cost and memory over the size", "Does the cost grow as the particles do?", measure_scaling)
RANKS = Study("ranks", "MPI ranks", "Do several ranks have the same forces, in no more time?", measure_ranks)
