"""The closed forms to compare a run with: one table, each with its conditions and its predictions of results.

Without adhesion: Hertz, Sneddon, Galin. Adhesive on a plane: JKR and its extensions to other profiles, Maugis and
Dugdale with a range, and with DMT where the Tabor parameter is below that of JKR. A sphere with an interaction: JKR,
Maugis and Dugdale or DMT by the Tabor parameter. Tangential displacement with friction: Cattaneo and Mindlin. Oblique
impact: the limits of gross sliding and of full stick.

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
from functools import partial
from typing import Any

import numpy as np

from contact1d.analysis.pressure import Array
from contact1d.analysis.theory.adhesion import Theory, of_tabor, valid_theory
from contact1d.analysis.theory.impact import full_stick
from contact1d.analysis.theory.indenters import Contact, PowerLaw
from contact1d.analysis.theory.mindlin import (
    mindlin_cycle_energy,
    mindlin_path,
    mindlin_stick_path,
    sliding_displacement,
)
from contact1d.analysis.theory.relaxing import Indented
from contact1d.workflow.body.cases import Case, Values
from contact1d.workflow.scene import Friction, Impact, Scene
from contact1d.workflow.units import NUMBER, Quantity, Scales, scale_of

ANY = ""
"""The kind of profile of a closed form for several kinds."""
BODIES = {
    "parabola": "a paraboloid", "cone": "a cone", "flat_punch": "a flat punch", "circle": "a whole sphere",
    "ellipsoid": "a whole ellipsoid", "power": "a power of the radius",
}  # fmt: skip
"""The name of a body by the kind of its profile."""


@dataclass(frozen=True)
class ClosedForm:
    """A theory with its conditions and its predictions of results.

    Attributes:
        name: its usual name: "Hertz".
        source: its publication.
        holds: returns why it holds for a body of its kind, in a few words; "" where it does not.
        values: returns its predictions, by the names of results, in their units of the model.
        kind: kind of the profile that it is for, as in a scene; ANY where `holds` decides.
        pressure: returns p(r) [FU/LU²] at r (n,) [LU] in the reported state; None where it predicts no pressure.
        has_range: whether the predictions depend on the Tabor parameter.
        is_limit: whether it is a limit between or beyond which a run lies, so that predictions have no deviation.
    """

    name: str
    source: str
    holds: Callable[[Case], str]
    values: Callable[[Case], Values]
    kind: str = "parabola"
    pressure: Callable[[Case, Array], Array] | None = None
    has_range: bool = False
    is_limit: bool = False

    def applies(self, case: Case) -> str:
        """Return why the theory holds for a case of its family, in a few words; "" where it does not."""
        return self.holds(case) if self.kind in (ANY, case.kind) else ""


def applying(case: Case) -> list[ClosedForm]:
    """Return the closed forms whose conditions hold for a case, in the order of its contact law; [] for none."""
    return _applying(case, case.law.closed_forms)


def exact(case: Case) -> list[ClosedForm]:
    """Return the closed forms that solve the model of a case exactly, and whose conditions hold; [] without any.

    [] for any other run than a quasi-static one on a rigid plane with the MDR, all of whose effects the reduced model
    has.
    """
    scene = case.scene
    by_mdr = scene.bodies.lower == "rigid_plane" and scene.bodies.reduction == "mdr"
    known = by_mdr and scene.is_modelled and scene.is_stepped
    return _applying(case, case.law.exact) if known else []


def _applying(case: Case, families: Sequence[str]) -> list[ClosedForm]:
    """Return the closed forms of the named families, in this order, whose conditions hold for a case; [] for none.

    Raises:
        KeyError: there is no family of a name.
    """
    return [form for family in families for form in FORMS[family] if form.applies(case)]


def theory(scene: Scene, quantities: Mapping[str, Quantity], scales: Scales) -> list[dict[str, Any]]:
    """Return the entry `theory` of results.json: an entry for each closed form that holds; [] where none does.

    Each has "name", "source", "applies" (why it holds), "tabor" where the values depend on it, and "values":
    prediction, unit and deviation by the name of a result. A prediction of a result that the run lacks is left out.

    Args:
        scene: the scene of the run.
        quantities: its results, of the body, by name, in units of the model.
        scales: sizes of LU and FU in SI.
    """
    case = Case(scene, quantities, scales)
    return [_entry(form, case, scales) for form in applying(case)]


def _entry(form: ClosedForm, case: Case, scales: Scales) -> dict[str, Any]:
    """Return the entry of a closed form in results.json: "name", "source", "applies" and "values" by name of a result.

    Of each prediction "values" has "value" and "unit" (of the model), "si" with both where the size of the unit is
    known, and "deviation", the result of the run over it minus 1, None for a prediction of 0 and of a limit.
    Predictions of results that the run lacks are left out. "tabor" is there where the closed form depends on the Tabor
    parameter.
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
        values[name]["deviation"] = ours.value / value - 1.0 if value and not form.is_limit else None
    depends = {"tabor": tabor(case)} if form.has_range else {}
    return {"name": form.name, "source": form.source, "applies": form.applies(case), **depends, "values": values}


