"""Claim: a slide balances: what pulls the plate is the friction it reports and the drag on what moves.

Over a while of sliding, M_all the mass of plate and particles and c_all the drag on them, against what moves at v,

    c ⟨v t − X⟩ = ⟨friction⟩ + c_all ⟨V − v⟩ + M_all (V_end − V_begin)/T,

with c, v and every drag as the scene says them, and X the place of the plate. The friction is measured by another way:
it is the sum of the lower body's forces on the upper particles.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from contact1d import Run, read_scene, run

PARTICLES, DRAG, PLATE_DRAG, MASS, PLATE_MASS = 30, 0.3, 20.0, 1.0, 30.0
STIFFNESS, VELOCITY, DISTANCE = 20.0, 0.05, 6.0
SPLINE = 2e-4
"""Relative: a cubic spline through five rows beside the polynomial that the program takes."""
BALANCE = 0.015
"""Of the static friction: rows, of whose ends the means are made here, and the drag of particles that swing."""


def sliding(**changes: Any) -> dict[str, Any]:
    """A sticky curved body on a flat one; `changes` replace whole tables."""
    return {
        "title": "slide",
        "bodies": {"particles": 44, "upper_particles": PARTICLES, "spacing": 1.0, "mass": MASS, "bulk_stiffness": 2.0,
                   "profile": {"kind": "parabola", "radius": 30.0}},
        "interaction": {"repulsion": {"amplitude": 1.0, "range": 0.5}, "attraction": {"amplitude": 0.5, "range": 1.0}},
        "horizontal": {},
        "damping": {"coefficient": DRAG},
        "plate": {"free": ["x", "z"], "mass": PLATE_MASS, "damping": PLATE_DRAG},
        "cantilever": {"stiffness": STIFFNESS, "velocity": VELOCITY},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": DISTANCE},
    } | changes  # fmt: skip


@pytest.fixture(scope="module")
def slid(tmp_path_factory: pytest.TempPathFactory) -> Run:
    return run(read_scene(sliding()), tmp_path_factory.mktemp("slide") / "run", figures=False)


def test_the_cantilever_pulls_as_much_as_friction_and_drag_hold_back(slid: Run) -> None:
    time, place, drive = (slid.friction[name] for name in ("time", "plate_x", "drive"))
    assert drive == pytest.approx(VELOCITY * time)
    half = len(time) // 2
    while_ = time[-1] - time[half]
    speed = np.gradient(place, time)
    pull = STIFFNESS * float(np.mean((VELOCITY * time - place)[half:]))
    drag = (PARTICLES * DRAG + PLATE_DRAG) * (float(place[-1] - place[half]) / while_ - VELOCITY)
    inertia = (PARTICLES * MASS + PLATE_MASS) * float(speed[-1] - speed[half]) / while_
    friction = float(np.mean(slid.friction["friction"][half:]))
    assert friction == pytest.approx(pull - drag - inertia, abs=BALANCE * slid.results["static_friction"].value)
    assert slid.results["mean_friction"].value > 0.0


def test_the_static_friction_is_what_has_to_be_overcome(slid: Run) -> None:
    """The plate stands as long as the cantilever pulls less; the largest friction comes before it has slid."""
    friction, place = slid.friction["friction"], slid.friction["plate_x"]
    top = int(np.argmax(np.where(place < 1.0, friction, 0.0)))
    near = slice(top - 2, top + 3)
    between = CubicSpline(place[near], friction[near])(np.linspace(place[near][0], place[near][-1], 1001)).max()
    assert friction[top] <= slid.results["static_friction"].value
    assert slid.results["static_friction"].value == pytest.approx(between, rel=SPLINE)
    assert slid.results["static_friction"].value >= slid.results["mean_friction"].value
