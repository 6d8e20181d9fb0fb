"""Equilibrium under a normal force, in time: at rest without noise, as an average over samples with it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from contact1d.analysis.curve import SAMPLE_TABLE
from contact1d.analysis.pressure import mean_pressure
from contact1d.workflow.deck.steps import UnderLoad
from contact1d.workflow.experiments.load.quasistatic import load_outcome, moved_by
from contact1d.workflow.experiments.running.contact import Contact, State
from contact1d.workflow.experiments.running.holding import Held, hold, overshoot, press, stiffness_under
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import (
    BLOCKS,
    SETTLING_LOOKS,
    chunk_steps,
    mean_profile,
    sample_columns,
    standard_error,
)
from contact1d.workflow.experiments.running.trust import ThroughError, UntrustedError, doubts, require_trust
from contact1d.workflow.scene import Load
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE, Quantity

FIRST_RISE = 2.0
"""Rise of the tension that is tried first over the tolerance: rest, table and cutoff use up to one of it themselves."""
DOUBTFUL_SHARE = 0.9
"""Tension over the estimate's largest one from which on it may be the pull-off force."""
LEAST_STEP = 1e-3
"""Steps towards a tension, over the largest one that is expected, below which the tension itself is tried."""
SAMPLES = 200
"""Samples taken before the statistics are judged for the first time, and again each time they are not good enough."""
MOST_SAMPLES = 2_000
BALANCE = 5.0
"""Standard errors by which the mean force may miss the load."""


def load_dynamic(context: RunContext) -> Outcome:
    """d, F, a and F/(πa²) of a scene with `[experiment] kind = "load"`, `method = "dynamic"`.

    Raises:
        UntrustedError: see `hold` and `require_trust`; with noise, also where the mean force misses the load.
    """
    scene = context.deck.scene
    assert isinstance(scene.experiment, Load)
    load = scene.experiment.force
    doubt = {} if scene.noise is not None else _by_a_hair(context, load)
    with context.contact() as contact:
        if scene.noise is not None:
            return _thermal(context, contact, load)
        states, last = _settled(context, contact, load)
        contact.write_state()
        contact.finish()
    settings = context.deck.settings
    error = last.unbalance + law_error(contact.scene, settings, last.last)
    moved = moved_by(states, error, stiffness_under(settings, load))
    outcome = load_outcome(context, tuple(states), contact.phases, error, moved)
    return replace(outcome, warnings=doubt | dict(outcome.warnings))


def _by_a_hair(context: RunContext, load: float) -> dict[str, str]:
    """A warning where a tension is held, or is not, by less than the tolerance: a load that much larger is tried first.

    A contact at rest balances its load within a share of the tolerance, and near the fold of F(d) it creeps: which side
    of it a load is on can't be told nearer than that.
    """
    settings, tolerance = context.deck.settings, context.deck.settings.tolerance
    if load > -DOUBTFUL_SHARE * settings.estimate.pull_off_force():
        return {}
    try:
        with context.contact("whether a little more is held, too") as contact:
            _settled(context, contact, load * (1.0 + FIRST_RISE * tolerance))
    except ThroughError:
        raise
    except UntrustedError:
        return {
            "near_pull_off": (
                f"the contact does not hold a tension that is larger by {FIRST_RISE * tolerance:g}: {-load:.6g} FU is "
                f"the pull-off force as nearly as a tolerance of {tolerance:g} can tell, and whether it is held for "
                'good can\'t be told. A smaller tolerance tells more, kind = "pull_off" gives the force itself'
            )
        }
    return {}


def _settled(context: RunContext, contact: Contact, load: float) -> tuple[list[State], Held]:
    """Hold the load; a tension is approached from a held F = 0, so gently that the plate's momentum breaks nothing."""
    settings = context.deck.settings
    scale, largest = max(abs(load), settings.force_scale), settings.estimate.pull_off_force()
    contact.begin("loading")
    held = press(contact, max(load, 0.0), scale)
    states = list(held.states)
    if load < 0.0 and held.held:
        contact.begin("unloading")
    while held.held and held.load > load:
        past = overshoot(settings, contact.scene.bodies.mass, held.load, -largest)
        gentle = (past * held.load - largest) / (1.0 + past)
        close = gentle >= held.load - LEAST_STEP * largest
        held = hold(contact, load if close else max(load, gentle), scale)
        states += held.states
    if not held.held:
        raise UntrustedError(f"the contact cannot hold {held.load:.4g} FU: the bodies part")
    return states, held


