"""[adhesion]: the contact that is predicted, and what its cells leave open."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from contact1d.workflow.model.cells import left_by_cells, pulling_rows
from numpy.typing import NDArray
from scipy.optimize import minimize_scalar

from contact1d.workflow.model.adhesion import AdhesiveEstimate
from contact1d.workflow.model.settings import SettingsError, settings_for
from contact1d.workflow.scene import scene_from_dict

BODIES = {
    "particles": "auto", "spacing": 0.2, "profile": {"kind": "parabola", "radius": 100.0}, "reduction": "mdr",
    "lower": "rigid_plane", "bulk_stiffness": 0.2,
}  # fmt: skip
SCENE: dict[str, Any] = {
    "title": "JKR",
    "bodies": BODIES,
    "adhesion": {"work_of_adhesion": 0.005},
    "experiment": {"kind": "pull_off", "preload": 2.0},
}
E, W, R = 1.0, 0.005, 100.0
MARGIN = 1.25
"""Claim over the difference of the sums."""
GRID = 1e-6
"""Relative, of what is looked up between 4000 places."""


@pytest.mark.parametrize("work", [5.0, 500.0])
def test_a_contact_that_spans_its_body_is_refused(work: float) -> None:
    for kind in ("circle", "parabola"):
        body = BODIES | {"profile": {"kind": kind, "radius": 10.0}}
        with pytest.raises(SettingsError, match=r"spread over the whole body, which ends at 10 LU"):
            settings_for(scene_from_dict(SCENE | {"bodies": body, "adhesion": {"work_of_adhesion": work}}))


@dataclass(frozen=True)
class Terrace:
    """A paraboloid whose transform rises more slowly around 6 LU."""

    reach: float = math.inf

    def height(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        return x**2 / R - 0.1 * (1.0 + np.tanh((x - 6.0) / 0.7))


def test_an_edge_that_would_jump_is_refused() -> None:
    flat = AdhesiveEstimate(
        np.asarray([-1.0, 0.0]), np.asarray([0.2, 0.0]), 0.0, Terrace(), 0.2, 0.2, work=W, known=20.0
    )
    with pytest.raises(SettingsError, match=r"would jump at x = (\S+) LU") as caught:
        flat.require_one_edge()
    at = float(str(caught.value).partition("x = ")[2].split()[0])
    x = np.array([0.97, 1.0, 1.03]) * at
    before, there, beyond = Terrace().height(x) - np.sqrt(2.0 * math.pi * W * x / E)
    assert max(before, beyond) < there  # where h begins to fall again
    replace(estimate()).require_one_edge()


def estimate() -> AdhesiveEstimate:
    found = settings_for(scene_from_dict(SCENE)).estimate
    assert isinstance(found, AdhesiveEstimate)
    return found


def test_the_estimate_is_jkrs() -> None:
    found = estimate()
    assert found.pull_off_force() == pytest.approx(1.5 * math.pi * W * R, rel=GRID)
    radius, displacement = found.fixed_grips
    wanted = (math.pi * W * R**2 / (8.0 * E)) ** (1.0 / 3.0)
    assert radius == pytest.approx(wanted, rel=1e-3)  # the least of a flat minimum between places
    assert displacement == pytest.approx(wanted**2 / R - math.sqrt(2.0 * math.pi * W * wanted / E), rel=GRID)
    a = 9.0
    d = a**2 / R - math.sqrt(2.0 * math.pi * W * a / E)
    force = 4.0 * E * a**3 / (3.0 * R) - math.sqrt(8.0 * math.pi * E * W * a**3)
    assert found.contact_force(d) == pytest.approx(force, abs=GRID * found.pull_off_force())
    assert found.half_width(d, 0.0) == pytest.approx(a, rel=GRID)


def test_particles_let_go_from_the_edge_inwards_and_the_last_ones_together() -> None:
    found = estimate()
    x = 0.2 * (np.arange(60) + 0.5)
    cells = found.cells(x, scene_from_dict(SCENE).bodies)
    displacement = cells.heights - cells.hold  # at which nothing of a cell is held
    radius, last = found.fixed_grips
    inner = x + 0.1 < radius
    assert displacement[inner] == pytest.approx(last, rel=GRID)
    assert (np.diff(displacement[~inner]) > 0.0).all()
    shares = cells.shares(np.linspace(last + 1e-6, 0.5, 200))
    assert (np.diff(shares, axis=0) >= -1e-12).all()  # a deeper plate holds more
    assert (np.diff(shares, axis=1) <= 1e-12).all()  # and no particle more than the one inside
    assert ((shares >= 0.0) & (shares <= 1.0)).all()
    assert ((shares > 0.0) & (shares < 1.0)).sum(axis=1).max() <= 1


@pytest.mark.parametrize("particles", [118, 120, 121])
def test_what_cells_leave_open_is_their_sum_beside_jkr(particles: int) -> None:
    """F_A of the particles' own places, the largest tension of the sum over their cells, against 3π W R/2."""
    bodies = BODIES | {"particles": particles, "spacing": 0.7, "bulk_stiffness": 0.7}
    scene = scene_from_dict(SCENE | {"bodies": bodies})
    settings = settings_for(scene)
    found = settings.estimate
    assert isinstance(found, AdhesiveEstimate)
    x = 0.7 * (np.arange(particles) - 0.5 * (particles - 1))
    cells = found.cells(x, scene.bodies)
    places = np.linspace(found.fixed_grips[1], found.displacement_at(0.0), 20_001)
    tension = -min(float(part.min()) for part in (cells.forces(some, 0.7) for some in np.array_split(places, 20)))
    exact = 1.5 * math.pi * W * R
    left = left_by_cells(scene, settings)
    assert left["adhesion_force"] == pytest.approx(MARGIN * abs(tension - exact), rel=0.1, abs=2e-5 * exact)
    assert 0.0 < left["adhesion_force"] < 0.02 * exact
    auto = scene_from_dict(SCENE | {"bodies": bodies | {"particles": "auto"}})
    wider = left_by_cells(auto, settings_for(auto))
    assert all(wider[name] >= 0.999 * value for name, value in left.items() if particles % 2 == 0)


