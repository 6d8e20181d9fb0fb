"""Claim: every shipped scene runs as it is shipped, and its main number stays what it was measured to be.

Each number was measured once with this program and, where the last column says so, by something independent of it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import Scene, read_scene, run
from contact1d.workflow.deck.lattice import start_offset
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.scene import Tangential
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.rigid_plane import rigid_plane_sum
from validation.references.slide import Integrator
from validation.references.solver import ChainSolver, trace
from validation.references.spring_sliders import SpringSliders
from validation.references.spring_sliders import displacement_under as displacement_carrying
from validation.references.thermal_chain import displacement_under
from validation.slides import slide_model

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"

PULL_OFF = 1.483414
"""Of one contact, at rest and in time [FU]."""
PINNED = {
    # scene: (quantity, value, tolerance and what limits it)
    "hertz_plane": ("largest_force", 59.62875, 1e-6 * 59.6),  # the exact sum; threshold of the minimiser
    "load": ("displacement", 0.395227, 1e-5),  # threshold of the minimiser and of the search for the force
    "pull_off": ("adhesion_force", PULL_OFF, 1e-4),  # the reference solver gives 1.483414; tail beyond the cutoff
    "paper": ("adhesion_force", 1.469966, 1e-4),  # as pull_off
    "pull_off_dynamic": ("adhesion_force", PULL_OFF, 4e-3),  # the same; half a bracket of the tolerance 5e-3
    "path_hysteresis": ("adhesion_force", 0.481134, 4e-3),  # the reference solver; half an increment before a snap
    "jkr": ("adhesion_force", 2.356194, 5e-4),  # 1.5πWR; the middle of a cell for its mean
    "steel_on_glass": ("contact_radius", 1.10373e-4, 1e-7),  # Hertz; the spacing, 27 particles in it
    "mindlin": ("tangential_force", -4.813935, 1e-5),  # the exact sum, after the way back; round-off of six digits
    "slide": ("mean_friction", 0.193011, 1.5e-4),  # the integrator; what is left of the run-in
    "prandtl_tomlinson": ("mean_friction", 0.0083200, 1e-5),  # the integrator
    "thermal_load": ("displacement", 0.259088, 1.3e-3),  # statistics: four standard errors of the run
}

LIMITED = {"path_hysteresis": ["unknown", "lattice"]}
"""Where particles snap, a radius between them does not exist to better than a share of the spacing, and the number of
those that hold together depends on where the centre lies between them; two readings of W differ by half."""


def test_every_shipped_scene_is_pinned() -> None:
    assert {path.stem for path in SCENES.glob("*.toml")} == PINNED.keys()


@pytest.mark.parametrize("name", PINNED)
def test_a_shipped_scene_gives_its_number(name: str, tmp_path: Path) -> None:
    quantity, value, tolerance = PINNED[name]
    results = run(read_scene(SCENES / f"{name}.toml"), tmp_path / name, figures=False).document
    assert results["status"] == "done"
    assert [warning["name"] for warning in results["warnings"]] == LIMITED.get(name, [])
    assert results[quantity]["value"] == pytest.approx(value, abs=tolerance)
    assert abs(results[quantity]["value"] - value) <= max(3 * results[quantity]["uncertainty"], 0.2 * tolerance)


DIGITS = 1e-6  # those that PINNED has
THERMAL_PLACES = np.linspace(0.1, 0.36, 27)
"""Displacements of a reference at a temperature [LU]: thirty standard deviations to either side."""


@pytest.mark.slow
def test_the_pinned_numbers_are_those_of_the_references() -> None:
    assert independent("hertz_plane") == pytest.approx(PINNED["hertz_plane"][1], abs=DIGITS)
    assert independent("load") == pytest.approx(PINNED["load"][1], abs=DIGITS)
    assert independent("pull_off") == pytest.approx(PINNED["pull_off"][1], abs=DIGITS)
    assert independent("paper") == pytest.approx(PINNED["paper"][1], abs=DIGITS)
    assert independent("path_hysteresis") == pytest.approx(PINNED["path_hysteresis"][1], abs=DIGITS)
    assert independent("jkr") == pytest.approx(PINNED["jkr"][1], abs=DIGITS)
    assert independent("mindlin") == pytest.approx(PINNED["mindlin"][1], abs=DIGITS)
    assert independent("thermal_load") == pytest.approx(PINNED["thermal_load"][1], abs=DIGITS)
    modulus = 1.0 / ((1.0 - 0.3**2) / 210e9 + (1.0 - 0.22**2) / 70e9)
    hertz = (0.75 * 10.0 * 0.01 / modulus) ** (1.0 / 3.0)
    assert PINNED["steel_on_glass"][1] == pytest.approx(hertz, rel=1e-5)  # digits that it has


SLIDING = 5e-4
"""Relative, of means over periods that the run-in has not quite left."""


@pytest.mark.slow
@pytest.mark.parametrize("name", ["slide", "prandtl_tomlinson"])
def test_the_pinned_slides_are_those_of_the_integrator(name: str) -> None:
    scene = read_scene(SCENES / f"{name}.toml")
    settings = settings_for(scene)
    body = Integrator(slide_model(scene.with_({"bodies.upper_offset": start_offset(scene, settings)}), settings))
    body.settle(settings.motion.time_step, 1e-7)
    (leg,) = settings.motion.drive
    trace_ = body.run(leg.rows * leg.steps // 2, leg.time_step, leg.velocity, every=leg.steps)
    last = 2.0 * scene.bodies.spacing / leg.velocity
    mean = (trace_.impulse[-1] - np.interp(trace_.time[-1] - last, trace_.time, trace_.impulse)) / last
    assert mean == pytest.approx(PINNED[name][1], rel=SLIDING)


def independent(name: str) -> float:
    """The number of a shipped scene by the exact sum, or by the solver that shares nothing with the program."""
    scene = read_scene(SCENES / f"{name}.toml")
    model = model_of(scene)
    experiment = scene.experiment
    match experiment.kind:
        case "load" if scene.noise is not None:
            return displacement_under(model, experiment.force, scene.noise.temperature, THERMAL_PLACES)[0]
        case "load":
            start, solver = trace(model, np.arange(-1.5, 0.31, 0.1))[-1], ChainSolver(model)
            return float(brentq(lambda d: solver.equilibrium(d, start).force - experiment.force, 0.3, 0.5, xtol=1e-10))
        case "tangential":
            return slid(scene, model.places())
        case "pull_off" if scene.adhesion is not None:
            return 1.5 * np.pi * scene.adhesion.work * 2.0 * float(scene.bodies.plane_radius or 0.0)
        case "pull_off":
            return pull_off(model, experiment.preload).adhesion_force
        case _ if model.rigid_plane:
            deepest = max(experiment.places())
            return rigid_plane_sum(deepest, model.places(), scene.bodies.plane_radius, model.bulk_stiffness)
        case _:
            return pull_off(model, 0.2).adhesion_force  # a path that turns deeper unloads along the same branch


def slid(scene: Scene, places: np.ndarray) -> float:
    """F_x of springs with sliders at these places, after the whole way."""
    assert isinstance(scene.experiment, Tangential)
    assert scene.friction is not None
    heights = (places**2 / (2.0 * float(scene.bodies.plane_radius or 0.0))).tolist()
    chain = SpringSliders(heights, scene.bulk_stiffness, scene.tangential_stiffness, scene.friction.coefficient)
    depth = displacement_carrying(scene.experiment.normal_forces()[0], heights, scene.bulk_stiffness)
    for place in (0.0, *scene.experiment.along()):
        chain.move(depth, place)
    return chain.tangential_force


def model_of(scene: Scene) -> ChainModel:
    """The chains of a scene for the reference."""
    law = None
    if scene.interaction is not None:
        repulsion, attraction = scene.interaction.repulsion, scene.interaction.attraction
        terms = [Exponential(term.amplitude, term.range) for term in (repulsion, attraction)]
        law = PairInteraction(*terms)
    return ChainModel(
        settings_for(scene).chains.upper,
        scene.bulk_stiffness,
        law,
        radius=scene.bodies.plane_radius,
        spacing=scene.bodies.spacing,
        neighbour_stiffness=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
        horizontal=scene.horizontal is not None,
        rigid_plane=law is None,
    )
