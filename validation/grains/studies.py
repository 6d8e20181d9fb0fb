"""What LAMMPS's granular models get wrong of two spheres that meet head-on, or are drawn apart; the program's own."""

import math
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

from validation.doors import on_plane
from validation.grains import cases
from validation.grains.cases import OURS, SPHERES, WORK_OF_ADHESION, at_number, at_velocity, row_name
from validation.grains.granular import INCREMENT, SLOW_STEP, Found, force_at, impact, variables_of
from validation.references.grains import kelvin_voigt
from validation.row import Evidence, Known, Reference, Row, absolute, claim, relative, solver
from validation.study import NOTHING, Bench, Findings, Refused, Study, said
from validation.study import found as result

AGREES = 1e-4
"""A model is right within it, relative, and what it gets wrong is its own law's within it, of the order of 1."""
ABOUT = 1e-3
"""The same of what is drawn apart, absolute."""
GRAINS = "Kelvin-Voigt body, its motion integrated"
JOHNSON = "Johnson, Kendall and Roberts (1971)"
EARLY = "it separates at the pull-off force"
DEEPEST = 0.02
"""To which spheres are pressed, over R."""
LENGTH, ENERGY, TENSION = (
    (math.pi * WORK_OF_ADHESION) ** (2 / 3),
    WORK_OF_ADHESION ** (5 / 3),
    -SPHERES.force(SPHERES.critical),
)
"""(π²W²R/E*²)^(1/3), (W⁵R⁴/E*²)^(1/3), (3/2)πWR."""
LATE = SPHERES.displacement(SPHERES.grips) / LENGTH, SPHERES.lost / ENERGY
"""Overlap at which fixed grips separate, and the energy that is lost."""
SOON = SPHERES.displacement(SPHERES.critical) / LENGTH, SPHERES.lost_to(SPHERES.critical) / ENERGY
"""The same at the pull-off force."""
RADIUS, MASS = 1000.0, math.sqrt(1000.0)
"""[LU], [MU]: with E* = 1 and v = 1 the time T of a Kelvin-Voigt body is 1, and d about 1."""
WORK = 0.01
"""W [FU/LU] of the adhesive body."""
PROFILE, LONG = {"kind": "parabola", "radius": RADIUS}, {"particles": 301}
"""Of the body; a chain that is longer than the deepest adhesive contact."""
FINE, COARSE = (on_plane(PROFILE, spacing, 1e-4) for spacing in (0.25, 1.0))
"""Fine is for the largest force, which a stiff dashpot has early, when few particles touch."""
STICKING = math.sqrt(
    (WORK / WORK_OF_ADHESION) ** (5 / 3) * RADIUS ** (4 / 3) / MASS
) * SPHERES.sticking_velocity(1.0)  # fmt: skip
"""v_s [LU/TU]: ½ m v_s² is as (W⁵R⁴/E*²)^(1/3)."""


def compared(
    name: str, found: Found, exact: float, source: str, law: float, states: str = "–",
    evidence: Evidence = "closed form",
) -> Row:  # fmt: skip
    """A row of what LAMMPS gives, what is exact, and what the model states, which it gives where it differs."""
    known = Known(law, AGREES, states) if abs(law - exact) > AGREES * abs(exact) else None
    reference = Reference(exact, source, evidence)
    return Row(name, found.value, reference, relative(AGREES, "timestep"), found.change, known=known)


def pulled(name: str, found: Found, exact: float, law: float, states: str = EARLY) -> Row:
    """The same of what is drawn apart."""
    known = Known(law, ABOUT, states) if abs(law - exact) > ABOUT else None
    bound = absolute(ABOUT, "increment of the overlap")
    return Row(name, found.value, Reference(exact, JOHNSON), bound, found.change, known=known)


def elastic(_: Bench) -> Findings:
    """No damping, no adhesion."""
    exact = kelvin_voigt(0.0)
    rows = [
        compared(row_name(model, "", name), one, getattr(exact, name), "Hertz (1881)", getattr(exact, name))
        for model, words in cases.ELASTIC.items()
        for name, one in impact(words).items()
    ]
    return Findings(rows)


