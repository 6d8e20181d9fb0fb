"""Equilibrium under a normal force, by prescribed displacement."""

from __future__ import annotations

import math
from collections.abc import Sequence

from contact1d.analysis.pressure import mean_pressure
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.prescribing import approach, curve_steps
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import doubts
from contact1d.workflow.scene import Load
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE, Quantity

MEANINGLESS_WITHOUT_LOAD = frozenset({"force", "mean_pressure"})
"""What is no result of a contact that is to carry nothing."""
BRANCH_DISTANCE = 0.02
"""Distance of two displacements over the whole way from which on a change is more than interpolation error."""


def load_quasistatic(context: RunContext) -> Outcome:
    """d, F, a and F/(πa²) of a scene with `[experiment] kind = "load"`, `method = "quasistatic"`.

    A tension is approached from F = 0, as an experiment would.

    Raises:
        UntrustedError: see `require_trust`; also where the contact cannot hold the force.
    """
    scene, settings = context.deck.scene, context.deck.settings
    assert isinstance(scene.experiment, Load)
    force = scene.experiment.force
    steps = curve_steps(settings)
    with context.contact() as contact:
        contact.begin("loading")
        states = approach(contact, max(force, 0.0), 0.0, steps=steps)
        if force < 0.0:
            contact.begin("unloading")
            states += approach(contact, force, states[-1].displacement, direction=-1, steps=steps)
        contact.write_state()
        contact.finish()
    final = states[-1]
    unbalance = abs(final.carried - force) + final.residual * settings.particles
    unbalance += law_error(scene, settings, final)
    moved = moved_by(states, unbalance, _stiffness(states))
    return load_outcome(context, tuple(states), contact.phases, unbalance, moved)


def load_outcome(
    context: RunContext,
    states: tuple[State, ...],
    phases: tuple[Phase, ...],
    force_uncertainty: float,
    displacement_uncertainty: float,
) -> Outcome:
    """The results of a load from its last state."""
    scene, final = context.deck.scene, states[-1]
    assert isinstance(scene.experiment, Load)
    quantities = {
        "displacement": Quantity(final.displacement, displacement_uncertainty, LENGTH),
        "force": Quantity(final.force, force_uncertainty, FORCE),
    }
    warnings = doubts(scene, context.deck.settings, states)
    radius = final.radius
    if radius is None or radius.value == 0.0:
        warnings["no_radius"] = "the bodies do not touch over a width, so there is no contact radius"
    else:
        pressure = mean_pressure(final.profile, scene.bodies.spacing, radius.value)
        errors = (force_uncertainty, displacement_uncertainty)
        spread = radius.uncertainty + _radius_spread(context, states, radius.value, errors)
        share = 2 * spread / radius.value + force_uncertainty / max(abs(final.force), 1e-300)
        quantities["contact_radius"] = Quantity(radius.value, spread, LENGTH)
        quantities["mean_pressure"] = Quantity(pressure, abs(pressure) * share, MEAN_PRESSURE)
    radii = {"final": math.nan if radius is None else radius.value}
    by_spacing = {} if radius is None else {"contact_radius": radius.uncertainty}
    if "mean_pressure" in quantities and radius is not None:
        by_spacing["mean_pressure"] = 2 * radius.uncertainty / radius.value * abs(quantities["mean_pressure"].value)
    return Outcome(
        quantities,
        states,
        {"final": final.profile},
        radii,
        phases,
        warnings,
        spacing_uncertainty=by_spacing,
        prescribed=MEANINGLESS_WITHOUT_LOAD if scene.experiment.force == 0.0 else frozenset(),
    )


def beside(states: Sequence[State]) -> list[State]:
    """Up to two states to tell how things change at the last one: one beside it, and one at least twice as far off.

    Nearer than BRANCH_DISTANCE of the way they say less than their own errors.
    """
    final = states[-1]
    others = sorted(states[:-1], key=lambda s: abs(s.displacement - final.displacement))
    least = BRANCH_DISTANCE * max((abs(s.displacement - final.displacement) for s in others), default=0.0)
    found: list[State] = []
    for state in others:
        away = abs(state.displacement - final.displacement)
        if away > 0.0 and away >= least and len(found) < 2:
            found.append(state)
            least = 2.0 * away
    return found


def moved_by(states: Sequence[State], error: float, expected: float) -> float:
    """How far [LU] an error of the force [FU] moves the displacement of the last state.

    x with S x − K x²/2 = error: towards the largest tension the stiffness S = dF/dd falls as K = dS/dd says, and x
    grows as a square root, up to √(2 error/K). S and K are those of a parabola through the states of `beside`; S is at
    most `expected` [FU/LU], which counts alone where there are no such states.
    """
    near = beside(states)
    slopes = [_slope(state, states[-1]) for state in near]
    if len(near) < 2:
        return error / min([expected, *(abs(slope) for slope in slopes if slope)])
    ways = [state.displacement - states[-1].displacement for state in near]
    bend = 2.0 * (slopes[0] - slopes[1]) / (ways[0] - ways[1])
    stiffness = min(expected, slopes[0] - 0.5 * bend * ways[0])
    if bend <= 0.0:
        return error / (stiffness if stiffness > 0.0 else expected)
    root = stiffness**2 - 2.0 * bend * error
    if stiffness <= 0.0 or root <= 0.0:
        return math.sqrt(2.0 * error / bend)
    return 2.0 * error / (stiffness + math.sqrt(root))


def _slope(one: State, other: State) -> float:
    """dF/dd [FU/LU] between two states."""
    return (one.force - other.force) / (one.displacement - other.displacement)


def _radius_spread(context: RunContext, states: Sequence[State], radius: float, errors: tuple[float, float]) -> float:
    """What errors of force [FU] and displacement [LU] make of the radius a [LU], which goes linearly with the latter.

    Where no state beside the last tells da/dd, a/F for da/dF, F at least the expected pull-off force: that of a
    straight line, above that of a curved body.
    """
    final = states[-1]
    near = beside(states)[:1]
    other = near[0].radius if near else None
    if other is None:
        return errors[0] * radius / max(abs(final.force), context.deck.settings.estimate.pull_off_force())
    return errors[1] * abs((other.value - radius) / (near[0].displacement - final.displacement))


def _stiffness(states: list[State]) -> float:
    """dF/dd [FU/LU] at the last state, from the nearest other row."""
    final = states[-1]
    others = [s for s in states if s.displacement != final.displacement and s.force != final.force]
    if not others:
        return math.inf
    near = min(others, key=lambda s: abs(s.displacement - final.displacement))
    return abs((near.force - final.force) / (near.displacement - final.displacement))
