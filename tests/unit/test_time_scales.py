"""Claims of what a scene in time leaves open: steps that each motion is sampled by, drags that are critical, masses.

References: eigenvalues of two straight chains, the plate and the drag, as linear equations; written-out critical drags.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.model.settings import Settings, settings_for
from tests.scenes import chains

RADIUS, SPRING, SPACING, MASS = 200.0, 0.7, 0.5, 3.0
LOAD = {"kind": "load", "method": "dynamic", "force": 0.5}
SLIDE = {"kind": "slide", "normal_force": 1.0, "distance": 7.0}
EXACT = 1e-9
SWING = 0.5
"""Of the swing of a slide's plate, the time to settle at least."""


def scene(**tables: Any) -> Scene:
    bodies = {"spacing": SPACING, "mass": MASS} | tables.pop("bodies", {})
    return read_scene(chains(RADIUS, SPRING, **{"experiment": LOAD, **tables}, bodies=bodies))


def slide(tolerance: float, cantilever: float = 0.5, **bodies: Any) -> Scene:
    own = {"spacing": 1.0, "mass": MASS, "upper_offset": 0.5} | bodies
    return read_scene(
        chains(
            30.0, 2.0, law=(1.0, 0.5, 0.5, 1.0), horizontal={}, damping={"coefficient": 0.3},
            plate={"free": ["x", "z"], "damping": 0.1}, cantilever={"stiffness": cantilever, "velocity": 0.1},
            bodies=own, experiment=SLIDE, accuracy={"tolerance": tolerance},
        )
    )  # fmt: skip


def stiffest(of: Scene, settings: Settings) -> float:
    """Stiffness [FU/LU] of a particle and a row of opposite ones that move against it, at the closest distance."""
    law = settings.forces.law
    assert law is not None
    row = (1.0 + 2.0 * law.repulsion.range / of.bodies.spacing) * float(law.stiffness(settings.forces.closest))
    return max(of.bulk_stiffness, of.tangential_stiffness) + 2.0 * row


def per_step(of: Scene, settings: Settings) -> float:
    """ω Δt of the stiffest motion of the particles."""
    return settings.motion.time_step * math.sqrt(stiffest(of, settings) / of.bodies.mass)


def test_a_motion_that_comes_to_rest_has_the_steps_that_were_measured() -> None:
    for damping in (0.3, "auto"):
        of = scene(damping={"coefficient": damping}, plate={})
        assert per_step(of, settings_for(of)) == pytest.approx(CALIBRATION.still_step, rel=EXACT)


@pytest.mark.parametrize(("tolerance", "product"), [(1e-1, 0.2), (1e-2, 0.2), (1e-3, 0.2), (1e-5, 0.02)])
def test_a_motion_that_is_the_result_has_steps_that_shrink_with_the_root_of_the_tolerance(
    tolerance: float, product: float
) -> None:
    """The error of a step goes with its square; rows take whole numbers of steps, so that one may be a little less."""
    of = slide(tolerance)
    assert 0.7 * product < per_step(of, settings_for(of)) <= product * (1.0 + EXACT)
    slow = of.with_({"cantilever.velocity": 0.003})
    assert 0.95 * product < per_step(slow, settings_for(slow)) <= product * (1.0 + EXACT)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_the_bias_of_a_thermal_motion_is_within_the_tolerance(tolerance: float) -> None:
    """Of ⟨u²⟩ it is 0.4 (ω Δt)², and no step is longer than without noise."""
    tables = {"damping": {"coefficient": 0.3}, "accuracy": {"tolerance": tolerance}, "plate": {}}
    of = scene(noise={"temperature": 1e-3, "seed": 1}, **tables)
    product = per_step(of, settings_for(of))
    assert 0.4 * product**2 <= tolerance * (1.0 + EXACT)
    assert product == pytest.approx(min(math.sqrt(tolerance / 0.4), CALIBRATION.still_step), rel=EXACT)


@pytest.mark.parametrize("mass", [1e-3, 0.1, 1e3])
def test_a_light_plate_is_sampled_too(mass: float) -> None:
    """It swings on the springs of all its particles, which stay behind."""
    of = scene(damping={"coefficient": 1e-6}, plate={"mass": mass, "damping": 0.0})
    settings = settings_for(of)
    swing = math.sqrt(settings.chains.upper * SPRING / mass) * settings.motion.time_step
    assert swing <= CALIBRATION.still_step * (1.0 + EXACT)
    assert max(swing, per_step(of, settings)) == pytest.approx(CALIBRATION.still_step, rel=EXACT)


def test_a_cantilever_holds_its_plate_too() -> None:
    """By the stiffer of both directions of its particles, and by itself."""
    for cantilever, along in ((0.5, 6.0), (3e4, 2.0), (0.5, 2.0)):
        of = slide(1e-3, cantilever, bulk_stiffness_tangential=along)
        light = of.with_({"plate.mass": 1e-3})
        settings = settings_for(light)
        held = settings.chains.upper * max(2.0, along) + cantilever
        assert 0.7 * 0.2 < settings.motion.time_step * math.sqrt(held / 1e-3) <= 0.2 * (1.0 + EXACT)


