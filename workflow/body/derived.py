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
from contact1d.workflow.laws.numerics import value_at
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
    """Return the result of the first of the `names`, in their order, that is in `results`; None where none is."""
    return next((results[name] for name in names if name in results), None)


def with_implied(scene: Scene, settings: Settings, outcome: Outcome) -> Outcome:
    """Return a copy of the outcome with the results that the attraction of [interaction] implies.

    Without such an attraction the copy is equal to the outcome. Added are "separation_energy" [FU], the work w that
    separates a particle from the opposite chain, over the spacing, and, of a profile with a radius of curvature and a
    contact radius above 0, "work_of_adhesion" [FU/LU].
    """
    quantities = implied(scene, settings, outcome.quantities)
    return _with_results(outcome, {name: (quantity, 0.0) for name, quantity in quantities.items()})


def _with_results(outcome: Outcome, made: Made) -> Outcome:
    """Return a copy of the outcome with the results of `made` added; they replace results of the same name.

    Each has one error, the uncertainty of the quantity plus that of its inputs: from the source "model" for
    "work_of_adhesion", else "input". A pressure [FU/LU²] that is 0 within its uncertainty has the scale max |F|/a²,
    with a the largest result whose name ends in "radius"; without an a above 0 it has no scale.

    Args:
        outcome: the outcome, with one state at least.
        made: (quantity, uncertainty by the inputs in its unit), by name.
    """
    radii = (quantity.value for name, quantity in outcome.quantities.items() if name.endswith("radius"))
    radius = max(radii, default=0.0)
    pressure = max(abs(state.force) for state in outcome.states) / radius**2 if radius > 0.0 else None
    results = {}
    for name, (quantity, given) in made.items():
        is_zero = quantity.unit == MEAN_PRESSURE and abs(quantity.value) <= quantity.uncertainty
        source = MODEL if name == "work_of_adhesion" else "input"
        errors = {source: quantity.uncertainty + given}
        results[name] = Result(quantity.value, quantity.unit, errors, pressure if is_zero else None, given=given)
    return replace(outcome, results={**outcome.results, **results})


