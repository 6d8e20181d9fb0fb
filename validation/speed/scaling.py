"""What a run costs beside LAMMPS, and how its cost and memory grow with the number of particles.

    python validation/speed/scaling.py [--sizes 200 2000 20000 200000 1000000] [--methods dynamic quasistatic]

(a) Time outside LAMMPS: wall time of a run minus what its results.json says was spent inside LAMMPS; of the command
    `contact1d run` with and without figures, and of the second and later runs in one Python process.
(b) Cost per particle and step: processor time of Python and of its LAMMPS process together, from the scene to the
    finished folder, over particles of both bodies and steps; a step is a time step, or quasistatically a force
    evaluation. Every size has a process of its own, in which a small run came first, so that start-up is left to (a).
    The bodies are scaled so that the contact covers the same share of the chain; small ones take more rows, as they
    would in use. Memory is the peak of each process.

Processor times stand beside the wall times of (a): they are what remains of them on a machine that is shared.
The table goes to validation/speed/results/scaling.json too. Exit code 1 where an asked figure is not reached.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import re
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import Any

from contact1d import read_scene, run
from contact1d.workflow.scene import Scene, scene_from_dict

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
RESULTS = Path(__file__).parent / "results" / "scaling.json"
COMMAND_RUNS, PYTHON_RUNS = 5, 10
COMMAND = {"figures": 1.5, "no-figures": 0.6}
"""Asked of `contact1d run pull_off.toml` outside LAMMPS [s]."""
LATER = 0.05
"""Asked of a later run in Python, without figures, outside LAMMPS [s]."""
IN_PYTHON = ("load", "pull_off", "hertz_plane")
SPREAD = 2.0
"""Asked of the largest cost per particle and step over the smallest."""
MEMORY = 8e9
"""Asked of both processes together at the largest size [bytes]."""
ROWS = {200: 40, 2_000: 20, 20_000: 8, 200_000: 2, 1_000_000: 1}
"""Displacements there, and as many back, of a scene with at least so many particles per body."""
DEEPEST = 0.015
"""Largest displacement [LU]: less than the longest move between two states, so that no row comes in between."""
EVALUATIONS = re.compile(r"Iterations, force evaluations = \d+ (\d+)")


def scaled_scene(particles: int, method: str) -> Scene:
    """A path of a few rows of two chains; R grows with N², so that heights along the chain are the same for all N."""
    rows = [count for least, count in ROWS.items() if particles >= least] or [max(ROWS.values())]
    tables: dict[str, Any] = {"damping": {"coefficient": "auto"}} if method == "dynamic" else {}
    return scene_from_dict(
        {
            "title": f"{particles} particles per body",
            "bodies": {
                "particles": particles,
                "spacing": 1.0,
                "profile": {"kind": "parabola", "radius": 1000.0 * (particles / 200) ** 2},
                "bulk_stiffness": 0.83,
            },
            "interaction": {
                "repulsion": {"amplitude": 0.18, "range": 0.13},
                "attraction": {"amplitude": 0.09, "range": 0.26},
            },
            "neighbours": {"stiffness": 0.3},
            "experiment": {
                "kind": "path",
                "method": method,
                "displacements": {"from": 0.0, "to": DEEPEST, "steps": rows[-1]},
            },
        }
        | tables
    )


def steps_of(folder: Path, results: dict[str, Any]) -> int:
    """Time steps of a run, or the force evaluations of its minimisations, as its log counts them."""
    if results["method"] == "dynamic":
        return int(results["timing"]["steps"])
    return sum(int(count) for count in EVALUATIONS.findall((folder / "log.lammps").read_text()))


def workers() -> list[int]:
    """Process ids of this process's children: the one LAMMPS process."""
    tasks = Path("/proc/self/task").glob("*/children")
    return [int(number) for task in tasks for number in task.read_text().split()]


