"""Adhesion on a rigid plane beside JKR itself, nothing fitted: Heß's rule as a local law of each spring.

F = (4/3) E* a³/R − √(8πE*Wa³),    d = a²/R − √(2πWa/E*),    F_A = (3/2)πWR,    a₀ = (9πWR²/2E*)^{1/3}
"""

from typing import Any

import numpy as np

from validation.doors import Run, Scene, on_plane, read_scene
from validation.figures import Panel, Series, figure
from validation.paper.section2 import fitted_order
from validation.references.indenters import jkr
from validation.row import Reference, Row, claim
from validation.study import Bench, Findings, Rows, Scenes, Study

RADIUS, MODULUS, WORK, SPACING = 100.0, 1.0, 0.005, 0.2
"""R [LU], E* [FU/LU²], W [FU/LU], h [LU]."""
THEORY = jkr(RADIUS, MODULUS, WORK)
FINENESS = (10.0, 20.0, 40.0, 80.0)
"""Particles in a₀, of the runs that measure the order."""
FARTHEST, NEAREST, STATES = 1.18, 0.32, 97
"""Contact radii over a₀ that these runs pass, and how many: from three times F_A to fixed grips' end."""
RMS, ORDER_SHORT = 1e-2, 0.2
"""Asked of the curve of 10 particles in a₀, over F_A; and of the order, which is to be 1.8 at least."""
FINE = 400_000
"""Places of JKR's branch between which a straight line is drawn: an error of 1e-9."""
LATTICE = "lattice: the edge lies anywhere between two particles; the run's claim"
SPACING_NAMED = {
    "lattice": "the run names the spacing that would do: what this one leaves is what is asked for",
    "tolerance": "marks between two rows of a way: the rows themselves are compared",
    "slope": "small slopes are the theory's: in units of the model it has no other scale",
}


def scenes(_: Scene) -> Scenes:
    """A pull-off at the spacing of the shipped scene, and ways through JKR's states at coarser and finer ones."""
    radius = THEORY.zero_load_radius()
    places = THEORY.displacement(np.linspace(FARTHEST, NEAREST, STATES) * radius)
    way = [1.1 * float(places[0]), *places.tolist()]
    ways = {_name(n): _scene({"kind": "path", "displacements": way}, radius / n) for n in FINENESS}
    return {"jkr_plane_pull_off": _scene({"kind": "pull_off", "preload": 2.0}, SPACING)} | ways


def _name(particles: float) -> str:
    return f"jkr_plane_{particles:g}"


def _scene(experiment: dict[str, Any], spacing: float) -> Scene:
    tables = {"title": "JKR on the plane", "adhesion": {"work_of_adhesion": WORK}, "experiment": experiment}
    return read_scene(tables | on_plane({"kind": "parabola", "radius": RADIUS}, spacing))


def judge(bench: Bench) -> Findings:
    """The pull-off's quantities within what it claims, the curve by its rms, the order in the spacing."""
    runs = bench.runs
    row = Rows(runs, SPACING_NAMED)
    rows = [*_pull_off_checks(row), *_curve_checks(row)]
    a = np.linspace(THEORY.fixed_grips_radius(), FARTHEST * THEORY.zero_load_radius(), 400)
    unit, depth = THEORY.pull_off_force(), THEORY.zero_load_radius() ** 2 / RADIUS
    curves = [
        Series(f"{n:g} particles in a₀", runs[_name(n)].curve.displacement / depth, runs[_name(n)].curve.force / unit)
        for n in FINENESS[:2]
    ]
    law = Series("JKR", THEORY.displacement(a) / depth, THEORY.force(a) / unit)
    panel = Panel("displacement over $a_0^2/R$", "force over $F_A$", curves, [law], view=(-1.15, 1.6))
    figures = figure("Force over displacement on a rigid plane, beside JKR", panel)
    finding = (
        "On a rigid plane a spring that detaches at √(2π|x|W/E*) makes the chain JKR's contact, with nothing fitted, "
        "and the curve comes nearer with the square of the spacing."
    )
    return Findings(rows, figures, text=finding)


def _pull_off_checks(row: Rows) -> list[Row]:
    name = "jkr_plane_pull_off"
    found = row.runs[name].results
    wanted = (
        ("F_A", "adhesion_force", THEORY.pull_off_force()),
        ("a_0", "zero_load_radius", THEORY.zero_load_radius()),
        ("a_cr", "critical_radius", THEORY.critical_radius()),
    )
    return [
        row(f"{symbol}, {THEORY.zero_load_radius() / SPACING:.0f} particles in a_0", found[key],
            Reference(value, "JKR (Johnson, Kendall and Roberts 1971)"), claim(LATTICE), on=name,
            wide="the claim is for the worst place of the edge between two particles")
        for symbol, key, value in wanted
    ]  # fmt: skip


def _curve_checks(row: Rows) -> list[Row]:
    """rms of F over JKR's states, the edge everywhere between two particles; and how it falls with the spacing."""
    off = [_off(row.runs[_name(n)]) for n in FINENESS]
    order, spread, _ = fitted_order([1.0 / n for n in FINENESS], off)
    checks = [
        row.at_most(f"rms of F − JKR over F_A, {n:g} particles in a_0", error,
            Reference(RMS, "bound that was asked for", "set bound"), LATTICE, on=_name(n))
        for n, error in zip(FINENESS[:2], off[:2], strict=True)
    ]  # fmt: skip
    short = row.at_most("what the order of convergence of F(d) in the spacing lacks of 2",
                max(0.0, 2.0 - order), Reference(ORDER_SHORT, "bound that was asked for", "set bound"),
                "the share of the edge's cell is known by a straight line",
                uncertainty=spread, on=[_name(n) for n in FINENESS])  # fmt: skip
    return [*checks, short]


def _off(run: Run) -> float:
    """rms of F [F_A] over unloading, beside JKR's stable branch under fixed grips at the same displacements."""
    a = np.linspace(THEORY.fixed_grips_radius(), 2.0 * THEORY.zero_load_radius(), FINE)
    back = run.curve.branch == "unloading"
    wanted = np.interp(run.curve.displacement[back], THEORY.displacement(a), THEORY.force(a))
    return float(np.sqrt(np.mean((run.curve.force[back] - wanted) ** 2))) / THEORY.pull_off_force()


STUDY = Study(
    "jkr_plane",
    "Adhesion on a rigid plane beside JKR itself",
    "Adhesive contacts map onto one dimension, too (Section 4). The paper's chains attract each other by a law with a "
    "range, and two of JKR's numbers are fitted; a local rule of separation needs none.",
    judge,
    scenes,
)
