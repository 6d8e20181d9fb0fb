"""Equilibrium under a normal force, by prescribed displacement."""

from __future__ import annotations

import math

from analysis.pressure import mean_pressure
from workflow.deck import Phase
from workflow.experiments.bench import Bench
from workflow.experiments.contact import State
from workflow.experiments.law import law_error
from workflow.experiments.outcome import Outcome, Quantity, doubts, radius_of
from workflow.experiments.quasistatic import approach
from workflow.units import FORCE, LENGTH, MEAN_PRESSURE

APART = 0.01
"""Difference of two forces over the largest one from which on that of their radii is more than interpolation error."""


def load_quasistatic(bench: Bench) -> Outcome:
    """d, F, a and F/(πa²) of a scene with `[experiment] kind = "load"`, `method = "quasistatic"`.

    A tension is approached from F = 0, as an experiment would.

    Raises:
        UntrustedError: see `require_trust`; also where the contact cannot hold the force.
    """
    scene, settings = bench.deck.scene, bench.deck.settings
    assert scene.experiment.kind == "load"
    force = scene.experiment.force
    with bench.contact() as contact:
        contact.begin("loading", "displace")
        states = approach(contact, max(force, 0.0), 0.0)
        if force < 0.0:
            contact.begin("unloading", "displace")
            states += approach(contact, force, states[-1].displacement, direction=-1)
        contact.write_state()
        contact.finish()
    final = states[-1]
    stiffness = _stiffness(states)
    unbalance = abs(final.force - force) + final.residual * settings.particles
    unbalance += law_error(scene, settings, final)
    return load_outcome(bench, tuple(states), contact.phases, unbalance, unbalance / stiffness)


def load_outcome(
    bench: Bench,
    states: tuple[State, ...],
    phases: tuple[Phase, ...],
    force_uncertainty: float,
    displacement_uncertainty: float,
) -> Outcome:
    """The results of a load from its last state."""
    scene, final = bench.deck.scene, states[-1]
    quantities = {
        "displacement": Quantity(final.displacement, displacement_uncertainty, LENGTH),
        "force": Quantity(final.force, force_uncertainty, FORCE),
    }
    warnings = doubts(scene, bench.deck.settings, states)
    radius = radius_of(scene, final.profile)
    if radius is None or radius.value == 0.0:
        warnings["no_radius"] = "the bodies do not touch over a width, so there is no contact radius"
    else:
        pressure = mean_pressure(final.profile, scene.bodies.spacing, radius.value)
        spread = radius.uncertainty + _radius_slope(bench, states, radius.value) * force_uncertainty
        share = 2 * spread / radius.value + force_uncertainty / max(abs(final.force), 1e-300)
        quantities["contact_radius"] = Quantity(radius.value, spread, LENGTH)
        quantities["mean_pressure"] = Quantity(pressure, abs(pressure) * share, MEAN_PRESSURE)
    radii = {"final": math.nan if radius is None else radius.value}
    lattice = {} if radius is None else {"contact_radius": radius.uncertainty}
    if "mean_pressure" in quantities and radius is not None:
        lattice["mean_pressure"] = 2 * radius.uncertainty / radius.value * abs(quantities["mean_pressure"].value)
    return Outcome(quantities, states, {"final": final.profile}, radii, phases, warnings, lattice=lattice)


def _radius_slope(bench: Bench, states: tuple[State, ...], radius: float) -> float:
    """|da/dF| [LU/FU] at the last state, with the radius a [LU], from the nearest row that is APART from it in force.

    Where there is no such, or its bodies do not touch, a/F, F at least the expected pull-off force: that of a straight
    line, above that of a curved body.
    """
    scene, final = bench.deck.scene, states[-1]
    scale = max(abs(state.force) for state in states)
    others = [state for state in states if abs(state.force - final.force) > APART * scale]
    near = min(others, key=lambda state: abs(state.force - final.force), default=final)
    other = radius_of(scene, near.profile)
    if near is final or other is None:
        return radius / max(abs(final.force), bench.deck.settings.estimate.pull_off_force())
    return abs((other.value - radius) / (near.force - final.force))


def _stiffness(states: list[State]) -> float:
    """dF/dd [FU/LU] at the last state, from the nearest other row."""
    final = states[-1]
    others = [s for s in states if s.displacement != final.displacement and s.force != final.force]
    if not others:
        return math.inf
    near = min(others, key=lambda s: abs(s.displacement - final.displacement))
    return abs((near.force - final.force) / (near.displacement - final.displacement))
