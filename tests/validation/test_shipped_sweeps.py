"""Claim: every shipped sweep of slides has points that run, and a number of it is what an independent law says.

Each number was measured once with this program; the law is evaluated here, without any part of it.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from contact1d import run
from contact1d.workflow.model.settings import settings_for
from validation.paper.fig9.asperity import smoluchowski
from validation.paper.fig9.curved import integrated
from validation.paper.fig9.reading import SWEEPS, slides
from validation.references.incommensurate import shared_corrugation
from validation.references.prandtl_tomlinson import corrugation, moving_friction, slow_friction

FOLDER = Path(__file__).parents[2] / "lammps_inputs" / "sweeps"
LAW, LOAD = (1.0, 0.5, 0.5, 1.0), 0.2
DIGITS = 2e-4  # relative: what the settings of a tolerance of 1e-3 may leave
CHANCE = 2.0  # of an interval of 95 %: four standard errors of a run under heat

PINNED = {
    # sweep: (values of its axes, quantity, value [FU], how near the law is to it and why)
    "friction_over_load": ((0.0,), "static_friction", 0.172793, 3e-4),  # the integrator, of which a row is the largest
    "friction_over_radius": ((10.0,), "mean_friction", 0.167349, 2e-3),  # the integrator; run-in
    "friction_of_one_particle": (
        (0.0,),
        "static_friction",
        2.21330e-3,
        1e-3,
    ),  # largest slope; drag of the rise at this v
    "friction_over_velocity": ((1.2e-3, 0.0214586), "mean_friction", 1.06382e-2, 3e-3),  # equation of one mass
    "friction_over_stiffness": ((0.021969, 4e-4), "mean_friction", 1.24041e-2, 3e-3),  # equation of one mass
    "friction_of_flats": ((0.03, 2e-4), "mean_friction", 0.148093, 5e-2),  # what is left of the velocity
    "friction_of_lattices": (
        (13.0, 1.0),
        "static_friction",
        0.255229,
        1e-3,
    ),  # 13 particles; drag of the rise at this v
    "friction_over_temperature": ((3.76e-4,), "mean_friction", 0.028431, 1e-3),  # Smoluchowski: the law itself
}


SHORTER = {"friction_over_temperature": 15.0, "friction_over_load": 3.0, "friction_of_lattices": 3.0}
"""A way [LU] that is enough for a mean under heat and its uncertainty, or for the friction before the plate slides."""
INTEGRATED = ("friction_over_load", "friction_over_radius")
"""By the integrator, which takes longer than the runs; `validation paper` holds all their points against it."""


def test_every_shipped_sweep_of_slides_is_pinned() -> None:
    assert {path.stem for path in FOLDER.glob("friction_*.toml")} == PINNED.keys() == set(SWEEPS)


@pytest.mark.parametrize("name", PINNED)
def test_a_point_of_a_shipped_sweep_gives_its_number(name: str, tmp_path: Path) -> None:
    place, quantity, value, _ = PINNED[name]
    scene = slides(name).scenes[place]
    scene = scene.with_({"experiment.distance": SHORTER.get(name, scene.experiment.excursion)})
    found = run(scene, tmp_path / name, figures=False).results[quantity]
    chance = 0.0 if scene.noise is None else CHANCE * found.uncertainty
    assert found.value == pytest.approx(value, rel=DIGITS, abs=chance)


def law(name: str) -> float:
    """The number by a law."""
    scene = slides(name).scenes[PINNED[name][0]]
    assert scene.cantilever is not None
    k = 1.0 / (1.0 / scene.cantilever.stiffness + 1.0 / scene.tangential_stiffness)
    match name:
        case "friction_over_temperature":
            return smoluchowski(scene, PINNED[name][0][0])
        case "friction_of_one_particle":
            return corrugation(LAW, 1.0, 0.0).largest_force
        case "friction_of_lattices":
            return 13.0 * corrugation(LAW, 1.0, LOAD).largest_force
        case "friction_of_flats":
            return 13.0 * slow_friction(shared_corrugation(LAW, 1.0, LOAD, 1.0, 0.03), 0.03)
        case "friction_over_load":
            return integrated(scene).static
        case "friction_over_radius":
            return integrated(scene).mean
        case "friction_over_velocity":
            wells = corrugation((100.0, 1.0, 50.0, 2.0), 1.0, 20.0)
        case _:
            wells = corrugation(LAW, 1.0, LOAD)
    settings = settings_for(scene)
    drag = settings.motion.damping + settings.motion.plate_damping
    return moving_friction(
        wells, k, scene.bodies.mass + settings.motion.plate_mass, drag, scene.cantilever.velocity, 4, 2
    )


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in INTEGRATED else name for name in PINNED]
)
def test_the_pinned_number_is_that_of_a_law(name: str) -> None:
    _, _, value, near = PINNED[name]
    assert law(name) == pytest.approx(value, rel=near)
