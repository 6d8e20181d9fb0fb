"""Claim: an experiment and a profile that nothing in the program names have honest uncertainties, or no number.

A new experiment is a script and a reader; the error budget perturbs whatever its reader reads. Reference: Galin's and
Sneddon's contact stiffness dF/dd = 2 E* a of any axisymmetric body, Hertz's a = √(Rd), and a worn sphere's infinite
pressure at its rim.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d import read_scene, run
from contact1d.workflow import experiments
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.marks import unloading
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.experiments.load import LoadExperiment
from contact1d.workflow.experiments.pull_off import PullOffExperiment
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.shapes import Shape
from contact1d.workflow.units import LINE_PRESSURE

RADIUS, LAYER = 1000.0, 1.0


class Stiffness(LoadExperiment):
    """dF/dd between a load and one percent more of it."""

    def script(self, branch: Driver, scene: Scene) -> None:
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


class Fatigue(PullOffExperiment):
    """The pull-off three times, and the force maximum of each."""

    def script(self, branch: Driver, scene: Scene) -> None:
        for _ in range(3):
            super().script(branch, scene)

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        falling = [leg for leg in trace.legs if leg.phase[0].partition("_")[0] != "loading"]
        forces = [unloading(leg.falling(), settings)["adhesion_force"] for leg in falling]
        return dict(zip(("adhesion_force", "adhesion_force_first", "preload"), forces, strict=True))


WORK = 0.05
LAW = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}


@pytest.mark.parametrize("lower", ["rigid_plane", "particles"])
def test_an_experiment_may_load_as_often_as_it_wants(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, lower: str
) -> None:
    tables = scene(1.0, experiment={"kind": "pull_off", "preload": 5.0})
    if lower == "particles":
        tables["bodies"] |= {"lower": lower, "bulk_stiffness": 2.0}
        tables |= {"interaction": LAW, "experiment": {"kind": "pull_off", "preload": 0.5}}
    else:
        tables["adhesion"] = {"work_of_adhesion": WORK}
    once = run(read_scene(tables), tmp_path / "once", figures=False).results["adhesion_force"]
    monkeypatch.setitem(experiments.KINDS, "pull_off", Fatigue())
    found = run(read_scene(tables), tmp_path / "run", figures=False).results
    for name in ("adhesion_force", "adhesion_force_first", "preload"):
        assert abs(found[name].value - once.value) <= found[name].uncertainty
    if lower == "rigid_plane":
        assert abs(once.value - 1.5 * math.pi * WORK * RADIUS) <= once.uncertainty


INNER, OUTER, BEND = 1000.0, 100.0, 12.0


class TwoRadii(Shape):
    """f' = r/R₁ up to b, r/R₂ beyond: g = x²/R₁ + (1/R₂ − 1/R₁) x √(x² − b²) beyond b."""

    kind: Literal["two_radii"] = "two_radii"

    def height(self, x: Any) -> Any:
        beyond = np.maximum(np.asarray(x) ** 2 - BEND**2, 0.0)
        return np.asarray(x) ** 2 / (2.0 * INNER) + 0.5 * (1.0 / OUTER - 1.0 / INNER) * beyond

    def transformed(self, x: Any) -> Any:
        beyond = np.maximum(np.asarray(x) ** 2 - BEND**2, 0.0)
        return np.asarray(x) ** 2 / INNER + (1.0 / OUTER - 1.0 / INNER) * np.abs(x) * np.sqrt(beyond)

    @property
    def kinks(self) -> tuple[float, ...]:
        return (BEND,)


@pytest.mark.filterwarnings("ignore:Pydantic serializer")  # the union of the scene's profiles does not have it
@pytest.mark.parametrize("spacing", [0.37, BEND / 13.0, BEND / 12.5])
@pytest.mark.parametrize("work", [0.0, WORK])
def test_a_new_profile_with_a_kink_is_right_on_every_lattice(tmp_path: Path, spacing: float, work: float) -> None:
    tables = scene(spacing) | ({"adhesion": {"work_of_adhesion": work}} if work else {})
    tables["bodies"]["profile"] = {"kind": "parabola", "radius": OUTER}
    plain = read_scene(tables)
    bent = plain.model_copy(update={"bodies": plain.bodies.model_copy(update={"profile": TwoRadii()})})
    found = run(bent, tmp_path / "run", figures=False).results

    def displacement(a: float) -> float:
        return float(TwoRadii().transformed(a)) - math.sqrt(2.0 * math.pi * a * work / LAYER)

    def force(a: float) -> float:
        below = quad(lambda x: float(TwoRadii().transformed(x)), 0.0, a, points=[BEND], epsabs=1e-12, limit=200)[0]
        return 2.0 * LAYER * (a * displacement(a) - below)

    a = brentq(lambda one: force(one) - 40.0, BEND, 60.0, xtol=1e-12)
    assert abs(found["contact_radius"].value - a) <= found["contact_radius"].uncertainty
    assert abs(found["displacement"].value - displacement(a)) <= found["displacement"].uncertainty
    assert "peak_pressure" not in found
