"""One particle on a rigid row, beside Prandtl and Tomlinson: over load, velocity and the cantilever's stiffness.

U(x), the energy of the row under the load, is integrated on its own; k = 1/(1/k_c + 1/k_t), κ = max(−U″), η = κ/k.
"""

from __future__ import annotations

import math

import numpy as np

from validation.doors import Scene, Slide, law_of, settings_for
from validation.figures import Array, Panel, Series
from validation.paper.fig9.reading import (
    CRITICAL,
    PARTICLE,
    SLIDES,
    STIFFNESS,
    TEMPERATURE,
    VELOCITY,
    exponent,
    mean,
    slides,
    slow_limit,
    static,
    threshold,
)
from validation.references.prandtl_tomlinson import Corrugation, corrugation, moving_friction, slow_friction
from validation.references.thermal_friction import free_corrugation, thermal_friction
from validation.row import Reference, Row, absolute, claim, relative, solver
from validation.study import Rows, found

SINUSOID = {1.0: 0.0, 2.0: 0.2015, 5.0: 0.5710}
"""⟨F⟩/F_max of a sinusoid at η, for v → 0."""
ASKED, OF_LARGEST = 1e-2, 5e-3
"""Bounds that were asked for: of ⟨F⟩, of F_max."""
NONE = 5e-3
"""⟨F⟩/F_max that is none."""
VISCOUS = 0.02
"""Of an exponent, from two velocities."""
LIMIT = "what is left of the velocity after v^{2/3} and v"
BETWEEN = "the largest friction lies between two rows of the trace, of which a spacing has 50"
EDGE = {
    "tolerance": "the largest friction between two rows: only the mean is asked for",
    "unknown": "the cantilever's largest force of the first period: only the mean is asked for",
}
EITHER = {
    "tolerance": "the largest friction between two rows, for which the bound allows",
    "drag": "the plate may be held to the drive's pace: it passes every place, and the largest friction is the row's",
}
MIDDLE = "the sweep was laid about the law: it is the middle of the step in which it lies"
BY_CHANCE = "what is left of the velocity cancels by chance"
PRANDTL = "Prandtl and Tomlinson with the corrugation there is: the energy that a slip loses"


def wells_of(scene: Scene) -> Corrugation:
    """U(x) of a particle of the scene under its share of the load."""
    assert isinstance(scene.experiment, Slide)
    load = scene.experiment.normal_force / (scene.bodies.upper_particles or 1)
    return corrugation(law_of(scene), scene.bodies.spacing, load)


def series_stiffness(scene: Scene) -> float:
    """k of one particle, its own spring and the cantilever in series [FU/LU]."""
    assert scene.cantilever is not None
    return 1.0 / (1.0 / scene.cantilever.stiffness + 1.0 / scene.tangential_stiffness)


def load_checks(row: Rows) -> tuple[list[Row], Panel]:
    """The largest friction over the load, beside the largest slope of U."""
    points = slides(PARTICLE)
    loads = [load for (load,) in points.names]
    ours = {load: static(row.runs[name]) for (load,), name in points.names.items()}
    theory = {load: wells_of(points.scenes[load,]).largest_force for load in loads}
    worst = max(loads, key=lambda load: abs(ours[load] / theory[load] - 1.0))
    step = [-0.1, 0.1]
    rise = [(of[step[1]] - of[step[0]]) / (step[1] - step[0]) for of in (ours, theory)]
    law = "largest slope of the energy of a rigid row"
    checks = [
        row(
            "largest friction of one particle without a load",
            ours[0.0],
            Reference(theory[0.0], law),
            relative(OF_LARGEST, BETWEEN),
            unit="FU",
            on=[points.names[0.0,]],
        ),
        row(
            f"the same over that of the row, worst of {len(loads)} loads from {loads[0]:g} to {loads[-1]:g} FU, at "
            f"{worst:g} FU",
            ours[worst] / theory[worst],
            Reference(1.0, law),
            relative(OF_LARGEST, BETWEEN),
            on=points.every,
            despite=EITHER,
        ),
        row(
            "what it rises by with the load, between -0.1 and 0.1 FU",
            rise[0],
            Reference(rise[1], law),
            relative(OF_LARGEST, BETWEEN),
            on=[points.names[load,] for load in step],
            despite=EITHER,
        ),
    ]
    fine = np.linspace(loads[0], loads[-1], 33)
    line = [corrugation(law_of(points.scenes[0.0,]), 1.0, load).largest_force for load in fine.tolist()]
    panel = Panel(
        "load on the particle (FU)",
        "largest friction (FU)",
        [Series("one particle", np.asarray(loads), np.asarray([ours[load] for load in loads]))],
        [Series("largest slope of the row's energy", fine, np.asarray(line))],
        title="one particle on a rigid row",
    )
    return checks, panel


