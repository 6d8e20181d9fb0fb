"""Section 2: the contact without adhesion, as Geike and Popov reduce it and as the MDR does, in SI beside Hertz.

    geike_popov   two equal spheres R:  U = (4√2 G/15(1−ν)) √(R d⁵)  (Eq. 1),  c_n = G/2(1−ν)  (Eq. 3)
    mdr           a sphere R on a half space, profile x²/R:  U = (8/15) E* √(R d⁵),  springs E*

Both from the sum over springs of LAMMPS runs on a rigid plane (`section2`).

U = Σ f²/2k, with the forces f of the particles. By Euler and Maclaurin a sum over springs h apart is off from the
integral by derivatives at the edge, times polynomials of the place of the edge between two particles. Of a parabola
    F: (3/2) B₂ (h/a)²,  |B₂| ≤ 1/6        U: (5/2) B₃ (h/a)³ + (15/8) B₄ (h/a)⁴,  |B₃| ≤ √3/36, |B₄| ≤ 1/30
and F of any profile g(x): h² B₂ c [g′(a) + g′(0)], with the layer's stiffness c = F′(a)/2a g′(a).
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.doors import Reduction, Run, Scene, read_scene
from validation.figures import Values
from validation.references import hertz
from validation.references.mdr import ReducedContact
from validation.references.numerics import Function, Pair
from validation.row import Known, Reference, Row, claim, printed, relative, tables_beside
from validation.study import Bench, Findings, Lines, Rows, Scenes, Study, found

MODULUS = 210e9
"""Young's modulus of both bodies [Pa]."""
LENGTH_UNIT, FORCE_UNIT = 1e-9, 1e-6
BASE, SWEEPS, WORDS = (tables_beside(__file__)[name] for name in ("base", "sweeps", "words"))
EDGE, RATE_SPACINGS = 32.0, (8.0, 4.0, 2.0, 1.0)
"""Half-width of the contact [LU] in the runs that measure the rate, a whole number of each spacing in them [LU]."""
RATE_TOLERANCE, SPARE = 1e-7, 4
"""Of those runs, so that what the minimiser leaves is below the fourth power of the spacing; particles beyond."""
REDUCTIONS: tuple[Reduction, ...] = ("geike_popov", "mdr")
FACTORS: dict[Reduction, float] = {"geike_popov": 2.0, "mdr": 1.0}
"""R of a sphere over the effective one, a of the springs over Hertz's, and a² over R d."""
SLOPE, EXPONENT, PUNCH, DEPTH = 0.05, 4.0, 20.0, 3.0
"""Of the other shapes; lengths in LU."""


def reduction_scene(reduction: Reduction, d: float, R: float, nu: float, h: float, tolerance: float = 1e-3) -> Scene:
    """A sphere of two equal materials pressed by d [LU]; R the sphere's radius, h the spacing [LU]."""
    title, path = f"{reduction}: d = {d:g}, R = {R:g}, nu = {nu:g}, h = {h:g}", {"kind": "path", "displacements": [d]}
    materials = ((MODULUS, nu), (MODULUS, nu))
    return pressed(title, reduction, R, materials, path, {"spacing": h}, accuracy={"tolerance": tolerance})


def pressed(
    title: str,
    reduction: Reduction,
    R: float,
    materials: Iterable[Pair],
    experiment: Any,
    bodies: Any,
    **more: Any,
) -> Scene:
    """A sphere R [LU] of two materials, E [Pa] and ν, on a plane; `bodies` beside what all have, `more` tables."""
    upper, lower = ({"youngs_modulus": E, "poisson_ratio": nu} for E, nu in materials)
    own = {
        "particles": "auto", "profile": {"kind": "parabola", "radius": R}, "reduction": reduction,
        "bulk_stiffness": "auto", "lower": "rigid_plane",
    }  # fmt: skip
    material = {"upper": upper, "lower": lower, "length_unit": LENGTH_UNIT, "force_unit": FORCE_UNIT}
    return read_scene({"title": title, "bodies": own | bodies, "material": material, "experiment": experiment, **more})


