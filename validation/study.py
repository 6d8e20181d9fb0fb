"""A study: scenes, rows, and a figure. One runner for the paper's studies, the hard cases and speed, and one record.

Scenes that a study names beforehand are run several at a time, each once for all studies; others as they are asked for
(`Bench.run`). A finished run of the same scene and versions is not made again. The record is written as each study
ends; studies of the same versions that were not asked for stay in it.
"""

import json
import math
import multiprocessing
import signal
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from validation import doors
from validation.age import today
from validation.doors import Quantity, Run, Scene
from validation.figures import Drawing, save
from validation.row import Bound, Reference, Row, at_most, verdicts

Scenes = dict[str, Scene]
Lines = Iterable[Row]
"""What a study found that has neither figures of its own nor a text."""
RECORD = "record.json"
PATIENCE, FULL_PATIENCE = 180, 3600
"""Seconds of a run, LAMMPS and all else: what hangs has failed. The long form goes on beside other work for hours."""
LONGEST = 160
"""Characters of a refusal in a row."""
NOTHING = Quantity(math.nan, math.nan, "")
"""Stands for a result of a run that failed."""


class LateError(Exception):
    """A run took too long."""


@contextmanager
def at_most_seconds(seconds: float, of_processor: bool = False) -> Iterator[None]:
    """Raise LateError after so many seconds of the clock, or of this process's work; for the main thread."""

    def late(*_: object) -> None:
        raise LateError

    timer, heard = (signal.ITIMER_PROF, signal.SIGPROF) if of_processor else (signal.ITIMER_REAL, signal.SIGALRM)
    before = signal.signal(heard, late)
    signal.setitimer(timer, seconds)
    try:
        yield
    finally:
        signal.setitimer(timer, 0.0)
        signal.signal(heard, before)


@dataclass(frozen=True)
class Refused:
    """A run that gave no number: why, in the program's words, and whether before anything ran (exit 2, not 3)."""

    words: str
    before: bool


class Runs(dict[str, Run]):
    """The runs in a folder by name, each read once."""

    def __init__(self, folder: Path) -> None:
        """Nothing is read yet."""
        super().__init__()
        self._folder = folder

    def __missing__(self, name: str) -> Run:
        """The run of that name."""
        self[name] = doors.read_run(self._folder / name).model
        return self[name]


@dataclass(frozen=True)
class Bench:
    """Where a study measures.

    Attributes:
        runs_folder: of the runs that studies share.
        folder: of the study's own runs.
        full: whether the long form is asked for.
        patience: wall time of a run [s].
    """

    runs_folder: Path
    folder: Path
    full: bool = False
    patience: int = PATIENCE

    @cached_property
    def paper(self) -> Scene:
        """The paper's scene, identified once."""
        from validation.paper.scenes import calibrated

        return calibrated(self.runs_folder / "identification")

    @cached_property
    def runs(self) -> Runs:
        """The runs that the study named beforehand; one that failed has no results."""
        return Runs(self.runs_folder)

    def run(self, name: str, scene: Mapping[str, Any]) -> Run | Refused:
        """The finished run of a scene, made now or there already, or the words with which it was refused."""
        folder = self.folder / name
        try:
            with at_most_seconds(self.patience):
                checked = doors.read_scene({"title": name} | dict(scene))
                if (found := doors.finished(checked, folder)) is None:
                    doors.run(checked, folder, float(self.patience))
                    found = doors.finished(checked, folder)
        except LateError:
            return Refused(f"nothing was said for {self.patience} s", before=False)
        except doors.BEFORE as error:
            return Refused(str(error), before=True)
        except doors.RunError as error:
            return Refused(error.message, before=False)
        assert found is not None
        return found if found.status == "done" else Refused(str(found.document["error"]["message"]), before=False)


