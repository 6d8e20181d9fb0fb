"""Claim: on a rigid plane the program gives the discrete sum of one-sided springs, which converges to Hertz as s².

References: F = Σ k max(0, d − x_i²/2R), written out here; F = (4√2/3) c_n √R d^{3/2}, c_n = k/s (Section 2 of the
paper); for neighbour springs the exact complementarity solver of `analysis.reference`. Limits: the minimiser's
threshold; the lattice; with neighbour springs the stiffness of the plane, which is finite then.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from analysis.curve import read_curve
from analysis.reference.model import ChainModel
from analysis.reference.solver import ChainSolver
from analysis.reference.winkler import winkler_force
from tests.validation.conftest import RunTables

EXACT = 1e-6  # asked by the issue; reached: about 1e-8, the threshold of the minimiser
RATE = 2.0  # Euler and Maclaurin: a sum over a lattice misses s²/12 times the jump of slope at each edge of the contact
RATE_ERROR = 0.25  # the constant changes with the edge's place between two particles; few depths give its envelope
PLANE_SHARE = 1e-3  # tolerance of the scene, at which the plane is 1/tolerance times stiffer than the chain


def tables(radius: float, spacing: float, layer: float, depths: list[float], **more: Any) -> dict[str, Any]:
    return {
        "bodies": {
            "particles": "auto",
            "spacing": spacing,
            "profile": {"kind": "parabola", "radius": radius},
            "bulk_stiffness": layer * spacing,
            "lower": "rigid_plane",
        },
        "experiment": {"kind": "path", "displacements": depths},
    } | more


def measured(run_tables: RunTables, *arguments: Any, **more: Any) -> tuple[np.ndarray, np.ndarray, int]:
    finished = run_tables(tables(*arguments, **more))
    curve = read_curve(finished.folder / "curve.csv")
    particles = len(finished.outcome.profiles["final"].x)
    return np.asarray(curve.displacement), np.asarray(curve.force), particles


@pytest.mark.parametrize(("radius", "spacing", "layer"), [(1000.0, 1.0, 0.5), (50.0, 0.25, 2.0), (2e4, 3.0, 0.1)])
def test_the_force_is_the_exact_discrete_sum(
    run_tables: RunTables, radius: float, spacing: float, layer: float
) -> None:
    depths = np.geomspace(0.05, 2.0, 7).tolist()
    displacement, force, particles = measured(run_tables, radius, spacing, layer, depths)
    x = (np.arange(particles) - (particles - 1) / 2) * spacing
    exact = [float(np.sum(layer * spacing * np.maximum(0.0, d - x**2 / (2 * radius)))) for d in depths]
    np.testing.assert_allclose(displacement, depths, rtol=1e-12)
    np.testing.assert_allclose(force, exact, rtol=EXACT)


def test_the_force_converges_to_hertz_with_the_square_of_the_spacing(run_tables: RunTables) -> None:
    radius, layer, spacings = 200.0, 1.0, [4.0, 2.0, 1.0, 0.5]
    depths = np.linspace(1.0, 1.4, 41).tolist()  # edges in many places between two particles
    errors = []
    for spacing in spacings:
        displacement, force, _ = measured(run_tables, radius, spacing, layer, depths)
        errors.append(np.max(np.abs(force / winkler_force(displacement, radius, layer) - 1.0)))
    rate = np.polyfit(np.log(spacings), np.log(errors), 1)[0]
    assert rate == pytest.approx(RATE, abs=RATE_ERROR)


@pytest.mark.parametrize("stiffness", [0.1, 2.0])
def test_neighbour_springs_on_the_plane_agree_with_the_complementarity_solver(
    run_tables: RunTables, stiffness: float
) -> None:
    depths = [0.5, 1.0, 1.5]
    displacement, force, particles = measured(
        run_tables, 100.0, 1.0, 0.5, depths, neighbours={"stiffness": stiffness}
    )
    model = ChainModel(particles, 0.5, radius=100.0, neighbour_stiffness=stiffness, rigid_plane=True)
    exact = [ChainSolver(model).equilibrium(d).force for d in displacement]
    np.testing.assert_allclose(force, exact, rtol=PLANE_SHARE)
