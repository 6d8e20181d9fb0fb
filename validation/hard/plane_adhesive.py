"""Random adhesive contacts on the rigid plane, of any profile, beside the MDR by quadrature of the profile's slope.

From d(a) and F(a) of `references.mdr` follow the states under a load or a tension, the pull-off force, the pressure
p(0), and what a closed path dissipates at its two instabilities, the snap-in at d = 0 and the separation under fixed
grips: with E(a) = U_el − πa²W

    ∮ F dd = E(a_fg) − E(a_in),    d(a_in) = 0,    dd/da = 0 at a_fg

An error is to be within its uncertainty, and one beyond the tolerance is to be named by a warning.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable
from itertools import product
from typing import Any

import numpy as np

from validation.hard.claims import INSIDE, Tally
from validation.references.mdr import ReducedContact, with_zero_load_radius
from validation.row import Row, at_most
from validation.study import Bench, Findings, Study, claim_row

NAME = "plane_adhesive"
SEED, QUICK, FULL = 31, 80, 400
REFERENCE = 1e-8
"""Relative error of the quadratures, and of radii at which a derivative is 0."""
OF_A_NAME, FARTHEST = 0.9, 3.0
"""Share of the numbers of one name that is to be inside, and the largest error over the uncertainty."""
PROFILES = ("parabola", "circle", "cone", "power", "ellipsoid")
KINDS = ("load", "tension", "pull_off", "path")
NARROW, WIDE, AUTOMATIC = 5.0, 60.0, 0.2
"""Particles in a₀, and the share of scenes whose spacing is the program's choice."""
MATERIAL = {"contact_modulus": 1e9, "length_unit": 1e-6, "force_unit": 1e-3}
"""E* = 1 FU/LU²."""
SEPARATED, RETURNING, UNPRESSED = 0.8, 0.6, 0.1
"""Shares of the paths that pass separation, that return, and that are not compressed beyond F = 0."""
PRELOADS, TOLERANCES = (1.0, 10.0, 1e3, 1e5, 1e6), (1e-2, 1e-3, 1e-4, 1e-5)
FLATTEST, PARTICLES = 1.58e-3, 20.0
"""a₀/R of a sphere with W = 2.8e-10 E*R, whose a/R stays below 0.1; particles in a₀ under these preloads."""
SOURCE = "the MDR by quadrature"
Slope = Callable[[float], float]
Scene = dict[str, Any]


def body(kind: str, radius: float, slope: float, exponent: float = 3.0, height: float = 1.0) -> tuple[Scene, Slope]:
    """A profile with about that slope at `radius` a₀ [LU], and f′(r); an ellipsoid's height is over its width."""
    end = radius / slope
    match kind:
        case "circle" | "ellipsoid":
            more, ratio = ({"height": height * end}, height) if kind == "ellipsoid" else ({}, 1.0)
            return {"kind": kind, "radius": end} | more, lambda r: ratio * r / math.sqrt((end - r) * (end + r))
        case "cone":
            return {"kind": kind, "slope": slope}, lambda _: slope
        case "parabola":
            return {"kind": kind, "radius": end}, lambda r: r / end
    table = {"kind": kind, "exponent": exponent, "radius": radius, "height": slope * radius / exponent}
    return table, lambda r: slope * (r / radius) ** (exponent - 1.0)


def on_plane(profile: Scene, contact: ReducedContact, spacing: float | None, tolerance: float) -> Scene:
    """The scene without its experiment; the spacing [LU] is the program's where there is none."""
    given = {"spacing": "auto"} if spacing is None else {"spacing": spacing, "bulk_stiffness": spacing}
    bodies = {"particles": "auto", "reduction": "mdr", "lower": "rigid_plane", "profile": profile} | given
    tables = {"bodies": bodies, "accuracy": {"tolerance": tolerance}}
    tables |= {"material": MATERIAL} if spacing is None else {}
    return tables | {"adhesion": {"work_of_adhesion": contact.work_of_adhesion}}


def drawn(rng: np.random.Generator) -> tuple[str, Scene, dict[str, float]]:
    """Its kind, the scene, and its numbers."""
    kind, shape = str(rng.choice(KINDS)), str(rng.choice(PROFILES))
    radius, slope = (float(10.0 ** rng.uniform(*ends)) for ends in ((0.0, 2.0), (-4.0, -2.0)))
    profile, steepness = body(shape, radius, slope, rng.uniform(1.05, 4.0), float(10.0 ** rng.uniform(-0.5, 0.5)))
    contact = with_zero_load_radius(steepness, 1.0, radius)
    fixed = rng.random() >= AUTOMATIC
    spacing = radius / math.exp(rng.uniform(math.log(NARROW), math.log(WIDE)))
    scene = on_plane(profile, contact, spacing if fixed else None, float(10.0 ** rng.uniform(-4.0, -2.0)))
    marks = {
        "adhesion_force": contact.pull_off_force(),
        "critical_radius": contact.critical_radius(),
        "zero_load_radius": radius,
    }
    unit = marks["adhesion_force"]
    if kind == "path":
        experiment, exact = _path(rng, contact, unit)
        exact = marks | exact
    elif kind == "pull_off":
        experiment, exact = {"kind": kind, "preload": unit * float(10.0 ** rng.uniform(-1.0, 4.0))}, marks
    else:
        force = unit * float(10.0 ** rng.uniform(-2.0, 2.0) if kind == "load" else -rng.uniform(0.1, 0.95))
        radius = contact.radius_under(force)
        experiment = {"kind": "load", "force": force}
        exact = {"displacement": contact.displacement(radius), "contact_radius": radius}
    if kind != "path" and shape != "cone":
        exact = exact | {"central_pressure": contact.central_pressure(radius)}
    return kind, scene | {"experiment": experiment}, exact


