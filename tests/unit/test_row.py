"""Spacing and middle of a row, of one place and of many."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.row import middle_of, spacing_of


@pytest.mark.parametrize("scale", [2.0**-20, 1.0, 2.0**20])
def test_spacing_and_middle_are_those_of_both_ends(scale: float) -> None:
    for places, spacing, middle in (
        ([7.0], 0.0, 7.0), ([7.0, 9.0], 2.0, 8.0), ([1.0, 2.0, 4.0], 1.5, 2.5), ([-3.0, 0.0, 2.0, 9.0], 4.0, 3.0),
    ):  # fmt: skip
        x = scale * np.array(places)
        assert (spacing_of(x), middle_of(x)) == (scale * spacing, scale * middle)
