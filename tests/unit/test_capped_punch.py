"""A cylindrical punch whose end is a paraboloid: g = x²/R up to the edge b, partial and full contact.

F = 2E*(a d − a³/3R), in full contact with a = b and any d from b²/R − Δl(b) on, Δl = √(2πbW/E*), and
p(0) = (E*/π)(a/R + d/a).
"""

import math
from typing import Any

import numpy as np
import pytest

from contact1d import run

E, B, R, TOLERANCE = 1e6, 2e-6, 40e-6, 1e-3
"""E* [Pa], radius of the punch and of curvature [m], the default tolerance."""
RISE = B**2 / R
"""Transformed height at the edge [m]."""


def force(a: Any, d: Any) -> Any:
    """F [N] of contacts."""
    return 2.0 * E * (a * d - a**3 / (3.0 * R))


def results(**tables: Any) -> dict[str, Any]:
    """Of a punch in SI, with [experiment] and other tables."""
    profile = {"kind": "capped_punch", "radius": f"{B} m", "cap_radius": f"{R} m"}
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile}
    scene = {"title": "capped punch", "bodies": bodies, "material": {"contact_modulus": f"{E} Pa"}}
    return dict(run(scene | tables).results)


def assert_within(found: dict[str, Any], exact: dict[str, float]) -> None:
    """Within the uncertainty, which is within the tolerance."""
    for name, value in exact.items():
        assert abs(found[name].value - value) <= found[name].uncertainty <= TOLERANCE * abs(value), name


@pytest.mark.parametrize("share", [0.2, 0.99, 1.0, 1.01, 3.0])
def test_a_punch_is_pressed_up_to_its_edge_and_beyond(share: float) -> None:
    d = share * RISE
    a = min(B, math.sqrt(R * d))
    found = results(experiment={"kind": "load", "force": f"{force(a, d)!r} N"})
    assert_within(found, {"displacement": d, "contact_radius": a, "central_pressure": E / math.pi * (a / R + d / a)})
    assert "peak_pressure" not in found


@pytest.mark.parametrize("share", [0.3, 1.6, 2.2, 3.0, 6.0])
def test_the_edge_of_an_adhesive_contact_stays_at_the_flank_until_f_a_or_leaves_before(share: float) -> None:
    """F_A is that of a contact inside up to Δl = 4/3 of the height at the edge, and bodies part at once from 4 on."""
    work = E * (share * RISE) ** 2 / (2.0 * math.pi * B)
    a = np.linspace(1e-4, 1.0, 200001) * B
    opened = a**2 / R - np.sqrt(2.0 * math.pi * a * work / E)
    least = int(np.argmin(force(a, opened)))
    preload = {"kind": "pull_off", "preload": f"{force(B, 2.0 * RISE)!r} N"}
    found = results(adhesion={"work_of_adhesion": f"{work!r} J/m^2"}, experiment=preload)
    assert_within(found, {"adhesion_force": -force(a, opened)[least], "critical_radius": a[least]})
    assert (least == a.size - 1) == (share > 4.0 / 3.0)
