"""Claim: on the rigid plane the force of a paraboloid and of a cone goes to the 3D indenter's as spacing².

Reference. With springs c = E* per length under the transformed profile g, F = ∫ E* (d − g) dx and g(a) = d are Galin's
and Sneddon's (I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47). z = q rⁿ: d = κ_n q aⁿ, F = 2n/(n+1) E* a d. Circle:
d = a artanh(a/R), F = E* [(R² + a²) artanh(a/R) − aR]. Flat punch: F = 2E* a d. The forms are written down here.

The lattice. F is a sum over particles in place of the integral, at N = 2m even places x = ±s/2, ±3s/2 …: exact to
1e-6 against that sum. Against the integral its error comes from the edge, where the pressure has a kink of slope
E* g′(a): −(1/2) g′(a) E* s² B₂ for each, B₂ = t² − t + 1/6, between −1/12 and 1/6, t the place of the edge between two
particles; and from the apex where that is one: there the places are half a spacing off, so that the cone's is B₂(1/2) =
−1/12 on either side, against t at the edge. So |F_lattice − F| ≤ E* s² [g′(a)/6 + g′(0)/12] and the rate is 2.

Geike and Popov's reduction: the profile as drawn, c = E*/2. Force and displacement are Hertz's of two equal spheres.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run
from contact1d.workflow.scene import scene_from_dict

RunTables = Callable[[dict[str, Any]], Run]
Array = NDArray[np.float64]

FORCE = 1e-6
"""Relative, against the sum over particles: the minimiser stops at 1e-6 of the deepest one's force."""
PLACE = 1e-4
"""Of the spacing: residual forces of 1e-6 of the deepest particle's, over the pressure's slope; measured 2e-5."""
MARGIN = 1.02
"""Over the bound of the lattice's error: its next order, s³ g″(a)."""
TABLE = 2e-5
"""Relative: 400 monotone cubics in place of the parabola."""
RATE = 0.02
"""Of the exponent; measured 2e-3: the edge and, of a cone, the ratio of the two kinks change by the way."""
CONSTANT = 0.02
"""Relative, of the root mean square over a period of the edge; measured 5e-3: OFFSETS points."""
SI_NUMBERS = 1e-12
"""Relative: the same forces times a unit."""
STIFFNESS = 0.5
OFFSETS = 32
DEPTHS = (0.3, 1.1, 2.0)


@dataclass(frozen=True)
class Indenter:
    """A profile; its transform g, slope g′(x), contact radius a(d) and force F(a, d) over E* [LU², LU]."""

    tables: dict[str, Any]
    transform: Callable[[Array], Array]
    slope: Callable[[float], float]
    radius: Callable[[float], float]
    force: Callable[[float, float], float]


def galin(n: float) -> float:
    """κ_n = (√π/2) n Γ(n/2)/Γ((n+1)/2)."""
    return 0.5 * math.sqrt(math.pi) * n * math.gamma(0.5 * n) / math.gamma(0.5 * (n + 1.0))


def power(tables: dict[str, Any], q: float, n: float) -> Indenter:
    """z = q rⁿ."""
    k = galin(n) * q
    return Indenter(
        tables,
        lambda x: k * np.abs(x) ** n,
        lambda x: n * k * x ** (n - 1.0),
        lambda d: (d / k) ** (1.0 / n),
        lambda a, d: 2.0 * n / (n + 1.0) * a * d,
    )


INDENTERS = {
    "parabola": power({"kind": "parabola", "radius": 400.0}, 1.0 / 800.0, 2.0),
    "cone": power({"kind": "cone", "slope": 0.05}, 0.05, 1.0),
}


def on_plane(run_tables: RunTables, profile: dict[str, Any], displacements: Array, spacing: float = 1.0) -> Run:
    """One chain with the MDR; the layer has STIFFNESS per LU, whatever the spacing."""
    return run_tables(
        {
            "bodies": {
                "particles": "auto",
                "spacing": spacing,
                "profile": profile,
                "reduction": "mdr",
                "bulk_stiffness": STIFFNESS * spacing,
                "lower": "rigid_plane",
            },
            "experiment": {"kind": "path", "displacements": displacements.tolist()},
        }
    )


SPACINGS = np.array([4.0, 2.0, 1.0, 0.5])


