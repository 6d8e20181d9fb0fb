"""Results that follow from others: the work of adhesion that an interaction implies, and those of the body.

w = ∫ −f dr from the force-free distance on separates a particle from the opposite chain of spacing s: w/s per length
of chain. As the edge of a contact of radius a recedes by da, a length da of chain separates at both ends, and the ring
2πa da of the body's surface:

    mdr:           2 (w/s) da = W 2πa da                          W = w/(π s a)
    geike_popov:   two equal spheres, half as wide as the image   W = 4w/(π s a),   a the image's

JKR's body has one W for every a, and the chain one w/s: they are equal at one radius only, that of the run. The
difference is estimated from the force, F_A = (3/2) πWR_e, R_e = R with the MDR and R/2 for the two spheres.

Stiffness: springs E* per length that touch over 2a make dF/dd = 2E*a, which is Galin's and Sneddon's relation of any
axisymmetric body.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache

import numpy as np

from contact1d.analysis.pressure import Array
from contact1d.potentials import DoubleExponential
from contact1d.workflow.body.cases import Case
from contact1d.workflow.body.reading import product
from contact1d.workflow.body.theory import tabor
from contact1d.workflow.body.traction import BodyPressure, body_pressures, is_of_a_body
from contact1d.workflow.continuation.outcome import MODEL, Made, Outcome, Result, in_squares
from contact1d.workflow.continuation.reduction import PRESSURE
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.pairs import row_force
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import ENERGY, FORCE, LINE_PRESSURE, MEAN_PRESSURE, NUMBER, Quantity

REPORTED = ("deepest", "final", "zero_load")
"""States whose pressure is a result: the first of them that a run has."""
RADII = ("contact_radius", "largest_radius", "zero_load_radius")
ERRORS = ("displacement", "force", "largest_force", *RADII)
"""Results whose relative uncertainty, discretisation error included, is also that of the pressure; for springs on a
plane, whose pressure is a function of the radius, that of the radius alone."""
FORMULAS = {
    "mdr": "W = w/(π s a), a the contact radius: as it shrinks by da, two lengths da of chain and the ring 2πa da "
    "of the body's surface separate (mdr). The uncertainty is the difference from F_A = (3/2)πWR",
    "geike_popov": "W = 4w/(π s a), a the image's half-width, twice the contact radius of the two equal spheres that "
    "geike_popov represents: as it shrinks by da, two lengths da of chain and the ring (π/2)a da of their surface "
    "separate. The uncertainty is the difference from F_A = (3/4)πWR",
}
"""The definition of W in words, by reduction."""


def first_of(results: Mapping[str, Quantity], *names: str) -> Quantity | None:
    """Return the first of the named results that a run has; None where it has none of them."""
    return next((results[name] for name in names if name in results), None)


def with_implied(scene: Scene, settings: Settings, outcome: Outcome) -> Outcome:
    """Return the outcome of a run with the results that its interaction implies; unchanged without an attraction."""
    quantities = implied(scene, settings, outcome.quantities)
    return _with_results(outcome, {name: (quantity, 0.0) for name, quantity in quantities.items()})


def _with_results(outcome: Outcome, made: Made) -> Outcome:
    """Return the outcome with further results; the uncertainty of W is that of the model, of others of the input.

    `made`: (quantity, uncertainty of inputs) by name. A pressure that may be 0, as under a punch without load, has the
    scale of the largest force over a².
    """
    sources = {"work_of_adhesion": MODEL}
    radii = (quantity.value for name, quantity in outcome.quantities.items() if name.endswith("radius"))
    radius = max(radii, default=0.0)
    pressure = max(abs(state.force) for state in outcome.states) / radius**2 if radius > 0.0 else None
    results = {}
    for name, (quantity, given) in made.items():
        is_zero = quantity.unit == MEAN_PRESSURE and abs(quantity.value) <= quantity.uncertainty
        errors = {sources.get(name, "input"): quantity.uncertainty + given}
        results[name] = Result(quantity.value, quantity.unit, errors, pressure if is_zero else None, given=given)
    return replace(outcome, results={**outcome.results, **results})


def implied(scene: Scene, settings: Settings, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return `separation_energy`, w/s [FU], and of a sphere `work_of_adhesion` [FU/LU]; {} without an attraction.

    Args:
        scene: the scene of the run.
        settings: its settings.
        results: its results; without a radius above 0 there is no W.
    """
    if settings.forces.law is None or settings.forces.law.attraction is None:
        return {}
    spacing, spheres = scene.bodies.spacing, scene.bodies.reduction == "geike_popov"
    line = product(1.0 / spacing, FORCE, (_work(settings.forces.law, spacing), 1.0))
    quantities = {"separation_energy": line}
    radius, curvature = first_of(results, "zero_load_radius", "contact_radius"), scene.bodies.profile.curvature_radius
    if radius is None or curvature is None or not radius.value > 0.0:
        return quantities
    energy = product((4.0 if spheres else 1.0) / math.pi, LINE_PRESSURE, (line, 1.0), (radius, -1.0))
    tension = results.get("adhesion_force", Quantity(settings.law.pull_off_force(), 0.0, FORCE))
    effective = 0.5 if spheres else 1.0  # R_e/R
    jkr = product(1.0 / (1.5 * math.pi * effective * curvature), LINE_PRESSURE, (tension, 1.0))
    spread = energy.uncertainty + abs(energy.value - jkr.value) + jkr.uncertainty
    return quantities | {"work_of_adhesion": Quantity(energy.value, spread, LINE_PRESSURE)}


