"""Claim: an incommensurate chain is pinned below, and slides freely above, the theory's threshold of its springs.

Frenkel, Kontorova and Tomlinson without springs between neighbours: particles on springs k to a common body over a
potential of largest negative curvature κ = max(−U″) are all of them in one well each for k > κ, and the body's energy
does not depend on its place; for k < κ they jump one after the other, and the friction of a slow drive is finite. κ is
that of a particle at the height that all share: on the top it presses its spring.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from contact1d import read_scene, run
from validation.references.incommensurate import threshold

LAW, LOAD = (1.0, 0.5, 0.5, 1.0), 0.2
UPPER, LOWER = 21, 34
FAST, SLOW = 2e-3, 5e-4
PINNED, FREE = 1.7, 3.5
"""⟨F⟩(v)/⟨F⟩(v/4): 1 for a friction that is finite at v = 0, 4 for one that is proportional to v."""


def friction(stiffness: float, velocity: float, folder: Path) -> float:
    """⟨F⟩ of a particle [FU]."""
    found = run(read_scene({
        "title": "Frenkel-Kontorova-Tomlinson",
        "bodies": {
            "particles": LOWER, "upper_particles": UPPER, "upper_spacing": LOWER / UPPER, "spacing": 1.0,
            "lower": "rigid_chain", "periodic": True, "profile": {"kind": "flat"}, "bulk_stiffness": 1.0,
            "bulk_stiffness_tangential": stiffness,
        },
        "interaction": {
            "repulsion": {"amplitude": LAW[0], "range": LAW[1]}, "attraction": {"amplitude": LAW[2], "range": LAW[3]},
        },
        "horizontal": {},
        "damping": {"coefficient": 0.3},
        "plate": {"free": ["x", "z"], "damping": 0.0},
        "cantilever": {"stiffness": 5.0 * UPPER, "velocity": velocity},
        "experiment": {"kind": "slide", "normal_force": LOAD * UPPER, "distance": 3.0},
    }), folder / f"{stiffness}-{velocity}", figures=False)  # fmt: skip
    return found.results["mean_friction"].value / UPPER


def test_it_changes_from_pinned_to_viscous_at_the_threshold(tmp_path: Path) -> None:
    stiffness = threshold(LAW, 1.0, LOAD, 1.0)
    assert stiffness == pytest.approx(0.1225, abs=1e-4)
    ratios = {}
    for share in (0.75, 1.6):
        fast, slow = (friction(share * stiffness, velocity, tmp_path) for velocity in (FAST, SLOW))
        ratios[share] = fast / slow
    assert ratios[0.75] < PINNED
    assert ratios[1.6] > FREE