def shape_scene(kind: str, reduction: Reduction = "mdr") -> Scene:
    """One of the profile kinds, pressed into a plane."""
    profiles = {
        "circle": {"kind": "circle", "radius": 200.0},
        "cone": {"kind": "cone", "slope": SLOPE},
        "flat_punch": {"kind": "flat_punch", "radius": PUNCH},
        "power": {"kind": "power", "exponent": EXPONENT, "radius": 40.0, "height": 2.0},
        "table": {"kind": "table", "r": [float(r) for r in range(81)], "z": [2.0 * (r / 40.0) ** 4 for r in range(81)]},
    }
    sphere = reduction_scene(reduction, DEPTH, 1.0, BASE["nu"], BASE["h"])
    base = sphere.model_dump(by_alias=True, exclude_none=True)
    base["title"] = f"{reduction}: {kind}"
    base["bodies"]["profile"] = profiles[kind]
    if reduction == "geike_popov":  # refused with a material: a shape as drawn is no body's
        del base["material"]
        base["bodies"]["bulk_stiffness"] = sphere.bulk_stiffness
    return read_scene(base)


SHAPES = ("circle", "cone", "flat_punch", "power", "table")


@dataclass(frozen=True)
class Case:
    """One run of a sweep: name of the run, reduction, and its values."""

    name: str
    reduction: Reduction
    values: dict[str, float]
    tolerance: float = 1e-3
    particles: int | None = None

    def scene(self) -> Scene:
        """What is run."""
        scene = reduction_scene(self.reduction, **self.values, tolerance=self.tolerance)
        return scene if self.particles is None else scene.with_({"bodies.particles": self.particles})

    @property
    def force(self) -> float:
        """F in 3D [N]."""
        R, modulus = self.sphere()
        return float(hertz.hertz_force(self.values["d"] * LENGTH_UNIT, R, modulus))

    @property
    def energy(self) -> float:
        """U in 3D [J]: Eq. (1) for two equal spheres, (8/15) E* √(R d⁵) with the effective R and E*."""
        R, modulus = self.sphere()
        return 8.0 / 15.0 * modulus * math.sqrt(R * (self.values["d"] * LENGTH_UNIT) ** 5)

    @property
    def half_width(self) -> float:
        """a of the springs [LU]: √(2Rd) as drawn, √(Rd) transformed."""
        return math.sqrt(FACTORS[self.reduction] * self.values["R"] * self.values["d"])

    def off(self, what: str) -> float:
        """Most by which the lattice lets "force" or "energy" be off, relative."""
        fineness = self.values["h"] / self.half_width
        if what == "force":
            return 0.25 * fineness**2
        return 2.5 * math.sqrt(3.0) / 36.0 * fineness**3 + fineness**4 / 16.0

    def sphere(self) -> Pair:
        """Effective radius [m] and contact modulus [Pa]: R/2 and G/(1 − ν) for two equal spheres."""
        radius = self.values["R"] * LENGTH_UNIT / FACTORS[self.reduction]
        return radius, MODULUS / (2.0 * (1.0 - self.values["nu"] ** 2))


def sweep(reduction: Reduction, name: str) -> list[Case]:
    """The runs in which one value changes."""
    cases = [BASE | {name: value} for value in SWEEPS[name]]
    return [Case(f"eq3_{reduction}_{_label(values)}", reduction, values) for values in cases]


def rate_cases(reduction: Reduction) -> list[Case]:
    """Runs of falling spacing whose contact ends midway between two of these very particles, at the half-width EDGE."""
    depth = EDGE**2 / BASE["R"] / FACTORS[reduction]
    return [
        Case(f"eq3_{reduction}_rate_{_label(v)}", reduction, v, RATE_TOLERANCE, 2 * round(EDGE / v["h"]) + SPARE)
        for v in [BASE | {"d": depth, "h": h} for h in RATE_SPACINGS]
    ]


