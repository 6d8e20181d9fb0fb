"""Slide: a normal force, and a cantilever that pulls the plate along x (Fig. 9 of the paper).

It starts from rest under the normal force. A plate with little drag swings as it is loaded, past its equilibrium and
through the other body: so the particles have a drag of their own on the path, critical for the contact, and at rest
that of the scene again. It counts as at rest where it is along both directions, the friction equal to the pull of
the cantilever.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from contact1d.analysis import friction
from contact1d.digits import apart
from contact1d.workflow.continuation.contact import TOLD, Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.holding import MOST_HOLDS, Start, at_rest, hold, hold_row
from contact1d.workflow.continuation.outcome import Outcome, Result
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import (
    OffEndError,
    PartedError,
    RestlessError,
    UnsteadyError,
    doubts,
    require_trust,
)
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase, UnderLoad
from contact1d.workflow.experiments.experiment import Experiment
from contact1d.workflow.experiments.motion import Motion, motion_of
from contact1d.workflow.experiments.thermal import SETTLING_LOOKS, chunk_steps, sampled_phase
from contact1d.workflow.model.dynamics import MOST_ROWS, MOVING_TOLERANCE, DriveLeg
from contact1d.workflow.model.motion import cantilever_swing, contact_half_width, too_fast
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.units import ENERGY, FORCE, NUMBER

STEADY = 0.1
"""Way of plate and drive after the run-in may differ by this share, or by one slip, where sliding counts as steady."""
SETTINGS_SHARE = 0.3
"""Of the tolerance: what cutoff and timesteps leave open at most; against the integrator 0.05 was measured."""
LONGER = "use a longer experiment.distance or a stiffer cantilever"
"""What makes a steady slide of one that is none yet."""
TEMPERATURE_BLOCKS = 20
"""Parts of the last leg whose spread gives the error of its temperature."""
CLOSED = 5e-3
"""Residual of the energy balance, over its largest term, from which on it is reported."""


class SlideExperiment(Experiment[Slide]):
    """Static and mean friction: the force of the lower body on the upper one against +x.

    Where the run ends early, or slides steadily nowhere, what it has is left in `context.left`.
    """

    main_results = ("mean_friction", "static_friction")

    def run(self, context: RunContext) -> Outcome:
        """Load, then drive leg by leg.

        Raises:
            UntrustedError: see `loaded` and `require_trust`; the plate runs off the lower body, parts, or never slides.
        """
        scene, settings = context.deck.scene, context.deck.settings
        experiment = scene.experiment
        assert isinstance(experiment, Slide)
        with context.contact() as contact:
            rested = loaded(contact, experiment.normal_force)
            states: list[State] = []
            try:
                for number, leg in enumerate(settings.motion.drive):
                    contact.begin(leg_name(number), leg_begin(scene, number), expected_steps=leg.rows * leg.steps)
                    _drive(contact, experiment.normal_force, leg, states)
                contact.write_state()
                contact.finish()
            except Exception:
                if states:
                    context.left = outcome_of(context.deck, rested, states, contact.phases)
                raise
        outcome = outcome_of(context.deck, rested, states, contact.phases)
        motion = motion_of(scene, settings, rested, states)
        if experiment.path is None and (why := is_steady(scene, settings, motion)):
            context.left = outcome
            raise UnsteadyError(why, LONGER)
        return outcome

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The schedule, without the relaxation under the normal force."""
        assert isinstance(scene.experiment, Slide)
        force, legs = scene.experiment.normal_force, settings.motion.drive
        sliding = (
            Phase(
                leg_name(i), (UnderLoad(force, leg.steps),) * leg.rows, state=i == len(legs) - 1,
                begin=leg_begin(scene, i),
            )
            for i, leg in enumerate(legs)
        )  # fmt: skip
        return loading_phase(scene, settings, force), *sliding

    def advice(self, scene: Scene) -> str:
        """The uncertainty of a mean depends on the averaging length."""
        assert isinstance(scene.experiment, Slide)
        way = "experiment.distance" if scene.experiment.path is None else "last leg of experiment.path that moves"
        return (
            f"Use a longer {way}, with more whole periods of the spacing; this does not improve static_friction, whose "
            f"uncertainty is the change between two of {MOST_ROWS} points in a spacing"
        )


