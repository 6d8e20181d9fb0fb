"""What of an uncertainty a tolerance is asked of."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from contact1d.workflow.continuation.outcome import LATTICE, Result, in_words, unmet

ONE = Result(2.0, "FU", {"solver": 0.02, LATTICE: 0.1})


def test_what_the_scene_leaves_open_is_no_error_of_the_program() -> None:
    assert unmet({"force": ONE}, 0.05) == {"force": pytest.approx(0.06)}
    assert unmet({"force": replace(ONE, given=0.01)}, 0.05) == {"force": pytest.approx(0.055)}
    assert unmet({"force": ONE}, 0.061) == {}
    assert (ONE.uncertainty, ONE.share) == pytest.approx((0.12, 0.06))


def test_without_the_lattice_what_is_left_by_reading_between_particles_still_counts() -> None:
    assert unmet({"force": ONE}, 0.0099, (LATTICE,)) == {"force": pytest.approx(0.01)}
    assert unmet({"force": ONE}, 0.0101, (LATTICE,)) == {}
    assert unmet({"force": replace(ONE, read=0.03)}, 0.0101, (LATTICE,)) == {"force": pytest.approx(0.025)}
    assert unmet({"force": replace(ONE, read=0.03)}, 0.05) == {"force": pytest.approx(0.06)}


def test_a_result_that_is_0_has_a_scale_or_is_a_length_without_bound() -> None:
    none = replace(ONE, value=0.0)
    assert unmet({"energy": none}, 0.05) == {}
    assert unmet({"contact_radius": none}, 0.05) == {"contact_radius": math.inf}
    assert unmet({"energy": replace(none, scale=1.0)}, 0.05) == {"energy": pytest.approx(0.12)}
    assert unmet({"force": replace(ONE, prescribed=True)}, 0.05) == {}


def test_shares_are_written_so_that_they_are_seen_above_the_tolerance() -> None:
    assert in_words({"a": 0.0123, "b": 0.010004}, 0.01) == "a 1.2e-02, b 1.0004e-02"
