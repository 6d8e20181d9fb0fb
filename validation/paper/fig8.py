"""Fig. 8: F/F_A over a/a₀ for many N and R, beside JKR, Barquins and the model's own closed form.

The closed form holds in the local limit (`paper.local`), whose curves have N and R of their own.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import Scene
from validation.judging.check import Check, Standing
from validation.judging.figures import Series, save
from validation.judging.runs import found
from validation.judging.words import agreement, share, worst_deviation
from validation.paper.curves import (
    DYNAMIC_FORCES,
    LENGTHENED,
    LOCAL_COUNTS,
    LOCAL_RADII,
    RADII,
    READ,
    REFINED,
    dynamic_run,
    lengthened_run,
    local_counted,
    radius_run,
    refined_run,
    scenes_8a,
    scenes_8b,
)
from validation.paper.fig4 import AGAINST, CAREFUL, STENCIL
from validation.paper.figures import closed_form_figure, reduced_figure
from validation.paper.oracles import chain_model, distances, equilibrium_under, independent_pairs, reduced
from validation.paper.paper import TABLE_1, local, with_radius
from validation.paper.runs import branch
from validation.paper.study import Findings, Rows, Runs, Study
from validation.references.tension_radius import state_radius

ASKED = 0.08
"""Largest rms distance of F/F_A to JKR's that was asked for, up to F/F_A = 1.5."""
OUTSIDE = 0.05
"""Share of radii that may be off by more than they claim."""
NARROW = "the claim also covers F_A, read between rows"


