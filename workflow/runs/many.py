"""Run many scenes by an executor: each gives a run or an error."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from dataclasses import replace
from pathlib import Path
from traceback import format_exc

from contact1d.files import AnyPath
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.runs.processors import cores, pool
from contact1d.workflow.scene import AnyScene

Entry = Run | RunError


def run_many(
    scenes: Iterable[tuple[AnyScene, AnyPath]], executor: Executor | None = None, workers: int | None = None
) -> list[Entry]:
    """Return a run or an error for each of many scenes, which run several at a time, without figures.

    Args:
        scenes: pairs of a scene (a `Scene`, a file, TOML text or tables) and a folder of its own.
        executor: anything with the interface of `concurrent.futures`; None: processes on this machine.
        workers: runs at a time on this machine; None: as many as there are processors. Ignored with an executor.

    Returns:
        An entry for each pair, in the order given: a `Run`, whose `outcome` is None, or a `RunError` with the folder
            and the message of whatever error `run` raised. After an error the others run, unless a process was killed:
            then its executor ends, and each scene that has not run gives an error.
    """
    pairs = list(scenes)
    if executor is None:
        with pool(min(workers or cores(), max(1, len(pairs)))) as local:
            return run_many(pairs, local)
    entries = dict(completed(pairs, executor))
    return [entries[index] for index in range(len(pairs))]


def completed(pairs: Sequence[tuple[AnyScene, AnyPath]], executor: Executor) -> Iterator[tuple[int, Entry]]:
    """Yield (index among the pairs, its run or RunError) for each pair, in the order in which they end.

    Before these come errors, without a run, of a pair whose folder an earlier one has, and of one that the executor
    does not accept. A pair whose process is killed, or that the executor accepts and does not run, gives an error as
    well.
    """
    futures: dict[Future[Entry], int] = {}
    taken = set()
    for index, (scene, folder) in enumerate(pairs):
        path = Path(folder).resolve()
        if path in taken:
            yield index, RunError("another of these runs has the same folder", path, kept=False)
            continue
        taken.add(path)
        try:
            futures[executor.submit(attempt, scene, path)] = index
        except RuntimeError as error:  # it is shut down, or a process of it has died already
            yield index, _no_answer(error, path)
    for future in as_completed(futures):
        index = futures[future]
        try:
            yield index, future.result()
        except Exception as error:
            yield index, _no_answer(error, Path(pairs[index][1]).resolve())


def attempt(scene: AnyScene, folder: Path) -> Entry:
    """Return the run of a scene, without figures and outcome, or the RunError of a run that failed.

    Any other exception is returned as a RunError, too, which has it as `__cause__` and its traceback as a note.
    """
    try:
        return replace(run(scene, folder, figures=False, workers=1), outcome=None)
    except RunError as error:
        return error
    except Exception as error:
        expected = isinstance(error, Contact1dError | OSError)
        failed = RunError(str(error) if expected else f"{type(error).__name__}: {error}", folder, kept=False)
        failed.add_note(format_exc())
        failed.__cause__ = error
        return failed


def _no_answer(error: Exception, folder: Path) -> RunError:
    """Return the RunError of a scene whose process was killed, or that its executor did not run, with the reason.

    Its folder is `folder`, and `kept` is False, since the run may not have begun.
    """
    if isinstance(error, BrokenExecutor):
        message = "the process that was to run it was killed, most often because the machine was out of memory"
    else:
        message = f"it was not run: {type(error).__name__}: {error}"
    return RunError(message, folder, kept=False)