def velocity_checks(row: Rows) -> tuple[list[Row], Panel]:
    """⟨F⟩ of a sinusoid over the velocity, at η = 1, 2, 5."""
    points = slides(VELOCITY)
    velocities = sorted({velocity for velocity, _ in points.names})
    cantilevers = sorted({stiffness for _, stiffness in points.names}, reverse=True)
    checks, off = [], []
    shown: list[Series] = []
    limits: list[Series] = []
    for (eta, expected), stiffness in zip(SINUSOID.items(), cantilevers, strict=True):
        scene = points.scenes[velocities[0], stiffness]
        wells, settings = wells_of(scene), settings_for(scene)
        inertia, drag = (
            scene.bodies.mass + settings.motion.plate_mass,
            settings.motion.damping + settings.motion.plate_damping,
        )
        names = [points.names[velocity, stiffness] for velocity in velocities]
        over = {v: mean(row.runs[name]) / wells.largest_force for v, name in zip(velocities, names, strict=True)}
        for velocity, value in over.items():
            moving = moving_friction(wells, series_stiffness(scene), inertia, drag, velocity, 4, 2, 0.2)
            off.append((value / (moving / wells.largest_force), velocity, eta))
        limit = slow_limit(over, CRITICAL if eta == 1.0 else 2.0 / 3.0)
        bound = absolute(NONE, LIMIT) if expected == 0.0 else relative(ASKED, LIMIT)
        checks.append(
            row(f"⟨F⟩/F_max of a sinusoid at η = {eta:g}, slow limit", limit.value,
                Reference(expected, "Prandtl and Tomlinson"), bound, uncertainty=limit.uncertainty, on=names,
                despite=EDGE, wide=BY_CHANCE)
        )  # fmt: skip
        power = np.asarray(velocities) ** (2.0 / 3.0)
        shown.append(Series(f"η = {eta:g}", power, np.asarray(list(over.values()))))
        limits.append(Series("" if limits else "theory for v → 0", np.zeros(1), np.asarray([expected])))
    worst, velocity, eta = max(off, key=lambda one: abs(one[0] - 1.0))
    checks.append(
        row(
            f"⟨F⟩ over that of the equation of motion at the same velocity, worst of {len(off)}, at η = {eta:g} and "
            f"{velocity:g} LU/TU",
            worst,
            solver(1.0, "equation of motion of one particle over the corrugation"),
            relative(ASKED, "particle and plate are two masses, the equation has one"),
            on=points.every,
            despite=EDGE,
        )
    )
    panel = Panel("velocity to the power 2/3 (LU/TU)$^{2/3}$", r"$\langle F\rangle/F_{max}$", shown, limits)
    return checks, panel


