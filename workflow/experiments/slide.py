"""Slide: a normal force, and a cantilever that pulls the plate along x (Fig. 9 of the paper).

The slide starts from rest under the normal force. A plate with little drag would swing past its equilibrium while it is
loaded, and through the other body: during the loading the particles have a drag that is critical for the contact, and
at rest that of the scene again. The plate is at rest where it is so along both directions, with the friction equal to
the pull of the cantilever.
"""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar

from contact1d.analysis.friction import FEWEST_PERIODS
from contact1d.digits import apart
from contact1d.workflow.continuation.contact import HEAT_FRAGMENT, Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.holding import MOST_HOLDS, Start, at_rest, hold, hold_row
from contact1d.workflow.continuation.outcome import Outcome
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import doubts, require_trust
from contact1d.workflow.deck.steps import Phase, UnderLoad, numbered
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments.experiment import Experiment
from contact1d.workflow.experiments.motion import Motion, motion_of
from contact1d.workflow.experiments.thermal import run_in
from contact1d.workflow.model.dynamics import MOST_ROWS, MOVING_TOLERANCE
from contact1d.workflow.model.motion import contact_half_width, too_fast
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.units import FORCE

LONGER = "use a longer experiment.distance or a stiffer cantilever"
"""Advice for a slide that is not yet steady."""


