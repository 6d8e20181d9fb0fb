"""Thermal friction: one particle on a rigid row, pulled by a spring, beside Smoluchowski's equation and an ensemble.

Slow, the overdamped equation holds, by quadrature and finite volumes; fast, inertia and the particle's height matter,
and the reference is an ensemble of the equations of motion. ⟨F⟩(T, v) spans three decades of v.
"""

import math
from collections.abc import Sequence
from functools import cache

import numpy as np

from validation.doors import Scene, law_table, read_scene
from validation.figures import Panel, Series, figure
from validation.page import number
from validation.references.langevin_ensemble import PulledParticle, ensemble_friction
from validation.references.prandtl_tomlinson import corrugation, slow_friction
from validation.references.thermal_friction import free_corrugation, textbook_friction, thermal_friction
from validation.row import Reference, Row, absolute, solver, tables_beside
from validation.study import Bench, Findings, Rows, Scenes, Study, found

LAW, LOAD, SPACING = (2.0, 0.5, 1.0, 1.0), 0.5, 1.0
"""A [FU·LU], a [LU], B [FU·LU], b [LU] of the row; F_N [FU]; s [LU]."""
OWN, MASS, DRAG = 1.0, 0.1, 0.8
"""Springs of the particle [FU/LU], m = M [MU], γ [FU·TU/LU]."""
ETA = 3.0
"""max(−U″) over the spring to the drive: sticks and slips without heat."""
WELLS = corrugation(LAW, SPACING, LOAD)
SPRING = WELLS.steepest / ETA
BARRIER = 2.0 * abs(float(WELLS.coefficients[0]))
"""U from hollow to top [FU·LU], without a pull."""
SHARES = (0.05, 0.15)
"""kT over it."""
DRIVES = {2e-4: 7.0, 2e-3: 20.0, 2e-2: 60.0, 2e-1: 100.0}
"""Velocities [LU/TU] and ways [LU]."""
SLOW = 5e-3
"""Velocity [LU/TU] below which Smoluchowski's equation is the reference: γ v is a tenth of F_max there."""
COPIES, ENSEMBLE_STEP = 200, 0.05
TIMES = 1500.0
"""Time [TU] of each copy of an ensemble."""
SIGMAS, MOST_RMS = 4.0, 1.8
"""Standard errors that a row allows; and of all rows together, of eight by chance once in a thousand times."""
INTERVAL = 1.96
"""Half-width of the intervals of 95 % that a run states, over its standard error."""
BY_CHANCE = "four standard errors, and by chance it is near"
FLAT_PAIR = tables_beside(__file__)
"""Tables of a flat pair that is at rest."""
TEMPERATURE, RATIO = FLAT_PAIR["noise"]["temperature"], 3.0
"""Of it [FU·LU], and the standard errors that its ratio is allowed."""
STATISTICS = "statistics: four standard errors of the run"
AT_REST = {
    "energy": "the plate's temperature is asked for, not the balance of energies",
    "unsteady": "it does not slide",
}
DRAGGED = {
    "drag": "the reference has the same drag, against what moves with the drive",
    "energy": "the mean friction is asked for, not the balance of energies",
}


def body(share: float) -> PulledParticle:
    """The particle at kT of that share of the barrier."""
    cantilever = 1.0 / (1.0 / SPRING - 1.0 / OWN)
    return PulledParticle(LAW, SPACING, LOAD, OWN, cantilever, MASS, MASS, DRAG, share * BARRIER)


def scene(share: float, velocity: float, distance: float, seed: int = 1) -> Scene:
    """The same as a scene."""
    particle = body(share)
    return read_scene({
        "title": "a particle on a row, under heat",
        "bodies": {
            "particles": 32, "upper_particles": 1, "upper_offset": 0.5, "spacing": SPACING, "lower": "rigid_chain",
            "periodic": True, "profile": {"kind": "flat"}, "bulk_stiffness": OWN, "mass": MASS,
        },
        "interaction": law_table(*LAW),
        "horizontal": {},
        "damping": {"coefficient": DRAG},
        "noise": {"temperature": particle.temperature, "seed": seed},
        "plate": {"free": ["x", "z"], "mass": MASS, "damping": 0.0},
        "cantilever": {"stiffness": particle.cantilever, "velocity": velocity},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "slide", "normal_force": LOAD, "distance": distance},
    })  # fmt: skip


def run_name(share: float, velocity: float) -> str:
    """Of a run of this study."""
    return f"heat_T{share:g}_v{velocity:g}"


def scenes(_: Scene) -> Scenes:
    """Two temperatures, four velocities, and a plate at rest."""
    slides = {
        run_name(share, velocity): scene(share, velocity, distance)
        for velocity, distance in DRIVES.items()
        for share in SHARES
    }
    at_rest = {"kind": "slide", "normal_force": 1.6, "path": [[0.0, 20.0]]}
    plate = read_scene({"title": "a plate at rest, under heat"} | FLAT_PAIR | {"experiment": at_rest})
    return slides | {"heat_plate": plate}


@cache
def smoluchowski(share: float, velocity: float) -> float:
    """⟨F⟩ [FU]."""
    particle = body(share)
    wells, heights = _free(share)
    kT, mass = particle.temperature, particle.moving_mass
    return thermal_friction(wells, heights, SPRING, DRAG, kT, velocity, mass)


@cache
def ensemble(share: float, velocity: float) -> tuple[float, float]:
    """⟨F⟩ and its standard error [FU]."""
    periods = 1 + math.ceil(TIMES * velocity / SPACING / 10.0)
    return ensemble_friction(body(share), velocity, COPIES, periods, ENSEMBLE_STEP, seed=1)


