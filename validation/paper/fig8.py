"""Fig. 8: F/F_A over a/a₀ for many N and R, beside JKR, Barquins and the model's own closed form.

The closed form holds in the local limit (`paper.local`), whose curves have N and R of their own.
"""

from collections.abc import Mapping
from functools import cache

import numpy as np

from validation.doors import Run, Scene, estimated
from validation.figures import Array, Panel, Series, figure
from validation.page import share
from validation.paper.fig4 import AGAINST, CAREFUL, STENCIL
from validation.paper.scenes import (
    FIRST_ROW,
    IN_PLACE,
    MOVING,
    READ,
    TABLE_1,
    barquins_reduced,
    breaking_reduced,
    chain_model,
    changed,
    curve_scene,
    equilibrium_under,
    independent_pairs,
    jkr_reduced,
    local,
    with_radius,
)
from validation.references.tension_radius import state_radius
from validation.row import Reference, Row, Standing, claim, solver
from validation.study import Bench, Findings, Rows, Runs, Scenes, Study, found

ASKED = 0.08
"""Largest rms distance of F/F_A to JKR's that was asked for, up to F/F_A = 1.5."""
OUTSIDE = 0.05
"""Share of radii that may be off by more than they claim."""
NARROW = "the claim also covers F_A, read between rows"


# N has two meanings: a longer chain of the same spacing, and a finer spacing of the same length. "The same physics" of
# the latter is the same stiffness and line tension per length, and a law with the same F_A and a₀ (`estimated`).
DEEPEST, STEPS = 0.46, 56
"""Largest displacement [LU] of a curve, F/F_A some 2 in every scene, and its rows in unloading."""
SAME = 200
"""N of the paper's chain; its curve is also that of R = 1000."""
LENGTHENED = {n: f"curve_lengthened_N{n}" for n in (SAME, 400, 800, 1600)}
"""The contact of R = 1000 needs some 174 particles; what a shorter chain cuts off the run warns of."""
REFINED = {n: f"curve_refined_N{n}" for n in (1600, 800, 400, 100)}
"""N on the length of 200 LU; the longest run first. N = 200 is the lengthened one."""
REFINED_TOLERANCE = 1e-2
"""Of runs whose particles feel tens of others."""
REFINED_DEEPEST = 0.5
"""Their contacts are softer; from 0.55 LU on particles of the finest go through the opposite chain."""
RADII = {R: f"curve_R{R:g}" for R in (500.0, 2000.0, 3000.0, 4000.0)} | {TABLE_1[0].radius: LENGTHENED[SAME]}
LOCAL_RADII = {R: f"curve_local_R{R:g}" for R in (4000.0, 8000.0, 16000.0, 32000.0)}
LOCAL_COUNTS = {n: f"curve_local_N{n}" for n in (100, 200, 300, 400)}
LOCAL_LENGTH, LOCAL_RADIUS = 1600.0, 64000.0
"""Length and R of the local chains of given N [LU]."""
DYNAMIC = {force: f"dynamic_load{force:g}" for force in (1.0, 0.0, -1.0)}
"""Loads [FU] of the dynamic points; the paper's own method."""
OF_N = {f"N = {n}, chain lengthened": name for n, name in LENGTHENED.items()} | {
    f"N = {n}, spacing refined": name for n, name in sorted(REFINED.items())
}
OF_R = {f"R = {R:g} LU": name for R, name in sorted(RADII.items())}
"""Runs by what rows say of them."""
HIGHEST = 1.5
"""F/F_A up to which curves are compared with theory."""
PLACES = 1000
"""Of the curve of springs that break, evenly over the displacement."""


def scenes_8a(paper: Scene) -> Scenes:
    """Curves of both meanings of N, and of the local limit."""
    fine = {name: curve_scene(refined(paper, n), REFINED_DEEPEST, STEPS) for n, name in REFINED.items()}
    long = {name: changed(paper, f"bodies.particles={n}") for n, name in LENGTHENED.items()}
    pairs = {name: local_counted(paper, n) for n, name in LOCAL_COUNTS.items()}
    return fine | {name: curve_scene(scene, DEEPEST, STEPS) for name, scene in (long | pairs).items()}


def scenes_8b(paper: Scene) -> Scenes:
    """Curves over R, of the local limit too, and dynamic loads of the paper's scene."""
    moving = {
        name: changed(
            paper,
            f"experiment={{ kind = 'load', force = {force}, method = 'dynamic' }}",
            *MOVING,
        )
        for force, name in DYNAMIC.items()
    }
    own = {name: changed(with_radius(paper, R), "bodies.particles=auto") for R, name in sorted(RADII.items())}
    own[LENGTHENED[SAME]] = paper
    pairs = {name: with_radius(local(paper), R) for R, name in LOCAL_RADII.items()}
    return moving | {name: curve_scene(scene, DEEPEST, STEPS) for name, scene in (own | pairs).items()}