def in_words(results: Mapping[str, Any], name: str) -> Iterator[str]:
    """Yield the prediction of each closed form for a result, with the deviation: `Hertz 110.37 µm (+0.001 %)`.

    The deviation is that of the run from the prediction, in per cent with two digits; it is left out for a prediction
    of 0. Predictions have five digits, in SI with a prefix where the units are known, else in units of the model.
    Nothing is yielded where no closed form has the result.

    Args:
        results: the content of results.json.
        name: of the result.
    """

    for form in results.get("theory", ()):
        if prediction := form["values"].get(name):
            entry, deviation = prediction.get("si", prediction), prediction["deviation"]
            factor, unit = scale_of(entry["value"], entry["unit"]) if "si" in prediction else (1.0, prediction["unit"])
            # Smaller deviations are round-off, and + 0.0 makes no −0 of them.
            off = "" if deviation is None else f" ({round(100.0 * deviation, 6) + 0.0:+.2g} %)"
            tabor_parameter = f" (μ = {form['tabor']:.3g})" if "tabor" in form else ""
            size = f"{entry['value'] * factor:.5g} {unit}".removesuffix(f" {NUMBER}")
            yield f"{form['name']}{tabor_parameter} {size}{off}"


# Without adhesion. Under a given F: d, a, F/πa², p(0), dF/dd = 2E*a; at a given d: F, a and the pressures.


def _pressed(case: Case) -> str:
    """Return "<body>, pressed without adhesion" where the closed form of such a body holds, else "".

    It holds where particles are pressed as linear springs (no attraction, viscoelasticity, springs between neighbours,
    or noise), the run has a force or a given displacement (an impact has neither), and the reduction is "mdr", or the
    paper's for a parabola or a circle without [interaction].
    """
    kept = case.scene.bodies.reduction == "mdr" or (case.radius is not None and case.scene.interaction is None)
    pressed = case.force is not None or case.displacement is not None
    return f"{BODIES[case.kind]}, pressed without adhesion" if kept and pressed and case.is_elastic else ""


