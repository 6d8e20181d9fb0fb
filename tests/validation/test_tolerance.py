"""`[accuracy] tolerance` holds: random scenes against the independent solver, errors and stated uncertainties.

Each scene has random bodies, law, effects, experiment and tolerance, drawn by hypothesis with a fixed seed. What is
asked, of all main results and whatever the run itself says about them: errors within the tolerance in at least 99 %,
within the stated uncertainty in at least 95 %.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, Phase, given, seed, settings
from hypothesis import strategies as st
from scipy.stats import binom

from contact1d import RunError, run
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.analysis.reference.model import ChainModel
from contact1d.analysis.reference.pull_off import pull_off
from contact1d.analysis.reference.solver import ChainSolver, State
from contact1d.analysis.reference.tension_radius import band_limited_radius
from contact1d.workflow.scene import scene_from_dict

SEED, SCENES, QUICK = 20071, 60, 12
WITHIN_TOLERANCE, WITHIN_UNCERTAINTY = 0.99, 0.95
CHANCE = 0.01
"""Of a right program to fail here: so few of a dozen scenes' results may be covered by chance."""
TOLD = 0.05
"""Largest share of results that the run itself calls less exact than asked: radii of a few particles."""
REFUSED = 0.05
"""Largest share of scenes that have no result, as their chains buckle sideways through each other."""
SOLVER = 2e-6
"""Relative error of the solver's forces and radii themselves."""
COARSE = 0.125
"""First steps of the solver's search over the shortest range: enough where no particle snaps."""


@dataclass(frozen=True)
class Error:
    """One main result: relative error over the tolerance, error over the stated uncertainty, and whether the run itself
    told that the tolerance is not met."""

    name: str
    over_tolerance: float
    over_uncertainty: float
    told: bool


def random_scene(random: Random) -> dict[str, Any]:
    """A pull_off or a load of two chains, or a load of one chain on the rigid plane."""
    spacing = 2.0 ** random.uniform(-2.0, 2.0)
    stiffness = random.uniform(0.4, 2.0) * spacing
    radius = 10.0 ** random.uniform(1.7, 2.5) * spacing  # the solver takes seconds for thousands of particles
    scene: dict[str, Any] = {
        "title": "random",
        "bodies": {
            "particles": "auto",
            "spacing": spacing,
            "profile": {"kind": "parabola", "radius": radius},
            "bulk_stiffness": stiffness,
        },
        "accuracy": {"tolerance": 10.0 ** random.uniform(-4.0, -2.0)},
    }
    if random.random() < 0.5:
        scene["neighbours"] = {"stiffness": random.uniform(0.05, 1.0) * stiffness}
    if random.random() < 0.1:
        scene["bodies"]["lower"] = "rigid_plane"
        depth = (random.uniform(3.0, 30.0) * spacing) ** 2 / radius  # of a contact so many spacings wide
        scene["experiment"] = {"kind": "load", "force": stiffness * depth * math.sqrt(radius * depth) / spacing}
        return scene
    scene["interaction"], force = random_law(random, spacing, stiffness, radius)
    if random.random() < 0.3:
        scene["horizontal"] = {}
    if random.random() < 0.7:
        scene["experiment"] = {"kind": "pull_off", "preload": force}
    else:
        scene["experiment"] = {"kind": "load", "force": force}
    if random.random() < 0.15:
        scene |= {"damping": {"coefficient": "auto"}, "plate": {}}
        scene["experiment"]["method"] = "dynamic"
    return scene


def random_law(random: Random, spacing: float, stiffness: float, radius: float) -> tuple[dict[str, Any], float]:
    """A law that reaches from a fifth of the spacing to all of it, no pair so strong that it snaps, and a load [FU].

    A pair snaps where its tension rises by k/2 per length; here by a tenth of that at most, as in the paper's contact,
    and less where a row of particles acts together. The load is 0.5 to 6 times the pull-off force, roughly.
    """
    reach = random.uniform(0.2, 1.0) * spacing
    strength, shorter = random.uniform(1.8, 3.0), random.uniform(1.7, 2.5)
    unit = PairInteraction(Exponential(strength, reach / shorter), Exponential(1.0, reach))
    steepest = float(unit.force_slope(np.array(unit.extremum_distance(2))))
    rows = 1.0 + 2.0 * reach / spacing
    amplitude = random.uniform(0.02, 0.1) * 0.5 * stiffness / steepest / rows**2
    largest = -amplitude * float(unit.force(np.array(unit.extremum_distance(1))))
    law = {
        "repulsion": {"amplitude": strength * amplitude, "range": reach / shorter},
        "attraction": {"amplitude": amplitude, "range": reach},
    }
    return law, random.uniform(3.0, 20.0) * largest * math.sqrt(radius * reach) / spacing


