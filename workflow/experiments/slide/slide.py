"""Sliding: a normal force, and a cantilever that pulls the plate along x (Fig. 9 of the paper)."""

from __future__ import annotations

from contact1d.workflow.deck.steps import UnderLoad
from contact1d.workflow.experiments.running.contact import TOLD, Contact, State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import OffEndError, PartedError, UnsteadyError, require_trust
from contact1d.workflow.experiments.slide.findings import LONGER, is_steady, outcome_of
from contact1d.workflow.experiments.slide.loading import loaded
from contact1d.workflow.experiments.slide.motion import motion_of
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.drive import DriveLeg
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.settings.way import contact_half_width


def slide(context: RunContext) -> Outcome:
    """Static and mean friction of a scene with `[experiment] kind = "slide"`.

    friction is the force of the lower body on the upper one against +x. Where the run ends early, or slides steadily
    nowhere, what it has is left in `context.left`.

    Raises:
        UntrustedError: see `loaded` and `require_trust`; the plate runs off the lower body, is torn off, or never
            slides.
    """
    scene, settings = context.deck.scene, context.deck.settings
    experiment = scene.experiment
    assert isinstance(experiment, Slide)
    legs = settings.drive
    with context.contact() as contact:
        rested = loaded(contact, experiment.normal_force)
        states: list[State] = []
        try:
            for number, leg in enumerate(legs):
                contact.begin(leg_name(number), leg_begin(scene, number), expected_steps=leg.rows * leg.steps)
                _drive(contact, experiment.normal_force, leg, states)
            contact.write_state()
            contact.finish()
        except Exception:
            if states:
                context.left = outcome_of(context.deck, rested, states, contact.phases)
            raise
    outcome = outcome_of(context.deck, rested, states, contact.phases)
    if experiment.path is None and (why := is_steady(scene, settings, motion_of(scene, settings, rested, states))):
        context.left = outcome
        raise UnsteadyError(why, LONGER)
    return outcome


def leg_name(number: int) -> str:
    """The phase of a leg: sliding, sliding_2, …"""
    return f"sliding_{number + 1}" if number else "sliding"


def leg_begin(scene: Scene, number: int) -> tuple[str, ...]:
    """The fragments with which it begins."""
    if number:
        return ("steps/turn",)
    return ("steps/drive",) if scene.noise is None else ("steps/drive", TOLD)


def _drive(contact: Contact, force: float, leg: DriveLeg, states: list[State]) -> None:
    """Run the rows of a leg and append their states, as long as they are ones of a slide."""
    scene, settings = contact.scene, contact.settings
    for _ in range(leg.rows):
        state = contact.row(UnderLoad(force, leg.steps))
        _require_above(scene, settings, state)
        require_trust(scene, settings, state)
        states.append(state)


def _require_above(scene: Scene, settings: Settings, state: State) -> None:
    """Refuse a plate that has left the lower body, along it or off it.

    Raises:
        OffEndError, PartedError: where it is, and what helps.
    """
    if state.smallest_distance > settings.cutoff:
        raise PartedError(
            f"the bodies parted on the way, with the plate at {state.plate_x:.4g} LU",
            "take a larger normal_force, or less of a pull" + (", or a lower temperature" if scene.noise else ""),
        )
    if scene.bodies.periodic:
        return
    end = 0.5 * settings.lower_particles * scene.bodies.spacing
    place = abs(state.plate_x + (scene.bodies.upper_offset or 0.0))
    half = contact_half_width(scene, settings)
    if place + half > end + scene.bodies.spacing:
        raise OffEndError(
            f"the plate ran off the lower body: {place:.4g} LU from its middle it reaches {half:.4g} LU further, and "
            f"that ends at {end:.4g} LU",
            "take more bodies.particles, a shorter distance, or more [damping]",
        )