def stiffness_checks(row: Rows) -> tuple[list[Row], tuple[Panel, Panel]]:
    """From stick-slip to smooth sliding: slow limits, how ⟨F⟩ falls with v, and the threshold."""
    points = slides(STIFFNESS)
    cantilevers = sorted({stiffness for stiffness, _ in points.names})
    names = {k_c: [name for (stiffness, _), name in points.names.items() if stiffness == k_c] for k_c in cantilevers}
    wells = wells_of(next(iter(points.scenes.values())))
    kappa = wells.steepest
    share, limits, powers = [], [], []
    for k_c in cantilevers:
        over = {v: mean(row.runs[name]) for (stiffness, v), name in points.names.items() if stiffness == k_c}
        scene = next(scene for (stiffness, _), scene in points.scenes.items() if stiffness == k_c)
        share.append(series_stiffness(scene) / kappa)
        limits.append(slow_limit(over))
        powers.append(exponent(over))
    checks = []
    for i in (0, 1):
        checks.append(
            row(f"⟨F⟩ at k = {share[i]:.2g} max(−U″), slow limit", limits[i],
                Reference(slow_friction(wells, share[i] * kappa), PRANDTL), relative(ASKED, LIMIT),
                on=names[cantilevers[i]], despite=EDGE)
        )  # fmt: skip
    where = threshold(share, powers)
    checks += [
        row("k at which stick-slip ends, over max(−U″): ⟨F⟩ falls as v^{4/5} there", where,
            Reference(1.0, "Prandtl and Tomlinson: η = 1"), claim("steps of the stiffness", 0.1), on=points.every,
            despite=EDGE, wide=MIDDLE),
        row(f"d ln⟨F⟩/d ln v at k = {share[-1]:.3g} max(−U″)", powers[-1],
            Reference(SLIDES, "nothing slips: ⟨F⟩ is what the drag takes"),
            relative(VISCOUS, "the drag's higher orders in v"), on=names[cantilevers[-1]], despite=EDGE,
            wide="the higher orders are small at so stiff a spring"),
    ]  # fmt: skip
    fine = np.linspace(0.15, 2.1, 60)
    line = np.asarray([slow_friction(wells, k * kappa) for k in fine.tolist()]) / wells.largest_force
    place: Array = np.asarray(share)
    slow = np.asarray([limit.value for limit in limits]) / wells.largest_force
    spread = np.asarray([limit.uncertainty for limit in limits]) / wells.largest_force
    over_threshold = "k over the threshold max(−U″)"
    return checks, (
        Panel(over_threshold, r"$\langle F\rangle/F_{max}$ for v → 0", [Series("runs", place, slow, spread)],
              [Series("energy that a slip loses", fine, line)]),
        Panel(over_threshold, r"power of v with which $\langle F\rangle$ falls",
              [Series("runs", place, np.asarray(powers))],
              [Series("at the threshold: 4/5", np.asarray([0.15, 2.1]), np.full(2, CRITICAL))], mark=1.0),
    )  # fmt: skip


SIGMAS, INTERVAL = 4.0, 1.96
"""Standard errors that a row allows; half-width of a run's interval of 95 % over its standard error."""
DRAGGED = {
    "drag": "the reference has the same drag, against what moves with the drive",
    "energy": "the mean friction is asked for, not the balance of energies",
}


def smoluchowski(scene: Scene, temperature: float) -> float:
    """⟨F⟩ [FU] of the scene at another kT [FU·LU]."""
    settings = settings_for(scene)
    assert scene.cantilever is not None
    assert isinstance(scene.experiment, Slide)
    wells = free_corrugation(law_of(scene), scene.bodies.spacing, scene.experiment.normal_force, temperature)
    drag, mass = settings.motion.damping + settings.motion.plate_damping, scene.bodies.mass + settings.motion.plate_mass
    return thermal_friction(*wells, series_stiffness(scene), drag, temperature, scene.cantilever.velocity, mass)


def temperature_checks(row: Rows) -> tuple[list[Row], Panel]:
    """⟨F⟩ at each temperature, and a line of the equation between them."""
    points = slides(TEMPERATURE)
    temperatures = [kT for (kT,) in points.names]
    scene = points.scenes[temperatures[0],]
    cold = wells_of(scene)
    top = cold.largest_force
    barrier = 2.0 * abs(float(cold.coefficients[0]))
    checks = []
    for kT in temperatures:
        ours = found(row.runs[points.names[kT,]], "mean_friction")
        sigma = ours.uncertainty / INTERVAL / top
        checks.append(
            row(
                f"⟨F⟩/F_max of one particle, kT = {kT / barrier:.2g} of the barrier",
                ours.value / top,
                solver(smoluchowski(scene, kT) / top, "Smoluchowski's equation"),
                absolute(
                    SIGMAS * sigma if math.isfinite(sigma) else 0.0, "statistics: four standard errors of the run"
                ),
                uncertainty=ours.uncertainty / top,
                on=[points.names[kT,]],
                despite=DRAGGED,
                wide="four standard errors, and by chance it is near",
            )
        )
    fine = np.linspace(0.6 * temperatures[0], 1.05 * temperatures[-1], 12)
    line = np.asarray([smoluchowski(scene, kT) for kT in fine.tolist()]) / top
    means = [found(row.runs[name], "mean_friction") for name in points.every]
    shown = Series(
        "runs",
        np.asarray(temperatures) / barrier,
        np.asarray([one.value for one in means]) / top,
        np.asarray([one.uncertainty for one in means]) / top,
    )
    none = Series(
        "without heat, for v → 0", np.zeros(1), np.asarray([slow_friction(cold, series_stiffness(scene)) / top])
    )
    theory = Series("Smoluchowski's equation", fine / barrier, line)
    panel = Panel("kT over the barrier between two hollows", r"$\langle F\rangle/F_{max}$", [shown], [theory, none])
    return checks, panel
