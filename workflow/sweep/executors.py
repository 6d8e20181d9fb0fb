"""Where points run: processes on this machine, or jobs of Slurm, each with many points."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from warnings import catch_warnings, simplefilter

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.runs.processors import cores, pool

NAMES = ("local", "slurm")
JOB_POINTS = 100
"""Points of a job of Slurm: to begin one takes as long as some tens of quick runs."""
AHEAD = 4
"""Chunks for each worker that are handed in before their turn, so that none waits for the parent."""
UNKNOWN_WORKERS = 16
"""Workers that an executor is taken to have which doesn't say."""


class ExecutorError(Contact1dError, RuntimeError):
    """An executor that isn't there."""


@dataclass(frozen=True)
class Workplace:
    """Where points run.

    Attributes:
        opened: a context with an executor in it; opened again after a process that died took the first one with it.
        chunk: points that are handed in together.
        window: chunks that are under way or wait.
    """

    opened: Callable[[], AbstractContextManager[Executor]]
    chunk: int
    window: int


def workplace_of(
    executor: Executor | str, workers: int | None, folder: Path, partition: str | None = None
) -> Workplace:
    """Where an executor works.

    Args:
        executor: "local", "slurm", or one that the caller opened and will close.
        workers: processes here, or jobs at a time; None: as many as there are processors.
        folder: of the sweep, where Slurm's scripts and outputs go.
        partition: of Slurm; None: its default one.

    Raises:
        ExecutorError: there is no such place, or what it needs isn't installed; the message says what to install.
    """
    if isinstance(executor, Executor):
        return Workplace(lambda: nullcontext(executor), 1, AHEAD * (workers or UNKNOWN_WORKERS))
    count = workers or cores()
    if executor == "local":
        return Workplace(lambda: pool(count), 1, AHEAD * count)
    if executor != "slurm":
        raise ExecutorError(f"there is no executor {executor!r}: take {' or '.join(NAMES)}")
    if find_spec("executorlib") is None:
        raise ExecutorError("Slurm is reached through executorlib: install it with pip install 'contact1d[cluster]'")
    if which("sbatch") is None:
        raise ExecutorError("there is no sbatch on this machine: start the sweep where jobs of Slurm are handed in")
    chosen = _partition(partition)
    return Workplace(lambda: _slurm(folder / "slurm", chosen), JOB_POINTS, count)


@contextmanager
def _slurm(folder: Path, partition: str) -> Iterator[Executor]:
    resources = {"cores": 1, "partition": partition}
    with catch_warnings():
        simplefilter("ignore")  # its own use of pydantic, and that it cannot check a partition
        from executorlib import SlurmClusterExecutor

        opened = SlurmClusterExecutor(resource_dict=resources, cache_directory=str(folder))
    with opened as executor:
        yield executor


def _partition(wanted: str | None) -> str:
    """The partition asked for, or Slurm's default one: executorlib hands in an empty name otherwise.

    Raises:
        ExecutorError: Slurm doesn't run, or has no such partition.
    """
    from subprocess import run

    listed = run(["sinfo", "--noheader", "--format=%P"], capture_output=True, text=True, check=False)
    names = listed.stdout.split()
    if not names:
        said = listed.stderr.strip().splitlines()
        raise ExecutorError(
            f"Slurm does not answer here{f' ({said[-1]})' if said else ''}: start the sweep on a machine of the "
            "cluster, or leave out --executor slurm to run it on this machine"
        )
    plain = [name.rstrip("*") for name in names]
    if wanted is not None and wanted not in plain:
        raise ExecutorError(f"Slurm has no partition {wanted!r}: take {' or '.join(plain)}")
    return wanted or next((name for name in names if name.endswith("*")), names[0]).rstrip("*")
