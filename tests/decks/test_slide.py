"""Claim: a slide balances: what pulls the plate is the friction it reports and the drag on what moves.

Over a while of sliding, M_all the mass of plate and particles and c_all the drag on them, against what moves at v,

    c ⟨v t − X⟩ = ⟨friction⟩ + c_all ⟨V − v⟩ + M_all (V_end − V_begin)/T,

with c, v and every drag as the scene says them, and X the place of the plate. The friction is measured by another way:
it is the sum of the lower body's forces on the upper particles.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from contact1d import Run, RunError, run
from tests.scenes import chains

PARTICLES, DRAG, PLATE_DRAG, MASS, PLATE_MASS = 30, 0.3, 20.0, 1.0, 30.0
STIFFNESS, VELOCITY, DISTANCE = 20.0, 0.05, 6.0
SPLINE = 2e-4
"""Relative: a cubic spline through five rows beside the polynomial that the program takes."""
BALANCE = 0.015
"""Of the static friction: rows, of whose ends the means are made here, and the drag of particles that swing."""


ENERGY = 5e-3
"""Over the work: means of every fifth step."""


def sliding(**changes: Any) -> dict[str, Any]:
    """A sticky curved body on a flat one; `changes` replace whole tables."""
    tables: dict[str, Any] = {
        "bodies": {"particles": 44, "upper_particles": PARTICLES, "mass": MASS},
        "horizontal": {},
        "damping": {"coefficient": DRAG},
        "plate": {"free": ["x", "z"], "mass": PLATE_MASS, "damping": PLATE_DRAG},
        "cantilever": {"stiffness": STIFFNESS, "velocity": VELOCITY},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": DISTANCE},
    }
    return chains(30.0, 2.0, (1.0, 0.5, 0.5, 1.0), title="slide", **tables | changes)


@pytest.fixture(scope="module")
def slid() -> Run:
    return run(sliding())


@pytest.fixture(scope="module")
def back() -> Run:
    """A way there and, twice as fast, further back."""
    path = {"kind": "slide", "normal_force": 1.0, "path": [[0.1, 2.5], [-0.2, 4.0]]}
    return run(sliding(experiment=path))


def test_the_cantilever_pulls_as_much_as_friction_and_drag_hold_back(slid: Run) -> None:
    assert slid.friction["drive"] == pytest.approx(VELOCITY * slid.friction["time"])
    half = slice(len(slid.friction["time"]) // 2, None)
    friction = balance(slid, half, VELOCITY)
    static = slid.results["static_friction"].value
    assert np.mean(slid.friction["friction"][half]) == pytest.approx(friction, abs=BALANCE * static)
    assert slid.results["mean_friction"].value > 0.0


def balance(done: Run, rows: slice, velocity: float) -> float:
    """The mean friction that pull, drag and inertia leave over some rows."""
    time, place, drive = (done.friction[name] for name in ("time", "plate_x", "drive"))
    speed, while_ = np.gradient(place, time)[rows], float(np.ptp(time[rows]))
    pull = STIFFNESS * float(np.mean((drive - place)[rows]))
    drag = (PARTICLES * DRAG + PLATE_DRAG) * (float(place[rows][-1] - place[rows][0]) / while_ - velocity)
    return pull - drag - (PARTICLES * MASS + PLATE_MASS) * float(speed[-1] - speed[0]) / while_


def test_energy_is_dissipated_or_stored(slid: Run, back: Run) -> None:
    for done, near in ((slid, 1e-3), (back, ENERGY)):
        work, lost, stored = (
            done.results[name].value for name in ("cantilever_work", "dissipated_energy", "stored_energy")
        )
        assert lost + stored == pytest.approx(work, rel=near)
        assert lost > 0.0


def test_a_way_there_and_back_is_driven_leg_by_leg(back: Run) -> None:
    """The cantilever's work is ∫ F v dt."""
    time, drive, pull = (back.friction[name] for name in ("time", "drive", "cantilever_force"))
    turn = int(np.argmax(drive))
    assert (time[turn], drive[turn]) == pytest.approx((25.0, 2.5))
    assert (time[-1], drive[-1]) == pytest.approx((45.0, -1.5))
    work = np.trapezoid(np.where(time <= 25.0, 0.1, -0.2) * pull, time)
    assert back.friction["cantilever_work"][-1] == back.results["cantilever_work"].value
    assert back.results["cantilever_work"].value == pytest.approx(work, rel=0.05)
    last, friction = slice(turn + 40, None), back.friction["friction"]
    largest = float(np.abs(friction).max())
    assert np.mean(friction[last]) == pytest.approx(balance(back, last, -0.2), abs=BALANCE * largest)
    assert back.results["mean_friction"].value > 0.0  # against the way


def test_a_plate_that_falls_behind_the_drive_does_not_slide_steadily(tmp_path: Path) -> None:
    """One that swings for longer than the way is named as why: 2π √((M + N m)/k)."""

    def failure(**changes: Any) -> str:
        with pytest.raises(RunError) as caught:
            run(sliding(**changes), tmp_path / "run", figures=False)
        return str(caught.value)

    said = failure(
        plate={"free": ["x", "z"], "mass": 60.0, "damping": 0.1}, damping={"coefficient": 0.02},
        cantilever={"stiffness": 0.25, "velocity": 0.2},
        experiment={"kind": "slide", "normal_force": 0.0, "distance": DISTANCE},
    )  # fmt: skip
    plate, drive = re.findall(r"the plate moves at (\S+) LU/TU and the drive at (\S+?)\. ", said)[0]
    assert float(plate) < 0.9 * float(drive) == 0.9 * 0.2
    assert f"has a period of {2.0 * np.pi * np.sqrt((60.0 + PARTICLES) / 0.25):.3g} TU" in said
    short = failure(experiment={"kind": "slide", "normal_force": 1.0, "distance": 2.5})
    assert "has 2 whole periods of the spacing, and a mean needs 3" in short


def test_a_drive_is_too_fast_above_the_velocity_that_is_told() -> None:
    """s √(k/m)/2π, k the smaller stiffness."""
    bodies = sliding()["bodies"] | {"mass": 1.5, "bulk_stiffness_tangential": 1.2}
    limit = np.sqrt(1.2 / 1.5) / (2.0 * np.pi)
    for share, told in ((0.999, False), (1.001, True)):
        path = {"kind": "slide", "normal_force": 1.0, "path": [[share * limit, 1.0]]}
        warnings = run(sliding(experiment=path, bodies=bodies)).warnings
        assert ("fast" in warnings) == told
    assert f"Use a velocity below {limit:.3g} LU/TU" in warnings["fast"]


def test_the_static_friction_is_what_has_to_be_overcome(slid: Run) -> None:
    """The plate stands as long as the cantilever pulls less; the largest friction comes before it has slid."""
    friction, place = slid.friction["friction"], slid.friction["plate_x"]
    top = int(np.argmax(np.where(place < 1.0, friction, 0.0)))
    near = slice(top - 2, top + 3)
    between = CubicSpline(place[near], friction[near])(np.linspace(place[near][0], place[near][-1], 1001)).max()
    assert friction[top] <= slid.results["static_friction"].value
    assert slid.results["static_friction"].value == pytest.approx(between, rel=SPLINE)
    assert slid.results["static_friction"].value >= slid.results["mean_friction"].value
