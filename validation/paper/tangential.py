"""The tangential contact: a body pressed on a rigid plane and drawn along it, beside Cattaneo and Mindlin.

    F_x = μN [1 − (1 − u/u*)^{3/2}],    c/a = √(1 − u/u*),    u* = μ (E*/G*) d

G*/E* is 2(1 − ν)/(2 − ν) of equal materials, N is Hertz's. Of the sums over springs, with S(d) = Σ k_n max(0, d − h_i),
F_x = μ [S(d) − S(d − u k_t/μk_n)]. The relative error of S is (3/2) B₂ (h/a)² with |B₂| ≤ 1/6: together at most
(h/a)²/4 (1 + c/a) of μN.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.doors import Reduction, Scene
from validation.figures import Array
from validation.paper.section2 import FACTORS, FORCE_UNIT, LENGTH_UNIT, MODULUS, fitted_order, pressed
from validation.references.hertz import hertz_force
from validation.references.mindlin import mindlin_force, mindlin_loop_area, raised_load_force
from validation.references.numerics import Pair
from validation.row import Reference, Row, absolute, relative
from validation.study import Bench, Findings, Rows, Scenes, Study

RADIUS, DEPTH, SPACING, FRICTION = 1000.0, 1.0, 0.5, 0.3
"""R, d and h in LU, μ."""
TURN = 0.8
"""Where the path turns, over u*."""
OUT, LOOP = np.linspace(0.0, TURN, 17), np.concatenate([np.linspace(TURN, -TURN, 33), np.linspace(-TURN, TURN, 33)[1:]])
"""The path over u*: initial loading, and one cycle."""
HALF = 10
"""Row of the initial path at u = u*/2."""
EDGE, STUCK, ORDER_SPACINGS, SPARE = 32.0, 0.5, (8.0, 4.0, 2.0, 1.0), 4
"""Of the runs that measure the order: a [LU] and c/a, both whole numbers of each spacing [LU]; particles beyond."""
FIRST, RAISED = 0.6, 0.6
"""Of the load that is raised: d before over d after, and u there over the u* before."""
LATTICE = "lattice: the edges of contact and stick zone lie anywhere between two particles; the run's claim"
BY_CHANCE = "the bound is that of the worst places of both edges between particles, and here they lie well"
ROUND_OFF = 1e-6
"""What is left of a radius that the springs meet exactly, and of an order whose series ends after one term."""
OTHER = {"reduction": "F_x and c/a over a hold in the paper's reduction as in the MDR; a itself is not asked for"}
"""Warnings of runs on which rows rest, and why they stand."""


@dataclass(frozen=True)
class Case:
    """A pair of bodies: name of the run, reduction, E [Pa] and ν of both."""

    name: str
    reduction: Reduction
    moduli: Pair
    poisson_ratios: Pair

    @property
    def ratio(self) -> float:
        """G*/E*."""
        return stiffness_ratio(self.moduli, self.poisson_ratios)

    def sliding(self, depth: float = DEPTH) -> float:
        """u* [LU]."""
        return FRICTION * depth / self.ratio

    def load(self, depth: float = DEPTH) -> float:
        """N of Hertz [FU]: two spheres R for the reduction of the paper, one and a flat for the MDR."""
        compliance = sum((1.0 - nu**2) / E for E, nu in zip(self.moduli, self.poisson_ratios, strict=True))
        radius = RADIUS * LENGTH_UNIT / FACTORS[self.reduction]
        return float(hertz_force(depth * LENGTH_UNIT, radius, 1.0 / compliance)) / FORCE_UNIT

    @property
    def half_width(self) -> float:
        """a of the springs [LU]."""
        return math.sqrt(FACTORS[self.reduction] * RADIUS * DEPTH)

    def scene(self, places: Array, depths: float | list[float] = DEPTH, **bodies: Any) -> Scene:
        """The body at the depths [LU], drawn along places [LU]."""
        experiment = {"kind": "tangential", "normal_displacement": depths, "displacements": places.tolist()}
        materials = zip(self.moduli, self.poisson_ratios, strict=True)
        return pressed(f"tangential: {self.name}", self.reduction, RADIUS, materials, experiment,
                       {"spacing": SPACING} | bodies, friction={"coefficient": FRICTION})  # fmt: skip


def stiffness_ratio(moduli: Pair, poisson_ratios: Pair) -> float:
    """G*/E*, 1/G* = Σ (2 − ν)/4G, 1/E* = Σ (1 − ν²)/E, G = E/2(1 + ν)."""
    pairs = list(zip(moduli, poisson_ratios, strict=True))
    return sum((1.0 - nu**2) / E for E, nu in pairs) / sum((2.0 - nu) * (1.0 + nu) / (2.0 * E) for E, nu in pairs)


def initial_path(u: float) -> float:
    """F_x/μN at u/u* ≤ 1."""
    return float(mindlin_force(u, 1.0, 1.0, 1.0))


def _equal(reduction: Reduction, nu: float) -> Case:
    return Case(f"tangential_{reduction}_nu{nu:g}", reduction, (MODULUS, MODULUS), (nu, nu))


CASES = (
    _equal("geike_popov", 0.3),
    _equal("mdr", 0.0),
    _equal("mdr", 0.3),
    _equal("mdr", 0.49),
    Case("tangential_mdr_unequal", "mdr", (MODULUS, 0.1 * MODULUS), (0.3, 0.48)),
)
BASE = CASES[2]


def _order_runs() -> dict[str, Scene]:
    depth = EDGE**2 / RADIUS
    place = np.array([BASE.sliding(depth) * (1.0 - STUCK**2)])
    return {
        f"tangential_order_h{h:g}": BASE.scene(place, depth, spacing=h, particles=2 * round(EDGE / h) + SPARE)
        for h in ORDER_SPACINGS
    }


def _raised() -> tuple[Array, list[float]]:
    """Places and depths [LU] of the run whose load is raised: out, up, and on."""
    low, high = BASE.sliding(FIRST * DEPTH), BASE.sliding()
    turn = RAISED * low
    on = turn + (high - low) * np.array([0.5, 1.0, 1.5])
    return np.array([turn, turn, *on]), [FIRST * DEPTH, DEPTH, DEPTH, DEPTH, DEPTH]


def scenes(_: Scene) -> Scenes:
    """A loop of every pair of bodies, a load that is raised, and spacings."""
    loops = {case.name: case.scene(case.sliding() * np.concatenate([OUT, LOOP[1:]])) for case in CASES}
    places, depths = _raised()
    return loops | {"tangential_raised": BASE.scene(places, depths)} | _order_runs()


def judge(bench: Bench) -> Findings:
    """Every quantity by its worst pair of bodies, then the raised load and the order."""
    row = Rows(bench.runs)
    finding = (
        "For pairs of bodies, equal and unequal, in both reductions, F_x forward and back, the stick radius and the "
        "dissipated energy are those of Cattaneo and Mindlin. A load that is raised while some particles slip has "
        "Mindlin's and Deresiewicz's force."
    )
    return Findings([*_loop_checks(row), *_raised_checks(row), _order_check(row)], text=finding)


def _fineness(case: Case) -> float:
    return (SPACING / case.half_width) ** 2


def _loop_checks(row: Rows) -> list[Row]:
    half, back = OUT[HALF], len(OUT) + 15
    reverse = initial_path(TURN) - 2.0 * initial_path(
        0.5 * TURN
    )  # at u = 0: the initial path at twice its size (Masing)
    each = []
    for case in CASES:
        run, unit = row.runs[case.name], FRICTION * case.load()
        force, energy = run.friction["tangential_force"], run.friction["dissipated_energy"]
        lattice, radius = _fineness(case), run.friction["stick_radius"][HALF] / run.curve.contact_radius[HALF]
        loop = mindlin_loop_area(TURN, 1.0, 1.0, 1.0) * case.sliding() * unit
        distance = 4.0 * TURN * case.sliding() * unit
        each.append((
            (force[HALF] / unit, initial_path(half), 0.5 * lattice),
            (force[back] / unit, reverse, 1.5 * lattice),
            (radius, math.sqrt(1.0 - half), ROUND_OFF),
            (float(energy[-1] - energy[len(OUT) - 1]) / loop, 1.0, 1.5 * lattice * distance / loop),
        ))  # fmt: skip
    pairs = f"worst of {len(CASES)} pairs of bodies"
    of = f"{pairs} for its lattice"
    names = (
        (f"F_x over μN at u*/2, {of}", "Cattaneo and Mindlin, N of Hertz in SI", LATTICE, BY_CHANCE),
        (f"F_x over μN on the reverse path from {TURN:g} u*, at u = 0, {of}",
         "Mindlin and Deresiewicz: the reverse path is the initial path at twice its size", LATTICE, BY_CHANCE),
        (f"c/a at u*/2, {pairs}", "Cattaneo and Mindlin", "round-off", "a parabola is met to round-off"),
        (f"energy of a loop between ±{TURN:g} u* over its area, {of}", "Mindlin and Deresiewicz", LATTICE, BY_CHANCE),
    )  # fmt: skip
    return [
        row(name, value, Reference(exact, source), absolute(bound, limit), on=[case.name for case in CASES],
            despite=OTHER, wide=wide)
        for (name, source, limit, wide), found in zip(names, zip(*each, strict=True), strict=True)
        for value, exact, bound in [max(found, key=lambda one: abs(one[0] - one[1]) / one[2])]
    ]  # fmt: skip


def _raised_checks(row: Rows) -> list[Row]:
    run, unit = row.runs["tangential_raised"], FRICTION * BASE.load()
    places, _ = _raised()
    loads, slidings = (FIRST**1.5, 1.0), (BASE.sliding(FIRST * DEPTH), BASE.sliding())
    force = run.friction["tangential_force"]
    raised = f"load raised by {1.0 / FIRST**1.5 - 1.0:.0%} at {RAISED:g} u*"
    return [
        row(f"F_x over μN, {raised}, {words} to the old edge on", force[i] / unit,
            Reference(raised_load_force(places[i], places[0], loads, slidings, 1.0),
                      "Mindlin and Deresiewicz: what slipped sticks anew"),
            absolute(1.5 * _fineness(BASE) / FIRST, LATTICE), on="tangential_raised", wide=BY_CHANCE)
        for i, words in ((2, "half of the distance"), (4, "one and a half times the distance"))
    ]  # fmt: skip


def _order_check(row: Rows) -> Row:
    """The fitted order, uncertain by the fit."""
    names = list(_order_runs())
    exact = FRICTION * BASE.load(EDGE**2 / RADIUS) * (1.0 - STUCK**3)
    errors = [abs(row.runs[name].friction["tangential_force"][-1] / exact - 1.0) for name in names]
    order, error, _ = fitted_order(ORDER_SPACINGS, errors)
    return row("order of convergence of F_x in the spacing", order,
               Reference(2.0, "Euler and Maclaurin: both edges are kinks of a sum"), relative(ROUND_OFF, "round-off"),
               uncertainty=error, on=names,
               wide="edges midway between particles: the series of a parabola ends after its first term")  # fmt: skip


STUDY = Study(
    "tangential",
    "The tangential contact beside Cattaneo and Mindlin",
    "The reduction is valid for the tangential contact, too, with the tangential stiffness in place of the normal one.",
    judge,
    scenes,
)