def neighbour_curves(paper: Scene) -> Scenes:
    """The curves of bodies whose particles have neighbours."""
    every = scenes_8a(paper) | scenes_8b(paper)
    return {name: every[name] for name in (OF_N | OF_R).values()}


@cache  # three studies ask for the same four scenes, of a second each
def refined(paper: Scene, count: int) -> Scene:
    """The paper's scene with `count` particles on the same length."""
    spacing = 200.0 / count
    assert paper.neighbours is not None
    scene = changed(
        paper,
        f"bodies.particles={count}",
        f"bodies.spacing={spacing}",
        f"bodies.bulk_stiffness={paper.bulk_stiffness * spacing}",
        f"neighbours.stiffness={paper.neighbours.stiffness / spacing}",
        f"accuracy.tolerance={REFINED_TOLERANCE}",
    )
    return estimated(scene, FIRST_ROW)


def local_counted(paper: Scene, count: int) -> Scene:
    """The local limit with `count` particles on a given length."""
    return changed(with_radius(local(paper, LOCAL_LENGTH / count), LOCAL_RADIUS), f"bodies.particles={count}")


def branch(run: Run) -> tuple[Array, Array, Array, Array]:
    """Displacement, force, contact radius and its uncertainty in unloading, where the bodies touch."""
    curve = run.curve
    chosen = (curve.branch == "unloading") & np.isfinite(curve.contact_radius) & (curve.contact_radius > 0.0)
    columns = (curve.displacement, curve.force, curve.contact_radius, curve.contact_radius_uncertainty)
    d, force, a, spread = (column[chosen] for column in columns)
    return d, force, a, spread


def reduced(force: Array, contact_radius: Array) -> tuple[Array, Array]:
    """F/F_A and a/a₀ of a branch, with its own F_A, the largest tension, and its own a₀, where F = 0."""
    largest = int(np.argmin(force))
    stable = slice(0, largest + 1)
    order = np.argsort(force[stable])
    a_0 = np.interp(0.0, force[stable][order], contact_radius[stable][order])
    return force / -force[largest], contact_radius / a_0


def distances(run: Run) -> tuple[float, float]:
    """Rms distance of F/F_A to JKR's and to Barquins' at the same a/a₀, from a_cr up to F/F_A = 1.5."""
    return _distances(*reduced(*branch(run)[1:3]))


def broken() -> float:
    """Distance to JKR over that to Barquins of springs that break, for which d ∝ a²."""
    a = np.sqrt(np.linspace(HIGHEST, 0.0, PLACES))
    return float(np.divide(*_distances(breaking_reduced(a), a)))


def _distances(tension: Array, a: Array) -> tuple[float, float]:
    compared = (np.arange(len(a)) <= int(np.argmin(tension))) & (tension <= HIGHEST)
    theories = (jkr_reduced, barquins_reduced)
    jkr, barquins = (np.sqrt(np.mean((tension - law(a))[compared] ** 2)) for law in theories)
    return jkr, barquins


def judge_8a(bench: Bench) -> Findings:
    """Distances of every curve over N."""
    paper, runs = bench.paper, bench.runs
    checks = _jkr_checks(OF_N, runs)
    law = {f"N = {n}": (name, local_counted(paper, n)) for n, name in LOCAL_COUNTS.items()}
    closed = _closed_form_checks(law, runs)
    a_0 = [found(runs[name], "zero_load_radius").value for name in LENGTHENED.values()]
    finding = (
        f"A chain longer than the contact needs changes a_0 by {share(float(np.ptp(a_0)) / a_0[0])} at most. For every "
        f"spacing the interaction is found anew, with a range of its own.\n\n{IN_PLACE}"
    )
    return Findings(checks + closed, text=finding)


def judge_8b(bench: Bench) -> Findings:
    """Distances of every curve over R, and the dynamic points."""
    paper, runs = bench.paper, bench.runs
    checks = _jkr_checks(OF_R, runs)
    law = {f"R = {R:g} LU": (name, with_radius(local(paper), R)) for R, name in LOCAL_RADII.items()}
    closed, moved = _closed_form_checks(law, runs), _dynamic_checks(paper, runs)
    finding = (
        "That the distance to JKR hardly depends on R follows from the closed form: F_A, a_0 and the whole curve scale "
        "with the square root of R. How near it is to JKR's depends on the range of the interaction: for a range of "
        f"zero the curve is that of springs that break, (3√3/2)(ã^3 − ã).\n\n{IN_PLACE}"
    )
    figures = figure("Reduced force over reduced radius for different radii of curvature", _panel(runs))
    return Findings([*checks, *closed, *moved], figures, text=finding)


