"""Fig. 5: the paper's iteration in time, and the springs between neighbours, beside the independent solver."""

from __future__ import annotations

from dataclasses import replace

from validation.doors import PullOff, Scene
from validation.page import agreement, share, worst_deviation
from validation.paper.fig4 import RUN, STENCIL, against_solver
from validation.paper.oracles import chain_model
from validation.paper.scenes import changed
from validation.references.pull_off import pull_off
from validation.study import Bench, Findings, Rows, Scenes, Study

ITERATION = "pull_off_dynamic"
NEIGHBOURS = (0.0, 3.0, 30.0)
"""Stiffness [FU/LU] beside the paper's scene, which has 0.3; a bulk spring has 1."""


def _run(stiffness: float) -> str:
    return f"neighbours{stiffness:g}"


def iteration_scenes(paper: Scene) -> Scenes:
    """The pull-off of the first row of Table 1, in time."""
    experiment = f"experiment={{ kind = 'pull_off', preload = {_preload(paper)}, method = 'dynamic' }}"
    return {ITERATION: changed(paper, experiment, "damping.coefficient=auto", "plate.mass=auto")}


def neighbour_scenes(paper: Scene) -> Scenes:
    """The same at rest, with other springs between neighbours, and with none."""
    bare = paper.model_copy(update={"neighbours": None})
    scenes = {_run(k): changed(paper, f"neighbours.stiffness={k}") if k else bare for k in NEIGHBOURS}
    return scenes | {RUN: paper}


def judge_iteration(bench: Bench) -> Findings:
    """F_A, a_0 and a_cr of tensions that are held or not."""
    paper, runs = bench.paper, bench.runs
    solved = pull_off(chain_model(paper), _preload(paper), stencil=STENCIL)
    checks = against_solver(Rows(runs), paper, runs[ITERATION], solved, ITERATION)
    finding = (
        "A plate with mass, pressed on by F_D and then pulled by ever narrower tensions until it rests or parts, finds "
        f"what energy minimisation finds within {share(worst_deviation(checks))}: {agreement(checks)}."
    )
    return Findings(checks, text=finding)


def judge_neighbours(bench: Bench) -> Findings:
    """F_A, a_0 and a_cr for each stiffness."""
    paper, runs = bench.paper, bench.runs
    row, checks, forces = Rows(runs), [], []
    for name, scene in sorted(neighbour_scenes(paper).items(), key=lambda entry: _stiffness(entry[1])):
        solved = pull_off(chain_model(scene), _preload(scene), stencil=STENCIL)
        rows = against_solver(
            row, scene, runs[name], solved, name, f", neighbour springs of {_stiffness(scene):g} FU/LU"
        )
        checks += rows if name != RUN else [replace(check, standing="repeats") for check in rows]
        forces.append(rows[0].value)
    finding = (
        f"Springs between neighbours of {_stiffness(paper):g} FU/LU change F_A by "
        f"{share(abs(forces[1] / forces[0] - 1.0))}, "
        f"of {NEIGHBOURS[-1]:g} FU/LU by {share(abs(forces[-1] / forces[0] - 1.0))}; the independent solver has the "
        "same: "
        f"{agreement(checks)}."
    )
    return Findings(checks, text=finding)


def _preload(scene: Scene) -> float:
    assert isinstance(scene.experiment, PullOff)
    return scene.experiment.preload


def _stiffness(scene: Scene) -> float:
    return 0.0 if scene.neighbours is None else scene.neighbours.stiffness


FIG5 = Study(
    "fig5",
    "Fig. 5: the iteration in time",
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