def formulas(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, dict[str, str]]:
    """Return {"formulas": {result: formula in words}} for results.json, of results with more than one definition.

    {} where the run has none of these.
    """
    texts = {
        "separation_energy": "w/s: w = ∫ −f dr separates one particle from the opposite chain, s the spacing; energy "
        "per length of chain",
        "work_of_adhesion": FORMULAS[scene.bodies.reduction],
    }
    present = {name: text for name, text in texts.items() if name in quantities}
    return {"formulas": present} if present else {}


@lru_cache(maxsize=16)  # scenes run one after the other mostly share their law
def _work(law: DoubleExponential, spacing: float, points: int = 8000) -> Quantity:
    """Return w [FU·LU] ≥ 0 of one particle and a chain of this spacing [LU], by the trapezoidal rule.

    Its uncertainty is the difference from twice the step. `points`: of the distance, up to the end of the range.
    """
    end = law.cutoff_for(1e-10)
    r = np.linspace(end / points, end, points)
    force = row_force(law, r, spacing, end)

    def work(values: Array, step: float) -> float:
        """Return the largest work [FU·LU] ≥ 0 of the attraction from a distance on, by forces (n,) at a `step` [LU]."""
        inwards = np.cumsum(0.5 * (values[1:] + values[:-1])[::-1]) * step
        return float(max(-inwards.min(), 0.0))

    fine = work(force, end / points)
    return Quantity(fine, abs(fine - work(force[1::2], 2.0 * end / points)), ENERGY)


def pressures_of(scene: Scene, outcome: Outcome) -> dict[str, BodyPressure]:
    """Return p(r) of the reported states by name, as uncertain as the results of which it is a function.

    {} where the run represents no body; a state without a contact radius is left out.
    """
    exact = outcome.exact
    shares = {
        name: result.uncertainty / outcome.results[name].size
        for name in ERRORS
        if (result := exact.get(name)) and result.value
    }
    radius = next((shares[name] for name in RADII if name in shares), 0.0)
    critical = exact.get("critical_radius")
    radii = dict.fromkeys(outcome.profiles, radius)
    if critical and critical.value and "critical" in radii:
        radii["critical"] = max(radius, critical.uncertainty / critical.value)
    given = {name: _pressure_share(scene, outcome, name) for name in outcome.profiles}
    return body_pressures(scene, outcome.profiles, radii, sum(shares.values()), given)


def _pressure_share(scene: Scene, outcome: Outcome, state: str) -> float:
    """Return the relative change of the pressures of a state due to the uncertain numbers of the scene.

    0 without any.
    """
    names = {PRESSURE, PRESSURE + state} & {name for move in outcome.moves for name in move.changes}
    if names and scene.is_stepped:
        return float(in_squares(outcome.moves, max(names)))
    return sum(given / size.value for size, given in outcome.made(scene, _pressure_size).values())


