"""Claim: a comparison sees an error of a number in SI, however small the number is."""

from __future__ import annotations

import numpy as np
import pytest

BOLTZMANN = 1.380649e-23
"""k_B [J/K]."""


@pytest.mark.parametrize("tolerance", [{}, {"rel": 1e-3}])
def test_a_small_number_is_compared_relatively(tolerance: dict[str, float]) -> None:
    close, off = (1.0 + 1e-8) * BOLTZMANN, 10.0 * BOLTZMANN
    assert close == pytest.approx(BOLTZMANN, **tolerance)
    assert off != pytest.approx(BOLTZMANN, **tolerance)
    assert np.array([close]) == pytest.approx(np.array([BOLTZMANN]), **tolerance)
    assert {"k_B": off} != pytest.approx({"k_B": BOLTZMANN}, **tolerance)
    assert off == pytest.approx(BOLTZMANN, abs=1e-12)
