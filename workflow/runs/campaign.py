"""Run a scene to a finished run folder, or write its deck."""

from __future__ import annotations

import fcntl
import time
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

from contact1d.files import PART, AnyPath, write_whole
from contact1d.workflow.body.derived import formulas, pressures_of, with_body, with_implied
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.failure import NO_MEMORY, TOO_LONG, TOO_WIDE
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.engine.session import EngineError
from contact1d.workflow.errors import FolderError, RunError, SettingsError, UntrustedError
from contact1d.workflow.experiments import perform, planned
from contact1d.workflow.experiments.spacing import with_spacing
from contact1d.workflow.model.chain import MIX_UP, in_words, require_steps
from contact1d.workflow.model.motion import require_way
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.runs.accuracy import reported, require_consistency, require_results, with_checks
from contact1d.workflow.runs.charts import charts
from contact1d.workflow.runs.finished import Run, draw
from contact1d.workflow.runs.plausibility import implausible
from contact1d.workflow.runs.processors import cores, require_ranks
from contact1d.workflow.runs.refinement import refined
from contact1d.workflow.runs.report import FILES, failure, results, tables_of, write_results, write_tables
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import AnyScene, Scene, read_scene

LOCK = ".running"
TIME_LIMIT = 3600.0
"""Wall time after which LAMMPS is stopped, for each pass of a search [s]."""


def run(
    scene: AnyScene,
    folder: AnyPath,
    figures: bool | str = True,
    progress: Progress | None = None,
    time_limit: float = TIME_LIMIT,
    settings: Settings | None = None,
    retries: bool = True,
    workers: int | None = None,
    ranks: int = 1,
    printed: Callable[[Run], object] | None = None,
) -> Run:
    """Return the finished run of a scene, and write all its files into a folder.

    Args:
        scene: a `Scene`, or anything that `read_scene` reads: a file, TOML text, tables.
        folder: made if it does not exist; an earlier run in it is replaced.
        figures: whether to draw figures, or their format: "png" (as True), "svg" or "pdf".
        progress: informed of phases and steps; None: nobody is.
        time_limit: wall time for LAMMPS [s], for each pass.
        settings: used in place of those that follow from the scene, without refinement; for cost studies.
        retries: whether smaller steps are tried where the bodies went through each other.
        workers: number of repeats of a thermal pull-off at a time; None or 0: as many as there are processors.
        ranks: number of MPI ranks that share a large contact; the results are those of one.
        printed: called with the run when its numbers are written, before the figures are drawn.

    Raises:
        SceneError: the scene is invalid; nothing is written.
        RanksError: several ranks can't run it, or are no use; nothing is written.
        SettingsError: the scene's numbers lead to no computable system; nothing is written.
        FolderError: the folder holds something else, or another run is active in it.
        RunError: LAMMPS failed, or the result can't be trusted; results.json in the folder says why.
    """
    started, progress = time.perf_counter(), progress or Silent()
    with _prepared(scene, folder, progress, settings, ranks) as (deck, phases, path):
        context = RunContext(deck, path, progress, time_limit, retries, workers or cores(), ranks)
        finished = _run(context, started, figures, phases, refine=settings is None)
        if printed:
            printed(finished)
        if figures:
            draw(charts(finished), path, figures)
    return finished


