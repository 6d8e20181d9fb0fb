"""Claim: no row of the paper passes where every run is wrong."""

import math
import zlib
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, Scene, read_scene
from contact1d.analysis.curve import Columns, profile_columns
from contact1d.analysis.pressure import Profile
from tests.scenes import SCENES
from validation.paper import STUDIES, fig9, tangential
from validation.paper.fig9 import asperity
from validation.paper.scenes import barquins_reduced
from validation.references.slide import Trace
from validation.row import tables_beside
from validation.study import Study

LONG = ("neighbours", "fig5", "fig6", "exponents", "fig8a", "fig8b", "heat", "detachment", "fig9", "adhesive", "fig4")
"""Their references take more than a second."""
EACH = [pytest.param(one, id=one.name, marks=[pytest.mark.slow] * (one.name in LONG)) for one in STUDIES]
PAPER = read_scene(SCENES / "paper.toml")
ABOUT = tables_beside(__file__)
WRONG = (1.4, 3.0)
"""Factors by which each number of each run is wrong, drawn from its name: the widest tolerance of a row is 10 %."""
POINTS, SLIDE = 30, 400
"""Points of a curve, and of a slide."""
COLUMNS = (
    "tangential_displacement", "tangential_force", "normal_force", "stick_radius", "stick_radius_uncertainty",
    "dissipated_energy", "drive", "friction",
)  # fmt: skip
CLAIMED = 1e-6
"""Uncertainty that the wrong numbers claim, relative: below any tolerance, so that no row fails by it alone."""


class WrongRuns(dict[str, Run]):
    """A finished run of any name. With horizontal freedom the larger preloads have failed, at a wrong place."""

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
        x = np.arange(200) - 99.5
        profile = Profile(x, 0.0 * x, 0.0 * x, rng.uniform(-0.3, 0.3, 200), 0.0 * x)
        a = np.linspace(45.0, 8.0, POINTS)
        curve: dict[str, Any] = {
            "displacement": np.linspace(wrong(0.5), -0.5, POINTS), "force": wrong(1.47) * barquins_reduced(a / 28.53),
            "contact_radius": a, "contact_radius_uncertainty": np.full(POINTS, 1e-3),
            "branch": np.array(["unloading"] * POINTS),
        }  # fmt: skip
        rows = len(tangential.OUT) + len(tangential.LOOP) - 1
        friction = {
            name: wrong(2.0) + rng.uniform(0.0, 1.0, SLIDE if name in COLUMNS[-2:] else rows).cumsum()
            for name in COLUMNS
        }
        profiles = Columns(profile_columns({"zero_load": profile, "deepest": profile}))
        tables: Any = {"curve": Columns(curve), "profile": profiles, "friction": friction}
        run = self[name] = Run(Path(name), document, PAPER, tables)
        vars(run).update(results=replace(run, tables={}).model.results, model=run)  # in units of the model already
        return run


@dataclass(frozen=True)
class WrongBench:
    """A bench whose runs are all wrong."""

    runs: WrongRuns = field(default_factory=WrongRuns)
    paper: Scene = PAPER


@pytest.mark.parametrize("study", EACH)
def test_no_row_passes_where_every_run_is_wrong(study: Study, monkeypatch: pytest.MonkeyPatch) -> None:
    """The integrator, which takes minutes and knows nothing of the runs, has about what is right."""
    known = np.full(SLIDE // 2, 0.07)
    slid = fig9.curved.Integrated(0.07, 0.17, Trace(known, known, known, known))
    monkeypatch.setattr(fig9.curved, "integrated", lambda _: slid)
    monkeypatch.setattr(asperity, "smoluchowski", cache(asperity.smoluchowski))
    bench: Any = WrongBench()
    found = study.measure(bench)
    assert found.rows
    if study.name != "adhesive":  # a ratio that is off the map of Maugis has no μ; else what is none fails for that
        assert all(math.isfinite(row.value) for row in found.rows)
    assert [row.name for row in found.rows if row.verdict != "FAIL"] == []