def model_of(scene: dict[str, Any], particles: int) -> ChainModel:
    bodies = scene["bodies"]
    law = None
    if "interaction" in scene:
        law = PairInteraction(*(Exponential(**scene["interaction"][name]) for name in ("repulsion", "attraction")))
    return ChainModel(
        particles,
        bodies["bulk_stiffness"],
        law,
        radius=bodies["profile"]["radius"] * (0.5 if law is None else 1.0),  # the MDR's parabola on the plane
        spacing=bodies["spacing"],
        neighbour_stiffness=scene.get("neighbours", {"stiffness": 0.0})["stiffness"],
        horizontal="horizontal" in scene,
        rigid_plane=law is None,
    )


def loaded(model: ChainModel, force: float, near: float) -> State:
    """The solver's state under a compressive force, by the secant method from a displacement that is near."""
    solver = ChainSolver(model)
    first, second = solver.equilibrium(near), solver.equilibrium(near * (1.0 + 1e-4) + 1e-6)
    for _ in range(20):
        if abs(second.force - force) <= 1e-10 * force:
            return second
        slope = (second.force - first.force) / (second.displacement - first.displacement)
        place = second.displacement + (force - second.force) / slope
        first, second = second, solver.equilibrium(place, second)
    raise AssertionError("the secant method did not end")


def radius_of(model: ChainModel, state: State) -> float:
    """Of the largest tension; on the plane of a chain without neighbour springs √(2 R d), which is exact."""
    if model.rigid_plane:
        assert model.radius is not None
        return math.sqrt(2.0 * model.radius * state.displacement)
    return band_limited_radius(model.places(), state.pair_force[:, 1])


def exact_results(scene: dict[str, Any], model: ChainModel, near: float) -> dict[str, float]:
    """Main results by the solver. On the plane neighbour springs leave the edge of a contact between two particles."""
    experiment = scene["experiment"]
    if experiment["kind"] == "pull_off":
        assert model.interaction is not None
        found = pull_off(model, experiment["preload"], COARSE * model.interaction.shortest_range)
        return {
            "adhesion_force": found.adhesion_force,
            "zero_load_radius": radius_of(model, found.zero_load),
            "critical_radius": radius_of(model, found.critical),
        }
    state = loaded(model, experiment["force"], near)
    if model.rigid_plane and model.neighbour_stiffness > 0.0:
        return {"displacement": state.displacement}
    radius = radius_of(model, state)
    pressure = experiment["force"] / (math.pi * radius**2)
    return {"displacement": state.displacement, "contact_radius": radius, "mean_pressure": pressure}


def errors_of(scene: dict[str, Any], folder: Path) -> list[Error]:
    finished = run(scene_from_dict(scene), folder, figures=False)
    model = model_of(scene, finished.outcome.states[0].profile.x.size)
    near = finished.document.get("displacement", {"value": 0.0})["value"]
    errors = []
    for name, value in exact_results(scene, model, near).items():
        quantity = finished.document[name]
        error = abs(quantity["value"] - value)
        relative = max(0.0, error / abs(value) - SOLVER) / scene["accuracy"]["tolerance"]
        covered = max(0.0, error - SOLVER * abs(value)) / quantity["uncertainty"]
        doubts = [warning["message"] for warning in finished.document["warnings"] if warning["name"] == "tolerance"]
        told = any(f"{name} is known to" in doubt for doubt in doubts)
        errors.append(Error(name, relative, covered, told))
    return errors


def collected(count: int, folder: Path) -> list[Error]:
    """Errors of all results of so many scenes; nothing is asked of a single one, so nothing is shrunk or replayed."""
    errors: list[Error] = []
    drawn, refused = 0, 0

    @seed(SEED)
    @settings(
        max_examples=count,
        database=None,
        deadline=None,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(st.randoms(use_true_random=True))  # a seed; numbers are then even and independent, as a share needs them
    def each(random: Random) -> None:
        nonlocal drawn, refused
        drawn += 1
        scene = random_scene(random)
        try:
            errors.extend(errors_of(scene, folder / str(drawn)))
        except RunError as error:
            if "horizontal" not in scene or "went through each other" not in error.message:
                raise
            refused += 1

    each()
    assert drawn == count
    assert refused <= max(1.0, REFUSED * count)
    return errors


def require(errors: list[Error], covered_at_least: float) -> None:
    within = np.mean([error.over_tolerance <= 1.0 for error in errors])
    covered = np.mean([error.over_uncertainty <= 1.0 for error in errors])
    assert np.mean([error.told for error in errors]) <= TOLD
    assert within >= WITHIN_TOLERANCE, sorted(errors, key=lambda e: -e.over_tolerance)[:5]
    assert covered >= covered_at_least, sorted(errors, key=lambda e: -e.over_uncertainty)[:5]


def test_a_dozen_random_scenes_are_as_exact_as_asked(tmp_path: Path) -> None:
    errors = collected(QUICK, tmp_path)  # too few for the share itself: what it lets happen by chance
    require(errors, binom.ppf(CHANCE, len(errors), WITHIN_UNCERTAINTY) / len(errors))


@pytest.mark.slow
def test_sixty_random_scenes_are_as_exact_as_asked(tmp_path: Path) -> None:
    require(collected(SCENES, tmp_path), WITHIN_UNCERTAINTY)
