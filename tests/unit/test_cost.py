"""`contact1d cost`: what it varies in a scene, when an error is a number, what it recommends, and its record."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest

from contact1d import read_scene
from contact1d.workflow.continuation.outcome import Result
from contact1d.workflow.cost.report import CostRecord, Error, VariantRuns, summary, table, write_report
from contact1d.workflow.cost.study import run_once, with_errors
from contact1d.workflow.cost.variants import finer, variants_of
from contact1d.workflow.errors import SceneEdit
from tests.costs import markdown, read_record
from tests.pages import require_shown

ROOT = Path(__file__).parents[2]
SCENES = ROOT / "lammps_inputs" / "scenes"
ROUND_OFF = 1e-12
TOLERANCE, SPACING, STEPS = "accuracy.tolerance", "bodies.spacing", "experiment.displacements.steps"
PARTICLES, METHOD = "bodies.particles", "experiment.method"
OUTCOME = 0.1
"""Part of an error by which it may change with the versions of packages."""


@pytest.mark.parametrize(
    ("name", "settings", "effects"),
    [
        ("pull_off", {PARTICLES}, {"neighbours", "horizontal"}),
        ("load", set(), {"neighbours"}),
        ("hertz_plane", {SPACING, STEPS}, set()),
        ("jkr", {SPACING}, set()),
        ("mindlin", {SPACING, STEPS}, set()),
        ("steel_on_glass", {SPACING}, set()),
        ("path_hysteresis", {STEPS}, set()),
        ("pull_off_dynamic", {PARTICLES, METHOD}, {"neighbours", "horizontal"}),
        ("thermal_load", set(), {"neighbours", "noise"}),
        ("slide", set(), set()),
        ("prandtl_tomlinson", set(), set()),
    ],
)
def test_a_scene_varies_in_what_its_file_gives_and_in_its_effects(
    name: str, settings: set[str], effects: set[str]
) -> None:
    found = [edit for edit, _ in variants_of(read_scene(SCENES / f"{name}.toml"))]
    assert {next(iter(edit.values)) for edit in found if edit.values} == {TOLERANCE} | settings
    assert {edit.without[0] for edit in found if not edit.values} == effects


@pytest.mark.parametrize(
    "change", ["damping.coefficient=0.3", "interaction.cutoff=3.5", "bodies.particles=220", "accuracy.tolerance=2e-3"]
)
def test_a_number_that_takes_the_place_of_auto_is_a_setting(change: str) -> None:
    scene = read_scene(SCENES / "pull_off_dynamic.toml", [change])
    key, _, value = change.partition("=")
    tried = {str(edit.values[key]) for edit, _ in variants_of(scene) if key in edit.values}
    assert len(tried) > 1
    assert ("auto" in tried) == (key != TOLERANCE)
    assert key == TOLERANCE or value not in tried


def test_of_a_slide_number_and_drag_of_particles_are_physics() -> None:
    scene = read_scene(SCENES / "slide.toml")
    for other in (scene, read_scene(SCENES / "prandtl_tomlinson.toml", ["damping.coefficient=0.3"])):
        assert {next(iter(edit.values), "") for edit, _ in variants_of(other)} == {TOLERANCE}
        assert finer(other).bodies.particles == other.bodies.particles


def test_what_is_open_stays_open_and_follows_the_tolerance() -> None:
    scene = read_scene(SCENES / "steel_on_glass.toml", ["bodies.spacing=auto"])
    assert {other.bodies.given_spacing for _, other in variants_of(scene)} == {"auto"}
    assert len({other.accuracy.tolerance for _, other in variants_of(scene)}) == len(variants_of(scene))


@pytest.mark.parametrize("name", ["hertz_plane", "jkr", "mindlin", "steel_on_glass"])
def test_with_a_spacing_stiffness_per_length_is_kept(name: str) -> None:
    scene = read_scene(SCENES / f"{name}.toml")
    given = [other for edit, other in variants_of(scene) if SPACING in edit.values]
    for other in [one for one in given if one.bodies.given_spacing != "auto"] + [finer(scene)]:
        assert other.bodies.spacing != scene.bodies.spacing
        for one in ("bulk_stiffness", "tangential_stiffness"):
            per_length = getattr(scene, one) / scene.bodies.spacing
            assert getattr(other, one) / other.bodies.spacing == pytest.approx(per_length, rel=ROUND_OFF)


@pytest.mark.parametrize("name", ["jkr", "hertz_plane", "steel_on_glass", "pull_off_dynamic"])
def test_every_variant_can_be_made_of_the_file_with_the_options_that_are_printed(name: str) -> None:
    path = SCENES / f"{name}.toml"
    for edit, other in variants_of(read_scene(path)):
        again = read_scene(path, [f"{key}={value}" for key, value in edit.values.items()], edit.without)
        assert finer(again) == finer(other)


def test_a_reference_is_finer_in_all_and_without_time_where_this_is_no_physics() -> None:
    path = read_scene(SCENES / "hertz_plane.toml")
    found = finer(finer(path))
    assert found.accuracy.tolerance == pytest.approx(1e-2 * path.accuracy.tolerance, rel=ROUND_OFF)
    assert found.bodies.spacing == 0.25 * path.bodies.spacing
    assert len(found.experiment.places()) - 1 == 4 * (len(path.experiment.places()) - 1)
    still = finer(read_scene(SCENES / "pull_off_dynamic.toml"))
    assert still.method == "quasistatic"
    assert still.bodies.particles == 240
    thermal = read_scene(SCENES / "thermal_load.toml")
    assert finer(thermal).method == "dynamic"
    assert (thermal.noise, finer(thermal).noise) != (thermal.noise, thermal.noise)


def result(value: float, **errors: float) -> Result:
    return Result(value, "FU", errors)


@pytest.mark.parametrize(
    ("value", "chance", "error"),
    [
        (1.02, 0.0, Error(0.02)),
        (0.98, 0.0, Error(0.02)),
        (1.005, 0.0, Error(0.006, is_bound=True)),  # the reference is uncertain by 0.001
        (1.02, 0.004, Error(0.025, is_bound=True)),  # another sample of the motion would give another error
        (1.0, 0.0, Error(0.001, is_bound=True)),
    ],
)
def test_an_error_is_a_number_where_the_reference_is_known_ten_times_better(
    value: float, chance: float, error: Error
) -> None:
    ran = VariantRuns({"adhesion_force": result(value, statistics=chance, sampling=0.1)})
    found = with_errors(ran, {"adhesion_force": result(1.0, solver=0.0004, model=0.0006)}).error
    assert found.relative == pytest.approx(error.relative)
    assert found.is_bound == error.is_bound
    assert str(found).startswith("less than") == error.is_bound


def test_a_number_with_an_uncertainty_is_the_same_in_the_reference() -> None:
    ran, best = (replace(result(value, solver=1e-4, input=0.05), given=0.05) for value in (1.02, 1.0))
    found = with_errors(VariantRuns({"adhesion_force": ran}), {"adhesion_force": best})
    assert (found.error.is_bound, found.dominant) == (False, "solver of adhesion_force")
    assert found.error.relative == pytest.approx(0.02)


def test_the_dominant_error_is_that_of_the_result_with_the_largest_error() -> None:
    results = {"adhesion_force": result(1.1, solver=3.0, sampling=2.0), "critical_radius": result(1.0, sampling=9.0)}
    found = with_errors(VariantRuns(results), dict.fromkeys(results, result(1.0, solver=0.0)))
    assert found.dominant == "solver of adhesion_force"
    assert found.errors["critical_radius"].relative == 0.0


def test_a_variant_without_a_main_result_is_a_row_with_the_reason() -> None:
    exact = result(1.0, solver=0.0)
    found = with_errors(VariantRuns({"critical_radius": exact}), {"adhesion_force": exact})
    assert found.failure == "no adhesion_force"
    assert table(record(found))[1][-1] == "no adhesion_force"


def test_a_variant_that_its_run_refuses_is_a_row_with_the_reason(tmp_path: Path) -> None:
    """A lower chain that is too short for the sliding distance is found as the run begins."""
    done = run_once(read_scene(SCENES / "slide.toml", ["bodies.particles=34"]), tmp_path)
    assert "too short for the sliding distance" in done.failure
    assert not done.results


def row(edit: Mapping[str, object], error: float, *cpu: float, warnings: tuple[str, ...] = ()) -> VariantRuns:
    return VariantRuns(
        {}, cpu, warnings, "", SceneEdit(edit), {"adhesion_force": Error(error)}, "solver of adhesion_force"
    )


OWN = row({TOLERANCE: 1e-3}, 1e-5, 1.2, 0.9, 1.0)
COARSE, COARSEST = row({TOLERANCE: 1e-2}, 2e-4, 0.4), row({TOLERANCE: 1e-1}, 2e-3, 0.2)


def record(*others: VariantRuns, own: VariantRuns = OWN) -> CostRecord:
    return CostRecord("a pull-off", 1e-3, 1e-6, {"adhesion_force": result(1.5, solver=1e-9)}, (*others, own))


USE, KEEP = "Use --set accuracy.tolerance=0.01: error 0.0002, 0.4 s in place of 1 s.", "Keep the scene as it is: "
MISSED = replace(OWN, errors={"adhesion_force": Error(2e-3)})


@pytest.mark.parametrize(
    ("found", "advice"),
    [
        (record(COARSEST, COARSE), USE),
        (record(COARSEST), KEEP),
        (record(replace(COARSE, warnings=("lattice",))), KEEP),
        (record(replace(COARSE, warnings=("lattice",)), own=replace(OWN, warnings=("slow", "lattice"))), USE),
        (record(replace(COARSE, cpu_runs=(0.905,))), KEEP),
        (record(replace(COARSE, cpu_runs=(0.01,)), own=replace(OWN, cpu_runs=(0.1,))), KEEP),
        (record(replace(COARSE, cpu_runs=(9.5,)), own=replace(OWN, cpu_runs=(10.0,))), KEEP),
        (record(replace(COARSE, errors={}, failure="it flew apart")), KEEP),
        (record(replace(COARSE, errors={"adhesion_force": Error(2e-3, is_bound=True)})), KEEP),
        (record(COARSEST, replace(COARSE, cpu_runs=(3.0,)), own=MISSED), USE.replace("0.4 s", "3 s")),
        (record(COARSEST, own=MISSED), "Neither the scene as it is nor a variant "),
        (record(), KEEP),
    ],
)
def test_the_cheapest_variant_within_the_tolerance_is_recommended_where_it_warns_of_nothing_new_and_saves_time(
    found: CostRecord, advice: str
) -> None:
    assert found.advice.startswith(advice)
    assert summary(found)[-1] == found.advice


def test_the_table_has_error_time_its_part_of_the_scenes_and_new_warnings() -> None:
    warned = replace(COARSE, warnings=("lattice", "slow"))
    _, *rows = table(record(warned, own=replace(OWN, warnings=("slow",))))
    assert rows == [
        (TOLERANCE, "0.01", "0.0002", "0.4 s", "0.40", "solver of adhesion_force; the run warns: lattice"),
        (TOLERANCE, "0.001 (as it is)", "1e-05", "1 s", "1.00", "solver of adhesion_force"),
    ]
    without = VariantRuns(cpu_runs=(0.5,), edit=SceneEdit(without=("horizontal",)), errors=OWN.errors)
    assert table(record(without))[1][:2] == ("without", "horizontal")


def test_a_record_survives_its_file(tmp_path: Path) -> None:
    written = record(COARSE, replace(COARSEST, failure="it flew apart", errors={}))
    write_report(written, tmp_path)
    assert table(read_record(tmp_path / "cost.json")) == table(written)
    assert (tmp_path / "cost.png").is_file()


def test_the_table_of_the_page_is_what_the_kept_record_says() -> None:
    """Renew the record with `contact1d cost lammps_inputs/scenes/pull_off.toml`, then WRITE_DOCS=1 pytest this file."""
    require_shown(
        "docs/performance.md",
        "cost",
        markdown(read_record(ROOT / "validation/results/costs/pull_off.json")),
        exactly=True,
    )
    assert (ROOT / "docs" / "cost.png").is_file()


def test_the_kept_record_is_of_the_scene_as_it_is_and_runs_today(tmp_path: Path) -> None:
    """A change of the settings without a new study of `pull_off.toml` fails here."""
    kept, scene = read_record(ROOT / "validation/results/costs/pull_off.json"), read_scene(SCENES / "pull_off.toml")
    found = [edit for edit, other in variants_of(scene) if other.accuracy.tolerance > kept.reference_tolerance]
    assert [one.edit for one in kept.rows] == found
    today = with_errors(run_once(scene, tmp_path), kept.reference)
    assert today.dominant == kept.baseline.dominant
    assert today.error.relative == pytest.approx(kept.baseline.error.relative, rel=OUTCOME)
