"""A scene to a finished run folder, or to an error with a suggested fix: the first change that it carries is tried."""

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
"""Wall time [s] of LAMMPS in the one trial, for each pass. With 200 particles a pass takes a few tenths."""

Reader = Callable[[SceneEdit], Scene]
"""The scene with an edit. Raises SceneError."""


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
    """As `workflow.runs.campaign.run`; where it fails, the first change that the error carries is tried.

    Arguments and errors are the same; an error says whether the scene gives a result with that change. Without a
    folder it is a temporary one, which is removed with the `Run`, and figures are drawn if they are asked for: here,
    or of the `Run` by `plot`.
    """
    progress, figures = progress or Silent(), folder is not None if figures is None else figures
    reader = partial(edited, scene)
    with ExitStack() as temporary:
        if folder is None:
            folder = mkdtemp(prefix="contact1d-")
            temporary.callback(rmtree, folder, ignore_errors=True)
        try:
            done = campaign.run(
                scene, folder, figures, progress, time_limit, settings, workers=workers, ranks=ranks, printed=printed
            )
        except SceneError as error:
            raise mended(reader, error, progress) from None
        except SettingsError as error:
            found = _tried(reader, error, progress)
            message = f"{error}. {found}" if found else str(error)
            raise SettingsError(message, changes=error.changes) from error.__cause__
        except RunError as error:
            temporary.pop_all()  # it says where its files are
            cause = error.__cause__
            if isinstance(cause, UntrustedError) and (found := _tried(reader, cause, progress)):
                raise _reported(error, cause, found) from cause
            raise
        finalize(done, temporary.pop_all().close)
    return done


def mended(reader: Reader, error: SceneError, progress: Progress) -> SceneError:
    """The error of a scene, and whether the first suggested fix gives a result.

    Args:
        reader: gives the scene with an edit.
        error: the scene's, without.
        progress: informed of the trial.
    """
    found = _tried(reader, error, progress)
    if not found:
        return error
    first, *others = error.problems
    return SceneError([replace(first, hint=". ".join(filter(None, (first.hint, found)))), *others])


def edited(source: AnyScene, edit: SceneEdit, overrides: Iterable[str] = (), without: Iterable[str] = ()) -> Scene:
    """A scene as `read_scene` reads it, with an edit. Raises SceneError."""
    return read_scene(source, (*overrides, *_overrides(edit)), (*without, *edit.without))


def _overrides(edit: SceneEdit) -> list[str]:
    """The values of an edit in the form of `read_scene` and `--set`."""
    return [f"{key}={value if isinstance(value, str) else as_toml(value)}" for key, value in edit.values.items()]


def in_words(edit: SceneEdit) -> str:
    """An edit as options of `contact1d run`."""
    return " ".join([*(f"--without {name}" for name in edit.without), *(f"--set {one}" for one in _overrides(edit))])


def _tried(reader: Reader, error: Contact1dError, progress: Progress) -> str:
    """The message on the changes that an error carries, the first of which is tried; "" where it carries none."""
    edits = []
    for edit in error.changes:
        try:
            scene = reader(edit)
        except SceneError:  # the same failure of another experiment, which has no such key
            continue
        edits.append((in_si(scene, edit), scene))
    if not edits:
        return ""
    (first, scene), *others = edits
    progress.note(f"trying a suggested fix: {in_words(first)}")
    try:
        _attempt(scene)
    except Contact1dError:
        untried = f". Not tried: {', or '.join(in_words(edit) for edit, _ in others)}" if others else ""
        return f"Tried without a result within {TRIAL:g} s: {in_words(first)}{untried}"
    return f"Tried: {in_words(first)} gives a result"


def _attempt(scene: Scene) -> None:
    """Run a scene once, without refinement and second tries, for at most a few seconds."""
    with TemporaryDirectory() as folder:
        chosen = with_spacing(scene)
        settings = settings_for(chosen)
        campaign.run(chosen, Path(folder) / "trial", False, time_limit=TRIAL, settings=settings, retries=False)


def in_si(scene: Scene, edit: SceneEdit, digits: int = 3) -> SceneEdit:
    """The edit with units, "33.3pN", where LU and FU are known: a scene file that has them takes no plain number."""
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


def _reported(error: RunError, cause: UntrustedError, found: str) -> RunError:
    """The error with the result of the trial, before advice that was not tried; the same in results.json."""
    document = read_results(error.folder)
    facts = document["error"]
    advice = f": {cause.advice}" if cause.advice and "gives a result" not in found else ""
    facts["message"] = f"{cause.message}{advice}. {found}"
    write_results(error.folder, document)
    return RunError(f"{facts['message']} [phase {facts['phase']}, step {facts['step']}]", error.folder)
