"""Rows of the reproduction: what they rest on, when they fail, and prose that follows them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.units import Quantity
from validation.judging.check import Check
from validation.judging.words import agreement, limits, outcome, ratio, worst_deviation
from validation.paper import adhesive, fig6, fig7, table1
from validation.paper.oracles import chain_model, equilibrium_under
from validation.paper.paper import TABLE_1
from validation.paper.record import read_record
from validation.paper.section2 import Case
from validation.paper.study import Rows, warnings
from validation.references.solver import ChainSolver

KEPT = Path(__file__).parents[2] / "docs" / "reproduced" / "reproduce.json"
CHECK = Check("study", "F_A", 1.0, 0.01, "FU", 1.001, "theory", "closed form", 0.01, "lattice")
ROUND_OFF = 1e-12
FITTED = 1e-3  # of the noise that is put on
SOLVER = 1e-9  # of the force, by a bisection to 1e-12 LU
JKR_WORK = 0.42446  # by hand: 8 [x^3.5/3.5 − x^5/5] − (4/3) [x²/2 − x^3.5/3.5] from (1/36)^(1/3) to 1


def run_with(*names: str, **results: float) -> Any:
    quantities = {name: Quantity(value, 1e-6 * value, "") for name, value in results.items()}
    return SimpleNamespace(results=quantities, document={"warnings": [{"name": n, "message": ""} for n in names]})


def row_on(run: Any, despite: dict[str, str] | None = None) -> Check:
    row = Rows("study", {"one": run, "other": run_with()})
    return row(
        "F_A", 1.0, 0.01, "FU", 1.0, "theory", "closed form", 0.01, "lattice", on=["other", "one"], despite=despite
    )


def test_a_row_that_rests_on_a_run_with_a_warning_fails() -> None:
    assert row_on(run_with()).verdict == "PASS"
    check = row_on(run_with("chain_end"))
    assert (check.verdict, check.runs, check.unanswered) == ("FAIL", ("other", "one"), ("chain_end",))
    assert "warning chain_end: not answered" in limits(check)


def test_a_row_that_answers_the_warning_says_so_and_stands() -> None:
    check = row_on(run_with("chain_end"), {"chain_end": "its tail is not used", "snaps": "none here"})
    assert check.verdict == "PASS"
    assert limits(check) == "lattice; warning chain_end: its tail is not used"
    assert row_on(run_with("chain_end", "slow"), {"chain_end": "its tail is not used"}).verdict == "FAIL"


def test_a_run_that_failed_has_no_warnings_to_read() -> None:
    assert warnings(SimpleNamespace(document={"status": "failed"})) == ()


@pytest.mark.parametrize(
    ("reference", "differs", "verdict"),
    [(1.001, False, "PASS"), (1.1, False, "FAIL"), (1.001, True, "FAIL"), (1.1, True, "DIFFERS")],
)
def test_what_is_expected_to_differ_fails_where_it_agrees(reference: float, differs: bool, verdict: str) -> None:
    assert replace(CHECK, reference=reference, differs=differs).verdict == verdict
    assert replace(CHECK, value=math.nan, reference=reference, differs=differs).verdict == "FAIL"


def test_a_claim_that_is_wider_than_the_tolerance_is_no_agreement() -> None:
    check = replace(CHECK, comparison="uncertainty", uncertainty=0.02, tolerance=0.0)
    assert check.verdict == "PASS"
    assert replace(check, tolerance=0.01).verdict == "FAIL"
    assert replace(check, tolerance=0.05).verdict == "PASS"


def test_the_margin_is_what_is_allowed_over_what_is_reached() -> None:
    assert replace(CHECK, reference=1.25, tolerance=0.5).margin == pytest.approx(2.5)
    assert replace(CHECK, comparison="absolute", reference=0.75, tolerance=0.5).margin == pytest.approx(2.0)
    assert replace(CHECK, comparison="at most", reference=30.0).margin == pytest.approx(30.0)
    assert replace(CHECK, comparison="at most", reference=30.0).is_wide
    assert not replace(CHECK, reference=1.0).is_wide


@pytest.mark.parametrize(
    ("value", "said"),
    [(1.0, "1"), (1.0 + 2e-7, "1.00000020"), (1.0 + 2e-8, "1"), (0.9876, "0.988"), (1.012, "1.012"), (1.7, "1.7")],
)
def test_a_ratio_has_the_places_that_show_how_far_it_is_from_one(value: float, said: str) -> None:
    assert ratio(replace(CHECK, value=value, reference=1.0)) == said


def test_the_worst_deviation_is_from_the_reference_on_either_side() -> None:
    rows = [replace(CHECK, value=v, reference=2.0) for v in (2.1, 1.8, 2.05)]
    assert worst_deviation(rows) == pytest.approx(0.1)
    assert worst_deviation([*rows, replace(CHECK, value=math.nan)]) == math.inf


def test_rows_that_repeat_are_counted_apart() -> None:
    rows = [CHECK, replace(CHECK, standing="repeats"), replace(CHECK, reference=2.0, standing="by construction")]
    rows += [replace(CHECK, reference=2.0, differs=True), replace(CHECK, differs=True)]
    said = "1 of 1 rows pass, 1 differs as expected, 1 expected to differ do not"
    assert outcome(rows) == f"{said}; counted apart: 1 repeat another, 1 true by construction"
    assert agreement([CHECK, CHECK]) == "all 2 rows pass"
    assert agreement([CHECK, replace(CHECK, value=math.nan)]) == "1 of 2 rows fail"


def test_every_kept_row_names_its_runs_answers_warnings_and_says_why_it_is_wide() -> None:
    rows = read_record(KEPT).checks
    assert len(rows) > 100
    for row in rows:
        assert row.runs, row.name
        assert not row.unanswered, row.name
        assert row.wide or not row.is_wide or row.standing != "judged", row.name


def table_runs(force: float = 1.47) -> dict[str, Any]:
    """Runs that have √R exactly, from a first row with this F_A."""
    return {
        table1.pull_off_run(R): run_with(
            adhesion_force=force * math.sqrt(R / 1000.0), zero_load_radius=28.53 * math.sqrt(R / 1000.0)
        )
        for R in (entry.radius for entry in TABLE_1)
    }


def test_the_words_about_table_1_follow_its_rows(tmp_path: Path) -> None:
    good, bad = (table1.judge(None, table_runs(force), tmp_path) for force in (1.47, 1.4))
    assert {check.verdict for check in bad.checks} >= {"FAIL"}
    assert "rows fail" in bad.finding
    told = {check.name: check.verdict for check in good.checks}
    assert told["a_0, R = 1600 LU"] == told["one FU, R = 2000 LU"] == "DIFFERS"
    assert told["F_A, R = 1600 LU"] == told["F_A, R = 2000 LU"] == "PASS"
    assert [check.standing for check in good.checks[:4]] == ["by construction"] * 2 + ["judged"] * 2


def test_the_units_of_table_1_say_how_its_adhesion_force_scatters() -> None:
    assert table1.printed_scatter() == pytest.approx(0.0032, abs=1e-4)  # 1.47114, 1.87072/√1.6, 2.08944/√2


def test_an_exponent_has_the_uncertainty_of_fit_and_claims() -> None:
    radii = (1.0, 2.0, 4.0, 8.0)
    exact = fig7.fitted(radii, [Quantity(3.0 * R**0.7, 0.0, "FU") for R in radii])
    assert exact.exponent == pytest.approx(0.7, abs=ROUND_OFF)
    assert exact.spread < 1e-6
    tilted = [Quantity(3.0 * R**0.7 * (1.0 + FITTED * (R - 4.0) / 4.0), FITTED * 3.0 * R**0.7, "FU") for R in radii]
    found = fig7.fitted(radii, tilted)
    assert 0.0 < abs(found.exponent - 0.7) < found.spread


def test_departures_from_the_square_root_are_named() -> None:
    near = replace(CHECK, name="exponent of F_A over R", value=0.5, reference=0.5)
    far = replace(near, name="exponent of a_0 over R", value=0.52)
    assert fig7._departures([near]).startswith("None")
    assert "depart from 1/2 a_0 by 0.02" in fig7._departures([near, far])


def test_scatter_is_told_where_there_is_some() -> None:
    assert fig6._scatter([CHECK]) == "The scatter of the paper is not found here."
    assert "There is scatter: F_A." in fig6._scatter([CHECK, replace(CHECK, value=2.0)])


def test_chains_that_never_slip_are_not_said_to() -> None:
    assert fig6._ending([]) == "No preload made the chains slip past each other."
    assert "0.387 LU" in fig6._ending([replace(CHECK, value=0.387, reference=0.3815)])


def test_a_sum_over_springs_is_within_what_the_lattice_allows() -> None:
    """Of √(2Rd) with the edge anywhere between two springs; the bound is met within a percent."""
    shares = {"force": 0.0, "energy": 0.0}
    for edge in np.linspace(20.0, 21.0, 201):
        case = Case("one", "geike_popov", {"d": float(edge**2 / 2.0), "R": 1.0, "nu": 0.3, "h": 1.0})
        assert case.half_width == pytest.approx(edge)
        x = np.arange(-30, 31)
        height = np.maximum(edge**2 - x**2, 0.0)
        force = height.sum() / (4.0 / 3.0 * edge**3)
        energy = (height**2).sum() / (16.0 / 15.0 * edge**5)
        for what, value in (("force", force), ("energy", energy)):
            shares[what] = max(shares[what], abs(value - 1.0) / case.off(what))
    assert 0.95 < shares["force"] <= 1.0 + 1e-9
    assert 0.9 < shares["energy"] <= 1.0 + 1e-9


def test_the_work_of_jkr_and_the_map_of_maugis() -> None:
    assert adhesive.jkr_work() == pytest.approx(JKR_WORK, abs=1e-5)
    tabor, load = adhesive._on_map(0.6)
    assert 1.5 < load < 1.6
    assert 1.0 < tabor < 2.0


def test_the_solver_finds_the_state_under_a_force() -> None:
    scene = scene_from_dict(
        {
            "title": "few",
            "bodies": {
                "particles": 21, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 40.0}, "bulk_stiffness": 1.0
            },
            "interaction": {
                "repulsion": {"amplitude": 0.174938, "range": 0.137615},
                "attraction": {"amplitude": 0.087469, "range": 0.275231},
            },
            "experiment": {"kind": "pull_off", "preload": 0.2},
        }
    )  # fmt: skip
    model = chain_model(scene)
    wanted = ChainSolver(model).equilibrium(0.1)
    state = equilibrium_under(model, wanted.force)
    assert state.force == pytest.approx(wanted.force, abs=SOLVER)
    assert state.displacement == pytest.approx(0.1, abs=SOLVER)