def judge_8a(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Distances of every curve over N."""
    names = {f"N = {n}, chain lengthened": lengthened_run(n) for n in LENGTHENED}
    names |= {f"N = {n}, spacing refined": refined_run(n) for n in sorted(REFINED)}
    checks = _jkr_checks("fig8a", names, runs)
    law = {f"N = {n}": (f"curve_local_N{n}", local_counted(paper, n)) for n in LOCAL_COUNTS}
    closed = _closed_form_checks("fig8a", law, runs)
    save(reduced_figure([_series(name, runs[run]) for name, run in names.items()]), folder / "fig8a.png")
    farthest = max(zip(checks, names, strict=True), key=lambda one: one[0].value)[1]
    a_0 = [found(runs[lengthened_run(n)], "zero_load_radius").value for n in LENGTHENED]
    finding = (
        f"A chain longer than the contact needs changes a_0 by {share(float(np.ptp(a_0)) / a_0[0])} at most. "
        f"{_summary(checks)} Farthest is {farthest}; for every spacing the interaction is found anew, with a range of "
        f"its own.\n\nIn the local limit, beside the model's closed form, {agreement(closed)}."
    )
    caption = "Reduced force over reduced radius for different numbers of particles"
    return Findings(finding, checks + closed, {"fig8a.png": caption})


def judge_8b(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Distances of every curve over R, and the dynamic points."""
    names = {f"R = {R:g} LU": radius_run(R) for R in RADII}
    checks = _jkr_checks("fig8b", names, runs)
    law = {f"R = {R:g} LU": (f"curve_local_R{R:g}", with_radius(local(paper), R)) for R in LOCAL_RADII}
    closed, moved = _closed_form_checks("fig8b", law, runs), _dynamic_checks(paper, runs)
    save(reduced_figure([_series(name, runs[run]) for name, run in names.items()], brittle=True), folder / "fig8b.png")
    points, lines = [], []
    for name, (run, scene) in law.items():
        d, force, a, _ = branch(runs[run])
        points.append(Series(name, a, force))
        pairs = independent_pairs(scene)
        law_radius, law_force = ([law(x) for x in d] for law in (pairs.contact_radius, pairs.force))
        lines.append(Series(name, np.array(law_radius), np.array(law_force)))
    save(closed_form_figure(points, lines), folder / "fig8b_closed_form.png")
    finding = (
        f"{_summary(checks)} That this hardly depends on R follows from the closed form: F_A, a_0 and the whole curve "
        "scale with the square root of R. How near it is to JKR's depends on the range of the interaction: for a range "
        "of zero the curve is that of springs that break, (3√3/2)(ã^3 − ã).\n\nIn the local limit, beside the closed "
        f"form, {agreement(closed)}. Radii of the dynamic method, settling under a load, beside the independent "
        "solver: "
        f"{agreement(moved)}, worst deviation {share(worst_deviation(moved))}."
    )
    captions = {
        "fig8b.png": "Reduced force over reduced radius for different radii of curvature",
        "fig8b_closed_form.png": "Force over radius in the local limit: runs, and the closed form of independent pairs",
    }
    return Findings(finding, [*checks, *closed, *moved], captions)


def judge_both(_: Scene, runs: Runs, folder: Path) -> Findings:
    """Is every curve nearer to JKR than to Barquins?"""
    row, checks = Rows("jkr_or_barquins", runs), []
    names = {f"N = {n}, chain lengthened": lengthened_run(n) for n in LENGTHENED}
    names |= {f"N = {n}, spacing refined": refined_run(n) for n in sorted(REFINED)}
    names |= {f"R = {R:g} LU": radius_run(R) for R in RADII}
    for name, run in names.items():
        jkr, barquins = _distances(runs[run])
        checks.append(
            row(f"rms distance to JKR over that to Barquins, {name}", jkr / barquins, 0.0, "1", 1.0,
                "JKR suits much better for arbitrary N and R", "paper's words", 0.0, "range of the interaction",
                on=[run], despite=READ, comparison="at most", standing=_standing(name))
        )  # fmt: skip
    nearer = sum(check.verdict == "PASS" for check in checks)
    worst = max(check.value for check in checks)
    finding = (
        f"For {nearer} of {len(checks)} curves JKR is nearer than Barquins; at the worst its distance is {worst:.2f} "
        "of "
        "that to Barquins."
    )
    return Findings(finding, checks, {})


def _standing(name: str) -> Standing:
    """Longer chains add particles that touch nothing, and R = 1000 is the chain of 200."""
    same = name == f"R = {TABLE_1[0].radius:g} LU" or ("lengthened" in name and f"N = {LENGTHENED[0]}," not in name)
    return "repeats" if same else "judged"


def _distances(run: Run) -> tuple[float, float]:
    _, force, a, _ = branch(run)
    return distances(force, a)


def _series(name: str, run: Run) -> Series:
    _, force, a, _ = branch(run)
    tension, ratio = reduced(force, a)
    stable = np.arange(len(force)) <= int(np.argmin(force)) + 2
    return Series(name, ratio[stable], tension[stable])


def _jkr_checks(study: str, names: Mapping[str, str], runs: Runs) -> list[Check]:
    row, checks = Rows(study, runs), []
    for name, run in names.items():
        jkr, barquins = _distances(runs[run])
        checks.append(
            row(f"rms distance of F/F_A to JKR up to 1.5, {name} (to Barquins: {barquins:.3f})", jkr, 0.0, "1", ASKED,
                "bound asked for; Fig. 8: curves lie on JKR's", "set bound", 0.0, "range of the interaction",
                on=[run], despite=READ, comparison="at most", standing=_standing(name))
        )  # fmt: skip
    return checks


def _closed_form_checks(study: str, laws: Mapping[str, tuple[str, Scene]], runs: Runs) -> list[Check]:
    """For each curve in the local limit: how far F and a are from the closed form, beside what the run claims."""
    row, checks = Rows(study, runs), []
    for name, (run, scene) in laws.items():
        d, force, a, spread = branch(runs[run])
        law = independent_pairs(scene)
        expected = np.array([law.force(x) for x in d])
        radii = np.array([law.contact_radius(x) for x in d])
        touching = radii > 2.0 * scene.bodies.spacing
        off = float(np.sqrt(np.mean((force - expected) ** 2))) / law.adhesion_force()
        claim = found(runs[run], "adhesion_force")
        over = (np.abs(a - radii) / spread)[touching]
        checks += [
            row(f"rms distance of F to the closed form over F_A, local limit, {name}", off, 0.0, "1",
                claim.uncertainty / claim.value, "what the run claims for F_A", "closed form", 0.0,
                "what the run claims", on=[run], despite=READ, comparison="at most", wide=NARROW),
            row(f"share of {over.size} radii farther from the closed form than they claim (worst: {over.max():.2g} of "
                f"the claim), local limit, {name}", float(np.mean(over > 1.0)), 0.0, "1", OUTSIDE,
                "closed form of independent pairs", "closed form", 0.0,
                "a claim is an estimate: 95 % are to be inside", on=[run], despite=READ, comparison="at most"),
        ]  # fmt: skip
    return checks


def _dynamic_checks(paper: Scene, runs: Runs) -> list[Check]:
    """Radii of settled loads beside the solver's at the same force."""
    row, model = Rows("fig8b", runs), chain_model(paper)
    checks = []
    for load in DYNAMIC_FORCES:
        ours = found(runs[dynamic_run(load)], "contact_radius")
        state = equilibrium_under(model, load)
        checks.append(
            row(f"contact radius of the dynamic method at F = {load:g} FU", ours.value, ours.uncertainty, "LU",
                state_radius(model, state, STENCIL), AGAINST, "independent solver", paper.accuracy.tolerance,
                "what the run claims", on=[dynamic_run(load)], comparison="uncertainty", wide=CAREFUL)
        )  # fmt: skip
    return checks


def _summary(checks: list[Check]) -> str:
    distances = [check.value for check in checks]
    return (
        f"The rms distance to JKR is {min(distances):.3f} to {max(distances):.3f} up to F/F_A = 1.5: "
        f"{agreement(checks)}."
    )


FIG8A = Study(
    "fig8a",
    "Fig. 8a: force over contact radius for different N",
    "Reduced curves of different numbers of particles lie close to the JKR curve, F̃ = 4ã^3 − 4ã^{3/2} (Eq. 8); an "
    "increasing number of particles, everything else being constant, should not change the result.",
    scenes_8a,
    judge_8a,
)
FIG8B = Study(
    "fig8b",
    "Fig. 8b: force over contact radius for different R",
    "Reduced curves of different radii of curvature lie close to the JKR curve as well.",
    scenes_8b,
    judge_8b,
)
JKR_OR_BARQUINS = Study(
    "jkr_or_barquins",
    "JKR or Barquins?",
    "For arbitrary N and R the three-dimensional theory (JKR) suits the results much better than the two-dimensional "
    "one (Barquins).",
    lambda paper: {
        name: scene
        for name, scene in (scenes_8a(paper) | scenes_8b(paper)).items()
        if name.startswith("curve") and "local" not in name
    },
    judge_both,
)
