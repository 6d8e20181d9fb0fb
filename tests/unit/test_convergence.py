"""The error of a lattice from three spacings, against sequences whose limit is known."""

import pytest

from contact1d.analysis.convergence import SLOWEST, extrapolated

ROUND_OFF = 1e-12


@pytest.mark.parametrize("order", [0.5, 1.0, 4.0])
@pytest.mark.parametrize("size", [-3.0, 0.2])
def test_what_shrinks_with_a_power_of_the_spacing_is_off_by_its_distance_from_the_limit(
    order: float, size: float
) -> None:
    values = [7.0 + size * spacing**order for spacing in (1.0, 0.5, 0.25)]
    assert extrapolated(*values) == pytest.approx(abs(size), rel=ROUND_OFF)


def test_what_shrinks_otherwise_is_followed_by_halves_or_ends_somewhere() -> None:
    """0.3 + 1 + 1/2 + 1/4 + … = 2.3, also from the other side; differences that hardly shrink; none at all."""
    assert [extrapolated(0.0, way * 0.3, way * 1.3) for way in (1.0, -1.0)] == pytest.approx([2.3, 2.3], rel=ROUND_OFF)
    assert extrapolated(0.0, 1.0, 1.99) == pytest.approx(1.0 / (1.0 - SLOWEST), rel=ROUND_OFF)
    assert extrapolated(0.0, 1.0, 2.0) == pytest.approx(10.0, rel=ROUND_OFF)
    assert extrapolated(2.0, 2.0, 2.0) == 0.0
