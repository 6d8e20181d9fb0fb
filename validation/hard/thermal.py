"""Thermal averages: a load against Boltzmann's integral, and the scatter of seeds against the claim."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy.optimize import brentq
from scipy.stats import chi2

from validation.doors import IN_TIME, Run
from validation.hard.cases import CHANCE, PAPER_LAW, PAPER_NUMBERS, SIGMAS, block_mean, chi_square_bound
from validation.references.boltzmann_pairs import BoltzmannPairs
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats, PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver
from validation.references.thermal_chain import displacement_under
from validation.row import Reference, Row, at_most, claim
from validation.study import Bench, Findings, Refused, Study, claim_row, found, over_claim, said

FORGOTTEN = 60
"""First rows of a thermal load, on the way to equilibrium."""
BODIES = {"particles": 41, "spacing": 4.0, "profile": {"kind": "parabola", "radius": 1000.0}, "bulk_stiffness": 0.83}
"""Pull_off.toml's bodies, four times as far apart so that particles feel their opposite only."""
LOAD = 0.25
TEMPERATURES = (1e-4, 1e-3, 3e-3)
LIMIT = f"statistics: {SIGMAS:g} of the run's standard errors"
WIDE_BODIES: dict[str, Any] = BODIES | {"particles": 200, "spacing": 1.0}
WIDE_LOAD, WIDE_NEAR, WIDE_WIDTH = 1.0, 0.255, 0.1
"""The load [FU], and the interval of displacements of its average [LU]: ten standard deviations."""
WIDE_TEMPERATURES, FULL_WIDE_TEMPERATURES, WIDE_TOLERANCE = (0.0, 1e-3), (0.0, 1e-4, 1e-3), 1e-3
LAW_HERE = PairInteraction.of(*PAPER_NUMBERS)
HEIGHTS: Floats = np.asarray((4.0 * np.arange(-20.0, 21.0)) ** 2 / 2000.0)
NEAR, WIDTH = 0.24, {1e-4: 0.05, 1e-3: 0.13, 3e-3: 0.22}
"""Interval of displacements of the integral [LU]: eight standard deviations."""


def thermal_scene(temperature: float, seed: int, tolerance: float = 2e-3) -> dict[str, Any]:
    """A load under noise; without, at temperature 0, the same at rest."""
    scene: dict[str, Any] = {
        "bodies": BODIES,
        "interaction": PAPER_LAW,
        "accuracy": {"tolerance": tolerance},
        "experiment": {"kind": "load", "force": LOAD},
    }
    if temperature > 0.0:
        scene |= IN_TIME | {"noise": {"temperature": temperature, "seed": seed}}
    return scene


def measure_boltzmann(bench: Bench) -> Findings:
    """⟨d⟩ under a load at three temperatures, and how much of it is thermal."""
    rest = FoldedPairs(LAW_HERE, 0.83, HEIGHTS).deepest(LOAD)
    still = bench.run("rest", thermal_scene(0.0, 0))
    rows = [claim_row("d at kT = 0 off over its claim", still, "displacement", rest, "independent pairs")]
    source, limit = "Boltzmann's integral over distances and plate", LIMIT
    for kT in TEMPERATURES:
        exact, swing = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, kT).displacement(LOAD, NEAR, WIDTH[kT])
        run = bench.run(f"noise_{kT:g}", thermal_scene(kT, 3))
        off = over_claim(run, "displacement", exact)
        rows.append(at_most(f"d at kT = {kT:g} off over its claim", off, SIGMAS, source, said(limit, run)))
        if isinstance(run, Refused):
            continue
        d = found(run, "displacement")
        if kT > TEMPERATURES[0]:  # there the mean cannot tell the temperature from 0, and the variance does
            rows.append(
                Row(f"d(kT = {kT:g}) − d(0)", d.value - rest, Reference(exact - rest, source), claim(limit),
                    uncertainty=SIGMAS * d.uncertainty, unit="LU")
            )  # fmt: skip
        rows.append(_swing_row(run, kT, swing))
    return Findings([*rows, *_shipped(bench)])