def test_a_machines_spring_holds_its_plate_too() -> None:
    pull = {"kind": "pull_off", "method": "dynamic", "preload": 0.5, "velocity": 1e-3, "stiffness": 1e4}
    of = scene(
        damping={"coefficient": 1e-6}, plate={"mass": 0.1, "damping": 0.0}, experiment=pull,
        noise={"temperature": 1e-6, "seed": 1}, accuracy={"tolerance": 1e-2},
    )  # fmt: skip
    settings = settings_for(of)
    swing = settings.motion.time_step * math.sqrt((settings.chains.upper * SPRING + 1e4) / 0.1)
    assert swing == pytest.approx(math.sqrt(1e-2 / 0.4), rel=EXACT)


@pytest.mark.parametrize("mass", [0.2, 40.0, 1e4, "auto"])
def test_an_automatic_drag_is_critical_for_plate_and_particles_on_the_softened_contact(mass: Any) -> None:
    """2√(K M): K is 0.6 of the springs of those within √(2Rd), two in series each; M is all that moves."""
    of = scene(damping={"coefficient": "auto"}, plate={"mass": mass})
    settings = settings_for(of)
    count = settings.chains.upper
    touching = 2.0 * math.sqrt(2.0 * RADIUS * settings.largest_displacement) / SPACING
    contact = 0.6 * touching * 0.5 * SPRING
    plate = count * MASS if mass == "auto" else mass
    assert settings.motion.plate_mass == plate
    drag = count * settings.motion.damping
    assert drag == pytest.approx(2.0 * math.sqrt(contact * (plate + count * MASS)), rel=1e-6)
    assert settings.motion.damped_stiffness == pytest.approx(contact, rel=1e-6)
    assert settings.motion.settle_time == pytest.approx(
        2.0 * math.pi * math.sqrt((plate + count * MASS) * 0.6 / contact)
    )
    share = plate / (count * MASS)  # a light plate swings against its particles: see `_swinging_apart`
    needed = 0.5 * settings.motion.damping / MASS * plate * max(0.0, 1.0 - share)
    assert settings.motion.plate_damping == pytest.approx(needed, rel=1e-6, abs=1e-9 * drag)


def test_without_a_plate_each_particle_is_damped_on_its_own_spring() -> None:
    path = {"kind": "path", "method": "dynamic", "displacements": [0.05]}
    settings = settings_for(scene(damping={"coefficient": "auto"}, experiment=path))
    assert settings.motion.damping == pytest.approx(math.sqrt(SPRING * MASS))
    assert settings.motion.settle_time == pytest.approx(2.0 * math.pi * math.sqrt(MASS / SPRING))
    assert settings.motion.plate_mass == settings.motion.plate_damping == 0.0


def test_what_snaps_comes_to_rest_under_a_drag_that_is_critical_for_the_stiffest_motion() -> None:
    of = scene(damping={"coefficient": "auto"}, plate={})
    settings = settings_for(of)
    critical = 2.0 * math.sqrt(stiffest(of, settings) * MASS)
    assert settings.motion.settling_damping == pytest.approx(critical, rel=EXACT)
    assert settings.motion.settling_step == pytest.approx(
        min(settings.motion.time_step, 0.2 * MASS / settings.motion.settling_damping), rel=EXACT
    )
    given = settings_for(of.with_({"damping.coefficient": 0.3})).motion
    assert (given.settling_damping, given.settling_step) == (given.damping, given.time_step)


@pytest.mark.parametrize("coefficient", [1e-3, 1.0, 500.0])
def test_drag_stops_nothing_within_a_step(coefficient: float) -> None:
    """Explicit integration needs γ Δt/m below 1; a fifth of it is left."""
    of = scene(damping={"coefficient": coefficient}, plate={"mass": 10.0, "damping": 30.0 * coefficient})
    settings = settings_for(of)
    assert settings.motion.time_step * coefficient / MASS <= 0.2 * (1.0 + EXACT)
    assert settings.motion.time_step * 30.0 * coefficient / 10.0 <= 0.2 * (1.0 + EXACT)
    swinging = settings.motion.time_step * math.sqrt(settings.chains.upper * SPRING / 10.0)
    tightest = [
        settings.motion.time_step * coefficient / MASS / 0.2,
        settings.motion.time_step * 3.0 * coefficient / 0.2,
    ]
    assert max(*tightest, swinging / CALIBRATION.still_step, per_step(of, settings) / CALIBRATION.still_step) == (
        pytest.approx(1.0, rel=EXACT)
    )


