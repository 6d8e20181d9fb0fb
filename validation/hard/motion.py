"""Motion in time: velocity Verlet up to and past its limit ωΔt = 2, and energy without damping over many steps.

Of a linear oscillator from rest x_n = A cos(nΩ), cos Ω = 1 − (ωΔt)²/2, exactly; past ωΔt = 2 x_n = (−1)ⁿ A cosh(nκ),
cosh κ = (ωΔt)²/2 − 1. Of any smooth system the energy swings by a constant times Δt² and does not drift.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigvals_banded

from validation.doors import EngineError, Session, contact_of, read_scene, settings_for
from validation.hard.cases import BODIES, PAPER_LAW, PAPER_NUMBERS
from validation.references.energy import EnergySurface
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.solver import ChainSolver
from validation.row import Reference, Row, absolute, at_most, so
from validation.study import Bench, Findings, Study

SHARES = (0.1, 0.5, 0.9, 0.99, 0.999)
BEYOND = 1.01
STEPS = 1000
EXACT = 1e-10
"""Of the amplitude after 1000 steps: round-off that the recursion makes 1000 times larger, more near the limit."""
APART, AMPLITUDE = 30.0, 0.1
"""[LU]"""
TIME_STEPS = (0.08, 0.04, 0.02)
"""Of the runs without damping [TU]; ω_max is about 2."""
ORDER = 0.1
"""Of the order 2: the next term in Δt is the fourth power."""
LOOKS = 400
TIMED: dict[str, Any] = {"damping": {"coefficient": 0.5}, "interaction": PAPER_LAW, "bodies": BODIES}
PATH: dict[str, Any] = {"experiment": {"kind": "path", "method": "dynamic", "displacements": [0.05]}}
LOADED: dict[str, Any] = {"plate": {}, "experiment": {"kind": "load", "force": 1.0}}


def measure(bench: Bench) -> Findings:
    """Oscillators, energy, and the program's own time step against the stiffest motion of the independent solver."""
    swings, drift = _energies(bench)
    fitted = float(np.polyfit(np.log(TIME_STEPS), np.log(swings), 1)[0])
    source, verlet = "velocity Verlet is symplectic: no drift", Reference(2.0, "velocity Verlet")
    words = f"drift of the energy over its swing, {_many(bench):g} steps without damping"
    return Findings([
        *(_oscillator(bench.folder, share) for share in SHARES), *_beyond(bench.folder),
        Row("order of the swing of the energy in Δt, no damping", fitted, verlet, absolute(ORDER, "next order")),
        at_most(words, drift, 1.0, source, "sampling of the swing"),
        *(_time_step(k, words) for k, words in ((0.0, ""), (83.0, ", neighbours 100 k"))),
    ])  # fmt: skip


def _many(bench: Bench) -> int:
    return 10**6 if bench.full else 10**5


def _swung(session: Session) -> NDArray[np.float64]:
    """Displace free particles by AMPLITUDE, far from the other body; where those of one body begin to swing [LU]."""
    session.execute(
        f"unfix damping_viscous\ndisplace_atoms upper_body move 0 0 {APART} units box\nrun 0\n"
        f"displace_atoms particles move 0 0 {AMPLITUDE} units box\n",
        phase="swinging",
    )
    return _heights(session)


def _heights(session: Session) -> NDArray[np.float64]:
    return session.atoms("x")["x"][:24, 2]


def _oscillator(folder: Path, share: float) -> Row:
    omega = math.sqrt(0.83)
    step = 2.0 * share / omega
    with contact_of(TIMED | PATH, folder / f"verlet_{share:g}", time_step=step) as contact:
        session = contact.session
        start = _swung(session)
        session.execute(f"run {STEPS}\n")
        moved = _heights(session) - start + AMPLITUDE
    angle = math.acos(1.0 - 0.5 * (2.0 * share) ** 2)
    off = float(np.max(np.abs(moved / AMPLITUDE - math.cos(STEPS * angle))))
    return at_most(
        f"place over the amplitude off after {STEPS} steps, ωΔt = {2 * share:g}",
        off,
        EXACT,
        "x_n = A cos(nΩ), cos Ω = 1 − (ωΔt)²/2",
        "round-off",
    )


