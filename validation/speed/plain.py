"""The plain way of the paper, kept to be compared with: every tension from the start, bisected.

For each tension a fresh contact is pressed together by F_D until it is at rest, then pulled until it is at rest again
or lost; the bracket of the tension is halved until it is as narrow as the accuracy that is asked for. Damping is one
fixed value, the critical one of the contact under its preload; every quarter of a settling time a state is measured.

The ratios hang on that damping and on the time step, so that two plain ways are timed: as a careful deck has them, and
"tuned", with the program's own time step and the damping that was found to be quickest for the scene.

    .venv/bin/python validation/speed/plain.py [SCENE] [--tolerance 1e-2 1e-3]

prints processor time in LAMMPS, timesteps and F_A of the plain way beside those of `contact1d run` with `quasistatic`
and with `dynamic`, on the same scene at the same tolerance, and the error of each against the independent solver, whose
own time stands there too.
"""

from __future__ import annotations

import argparse
import json
import math
import platform
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

from contact1d import read_scene, run
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments.running.contact import Contact
from contact1d.workflow.experiments.running.holding import LOSS_SHARE, REST_SHARE
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import chunk_steps
from contact1d.workflow.scene import PullOff, Scene, scene_from_dict
from contact1d.workflow.settings.calibration import CALIBRATION
from contact1d.workflow.settings.settings import settings_for
from validation.paper.oracles import chain_model
from validation.references.pull_off import pull_off

SCENE = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "paper.toml"
RESULTS = Path(__file__).parent / "results" / "plain.json"
TIME_LIMIT = 3600.0
REPEATS = {"quasistatic": 7, "dynamic": 5}
"""Runs each time; the median of all counts. The long ones are steady by themselves."""
STEP = 0.2
"""ω_max·Δt of the plain way, some thirty steps to the fastest period: what a careful deck has."""
TUNED_DAMPING = 0.3
"""Damping of a particle [FU·TU/LU] of the tuned way; the automatic one is 0.74 in the paper's scene."""


@dataclass(frozen=True)
class Cost:
    """What a pull-off took: F_A [FU], its error, processor time in LAMMPS [s], timesteps and minimiser iterations."""

    way: str
    tolerance: float
    adhesion_force: float
    error: float
    cpu_s: float
    steps: int


def dynamic(scene: Scene, tolerance: float) -> Scene:
    """The scene by the paper's method."""
    data = scene.model_dump(by_alias=True, exclude_none=True)
    data["experiment"]["method"] = "dynamic"
    data |= {"damping": {"coefficient": "auto"}, "plate": {"mass": "auto"}, "accuracy": {"tolerance": tolerance}}
    return scene_from_dict(data)


def quasistatic(scene: Scene, tolerance: float) -> Scene:
    """The scene by prescribed displacement."""
    data = scene.model_dump(by_alias=True, exclude_none=True)
    data["experiment"]["method"] = "quasistatic"
    data["accuracy"] = {"tolerance": tolerance}
    return scene_from_dict(data)


def held(contact: Contact, load: float, scale: float) -> bool:
    """Whether the contact comes to rest under a load [FU], or is lost."""
    settings, largest = contact.settings, 0.0
    near = REST_SHARE * contact.settings.tolerance * scale
    stiffness = scale / settings.largest_displacement
    while True:
        state = contact.row(UnderLoad(load, chunk_steps(settings)))
        if max(abs(state.force - load), abs(state.plate_velocity) * settings.settle_time * stiffness) <= near:
            return True
        largest = max(largest, -state.force)
        off = load < 0.0 < largest and state.plate_velocity < 0.0 and -state.force < LOSS_SHARE * min(largest, -load)
        if off or state.smallest_distance > settings.cutoff:
            return False