def _contact(case: Case, a: float, d: float, force: float) -> Values:
    """Return the predictions of a contact by the names of results, from its radius a, displacement d and force F.

    "contact_radius", "largest_radius" and "displacement" [LU], "force" and "largest_force" [FU], "contact_stiffness"
    [FU/LU], and where a > 0 "mean_pressure" [FU/LU²]. "force" is left out where the force of the case is known, else
    "displacement".

    Args:
        case: the case, whose contact modulus gives the stiffness 2E*a.
        a: contact radius [LU].
        d: displacement [LU].
        force: normal force [FU], compression positive.
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
    """Return the predictions of a body pressed without adhesion, by the names of results.

    "contact_radius", "largest_radius" [LU], "displacement" [LU] under a known force, else "force" [FU], "largest_force"
    [FU], "contact_stiffness" [FU/LU], "mean_pressure" for a contact radius above 0, and where finite "central_pressure"
    and "peak_pressure" [FU/LU²]: a cone has neither, a power with an exponent above 2 no peak.
    """
    body, a = case.body, case.contact_radius
    pressures = {"central_pressure": body.central_pressure(a), "peak_pressure": body.peak_pressure(a)}
    bounded = {name: pressure for name, pressure in pressures.items() if math.isfinite(pressure)}
    return _contact(case, a, body.displacement(a), body.force(a)) | bounded


def _pressure(case: Case, r: Array) -> Array:
    """Return p(r), (n,) [FU/LU²], compression positive, of a paraboloid or a cone in the reported state, r (n,) [LU].

    By Hertz, Sneddon, or with adhesion JKR: tension at the edge; 0 from the edge on. Infinite at a cone's tip.

    Raises:
        AssertionError: the body is an ellipsoid, a circle or a flat punch.
        ValueError: the body is a power with an exponent other than 1 and 2.
    """
    body = case.body
    assert isinstance(body, PowerLaw)
    return body.pressure(r, case.contact_radius)


def _punch_values(case: Case) -> Values:
    """Return the predictions of a flat punch without adhesion by name, p(0) = E*d/πa as "central_pressure" [FU/LU²].

    Also "mean_pressure" [FU/LU²], "contact_stiffness" [FU/LU], "largest_force" [FU], and "displacement" [LU] under a
    known force, else "force" [FU]. No radius is among them, and no largest pressure, which is singular at the edge.
    """
    punch, d = case.punch
    values = _contact(case, punch.radius, d, punch.stiffness * d)
    del values["contact_radius"], values["largest_radius"]
    return values | {"central_pressure": float(punch.pressure(0.0, d))}


def _punch_pressure(case: Case, r: Array) -> Array:
    """Return p(r), (n,) [FU/LU²], compression positive, of a flat punch without adhesion, at radii r < a, (n,) [LU].

    The pressure is infinite at the edge r = a, NaN beyond.
    """
    punch, d = case.punch
    return punch.pressure(r, d)


# Adhesive: F_A, the radii there and at F = 0, and d, F and a of a load or of the largest displacement of a path.


def _adhesive(case: Case) -> str:
    """Return "<body> that adheres, without a range".

    That the case has adhesion is not checked: only laws with [adhesion] have such closed forms.
    """
    return f"{BODIES[case.kind]} that adheres, without a range"


def _marks(case: Case, contact: Contact) -> Values:
    """Return the predictions of an adhesive contact by the names of results.

    "adhesion_force", the pull-off force F_A [FU] as a positive tension; "critical_radius" and "zero_load_radius", the
    contact radii there and at F = 0 [LU]; and under a known force that is no larger tension than F_A "contact_radius"
    and "displacement" [LU].
    """
    values = {
        "adhesion_force": contact.pull_off_force(), "critical_radius": contact.critical_radius(),
        "zero_load_radius": contact.zero_load_radius(),
    }  # fmt: skip
    if case.force is not None and case.force >= -values["adhesion_force"]:
        a = contact.contact_radius(case.force)
        values |= {"contact_radius": a, "displacement": contact.displacement(a)}
    return values


def _adhesive_values(case: Case) -> Values:
    """Return the predictions of JKR, or its extension to the profile, for a body on a plane, by the names of results.

    "adhesion_force" [FU], a positive tension, "critical_radius", "zero_load_radius" and "fixed_grips_displacement"
    (where the contact is lost under displacement control; compression positive) [LU], "adhesion_energy" πa²W [FU·LU],
    and under a known force that the contact sustains "contact_radius" and "displacement" [LU] and, if it is in contact,
    "mean_pressure" [FU/LU²]. Of a paraboloid in contact also "central_pressure" and "peak_pressure", both p(0)
    [FU/LU²].

    The radius a of "adhesion_energy" is that under the force; without a known force that at the displacement of the
    run, or if the run has no such result at F = 0; 0 beyond pull-off.
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
    """Return "adhesion_force", F_A = √(8πE*Wa³) [FU], a positive tension, of an adhesive flat punch of radius a.

    Under a known force F [FU], compression positive, also "displacement", d = F/2E*a [LU].
    """
    punch, d = case.punch
    values = {"adhesion_force": punch.pull_off_force()}
    return values if case.force is None else values | {"displacement": d}


