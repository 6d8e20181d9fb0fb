"""Claim: repeats of a thermal pull-off run side by side, each as its seed does alone, and one that fails ends all."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, RunError, load_run
from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments.pull_off import thermal
from contact1d.workflow.experiments.pull_off.pulls import Detachment, ramp_of
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for

FAST = 5e-3
"""Loading rate [FU/TU] of pulls that take a tenth of a second."""


def scene_of(**tables: Any) -> Scene:
    return scene_from_dict({
        "title": "three pairs",
        "bodies": {
            "particles": "auto", "spacing": 3.0, "profile": {"kind": "flat_punch", "radius": 4.5},
            "bulk_stiffness": 2.0, "reduction": "geike_popov", "mass": 0.02,
        },
        "interaction": {
            "repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26},
        },
        "damping": {"coefficient": 0.5},
        "noise": {"temperature": 2e-3, "seed": 5},
        "plate": {"mass": 0.1},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "pull_off", "preload": 0.02, "loading_rate": FAST, "repeats": 4},
    } | tables)  # fmt: skip


@pytest.fixture(scope="module")
def pulled(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(scene_of(), tmp_path_factory.mktemp("pulls") / "run", workers=4)


def test_side_by_side_they_give_what_they_give_one_by_one(pulled: Run, tmp_path: Path) -> None:
    alone = run(scene_of(), tmp_path / "run", figures=False, workers=1)
    assert alone.detachments["seed"].tolist() == [5.0, 6.0, 7.0, 8.0]
    for name, column in alone.detachments.items():
        assert column.tolist() == pulled.detachments[name].tolist(), name
    assert (alone.folder / "in.lammps").read_bytes() == (pulled.folder / "in.lammps").read_bytes()
    assert alone.timing["steps"] == pulled.timing["steps"]


def test_each_seed_is_the_pull_that_it_is_alone(pulled: Run, tmp_path: Path) -> None:
    once = scene_of(experiment={"kind": "pull_off", "preload": 0.02, "loading_rate": FAST})
    third = run(once.with_({"noise.seed": 7}), tmp_path / "run", figures=False)
    assert third.detachments["force"].tolist() == pulled.detachments["force"].tolist()[2:3]
    assert third.results["detachment_force"].value == third.results["detachment_force"].uncertainty
    settings = settings_for(once)
    table = third.outcome.tables["samples"]
    load, place = np.asarray(table["load"]), np.asarray(table["displacement"])
    pulling = load < 0.0
    last = np.flatnonzero(place[pulling] > settings.estimate.parted(0.99))[-1]  # then it leaves for good
    tension = -load[pulling][last] + 0.5 * ramp_of(once, settings).rise
    assert third.detachments["force"] == pytest.approx([tension])


def test_the_folder_has_them_all_and_nothing_under_way(pulled: Run) -> None:
    assert (pulled.folder / "detachments.png").is_file()
    assert not list(pulled.folder.glob(".*"))
    again = load_run(pulled.folder)
    forces = again.detachments["force"]
    assert again.results["detachment_force"].value == pytest.approx(forces.mean())
    assert again.results["detachment_force_spread"].value == pytest.approx(forces.std(ddof=1))
    assert again.plot().axes
    assert np.all(np.diff(again.detachments["time"][np.argsort(forces)]) >= 0.0)


def test_one_that_fails_ends_them_all(tmp_path: Path) -> None:
    hot = scene_of(noise={"temperature": 0.05, "seed": 5})
    with pytest.raises(RunError, match=r"heat alone parts the bodies.*noise\.temperature.*phase settling"):
        run(hot, tmp_path / "run", workers=2)
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"
    assert (tmp_path / "run" / "log.lammps").stat().st_size > 0
    assert not (tmp_path / "run" / ".pulls").exists()


def test_a_pull_faster_than_drag_lets_the_bodies_part_says_so(tmp_path: Path) -> None:
    fast = {"kind": "pull_off", "preload": 0.02, "loading_rate": 0.05, "repeats": 2}
    assert "lagging" in run(scene_of(experiment=fast), tmp_path / "run", figures=False).warnings


def test_a_spring_that_is_drawn_off_pulls_as_its_equation_says(tmp_path: Path) -> None:
    """Its force at the barrier is k (v t − (d_0 − d_A)): rows, forces and times of each pull agree."""
    drawn = {"kind": "pull_off", "preload": 0.02, "velocity": 2.5e-2, "stiffness": 0.2, "repeats": 2}
    scene = scene_of(experiment=drawn)
    found, settings = run(scene, tmp_path / "run", figures=False), settings_for(scene)
    estimate = settings.estimate
    slack, barrier = estimate.displacement_at(0.0), estimate.parted(0.99)
    expected = 0.2 * (2.5e-2 * found.detachments["time"] - (slack - barrier))
    assert found.detachments["force"] == pytest.approx(expected, rel=1e-9)
    assert found.results["detachment_force"].value < 2.0 * estimate.pull_off_force()
    deck = (found.folder / "in.lammps").read_text(encoding="utf-8")
    assert "spring tether" in deck
    assert deck.index("fix             drawn_spring") < deck.index("fix             plate_body")


def test_without_a_stiffness_the_spring_is_as_stiff_as_the_contact() -> None:
    scene = scene_of(experiment={"kind": "pull_off", "preload": 0.02, "velocity": 5e-3})
    settings = settings_for(scene)
    assert ramp_of(scene, settings).spring == pytest.approx(settings.estimate.stiffness_under(0.0))


@pytest.mark.parametrize("count", [1, 2, 9])
def test_the_mean_of_pulls_is_as_sure_as_so_many_of_them_make_it(
    count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Their scatter and that of a staircase, rise/√12, over √n; the spread itself to 1/√(2(n − 1))."""
    scene = scene_of(experiment={"kind": "pull_off", "preload": 0.02, "loading_rate": FAST, "repeats": count})
    settings = settings_for(scene)
    ramp, rule = ramp_of(scene, settings), RadiusRule(scene, 1e-2)
    none = np.zeros(3)
    state = State("pulling", 0.1, -0.2, Profile(none, none, none + 0.2, none, none), 0.2, 0.0, 0.0, rule, step=30.0)
    forces = 0.4 + 3.0 * ramp.rise * np.sin(np.arange(count))
    phases = (Phase("pulling", (ramp.row(4),)),)
    made = [Detachment(5 + i, float(f), 10.0 * f, phases, (state,), 0) for i, f in enumerate(forces)]
    monkeypatch.setattr(thermal, "pulls", lambda context, n: made[:n])
    found = thermal.pull_off_thermal(RunContext(Deck(scene, settings), tmp_path, Silent(), 1.0))
    mean = found.quantities["detachment_force"]
    assert mean.value == pytest.approx(forces.mean())
    if count == 1:
        assert mean.uncertainty == pytest.approx(forces[0])
        assert "detachment_force_spread" not in found.quantities
    else:
        spread = found.quantities["detachment_force_spread"]
        assert spread.value == pytest.approx(forces.std(ddof=1))
        assert spread.uncertainty == pytest.approx(spread.value / np.sqrt(2.0 * (count - 1)))
        assert mean.uncertainty**2 * count == pytest.approx(spread.value**2 + ramp.rise**2 / 12.0)
    assert found.tables["detachments"]["seed"] == tuple(5.0 + i for i in range(count))
    assert found.tables["samples"]["load"] == pytest.approx((-4.0 * ramp.rise,))


@pytest.mark.parametrize(("share", "told"), [(0.95, False), (1.05, True)])
def test_drag_is_told_where_it_takes_a_tenth_of_what_holds_the_bodies(share: float, told: bool) -> None:
    """Γ b Ḟ/F_A² = 0.1, Γ the drag of all, b the longest range."""
    settings = settings_for(scene_of())
    assert settings.law is not None
    drag = settings.particles * settings.damping + settings.plate_damping
    rate = share * 0.1 * settings.estimate.pull_off_force() ** 2 / (drag * settings.law.longest_range)
    for drawn in ({"loading_rate": rate}, {"velocity": rate / 0.2, "stiffness": 0.2}):
        scene = scene_of(experiment={"kind": "pull_off", "preload": 0.02} | drawn)
        warned = thermal._lagging(scene, settings_for(scene))
        assert bool(warned) == told
        if told:
            below = float(warned["lagging"].split(" of ")[-1].split()[0])
            assert below == pytest.approx(next(iter(drawn.values())) / share, rel=0.05)  # two digits are said
