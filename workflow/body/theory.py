"""The closed forms beside the results of a run: one table, each with when it applies and what it says of the results.

Pressed without adhesion: Hertz, Sneddon, Galin. Adhesive on a plane: JKR and its like for other profiles, Maugis and
Dugdale with a range. A sphere that an interaction holds: JKR, Maugis and Dugdale or DMT by Tabor's µ. Drawn along a
plane with friction: Cattaneo and Mindlin.

results.json has them as `theory`: a list of {"name", "source", "applies", "values"}; of each result in `values` the
closed form's "value" and "unit", with known units "si", and "deviation", the run's value over it minus 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.theory import mindlin, sneddon
from contact1d.analysis.theory.adhesive_power import AdhesivePower
from contact1d.analysis.theory.dmt import Dmt
from contact1d.workflow.scene import Scene
from contact1d.workflow.scene.tables import SPHERES
from contact1d.workflow.units import Quantity, Scales, scale_of

Array = NDArray[np.float64]
Values = dict[str, float]

SHOWN = 6
"""Decimals of a deviation in percent: below that it is round-off."""
HALVINGS = 120
"""Of the bracket of a radius: below round-off. (`scipy.optimize` takes longer to import than a small run.)"""
ROUND_OFF = 1e-12
"""Relative: of one load, and of a sphere's radius below which its contact is looked for, no bound being at the rim."""
POINTS = 200
"""Of Gauss's quadrature of a smooth function: its error is below round-off."""
JKR_ABOVE, DMT_BELOW = 5.0, 0.1
"""Tabor's µ beyond which a limit holds (`analysis.theory.tabor`)."""
OF_ANY_INTERACTION = ("adhesion_force", "zero_load_radius", "critical_radius", "contact_radius", "displacement")
"""What JKR says of a sphere that an interaction holds, with or without a load."""


@dataclass(frozen=True)
class Case:
    """A finished run, as a closed form sees it; all in model units.

    Attributes:
        scene: what ran.
        quantities: what it found, of the body, by name.
    """

    scene: Scene
    quantities: Mapping[str, Quantity]

    @property
    def contact_modulus(self) -> float:
        """E* [FU/LU²] of the body: that of the layer, c = k/χh, with the MDR; 2c with the paper's reduction."""
        layer = self.scene.bulk_stiffness / (self.scene.chains * self.scene.bodies.spacing)
        return layer if self.scene.bodies.reduction == "mdr" else 2.0 * layer

    @property
    def radius(self) -> float | None:
        """Effective R [LU] of a sphere on a plane, or of the paper's two equal spheres, R/2; None for no sphere."""
        curvature = self.scene.bodies.profile.curvature_radius
        if curvature is None or self.scene.bodies.reduction == "mdr":
            return curvature
        return 0.5 * curvature if self.kind in SPHERES else None

    @property
    def kind(self) -> str:
        """Of the profile."""
        return self.scene.bodies.profile.kind

    @property
    def force(self) -> float | None:
        """F [FU] of the state that is reported, where the scene gives it; else None."""
        return float(self.quantities["force"].value) if "force" in self.quantities else None

    @property
    def displacement(self) -> float | None:
        """d [LU] of the state that is reported, where the scene gives it (the deepest of a path); else None."""
        places = self.scene.experiment.places()
        return max(places) if places and self.force is None else None

    @property
    def work(self) -> float:
        """W [FU/LU]: given, or implied by the interaction at the radius that the run found; 0 without."""
        if self.scene.adhesion is not None:
            return self.scene.adhesion.work
        implied = self.quantities.get("work_of_adhesion")
        return 0.0 if implied is None else float(implied.value)

    @property
    def range(self) -> float:
        """z₀ [LU]: given, or the force-free distance of an interaction that attracts; 0 where neither is."""
        if self.scene.adhesion is not None:
            return self.scene.adhesion.range or 0.0
        terms = self.scene.interaction
        if terms is None or terms.attraction is None:
            return 0.0
        a, b = terms.repulsion.range, terms.attraction.range
        return math.log(terms.repulsion.amplitude * b / (terms.attraction.amplitude * a)) * a * b / (b - a)

    @property
    def is_elastic(self) -> bool:
        """Whether springs under the profile are all there is: no attraction, no neighbour springs, no noise."""
        scene = self.scene
        return not (scene.adheres or scene.neighbours or scene.noise)

    def power(self) -> tuple[float, float]:
        """c and n of the profile z = c rⁿ, for a cone, a power or a sphere."""
        profile: Any = self.scene.bodies.profile
        if self.kind == "cone":
            return profile.slope, 1.0
        if self.kind == "power":
            return profile.height_there / profile.radius**profile.exponent, profile.exponent
        assert self.radius is not None
        return 0.5 / self.radius, 2.0


