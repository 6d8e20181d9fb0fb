"""The adhesive reduction beside JKR as it is: what F_A and a₀ don't fix, and where on the map of Maugis the scenes lie.

In the units F_A, a₀ and a₀²/R JKR has no parameter: a_cr/a₀ = 4^{-1/3}, d = ã² − (2/3)√ã, and at prescribed
displacement the work of separation ∫ −F dd from F = 0 on. Maugis and Dugdale have one, by which a_cr/a₀ goes from 0
(DMT) to JKR's.

The model is known to differ from JKR, and by how much is the independent chain solver's to say: it unloads to F = 0 and
to the largest tension; the work of separation is the difference of its energies.
"""

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from scipy.integrate import quad

from validation.doors import Scene, estimated, jkr_target, law_of, material_scene
from validation.page import number
from validation.paper import fig4
from validation.paper.fig4 import AGAINST, STENCIL
from validation.paper.scenes import CONTACT_MODULUS, READ, SURFACE_ENERGY, TABLE_1, chain_model, changed, jkr_reduced
from validation.paper.table1 import pull_off_run
from validation.references.interaction import Floats
from validation.references.maugis import tabor_of
from validation.references.solver import ChainSolver
from validation.references.tension_radius import state_radius
from validation.row import Known, Reference, Row, claim, relative
from validation.study import Bench, Findings, Rows, Runs, Scenes, Study, found

RADIUS, PARTICLES = 6.1e-6, 180
"""R of the sphere of the second scene [m], that of Table 1's first row, and particles of its chain, as many as its
contact needs and some more."""
ABOVE, BEYOND, STEPS = 1.2, 10.0, 160
"""Displacements of a parting: from JKR's zero-load place, times ABOVE, to BEYOND ranges past touch, in so many rows."""
CRITICAL_RADIUS_RATIO, FIXED_GRIPS_RADIUS_RATIO = 4.0 ** (-1.0 / 3.0), 6.0 ** (-2.0 / 3.0)
"""JKR's a/a₀ of the largest tension, and where bodies part under fixed grips."""
JKR_PULL_OFF, JKR_TABOR = 1.5, 5.0
"""F_A/πWR of JKR, and Tabor's μ from which on its zone is said to begin."""
LAMBDAS = (1e-2, 100.0)
"""Between which the parameter of Maugis is looked for."""
ZONE = 0.2
"""How sharp the border of a zone is: a convention, to some ten percent."""


class Case(NamedTuple):
    """A scene: words for it, names of its pull-off and of its parting, its R [LU] and range of attraction [LU]."""

    words: str
    pull_off: str
    parting: str


PAPER = Case("the paper's scene", pull_off_run(TABLE_1[0].radius), "parting_paper")
SPHERE = Case("a sphere by the MDR", "sphere", "parting_sphere")


@cache  # asked for twice
def sphere(tolerance: float) -> Scene:
    """The scene that `contact1d identify` begins with for a sphere of the paper's material, of PARTICLES."""
    target = jkr_target(CONTACT_MODULUS, SURFACE_ENERGY, RADIUS)
    found = estimated(*material_scene(CONTACT_MODULUS, RADIUS, target, tolerance=tolerance))
    return changed(found, f"bodies.particles={PARTICLES}")


def parting(scene: Scene) -> Scene:
    """The scene's way apart under prescribed displacement, from above F = 0 until the attraction has died away."""
    radius, reach = _lengths(scene)
    start, end = ABOVE * TABLE_1[0].zero_load_radius ** 2 / radius / 2.0, -BEYOND * reach
    places = [round(float(d), 6) for d in np.linspace(start, end, STEPS + 1)]
    return changed(scene, f"experiment={{ kind = 'path', displacements = {places} }}")


def _lengths(scene: Scene) -> tuple[float, float]:
    """R of the sphere and the range of the attraction [LU]."""
    radius = scene.bodies.profile.curvature_radius
    assert radius is not None
    return radius, law_of(scene)[3]


def scenes(paper: Scene) -> Scenes:
    """Pull-off and way apart of both scenes."""
    ball = sphere(paper.accuracy.tolerance)
    return {PAPER.pull_off: paper, PAPER.parting: parting(paper), SPHERE.pull_off: ball, SPHERE.parting: parting(ball)}


def jkr_work() -> float:
    """∫ −F̃ dd̃ from ã = 1 to the fold at prescribed displacement, in F_A a₀²/R: 0.42."""
    work = quad(lambda a: -jkr_reduced(a) * (2.0 * a - 1.0 / (3.0 * math.sqrt(a))), FIXED_GRIPS_RADIUS_RATIO, 1.0)
    return float(work[0])


@cache
def solved(scene: Scene) -> tuple[float, float, float, float]:
    """By the independent solver: a_cr/a₀, d at F = 0 and at F_A over a₀²/R, work of separation over F_A a₀²/R."""
    model, (radius, reach), marks = chain_model(scene), _lengths(scene), fig4.solved(scene)
    a_0, a_cr = (state_radius(model, state, STENCIL) for state in (marks.zero_load, marks.critical))
    apart = ChainSolver(model).equilibrium(-BEYOND * reach, marks.critical)
    unit = a_0**2 / radius
    work = (apart.energy - marks.zero_load.energy) / (marks.adhesion_force * unit)
    return a_cr / a_0, marks.zero_load.displacement / unit, marks.critical.displacement / unit, work


