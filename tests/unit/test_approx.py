"""Claim: a comparison sees an error of a number in SI, however small the number is."""

import numpy as np
import pytest

BOLTZMANN = 1.380649e-23
"""k_B [J/K]."""


def test_a_small_number_is_compared_relatively() -> None:
    close, off = (1.0 + 1e-8) * BOLTZMANN, 10.0 * BOLTZMANN
    assert close == pytest.approx(BOLTZMANN)
    assert off != pytest.approx(BOLTZMANN, rel=1e-3)
    assert np.array([close]) == pytest.approx(np.array([BOLTZMANN]), rel=1e-3)
    assert off == pytest.approx(BOLTZMANN, abs=1e-12)
