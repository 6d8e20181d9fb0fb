"""Equilibrium under a normal force, by prescribed displacement."""

from __future__ import annotations

import math

from analysis.pressure import mean_pressure
from workflow.deck import Phase
from workflow.experiments.bench import Bench
from workflow.experiments.contact import State
from workflow.experiments.outcome import Outcome, Quantity, doubts, law_share, radius_of
from workflow.experiments.quasistatic import approach
from workflow.units import FORCE, LENGTH, MEAN_PRESSURE


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
    unbalance += law_share(scene, settings) * abs(final.force)
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
        share = 2 * radius.uncertainty / radius.value + force_uncertainty / max(abs(final.force), 1e-300)
        quantities["contact_radius"] = Quantity(radius.value, radius.uncertainty, LENGTH)
        quantities["mean_pressure"] = Quantity(pressure, abs(pressure) * share, MEAN_PRESSURE)
    radii = {"final": math.nan if radius is None else radius.value}
    return Outcome(quantities, states, {"final": final.profile}, radii, phases, warnings)


def _stiffness(states: list[State]) -> float:
    """dF/dd [FU/LU] at the last state, from the nearest other row."""
    final = states[-1]
    others = [s for s in states if s.displacement != final.displacement and s.force != final.force]
    if not others:
        return math.inf
    near = min(others, key=lambda s: abs(s.displacement - final.displacement))
    return abs((near.force - final.force) / (near.displacement - final.displacement))