_free = cache(lambda share: free_corrugation(LAW, SPACING, LOAD, share * BARRIER))


def expected(share: float, velocity: float) -> tuple[float, float]:
    """⟨F⟩ and its standard error [FU] of the reference that holds at this velocity."""
    return (smoluchowski(share, velocity), 0.0) if velocity < SLOW else ensemble(share, velocity)


def judge(bench: Bench) -> Findings:
    """Every mean within its errors, all of them together, and the temperature of a plate that drag of its own cools."""
    runs = bench.runs
    row = Rows(runs, DRAGGED)
    means = {share: [_friction(row, share, velocity) for velocity in DRIVES] for share in SHARES}
    rows = [mean for share in SHARES for mean in means[share]]
    rows.append(together(row, "all velocities and temperatures", rows, MOST_RMS))
    plate = found(runs["heat_plate"], "plate_temperature")
    sigma = plate.uncertainty / INTERVAL / TEMPERATURE
    rows.append(
        row("temperature of a plate with drag of its own over that of the particles", plate.value / TEMPERATURE,
            Reference(1.0, "equipartition"),
            absolute(RATIO * sigma if math.isfinite(sigma) else 0.0, "statistics: three standard errors"),
            uncertainty=sigma, on="heat_plate", despite=AT_REST)
    )  # fmt: skip
    figures = figure(
        "Mean friction with thermal noise over velocity: runs, references, and the (ln v)^(2/3) law",
        *(_panel(share, means[share]) for share in SHARES),
    )
    slowest = min(DRIVES)
    top = WELLS.largest_force
    laws = [number(_textbook(share, slowest) / top, 2) for share in SHARES]
    finding = (
        "Over three decades of velocity the mean thermal friction of one particle is that of the references: "
        f"Smoluchowski's equation up to {SLOW:g} LU/TU, an ensemble of the equations of motion beyond. Without heat it "
        "would go to one value for slow drives; with it a slow drive waits for fluctuations. The textbook's "
        f"(ln v)^(2/3) is an expansion about a vanishing barrier: at {number(slowest)} LU/TU it gives {laws[0]} of "
        f"F_max at kT = {SHARES[0]:g} of the barrier, and {laws[1]} at {SHARES[1]:g}."
    )
    return Findings(rows, figures, text=finding)


def _friction(row: Rows, share: float, velocity: float) -> Row:
    mean, error = expected(share, velocity)
    source = "Smoluchowski's equation" if velocity < SLOW else f"ensemble of {COPIES} equations of motion"
    return friction_row(
        row,
        f"⟨F⟩/F_max, kT = {share:g} of the barrier, v = {velocity:g} LU/TU",
        run_name(share, velocity),
        WELLS.largest_force,
        solver(mean / WELLS.largest_force, source),
        error,
    )


def friction_row(row: Rows, words: str, name: str, top: float, known: Reference, error: float = 0.0) -> Row:
    """⟨F⟩ over `top` [FU] beside the same of a reference, whose ⟨F⟩ has a standard error [FU]."""
    ours = found(row.runs[name], "mean_friction")
    sigma = math.hypot(ours.uncertainty / INTERVAL, error) / top
    limit = STATISTICS + " and of the reference" * (error > 0.0)
    return row(words, ours.value / top, known, absolute(SIGMAS * sigma if math.isfinite(sigma) else 0.0, limit),
               uncertainty=ours.uncertainty / top, on=name, wide=BY_CHANCE)  # fmt: skip


def together(row: Rows, words: str, rows: Sequence[Row], most: float) -> Row:
    """The rms of the deviations of rows that allow SIGMAS standard errors each."""
    off = [SIGMAS * (one.value - one.reference.value) / one.bound.size for one in rows]
    return row.at_most(f"deviation over standard error, rms of {words}", math.hypot(*off) / len(off) ** 0.5,
                       Reference(most, "chance, 1 in 1000", "set bound"), "statistics",
                       on=[name for one in rows for name in one.runs])  # fmt: skip


def values_and_errors(rows: Sequence[Row]) -> tuple[list[float], list[float]]:
    """For a series of rows."""
    return [one.value for one in rows], [one.uncertainty for one in rows]


def _textbook(share: float, velocity: float) -> float:
    return textbook_friction(WELLS, SPRING, DRAG, share * BARRIER, velocity)


def _panel(share: float, means: Sequence[Row]) -> Panel:
    """⟨F⟩/F_max over v at a temperature: runs, references, the textbook's law."""
    top, drives = WELLS.largest_force, list(DRIVES)
    fine = np.geomspace(drives[0], SLOW, 60)
    law = [_textbook(share, v) / top for v in fine.tolist()]
    points = [Series("runs", drives, *values_and_errors(means)),
              Series("Smoluchowski, then an ensemble", drives, [one.reference.value for one in means])]  # fmt: skip
    return Panel("velocity (LU/TU)", r"mean friction over $F_{max}$", points,
                 [Series("$(\\ln v)^{2/3}$", fine, law)], log="x", bound=slow_friction(WELLS, SPRING) / top,
                 title=f"kT = {share:g} of the barrier", view=(0.0, None))  # fmt: skip


STUDY = Study(
    "heat",
    "Thermal friction of one particle",
    "The paper's model has stochastic forces on the particles and a cantilever that pulls the plate (Section 3), and "
    "gives no result with either. What a single particle does under both is known.",
    judge,
    scenes,
)
