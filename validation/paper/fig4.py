"""Fig. 4: the pressure of the zero-load state, and the contact radius as the place of the largest tension."""

from __future__ import annotations

import numpy as np

from validation.doors import PullOff, Run, Scene
from validation.figures import Panel, Series, figure
from validation.page import agreement, number, share
from validation.paper.oracles import chain_model, row_tension
from validation.references.pull_off import PullOff as SolvedPullOff
from validation.references.pull_off import pull_off
from validation.references.tension_radius import state_radius
from validation.row import Reference, Row, claim, relative, solver
from validation.study import Bench, Findings, Rows, Scenes, Study, found

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


def judge(bench: Bench) -> Findings:
    """Profile, radii and force beside the independent solver."""
    paper, runs = bench.paper, bench.runs
    run, row = runs[RUN], Rows(runs)
    assert isinstance(paper.experiment, PullOff)
    model = chain_model(paper)
    solved = pull_off(model, paper.experiment.preload, stencil=STENCIL)
    pressure = solved.zero_load.pair_force[:, 1] / paper.bodies.spacing
    profile, radius = run.profiles["zero_load"], found(run, "zero_load_radius")
    tension = -float(pressure.min())
    rms = float(np.sqrt(np.mean((profile.pressure - pressure) ** 2))) / tension
    lowest = int(np.argmin(pressure))
    between = float(pressure[lowest - 1] - 2.0 * pressure[lowest] + pressure[lowest + 1]) / (8.0 * tension)
    setting = SETTING * paper.accuracy.tolerance
    checks = [
        row.at_most(
            "pressure at zero load, rms distance to the solver's over the largest tension",
            rms,
            solver(setting, AGAINST),
            "share of the tolerance of the run that a setting may use up",
            on=[RUN],
        ),
        *against_solver(row, paper, run, solved, RUN),
        row.at_most(
            "sum of the pressure at zero load over the largest tension times a_0",
            abs(float(profile.pressure.sum())) * paper.bodies.spacing / (tension * radius.value),
            Reference(setting, "equilibrium: the force of the contact is 0"),
            "search for F = 0",
            on=[RUN],
            standing="by construction",
        ),
        row(
            "largest tension of a particle at zero load",
            -float(profile.pressure.min()) * paper.bodies.spacing,
            Reference(row_tension(paper), "the law's largest tension before a straight row: no singularity"),
            relative(
                between, "a particle lies at most half a spacing from the maximum: curvature of the pressure there"
            ),
            unit="FU",
            on=[RUN],
            wide="the particle nearest to the maximum is nearer to it",
        ),
    ]
    finding = (
        "The pressure falls from the compressed middle to a finite tension, largest at the radius "
        f"a_0 = {radius.value:.3f} LU: {number(checks[-1].value / checks[-1].reference.value, 6)} of what one particle "
        "can "
        "be pulled with, so that there is no singularity. The independent solver finds the same pressure within "
        f"{share(rms)} of the largest tension: {agreement(checks)}."
    )
    panel = Panel(
        "x (LU)", "pressure (FU/LU)", [Series("run", profile.x, profile.pressure)],
        [Series("independent solver", model.places(), pressure)], mark=radius.value,
    )  # fmt: skip
    figures = figure("Pressure at zero load, the independent solver's (line), and the contact radius (dotted)", panel)
    return Findings(checks, figures, text=finding)


def against_solver(row: Rows, scene: Scene, run: Run, solved: SolvedPullOff, name: str, words: str = "") -> list[Row]:
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
        row(symbol + words, found(run, quantity), solver(reference, AGAINST),
            claim("what the run claims", scene.accuracy.tolerance), on=[name], wide=wide or CAREFUL)
        for quantity, symbol, unit, reference, wide in expected
    ]  # fmt: skip


CAREFUL = "the run claims the worst of what its settings and its lattice can do"
FLAT = "the maximum of F is flat, so that the run can't claim its place better"


STUDY = Study(
    NAME,
    "Fig. 4: pressure and contact radius",
    "In a model with a finite range the edge of the contact is ill defined; the contact radius is the place of the "
    "largest tensile stress.",
    judge,
    scenes,
)
