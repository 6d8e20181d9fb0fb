"""What LAMMPS's granular models get wrong of two spheres that meet, or are drawn apart; the program's own."""

import math
from collections.abc import Iterator, Mapping
from itertools import product
from typing import Any

from validation.doors import Impact, on_plane
from validation.grains import cases
from validation.grains.cases import (
    GIVEN,
    OURS,
    SPHERES,
    WORK_OF_ADHESION,
    at_number,
    at_psi,
    at_step,
    at_velocity,
    row_name,
)
from validation.grains.granular import INCREMENT, SLOW_STEP, Found, force_at, impact, measured, refined
from validation.references import zunker_kamrin as rule
from validation.references.grains import coeff_restitution, kelvin_voigt, mindlin, restoring
from validation.references.impact import elastic as hertz
from validation.references.oblique import of_power
from validation.references.relaxing import sphere
from validation.row import Known, Reference, Row, absolute, claim, relative, solver
from validation.study import NOTHING, Bench, Lines, Refused, Study, said
from validation.study import found as result

AGREES = 1e-4
"""A model is right within it, relative, and what it gets wrong is its own law's within it, of the order of 1."""
ABOUT = 1e-3
"""The same of what is drawn apart or hit obliquely, absolute."""
GRAINS = "Kelvin-Voigt body, its motion integrated"
JOHNSON = "Johnson, Kendall and Roberts (1971)"
EARLY = "it separates at the pull-off force"
DASHPOT = "F = k d^1.5 + η m √(R d) d′"
REBOUND = "e² = 1 − (v_s/v)²"
RULE = "tension begins where the contact radius falls by more than 1 % in one step"
JAEGER = "superposition of normal contacts (Jäger, Ciavarella), integrated"
HERTZ, SLIDES = "Hertz (1881)", "sliding throughout, an impulse of µ (1 + e) m v"
TRUNCATED = "one spring for the whole contact, cut off at µ |F_n|, also where F_n is tensile"
DEEPEST, PRESSED = 0.02, 0.05
"""To which spheres are pressed, over R; of `mdr`, so deep that the contact recedes before the overlap is 0."""
SOME = 1.5
"""v/v_s of an impact of `mdr`."""
KAPPA, FRICTION, GENTLE, GENTLE_STEP = 2.0 * (1.0 - 0.3) / (2.0 - 0.3), 0.3, 1e-6, 1e-3
"""G*/E*, µ, and a velocity at which the overlap is small beside R, with its timestep."""
MANY = 16_000
"""Steps of a reference that is nearer than the program's own uncertainty."""
SLIPS = "tangential_velocity"
"""Of the program's oblique impacts."""
CHI = 1.75 * KAPPA
"""Of solid spheres."""
PART, TURNED = 20_000, 0.03
"""Timesteps of a contact in the tests of Chung and Ooi; what the law of `turned` is off where F_n becomes tensile."""
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
BALL = {"mass": MASS, "lever_arm": RADIUS, "moment_of_inertia": 0.4 * MASS * RADIUS**2}
"""A solid sphere."""
SLOWEST = SPHERES.sticking_velocity(1.0)
STICKING = math.sqrt((WORK / WORK_OF_ADHESION) ** (5 / 3) * RADIUS ** (4 / 3) / MASS) * SLOWEST
"""v_s [LU/TU]: ½ m v_s² is as (W⁵R⁴/E*²)^(1/3)."""


def compared(name: str, found: Found, exact: float, source: str, law: float | None = None, states: str = EARLY,
             about: float = 0.0) -> Row:  # fmt: skip
    """A row of what LAMMPS gives, what is exact, and what the model states, which it gives where it differs.

    Within `about`, absolute, where displacements are prescribed or the normal turns in an impact.
    """
    bound = absolute(about, "timestep, size of the overlap") if about else relative(AGREES, "timestep")
    differs = law is not None and abs(law - exact) > (about or AGREES * abs(exact))
    known = Known(law or 0.0, about or AGREES, states) if differs else None
    reference = (solver if source in (GRAINS, JAEGER) else Reference)(exact, source)
    return Row(name, found.value, reference, bound, found.change, runs=(found.run,), known=known)


def elastic(_: Bench) -> Lines:
    """No damping, no adhesion."""
    for model, words in GIVEN.elastic.items():
        for name, found in impact(words).items():
            yield compared(row_name(model, "", name), found, getattr(kelvin_voigt(0.0), name), HERTZ)


