"""Claim: docs/grains.md is what its record says, a LAMMPS run gives the record again, and its references are right."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from docs.grains import blocks, unit_tests
from tests.pages import require_shown
from validation.__main__ import RESULTS
from validation.grains import STUDIES, cases
from validation.grains.cases import GIVEN
from validation.grains.granular import DECKS, measured
from validation.grains.studies import AGREES, CHI
from validation.references.grains import K, coeff_restitution, kelvin_voigt, restoring, tsuji, viscoelastic
from validation.references.oblique import of_power, rebound, sticking
from validation.references.zunker_kamrin import Adhering, pull_off
from validation.study import Study, answered, read_record

RECORD = read_record(RESULTS / "grains.json")
PRINTED = 5e-5
"""Half a unit of the last decimal on the page."""


@pytest.mark.parametrize("name", blocks(RECORD))
def test_the_page_is_what_the_record_says(name: str) -> None:
    """Renew it with `python -m validation pages`."""
    require_shown("docs/grains.md", name, blocks(RECORD)[name], exactly=True)


def test_the_record_has_every_study_and_no_printed_digit_changes_in_half_the_timestep() -> None:
    assert [answer.name for answer in RECORD.answers] == [study.name for study in STUDIES]
    for row in RECORD.rows:
        assert row.verdict != "FAIL", row.name
        if row.name.startswith(cases.OURS):
            continue
        assert row.uncertainty <= PRINTED * (2.0 if abs(row.value) >= 2.0 or not row.reference.value else 1.0), row.name


def test_references_are_those_of_theory() -> None:
    assert [kelvin_voigt(A).restitution for A in GIVEN.timed] == pytest.approx([0.8327, 0.6091, 0.2808], abs=5e-5)
    elastic, peak = kelvin_voigt(0.0), (15.0 / 16.0) ** 0.4
    time = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * peak  # 2.9433 peak / v
    assert elastic.contact_time == pytest.approx(time, rel=1e-8)
    assert elastic.peak_overlap == pytest.approx(peak, rel=1e-8)
    assert elastic.peak_force == pytest.approx(4.0 / 3.0 * peak**1.5, rel=1e-8)
    first = 1.7302e-3 * (4.0 / 3.0) ** 0.4  # Ramirez et al. (1999)
    for small in (kelvin_voigt(1e-3), viscoelastic(2e-3, limited=True)):
        assert 1.0 - small.restitution == pytest.approx(first, rel=2e-3)
    assert restoring(coeff_restitution(0.6), limited=False).restitution == pytest.approx(0.6, abs=1e-7)
    assert restoring(2.0**0.5 * tsuji(0.6), limited=False).restitution == pytest.approx(0.6, abs=1e-3)
    pair = cases.SPHERES
    assert pair.lost == pytest.approx(7.0922e-5, rel=1e-5)
    pull_off = 1.5 * math.pi * cases.WORK_OF_ADHESION
    shares = [pair.force_at(0.0), pair.force(pair.critical), pair.force(pair.grips)]
    assert shares == pytest.approx([-one * pull_off for one in (8.0 / 9.0, 1.0, 5.0 / 9.0)], rel=1e-9)


@pytest.mark.parametrize(("deck", "printed", "values"), [
    ("deviations", r"^1\. .* overlap (\S+) +2\. .* is (\S+)$", [-0.007734, 0.5 / 0.91]),
    ("mdr", r"^pull-off force (\S+), by JKR (\S+)$", [2.14638e-4, 1.5e-3 * math.pi]),
])  # fmt: skip
def test_a_deck_to_send_shows_its_deviations_by_itself(
    deck: str, printed: str, values: list[float], tmp_path: Path
) -> None:
    path = DECKS / f"{deck}.lmp"
    assert len([line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]) <= 25
    lmp = [Path(sys.executable).with_name("lmp"), "-in", path, "-log", "none"]
    environment = os.environ | {"UCX_TLS": "self,sm", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(lmp, cwd=tmp_path, env=environment, check=True, capture_output=True, text=True)
    found = re.search(printed, done.stdout, re.M)
    assert found
    assert [*map(float, found.groups())] == pytest.approx(values, rel=3e-4)


def chain(psi: float) -> float:
    """v_s'/v_s of 800 springs with sliders, of m = v_n = E* = R = 1, by velocity Verlet: first order in the step."""
    heights, held, step = ((np.arange(800) + 0.5) / 800.0) ** 2, np.zeros(800), 5e-4
    d, v, slip, force, shear = 0.0, 1.0, psi, 0.0, 0.0
    while d > 0.0 or v > 0.0:
        v, slip = v - 0.5 * step * force, slip - step * CHI * shear
        d += step * v
        limit = np.maximum(d - heights, 0.0)
        held = np.clip(held + step * slip, -limit, limit)
        force, shear = limit.sum() / 400.0, held.sum() / 400.0
        v, slip = v - 0.5 * step * force, slip - step * CHI * shear
    return float(slip / psi)


