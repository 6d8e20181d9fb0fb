"""Contact radius without tension: where the pressure vanishes, exact for layers of springs, and what it claims."""

from __future__ import annotations

import numpy as np
import pytest

from contact1d.analysis.radius import compressive_radius, tensile_radius
from tests.unit.test_radius import BODY_RADIUS, CASES, COVERED, profile, random_case

ROUND_OFF = 1e-9  # LU: roots of a parabola through three doubles


def layer(x: np.ndarray, radius: float, centre: float = 0.0) -> np.ndarray:
    """Springs under a parabola: p = k/s (d - x²/2R) where positive, d = a²/2R."""
    return 0.8 * np.maximum(0.0, radius**2 - (x - centre) ** 2) / (2.0 * BODY_RADIUS)


def test_the_compressive_radius_of_a_layer_of_springs_is_exact() -> None:
    rng = np.random.default_rng(16)
    for radius in rng.uniform(4.0, 60.0, CASES):
        x = np.arange(-80.0, 81.0) + rng.uniform(-0.5, 0.5)
        found = compressive_radius(profile(x, layer(x, radius, centre=3.3)))
        assert found.value == pytest.approx(radius, abs=ROUND_OFF)
        assert found.left == pytest.approx(3.3 - radius, abs=ROUND_OFF)
        assert abs(found.value - radius) <= found.uncertainty < 1e-6
        assert not found.reaches_end


@pytest.mark.parametrize("noise", [1e-3, 1e-2])
def test_the_uncertainty_covers_a_noisy_layer(noise: float) -> None:
    rng = np.random.default_rng(17)
    covered = 0
    for radius in rng.uniform(1.0, 60.0, CASES):
        x = np.arange(-80.0, 81.0) + rng.uniform(-0.5, 0.5)
        found = compressive_radius(profile(x, layer(x, radius) * (1.0 + noise * rng.normal(size=x.size))))
        covered += abs(found.value - radius) <= found.uncertainty
        assert found.uncertainty <= 1.0  # between the outermost loaded particle and the next
    assert covered >= COVERED * CASES


def test_what_a_minimiser_leaves_widens_the_uncertainty() -> None:
    """Largest pressure 20, slope 1 at the edge: 1e-6 of the one is 2e-5 LU of the other."""
    x = np.arange(-40.0, 41.0) + 0.2
    cone = profile(x, np.maximum(0.0, 20.0 - np.abs(x)))
    exact, found = compressive_radius(cone), compressive_radius(cone, residual=1e-6)
    wide = compressive_radius(profile(0.25 * x, cone.pressure), residual=1e-6)
    assert wide.uncertainty == pytest.approx(0.25 * 2e-5, rel=0.02)
    assert found.value == exact.value == pytest.approx(20.0, abs=ROUND_OFF)
    assert exact.uncertainty < ROUND_OFF
    assert found.uncertainty == pytest.approx(2e-5, rel=0.02)


@pytest.mark.parametrize("loaded", [1, 2])
def test_few_loaded_particles_leave_half_a_spacing_of_doubt(loaded: int) -> None:
    x = np.arange(-5.0, 6.0)
    p = np.where(np.abs(x - 0.5 * (loaded - 1)) <= 0.5 * loaded - 0.25, 1.0, 0.0)
    found = compressive_radius(profile(x, p))
    assert np.count_nonzero(p) == loaded
    assert (found.value, found.uncertainty) == (0.5 * loaded, 0.5)


def test_three_loaded_particles_fix_a_parabola_and_a_fourth_tells_how_well() -> None:
    """1.45 spacings about a particle, or 1.9 about the middle of two."""
    for offset, radius, loaded in ((0.0, 1.45, 3), (0.5, 1.9, 4)):
        x = np.arange(-8.0, 9.0) + offset
        found = compressive_radius(profile(x, layer(x, radius)))
        assert np.count_nonzero(layer(x, radius)) == loaded
        assert found.value == pytest.approx(radius, abs=ROUND_OFF)
        assert found.uncertainty == pytest.approx(0.55, abs=1e-6) if loaded == 3 else found.uncertainty < 1e-6


def test_no_load_has_no_radius() -> None:
    found = compressive_radius(profile(np.arange(-5.0, 6.0), np.zeros(11)))
    assert (found.value, found.uncertainty, found.reaches_end) == (0.0, 0.5, False)


def test_a_chain_loaded_to_its_end_says_so() -> None:
    x = np.arange(-5.0, 6.0)
    found = compressive_radius(profile(x, layer(x, 30.0)))
    assert found.reaches_end
    assert found.value == 5.0


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_contact_at_one_end_of_its_chain_says_so_too(side: float) -> None:
    x = np.arange(-5.0, 6.0)
    found = compressive_radius(profile(x, layer(x, 4.5, centre=side * 3.0)))
    assert found.reaches_end
    assert (found.right if side > 0.0 else found.left) == side * 5.0


def test_tension_has_no_compressive_radius() -> None:
    with pytest.raises(ValueError, match="carry tension"):
        compressive_radius(profile(np.arange(3.0), np.array([-0.1, 1.0, -0.1])))


@pytest.mark.parametrize("seed", range(5))
def test_the_radius_does_not_depend_on_how_far_the_chain_goes_on(seed: int) -> None:
    """Bitwise: samples beyond a stencil's reach of the edge have no part in it."""
    rng = np.random.default_rng(seed)
    x, pressure, _ = random_case(rng, snaps=bool(seed % 2))
    far = 500
    longer = np.concatenate([x[0] - np.arange(far, 0.0, -1.0), x, x[-1] + np.arange(1.0, far + 1.0)])
    padded = np.concatenate([np.zeros(far), pressure, np.zeros(far)])
    assert tensile_radius(profile(longer, padded)) == tensile_radius(profile(x, pressure))