def _thermal(context: RunContext, contact: Contact, load: float) -> Outcome:
    scene, settings = context.deck.scene, context.deck.settings
    steps = chunk_steps(settings)
    contact.begin("settling", expected_steps=SETTLING_LOOKS * steps)
    settling = [_joined(contact, contact.row(UnderLoad(load, steps))) for _ in range(SETTLING_LOOKS)]
    contact.begin("sampling", expected_steps=SAMPLES * steps)
    samples: list[State] = []
    goal = settings.tolerance * max(settings.rest, abs(settings.largest_displacement))
    while len(samples) < MOST_SAMPLES:
        samples += [_joined(contact, contact.row(UnderLoad(load, steps))) for _ in range(SAMPLES)]
        if standard_error([s.displacement for s in samples]) <= goal:
            break
    contact.write_state()
    contact.finish()
    for state in samples:
        require_trust(scene, settings, state)
    carried = [s.carried for s in samples]
    mean_force, force_error = float(np.mean(carried)), standard_error(carried)
    if abs(mean_force - load) > BALANCE * force_error:
        raise UntrustedError(
            f"not in equilibrium: the mean force {mean_force:.4g} FU misses the load {load:.4g} FU by "
            f"{abs(mean_force - load) / force_error:.1f} standard errors"
        )
    return _thermal_outcome(context, contact, (*settling, *samples), samples, (mean_force, force_error), goal)


def _joined(contact: Contact, state: State) -> State:
    """The state, if the bodies still reach each other."""
    if contact.settings.law is not None and state.smallest_distance > contact.settings.cutoff:
        raise UntrustedError(
            "the bodies parted under the load and the noise: take a more compressive experiment.force or a lower "
            "noise.temperature"
        )
    return state


def _thermal_outcome(
    context: RunContext,
    contact: Contact,
    states: tuple[State, ...],
    samples: list[State],
    force: tuple[float, float],
    goal: float,
) -> Outcome:
    scene = context.deck.scene
    assert isinstance(scene.experiment, Load)
    load = scene.experiment.force
    displacement = [s.displacement for s in samples]
    error = standard_error(displacement)
    quantities = {
        "displacement": Quantity(float(np.mean(displacement)), error, LENGTH),
        "force": Quantity(force[0], force[1], FORCE),
    }
    warnings = doubts(scene, context.deck.settings, tuple(samples))
    if error > goal:
        warnings["statistics"] = (
            f"{MOST_SAMPLES} samples give the displacement within {error:.2g} LU only, not the {goal:.2g} LU asked for"
        )
    mean = mean_profile([s.profile for s in samples])
    rule = RadiusRule(scene, context.deck.settings.tolerance)
    radius = rule.of(mean)
    if radius is None:
        warnings["no_radius"] = "the bodies do not touch over a width, so there is no contact radius"
    else:
        blocks = [rule.of(mean_profile([s.profile for s in block])) for block in _blocks(samples)]
        values = [block.value for block in blocks if block is not None]
        spread = float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else radius.value
        pressure = mean_pressure(mean, scene.bodies.spacing, radius.value)
        share = 2 * (spread + radius.uncertainty) / radius.value + force[1] / max(abs(force[0]), 1e-300)
        quantities["contact_radius"] = Quantity(radius.value, spread + radius.uncertainty, LENGTH)
        quantities["mean_pressure"] = Quantity(pressure, abs(pressure) * share, MEAN_PRESSURE)
    radii = {"final": math.nan if radius is None else radius.value}
    table = {SAMPLE_TABLE: sample_columns(states, [load] * len(states), context.deck.settings)}
    return Outcome(quantities, states, {"final": mean}, radii, contact.phases, warnings, tables=table)


def _blocks(samples: list[State]) -> list[list[State]]:
    size = max(1, len(samples) // BLOCKS)
    return [samples[i : i + size] for i in range(0, size * BLOCKS, size)]
