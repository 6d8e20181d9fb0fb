"""Claim: a largest pressure is a number only where the pressure has a bound; then it is the closed form's.

References: Hertz's p₀ = 3F/2πa²; a rim, where the slope jumps, has a pressure without bound (Shtaerman's logarithm);
bodies that points were taken from, by quadrature of the MDR (`validation.references.axisymmetric`).
"""

import math
from typing import Any

import numpy as np
import pytest

from contact1d import Run, run
from validation.hard.surfaces import Surface, kinked_body, on_plane
from validation.references.axisymmetric import Contact, with_rest_radius

R, FORCE, FLAT = 1000.0, 40.0, 10.0
"""Of a sphere [LU], a load [FU], and up to where a sphere is worn flat."""
RADII = np.linspace(0.0, 60.0, 121)
SHARP: dict[str, dict[str, Any]] = {
    "cone": {"kind": "cone", "slope": 0.02},
    "punch": {"kind": "flat_punch", "radius": 16.0},
    "capped": {"kind": "capped_punch", "radius": 16.0, "cap_radius": 1000.0},
    "worn": {"kind": "table", "r": RADII.tolist(), "z": np.maximum(0.0, (RADII**2 - FLAT**2) / (2.0 * R)).tolist()},
}


@pytest.mark.parametrize("name", SHARP)
def test_a_pressure_without_bound_has_no_largest_one(name: str) -> None:
    tables = on_plane(SHARP[name], 1.0) | {"title": name, "experiment": {"kind": "load", "force": FORCE}}
    assert "peak_pressure" not in run(tables).results


RIM, SLOPE, TOLERANCE = 10.0, 0.02, 1e-3
"""Radius at which slope or curvature jumps [LU], slope beyond it."""
FEW, MANY = 5.4, 33.3
"""Points of a table in that radius; the rim is between two."""


def of_a_table(kind: str, inside: float, adheres: bool) -> tuple[Run, dict[str, float]]:
    """A body from a table of its points, pressed to 1.7 RIM or drawn off; p(0) and the largest pressure of the body."""
    body = kinked_body(kind, RIM, SLOPE, np.random.default_rng(11))
    contact = with_rest_radius(body, 1.0, 1.4 * RIM) if adheres else Contact(body)
    a = contact.pressed_radius(0.0, RIM) if adheres else 1.7 * RIM
    load = {"kind": "load", "force": contact.force(a)}
    pull_off = {"kind": "pull_off", "preload": -2.0 * contact.force(contact.critical(RIM)) if adheres else 0.0}
    scene = Surface({}, body, RIM).sampled(RIM / inside, 6.0 * RIM).tables(RIM / 61.0, TOLERANCE)
    scene |= {"adhesion": {"work_of_adhesion": contact.work}} if adheres else {}
    found = run(scene | {"title": kind, "experiment": pull_off if adheres else load})
    return found, {"central_pressure": contact.central_pressure(a), "peak_pressure": contact.peak_pressure(a)}


@pytest.mark.filterwarnings("ignore:The occurrence of roundoff")  # the quadrature is asked for its last digits
@pytest.mark.parametrize(
    ("kind", "inside", "adheres"),
    [
        ("rounded_punch", MANY, False), ("worn_ball", MANY, False),
        ("two_radii", FEW, False), ("steps", MANY, True),
    ],
)  # fmt: skip
def test_a_pressure_of_a_table_is_within_its_uncertainty_or_null(kind: str, inside: float, adheres: bool) -> None:
    """Also where p(0) is a small difference of the pressure of the shape and the tension of the edge.

    Points that show a rounded edge give its largest pressure. Five points to a rim show as much of a steep rounding;
    more of them show the rim, and there is no number.
    """
    found, exact = of_a_table(kind, inside, adheres)
    for name in exact.keys() & found.results.keys():
        one = found.results[name]
        assert abs(one.value - exact[name]) <= one.uncertainty
        assert one.uncertainty <= TOLERANCE * abs(one.value) or name in found.warnings["tolerance"]
    if kind == "rounded_punch" and not adheres:
        assert found.results["peak_pressure"].value == pytest.approx(exact["peak_pressure"], rel=1e-3)
    if kind == "two_radii":
        assert math.isinf(exact["peak_pressure"])
        assert found.document["peak_pressure"]["value"] is found.document["peak_pressure"]["uncertainty"] is None
        assert "peak_pressure (not shown to have a bound" in found.warnings["unknown"]
    if kind == "worn_ball":
        assert "peak_pressure" not in found.document


def test_a_rim_beside_a_point_holds_as_much_as_the_body() -> None:
    """A worn tip, flat to b and a cone beyond, parts at F_A = √(8πE*Wb³)."""
    points, share, work = 44.0, 0.95, 5e-4
    body = kinked_body("land_cone", RIM, SLOPE, np.random.default_rng(11))
    scene = Surface({}, body, RIM).sampled(RIM / (points + share), 6.0 * RIM).tables(RIM / 9.3, TOLERANCE)
    scene |= {"adhesion": {"work_of_adhesion": work}, "experiment": {"kind": "pull_off", "preload": 1.0}}
    found = run(scene | {"title": "worn tip"}).results
    exact = math.sqrt(8.0 * math.pi * work * RIM**3)
    assert found["adhesion_force"].value == pytest.approx(exact, rel=1e-6)
    assert found["critical_radius"].value == pytest.approx(RIM, rel=1e-6)