def _label(values: dict[str, float]) -> str:
    return "_".join(f"{name}{value:g}" for name, value in values.items())


def scenes(_: Scene) -> Scenes:
    """All runs."""
    shapes = {f"eq3_shape_{kind}": shape_scene(kind) for kind in SHAPES}
    drawn = {"eq3_shape_cone_as_drawn": shape_scene("cone", "geike_popov")}
    swept = [case for reduction in REDUCTIONS for name in SWEEPS for case in sweep(reduction, name)]
    rates = [case for reduction in REDUCTIONS for case in rate_cases(reduction)]
    return {case.name: case.scene() for case in swept + rates} | shapes | drawn


def ratio(case: Case, run: Run, what: str) -> Pair:
    """The run's "force" or "energy" over the sphere's, and its claim."""
    force = run.document["largest_force"]["si"]
    claim = float(force["uncertainty"] / force["value"])
    if what == "force":
        return float(force["value"]) / case.force, claim
    return energy(case, run) / case.energy, 2.0 * claim


def energy(case: Case, run: Run) -> float:
    """U = Σ f²/2k [J]."""
    scene = case.scene()
    forces = run.profiles["deepest"].pressure * scene.bodies.spacing
    return float(np.sum(forces**2)) / (2.0 * scene.bulk_stiffness) * LENGTH_UNIT * FORCE_UNIT


LATTICE = "lattice: the edge lies anywhere between two particles; the run's claim"
BY_CHANCE = "the bound is that of the worst place of the edge between two particles, and here it lies well"
LEVEL = "tip and edge lie alike between particles, so that their errors cancel"
TABLE_STEP = 1.0
"""Of the tabulated shape c r⁴ [LU]: the slopes of monotone cubics are off by 5 c r step², heights by 0.1 step of it."""
NAMED = {"reduction": "the row is about the reduction itself, and names it"}
"""Why a row stands beside the warning of a run that chose the paper's reduction."""
STEEP = {"slope": "the reference is the same theory of the half-space"}
"""Why a row stands beside the warning of a steep profile."""
POINTS = {
    "tolerance": "it names pressures, which 81 points leave open; the row is of force and radius, and within its own"
}
"""Why a row of a table stands beside the warning of its pressures."""
EXACT = "the claim is for any profile; between particles a parabola, a power or an even end is met exactly"


def judge(bench: Bench) -> Findings:
    """Every sweep by its worst run, the rates, half-widths, the factor of Eq. (2), and the other shapes."""
    row = Rows(bench.runs, NAMED)
    rows = [check for reduction in REDUCTIONS for name in SWEEPS for check in _sweep_checks(row, reduction, name)]
    for reduction in REDUCTIONS:
        rows += [*_rate_checks(row, reduction), _width_check(row, reduction)]
    rows += [*_factor_checks(row), *(check for kind in SHAPES for check in _shape_checks(row, kind)), _drawn_cone(row)]
    finding = (
        "Force and energy of both reductions are Hertz's over two decades of displacement and radius, and converge "
        "with the second and the fourth power of the spacing. With the 2√2/15 that Eq. (2) has as printed the "
        "stiffness of Eq. (3) would not follow; 8√2/15 is what it needs.\n\nThe reduction of the paper has twice the "
        "contact radius of the two spheres, that of the MDR has it. The former holds for a parabola: a cone taken as "
        "it is drawn has π/2 times its force. The transform of the MDR has force, displacement and radius of other "
        "shapes. All this is without adhesion; with it see `jkr_plane`."
    )
    return Findings(rows, text=finding)


def _sweep_checks(row: Rows, reduction: Reduction, name: str) -> Lines:
    """Of the runs in which one value changes the one that is farthest off for what its lattice allows."""
    cases = sweep(reduction, name)
    for what, source in (("force", "F = dU/dd"), ("energy", "Eq. (1)")):
        each = [(*ratio(case, row.runs[case.name], what), case.off(what)) for case in cases]
        value, claim, bound = max(each, key=lambda one: abs(one[0] - 1.0) / (one[1] + one[2]))
        yield row(f"{what} over Hertz's, worst of {len(cases)} for its lattice: {WORDS[name]} ({reduction})", value,
                  Reference(1.0, f"Hertz in SI, {source}"), relative(bound + claim, LATTICE), uncertainty=claim,
                  on=[case.name for case in cases], wide=BY_CHANCE,
                  standing="repeats" if name == "R" else "judged")  # fmt: skip


