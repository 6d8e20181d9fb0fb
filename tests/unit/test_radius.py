"""Contact radii against closed forms: of independent pairs, layers of springs and contacts held up to an edge.

They are known whatever the lattice; so is what the place of a minimum between samples may be off.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

from contact1d.analysis.extremum import position_of_minimum
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import compressive_radius, held_radius, moved_centre, tensile_radius
from tests.profiles import profile
from validation.references.interaction import PairInteraction

BODY_RADIUS = 1000.0  # LU
CASES = 200
SMALL_CASES = 150  # of them 0.98 covered, of those without a radius 0.99; 0.9 by interpolation alone
COVERED = 0.95  # share of cases whose error the uncertainty must cover; 0.96 to 1 measured on 300 cases of each kind
COVERED_SMOOTH = 0.99  # the share that `analysis.extremum` states for cases without snaps and noise
MEDIAN_ERROR = 1e-3  # spacings; 1e-4 measured: the degree of the interpolant limits it
SNAP_ERROR = 0.1  # spacings; 0.03 measured: a particle's snap is seen on the lattice only
TYPICAL_ERROR = 0.15  # spacings, 95 % of cases; 0.04 measured: dips of the shortest range are three spacings wide
ROUND_OFF = 1e-9
"""[LU], roots of a parabola through three doubles."""


@dataclass(frozen=True)
class Pair:
    """Two exponentials with two springs in series: G = r - 2 f(r)/k."""

    law: PairInteraction
    stiffness: float

    def undeformed(self, r: np.ndarray | float) -> np.ndarray | float:
        return r - 2.0 * self.law.force(r) / self.stiffness

    def tension(self, gap: np.ndarray) -> np.ndarray:
        """Force at each undeformed gap, when unloading: a particle that can snap stays in contact until it must."""
        fold = self.law.extremum_distance(2)
        stays = np.linspace(-6.0 * self.law.longest_range, fold, 4000)
        stays = stays[: int(np.argmax(self.undeformed(stays))) + 1]
        leaves = np.linspace(fold, 40.0 * self.law.longest_range, 8000)
        leaves = leaves[int(np.argmin(self.undeformed(leaves))) :]
        inside = gap <= self.undeformed(stays[-1])
        low = np.where(inside, stays[0], leaves[0])
        high = np.where(inside, stays[-1], np.maximum(leaves[-1], 1.1 * gap + 1.0))
        for _ in range(60):  # bisection: G rises with r on both branches
            middle = 0.5 * (low + high)
            above = self.undeformed(middle) > gap
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        return np.asarray(self.law.force(0.5 * (low + high)))


def random_pair(rng: np.random.Generator, snaps: bool) -> Pair:
    long = float(np.exp(rng.uniform(math.log(0.2), math.log(2.0))))
    law = PairInteraction.of(rng.uniform(1.0, 3.0), long / rng.uniform(1.5, 4.0), 1.0, long)
    steepest = float(law.force_slope(np.array(law.extremum_distance(2))))
    share = rng.uniform(1.02, 3.0) if snaps else rng.uniform(0.05, 0.98)
    return Pair(law, 2.0 * steepest / share)


def random_case(rng: np.random.Generator, snaps: bool) -> tuple[np.ndarray, np.ndarray, float]:
    """Places, pressures and true radius of a contact whose lattice lies anywhere."""
    pair = random_pair(rng, snaps)
    radius = rng.uniform(5.0 if snaps else 0.0, 80.0)
    apex = float(pair.undeformed(pair.law.extremum_distance(1))) - radius**2 / (2.0 * BODY_RADIUS)
    x = np.arange(-130.0, 131.0) + rng.uniform(-0.5, 0.5)
    return x, pair.tension(apex + x**2 / (2.0 * BODY_RADIUS)), radius


def errors(snaps: bool, noise: float, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Error and estimated uncertainty over random cases; noise relative to the largest tension."""
    rng = np.random.default_rng(seed)
    rows = []
    for _ in range(CASES):
        x, pressure, radius = random_case(rng, snaps)
        found = tensile_radius(profile(x, pressure + noise * pressure.min() * rng.normal(size=x.size)))
        rows.append((abs(found.value - radius), found.uncertainty))
    return np.array(rows)[:, 0], np.array(rows)[:, 1]


def test_the_uncertainty_covers_as_much_as_is_said_where_nothing_snaps() -> None:
    """0.995 measured on 600 cases; half of this uncertainty would cover 0.987 of them, a third 0.980."""
    error, uncertainty = np.concatenate([errors(False, 0.0, seed) for seed in (11, 14, 15)], axis=1)
    assert np.median(error) < MEDIAN_ERROR
    assert np.quantile(error, 0.95) < TYPICAL_ERROR
    assert np.mean(error <= uncertainty) >= COVERED_SMOOTH


