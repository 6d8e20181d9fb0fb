"""Thermal detachment: nine pairs pulled at a steady loading rate until they part, beside Smoluchowski's equation.

The pairs are too far apart to feel each other, so that the free energy of the plate is nine times that of a pair, by
quadrature. The density of the plate is followed in time as the load grows, over three decades of its rate.
"""

import math
from functools import cache

import numpy as np

from validation.doors import Scene, law_table, read_scene
from validation.figures import Array
from validation.page import number
from validation.paper.heat import BY_CHANCE, SIGMAS, together
from validation.references import boltzmann_pairs, detachment, interaction
from validation.row import Row, absolute, relative, solver
from validation.study import Bench, Findings, Rows, Scenes, Study, found

PAIRS, APART, STIFFNESS, DRAG, TEMPERATURE = 9, 3.0, 2.0, 0.5, 5e-3
"""Pairs, their spacing [LU], springs [FU/LU], γ [FU·TU/LU] of a particle, kT [FU·LU]."""
LAW = (0.18, 0.13, 0.09, 0.26)
"""A [FU·LU], a [LU], B [FU·LU], b [LU]."""
RATES = (3e-5, 3e-4, 3e-3, 3e-2)
"""Loading rates [FU/TU], the one that takes longest first."""
PULLS = 100
"""At each rate: four standard errors of a spread are then 28 % of it, of all four together 14 %."""
FARTHEST, DEEPEST, PLACES = -1.6, 0.45, 2200
"""Places of the density [LU]."""
COLD = 2e-5
"""kT [FU·LU] of the forces that say where the largest tension is."""
LET_GO = 0.99
"""Share of the largest tension that has its place beyond the barrier, as the program has it."""
MOST_RMS = 2.2
"""Standard errors of all means together, of four by chance once in a thousand times."""
SPREAD_ERROR = 1.0 / math.sqrt(2.0 * (PULLS - 1))
"""Standard error of a spread over it."""
STATISTICS = "statistics: four standard errors"


def scene(rate: float, repeats: int = PULLS) -> Scene:
    """The pairs, pulled at a rate [FU/TU]."""
    return read_scene({
        "title": "nine pairs under heat",
        "bodies": {
            "particles": "auto", "spacing": APART, "profile": {"kind": "flat_punch", "radius": 0.5 * PAIRS * APART},
            "bulk_stiffness": STIFFNESS, "reduction": "geike_popov", "mass": 0.02,
        },
        "interaction": law_table(*LAW),
        "damping": {"coefficient": DRAG},
        "noise": {"temperature": TEMPERATURE, "seed": 1},
        "plate": {"mass": 0.1},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "pull_off", "preload": 0.1, "loading_rate": rate, "repeats": repeats},
    })  # fmt: skip


def run_name(rate: float) -> str:
    """Of a run of this study."""
    return f"detachment_{rate:g}"


def scenes(_: Scene) -> Scenes:
    """Pulls at every rate."""
    return {run_name(rate): scene(rate) for rate in RATES}


@cache
def free_energy(temperature: float = TEMPERATURE) -> tuple[Array, Array]:
    """Displacements d [LU] and A(d) [FU·LU] of all pairs."""
    law = interaction.PairInteraction.of(*LAW)
    d = np.linspace(FARTHEST, DEEPEST, PLACES)
    pairs = boltzmann_pairs.BoltzmannPairs(law, STIFFNESS, np.zeros(1), temperature)
    return d, -temperature * PAIRS * pairs.log_partition(law.force_free_distance() - d)


def largest() -> tuple[float, float]:
    """The largest tension F_A(T) [FU] and |F″| there [FU/LU²]."""
    d, energy = free_energy()
    tension = -np.gradient(energy, d)
    top = int(tension.argmax())
    return float(tension[top]), abs(np.gradient(np.gradient(tension, d), d)[top])


@cache
def barrier() -> float:
    """d [LU] at which the pairs have detached."""
    d, energy = free_energy(COLD)
    tension = -np.gradient(energy, d)
    top = int(tension.argmax())
    return float(d[:top][tension[:top] < LET_GO * tension[top]][-1])


@cache
def expected(rate: float) -> tuple[float, float]:
    """Mean and standard deviation [FU] by Smoluchowski's equation."""
    d, energy = free_energy()
    drag = detachment.drag_of_pairs(d, energy, PAIRS, STIFFNESS, DRAG)
    return detachment.detachment_in_time(d, energy, drag, TEMPERATURE, rate, barrier())


def by_garg(rate: float) -> float:
    """Of his closed form [FU], with F_A at this temperature; NaN where it has none."""
    strongest, bend = largest()
    return detachment.garg(strongest, bend, PAIRS * DRAG, TEMPERATURE, rate)


def judge(bench: Bench) -> Findings:
    """Means and spreads within their errors, and all means together."""
    row = Rows(bench.runs, {"lagging": "the reference has the same drag"})
    means, spreads = [_mean(row, rate) for rate in RATES], [_spread(row, rate) for rate in RATES]
    ratio = float(np.mean([(one.value / one.reference.value) ** 2 for one in spreads])) ** 0.5
    width = row("spread of the detachment force over that of the equation, rms of all rates", ratio,
                solver(1.0, "Smoluchowski's equation"),
                absolute(SIGMAS * SPREAD_ERROR / math.sqrt(len(RATES)), STATISTICS),
                on=[run_name(rate) for rate in RATES])  # fmt: skip
    slow = [rate for rate in RATES if math.isfinite(by_garg(rate))]
    worst = max(abs(by_garg(rate) / expected(rate)[0] - 1.0) for rate in slow)
    rows = [*means, *spreads, together(row, "the means at all rates", means, MOST_RMS), width]
    finding = (
        "Over three decades of the loading rate mean and spread of the detachment force are those of Smoluchowski's "
        f"equation. A slow pull-off detaches below the {number(largest()[0], 3)} FU that are the most that the pairs "
        f"hold at this temperature; a fast one drags on. Garg's closed form, for slow pulls and high barriers, is off "
        f"by {number(100.0 * worst, 2)} % up to {number(max(slow))} FU/TU and has no value beyond."
    )
    return Findings(rows, text=finding)


def _mean(row: Rows, rate: float) -> Row:
    ours, (mean, spread) = found(row.runs[run_name(rate)], "detachment_force"), expected(rate)
    return row(f"mean detachment force, Ḟ = {rate:g} FU/TU, {PULLS} pulls", ours,
               solver(mean, "Smoluchowski's equation"),
               absolute(SIGMAS * spread / math.sqrt(PULLS), STATISTICS), on=run_name(rate),
               wide=BY_CHANCE)  # fmt: skip


def _spread(row: Rows, rate: float) -> Row:
    ours = found(row.runs[run_name(rate)], "detachment_force_spread")
    return row(f"spread of the detachment force, Ḟ = {rate:g} FU/TU", ours,
               solver(expected(rate)[1], "Smoluchowski's equation"),
               relative(SIGMAS * SPREAD_ERROR, STATISTICS), on=run_name(rate), wide=BY_CHANCE)  # fmt: skip


STUDY = Study(
    "detachment",
    "Detachment force under thermal fluctuations over the loading rate",
    "The paper's model has stochastic forces on the particles (Section 3); its adhesion force is found without them. "
    "Under heat a contact detaches at a force that scatters, and that is the larger the faster it is pulled.",
    judge,
    scenes,
)