def tabor(case: Case) -> float | None:
    """Return the Tabor parameter µ = (R W²/E*² h₀³)^{1/3} (dimensionless) of an adhesive contact.

    R is the effective radius and h₀ the range of the attraction; for JKR, which has none, 0.3 nm is assumed. None where
    the profile has no effective radius, W is 0, there is no attraction, or JKR's LU is unknown in metres.
    """
    return None if case.with_range is None else case.with_range.tabor


def _has_range(case: Case) -> str:
    """Return text with the Tabor parameter of an adhesive paraboloid and the theory that holds there.

    The range may be an assumed one. "" without a Tabor parameter.
    """
    mu = tabor(case)
    if mu is None:
        return ""
    return f"a paraboloid with a range; the Tabor parameter is {mu:.3g}, where {valid_theory(mu, 0.0).theory} holds"


def _is_below_jkr(case: Case) -> str:
    """Return the text of `_has_range` for a Tabor parameter that is not one of JKR, up to 5; else ""."""
    mu = tabor(case)
    return "" if mu is None or of_tabor(mu) is Theory.JKR else _has_range(case)


def _by_tabor(theory: Theory, case: Case) -> str:
    """Return text with the Tabor parameter of a case with an interaction where `theory` holds, or "".

    It is "" for another reduction than the MDR (with which E* and R are the body's), with springs between neighbours,
    with noise, and where the Tabor parameter is one of another theory (JKR above 5, DMT below 0.1, else Maugis and
    Dugdale).
    """
    scene, mu = case.scene, tabor(case)
    departs = scene.bodies.reduction != "mdr" or scene.neighbours or scene.noise
    if mu is None or departs or of_tabor(mu) is not theory:
        return ""
    return f"the Tabor parameter μ = {mu:.3g}, of the implied W and the force-free distance"


def _sphere_values(theory: Theory, case: Case) -> Values:
    """Return the predictions of JKR, DMT, or Maugis and Dugdale for a sphere with a range, by the names of results.

    "adhesion_force" [FU], a positive tension, "critical_radius" (but by DMT) and "zero_load_radius" [LU], and under a
    known force that the contact sustains "contact_radius" and "displacement" [LU]. Maugis and Dugdale predict no
    "displacement" for an interaction: there it has another origin.

    Raises:
        AssertionError: the case has no range of an attraction.
    """
    assert case.with_range
    values = _marks(case, case.with_range.theories[theory])
    if theory is Theory.DMT:
        del values["critical_radius"]
    if theory is Theory.MAUGIS and case.scene.interaction:
        values.pop("displacement", None)
    return values


# Tangential: of a sphere under a constant load N, F_x, c and a on any path; at a constant displacement N as well.
# Of closed cycles the energy that one dissipates.


def drawn_along(case: Case) -> str:
    """Return text that states the condition of Cattaneo and Mindlin; "" where it does not hold.

    It holds in a tangential experiment with a parabola, a coefficient of friction other than 0, and the same normal
    force, or normal displacement, above 0 in all load steps, but for round-off.
    """
    experiment: Any = case.scene.experiment
    if not experiment.goes_along or case.kind != "parabola" or case.scene.the(Friction).coefficient == 0.0:
        return ""
    loads = experiment.normal_forces() or experiment.places()
    # Loads that differ by round-off are equal.
    is_constant = case.radius is not None and min(loads) > 0.0 and max(loads) - min(loads) <= 1e-12 * max(loads)
    return "a paraboloid under one load, displaced tangentially with friction" if is_constant else ""