def damped(_: Bench) -> Findings:
    """Kelvin-Voigt bodies, with the coefficient that makes the force of loading exact."""
    rows, states = [], "F = k d^1.5 + η m √(R d) d′"
    for A, model in product(cases.NUMBERS, cases.DAMPED):
        exact, law, found = kelvin_voigt(A), model.law(2.0 * A), impact(model.words.format(round(2.0 * A, 6)))
        for name in ("restitution", "contact_time", "peak_force") if A in cases.TIMED else ("restitution",):
            rows.append(compared(row_name(model.name, at_number(A), name), found[name], getattr(exact, name), GRAINS,
                                 getattr(law, name), states, "independent solver"))  # fmt: skip
    return Findings(rows)


def asked(_: Bench) -> Findings:
    """Models that are given the coefficient of restitution."""
    rows = []
    for model, e in product(cases.BY_RESTITUTION, cases.ASKED):
        name = row_name(model.name, f"e = {e:g}", "restitution")
        found, law = impact(model.words.format(e))["restitution"], model.law(e).restitution
        rows.append(compared(name, found, e, "what the model is given", law, "F = k d^1.5 + α √(m k) d^¼ d′"))
    return Findings(rows)


def decade(_: Bench) -> Findings:
    """One body at velocities over a decade, with the coefficient that is nearest."""
    rows = []
    for model, (place, A), v in product(cases.FITTED, enumerate(cases.TIMED), cases.DECADE):
        given, rate = cases.coefficient(model, place), 1.0 if model is cases.RESTITUTION else v**0.2
        found, law = impact(model.words.format(given), v)["restitution"], model.law(given * rate).restitution
        exact, name = kelvin_voigt(A * v**0.2).restitution, cases.near_name(model, A, v)
        rows.append(compared(name, found, exact, GRAINS, law, "its own law", "independent solver"))
    return Findings(rows)


def adhesive(_: Bench) -> Findings:
    """Elastic spheres that adhere."""
    sticking = SPHERES.sticking_velocity(1.0)
    later = math.sqrt(SOON[1] / LATE[1])
    rows = []
    for over in cases.OVER_STICKING:
        models = cases.ADHESIVE | ({"nearest jkr": cases.NEAREST_JKR} if over > 1.0 else {})
        found = {name: impact(words, over * sticking, SLOW_STEP)["restitution"] for name, words in models.items()}
        exact = math.sqrt(1.0 - over**-2) if over > 1.0 else 0.0
        laws = {"jkr": math.sqrt(1.0 - (later / over) ** 2), "dmt": 1.0, "nearest jkr": exact}
        for name, one in found.items():
            true = (1.0, "DMT has no hysteresis") if name == "dmt" else (exact, "e² = 1 − (v_s/v)²")
            rows.append(compared(row_name(name, at_velocity(over), "restitution"), one, *true, laws[name], EARLY))
        if over == cases.MEASURED:
            speed = Found(over * math.sqrt(1.0 - found["jkr"].value ** 2), found["jkr"].change / over)
            rows.append(compared(row_name("jkr", "", "sticking velocity"), speed, 1.0, JOHNSON, later, EARLY))
    return Findings(rows)


def drawn(_: Bench) -> Findings:
    """Spheres that are pressed together and drawn apart by displacement."""
    units = {"pull_off": TENSION, "separation": LENGTH, "dissipated": ENERGY}
    answers = {"jkr": ((1.0, *LATE), (1.0, *SOON)), "dmt": ((4.0 / 3.0, 0.0, 0.0), (4.0 / 3.0, 0.0, 0.0))}
    rows = []
    for model, words in cases.ADHESIVE.items():
        coarse, fine = (
            variables_of("pulled", tuple(units), model=words, deepest=DEEPEST, increment=step)
            for step in (INCREMENT, 0.5 * INCREMENT)
        )
        for (name, unit), exact, law in zip(units.items(), *answers[model], strict=True):
            found = Found(fine[name] / unit, abs(fine[name] - coarse[name]) / unit)
            rows.append(pulled(row_name(model, "", name), found, exact, law))
    near = variables_of("pulled", ("pull_off",), model=cases.NEAREST_JKR, deepest=DEEPEST, increment=INCREMENT)
    found = Found(near["pull_off"] / TENSION, 0.0)
    rows.append(pulled(row_name("nearest jkr", "", "pull_off"), found, 1.0, cases.STRONGER, "proportional to W"))
    for over in cases.DRAWN:
        overlap = round(over * LENGTH / INCREMENT) * INCREMENT
        exact = SPHERES.force_at(overlap) / TENSION
        found = Found(force_at(overlap, DEEPEST, cases.ADHESIVE["jkr"]) / TENSION, 0.0)
        rows.append(pulled(row_name("jkr", f"overlap {over:g}", "force"), found, exact, exact * (over > SOON[0])))
    return Findings(rows)