def damped(_: Bench) -> Lines:
    """Kelvin-Voigt bodies, with the coefficient that makes the force of loading exact."""
    for A, model in product(GIVEN.numbers, cases.DAMPED):
        exact, law, found = kelvin_voigt(A), model.law(2.0 * A), impact(model.words.format(round(2.0 * A, 6)))
        for name in wanted(A):
            at = row_name(model.name, at_number(A), name)
            yield compared(at, found[name], getattr(exact, name), GRAINS, getattr(law, name), DASHPOT)


def wanted(A: float) -> tuple[str, ...]:
    """What is compared of a Kelvin-Voigt body."""
    return ("restitution", "contact_time", "peak_force") if A in GIVEN.timed else ("restitution",)


def asked(_: Bench) -> Lines:
    """Models that are given the coefficient of restitution."""
    for model, e in product(cases.BY_RESTITUTION, GIVEN.asked):
        name = row_name(model.name, f"e = {e:g}", "restitution")
        found, law = impact(model.words.format(e))["restitution"], model.law(e).restitution
        yield compared(name, found, e, "what the model is given", law, "F = k d^1.5 + α √(m k) d^¼ d′")


def decade(_: Bench) -> Lines:
    """One body at velocities over a decade, with the coefficient that is nearest."""
    for model, (place, A), v in product(cases.FITTED, enumerate(GIVEN.timed), cases.DECADE):
        given, rate = cases.coefficient(model, place), 1.0 if model is cases.RESTITUTION else v**0.2
        found, law = impact(model.words.format(given), v)["restitution"], model.law(given * rate).restitution
        exact, name = kelvin_voigt(A * v**0.2).restitution, cases.near_name(model, A, v)
        yield compared(name, found, exact, GRAINS, law, "its own law")


def adhesive(_: Bench) -> Lines:
    """Elastic spheres that adhere."""
    later = math.sqrt(SOON[1] / LATE[1])
    for over in GIVEN.over:
        models = GIVEN.adhesive | ({"nearest jkr": cases.NEAREST_JKR} if over > 1.0 else {})
        found = {name: impact(words, over * SLOWEST, SLOW_STEP)["restitution"] for name, words in models.items()}
        exact = rebounds(over)
        laws = {"jkr": math.sqrt(1.0 - (later / over) ** 2), "dmt": 1.0, "nearest jkr": exact}
        for name, one in found.items():
            true = (1.0, "DMT has no hysteresis") if name == "dmt" else (exact, REBOUND)
            yield compared(row_name(name, at_velocity(over), "restitution"), one, *true, laws[name])
        if over == cases.MEASURED:
            e = found["jkr"]
            speed = Found(over * math.sqrt(1.0 - e.value**2), e.change / over, e.run)
            yield compared(row_name("jkr", "", "sticking velocity"), speed, 1.0, JOHNSON, later)


def rebounds(over: float) -> float:
    """e of JKR at a velocity over that of sticking; 0 where the spheres stick."""
    return math.sqrt(1.0 - over**-2) if over > 1.0 else 0.0


def drawn(_: Bench) -> Lines:
    """Spheres that are pressed together and drawn apart by displacement."""
    units = {"pull_off": TENSION, "separation": LENGTH, "dissipated": ENERGY}
    answers = {"jkr": ((1.0, *LATE), (1.0, *SOON)), "dmt": ((4.0 / 3.0, 0.0, 0.0), (4.0 / 3.0, 0.0, 0.0))}
    for model, words in GIVEN.adhesive.items():
        found = refined("pulled", tuple(units), INCREMENT, model=words, deepest=DEEPEST)
        for (name, unit), exact, law in zip(units.items(), *answers[model], strict=True):
            yield pulled(row_name(model, "", name), found[name].over(unit), exact, law)
    near = measured("pulled", ("pull_off",), model=cases.NEAREST_JKR, deepest=DEEPEST, dt=INCREMENT)["pull_off"]
    yield pulled(row_name("nearest jkr", "", "pull_off"), near.over(TENSION), 1.0, cases.STRONGER)
    for over in GIVEN.drawn:
        overlap = round(over * LENGTH / INCREMENT) * INCREMENT
        exact = SPHERES.force_at(overlap) / TENSION
        force = force_at(overlap, DEEPEST, GIVEN.adhesive["jkr"]).over(TENSION)
        yield pulled(row_name("jkr", f"overlap {over:g}", "force"), force, exact, exact * (over > SOON[0]))