def test_the_uncertainty_covers_what_a_snap_hides() -> None:
    error, uncertainty = errors(True, 0.0, 11)
    assert np.median(error) < SNAP_ERROR
    assert np.mean(error <= uncertainty) >= COVERED


def test_the_uncertainty_covers_the_error_of_a_noisy_profile() -> None:
    error, uncertainty = errors(False, 1e-2, 12)
    assert np.mean(error <= uncertainty) >= COVERED


@pytest.mark.parametrize("tilt", [-1e-7, 0.0, 1e-7])
def test_the_middle_particles_of_a_small_contact_may_tie(tilt: float) -> None:
    """Its two largest tensions lie one spacing from the centre, and the particles at ±1/2 are lowest, and alike."""
    narrow, wide = 0.05, 0.0525
    x = np.arange(-19.5, 20.0)
    tension = (1.0 + wide * x**2) * np.exp(-narrow * x**2)  # largest where x² = 1/narrow - 1/wide
    assert tension.max() == pytest.approx(float(tension[19]), rel=1e-15)
    found = tensile_radius(profile(x, -tension * (1.0 + tilt * x)))
    assert found.value == pytest.approx(math.sqrt(1.0 / narrow - 1.0 / wide), rel=1e-4)


def smooth(x: np.ndarray, left: float, right: float) -> np.ndarray:
    """A pressure with its two minima at left and right: dp/dx ~ -(x - left)(x - middle)(x - right), then fading."""
    middle, half = 0.5 * (left + right), 0.5 * (right - left)
    t = (x - middle) / half
    return ((t**2 - 1.0) ** 2 - 1.5) * np.exp(-0.5 * np.maximum(0.0, np.abs(t) - 1.3) ** 2 * 40.0)


def test_the_contact_need_not_be_centred_nor_its_places_even() -> None:
    x = np.arange(-60.0, 61.0) + np.random.default_rng(15).uniform(-0.2, 0.2, 121)
    found = tensile_radius(profile(x, smooth(x, -8.3, 17.9)))
    assert (found.left, found.right, found.value) == pytest.approx((-8.3, 17.9, 13.1), abs=1e-6)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_contact_at_one_end_of_its_chain_ends_there(side: float) -> None:
    x = np.arange(-20.0, 21.0)
    t = (x - side * 14.0) / 5.0
    found = tensile_radius(profile(x, (0.5 - t**2) * np.exp(-(t**2))))  # least at t² = 3/2, on one side beyond the end
    assert found.value == pytest.approx(0.5 * (6.0 + 5.0 * math.sqrt(1.5)), abs=0.01)
    found = compressive_radius(profile(x, layer(x, 4.5, centre=side * 18.0)))
    assert (found.right if side > 0.0 else found.left) == side * 20.0


def test_a_radius_of_a_few_spacings_is_not_known_to_a_thousandth_of_one() -> None:
    """Small contacts in closed form, all of them and those that look like a single spot; a claim never falls to 0."""
    rng = np.random.default_rng(7)
    found = []
    for _ in range(SMALL_CASES):
        pair, body, exact = random_pair(rng, snaps=False), 10.0 ** rng.uniform(0.3, 2.0), rng.uniform(0.0, 2.5)
        nearest = float(pair.undeformed(pair.law.extremum_distance(1))) - 0.5 * exact**2 / body
        x = np.arange(-60, 61) + rng.choice([0.0, 0.5])
        radius = tensile_radius(profile(x, pair.tension(nearest + 0.5 * x**2 / body)))
        found.append((radius.value, abs(radius.value - exact) <= radius.uncertainty))
        assert radius.uncertainty >= 0.5 or radius.value > 1.0
    assert np.mean([ok for _, ok in found]) >= COVERED
    spots = [ok for value, ok in found if value == 0.0]
    assert len(spots) > 0.2 * SMALL_CASES
    assert np.mean(spots) >= COVERED


@pytest.mark.parametrize("radius_of", [tensile_radius, compressive_radius, held_radius])
def test_a_radius_needs_particles_with_numbers(radius_of: Callable[[Profile], object]) -> None:
    with pytest.raises(ValueError, match="at least 3"):
        radius_of(profile(np.arange(2.0), np.ones(2)))
    with pytest.raises(ValueError, match="finite"):
        radius_of(profile(np.arange(3.0), np.array([0.0, math.nan, 0.0])))