@dataclass(frozen=True)
class Rows:
    """Makes rows with the runs that they rest on and these runs' warnings.

    Attributes:
        runs: by name.
        despite: why a row stands beside a warning of its runs, by the warning's name, where the row says nothing else.
    """

    runs: Mapping[str, Run]
    despite: Mapping[str, str] = field(default_factory=dict)

    def __call__(
        self,
        name: str,
        value: float | Quantity,
        reference: Reference,
        bound: Bound,
        *,
        on: str | Sequence[str],
        despite: Mapping[str, str] | None = None,
        **more: Any,
    ) -> Row:
        """A row; `on`: names of its runs, or of its only one, `despite`: in place of the maker's."""
        on = [on] if isinstance(on, str) else on
        warned = sorted({str(one["name"]) for run in on for one in self.runs[run].document.get("warnings", ())})
        answers = {warning: (despite or self.despite).get(warning, "") for warning in warned}
        if isinstance(value, Quantity):
            more = {"uncertainty": value.uncertainty, "unit": value.unit} | more
        return Row(name, float(value), reference, bound, runs=tuple(on), warnings=answers, **more)

    def at_most(self, name: str, value: float, bound: Reference, limited_by: str, **more: Any) -> Row:
        """A row that passes where `value` is at most what `bound` says."""
        return self(name, value, bound, Bound("at most", 0.0, limited_by), **more)


@dataclass(frozen=True)
class Findings:
    """The rows of a study, its own figures by what is added to the study's name, and a text."""

    rows: Sequence[Row]
    figures: Mapping[str, Drawing] = field(default_factory=dict)
    text: str = ""


@dataclass(frozen=True)
class Study:
    """One question.

    Attributes:
        name: of the rows, the figures and `--only`.
        title: one line.
        question: what the paper says, or what goes wrong here in a program that is not careful.
        measure: (where to run) to what was found.
        scenes: the runs that are needed beforehand, by name; studies may share them.
    """

    name: str
    title: str
    question: str
    measure: Callable[[Bench], Findings | Lines]
    scenes: Callable[[Scene], Scenes] | None = None


@dataclass(frozen=True)
class Answer:
    """A study that was measured, as a record holds it; `form` is "full" or "quick", `commit` as in `validation.age`."""

    name: str
    title: str
    question: str
    text: str
    figures: Mapping[str, str]
    rows: Sequence[Row]
    runs: int
    form: str
    date: str
    wall_s: float
    commit: str = ""


@dataclass(frozen=True)
class Record:
    """All answers, in the order of the studies, with kind of machine, versions and wall time [s]."""

    answers: Sequence[Answer]
    machine: str
    versions: Mapping[str, str]
    wall_s: float

    @property
    def rows(self) -> list[Row]:
        """The rows of all studies."""
        return [row for answer in self.answers for row in answer.rows]

    def to_json(self) -> str:
        """The text of a record's file."""
        answers = [vars(one) | {"rows": [row.as_data() for row in one.rows]} for one in self.answers]
        return json.dumps(vars(self) | {"answers": answers}, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def read_record(path: Path) -> Record:
    """Read a record. Raises OSError, and ValueError, KeyError or TypeError where it is none."""
    data = json.loads(path.read_text(encoding="utf-8"))
    answers = [Answer(**one | {"rows": [Row.of(row) for row in one["rows"]]}) for one in data["answers"]]
    return Record(**data | {"answers": answers})


def conduct(
    studies: Sequence[Study],
    folder: Path,
    only: Sequence[str] = (),
    full: bool = False,
    workers: int | None = None,
    tell: Callable[[str], None] = lambda _: None,
) -> Record:
    """Run and judge studies; write record and figures into `folder`.

    Args:
        studies: all there are.
        folder: made if it does not exist; runs go to `folder`/runs.
        only: names of studies; empty: all.
        full: the long form of those that have one.
        workers: runs, then studies, at a time; None: as many as there are processors.
        tell: is told what begins and what ends.

    Raises:
        KeyError: a name that no study has.
        FolderError: the folder holds something else.
    """
    chosen = [study for study in studies if study.name in only or not only]
    if unknown := set(only) - {study.name for study in studies}:
        raise KeyError(", ".join(sorted(unknown)))
    if folder.is_dir() and any(folder.iterdir()) and not any((folder / name).exists() for name in ("runs", RECORD)):
        raise doors.FolderError(f"{folder} holds files that are not of a validation; choose another folder with --out")
    runs = folder / "runs"
    runs.mkdir(parents=True, exist_ok=True)
    started, workers = time.perf_counter(), workers or doors.cores()
    if shared := [study.scenes for study in chosen if study.scenes]:
        paper = Bench(runs, runs).paper
        needed = {name: scene for scenes in shared for name, scene in scenes(paper).items()}
        tell(f"{len(needed)} runs")
        doors.finish(needed, runs, workers)
    known = _earlier(folder)
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers, len(chosen)), context) as executor:
        futures = [executor.submit(answered, study, folder, full) for study in chosen]
        try:
            for future in as_completed(futures):
                answer = future.result()
                known[answer.name] = answer
                tell(f"{answer.name}: {len(verdicts(answer.rows, 'FAIL'))} of {len(answer.rows)} rows fail")
                record = _written(studies, folder, known, time.perf_counter() - started)
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            raise
    return record


