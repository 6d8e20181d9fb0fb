"""Thermal averages: equipartition of every mode and of the plate, a load against Boltzmann's integral, and seeds.

A chain of N free ends has the modes φ_q(i) ∝ cos(πq(i + ½)/N) of stiffness κ_q = k + 4 k_n sin²(πq/2N), and each the
variance kT/κ_q; the plate has ⟨V²⟩ = kT/M.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from scipy.stats import chi2

from contact1d.analysis.reference.boltzmann_pairs import BoltzmannPairs
from contact1d.analysis.reference.folded_pairs import FoldedPairs
from contact1d.analysis.reference.interaction import Exponential, Floats, PairInteraction
from contact1d.workflow.reproduce.check import Check
from contact1d.workflow.reproduce.figures import Series
from contact1d.workflow.reproduce.runs import Finished
from contact1d.workflow.stability.case import Bench, Class, Findings, Refused, at_most, over_claim, warned
from contact1d.workflow.stability.figures import points_figure
from contact1d.workflow.stability.opened import LAW, contact_of

MODES, THERMAL, SEEDS = "modes", "boltzmann", "seeds"
SIGMAS = 4.0
"""Standard errors of the sample: one row in 16 000 fails by chance, and the seeds are fixed."""
CHANCE = 1e-4
"""Of a row that judges a chi-square."""
TEMPERATURE, STIFFNESS, NEIGHBOURS, MASS, DAMPING = 0.01, 0.83, 0.3, 1.0, 1.5
PARTICLES, APART, INTERVAL, BLOCKS = 20, 30.0, 3.0, 20
PLATE_MASS = 5.0
FORGOTTEN = 60
"""First rows of a thermal load, on the way to equilibrium."""
BODIES = {"particles": 41, "spacing": 4.0, "profile": {"kind": "parabola", "radius": 1000.0}, "bulk_stiffness": 0.83}
"""Pull_off.toml's bodies, four times as far apart so that particles feel their opposite only."""
LOAD = 0.25
TEMPERATURES = (1e-4, 1e-3, 3e-3)
LAW_HERE = PairInteraction(*(Exponential(*LAW[term].values()) for term in ("repulsion", "attraction")))
PLACES = (np.arange(41) - 20) * 4.0
HEIGHTS = PLACES**2 / 2000.0
NEAR, WIDTH = 0.24, {1e-4: 0.05, 1e-3: 0.13, 3e-3: 0.22}
"""Interval of displacements of the integral [LU]: eight standard deviations."""


def measure_modes(bench: Bench, folder: Path) -> Findings:
    """Variances of all modes of both chains far apart, and of the plate's velocity under a load."""
    samples = 4000 if bench.full else 800
    moved, velocity = _sampled(bench.folder / "modes", samples, 0.0)
    _, dragged = _sampled(bench.folder / "dragged", samples, "auto")
    q = np.arange(PARTICLES)
    shape = np.cos(np.pi * q[None, :] * (np.arange(PARTICLES)[:, None] + 0.5) / PARTICLES)
    shape /= np.sqrt((shape**2).sum(axis=0))
    stiffness = STIFFNESS + 4.0 * NEIGHBOURS * np.sin(np.pi * q / (2 * PARTICLES)) ** 2
    squares = (moved[:, 0] @ shape) ** 2 * stiffness / TEMPERATURE
    ratio, error = _mean(squares)
    sigmas = np.abs(ratio - 1.0) / error
    off = float(np.sum(((ratio - 1.0) / error) ** 2))
    source, limit = "equipartition: κ_q ⟨q²⟩ = kT", f"statistics: {samples} samples"
    checks = [
        at_most(MODES, f"variance of a mode off over its standard error, worst of {PARTICLES}", float(sigmas.max()),
                SIGMAS, source, limit),
        at_most(MODES, f"χ² of the variances of all {PARTICLES} modes", off, _bound(PARTICLES), source, limit),
    ]  # fmt: skip
    for words, speeds in (("no drag of its own", velocity), ('damping = "auto"', dragged)):
        kinetic, spread = _mean(speeds[:, None] ** 2 * PLATE_MASS / TEMPERATURE)
        checks.append(
            Check(MODES, f"M ⟨V²⟩/kT of the plate, {words}", float(kinetic[0]), SIGMAS * float(spread[0]), "1", 1.0,
                  "equipartition: M ⟨V²⟩ = kT", "closed form", 0.0, limit + ", 4 standard errors", "uncertainty")
        )  # fmt: skip
    exact = Series("kT", stiffness, np.ones(PARTICLES))
    points_figure(folder / f"{MODES}.png", [Series("run", stiffness, ratio)], ("stiffness of the mode", "κ⟨q²⟩/kT"),
                  [exact], log="x")  # fmt: skip
    return Findings(checks, f"{MODES}.png", "Energy of each mode over kT/2")


