"""A scene to a finished run folder, or to an error that says what was tried against it and helps."""

from __future__ import annotations

import json
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from contact1d.workflow.continuation.trust import UntrustedError
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.experiments.spacing import with_spacing
from contact1d.workflow.runs import campaign
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.runs.remedies import Attempt, Reader, Tried, tried
from contact1d.workflow.runs.report import RESULTS, write_results
from contact1d.workflow.scene import AnyScene, Scene, SceneError, read_scene
from contact1d.workflow.scene.problems import Problem
from contact1d.workflow.settings.settings import Settings, SettingsError, settings_for

TRIAL, PATIENCE = 60.0, 90.0
"""Wall time [s] of LAMMPS in one trial, and of all trials: at least, and never less than the run that failed took, or
twice that. On an idle machine a trial takes a few tenths with 200 particles and five seconds with 900."""


def run(
    scene: AnyScene,
    folder: campaign.AnyPath,
    figures: bool | str = True,
    progress: Progress | None = None,
    time_limit: float = campaign.TIME_LIMIT,
    settings: Settings | None = None,
    workers: int | None = None,
    ranks: int = 1,
) -> Run:
    """As `workflow.runs.campaign.run`; where it fails, changes of the scene are tried.

    Arguments and errors are the same; an error says with which changes the scene gives a result.
    """
    progress, started = progress or Silent(), time.monotonic()
    try:
        return campaign.run(scene, folder, figures, progress, time_limit, settings, workers=workers, ranks=ranks)
    except SceneError as error:
        raise mended(lambda change: read_scene(scene, change.overrides, change.without), error, progress) from None
    except SettingsError as error:
        found = _tried(scene, error, progress, 0.0)
        raise SettingsError(f"{error}. {found}" if str(found) else str(error)) from error.__cause__
    except RunError as error:
        if not isinstance(error.__cause__, UntrustedError):
            raise
        raise _said(
            error, error.__cause__, _tried(scene, error, progress, time.monotonic() - started)
        ) from error.__cause__


def mended(reader: Reader, error: SceneError, progress: Progress) -> SceneError:
    """The error of a scene, and which of the ways to mend it give a result.

    Args:
        reader: gives the scene with a change.
        error: the scene's, without.
        progress: told of every trial.
    """
    found = tried(reader, error, _attempt(TRIAL), progress.note, PATIENCE)
    if not str(found):
        return error
    first, *others = error.problems
    hint = f"{first.hint}. {found}" if first.hint else str(found)
    return SceneError([Problem(first.path, first.message, first.given, hint, first.ways), *others])


def _tried(source: AnyScene, error: Contact1dError, progress: Progress, took: float) -> Tried:
    """What helps a scene whose run `took` so many seconds to fail."""
    attempt = _attempt(max(TRIAL, took))
    return tried(
        lambda change: read_scene(source, change.overrides, change.without),
        error,
        attempt,
        progress.note,
        max(PATIENCE, 2.0 * took),
    )


def _attempt(limit: float) -> Attempt:
    """Runs a scene once, without refinement and second tries, for at most so many seconds."""

    def attempt(scene: Scene) -> None:
        with TemporaryDirectory() as folder:
            chosen = with_spacing(scene)
            settings = settings_for(chosen)
            campaign.run(chosen, Path(folder) / "trial", False, time_limit=limit, settings=settings, retries=False)

    return attempt


def _said(error: RunError, cause: UntrustedError, found: Tried) -> RunError:
    """The error with what was found in place of advice that nobody tried; results.json says the same."""
    document = json.loads((error.folder / RESULTS).read_text(encoding="utf-8"))
    facts = document["error"]
    advice = f". {found}" if found.helped else f": {cause.advice}" if cause.advice else ""
    facts["message"] = f"{cause.message}{advice}"
    if found.failed and not found.helped:
        facts["message"] += f". {found}"
    write_results(error.folder, document)
    return RunError(f"{facts['message']} [phase {facts['phase']}, step {facts['step']}]", error.folder)