@dataclass(frozen=True)
class ClosedForm:
    """One theory.

    Attributes:
        name: what it is called: "Hertz".
        source: where it is written down.
        applies: why it holds for a case, in a few words; "" where it does not.
        values: what it says, by the names of results, in their model units; of those the run's are compared.
        pressure: p(r) [FU/LU²] at r [LU] in the reported state, where it says that.
    """

    name: str
    source: str
    applies: Callable[[Case], str]
    values: Callable[[Case], Values]
    pressure: Callable[[Case, Array], Array] | None = None


def applying(case: Case) -> list[ClosedForm]:
    """The closed forms that hold for a case."""
    return [form for form in FORMS if form.applies(case)]


def theory(scene: Scene, quantities: Mapping[str, Quantity], scales: Scales | None) -> list[dict[str, Any]]:
    """What results.json has as `theory`; `quantities` of the body, `scales` of the run."""
    case = Case(scene, quantities)
    return [_entry(form, case, scales) for form in applying(case)]


def _entry(form: ClosedForm, case: Case, scales: Scales | None) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for name, value in form.values(case).items():
        if name not in case.quantities:
            continue
        ours = case.quantities[name]
        values[name] = {"value": value, "unit": ours.unit}
        if scales is not None:
            si = scales.in_si(value, 0.0, ours.unit)
            values[name]["si"] = {"value": si["value"], "unit": si["unit"]}
        values[name]["deviation"] = ours.value / value - 1.0 if value else None
    return {"name": form.name, "source": form.source, "applies": form.applies(case), "values": values}


def in_words(results: Mapping[str, Any], name: str) -> Iterator[str]:
    """What each closed form says of a result, and how far the result is from it: `Hertz 110.37 µm (+0.001 %)`."""
    for form in results.get("theory", ()):
        if said := form["values"].get(name):
            entry = said.get("si", said)
            factor, unit = scale_of(entry["value"], entry["unit"]) if "si" in said else (1.0, said["unit"])
            off = "" if said["deviation"] is None else f" ({round(100.0 * said['deviation'], SHOWN) + 0.0:+.2g} %)"
            yield f"{form['name']} {entry['value'] * factor:.5g} {unit}{off}"


# Pressed without adhesion. Under a given F: d, a, F/πa², p(0), dF/dd = 2E*a; at a given d: F, a and the pressures.


def _pressed(kind: str, words: str) -> Callable[[Case], str]:
    """Applies to a profile of that kind, pressed and nothing else, whose reduction keeps it."""

    def applies(case: Case) -> str:
        stands = case.scene.bodies.reduction == "mdr" or (case.radius is not None and case.scene.interaction is None)
        pressed = case.force is not None or case.displacement is not None
        return words if case.kind == kind and stands and pressed and case.is_elastic else ""

    return applies


