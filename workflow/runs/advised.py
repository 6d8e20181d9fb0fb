"""Run a scene to a finished folder, or to an error with a suggested fix: the first change that it carries is tried."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path
from shutil import rmtree
from tempfile import TemporaryDirectory, mkdtemp
from weakref import finalize

from contact1d.files import AnyPath
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import Contact1dError, RunError, SceneEdit, SettingsError, UntrustedError
from contact1d.workflow.experiments.spacing import with_spacing
from contact1d.workflow.model.settings import Settings, settings_for
from contact1d.workflow.runs import campaign
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.runs.report import read_results, write_results
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.scene import AnyScene, Scene, SceneError, read_scene
from contact1d.workflow.scene.problems import as_toml
from contact1d.workflow.scene.quantities import places
from contact1d.workflow.units import NUMBER

TRIAL = 4.0
"""Wall time [s] of LAMMPS in the trial of a fix, for each pass. With 200 particles a pass takes a few tenths."""

Reader = Callable[[SceneEdit], Scene]
"""Function that returns the scene with an edit. Raises SceneError."""


def run(
    scene: AnyScene,
    folder: AnyPath | None = None,
    figures: bool | str | None = None,
    progress: Progress | None = None,
    time_limit: float = campaign.TIME_LIMIT,
    settings: Settings | None = None,
    workers: int | None = None,
    ranks: int = 1,
    printed: Callable[[Run], object] | None = None,
) -> Run:
    """Return the finished run of a scene; where it fails, the first suggested fix is tried, and the error says so.

    All files of the run are written into a folder. The message of an error without a fix to try is unchanged.

    Args:
        scene: a `Scene`, or a file, TOML text or tables.
        folder: made if it does not exist, an earlier run in it is replaced; None: a temporary one, which is removed
            with the `Run`, but kept after a RunError.
        figures: whether to draw figures, or their format: "png" (as True), "svg" or "pdf"; None: only with a folder.
            `Run.plot` draws them later.
        progress: informed of phases and steps; None: nobody is.
        time_limit: wall time for LAMMPS [s], for each pass.
        settings: used in place of those chosen by the scene, without refinement.
        workers: number of repeats of a thermal pull-off at a time; None: as many as there are processors.
        ranks: number of MPI ranks that share a large contact.
        printed: called with the run when its numbers are written, before the figures are drawn.

    Raises:
        SceneError: the scene is invalid; nothing is written.
        RanksError: several ranks can't run it, or are no use; nothing is written.
        SettingsError: the scene's numbers lead to no computable system; nothing is written.
        FolderError: the folder holds something else, or another run is active in it.
        RunError: LAMMPS failed, or the result can't be trusted.
    """
    progress, figures = progress or Silent(), folder is not None if figures is None else figures
    reader = partial(edited, scene)
    with ExitStack() as temporary:
        if folder is None:
            folder = mkdtemp(prefix="contact1d-")
            temporary.callback(rmtree, folder, ignore_errors=True)
        try:
            finished = campaign.run(
                scene, folder, figures, progress, time_limit, settings, workers=workers, ranks=ranks, printed=printed
            )
        except SceneError as error:
            raise mended(reader, error, progress) from None
        except SettingsError as error:
            outcome = _tried(reader, error, progress)
            message = f"{error}. {outcome}" if outcome else str(error)
            raise SettingsError(message, changes=error.changes) from error.__cause__
        except RunError as error:
            temporary.pop_all()  # the error says where its files are
            cause = error.__cause__
            if isinstance(cause, UntrustedError) and (outcome := _tried(reader, cause, progress)):
                raise _reported(error, cause, outcome) from cause
            raise
        finalize(finished, temporary.pop_all().close)
    return finished


def mended(reader: Reader, error: SceneError, progress: Progress) -> SceneError:
    """Return a new error of a scene, with the outcome of its first suggested fix in the hint of its first problem.

    The same error where it suggests none that makes the scene valid. The fix is tried for at most 4 s of LAMMPS in each
    pass.

    Args:
        reader: returns the scene with an edit; raises SceneError.
        error: of the scene without an edit.
        progress: informed of the trial.
    """
    outcome = _tried(reader, error, progress)
    if not outcome:
        return error
    first, *rest = error.problems
    return SceneError([replace(first, hint=". ".join(filter(None, (first.hint, outcome)))), *rest])


def edited(source: AnyScene, edit: SceneEdit, overrides: Iterable[str] = (), without: Iterable[str] = ()) -> Scene:
    """Return the checked scene that a source describes, with an edit.

    Args:
        source: a file, TOML text, tables or a `Scene`.
        edit: values to set and tables to leave out.
        overrides: further values, `key=value`; those of the edit have priority.
        without: further tables to leave out.

    Raises:
        SceneError: the scene with the edit is invalid.
    """
    return read_scene(source, (*overrides, *_overrides(edit)), (*without, *edit.without))


def _overrides(edit: SceneEdit) -> list[str]:
    """Return the values of an edit as texts `key=value`: a text as it is, any other value as in TOML; [] for none."""
    return [f"{key}={value if isinstance(value, str) else as_toml(value)}" for key, value in edit.values.items()]


def in_words(edit: SceneEdit) -> str:
    """Return an edit as options of `contact1d run`: first each `--without effect`, then each `--set key=value`.

    "" for an edit that changes nothing.
    """
    return " ".join([*(f"--without {name}" for name in edit.without), *(f"--set {text}" for text in _overrides(edit))])


def _tried(reader: Reader, error: Contact1dError, progress: Progress) -> str:
    """Return a sentence, without a full stop, on the trial of the first change of an error that gives a valid scene.

    It says that the change gives a result, or that it has none within 4 s in each pass of LAMMPS and which others with
    a valid scene were not tried. "" where no change gives a valid scene.

    Args:
        reader: returns the scene with an edit; raises SceneError.
        error: with its changes.
        progress: informed of the trial.
    """
    edits = []
    for edit in error.changes:
        try:
            scene = reader(edit)
        except SceneError:  # the same failure of another experiment, which has no such key
            continue
        edits.append((in_si(scene, edit), scene))
    if not edits:
        return ""
    (first, scene), *rest = edits
    progress.note(f"trying a suggested fix: {in_words(first)}")
    try:
        _attempt(scene)
    except Contact1dError:
        untried = f". Not tried: {', or '.join(in_words(edit) for edit, _ in rest)}" if rest else ""
        return f"Tried without a result within {TRIAL:g} s: {in_words(first)}{untried}"
    return f"Tried: {in_words(first)} gives a result"


def _attempt(scene: Scene) -> None:
    """Run a scene once in a temporary folder, without refinement and retries, for at most 4 s of LAMMPS in each pass.

    Nothing is returned, and no file is left.

    Raises:
        Contact1dError: the run failed, or the time was too short.
    """
    with TemporaryDirectory() as folder:
        scene = with_spacing(scene)
        settings = settings_for(scene)
        campaign.run(scene, Path(folder) / "trial", False, time_limit=TRIAL, settings=settings, retries=False)


def in_si(scene: Scene, edit: SceneEdit, digits: int = 3) -> SceneEdit:
    """Return a copy of an edit whose floats with a unit are texts in SI with a prefix, "33.3pN".

    Other values are unchanged, as are floats without dimension and those whose unit has no known size. The edit itself
    is returned without a material or where LU or FU is not given.

    Args:
        scene: the scene with the edit.
        edit: the edit, in units of the model.
        digits: significant digits.
    """
    material, scales = scene.material, scales_of(scene, {})
    if material is None or None in (material.length_unit, material.force_unit):
        return edit
    tables = scene.model_dump(by_alias=True, exclude_none=True)
    units = {place.path: place.unit.name for place in places(Scene, tables)}
    values = dict(edit.values)
    for key, value in values.items():
        unit = units.get(key, NUMBER)
        if isinstance(value, float) and unit != NUMBER and scales.know(unit):
            factor, name = scales.written(value, unit)
            values[key] = f"{value * factor:.{digits}g}{name}"
    return replace(edit, values=values)


def _reported(error: RunError, cause: UntrustedError, outcome: str) -> RunError:
    """Return a new RunError with the outcome of a trial in its message, and write that to results.json in its folder.

    The advice of the cause is kept only where the trial failed.

    Args:
        error: of the run, with its folder.
        cause: what can't be trusted.
        outcome: sentence on the trial.
    """
    document = read_results(error.folder)
    facts = document["error"]
    advice = f": {cause.advice}" if cause.advice and "gives a result" not in outcome else ""
    facts["message"] = f"{cause.message}{advice}. {outcome}"
    write_results(error.folder, document)
    return RunError(f"{facts['message']} [phase {facts['phase']}, step {facts['step']}]", error.folder)
