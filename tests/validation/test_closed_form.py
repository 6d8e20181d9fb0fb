"""Claim: where pairs are independent, a pull-off follows the closed form, and F_A, a_0 and a_cr grow as √R exactly.

Reference: `validation.references.independent_pairs`, F(G₀) = (√(2R)/s) ∫ f(G) (G − G₀)^(−1/2) dG with G = r − 2 f(r)/k,
and a = √(2R (G_m − G₀)): one integral, no chain and no minimisation (physics.md). It holds without neighbour
springs and
horizontal freedom, for interactions that end well within one spacing, and edges that are several particles wide.

What limits the tolerance. The force: the sum over particles is the trapezoidal rule of a smooth integrand, so the
lattice costs nothing once the edge is a few particles wide; left are the rows around the largest tension. The
radii: the
interpolation of the pressure between particles, about 1e-3 spacings, which shrinks against the contact as R grows.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import pytest

from contact1d import Run
from contact1d.workflow.units import Quantity
from tests.scenes import LAW, chains
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction

FORCE = 2e-6
"""Relative; measured 4e-7: table, cutoff and rows, each chosen for far less than the tolerance of 1e-3."""
RADIUS = 3e-3
"""[LU]; measured 1.2e-3 at most: interpolation between particles one spacing apart."""
REPULSION, ATTRACTION = (0.0024, 0.015), (0.0012, 0.03)
"""Energy [FU·LU] and range [LU]: at a distance of one spacing the force is 1e-13 of its largest value."""
STIFFNESS = 0.83
RADII = (2000.0, 4000.0, 8000.0)
NAMES = ("adhesion_force", "zero_load_radius", "critical_radius")


@pytest.fixture(scope="module")
def measured(run_tables: Callable[[dict[str, Any]], Run]) -> dict[float, Mapping[str, Quantity]]:
    """The quantities of a pull-off for each radius; the preload grows as √R too, though nothing depends on it."""
    return {radius: run_tables(tables(radius)).outcome.quantities for radius in RADII}


def tables(radius: float) -> dict[str, Any]:
    """The scene of one radius [LU]."""
    preload = 0.05 * float(np.sqrt(radius / RADII[0]))
    pull = {"kind": "pull_off", "method": "quasistatic", "preload": preload}
    return chains(radius, STIFFNESS, (*REPULSION, *ATTRACTION), experiment=pull)


def closed_form(radius: float) -> dict[str, float]:
    """F_A [FU], a_0 and a_cr [LU] of the integral."""
    law = PairInteraction(Exponential(*REPULSION), Exponential(*ATTRACTION))
    pairs = IndependentPairs(law, STIFFNESS, radius)
    return dict(zip(NAMES, (pairs.adhesion_force(), pairs.zero_load_radius(), pairs.critical_radius()), strict=True))


@pytest.mark.parametrize("radius", RADII)
def test_closed_form(measured: dict[float, Mapping[str, Quantity]], radius: float) -> None:
    found, exact = measured[radius], closed_form(radius)
    assert found["adhesion_force"].value == pytest.approx(exact["adhesion_force"], rel=FORCE)
    for name in NAMES[1:]:
        assert abs(found[name].value - exact[name]) < RADIUS
    for name in NAMES:
        assert abs(found[name].value - exact[name]) <= found[name].uncertainty


@pytest.mark.parametrize("radius", [64_000.0])
def test_a_coarse_law_under_a_blunt_body_is_within_the_claim(run_tables: Callable[..., Run], radius: float) -> None:
    """Hundreds of particles leave nothing to interpolation: what a short cutoff moves is all there is. Spacing 7."""
    pairs = IndependentPairs(PairInteraction(*(Exponential(*LAW[i : i + 2]) for i in (0, 2))), STIFFNESS, radius, 7.0)
    pull = {"kind": "pull_off", "preload": 0.5 * pairs.adhesion_force()}
    tables = chains(radius, STIFFNESS, bodies={"spacing": 7.0}, accuracy={"tolerance": 1e-2}, experiment=pull)
    found = run_tables(tables).results
    exact = (pairs.adhesion_force(), pairs.zero_load_radius(), pairs.critical_radius())
    for name, value in zip(NAMES, exact, strict=True):
        assert abs(found[name].value - value) <= found[name].uncertainty
