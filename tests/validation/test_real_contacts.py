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
from tests.scenes import MODULUS
from validation.references.mdr import ReducedContact

PRESSURE = 2e-4
"""Relative, of p(r) inside 0.95 a: the same; measured 3e-5."""
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
    done = run(scene)
    r, pressure = np.loadtxt(
        done.folder / "pressure_3d.csv",
        delimiter=",", skiprows=1, usecols=(0, 1), unpack=True,
    )  # fmt: skip
    inside = r < 0.95 * a
    assert inside.sum() > 15
    assert pressure[inside] == pytest.approx([exact(place) for place in r[inside]], rel=PRESSURE)
    with pytest.raises(SceneError, match="was derived for two equal spheres"):
        read_scene(tables(profile, spacing, reduction="geike_popov"), folder=tmp_path)
