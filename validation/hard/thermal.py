"""Thermal averages: a load against Boltzmann's integral, and the scatter of seeds against the claim."""

import math

import numpy as np
from scipy.stats import chi2

from validation.doors import IN_TIME, Run
from validation.hard.cases import PAPER_BODIES, PAPER_LAW, PAPER_NUMBERS
from validation.hard.units import Scene
from validation.references.boltzmann_pairs import BoltzmannPairs
from validation.references.folded_pairs import FoldedPairs
from validation.references.interaction import Floats, PairInteraction
from validation.row import Reference, Row, at_most, claim
from validation.study import Bench, Lines, Refused, Study, claim_row, found, over_claim, said

SIGMAS = 4.0
"""Standard errors of the sample: one row in 16 000 fails by chance, and the seeds are fixed."""
CHANCE = 1e-4
"""Of a row that judges a chi-square."""
BLOCKS = 20
FORGOTTEN = 60
"""First rows of a thermal load, on the way to equilibrium."""
BODIES = PAPER_BODIES | {"particles": 41, "spacing": 4.0}
"""Pull_off.toml's bodies, four times as far apart so that particles feel their opposite only."""
LOAD = 0.25
TEMPERATURES = (1e-4, 1e-3, 3e-3)
LIMIT = f"statistics: {SIGMAS:g} of the run's standard errors"
LAW_HERE = PairInteraction.of(*PAPER_NUMBERS)
HEIGHTS: Floats = (4.0 * np.arange(-20.0, 21.0)) ** 2 / 2000.0
NEAR, WIDTH = 0.24, {1e-4: 0.05, 1e-3: 0.13, 3e-3: 0.22}
"""Interval of displacements of the integral [LU]: eight standard deviations."""


def thermal_scene(temperature: float, seed: int, tolerance: float = 2e-3) -> Scene:
    """A load under noise; without, at temperature 0, the same at rest."""
    scene: Scene = {
        "bodies": BODIES,
        "interaction": PAPER_LAW,
        "accuracy": {"tolerance": tolerance},
        "experiment": {"kind": "load", "force": LOAD},
    }
    if temperature > 0.0:
        scene |= IN_TIME | {"noise": {"temperature": temperature, "seed": seed}}
    return scene


def measure_boltzmann(bench: Bench) -> Lines:
    """⟨d⟩ under a load at three temperatures, how much of it is thermal, and the variance of d in time."""
    rest = FoldedPairs(LAW_HERE, 0.83, HEIGHTS).deepest(LOAD)
    still = bench.run("rest", thermal_scene(0.0, 0))
    yield claim_row("d at kT = 0 off over its claim", still, "displacement", rest, "independent pairs")
    source, limit = "Boltzmann's integral over distances and plate", LIMIT
    for kT in TEMPERATURES:
        exact, swing = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, kT).displacement(LOAD, NEAR, WIDTH[kT])
        run = bench.run(f"noise_{kT:g}", thermal_scene(kT, 3))
        off = over_claim(run, "displacement", exact)
        yield at_most(f"d at kT = {kT:g} off over its claim", off, SIGMAS, source, said(limit, run))
        if isinstance(run, Refused):
            continue
        d = found(run, "displacement")
        if kT > TEMPERATURES[0]:  # there the mean cannot tell the temperature from 0, and the variance does
            yield Row(f"d(kT = {kT:g}) − d(0)", d.value - rest, Reference(exact - rest, source), claim(limit),
                    uncertainty=SIGMAS * d.uncertainty, unit="LU")  # fmt: skip
        # It tells the temperature where the mean does not.
        sampled = np.asarray(run.curve.displacement)[FORGOTTEN:]
        squares = (sampled - sampled.mean()) ** 2 / swing**2
        error = np.std([block.mean() for block in np.array_split(squares, BLOCKS)], ddof=1) / math.sqrt(BLOCKS)
        name = f"variance of d in time at kT = {kT:g} off over its standard error"
        yield at_most(name, abs(squares.mean() - 1.0) / error, SIGMAS, "Boltzmann's integral",
                            f"statistics: {sampled.size} samples, ± {error:.2g}")  # fmt: skip


def measure_seeds(bench: Bench) -> Lines:
    """(d − exact)/claim of each seed: its χ² neither too large nor too small."""
    count, temperature = 24 if bench.full else 6, TEMPERATURES[0]
    exact, _ = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, temperature).displacement(LOAD, NEAR, WIDTH[temperature])
    runs = [bench.run(f"seed_{seed}", thermal_scene(temperature, seed, 5e-3)) for seed in range(1, count + 1)]
    means = [found(run, "displacement") for run in runs if isinstance(run, Run)]
    sigmas = [(d.value - exact) / d.uncertainty for d in means]
    square = np.sum(np.square(sigmas)) if len(sigmas) == count else math.nan
    source, limit = "Boltzmann's integral; χ² of as many independent seeds", "statistics"
    words, mean = f"of {count} seeds", abs(float(np.mean(sigmas))) * math.sqrt(count)
    least = chi2.ppf(CHANCE, count) / square
    # The errors are known from BLOCKS blocks only: each is an F-variable.
    most = chi2.ppf(1.0 - CHANCE, count) * (BLOCKS - 1) / (BLOCKS - 3)
    return [
        at_most(f"χ² {words} by their claims: not too large", square, most, source, limit),
        at_most(f"least χ² that chance allows over χ² {words}: claims not too wide", least, 1.0, source, limit),
        at_most(f"mean {words} off, in standard errors of it", mean, SIGMAS, source, limit),
    ]  # fmt: skip


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
