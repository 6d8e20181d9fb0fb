"""Claim: a largest pressure is a number only where the pressure has a bound; then it is the closed form's.

References: Hertz's p₀ = 3F/2πa²; a rim, where the slope jumps, has a pressure without bound (Shtaerman's logarithm).
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import run
from tests.scenes import chains

R, FORCE = 1000.0, 40.0
FLAT, OUTER = 10.0, 200.0
"""A sphere that is worn flat up to a radius, and where its profile ends [LU]."""
RADII = np.linspace(0.0, OUTER, 401)
WORN = {
    "kind": "table",
    "r": RADII.tolist(),
    "z": np.maximum(0.0, (RADII**2 - FLAT**2) / (2.0 * R)).tolist(),
}
PROFILES: dict[str, dict[str, Any]] = {
    "parabola": {"kind": "parabola", "radius": R},
    "cone": {"kind": "cone", "slope": 0.02},
    "flat_punch": {"kind": "flat_punch", "radius": 16.0},
    "worn": WORN,
}


def results(name: str, spacing: float, folder: Path) -> Any:
    bodies = {"profile": PROFILES[name], "spacing": spacing, "lower": "rigid_plane", "reduction": "mdr"}
    experiment = {"kind": "load", "force": FORCE}
    return run(chains(R, spacing, interaction=None, bodies=bodies, experiment=experiment), folder, False).results


@pytest.mark.parametrize("spacing", [1.0, 0.5])
def test_the_largest_pressure_of_a_sphere_is_hertzs(spacing: float, tmp_path: Path) -> None:
    found = results("parabola", spacing, tmp_path / "run")
    peak = 1.5 * FORCE / (math.pi * (0.75 * FORCE * R) ** (2.0 / 3.0))
    assert abs(found.peak_pressure.value - peak) <= found.peak_pressure.uncertainty


@pytest.mark.parametrize("spacing", [1.0, 0.5])
@pytest.mark.parametrize("name", ["cone", "flat_punch", "worn"])
def test_a_pressure_without_bound_has_no_largest_one(name: str, spacing: float, tmp_path: Path) -> None:
    assert "peak_pressure" not in results(name, spacing, tmp_path / "run")