def _sampled(folder: Path, samples: int, drag: float | str) -> tuple[Floats, Floats]:
    """Moves of the particles (samples, 2, N) [LU] with the bodies far apart, and the plate's velocity [LU/TU]."""
    tables: dict[str, Any] = {
        "bodies": {"particles": PARTICLES, "spacing": 1.0, "profile": {"kind": "parabola", "radius": 1000.0},
                   "bulk_stiffness": STIFFNESS, "mass": MASS},
        "interaction": LAW, "neighbours": {"stiffness": NEIGHBOURS}, "damping": {"coefficient": DAMPING},
        "noise": {"temperature": TEMPERATURE, "seed": 20}, "plate": {"mass": PLATE_MASS, "damping": drag},
        "experiment": {"kind": "load", "method": "dynamic", "force": 0.0},
    }  # fmt: skip
    moved, velocity = [], []
    with contact_of(tables, folder) as contact:
        session = contact.session
        stride = round(INTERVAL / contact.settings.time_step)
        session.execute(f"displace_atoms upper_body move 0 0 {APART} units box\n", phase="sampling")
        start = session.atoms("x")["x"]
        session.execute(f"run {20 * stride} post no\n")
        for _ in range(samples):
            reading = session.measure(f"run {stride} post no\n", ("v_plate_velocity",), ("x",))
            shift = reading.atoms["x"][:, 2] - start[:, 2]
            shift[PARTICLES : 2 * PARTICLES] -= shift[3 * PARTICLES]
            moved.append(shift[: 2 * PARTICLES].reshape(2, PARTICLES))
            velocity.append(reading.values[0])
    return np.array(moved), np.array(velocity)


def _bound(count: int) -> float:
    """χ² of `count` block means, whose own errors are known from BLOCKS blocks only: each is an F-variable."""
    return float(chi2.ppf(1.0 - CHANCE, count)) * (BLOCKS - 1) / (BLOCKS - 3)


def _mean(samples: Floats) -> tuple[Floats, Floats]:
    """Mean and standard error of each column, from blocks."""
    blocks = np.array([block.mean(axis=0) for block in np.array_split(samples, BLOCKS)])
    return samples.mean(axis=0), blocks.std(axis=0, ddof=1) / math.sqrt(BLOCKS)


def thermal_scene(temperature: float, seed: int, tolerance: float = 2e-3) -> dict[str, Any]:
    """A load under noise; without, at temperature 0, the same at rest."""
    scene: dict[str, Any] = {
        "bodies": BODIES, "interaction": LAW, "accuracy": {"tolerance": tolerance},
        "experiment": {"kind": "load", "force": LOAD},
    }  # fmt: skip
    if temperature > 0.0:
        scene |= {"damping": {"coefficient": "auto"}, "noise": {"temperature": temperature, "seed": seed}, "plate": {}}
    return scene


