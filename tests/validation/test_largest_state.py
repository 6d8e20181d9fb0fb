"""Claim: every experiment is judged by its widest contact and its largest pressure, also where the bodies end apart.

References: Hertz's impact, a² = R (15 M v²/(16 E* √R))^{2/5}, and his p(0) = 2E*a/πR.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest

from contact1d import Run, run

RADIUS, MODULUS, STRENGTH = 2e-3, 70e9 / (1.0 - 0.22**2), 50e6
NEAR = 1e-3
"""Of a radius and a pressure between the states of an impact, and of the lattice."""


def contact(experiment: dict[str, Any], **more: Any) -> Run:
    glass = {"youngs_modulus": "70 GPa", "poisson_ratio": 0.22, "yield_strength": "50 MPa"}
    profile = {"kind": "parabola", "radius": "2 mm"}
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile}
    material = {"upper": "rigid", "lower": glass}
    return run({"title": "largest", "bodies": bodies, "material": material, "experiment": experiment} | more)


def impact(velocity: float) -> tuple[Run, float]:
    """Of 0.2 g, and its largest a [m]."""
    depth = (15.0 * 2e-4 * velocity**2 / (16.0 * MODULUS * math.sqrt(RADIUS))) ** 0.4
    hit = {"kind": "impact", "velocity": f"{velocity!r} m/s"}
    return contact(hit, plate={"mass": "0.2 g", "free": ["z"]}), math.sqrt(RADIUS * depth)


def history(displacement: float) -> tuple[Run, float]:
    """In and out again."""
    points = [[f"{t} s", f"{d!r} m"] for t, d in ((0, -1e-9), (1, displacement), (2, -1e-9))]
    return contact({"kind": "history", "displacement": points}), math.sqrt(RADIUS * displacement)


def path(displacement: float) -> tuple[Run, float]:
    """To a displacement, and back to a tenth of it."""
    places = [f"{part * displacement!r} m" for part in (0.0, 0.5, 1.0, 0.1)]
    return contact({"kind": "path", "displacements": places}), math.sqrt(RADIUS * displacement)


@pytest.mark.parametrize(
    ("made", "size", "broken"),
    [
        (impact, 0.01, {"yield"}),
        (impact, 3000.0, {"yield", "slope", "body_size"}),
        (history, 0.1e-9, set()),
        (history, 60e-6, {"yield", "slope"}),
        (path, 60e-6, {"yield", "slope"}),
    ],
)
def test_the_largest_state_is_checked(
    made: Callable[[float], tuple[Run, float]], size: float, broken: set[str]
) -> None:
    done, a = made(size)
    checks = {one["name"]: one for one in done.document["validity"]}
    expected = {
        "slope": a / RADIUS,
        "body_size": a / RADIUS,
        "yield": 2.0 * MODULUS * a / (math.pi * RADIUS) / STRENGTH,
    }
    assert {name: one["value"] for name, one in checks.items()} == pytest.approx(expected, rel=NEAR)
    assert {name for name, one in checks.items() if not one["holds"]} == broken == checks.keys() & done.warnings.keys()