def test_an_oblique_impact_by_superposition_is_that_of_springs_with_sliders_without_slip_and_sliding() -> None:
    assert [of_power(psi, CHI) for psi in GIVEN.psi] == pytest.approx([*map(chain, GIVEN.psi)], abs=3e-4)
    assert sticking(CHI) == pytest.approx(0.2317, abs=5e-5)
    lasts = kelvin_voigt(0.0).contact_time
    solved = [rebound(psi, CHI, lambda d: K * max(d, 0.0) ** 1.5, lasts) for psi in (1e-4, 4.75, 4.78)]
    known = [sticking(CHI) - 2.4e-5, 1.0 - 4.0 * CHI / 4.75 + 3.46e-5, of_power(4.78, CHI)]
    assert solved == pytest.approx(known, abs=1e-6)


@pytest.mark.parametrize("step", [1e-5, 1e-4, 4e-4])
def test_mdr_is_its_rule_whose_tension_fades_with_the_step(step: float) -> None:
    words = GIVEN.mdr.format(0.0005)
    found = measured("pulled", ("pull_off",), model=words, deepest=0.02, dt=step)["pull_off"].value
    now, first = (pull_off(Adhering(2.0, 2.0, 0.0005, *parts), 0.02, step) for parts in ((), (1.0, 1.0)))
    assert found == pytest.approx(now, rel=1e-9)
    assert first == pytest.approx(2.0 / 3.0 * 0.02**1.5 - 2.0 * 0.02**0.5 * step, rel=3e-3)  # the largest radius, kept


def test_docs_grains_yaml_is_the_record_for_other_codes() -> None:
    text = "".join(unit_tests(RECORD))
    assert (RESULTS.parents[1] / "docs" / "grains.yaml").read_text(encoding="utf-8") == text
    found = {one["name"]: one["analytic_value"] for one in pytest.importorskip("yaml").safe_load_all(text)}
    assert found == pytest.approx({row.name: row.reference.value for row in RECORD.rows if any(row.runs)}, rel=1e-11)


@pytest.mark.slow
@pytest.mark.parametrize("study", STUDIES, ids=lambda study: study.name)
def test_lammps_gives_every_row_again(study: Study, tmp_path: Path) -> None:
    rows = {row.name: row for row in next(one for one in RECORD.answers if one.name == study.name).rows}
    again = answered(study, tmp_path, False).rows
    assert [row.name for row in again] == list(rows)
    for row in again:
        assert row.verdict == rows[row.name].verdict, row.name
        assert row.value == pytest.approx(rows[row.name].value, abs=max(0.1 * AGREES, row.uncertainty)), row.name


@pytest.mark.slow
@pytest.mark.parametrize("place", range(len(GIVEN.timed)))
def test_the_nearest_coefficients_are(place: int) -> None:
    """A hundredth more or less has a larger largest error over the decade."""
    velocities = np.geomspace(cases.DECADE[0], cases.DECADE[-1], 9)
    exact = np.array([kelvin_voigt(GIVEN.timed[place] * v**0.2).restitution for v in velocities])
    for model in cases.FITTED:
        given = 1.0 if model is cases.RESTITUTION else 2.0 * GIVEN.timed[place] * velocities**0.2
        off = [
            np.max(abs(np.array([model.law(c).restitution for c in near * given * np.ones(9)]) - exact))
            for near in (GIVEN.nearest[model.name][place] + change for change in (-0.01, 0.0, 0.01))
        ]
        assert off[1] <= min(off), model.name
