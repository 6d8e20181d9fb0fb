"""How every command ends: done, or with a message on standard error and an exit code. The one reader of scene files."""

from __future__ import annotations

import errno
import os
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import typer
import typer.core

from contact1d.files import FULL_DISK

if TYPE_CHECKING:
    from contact1d.workflow.engine.progress import Progress
    from contact1d.workflow.scene import Scene

FAILS = 1
"""A check of `doctor` fails."""
CALL_IS_WRONG = 2
"""The scene, an option or a folder is wrong; nothing was written."""
RUN_FAILED = 3
INTERRUPTED = 130

BAD_PLACE = (
    errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENAMETOOLONG,
    errno.ELOOP,
)  # fmt: skip
"""What the system says about a place that the caller should choose otherwise."""


class Commands(typer.core.TyperGroup):
    """All commands, with the errors of their options reported in the same form as others."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        with command(ctx.info_name, quiet=True):
            return super().invoke(ctx)


def stop(message: str, code: int) -> NoReturn:
    """Print the error and end with this exit code."""
    typer.secho(message, err=True, fg="red")
    raise SystemExit(code)


def say(lines: Iterable[str], warnings: Mapping[str, str], place: object = None) -> None:
    """Print lines, warnings on standard error, and where the files are."""
    typer.echo("\n".join(lines))
    for name, message in warnings.items():
        typer.secho(f"warning {name}: {message}", err=True, fg="yellow")
    if place is not None:
        typer.echo(f"\n{place}")


def say_counts(counts: Mapping[str, int], table: Path) -> None:
    """Print how many of a series ended how, and where their table is; the end of the command where one is not done."""
    typer.echo(f"{', '.join(f'{count} {status}' for status, count in sorted(counts.items()))}; {table}")
    if set(counts) != {"done"}:
        raise typer.Exit(RUN_FAILED)


def read(path: Path, overrides: list[str] | None, without: list[str] | None, progress: Progress | None = None) -> Scene:
    """The scene in a file as the options change it; with every problem reported, the end of the command.

    With a `progress`, which reports it, a suggested fix of the scene is tried.
    """
    from contact1d.workflow.scene import SceneError, read_scene

    try:
        return read_scene(path, tuple(overrides or ()), tuple(without or ()))
    except SceneError as error:
        if progress is not None and error.changes:
            from contact1d.workflow.runs.advised import edited, mended

            reader = partial(edited, path, overrides=overrides or (), without=without or ())
            error = mended(reader, error, progress)
        stop(problems_in(str(path), error), CALL_IS_WRONG)


def problems_in(where: str, error: Exception) -> str:
    """The problems of a file, each on a line of its own, under their number; another error as it is."""
    count = len(getattr(error, "problems", ()))
    head = [f"{where}: {count} problem{'s' if count > 1 else ''}"] if count else []
    return "\n  ".join([*head, *str(error).split("\n")])


@contextmanager
def command(
    what: str, folder: Path | None = None, kept: str = "", quiet: bool = False, source: str = "the scene"
) -> Iterator[Progress]:
    """Do the work of a command; an error in it ends it with a message and the exit code of that error.

    Args:
        what: is done, for "… failed".
        folder: where files are; named if it is there when the work breaks off.
        kept: what is left then, and what to do, as words; not where its numbers were written before.
        quiet: whether no progress is shown.
        source: what is read: its name stands above its problems.
    """
    from contact1d.workflow.engine.progress import Silent, choose_progress

    try:
        with closing(Silent() if quiet else choose_progress()) as progress:
            yield progress
    except typer.Exit:
        raise
    except (Exception, KeyboardInterrupt) as error:
        left = [kept] if kept and not os.path.isfile(f"{folder}/results.json") else []
        if folder is not None and os.path.isdir(folder):
            left.append(f"files are kept in {folder}")
        if isinstance(error, KeyboardInterrupt):
            stop("; ".join(["interrupted", *left]), INTERRUPTED)
        ending = _ending(error, what, left, str(folder or ""), source)
        if ending is None:
            raise
        stop(*ending)


def _ending(error: BaseException, what: str, left: Iterable[str], folder: str, source: str) -> tuple[str, int] | None:
    """The message and the exit code for an error; None for a defect of the program."""
    from concurrent.futures.process import BrokenProcessPool

    from contact1d.workflow.errors import Contact1dError

    if isinstance(error, Contact1dError):
        if error.exit_code == CALL_IS_WRONG:
            return problems_in(source, error), CALL_IS_WRONG
        place = getattr(error, "folder", None)  # one that was there for a while only is not named
        is_there = place is not None and place.is_dir()
        return f"{what} failed: {error if is_there else error.message}", RUN_FAILED
    if isinstance(error, ImportError) and not (error.name or "").startswith("contact1d"):
        return f"the installation is incomplete ({error}): check it with `contact1d doctor`", FAILS
    reason = ""
    if isinstance(error, OSError) and error.errno != errno.EPIPE:  # a reader that went away is no error: typer ends
        if sentence := _of_a_place(error, folder):
            return sentence, CALL_IS_WRONG
        reason = FULL_DISK.get(error.errno or 0, error.strerror or str(error))
        reason += f" ({os.fsdecode(error.filename)})" if error.filename else ""
    elif isinstance(error, BrokenProcessPool):
        reason = "one of its processes was killed, most often because the machine was out of memory"
    elif isinstance(error, MemoryError):
        reason = "the machine is out of memory"
    return ("; ".join([f"{what} failed: {reason}", *left]), RUN_FAILED) if reason else None


def _of_a_place(error: OSError, folder: str) -> str:
    """What is wrong with a place that the caller chose; "" where it is something else."""
    place = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else folder
    if error.errno in (errno.EEXIST, errno.ENOTDIR) and os.path.isfile(place):
        return f"{place} is a file; a folder is needed"
    return f"{place} cannot be written: {error.strerror}" if error.errno in BAD_PLACE and place else ""
