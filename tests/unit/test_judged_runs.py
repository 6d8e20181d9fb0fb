"""Claim: the record that VALIDATION.md shows is what its studies make of its runs, and its runs are of their scenes.

The runs are kept as far as they are read (`tests/kept_runs.py`), so that each row is judged anew in each run of the
tests. `make validation` renews them; with runs of a reproduction in `reproduced`, WRITE_DOCS=1 writes them alone.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

from contact1d.workflow.scene import Scene
from tests.kept_runs import KEPT, drawn, keep, keep_figures, kept_figures, kept_paper, kept_runs, solved_once
from validation.judging.check import Check
from validation.paper import fig9
from validation.paper.record import read_record
from validation.paper.studies import NAMES, STUDIES
from validation.paper.study import Findings
from validation.references.slide import Trace

ROOT = Path(__file__).parents[2]
SAME = 1e-6
"""Relative: the kept numbers have twelve digits, what is found by a search fewer."""
SAME_PLACE = 1e-4
"""The same of what a figure draws, which nobody sees finer."""
SMALL = 1e-9
"""Absolute, of rows whose value is a residue: a sum that is 0 but for round-off."""
ROUND_OFF = 1e-9
"""Relative: what allows no more than this can't be met by halves."""
JUST = 1e-6
"""Share of what a row allows by which it is just outside, or just inside."""
BY_INTEGRATOR = ("⟨F⟩ of a curved", "largest friction of a curved", "what it rises by", "friction at every row")
"""Rows whose reference takes minutes, in its place stand the numbers of the run."""


FIGURES: dict[str, list[list[float]]] = {}
"""What the figures of the studies that were judged draw."""


def setup_module() -> None:
    if os.environ.get("WRITE_DOCS") and (ROOT / "reproduced" / "runs").is_dir():
        keep(ROOT / "reproduced" / "runs")
        for name in NAMES:
            judged(name)
        keep_figures(FIGURES)


def as_the_run(scene: Scene) -> fig9.curved.Integrated:
    """In place of the integrator: what the run itself has."""
    run = next(run for run in kept_runs().values() if run.scene == scene)
    known = np.full(2, 1.0)
    mean, static = (run.results[name].value for name in ("mean_friction", "static_friction"))
    return fig9.curved.Integrated(mean, static, Trace(known, known, known, known, known))


def look(figure: Figure, path: Path) -> None:
    """In place of saving it."""
    FIGURES[path.name] = drawn(figure)


@cache
def judged(name: str) -> Findings:
    """What a study makes of the kept runs."""
    study = next(study for study in STUDIES if study.name == name)
    with pytest.MonkeyPatch.context() as patch, solved_once():
        for module in {one.judge.__module__ for one in STUDIES}:
            patch.setattr(sys.modules[module], "save", look, raising=False)
        patch.setattr(fig9.curved, "integrated", as_the_run)
        patch.setattr(fig9.curved, "off_trace", lambda *_: 0.0)
        return study.judge(kept_paper(), kept_runs(), Path("nowhere"))


def recorded(name: str) -> Any:
    return next(one for one in read_record(KEPT.parent / "reproduce.json").studies if one.name == name)


def rows_of(name: str) -> list[tuple[Check, Check]]:
    """The study's rows, anew and as recorded, without those of the integrator."""
    pairs = list(zip(judged(name).checks, recorded(name).checks, strict=True))
    return [pair for pair in pairs if not pair[1].name.startswith(BY_INTEGRATOR)]


@pytest.mark.parametrize("name", NAMES)
def test_every_row_of_the_kept_runs_agrees_or_is_known_to_differ(name: str) -> None:
    rows = judged(name).checks
    assert [row.name for row in rows if row.verdict == "FAIL"] == []
    assert all(row.verdict == "DIFFERS" for row in rows if row.differs)


@pytest.mark.parametrize("name", NAMES)
def test_the_record_is_what_its_studies_make_of_its_runs(name: str) -> None:
    for ours, known in rows_of(name):
        assert ours.name == known.name
        for key in ("value", "uncertainty", "reference", "tolerance"):
            assert getattr(ours, key) == pytest.approx(getattr(known, key), rel=SAME, abs=SMALL), (ours.name, key)
        for key in ("unit", "comparison", "evidence", "standing", "differs", "paper", "runs", "source", "limited_by"):
            assert getattr(ours, key) == getattr(known, key), (ours.name, key)
    if name != "fig9":  # it tells of the integrator
        assert judged(name).finding == recorded(name).finding


@pytest.mark.parametrize("name", NAMES)
def test_the_figures_show_what_they_showed(name: str) -> None:
    known = kept_figures()
    for figure in judged(name).figures:
        for ours, theirs in zip(FIGURES[figure], known[figure], strict=True):
            assert ours == pytest.approx(theirs, rel=SAME_PLACE, abs=SMALL), figure


@pytest.mark.parametrize("name", NAMES)
def test_a_row_just_outside_of_what_it_allows_fails_and_one_just_inside_passes(name: str) -> None:
    for row in judged(name).checks:
        least = 0.0 if row.comparison == "at most" else row.reference
        if row.allowed <= ROUND_OFF * abs(row.reference):
            continue
        for side in (-1.0, 1.0) if row.comparison != "at most" else (1.0,):
            inside, outside = (least + side * (1.0 + by) * row.allowed for by in (-JUST, JUST))
            agrees, fails = ("FAIL", "DIFFERS") if row.differs else ("PASS", "FAIL")
            assert replace(row, value=inside).verdict == agrees, row.name
            assert replace(row, value=outside).verdict == fails, row.name


def alike(ours: Any, theirs: Any) -> bool:
    """Whether two scenes as data are the same, numbers to SAME."""
    match ours, theirs:
        case bool() | str(), _:
            return bool(ours == theirs)
        case float() | int(), float() | int():
            return math.isclose(ours, theirs, rel_tol=SAME)
        case Mapping(), Mapping():
            return ours.keys() == theirs.keys() and all(alike(ours[key], theirs[key]) for key in ours)
        case list() | tuple(), list() | tuple():
            return len(ours) == len(theirs) and all(map(alike, ours, theirs))
    return bool(ours == theirs)


def as_data(scene: Scene) -> dict[str, Any]:
    return scene.model_dump(mode="json", by_alias=True, exclude_none=True)


@pytest.mark.parametrize("name", NAMES)
def test_the_kept_runs_are_of_the_scenes_that_their_study_asks_for(name: str) -> None:
    scenes = next(study for study in STUDIES if study.name == name).scenes(kept_paper())
    rested = {run for row in judged(name).checks for run in row.runs}
    assert rested <= set(scenes)
    for run, scene in scenes.items():
        assert alike(as_data(kept_runs()[run].scene), as_data(scene)), run
