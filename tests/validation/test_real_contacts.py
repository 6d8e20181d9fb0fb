"""Claim: a real contact in real units gives the right numbers at default settings: F, d, a, p(0), p(r) within 1 %.

References, in SI and written down here: Hertz, and Galin's and Sneddon's d(a), F(a), p(r) of a cone, a flat punch and a
sphere that is flattened to an ellipsoid (I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47); p(r) of the ellipsoid by
quadrature (`validation.references.mdr`). The measured profile is a sphere's, read from a file in µm, without noise.
The same scenes with the paper's reduction are refused, or carry the factor.
"""

from __future__ import annotations

import csv
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, SceneError, read_scene, run
from validation.references.mdr import ReducedContact

REACHED = 2e-4
"""Relative, of F, d, a and p(0): the lattice of some fifty particles; measured 2e-5."""
PRESSURE = 2e-4
"""Relative, of p(r) inside 0.95 a: the same; measured 3e-5."""
STEEL, GLASS = (210e9, 0.3), (70e9, 0.22)
E_STAR = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
"""[Pa]"""
LENGTH = 1e-6
"""One LU [m]."""
LOAD = 10.0
"""[N]"""


@dataclass(frozen=True)
class Contact:
    """Profile of the scene; a [m] under LOAD, d [m] of a, and p [Pa] at r [m] of a."""

    profile: dict[str, Any]
    spacing: float
    radius: float
    displacement: float
    pressure: Callable[[float], float]
    central: float | None


def root(curve: Callable[[float], float], high: float) -> float:
    """a with curve(a) = LOAD by bisection."""
    low = 0.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if curve(middle) < LOAD else (low, middle)
    return low


def sphere(radius: float) -> tuple[float, float, Callable[[float], float]]:
    """Hertz: a = (3FR/4E*)^{1/3}, d = a²/R, p = p₀ √(1 − r²/a²), p₀ = 3F/2πa²."""
    a = (0.75 * LOAD * radius / E_STAR) ** (1.0 / 3.0)
    return a, a**2 / radius, lambda r: 1.5 * LOAD / (math.pi * a**2) * math.sqrt(1.0 - (r / a) ** 2)


def cone(slope: float) -> tuple[float, float, Callable[[float], float]]:
    """F = (π/2) E* s a², d = (π/2) s a, p = (E* s/2) arcosh(a/r)."""
    a = math.sqrt(2.0 * LOAD / (math.pi * E_STAR * slope))
    return a, 0.5 * math.pi * slope * a, lambda r: 0.5 * E_STAR * slope * math.acosh(a / r)


def punch(a: float) -> tuple[float, float, Callable[[float], float]]:
    """F = 2E*ad, p = F/2πa √(a² − r²)."""
    return a, LOAD / (2.0 * E_STAR * a), lambda r: LOAD / (2.0 * math.pi * a * math.sqrt(a**2 - r**2))


def ellipsoid(b: float, c: float) -> tuple[float, float, Callable[[float], float]]:
    """b/c times Sneddon's sphere of radius c: d = (b/c) a artanh(a/c), F = (b/c) E* [(c² + a²) artanh(a/c) − ac]."""
    a = root(lambda a: b / c * E_STAR * ((c**2 + a**2) * math.atanh(a / c) - a * c), c * (1.0 - 1e-9))
    body = ReducedContact(lambda r: b * r / (c * math.sqrt(c**2 - r**2)), E_STAR)
    return a, b / c * a * math.atanh(a / c), lambda r: body.pressure(max(r, 1e-4 * a), a)


R = 10e-3
SPHERE, MEASURED = sphere(R), sphere(5e-3)
CONE, PUNCH, ELLIPSOID = cone(0.05), punch(100e-6), ellipsoid(2e-3, 6e-3)
CONTACTS = {
    "sphere": Contact({"kind": "parabola", "radius": R / LENGTH}, 2.0, *SPHERE, SPHERE[2](0.0)),
    "cone": Contact({"kind": "cone", "slope": 0.05}, 1.0, *CONE, None),
    "flat punch": Contact({"kind": "flat_punch", "radius": 100.0}, 2.0, *PUNCH, PUNCH[2](0.0)),
    "ellipsoid": Contact(
        {"kind": "ellipsoid", "radius": 6e-3 / LENGTH, "height": 2e-3 / LENGTH}, 3.0, *ELLIPSOID, ELLIPSOID[2](0.0)
    ),
    "measured": Contact({"kind": "table", "file": "lens.csv"}, 2.0, *MEASURED, MEASURED[2](0.0)),
}


def tables(contact: Contact, **bodies: Any) -> dict[str, Any]:
    upper, lower = ({"youngs_modulus": E, "poisson_ratio": nu} for E, nu in (STEEL, GLASS))
    return {
        "title": "Steel on glass",
        "bodies": {
            "particles": "auto", "spacing": contact.spacing, "profile": contact.profile, "bulk_stiffness": "auto",
            "lower": "rigid_plane",
        } | bodies,
        "material": {"upper": upper, "lower": lower, "length_unit": LENGTH, "force_unit": 1.0},
        "experiment": {"kind": "load", "force": LOAD},
    }  # fmt: skip


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With lens.csv: r and z of a sphere's paraboloid in µm, every 5 µm."""
    made = tmp_path_factory.mktemp("real")
    r = np.arange(0.0, 300.0, 5.0)
    rows = [f"{one},{one**2 / 10000.0}" for one in r]
    (made / "lens.csv").write_text("\n".join(["r,z", *rows]) + "\n")
    return made


@pytest.fixture(scope="module")
def finished(folder: Path) -> dict[str, Run]:
    return {
        name: run(read_scene(tables(contact), folder=folder), folder / name, figures=False)
        for name, contact in CONTACTS.items()
    }


@pytest.mark.parametrize("name", CONTACTS)
def test_pressure_in_si_is_that_of_the_closed_form(finished: dict[str, Run], name: str) -> None:
    """pressure_3d.csv, from the axis (of a cone from its first particle) to 0.95 a."""
    contact = CONTACTS[name]
    with (finished[name].folder / "pressure_3d.csv").open() as file:
        rows = [(float(row["r [m]"]), float(row["pressure [Pa]"])) for row in csv.DictReader(file)]
    inside = [(r, p) for r, p in rows if r < 0.95 * contact.radius]
    assert len(inside) > 15
    for r, p in inside:
        assert p == pytest.approx(contact.pressure(r), rel=PRESSURE), r / contact.radius


@pytest.mark.parametrize("name", CONTACTS)
def test_the_paper_s_reduction_is_refused_or_carries_the_factor(folder: Path, name: str) -> None:
    asked = tables(CONTACTS[name], reduction="geike_popov")
    if name != "sphere":
        with pytest.raises(SceneError, match="was derived for two equal spheres"):
            read_scene(asked, folder=folder)
        return
    found = run(read_scene(asked), folder / "paper", figures=False)
    doubt = found.warnings["reduction"]
    image, own = (found.results[key].si for key in ("image_contact_radius", "contact_radius"))
    assert image is not None
    assert own is not None
    factor = image.value / CONTACTS[name].radius
    assert f"{factor:.4g} times its contact radius" in doubt
    spheres = (0.75 * LOAD * 0.5 * R / E_STAR) ** (1.0 / 3.0)
    assert own.value == pytest.approx(spheres, rel=REACHED)
    assert found.results.peak_pressure.si is not None
    assert found.results.peak_pressure.si.value == pytest.approx(1.5 * LOAD / (math.pi * spheres**2), rel=REACHED)
