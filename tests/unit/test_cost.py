"""`contact1d cost`: which knobs a scene has, orders, front, advice and the record."""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import replace
from io import StringIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import read_scene
from contact1d.workflow.cost.knobs import Knob, Order, at_tolerance, base_keys, changed, knobs_of
from contact1d.workflow.cost.measure import EffectCost
from contact1d.workflow.cost.report import Advice, CostRecord, Variant, summary, write_report
from contact1d.workflow.cost.study import TARGETS, advise, choice, fit_order, judged, pareto_front
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity
from tests.costs import effects_markdown, read_record
from tests.pages import require_shown

MakeScene = Callable[..., Scene]
ROOT = Path(__file__).parents[2]
SCENES = ROOT / "lammps_inputs" / "scenes"
ROUND_OFF = 1e-12


ALWAYS = {"tolerance", "chain length"}


@pytest.mark.parametrize(
    ("name", "wanted"),
    [
        ("pull_off", {"cutoff", "method dynamic"}),
        ("load", {"cutoff", "method dynamic"}),
        ("hertz_plane", {"load increment", "method dynamic", "spacing"}),
        ("path_hysteresis", {"cutoff", "load increment", "method dynamic"}),
        ("pull_off_dynamic", {"cutoff", "damping", "method quasistatic"}),
        ("thermal_load", {"cutoff", "damping"}),
    ],
)
def test_a_scene_has_the_knobs_that_its_file_can_turn(name: str, wanted: set[str]) -> None:
    scene = read_scene(SCENES / f"{name}.toml")
    knobs, left_out = knobs_of(scene, settings_for(scene))
    names = {knob.name for knob in knobs}
    assert names == ALWAYS | wanted
    assert not names & left_out.keys()
    assert ("spacing" in left_out) == ("spacing" not in wanted)


def test_a_spacing_keeps_stiffness_per_length() -> None:
    scene = read_scene(SCENES / "hertz_plane.toml")
    knobs, _ = knobs_of(scene, settings_for(scene))
    spacing = next(knob for knob in knobs if knob.name == "spacing")
    for level in spacing.levels:
        other = changed(scene, base_keys(scene) + level.keys)
        assert other.bodies.spacing == level.value
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


def test_the_pareto_front_is_what_nothing_else_beats() -> None:
    costs, errors = [1.0, 2.0, 2.0, 3.0, 4.0, 0.5, math.nan], [1e-2, 1e-3, 5e-3, 2e-3, 1e-5, math.nan, 1e-9]
    assert pareto_front(costs, errors) == [0, 1, 4]
    assert pareto_front([], []) == []


def variant(label: str, error: float, cpu: float, knob: str = "tolerance", **more: Any) -> Variant:
    return Variant(label=label, knob=knob, value=1e-3, error=error, cpu_runs=(cpu,), **more)


def tolerance(value: float, error: float, cpu: float, **more: Any) -> Variant:
    label, details = f"accuracy.tolerance = {value:g}", more.pop("details", "table of 2000 points")
    return replace(variant(label, error, cpu, **more), value=value, details=details)


def test_advice_says_what_the_tolerance_chooses_and_what_is_cheaper_in_the_scene() -> None:
    variants = [
        tolerance(1e-3, 1e-6, 3.0),
        tolerance(1e-1, 1e-4, 0.5),
        variant("tuned", 2e-4, 0.1, knob="combined", details="cutoff 3 LU"),
    ]
    advice = advise(1e-3, variants, noisy=False)
    assert advice.text == (
        "tolerance 1e-3: chooses table of 2000 points: error 1.0e-06 in 3 s of CPU; "
        "cheaper in this scene: tuned (cutoff 3 LU), error 2.0e-04 in 0.1 s of CPU"
    )
    assert (advice.chosen, advice.label) == ("accuracy.tolerance = 0.001", "tuned")


def test_advice_tells_a_tolerance_that_was_not_run_or_is_not_enough() -> None:
    variants = [tolerance(1e-3, 2e-3, 1.0), variant("slow", 1e-6, 3.0)]
    not_enough = advise(1e-3, variants, noisy=False)
    assert "error 2.0e-03 in 1 s of CPU, which is not enough; the cheapest in this scene: slow" in not_enough.text
    assert not_enough.label == "slow"
    not_run = advise(1e-5, variants, noisy=False)
    assert not_run.text.startswith("tolerance 1e-5: was not run; the cheapest in this scene: slow")
    assert not_run.chosen == ""
    missed = advise(1e-7, variants, noisy=False)
    assert missed.text.endswith("; not reached by any setting tried (best 1.0e-06: slow)")
    assert missed.label == ""


