"""The plain way of the paper, kept to be compared with: every tension from the start, bisected.

For each tension a fresh contact is pressed together by F_D until it is at rest, then pulled until it is at rest again
or lost; the bracket of the tension is halved until it is as narrow as the accuracy that is asked for. The ratios depend
on damping and time step, so that two plain ways are timed: as a careful deck has them, and "tuned", with the program's
own time step and the damping that was found to be quickest for the scene.
"""

from collections.abc import Mapping
from pathlib import Path
from statistics import median
from time import process_time
from typing import Any

from contact1d import run
from validation import doors
from validation.doors import Contact, PullOff, Scene, UnderLoad, read_scene, settings_for, shipped
from validation.paper.scenes import MOVING, chain_model, changed
from validation.references.pull_off import pull_off
from validation.row import at_most
from validation.study import Bench, Lines, Study

REPEATS = 7
STEP = 0.2
"""ω_max·Δt of the plain way, some thirty steps to the fastest period: what a careful deck has."""
TUNED_DAMPING = 0.3
"""Damping of a particle [FU·TU/LU] of the tuned way; the automatic one is 0.74 in the paper's scene."""
REST, LOST = 0.1, 0.7
"""A plate is at rest within this share of the tolerance, and lost where its tension falls to this share of its load."""
TOLERANCES = (1e-2, 1e-3)
ASKED = {("quasistatic", 1e-3): 100.0, ("dynamic", 1e-2): 10.0}
"""Processor time of the plain way over ours, by method and tolerance; and at least that of the solver over ours."""
WAYS = {
    "plain": "bisection of the tension in time", "plain, tuned": "tuned bisection of the tension in time",
    "scipy solver": "an energy minimiser in scipy",
}  # fmt: skip
"""What ours is compared with, in words of the rows."""


def timed(scene: Scene, method: str, tolerance: float) -> Scene:
    """The scene by a method."""
    moving = MOVING if method == "dynamic" else ()
    return changed(scene, f"experiment.method={method}", f"accuracy.tolerance={tolerance}", *moving)


def held(contact: Contact, load: float, scale: float) -> bool:
    """Whether the contact comes to rest under a load [FU], or is lost."""
    settings, largest = contact.settings, 0.0
    near = REST * settings.tolerance * scale
    stiffness = scale / settings.largest_displacement
    while True:
        state = contact.row(UnderLoad(load, doors.chunk_steps(settings)))
        if max(abs(state.force - load), abs(state.plate_velocity) * settings.motion.settle_time * stiffness) <= near:
            return True
        largest = max(largest, -state.force)
        off = load < 0.0 < largest and state.plate_velocity < 0.0 and -state.force < LOST * min(largest, -load)
        if off or state.smallest_distance > settings.forces.cutoff:
            return False


def plain(scene: Scene, tolerance: float, folder: Path, tuned: bool) -> tuple[float, float]:
    """F_A [FU] and processor time [s] of the plain way."""
    own = timed(scene, "dynamic", tolerance)
    assert isinstance(own.experiment, PullOff)
    preload = own.experiment.preload
    settings = settings_for(own)
    step = settings.motion.time_step * STEP / doors.CALIBRATION.still_step
    chosen: dict[str, Any] = {"damping": TUNED_DAMPING} if tuned else {"time_step": step}
    context, guess = doors.context_of(own, folder, **chosen), settings.law.pull_off_force()
    low, high, scale = 0.0, 2.0 * guess, max(preload, guess)
    while high - low > tolerance * high:
        tension = 0.5 * (low + high)
        with context.contact() as contact:
            contact.begin("loading")
            held(contact, preload, scale)
            contact.begin("pulling")
            holds = held(contact, -tension, scale)
            contact.finish()
        low, high = (tension, high) if holds else (low, tension)
    return 0.5 * (low + high), context.clock.times["lammps_cpu_s"]


def rows_of(tolerance: float, seconds: Mapping[str, float], errors: Mapping[str, float]) -> Lines:
    """Times of ours over those of the plain ways and of the solver, and errors over the tolerance."""
    for method in ("quasistatic", "dynamic"):
        asked = ASKED.get((method, tolerance))
        for way in WAYS:
            bound = 1.0 / asked if asked and way == "plain" else 1.0
            if asked or way == "plain":
                words = f"CPU time of a pull-off, {method} contact1d over {WAYS[way]}, tolerance {tolerance:g}"
                yield at_most(words, seconds[method] / seconds[way], bound, "asked for", "–", "set bound")
        words = f"relative error of F_A over the tolerance {tolerance:g}, {method}"
        yield at_most(words, errors[method] / tolerance, 1.0, "scipy solver", "tolerance", "independent solver")


def measure(bench: Bench) -> Lines:
    """All at one tolerance, ours before, between and after the long ones: machines have slow minutes."""
    scene = read_scene(shipped("scenes/paper.toml"))
    assert isinstance(scene.experiment, PullOff)
    for tolerance in TOLERANCES if bench.full else TOLERANCES[:1]:
        times: dict[str, list[float]] = {}
        forces = {}
        for way in ("plain, tuned", "plain", ""):
            started = process_time()
            exact = pull_off(chain_model(scene), scene.experiment.preload).adhesion_force
            times.setdefault("scipy solver", []).append(process_time() - started)
            for method in ("quasistatic", "dynamic"):
                own = timed(scene, method, tolerance)
                for _ in range(REPEATS):
                    # The plain way finds F_A alone; with these settings ours is not run again for the sake of a radius.
                    done = run(own, bench.folder / method, figures=False, settings=settings_for(own))
                    times.setdefault(method, []).append(float(done.timing["lammps_cpu_s"]))
                    forces[method] = done.results["adhesion_force"].value
            if way:
                _, seconds = plain(scene, tolerance, bench.folder / way, way != "plain")
                times[way] = [seconds]
        errors = {method: abs(force / exact - 1.0) for method, force in forces.items()}
        yield from rows_of(tolerance, {way: median(each) for way, each in times.items()}, errors)


PLAIN = Study("plain", "A pull-off beside the paper's plain way", "Is a search worth its code?", measure)
