"""Fig. 4: pressure and contact radius at zero load; Fig. 3b: springs between neighbours; Fig. 5: iteration in time."""

from dataclasses import replace
from functools import cache

import numpy as np

from validation.doors import PullOff, Scene
from validation.paper.scenes import MOVING, chain_model, changed, row_tension
from validation.references.pull_off import PullOff as SolvedPullOff
from validation.references.pull_off import pull_off
from validation.references.tension_radius import state_radius
from validation.row import Reference, Row, claim, relative, solver
from validation.study import Bench, Findings, Rows, Scenes, Study, found

RUN = "pull_off_R1000"
STENCIL = 9
"""Points of the solver's own polynomial for a radius."""
SETTING = 0.1
"""Share of a tolerance that a numerical setting may use up."""
AGAINST = "independent solver (energy minimisation with scipy)"


def scenes(paper: Scene) -> Scenes:
    """The pull-off of the first row of Table 1."""
    return {RUN: paper}


@cache
def solved(scene: Scene) -> SolvedPullOff:
    """The pull-off of a scene by the independent solver."""
    return pull_off(chain_model(scene), _preload(scene), stencil=STENCIL)


def judge(bench: Bench) -> Findings:
    """Profile, radii and force beside the independent solver."""
    paper, row = bench.paper, Rows(bench.runs)
    pressure = solved(paper).zero_load.pair_force[:, 1] / paper.bodies.spacing
    profile, radius = row.runs[RUN].profiles["zero_load"], found(row.runs[RUN], "zero_load_radius")
    tension = -pressure.min()
    rms = np.sqrt(np.mean((profile.pressure - pressure) ** 2)) / tension
    lowest = int(np.argmin(pressure))
    between = float(pressure[lowest - 1] - 2.0 * pressure[lowest] + pressure[lowest + 1]) / (8.0 * tension)
    setting = SETTING * paper.accuracy.tolerance
    checks = [
        row.at_most("pressure at zero load, rms distance to the solver's over the largest tension", rms,
            solver(setting, AGAINST), "share of the tolerance of the run that a setting may use up", on=RUN),
        *against_solver(row, paper, RUN),
        row.at_most(
            "sum of the pressure at zero load over the largest tension times a_0",
            abs(profile.pressure.sum()) * paper.bodies.spacing / (tension * radius.value),
            Reference(setting, "equilibrium: the force of the contact is 0"),
            "search for F = 0", on=RUN, standing="by construction"),
        row(
            "largest tension of a particle at zero load",
            -profile.pressure.min() * paper.bodies.spacing,
            Reference(row_tension(paper), "the law's largest tension before a straight row: no singularity"),
            relative(between,
                     "a particle lies at most half a spacing from the maximum: curvature of the pressure there"),
            unit="FU", on=RUN, wide="the particle nearest to the maximum is nearer to it"),
    ]  # fmt: skip
    finding = (
        "The pressure falls from the compressed middle to a finite tension, largest at the radius a_0: what one "
        "particle can be pulled with, so that there is no singularity."
    )
    return Findings(checks, text=finding)


def against_solver(row: Rows, scene: Scene, name: str, words: str = "") -> list[Row]:
    """F_A, a_0 and a_cr of a run beside the solver's, within what the run claims, and that within its tolerance."""
    model, marks = chain_model(scene), solved(scene)
    expected = (
        ("adhesion_force", "adhesion force F_A", marks.adhesion_force, CAREFUL),
        ("zero_load_radius", "radius of the largest tension at zero load, a_0",
         state_radius(model, marks.zero_load, STENCIL), CAREFUL),
        ("critical_radius", "radius of the largest tension at pull-off, a_cr",
         state_radius(model, marks.critical, STENCIL), FLAT),
    )  # fmt: skip
    return [
        row(symbol + words, found(row.runs[name], quantity), solver(reference, AGAINST),
            claim("what the run claims", scene.accuracy.tolerance), on=name, wide=wide)
        for quantity, symbol, reference, wide in expected
    ]  # fmt: skip


CAREFUL = "the run claims the worst of what its settings and its lattice can do"
FLAT = "the maximum of F is flat, so that the run can't claim its place better"


STUDY = Study(
    "fig4",
    "Fig. 4: pressure and contact radius",
    "In a model with a finite range the edge of the contact is ill defined; the contact radius is the place of the "
    "largest tensile stress.",
    judge,
    scenes,
)


ITERATION = "pull_off_dynamic"
NEIGHBOURS = (0.0, 3.0, 30.0)
"""Stiffness [FU/LU] beside the paper's scene, which has 0.3; a bulk spring has 1."""


def _run(stiffness: float) -> str:
    return f"neighbours{stiffness:g}"


def iteration_scenes(paper: Scene) -> Scenes:
    """The pull-off of the first row of Table 1, in time."""
    experiment = f"experiment={{ kind = 'pull_off', preload = {_preload(paper)}, method = 'dynamic' }}"
    return {ITERATION: changed(paper, experiment, *MOVING)}


def neighbour_scenes(paper: Scene) -> Scenes:
    """The same at rest, with other springs between neighbours, and with none."""
    bare = paper.model_copy(update={"neighbours": None})
    scenes = {_run(k): changed(paper, f"neighbours.stiffness={k}") if k else bare for k in NEIGHBOURS}
    return scenes | {RUN: paper}


def judge_iteration(bench: Bench) -> Findings:
    """F_A, a_0 and a_cr of tensions that are held or not."""
    finding = (
        "A plate with mass, pressed on by F_D and then pulled by ever narrower tensions until it rests or parts, finds "
        "what energy minimisation finds."
    )
    return Findings(against_solver(Rows(bench.runs), bench.paper, ITERATION), text=finding)


def judge_neighbours(bench: Bench) -> Findings:
    """F_A, a_0 and a_cr for each stiffness."""
    row, checks = Rows(bench.runs), []
    for name, scene in sorted(neighbour_scenes(bench.paper).items(), key=lambda entry: _stiffness(entry[1])):
        rows = against_solver(row, scene, name, f", neighbour springs of {_stiffness(scene):g} FU/LU")
        checks += rows if name != RUN else [replace(check, standing="repeats") for check in rows]
    return Findings(checks)


def _preload(scene: Scene) -> float:
    assert isinstance(scene.experiment, PullOff)
    return scene.experiment.preload


def _stiffness(scene: Scene) -> float:
    return 0.0 if scene.neighbours is None else scene.neighbours.stiffness


FIG5 = Study(
    "fig5",
    "Fig. 5: the adhesion force by iteration of the load in time",
    "A compressive force is applied and the plate comes to rest; then a tensile force: where an equilibrium is "
    "reached it "
    "is smaller than the adhesion force. Iterating yields the adhesion force and the critical radius.",
    judge_iteration,
    iteration_scenes,
)
NEIGHBOURS_STUDY = Study(
    "neighbours",
    "Fig. 3b: springs between neighbours",
    "Neighbouring particles are connected by linear springs that have transverse rigidity.",
    judge_neighbours,
    neighbour_scenes,
)
