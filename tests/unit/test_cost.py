"""`contact1d cost`: which settings a scene has, orders, errors, what to do, and the record."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene
from contact1d.workflow.cost.knobs import Knob, Order, changed, knobs_of
from contact1d.workflow.cost.measure import EffectCost
from contact1d.workflow.cost.report import AS_IT_IS, EFFECT, CostRecord, Variant, summary, table, write_report
from contact1d.workflow.cost.study import choice, fit_order, judged, judged_by_group
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity
from tests.costs import markdown, read_record
from tests.pages import require_shown

MakeScene = Callable[..., Scene]
ROOT = Path(__file__).parents[2]
SCENES = ROOT / "lammps_inputs" / "scenes"
ROUND_OFF = 1e-12


ALWAYS = {"accuracy.tolerance", "bodies.particles"}
METHOD, CUTOFF, DAMPING, STEPS = (
    "experiment.method",
    "interaction.cutoff",
    "damping.coefficient",
    "experiment.displacements.steps",
)


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("pull_off", {CUTOFF, METHOD}),
        ("load", {CUTOFF, METHOD}),
        ("hertz_plane", {STEPS, METHOD, "bodies.spacing"}),
        ("path_hysteresis", {CUTOFF, STEPS, METHOD}),
        ("pull_off_dynamic", {CUTOFF, DAMPING, METHOD}),
        ("thermal_load", {CUTOFF, DAMPING}),
    ],
)
def test_a_scene_has_the_settings_that_its_file_can_change(name: str, wanted: set[str]) -> None:
    scene = read_scene(SCENES / f"{name}.toml")
    knobs, left_out = knobs_of(scene, settings_for(scene))
    names = {knob.name for knob in knobs}
    assert names == ALWAYS | wanted
    assert not names & left_out.keys()
    assert ("bodies.spacing" in left_out) == ("bodies.spacing" not in wanted)
    methods = {level.value.split(",")[0] for knob in knobs if math.isnan(knob.h) for level in knob.levels}
    assert methods == ({"quasistatic", "dynamic"} if METHOD in wanted else set())


def test_a_spacing_keeps_stiffness_per_length() -> None:
    scene = read_scene(SCENES / "hertz_plane.toml")
    knobs, _ = knobs_of(scene, settings_for(scene))
    spacing = next(knob for knob in knobs if knob.name == "bodies.spacing")
    for level in spacing.levels:
        other = changed(scene, level.keys)
        assert other.bodies.spacing == level.h
        assert other.bulk_stiffness / other.bodies.spacing == pytest.approx(0.5, rel=ROUND_OFF)


def test_the_order_of_synthetic_errors_is_found_with_its_standard_error() -> None:
    h = [0.1, 0.05, 0.025, 0.0125]
    exact = fit_order(h, [3.0 * x**2 for x in h])
    assert exact is not None
    assert exact.order == pytest.approx(2.0, rel=ROUND_OFF)
    assert exact.standard_error < ROUND_OFF
    rng = np.random.default_rng(1)
    fits = [
        fit_order(h, [x**2 * math.exp(0.2 * e) for x, e in zip(h, rng.normal(size=4), strict=True)]) for _ in h * 99
    ]
    pulls = [(fit.order - 2.0) / fit.standard_error for fit in fits if fit is not None]
    # Student's t with two degrees of freedom: half of all lies within 0.816; 396 fits give that share within 0.025.
    assert np.mean(np.abs(pulls) < 0.816) == pytest.approx(0.5, abs=0.1)


def variant(value: str, error: float, cpu: float = 1.0, **more: Any) -> Variant:
    errors = {} if math.isnan(error) else {"adhesion_force": error}
    return Variant(**{"knob": "accuracy.tolerance", "value": value, "errors": errors, "cpu_runs": (cpu,)} | more)


COARSE, NOW, FINE = variant("0.01", 1e-4, 0.2, h=1e-2), variant("0.001", 1e-5, h=1e-3), variant("1e-4", 1e-6, h=1e-4)
ROUGH = replace(NOW, errors={"adhesion_force": 2e-3})
NO_TIME, NO_NUMBERS = "Keep it: less saves no time.", "Keep it: no value that was tried gave numbers."
NONE_ENOUGH = "No value that was tried is enough: try a finer one, or a smaller accuracy.tolerance."


@pytest.mark.parametrize(
    ("levels", "cells"),
    [
        ((COARSE, NOW, FINE), ("0.01", "1e-05 → 0.0001", "1 → 0.2 s", "Set it to 0.01: it saves 80 % of the time.")),
        ((replace(COARSE, cpu_runs=(0.95,)), NOW), ("0.01", "1e-05 → 0.0001", "1 → 0.95 s", NO_TIME)),
        ((replace(COARSE, spread=1.0), NOW, FINE), ("0.001", "1e-05", "1 s", "Keep it.")),
        ((ROUGH, FINE), ("1e-4", "0.002 → 1e-06", "1 → 1 s", "Set it to 1e-4: the error is too large now.")),
        ((ROUGH,), ("", "0.002", "1 s", NONE_ENOUGH)),
        ((), ("", "", "", NO_NUMBERS)),
    ],
)  # fmt: skip
def test_a_row_has_what_is_enough_and_what_to_do(levels: tuple[Variant, ...], cells: tuple[str, ...]) -> None:
    found = replace(record(), variants=(record().variants[0], *levels))
    _, row, *_ = table(found)
    assert row == ("accuracy.tolerance", "0.001", *cells[:3], "0.94 ± 0.04" if levels else "", cells[3])


def test_of_a_setting_without_a_scale_of_errors_the_cheapest_is_enough() -> None:
    names = {"knob": "experiment.method"}
    levels = (variant("quasistatic", 1e-5, **names), variant("dynamic", 1e-4, 0.5, **names), variant("d", 0.9, **names))
    knob = Knob("experiment.method", "quasistatic", math.nan, has_order=False)
    row = table(replace(record(), knobs=(knob,), variants=levels))[1]
    assert (row[1], row[2], row[-1]) == ("quasistatic", "dynamic", "Set it to dynamic: it saves 50 % of the time.")


def test_the_kept_record_is_what_the_tolerance_uses() -> None:
    """A change of the settings without a new study of `pull_off.toml` fails here."""
    kept = read_record(ROOT / "docs" / "cost.json")
    scene = read_scene(SCENES / "pull_off.toml")
    assert [one.h for one in kept.of("accuracy.tolerance")] == [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6]
    for one in kept.variants:
        asked = changed(scene, one.scene_keys)
        assert one.details == choice(asked, settings_for(asked))
    assert [knob.now for knob in kept.knobs] == [knob.now for knob in knobs_of(scene, settings_for(scene))[0]]


def test_errors_are_against_what_they_belong_to_and_with_noise_have_a_standard_error() -> None:
    reference = {"displacement": Quantity(2.0, 0.003, "LU")}
    ran = variant("a", math.nan, quantities={"displacement": Quantity(2.02, 0.004, "LU")})
    found = judged(ran, reference, noisy=True)
    assert found.error == pytest.approx(0.01)
    assert found.spread == pytest.approx(0.0025)
    knob = Knob("bodies.spacing", "1 LU", 1.0, own_reference=True)
    results = ((AS_IT_IS, math.nan, 2.1), (knob.name, 0.5, 4.0), (knob.name, 1.0, 5.0), (EFFECT, math.nan, 4.2))
    several = [
        variant("", math.nan, knob=name, h=h, quantities={"displacement": Quantity(value, 0.0, "LU")})
        for name, h, value in results
    ]
    own, finest, coarse, left_out = judged_by_group(several, [knob], reference, noisy=False)
    assert own.error == pytest.approx(0.05)
    assert not finest.errors
    assert (coarse.error, left_out.error) == pytest.approx((0.25, 1.0))


def record() -> CostRecord:
    return CostRecord(
        title="a pull-off", scene="pull_off", reference="quasistatic", reference_values={"adhesion_force": 1.5},
        base_error=1e-8, limit=2.5e-4,
        knobs=(
            Knob("accuracy.tolerance", "0.001", 1e-3, order=Order(0.94, 0.04)),
            Knob("experiment.method", "quasistatic", math.nan),
        ),
        variants=(
            Variant(knob=AS_IT_IS, value="as it is", failure="particles flew\napart"),
            variant("0.01", 1e-4, 0.2, h=1e-2, steps=70, memory_mb=61.0, scene_keys=("accuracy.tolerance=0.01",)),
            variant("neighbours", 6e-3, knob=EFFECT), variant("horizontal", 6e-5, knob=EFFECT),
        ),
        effect_costs=(
            EffectCost("interaction", 17.0, math.nan, math.nan, math.nan),
            EffectCost("neighbours", 17.0, 15.0, 1.133, 0.004),
            EffectCost("horizontal", 17.0, 8.5, 2.0, 0.004),
        ),
        left_out={"bodies.spacing": "it would change the physics"}, versions={"lammps": "1"},
    )  # fmt: skip


def test_a_record_survives_its_file(tmp_path: Path) -> None:
    for folder in ("written", "again"):
        (tmp_path / folder).mkdir()
    write_report(record(), tmp_path / "written")
    read = read_record(tmp_path / "written" / "cost.json")
    write_report(read, tmp_path / "again")
    assert (tmp_path / "again" / "cost.json").read_text() == (tmp_path / "written" / "cost.json").read_text()
    assert read.variants[0].failure == "particles flew\napart"
    assert read.knobs[0] == record().knobs[0]


def test_the_summary_and_the_page_say_orders_costs_failures_and_what_to_do() -> None:
    text = "\n".join(summary(record()))
    for words in (
        "0.94 ± 0.04",
        "1.133 ± 0.004",
        "the scene as it is: particles flew apart",
        "Leave it out (--without horizontal): it saves 50 % of the time.",
        "at most 0.00025",
        "it would change the physics",
    ):
        assert words in text
    time, advice = "17.0 → 15.0 µs a step, ratio 1.133 ± 0.004", "Keep it: the main results need it."
    assert f"| `neighbours` | on | on | 0.006 without it | {time} |  | {advice} |" in markdown(record())


def test_the_table_of_the_page_is_what_the_kept_record_says() -> None:
    """Renew docs with `contact1d cost lammps_inputs/scenes/pull_off.toml`, then WRITE_DOCS=1 pytest this file."""
    require_shown("docs/performance.md", "cost", markdown(read_record(ROOT / "docs" / "cost.json")), exactly=True)
    assert (ROOT / "docs" / "cost.png").is_file()
