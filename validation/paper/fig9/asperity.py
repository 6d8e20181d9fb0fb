"""One particle on a rigid row, beside Prandtl and Tomlinson: over load, velocity and the cantilever's stiffness; flats.

U(x), the energy of the row under the load, is integrated on its own; k = 1/(1/k_c + 1/k_t), κ = max(−U″), η = κ/k.

Flat on flat: of one spacing, N particles; of spacings without a common measure, each particle alone at every phase.
A commensurate chain has the friction of N particles. An incommensurate one is pinned below, and slides freely above,
the stiffness k_t = max(−U″) of its particles' springs, U being that of a particle on springs at the common height.
That height is constant without end; a plate of N particles gives way to each slip, and friction is lower: of 13 by
0.8 % at k_t = 0.03 and 1.3 % at 0.06 FU/LU.
"""

import numpy as np

from validation.doors import Scene, Slide, law_of, settings_for
from validation.figures import Panel, Series
from validation.paper.fig9.reading import (
    CRITICAL,
    FLATS,
    LATTICES,
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
from validation.paper.heat import DRAGGED, friction_row, values_and_errors
from validation.references import incommensurate
from validation.references.flat_chain import FlatChain
from validation.references.prandtl_tomlinson import Corrugation, corrugation, moving_friction, slow_friction
from validation.references.thermal_friction import free_corrugation, thermal_friction
from validation.row import Reference, Row, absolute, claim, relative, solver
from validation.study import Rows

SINUSOID = {1.0: 0.0, 2.0: 0.2015, 5.0: 0.5710}
"""⟨F⟩/F_max of a sinusoid at η, for v → 0."""
ASKED, OF_LARGEST = 1e-2, 5e-3
"""Bounds that were asked for: of ⟨F⟩, of F_max."""
NONE = 5e-3
"""⟨F⟩/F_max that is none."""
VISCOUS = 0.02
"""Of an exponent, from two velocities."""
LIMIT = "terms of the velocity beyond v^{2/3} and v"
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
BY_CHANCE = "terms of the velocity beyond these cancel by chance"
SLOW = 0.05
"""Of ⟨F⟩: the most that its limit may be uncertain by."""
FLAT = EDGE | {
    "tolerance": "a largest friction or a mean that is nearly none: only the mean beside the others is asked for",
    "drag": "the plate is held to the drive's pace by the cantilever, and is to be",
}
PINNED = 2
"""Of the stiffnesses, the softest, whose slow limit is held against the law."""
CHAIN = "as many particles on one plate, at rest at every place: the energy that their slips lose"


def load_of(scene: Scene) -> float:
    """Load on a particle [FU]."""
    assert isinstance(scene.experiment, Slide)
    return scene.experiment.normal_force / (scene.bodies.upper_particles or 1)


def wells_of(scene: Scene) -> Corrugation:
    """U(x) of a particle of the scene under its share of the load."""
    return corrugation(law_of(scene), scene.bodies.spacing, load_of(scene))


def series_stiffness(scene: Scene) -> float:
    """k of one particle, its own spring and the cantilever in series [FU/LU]."""
    assert scene.cantilever is not None
    return 1.0 / (1.0 / scene.cantilever.stiffness + 1.0 / scene.tangential_stiffness)


def mass_and_drag_of(scene: Scene) -> tuple[float, float]:
    """m [MU] and γ [FU·TU/LU] of particle and plate together."""
    motion = settings_for(scene).motion
    return scene.bodies.mass + motion.plate_mass, motion.damping + motion.plate_damping


def load_checks(row: Rows) -> tuple[list[Row], Panel]:
    """The largest friction over the load, beside the largest slope of U."""
    points = slides(PARTICLE)
    loads = [load for (load,) in points.names]
    ours = {load: static(row.runs[name]) for (load,), name in points.names.items()}
    theory = {load: wells_of(points.scenes[load,]).largest_force for load in loads}
    worst = max(loads, key=lambda load: abs(ours[load] / theory[load] - 1.0))
    rise, expected = ((of[0.1] - of[-0.1]) / 0.2 for of in (ours, theory))
    law, bound = "largest slope of the energy of a rigid row", relative(OF_LARGEST, BETWEEN)
    compared = f"worst of {len(loads)} loads from {loads[0]:g} to {loads[-1]:g} FU, at {worst:g} FU"
    checks = [
        row("largest friction of one particle without a load", ours[0.0], Reference(theory[0.0], law), bound,
            unit="FU", on=[points.names[0.0,]]),
        row(f"the same over that of the row, {compared}", ours[worst] / theory[worst], Reference(1.0, law), bound,
            on=points.every, despite=EITHER),
        row("what it rises by with the load, between -0.1 and 0.1 FU", rise, Reference(expected, law), bound,
            on=[points.names[load,] for load in (-0.1, 0.1)], despite=EITHER),
    ]  # fmt: skip
    fine = np.linspace(loads[0], loads[-1], 33)
    line = [corrugation(law_of(points.scenes[0.0,]), 1.0, load).largest_force for load in fine.tolist()]
    panel = Panel(
        "load on the particle (FU)",
        "largest friction (FU)",
        [Series("one particle", loads, list(ours.values()))],
        [Series("largest slope of the row's energy", fine, line)],
        title="one particle on a rigid row",
    )
    return checks, panel


def velocity_checks(row: Rows) -> tuple[list[Row], Panel]:
    """⟨F⟩ of a sinusoid over the velocity, at η = 1, 2, 5."""
    points = slides(VELOCITY)
    checks, off = [], []
    shown, limits = [], list[Series]()
    for (eta, expected), (stiffness, names) in zip(SINUSOID.items(), reversed(points.by(1).items()), strict=True):
        scene = points.scenes[min(names), stiffness]
        wells, mass_and_drag = wells_of(scene), mass_and_drag_of(scene)
        over = {v: mean(row.runs[name]) / wells.largest_force for v, name in names.items()}
        for velocity, value in over.items():
            moving = moving_friction(wells, series_stiffness(scene), *mass_and_drag, velocity, 4, 2, 0.2)
            off.append((value / (moving / wells.largest_force), velocity, eta))
        limit = slow_limit(over, CRITICAL if eta == 1.0 else 2.0 / 3.0)
        bound = absolute(NONE, LIMIT) if expected == 0.0 else relative(ASKED, LIMIT)
        checks.append(
            row(f"⟨F⟩/F_max of a sinusoid at η = {eta:g}, slow limit", limit.value,
                Reference(expected, "Prandtl and Tomlinson"), bound, uncertainty=limit.uncertainty,
                on=list(names.values()), despite=EDGE, wide=BY_CHANCE)
        )  # fmt: skip
        shown.append(Series(f"η = {eta:g}", [v ** (2.0 / 3.0) for v in over], list(over.values())))
        limits.append(Series("" if limits else "theory for v → 0", [0.0], [expected]))
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
    names = points.by(0)
    wells = wells_of(next(iter(points.scenes.values())))
    kappa = wells.steepest
    share = [series_stiffness(points.scenes[k_c, min(of)]) / kappa for k_c, of in names.items()]
    over = [{v: mean(row.runs[name]) for v, name in of.items()} for of in names.values()]
    limits, powers = [slow_limit(one) for one in over], [exponent(one) for one in over]
    on = [list(of.values()) for of in names.values()]
    checks = [
        row(f"⟨F⟩ at k = {share[i]:.2g} max(−U″), slow limit", limits[i],
            Reference(slow_friction(wells, share[i] * kappa),
                      "Prandtl and Tomlinson with the corrugation there is: the energy that a slip loses"),
            relative(ASKED, LIMIT), on=on[i], despite=EDGE)
        for i in (0, 1)
    ] + [
        row("k at which stick-slip ends, over max(−U″): ⟨F⟩ falls as v^{4/5} there", threshold(share, powers),
            Reference(1.0, "Prandtl and Tomlinson: η = 1"), claim("steps of the stiffness", 0.1), on=points.every,
            despite=EDGE, wide=MIDDLE),
        row(f"d ln⟨F⟩/d ln v at k = {share[-1]:.3g} max(−U″)", powers[-1],
            Reference(SLIDES, "nothing slips: ⟨F⟩ is what the drag takes"),
            relative(VISCOUS, "the drag's higher orders in v"), on=on[-1], despite=EDGE,
            wide="the higher orders are small at so stiff a spring"),
    ]  # fmt: skip
    fine = np.linspace(0.15, 2.1, 60)
    line = [slow_friction(wells, k * kappa) / wells.largest_force for k in fine.tolist()]
    slow = [limit.value / wells.largest_force for limit in limits]
    spread = [limit.uncertainty / wells.largest_force for limit in limits]
    over_threshold = "k over the threshold max(−U″)"
    return checks, (
        Panel(over_threshold, r"$\langle F\rangle/F_{max}$ for v → 0", [Series("runs", share, slow, spread)],
              [Series("energy that a slip loses", fine, line)]),
        Panel(over_threshold, r"power of v with which $\langle F\rangle$ falls",
              [Series("runs", share, powers)],
              [Series("at the threshold: 4/5", [0.15, 2.1], [CRITICAL, CRITICAL])], mark=1.0),
    )  # fmt: skip


def smoluchowski(scene: Scene, temperature: float) -> float:
    """⟨F⟩ [FU] of the scene at another kT [FU·LU]."""
    assert scene.cantilever is not None
    wells = free_corrugation(law_of(scene), scene.bodies.spacing, load_of(scene), temperature)
    mass, drag = mass_and_drag_of(scene)
    return thermal_friction(*wells, series_stiffness(scene), drag, temperature, scene.cantilever.velocity, mass)


def temperature_checks(row: Rows) -> tuple[list[Row], Panel]:
    """⟨F⟩ at each temperature, and a line of the equation between them."""
    points = slides(TEMPERATURE)
    temperatures = [kT for (kT,) in points.names]
    scene = points.scenes[temperatures[0],]
    cold = wells_of(scene)
    top = cold.largest_force
    barrier = 2.0 * abs(float(cold.coefficients[0]))
    warm = Rows(row.runs, DRAGGED)
    checks = [
        friction_row(warm, f"⟨F⟩/F_max of one particle, kT = {kT / barrier:.2g} of the barrier", points.names[kT,], top,
                     solver(smoluchowski(scene, kT) / top, "Smoluchowski's equation"))
        for kT in temperatures
    ]  # fmt: skip
    fine = np.linspace(0.6 * temperatures[0], 1.05 * temperatures[-1], 12)
    line = [smoluchowski(scene, kT) / top for kT in fine.tolist()]
    shown = Series("runs", [kT / barrier for kT in temperatures], *values_and_errors(checks))
    none = Series("without heat, for v → 0", [0.0], [slow_friction(cold, series_stiffness(scene)) / top])
    theory = Series("Smoluchowski's equation", fine / barrier, line)
    panel = Panel("kT over the barrier between two hollows", r"$\langle F\rangle/F_{max}$", [shown], [theory, none])
    return checks, panel


def lattice_checks(row: Rows) -> tuple[list[Row], Panel]:
    """The largest friction of a commensurate pair, and both traces."""
    points = slides(LATTICES)
    same, alike = next(iter(points.scenes.values())), points.every[0]
    count, wells = same.bodies.upper_particles or 0, wells_of(same)
    check = row(f"largest friction of a commensurate pair over that of its {count} particles",
                static(row.runs[alike]) / count / wells.largest_force,
                Reference(1.0, "a commensurate chain is so many particles"), relative(OF_LARGEST, BETWEEN),
                on=alike)  # fmt: skip
    traces = [
        Series(words, row.runs[name].friction["drive"], row.runs[name].friction["friction"] / count)
        for name, words in zip(points.every, ("spacings 1 : 1", "spacings 21 : 13"), strict=True)
    ]
    return [check], Panel(
        "way of the drive (LU)", "friction of a particle (FU)", traces, [], lines=True, title="$k_t$ = 0.06 FU/LU"
    )


def flat_checks(row: Rows) -> tuple[list[Row], Panel]:
    """The incommensurate pair over the stiffness of its springs along x."""
    points = slides(FLATS)
    names = points.by(0)
    springs = list(names)
    scene = next(iter(points.scenes.values()))
    count, law, load, normal = scene.bodies.upper_particles or 0, law_of(scene), load_of(scene), scene.bulk_stiffness
    over = {k: {v: mean(row.runs[name]) / count for v, name in of.items()} for k, of in names.items()}
    limits = [slow_limit(each) for each in over.values()]
    theory = [slow_friction(incommensurate.shared_corrugation(law, 1.0, load, normal, k), k) for k in springs]
    below = scene.bodies.particles
    assert isinstance(below, int)
    checks = [
        row(f"⟨F⟩ of a particle of an incommensurate pair, k_t = {k:g} FU/LU, slow limit", limit,
            solver(FlatChain(law, 1.0, count, below, load, normal, k).friction(), CHAIN),
            claim("the power of v that follows v^{2/3}", SLOW), on=list(names[k].values()), despite=FLAT)
        for k, limit in zip(springs[:PINNED], limits, strict=False)
    ]  # fmt: skip
    where = threshold(springs, [exponent(each) for each in over.values()], "FU/LU")
    kappa = incommensurate.threshold(law, 1.0, load, normal)
    checks.append(
        row("k_t at which an incommensurate pair is no longer pinned: ⟨F⟩ falls as v^{4/5} there", where,
            Reference(kappa, "max(−U″) of a particle, all at one height"), claim("steps of the stiffness", 0.1),
            on=points.every, despite=FLAT, wide=MIDDLE)
    )  # fmt: skip
    slowest = min(over[springs[0]])
    shown = [
        Series("v → 0", springs, [limit.value for limit in limits], [limit.uncertainty for limit in limits]),
        Series(f"v = {slowest:g} LU/TU", springs, [each[slowest] for each in over.values()]),
    ]
    panel = Panel(
        "stiffness $k_t$ of a particle's spring (FU/LU)", r"$\langle F\rangle$ of a particle (FU)", shown,
        [Series("theory for v → 0", springs, theory)], mark=kappa, title="spacings 21 : 13",
    )  # fmt: skip
    return checks, panel