def _pressure_size(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return {"pressure": E* g(a)/a [FU/LU²]}, to which pressures are proportional.

    That is exact of a power, with adhesion at F = 0. {} without a contact radius above 0, and of a body with an edge.
    The uncertainty is 0.
    """
    radius = first_of(results, *RADII)
    if radius is None or not radius.value > 0.0 or scene.bodies.profile.has_edge:
        return {}
    height = float(scene.bodies.height(np.asarray([radius.value]))[0])
    layer = scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
    return {"pressure": Quantity(layer * height / radius.value, 0.0, MEAN_PRESSURE)} if height > 0.0 else {}


def with_body(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """Return the outcome with the results of the body: pressures, stiffness, adhesion energy and Tabor parameter.

    "central_pressure", "peak_pressure" and "mean_pressure" [FU/LU²], "contact_stiffness" [FU/LU], "adhesion_energy"
    [FU·LU] and "tabor_parameter", as far as there are any; unchanged where the run represents no body.

    Args:
        scene: the scene of the run.
        outcome: its outcome.
        pressures: p(r) of its states by name; a singular pressure is no result.
    """
    if not is_of_a_body(scene):
        return outcome
    of_pressure: Made = {}
    share = max((_pressure_share(scene, outcome, name) for name in reported_state(outcome)), default=0.0)
    for name in reported_state(outcome):
        if pressure := pressures.get(name):
            # The residual force of the state at F = 0 is distributed over the contact.
            residual = abs(outcome.marked[name].force) / pressure.contact_radius**2 if name == "zero_load" else 0.0
            given = {key: share * abs(result.value) for key, result in pressure.results.items()}
            of_pressure = {
                key: (replace(result, uncertainty=result.uncertainty - given[key] + residual), given[key])
                for key, result in pressure.results.items()
            }
    # Without an attraction dF/dd is that of springs in equilibrium.
    if "pressed" in law_of(scene).closed_forms and not (scene.interaction or scene.noise):
        for name in reported_state(outcome):
            if (pressure := pressures.get(name)) and pressure.stiffness:
                of_pressure["contact_stiffness"] = (pressure.stiffness, share * pressure.stiffness.value)
    makers = (_contact_results, _adhesion_energy, _tabor)
    made = {name: quantity for make in makers for name, quantity in outcome.made(scene, make).items()}
    return _with_results(outcome, of_pressure | made)


def reported_state(outcome: Outcome) -> list[str]:
    """Return a list of the one state whose pressures are results: "deepest", "final" or "zero_load".

    Empty without these.
    """
    return [name for name in REPORTED if name in outcome.profiles][:1]


def _contact_results(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return F/πa² [FU/LU²], where the experiment has none, and dF/dd = 2E*a [FU/LU] of elastic bodies, by name.

    "mean_pressure" and "contact_stiffness", without the latter for an interaction. {} without a force, or a radius
    above 0.
    """
    force = first_of(results, "force", "largest_force")
    radius = first_of(results, "contact_radius", "largest_radius")
    made: dict[str, Quantity] = {}
    if radius is None or force is None or not radius.value > 0.0:
        return made
    if "mean_pressure" not in results:
        made["mean_pressure"] = product(1.0 / math.pi, MEAN_PRESSURE, (force, 1.0), (radius, -2.0))
    if scene.interaction is None and Case(scene, results).is_elastic:
        stiffness = 2.0 * scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
        made["contact_stiffness"] = product(stiffness, LINE_PRESSURE, (radius, 1.0))
    return made


def _tabor(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return {"tabor_parameter": µ} of a body with a radius of curvature, where the attraction has a range; else {}."""
    mu = tabor(Case(scene, results)) if scene.work_of_adhesion else None
    return {} if mu is None else {"tabor_parameter": Quantity(mu, 0.0, NUMBER)}


def _adhesion_energy(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return {"adhesion_energy": …} [FU·LU]: πa²W on a plane with adhesion, 2a w/s with an interaction.

    {} without a radius or an adhesion; with a range most of the energy is that of the cohesive zone.
    """
    a, line = first_of(results, "zero_load_radius", "contact_radius"), results.get("separation_energy")
    # With a range most of the energy is that of the cohesive zone.
    if a is not None and scene.work_of_adhesion and not law_of(scene).range_of(scene, 0.0):
        return {"adhesion_energy": product(math.pi * scene.work_of_adhesion, ENERGY, (a, 2.0))}
    return {} if a is None or line is None else {"adhesion_energy": product(2.0, ENERGY, (a, 1.0), (line, 1.0))}
