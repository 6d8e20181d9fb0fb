"""Claim: a real contact in real units gives the right pressure p(r) at default settings, within 1 %.

Reference: the profile's slope by quadrature (`validation.references.mdr`), of a punch p = F/2πa √(a² − r²). The
measured profile is a sphere's, read from a file in µm, without noise. The same scenes with the paper's reduction are
refused, or carry the factor.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import SceneError, read_scene, run
from validation.references.mdr import ReducedContact

REACHED = 2e-4
"""Relative, of a and p(0): the lattice of some fifty particles; measured 2e-5."""
PRESSURE = 2e-4
"""Relative, of p(r) inside 0.95 a: the same; measured 3e-5."""
MODULUS = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
"""E* of steel on glass [Pa]."""
LENGTH, LOAD = 1e-6, 10.0
"""One LU [m], F [N]."""
SLOPES: dict[str, tuple[dict[str, Any], float, Callable[[float], float]]] = {
    "cone": ({"kind": "cone", "slope": 0.05}, 1.0, lambda r: 0.05),
    "flat punch": ({"kind": "flat_punch", "radius": 100.0}, 2.0, lambda r: 0.0),
    "ellipsoid": (
        {"kind": "ellipsoid", "radius": 6000.0, "height": 2000.0}, 3.0,
        lambda r: 2e-3 * r / (6e-3 * math.sqrt(6e-3**2 - r**2)),
    ),
    "measured": ({"kind": "table", "file": "lens.csv"}, 2.0, lambda r: r / 5e-3),
}  # fmt: skip
"""Profile and spacing [LU], and f′(r) of r [m]."""


def hertz(radius: float) -> float:
    """a [m]."""
    return float((0.75 * LOAD * radius / MODULUS) ** (1.0 / 3.0))


def tables(profile: dict[str, Any], spacing: float, **bodies: Any) -> dict[str, Any]:
    plane = {"particles": "auto", "bulk_stiffness": "auto", "lower": "rigid_plane"}
    steel, glass = {"youngs_modulus": 210e9, "poisson_ratio": 0.3}, {"youngs_modulus": 70e9, "poisson_ratio": 0.22}
    return {
        "title": "Steel on glass",
        "bodies": plane | {"spacing": spacing, "profile": profile} | bodies,
        "material": {"upper": steel, "lower": glass, "length_unit": LENGTH, "force_unit": 1.0},
        "experiment": {"kind": "load", "force": LOAD},
    }


@pytest.mark.parametrize("name", SLOPES)
def test_pressure_in_si_is_that_of_the_closed_form(name: str, tmp_path: Path) -> None:
    """pressure_3d.csv, from the axis (of a cone from its first particle) to 0.95 a."""
    profile, spacing, slope = SLOPES[name]
    body = ReducedContact(slope, MODULUS)
    punch = name == "flat punch"
    a = 1e-4 if punch else brentq(lambda a: body.force(a) - LOAD, 1e-6, 3e-3)

    def exact(place: float) -> float:
        if punch:
            return LOAD / (2.0 * math.pi * a * math.sqrt(a**2 - place**2))
        return body.pressure(max(place, 1e-4 * a), a)

    rows = [f"{r},{r**2 / 10000.0}" for r in np.arange(0.0, 300.0, 5.0)]  # in µm, of R = 5 mm
    (tmp_path / "lens.csv").write_text("\n".join(["r,z", *rows]) + "\n")
    scene = read_scene(tables(profile, spacing), folder=tmp_path)
    r, pressure = np.loadtxt(
        run(scene, tmp_path / "run", figures=False).folder / "pressure_3d.csv",
        delimiter=",", skiprows=1, usecols=(0, 1), unpack=True,
    )  # fmt: skip
    inside = r < 0.95 * a
    assert inside.sum() > 15
    assert pressure[inside] == pytest.approx([exact(place) for place in r[inside]], rel=PRESSURE)
    with pytest.raises(SceneError, match="was derived for two equal spheres"):
        read_scene(tables(profile, spacing, reduction="geike_popov"), folder=tmp_path)


def test_the_reduction_of_the_paper_carries_the_factor(tmp_path: Path) -> None:
    """Of two equal spheres."""
    R = 10e-3
    asked = tables({"kind": "parabola", "radius": R / LENGTH}, 2.0, reduction="geike_popov")
    found = run(asked, tmp_path / "run", figures=False)
    image, own, peak = (found.results[key].si for key in ("image_contact_radius", "contact_radius", "peak_pressure"))
    assert image is not None
    assert own is not None
    assert peak is not None
    assert f"{image.value / hertz(R):.4g} times its contact radius" in found.warnings["reduction"]
    a = hertz(0.5 * R)
    assert own.value == pytest.approx(a, rel=REACHED)
    assert peak.value == pytest.approx(1.5 * LOAD / (math.pi * a**2), rel=REACHED)