def plain(scene: Scene, tolerance: float, folder: Path, tuned: bool) -> tuple[float, float, int]:
    """F_A [FU], processor time [s] and timesteps of the plain way."""
    timed = dynamic(scene, tolerance)
    assert isinstance(timed.experiment, PullOff)
    preload = timed.experiment.preload
    settings = settings_for(timed)
    if tuned:
        settings = replace(settings, damping=TUNED_DAMPING)
    else:
        settings = replace(settings, time_step=settings.time_step * STEP / CALIBRATION.still_step)
    deck = Deck(timed, settings)
    folder.mkdir(parents=True, exist_ok=True)
    write_system(deck, folder)
    context = RunContext(deck, folder, Silent(), TIME_LIMIT)
    guess = deck.settings.estimate.pull_off_force()
    low, high = 0.0, 2.0 * guess
    while high - low > tolerance * high:
        tension = 0.5 * (low + high)
        with context.contact() as contact:
            contact.begin("loading")
            held(contact, preload, max(preload, guess))
            contact.begin("pulling")
            holds = held(contact, -tension, max(preload, guess))
            contact.finish()
        low, high = (tension, high) if holds else (low, tension)
    return 0.5 * (low + high), context.lammps_cpu_seconds, context.steps


def compared(scene: Scene, tolerance: float, folder: Path) -> list[Cost]:
    """All at one tolerance, the quick ones run before, between and after the long ones: machines have slow minutes."""
    assert isinstance(scene.experiment, PullOff)
    ours = {"quasistatic": quasistatic(scene, tolerance), "dynamic": dynamic(scene, tolerance)}
    done: dict[str, list[dict[str, Any]]] = {way: [] for way in ours}
    solver: list[float] = []
    exact, plains = math.nan, []
    for tuned in (True, False, None):
        started = process_time()
        exact = pull_off(chain_model(scene), scene.experiment.preload).adhesion_force
        solver.append(process_time() - started)
        for way, timed in ours.items():
            # The plain way finds F_A alone; with these settings ours is not run again for the sake of a radius.
            own = settings_for(timed)
            runs = (run(timed, folder / way, figures=False, settings=own).document for _ in range(REPEATS[way]))
            done[way] += runs
        if tuned is not None:
            way = "plain, tuned" if tuned else "plain"
            force, cpu, steps = plain(scene, tolerance, folder / way, tuned)
            plains.append(Cost(way, tolerance, force, abs(force / exact - 1.0), cpu, steps))
    costs = [Cost("scipy solver", tolerance, exact, 0.0, median(solver), 0)]
    for way, runs in done.items():
        force, steps = runs[0]["adhesion_force"]["value"], runs[0]["timing"]["steps"]
        cpu = median(results["timing"]["lammps_cpu_s"] for results in runs)
        costs.append(Cost(way, tolerance, force, abs(force / exact - 1.0), cpu, steps))
    return costs + plains


def main() -> None:
    """Compare and print; the table goes to validation/speed/results/plain.json as well."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", default=SCENE, type=Path)
    parser.add_argument("--tolerance", nargs="+", type=float, default=[1e-2, 1e-3])
    options = parser.parse_args()
    scene, rows = read_scene(options.scene), []
    head = ("way", "tolerance", "F_A (FU)", "error", "CPU (s)", "steps", "plain over it")
    print("{:<13} {:>9} {:>10} {:>9} {:>9} {:>9} {:>14}".format(*head))
    for tolerance in options.tolerance:
        with tempfile.TemporaryDirectory() as folder:
            costs = compared(scene, tolerance, Path(folder))
        for cost in costs:
            ratio = costs[-1].cpu_s / cost.cpu_s
            rows.append(vars(cost) | {"plain_over_it": ratio})
            print(
                f"{cost.way:<13} {tolerance:>9.0e} {cost.adhesion_force:>10.6f} {cost.error:>9.1e} {cost.cpu_s:>9.3f} "
                f"{cost.steps:>9} {ratio:>14.1f}"
            )
    RESULTS.parent.mkdir(exist_ok=True)
    machine = {"processor": platform.processor() or platform.machine(), "python": platform.python_version()}
    RESULTS.write_text(json.dumps({"scene": scene.title, "machine": machine, "rows": rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