def _written(studies: Sequence[Study], folder: Path, known: Mapping[str, Answer], seconds: float) -> Record:
    answers = [known[study.name] for study in studies if study.name in known]
    record = Record(answers, doors.machine(), doors.versions(), seconds)
    doors.write_whole(folder / RECORD, record.to_json())
    return record


def _earlier(folder: Path) -> dict[str, Answer]:
    """The answers of a record of the same versions that is there, by name."""
    with suppress(OSError, ValueError, KeyError, TypeError):
        record = read_record(folder / RECORD)
        if record.versions == doors.versions():
            return {answer.name: answer for answer in record.answers}
    return {}


def answered(study: Study, folder: Path, full: bool) -> Answer:
    """One study, measured here; for a process of its own."""
    started, runs = time.perf_counter(), folder / "runs"
    own = runs / study.name
    own.mkdir(parents=True, exist_ok=True)
    bench = Bench(runs, own, full, FULL_PATIENCE if full else PATIENCE)
    try:
        measured = study.measure(bench)
        found = measured if isinstance(measured, Findings) else Findings([*measured])
    except Exception as error:  # what a study did not expect is the worst of its findings, and no reason to lose others
        words = f"ended by {type(error).__name__}: {error}"
        found = Findings([at_most(words, math.nan, 0.0, "a study ends with rows", evidence="set bound")])
    captions = {}
    for suffix, drawing in found.figures.items():
        file = f"{study.name}{'_' * bool(suffix)}{suffix}.png"
        save(drawing, folder / file)
        captions[file] = drawing.caption
    count, now = len(study.scenes(bench.paper)) if study.scenes else 0, today()
    return Answer(
        study.name, study.title, study.question, found.text, captions, list(found.rows), count,
        "full" if full else "quick", now.date, time.perf_counter() - started, now.commit,
    )  # fmt: skip


def found(run: Run, name: str) -> Quantity:
    """A result; NaN where the run has none, since it failed."""
    return run.model.results.get(name, NOTHING)


def said(limited_by: str, run: Run | Refused) -> str:
    """What a row says about its limit: that of its number, or the words of a refusal in its place."""
    if not isinstance(run, Refused):
        return limited_by
    return f"refused {'before anything ran' if run.before else 'in the run'}: {run.words[:LONGEST]}"


def over_uncertainty(error: float, uncertainty: float) -> float:
    """Their ratio; 0 where there is no error, inf where there is one and no uncertainty, NaN where one is NaN."""
    if math.isnan(error + uncertainty):
        return math.nan
    return error / uncertainty if uncertainty > 0.0 else math.inf if error else 0.0


def over_claim(run: Run | Refused, name: str, exact: float) -> float:
    """|value − exact| over the claimed uncertainty; NaN where there is no such quantity."""
    if isinstance(run, Refused):
        return math.nan
    quantity = found(run, name)
    return over_uncertainty(abs(quantity.value - exact), quantity.uncertainty)


def claim_row(words: str, run: Run | Refused, name: str, exact: float, source: str) -> Row:
    """Error of a result over what the run claims, at most 1."""
    return at_most(words, over_claim(run, name, exact), 1.0, source, said("what the run claims", run))