class SlideExperiment(Experiment[Slide]):
    """Static and mean friction: the force of the lower body on the upper one against +x.

    Where the run ends early, or the sliding is never steady, `context.left` has the outcome up to there.
    """

    main_results = ("mean_friction", "static_friction")
    start: ClassVar[tuple[str, ...]] = ("steps/drive",)

    def run(self, context: RunContext) -> Outcome:
        """Load, then drive leg by leg, and return the outcome.

        From the first load step of the drive on `context.left` has the outcome up to the end, also of a run that fails.

        Raises:
            UntrustedError: the plate does not come to rest under the load, runs off the lower body, or separates;
                bodies pass through each other; or, without a given path, the plate never slides steadily.
            EngineError: LAMMPS failed.
        """
        scene, settings = context.inputs
        load, legs = self.given(scene).normal_force, self.planned(scene, settings)[1:]
        with context.contact() as contact:
            states = [self.loaded(contact, load)]
            try:
                for leg in legs:
                    for row in contact.begin_phase(leg):
                        state = contact.row(row, trusted=False)
                        _require_contact(scene, settings, state)
                        require_trust(scene, settings, state)
                        states.append(state)
                contact.write_state()
                contact.finish()
            finally:
                if states[1:]:
                    motion = motion_of(scene, settings, load, states)
                    context.left = outcome = outcome_of(motion, states, contact.phases)
        if self.given(scene).path is None and motion.unsteady:
            raise UntrustedError(motion.unsteady, LONGER)
        return outcome

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the schedule, "loading" and a phase "sliding" for each leg, numbered from the second on.

        The load steps in which the plate relaxes along x, whose number is not known, are left out.
        """
        load, phases = self.given(scene).normal_force, list[Phase]()
        for leg in settings.motion.drive:
            name = numbered("sliding", [phase.name for phase in phases])
            begin = ("steps/turn",) if phases else self.start
            phases.append(Phase(name, (UnderLoad(load, leg.steps),) * leg.rows, begin=begin))
        phases[-1] = replace(phases[-1], state=True)
        return self.loading(scene, settings, load), *phases

    def loading(self, scene: Scene, settings: Settings, force: float) -> Phase:
        """Return the phase "loading", as planned, in which the normal force [FU], compression positive, is applied.

        It has one load step with the drag of the loading, and another with the drag of the scene where that differs.
        """
        scale = abs(force) or settings.forces.scale
        rows = [hold_row(scene, _loading_settings(settings), force, scale, Start.KEPT)]
        if settings.motion.settling_damping != settings.motion.damping:
            rows.append(hold_row(scene, settings, force, scale, Start.HERE))
        return Phase("loading", tuple(rows))

    def loaded(self, contact: Contact, force: float) -> State:
        """Apply the normal force [FU], compression positive, and return the state at rest, with the drag of the scene.

        Raises:
            UntrustedError: the bodies separate under it; the plate does not come to rest along z or along x; on the
                path bodies pass through each other, or the contact reaches the end of a chain.
            EngineError: LAMMPS failed.
        """
        phase = self.loading(contact.scene, contact.settings, force)
        scale = abs(force) or contact.settings.forces.scale
        contact.begin(phase.name)
        held = hold(contact, force, scale, settings=_loading_settings(contact.settings))
        if not held.held:
            raise UntrustedError(
                f"the contact does not sustain {force:.4g} FU: the bodies separate", "use a smaller tension"
            )
        state = _settled_along_x(contact, force, scale, held.last)
        for row in phase.rows[1:]:  # with the drag of the scene again
            state = contact.row(row, trusted=False)
        return state

    def advice(self, scene: Scene) -> str:
        """Return the advice to average over a longer distance, as text without a full stop.

        It says as well that this does not improve the static friction.
        """
        leg = "experiment.distance" if self.given(scene).path is None else "last leg of experiment.path that moves"
        return (
            f"Use a longer {leg}, with more whole periods of the spacing; this does not improve static_friction, whose "
            f"uncertainty is the change between two of {MOST_ROWS} points in a spacing"
        )


class ThermalSlide(SlideExperiment):
    """A slide under noise: it begins when the contact has forgotten its start, and its heat baths are measured."""

    is_statistical = True
    start = ("steps/drive", HEAT_FRAGMENT)

    def loading(self, scene: Scene, settings: Settings, force: float) -> Phase:
        """Return the phase "loading" of the run-in under the normal force [FU], compression positive: 40 load steps."""
        return run_in("loading", settings, force)

    def loaded(self, contact: Contact, force: float) -> State:
        """Run in under the normal force [FU], compression positive, and return the last state, whether at rest or not.

        Raises:
            EngineError: LAMMPS failed.
        """
        phase = self.loading(contact.scene, contact.settings, force)
        return contact.rows(contact.begin_phase(phase), trusted=False)[-1]


def outcome_of(motion: Motion, states: list[State], phases: tuple[Phase, ...]) -> Outcome:
    """Return the outcome of a finished slide, or of the part before a failure, with its tables "slips" and "friction".

    The last state is marked "final". "slips" has the columns "time" [TU] of its end, "place" and "size" [LU] of each
    slip, "friction" the columns of the motion's series, with a row for each load step, without the start.
    """
    tables = {
        "slips": {name: tuple(getattr(slip, name) for slip in motion.slips) for name in ("time", "place", "size")},
        "friction": motion.series.chosen(slice(1, None)).table(),
    }
    warnings = doubts(motion.scene, motion.settings, tuple(states)) | _warnings(motion)
    return Outcome(motion.results, tuple(states), {"final": states[-1]}, phases, warnings, tables=tables)


def _warnings(motion: Motion) -> dict[str, str]:
    """Return the warnings of a slide by name; {} for none.

    "fast": the drive passes a particle in less than its period; "unsteady": the drive moves, and no mean friction
    results; "drag": the drag at the drive's velocity exceeds the largest friction; "energy": the residual of the energy
    balance exceeds 0.5 % of its largest term.
    """
    settings, top, work = motion.settings, motion.largest[FORCE], motion.results["cantilever_work"]
    fastest, warnings = max(abs(leg.velocity) for leg in settings.motion.drive), {}
    if fast := too_fast(motion.scene):
        warnings["fast"] = fast
    if fastest and "mean_friction" not in motion.results:
        warnings["unsteady"] = (
            "the last leg on which the drive moves has too few whole periods of the spacing for a mean friction: make "
            f"it longer than {FEWEST_PERIODS} spacings"
        )
    if (drag := settings.drag() * fastest) > top:
        dragged, most = apart(drag, top)
        warnings["drag"] = (
            f"the viscous drag at the drive's velocity, {dragged} FU, exceeds the friction of the contact, "
            f"at most {most} FU, and suppresses slips of the plate. Use "
            "a lower cantilever.velocity, or less [damping] and [plate] damping"
        )
    if work.share > 5e-3:
        warnings["energy"] = (
            f"the residual of the energy balance is {work.uncertainty:.2g} FU·LU, {work.share:.1g} "
            "of its largest term: use an [accuracy] tolerance below "
            f"{MOVING_TOLERANCE:g}, which shortens the timesteps"
        )
    return warnings


def _loading_settings(settings: Settings) -> Settings:
    """Return a copy of the settings with the drag of the loading, critical for the contact, on each particle."""
    return replace(settings, motion=replace(settings.motion, damping=settings.motion.settling_damping))


def _settled_along_x(contact: Contact, force: float, scale: float, state: State) -> State:
    """Continue from a state until the plate is at rest along x as well, and return the state there.

    At rest the friction equals the pull of the cantilever, and the drag on the moving plate is as small as their
    difference may be. The state is returned as it is where that holds already.

    Args:
        contact: the running contact.
        force: normal force [FU], compression positive.
        scale: force [FU] to which the tolerance is relative.
        state: the state to begin with.

    Raises:
        UntrustedError: it does not come to rest, bodies pass through each other, or the contact reaches the end of a
            chain.
    """
    scene, settings = contact.scene, _loading_settings(contact.settings)
    steps = max(1, round(settings.motion.settle_time / settings.motion.time_step))
    row = replace(hold_row(scene, settings, force, scale, Start.HERE), rest=0.0, steps=steps)
    near, drag = at_rest(settings, scale), settings.drag()
    for _ in range(MOST_HOLDS):
        friction = -scene.bodies.own_spacing * float(state.profile.shear.sum())
        if max(abs(friction - state.cantilever_force), drag * abs(state.motion["vcm(plate,x)"])) <= near:
            return state
        state = contact.row(row)
    speed = state.motion["vcm(plate,x)"]
    raise UntrustedError(
        f"the plate did not come to rest along x under {force:.4g} FU within {MOST_HOLDS * steps} timesteps: it "
        f"moves at {speed:.2g} LU/TU",
        "use more [damping] or a stiffer cantilever",
    )


def _require_contact(scene: Scene, settings: Settings, state: State) -> None:
    """Refuse a plate that has left the lower body, along it or off it; nothing is returned.

    Raises:
        UntrustedError: the contact is beyond the end of the lower body, but not with periodic bodies; or the bodies
            have separated: no particle is within the cutoff of the other body.
    """
    if state.smallest_distance > settings.forces.cutoff:
        raise UntrustedError(
            f"the bodies separated while sliding, with the plate at {state.plate_x:.4g} LU",
            "use a larger normal_force, or a smaller tensile one" + (", or a lower temperature" if scene.noise else ""),
        )
    if scene.bodies.periodic:
        return
    end = 0.5 * settings.chains.lower * scene.bodies.spacing
    position = abs(state.plate_x + (scene.bodies.upper_offset or 0.0))
    half = contact_half_width(scene, settings)
    if position + half > end + scene.bodies.spacing:
        raise UntrustedError(
            f"the plate slid off the lower body: at {position:.4g} LU from the middle its half-width is {half:.4g} LU, "
            f"and the lower body ends at {end:.4g} LU",
            "use more bodies.particles, a shorter distance, or more [damping]",
        )