@pytest.mark.parametrize("share", [1e-13, 1e-11])
def test_round_off_of_the_largest_pressure_is_no_tension(share: float) -> None:
    x = np.arange(-6.0, 7.0)
    p = np.maximum(9.5 - x**2, 0.0)
    p[0] = -share * p.max()
    found = profile(x, p)
    if share < 1e-12:
        assert compressive_radius(found).value == pytest.approx(math.sqrt(9.5), abs=1e-6)
    with pytest.raises(ValueError, match=r"carr(y|ies) tension"):
        tensile_radius(found) if share < 1e-12 else compressive_radius(found)


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**20])
def test_a_contact_drawn_along_by_more_than_a_spacing_has_its_centre_where_its_pressure_is(scale: float) -> None:
    x = scale * np.arange(-10.0, 11.0)
    for to, moved in ((1, 0.0), (2, 2.0), (-2, -2.0)):
        p = np.zeros(21)
        p[9 + to : 12 + to] = 1.0, -4.0, 1.0
        assert moved_centre(profile(x, p)) == pytest.approx(moved * scale, rel=ROUND_OFF)
    assert moved_centre(profile(x, np.zeros(21))) == moved_centre(profile(x[:1], np.ones(1))) == 0.0


def layer(x: np.ndarray, radius: float, centre: float = 0.0) -> np.ndarray:
    """Springs under a parabola: p = k/s (d - x²/2R) where positive, d = a²/2R."""
    return 0.8 * np.maximum(0.0, radius**2 - (x - centre) ** 2) / (2.0 * BODY_RADIUS)


def test_the_uncertainty_covers_a_noisy_layer() -> None:
    noise, rng = 1e-2, np.random.default_rng(17)
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


@pytest.mark.parametrize("loaded", [0, 1, 2])
def test_few_loaded_particles_leave_half_a_spacing_of_doubt(loaded: int) -> None:
    x = np.arange(-5.0, 6.0)
    p = np.where(np.abs(x - 0.5 * (loaded - 1)) <= 0.5 * loaded - 0.25, 1.0, 0.0)
    assert np.count_nonzero(p) == loaded
    for found in (compressive_radius(profile(x, p)), *([] if loaded else [held_radius(profile(x, p))])):
        assert (found.value, found.uncertainty) == (0.5 * loaded, 0.5)


def test_three_loaded_particles_fix_a_parabola_and_a_fourth_tells_how_well() -> None:
    """1.45 spacings about a particle, or 1.9 about the middle of two."""
    for offset, radius, loaded in ((0.0, 1.45, 3), (0.5, 1.9, 4)):
        x = np.arange(-8.0, 9.0) + offset
        found = compressive_radius(profile(x, layer(x, radius)))
        assert np.count_nonzero(layer(x, radius)) == loaded
        assert found.value == pytest.approx(radius, abs=ROUND_OFF)
        assert found.uncertainty == pytest.approx(0.55, abs=1e-6) if loaded == 3 else found.uncertainty < 1e-6


@pytest.mark.parametrize(("width", "known"), [(0.7, 1.0), (2.8, 0.1), (5.6, 1e-3)])
def test_a_dip_is_known_the_better_the_more_samples_it_has(width: float, known: float) -> None:
    """One narrower than a sample is anywhere between those beside the lowest, one of ten samples is where it is."""
    every, spacing, far = np.arange(60), 0.25, 400.0  # a place is not a distance
    place = position_of_minimum(far + spacing * every, -1.0 / np.cosh((every - 30.3) / width), every)
    assert abs(place.position - (far + spacing * 30.3)) <= place.uncertainty <= known * spacing


@pytest.mark.parametrize("beside", [(0.95, 0.1), (0.1, 0.95)])
def test_a_dip_of_one_sample_may_lie_anywhere_up_to_both_of_its_neighbours(beside: tuple[float, float]) -> None:
    every, y = np.arange(21), np.full(21, 1.0)
    y[9:12] = beside[0], 0.0, beside[1]
    place = position_of_minimum(1.0 * every, y, every)
    assert place.position - place.uncertainty <= 9.0 + 1e-9
    assert 11.0 - 1e-9 <= place.position + place.uncertainty <= place.position + 2.0


def test_two_samples_that_tie_leave_no_doubt_of_their_own() -> None:
    every = np.arange(24)
    place = position_of_minimum(1.0 * every, -1.0 / np.cosh(0.2 * (every - 11.5)), every)
    assert place.position == pytest.approx(11.5, abs=1e-8)
    assert place.uncertainty < 1e-3