def _path(rng: np.random.Generator, contact: ReducedContact, unit: float) -> tuple[Scene, dict[str, float]]:
    """From a compression mostly to beyond separation, or back; and its dissipated energy. `unit`: F_A [FU]."""
    load = 0.0 if rng.random() < UNPRESSED else unit * float(10.0 ** rng.uniform(-2.0, 2.0))
    deepest, rest = (contact.displacement(contact.radius_under(force)) for force in (load, 0.0))
    separation = contact.fixed_grips_radius()
    limit, separates = contact.displacement(separation), rng.random() < SEPARATED
    apart = limit * rng.uniform(1.05, 3.0) if separates else limit + rng.uniform(0.02, 1.0) * (rest - limit)
    returns, steps = rng.random() < RETURNING, round(math.exp(rng.uniform(math.log(10.0), math.log(400.0))))
    start, end = (apart, deepest) if returns else (deepest, apart)
    displacements = {"from": start, "to": end, "steps": steps, "return": bool(returns)}
    exact = {}
    if separates and returns:
        exact["dissipated_energy"] = _energy(contact, separation) - _energy(contact, contact.snap_in_radius())
    return {"kind": "path", "displacements": displacements}, exact


def _energy(contact: ReducedContact, radius: float) -> float:
    return contact.energy(radius) - math.pi * radius**2 * contact.work_of_adhesion


def measure(bench: Bench) -> Findings:
    """Rows of the random scenes, and of preloads up to a million F_A."""
    tally = Tally()
    for number in range(FULL if bench.full else QUICK):
        kind, scene, exact = drawn(np.random.default_rng((SEED, number)))
        run = bench.run(f"random_{number}", scene)
        tally.add(f"random_{number}", kind, run, reported(exact, run), REFERENCE)
    return Findings([*checks(tally), *_after_preloads(bench)], tally.drawn())


def reported(exact: dict[str, float], run: object) -> dict[str, float]:
    """The numbers, without p(0) where a run does not report it."""
    results = getattr(run, "results", exact)
    return {name: value for name, value in exact.items() if name in results or name != "central_pressure"}


def checks(tally: Tally) -> list[Row]:
    """Errors within uncertainties, by name too, and none far outside; errors beyond the tolerance named; refusals."""
    inside, _, refused = tally.checks(NAME, SOURCE)
    names = Counter(one.name for one in tally.errors)
    outside = Counter(one.name for one in tally.errors if not one.over_claim <= 1.0)
    shares = {name: outside[name] / count for name, count in sorted(names.items())}
    within = ", ".join(f"{name} {1.0 - share:.3g} of {names[name]}" for name, share in shares.items())
    off = [one for one in tally.errors if not one.over_tolerance <= 1.0]
    unnamed = Counter(one.name for one in off if not one.told)
    listed = ", ".join(f"{count} {name}" for name, count in unnamed.items()) or "–"
    farthest = max((one.over_claim for one in tally.errors), default=math.nan)
    words = f"share of {len(off)} numbers with errors beyond the tolerance that no warning names"
    return [
        inside,
        at_most("largest share outside of one name", max(shares.values()), 1.0 - OF_A_NAME, SOURCE, within),
        at_most("largest error over the uncertainty", farthest, FARTHEST, SOURCE),
        at_most(words, unnamed.total() / max(1, len(off)), 1.0 - INSIDE, SOURCE, listed),
        refused,
    ]


def _after_preloads(bench: Bench) -> list[Row]:
    """F_A and a₀ after every preload at every tolerance; the quick form takes a Latin square of the profiles."""
    rows = []
    for number, (preload, tolerance, kind) in enumerate(product(PRELOADS, TOLERANCES, PROFILES[:4])):
        if not bench.full and (number // 16 + number // 4 - number) % 4:
            continue
        profile, slope = body(kind, 1.0, FLATTEST)
        contact = with_zero_load_radius(slope, 1.0, 1.0)
        exact = {"adhesion_force": contact.pull_off_force(), "zero_load_radius": 1.0}
        experiment = {"kind": "pull_off", "preload": preload * exact["adhesion_force"]}
        scene = on_plane(profile, contact, 1.0 / PARTICLES, tolerance) | {"experiment": experiment}
        run = bench.run(f"{kind}_{preload:g}_{tolerance:g}", scene)
        words = f"off over its uncertainty, {kind} after {preload:g} F_A at a tolerance of {tolerance:g}"
        rows += [claim_row(f"{name} {words}", run, name, value, SOURCE, REFERENCE) for name, value in exact.items()]
    return rows


ADHESIVE = Study(
    NAME,
    "Random adhesive contacts on the rigid plane",
    "JKR is for a paraboloid and moderate preloads. Are results within their uncertainties for any profile, under "
    "tension, after a preload of a million times the pull-off force, and along paths with jumps?",
    measure,
)