def judge_both(bench: Bench) -> Findings:
    """Is every curve much nearer to JKR than to Barquins? Springs that break are nearer to JKR, and not much."""
    row = Rows(bench.runs, READ)
    limit = Reference(broken(), "JKR suits much better: nearer than springs that break", "paper's words")
    checks = [
        row.at_most(f"rms distance to JKR over that to Barquins, {name}", jkr / barquins, limit,
            "range of the interaction: at zero range springs break", on=run, standing=_standing(name))
        for name, run in (OF_N | OF_R).items()
        for jkr, barquins in [distances(row.runs[run])]
    ]  # fmt: skip
    finding = (
        '"Much better" is taken as nearer than springs that break, (3√3/2)(ã^3 − ã), the model\'s own limit of zero '
        "range."
    )
    return Findings(checks, text=finding)


def _standing(name: str) -> Standing:
    """Longer chains add particles that touch nothing, and R = 1000 is the chain of 200."""
    same = name == f"R = {TABLE_1[0].radius:g} LU" or ("lengthened" in name and f"N = {SAME}," not in name)
    return "repeats" if same else "judged"


def _jkr_checks(names: Mapping[str, str], runs: Runs) -> list[Row]:
    row, bound = Rows(runs, READ), Reference(ASKED, "bound asked for; Fig. 8: curves lie on JKR's", "set bound")
    return [
        row.at_most(f"rms distance of F/F_A to JKR up to 1.5, {name} (to Barquins: {barquins:.3f})", jkr, bound,
            "range of the interaction", on=run, standing=_standing(name))
        for name, run in names.items()
        for jkr, barquins in [distances(runs[run])]
    ]  # fmt: skip


def _closed_form_checks(laws: Mapping[str, tuple[str, Scene]], runs: Runs) -> list[Row]:
    """For each curve in the local limit: how far F and a are from the closed form, beside what the run claims."""
    row, checks = Rows(runs, READ), []
    for name, (run, scene) in laws.items():
        d, force, a, spread = branch(runs[run])
        law = independent_pairs(scene)
        expected = np.array([law.force(x) for x in d])
        radii = np.array([law.contact_radius(x) for x in d])
        touching = radii > 2.0 * scene.bodies.spacing
        off = np.sqrt(np.mean((force - expected) ** 2)) / law.adhesion_force()
        claim = found(runs[run], "adhesion_force")
        over = (np.abs(a - radii) / spread)[touching]
        checks += [
            row.at_most(f"rms distance of F to the closed form over F_A, local limit, {name}", off,
                Reference(claim.uncertainty / claim.value, "what the run claims for F_A"), "what the run claims",
                on=run, wide=NARROW),
            row.at_most(
                f"share of {over.size} radii farther from the closed form than they claim (worst: {over.max():.2g} of "
                f"the claim), local limit, {name}",
                np.mean(over > 1.0), Reference(OUTSIDE, "closed form of independent pairs"),
                "a claim is an estimate: 95 % are to be inside", on=run),
        ]  # fmt: skip
    return checks


def _dynamic_checks(paper: Scene, runs: Runs) -> list[Row]:
    """Radii of settled loads beside the solver's at the same force."""
    row, model = Rows(runs), chain_model(paper)
    return [
        row(f"contact radius of the dynamic method at F = {load:g} FU", found(runs[name], "contact_radius"),
            solver(state_radius(model, equilibrium_under(model, load), STENCIL), AGAINST),
            claim("what the run claims", paper.accuracy.tolerance), on=name, wide=CAREFUL)
        for load, name in DYNAMIC.items()
    ]  # fmt: skip


def _panel(runs: Runs) -> Panel:
    """F/F_A over a/a₀ for each R beside JKR, Barquins, and springs that break (range → 0)."""
    series = []
    for name, run in OF_R.items():
        tension, ratio = reduced(*branch(runs[run])[1:3])
        stable = slice(0, int(np.argmin(tension)) + 3)
        series.append(Series(name, ratio[stable], tension[stable]))
    a = np.linspace(0.0, 1.25, 400)
    lines = [Series("JKR", a, jkr_reduced(a)), Series("Barquins (2D)", a, barquins_reduced(a)),
             Series("range → 0", a, breaking_reduced(a))]  # fmt: skip
    labels = (r"contact radius $\tilde a = a/a_0$", r"force $\tilde F = F/F_A$")
    return Panel(*labels, series, lines, view=(-1.15, 1.6))


FIG8A = Study(
    "fig8a",
    "Fig. 8a: force over contact radius for different N",
    "Reduced curves of different numbers of particles lie close to the JKR curve, F̃ = 4ã^3 − 4ã^{3/2} (Eq. 8); an "
    "increasing number of particles, everything else being constant, should not change the result.",
    judge_8a,
    scenes_8a,
)
FIG8B = Study(
    "fig8b",
    "Fig. 8b: force over contact radius for different R",
    "Reduced curves of different radii of curvature lie close to the JKR curve as well.",
    judge_8b,
    scenes_8b,
)
JKR_OR_BARQUINS = Study(
    "jkr_or_barquins",
    "Curves of force over radius beside JKR (3D) and Barquins (2D)",
    "For arbitrary N and R the three-dimensional theory (JKR) suits the results much better than the two-dimensional "
    "one (Barquins).",
    judge_both,
    neighbour_curves,
)
