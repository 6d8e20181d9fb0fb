"""Claim: uncertainties cover the errors of the numbers, and are no wider than they have to be.

Random contacts on the plane are the class `random_plane` of `validation.hard`; here are coarse paths of JKR's contact,
whose steps miss much of the largest tension. Each uncertainty ÷ 3 would leave some of these errors out.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from contact1d import Run
from validation.references.indenters import jkr

SEED, SCENES, REFERENCE = 20261122, 24, 1e-8
"""Relative error of the closed forms."""
INSIDE = 0.95
"""Share of errors that lie within their uncertainty."""
R, W = 100.0, 0.005


@pytest.mark.parametrize("steps", [10, 23, 60, 150])
def test_coarse_steps_of_a_path_are_in_the_uncertainty(run_tables: Callable[[dict[str, Any]], Run], steps: int) -> None:
    bodies = {
        "particles": "auto", "spacing": 0.1, "reduction": "mdr", "lower": "rigid_plane",
        "profile": {"kind": "parabola", "radius": R}, "bulk_stiffness": 0.1,
    }  # fmt: skip
    path = {"kind": "path", "displacements": {"from": 0.3, "to": -0.2, "steps": steps, "return": False}}
    scene = {"title": "JKR", "bodies": bodies, "adhesion": {"work_of_adhesion": W}, "experiment": path}
    results, exact = run_tables(scene).results, jkr(R, 1.0, W)
    for name, value in (("adhesion_force", exact.pull_off_force()), ("zero_load_radius", exact.zero_load_radius())):
        if name in results:  # ten steps pass F = 0 between a contact and none
            assert abs(results[name].value - value) <= results[name].uncertainty, name