def measure_boltzmann(bench: Bench, folder: Path) -> Findings:
    """⟨d⟩ under a load at three temperatures, and how much of it is thermal."""
    checks: list[Check] = []
    rest = FoldedPairs(LAW_HERE, 0.83, HEIGHTS).deepest(LOAD)
    still = bench.run("rest", thermal_scene(0.0, 0))
    source = "independent pairs"
    value = math.nan if isinstance(still, Refused) else over_claim(still, "displacement", rest)
    checks.append(at_most(THERMAL, "d at kT = 0 off over its claim", value, 1.0, source, "what the run claims"))
    drawn, exacts = [], []
    for temperature in TEMPERATURES:
        exact, swing = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, temperature).displacement(LOAD, NEAR, WIDTH[temperature])
        found = bench.run(f"noise_{temperature:g}", thermal_scene(temperature, 3))
        source, limit = "Boltzmann's integral over distances and plate", "statistics: 4 of the run's standard errors"
        if isinstance(found, Refused):
            checks.append(at_most(THERMAL, f"d at kT = {temperature:g} refused: {found.words}", math.nan, SIGMAS, source, limit))
            continue
        d, error = found.value("displacement"), found.uncertainty("displacement")
        checks.append(at_most(THERMAL, f"d at kT = {temperature:g} off over its claim", abs(d - exact) / error, SIGMAS,
                              source, limit))  # fmt: skip
        if temperature > TEMPERATURES[0]:  # there the mean cannot tell the temperature from 0, and the variance does
            checks.append(Check(THERMAL, f"d(kT = {temperature:g}) − d(0)", d - rest, SIGMAS * error, "LU", exact - rest, source,
                                "closed form", 0.0, limit, "uncertainty"))  # fmt: skip
        checks.append(_swing_row(found, temperature, swing))
        drawn.append((temperature, d))
        exacts.append((temperature, exact))
    x, y = np.array(drawn).T
    points_figure(folder / f"{THERMAL}.png", [Series("run", x, y)], ("kT (FU·LU)", "mean displacement (LU)"),
                  [Series("Boltzmann", *np.array(exacts).T)], log="x")  # fmt: skip
    return Findings(checks, f"{THERMAL}.png", "Mean displacement under a load over the temperature")


def _swing_row(found: Finished, temperature: float, swing: float) -> Check:
    """The variance of d in time: it tells the temperature where the mean does not."""
    sampled = np.asarray(found.curve().displacement)[FORGOTTEN:]
    ratio, error = _mean(((sampled - sampled.mean()) ** 2 / swing**2)[:, None])
    off = float(abs(ratio[0] - 1.0) / error[0])
    return at_most(THERMAL, f"variance of d in time at kT = {temperature:g} off over its standard error", off, SIGMAS,
                   "Boltzmann's integral", f"statistics: {sampled.size} samples, ± {error[0]:.2g}")  # fmt: skip


def measure_seeds(bench: Bench, folder: Path) -> Findings:
    """(d − exact)/claim of each seed: its χ² neither too large nor too small."""
    count, temperature = (24, 1e-4) if bench.full else (6, 1e-4)
    exact, _ = BoltzmannPairs(LAW_HERE, 0.83, HEIGHTS, temperature).displacement(LOAD, NEAR, WIDTH[temperature])
    sigmas, silent = [], 0
    for seed in range(1, count + 1):
        found = bench.run(f"seed_{seed}", thermal_scene(temperature, seed, 5e-3))
        if isinstance(found, Finished):
            sigmas.append((found.value("displacement") - exact) / found.uncertainty("displacement"))
            silent += abs(sigmas[-1]) > SIGMAS and not warned(found)
    square = float(np.sum(np.square(sigmas))) if len(sigmas) == count else math.nan
    source, limit = "Boltzmann's integral; χ² of as many independent seeds", "statistics"
    checks = [
        at_most(SEEDS, f"χ² of {count} seeds by their claims: not too large", square, _bound(count), source, limit),
        at_most(SEEDS, f"least χ² that chance allows over χ² of {count} seeds: claims not too wide",
                float(chi2.ppf(CHANCE, count)) / square, 1.0, source, limit),
        at_most(SEEDS, f"mean of {count} seeds off, in standard errors of it", abs(float(np.mean(sigmas))) * math.sqrt(count),
                SIGMAS, source, limit),
    ]  # fmt: skip
    points_figure(folder / f"{SEEDS}.png", [Series("seeds", np.arange(1, len(sigmas) + 1), np.array(sigmas))],
                  ("seed", "(d − exact)/claim"), log="")  # fmt: skip
    return Findings(checks, f"{SEEDS}.png", "Deviation of each seed over its claim")


CLASSES = (
    Class(MODES, "Equipartition of every mode and of the plate",
          "A thermostat may have the right mean temperature and the wrong share for one mode.", measure_modes),
    Class(THERMAL, "Thermal averages against Boltzmann's integral",
          "A thermal number can be right at 0 and wrong in what the noise adds: the part that is thermal has a row of "
          "its own.", measure_boltzmann),
    Class(SEEDS, "Scatter over seeds against the claim",
          "A standard error that is too small is a wrong number; one that is too large hides one.", measure_seeds),
)  # fmt: skip