def _shipped(bench: Bench) -> Iterator[Row]:
    """⟨d⟩ of pull_off.toml's bodies without neighbours, held along x, under 1 FU: all pairs, to first order in kT."""
    model = ChainModel(WIDE_BODIES["particles"], WIDE_BODIES["bulk_stiffness"], LAW_HERE, radius=1000.0)
    places = np.linspace(WIDE_NEAR - WIDE_WIDTH, WIDE_NEAR + WIDE_WIDTH, 27)
    rest = float(brentq(lambda d: ChainSolver(model).equilibrium(d).force - WIDE_LOAD, *places[[0, -1]], xtol=1e-9))
    for kT in FULL_WIDE_TEMPERATURES if bench.full else WIDE_TEMPERATURES:
        scene = thermal_scene(kT, 3, WIDE_TOLERANCE if bench.full else 5e-3)
        scene |= {"bodies": WIDE_BODIES, "experiment": {"kind": "load", "force": WIDE_LOAD}}
        run = bench.run(f"wide_{kT:g}", scene)
        exact, source, bound, limit = (
            (displacement_under(model, WIDE_LOAD, kT, places)[0], "all pairs, first order in kT", SIGMAS, LIMIT)
            if kT else (rest, "Newton's method on all pairs", 1.0, "what the run claims")
        )  # fmt: skip
        name = f"d of pull_off.toml's bodies without neighbours under 1 FU at kT = {kT:g}, off over its claim"
        yield at_most(name, over_claim(run, "displacement", exact), bound, source, said(limit, run))


def _swing_row(run: Run, temperature: float, swing: float) -> Row:
    """The variance of d in time: it tells the temperature where the mean does not."""
    sampled = np.asarray(run.curve.displacement)[FORGOTTEN:]
    ratio, error = block_mean(((sampled - sampled.mean()) ** 2 / swing**2)[:, None])
    off = float(abs(ratio[0] - 1.0) / error[0])
    return at_most(
        f"variance of d in time at kT = {temperature:g} off over its standard error",
        off,
        SIGMAS,
        "Boltzmann's integral",
        f"statistics: {sampled.size} samples, ± {error[0]:.2g}",
    )


def measure_seeds(bench: Bench) -> Findings:
    """(d − exact)/claim of each seed: its χ² neither too large nor too small."""
    count, temperature = (24, 1e-4) if bench.full else (6, 1e-4)
    exact, _ = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, temperature).displacement(LOAD, NEAR, WIDTH[temperature])
    runs = [bench.run(f"seed_{seed}", thermal_scene(temperature, seed, 5e-3)) for seed in range(1, count + 1)]
    means = [found(run, "displacement") for run in runs if isinstance(run, Run)]
    sigmas = [(d.value - exact) / d.uncertainty for d in means]
    square = float(np.sum(np.square(sigmas))) if len(sigmas) == count else math.nan
    source, limit = "Boltzmann's integral; χ² of as many independent seeds", "statistics"
    words, mean = f"of {count} seeds", abs(float(np.mean(sigmas))) * math.sqrt(count)
    least = float(chi2.ppf(CHANCE, count)) / square
    return Findings([
        at_most(f"χ² {words} by their claims: not too large", square, chi_square_bound(count), source, limit),
        at_most(f"least χ² that chance allows over χ² {words}: claims not too wide", least, 1.0, source, limit),
        at_most(f"mean {words} off, in standard errors of it", mean, SIGMAS, source, limit),
    ])  # fmt: skip


CLASSES = (
    Study(
        "boltzmann",
        "Thermal averages and Boltzmann's integral",
        "The mean displacement under noise may be correct at temperature 0 and wrong in its thermal part, which has a"
        " row of its own. Is each within its uncertainty?",
        measure_boltzmann,
    ),
    Study(
        "seeds",
        "Scatter over random seeds and the standard error",
        "Is the standard error of a mean under noise neither too small nor too large for its scatter over seeds?",
        measure_seeds,
    ),
)
