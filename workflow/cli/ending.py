"""The end of every command: its output, or a message on standard error with an exit code; the reader of scene files."""

from __future__ import annotations

import errno
import os
import sys
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
"""Exit code: a check of `doctor` failed."""
CALL_IS_WRONG = 2
"""Exit code: the scene, an option or a folder is wrong; nothing was written."""
RUN_FAILED = 3
"""Exit code: the run failed, or its result can't be trusted; files are kept."""
INTERRUPTED = 130
"""Exit code: interrupted by the user."""
BAD_PATH = (
    errno.EACCES, errno.EPERM, errno.EROFS, errno.ENOENT, errno.ENOTDIR, errno.EISDIR, errno.EEXIST, errno.ENAMETOOLONG,
    errno.ELOOP,
)  # fmt: skip
"""Errors of the system for a path that the caller should choose otherwise."""


class Commands(typer.core.TyperGroup):
    """All commands, with the errors of their options reported in the same form as others."""

    def invoke(self, ctx: Any) -> Any:
        """Run a command and return its value.

        An error, in its options or later, ends the program by SystemExit with a message and an exit code; a defect of
        the program is raised.
        """
        with command(ctx.info_name, quiet=True):
            return super().invoke(ctx)


def stop(message: str, code: int) -> NoReturn:
    """Print an error message to standard error and end the program by SystemExit with an exit code."""
    typer.secho(message, err=True, fg="red")
    raise SystemExit(code)


def show(text: str) -> None:
    """Print a text and a line end to standard output.

    Where its reader has ended (`| head`), the command goes on, and this and all later output is dropped.
    """
    try:
        typer.echo(text)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def print_lines(lines: Iterable[str], warnings: Mapping[str, str], path: object = None) -> None:
    """Print lines, then warnings, by name, on standard error, and the path of the files, unless that is None.

    The path has an empty line before it; lines and path are on standard output.
    """
    show("\n".join(lines))
    for name, message in warnings.items():
        typer.secho(f"warning {name}: {message}", err=True, fg="yellow")
    if path is not None:
        show(f"\n{path}")


def print_counts(counts: Mapping[str, int], table: Path) -> None:
    """Print the number of points by status, sorted by the name of the status, and the path of their table.

    Raises:
        typer.Exit: exit code 3, if any point is not done, or there is none.
    """
    show(f"{', '.join(f'{count} {status}' for status, count in sorted(counts.items()))}; {table}")
    if set(counts) != {"done"}:
        raise typer.Exit(RUN_FAILED)


def read(path: Path, overrides: list[str] | None, without: list[str] | None, progress: Progress | None = None) -> Scene:
    """Return the scene in a file with the changes of the options; print all problems and end if there are any.

    It ends by SystemExit with exit code 2.

    Args:
        path: of the scene file.
        overrides: texts `key=value`; None: no changes.
        without: effects to leave out; None: none.
        progress: informed of the trial of a suggested fix, whose outcome is reported; None: no fix is tried.
    """
    from contact1d.workflow.scene import SceneError, read_scene

    try:
        return read_scene(path, overrides or (), without or ())
    except SceneError as error:
        if progress is not None and error.changes:
            from contact1d.workflow.runs.advised import edited, mended

            reader = partial(edited, path, overrides=overrides or (), without=without or ())
            error = mended(reader, error, progress)
        stop(problems_in(str(path), error), CALL_IS_WRONG)


def problems_in(where: str, error: Exception) -> str:
    """Return the number of problems of the file `where`, with its name, and a line for each, indented.

    Of an error that is no list of problems its message alone, from the second line on indented.
    """
    count = len(getattr(error, "problems", ()))
    head = [f"{where}: {count} problem{'s' if count > 1 else ''}"] if count else []
    return "\n  ".join([*head, *str(error).split("\n")])


@contextmanager
def command(
    task: str, folder: Path | None = None, kept: str = "", quiet: bool = False, source: str = "the scene"
) -> Iterator[Progress]:
    """Provide the progress of a command, and end it at any error with a message and the exit code of that error.

    It ends by SystemExit: 2 for a wrong scene, call or path, 3 for a failed run, a full disk or memory, 1 for a missing
    package, 130 for an interruption. typer.Exit and defects of the program are raised as they are. The progress is
    closed at the end of the block.

    Args:
        task: subject of the message "… failed".
        folder: folder of the files, reported if it exists when the command fails.
        kept: what a failed command leaves, and what to do; not reported if results.json was written.
        quiet: whether no progress is shown.
        source: name of the file that is read, above its problems.
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
        ending = _ending(error, task, left, str(folder or ""), source)
        if ending is None:
            raise
        stop(*ending)


def _ending(error: BaseException, task: str, left: Iterable[str], folder: str, source: str) -> tuple[str, int] | None:
    """Return message and exit code of an error; None for a defect of the program, and for a closed output pipe.

    The code is 2 for a wrong scene, call or path, 3 for a failed run, a full disk or memory, a killed process or
    another error of the system, and 1 for a missing package.

    Args:
        error: that ended the command.
        task: subject of "… failed".
        left: what is to be said on files that are kept.
        folder: of the files, for a path error without a path; "" without one.
        source: name of the file that was read, above its problems.
    """
    from concurrent.futures.process import BrokenProcessPool

    from contact1d.workflow.errors import Contact1dError

    if isinstance(error, Contact1dError):
        if error.exit_code == CALL_IS_WRONG:
            return problems_in(source, error), CALL_IS_WRONG
        run_folder = getattr(error, "folder", None)
        is_kept = run_folder is not None and run_folder.is_dir()  # a temporary folder is not reported
        return f"{task} failed: {error if is_kept else error.message}", RUN_FAILED
    if isinstance(error, ImportError) and not (error.name or "").startswith("contact1d"):
        return f"the installation is incomplete ({error}): check it with `contact1d doctor`", FAILS
    reason = ""
    if isinstance(error, OSError) and error.errno != errno.EPIPE:  # typer handles an output pipe that was closed
        if sentence := _path_error(error, folder):
            return sentence, CALL_IS_WRONG
        reason = FULL_DISK.get(error.errno or 0, error.strerror or str(error))
        reason += f" ({os.fsdecode(error.filename)})" if error.filename else ""
    elif isinstance(error, BrokenProcessPool):
        reason = "one of its processes was killed, most often because the machine was out of memory"
    elif isinstance(error, MemoryError):
        reason = "the machine is out of memory"
    return ("; ".join([f"{task} failed: {reason}", *left]), RUN_FAILED) if reason else None


def _path_error(error: OSError, folder: str) -> str:
    """Return the message of an error in a path that the caller chose; "" for any other error.

    The path is that of the error, without one the `folder`. It is a file where a folder is needed, or cannot be
    written, as without permission.
    """
    path = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else folder
    if error.errno in (errno.EEXIST, errno.ENOTDIR) and os.path.isfile(path):
        return f"{path} is a file; a folder is needed"
    return f"{path} cannot be written: {error.strerror}" if error.errno in BAD_PATH and path else ""