def wall(_: Bench) -> Findings:
    """A sphere on `fix wall/gran`, and the deck with both deviations."""
    modulus = 1.0 / (1.0 - 0.3**2)
    length = (math.pi * WORK_OF_ADHESION / (0.5 * modulus)) ** (2 / 3)
    deviations = variables_of("deviations", ("separation", "modulus"))
    moduli = (
        ("wall hertz/material", variables_of("wall", ("modulus",), increment=1e-5), 0.5 * modulus),
        ("nearest wall hertz/material", variables_of("wall", ("modulus",), model=cases.RIGID, increment=1e-5), modulus),
        ("deviations", deviations, 0.5 * modulus),
    )
    separations = (
        ("deviations", deviations, LENGTH),
        ("wall jkr", variables_of("wall", ("separation",), model=cases.ON_WALL, increment=INCREMENT), length),
    )
    rows = [
        compared(row_name(name, "", "E*"), Found(one["modulus"], 0.0), modulus, "E/(1 − ν²) of a rigid wall", law,
                 "it acts as a body of the sphere's own material, E* = E/(2(1 − ν²))")
        for name, one, law in moduli
    ] + [
        pulled(row_name(name, "", "separation"), Found(one["separation"] / unit, 0.0), LATE[0], SOON[0])
        for name, one, unit in separations
    ]  # fmt: skip
    return Findings(rows)


def impacts(bench: Bench) -> Findings:
    """Kelvin-Voigt bodies, and adhesive ones."""
    rows = list[Row]()
    for A in cases.NUMBERS:
        exact = kelvin_voigt(A)
        wanted = {"restitution": exact.restitution}
        if A in cases.TIMED:
            wanted |= {"contact_time": exact.contact_time, "peak_force": exact.peak_force}
        known = {name: solver(value, GRAINS) for name, value in wanted.items()}
        rows += _impacts(bench, at_number(A), 1.0, FINE | {"viscoelasticity": {"retardation_time": A}}, known)
    for over in cases.OVER_STICKING:
        known = {"restitution": Reference(math.sqrt(1.0 - over**-2) if over > 1.0 else 0.0, "e² = 1 − (v_s/v)²")}
        adheres = COARSE | {"bodies": COARSE["bodies"] | LONG, "adhesion": {"work_of_adhesion": WORK}}
        rows += _impacts(bench, at_velocity(over), over * STICKING, adheres, known)
    return Findings(rows)


def _impacts(
    bench: Bench, at: str, velocity: float, tables: Mapping[str, Any], known: Mapping[str, Reference]
) -> Iterator[Row]:
    experiment = {"kind": "impact", "velocity": velocity}
    run = bench.run(at.replace(" ", ""), {**tables, "plate": {"mass": MASS}, "experiment": experiment})
    bound = claim(said("what the run states", run))
    for name, exact in known.items():
        one = NOTHING if isinstance(run, Refused) else result(run, name)
        unit = MASS if name == "peak_force" else 1.0  # a force is in units of m v/T
        yield Row(row_name(OURS, at, name), one.value / unit, exact, bound, one.uncertainty / unit)


STUDIES = (
    Study("elastic", "Elastic spheres", "`hertz` without damping", elastic),
    Study("damped", "Kelvin-Voigt bodies", "`damping viscoelastic` with η = 2 E* τ/m", damped),
    Study("asked", "A given restitution", "`coeff_restitution` and `tsuji`", asked),
    Study("decade", "The nearest coefficients", "a body at velocities over a decade", decade),
    Study("adhesive", "Adhesive impact", "`jkr` and `dmt` without damping", adhesive),
    Study("drawn", "Drawn apart", "`jkr` and `dmt` by displacement", drawn),
    Study("wall", "A wall", "`fix wall/gran granular`", wall),
    Study("impacts", "The program's own impacts", "Kelvin-Voigt bodies, and adhesive ones", impacts),
)
