"""A scene as the references of `analysis` take it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from validation.doors import Parabola, Scene
from validation.references.independent_pairs import IndependentPairs
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver, State

Array = NDArray[np.float64]
ROW_REACH, ROW_POINTS, ROW_HALF = 5.0, 4001, 20
"""Distances [longest ranges] and particles to each side that the largest tension of a row is looked for with."""
STEP, BEYOND = 0.02, 0.1
"""Of the displacement [LU] in which an equilibrium under a force is looked for, and what is added at both ends."""
HIGHEST = 1.5
"""F/F_A up to which curves are compared with theory."""


def interaction(scene: Scene) -> PairInteraction:
    """The scene's law."""
    terms = scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    return PairInteraction(
        Exponential(terms.repulsion.amplitude, terms.repulsion.range),
        Exponential(terms.attraction.amplitude, terms.attraction.range),
    )


def radius(scene: Scene) -> float:
    """R of the scene's parabola [LU]."""
    assert isinstance(scene.bodies.profile, Parabola)
    return scene.bodies.profile.radius


def chain_model(scene: Scene) -> ChainModel:
    """The scene for the independent solver."""
    assert isinstance(scene.bodies.particles, int)
    return ChainModel(
        scene.bodies.particles,
        scene.bulk_stiffness,
        interaction(scene),
        radius=radius(scene),
        spacing=scene.bodies.spacing,
        neighbour_stiffness=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
        horizontal=scene.horizontal is not None,
    )


def equilibrium_under(model: ChainModel, force: float) -> State:
    """The solver's state under a force [FU]: steps of the displacement from 0 until it is passed, then bisection."""
    solver = ChainSolver(model)
    state = solver.equilibrium(0.0)
    towards = math.copysign(STEP, force - state.force)
    before = state
    while (state.force - force) * towards < 0.0:
        before, state = state, solver.equilibrium(state.displacement + towards, state)

    def excess(d: float) -> float:
        return solver.equilibrium(d, before).force - force

    if before is state:
        return state
    ends = (before.displacement - BEYOND * towards, state.displacement + BEYOND * towards)  # a step may end on it
    return solver.equilibrium(float(brentq(excess, *ends, xtol=1e-12)), before)


def independent_pairs(scene: Scene) -> IndependentPairs:
    """The scene's closed form, which holds where only opposite particles meet."""
    return IndependentPairs(interaction(scene), scene.bulk_stiffness, radius(scene), scene.bodies.spacing)


def row_tension(scene: Scene) -> float:
    """Largest tension [FU] of a particle that faces a straight row: f(r) = Σ_j f_pair(ϱ_j) r/ϱ_j, ϱ_j² = r² + (js)²."""
    law, spacing = interaction(scene), scene.bodies.spacing
    r = np.linspace(law.force_free_distance(), law.force_free_distance() + ROW_REACH * law.longest_range, ROW_POINTS)
    offsets = spacing * np.arange(-ROW_HALF, ROW_HALF + 1)
    distance = np.hypot(r[:, None], offsets)
    return float(-(law.force(distance) * r[:, None] / distance).sum(axis=1).min())


def jkr_reduced(a: Array | float) -> Array:
    """F/F_A = 4 ã³ − 4 ã^{3/2} at ã = a/a₀ (Eq. 8)."""
    return np.asarray(4.0 * np.asarray(a) ** 3 - 4.0 * np.asarray(a) ** 1.5)


def barquins_reduced(a: Array | float) -> Array:
    """F/F_A of a cylinder, ∝ ã² − √ã with the minimum −1 (Barquins 1988)."""
    lowest = 4.0 ** (-2.0 / 3.0)  # where 2ã = 1/(2√ã)
    return np.asarray((np.asarray(a) ** 2 - np.sqrt(a)) / (lowest**0.5 - lowest**2))


def reduced(force: Array, contact_radius: Array) -> tuple[Array, Array]:
    """F/F_A and a/a₀ of a branch, with its own F_A, the largest tension, and its own a₀, where F = 0."""
    largest = int(np.argmin(force))
    stable = slice(0, largest + 1)
    order = np.argsort(force[stable])
    a_0 = float(np.interp(0.0, force[stable][order], contact_radius[stable][order]))
    return force / -force[largest], contact_radius / a_0


def distances(force: Array, contact_radius: Array) -> tuple[float, float]:
    """Rms distance of F/F_A to JKR's and to Barquins' at the same a/a₀, from a_cr up to F/F_A = 1.5."""
    tension, a = reduced(force, contact_radius)
    compared = (np.arange(len(a)) <= int(np.argmin(tension))) & (tension <= HIGHEST)
    theories = (jkr_reduced, barquins_reduced)
    jkr, barquins = (float(np.sqrt(np.mean((tension - law(a))[compared] ** 2))) for law in theories)
    return jkr, barquins
