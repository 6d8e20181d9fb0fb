"""Fig. 4: the pressure of the zero-load state, and the contact radius as the place of the largest tension."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from contact1d.analysis.reference.pull_off import pull_off
from contact1d.analysis.reference.tension_radius import state_radius
from contact1d.workflow.reproduce.check import Check
from contact1d.workflow.reproduce.figures import pressure_compared_figure, save
from contact1d.workflow.reproduce.oracles import chain_model, row_tension
from contact1d.workflow.reproduce.page import share
from contact1d.workflow.reproduce.runs import found
from contact1d.workflow.reproduce.study import Findings, Runs, Scenes, Study, checker
from contact1d.workflow.runs.finished import Run
from contact1d.workflow.scene import PullOff, Scene

NAME = "fig4"
row = checker(NAME)
RUN = "pull_off_R1000"
STENCIL = 9
"""Points of the solver's own polynomial for a radius."""
PRESSURE = 2e-3
"""Allowed rms distance of the pressures over the largest tension, at the scene's tolerance of 1e-3."""
RADIUS = 1e-3
FORCE = 1e-3
TENSION = 0.02
"""The largest tension lies between two particles: half a spacing off, some percent are missing."""


def scenes(paper: Scene) -> Scenes:
    """The pull-off of the first row of Table 1."""
    return {RUN: paper}


def judge(paper: Scene, runs: Runs, folder: Path) -> Findings:
    """Profile, radii and force beside the independent solver."""
    run = runs[RUN]
    assert isinstance(paper.experiment, PullOff)
    model = chain_model(paper)
    solved = pull_off(model, paper.experiment.preload, stencil=STENCIL)
    solver = solved.zero_load.pair_force[:, 1] / paper.bodies.spacing
    profile, radius, force = run.profiles["zero_load"], found(run, "zero_load_radius"), found(run, "adhesion_force")
    tension = -float(solver.min())
    rms = float(np.sqrt(np.mean((profile.pressure - solver) ** 2))) / tension
    save(
        pressure_compared_figure(profile.x, profile.pressure, model.places(), solver, radius.value),
        folder / "fig4.png",
    )
    against = "independent solver (energy minimisation with scipy)"
    checks = [
        row("pressure at zero load, rms distance to the solver's over the largest tension", rms, 0.0, "1", PRESSURE,
            against, "independent solver", 0.0, "tolerance of the run", comparison="at most"),
        _radius(run, "zero_load_radius", "radius of the largest tension at zero load, a_0",
                state_radius(model, solved.zero_load, STENCIL)),
        _radius(run, "critical_radius", "radius of the largest tension at pull-off, a_cr",
                state_radius(model, solved.critical, STENCIL)),
        row("adhesion force F_A", force.value, force.uncertainty, "FU",
            solved.adhesion_force, against, "independent solver", FORCE, "tolerance of the run"),
        row("sum of the pressure at zero load over the largest tension times a_0",
            abs(float(profile.pressure.sum())) * paper.bodies.spacing / (tension * radius.value),
            0.0, "1", FORCE, "equilibrium: the force of the contact is 0", "closed form", 0.0, "search for F = 0",
            comparison="at most"),
        row("largest tension of a particle at zero load", -float(profile.pressure.min()) * paper.bodies.spacing, 0.0,
            "FU", row_tension(paper), "the law's largest tension before a straight row: no singularity", "closed form",
            TENSION, "slope of the profile; particles lie to both sides of the maximum"),
    ]  # fmt: skip
    finding = (
        "The pressure has no singularity: it falls from the compressed middle to a finite tension, largest at the "
        f"radius a_0 = {radius.value:.3f} LU. The independent solver finds the same pressure within "
        f"{share(rms)} of the largest tension."
    )
    caption = "Pressure at zero load (bars), the independent solver's (line), and the contact radius (dashed)"
    return Findings(finding, checks, {"fig4.png": caption})


def _radius(run: Run, quantity: str, name: str, reference: float) -> Check:
    source = "independent solver (energy minimisation with scipy)"
    ours = found(run, quantity)
    return row(
        name, ours.value, ours.uncertainty, "LU", reference, source, "independent solver", RADIUS,
        "interpolation between particles",
    )  # fmt: skip


STUDY = Study(
    NAME,
    "Fig. 4: pressure and contact radius",
    "In a model with a finite range the edge of the contact is ill defined; the contact radius is the place of the "
    "largest tensile stress.",
    scenes,
    judge,
)
