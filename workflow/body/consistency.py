"""Whether the body's results contradict the run: ∫ p dA against the force, results against an exact closed form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from contact1d.workflow.body.cases import Case
from contact1d.workflow.body.theory import exact
from contact1d.workflow.body.traction import BodyPressure
from contact1d.workflow.continuation.outcome import Agreement, Outcome
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity


def pressure(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> dict[str, Agreement]:
    """Return {"pressure": `Agreement`}: the relative difference of ∫ p dA of the body and the force of the run.

    The difference is |∫ p dA − F| over ∫ |p| dA of one state; of several the one that is largest relative to what is
    allowed. Allowed is the relative uncertainty of pressure and force, and 1e-4 at least, for a profile given by a
    table or a scan 1e-3. The force has the uncertainty of that load step, to which that of its displacement adds by the
    stiffness; a state that is no load step has neither. {} with an interaction, or without pressures.

    Args:
        scene: the scene of the run.
        outcome: its outcome; KeyError where it has no marked state of a name.
        pressures: by the name of a state.
    """
    if scene.interaction is not None:
        return {}
    agreements, shape = [], scene.bodies.profile
    rows = [sum(outcome.rows.get(name, {}).values()) for name in ("force", "displacement")]
    # Relative to ∫ |p| dA, for a profile given by a table or a scan and for one given by a formula.
    least = 1e-3 if shape.alternatives or shape.deviations or shape.slow else 1e-4
    for name, body in pressures.items():
        marked = outcome.marked[name]
        index = next((i for i, state in enumerate(outcome.states) if state is marked), None)
        force_error, displacement_error = (
            0.0 if index is None else float(np.broadcast_to(row, len(outcome.states))[index]) for row in rows
        )
        force_error += displacement_error * (body.stiffness.value if body.stiffness else 0.0)
        force, size = marked.force, float(np.trapezoid(np.abs(body.pressure) * body.r, body.r))
        stated = float(np.trapezoid(body.uncertainty * body.r, body.r)) / size if size else 0.0
        words = f"the pressure of the state {name!r} adds up to {body.force:.8g} FU, and its force is {force:.8g} FU"
        allowed = max(least, stated + body.doubt + force_error / (body.size or 1.0))
        agreements.append(Agreement(abs(body.force - force) / (body.size or 1.0), allowed, words))
    return _worst("pressure", agreements)


def closed_form(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Agreement]:
    """Return {"closed_form": `Agreement`}: relative difference of a result from an exact closed form.

    Of several results it is the difference that is largest relative to what is allowed, 1e-4 plus three times the
    relative uncertainty of the result. {} where no exact closed form predicts a result other than 0, where the scene
    gives the number of particles (but for a body with an edge, such as a flat punch), with a contact radius below 10
    spacings, and with one above 90 % of the half-width of a body without an edge.

    Args:
        scene: the scene of the run.
        quantities: the results as if the inputs were exact, by name; the largest one whose name ends in "radius" counts
            as the contact radius.
    """
    radius = max((quantity.value for name, quantity in quantities.items() if name.endswith("radius")), default=0.0)
    bodies, reach = scene.bodies, scene.bodies.profile.reach
    if bodies.particles != "auto" and bodies.own_count is None:  # the chain itself is the body
        return {}
    if radius < 10.0 * scene.bodies.spacing or (radius > 0.9 * reach and not scene.bodies.profile.has_edge):
        return {}
    case, agreements = Case(scene, quantities), []
    for form in exact(case):
        for name, value in form.values(case).items():
            if name in quantities and value:
                ours = quantities[name]
                allowed = 1e-4 + 3.0 * ours.uncertainty / abs(value)
                words = f"{name} is {ours.value:.8g} {ours.unit}, and {value:.8g} {ours.unit} by {form.name}"
                agreements.append(Agreement(abs(ours.value / value - 1.0), allowed, words))
    return _worst("closed_form", agreements)


def _worst(name: str, agreements: Sequence[Agreement]) -> dict[str, Agreement]:
    """Return {name: the agreement whose difference is largest relative to the allowed one}; {} without agreements."""
    if not agreements:
        return {}
    return {name: max(agreements, key=lambda agreement: agreement.difference / agreement.allowed)}
