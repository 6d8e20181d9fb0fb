"""Fig. 4: the pressure of the zero-load state, and the contact radius as the place of the largest tension."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import PullOff, Scene
from validation.judging.check import Check
from validation.judging.figures import save
from validation.judging.runs import found
from validation.judging.words import agreement, number, share
from validation.paper.figures import pressure_compared_figure
from validation.paper.oracles import chain_model, row_tension
from validation.paper.study import Findings, Rows, Runs, Scenes, Study
from validation.references.pull_off import PullOff as SolvedPullOff
from validation.references.pull_off import pull_off
from validation.references.tension_radius import state_radius

NAME = "fig4"
RUN = "pull_off_R1000"
STENCIL = 9
"""Points of the solver's own polynomial for a radius."""
SETTING = 0.1
"""Share of a tolerance that a numerical setting may use up."""
AGAINST = "independent solver (energy minimisation with scipy)"


def scenes(paper: Scene) -> Scenes:
    """The pull-off of the first row of Table 1."""
    return {RUN: paper}


def judge(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Profile, radii and force beside the independent solver."""
    run, row = runs[RUN], Rows(NAME, runs)
    assert isinstance(paper.experiment, PullOff)
    model = chain_model(paper)
    solved = pull_off(model, paper.experiment.preload, stencil=STENCIL)
    solver = solved.zero_load.pair_force[:, 1] / paper.bodies.spacing
    profile, radius = run.profiles["zero_load"], found(run, "zero_load_radius")
    tension = -float(solver.min())
    rms = float(np.sqrt(np.mean((profile.pressure - solver) ** 2))) / tension
    lowest = int(np.argmin(solver))
    between = float(solver[lowest - 1] - 2.0 * solver[lowest] + solver[lowest + 1]) / (8.0 * tension)
    save(
        pressure_compared_figure(profile.x, profile.pressure, model.places(), solver, radius.value),
        folder / "fig4.png",
    )
    setting = SETTING * paper.accuracy.tolerance
    checks = [
        row("pressure at zero load, rms distance to the solver's over the largest tension", rms, 0.0, "1", setting,
            AGAINST, "independent solver", 0.0, "share of the tolerance of the run that a setting may use up", on=[RUN],
            comparison="at most"),
        *against_solver(row, paper, run, solved, RUN),
        row("sum of the pressure at zero load over the largest tension times a_0",
            abs(float(profile.pressure.sum())) * paper.bodies.spacing / (tension * radius.value),
            0.0, "1", setting, "equilibrium: the force of the contact is 0", "closed form", 0.0, "search for F = 0",
            on=[RUN], comparison="at most", standing="by construction"),
        row("largest tension of a particle at zero load", -float(profile.pressure.min()) * paper.bodies.spacing, 0.0,
            "FU", row_tension(paper), "the law's largest tension before a straight row: no singularity", "closed form",
            between, "a particle lies at most half a spacing from the maximum: curvature of the pressure there",
            on=[RUN], wide="the particle nearest to the maximum is nearer to it"),
    ]  # fmt: skip
    finding = (
        "The pressure falls from the compressed middle to a finite tension, largest at the radius "
        f"a_0 = {radius.value:.3f} LU: {number(checks[-1].value / checks[-1].reference, 6)} of what one particle can "
        "be pulled with, so that there is no singularity. The independent solver finds the same pressure within "
        f"{share(rms)} of the largest tension: {agreement(checks)}."
    )
    caption = "Pressure at zero load (bars), the independent solver's (line), and the contact radius (dashed)"
    return Findings(finding, checks, {"fig4.png": caption})


def against_solver(row: Rows, scene: Scene, run: Run, solved: SolvedPullOff, name: str, words: str = "") -> list[Check]:
    """F_A, a_0 and a_cr of a run beside the solver's, within what the run claims, and that within its tolerance."""
    model = chain_model(scene)
    expected = (
        ("adhesion_force", "adhesion force F_A", "FU", solved.adhesion_force, ""),
        ("zero_load_radius", "radius of the largest tension at zero load, a_0", "LU",
         state_radius(model, solved.zero_load, STENCIL), CAREFUL),
        ("critical_radius", "radius of the largest tension at pull-off, a_cr", "LU",
         state_radius(model, solved.critical, STENCIL), FLAT),
    )  # fmt: skip
    return [
        row(symbol + words, found(run, quantity).value, found(run, quantity).uncertainty, unit, reference, AGAINST,
            "independent solver", scene.accuracy.tolerance, "what the run claims", on=[name], comparison="uncertainty",
            wide=wide or CAREFUL)
        for quantity, symbol, unit, reference, wide in expected
    ]  # fmt: skip


CAREFUL = "the run claims the worst of what its settings and its lattice can do"
FLAT = "the maximum of F is flat, so that the run can't claim its place better"


STUDY = Study(
    NAME,
    "Fig. 4: pressure and contact radius",
    "In a model with a finite range the edge of the contact is ill defined; the contact radius is the place of the "
    "largest tensile stress.",
    scenes,
    judge,
)
