"""Whether the body's results contradict the run: ∫ p dA beside the force, an exact closed form beside the results."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from contact1d.workflow.body.cases import Case
from contact1d.workflow.body.theory import exact
from contact1d.workflow.body.traction import BodyPressure
from contact1d.workflow.continuation.outcome import Agreement, Outcome
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity

PRESSURE, OPEN_PRESSURE = 1e-4, 1e-3
"""Difference of ∫ p dA from the force over ∫ |p| dA, by springs under a formula, and under a table or a scan."""
CLOSED_FORM, DOUBT = 1e-4, 3.0
"""Difference from an exact closed form, relative, beside so many uncertainties."""
FEWEST, WIDEST = 10.0, 0.9
"""Contact radii over the spacing from which on closed forms are compared, and up to which over the half-width."""


def pressure(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> dict[str, Agreement]:
    """∫ p dA of each reported state beside the force, which is as uncertain as the forces of the run.

    Under a given force the displacement is, which moves ∫ p dA. Nothing of particles that interact.
    """
    if scene.interaction is not None:
        return {}
    found, shape = [], scene.bodies.profile
    rows = {name: sum(outcome.rows.get(name, {}).values()) for name in ("force", "displacement")}
    least = OPEN_PRESSURE if shape.alternatives or shape.deviations or shape.slow else PRESSURE
    for name, one in pressures.items():
        state = outcome.marked[name]
        at = next((i for i, other in enumerate(outcome.states) if other is state), None)
        known, moved = (
            0.0 if at is None else float(np.broadcast_to(row, len(outcome.states))[at]) for row in rows.values()
        )
        known += moved * (one.stiffness.value if one.stiffness else 0.0)
        force, size = state.force, float(np.trapezoid(np.abs(one.pressure) * one.r, one.r))
        stated = float(np.trapezoid(one.uncertainty * one.r, one.r)) / size if size else 0.0
        words = f"the pressure of the state {name!r} adds up to {one.force:.8g} FU, and its force is {force:.8g} FU"
        allowed = max(least, stated + one.doubt + known / (one.size or 1.0))
        found.append(Agreement(abs(one.force - force) / (one.size or 1.0), allowed, words))
    return {"pressure": max(found, key=lambda one: one.difference / one.allowed)} if found else {}


def closed_form(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Agreement]:
    """The results beside each closed form that is exact for the run; `quantities`: as if its inputs were exact."""
    radius = max((one.value for name, one in quantities.items() if name.endswith("radius")), default=0.0)
    bodies, reach = scene.bodies, scene.bodies.profile.reach
    if bodies.particles != "auto" and bodies.own_count is None:  # the chain itself is the body
        return {}
    if radius < FEWEST * scene.bodies.spacing or (radius > WIDEST * reach and not scene.bodies.profile.has_edge):
        return {}
    case, found = Case(scene, quantities), []
    for form in exact(case):
        for name, value in form.values(case).items():
            if name in quantities and value:
                ours = quantities[name]
                allowed = CLOSED_FORM + DOUBT * ours.uncertainty / abs(value)
                words = f"{name} is {ours.value:.8g} {ours.unit}, and {value:.8g} {ours.unit} by {form.name}"
                found.append(Agreement(abs(ours.value / value - 1.0), allowed, words))
    return {"closed_form": max(found, key=lambda one: one.difference / one.allowed)} if found else {}
