"""Claims of what a row holds along x, at both ends of the heights that are looked at: the slope of its energy."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.model.cutoff import largest_holding_force, slide_cutoff

STEP = 1e-5
"""Over the range, of a difference of energies."""
LAWS = [
    DoubleExponential(Exponential(1.0, 0.5), Exponential(0.5, 1.0)),
    DoubleExponential(Exponential(1.0, 0.5), None),
    DoubleExponential(Exponential(0.3, 0.2), Exponential(0.001, 0.8)),
]


def steepest(law: DoubleExponential, spacing: float, height: float) -> float:
    """max |∂U/∂x| of Σ V(r) over a long row, at a height."""
    row = spacing * np.arange(-300.0, 301.0)
    step = STEP * law.longest_range
    slopes = [
        float(law.energy(np.hypot(x + step - row, height)).sum() - law.energy(np.hypot(x - step - row, height)).sum())
        for x in np.linspace(0.0, spacing, 2049).tolist()
    ]
    return max(abs(slope) for slope in slopes) / (2.0 * step)


@pytest.mark.parametrize("spacing", [0.3, 1.0])
@pytest.mark.parametrize("law", LAWS)
def test_a_load_that_nothing_carries_leaves_a_particle_at_a_hundredth_of_the_range(
    law: DoubleExponential, spacing: float
) -> None:
    found = largest_holding_force(law, spacing, 1e9)
    assert found == pytest.approx(steepest(law, spacing, 0.01 * law.longest_range), rel=0.1)  # 33 places of a steep one


def test_what_only_repels_is_held_by_next_to_nothing_ten_ranges_away() -> None:
    found = largest_holding_force(LAWS[1], 2.0, 0.0)
    assert found == pytest.approx(steepest(LAWS[1], 2.0, 10.0 * 0.5), rel=5e-3)
    assert slide_cutoff(LAWS[1], 2.0, 0.0, 1e-3) <= 40.0 * 0.5


@pytest.mark.parametrize("share", [1e8, 1e-2, 1e-4, 1e-30])
@pytest.mark.parametrize("law", LAWS)
def test_a_pair_at_the_cutoff_bears_a_tenth_of_the_share_of_what_a_row_holds(
    law: DoubleExponential, share: float
) -> None:
    """By its far term alone, within one and forty of the longest range."""
    cutoff = slide_cutoff(law, 0.8, 0.1, share)
    far = law.attraction or law.repulsion
    wanted = far.range * np.log(far.amplitude / far.range / (0.1 * share * largest_holding_force(law, 0.8, 0.1)))
    assert (law.longest_range < wanted < 40.0 * law.longest_range) == (1e-4 <= share <= 1e-2)
    assert cutoff == pytest.approx(np.clip(wanted, law.longest_range, 40.0 * law.longest_range), rel=1e-9)
