"""Flat on flat: of one spacing, N particles; of spacings without a common measure, each particle alone at every phase.

A commensurate chain has the friction of N particles. An incommensurate one is pinned below, and slides freely above,
the stiffness k_t = max(−U″) of its particles' springs, U being that of a particle on springs at the common height.
That height is constant without end; a plate of N particles gives way to each slip, and friction is lower: of 13 by
0.8 % at k_t = 0.03 and 1.3 % at 0.06 FU/LU.
"""

from __future__ import annotations

from validation.doors import Scene, Slide, law_of
from validation.figures import Panel, Series
from validation.paper.fig9.asperity import BETWEEN, MIDDLE, OF_LARGEST, wells_of
from validation.paper.fig9.reading import FLATS, LATTICES, exponent, mean, slides, slow_limit, static, threshold
from validation.references.flat_chain import FlatChain
from validation.references.incommensurate import shared_corrugation
from validation.references.incommensurate import threshold as law_threshold
from validation.references.prandtl_tomlinson import slow_friction
from validation.row import Reference, Row, claim, relative, solver
from validation.study import Rows

SLOW = 0.05
"""Of ⟨F⟩: the most that its limit may be uncertain by."""
EDGE = {
    "tolerance": "a largest friction or a mean that is nearly none: only the mean beside the others is asked for",
    "drag": "the plate is held to the drive's pace by the cantilever, and is to be",
    "unknown": "the cantilever's largest force of the first period: only the mean is asked for",
}
PINNED = 2
"""Of the stiffnesses, the softest, whose slow limit is held against the law."""
CHAIN = "as many particles on one plate, at rest at every place: the energy that their slips lose"


def load_of(scene: Scene) -> float:
    """Load on a particle [FU]."""
    assert isinstance(scene.experiment, Slide)
    assert scene.bodies.upper_particles is not None
    return scene.experiment.normal_force / scene.bodies.upper_particles


def lattice_checks(row: Rows) -> tuple[list[Row], Panel]:
    """The largest friction of a commensurate pair, and both traces."""
    points = slides(LATTICES)
    same, alike = next(iter(points.scenes.values())), points.every[0]
    count, wells = same.bodies.upper_particles or 0, wells_of(same)
    check = row(f"largest friction of a commensurate pair over that of its {count} particles",
                static(row.runs[alike]) / count / wells.largest_force,
                Reference(1.0, "a commensurate chain is so many particles"), relative(OF_LARGEST, BETWEEN),
                on=[alike])  # fmt: skip
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
    theory = [slow_friction(shared_corrugation(law, 1.0, load, normal, k), k) for k in springs]
    below = scene.bodies.particles
    assert isinstance(below, int)
    checks = [
        row(f"⟨F⟩ of a particle of an incommensurate pair, k_t = {k:g} FU/LU, slow limit", limit,
            solver(FlatChain(law, 1.0, count, below, load, normal, k).friction(), CHAIN),
            claim("the power of v that follows v^{2/3}", SLOW), on=list(names[k].values()), despite=EDGE)
        for k, limit in zip(springs[:PINNED], limits, strict=False)
    ]  # fmt: skip
    where = threshold(springs, [exponent(each) for each in over.values()], "FU/LU")
    kappa = law_threshold(law, 1.0, load, normal)
    checks.append(
        row("k_t at which an incommensurate pair is no longer pinned: ⟨F⟩ falls as v^{4/5} there", where,
            Reference(kappa, "max(−U″) of a particle, all at one height"), claim("steps of the stiffness", 0.1),
            on=points.every, despite=EDGE, wide=MIDDLE)
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