def judge(bench: Bench) -> Findings:
    """Both scenes beside JKR, and their place on the map of Maugis."""
    runs = bench.runs
    row = Rows(runs, READ)
    groups = {case: _checks(row, case) for case in (PAPER, SPHERE)}
    rows = [check for checks in groups.values() for check in checks]
    ranges = [f"{number(_by_range(case, runs), 2)} for {case.words}" for case in groups]
    finding = (
        "F_A and a_0 are JKR's because they are fitted, and F/F_A over a/a_0 is near it, as in Fig. 8b; other numbers "
        "differ from JKR's as the independent chain solver has it. What a run says of displacements, of work, or of "
        "a_cr of an adhesive body is the one-dimensional image's and not the body's. By the range of the attraction "
        f"Tabor's μ is {' and '.join(ranges)}; JKR is for μ above {JKR_TABOR:g}. Where F_A/πWR is not "
        f"{JKR_PULL_OFF:g}, γ read by Eq. (9) is wrong by as much."
    )
    return Findings(rows, text=finding)


def _checks(row: Rows, case: Case) -> list[Row]:
    """a_cr/a₀, d at F = 0 and at F_A, work, μ and F_A/πWR."""
    run, curve = row.runs[case.pull_off], row.runs[case.parting].curve
    force, a_0, a_cr = (found(run, q) for q in ("adhesion_force", "zero_load_radius", "critical_radius"))
    unit = a_0.value**2 / _lengths(run.scene)[0]
    d, f = np.asarray([curve.displacement, curve.force])[:, int(np.argmax(curve.displacement)) :]
    ratio = a_cr.value / a_0.value
    spread = ratio * (a_cr.uncertainty / a_cr.value + a_0.uncertainty / a_0.value)
    fine, rough = (
        np.array([_zero(d[::n], f[::n]), _lowest(d[::n], f[::n]), _work(d[::n], f[::n]) / force.value]) / unit
        for n in (1, 2)
    )
    on_map, beside = (np.array(tabor_of(of, LAMBDAS)) for of in (ratio, ratio - spread))
    limit = "model: one layer of springs, and a law whose range is not short"
    lowest = CRITICAL_RADIUS_RATIO**2 - 2.0 / 3.0 * math.sqrt(CRITICAL_RADIUS_RATIO)
    both, own, known = [case.parting, case.pull_off], [case.pull_off], solved(run.scene)
    theories = (
        ("a_cr/a_0", CRITICAL_RADIUS_RATIO, "JKR, 4^{-1/3}", own),
        ("d at F = 0 over a_0²/R", 1.0 / 3.0, "JKR", both),
        ("d at F_A over a_0²/R", lowest, "JKR", both),
        ("work of separation from F = 0 over F_A a_0²/R", jkr_work(), "JKR at prescribed displacement", both),
        ("Tabor's μ by a_cr/a_0 on the map of Maugis", JKR_TABOR, "JKR's zone begins there", own),
        ("F_A/πWR of Maugis and Dugdale at that μ", JKR_PULL_OFF, "JKR, and Eq. (9)", own),
    )
    numbers = zip(
        [ratio, *fine.tolist(), *on_map.tolist()],
        [spread, *abs(fine - rough).tolist(), *abs(on_map - beside).tolist()],
        [*known, *tabor_of(known[0], LAMBDAS)],
        strict=True,
    )
    return [
        row(f"{name}, {case.words}", value, Reference(theory, source),
            relative(ZONE, limit) if theory == JKR_TABOR else claim(limit), uncertainty=error, on=on,
            known=Known(solver, error, f"{AGAINST}, within the uncertainty"),
            standing="repeats" if theory in (JKR_TABOR, JKR_PULL_OFF) else "judged")
        for (name, theory, source, on), (value, error, solver) in zip(theories, numbers, strict=True)
    ]  # fmt: skip


def _by_range(case: Case, runs: Runs) -> float:
    """Tabor's μ with the range of the attraction for h₀ = γ/σ₀, γ and E* by Eq. (9)."""
    run = runs[case.pull_off]
    force, a_0 = (found(run, q).value for q in ("adhesion_force", "zero_load_radius"))
    radius, reach = _lengths(run.scene)
    work, modulus = force / (1.5 * math.pi * radius), 3.0 * force * radius / a_0**3
    return math.cbrt(radius * work**2 / (modulus**2 * reach**3))


def _zero(d: Floats, force: Floats) -> float:
    """d of the first F = 0 in unloading."""
    after = int(np.argmax(force < 0.0))
    return float(np.interp(0.0, force[[after, after - 1]], d[[after, after - 1]]))


def _lowest(d: Floats, force: Floats) -> float:
    """d of the largest tension, by a parabola through three rows."""
    i = int(np.argmin(force))
    left, middle, right = force[i - 1 : i + 2]
    return float(d[i] + 0.5 * (d[i + 1] - d[i]) * (left - right) / (left - 2.0 * middle + right))


def _work(d: Floats, force: Floats) -> float:
    """∫ −F dd from F = 0 on, by trapezoids."""
    zero = _zero(d, force)
    beyond = d < zero
    return float(np.trapezoid(np.concatenate([[0.0], force[beyond]]), np.concatenate([[zero], d[beyond]])))


STUDY = Study(
    "adhesive",
    "Adhesion of two chains beside JKR",
    "The model may not be suited for the adhesive contact; further calculations will help to identify its limits. JKR "
    "holds for large, compliant spheres, that is for a large μ; its F̃-ã curve is met, and F_A and a_0 identify the "
    "material.",
    judge,
    scenes,
)