def _beyond(folder: Path) -> list[Row]:
    """Past the limit: it grows as it must, and a run that goes on ends in one sentence."""
    step, few = 2.0 * BEYOND / math.sqrt(0.83), 10
    words, moved = "", math.nan
    try:
        with contact_of(TIMED | PATH, folder / "verlet_beyond", time_step=step) as contact:
            session = contact.session
            start = _swung(session)
            session.execute(f"run {few}\n")
            moved = float((_heights(session) - start + AMPLITUDE)[0])
            session.execute("run 5000\n")
    except EngineError as error:
        words = str(error)
    growth = math.acosh(0.5 * (2.0 * BEYOND) ** 2 - 1.0)
    off = abs(moved / AMPLITUDE / math.cosh(few * growth) - 1.0)
    return [
        at_most(
            f"growth off after {few} steps, ωΔt = {2 * BEYOND:g}", off, EXACT, "x_n = (−1)ⁿ A cosh(nκ)", "round-off"
        ),
        so(
            f"a run at ωΔt = {2 * BEYOND:g} that ends otherwise than in a sentence",
            not words or "\n" in words or "Traceback" in words,
            "no number from what flies apart",
        ),
    ]


def _energies(bench: Bench) -> tuple[list[float], float]:
    """Swing of the energy at each time step, over the same time; and how far its mean drifts over many steps."""
    swings = []
    for step in TIME_STEPS:
        energy = _energy(bench.folder / f"energy_{step:g}", step, round(160.0 / step), LOOKS)
        swings.append(float(np.std(energy)))
    energy = _energy(bench.folder / "energy_long", TIME_STEPS[1], _many(bench), 10 * LOOKS)
    tenth = energy.size // 10
    return swings, abs(float(np.mean(energy[-tenth:]) - np.mean(energy[:tenth]))) / float(np.std(energy[:tenth]))


def _energy(folder: Path, step: float, steps: int, looks: int) -> Any:
    tables = TIMED | PATH | {"neighbours": {"stiffness": 0.3}}
    with contact_of(tables, folder, time_step=step) as contact:
        session = contact.session
        session.execute(
            "thermo_style custom step pe ke\nthermo_modify norm no\nunfix damping_viscous\n"
            "displace_atoms upper_body move 0 0 -0.05 units box\n",
            phase="swinging",
        )
        energy = []
        stride = max(1, steps // looks)
        for _ in range(looks):
            energy.append(sum(session.measure(f"run {stride} post no\n", ("pe", "ke")).values))
    return np.array(energy)


def _time_step(neighbours: float, words: str) -> Row:
    """ωΔt/2 of the time step that the program chooses, ω from the solver's Hessian under the load."""
    more = {"neighbours": {"stiffness": neighbours}} if neighbours else {}
    step = settings_for(read_scene({"title": "time step"} | TIMED | LOADED | more)).motion.time_step
    model = ChainModel(12, 0.83, PairInteraction.of(*PAPER_NUMBERS), radius=40.0, neighbour_stiffness=neighbours)
    solver = ChainSolver(model)
    state, d = solver.equilibrium(0.0), 0.0
    while state.force < LOADED["experiment"]["force"] and d < 1.0:
        d += 0.01
        state = solver.equilibrium(d, state)
    band = EnergySurface(model).hessian(np.stack([state.lower[:, 1], state.upper[:, 1]], axis=1).ravel(), d)
    omega = math.sqrt(float(eigvals_banded(band, lower=True)[-1]))
    return at_most(f"ωΔt/2 of the chosen time step under load{words}", 0.5 * omega * step, 1.0,
                   "largest eigenvalue of the solver's Hessian", evidence="independent solver")  # fmt: skip


MOTION = Study(
    "motion",
    "Timesteps from 0.1 to 1.01 of Verlet's stability limit, and energy without damping",
    "A timestep that is too long heats the particles, just below the limit by a small amount; a damping that remains "
    "active, or a force that is not the gradient of an energy, makes the energy drift. Are motion and energy the "
    "exact ones?",
    measure,
)
