"""A scene as the references of `analysis` take it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from contact1d.analysis.reference.independent_pairs import IndependentPairs
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.analysis.reference.jkr import jkr_reduced_force
from contact1d.analysis.reference.line_adhesion import barquins_reduced_force
from contact1d.analysis.reference.model import ChainModel
from contact1d.analysis.reference.slide import SlideModel
from contact1d.analysis.reference.solver import ChainSolver, State
from contact1d.workflow.deck.lattice import start_offset
from contact1d.workflow.scene import Parabola, Scene, Slide
from contact1d.workflow.settings.settings import Settings

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


def law_of(scene: Scene) -> tuple[float, float, float, float]:
    """A [FU·LU], a [LU], B [FU·LU], b [LU] of the scene's law."""
    terms = scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    return terms.repulsion.amplitude, terms.repulsion.range, terms.attraction.amplitude, terms.attraction.range


def slide_model(scene: Scene, settings: Settings) -> SlideModel:
    """A slide for the independent integrator; the values that the scene leaves open are the program's."""
    bodies = scene.bodies
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)

    def row(count: int, spacing: float) -> Array:
        return np.asarray((np.arange(count) - 0.5 * (count - 1)) * spacing, dtype=np.float64)

    below, along = row(settings.lower_particles, bodies.spacing), row(settings.particles, bodies.own_spacing)
    offset = start_offset(scene, settings)
    upper = np.column_stack([along + offset, settings.rest + bodies.profile.height(along)])
    return SlideModel(
        lower=np.column_stack([below, np.zeros_like(below)]),
        upper=upper,
        law=law_of(scene),
        cutoff=settings.cutoff,
        normal_stiffness=scene.bulk_stiffness,
        tangential_stiffness=scene.tangential_stiffness,
        mass=bodies.mass,
        plate_mass=settings.plate_mass,
        drag=settings.damping,
        plate_drag=settings.plate_damping,
        cantilever_stiffness=scene.cantilever.stiffness,
        velocity=scene.cantilever.velocity,
        normal_force=scene.experiment.normal_force,
        rigid=bodies.lower == "rigid_chain",
        period=settings.lower_particles * bodies.spacing if bodies.periodic else 0.0,
        neighbours=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
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
    theories = (jkr_reduced_force, barquins_reduced_force)
    jkr, barquins = (float(np.sqrt(np.mean((tension - law(a))[compared] ** 2))) for law in theories)
    return jkr, barquins