def _contact_radius(case: Case, indenter: sneddon.PowerLaw | sneddon.Sphere, flat: float, reach: float) -> float:
    """a [LU] below `reach` of the reported state, from its force or displacement; of a body `flat` times as high."""
    given = case.force if case.force is not None else case.displacement or 0.0
    curve, wanted = (indenter.displacement if case.force is None else indenter.force), given / flat
    if not wanted > 0.0:
        return 0.0
    low, high = 0.0, min(case.scene.bodies.spacing, reach)
    while high < reach and float(curve(high)) < wanted:
        high = min(2.0 * high, reach)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if float(curve(middle)) < wanted else (low, middle)
    return 0.5 * (low + high)


def _contact(case: Case, a: float, d: float, force: float, central: float | None = None) -> Values:
    """What is known of a contact with a [LU], d [LU], F [FU], p(0) [FU/LU²]; what the scene gives is no prediction."""
    said = {
        "displacement": d, "force": force, "contact_radius": a, "largest_force": force, "largest_radius": a,
        "contact_stiffness": 2.0 * case.contact_modulus * a,
    }  # fmt: skip
    del said["force" if case.force is not None else "displacement"]
    if a > 0.0:
        said["mean_pressure"] = force / (math.pi * a**2)
    return said if central is None else said | {"peak_pressure": central, "central_pressure": central}


def _power_contact(case: Case) -> tuple[sneddon.PowerLaw, float]:
    body = sneddon.PowerLaw(*case.power(), case.contact_modulus)
    return body, _contact_radius(case, body, 1.0, math.inf)


def _power_values(case: Case) -> Values:
    """p(0) = E* κ_n c a^{n−1}/π · n/(n−1) for n > 1; a cone's has no bound. For n ≤ 2 it is the largest."""
    body, a = _power_contact(case)
    n, central = body.exponent, None
    if n > 1.0:
        rise = sneddon.galin_factor(n) * body.coefficient * a ** (n - 1.0)
        central = case.contact_modulus * rise * n / (math.pi * (n - 1.0))
    said = _contact(case, a, float(body.displacement(a)), float(body.force(a)), central)
    if n > 2.0:  # the largest pressure is off the axis
        del said["peak_pressure"]
    return said


def _hertz_pressure(case: Case, r: Array) -> Array:
    """p₀ √(1 − r²/a²), p₀ = 2E*a/πR."""
    assert case.radius is not None
    _, a = _power_contact(case)
    peak = 2.0 * case.contact_modulus * a / (math.pi * case.radius)
    return peak * np.sqrt(np.maximum(0.0, 1.0 - (r / a) ** 2))


def _cone_pressure(case: Case, r: Array) -> Array:
    body, a = _power_contact(case)
    return sneddon.cone_pressure(np.maximum(r, ROUND_OFF * a), a, body.coefficient, case.contact_modulus)


def _round_values(case: Case) -> Values:
    """A whole sphere of radius c, b/c times as high: p(0) = (E*/π) (b/c) ∫₀^a g′/x dx.

    g′ = artanh(x/c) + xc/(c² − x²): by quadrature, its first part has no form.
    """
    profile: Any = case.scene.bodies.profile
    flat = profile.half_axis / profile.radius if case.kind == "ellipsoid" else 1.0
    c = float(profile.radius if case.kind == "ellipsoid" else case.radius or 0.0)
    body = sneddon.Sphere(c, case.contact_modulus)
    a = _contact_radius(case, body, flat, (1.0 - ROUND_OFF) * c)
    nodes, weights = np.polynomial.legendre.leggauss(POINTS)
    x = 0.5 * a * (nodes + 1.0)
    rate = flat * 0.5 * a * float(weights @ (np.arctanh(x / c) / x + c / (c**2 - x**2)))
    central = case.contact_modulus / math.pi * rate
    return _contact(case, a, flat * float(body.displacement(a)), flat * float(body.force(a)), central)


def _punch(case: Case) -> tuple[sneddon.FlatPunch, float]:
    """The punch and its d [LU], F = 2E*ad."""
    profile: Any = case.scene.bodies.profile
    punch = sneddon.FlatPunch(profile.radius, case.contact_modulus)
    if case.force is not None:
        return punch, case.force / (2.0 * case.contact_modulus * punch.radius)
    return punch, max(case.displacement or 0.0, 0.0)