@pytest.mark.parametrize("drag", [1e-4, 0.3, 3e3])
def test_a_slide_is_loaded_with_a_drag_that_lets_its_plate_swing_not_and_creep_not(drag: float) -> None:
    """Reference: the eigenvalues of the plate with its particles on the contact's stiffness, and of the calm steps."""
    of = slide(1e-3).with_({"damping.coefficient": drag})
    settings = settings_for(of)
    count = settings.chains.upper
    stiffness = min(
        settings.law.stiffness_under(1.0),
        settings.law.half_width(settings.largest_displacement, settings.forces.rest) * 2.0 * settings.law.stiffness,
    )
    moving = settings.motion.plate_mass + count * MASS
    rate = count * settings.motion.settling_damping / moving
    values = np.linalg.eigvals([[0.0, 1.0], [-0.6 * stiffness / moving, -rate]])
    assert settings.motion.settling_step == pytest.approx(settings.motion.time_step, rel=0.3)
    swing = 2.0 * math.pi * math.sqrt(moving / stiffness)  # of the plate on its contact, by the law and springs
    own = 2.0 * math.pi * math.sqrt(moving / (2.0 * settings.law.stiffness))
    assert settings.motion.settle_time >= SWING * swing * (1.0 - 1e-6)
    assert settings.motion.settle_time <= max(SWING * swing, own) * (1.0 + 1e-6)
    assert settings.motion.settling_step * settings.motion.settling_damping / MASS <= 0.4 * 1.3
    if drag == 0.3 and settings.motion.settling_damping != drag:
        assert np.abs(values.imag).max() <= 1e-3 * np.abs(values.real).max()
    if drag == 3e3:  # a particle alone would not come to rest
        assert settings.motion.settling_damping < drag
    assert settings.motion.damping == drag


def test_in_smaller_steps_a_chain_without_a_plate_is_stopped_by_drag_and_a_plate_keeps_its_own() -> None:
    path = {"kind": "path", "method": "dynamic", "displacements": [0.05]}
    alone = settings_for(scene(damping={"coefficient": "auto"}, experiment=path))
    held = settings_for(scene(damping={"coefficient": "auto"}, plate={}))
    for settings, damping in ((alone, alone.motion.settling_damping), (held, held.motion.damping)):
        smaller = settings.in_smaller_steps(0.25)
        assert (smaller.motion.damping, smaller.motion.time_step) == (damping, settings.motion.settling_step)
        for name in ("displacement_step", "loading_step", "smooth_step", "longest_move"):
            assert getattr(smaller.increments, name) == 0.25 * getattr(settings.increments, name)
        assert settings.motion.settling_damping > 2.0 * settings.motion.damping


@pytest.mark.parametrize("spring", [2.0, 2000.0])
def test_a_slides_plate_has_time_for_half_a_swing_on_what_holds_it(spring: float) -> None:
    """On stiff springs that is the law alone, which is softer by far."""
    of = slide(1e-3, bulk_stiffness=spring, bulk_stiffness_tangential=2.0)
    settings = settings_for(of)
    moving = settings.motion.plate_mass + settings.chains.upper * MASS
    touching = settings.law.half_width(settings.largest_displacement, settings.forces.rest) * 2.0
    contact = max(1.0, touching) * settings.law.stiffness
    held = min(contact, settings.law.stiffness_under(1.0))
    assert (held < 0.1 * contact) == (spring > 2.0)
    periods = [2.0 * math.pi * math.sqrt(moving / contact), SWING * 2.0 * math.pi * math.sqrt(moving / held)]
    assert settings.motion.settle_time == pytest.approx(max(periods), rel=1e-6)


@pytest.mark.parametrize(("force", "spring"), [(1.0, 2.0), (0.0, 2.0), (0.1, 0.02)])
@pytest.mark.parametrize("mass", [1.0, 300.0, 1e5])
@pytest.mark.parametrize("drag", [1e-4, 1e-2, 2.0, 30.0, 3e3])
def test_a_slide_is_loaded_under_its_own_drag_where_that_is_enough_and_no_more_than_ten_times_that(
    drag: float, mass: float, force: float, spring: float
) -> None:
    """Enough is critical for the plate on 0.6 of what holds it, 2√(0.6 K M)/N, and lets steps stop no particle."""
    of = slide(1e-3, bulk_stiffness=spring).with_(
        {"damping.coefficient": drag, "plate.mass": mass, "experiment.normal_force": force}
    )
    settings = settings_for(of)
    moving = mass + settings.chains.upper * MASS
    touching = settings.law.half_width(settings.largest_displacement, settings.forces.rest) * 2.0
    held = min(max(1.0, touching) * settings.law.stiffness, settings.law.stiffness_under(force))
    critical = 2.0 * math.sqrt(0.6 * held * moving) / settings.chains.upper
    within = [
        0.4 * MASS / (settings.motion.time_step * part) for part in (1.0, 1.3)
    ]  # rows take whole numbers of steps
    if critical < within[1]:
        enough = critical
    else:
        enough = settings.motion.settling_damping
        assert within[1] <= enough <= within[0] * (1.0 + EXACT) or drag >= within[1]
    if enough <= drag <= 10.0 * enough:
        assert settings.motion.settling_damping == drag
    else:
        assert settings.motion.settling_damping == pytest.approx(enough, rel=EXACT)


def test_a_relaxation_without_time_has_steps_in_which_nothing_swings_apart() -> None:
    """Verlet's steps are stable below ω Δt = 2; a fourth of that is left."""
    of = scene(experiment={"kind": "load", "force": 0.5})
    assert per_step(of, settings_for(of)) == pytest.approx(0.5, rel=EXACT)
