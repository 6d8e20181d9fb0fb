"""Claim: every row of curve.csv has an uncertainty that is right.

References: Maugis and Barquins's and JKR's F(d), Ting's convolution of a ramp, the creep of a standard solid.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import quad

import contact1d
from validation.references.impact import Adhesive
from validation.references.relaxing import Power

RADIUS, WORK = 250.0, 0.03
"""Of a body whose layer has E* = 1."""
POINTS = "force in curve.csv"


def scene(experiment: Mapping[str, Any], spacing: float = 0.7, **tables: Any) -> dict[str, Any]:
    profile = {"kind": "parabola", "radius": RADIUS}
    bodies = {"particles": "auto", "spacing": spacing, "reduction": "mdr", "lower": "rigid_plane", "profile": profile}
    return {"title": "rows", "bodies": bodies | {"bulk_stiffness": spacing}, "experiment": dict(experiment)} | tables


def inside(values: NDArray[np.float64], exact: Any, uncertainty: NDArray[np.float64], within: float) -> None:
    off, largest = np.abs(values - np.asarray(exact)), np.abs(values).max()
    assert np.all(off <= uncertainty + 1e-15 * largest)
    assert uncertainty.max() <= within * largest


@pytest.mark.parametrize(("exponent", "tolerance"), [(2.0, 1e-5), (1.0, 1e-4), (3.5, 1e-3)])
def test_an_adhesive_path_meets_its_tolerance_at_every_point(exponent: float, tolerance: float) -> None:
    """Of z ~ rⁿ, from contact to where F = 0 need not be passed."""
    profile = {"kind": "power", "exponent": exponent, "radius": "200 µm", "height": "10 µm"}
    half = {"youngs_modulus": "6 MPa", "poisson_ratio": 0.0}
    tables = scene({"kind": "path", "displacements": {"from": "20 µm", "to": "1 µm", "steps": 19}, "start": "contact"})
    tables["bodies"] |= {"spacing": "auto", "bulk_stiffness": "auto", "profile": profile}
    tables |= {"material": {"upper": half, "lower": half}, "adhesion": {"work_of_adhesion": "80 mJ/m²"}}
    run = contact1d.run(tables | {"accuracy": {"tolerance": tolerance}})
    contact = Adhesive(Power(exponent, 1e-5 / 2e-4**exponent), 0.08, 3e6)
    exact = [contact.force(contact.radius_at(float(d))) for d in run.curve["displacement"]]
    inside(run.curve["force"], exact, run.curve["force_uncertainty"], tolerance)
    assert list(run.curve)[-1] == "force_uncertainty"
    assert not any(f"{POINTS} " in one["message"].partition(". ")[0] for one in run.document["warnings"])


@pytest.mark.parametrize("kind", ["displacement", "force"])
def test_points_of_a_history(kind: str) -> None:
    share, time, most = 0.6, 1.7, {"displacement": 0.8, "force": 12.0}[kind]
    terms = {"viscoelasticity": {"terms": [{"share": share, "time": time}]}}
    run = contact1d.run(scene({"kind": "history", kind: [[0.0, 0.0], [1.0, most], [3.0, most]]}, **terms))
    scale, left = 4.0 / 3.0 * math.sqrt(RADIUS), 1.0 - share

    def relaxing(t: float) -> float:
        def rate(s: float) -> float:
            return (left + share * math.exp((s - t) / time)) * 1.5 * math.sqrt(most * s) * most

        return scale * float(quad(rate, 0.0, min(t, 1.0), epsabs=1e-13)[0])

    def creeping(t: float) -> float:
        def rate(s: float) -> float:
            return most * (1.0 + share / left * (1.0 - math.exp((s - t) * left / time)))

        return float((quad(rate, 0.0, min(t, 1.0), epsabs=1e-13)[0] / scale) ** (2.0 / 3.0))

    found, law = {"displacement": ("force", relaxing), "force": ("displacement", creeping)}[kind]
    inside(run.curve[found], [law(t) for t in run.curve["time"]], run.curve[f"{found}_uncertainty"], 2e-3)


def test_an_edge_at_a_rate_starts_at_its_own_equilibrium() -> None:
    """The largest force of a history is that of JKR at its corner, to round-off."""
    rate = {"velocity": 0.02, "exponent": 0.4}
    points = [[0.0, 0.0], [10.0, 1.3], [20.0, -0.5]]
    adhesion = {"work_of_adhesion": WORK, "rate": rate}
    found = contact1d.run(scene({"kind": "history", "displacement": points}, adhesion=adhesion)).results.peak_force
    contact = Adhesive(Power(2.0, 0.5 / RADIUS), WORK)
    exact = contact.force(contact.radius_at(1.3))
    assert abs(found.value - exact) <= found.uncertainty <= 1e-9