def implied(scene: Scene, settings: Settings, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return the results that the attraction of [interaction] implies, by name; {} without an attraction.

    "separation_energy" is w/s [FU], the work that separates a particle from the opposite chain, over the spacing;
    "work_of_adhesion" [FU/LU] is W = w/(πsa), with the reduction of Geike and Popov 4w/(πsa). There is no W where the
    profile has no radius of curvature, or the results have no radius a above 0. The uncertainty of W also includes its
    difference from the W that follows by JKR from the pull-off force: the result "adhesion_force", or without it the
    one expected by the law.

    Args:
        scene: the scene of the run.
        settings: its settings.
        results: its results: a is "zero_load_radius", else "contact_radius", as read off the particles.
    """
    if settings.forces.law is None or settings.forces.law.attraction is None:
        return {}
    spacing = scene.bodies.spacing
    # The area that separates, 2πa da, over that of the body, with a of the image, and R_e/R.
    factor, effective = (4.0, 0.5) if scene.bodies.reduction == "geike_popov" else (1.0, 1.0)
    line = product(1.0 / spacing, FORCE, (_work(settings.forces.law, spacing), 1.0))
    quantities = {"separation_energy": line}
    radius, curvature = first_of(results, "zero_load_radius", "contact_radius"), scene.bodies.profile.curvature_radius
    if radius is None or curvature is None or not radius.value > 0.0:
        return quantities
    energy = product(factor / math.pi, LINE_PRESSURE, (line, 1.0), (radius, -1.0))
    tension = results.get("adhesion_force", Quantity(settings.law.pull_off_force(), 0.0, FORCE))
    jkr = product(1.0 / (1.5 * math.pi * effective * curvature), LINE_PRESSURE, (tension, 1.0))
    spread = energy.uncertainty + abs(energy.value - jkr.value) + jkr.uncertainty
    return quantities | {"work_of_adhesion": Quantity(energy.value, spread, LINE_PRESSURE)}


def formulas(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, dict[str, str]]:
    """Return {"formulas": {name: definition in words}} of "separation_energy" and "work_of_adhesion".

    One that is not in `quantities` is left out; {} where the run has neither. The definition of W depends on the
    reduction of the scene.
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
    """Return w [FU·LU] ≥ 0, the work that separates one particle from a straight opposite chain; cached.

    It is the largest ∫ −f dr (f repulsion positive) from any distance to the end of the range, by the trapezoidal rule;
    0 without tension. Its uncertainty is the difference from twice the step.

    Args:
        law: interaction of a pair.
        spacing: of the chain [LU].
        points: number of distances up to the end of the range.
    """
    end = law.cutoff_for(1e-10)
    r = np.linspace(end / points, end, points)
    force = row_force(law, r, spacing, end)

    def work(values: Array, step: float) -> float:
        """Return the largest work [FU·LU] ≥ 0 against attraction from any of the distances to the last one.

        0 without attraction. `values`: forces, (n,) [FU], repulsion positive, at rising distances a `step` [LU] apart.
        """
        inwards = np.cumsum(0.5 * (values[1:] + values[:-1])[::-1]) * step
        return float(max(-inwards.min(), 0.0))

    fine = work(force, end / points)
    return Quantity(fine, abs(fine - work(force[1::2], 2.0 * end / points)), ENERGY)


def pressures_of(scene: Scene, outcome: Outcome) -> dict[str, BodyPressure]:
    """Return the pressure p(r) of each marked state of the run, by the name of the state.

    Left out are states without a contact radius above 0, or with too few particles in contact. {} where the run
    represents no axisymmetric body: with noise, in a slide, of a flat profile, on a rigid chain, and with the reduction
    of Geike and Popov, unless two equal spheres stand for it. The uncertainty of p includes the relative ones of
    displacement, force and radii of the run, added up; under linear springs on a plane, of a body without an edge, that
    of the contact radius alone, in the state "critical" of the critical radius, if that is larger.

    Raises:
        ValueError: no radius can be read off a profile: too few particles, or tension where the law has none.
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
    moved = {name: _displacement_error(scene, outcome, name) for name in outcome.profiles}
    return body_pressures(scene, outcome.profiles, radii, sum(shares.values()), given, moved)


def _displacement_error(scene: Scene, outcome: Outcome, state: str) -> float:
    """Return the error [LU] ≥ 0 of the displacement of a marked state but for uncertain inputs, with that of its force
    over 2E*a, a the half-width of the body; 0 of a body without an edge.

    Of a state that is no load step it is the largest one of all load steps.
    """
    if not scene.bodies.profile.has_edge:
        return 0.0
    index = [i for i, passed in enumerate(outcome.states) if passed is outcome.marked[state]] or slice(None)
    stiffness = 2.0 * scene.bulk_stiffness / (scene.chains * scene.bodies.spacing) * scene.bodies.reach
    rows = {"displacement": 1.0, "force": 1.0 / stiffness}
    return sum(
        float(np.max(np.broadcast_to(error, len(outcome.states))[index])) * factor
        for name, factor in rows.items()
        for source, error in outcome.rows.get(name, {}).items()
        if source != "input"
    )


def _pressure_share(scene: Scene, outcome: Outcome, state: str) -> float:
    """Return the relative uncertainty (dimensionless) of a state's pressures due to the scene's uncertain numbers.

    Of viscoelastic springs in a quasi-static run it is that of the pressure on the axis in the reduced model, in this
    state, or where the model does not report it in the deepest one; else that of c h(a)/a, with the stiffness c of the
    layer per length and the profile h under the reduction. The latter is 0 without a contact radius above 0, and of a
    body with an edge; 0, too, where all numbers are certain.

    Args:
        scene: the scene of the run.
        outcome: its outcome.
        state: name of the marked state, "deepest" for instance.
    """
    names = {PRESSURE, PRESSURE + state} & {name for move in outcome.moves for name in move.changes}
    if names and scene.is_stepped:
        return float(in_squares(outcome.moves, max(names)))
    return sum(given / size.value for size, given in outcome.made(scene, _pressure_size).values())


def _pressure_size(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return {"pressure": c h(a)/a [FU/LU²]}, to which pressures are proportional, with the uncertainty 0.

    Of a punch with a paraboloid as its end it is c (h(a) + d)/a, d the displacement, or h(a) where that is unknown.

    c is the stiffness of the layer per length, h the profile under the reduction, and a the first of "contact_radius",
    "largest_radius", "zero_load_radius" in the results. The proportion is exact of a power, with adhesion at F = 0. {}
    without an a above 0, where h(a) is 0, and of a plane body.
    """
    radius = first_of(results, *RADII)
    if radius is None or not radius.value > 0.0 or scene.bodies.profile.is_plane:
        return {}
    height = value_at(scene.bodies.height, radius.value)
    if scene.bodies.profile.has_edge:
        depth = first_of(results, "displacement", "peak_displacement")
        height += max(scene.experiment.places(), default=height) if depth is None else depth.value
    layer = scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
    return {"pressure": Quantity(layer * height / radius.value, 0.0, MEAN_PRESSURE)} if height > 0.0 else {}


def with_body(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """Return the outcome with the results of the body: pressures, stiffness, adhesion energy and Tabor parameter.

    Added, as far as there are any, are "central_pressure", "peak_pressure" and, where the run has none, "mean_pressure"
    [FU/LU²], "contact_stiffness" [FU/LU], "adhesion_energy" [FU·LU] and "tabor_parameter"; pressures are those of the
    first of the states "deepest", "final", "zero_load". The outcome is returned as it is where the run represents no
    axisymmetric body: with noise, in a slide, of a flat profile, on a rigid chain, and with the reduction of Geike and
    Popov, unless two equal spheres stand for it.

    Args:
        scene: the scene of the run.
        outcome: its outcome.
        pressures: p(r) of its states by name; a singular pressure is no result.
    """
    if not is_of_a_body(scene):
        return outcome
    of_pressure: Made = {}
    for name in reported_state(outcome):
        if pressure := pressures.get(name):
            share = _pressure_share(scene, outcome, name)
            # The residual force of the state at F = 0 is distributed over the contact.
            residual = abs(outcome.marked[name].force) / pressure.contact_radius**2 if name == "zero_load" else 0.0
            for key, result in pressure.results.items():
                given = share * abs(result.value)
                of_pressure[key] = replace(result, uncertainty=result.uncertainty - given + residual), given
            # Without an attraction dF/dd is that of springs in equilibrium.
            if pressure.stiffness and "pressed" in law_of(scene).closed_forms and not scene.interaction:
                of_pressure["contact_stiffness"] = pressure.stiffness, share * pressure.stiffness.value
    makers = (_contact_results, _adhesion_energy, _tabor)
    made = {name: quantity for make in makers for name, quantity in outcome.made(scene, make).items()}
    return _with_results(outcome, of_pressure | made)


def reported_state(outcome: Outcome) -> list[str]:
    """Return a list of one name, that of the state whose pressures are results; [] where the outcome has no such state.

    It is the first of "deepest", "final" and "zero_load" among the marked states of the outcome.
    """
    return [name for name in REPORTED if name in outcome.profiles][:1]


def _contact_results(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return "mean_pressure", F/πa² [FU/LU²], where `results` have none, and "contact_stiffness" dF/dd [FU/LU].

    F is "force", else "largest_force", a "contact_radius", else "largest_radius". The stiffness 2ca, c the stiffness of
    the layer per length, is left out with an interaction, adhesion, viscoelasticity, springs between neighbours, or
    noise. {} without such a force, or where that a is missing or 0.
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
    """Return {"tabor_parameter": µ}, dimensionless, with the uncertainty 0, for [adhesion] with a given range; else {}.

    {} also for [interaction], and where the profile has no effective radius of curvature.
    """
    mu = tabor(Case(scene, results)) if scene.work_of_adhesion else None
    return {} if mu is None else {"tabor_parameter": Quantity(mu, 0.0, NUMBER)}


def _adhesion_energy(scene: Scene, results: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Return {"adhesion_energy": energy [FU·LU] ≥ 0}: πa²W for [adhesion] without a range, 2a w/s with an interaction.

    w/s is the result "separation_energy", a "zero_load_radius", else "contact_radius". {} without such a radius,
    without adhesion or an attraction, and for [adhesion] with a range: most of its energy is that of the cohesive zone.
    """
    a, line = first_of(results, "zero_load_radius", "contact_radius"), results.get("separation_energy")
    # With a range most of the energy is that of the cohesive zone.
    if a is not None and scene.work_of_adhesion and not law_of(scene).range_of(scene, 0.0):
        return {"adhesion_energy": product(math.pi * scene.work_of_adhesion, ENERGY, (a, 2.0))}
    return {} if a is None or line is None else {"adhesion_energy": product(2.0, ENERGY, (a, 1.0), (line, 1.0))}