def outcome_of(deck: Deck, loaded: State, states: list[State], phases: tuple[Phase, ...]) -> Outcome:
    """The result of a finished slide, or of the part before a failure."""
    scene, settings = deck.scene, deck.settings
    motion = motion_of(scene, settings, loaded, states)
    found = slips_of(scene, motion)
    results = energies(motion) | {"slips": Result(float(len(found)), NUMBER, {"statistics": 0.0})}
    results |= means(scene, settings, motion) | temperature(scene, settings, motion)
    scales = _scales(results, motion)
    results = {name: replace(one, scale=scales.get(name)) for name, one in results.items()}
    warnings = _doubts(scene, settings, motion, results, (loaded, *states))
    tables = {
        "slips": {name: tuple(getattr(slip, name) for slip in found) for name in ("time", "place", "size")},
        "friction": _columns(motion, states),
    }
    return Outcome(results, (loaded, *states), {"final": states[-1]}, phases, warnings, tables=tables)


def means(scene: Scene, settings: Settings, motion: Motion) -> dict[str, Result]:
    """Friction and cantilever force over whole periods of the last leg that moves, as far as it has enough of them."""
    number = _last_moving(motion)
    if number is None:
        return {}
    leg, rows = motion.legs[number], motion.of_leg(number)
    sign, period = math.copysign(1.0, leg.velocity), scene.bodies.spacing / abs(leg.velocity)
    time, way = motion.time[rows], sign * motion.place[rows]
    tolerance = SETTINGS_SHARE * settings.tolerance
    found = {}
    smooth = scene.noise is None  # a force under heat at an instant says little of the time around it
    force, pulls = sign * motion.friction[rows], sign * motion.pull[rows]
    blocks = friction.block_means(time, sign * motion.impulse[rows], period, force if smooth else None)
    if blocks.size >= friction.DROPPED + friction.FEWEST_BLOCKS:
        mean = friction.mean_of(blocks)
        if not smooth:
            mean = min(mean, friction.sampled_mean(time, force, period), key=lambda one: one.error)
        pulled = friction.block_means(time, sign * motion.pulled[rows], period, pulls if smooth else None)[mean.first :]
        pull = float(pulled.mean())
        found["mean_friction"] = Result(
            mean.value, FORCE, {"statistics": mean.error, "solver": tolerance * abs(mean.value)}
        )
        found["mean_cantilever_force"] = Result(
            pull, FORCE, {"statistics": friction.interval(pulled), "solver": tolerance * abs(pull)}
        )
    if number == _first_moving(motion) and way[-1] - way[0] >= scene.bodies.spacing:
        for name, curve in (("static_friction", force), ("static_cantilever_force", pulls)):
            top, missed = friction.largest_before(curve, way, scene.bodies.spacing)
            found[name] = Result(top, FORCE, {"sampling": missed, "solver": tolerance * abs(top)})
    return found


def temperature(scene: Scene, settings: Settings, motion: Motion) -> dict[str, Result]:
    """M ⟨(V − ⟨V⟩)²⟩ of the plate's free directions in the last leg [FU·LU]; slips are part of it."""
    if scene.noise is None or scene.plate is None:
        return {}
    rows = motion.of_leg(int(motion.leg[-1]))
    time = motion.time[rows]
    length = (time[-1] - time[0]) / TEMPERATURE_BLOCKS
    squares, speeds = (friction.block_means(time, values[rows], length) for values in (motion.squares, motion.place))
    blocks = settings.motion.plate_mass * (squares - float(speeds.mean()) ** 2) / len(scene.plate.free)
    return {"plate_temperature": Result(float(blocks.mean()), ENERGY, {"statistics": friction.interval(blocks)})}


def energies(motion: Motion) -> dict[str, Result]:
    """Work of the cantilever, dissipated and stored energy; the residual of the balance is the uncertainty of each."""
    ends = {
        "cantilever_work": float(motion.work[-1]),
        "dissipated_energy": float(motion.dissipated[-1]),
        "stored_energy": float(motion.stored[-1]),
    }
    open_ = abs(ends["cantilever_work"] - ends["dissipated_energy"] - ends["stored_energy"])
    results = {name: Result(value, ENERGY, {"solver": open_}) for name, value in ends.items()}
    return results | {"stored_energy": replace(results["stored_energy"], prescribed=True)}


def slips_of(scene: Scene, motion: Motion) -> list[friction.Slip]:
    """The slips of all legs."""
    found = []
    for number, leg in enumerate(motion.legs):
        if leg.velocity and (motion.leg == number).any():
            rows = motion.of_leg(number)
            found += friction.slips(motion.time[rows], motion.place[rows], scene.bodies.spacing, leg.velocity)
    return found