def sliding_contact(case: Case) -> tuple[float, float, float, float]:
    """Return (N [FU], μ, u* [LU], a [LU]) of a paraboloid displaced tangentially under a constant load, in closed form.

    N is the normal force, compression positive, u* the tangential displacement at which full sliding begins, a the
    contact radius. The case must be a tangential experiment with friction and a parabola.
    """
    experiment: Any = case.scene.experiment
    scene, body, loads = case.scene, case.body, experiment.normal_forces()
    edge = body.contact_radius(loads[0]) if loads else body.radius_at(experiment.places()[0])
    coefficient, ratio = scene.the(Friction).coefficient, scene.tangential_stiffness / scene.bulk_stiffness
    return body.force(edge), coefficient, sliding_displacement(coefficient, ratio, body.displacement(edge)), edge


def _mindlin_values(case: Case) -> Values:
    """Return the predictions of Cattaneo and Mindlin at the end of the path, by the names of results.

    "tangential_force" [FU], with the sign of the displacement in loading, "contact_radius" and "stick_radius" [LU] and,
    where the scene prescribes the normal displacement, "normal_force" [FU], compression positive.
    "dissipated_energy_per_cycle" [FU·LU] ≥ 0 is that of a closed cycle with the largest tangential displacement as its
    amplitude, also of a path without cycles.
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


# Oblique impact: what a body does that slips until it stops, and one that never slips.


def _oblique(case: Case) -> str:
    """Return text that states the condition of theories of oblique impacts; "" of another experiment, or v_s = 0."""
    return "a body that hits a plane obliquely, with friction" if case.scene.slip_velocity else ""


def _sticks(case: Case) -> str:
    """Return text that states the condition of an oblique impact without slip, for a power of the radius; else ""."""
    return "an oblique impact without slip" if _oblique(case) and case.scene.bodies.profile.degree else ""


def _sliding_values(case: Case) -> Values:
    """Return {"tangential_restitution": −max(0, 1 − 2 μ v_n (1 + m l²/I)/|v_s|)} of gross sliding, until v_s is 0."""
    scene, impact = case.scene, case.scene.experiment
    assert isinstance(impact, Impact)
    slowed = 2.0 * scene.the(Friction).coefficient * impact.velocity * (1.0 + scene.spin_ratio)
    return {"tangential_restitution": min(0.0, slowed / abs(scene.slip_velocity) - 1.0)}


def _sticking_values(case: Case) -> Values:
    """Return {"tangential_restitution": −v_s′/v_s of full stick}, which does not depend on the angle."""
    scene, body = case.scene, case.body
    assert isinstance(body, PowerLaw)
    chi = 0.5 * scene.tangential_stiffness / scene.bulk_stiffness * (1.0 + scene.spin_ratio)
    return {"tangential_restitution": -full_stick(body.exponent, chi)}


# Viscoelastic, indented once by a given displacement: F over time, and the time of the separation.


def indented(case: Case) -> Indented | None:
    """Return the history of an indentation by given displacements, for Ting's theory; None where it does not hold.

    It holds for a viscoelastic parabola, cone or power. None for another profile, without a Prony series (also of
    dashpots), without given displacements, and where these begin above 0 or have more than one maximum.

    Raises:
        ValueError: the largest displacement is below 0.
    """
    given: Any = case.scene.experiment
    exponent = case.scene.bodies.profile.degree
    terms, displacements = case.law.series(case.scene), given.places()
    if not (terms and exponent and displacements):
        return None
    force = case.body.force(case.body.radius_at(max(displacements)))
    try:
        return Indented(tuple(given.times), tuple(displacements), force, exponent, terms)
    except ValueError:
        return None


def _relaxes(case: Case) -> str:
    """Return "a body that relaxes, pressed once by a given displacement" where Ting's theory holds; else "".

    It holds of a viscoelastic parabola, cone or power with a Prony series whose given displacements have one maximum.
    """
    return "a body that relaxes, pressed once by a given displacement" if indented(case) else ""


def _ting_values(case: Case) -> Values:
    """Return the predictions of Ting: "peak_force" and, at the end of the history, "force" [FU], compression positive.

    Where the bodies separate before the end also "contact_time" [TU], from first touch to separation. The peak is the
    largest force at 200 times and at the corners of the history.

    Raises:
        AssertionError: the case is no single indentation of a viscoelastic parabola, cone or power.
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
            _pressed,
            _elastic_values,
            pressure=_pressure,
        ),
        ClosedForm("Sneddon, cone", SNEDDON, _pressed, _elastic_values, "cone", _pressure),
        ClosedForm("Sneddon, flat punch", SNEDDON, _pressed, _punch_values, "flat_punch", _punch_pressure),
        ClosedForm("Sneddon, sphere", SNEDDON, _pressed, _elastic_values, "circle"),
        ClosedForm("Sneddon, ellipsoid", f"{SNEDDON}: his sphere, flattened", _pressed, _elastic_values, "ellipsoid"),
        ClosedForm("Galin, power", f"L. A. Galin 1953; {SNEDDON}", _pressed, _elastic_values, "power"),
    ),
    "adhesive": (
        ClosedForm("JKR", JKR, _adhesive, _adhesive_values, pressure=_pressure),
        ClosedForm(
            "Maugis and Barquins, cone",
            "D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981) L95",
            _adhesive,
            _adhesive_values,
            "cone",
        ),
        ClosedForm(
            "Popov and Heß, power",
            "V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, section 4.4",
            _adhesive,
            _adhesive_values,
            "power",
        ),
        ClosedForm("JKR, whole sphere", "D. Maugis, Langmuir 11 (1995) 679", _adhesive, _adhesive_values, "circle"),
        ClosedForm(
            "Kendall, flat punch",
            "K. Kendall, J. Phys. D 4 (1971) 1186",
            _adhesive,
            _adhesive_punch_values,
            "flat_punch",
        ),
    ),
    "zone": (
        ClosedForm("Maugis and Dugdale", MAUGIS, _has_range, partial(_sphere_values, Theory.MAUGIS), has_range=True),
    ),
    "transition": (
        ClosedForm("Maugis and Dugdale", MAUGIS, _is_below_jkr, partial(_sphere_values, Theory.MAUGIS), has_range=True),
    ),
    "dmt": (ClosedForm("DMT", DMT, _is_below_jkr, partial(_sphere_values, Theory.DMT)),),
    "interaction": tuple(
        ClosedForm(
            str(theory),
            source,
            partial(_by_tabor, theory),
            partial(_sphere_values, theory),
            has_range=theory is Theory.MAUGIS,
        )
        for theory, source in ((Theory.JKR, JKR), (Theory.MAUGIS, MAUGIS), (Theory.DMT, DMT))
    ),
    "along": (
        ClosedForm(
            "Cattaneo and Mindlin",
            "C. Cattaneo 1938; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327",
            drawn_along,
            _mindlin_values,
        ),
    ),
    "oblique": (
        ClosedForm(
            "gross sliding",
            "K. L. Johnson, Contact Mechanics, 1985, section 11.4",
            _oblique,
            _sliding_values,
            ANY,
            is_limit=True,
        ),
        ClosedForm(
            "full stick",
            "N. Maw, J. R. Barber, J. N. Fawcett, Wear 38 (1976) 101",
            _sticks,
            _sticking_values,
            ANY,
            is_limit=True,
        ),
    ),
    "relaxing": (
        ClosedForm(
            "Ting",
            "T. C. T. Ting, J. Appl. Mech. 33 (1966) 845; loaded as by E. H. Lee, J. R. M. Radok 1960",
            _relaxes,
            _ting_values,
            ANY,
        ),
    ),
}
"""Closed forms by family; each has its own conditions."""