def pulled(name: str, found: Found, exact: float, law: float) -> Row:
    """A row of what is drawn apart."""
    return compared(name, found, exact, JOHNSON, law, about=ABOUT)


def wall(_: Bench) -> Lines:
    """A sphere on `fix wall/gran`, and the deck with both deviations."""
    modulus = 1.0 / (1.0 - 0.3**2)
    length = (math.pi * WORK_OF_ADHESION / (0.5 * modulus)) ** (2 / 3)
    deviations = measured("deviations", ("separation", "modulus"))
    for name, one, law in (
        ("wall hertz/material", measured("wall", ("modulus",), dt=1e-5), 0.5 * modulus),
        ("nearest wall hertz/material", measured("wall", ("modulus",), model=GIVEN.rigid, dt=1e-5), modulus),
        ("deviations", deviations, 0.5 * modulus),
    ):
        rigid = modulus, "E/(1 − ν²) of a rigid wall"
        yield compared(row_name(name, "", "E*"), one["modulus"], *rigid, law,
                       "it acts as a body of the sphere's own material, E* = E/(2(1 − ν²))")  # fmt: skip
    adheres = measured("wall", ("separation",), model=GIVEN.on_wall, dt=INCREMENT)
    for name, one, unit in (("deviations", deviations, LENGTH), ("wall jkr", adheres, length)):
        yield pulled(row_name(name, "", "separation"), one["separation"].over(unit), LATE[0], SOON[0])


def mdr(_: Bench) -> Lines:
    """`mdr` by the step: drawn apart, in an impact, and in one without adhesion."""
    gamma, v = 0.5 * WORK_OF_ADHESION, SOME * SLOWEST
    words = GIVEN.mdr.format(gamma)
    for name, step in GIVEN.steps:
        balls = [rule.Adhering(2.0, 2.0, gamma, factor) for factor in (0.99, 1.0)]
        if name == "pull_off":
            found = measured("pulled", (name,), model=words, deepest=PRESSED, dt=step)[name].over(TENSION)
            exact, ends, (law, mended) = 1.0, 8.0 / 9.0, (rule.pull_off(one, PRESSED, step) / TENSION for one in balls)
        else:
            found, exact = measured("impact", (name,), model=words, v=v, dt=step)[name], rebounds(SOME)
            ends, (law, mended) = exact, (rule.restitution(one, 1.0, v, step) for one in balls)
        yield compared(row_name("mdr", at_step(step), name), found, exact, JOHNSON, law, RULE)
        at, limit = row_name("mdr, factor 1", at_step(step), name), relative(0.1, "it ends at overlap 0")
        yield Row(at, mended, Reference(ends, "JKR, drawn apart to overlap 0" if ends < exact else JOHNSON), limit)
    for name, found in impact(GIVEN.mdr.format(0.0), v, SLOW_STEP).items():
        if name in ("restitution", "peak_force"):
            exact = getattr(hertz(sphere(1.0), 1.0, 1.0, v), name)
            yield compared(row_name("mdr, no adhesion", "", name), found, exact, HERTZ, about=ABOUT * exact)


def oblique_impacts(_: Bench) -> Lines:
    """Elastic spheres that slip on each other, by psi."""
    for psi, model in product(GIVEN.psi, GIVEN.tangential):
        vs, words = psi * FRICTION / KAPPA * GENTLE, f"{model} NULL 0 {FRICTION}"
        found = refined("impact", ("slip",), GENTLE_STEP, model=GIVEN.elastic["hertz/material"], v=GENTLE, vs=vs,
                        apart=GENTLE, tangential=words)["slip"].over(vs)  # fmt: skip
        law = mindlin(psi, CHI, "force" in model, "rescale" in model)
        yield compared(row_name(model, at_psi(psi), "slip"), found, of_power(psi, CHI), JAEGER, law, TRUNCATED, ABOUT)