def is_steady(scene: Scene, settings: Settings, motion: Motion) -> str:
    """Why a slide of one leg is none, or not yet a steady one; "" where it is. LONGER helps."""
    leg, spacing = motion.legs[0], scene.bodies.spacing
    period = spacing / abs(leg.velocity)
    blocks = friction.block_means(motion.time, motion.impulse, period)
    if blocks.size < friction.DROPPED + friction.FEWEST_BLOCKS:
        periods = "1 whole period" if blocks.size == 1 else f"{blocks.size} whole periods"
        return (
            f"no steady sliding yet: the drive distance of {motion.drive[-1]:.3g} LU has {periods} of "
            f"the spacing, and a mean needs {friction.DROPPED + friction.FEWEST_BLOCKS}"
        )
    if motion.place[-1] < spacing:
        found = f"the plate moved by {motion.place[-1]:.3g} LU only, which is not yet sliding"
        return found + _swing(scene, settings, motion)
    start = motion.time[-1] - period * (blocks.size - friction.mean_of(blocks).first)
    while_ = motion.time[-1] - start
    way = float(motion.place[-1] - np.interp(start, motion.time, motion.place))
    sizes = [slip.size for slip in slips_of(scene, motion) if slip.time > start]
    one = max(sizes) if len(sizes) > 1 else 0.0
    if abs(way - leg.velocity * while_) > max(STEADY * leg.velocity * while_, one):
        return (
            f"no steady sliding yet: over the last {while_:.3g} TU the plate moves at {way / while_:.3g} LU/TU and the "
            f"drive at {leg.velocity:.3g}{_swing(scene, settings, motion)}"
        )
    return ""


def _swing(scene: Scene, settings: Settings, motion: Motion) -> str:
    """That the period of the plate on its cantilever is longer than the slide; "" where it is not."""
    swing = cantilever_swing(scene, settings)
    if swing < motion.time[-1]:
        return ""
    return (
        f". The plate of {settings.motion.plate_mass:.3g} MU on its cantilever has a period of {swing:.3g} TU, and the "
        f"drive moved for {motion.time[-1]:.3g} TU: a lower cantilever.velocity or a lighter plate.mass helps, too"
    )


def _first_moving(motion: Motion) -> int | None:
    return next((i for i, leg in enumerate(motion.legs) if leg.velocity and (motion.leg == i).any()), None)


def _last_moving(motion: Motion) -> int | None:
    there = [i for i, leg in enumerate(motion.legs) if leg.velocity and (motion.leg == i).any()]
    return there[-1] if there else None


def _scales(results: Mapping[str, Result], motion: Motion) -> dict[str, float]:
    """What an uncertainty is compared with: means may vanish beside the friction of the way, energies beside a work."""
    force = max(float(np.max(np.abs(motion.friction))), 1e-300)
    energy = max(float(np.max(np.abs(values))) for values in (motion.work, motion.dissipated, motion.stored))
    units = {FORCE: force, ENERGY: max(energy, 1e-300)}
    return {name: units[known.unit] for name, known in results.items() if known.unit in units}


def _doubts(
    scene: Scene, settings: Settings, motion: Motion, results: Mapping[str, Result], states: tuple[State, ...]
) -> dict[str, str]:
    found = doubts(scene, settings, states)
    if fast := too_fast(scene):
        found["fast"] = fast
    moves = any(leg.velocity for leg in motion.legs)
    if moves and "mean_friction" not in results:
        found["unsteady"] = (
            "the last leg on which the drive moves has too few whole periods of the spacing for a mean friction: make "
            f"it longer than {friction.DROPPED + friction.FEWEST_BLOCKS} spacings"
        )
    drag = settings.drag()
    fastest = max(abs(leg.velocity) for leg in motion.legs)
    top = float(np.max(np.abs(motion.friction)))
    if drag * fastest > top:
        dragged, most = apart(drag * fastest, top)
        found["drag"] = (
            f"the viscous drag at the drive's velocity, {dragged} FU, exceeds the friction of the contact, "
            f"at most {most} FU, and suppresses slips of the plate. Use "
            "a lower cantilever.velocity, or less [damping] and [plate] damping"
        )
    energy = results["cantilever_work"].uncertainty
    largest = max(float(np.max(np.abs(values))) for values in (motion.work, motion.dissipated, motion.stored))
    if energy > CLOSED * largest:
        found["energy"] = (
            f"the residual of the energy balance is {energy:.2g} FU·LU, {energy / largest:.1g} "
            "of its largest term: use an [accuracy] tolerance below "
            f"{MOVING_TOLERANCE:g}, which shortens the timesteps"
        )
    return found


def _columns(motion: Motion, states: list[State]) -> dict[str, tuple[float, ...]]:
    """friction.csv: one line for each load step."""
    return {
        "time": tuple(motion.time[1:].tolist()),
        "drive": tuple(motion.drive[1:].tolist()),
        "plate_x": tuple(motion.place[1:].tolist()),
        "plate_z": tuple(-state.displacement for state in states),
        "friction": tuple(motion.friction[1:].tolist()),
        "normal_force": tuple(state.force for state in states),
        "cantilever_force": tuple(motion.pull[1:].tolist()),
        "cantilever_work": tuple(motion.work[1:].tolist()),
    }


