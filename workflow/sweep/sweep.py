"""A sweep: its missing points run on this machine or as Slurm jobs; the table and figures have all points.

Only the run folders record which points are done, so that the same command continues an interrupted sweep.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from importlib.util import find_spec
from itertools import chain, islice, repeat
from pathlib import Path
from shutil import which
from subprocess import CalledProcessError, run
from typing import TYPE_CHECKING, Any
from warnings import catch_warnings, simplefilter

from contact1d.analysis.curve import HEADER
from contact1d.files import FULL_DISK, AnyPath, write_whole
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import Contact1dError, FolderError, RunError, SettingsError
from contact1d.workflow.runs.campaign import alone, prepare
from contact1d.workflow.runs.finished import draw
from contact1d.workflow.runs.many import attempt
from contact1d.workflow.runs.processors import cores, pool
from contact1d.workflow.runs.report import RESULTS
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.scene.problems import as_toml, tables_as_toml
from contact1d.workflow.sweep.axes import AnySweep, SweepPlan, name_of, read_sweep, require_keys, scene_of
from contact1d.workflow.sweep.table import (
    RECORD,
    RUNS,
    Answer,
    answer_in,
    bare,
    columns_of,
    counts_in,
    frame_of,
    read_record,
    write_parquet,
    write_table,
)

if TYPE_CHECKING:
    from pandas import DataFrame

Task = tuple[Scene, Path]
"""A checked scene and its run folder."""


@dataclass(frozen=True)
class Sweep:
    """A finished or interrupted sweep.

    Attributes:
        folder: folder with results.csv, figures, and a run folder for each point in runs/.
        counts: number of points by status, `done`, `failed`, `refused` or `missing`, without those that no point has.
        quantities: unit of each result, of SI or of the model, by name; the table has <name> and <name>_uncertainty.
    """

    folder: Path
    counts: dict[str, int]
    quantities: Mapping[str, str]

    def table(self) -> DataFrame:
        """Return results.csv as a pandas.DataFrame, a row for each point, in base units of SI where these are known.

        Its columns have no units in their names; `.attrs["units"]` has the unit of each column that has one. Empty
        cells are NaN; `status`, `reason` and `run` are text.

        Raises:
            FileNotFoundError: the table was removed.
        """
        frame = frame_of(self.folder)
        units = {name[1]: name[2] for header in frame.columns if (name := HEADER.fullmatch(header))}
        units |= {column: unit for name, unit in self.quantities.items() for column in columns_of(name)}
        frame.columns = frame.columns.map(bare)
        frame.attrs["units"] = units
        return frame


def sweep(
    source: AnySweep,
    folder: AnyPath,
    executor: Executor | str = "local",
    workers: int | None = None,
    figures: bool | str = True,
    progress: Progress | None = None,
    partition: str | None = None,
) -> Sweep:
    """Return the sweep after running every point that has not run yet; its table and figures have all points.

    A point whose run fails, or that has no valid scene, is a row of the table. If the sweep is interrupted, the table
    is written, and the same call continues it.

    Args:
        source: a sweep file, by its path, or its tables.
        folder: folder of the sweep; points that ran in it earlier are kept, also those that failed.
        executor: "local", "slurm", or a `concurrent.futures.Executor`, which stays open.
        workers: processes, or jobs of Slurm, at a time; None: as many as there are processors here, 16 for an executor
            of the caller.
        figures: whether to draw, or the format: "png" (the same as True), "svg" or "pdf"; not after an interruption.
        progress: informed of each point; None: nobody is.
        partition: partition of Slurm; None: its default.

    Raises:
        SceneError: the sweep file is wrong, or an axis names no key of the scene; nothing is written.
        FolderError: the folder holds another sweep or something else, or this sweep is active in it.
        ExecutorError: there is no such executor, or it refuses a job.
        OSError: the disk is full.
        Contact1dError: pyarrow isn't installed, which the Parquet file of 100 000 points or more needs.
    """
    plan = read_sweep(source)
    require_keys(plan)
    folder = Path(folder).absolute()
    workplace = workplace_of(executor, workers, folder, partition)
    record = _record(plan)
    progress = progress or Silent()
    if (folder / RECORD).is_file() and not _continues(folder, record, progress):
        raise FolderError(
            f"{folder} holds another sweep: its base scene or the keys of its axes differ; choose another folder"
        )
    prepare(folder, "sweep", {RECORD})
    rows: list[str | Answer] = []
    answers: dict[str, Answer] = {}
    with alone(folder, "a sweep is active in"):
        write_whole(folder / RECORD, record)
        progress.phase("sweep", len(plan), "point")
        try:
            for name, answer in _answered(_missing(plan, folder, rows, progress), workplace):
                if answer.status != "done":
                    progress.note(f"{name}: {answer.status}: {answer.reason}")
                    answers[name] = answer
                progress.advance(1)
        finally:
            done = _finish(plan, folder, rows, answers)
        if figures:
            from contact1d.workflow.sweep.figures import sweep_charts

            draw(sweep_charts(folder, plan, done.quantities), folder, figures)
    return done


def _record(plan: SweepPlan) -> str:
    """Return the text of a sweep file, TOML, for a sweep: each axis by its values, and its base scene as [base]."""
    head = f"title = {as_toml(plan.title)}\ncombine = {as_toml(plan.combine)}\n"
    axes = "".join(f"\n[[axes]]\nkey = {as_toml(a.key)}\nvalues = {as_toml(list(a.values))}\n" for a in plan.axes)
    return head + axes + tables_as_toml({"base": plan.base})


def _continues(folder: Path, record: str, progress: Progress) -> bool:
    """Return whether the folder holds a sweep with the same base scene and the same keys of axes, in the same order.

    The values of axes, their combination (product or zip) and the title may differ.
    A record that can't be read is replaced where there are runs, and `progress` says so: True then, False without runs.
    `record`: text of the sweep file of today.
    """
    try:
        plans = [read_record(folder), read_sweep(record)]
    except FolderError:
        if has_runs := (folder / RUNS).is_dir():
            progress.note(f"{folder / RECORD} is not the record of a sweep and is replaced")
        return has_runs
    earlier, today = ((plan.base, [axis.key for axis in plan.axes]) for plan in plans)
    return earlier == today


def _missing(plan: SweepPlan, folder: Path, rows: list[str | Answer], progress: Progress) -> Iterator[Task]:
    """Yield (scene, its run folder) of each point that has not run yet, each scene once.

    Args:
        plan: the sweep.
        folder: folder of the sweep.
        rows: list to which the name of the run folder of each point is added, in order, or the outcome `refused` of one
            without a valid scene.
        progress: informed of refusals, of points that are done and of those with the scene of an earlier one.
    """
    seen = set()
    for values in plan.values():
        try:
            scene = scene_of(plan, values)
        except SceneError as error:
            reason = str(error).replace("\n", "; ")
            rows.append(Answer("refused", reason))
            point = ", ".join(f"{axis.key} = {value}" for axis, value in zip(plan.axes, values, strict=True))
            progress.note(f"{point}: refused: {reason}")
        else:
            name = name_of(scene)
            rows.append(name)
            run_folder = folder / RUNS / name
            if name not in seen and answer_in(run_folder) is None:
                seen.add(name)
                if (run_folder / RESULTS).exists():
                    progress.note(f"{name}: its {RESULTS} is invalid, so it is run again")
                yield scene, run_folder
                continue
        progress.advance(1)


def _answered(tasks: Iterator[Task], workplace: Workplace) -> Iterator[tuple[str, Answer]]:
    """Run tasks, `workplace.window` chunks at a time; yield (folder name, outcome) of each as it ends.

    A process that dies breaks its executor. The tasks that ran or waited then run again one by one, so that a second
    failure is that of a known task, which then has failed.

    Raises:
        OSError: the disk is full.
        ExecutorError: a job was refused.
    """
    while (first := next(tasks, None)) is not None:
        suspects: list[Task] = []
        with workplace.opened() as executor:
            yield from _through(executor, chain([first], tasks), workplace.chunk, workplace.window, suspects)
        while suspects:
            one_by_one, broken = iter(suspects), list[Task]()
            with workplace.opened() as executor:
                yield from _through(executor, one_by_one, 1, 1, broken)
            for _, folder in broken[:1]:
                yield folder.name, Answer("failed", "its process was killed twice, most often by a lack of memory")
            suspects = [*broken[1:], *one_by_one]


def _through(
    executor: Executor, tasks: Iterator[Task], chunk: int, window: int, broken: list[Task]
) -> Iterator[tuple[str, Answer]]:
    """Yield (folder name, outcome) of each task as it ends; put the tasks of an executor that breaks into `broken`.

    The outcome of a task that its executor lost is that in its folder, else `missing`.

    Args:
        executor: runs the tasks.
        tasks: scenes with their folders.
        chunk: tasks that are submitted together.
        window: chunks that run or wait.
        broken: list to which the tasks of a process that died are added, without an outcome; no further task is then
            submitted, and those remain in `tasks`.

    Raises:
        OSError: the disk is full.
        ExecutorError: a job was refused.
    """
    waiting: dict[Future[list[Answer]], list[Task]] = {}
    while True:
        while not broken and len(waiting) < window and (job := list(islice(tasks, chunk))):
            try:
                waiting[executor.submit(attempt_all, job)] = job
            except BrokenExecutor:
                broken += job
        if not waiting:
            return
        for future in wait(waiting, return_when=FIRST_COMPLETED).done:
            job = waiting.pop(future)
            try:
                answers = future.result()
            except BrokenExecutor:
                broken += job
                continue
            except OSError:
                raise
            except CalledProcessError as error:
                raise ExecutorError(f"the job was refused: {' '.join(map(str, error.cmd))} gives the reason") from None
            except Exception as error:  # of the executor, such as a cancelled job or a lost node
                words = " ".join(str(error).split()).rstrip(".")
                lost = Answer("missing", f"its job ended before it ran; start the sweep again: {words}")
                answers = [answer_in(path) or lost for _, path in job]
            yield from ((path.name, answer) for (_, path), answer in zip(job, answers, strict=True))


def attempt_all(tasks: Sequence[Task]) -> list[Answer]:
    """Run scenes one after the other in this process, which loads LAMMPS once, and return their outcomes in order.

    Raises:
        OSError: the disk is full; further scenes do not run.
    """
    return [_attempt(scene, folder) for scene, folder in tasks]


def _attempt(scene: Scene, folder: Path) -> Answer:
    """Return the outcome of a scene after running it: done, refused (no valid scene or settings), or failed.

    Its reason is the message of the error, "" of `done`. It has no results, which are in the run folder.

    Raises:
        OSError: the disk is full, which stops all other points, too.
    """
    entry = attempt(scene, folder)
    if not isinstance(entry, RunError):
        return Answer("done")
    cause = entry.__cause__
    if isinstance(cause, OSError) and cause.errno in FULL_DISK:
        raise cause
    return Answer("refused" if isinstance(cause, SceneError | SettingsError) else "failed", entry.message)


def _finish(plan: SweepPlan, folder: Path, rows: Sequence[str | Answer], answers: Mapping[str, Answer]) -> Sweep:
    """Write the table of a sweep from refusals, run folders, and the answers that no folder holds; return the sweep.

    A sweep of 100 000 points or more is written as Parquet as well.

    Args:
        plan: the sweep.
        folder: folder of the sweep.
        rows: name of the run folder, or outcome `refused`, of each point so far, in order; the others are `missing`.
        answers: outcomes that were not `done`, by folder name; those in run folders have priority.

    Raises:
        Contact1dError: Parquet needs pyarrow, which isn't installed; results.csv is written.
    """
    parquet_rows = 100_000  # rows from which on the table is written as Parquet as well
    interrupted = Answer("missing", "the sweep was interrupted before it")

    def answered() -> Iterator[tuple[tuple[Any, ...], Answer]]:
        """Yield (cells of the axes, outcome) of every point in order; `missing` where a point has none."""
        for cells, row in zip(plan.cells(), chain(rows, repeat(interrupted)), strict=False):
            if isinstance(row, Answer):
                yield cells, row
            else:
                yield cells, answer_in(folder / RUNS / row) or answers.get(row, interrupted)

    units = write_table(folder, plan.axes, answered)
    if len(plan) >= parquet_rows:
        write_parquet(folder)
    return Sweep(folder, counts_in(folder), units)


JOB_POINTS = 100
"""Points of a job of Slurm: the start of a job takes as long as some tens of quick runs."""


class ExecutorError(Contact1dError, RuntimeError):
    """An executor that is unknown, not installed, or out of reach from this machine."""


@dataclass(frozen=True)
class Workplace:
    """An executor for points, and how many it is given at a time.

    Attributes:
        opened: returns a context with an executor; called again after a process that died broke the first one.
        chunk: points that are submitted together.
        window: chunks that run or wait.
    """

    opened: Callable[[], AbstractContextManager[Executor]]
    chunk: int
    window: int


def workplace_of(
    executor: Executor | str, workers: int | None, folder: Path, partition: str | None = None
) -> Workplace:
    """Return the executor for the points of a sweep, and how many it is given at a time; it is opened when it is used.

    Points are submitted one by one, up to 4 for each worker at a time; to Slurm in jobs of 100 points, one for each
    worker.

    Args:
        executor: "local", "slurm", or one that the caller opened and will close.
        workers: processes here, or jobs at a time; None: as many as there are processors, 16 for an executor of the
            caller.
        folder: folder of the sweep, for Slurm's scripts and outputs.
        partition: partition of Slurm; None: its default.

    Raises:
        ExecutorError: the executor is unknown, what it needs isn't installed, or Slurm has no such partition.
    """
    ahead = 4  # chunks for each worker that are submitted before their turn, so that no worker waits for the parent
    if isinstance(executor, Executor):
        assumed_workers = 16  # an executor does not give its number of workers
        return Workplace(lambda: nullcontext(executor), 1, ahead * (workers or assumed_workers))
    count = workers or cores()
    if executor == "local":
        return Workplace(lambda: pool(count), 1, ahead * count)
    if executor != "slurm":
        raise ExecutorError(f"there is no executor {executor!r}: take local or slurm")
    if find_spec("executorlib") is None:
        raise ExecutorError("Slurm is reached through executorlib: install it with pip install 'contact1d[cluster]'")
    if which("sbatch") is None:
        raise ExecutorError("there is no sbatch on this machine: start the sweep where Slurm jobs are submitted")
    chosen = _partition(partition)
    return Workplace(lambda: _slurm(folder / "slurm", chosen), JOB_POINTS, count)


@contextmanager
def _slurm(folder: Path, partition: str) -> Iterator[Executor]:
    """Yield an executor that submits jobs of one processor to a partition of Slurm, with its files in `folder`.

    It is closed at the end of the block, when its jobs have ended.
    """
    resources = {"cores": 1, "partition": partition}
    with catch_warnings():
        simplefilter("ignore")  # executorlib's use of pydantic, and that it cannot check a partition
        from executorlib import SlurmClusterExecutor

        opened = SlurmClusterExecutor(resource_dict=resources, cache_directory=str(folder))
    with opened as executor:
        yield executor


def _partition(wanted: str | None) -> str:
    """Return the wanted partition, or Slurm's default one, else its first: executorlib would submit an empty name.

    Raises:
        ExecutorError: Slurm doesn't answer, or has no such partition.
        FileNotFoundError: there is no `sinfo` on this machine.
    """
    listed = run(["sinfo", "--noheader", "--format=%P"], capture_output=True, text=True, check=False)
    names = listed.stdout.split()
    if not names:
        errors = listed.stderr.strip().splitlines()
        raise ExecutorError(
            f"Slurm does not answer here{f' ({errors[-1]})' if errors else ''}: start the sweep on a machine of the "
            "cluster, or leave out --executor slurm to run it on this machine"
        )
    plain = [name.rstrip("*") for name in names]
    if wanted is not None and wanted not in plain:
        raise ExecutorError(f"Slurm has no partition {wanted!r}: take {' or '.join(plain)}")
    return wanted or next((name for name in names if name.endswith("*")), names[0]).rstrip("*")
