"""All classes of hard cases, several at a time, and their record."""

from __future__ import annotations

import datetime
import json
import math
import multiprocessing
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from contact1d.files import write_whole
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import FolderError
from contact1d.workflow.runs.cores import cores
from contact1d.workflow.runs.report import versions
from validation.hard import (
    extremes,
    faults,
    forces,
    friction,
    fuzz,
    loads,
    loops,
    modes,
    motion,
    pressed,
    random_scenes,
    settling,
    sharp,
    similarity,
    slides,
    stiffness,
    thermal,
)
from validation.hard.case import FULL_PATIENCE, PATIENCE, Bench, Class, Findings, at_most
from validation.hard.record import RECORD, TABLE, Answer, Stability, stability_markdown
from validation.judging.check import Check
from validation.judging.machine import machine

CLASSES: tuple[Class, ...] = (
    stiffness.STIFFNESS,
    sharp.SHARP,
    random_scenes.RANDOM,
    loads.LOADS,
    settling.SETTLING,
    loops.LOOPS,
    friction.FRICTION,
    similarity.SIMILARITY,
    forces.FORCES,
    motion.MOTION,
    modes.EQUIPARTITION,
    *thermal.CLASSES,
    extremes.EXTREMES,
    *pressed.CLASSES,
    slides.SLIDES,
    faults.FAULTS,
    fuzz.FUZZ,
)
NAMES = tuple(one.name for one in CLASSES)


def stability(
    folder: Path,
    only: Sequence[str] = (),
    full: bool = False,
    workers: int | None = None,
    progress: Progress | None = None,
) -> Stability:
    """Measure classes of hard cases; write stability.json, stability.md and a figure for each into `folder`.

    Runs that `folder` has already, of the same scenes and versions, are not made again; classes of its record, of the
    same versions, that are not among those asked for stay in it. The record is written as each class ends.

    Args:
        folder: made if it does not exist; runs go to `folder`/runs.
        only: names of classes; empty: all.
        full: the long form.
        workers: classes at a time; None: as many as there are processors.
        progress: is told of each class that ends.

    Raises:
        KeyError: a name that no class has.
        FolderError: the folder holds something else.
    """
    started = time.perf_counter()
    progress = progress or Silent()
    if unknown := set(only) - set(NAMES):
        raise KeyError(", ".join(sorted(unknown)))
    if folder.is_dir() and any(folder.iterdir()) and not any((folder / name).exists() for name in ("runs", RECORD)):
        raise FolderError(f"{folder} holds files that are not of a stability run; choose another folder with --out")
    folder.mkdir(parents=True, exist_ok=True)
    chosen = [name for name in NAMES if name in (only or NAMES)]
    progress.phase("hard cases", len(chosen))
    answers = {name: answer for name, answer in earlier(folder).items() if name not in chosen}
    before = sum(answer.seconds for answer in answers.values())
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(workers or cores(), len(chosen)), context) as executor:
        futures = {executor.submit(measured, name, folder, full): name for name in chosen}
        try:
            for future in as_completed(futures):
                answers[futures[future]] = future.result()
                spent = before + time.perf_counter() - started
                written(folder, answers, spent)
                progress.advance(1)
        except BaseException:
            executor.shutdown(wait=False, cancel_futures=True)
            raise
    return written(folder, answers, before + time.perf_counter() - started)


def written(folder: Path, answers: Mapping[str, Answer], seconds: float) -> Stability:
    """Write the record of what was measured so far, and its table."""
    listed = tuple(answers[name] for name in NAMES if name in answers)
    record = Stability(listed, machine(), versions(), seconds)
    write_whole(folder / RECORD, record.to_json())
    write_whole(folder / TABLE, stability_markdown(record.document()))
    return record


def earlier(folder: Path) -> dict[str, Answer]:
    """The classes of a record of the same versions that is there, by name."""
    try:
        found = json.loads((folder / RECORD).read_text(encoding="utf-8"))
        if found["versions"] != versions():
            return {}
        rows = [Check.from_row(row) for row in found["rows"]]
        kept = {one["name"]: one for one in found["classes"]}
    except (OSError, ValueError, KeyError, TypeError):
        return {}
    return {
        asked.name: Answer(
            asked,
            Findings([row for row in rows if row.study == asked.name], one["figure"], one["caption"]),
            one["wall_s"],
            one["form"],
            one["date"],
        )
        for asked in CLASSES
        if (one := kept.get(asked.name))
    }


def measured(name: str, folder: Path, full: bool) -> Answer:
    """One class, measured here; for a process of its own."""
    asked = next(one for one in CLASSES if one.name == name)
    started = time.perf_counter()
    runs = folder / "runs" / name
    runs.mkdir(parents=True, exist_ok=True)
    try:
        found = asked.measure(Bench(runs, full, FULL_PATIENCE if full else PATIENCE), folder)
    except Exception as error:  # what a class did not expect is the worst of its findings, and no reason to lose others
        words = f"ended by {type(error).__name__}: {error}"
        found = Findings([at_most(name, words, math.nan, 0.0, "a class ends with rows", "–", "set bound")], "", "")
    form = "full" if full else "quick"
    return Answer(asked, found, time.perf_counter() - started, form, datetime.date.today().isoformat())