def _rate_checks(row: Rows, reduction: Reduction) -> Lines:
    """Fitted orders; their uncertainty is that of the fit and of the runs, δp = Σ |c_i| claim_i/error_i."""
    cases = rate_cases(reduction)
    for what, order, first in (("force", 2.0, "first"), ("energy", 4.0, "third")):
        values, claims = np.array([ratio(case, row.runs[case.name], what) for case in cases]).T
        errors = np.abs(values - 1.0)
        slope, error, spread = fitted_order([case.values["h"] for case in cases], errors, claims / errors)
        yield row(
            f"order of convergence of the {what} in the spacing ({reduction})",
            slope,
            Reference(
                order, f"Euler and Maclaurin: the first derivative at the edge that does not vanish is the {first}"
            ),
            claim("residual forces of the minimisation: the series of a parabola ends here"),
            uncertainty=error + spread,
            on=[case.name for case in cases],
            wide="the claim takes each run at its worst, and a sum over springs in place leaves round-off",
        )


def fitted_order(places: Sequence[float], values: Values, claims: Values = ()) -> tuple[float, float, float]:
    """Slope p of ln value over ln place, its standard error, and δp = Σ |c_i| claim_i of relative claims."""
    x = np.log(places)
    fitted, covariance = np.polyfit(x, np.log(values), 1, cov=True)
    weights = np.abs(x - x.mean()) / np.sum((x - x.mean()) ** 2)
    return float(fitted[0]), float(np.sqrt(covariance[0, 0])), float(weights[: len(claims)] @ claims)


def _width_check(row: Rows, reduction: Reduction) -> Row:
    case = rate_cases(reduction)[-1]
    R, _ = case.sphere()
    twice = reduction == "geike_popov"
    radius = row.runs[case.name].document["image_largest_radius" if twice else "largest_radius"]["si"]
    hertzian = float(hertz.hertz_contact_radius(case.values["d"] * LENGTH_UNIT, R))
    return row(
        f"half-width over Hertz's contact radius ({reduction})",
        radius["value"] / hertzian,
        Reference(
            FACTORS[reduction],
            "closed form of the springs, √(2Rd) beside √(Rd/2)" if twice else "the MDR's transform keeps the radius",
        ),
        claim("round-off, residual forces"),
        uncertainty=radius["uncertainty"] / hertzian,
        on=case.name,
        wide=EXACT,
    )


def _factor_checks(row: Rows) -> list[Row]:
    """The factor of Eq. (2), beside the integral and beside the print."""
    case = sweep("geike_popov", "h")[-1]
    scene, run = case.scene(), row.runs[case.name]
    layer = scene.bulk_stiffness / scene.bodies.spacing * FORCE_UNIT / LENGTH_UNIT**2
    scale = layer * math.sqrt(case.values["R"] * LENGTH_UNIT * (case.values["d"] * LENGTH_UNIT) ** 5)
    value, stated = energy(case, run) / scale, ratio(case, run, "energy")[1]
    off, misprint = case.off("energy") + stated, 2.0 * math.sqrt(2.0) / 15.0
    name = "factor in U = factor · c_n √(R d^5), Eq. (2)"
    right, wrong = (
        Reference(4.0 * misprint, "integral over the springs, 8√2/15"),
        printed(misprint, "Eq. (2) of the paper, 2√2/15: a misprint"),
    )
    more: dict[str, Any] = {"uncertainty": value * stated, "on": [case.name]}
    known = Known(right.value, off * right.value, "8√2/15, what Eq. (3) needs")
    return [
        row(name, value, right, relative(off, LATTICE), standing="repeats", wide=BY_CHANCE, **more),
        row(f"{name}, as printed", value, wrong, relative(off, LATTICE), known=known, **more),
    ]