def _punch_values(case: Case) -> Values:
    """p(0) = E*d/πa; at the edge the pressure has no bound, and a is given."""
    punch, d = _punch(case)
    a, e = punch.radius, case.contact_modulus
    said = _contact(case, a, d, 2.0 * e * a * d) | {"central_pressure": e * d / (math.pi * a)}
    return {name: value for name, value in said.items() if name not in ("contact_radius", "largest_radius")}


def _punch_pressure(case: Case, r: Array) -> Array:
    punch, d = _punch(case)
    return punch.pressure(r, d)


# Adhesive: F_A, the radii there and at F = 0, and of a load or the deepest place of a path d, F and a.


def _adheres(kind: str, words: str) -> Callable[[Case], str]:
    """Applies to a profile of that kind on a plane with an energy of adhesion."""
    return lambda case: words if case.scene.adhesion is not None and case.kind == kind and case.work > 0.0 else ""


def _adhesive(case: Case) -> AdhesivePower:
    return AdhesivePower(*case.power(), case.contact_modulus, case.work)


def _reported_radius(case: Case) -> float:
    """a [LU] of the reported state: under a load, at the deepest place of a path, at F = 0; 0 where nothing holds."""
    body, place = _adhesive(case), case.displacement
    if place is not None:
        return body.radius_at(place) if place >= body.displacement(body.fixed_grips_radius()) else 0.0
    force = case.force or 0.0
    return body.contact_radius(force) if force >= -body.pull_off_force() else 0.0


def _adhesive_values(case: Case) -> Values:
    body = _adhesive(case)
    said = {
        "adhesion_force": body.pull_off_force(), "critical_radius": body.critical_radius(),
        "zero_load_radius": body.zero_load_radius(),
        "fixed_grips_displacement": body.displacement(body.fixed_grips_radius()),
    }  # fmt: skip
    held = case.force is None or case.force >= -body.pull_off_force()
    a = body.contact_radius(case.force or 0.0) if held else 0.0
    said["adhesion_energy"] = math.pi * a**2 * case.work
    if case.kind == "parabola" and _reported_radius(case) > 0.0:
        said["central_pressure"] = said["peak_pressure"] = float(_jkr_pressure(case, np.zeros(1))[0])
    if case.force is not None and held:
        said |= {"displacement": body.displacement(a), "contact_radius": a,
                 "mean_pressure": case.force / (math.pi * a**2)}  # fmt: skip
    return said


def _jkr_pressure(case: Case, r: Array) -> Array:
    """p = (2E*a/πR) √(1 − r²/a²) − √(2E*W/πa)/√(1 − r²/a²), in the reported state."""
    e, a = case.contact_modulus, _reported_radius(case)
    assert case.radius is not None
    if a == 0.0:
        return np.zeros_like(r)
    root = np.sqrt(np.maximum(1.0 - (r / a) ** 2, 0.0))
    with np.errstate(divide="ignore"):
        tension = math.sqrt(2.0 * e * case.work / (math.pi * a)) / root
    return np.where(root > 0.0, 2.0 * e * a / (math.pi * case.radius) * root - tension, 0.0)


def _adhesive_punch_values(case: Case) -> Values:
    """F_A = √(8πE*Wa³); before that F = 2E*ad."""
    punch, d = _punch(case)
    said = {"adhesion_force": math.sqrt(8.0 * math.pi * case.contact_modulus * case.work * punch.radius**3)}
    return said if case.force is None else said | {"displacement": d}


def tabor(case: Case) -> float | None:
    """µ = (R W²/E*² z₀³)^{1/3} of a sphere with a range; None for anything else."""
    if case.radius is None or not (case.work > 0.0 and case.range > 0.0):
        return None
    return math.cbrt(case.radius * (case.work / case.contact_modulus) ** 2) / case.range


