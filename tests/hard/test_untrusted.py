"""Hard cases: what can't be trusted is not reported. Each run ends in words, with status "failed" and no number."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from contact1d import RunError, Scene, read_scene, run
from contact1d.workflow.model.settings import Settings
from tests.scenes import LAW, chains
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off


def tables(experiment: dict[str, Any], bodies: dict[str, Any] | None = None, **more: Any) -> dict[str, Any]:
    return chains(100.0, bodies={"particles": 60} | (bodies or {}), experiment=experiment, **more)


PULL = {"kind": "pull_off", "preload": 0.3}
UNTRUSTED = {
    "through each other: buckled chains": (
        tables(
            {"kind": "pull_off", "preload": 0.5},
            {"particles": 120, "profile": {"kind": "parabola", "radius": 500.0}, "bulk_stiffness": 0.4,
             "bulk_stiffness_tangential": 0.2},
            neighbours={"stiffness": 0.3}, horizontal={},
        ),
        "went through each other",
    ),
    "through each other: too deep": (
        tables({"kind": "path", "displacements": [0.0, 6.0]}), "went through each other",
    ),
    "end of the chain": (tables({"kind": "load", "force": 2.0}, {"particles": 13}), "end of the chain"),
    "more tension than adhesion": (tables({"kind": "load", "force": -5.0}), "never reached"),
    "lost in time": (
        tables({"kind": "load", "force": -5.0, "method": "dynamic"}, plate={}, damping={"coefficient": "auto"}),
        "does not sustain -5 FU",
    ),
}  # fmt: skip


SLOW = {"through each other: too deep"}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in SLOW else name for name in UNTRUSTED]
)
def test_no_number_comes_out(name: str, tmp_path: Path) -> None:
    scene, words = UNTRUSTED[name]
    with pytest.raises(RunError, match=words):
        run(read_scene(scene), tmp_path / "run", figures=False)
    document = json.loads((tmp_path / "run" / "results.json").read_text())
    assert document["status"] == "failed"
    assert words in document["error"]["message"]
    assert not any(isinstance(entry, dict) and "value" in entry for entry in document.values())
    assert {"in.lammps", "system.data", "log.lammps"} <= {path.name for path in (tmp_path / "run").iterdir()}


def spoil(monkeypatch: pytest.MonkeyPatch, record: str, **numbers: float) -> None:
    """Give a run settings that no scene can ask for, in one of their records."""
    from dataclasses import replace

    from contact1d.workflow.runs import campaign

    choose: Callable[..., Any] = campaign.settings_for

    def spoilt(scene: Scene) -> Settings:
        chosen = choose(scene)
        return replace(chosen, **{record: replace(getattr(chosen, record), **numbers)})

    monkeypatch.setattr(campaign, "settings_for", spoilt)


def test_a_time_step_that_explodes_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(monkeypatch, "motion", time_step=50.0)
    scene = tables({"kind": "load", "force": 0.3, "method": "dynamic"}, plate={}, damping={"coefficient": "auto"})
    with pytest.raises(RunError, match=r"finite|left the box|went through|LAMMPS stopped"):
        run(read_scene(scene), tmp_path / "run", figures=False)
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"


def test_a_run_that_takes_too_long_is_stopped(tmp_path: Path) -> None:
    scene = tables(
        {"kind": "load", "force": 0.3, "method": "dynamic"}, {"particles": 4000}, plate={},
        damping={"coefficient": "auto"}, accuracy={"tolerance": 1e-6},
    )  # fmt: skip
    with pytest.raises(RunError, match="time limit"):
        run(read_scene(scene), tmp_path / "run", figures=False, time_limit=0.5)
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"


def doubts(results: dict[str, Any]) -> set[str]:
    return {warning["name"] for warning in results["warnings"]}


def test_a_chain_that_cuts_the_tail_of_the_contact_gets_a_warning(tmp_path: Path) -> None:
    results = run(read_scene(tables(PULL, {"particles": 34})), tmp_path / "run", figures=False).document
    assert results["status"] == "done"
    assert doubts(results) == {"chain_end"}


def test_particles_closer_than_the_table_was_chosen_for_get_a_warning(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = tables({"kind": "path", "displacements": [0.0, 1.7]})  # one leap: the rows between are the program's
    results = run(read_scene(scene), tmp_path / "run", figures=False).document
    assert "table_core" not in doubts(results)
    spoil(monkeypatch, "forces", table_from=0.1)
    results = run(read_scene(scene), tmp_path / "run", figures=False).document
    assert "table_core" in doubts(results)


def test_atoms_that_fly_apart_are_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    spoil(monkeypatch, "motion", damping=1e4)  # over the time step it takes away many times the momentum that there is
    scene = tables({"kind": "load", "force": 0.3, "method": "dynamic"}, plate={}, damping={"coefficient": "auto"})
    with pytest.raises(RunError, match=r"left the box|missing"):
        run(read_scene(scene), tmp_path / "run", figures=False)
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"


def test_a_minimisation_that_is_cut_short_is_no_result(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("contact1d.workflow.deck.parts.MINIMISER_ITERATIONS", 1)
    with pytest.raises(RunError, match="not converged"):
        run(read_scene(tables({"kind": "path", "displacements": [0.3]})), tmp_path / "run", figures=False)
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"


def test_a_failed_run_leaves_nothing_of_the_run_before(tmp_path: Path) -> None:
    """Numbers of an older run beside a failure would be taken for its results."""
    scene = read_scene(tables({"kind": "load", "force": 0.3}))
    run(scene, tmp_path / "run", figures=False)
    assert {"curve.csv", "profile.csv"} <= {path.name for path in (tmp_path / "run").iterdir()}
    with pytest.raises(RunError):
        run(read_scene(tables({"kind": "load", "force": -5.0})), tmp_path / "run", figures=False)
    left = {path.name for path in (tmp_path / "run").iterdir()}
    assert not left & {"curve.csv", "profile.csv", "pressure.png"}
    assert json.loads((tmp_path / "run" / "results.json").read_text())["status"] == "failed"


TIMED = {"damping": {"coefficient": "auto"}, "plate": {}}
NEAR = {"quasistatic": 0.002, "dynamic": 0.01}
"""Distance from the pull-off force, relative: what was asked of it is 0.3 % and 1 %."""


@pytest.mark.parametrize("method", NEAR)
def test_a_tension_is_held_up_to_the_adhesion_force_and_no_further(tmp_path: Path, method: str) -> None:
    """The adhesion force is that of the reference solver, which shares nothing with the program."""
    terms = [Exponential(*LAW[:2]), Exponential(*LAW[2:])]
    adhesion = pull_off(ChainModel(60, 0.83, PairInteraction(*terms), radius=100.0), 0.1).adhesion_force
    more = TIMED if method == "dynamic" else {}

    def held(tension: float) -> float:
        scene = tables({"kind": "load", "method": method, "force": -tension}, **more)
        return float(run(read_scene(scene), tmp_path / "run", figures=False).document["force"]["value"])

    below, above = (1.0 - NEAR[method]) * adhesion, (1.0 + NEAR[method]) * adhesion
    assert held(below) == pytest.approx(-below, rel=1e-3)  # the tolerance of the scene
    with pytest.raises(RunError, match=r"never reached|does not sustain"):
        held(above)
