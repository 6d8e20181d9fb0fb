"""What the record of a kind says reaches curves, warnings and decks: branches, advice, loads, and other forces."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path
from typing import Any, get_args

import pytest

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.effects import Contribution, Stage
from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.progress import Silent
from contact1d.workflow.experiments import KINDS, planned
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.holding import hold
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import Experiment, Scene, read_scene
from contact1d.workflow.settings.settings import settings_for

MakeScene = Callable[..., Scene]
SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
TIMED: dict[str, Any] = {"bodies": {"particles": 60}, "damping": {"coefficient": "auto"}, "plate": {}}


def test_every_experiment_of_a_scene_has_a_record() -> None:
    kinds = [get_args(table.model_fields["kind"].annotation)[0] for table in get_args(get_args(Experiment)[0])]
    assert list(KINDS) == kinds


def branches(folder: Path) -> list[str]:
    with (folder / "curve.csv").open() as file:
        return [row["branch"] for row in csv.DictReader(file)]


def test_samples_of_a_thermal_load_are_no_unloading(make_scene: MakeScene, tmp_path: Path) -> None:
    scene = make_scene(
        **TIMED, noise={"temperature": 1e-4, "seed": 3}, experiment={"kind": "load", "force": 0.3, "method": "dynamic"}
    )
    assert set(branches(run(scene, tmp_path, figures=False).folder)) == {"settling", "sampling"}


def test_a_pull_off_loads_and_unloads(make_scene: MakeScene, tmp_path: Path) -> None:
    scene = make_scene(bodies={"particles": 40}, experiment={"kind": "pull_off", "preload": 0.2})
    assert set(branches(run(scene, tmp_path, figures=False).folder)) == {"loading", "unloading"}


def test_a_path_there_and_back_twice_has_two_branches(make_scene: MakeScene, tmp_path: Path) -> None:
    path = {"kind": "path", "displacements": [0.0, 0.05, 0.0, 0.04, 0.0]}
    scene = make_scene(bodies={"particles": 60}, experiment=path)
    assert branches(run(scene, tmp_path, figures=False).folder) == ["loading", *["loading", "unloading"] * 2]


def test_rows_of_a_slide_are_no_unloading() -> None:
    assert [KINDS["slide"].branch(phase) for phase in ("loading", "sliding")] == ["loading", "sliding"]


def test_rows_of_a_tangential_are_named_by_their_way() -> None:
    assert [KINDS["tangential"].branch(phase) for phase in ("forward", "backward_2")] == ["forward", "backward"]


def test_nobody_is_sent_to_a_method_that_his_experiment_refuses() -> None:
    """A slide exists in time only."""
    assert "quasistatic" in KINDS["pull_off"].advice(read_scene(SCENES / "pull_off_dynamic.toml"))
    sliding = KINDS["slide"].advice(read_scene(SCENES / "slide.toml"))
    assert "quasistatic" not in sliding
    assert "not for static_friction" in sliding  # no length gives it more rows
    assert "distance" in sliding


def test_a_tight_tolerance_beyond_what_a_scene_may_ask_ends_in_numbers(tmp_path: Path) -> None:
    """Passes are finer than the finest tolerance that a scene may have."""
    scene = read_scene(SCENES / "pull_off.toml", ("accuracy.tolerance=1e-7", "interaction.cutoff=2.5"))
    document = run(scene, tmp_path, figures=False).document
    assert document["status"] == "done"
    assert document["accuracy"]["tolerance"] < 1e-7
    assert "cutoff" in [warning["name"] for warning in document["warnings"]]


class Expected(Silent):
    """Keeps the steps that each phase is expected to take."""

    def __init__(self) -> None:
        self.steps: dict[str, int | None] = {}

    def phase(self, name: str, expected_steps: int | None = None) -> None:
        self.steps[name] = expected_steps


def opened(scene: Scene, folder: Path) -> RunContext:
    deck = Deck(scene, settings_for(scene))
    write_system(deck, folder)
    return RunContext(deck, folder, Expected(), 60.0)


def test_a_phase_under_load_is_expected_to_take_its_steps_and_not_its_load(
    make_scene: MakeScene, tmp_path: Path
) -> None:
    context = opened(make_scene(**TIMED, experiment={"kind": "load", "force": 0.3, "method": "dynamic"}), tmp_path)
    with context.contact() as contact:
        contact.replay((Phase("loading", (UnderLoad(0.5, 10), UnderLoad(0.5, 20))),))
    assert isinstance(context.progress, Expected)
    assert context.progress.steps["loading"] == 30


PUSH = 0.2


def test_another_force_on_the_upper_body_is_no_load(
    make_scene: MakeScene, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A constant force on the upper particles, half the load: the plate comes to rest, and the contact carries both."""
    scene = make_scene(**TIMED, experiment={"kind": "load", "force": 0.3, "method": "dynamic"})
    context = opened(scene, tmp_path)
    deck = context.deck
    push = Contribution("push", Stage.PULL, (), pushes="push_total")
    with context.contact() as contact:
        contact.session.execute(
            f"variable push_total equal {PUSH}\nfix push_particles upper addforce 0.0 0.0 $(-{PUSH}/count(upper):%.17g)"
        )
        contact._pushes = (push.pushes,)
        contact.begin("loading")
        held = hold(contact, 0.3, 0.3)
        contact.finish()
    last: State = held.last
    assert held.held
    near = 0.1 * deck.settings.tolerance * 0.3
    assert last.force == pytest.approx(0.3 + PUSH, abs=near)
    assert last.carried == pytest.approx(0.3, abs=near)


def test_the_planned_schedule_of_every_shipped_scene_is_a_deck() -> None:
    for path in SCENES.glob("*.toml"):
        scene = read_scene(path)
        deck = Deck(scene, settings_for(scene))
        assert deck.text(planned(scene, deck.settings)).startswith("# ")