@contextmanager
def _prepared(
    scene: AnyScene, folder: AnyPath, progress: Progress, settings: Settings | None = None, ranks: int = 1
) -> Iterator[tuple[Deck, tuple[Phase, ...], Path]]:
    """Write the deck of a scene with its planned schedule into a folder in place of an earlier run, and lock that.

    Yields (deck, schedule, absolute path of the folder); the lock ends with the block. Files of an earlier run are
    removed.

    Raises:
        SceneError: the scene is invalid; nothing is written.
        SettingsError: its numbers lead to no computable system, in SI where the units are known; nothing is written.
        RanksError: several ranks can't run it, or are no use; nothing is written.
        FolderError: the folder holds something else, or another run is active in it.
    """
    given = scene if isinstance(scene, Scene) else read_scene(scene)
    scales = scales_of(given, {})
    try:
        chosen = with_spacing(given)
        if chosen is not given:
            note = f"bodies.spacing = {chosen.bodies.spacing:.4g} LU for a tolerance of {chosen.accuracy.tolerance:g}"
            progress.note(scales.in_words(note))
        deck = Deck(chosen, settings or settings_for(chosen))
        require_way(chosen, deck.settings)
        phases = planned(chosen, deck.settings)
        require_steps(getattr(row, "steps", 0) for phase in phases for row in phase.rows)
        text = deck.text(phases)
    except SettingsError as error:
        raise SettingsError(scales.in_words(str(error)), changes=error.changes) from error
    require_ranks(deck, ranks)
    path = prepare(Path(folder))
    with alone(path):
        for file in path.iterdir():
            if file.name.removesuffix(PART) in FILES:
                file.unlink()
        write_whole(path / "in.lammps", text)
        write_whole(path / "scene.toml", str(chosen))
        write_system(deck, path)
        yield deck, phases, path


def _run(context: RunContext, started: float, figures: bool | str, written: Sequence[Phase], refine: bool) -> Run:
    """Return the finished run of a context's deck, with its outcome, and write the files of the run but the figures.

    Args:
        context: with deck and folder.
        started: reading of time.perf_counter at the beginning [s].
        figures: whether a run that fails draws figures, or their format.
        written: the schedule that in.lammps in the folder has.
        refine: whether the run is repeated with finer settings where the tolerance is not met.

    Raises:
        RunError: LAMMPS failed, or the result can't be trusted; results.json says why.
    """
    (scene, settings), folder = context.inputs, context.folder
    if large := in_words(scene, settings.chains.upper, settings.forces.cutoff):
        context.progress.note(large)
    for warning in implausible(scene, scales_of(scene, {}), {}).values():
        context.progress.note(warning)
    try:
        outcome = perform(context)
        deck, outcome = refined(context, outcome) if refine else (context.deck, outcome)
        context.left = outcome
        require_results(scene, outcome)
        outcome = with_implied(scene, deck.settings, outcome)
        pressures = pressures_of(scene, outcome)
        outcome = with_checks(scene, with_body(scene, outcome, pressures), pressures)
        context.left = outcome
        require_consistency(outcome)
    except (EngineError, UntrustedError) as error:
        raise _failed(context, error, started, figures) from error
    if outcome.phases != written or deck.settings is not settings:
        write_whole(folder / "in.lammps", deck.text(outcome.phases))
    tables = tables_of(scene, reported(scene, outcome), pressures)
    write_tables(folder, scene, outcome, tables)
    document = results(scene, outcome, _timing(context, started)) | formulas(scene, outcome.quantities)
    write_results(folder, document)
    return Run(folder, document, scene, tables, outcome)


def _failed(context: RunContext, error: EngineError | UntrustedError, started: float, figures: bool | str) -> RunError:
    """Return the RunError of a run that failed, in the units of its scene; write results.json and the states so far.

    Numbers in the message of `error`, and its advice, are put into these units in place. Without states so far, only
    results.json is written.

    Args:
        context: with deck and folder, and the part of the run that was done.
        error: the cause.
        started: reading of time.perf_counter at the beginning [s].
        figures: whether figures of these states are drawn, or their format.
    """
    scene, folder, left = context.deck.scene, context.folder, context.left
    scales = scales_of(scene, {})
    error.message = message = scales.in_words(error.message)
    if isinstance(error, UntrustedError):
        error.advice = scales.in_words(error.advice)
        message = str(error)
    if left is not None:
        states = replace(left, results={})
        tables = tables_of(scene, states, pressures_of(scene, states))
        write_tables(folder, scene, states, tables)
        if figures:
            draw(charts(Run(folder, {}, scene, tables, states)), folder, figures)
    facts = {"message": message, "phase": context.phase, "step": context.timestep}
    write_results(folder, failure(scene, facts, _timing(context, started), left))
    return RunError(f"{message}{_hint(message)} [phase {context.phase}, step {context.timestep}]", folder)


