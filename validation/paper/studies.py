"""All studies in the paper's order. Their runs come first, all together, then one judgement after the other."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from contact1d.files import write_whole
from contact1d.workflow.engine.progress import Progress, Silent
from contact1d.workflow.errors import FolderError
from contact1d.workflow.runs.campaign import LOCK, alone
from contact1d.workflow.runs.cores import cores
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene
from validation.paper import (
    adhesive,
    detachment,
    eq3,
    fig4,
    fig5,
    fig6,
    fig7,
    fig8,
    fig9,
    heat,
    jkr_plane,
    pressure,
    table1,
    tangential,
)
from validation.paper.markdown import validation_markdown
from validation.paper.page import html_page
from validation.paper.paper import calibrated
from validation.paper.record import RECORD, Record, StudyRecord, read_record
from validation.paper.runs import finish
from validation.paper.study import Scenes, Study

STUDIES: tuple[Study, ...] = (
    eq3.STUDY_EQ3,
    fig4.STUDY,
    fig5.NEIGHBOURS_STUDY,
    fig5.FIG5,
    fig6.STUDY,
    fig7.FIG7,
    fig7.EXPONENTS,
    fig8.FIG8A,
    fig8.FIG8B,
    fig8.JKR_OR_BARQUINS,
    table1.TABLE1,
    pressure.MEAN_PRESSURE_STUDY,
    adhesive.STUDY,
    jkr_plane.STUDY,
    tangential.STUDY,
    heat.STUDY,
    detachment.STUDY,
    fig9.STUDY,
)
NAMES = tuple(study.name for study in STUDIES)
PAGE, VALIDATION = "reproduce.html", "VALIDATION.md"


def reproduce(
    folder: Path,
    only: Sequence[str] = (),
    workers: int | None = None,
    progress: Progress | None = None,
) -> Record:
    """Do studies and write reproduce.json, reproduce.html, VALIDATION.md and the figures into `folder`.

    Runs that `folder` has already, of the same scenes and versions, are not made again.

    Args:
        folder: made if it does not exist; runs go to `folder`/runs.
        only: names of studies; empty: all.
        workers: runs at a time; None: as many as there are processors.
        progress: is told what begins, and of each run that ends.

    Raises:
        KeyError: a name that no study has.
        FolderError: the folder holds something else, or another reproduction is at work in it.
        IdentifyError, RunError: the paper's scene could not be identified.
    """
    started = time.perf_counter()
    progress = progress or Silent()
    chosen = [study for study in STUDIES if study.name in (only or NAMES)]
    if unknown := set(only) - set(NAMES):
        raise KeyError(", ".join(sorted(unknown)))
    strange = folder.is_dir() and any(entry.name != LOCK for entry in folder.iterdir())
    if strange and not any((folder / name).exists() for name in ("runs", RECORD)):
        raise FolderError(f"{folder} holds files that are not of a reproduction; choose another folder with --out")
    folder.mkdir(parents=True, exist_ok=True)
    with alone(folder, "a reproduction is at work in"):
        progress.phase("identifying the interaction")
        paper = calibrated(folder / "runs" / "identification")
        needed: Scenes = {}
        for study in _longest_first(chosen):
            needed |= study.scenes(paper)
        progress.phase("runs", len(needed))
        done = finish(needed, folder / "runs", workers or cores(), progress)
        progress.phase("judging")
        records = tuple(_judged(study, paper, done, folder) for study in chosen)
        record = Record(_merged(folder, records), versions(), time.perf_counter() - started)
        write_whole(folder / RECORD, record.to_json())
        write_whole(folder / PAGE, html_page(record, folder))
        write_whole(folder / VALIDATION, validation_markdown(record))
        return record


def _merged(folder: Path, records: tuple[StudyRecord, ...]) -> tuple[StudyRecord, ...]:
    """The studies just done, and those of an earlier record of the same versions, in the paper's order."""
    known = {}
    with suppress(OSError, ValueError, KeyError, TypeError):
        earlier = read_record(folder / RECORD)
        if earlier.versions == versions():
            known = {study.name: study for study in earlier.studies}
    known |= {study.name: study for study in records}
    return tuple(known[name] for name in NAMES if name in known)


def _longest_first(studies: Sequence[Study]) -> list[Study]:
    """Fig. 8a and Fig. 6 have the longest runs: begun first, they don't leave a processor idle at the end."""
    order = {"fig8a": 0, "fig5": 1, "fig6": 2, "fig8b": 3}
    return sorted(studies, key=lambda study: order.get(study.name, len(order)))


def _judged(study: Study, paper: Scene, done: dict[str, Run], folder: Path) -> StudyRecord:
    names = list(study.scenes(paper))
    found = study.judge(paper, done, folder)
    return StudyRecord(
        study.name,
        study.title,
        study.statement,
        found.finding,
        tuple(found.checks),
        found.figures,
        len(names),
        sum(done[name].timing["lammps_s"] for name in names),
    )
