"""Results that follow from others: the work of adhesion that an interaction implies, and those of the body.

w = ∫ −f dr from the force-free distance on separates a particle from the opposite chain of spacing s: w/s per length
of chain. As the edge of a contact of radius a recedes by da, a length da of chain separates at both ends, and the ring
2πa da of the body's surface:

    mdr:           2 (w/s) da = W 2πa da                          W = w/(π s a)
    geike_popov:   two equal spheres, half as wide as the image   W = 4w/(π s a),   a the image's

JKR's body has one W for every a, and the chain one w/s: they are alike at one radius only, that of the run. Their
difference follows from the force, F_A = (3/2) πWR_e, R_e = R with the MDR and R/2 for the two spheres.

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
"""States whose pressure is a result, the first that a run has."""
RADII = ("contact_radius", "largest_radius", "zero_load_radius")
ERRORS = ("displacement", "force", "largest_force", *RADII)
"""Results whose relative uncertainty, that of the lattice included, is the pressure's, too; of springs on a plane,
whose pressure is a function of the radius, that of the radius alone."""
WIDER = {"mdr": 1.0, "geike_popov": 4.0}
"""W π s a/w."""
EFFECTIVE = {"mdr": 1.0, "geike_popov": 0.5}
"""R_e/R."""
TAIL, POINTS = 1e-10, 8000
"""Force at the last distance over that at the force-free one, and how many distances."""
FORMULAS = {
    "mdr": "W = w/(π s a), a the contact radius: as it shrinks by da, two lengths da of chain and the ring 2πa da "
    "of the body's surface separate (mdr). The uncertainty is the difference from F_A = (3/2)πWR",
    "geike_popov": "W = 4w/(π s a), a the image's half-width, twice the contact radius of the two equal spheres that "
    "geike_popov represents: as it shrinks by da, two lengths da of chain and the ring (π/2)a da of their surface "
    "separate. The uncertainty is the difference from F_A = (3/4)πWR",
}
"""How W is made, by reduction."""


def first_of(found: Mapping[str, Quantity], *names: str) -> Quantity | None:
    """The first of the named results that a run has."""
    return next((found[name] for name in names if name in found), None)


def with_implied(scene: Scene, settings: Settings, outcome: Outcome) -> Outcome:
    """The outcome of a run with the results that its interaction implies."""
    made = implied(scene, settings, outcome.quantities)
    return _with(outcome, {name: (one, 0.0) for name, one in made.items()})


def _with(outcome: Outcome, made: Made) -> Outcome:
    """The outcome with what was made of its results; W is two readings of one quantity.

    A pressure that may be 0, as under a punch that carries nothing, is compared with the largest force over a².
    """
    sources = {"work_of_adhesion": MODEL}
    radius = max((one.value for name, one in outcome.quantities.items() if name.endswith("radius")), default=0.0)
    pressure = max(abs(state.force) for state in outcome.states) / radius**2 if radius > 0.0 else None
    results = {}
    for name, (one, given) in made.items():
        is_zero = one.unit == MEAN_PRESSURE and abs(one.value) <= one.uncertainty
        errors = {sources.get(name, "input"): one.uncertainty + given}
        results[name] = Result(one.value, one.unit, errors, pressure if is_zero else None, given=given)
    return replace(outcome, results={**outcome.results, **results})


def implied(scene: Scene, settings: Settings, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """`separation_energy`, w/s [FU], and of a sphere `work_of_adhesion` [FU/LU]; nothing without an attraction.

    Args:
        scene: that ran.
        settings: that it ran with.
        found: its results; without a radius there is no W.
    """
    if settings.forces.law is None or settings.forces.law.attraction is None:
        return {}
    work, spacing, reduction = (
        _work(settings.forces.law, scene.bodies.spacing),
        scene.bodies.spacing,
        scene.bodies.reduction,
    )
    line = product(1.0 / spacing, FORCE, (work, 1.0))
    quantities = {"separation_energy": line}
    radius, curvature = first_of(found, "zero_load_radius", "contact_radius"), scene.bodies.profile.curvature_radius
    if radius is None or curvature is None or not radius.value > 0.0:
        return quantities
    energy = product(WIDER[reduction] / math.pi, LINE_PRESSURE, (line, 1.0), (radius, -1.0))
    tension = found.get("adhesion_force", Quantity(settings.law.pull_off_force(), 0.0, FORCE))
    jkr = product(1.0 / (1.5 * math.pi * EFFECTIVE[reduction] * curvature), LINE_PRESSURE, (tension, 1.0))
    spread = energy.uncertainty + abs(energy.value - jkr.value) + jkr.uncertainty
    return quantities | {"work_of_adhesion": Quantity(energy.value, spread, LINE_PRESSURE)}


def formulas(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, dict[str, str]]:
    """For results.json, `formulas`: the formula of a result that has more than one definition."""
    made = {
        "separation_energy": "w/s: w = ∫ −f dr separates one particle from the opposite chain, s the spacing; energy "
        "per length of chain",
        "work_of_adhesion": FORMULAS[scene.bodies.reduction],
    }
    said = {name: text for name, text in made.items() if name in quantities}
    return {"formulas": said} if said else {}


@lru_cache(maxsize=16)  # scenes run one after the other mostly share their law
def _work(law: DoubleExponential, spacing: float) -> Quantity:
    """w [FU·LU] by the trapezoid, and its error: the difference from twice the step."""
    end = law.cutoff_for(TAIL)
    r = np.linspace(end / POINTS, end, POINTS)
    force = row_force(law, r, spacing, end)

    def work(values: Array, step: float) -> float:
        inwards = np.cumsum(0.5 * (values[1:] + values[:-1])[::-1]) * step
        return float(max(-inwards.min(), 0.0))

    fine = work(force, end / POINTS)
    return Quantity(fine, abs(fine - work(force[1::2], 2.0 * end / POINTS)), ENERGY)


def pressures_of(scene: Scene, outcome: Outcome) -> dict[str, BodyPressure]:
    """p(r) of the reported states of the body, as uncertain as the results of which it is a function."""
    found = outcome.exact
    shares = {
        name: one.uncertainty / outcome.results[name].size for name in ERRORS if (one := found.get(name)) and one.value
    }
    radius = next((shares[name] for name in RADII if name in shares), 0.0)
    critical = found.get("critical_radius")
    radii = dict.fromkeys(outcome.profiles, radius)
    if critical and critical.value and "critical" in radii:
        radii["critical"] = max(radius, critical.uncertainty / critical.value)
    given = {name: _pressure_share(scene, outcome, name) for name in outcome.profiles}
    return body_pressures(scene, outcome.profiles, radii, sum(shares.values()), given)


def _pressure_share(scene: Scene, outcome: Outcome, state: str) -> float:
    """What uncertain numbers of the scene change the pressures of a state by, relatively."""
    names = {PRESSURE, PRESSURE + state} & {name for move in outcome.moves for name in move.changes}
    if names and scene.is_stepped:
        return float(in_squares(outcome.moves, max(names)))
    return sum(given / size.value for size, given in outcome.made(scene, _pressure_size).values())


def _pressure_size(scene: Scene, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """E* g(a)/a [FU/LU²], as which pressures go where inputs change: exact of a power, at F = 0 with adhesion too."""
    radius = first_of(found, *RADII)
    if radius is None or not radius.value > 0.0 or scene.bodies.profile.has_edge:
        return {}
    height = float(scene.bodies.height(np.asarray([radius.value]))[0])
    layer = scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
    return {"pressure": Quantity(layer * height / radius.value, 0.0, MEAN_PRESSURE)} if height > 0.0 else {}


def with_body(scene: Scene, outcome: Outcome, pressures: Mapping[str, BodyPressure]) -> Outcome:
    """The outcome with the results of the body: p(0), the largest pressure, mean pressure, stiffness, adhesion energy.

    `pressures`: of its states. One that has no bound is left out.
    """
    if not is_of_a_body(scene):
        return outcome
    of_pressure: Made = {}
    share = max((_pressure_share(scene, outcome, name) for name in reported_state(outcome)), default=0.0)
    for name in reported_state(outcome):
        if pressure := pressures.get(name):
            # What is not quite 0 at F = 0 is spread over the contact.
            left = abs(outcome.marked[name].force) / pressure.contact_radius**2 if name == "zero_load" else 0.0
            given = {key: share * abs(one.value) for key, one in pressure.results.items()}
            of_pressure = {
                key: (replace(one, uncertainty=one.uncertainty - given[key] + left), given[key])
                for key, one in pressure.results.items()
            }
    # Springs in equilibrium, without an attraction: dF/dd is theirs.
    if "pressed" in law_of(scene).closed_forms and not (scene.interaction or scene.noise):
        for name in reported_state(outcome):
            if (pressure := pressures.get(name)) and pressure.stiffness:
                of_pressure["contact_stiffness"] = (pressure.stiffness, share * pressure.stiffness.value)
    makers = (_of_the_contact, _adhesion_energy, _tabor)
    made = {name: one for make in makers for name, one in outcome.made(scene, make).items()}
    return _with(outcome, of_pressure | made)


def reported_state(outcome: Outcome) -> list[str]:
    """The name of the state whose pressures are results; none where a run has no such state."""
    return [name for name in REPORTED if name in outcome.profiles][:1]


def _of_the_contact(scene: Scene, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """F/πa² where the experiment has none, and dF/dd = 2E*a of elastic bodies; see `_Loaded` of others."""
    force, radius = first_of(found, "force", "largest_force"), first_of(found, "contact_radius", "largest_radius")
    made: dict[str, Quantity] = {}
    if radius is None or force is None or not radius.value > 0.0:
        return made
    if "mean_pressure" not in found:
        made["mean_pressure"] = product(1.0 / math.pi, MEAN_PRESSURE, (force, 1.0), (radius, -2.0))
    if scene.interaction is None and Case(scene, found).is_elastic:
        stiffness = 2.0 * scene.bulk_stiffness / (scene.chains * scene.bodies.spacing)
        made["contact_stiffness"] = product(stiffness, LINE_PRESSURE, (radius, 1.0))
    return made


def _tabor(scene: Scene, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """µ of a body with a radius of curvature, where the range of the attraction is given."""
    mu = tabor(Case(scene, found)) if scene.work_of_adhesion else None
    return {} if mu is None else {"tabor_parameter": Quantity(mu, 0.0, NUMBER)}


def _adhesion_energy(scene: Scene, found: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """πa²W on a plane with adhesion; 2a w/s where an interaction holds the bodies."""
    a, line = first_of(found, "zero_load_radius", "contact_radius"), found.get("separation_energy")
    # Of an attraction with a range the cohesive zone has most of it.
    if a is not None and scene.work_of_adhesion and not law_of(scene).range_of(scene, 0.0):
        return {"adhesion_energy": product(math.pi * scene.work_of_adhesion, ENERGY, (a, 2.0))}
    return {} if a is None or line is None else {"adhesion_energy": product(2.0, ENERGY, (a, 1.0), (line, 1.0))}
