"""Claim: the friction of a slide is what cantilever, drag and inertia of what moves leave of it, whatever their sizes.

A plate and its particles swing about the drive, V = v + A ω cos ωt, against a constant friction f; then the cantilever
pulls with f + (M + N m) V′ + (c + N γ)(V − v).
"""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.experiments.motion import motion_of
from contact1d.workflow.model.dynamics import DriveLeg

FRICTION, NORMAL, STIFFNESS = 0.7, 2.0, 1.3
COUNT, MASS, DRAG, PLATE_MASS, PLATE_DRAG = 3, 0.4, 0.3, 2.5, 1.7
VELOCITY, SWING, OMEGA = 0.5, 0.1, 0.9
ROWS, STEPS, STEP = 200, 10, 0.01
SAMPLED = 1e-4
"""Of the friction: the means of every fifth step, made the trapezoid rule, are off by (ω 5Δt)²/12."""

LEGS = (DriveLeg(ROWS, STEPS, VELOCITY, STEP), DriveLeg(ROWS, STEPS, -2.0 * VELOCITY, STEP))
SCENE: Any = SimpleNamespace(
    bodies=SimpleNamespace(mass=MASS, own_spacing=0.5, spacing=1.0),
    the=lambda kind: SimpleNamespace(stiffness=STIFFNESS),
    noise=None,
)
SETTINGS: Any = SimpleNamespace(
    chains=SimpleNamespace(upper=COUNT),
    motion=SimpleNamespace(
        time_step=STEP, plate_mass=PLATE_MASS, plate_damping=PLATE_DRAG, damping=DRAG, drive=LEGS, settle_time=1.0
    ),
)


def states(legs: int) -> list[Any]:
    """At the start and after each load step of the first legs; the means are those of every fifth step so far."""
    total = legs * ROWS * STEPS
    time = STEP * np.arange(total + 1)
    drive = np.where(np.arange(total + 1) > ROWS * STEPS, LEGS[1].velocity, LEGS[0].velocity)
    speed = SWING * OMEGA * np.cos(OMEGA * time)  # relative to the drive
    place = np.concatenate([[0.0], np.cumsum(STEP * drive[1:])]) + SWING * np.sin(OMEGA * time)
    push = -SWING * OMEGA**2 * np.sin(OMEGA * time)
    pull = FRICTION + (PLATE_MASS + COUNT * MASS) * push + (PLATE_DRAG + COUNT * DRAG) * speed
    found = []
    for step in range(0, total + 1, STEPS):
        motion = dict.fromkeys(("cantilever_kinetic", "c_measuring_energy", "vcm(plate,z)"), 0.0) | {
            "f_cantilever_means[1]": pull[: step + 1 : 5].mean(), "f_cantilever_means[2]": 0.0,
            "f_cantilever_means[3]": 0.0, "vcm(plate,x)": drive[step] + speed[step],
            "vcm(upper,x)": drive[step] + speed[step], "xcm(upper,x)": 7.0 + place[step],
        }  # fmt: skip
        shear = np.full(2, -FRICTION)
        found.append(
            SimpleNamespace(
                motion=motion, plate_x=place[step], displacement=0.1, force=NORMAL, cantilever_force=pull[step],
                step=step, profile=SimpleNamespace(shear=shear),
            )
        )  # fmt: skip
    return found


def test_the_impulse_of_the_friction_is_what_pull_drag_and_inertia_leave() -> None:
    series = motion_of(SCENE, SETTINGS, NORMAL, states(1)).series
    time = STEP * STEPS * np.arange(ROWS + 1)
    assert series["time"] == pytest.approx(time)
    assert series.integrals["friction"] == pytest.approx(FRICTION * time, abs=SAMPLED * FRICTION * time[-1])
    assert series["friction"] == pytest.approx(np.full(ROWS + 1, FRICTION))
    assert series["drive"] == pytest.approx(VELOCITY * time)


def test_each_leg_that_has_begun_has_its_load_steps_and_its_start() -> None:
    both = states(2)
    for kept, lengths in ((ROWS + 1, [ROWS + 1]), (ROWS + 2, [ROWS + 1, 2]), (2 * ROWS + 1, [ROWS + 1, ROWS + 1])):
        legs = motion_of(SCENE, SETTINGS, NORMAL, both[:kept]).legs
        assert [len(series) for _, series in legs] == lengths
        assert [velocity for velocity, _ in legs] == [leg.velocity for leg in LEGS[: len(lengths)]]
        assert legs[-1][1]["plate_x"][-1] == pytest.approx(both[kept - 1].plate_x)