def _timing(context: RunContext, started: float) -> dict[str, float]:
    """Return times [s] of a run since `started`, and its number of steps, by name, for results.json.

    Wall times are `total_s`, `lammps_s` of all passes in LAMMPS and of that `rows_s` in load steps; `lammps_cpu_s` is
    the processor time of LAMMPS; `steps` is a number of timesteps. `started` is a reading of time.perf_counter [s].
    """
    return {"total_s": time.perf_counter() - started} | context.clock.times


def _hint(message: str) -> str:
    """Return what to do about a LAMMPS error whose message does not say it, as ". Use …"; "" for any other message.

    Known are lost atoms, a box that is too wide, a run that is too long, and a lack of memory.
    """
    if "atoms" in message and ("missing" in message or "left the box" in message):
        return ". The motion is unstable: use stiffnesses, masses, damping and ranges of similar magnitude"
    if TOO_WIDE in message:
        return f". Compare spacing, radius, ranges and displacements with each other. {MIX_UP}"
    if TOO_LONG in message:
        return ". Use masses, stiffnesses and dampings of similar magnitude"
    if NO_MEMORY in message:
        return ". Use fewer particles: a wider bodies.spacing, a smaller radius or load, a shorter cutoff"
    return ""


def write_deck(scene: AnyScene, folder: AnyPath) -> Path:
    """Return the absolute path of a folder, after writing the files of a run's deck into it; nothing runs.

    These are in.lammps with the planned schedule, system.data and its tables, and scene.toml. Files of an earlier run
    in the folder are removed.

    Args:
        scene: a `Scene`, or a file, TOML text or tables.
        folder: made if it does not exist.

    Raises:
        SceneError: the scene is invalid; nothing is written.
        SettingsError: its numbers lead to no computable system; nothing is written.
        FolderError: the folder holds something else, or a run is active in it.
    """
    with _prepared(scene, folder, Silent()) as (_, _, path):
        return path


def prepare(folder: Path, kind: str = "run", marks: Collection[str] = ("in.lammps", LOCK)) -> Path:
    """Make the folder of a run or a sweep with an empty lock file, and return its absolute path, links resolved.

    Nothing in it is removed; an empty folder, or one with a lock file alone, passes.

    Args:
        folder: to be made; one that holds files must have one of `marks`, of an earlier run or sweep.
        kind: "run" or "sweep", for messages.
        marks: names of files; a file that is not complete counts, too.

    Raises:
        FolderError: the folder is a file, holds files but none of `marks`, or cannot be written.
    """
    if folder.exists() and not folder.is_dir():
        raise FolderError(f"{folder} is a file; a {kind} needs a folder")
    names = {path.name.removesuffix(PART) for path in folder.iterdir()} if folder.is_dir() else set()
    if names - {LOCK} and names.isdisjoint(marks):
        raise FolderError(f"{folder} has files that do not belong to a {kind}; choose another folder")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / LOCK).touch()
    except OSError as error:
        raise FolderError(f"{folder} cannot be written: {error.strerror}") from None
    return folder.resolve()


@contextmanager
def alone(folder: Path, busy: str = "another run is active in", wait: float = 1.0) -> Iterator[None]:
    """Lock a folder for a `with` block; nothing is yielded, and the lock file is removed at its end.

    The system releases the lock even if this process is killed, when its children have ended.

    Args:
        folder: an existing folder.
        busy: the message of the FolderError where it is locked, without the folder.
        wait: time [s] for the children of a run that was killed to end.

    Raises:
        FolderError: the folder is still locked after that time.
    """
    until = time.monotonic() + wait
    with (folder / LOCK).open("w") as lock:
        while True:
            try:
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                break
            except OSError:
                if time.monotonic() > until:
                    raise FolderError(f"{busy} {folder}; choose another folder") from None
                time.sleep(0.05)
        try:
            yield
        finally:
            (folder / LOCK).unlink(missing_ok=True)
