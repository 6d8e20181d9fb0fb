"""Claims of JKR's estimate on a plane: closed forms of a paraboloid and a punch, cells of second order.

Kendall's punch of the radius a: F = 2 E* a d down to d = −√(2π a W/E*), where all of it lets go.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.optimize import brentq, minimize_scalar

from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.adhesion import AdhesiveEstimate, elongation
from contact1d.workflow.settings.centring import expected
from contact1d.workflow.settings.settings import SettingsError, settings_for

Array = NDArray[np.float64]
E, W, R, A = 1.0, 0.005, 100.0, 5.0
GRID = 1e-5
"""Relative, of what is looked up between 4000 places."""
SLOPE = 3e-3
"""Relative, of differences of them."""
CLOSED_FORM = 2e-3
"""Of a displacement or radius, read off 61 places and a parabola."""
RATE = 0.35
"""Of the exponent: the rms over eight places of the apex."""


def scene(spacing: float = 0.2, particles: Any = "auto", profile: Any = None, **tables: Any) -> Scene:
    bodies = {
        "particles": particles, "spacing": spacing, "profile": profile or {"kind": "parabola", "radius": R},
        "reduction": "mdr", "lower": "rigid_plane", "bulk_stiffness": E * spacing,
    }  # fmt: skip
    experiment = {"kind": "pull_off", "preload": 2.0}
    return scene_from_dict(
        {"title": "JKR", "bodies": bodies, "adhesion": {"work_of_adhesion": W}, "experiment": experiment} | tables
    )


def estimate(of: Scene) -> AdhesiveEstimate:
    found = settings_for(of).estimate
    assert isinstance(found, AdhesiveEstimate)
    return found


def jkr(a: float) -> tuple[float, float]:
    """(displacement, force) of a contact of the radius a."""
    d = a**2 / R - math.sqrt(2.0 * math.pi * W * a / E)
    return d, 4.0 * E * a**3 / (3.0 * R) - math.sqrt(8.0 * math.pi * E * W * a**3)


def radius_under(force: float) -> float:
    lowest = minimize_scalar(lambda a: jkr(a)[1], bounds=(0.1, 20.0), method="bounded").x
    return float(brentq(lambda a: jkr(a)[1] - force, lowest, 90.0))


@pytest.mark.parametrize("depth", [-0.1, 0.3, 50.0])
def test_a_punch_is_kendalls(depth: float) -> None:
    found = estimate(scene(profile={"kind": "flat_punch", "radius": A}))
    last = -math.sqrt(2.0 * math.pi * A * W / E)
    assert found.fixed_grips == pytest.approx((A, last), rel=GRID)
    assert found.parted(0.1) == pytest.approx(last, rel=GRID)
    assert found.pull_off_force() == pytest.approx(-2.0 * E * A * last, rel=GRID)
    force = 2.0 * E * A * depth
    assert found.contact_force(depth) == pytest.approx(force, rel=GRID)
    assert found.displacement_at(force) == pytest.approx(depth, rel=GRID)
    assert found.stiffness_under(force) == pytest.approx(2.0 * E * A, rel=SLOPE)
    assert found.half_width(depth, 0.0) == pytest.approx(A)
    assert found.contact_force(1.01 * last) == 0.0  # nothing is held there


@pytest.mark.parametrize("share", [-0.9, -0.5, 0.0, 1.0, 2.0])
def test_the_stiffness_under_a_force_is_jkrs(share: float) -> None:
    found = estimate(scene())
    force = share * found.pull_off_force()
    a = radius_under(force)
    (d, f), (further, more) = jkr(a), jkr(1.0001 * a)
    assert found.displacement_at(force) == pytest.approx(d, rel=GRID, abs=GRID)
    assert found.stiffness_under(force) == pytest.approx((more - f) / (further - d), rel=SLOPE)


def test_below_the_largest_tension_nothing_is_stiffer_than_near_it() -> None:
    found = estimate(scene())
    most = found.pull_off_force()
    assert found.stiffness_under(-2.0 * most) == found.stiffness_under(-0.999 * most)
    assert 0.0 < found.stiffness_under(-2.0 * most) < 0.2 * found.stiffness_under(0.0)


@pytest.mark.parametrize(
    "experiment",
    [
        {"kind": "path", "displacements": [0.0, 20.0, -0.01, 0.3]},
        {"kind": "load", "force": 1500.0},
        {"kind": "pull_off", "preload": 1e-3},
    ],
)
def test_it_is_known_as_far_as_the_experiment_goes(experiment: dict[str, Any]) -> None:
    found = estimate(scene(1.0, experiment=experiment))
    if "displacements" in experiment:
        d, a = 20.0, float(brentq(lambda a: jkr(a)[0] - 20.0, 20.0, 90.0))
    else:
        a = radius_under(experiment.get("force", 1e-3))
        d = jkr(a)[0]
    assert found.half_width(d, 0.0) == pytest.approx(a, rel=GRID)
    assert found.contact_force(d) == pytest.approx(jkr(a)[1], rel=GRID, abs=GRID)


def test_a_contact_may_come_near_the_end_of_its_body_but_not_to_it() -> None:
    """A circle of 30 LU: a radius of 0.85 of it is computed, one of 0.95 is refused, and said to be its whole."""
    circle = {"kind": "circle", "radius": 30.0}
    near, far = (
        scene(0.5, profile=circle, experiment={"kind": "path", "displacements": [d]})
        for d in (float(scene(profile=circle).bodies.height(np.asarray([30.0 * share]))[0]) for share in (0.85, 0.95))
    )
    assert 0.85 * 30.0 <= estimate(near).half_width(near.experiment.places()[0], 0.0) < 0.9 * 30.0
    with pytest.raises(SettingsError, match=r"over the whole body, which ends at 30 LU"):
        settings_for(far)


@pytest.mark.parametrize("phase", np.linspace(0.0, 0.9, 10).tolist())
def test_shares_rise_from_the_edge_inwards_wherever_the_apex_stands(phase: float) -> None:
    """Between 0 and 1, the more the deeper; and one half where the edge of the contact is at the particle."""
    of = scene(0.7)
    found = estimate(of)
    x = 0.7 * (np.arange(25) + phase)
    cells = found.cells(x, of.bodies)
    shares = cells.shares(np.linspace(found.fixed_grips[1] - 0.01, 1.0, 2000))
    assert (np.diff(shares, axis=0) >= -1e-12).all()
    assert (np.diff(shares, axis=1) <= 1e-12).all()
    assert ((shares >= 0.0) & (shares <= 1.0)).all()
    assert shares[0].max() == 0.0
    outer = np.flatnonzero(x - 0.7 > found.fixed_grips[0])
    places = np.asarray([jkr(a)[0] for a in x[outer].tolist()])
    assert np.diagonal(cells.shares(places)[:, outer]) == pytest.approx(0.5, abs=GRID)


@pytest.mark.parametrize("work", [0.0, W])
def test_cells_make_a_sum_of_second_order_in_the_spacing(work: float) -> None:
    """rms of the sum beside JKR's (without adhesion Hertz's) own force, over eight places of the apex."""
    errors = []
    for spacing in (2.0, 1.0, 0.5, 0.25):
        of = scene(spacing, adhesion={"work_of_adhesion": work}, experiment={"kind": "load", "force": 10.0})
        found = estimate(of)
        left = []
        for phase in np.arange(8) / 8.0:
            cells = found.cells(spacing * (np.arange(-60.0 / spacing, 60.0 / spacing) + phase), of.bodies)
            for d in (0.7, 1.1, 1.9):
                exact = jkr(brentq(lambda a, d=d: jkr(a)[0] - d, 8.0, 40.0))[1] if work else 4 / 3 * math.sqrt(R * d**3)
                left.append(float(cells.forces(np.asarray([d]), E * spacing)[0]) - exact)
        errors.append(math.sqrt(np.mean(np.square(left))))
    rates = np.log2(np.asarray(errors[:-1]) / errors[1:])
    assert rates.mean() == pytest.approx(2.0, abs=RATE)


@pytest.mark.parametrize("force", [-1.5, 0.0, 3.0])
def test_what_is_expected_of_a_load_is_jkrs(force: float) -> None:
    of = scene(experiment={"kind": "load", "force": force})
    told = expected(of, settings_for(of))
    a = radius_under(force)
    assert told == {
        "displacement": pytest.approx(jkr(a)[0], rel=CLOSED_FORM),
        "contact_radius": pytest.approx(a, rel=CLOSED_FORM),
    }


def test_what_is_expected_of_a_pull_off_is_jkrs() -> None:
    of = scene()
    told = expected(of, settings_for(of))
    assert told["adhesion_force"] == pytest.approx(1.5 * math.pi * W * R, rel=GRID)
    assert told["critical_radius"] == pytest.approx((9.0 * math.pi * W * R**2 / (8.0 * E)) ** (1 / 3), rel=CLOSED_FORM)
    assert told["zero_load_radius"] == pytest.approx((4.5 * math.pi * W * R**2 / E) ** (1 / 3), rel=CLOSED_FORM)


@pytest.mark.parametrize(
    "experiment",
    [
        {"kind": "path", "displacements": [0.0, 60.0, -0.01]},
        {"kind": "path", "displacements": [-0.1]},
        {"kind": "load", "force": 1500.0},
        {"kind": "load", "force": -2.0},
        {"kind": "pull_off", "preload": 1e-3},
        {"kind": "pull_off", "preload": 30.0},
    ],
)
def test_it_is_known_a_fifth_beyond_what_is_needed_and_not_twice_as_far_as_that(experiment: dict[str, Any]) -> None:
    """Beyond fixed grips, the deepest place, the load, and from where the force is more than the largest tension."""
    found = estimate(scene(1.0, experiment=experiment))
    wanted = max([0.0, *experiment.get("displacements", [])])
    load = experiment.get("force", experiment.get("preload", 0.0))

    def is_enough(a: float) -> bool:
        (d, force), grips = jkr(a), (math.pi * W * R**2 / (8.0 * E)) ** (1.0 / 3.0)
        return a > 1.2 * grips and d > 1.2 * wanted and force > max(1.2 * load, 1.5 * math.pi * W * R)

    assert found.end == pytest.approx((found.known, *jkr(found.known)), rel=GRID)
    assert is_enough(found.known)
    assert not is_enough(0.5 * found.known)
    assert found.pull_off_force() == pytest.approx(1.5 * math.pi * W * R, rel=GRID)


def test_without_work_it_is_hertz_from_nothing_on() -> None:
    found = estimate(scene(adhesion={"work_of_adhesion": 0.0}, experiment={"kind": "load", "force": 3.0}))
    assert found.pull_off_force() == 0.0
    assert found.fixed_grips == (0.0, 0.0)
    assert found.contact_force(-1e-3) == found.contact_force(0.0) == 0.0
    for d in (0.01, 0.1, 0.5):
        assert found.contact_force(d) == pytest.approx(4.0 / 3.0 * E * math.sqrt(R * d**3), rel=GRID)
        assert float(found.radii(np.asarray([d]))[0]) == pytest.approx(math.sqrt(R * d), rel=GRID)
    assert found.half_width(1e-9, 0.0) == 0.2  # a spacing at least


@pytest.mark.parametrize("depth", [1.0, 1e4, 1e7])
def test_beyond_its_end_a_punch_is_as_wide_as_it_is(depth: float) -> None:
    found = estimate(scene(profile={"kind": "flat_punch", "radius": A}))
    assert found.half_width(depth, 0.0) == pytest.approx(A, rel=1e-12)
    assert found.contact_force(depth) == pytest.approx(2.0 * E * A * depth, rel=1e-6)


@dataclass(frozen=True)
class Resting:
    """A body under which h(x) falls to 3 LU, stays as low up to 6, and rises."""

    reach: float = math.inf

    def height(self, x: Array) -> Array:
        x = np.asarray(x)
        return elongation(x, E, W) - 0.2 * np.minimum(x, 3.0) / 3.0 + 0.05 * np.maximum(x - 6.0, 0.0)


def test_an_edge_that_rests_anywhere_does_not_jump() -> None:
    springs = np.asarray([-1.0, 0.0])
    AdhesiveEstimate(springs, -0.2 * springs, 0.0, Resting(), 0.2, 0.2, work=W, known=20.0).require_one_edge()


@pytest.mark.parametrize("work", [5e-6, 5e-9])
def test_a_way_that_only_leads_apart_asks_for_no_more_than_the_adhesion_does(work: float) -> None:
    path = {"kind": "path", "displacements": [-1e-5]}
    found = estimate(scene(1e-3, adhesion={"work_of_adhesion": work}, experiment=path))
    grips = (math.pi * work * R**2 / (8.0 * E)) ** (1.0 / 3.0)
    assert 1.2 * grips < found.known < 20.0 * grips  # F is the largest tension on the other side at 5 times that
    assert found.pull_off_force() == pytest.approx(1.5 * math.pi * work * R, rel=GRID)


def test_cells_at_the_end_of_a_body_have_shares_too() -> None:
    circle = {"kind": "circle", "radius": 30.0}
    of = scene(0.5, profile=circle, experiment={"kind": "path", "displacements": [0.1]})
    found = estimate(of)
    cells = found.cells(np.asarray([-30.0, -29.9, 29.5, 29.75, 30.0]), of.bodies)
    shares = cells.shares(np.linspace(-1.0, 1e3, 1001))
    assert np.isfinite(shares).all()
    assert shares.min() == 0.0
    assert shares.max() == 1.0
    assert (np.diff(shares, axis=0) >= -1e-12).all()
