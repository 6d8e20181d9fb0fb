"""The closed forms to compare a run with: one table, each with its conditions and its predictions of results.

Pressed without adhesion: Hertz, Sneddon, Galin. Adhesive on a plane: JKR and its extensions to other profiles, Maugis
and Dugdale with a range, and with DMT where the Tabor parameter is below that of JKR. A sphere with an interaction:
JKR, Maugis and Dugdale or DMT by the Tabor parameter. Tangential displacement with friction: Cattaneo and Mindlin.

results.json has them as `theory`: a list of {"name", "source", "applies", "values"}, and "tabor" where the values
depend on it; of each result in `values` the closed form's "value" and "unit", with known units "si", and "deviation",
the run's value over it minus 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from contact1d.analysis.pressure import Array
from contact1d.analysis.theory.adhesion import Dmt, MaugisDugdale, Theory, of_tabor, valid_theory
from contact1d.analysis.theory.indenters import Contact, PowerLaw
from contact1d.analysis.theory.mindlin import (
    mindlin_cycle_energy,
    mindlin_path,
    mindlin_stick_path,
    sliding_displacement,
)
from contact1d.analysis.theory.relaxing import Indented
from contact1d.workflow.body.cases import Case, Values
from contact1d.workflow.scene import Friction, Scene
from contact1d.workflow.units import Quantity, Scales, scale_of

SHOWN = 6
"""Decimals of a deviation in percent: below that it is round-off."""
SAME_LOAD = 1e-12
"""Relative: up to that loads are one; round-off."""


@dataclass(frozen=True)
class ClosedForm:
    """One theory.

    Attributes:
        name: what it is called: "Hertz".
        source: where it is written down.
        applies: why it holds for a case of its family, in a few words; "" where it does not.
        values: its predictions, by the names of results, in their model units, to compare the run with.
        pressure: p(r) [FU/LU²] at r [LU] in the reported state, if it predicts that.
        has_range: whether the predictions depend on the Tabor parameter.
    """

    name: str
    source: str
    applies: Callable[[Case], str]
    values: Callable[[Case], Values]
    pressure: Callable[[Case, Array], Array] | None = None
    has_range: bool = False


def applying(case: Case) -> list[ClosedForm]:
    """The closed forms that hold for a case."""
    return _of(case, case.law.closed_forms)


def exact(case: Case) -> list[ClosedForm]:
    """Those that are the law of its springs: of a chain on a plane by the method of dimensionality reduction."""
    scene = case.scene
    by_mdr = scene.bodies.lower == "rigid_plane" and scene.bodies.reduction == "mdr"
    known = by_mdr and scene.is_modelled and scene.is_stepped
    return _of(case, case.law.exact) if known else []


def _of(case: Case, families: Sequence[str]) -> list[ClosedForm]:
    return [form for family in families for form in FORMS[family] if form.applies(case)]


def theory(scene: Scene, quantities: Mapping[str, Quantity], scales: Scales) -> list[dict[str, Any]]:
    """What results.json has as `theory`; `quantities` of the body, `scales` of the run."""
    case = Case(scene, quantities, scales)
    return [_entry(form, case, scales) for form in applying(case)]


def _entry(form: ClosedForm, case: Case, scales: Scales) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, value in form.values(case).items():
        if name not in case.quantities:
            continue
        ours = case.quantities[name]
        values[name] = {"value": value, "unit": ours.unit}
        if scales.know(ours.unit):
            si = scales.in_si(value, 0.0, ours.unit)
            values[name]["si"] = {"value": si["value"], "unit": si["unit"]}
        values[name]["deviation"] = ours.value / value - 1.0 if value else None
    depends = {"tabor": tabor(case)} if form.has_range else {}
    return {"name": form.name, "source": form.source, "applies": form.applies(case), **depends, "values": values}


def in_words(results: Mapping[str, Any], name: str) -> Iterator[str]:
    """The prediction of each closed form for a result, with the deviation: `Hertz 110.37 µm (+0.001 %)`."""

    def named(form: Mapping[str, Any]) -> str:
        return f"{form['name']} (μ = {form['tabor']:.3g})" if "tabor" in form else str(form["name"])

    for form in results.get("theory", ()):
        if said := form["values"].get(name):
            entry = said.get("si", said)
            factor, unit = scale_of(entry["value"], entry["unit"]) if "si" in said else (1.0, said["unit"])
            off = "" if said["deviation"] is None else f" ({round(100.0 * said['deviation'], SHOWN) + 0.0:+.2g} %)"
            yield f"{named(form)} {entry['value'] * factor:.5g} {unit}{off}"


# Pressed without adhesion. Under a given F: d, a, F/πa², p(0), dF/dd = 2E*a; at a given d: F, a and the pressures.


def _pressed(kind: str, body: str) -> Callable[[Case], str]:
    """Applies to a profile of that kind, pressed and nothing else, whose reduction keeps it."""

    def applies(case: Case) -> str:
        stands = case.scene.bodies.reduction == "mdr" or (case.radius is not None and case.scene.interaction is None)
        pressed = case.force is not None or case.displacement is not None
        is_one = case.kind == kind and stands and pressed and case.is_elastic
        return f"{body}, pressed without adhesion" if is_one else ""

    return applies


def _contact(case: Case, a: float, d: float, force: float) -> Values:
    """What is known of a contact with a [LU], d [LU], F [FU]; what the scene gives is no prediction."""
    said = {
        "displacement": d, "force": force, "contact_radius": a, "largest_force": force, "largest_radius": a,
        "contact_stiffness": 2.0 * case.contact_modulus * a,
    }  # fmt: skip
    del said["force" if case.force is not None else "displacement"]
    if a > 0.0:
        said["mean_pressure"] = force / (math.pi * a**2)
    return said


def _pressed_values(case: Case) -> Values:
    """Pressures that have a bound and a closed form are among them."""
    body, a = case.body, case.contact_radius
    pressures = {"central_pressure": body.central_pressure(a), "peak_pressure": body.peak_pressure(a)}
    bounded = {name: pressure for name, pressure in pressures.items() if math.isfinite(pressure)}
    return _contact(case, a, body.displacement(a), body.force(a)) | bounded


def _pressure(case: Case, r: Array) -> Array:
    """Of a paraboloid or a cone."""
    body = case.body
    assert isinstance(body, PowerLaw)
    return body.pressure(r, case.contact_radius)


def _punch_values(case: Case) -> Values:
    """p(0) = E*d/πa; at the edge the pressure has no bound, and a is given."""
    punch, d = case.punch
    said = _contact(case, punch.radius, d, punch.stiffness * d)
    del said["contact_radius"], said["largest_radius"]
    return said | {"central_pressure": float(punch.pressure(0.0, d))}


def _punch_pressure(case: Case, r: Array) -> Array:
    punch, d = case.punch
    return punch.pressure(r, d)


# Adhesive: F_A, the radii there and at F = 0, and of a load or the deepest place of a path d, F and a.


def _adheres(kind: str, body: str) -> Callable[[Case], str]:
    """Applies to a profile of that kind on a plane with an energy of adhesion."""
    return lambda case: f"{body} that adheres, without a range" if case.kind == kind else ""


def _marks(case: Case, contact: Contact) -> Values:
    """F_A, a_cr, a₀, and of a load that holds a and d."""
    said = {
        "adhesion_force": contact.pull_off_force(), "critical_radius": contact.critical_radius(),
        "zero_load_radius": contact.zero_load_radius(),
    }  # fmt: skip
    if case.force is not None and case.force >= -said["adhesion_force"]:
        a = contact.contact_radius(case.force)
        said |= {"contact_radius": a, "displacement": contact.displacement(a)}
    return said


def _jkr_values(case: Case) -> Values:
    return _marks(case, case.body)


def _adhesive_values(case: Case) -> Values:
    body, said = case.body, _marks(case, case.body)
    said["fixed_grips_displacement"] = body.displacement(body.fixed_grips_radius())
    reported = case.contact_radius if "displacement" in case.quantities else said["zero_load_radius"]
    a = said.get("contact_radius", reported if case.force is None else 0.0)
    said["adhesion_energy"] = math.pi * a**2 * case.work
    if case.kind == "parabola" and case.contact_radius > 0.0:
        said["central_pressure"] = said["peak_pressure"] = body.central_pressure(case.contact_radius)
    if case.force is not None and a > 0.0:
        said["mean_pressure"] = case.force / (math.pi * a**2)
    return said


def _adhesive_punch_values(case: Case) -> Values:
    """F_A = √(8πE*Wa³); before that F = 2E*ad."""
    punch, d = case.punch
    said = {"adhesion_force": punch.pull_off_force()}
    return said if case.force is None else said | {"displacement": d}


def tabor(case: Case) -> float | None:
    """µ = (R W²/E*² h₀³)^{1/3} of a sphere with a range; None for anything else."""
    return None if case.with_range is None else case.with_range.tabor


def _with_a_range(of_any: bool) -> Callable[[Case], str]:
    """Applies to a paraboloid on a plane where JKR does not hold, or `of_any` µ."""

    def applies(case: Case) -> str:
        mu = tabor(case)
        if mu is None or case.kind != "parabola" or (of_tabor(mu) is Theory.JKR and not of_any):
            return ""
        return f"a paraboloid with a range; the Tabor parameter is {mu:.3g}, where {valid_theory(mu, 0.0).theory} holds"

    return applies


def _by_tabor(theory: Theory) -> Callable[[Case], str]:
    """Applies to a paraboloid that was transformed, so that E* and R are its own, held by an interaction alone."""

    def applies(case: Case) -> str:
        scene, mu = case.scene, tabor(case)
        sphere = case.kind == "parabola" and scene.bodies.reduction == "mdr"
        if mu is None or not sphere or scene.neighbours or scene.noise or of_tabor(mu) is not theory:
            return ""
        return f"the Tabor parameter μ = {mu:.3g}, of the implied W and the force-free distance"

    return applies


def _maugis_values(case: Case) -> Values:
    said = _marks(case, MaugisDugdale(*case.sphere, case.range))
    if case.scene.interaction:  # its displacement is counted from another place
        said.pop("displacement", None)
    return said


def _dmt_values(case: Case) -> Values:
    said = _marks(case, Dmt(*case.sphere))
    del said["critical_radius"]
    return said


# Drawn along: of a sphere under one load N, F_x and c on any path there and back, and a; at a displacement N as well.
# Of closed cycles what one dissipates.


def drawn_along(case: Case) -> str:
    """Applies where there are a sphere, a contact and one load."""
    experiment: Any = case.scene.experiment
    if not experiment.goes_along or case.kind != "parabola" or case.scene.the(Friction).coefficient == 0.0:
        return ""
    given = experiment.normal_forces() or experiment.places()
    one = case.radius is not None and min(given) > 0.0 and max(given) - min(given) <= SAME_LOAD * max(given)
    return "a paraboloid under one load, displaced tangentially with friction" if one else ""


def sliding_contact(case: Case) -> tuple[float, float, float, float]:
    """N [FU], μ, u* [LU] and a [LU] where `drawn_along` applies."""
    experiment: Any = case.scene.experiment
    scene, body, loads = case.scene, case.body, experiment.normal_forces()
    edge = body.contact_radius(loads[0]) if loads else body.radius_at(experiment.places()[0])
    coefficient, ratio = scene.the(Friction).coefficient, scene.tangential_stiffness / scene.bulk_stiffness
    return body.force(edge), coefficient, sliding_displacement(coefficient, ratio, body.displacement(edge)), edge


def _mindlin_values(case: Case) -> Values:
    """Of cycles one dissipates the same as any other; N is no prediction where it is given."""
    experiment: Any = case.scene.experiment
    *contact, edge = sliding_contact(case)
    places = experiment.along()
    said = {
        "tangential_force": mindlin_path(places, *contact)[-1],
        "contact_radius": edge,
        "stick_radius": mindlin_stick_path(places, edge, contact[-1])[-1],
        "dissipated_energy_per_cycle": mindlin_cycle_energy(experiment.way, *contact),
    }
    return said if experiment.normal_forces() else said | {"normal_force": contact[0]}


# Of a body that relaxes, pressed once by a given displacement: F over time, and when the contact is lost.

EXPONENTS = {"parabola": 2.0, "cone": 1.0}
MOMENTS = 200
"""At which the largest force is looked for, beside the corners."""


def indented(case: Case) -> Indented | None:
    """The history of a body that relaxes; None of anything else, or where it is pressed more than once."""
    given: Any = case.scene.experiment
    exponent = EXPONENTS.get(case.kind) or getattr(case.scene.bodies.profile, "exponent", None)
    terms, places = case.law.series(case.scene), given.places()
    if not (terms and exponent and places):
        return None
    force = case.body.force(case.body.radius_at(max(places)))
    try:
        return Indented(tuple(given.times), tuple(places), force, exponent, terms)
    except ValueError:
        return None


def _relaxes(case: Case) -> str:
    return "a body that relaxes, pressed once by a given displacement" if indented(case) else ""


def _ting_values(case: Case) -> Values:
    history = indented(case)
    assert history is not None
    ends, lost = history.times, history.lost(history.times[-1])
    forces = history.forces([*np.linspace(ends[0], ends[-1], MOMENTS), *ends])
    said = {"peak_force": float(forces.max()), "force": float(forces[-1])}
    return said if lost is None else said | {"contact_time": lost - history.touched}


SNEDDON = "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47"
JKR = "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301"
MAUGIS = "D. Maugis, J. Colloid Interface Sci. 150 (1992) 243"
DMT = "B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314"
FORMS: Mapping[str, tuple[ClosedForm, ...]] = {
    "pressed": (
        ClosedForm(
            "Hertz",
            "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, section 4.2",
            _pressed("parabola", "a paraboloid"),
            _pressed_values,
            _pressure,
        ),
        ClosedForm("Sneddon, cone", SNEDDON, _pressed("cone", "a cone"), _pressed_values, _pressure),
        ClosedForm(
            "Sneddon, flat punch", SNEDDON, _pressed("flat_punch", "a flat punch"), _punch_values, _punch_pressure
        ),
        ClosedForm("Sneddon, sphere", SNEDDON, _pressed("circle", "a whole sphere"), _pressed_values),
        ClosedForm(
            "Sneddon, ellipsoid",
            f"{SNEDDON}: his sphere, flattened",
            _pressed("ellipsoid", "a whole ellipsoid"),
            _pressed_values,
        ),
        ClosedForm(
            "Galin, power", f"L. A. Galin 1953; {SNEDDON}", _pressed("power", "a power of the radius"), _pressed_values
        ),
    ),
    "adhesive": (
        ClosedForm("JKR", JKR, _adheres("parabola", "a paraboloid"), _adhesive_values, _pressure),
        ClosedForm(
            "Maugis and Barquins, cone",
            "D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981) L95",
            _adheres("cone", "a cone"),
            _adhesive_values,
        ),
        ClosedForm(
            "Popov and Heß, power",
            "V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, section 4.4",
            _adheres("power", "a power of the radius"),
            _adhesive_values,
        ),
        ClosedForm(
            "JKR, whole sphere",
            "D. Maugis, Langmuir 11 (1995) 679",
            _adheres("circle", "a whole sphere"),
            _adhesive_values,
        ),
        ClosedForm(
            "Kendall, flat punch",
            "K. Kendall, J. Phys. D 4 (1971) 1186",
            _adheres("flat_punch", "a flat punch"),
            _adhesive_punch_values,
        ),
    ),
    "zone": (ClosedForm("Maugis and Dugdale", MAUGIS, _with_a_range(True), _maugis_values, has_range=True),),
    "transition": (ClosedForm("Maugis and Dugdale", MAUGIS, _with_a_range(False), _maugis_values, has_range=True),),
    "dmt": (ClosedForm("DMT", DMT, _with_a_range(False), _dmt_values),),
    "interaction": (
        ClosedForm("JKR", JKR, _by_tabor(Theory.JKR), _jkr_values),
        ClosedForm("Maugis-Dugdale", MAUGIS, _by_tabor(Theory.MAUGIS), _maugis_values, has_range=True),
        ClosedForm("DMT", DMT, _by_tabor(Theory.DMT), _dmt_values),
    ),
    "along": (
        ClosedForm(
            "Cattaneo and Mindlin",
            "C. Cattaneo 1938; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327",
            drawn_along,
            _mindlin_values,
        ),
    ),
    "relaxing": (
        ClosedForm(
            "Ting",
            "T. C. T. Ting, J. Appl. Mech. 33 (1966) 845; loaded as by E. H. Lee, J. R. M. Radok 1960",
            _relaxes,
            _ting_values,
        ),
    ),
}
"""By family what a run may be compared with; each closed form has its own conditions."""
