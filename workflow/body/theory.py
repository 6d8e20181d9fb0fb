"""The closed forms to compare a run with: one table, each with its conditions and its predictions of results.

Without adhesion: Hertz, Sneddon, Galin. Adhesive on a plane: JKR and its extensions to other profiles, Maugis and
Dugdale with a range, and with DMT where the Tabor parameter is below that of JKR. A sphere with an interaction: JKR,
Maugis and Dugdale or DMT by the Tabor parameter. Tangential displacement with friction: Cattaneo and Mindlin.

results.json has them as `theory`: a list of {"name", "source", "applies", "values"}, and "tabor" where the values
depend on it; of each result in `values` the closed form's "value" and "unit", with known units "si", and "deviation",
the run's value over it minus 1.

F [FU], compression positive, d and a [LU]: force, displacement and contact radius; F_A is the pull-off force, a_cr the
radius there, a₀ that at F = 0.
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


@dataclass(frozen=True)
class ClosedForm:
    """A theory with its conditions and its predictions of results.

    Attributes:
        name: its usual name: "Hertz".
        source: its publication.
        applies: returns why it holds for a case of its family, in a few words; "" where it does not.
        values: returns its predictions, by the names of results, in their units of the model.
        pressure: returns p(r) [FU/LU²] at r (n,) [LU] in the reported state; None where it predicts no pressure.
        has_range: whether the predictions depend on the Tabor parameter.
    """

    name: str
    source: str
    applies: Callable[[Case], str]
    values: Callable[[Case], Values]
    pressure: Callable[[Case, Array], Array] | None = None
    has_range: bool = False


def applying(case: Case) -> list[ClosedForm]:
    """Return the closed forms that hold for a case, in the order of the families of its law; [] for none."""
    return _applying(case, case.law.closed_forms)


def exact(case: Case) -> list[ClosedForm]:
    """Return the closed forms that are exact for a case: for springs on a plane by the MDR; [] for any other."""
    scene = case.scene
    by_mdr = scene.bodies.lower == "rigid_plane" and scene.bodies.reduction == "mdr"
    known = by_mdr and scene.is_modelled and scene.is_stepped
    return _applying(case, case.law.exact) if known else []


def _applying(case: Case, families: Sequence[str]) -> list[ClosedForm]:
    """Return the closed forms of the families, in their order, that hold for a case."""
    return [form for family in families for form in FORMS[family] if form.applies(case)]


def theory(scene: Scene, quantities: Mapping[str, Quantity], scales: Scales) -> list[dict[str, Any]]:
    """Return the entry `theory` of results.json: a list of closed forms with their values; [] where none holds.

    `quantities`: results of the body, in units of the model; `scales`: those of the run.
    """
    case = Case(scene, quantities, scales)
    return [_entry(form, case, scales) for form in applying(case)]


def _entry(form: ClosedForm, case: Case, scales: Scales) -> dict[str, Any]:
    """Return the entry of a closed form in results.json, with the deviations of the run, value over prediction minus 1.

    Predictions of results that the run lacks are left out; the deviation from a prediction of 0 is None.
    """
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
    """Yield the prediction of each closed form for a result, with the deviation: `Hertz 110.37 µm (+0.001 %)`.

    `results`: the content of results.json; `name`: of the result. Nothing is yielded where no closed form has it.
    """

    def named(form: Mapping[str, Any]) -> str:
        """Return the name of a closed form, with the Tabor parameter if it depends on it."""
        return f"{form['name']} (μ = {form['tabor']:.3g})" if "tabor" in form else str(form["name"])

    for form in results.get("theory", ()):
        if prediction := form["values"].get(name):
            entry, deviation = prediction.get("si", prediction), prediction["deviation"]
            factor, unit = scale_of(entry["value"], entry["unit"]) if "si" in prediction else (1.0, prediction["unit"])
            # Smaller deviations are round-off, and + 0.0 makes no −0 of them.
            off = "" if deviation is None else f" ({round(100.0 * deviation, 6) + 0.0:+.2g} %)"
            yield f"{named(form)} {entry['value'] * factor:.5g} {unit}{off}"


# Without adhesion. Under a given F: d, a, F/πa², p(0), dF/dd = 2E*a; at a given d: F, a and the pressures.


def _without_adhesion(kind: str, body: str) -> Callable[[Case], str]:
    """Return a function of a case: "<body>, pressed without adhesion" where such a closed form holds, else "".

    It holds where the profile is of this kind, the contact has linear springs alone and no attraction, the run has a
    force or a given displacement (an impact has neither), and the reduction is "mdr", or the paper's for a parabola or
    a circle without [interaction].

    Args:
        kind: of the profile, as in a scene: "cone".
        body: its name in the text: "a cone".
    """

    def applies(case: Case) -> str:
        """Return the body and its load in words; "" where the closed form does not hold."""
        kept = case.scene.bodies.reduction == "mdr" or (case.radius is not None and case.scene.interaction is None)
        pressed = case.force is not None or case.displacement is not None
        holds = case.kind == kind and kept and pressed and case.is_elastic
        return f"{body}, pressed without adhesion" if holds else ""

    return applies


def _contact(case: Case, a: float, d: float, force: float) -> Values:
    """Return the predictions of a contact with a [LU], d [LU], F [FU], without F or d where the scene gives it.

    By the names of results: lengths [LU], forces [FU], "contact_stiffness" [FU/LU], and where a > 0 "mean_pressure"
    [FU/LU²].
    """
    values = {
        "displacement": d, "force": force, "contact_radius": a, "largest_force": force, "largest_radius": a,
        "contact_stiffness": 2.0 * case.contact_modulus * a,
    }  # fmt: skip
    del values["force" if case.force is not None else "displacement"]
    if a > 0.0:
        values["mean_pressure"] = force / (math.pi * a**2)
    return values


def _elastic_values(case: Case) -> Values:
    """Return the predictions of a body without adhesion by name, "central_pressure" and "peak_pressure" where finite.

    In units of the model: lengths [LU], forces [FU], stiffness [FU/LU], pressures [FU/LU²].
    """
    body, a = case.body, case.contact_radius
    pressures = {"central_pressure": body.central_pressure(a), "peak_pressure": body.peak_pressure(a)}
    bounded = {name: pressure for name, pressure in pressures.items() if math.isfinite(pressure)}
    return _contact(case, a, body.displacement(a), body.force(a)) | bounded


def _pressure(case: Case, r: Array) -> Array:
    """Return p(r) [FU/LU²], compression positive, of a paraboloid or a cone at radii r (n,) [LU], (n,)."""
    body = case.body
    assert isinstance(body, PowerLaw)
    return body.pressure(r, case.contact_radius)


def _punch_values(case: Case) -> Values:
    """Return the predictions of a flat punch by name, p(0) = E*d/πa [FU/LU²] among them, without its radius.

    The pressure at the edge is singular.
    """
    punch, d = case.punch
    values = _contact(case, punch.radius, d, punch.stiffness * d)
    del values["contact_radius"], values["largest_radius"]
    return values | {"central_pressure": float(punch.pressure(0.0, d))}


def _punch_pressure(case: Case, r: Array) -> Array:
    """Return p(r) [FU/LU²], compression positive, of a flat punch at radii r (n,) [LU], (n,)."""
    punch, d = case.punch
    return punch.pressure(r, d)


# Adhesive: F_A, the radii there and at F = 0, and d, F and a of a load or of the largest displacement of a path.


def _adhesive(kind: str, body: str) -> Callable[[Case], str]:
    """Return the condition of a kind of profile on a plane with a work of adhesion: a function of a case.

    It returns text, "" where it does not hold. `body`: name of the body in the text.
    """
    return lambda case: f"{body} that adheres, without a range" if case.kind == kind else ""


def _marks(case: Case, contact: Contact) -> Values:
    """Return F_A [FU] > 0, a_cr and a₀ [LU], and a and d [LU] under a given load that the contact sustains, by name."""
    values = {
        "adhesion_force": contact.pull_off_force(), "critical_radius": contact.critical_radius(),
        "zero_load_radius": contact.zero_load_radius(),
    }  # fmt: skip
    if case.force is not None and case.force >= -values["adhesion_force"]:
        a = contact.contact_radius(case.force)
        values |= {"contact_radius": a, "displacement": contact.displacement(a)}
    return values


def _jkr_values(case: Case) -> Values:
    """Return the predictions of JKR for a sphere with an interaction, by name: forces [FU], lengths [LU]."""
    return _marks(case, case.body)


def _adhesive_values(case: Case) -> Values:
    """Return the predictions of JKR and its extensions for a body on a plane, by name in units of the model.

    Those of `_marks`, "fixed_grips_displacement" [LU], "adhesion_energy" [FU·LU], and of a paraboloid in contact and
    under a force also pressures [FU/LU²].
    """
    body, values = case.body, _marks(case, case.body)
    values["fixed_grips_displacement"] = body.displacement(body.fixed_grips_radius())
    reported = case.contact_radius if "displacement" in case.quantities else values["zero_load_radius"]
    a = values.get("contact_radius", reported if case.force is None else 0.0)
    values["adhesion_energy"] = math.pi * a**2 * case.work
    if case.kind == "parabola" and case.contact_radius > 0.0:
        values["central_pressure"] = values["peak_pressure"] = body.central_pressure(case.contact_radius)
    if case.force is not None and a > 0.0:
        values["mean_pressure"] = case.force / (math.pi * a**2)
    return values


def _adhesive_punch_values(case: Case) -> Values:
    """Return F_A = √(8πE*Wa³) [FU] of a flat punch, and d = F/2E*a [LU] under a given force, by name."""
    punch, d = case.punch
    values = {"adhesion_force": punch.pull_off_force()}
    return values if case.force is None else values | {"displacement": d}


def tabor(case: Case) -> float | None:
    """Return the Tabor parameter µ = (R W²/E*² h₀³)^{1/3} (dimensionless) of a sphere with a range.

    None for anything else.
    """
    return None if case.with_range is None else case.with_range.tabor


def _with_a_range(of_any: bool) -> Callable[[Case], str]:
    """Return the condition of a paraboloid with a range on a plane, where JKR does not hold or `of_any` µ.

    It is a function of a case: text, "" where it does not hold.
    """

    def applies(case: Case) -> str:
        """Return the Tabor parameter and its theory in words; "" where the closed form does not hold."""
        mu = tabor(case)
        if mu is None or case.kind != "parabola" or (of_tabor(mu) is Theory.JKR and not of_any):
            return ""
        return f"a paraboloid with a range; the Tabor parameter is {mu:.3g}, where {valid_theory(mu, 0.0).theory} holds"

    return applies


def _by_tabor(theory: Theory) -> Callable[[Case], str]:
    """Return the condition of a paraboloid with an interaction alone, at Tabor parameters where `theory` holds.

    It is a function of a case: text, "" where it does not hold. The reduction is the MDR, so that E* and R are the
    body's.
    """

    def applies(case: Case) -> str:
        """Return the Tabor parameter in words; "" where the closed form does not hold."""
        scene, mu = case.scene, tabor(case)
        sphere = case.kind == "parabola" and scene.bodies.reduction == "mdr"
        if mu is None or not sphere or scene.neighbours or scene.noise or of_tabor(mu) is not theory:
            return ""
        return f"the Tabor parameter μ = {mu:.3g}, of the implied W and the force-free distance"

    return applies


def _maugis_values(case: Case) -> Values:
    """Return the predictions of Maugis and Dugdale for a sphere with a range, by name: forces [FU], lengths [LU].

    Without "displacement" for an interaction, which has another origin.
    """
    values = _marks(case, MaugisDugdale(*case.sphere, case.range))
    if case.scene.interaction:  # its displacement has another origin
        values.pop("displacement", None)
    return values


def _dmt_values(case: Case) -> Values:
    """Return the predictions of DMT for a sphere, by name, without a critical radius: forces [FU], lengths [LU]."""
    values = _marks(case, Dmt(*case.sphere))
    del values["critical_radius"]
    return values


# Tangential: of a sphere under a constant load N, F_x, c and a on any path; at a constant displacement N as well.
# Of closed cycles the energy that one dissipates.


def drawn_along(case: Case) -> str:
    """Return the condition of Cattaneo and Mindlin in words: a paraboloid under a constant load; "" where it fails."""
    experiment: Any = case.scene.experiment
    if not experiment.goes_along or case.kind != "parabola" or case.scene.the(Friction).coefficient == 0.0:
        return ""
    loads = experiment.normal_forces() or experiment.places()
    # Loads that differ by round-off are equal.
    is_constant = case.radius is not None and min(loads) > 0.0 and max(loads) - min(loads) <= 1e-12 * max(loads)
    return "a paraboloid under one load, displaced tangentially with friction" if is_constant else ""


def sliding_contact(case: Case) -> tuple[float, float, float, float]:
    """Return (N [FU], μ, u* [LU], a [LU]) of a case that meets `drawn_along`; u* is that of full sliding."""
    experiment: Any = case.scene.experiment
    scene, body, loads = case.scene, case.body, experiment.normal_forces()
    edge = body.contact_radius(loads[0]) if loads else body.radius_at(experiment.places()[0])
    coefficient, ratio = scene.the(Friction).coefficient, scene.tangential_stiffness / scene.bulk_stiffness
    return body.force(edge), coefficient, sliding_displacement(coefficient, ratio, body.displacement(edge)), edge


def _mindlin_values(case: Case) -> Values:
    """Return the predictions of Cattaneo and Mindlin at the end of the path and of a cycle, by name.

    N unless it is given. "tangential_force" and "normal_force" [FU], "contact_radius" and "stick_radius" [LU],
    "dissipated_energy_per_cycle" [FU·LU].
    """
    experiment: Any = case.scene.experiment
    *contact, edge = sliding_contact(case)
    positions = experiment.along()
    values = {
        "tangential_force": mindlin_path(positions, *contact)[-1],
        "contact_radius": edge,
        "stick_radius": mindlin_stick_path(positions, edge, contact[-1])[-1],
        "dissipated_energy_per_cycle": mindlin_cycle_energy(experiment.excursion, *contact),
    }
    return values if experiment.normal_forces() else values | {"normal_force": contact[0]}


# Viscoelastic, indented once by a given displacement: F over time, and the time of the separation.


def indented(case: Case) -> Indented | None:
    """Return the indentation of a viscoelastic paraboloid, cone or power by a given displacement; else None.

    None also with more than one indentation.
    """
    given: Any = case.scene.experiment
    exponents = {"parabola": 2.0, "cone": 1.0}
    exponent = exponents.get(case.kind) or getattr(case.scene.bodies.profile, "exponent", None)
    terms, displacements = case.law.series(case.scene), given.places()
    if not (terms and exponent and displacements):
        return None
    force = case.body.force(case.body.radius_at(max(displacements)))
    try:
        return Indented(tuple(given.times), tuple(displacements), force, exponent, terms)
    except ValueError:
        return None


def _relaxes(case: Case) -> str:
    """Return the condition of Ting in words; "" where it fails: a viscoelastic body, pressed once by a displacement."""
    return "a body that relaxes, pressed once by a given displacement" if indented(case) else ""


def _ting_values(case: Case) -> Values:
    """Return the predictions of Ting: "peak_force" and "force" [FU], and where it separates "contact_time" [TU].

    The largest force is that at 200 times and the corners of the history.
    """
    history = indented(case)
    assert history is not None
    corners, separated = history.times, history.lost(history.times[-1])
    forces = history.forces([*np.linspace(corners[0], corners[-1], 200), *corners])
    values = {"peak_force": float(forces.max()), "force": float(forces[-1])}
    return values if separated is None else values | {"contact_time": separated - history.touched}


SNEDDON = "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47"
JKR = "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301"
MAUGIS = "D. Maugis, J. Colloid Interface Sci. 150 (1992) 243"
DMT = "B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314"
FORMS: Mapping[str, tuple[ClosedForm, ...]] = {
    "pressed": (
        ClosedForm(
            "Hertz",
            "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, section 4.2",
            _without_adhesion("parabola", "a paraboloid"),
            _elastic_values,
            _pressure,
        ),
        ClosedForm("Sneddon, cone", SNEDDON, _without_adhesion("cone", "a cone"), _elastic_values, _pressure),
        ClosedForm(
            "Sneddon, flat punch",
            SNEDDON,
            _without_adhesion("flat_punch", "a flat punch"),
            _punch_values,
            _punch_pressure,
        ),
        ClosedForm("Sneddon, sphere", SNEDDON, _without_adhesion("circle", "a whole sphere"), _elastic_values),
        ClosedForm(
            "Sneddon, ellipsoid",
            f"{SNEDDON}: his sphere, flattened",
            _without_adhesion("ellipsoid", "a whole ellipsoid"),
            _elastic_values,
        ),
        ClosedForm(
            "Galin, power",
            f"L. A. Galin 1953; {SNEDDON}",
            _without_adhesion("power", "a power of the radius"),
            _elastic_values,
        ),
    ),
    "adhesive": (
        ClosedForm("JKR", JKR, _adhesive("parabola", "a paraboloid"), _adhesive_values, _pressure),
        ClosedForm(
            "Maugis and Barquins, cone",
            "D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981) L95",
            _adhesive("cone", "a cone"),
            _adhesive_values,
        ),
        ClosedForm(
            "Popov and Heß, power",
            "V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, section 4.4",
            _adhesive("power", "a power of the radius"),
            _adhesive_values,
        ),
        ClosedForm(
            "JKR, whole sphere",
            "D. Maugis, Langmuir 11 (1995) 679",
            _adhesive("circle", "a whole sphere"),
            _adhesive_values,
        ),
        ClosedForm(
            "Kendall, flat punch",
            "K. Kendall, J. Phys. D 4 (1971) 1186",
            _adhesive("flat_punch", "a flat punch"),
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
"""Closed forms by family; each has its own conditions."""
