"""How many rows a planned schedule has and where they lie; how often something is measured, counted by hand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.law_error import left_out
from contact1d.workflow.deck.steps import Displace, DisplaceInTime, Hold, Phase
from contact1d.workflow.experiments import planned
from contact1d.workflow.experiments.load.kind import planned as planned_load
from contact1d.workflow.experiments.path.thermal import thermal_rows
from contact1d.workflow.experiments.pull_off.kind import advice
from contact1d.workflow.experiments.pull_off.kind import planned as planned_pull_off
from contact1d.workflow.experiments.running.kind import advice_at_rest
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.sampling import chunk_steps, sampled_phase, standard_error
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.given import PULL, at, given_scene
from tests.unit.test_settings_similarity import SCENES

TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}


def of(scene: Scene) -> tuple[Settings, tuple[Phase, ...]]:
    settings = settings_for(scene)
    return settings, planned(scene, settings)


def places(phase: Phase) -> list[float]:
    return [row.displacement for row in phase.rows if isinstance(row, Displace)]


@pytest.mark.parametrize(("name", "rows"), [("smooth pull-off", 24), ("JKR on the plane", 24)])
def test_a_planned_pull_off_has_24_rows_down_and_80_back(name: str, rows: int) -> None:
    """Back to where nothing is felt; on a plane a twentieth beyond where fixed grips let go."""
    scene = scene_from_dict(SCENES[name])
    settings = settings_for(scene)
    loading, unloading = planned_pull_off(scene, settings)
    deepest = settings.largest_displacement
    end = 1.05 * settings.estimate.parted(0.0) if scene.is_stepped else settings.rest - settings.cutoff
    assert places(loading) == pytest.approx(np.linspace(0.0, deepest, rows + 1))
    assert places(unloading) == pytest.approx(np.linspace(deepest, end, 80))
    assert (loading.state, unloading.state) == (False, True)


def test_a_planned_pull_in_time_has_twelve_tensions() -> None:
    scene = given_scene(**TIMED, experiment=PULL | {"method": "dynamic"})
    settings, (_, _, pulling) = of(scene)
    tensions = [-row.load for row in pulling.rows if isinstance(row, Hold)]
    assert tensions == pytest.approx([1.2 * settings.estimate.pull_off_force() * n / 12.0 for n in range(1, 13)])


def test_a_planned_load_has_24_rows_and_one_in_one_run_a_hundred() -> None:
    for scene, rows in ((given_scene(experiment={"kind": "load", "force": 0.3}), 24), (
        scene_from_dict(SCENES["tension on the plane"]), 100
    )):  # fmt: skip
        settings = settings_for(scene)
        (phase,) = planned_load(scene, settings)
        assert places(phase) == pytest.approx(np.linspace(0.0, settings.largest_displacement, rows + 1))
        assert phase.state


def test_what_helps_a_pull_off_in_time_is_to_do_it_at_rest() -> None:
    moving = given_scene(**TIMED, experiment=PULL | {"method": "dynamic"})
    assert advice(moving) == advice_at_rest(moving) + ", since force control never sees the pull-off itself"
    assert advice(given_scene()) == advice_at_rest(given_scene())
    assert "interaction.cutoff" in advice(given_scene())
    assert "interaction.cutoff" not in advice_at_rest(scene_from_dict(SCENES["JKR on the plane"]))


def test_under_heat_a_place_is_left_forty_times_and_sampled_two_hundred() -> None:
    """Half a decay apart, or as far as samples of a load are."""
    settings = replace(settings_for(given_scene(**TIMED, experiment=PULL | {"method": "dynamic"})), time_step=0.01)
    look = chunk_steps(settings)
    assert (look - 1) * 0.01 < 0.25 * settings.settle_time <= look * 0.01
    for decay, steps in ((1e-6, look), (1e3, 50_000)):
        rows = thermal_rows(settings, decay, [(0.25, False), (0.5, True), (0.75, False)])
        assert rows == (
            *(DisplaceInTime(0.25, steps),) * 40, *(DisplaceInTime(0.5, steps),) * 240,
            *(DisplaceInTime(0.75, steps),) * 40,
        )  # fmt: skip
    assert chunk_steps(replace(settings, settle_time=1e-6)) == 20
    phase = sampled_phase("sampling", settings, 0.3, 7, state=True)
    assert (len(phase.rows), phase.state, sampled_phase("a", settings, 0.3, 7).state) == (7, True, False)


def test_a_standard_error_is_that_of_twenty_means() -> None:
    samples = np.random.default_rng(4).standard_normal(207).cumsum()
    sizes = [11] * 7 + [10] * 13  # as evenly as 207 goes into twenty
    ends = np.cumsum(sizes)
    means = [sum(samples[end - size : end]) / size for end, size in zip(ends, sizes, strict=True)]
    middle = sum(means) / 20.0
    variance = sum((mean - middle) ** 2 for mean in means) / 19.0
    assert standard_error(samples.tolist()) == pytest.approx(math.sqrt(variance / 20.0))


def test_an_equilibrium_is_off_by_twice_what_is_left_out_of_its_forces() -> None:
    scene = given_scene(interaction={"repulsion": {"amplitude": 0.018, "range": 0.03},
                                     "attraction": {"amplitude": 0.009, "range": 0.06}, "cutoff": 0.3})  # fmt: skip
    settings = settings_for(scene)
    assert settings.law is not None
    assert settings.table is not None
    state = at(0.1, 1.0)
    left = left_out(settings.law, settings.table, state.profile)
    assert left > 0.0
    assert law_error(scene, settings, state) == pytest.approx(2.0 * left)
