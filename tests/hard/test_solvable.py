"""What the independent solver carries, the program carries: pairs that snap together, particles near their core."""

from collections.abc import Sequence
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import RunError, read_scene, run
from contact1d.workflow.model.settings import settings_for
from tests.scenes import chains
from validation.hard.cases import CORE, PairCase, shaped
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver

CARRIED = 0.9
"""Force of a pair over that of its core at which a particle counts as about to be pushed through."""
RUNS = 0.95
"""Share of the scenes that the solver carries that must run."""
ROWS = 1500
"""Displacements of the solver from out of reach to the load: with 600 it leaps through a core that carries."""
SEED = 13
"""A scene whose `share` is 0.37: of the solver alone, which takes ten times as long as the run."""


def random_load(seed: int) -> dict[str, Any]:
    """A load of a thirtieth to ten times the largest tension of a pair; pairs of 0.2 to 3 times the ratio of a fold."""
    rng = np.random.default_rng(seed)
    near = float(np.exp(rng.uniform(np.log(0.05), np.log(0.4))))
    far, amplitude = near * rng.uniform(1.3, 3.0), float(np.exp(rng.uniform(np.log(0.02), 0.0)))
    law = (amplitude, near, amplitude * far / near * rng.uniform(0.2, 0.85), far)
    r = np.linspace(0.0, 20.0 * far, 20_001)
    pair = PairInteraction.of(*law)
    steepest, tension = float(pair.force_slope(r).max()), -float(pair.force(r).min())
    stiffness = 2.0 * steepest / float(np.exp(rng.uniform(np.log(0.2), np.log(3.0))))
    force, radius = tension * 10.0 ** rng.uniform(-1.5, 1.0), float(10.0 ** rng.uniform(1.0, 2.0))
    experiment = {"kind": "load", "force": float(force)}
    return chains(radius, stiffness, law, accuracy={"tolerance": 1e-2}, experiment=experiment)


@cache
def share(seed: int) -> float:
    """Largest force of a pair over its core's on the solver's way to the load of a random scene.

    A pair that is pushed through has infinitely much of it, and so has a load that is never reached.
    """
    tables = random_load(seed)
    near, far = (Exponential(**tables["interaction"][name]) for name in ("repulsion", "attraction"))
    law, settings = PairInteraction(near, far), settings_for(read_scene(tables))
    radius, stiffness = tables["bodies"]["profile"]["radius"], tables["bodies"]["bulk_stiffness"]
    solver = ChainSolver(ChainModel(settings.chains.upper, stiffness, law, radius=radius))
    core, worst, load = float(law.force(np.zeros(1))[0]), 0.0, tables["experiment"]["force"]
    start, way = -5.0 * far.range, 2.0 * settings.largest_displacement + 7.0 * far.range
    state = solver.equilibrium(start)
    for displacement in np.linspace(start, start + way, ROWS)[1:]:
        before, state = state, solver.equilibrium(float(displacement), state)
        gap = solver.model.undeformed_gap(state.displacement) + state.upper[:, 1] - state.lower[:, 1]
        worst = max(worst, float(law.force(np.asarray([state.smallest_distance]))[0]) / core)
        if gap.min() <= 0.0 or worst > 1.0:
            return np.inf
        if displacement > 0.0 and state.force >= load > before.force:
            return worst
    return np.inf


IN_TIME: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}


def refused(seeds: Sequence[int], folder: Path, kind: str, timed: bool) -> tuple[int, dict[int, str]]:
    """How many of these scenes the solver carries, and which of those the program refuses."""
    solvable, failures = 0, {}
    for seed in seeds:
        tables = random_load(seed)
        if share(seed) > CARRIED:
            continue
        solvable += 1
        key = "force" if kind == "load" else "preload"
        tables |= {"experiment": {"kind": kind, key: tables["experiment"]["force"]}} | (IN_TIME if timed else {})
        try:
            run(tables, folder / str(seed), figures=False)
        except RunError as error:
            failures[seed] = str(error)
    return solvable, failures


def test_a_scene_that_the_solver_carries_runs() -> None:
    assert run(random_load(SEED)).status == "done"


def test_pairs_that_snap_together_in_time_stay_in_front_of_each_other(tmp_path: Path) -> None:
    """A load that comes at once drives a plate past its place, and a snap a particle through its opposite."""
    assert run(random_load(8) | IN_TIME, tmp_path, figures=False).status == "done"
    assert "hold" in (tmp_path / "in.lammps").read_text()


@pytest.mark.parametrize("dynamic", [False, True])
def test_pairs_stand_near_their_core_where_the_closed_form_says(dynamic: bool) -> None:
    case = PairCase("core", 0.5, shaped("flat_punch", 10, 0.0), 10, dynamic=dynamic)
    load = 0.85 * 10 * CORE
    experiment = {"kind": "load", "method": case.method, "force": load}
    found = run({"title": "core"} | case.scene() | {"experiment": experiment}).results.displacement
    assert abs(found.value - case.pairs.deepest(load)) <= found.uncertainty


@pytest.mark.slow
@pytest.mark.parametrize("timed", [False, True], ids=["at rest", "in time"])
@pytest.mark.parametrize("kind", ["load", "pull_off"])
def test_of_many_scenes_that_the_solver_carries_nearly_all_run(kind: str, timed: bool, tmp_path: Path) -> None:
    """Of the first 60 seeds all ran, but for a refusal each of a load and a pull-off in time before smaller steps."""
    solvable, failures = refused(range(100, 200), tmp_path, kind, timed)
    assert solvable >= 30
    assert len(failures) <= (1.0 - RUNS) * solvable, failures