def loading_phase(scene: Scene, settings: Settings, force: float) -> Phase:
    """The planned application of the normal force."""
    if scene.noise is not None:
        return sampled_phase("loading", settings, force, SETTLING_LOOKS)
    scale = abs(force) or settings.forces.scale
    rows = [hold_row(scene, _calm(settings), force, scale, Start.KEPT)]
    if settings.motion.calm_damping != settings.motion.damping:
        rows.append(hold_row(scene, settings, force, scale, Start.HERE))
    return Phase("loading", tuple(rows))


def loaded(contact: Contact, force: float) -> State:
    """At rest under the normal force; with noise, after it has forgotten its start.

    Raises:
        PartedError: the bodies separate under it.
        UntrustedError: see `hold`; or the plate oscillates on along x.
    """
    scene, settings = contact.scene, contact.settings
    if scene.noise is not None:
        steps = chunk_steps(settings)
        contact.begin("loading", expected_steps=SETTLING_LOOKS * steps)
        return [contact.row(UnderLoad(force, steps), trusted=False) for _ in range(SETTLING_LOOKS)][-1]
    contact.begin("loading")
    scale = abs(force) or settings.forces.scale
    held = hold(contact, force, scale, settings=_calm(settings))
    if not held.held:
        raise PartedError(f"the contact does not sustain {force:.4g} FU: the bodies separate", "use a smaller tension")
    state = _settled_along(contact, force, scale, held.last)
    if settings.motion.calm_damping == settings.motion.damping:
        return state
    return contact.row(hold_row(scene, settings, force, scale, Start.HERE), trusted=False)


def _calm(settings: Settings) -> Settings:
    return replace(settings, motion=replace(settings.motion, damping=settings.motion.calm_damping))


def _settled_along(contact: Contact, force: float, scale: float, state: State) -> State:
    """The state when the plate is at rest along x as well."""
    scene, settings = contact.scene, _calm(contact.settings)
    row = replace(hold_row(scene, settings, force, scale, Start.HERE), rest=0.0)
    row = replace(row, steps=max(1, round(settings.motion.settle_time / settings.motion.time_step)))
    near, drag = at_rest(settings, scale), settings.drag()
    for _ in range(MOST_HOLDS):
        friction = -scene.bodies.own_spacing * float(state.profile.shear.sum())
        if max(abs(friction - state.cantilever_force), drag * abs(state.motion["vcm(plate,x)"])) <= near:
            return state
        state = contact.row(row)
    speed = state.motion["vcm(plate,x)"]
    raise RestlessError(
        f"the plate did not come to rest along x under {force:.4g} FU within {MOST_HOLDS * row.steps} timesteps: it "
        f"moves at {speed:.2g} LU/TU",
        "use more [damping] or a stiffer cantilever",
    )


def leg_name(number: int) -> str:
    """The phase of a leg: sliding, sliding_2, …"""
    return f"sliding_{number + 1}" if number else "sliding"


def leg_begin(scene: Scene, number: int) -> tuple[str, ...]:
    """The fragments with which it begins."""
    if number:
        return ("steps/turn",)
    return ("steps/drive",) if scene.noise is None else ("steps/drive", TOLD)


def _drive(contact: Contact, force: float, leg: DriveLeg, states: list[State]) -> None:
    """Run the load steps of a leg and append their states, until the bodies separate or the plate slides off."""
    scene, settings = contact.scene, contact.settings
    for _ in range(leg.rows):
        state = contact.row(UnderLoad(force, leg.steps), trusted=False)
        _require_above(scene, settings, state)
        require_trust(scene, settings, state)
        states.append(state)


def _require_above(scene: Scene, settings: Settings, state: State) -> None:
    """Refuse a plate that has left the lower body, along it or off it.

    Raises:
        OffEndError, PartedError: where it is, with a suggested fix.
    """
    if state.smallest_distance > settings.forces.cutoff:
        raise PartedError(
            f"the bodies separated while sliding, with the plate at {state.plate_x:.4g} LU",
            "use a larger normal_force, or a smaller tensile one" + (", or a lower temperature" if scene.noise else ""),
        )
    if scene.bodies.periodic:
        return
    end = 0.5 * settings.chains.lower * scene.bodies.spacing
    place = abs(state.plate_x + (scene.bodies.upper_offset or 0.0))
    half = contact_half_width(scene, settings)
    if place + half > end + scene.bodies.spacing:
        raise OffEndError(
            f"the plate slid off the lower body: at {place:.4g} LU from the middle its half-width is {half:.4g} LU, "
            f"and the lower body ends at {end:.4g} LU",
            "use more bodies.particles, a shorter distance, or more [damping]",
        )
