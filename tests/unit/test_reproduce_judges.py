"""Claim: a row of the reproduction can fail. Where every number of every run is wrong, every row of every study does.

A row that compares a value with itself, or with something that goes with it, passes whatever the runs say.
"""

from __future__ import annotations

import math
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve import TANGENTIAL_COLUMNS, Curve
from contact1d.analysis.pressure import Profile
from contact1d.analysis.theory.line_adhesion import barquins_reduced_force
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene, read_scene
from tests.kept_runs import solved_once
from validation.paper import fig9, tangential
from validation.paper.record import read_record
from validation.paper.studies import STUDIES
from validation.paper.study import Study
from validation.references.slide import Trace

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
ABOUT = {
    "adhesion_force": (1.47, "FU"), "zero_load_radius": (28.53, "LU"), "critical_radius": (15.0, "LU"),
    "largest_force": (40.0, "FU"), "largest_radius": (30.0, "LU"), "contact_radius": (30.0, "LU"),
    "mean_friction": (0.02, "FU"), "static_friction": (0.02, "FU"), "cantilever_work": (0.1, "FU·LU"),
    "dissipated_energy": (0.1, "FU·LU"), "stored_energy": (0.01, "FU·LU"),
    "image_contact_radius": (30.0, "LU"), "image_largest_radius": (30.0, "LU"), "displacement": (0.4, "LU"),
    "plate_temperature": (2e-3, "FU·LU"), "detachment_force": (0.5, "FU"),
    "detachment_force_spread": (0.1, "FU"),
}  # fmt: skip
"""About what the paper's scene has, so that nothing fails by its size alone."""
WRONG = (1.4, 3.0)
"""Factors by which each number of each run is wrong, drawn from its name: the widest tolerance of a row is 10 %, but
for shares that are to lie below a bound."""
ROWS = 30
SLIDE = 400
"""Rows of a slide."""
COLUMNS = (*TANGENTIAL_COLUMNS, "drive", "friction")
CLAIMED = 1e-3
"""Uncertainty that the wrong numbers claim, relative."""


class WrongRuns(dict[str, Run]):
    """A finished run of any name. With horizontal freedom the larger preloads have failed, at a wrong place."""

    def __init__(self, paper: Scene) -> None:
        super().__init__()
        self._paper = paper

    def __missing__(self, name: str) -> Run:
        rng = np.random.default_rng(zlib.crc32(name.encode()))

        def wrong(value: float) -> float:
            return float(value * rng.uniform(*WRONG))

        document: dict[str, Any] = {"status": "done"}
        for quantity, (value, unit) in ABOUT.items():
            number = wrong(value)
            entry = {"value": number, "uncertainty": CLAIMED * number, "unit": unit}
            document[quantity] = entry | {"si": {"value": 1e-9 * wrong(value), "uncertainty": 0.0, "unit": unit}}
        if "horizontal" in name and "dynamic" not in name and float(name.split("_")[0].removeprefix("preload")) > 2.0:
            document = {"status": "failed", "error": {"message": "it went through at displacement 9.9 LU"}}
        count = 200
        x = np.arange(count) - 0.5 * (count - 1)
        profile = Profile(x, 0.0 * x, 0.0 * x, rng.uniform(-0.3, 0.3, count), 0.0 * x)
        a = np.linspace(45.0, 8.0, ROWS)
        force = wrong(1.47) * barquins_reduced_force(a / 28.53)
        d = np.linspace(wrong(0.5), -0.5, ROWS)
        curve = Curve(d, force, a, np.full(ROWS, 0.3), ["unloading"] * ROWS, np.full(ROWS, 1e-3))
        rows = len(tangential.OUT) + len(tangential.LOOP) - 1
        friction = {
            name: wrong(2.0) + rng.uniform(0.0, 1.0, SLIDE if name in COLUMNS[-2:] else rows).cumsum()
            for name in COLUMNS
        }
        profiles = {"zero_load": profile, "deepest": profile}
        self[name] = Run(Path(name), document, self._paper, curve, profiles, friction)
        return self[name]


def no_integrator(scene: Scene) -> fig9.curved.Integrated:
    """In place of the integrator, which takes minutes and knows nothing of the runs."""
    known = np.full(SLIDE // 2, 0.07)
    return fig9.curved.Integrated(0.07, 0.17, Trace(known, known, known, known, known))


KEPT = {(c.study, c.name): c for c in read_record(SCENES.parents[1] / "docs/reproduced/reproduce.json").checks}
"""The rows that VALIDATION.md shows: what they are held against is no result, and the same whatever the runs say."""
SAME = 0.01
"""Relative: the paper's scene may be known better since."""


@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.name)
def test_no_row_passes_where_every_run_is_wrong(study: Study, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for module in {one.judge.__module__ for one in STUDIES}:
        monkeypatch.setattr(sys.modules[module], "save", lambda *_: None, raising=False)
    monkeypatch.setattr(fig9.curved, "integrated", no_integrator)
    paper = read_scene(SCENES / "paper.toml")
    with solved_once():
        found = study.judge(paper, WrongRuns(paper), tmp_path)
    assert found.checks
    if study.name != "adhesive":  # a ratio that is off the map of Maugis has no μ; else what is none fails for that
        assert all(math.isfinite(check.value) for check in found.checks)
    assert [check.name for check in found.checks if check.verdict == "PASS"] == []
    for check in found.checks:
        known = KEPT.get((study.name, check.name))
        stands_in = study is fig9.study.STUDY  # `no_integrator`
        if known and not stands_in and known.comparison != "at most" and known.evidence != "set bound":
            assert check.reference == pytest.approx(known.reference, rel=SAME, abs=1e-9), check.name
            for name in ("unit", "comparison", "evidence", "standing", "differs", "paper"):
                assert getattr(check, name) == getattr(known, name), (check.name, name)
