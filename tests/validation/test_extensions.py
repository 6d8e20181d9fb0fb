"""Claim: an experiment and a profile that nothing in the program names have honest uncertainties, or no number.

A new experiment is a script and a reader; the error budget perturbs whatever its reader reads. Reference: Galin's and
Sneddon's contact stiffness dF/dd = 2 E* a of any axisymmetric body, Hertz's a = √(Rd), and a worn sphere's infinite
pressure at its rim.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene, run
from contact1d.workflow import experiments
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.experiments.load import LoadExperiment
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import LINE_PRESSURE

RADIUS, LAYER = 1000.0, 1.0


class Stiffness(LoadExperiment):
    """dF/dd between a load and one percent more of it."""

    def script(self, branch: Any, scene: Scene) -> None:
        force = scene.experiment.compression or 0.0
        branch.begin("loading")
        branch.reach(force, force)
        branch.begin("unloading")
        branch.reach(0.99 * force, force)
        branch.mark("final")

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        loaded = trace.phases("loading")
        d, force = (
            float(values[0][-1] - values[1][-1])
            for values in ((loaded.displacement, trace.displacement), (loaded.force, trace.force))
        )
        return {"stiffness": Reading(force / d, LINE_PRESSURE)}


def scene(spacing: float, profile: Mapping[str, Any] | None = None, **more: Any) -> dict[str, Any]:
    return {
        "title": "a load on a plane",
        "bodies": {
            "particles": "auto",
            "spacing": spacing,
            "reduction": "mdr",
            "lower": "rigid_plane",
            "profile": profile or {"kind": "parabola", "radius": RADIUS},
            "bulk_stiffness": LAYER * spacing,
        },
        "experiment": {"kind": "load", "force": 40.0},
    } | more


@pytest.mark.parametrize("spacing", [0.37, 1.0, 2.3])
def test_a_new_experiment_states_its_lattice_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, spacing: float
) -> None:
    monkeypatch.setitem(experiments.KINDS, "load", Stiffness())
    found = run(read_scene(scene(spacing)), tmp_path / "run", figures=False).results["stiffness"]
    place = (0.75 * 40.0 / LAYER / math.sqrt(RADIUS)) ** (2.0 / 3.0)
    less = (0.75 * 39.6 / LAYER / math.sqrt(RADIUS)) ** (2.0 / 3.0)
    exact = 0.4 / (place - less)
    assert exact == pytest.approx(2.0 * LAYER * math.sqrt(RADIUS * place), rel=5e-3)
    assert 0.0 < abs(found.value - exact) <= found.uncertainty


@pytest.mark.parametrize("kind", ["displacement", "force"])
def test_hold_ends_at_hertz_within_its_uncertainty(tmp_path: Path, kind: str) -> None:
    tables = scene(1.0, damping={"coefficient": "auto"})
    held: dict[str, Any] = {"displacement": 1.0, "duration": 60.0}
    if kind == "force":
        held, tables["plate"] = {"force": 40.0, "duration": 2000.0}, {}
    tables["experiment"] = {"kind": "hold"} | held
    found = run(read_scene(tables), tmp_path / "run", figures=False)
    d, force, radius = (found.results[name] for name in ("displacement", "force", "contact_radius"))
    place = 1.0 if kind == "displacement" else (0.75 * 40.0 / LAYER / math.sqrt(RADIUS)) ** (2.0 / 3.0)
    assert abs(d.value - place) <= d.uncertainty
    assert abs(force.value - 4.0 / 3.0 * LAYER * math.sqrt(RADIUS) * place**1.5) <= force.uncertainty + 1e-9
    assert abs(radius.value - math.sqrt(RADIUS * place)) <= radius.uncertainty
    if kind == "displacement":  # springs on a plane have nothing to relax
        assert found.results["relaxation"].value == 0.0
    assert np.ptp(np.loadtxt(tmp_path / "run" / "curve.csv", delimiter=",", skiprows=1, usecols=0)) >= 0.0


def test_a_rim_has_no_largest_pressure(tmp_path: Path) -> None:
    r = np.linspace(0.0, 400.0, 400)
    worn = {"kind": "table", "r": r.tolist(), "z": np.maximum(0.0, (r**2 - 20.0**2) / 2000.0).tolist()}
    found = run(read_scene(scene(1.0, worn)), tmp_path / "run", figures=False)
    assert "peak_pressure" not in found.results