def cpu_seconds(pid: int) -> float:
    """Processor time of a process so far [s]."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def peak_memory(pid: int) -> int:
    """Largest resident memory of a process so far [bytes]."""
    line = re.search(r"VmHWM:\s+(\d+) kB", Path(f"/proc/{pid}/status").read_text())
    return 1024 * int(line[1]) if line else 0


def one(particles: int, method: str) -> dict[str, Any]:
    """Cost of one run in this process, after a small one."""
    scene = scaled_scene(particles, method)
    with tempfile.TemporaryDirectory() as folder:
        run(scaled_scene(20, method), Path(folder) / "first", figures=False)
        (worker,) = workers()
        before, started = (time.process_time(), cpu_seconds(worker)), time.perf_counter()
        results = run(scene, Path(folder) / "run", figures=False).document
        wall = time.perf_counter() - started
        python, child = time.process_time() - before[0], cpu_seconds(worker) - before[1]
        steps = steps_of(Path(folder) / "run", results)
    lammps = results["timing"]["lammps_cpu_s"]
    share = 1e9 / (2 * particles * steps)
    return {
        "particles_per_body": particles, "method": method, "steps": steps, "wall_s": wall, "cpu_s": python + child,
        "lammps_cpu_s": lammps, "worker_other_cpu_s": child - lammps, "python_cpu_s": python,
        "ns_per_particle_step": share * (python + child), "lammps_ns_per_particle_step": share * lammps,
        "python_bytes": peak_memory(os.getpid()), "lammps_bytes": peak_memory(worker),
    }  # fmt: skip


def scaling(sizes: Sequence[int], methods: Sequence[str]) -> list[dict[str, Any]]:
    """`one` for each method and size, each in a new process; printed as they come."""
    head = ("method", "N", "steps", "wall s", "ns all", "in LAMMPS", "Python", "LAMMPS")
    print("\n{:<12}{:>9}{:>7}{:>9}{:>10}{:>11}{:>10}{:>10}".format(*head), "  (ns per particle and step; peak memory)")
    rows = []
    for method in methods:
        for size in sizes:
            command = [sys.executable, str(Path(__file__).resolve()), "--one", str(size), method]
            done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
            row = json.loads(done.stdout)
            rows.append(row)
            print(
                f"{method:<12}{size:>9}{row['steps']:>7}{row['wall_s']:>9.1f}{row['ns_per_particle_step']:>10.1f}"
                f"{row['lammps_ns_per_particle_step']:>11.1f}{row['python_bytes'] / 1e6:>7.0f} MB"
                f"{row['lammps_bytes'] / 1e6:>7.0f} MB",
                flush=True,
            )
    return rows


def command_run(scene: Path, figures: str, folder: Path) -> tuple[float, float]:
    """Wall and processor time [s] of one `contact1d run`, with its children, without what LAMMPS took."""
    program = Path(sys.executable).with_name("contact1d")
    words = [str(program), "run", str(scene), f"--{figures}", "--out", str(folder)]
    before, started = os.times(), time.perf_counter()
    subprocess.run(words, check=True, capture_output=True)
    wall, after = time.perf_counter() - started, os.times()
    cpu = after.children_user + after.children_system - before.children_user - before.children_system
    timing = json.loads((folder / "results.json").read_text())["timing"]
    return wall - timing["lammps_s"], cpu - timing["lammps_cpu_s"]


def later_run(scene: Scene, figures: bool, folder: Path) -> tuple[float, float]:
    """Wall and processor time [s] of one run in this process, without what LAMMPS took."""
    (worker,) = workers()
    before, started = time.process_time() + cpu_seconds(worker), time.perf_counter()
    timing = run(scene, folder, figures=figures).document["timing"]
    wall = time.perf_counter() - started
    cpu = time.process_time() + cpu_seconds(worker) - before
    return wall - timing["lammps_s"], cpu - timing["lammps_cpu_s"]


def outside() -> list[dict[str, Any]]:
    """Part (a): medians, printed as they come."""
    print(f"{'outside LAMMPS':<44}{'wall ms':>9}{'CPU ms':>9}{'asked':>8}")
    rows = []

    def add(name: str, times: Sequence[tuple[float, float]], asked: float | None) -> None:
        wall, cpu = (statistics.median(column) for column in zip(*times, strict=True))
        rows.append({"run": name, "wall_s": wall, "cpu_s": cpu, "asked_s": asked, "runs": len(times)})
        print(f"{name:<44}{1e3 * wall:>9.1f}{1e3 * cpu:>9.1f}{1e3 * asked if asked else '':>8}", flush=True)

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "run"
        for figures, asked in COMMAND.items():
            times = [command_run(SCENES / "pull_off.toml", figures, folder) for _ in range(COMMAND_RUNS)]
            add(f"contact1d run pull_off.toml --{figures}", times, asked)
        for stem in IN_PYTHON:
            scene = read_scene(SCENES / f"{stem}.toml")
            for figures in (False, True):
                run(scene, folder, figures=figures)
                times = [later_run(scene, figures, folder) for _ in range(PYTHON_RUNS)]
                words = "with figures" if figures else "no figures"
                add(f"Python, later runs of {stem}.toml, {words}", times, None if figures else LATER)
    return rows


def spread(rows: Sequence[dict[str, Any]]) -> float:
    """Largest cost per particle and step over the smallest."""
    costs = [row["ns_per_particle_step"] for row in rows]
    return float(max(costs) / min(costs))


def missed(costs: Sequence[dict[str, Any]], sizes: Sequence[dict[str, Any]]) -> list[str]:
    """What was asked and not reached, one sentence each."""
    found = [
        f"{row['run']}: {1e3 * row['wall_s']:.0f} ms, asked {1e3 * row['asked_s']:.0f} ms"
        for row in costs
        if row["asked_s"] is not None and row["wall_s"] > row["asked_s"]
    ]
    for method in dict.fromkeys(row["method"] for row in sizes):
        ratio = spread([row for row in sizes if row["method"] == method])
        if ratio > SPREAD:
            found.append(f"{method}: cost per particle and step varies by {ratio:.2f}, asked {SPREAD:g}")
    for row in sizes:
        memory = row["python_bytes"] + row["lammps_bytes"]
        if memory > MEMORY:
            found.append(
                f"{row['method']}, N = {row['particles_per_body']}: {memory / 1e9:.1f} GB, asked {MEMORY / 1e9:g}"
            )
    return found


def machine() -> dict[str, Any]:
    """What the numbers depend on."""
    model = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text())
    return {
        "processor": model[1] if model else platform.machine(),
        "cores": os.cpu_count(),
        "memory_bytes": os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"),
        "load_average_before": os.getloadavg()[0],
        "python": platform.python_version(),
        "versions": {name: version(name) for name in ("contact1d", "lammps", "numpy", "scipy", "matplotlib")},
    }


def main() -> int:
    """Measure and print; 1 where an asked figure is not reached."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sizes", nargs="*", type=int, default=[200, 2_000, 20_000, 200_000, 1_000_000])
    parser.add_argument("--methods", nargs="+", choices=("dynamic", "quasistatic"), default=["dynamic", "quasistatic"])
    parser.add_argument("--one", nargs=2, metavar=("N", "METHOD"), help="measure one size in this process, print JSON")
    options = parser.parse_args()
    if options.one:
        print(json.dumps(one(int(options.one[0]), options.one[1])))
        return 0
    where = machine()
    costs = outside()
    sizes = scaling(options.sizes, options.methods) if options.sizes else []
    short = missed(costs, sizes)
    print("\n".join(["", *(short or ["every asked figure is reached"])]))
    RESULTS.parent.mkdir(exist_ok=True)
    record = {"machine": where, "outside_lammps": costs, "scaling": sizes, "missed": short}
    RESULTS.write_text(json.dumps(record, indent=1) + "\n")
    return int(bool(short))


if __name__ == "__main__":
    sys.exit(main())
