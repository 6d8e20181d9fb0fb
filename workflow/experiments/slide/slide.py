"""Sliding: a normal force, and a cantilever that pulls the plate along x at a steady velocity (Fig. 9 of the paper)."""

from __future__ import annotations

import math

import numpy as np

from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.holding import hold
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps, standard_error
from contact1d.workflow.experiments.running.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, Quantity

ROWS_PER_SPACING = 50
"""Measured states per spacing of the drive's way."""
SLIDING = 1.0
"""Way of the plate over the spacing from which on it slides: one period of the other body."""
STEADY = 0.1
"""Mean velocities of plate and drive may differ by this share where sliding counts as steady."""


def slide(context: RunContext) -> Outcome:
    """Static and mean friction of a scene with `[experiment] kind = "slide"`.

    friction is the force of the lower body on the upper one against the sliding. The cantilever's force has the drag of
    [damping] and of the plate on top of it, which belongs to the bath and not to the contact; friction.csv holds both.
    The static friction is the largest value until the plate has moved by one spacing; the mean one is taken over the
    second half of the way, in which the plate must keep up with the drive.

    Raises:
        UntrustedError: see `hold` and `require_trust`; also where the drive never makes the plate slide.
    """
    scene, settings = context.deck.scene, context.deck.settings
    experiment = scene.experiment
    assert isinstance(experiment, Slide)
    rows, stride = slide_rows(scene, settings)
    with context.contact() as contact:
        loaded = _loaded(contact, experiment.normal_force)
        contact.begin("sliding", ("steps/drive",), expected_steps=rows * stride)
        states = [contact.row(UnderLoad(experiment.normal_force, stride)) for _ in range(rows)]
        contact.write_state()
        contact.finish()
    for state in states:
        require_trust(scene, settings, state)
    return _outcome(context, loaded, states, contact.phases)


def _loaded(contact: Contact, force: float) -> State:
    """At rest under the normal force; with noise, after it has forgotten its start."""
    if contact.scene.noise is None:
        contact.begin("loading")
        return hold(contact, force, force).last
    steps = chunk_steps(contact.settings)
    contact.begin("loading", expected_steps=SETTLING_LOOKS * steps)
    return [contact.row(UnderLoad(force, steps)) for _ in range(SETTLING_LOOKS)][-1]


def slide_rows(scene: Scene, settings: Settings) -> tuple[int, int]:
    """(rows, timesteps of each) that bring the drive over the distance of a slide."""
    experiment, cantilever = scene.experiment, scene.cantilever
    assert isinstance(experiment, Slide)
    assert cantilever is not None
    rows = max(20, math.ceil(ROWS_PER_SPACING * experiment.distance / scene.bodies.spacing))
    return rows, max(1, round(experiment.distance / cantilever.velocity / settings.time_step / rows))


def _outcome(context: RunContext, loaded: State, states: list[State], phases: tuple[Phase, ...]) -> Outcome:
    scene, settings = context.deck.scene, context.deck.settings
    assert scene.cantilever is not None
    friction = np.asarray([-scene.bodies.spacing * float(s.profile.shear.sum()) for s in states])
    time = np.asarray([s.step - loaded.step for s in states]) * settings.time_step
    steady = friction[len(friction) // 2 :]
    place = np.asarray([s.plate_x for s in states])
    top = int(np.argmax(np.where(place < SLIDING * scene.bodies.spacing, friction, -np.inf)))
    half = len(states) // 2
    speed = float((place[-1] - place[half]) / (time[-1] - time[half]))
    if abs(speed / scene.cantilever.velocity - 1.0) > STEADY:
        raise UntrustedError(
            f"no steady sliding yet: over the second half of the way the plate moves at {speed:.3g} LU/TU and the "
            f"drive at {scene.cantilever.velocity:.3g}: take a longer experiment.distance or a stiffer cantilever"
        )
    if states[-1].plate_x < SLIDING * scene.bodies.spacing:
        raise UntrustedError(
            f"the plate moved by {states[-1].plate_x:.3g} LU only, which is no sliding yet: take a longer "
            "experiment.distance or a stiffer cantilever"
        )
    missed = float(np.max(np.abs(np.diff(friction[max(0, top - 1) : top + 1])), initial=0.0))
    quantities = {
        "mean_friction": Quantity(float(steady.mean()), standard_error(steady.tolist()), FORCE),
        "static_friction": Quantity(float(friction[top]), missed, FORCE),
    }
    columns = {
        "time": tuple(time.tolist()),
        "drive": tuple((scene.cantilever.velocity * time).tolist()),
        "plate_x": tuple(s.plate_x for s in states),
        "plate_z": tuple(-s.displacement for s in states),
        "friction": tuple(friction.tolist()),
        "normal_force": tuple(s.force for s in states),
        "cantilever_force": tuple(s.cantilever_force for s in states),
    }
    last = states[-1]
    radius = last.radius
    radii = {"final": math.nan if radius is None else radius.value}
    warnings = doubts(scene, settings, tuple(states))
    return Outcome(quantities, (loaded, *states), {"final": last.profile}, radii, phases, warnings, columns)
