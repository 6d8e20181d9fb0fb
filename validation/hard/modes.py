"""Equipartition of every mode of a chain and of the plate.

A chain of N free ends has the modes φ_q(i) ∝ cos(πq(i + ½)/N) of stiffness κ_q = k + 4 k_n sin²(πq/2N), and each the
variance kT/κ_q; the plate has ⟨V²⟩ = kT/M.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from validation.doors import contact_of
from validation.hard.cases import PAPER_LAW, SIGMAS, block_mean, chi_square_bound
from validation.references.interaction import Floats
from validation.row import Reference, Row, at_most, claim
from validation.study import Bench, Findings, Study

MODES = "modes"
TEMPERATURE, STIFFNESS, NEIGHBOURS, MASS, DAMPING = 0.01, 0.83, 0.3, 1.0, 1.5
PARTICLES, APART, INTERVAL = 20, 30.0, 3.0
PLATE_MASS = 5.0


def measure_modes(bench: Bench) -> Findings:
    """Variances of all modes of both chains far apart, and of the plate's velocity under a load."""
    samples = 4000 if bench.full else 800
    moved, velocity = _sampled(bench.folder / "modes", samples, 0.0)
    _, dragged = _sampled(bench.folder / "dragged", samples, "auto")
    q = np.arange(PARTICLES)
    shape = np.cos(np.pi * q[None, :] * (np.arange(PARTICLES)[:, None] + 0.5) / PARTICLES)
    shape /= np.sqrt((shape**2).sum(axis=0))
    stiffness = STIFFNESS + 4.0 * NEIGHBOURS * np.sin(np.pi * q / (2 * PARTICLES)) ** 2
    squares = (moved[:, 0] @ shape) ** 2 * stiffness / TEMPERATURE
    ratio, error = block_mean(squares)
    sigmas = np.abs(ratio - 1.0) / error
    off = float(np.sum(((ratio - 1.0) / error) ** 2))
    source, limit = "equipartition: κ_q ⟨q²⟩ = kT", f"statistics: {samples} samples"
    name = f"variance of a mode off over its standard error, worst of {PARTICLES}"
    squared = f"χ² of the variances of all {PARTICLES} modes"
    rows = [at_most(name, float(sigmas.max()), SIGMAS, source, limit),
            at_most(squared, off, chi_square_bound(PARTICLES), source, limit)]  # fmt: skip
    for words, speeds in (("no drag of its own", velocity), ('damping = "auto"', dragged)):
        kinetic, spread = block_mean(speeds[:, None] ** 2 * PLATE_MASS / TEMPERATURE)
        exact = Reference(1.0, "equipartition: M ⟨V²⟩ = kT")
        rows.append(Row(f"M ⟨V²⟩/kT of the plate, {words}", float(kinetic[0]), exact,
                        claim(f"{limit}, 4 standard errors"), uncertainty=SIGMAS * float(spread[0])))  # fmt: skip
    return Findings(rows)


def _sampled(folder: Path, samples: int, drag: float | str) -> tuple[Floats, Floats]:
    """Moves of the particles (samples, 2, N) [LU] with the bodies far apart, and the plate's velocity [LU/TU]."""
    tables: dict[str, Any] = {
        "bodies": {
            "particles": PARTICLES,
            "spacing": 1.0,
            "profile": {"kind": "parabola", "radius": 1000.0},
            "bulk_stiffness": STIFFNESS,
            "mass": MASS,
        },
        "interaction": PAPER_LAW,
        "neighbours": {"stiffness": NEIGHBOURS},
        "damping": {"coefficient": DAMPING},
        "noise": {"temperature": TEMPERATURE, "seed": 20},
        "plate": {"mass": PLATE_MASS, "damping": drag},
        "experiment": {"kind": "load", "method": "dynamic", "force": 0.0},
    }
    moved, velocity = [], []
    with contact_of(tables, folder) as contact:
        session = contact.session
        stride = round(INTERVAL / contact.settings.motion.time_step)
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


EQUIPARTITION = Study(
    MODES,
    "Equipartition of every mode and of the plate",
    "A thermostat may have the correct mean temperature and the wrong energy of a single mode. Do all modes and the "
    "plate have the energy of equipartition?",
    measure_modes,
)
