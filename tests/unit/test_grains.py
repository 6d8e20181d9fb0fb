"""Claim: docs/grains.md is what its record says, a LAMMPS run gives the record again, and its references are right."""

import math
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.pages import require_shown
from validation.__main__ import RESULTS
from validation.grains import STUDIES, cases
from validation.grains.granular import DECKS
from validation.grains.page import blocks
from validation.grains.studies import AGREES
from validation.references.grains import coeff_restitution, kelvin_voigt, restoring, tsuji, viscoelastic
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
    assert [kelvin_voigt(A).restitution for A in cases.TIMED] == pytest.approx([0.8327, 0.6091, 0.2808], abs=5e-5)
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


def test_the_deck_to_send_shows_both_deviations_by_itself(tmp_path: Path) -> None:
    deck = (DECKS / "deviations.lmp").read_text(encoding="utf-8")
    assert len([line for line in deck.splitlines() if not line.startswith("#")]) <= 25
    lmp = [Path(sys.executable).with_name("lmp"), "-in", DECKS / "deviations.lmp", "-log", "none"]
    environment = os.environ | {"UCX_TLS": "self,sm", "OMP_NUM_THREADS": "1"}
    done = subprocess.run(lmp, cwd=tmp_path, env=environment, check=True, capture_output=True, text=True)
    found = re.search(r"^1\. .* overlap (\S+) +2\. .* is (\S+)$", done.stdout, re.M)
    assert found
    assert float(found[1]) == pytest.approx(-0.007734, abs=2e-6)
    assert float(found[2]) == pytest.approx(0.5 / 0.91, rel=1e-9)


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
@pytest.mark.parametrize("place", range(len(cases.TIMED)))
def test_the_nearest_coefficients_are(place: int) -> None:
    """A hundredth more or less has a larger largest error over the decade."""
    velocities = np.geomspace(cases.DECADE[0], cases.DECADE[-1], 9)
    exact = np.array([kelvin_voigt(cases.TIMED[place] * v**0.2).restitution for v in velocities])
    for model in cases.FITTED:
        given = 1.0 if model is cases.RESTITUTION else 2.0 * cases.TIMED[place] * velocities**0.2
        off = [
            np.max(abs(np.array([model.law(c).restitution for c in near * given * np.ones(9)]) - exact))
            for near in (cases.NEAREST[model.name][place] + change for change in (-0.01, 0.0, 0.01))
        ]
        assert off[1] <= min(off), model.name