def test_the_kept_advice_is_what_the_tolerance_uses() -> None:
    """A change of the settings without a new study of `pull_off.toml` fails here."""
    kept = read_record(ROOT / "docs" / "cost.json")
    scene = read_scene(SCENES / "pull_off.toml")
    assert [one.tolerance for one in kept.advice] == list(TARGETS)
    for one in kept.advice:
        asked = changed(scene, at_tolerance(scene, one.tolerance))
        chosen = next(variant for variant in kept.variants if variant.label == one.chosen)
        assert chosen.value == one.tolerance
        assert chosen.details == choice(asked, settings_for(asked))
        assert f"chooses {choice(asked, settings_for(asked))}: error " in one.text


def test_with_noise_an_error_counts_with_its_standard_error() -> None:
    lucky = variant("lucky", 1e-6, 1.0, spread=5e-3)
    assert advise(1e-2, [lucky], noisy=True).label == "lucky"
    assert advise(1e-3, [lucky], noisy=True).text.endswith("(best 5.0e-03, by its noise: lucky)")
    reference = {"displacement": Quantity(2.0, 0.003, "LU")}
    ran = variant("a", math.nan, 1.0, quantities={"displacement": Quantity(2.02, 0.004, "LU")})
    found = judged(ran, reference, noisy=True)
    assert found.error == pytest.approx(0.01)
    assert found.spread == pytest.approx(0.0025)


def record() -> CostRecord:
    failed = Variant(label="the scene as it is", knob="scene", failure="particles flew\napart")
    good = variant(
        "accuracy.tolerance = 0.01", 1e-4, 0.2, values={"adhesion_force": 1.5}, errors={"adhesion_force": 1e-4},
        steps=70, memory_mb=61.0, scene_keys=("accuracy.tolerance=0.01",),
    )  # fmt: skip
    return CostRecord(
        title="a pull-off", scene="pull_off", method="quasistatic", tolerance=1e-3,
        effects=("interaction", "neighbours"), reference="quasistatic", reference_values={"adhesion_force": 1.5},
        reference_uncertainties={"adhesion_force": 1e-9}, base="base", base_error=1e-8, repeats=3,
        knobs=(
            Knob("tolerance", "of all", 1e-3, order=Order(0.94, 0.04, 4)),
            Knob("method dynamic", "the other", math.nan),
        ),
        variants=(good, failed),
        effect_costs=(
            EffectCost("interaction", 400, 17.0, reason="interaction missing"),
            EffectCost("neighbours", 400, 17.0, 15.0, 1.133, 0.004, changes={"adhesion_force": 6e-5}),
        ),
        left_out={"spacing": "it would change the physics"}, pareto=(good.label,),
        advice=(Advice(1e-3, "tolerance 1e-3: take it", "", good.label),),
        versions={"lammps": "1"}, wall_s=9.0,
    )  # fmt: skip


def test_a_record_survives_its_file(tmp_path: Path) -> None:
    for folder in ("written", "again"):
        (tmp_path / folder).mkdir()
    write_report(record(), tmp_path / "written")
    read = read_record(tmp_path / "written" / "cost.json")
    write_report(read, tmp_path / "again")
    assert (tmp_path / "again" / "cost.json").read_text() == (tmp_path / "written" / "cost.json").read_text()
    assert read.variants[1].failure == "particles flew\napart"
    assert read.knobs[0] == record().knobs[0]


def test_the_table_has_a_row_for_every_variant_and_failures_a_reason(tmp_path: Path) -> None:
    write_report(record(), tmp_path)
    rows = list(csv.DictReader(StringIO((tmp_path / "cost.csv").read_text(encoding="utf-8"))))
    assert list(rows[0]) == [
        "knob", "label", "value", "error", "error_spread", "lammps_cpu_s", "wall_s", "steps", "memory_mb", "runs",
        "pareto", "failure", "details", "error_adhesion_force",
    ]  # fmt: skip
    assert (float(rows[0]["error"]), float(rows[0]["lammps_cpu_s"]), rows[0]["pareto"]) == (1e-4, 0.2, "1")
    assert (rows[1]["error"], rows[1]["failure"], rows[1]["runs"]) == ("", "particles flew apart", "0")


def test_the_summary_and_the_readme_say_orders_costs_failures_and_advice() -> None:
    text = "\n".join(summary(record()))
    for words in (
        "0.94 ± 0.04",
        "1.133 ± 0.004",
        "the scene as it is: particles flew apart",
        "take it",
        "would change the physics",
    ):
        assert words in text
    assert "| `neighbours` | 17.0 µs | 15.0 µs | 1.133 ± 0.004 | 5.0 ns | up to 6.0e-05 |" in effects_markdown(record())


def test_the_table_of_the_page_is_what_the_kept_record_says() -> None:
    """Renew docs with `contact1d cost lammps_inputs/scenes/pull_off.toml`, then WRITE_DOCS=1 pytest this file."""
    require_shown(
        "docs/performance.md", "cost", effects_markdown(read_record(ROOT / "docs" / "cost.json")), exactly=True
    )
    assert (ROOT / "docs" / "cost.png").is_file()