SLOPES: dict[str, Function] = {
    "circle": lambda r: r / math.sqrt(200.0**2 - r**2),
    "cone": lambda r: SLOPE,
    "power": lambda r: 2.0 * EXPONENT / 40.0 * (r / 40.0) ** (EXPONENT - 1.0),
}
SLOPES["table"] = SLOPES["power"]
"""f′(r) of the shapes, which the method of dimensionality reduction integrates."""


def _shape_checks(row: Rows, kind: str) -> list[Row]:
    """Force and radius of a shape beside Sneddon or Galin, in model units."""
    scene, name = shape_scene(kind), f"eq3_shape_{kind}"
    run, h = row.runs[name], scene.bodies.spacing
    modulus = scene.bulk_stiffness / h
    if kind == "flat_punch":
        force, radius, lattice = 2.0 * modulus * PUNCH * DEPTH, PUNCH, 0.0
    else:
        indenter = ReducedContact(SLOPES[kind], modulus)
        radius = indenter.contact_radius(DEPTH)
        force = indenter.force(radius)
        step = 1e-4 * radius
        slope = (indenter.force(radius + step) - indenter.force(radius - step)) / (2.0 * step)
        edges = 2.0 if kind == "cone" else 1.0  # its tip is as much of an edge
        lattice = edges * h**2 / 6.0 * slope / (2.0 * radius) / force
    source = "Galin, r^4" if kind in ("power", "table") else "Sneddon"
    words = {"table": "table of 81 points of r^4", "power": "power r^4"}.get(kind, kind.replace("_", " "))
    between = 0.5 * 2.0 / 40.0**EXPONENT * radius * TABLE_STEP**3 / DEPTH if kind == "table" else 0.0
    limit = f"points of the table, 1 LU apart; {LATTICE}" if kind == "table" else LATTICE
    ours, width = found(run, "largest_force"), found(run, "largest_radius")
    answers = STEEP | POINTS if kind == "table" else STEEP
    return [
        row(f"force of a {words} (mdr)", ours, Reference(force, source),
            relative(lattice + between + ours.uncertainty / ours.value, limit),
            on=name, despite=answers, wide=BY_CHANCE),
        row(f"contact radius of a {words} (mdr)", width, Reference(radius, source), claim(limit), on=name,
            despite=answers, wide=EXACT, standing="by construction" if kind == "flat_punch" else "judged"),
    ]  # fmt: skip


def _drawn_cone(row: Rows) -> Row:
    """Two equal cones as drawn, F = (E*/2) d²/s, over Sneddon's E* d²/πs for both together (slope 2s)."""
    name, scene = "eq3_shape_cone_as_drawn", shape_scene("cone", "geike_popov")
    modulus, slope = 2.0 * scene.bulk_stiffness / scene.bodies.spacing, 2.0 * SLOPE
    expected = 2.0 * modulus * DEPTH**2 / (math.pi * slope)
    ours = found(row.runs[name], "largest_force")
    return row("force of two equal cones as drawn over Sneddon's (geike_popov)", ours.value / expected,
               Reference(0.5 * math.pi, "closed form of the springs: the reduction as drawn is for parabolas only"),
               relative((BASE["h"] * SLOPE / DEPTH) ** 2 / 3.0 + ours.uncertainty / ours.value, LATTICE),
               uncertainty=ours.uncertainty / expected, on=name, wide=LEVEL)  # fmt: skip


STUDY_EQ3 = Study(
    "eq3",
    "Section 2: normal contact without adhesion",
    "The elastic energy of two spheres, Eq. (1), is that of a curved layer of independent springs, Eq. (2), if the "
    "layer's stiffness per length is c_n = G/2(1 − ν), Eq. (3): both contacts then have the same force at every "
    "displacement.",
    judge,
    scenes,
)
