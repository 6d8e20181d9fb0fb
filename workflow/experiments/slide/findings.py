"""What is read off a slide: friction after the run-in, slips, energies, temperature of the plate, doubts."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from contact1d.analysis import friction
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.trust import doubts
from contact1d.workflow.experiments.slide.motion import Motion, motion_of
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.dynamics import MOVING_TOLERANCE
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.settings.way import cantilever_swing, too_fast
from contact1d.workflow.units import ENERGY, FORCE, NUMBER, Quantity

STEADY = 0.1
"""Way of plate and drive after the run-in may differ by this share, or by one slip, where sliding counts as steady."""
SETTINGS_SHARE = 0.3
"""Of the tolerance: what cutoff and timesteps leave open at most; against the integrator 0.05 was measured."""
LONGER = "take a longer experiment.distance or a stiffer cantilever"
"""What makes a steady slide of one that is none yet."""
TEMPERATURE_BLOCKS = 20
"""Parts of the last leg whose spread gives the error of its temperature."""
CLOSED = 5e-3
"""Work that is neither dissipated nor stored, over the largest of the three, from which on it is told."""


def outcome_of(deck: Deck, loaded: State, states: list[State], phases: tuple[Phase, ...]) -> Outcome:
    """The result of a slide that is over, or of what there is of one that ended early."""
    scene, settings = deck.scene, deck.settings
    motion = motion_of(scene, settings, loaded, states)
    found = slips_of(scene, motion)
    quantities = energies(motion) | {"slips": Quantity(float(len(found)), 0.0, NUMBER)} | means(scene, settings, motion)
    quantities |= temperature(scene, settings, motion)
    last = states[-1]
    return Outcome(
        quantities,
        (loaded, *states),
        {"final": last.profile},
        {"final": math.nan if last.radius is None else last.radius.value},
        phases,
        _doubts(scene, settings, motion, quantities, (loaded, *states)),
        _columns(motion, states),
        tables={"slips": {name: tuple(getattr(slip, name) for slip in found) for name in ("time", "place", "size")}},
        compared_with=_scales(quantities, motion),
    )


def means(scene: Scene, settings: Settings, motion: Motion) -> dict[str, Quantity]:
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
        found["mean_friction"] = Quantity(mean.value, mean.error + tolerance * abs(mean.value), FORCE)
        found["mean_cantilever_force"] = Quantity(pull, friction.interval(pulled) + tolerance * abs(pull), FORCE)
    if number == _first_moving(motion) and way[-1] - way[0] >= scene.bodies.spacing:
        top, missed = friction.largest_before(force, way, scene.bodies.spacing)
        found["static_friction"] = Quantity(top, missed + tolerance * abs(top), FORCE)
    return found


def temperature(scene: Scene, settings: Settings, motion: Motion) -> dict[str, Quantity]:
    """M ⟨(V − ⟨V⟩)²⟩ of the plate's free directions in the last leg [FU·LU]; slips are part of it."""
    if scene.noise is None or scene.plate is None:
        return {}
    rows = motion.of_leg(int(motion.leg[-1]))
    time = motion.time[rows]
    length = (time[-1] - time[0]) / TEMPERATURE_BLOCKS
    squares, speeds = (friction.block_means(time, values[rows], length) for values in (motion.squares, motion.place))
    blocks = settings.plate_mass * (squares - float(speeds.mean()) ** 2) / len(scene.plate.free)
    return {"plate_temperature": Quantity(float(blocks.mean()), friction.interval(blocks), ENERGY)}


def energies(motion: Motion) -> dict[str, Quantity]:
    """Work of the cantilever, what the baths took of it and what is stored; what is missing is uncertain in each."""
    ends = {
        "cantilever_work": float(motion.work[-1]),
        "dissipated_energy": float(motion.dissipated[-1]),
        "stored_energy": float(motion.stored[-1]),
    }
    open_ = abs(ends["cantilever_work"] - ends["dissipated_energy"] - ends["stored_energy"])
    return {name: Quantity(value, open_, ENERGY) for name, value in ends.items()}


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
            f"no steady sliding yet: the drive's way of {motion.drive[-1]:.3g} LU has {periods} of "
            f"the spacing, and a mean needs {friction.DROPPED + friction.FEWEST_BLOCKS}"
        )
    if motion.place[-1] < spacing:
        found = f"the plate moved by {motion.place[-1]:.3g} LU only, which is no sliding yet"
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
    """That the plate swings on its cantilever for longer than the whole way took; "" where it does not."""
    swing = cantilever_swing(scene, settings)
    if swing < motion.time[-1]:
        return ""
    return (
        f". On its cantilever the plate of {settings.plate_mass:.3g} MU swings once in {swing:.3g} TU, and the drive's "
        f"way took {motion.time[-1]:.3g} TU: a lower cantilever.velocity or a lighter plate.mass gives it time, too"
    )


def _first_moving(motion: Motion) -> int | None:
    return next((i for i, leg in enumerate(motion.legs) if leg.velocity and (motion.leg == i).any()), None)


def _last_moving(motion: Motion) -> int | None:
    there = [i for i, leg in enumerate(motion.legs) if leg.velocity and (motion.leg == i).any()]
    return there[-1] if there else None


def _scales(quantities: Mapping[str, Quantity], motion: Motion) -> dict[str, float]:
    """What an uncertainty is compared with: means may vanish beside the friction of the way, energies beside a work."""
    force = max(float(np.max(np.abs(motion.friction))), 1e-300)
    energy = max(float(np.max(np.abs(values))) for values in (motion.work, motion.dissipated, motion.stored))
    units = {FORCE: force, ENERGY: max(energy, 1e-300)}
    return {name: units[known.unit] for name, known in quantities.items() if known.unit in units}


def _doubts(
    scene: Scene, settings: Settings, motion: Motion, quantities: Mapping[str, Quantity], states: tuple[State, ...]
) -> dict[str, str]:
    found = doubts(scene, settings, states)
    if fast := too_fast(scene):
        found["fast"] = fast
    moves = any(leg.velocity for leg in motion.legs)
    if moves and "mean_friction" not in quantities:
        found["unsteady"] = (
            "the last leg on which the drive moves has too few whole periods of the spacing for a mean friction: make "
            f"it longer than {friction.DROPPED + friction.FEWEST_BLOCKS} spacings"
        )
    drag = settings.particles * settings.damping + settings.plate_damping
    fastest = max(abs(leg.velocity) for leg in motion.legs)
    top = float(np.max(np.abs(motion.friction)))
    if drag * fastest > top:
        found["drag"] = (
            f"the drag on what moves, {drag * fastest:.3g} FU at the drive's velocity, is more than the contact's own "
            f"friction of up to {top:.3g} FU: it holds the plate to the drive's pace and keeps it from slipping. Take "
            "a lower cantilever.velocity, or less [damping] and [plate] damping"
        )
    energy = quantities["cantilever_work"].uncertainty
    largest = max(float(np.max(np.abs(values))) for values in (motion.work, motion.dissipated, motion.stored))
    if energy > CLOSED * largest:
        found["energy"] = (
            f"{energy:.2g} FU·LU of the cantilever's work were neither dissipated nor stored, {energy / largest:.1g} "
            "of the largest of the three: take an [accuracy] tolerance below "
            f"{MOVING_TOLERANCE:g}, whose timesteps are shorter"
        )
    return found


def _columns(motion: Motion, states: list[State]) -> dict[str, tuple[float, ...]]:
    """friction.csv: one line for each row."""
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
