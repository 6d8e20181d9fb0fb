"""Claim: every shipped scene, and a point of every shipped sweep of slides, runs as it is shipped and gives its number.

Each number was measured once with this program and is held against something independent of it: a reference solver, an
integrator, an exact sum or a law.
"""

import math
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import read_scene, run
from tests.scenes import ROOT
from validation.paper.fig9.curved import integrated
from validation.paper.fig9.reading import SWEEPS, slides
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off
from validation.references.solver import ChainSolver, trace

SHIPPED = ROOT / "lammps_inputs"
PULL_OFF = 1.483414
"""Of one contact, at rest and in time [FU]."""
SCENES = {
    # scene: (quantity, value, tolerance and what limits it)
    "hertz_plane": ("largest_force", 59.62875, 1e-6 * 59.6),  # the exact sum; threshold of the minimiser
    "load": ("displacement", 0.395227, 1e-5),  # threshold of the minimiser and of the search for the force
    "pull_off": ("adhesion_force", PULL_OFF, 1e-4),  # the reference solver gives 1.483414; tail beyond the cutoff
    "paper": ("adhesion_force", 1.469966, 1e-4),  # as pull_off
    "pull_off_dynamic": ("adhesion_force", PULL_OFF, 4e-3),  # the same; half a bracket of the tolerance 5e-3
    "path_hysteresis": ("adhesion_force", 0.481134, 4e-3),  # the reference solver; half an increment before a snap
    "jkr": ("adhesion_force", 0.75 * math.pi, 5e-4),  # 1.5πWR; the middle of a cell for its mean
    "steel_on_glass": ("contact_radius", 1.10373e-4, 1e-7),  # Hertz; the spacing, 27 particles in it
    "mindlin": ("tangential_force", -4.813935, 1e-5),  # the exact sum, after the way back; round-off of six digits
    "oblique": ("tangential_restitution", 0.32953788, 1e-6),  # superposition of normal contacts, to its digits
    "slide": ("mean_friction", 0.193011, 1.5e-4),  # the integrator, and the end of the run-in
    "prandtl_tomlinson": ("mean_friction", 0.0083200, 1e-5),  # the integrator
}
IN_TEST_THERMAL = {"thermal_load"}
LIMITED = {"path_hysteresis": {"unknown", "lattice"}}
"""Where particles snap, a radius between them does not exist to better than a share of the spacing, and the number of
those that hold together depends on where the centre lies between them; two readings of W differ by half."""
DIGITS = 1e-6
"""Those that SCENES has."""
SLIDING = 5e-4
"""Relative, of means over periods that the run-in has not quite left."""
LEFT = 2e-4
"""Relative: what the settings of a tolerance of 1e-3 may leave."""
CHANCE = 2.0
"""Of an interval of 95 %: four standard errors of a run under heat."""
SLIDES = {
    # sweep: (values of its axes, quantity, value [FU]); `validation paper` holds all against laws
    "friction_over_load": ((0.0,), "static_friction", 0.172793),
    "friction_over_radius": ((10.0,), "mean_friction", 0.167349),
    "friction_of_one_particle": ((0.0,), "static_friction", 2.21330e-3),
    "friction_over_velocity": ((1.2e-3, 0.0214586), "mean_friction", 1.06382e-2),
    "friction_over_stiffness": ((0.021969, 4e-4), "mean_friction", 1.24041e-2),
    "friction_of_flats": ((0.03, 2e-4), "mean_friction", 0.148093),
    "friction_of_lattices": ((13.0, 1.0), "static_friction", 0.255229),
    "friction_over_temperature": ((3.76e-4,), "mean_friction", 0.028431),
}
LONG = ("friction_over_radius", "friction_over_temperature", "friction_of_flats")
"""Those whose like is in `test_slides.py` and among the scenes."""
SHORTER = {"friction_over_temperature": 15.0, "friction_over_load": 3.0, "friction_of_lattices": 3.0}
"""A way [LU] that is enough for a mean under heat and its uncertainty, or for the friction before the plate slides."""


def test_every_shipped_scene_and_sweep_of_slides_is_pinned() -> None:
    assert {path.stem for path in (SHIPPED / "scenes").glob("*.toml")} == SCENES.keys() | IN_TEST_THERMAL
    assert {path.stem for path in (SHIPPED / "sweeps").glob("friction_*.toml")} == SLIDES.keys() == set(SWEEPS)


@pytest.mark.parametrize("name", SCENES)
def test_a_shipped_scene_gives_its_number(name: str) -> None:
    quantity, value, tolerance = SCENES[name]
    done = run(SHIPPED / "scenes" / f"{name}.toml")
    found = done.document[quantity]
    assert done.warnings.keys() == LIMITED.get(name, set())
    assert found["value"] == pytest.approx(value, abs=tolerance)
    assert abs(found["value"] - value) <= max(3 * found["uncertainty"], 0.2 * tolerance)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["load", "pull_off", "paper", "path_hysteresis"])
def test_a_pinned_contact_is_that_of_the_reference_solver(name: str) -> None:
    """A path that turns deeper unloads along the same branch as a pull-off."""
    scene = read_scene(SHIPPED / "scenes" / f"{name}.toml")
    assert scene.interaction is not None
    terms = [
        Exponential(one.amplitude, one.range) for one in (scene.interaction.repulsion, scene.interaction.attraction)
    ]
    profiles = run(scene).profiles
    experiment: Any = scene.experiment
    model = ChainModel(
        next(iter(profiles.values())).x.size,
        scene.bulk_stiffness,
        PairInteraction(*terms),
        radius=scene.bodies.plane_radius,
        neighbour_stiffness=0.0 if scene.neighbours is None else scene.neighbours.stiffness,
        horizontal=scene.horizontal is not None,
    )
    if name == "load":
        start, solver = trace(model, np.arange(-1.5, 0.31, 0.1))[-1], ChainSolver(model)
        exact = brentq(lambda d: solver.equilibrium(d, start).force - experiment.force, 0.3, 0.5, xtol=1e-10)
    else:
        exact = pull_off(model, getattr(experiment, "preload", 0.2)).adhesion_force
    assert exact == pytest.approx(SCENES[name][1], abs=DIGITS)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["slide", "prandtl_tomlinson"])
def test_a_pinned_slide_is_that_of_the_integrator(name: str) -> None:
    mean = integrated(read_scene(SHIPPED / "scenes" / f"{name}.toml")).mean
    assert mean == pytest.approx(SCENES[name][1], rel=SLIDING)


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in LONG else name for name in SLIDES]
)
def test_a_point_of_a_shipped_sweep_gives_its_number(name: str) -> None:
    place, quantity, value = SLIDES[name]
    scene = slides(name).scenes[place]
    scene = scene.with_({"experiment.distance": SHORTER.get(name, scene.experiment.excursion)})
    found = run(scene).results[quantity]
    chance = 0.0 if scene.noise is None else CHANCE * found.uncertainty
    assert found.value == pytest.approx(value, rel=LEFT, abs=chance)