def _with_a_range(case: Case) -> str:
    """µ and what follows from it."""
    mu = tabor(case)
    if mu is None or case.scene.adhesion is None or case.kind != "parabola":
        return ""
    from contact1d.analysis.theory.tabor import valid_theory  # scipy's solvers take longer than a small run

    return f"a paraboloid with a range; Tabor's number is {mu:.3g}, where {valid_theory(mu, 0.0).theory} holds"


def _by_tabor(holds: Callable[[float], bool]) -> Callable[[Case], str]:
    """Applies to a paraboloid that was transformed, so that E* and R are its own, held by an interaction alone."""

    def applies(case: Case) -> str:
        scene, mu = case.scene, tabor(case)
        sphere = case.kind == "parabola" and scene.bodies.reduction == "mdr" and scene.adhesion is None
        if mu is None or not sphere or scene.neighbours or scene.noise or not holds(mu):
            return ""
        return f"Tabor's μ = {mu:.3g}, with the W that the interaction implies and its force-free distance as range"

    return applies


def _maugis_values(case: Case) -> Values:
    """Maugis and Dugdale's results in the scene's units: πWR, and (πWR²/K)^{1/3} with K = 4E*/3."""
    from contact1d.analysis.theory.maugis_dugdale import MaugisDugdale, maugis_parameter_of_tabor

    mu = tabor(case)
    assert mu is not None
    assert case.radius is not None
    contact, load = MaugisDugdale(maugis_parameter_of_tabor(mu)), math.pi * case.work * case.radius
    length = math.cbrt(0.75 * load * case.radius / case.contact_modulus)
    said = {
        "adhesion_force": load * contact.pull_off_load(), "critical_radius": length * contact.critical_radius(),
        "zero_load_radius": length * contact.zero_load_radius(),
    }  # fmt: skip
    if case.force is not None and case.force >= -said["adhesion_force"]:
        a = contact.contact_radius(case.force / load)
        said["contact_radius"] = length * a
        if case.scene.adhesion is not None:  # an interaction's displacement is counted from another place
            said["displacement"] = length**2 / case.radius * float(contact.displacement(a))
    return said


def _jkr_values(case: Case) -> Values:
    return {name: value for name, value in _adhesive_values(case).items() if name in OF_ANY_INTERACTION}


def _dmt_values(case: Case) -> Values:
    assert case.radius is not None
    body = Dmt(case.radius, case.contact_modulus, case.work)
    said = {"adhesion_force": body.pull_off_force(), "zero_load_radius": body.zero_load_radius()}
    if case.force is not None and case.force > -body.pull_off_force():
        a = float(body.contact_radius(case.force))
        said |= {"contact_radius": a, "displacement": float(body.displacement(a))}
    return said


# Drawn along: of a sphere under one load N, F_x and c on any path there and back, and a; at a displacement N as well.


def _one_load(case: Case) -> tuple[float, float] | None:
    """N [FU] and d [LU] of Hertz's contact; None where there is no sphere, no contact, or more than one load."""
    experiment: Any = case.scene.experiment
    friction = case.scene.friction
    if not experiment.goes_along or case.radius is None or friction is None or friction.coefficient == 0.0:
        return None
    given = experiment.normal_forces() or experiment.places()
    if case.kind != "parabola" or not min(given) > 0.0 or max(given) - min(given) > ROUND_OFF * max(given):
        return None
    stiffness = 4.0 / 3.0 * case.contact_modulus * math.sqrt(case.radius)
    if experiment.normal_forces():
        return given[0], (given[0] / stiffness) ** (2.0 / 3.0)
    return stiffness * given[0] ** 1.5, given[0]


