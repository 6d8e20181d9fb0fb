"""Claim: an automatic chain is long enough for stiff neighbour springs, and a given one that is not is warned of.

Reference: `validation.references.solver`, Newton's method for a chain of twice the length.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from scipy.optimize import brentq

from contact1d import read_scene, run
from contact1d.workflow.model.settings import settings_for
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver

TOLERANCE, FORCE = 1e-2, 0.5
ASKED: dict[str, Any] = {
    "title": "stiff neighbours",
    "bodies": {
        "particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": 200.0}, "bulk_stiffness": 0.83,
    },
    "interaction": {
        "repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26},
    },
    "accuracy": {"tolerance": TOLERANCE},
    "experiment": {"kind": "load", "force": FORCE},
}  # fmt: skip


def scene(neighbours: float, particles: int | str = "auto") -> dict[str, Any]:
    return ASKED | {"neighbours": {"stiffness": neighbours}, "bodies": ASKED["bodies"] | {"particles": particles}}


@pytest.mark.parametrize("ratio", [0.3, 1000.0])
def test_an_automatic_chain_is_long_enough(tmp_path: Path, ratio: float) -> None:
    outcome = run(read_scene(scene(0.83 * ratio)), tmp_path, figures=False).outcome
    law = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
    longer = 2 * len(outcome.states[-1].profile.x)
    solver = ChainSolver(ChainModel(longer, 0.83, law, radius=200.0, neighbour_stiffness=0.83 * ratio))
    found = outcome.quantities["displacement"]
    near = (found.value - 0.02, found.value + 0.02)
    start = solver.equilibrium(near[0])
    exact = brentq(lambda d: solver.equilibrium(float(d), start).force - FORCE, *near, xtol=1e-7)
    assert abs(found.value - exact) < TOLERANCE * exact
    assert "chain_end" not in outcome.warnings


def test_a_given_chain_that_ends_too_soon_is_warned_of(tmp_path: Path) -> None:
    outcome = run(read_scene(scene(830.0, 60)), tmp_path, figures=False).outcome
    assert "spread the load over 31.6 LU" in outcome.warnings["chain_end"]


def test_soft_neighbours_make_no_chain_longer() -> None:
    alone = read_scene(ASKED)
    assert settings_for(read_scene(scene(0.3))).chains.upper == settings_for(alone).chains.upper