@pytest.mark.parametrize("name", ["parabola", "cone"])
def test_convergence_towards_the_closed_form(run_tables: RunTables, name: str) -> None:
    """At each spacing the displacements move the edge, near 40 LU, through one spacing."""
    indenter, edge = INDENTERS[name], 40.0
    spread = []
    for spacing in SPACINGS:
        edges = edge + spacing * ((np.arange(OFFSETS) + 0.5) / OFFSETS - 0.5)
        depths = indenter.transform(edges)
        states = on_plane(run_tables, indenter.tables, depths, float(spacing)).outcome.states
        closed = np.array([STIFFNESS * indenter.force(a, d) for a, d in zip(edges, depths, strict=True)])
        error = np.array([state.force for state in states]) / closed - 1.0
        bound = STIFFNESS * spacing**2 * (indenter.slope(edge + spacing) / 6.0 + indenter.slope(1e-12) / 12.0)
        assert np.all(np.abs(error * closed) < MARGIN * bound)
        spread.append(float(np.sqrt(np.mean(error**2))))
    rate = float(np.polyfit(np.log(SPACINGS), np.log(spread), 1)[0])
    assert rate == pytest.approx(2.0, abs=RATE)
    # B₂ at both edges, root mean square 1/√180; besides, at a cone's apex, B₂(1/2) = −1/12
    kink, apex = indenter.slope(edge), indenter.slope(1e-12)
    squares = (kink / math.sqrt(180.0)) ** 2 + (apex / 12.0) ** 2
    expected = 0.5**2 * math.sqrt(squares) / indenter.force(edge, float(indenter.transform(np.array([edge]))[0]))
    assert spread[-1] == pytest.approx(expected, rel=CONSTANT)


# Geike and Popov's reduction in SI, springs from E and ν.

YOUNG, LENGTH, FORCE_UNIT, RADIUS = 3e9, 1e-6, 1e-3, 2000.0


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5])
@pytest.mark.parametrize("lower", ["rigid_plane", "particles"])
def test_geike_and_popov_is_hertz_of_two_equal_spheres(run_tables: RunTables, nu: float, lower: str) -> None:
    """F = (4/3) E* √(R/2) d^{3/2}, E* = E/2(1 − ν²), d the approach; within the lattice's error.

    The half-width of the image is √(2Rd), twice Hertz's √(Rd/2), which is reported beside it. With particles as the
    lower body, the springs alone are read: k/2 in series under the profile as drawn, at touch with the stiffness of the
    material.
    """
    body = {"youngs_modulus": YOUNG, "poisson_ratio": nu}
    tables: dict[str, Any] = {
        "bodies": {"particles": "auto", "spacing": 1.0, "profile": {"kind": "parabola", "radius": RADIUS},
                   "reduction": "geike_popov", "bulk_stiffness": "auto", "lower": lower},
        "material": {"upper": body, "lower": body, "length_unit": LENGTH, "force_unit": FORCE_UNIT},
        "experiment": {"kind": "path", "displacements": [1.0]},
    }  # fmt: skip
    modulus = YOUNG / (2.0 * (1.0 - nu**2))
    if lower == "particles":
        tables |= {"title": "springs", "interaction": {"repulsion": {"amplitude": 1.0, "range": 0.1}}}
        spring = scene_from_dict(tables).bulk_stiffness * FORCE_UNIT / LENGTH
        assert 0.5 * spring / LENGTH == pytest.approx(0.5 * modulus, rel=SI_NUMBERS)
        return
    results = run_tables(tables).document
    d, radius = 1.0 * LENGTH, RADIUS * LENGTH
    hertz = 4.0 / 3.0 * modulus * math.sqrt(0.5 * radius) * d**1.5
    a = math.sqrt(2.0 * radius * d)
    lattice = 0.5 * modulus * LENGTH**2 * (a / radius) / 6.0
    si = results["largest_force"]["si"]
    assert si["unit"] == "N"
    assert si["value"] == pytest.approx(hertz, abs=MARGIN * lattice + FORCE * hertz)
    assert lattice < 1e-4 * hertz
    assert results["image_largest_radius"]["si"]["value"] == pytest.approx(a, abs=PLACE * LENGTH)
    assert results["largest_radius"]["si"]["value"] == pytest.approx(0.5 * a, abs=PLACE * LENGTH)
    assert [warning["name"] for warning in results["warnings"]] == ["reduction"]
    assert results["reduction"] == "geike_popov"