def _mindlin_values(case: Case) -> Values:
    experiment: Any = case.scene.experiment
    scene, loaded = case.scene, _one_load(case)
    assert loaded is not None
    assert scene.friction is not None
    assert case.radius is not None
    (load, depth), coefficient = loaded, scene.friction.coefficient
    edge, places = math.sqrt(case.radius * depth), experiment.along()
    sliding = mindlin.sliding_displacement(coefficient, scene.tangential_stiffness / scene.bulk_stiffness, depth)
    said = {
        "tangential_force": mindlin.mindlin_path(places, load, coefficient, sliding)[-1],
        "contact_radius": edge,
        "stick_radius": mindlin.mindlin_stick_path(places, edge, sliding)[-1],
    }
    return said if experiment.normal_forces() else said | {"normal_force": load}


SNEDDON = "I. N. Sneddon, Int. J. Engng Sci. 3 (1965) 47"
JKR = "K. L. Johnson, K. Kendall, A. D. Roberts, Proc. R. Soc. A 324 (1971) 301"
MAUGIS = "D. Maugis, J. Colloid Interface Sci. 150 (1992) 243"
FORMS = (
    ClosedForm("Hertz", "H. Hertz 1882; K. L. Johnson, Contact Mechanics, 1985, section 4.2",
               _pressed("parabola", "a paraboloid, pressed without adhesion"), _power_values, _hertz_pressure),
    ClosedForm("Sneddon, cone", SNEDDON, _pressed("cone", "a cone, pressed without adhesion"),
               _power_values, _cone_pressure),
    ClosedForm("Sneddon, flat punch", SNEDDON, _pressed("flat_punch", "a flat punch, pressed without adhesion"),
               _punch_values, _punch_pressure),
    ClosedForm("Sneddon, sphere", SNEDDON, _pressed("circle", "a whole sphere, pressed without adhesion"),
               _round_values),
    ClosedForm("Sneddon, ellipsoid", f"{SNEDDON}: his sphere, flattened",
               _pressed("ellipsoid", "a whole ellipsoid, pressed without adhesion"), _round_values),
    ClosedForm("Galin, power", f"L. A. Galin 1953; {SNEDDON}",
               _pressed("power", "a power of the radius, pressed without adhesion"), _power_values),
    ClosedForm("JKR", JKR, _adheres("parabola", "a paraboloid that adheres, without a range"), _adhesive_values,
               _jkr_pressure),
    ClosedForm("Maugis and Barquins, cone", "D. Maugis, M. Barquins, J. Phys. Lett. 42 (1981) L95",
               _adheres("cone", "a cone that adheres, without a range"), _adhesive_values),
    ClosedForm("Popov and Heß, power", "V. L. Popov, M. Heß, Method of Dimensionality Reduction, 2015, section 4.4",
               _adheres("power", "a power of the radius that adheres, without a range"), _adhesive_values),
    ClosedForm("Kendall, flat punch", "K. Kendall, J. Phys. D 4 (1971) 1186",
               _adheres("flat_punch", "a flat punch that adheres, without a range"), _adhesive_punch_values),
    ClosedForm("Maugis and Dugdale", MAUGIS, _with_a_range, _maugis_values),
    ClosedForm("JKR", JKR, _by_tabor(lambda mu: mu > JKR_ABOVE), _jkr_values),
    ClosedForm("Maugis-Dugdale", MAUGIS, _by_tabor(lambda mu: DMT_BELOW <= mu <= JKR_ABOVE), _maugis_values),
    ClosedForm("DMT", "B. V. Derjaguin, V. M. Muller, Yu. P. Toporov, J. Colloid Interface Sci. 53 (1975) 314",
               _by_tabor(lambda mu: mu < DMT_BELOW), _dmt_values),
    ClosedForm("Cattaneo and Mindlin", "C. Cattaneo 1938; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327",
               lambda case: "a paraboloid under one load, drawn along a plane with friction" if _one_load(case) else "",
               _mindlin_values),
)  # fmt: skip
"""Every closed form that a run is laid beside; which of them applies each says itself."""