def chung_ooi(_: Bench) -> Lines:
    """Tests 1 to 8 of Chung and Ooi."""
    for test, body, at, ratio, R, v, vt, spin, mu, e in GIVEN.tests:
        E, nu, rho = GIVEN.bodies[body]
        mass, units = rho * 4.0 / 3.0 * math.pi * R**3, GIVEN.measured[test]
        pair = sphere(R * ratio / (1.0 + ratio) if ratio else R), E / (1.0 - nu**2) / (2.0 if ratio else 1.0)
        met = hertz(*pair, *((0.5 * mass, 2.0 * v) if ratio == 1 else (mass, v)))
        given = {"ratio": ratio, "R": R, "rho": rho, "E": E, "nu": nu, "v": v, "vt": vt, "spin": spin, "mu": mu, "e": e}
        for name, found in refined("chung_ooi", tuple(units), met.contact_time / PART, **given).items():
            where = row_name(f"test {test}, {body}", at, name)
            if name == "rotation":
                start, over = R * spin / (mu * v), found.over(mu * v / R)
                exact, law = turned(2.0 * (1.0 - nu) / (2.0 - nu), (vt + R * spin) / (mu * v), e)
                source, about = (JAEGER, 5.0 * ABOUT) if e == 1.0 else (SLIDES, TURNED)
                yield compared(where, over, start - exact, source, start - law, TRUNCATED, about)
            else:
                exact = e if name == "restitution" else getattr(met, name) / units[name]
                yield compared(where, found.over(units[name]), exact, HERTZ, about=ABOUT * exact)


def turned(kappa: float, angle: float, e: float) -> tuple[float, float]:
    """What friction takes of R omega/(mu v): exact, and of `mindlin_rescale/force` with `coeff_restitution`.

    Of a damped sphere that slides throughout 5/2 (1 + e), and in LAMMPS 5/2 (1 + 2 e_0 - e), with e_0 where F_n becomes
    tensile; of an elastic one by v_s'/v_s. angle: v_s/(mu v).
    """
    if e < 1.0:
        return 2.5 * (1.0 + e), 2.5 * (1.0 + 2.0 * restoring(coeff_restitution(e), True).restitution - e)
    psi, chi = kappa * angle, 1.75 * kappa
    exact, law = (5.0 / 7.0 * angle * (1.0 - end) for end in (of_power(psi, chi), mindlin(psi, chi, True, True)))
    return exact, law


def impacts(bench: Bench) -> Lines:
    """Kelvin-Voigt bodies, adhesive ones, and a solid sphere that slides, where the program has such impacts."""
    for A in GIVEN.numbers:
        known = {name: solver(getattr(kelvin_voigt(A), name), GRAINS) for name in wanted(A)}
        table = {"viscoelasticity": {"retardation_time": A}}
        yield from _impacts(bench, at_number(A), FINE | table, known, velocity=1.0)
    adheres = COARSE | {"bodies": COARSE["bodies"] | LONG, "adhesion": {"work_of_adhesion": WORK}}
    for over in GIVEN.over:
        known = {"restitution": Reference(rebounds(over), REBOUND)}
        yield from _impacts(bench, at_velocity(over), adheres, known, velocity=over * STICKING)
    along = {"bulk_stiffness_tangential": KAPPA * FINE["bodies"]["bulk_stiffness"]}
    slides = {"bodies": FINE["bodies"] | along, "friction": {"coefficient": FRICTION}, "plate": BALL}
    for psi in GIVEN.psi if SLIPS in Impact.model_fields else ():
        known = {"tangential_restitution": solver(-of_power(psi, CHI, steps=MANY), JAEGER)}
        given = {"velocity": 1.0, SLIPS: psi * FRICTION / KAPPA}
        yield from _impacts(bench, at_psi(psi), FINE | slides, known, **given)


def _impacts(
    bench: Bench, at: str, tables: Mapping[str, Any], known: Mapping[str, Reference], **given: float
) -> Iterator[Row]:
    scene = {"plate": {"mass": MASS}, **tables, "experiment": {"kind": "impact"} | given}
    run = bench.run(at.replace(" ", ""), scene)
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
    Study("mdr", "The adhesion of `mdr`", "`mdr` by the step of the overlap, and by the timestep", mdr),
    Study("oblique", "Oblique impact", "`mindlin` and its variants by the angle", oblique_impacts),
    Study("chung_ooi", "Tests 1 to 8 of Chung and Ooi", "spheres on a plane, on a twin, on a heavy sphere", chung_ooi),
    Study("impacts", "The program's own impacts", "Kelvin-Voigt bodies, and adhesive ones", impacts),
)
