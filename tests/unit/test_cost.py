"""`contact1d cost`: what it varies in a scene, when an error is a number, what it recommends, and its record."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import pytest
from pydantic import TypeAdapter

from contact1d import read_scene
from contact1d.workflow.continuation.outcome import Result
from contact1d.workflow.cost.report import CostRecord, Error, VariantRuns, summary, table
from contact1d.workflow.cost.study import run_once, with_errors
from contact1d.workflow.cost.variants import finer, variants_of
from contact1d.workflow.errors import SceneEdit
from tests.pages import require_shown
from tests.scenes import ROOT

SCENES = ROOT / "lammps_inputs" / "scenes"
KEPT = ROOT / "validation" / "results" / "costs" / "pull_off.json"
ROUND_OFF = 1e-12
TOLERANCE, SPACING, STEPS = "accuracy.tolerance", "bodies.spacing", "experiment.displacements.steps"
PARTICLES, METHOD = "bodies.particles", "experiment.method"
OUTCOME = 0.1
"""Part of an error by which it may change with the versions of packages."""


@pytest.mark.parametrize(
    ("name", "change", "varied"),
    [
        ("pull_off", (), {PARTICLES, "neighbours", "horizontal"}),
        ("mindlin", (), {SPACING, STEPS}),
        ("path_hysteresis", (), {STEPS}),
        ("pull_off_dynamic", (), {PARTICLES, METHOD, "neighbours", "horizontal"}),
        ("pull_off_dynamic", ("interaction.cutoff=3.5",),
         {PARTICLES, METHOD, "interaction.cutoff", "neighbours", "horizontal"}),
        ("thermal_load", (), {"neighbours", "noise"}),
        ("slide", (), set()),
        ("prandtl_tomlinson", ("damping.coefficient=0.3",), set()),
    ],
)  # fmt: skip
def test_a_scene_varies_in_numbers_that_are_no_physics_and_in_its_effects(
    name: str, change: tuple[str, ...], varied: set[str]
) -> None:
    """Each variant can be made of the file with the options that are printed."""
    path = SCENES / f"{name}.toml"
    found = variants_of(read_scene(path, change))
    assert {next(iter(edit.values), "".join(edit.without)) for edit, _ in found} == {TOLERANCE} | varied
    for edit, variant in found:
        again = read_scene(path, [*change, *(f"{key}={value}" for key, value in edit.values.items())], edit.without)
        assert finer(again) == finer(variant)


def test_a_reference_is_finer_in_all_and_without_time_where_this_is_no_physics() -> None:
    path = read_scene(SCENES / "hertz_plane.toml")
    found = finer(finer(path))
    assert found.accuracy.tolerance == pytest.approx(1e-2 * path.accuracy.tolerance, rel=ROUND_OFF)
    assert found.bodies.spacing == 0.25 * path.bodies.spacing
    assert len(found.experiment.places()) - 1 == 4 * (len(path.experiment.places()) - 1)
    still = finer(read_scene(SCENES / "pull_off_dynamic.toml"))
    assert (still.method, still.bodies.particles) == ("quasistatic", 240)
    thermal = read_scene(SCENES / "thermal_load.toml")
    assert finer(thermal).method == "dynamic"
    assert (thermal.noise, finer(thermal).noise) != (thermal.noise, thermal.noise)


def result(value: float, **errors: float) -> Result:
    return Result(value, "FU", errors)


@pytest.mark.parametrize(
    ("value", "chance", "error", "is_bound"),
    [
        (0.98, 0.0, 0.02, False),
        (1.005, 0.0, 0.006, True),  # the reference is uncertain by 0.001
        (1.02, 0.004, 0.025, True),  # another sample of the motion would give another error
    ],
)
def test_an_error_is_a_number_where_the_reference_is_known_ten_times_better(
    value: float, chance: float, error: float, is_bound: bool
) -> None:
    ran = VariantRuns({"adhesion_force": result(value, statistics=chance, sampling=0.1)})
    found = with_errors(ran, {"adhesion_force": result(1.0, solver=0.0004, model=0.0006)}).error
    assert found.relative == pytest.approx(error)
    assert found.is_bound == str(found).startswith("less than") == is_bound


def test_the_dominant_error_is_that_of_the_result_with_the_largest_error() -> None:
    """A number with ± is the same in the reference."""
    force = replace(result(1.02, solver=1e-4, input=0.05), given=0.05)
    results = {"adhesion_force": force, "critical_radius": result(1.0, sampling=9.0)}
    known = replace(result(1.0, solver=1e-4, input=0.05), given=0.05)
    best = {"adhesion_force": known, "critical_radius": result(1.0, solver=0.0)}
    found = with_errors(VariantRuns(results), best)
    assert (found.error.is_bound, found.dominant) == (False, "solver of adhesion_force")
    assert found.error.relative == pytest.approx(0.02)
    missing = with_errors(VariantRuns({"critical_radius": force}), best)
    assert table(record(missing))[1][-1] == "no adhesion_force"


def row(edit: Mapping[str, object], error: float, *cpu: float, warnings: tuple[str, ...] = ()) -> VariantRuns:
    errors = {"adhesion_force": Error(error)}
    return VariantRuns({}, cpu, warnings, "", SceneEdit(edit), errors, "solver of adhesion_force")


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
        (record(replace(COARSE, cpu_runs=(0.01,)), own=replace(OWN, cpu_runs=(0.1,))), KEEP),
        (record(replace(COARSE, cpu_runs=(9.5,)), own=replace(OWN, cpu_runs=(10.0,))), KEEP),
        (record(COARSEST, replace(COARSE, cpu_runs=(3.0,)), own=MISSED), USE.replace("0.4 s", "3 s")),
        (record(COARSEST, own=MISSED), "Neither the scene as it is nor a variant "),
    ],
)
def test_the_cheapest_variant_within_the_tolerance_is_recommended_where_it_warns_of_nothing_new_and_saves_time(
    found: CostRecord, advice: str
) -> None:
    assert found.advice.startswith(advice)
    assert summary(found)[-1] == found.advice


def test_the_table_has_error_time_its_part_of_the_scenes_and_new_warnings() -> None:
    warned = replace(COARSE, warnings=("lattice", "slow"))
    without = VariantRuns(cpu_runs=(0.5,), edit=SceneEdit(without=("horizontal",)), errors=OWN.errors)
    _, *rows, last = table(record(warned, replace(without, dominant="x"), own=replace(OWN, warnings=("slow",))))
    assert rows == [
        (TOLERANCE, "0.01", "0.0002", "0.4 s", "0.40", "solver of adhesion_force; the run warns: lattice"),
        ("without", "horizontal", "1e-05", "0.5 s", "0.50", "x"),
    ]
    assert last == (TOLERANCE, "0.001 (as it is)", "1e-05", "1 s", "1.00", "solver of adhesion_force")


def test_the_kept_record_is_of_the_scene_as_it_is_and_runs_today(tmp_path: Path) -> None:
    """Of the page; renew it with `contact1d cost lammps_inputs/scenes/pull_off.toml`, then WRITE_DOCS=1 this file."""
    kept, scene = TypeAdapter(CostRecord).validate_json(KEPT.read_bytes()), read_scene(SCENES / "pull_off.toml")
    header, *rows = table(kept)
    cells = [header, ["---"] * len(header), *((f"`{name}`", *others) for name, *others in rows)]
    text = "".join("| " + " | ".join(row) + " |\n" for row in cells) + f"\n{kept.advice}\n"
    require_shown("docs/performance.md", "cost", text, exactly=True)
    assert (ROOT / "docs" / "cost.png").is_file()
    found = [edit for edit, variant in variants_of(scene) if variant.accuracy.tolerance > kept.reference_tolerance]
    assert [row.edit for row in kept.rows] == found
    today = with_errors(run_once(scene, tmp_path), kept.reference)
    assert today.dominant == kept.baseline.dominant
    assert today.error.relative == pytest.approx(kept.baseline.error.relative, rel=OUTCOME)