@pytest.mark.parametrize(
    ("spacing", "particles", "phase"),
    [
        (1.0, "auto", 0.0),
        (1.5, "auto", 0.0),
        (1.5, "auto", 0.25),
        (3.0, "auto", 0.0),
        (2.0, "auto", 0.0),
        (2.0, "auto", 0.25),
        (2.0, "auto", 0.5),
        (0.3, 121, 0.0),
        (1.0, 121, 0.0),
        (3.0, 120, 0.5),
    ],
)
def test_the_claim_covers_where_the_sum_over_cells_has_its_largest_tension(
    spacing: float, particles: Any, phase: float
) -> None:
    """Wherever the apex of a chain "auto" stands: a_cr beside JKR's (9π W R²/8E)^(1/3), F_A beside 3π W R/2."""
    bodies = BODIES | {"spacing": spacing, "bulk_stiffness": spacing, "particles": particles}
    scene = scene_from_dict(SCENE | {"bodies": bodies})
    settings = settings_for(scene)
    found = settings.estimate
    assert isinstance(found, AdhesiveEstimate)
    cells = found.cells(spacing * (np.arange(-60.0, 61.0) + phase), scene.bodies)

    def force(d: float) -> float:
        return float(cells.forces(np.asarray([d]), spacing)[0])

    places = np.linspace(found.fixed_grips[1], found.displacement_at(0.0), 2001)
    near, step = places[int(np.argmin(cells.forces(places, spacing)))], places[1] - places[0]
    top = minimize_scalar(force, bounds=(near - step, near + step), method="bounded", options={"xatol": 1e-10})
    left = left_by_cells(scene, settings)
    error = abs(found.half_width(float(top.x), 0.0) - (9.0 * math.pi * W * R**2 / (8.0 * E)) ** (1.0 / 3.0))
    assert error <= left["critical_radius"] < 0.25 * spacing
    assert abs(-top.fun - 1.5 * math.pi * W * R) <= left["adhesion_force"]


def test_rows_of_a_pull_go_from_zero_force_to_just_before_fixed_grips() -> None:
    found = estimate()
    zero, last = found.displacement_at(0.0), found.fixed_grips[1]
    rows = pulling_rows(zero, last)
    assert np.diff(rows) == pytest.approx((last - zero) / rows.size, rel=1e-6)
    assert 0.0 < rows[-1] - last < 1e-6 * (zero - last)
    assert zero + (last - zero) / rows.size == pytest.approx(rows[0], rel=1e-6)
