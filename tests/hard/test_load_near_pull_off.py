"""Claim: a dynamic tension within the tolerance of F_A is held with a warning, and one beyond it is not held at all.

Reference: `tests.pair_lattice`, whose largest tension is F_A to round-off.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import RunError, read_scene, run
from tests.pair_lattice import PairLattice
from validation.references.interaction import Exponential, PairInteraction

TOLERANCE = 1e-3
PARTICLES, RADIUS, STIFFNESS = 40, 100.0, 0.83
LAW = PairInteraction(Exponential(0.018, 0.03), Exponential(0.009, 0.06))
"""Short against the spacing, so that a particle feels its opposite alone."""


@cache
def largest_tension() -> float:
    x = np.arange(PARTICLES) - 0.5 * (PARTICLES - 1)
    return PairLattice(LAW, STIFFNESS, x**2 / (2.0 * RADIUS)).pull_off(0.05)[0]


def scene(tension: float) -> dict[str, Any]:
    return {
        "title": f"{tension} FU",
        "bodies": {
            "particles": PARTICLES, "spacing": 1.0, "profile": {"kind": "parabola", "radius": RADIUS},
            "bulk_stiffness": STIFFNESS,
        },
        "interaction": {
            "repulsion": {"amplitude": 0.018, "range": 0.03}, "attraction": {"amplitude": 0.009, "range": 0.06},
        },
        "damping": {"coefficient": "auto"},
        "plate": {},
        "accuracy": {"tolerance": TOLERANCE},
        "experiment": {"kind": "load", "method": "dynamic", "force": -tension},
    }  # fmt: skip


@pytest.mark.parametrize("share", [0.99999, 1.00003])
def test_within_the_tolerance_a_warning_says_so(tmp_path: Path, share: float) -> None:
    try:
        found = run(read_scene(scene(share * largest_tension())), tmp_path, figures=False)
    except RunError as error:
        assert share > 1.0, error
        assert "does not sustain" in str(error)
        return
    assert "near_pull_off" in {warning["name"] for warning in found.document["warnings"]}


def test_beyond_the_tolerance_it_parts(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="does not sustain"):
        run(read_scene(scene((1.0 + 2.0 * TOLERANCE) * largest_tension())), tmp_path, figures=False)


@pytest.mark.parametrize("share", [0.5, 0.99, 0.9997])
def test_well_below_nothing_is_doubted(tmp_path: Path, share: float) -> None:
    """The last within a tolerance of it, which a refinement, run because the displacement goes with a root, tells."""
    found = run(read_scene(scene(share * largest_tension())), tmp_path, figures=False)
    assert "near_pull_off" not in {warning["name"] for warning in found.document["warnings"]}
