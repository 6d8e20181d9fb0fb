"""A scene to a finished run folder, and many scenes through an executor."""

from __future__ import annotations

import fcntl
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.engine.session import EngineError
from contact1d.workflow.experiments import Outcome, RunContext, UntrustedError, perform, planned, write_system
from contact1d.workflow.experiments.running.outcome import anywhere_between
from contact1d.workflow.runs.refinement import Refined, refined
from contact1d.workflow.runs.report import (
    FILES,
    curve_of,
    draw,
    failure,
    results,
    write_results,
    write_tables,
    write_whole,
)
from contact1d.workflow.scene import Scene, scene_to_toml
from contact1d.workflow.settings.settings import Settings, settings_for

LOCK = ".running"
TIME_LIMIT = 3600.0
"""Wall time after which LAMMPS is stopped, for each pass of a search [s]."""


class FolderError(RuntimeError):
    """A folder that no run may be written into."""


class RunError(RuntimeError):
    """A run that gave no numbers; results.json in its folder says the same.

    Attributes:
        folder: the run folder, whose files are kept.
    """

    def __init__(self, message: str, folder: Path) -> None:
        """Keep both; they are arguments, so that the error can be pickled."""
        super().__init__(message, folder)
        self.message, self.folder = message, folder

    def __str__(self) -> str:
        """Return the message and where the files are."""
        return f"{self.message}\nfiles kept in {self.folder}"


@dataclass(frozen=True)
class Run:
    """A finished run.

    Attributes:
        folder: with every file of the run.
        results: what results.json holds.
        outcome: quantities, states, profiles as Python objects.
    """

    folder: Path
    results: dict[str, Any]
    outcome: Outcome


def run(
    scene: Scene,
    folder: Path | str,
    figures: bool = True,
    progress: Progress | None = None,
    time_limit: float = TIME_LIMIT,
    settings: Settings | None = None,
) -> Run:
    """Run a scene in a folder and leave everything there.

    Args:
        scene: what `read_scene` returns.
        folder: made if it does not exist; an earlier run in it is replaced.
        figures: whether to draw.
        progress: told of phases and steps.
        time_limit: wall time for LAMMPS [s].
        settings: in place of those that `settings_for` chooses and refines; for cost studies.

    Raises:
        SettingsError: the scene's numbers lead to no computable system; nothing is written.
        FolderError: the folder holds something else, or another run is at work in it.
        RunError: LAMMPS failed, or the result can't be trusted.
    """
    started = time.perf_counter()
    deck = Deck(scene, settings or settings_for(scene))
    folder = prepare(Path(folder))
    with _alone(folder):
        context = RunContext(deck, folder, progress or Silent(), time_limit)
        return _run(context, started, figures, refine=settings is None)


def _run(context: RunContext, started: float, figures: bool, refine: bool) -> Run:
    scene, folder = context.deck.scene, context.folder
    _write(context.deck, folder)

    def timing() -> dict[str, float]:
        total = time.perf_counter() - started
        lammps = {"lammps_s": context.lammps_seconds, "lammps_cpu_s": context.lammps_cpu_seconds}
        return {"total_s": total, **lammps, "steps": context.steps}

    try:
        outcome = perform(context)
        last = refined(context, outcome) if refine else Refined(context.deck, outcome)
    except (EngineError, UntrustedError) as error:
        facts = {"message": getattr(error, "message", str(error)), "phase": context.phase, "step": context.timestep}
        write_results(folder, failure(scene, facts, timing()))
        where = f" [phase {context.phase}, step {context.timestep}]"
        raise RunError(f"{facts['message']}{_hint(str(facts['message']))}{where}", folder) from error
    outcome = anywhere_between(scene, last.deck.settings, last.outcome)
    write_whole(folder / "in.lammps", last.deck.text(outcome.phases))
    curve = curve_of(last.deck.scene, outcome)
    write_tables(folder, scene, outcome, curve)
    if figures:
        draw(folder, scene, outcome, curve)
    document = results(scene, outcome, timing())
    write_results(folder, document)
    return Run(folder, document, outcome)


def _hint(message: str) -> str:
    """What to do about LAMMPS errors whose own words don't say it."""
    if "atoms" in message and ("missing" in message or "left the box" in message):
        return ". Particles flew apart: bring stiffnesses, masses, damping and ranges nearer to each other"
    return ""


def write_deck(scene: Scene, folder: Path | str) -> Path:
    """Write system.data, the table and in.lammps with the planned schedule; nothing runs. Returns the folder."""
    deck = Deck(scene, settings_for(scene))
    folder = prepare(Path(folder))
    with _alone(folder):
        _write(deck, folder)
    return folder


def prepare(folder: Path) -> Path:
    """Make the folder, or see that it holds nothing but an earlier run.

    Raises:
        FolderError: it is a file, or holds files and none of a run.
    """
    if folder.exists() and not folder.is_dir():
        raise FolderError(f"{folder} is a file; a run needs a folder")
    if folder.is_dir() and any(folder.iterdir()) and not any((folder / name).exists() for name in ("in.lammps", LOCK)):
        raise FolderError(f"{folder} holds files that are not of a run; choose another folder with --out")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        (folder / LOCK).touch()
    except OSError as error:
        raise FolderError(f"{folder} cannot be written: {error.strerror}") from None
    return folder.resolve()


@contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Hold the folder against other runs; the system lets go of it whatever happens to this process."""
    with (folder / LOCK).open("w") as lock:
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise FolderError(f"another run is at work in {folder}; choose another folder with --out") from None
        try:
            yield
        finally:
            (folder / LOCK).unlink(missing_ok=True)


def _write(deck: Deck, folder: Path) -> None:
    """Replace whatever an earlier run left by what the deck needs."""
    for path in folder.iterdir():
        if path.name.removesuffix(".part") in FILES:
            path.unlink()
    write_whole(folder / "in.lammps", deck.text(planned(deck.scene, deck.settings)))
    write_whole(folder / "scene.toml", scene_to_toml(deck.scene))
    write_system(deck, folder)


def run_many(scenes: Iterable[tuple[Scene, Path]], executor: Executor) -> Iterator[Run | RunError]:
    """Run (scene, folder) pairs through an executor; results come in the order given, failures among them."""
    futures = [executor.submit(_run_quietly, scene, folder) for scene, folder in scenes]
    for future in futures:
        yield future.result()


def _run_quietly(scene: Scene, folder: Path) -> Run | RunError:
    try:
        return run(scene, folder, figures=False)
    except RunError as error:
        return error
