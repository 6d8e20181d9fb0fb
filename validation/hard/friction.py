"""Friction and adhesion on the rigid plane: no friction and endless friction, no way, no load, edges, few particles.

A chain on a plane is a row of springs of its own, so that every number has an exact sum beside it: springs whose ends
slide, s_i <- clip(s_i + k_t du, ±μ f_i), particle by particle in plain numbers (`references.spring_sliders`).
Mindlin's and JKR's contacts judge the claims of random scenes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard.random_plane import FRICTION as RANDOM
from validation.hard.random_plane import random_rows
from validation.hard.units import Scene, Units
from validation.references.indenters import jkr
from validation.references.spring_sliders import SpringSliders
from validation.row import Row, at_most, so, worst
from validation.study import Bench, Findings, Refused, Study, found, said

RADIUS, NORMAL, TANGENTIAL, MU, DEPTH = 1000.0, 1.0, 0.8, 0.3, 0.9
"""Of the body [LU], of its springs [FU/LU], μ, and the displacement [LU] of a contact of 60 particles."""
WAY = 0.5
"""Way along x [LU] after which all slips: μ k_n d/k_t is a third of it."""
EXACT, EQUAL = 1e-10, 1e-8
"""Error over μF_N that round-off leaves in a history of some rows: a particle's limit is a difference of distances from
far below, 1e-13 of it; of scaled scenes, whose numbers are rounded anew."""
CYCLES, FULL_CYCLES = 50, 200
SCALES = (1e-9, 1e-3, 1e6, 1e9)
FEW = (1, 2, 3, 4, 5)
SUM, ENERGY = "springs that slide, particle by particle", 0.01
"""W [FU/LU] of the adhesive cases."""
BODIES: Scene = {
    "particles": "auto", "spacing": 1.0, "reduction": "mdr", "lower": "rigid_plane",
    "profile": {"kind": "parabola", "radius": RADIUS}, "bulk_stiffness": NORMAL,
}  # fmt: skip


def scaled(length: float, energy: float) -> Units:
    """Lengths × s, energies × e."""
    return Units(length, energy / length**3, scaled=True)


AS_IT_IS = scaled(1.0, 1.0)


@dataclass(frozen=True)
class Way:
    """Stops (displacement, place) [LU] after a first one at `displacement` of the first, place 0."""

    name: str
    stops: Sequence[tuple[float, float]]
    friction: float = MU
    units: Units = AS_IT_IS

    def scene(self) -> Scene:
        """In its units."""
        d, u = ([float(one[i]) for one in self.stops] for i in (0, 1))
        bodies = BODIES | {"bulk_stiffness_tangential": TANGENTIAL}
        experiment = {"kind": "tangential", "normal_displacement": d, "displacements": u}
        return self.units.written(
            {"bodies": bodies, "friction": {"coefficient": self.friction}, "experiment": experiment}
        )

    def off(self, run: Run | Refused) -> float:
        """The largest error of F_x over all rows and of the dissipated energy, over μF_N and μF_N times the way."""
        if isinstance(run, Refused) or run.friction is None:
            return math.nan
        length, force, energy = (self.units.sizes[unit] for unit in ("LU", "FU", "FU·LU"))
        x = run.profiles["final"].x / length
        chain = SpringSliders((x**2 / RADIUS).tolist(), NORMAL, TANGENTIAL, self.friction)
        chain.move(self.stops[0][0], 0.0)
        forces, strongest = [], chain.normal_force
        for stop in self.stops:
            chain.move(*stop)
            forces.append(chain.tangential_force)
            strongest = max(strongest, chain.normal_force)
        unit = min(self.friction * strongest, TANGENTIAL * WAY * len(x)) or 1.0
        errors = np.abs(np.asarray(run.friction["tangential_force"]) / force - forces) / unit
        # The curve's own number: the result of 1 to 3 particles is not reported where it is too uncertain.
        lost = abs(float(run.friction["dissipated_energy"][-1]) / energy - chain.dissipated) / (unit * WAY)
        return worst([float(errors.max()), lost])


def ways(full: bool) -> Iterator[Way]:
    """The hard ways."""
    cycles = FULL_CYCLES if full else CYCLES
    edge, slipping = 10.5**2 / RADIUS, MU / TANGENTIAL * (10.5**2 - 5.5**2) / RADIUS
    yield Way("μ = 0", [(DEPTH, u) for u in (0.1, -0.3, WAY)], 0.0)
    yield Way("μ = 1e6", [(DEPTH, u) for u in (0.1, -0.3, 0.2)], 1e6)
    named = {
        "no way at all, u = 0": [(DEPTH, 0.0), (DEPTH, 0.0)],
        "the load is taken away while all sticks": [(DEPTH, 0.05), (0.0, 0.05), (0.0, 0.1), (DEPTH, 0.1)],
        "lifted off and put down again": [(DEPTH, 0.2), (-0.5, 0.2), (-0.5, WAY), (DEPTH, WAY), (DEPTH, 0.6)],
        "the contact grows under a tangential load": [(0.3, 0.05), (0.6, 0.1), (DEPTH, 0.15), (DEPTH, 0.3)],
        "the contact grows from the first touch": [(0.0, 0.0), (DEPTH, 0.4 * DEPTH)],
        "the contact shrinks while it slips": [(DEPTH, 0.2), (0.5, 0.35), (0.2, 0.1)],
        f"{cycles} cycles there and back": [(DEPTH, u) for u in (0.15, -0.15) * cycles],
    }
    for nudge in (-1e-12, -1e-15, 0.0, 1e-15, 1e-12):
        stops = [(edge + nudge, slipping + nudge), (edge + nudge, 0.5 * slipping), (edge + nudge, slipping + nudge)]
        named[f"a particle on both edges, {nudge:+g} LU"] = stops
    for count in FEW:
        deep = (0.5 * count + 0.25) ** 2 / RADIUS
        u = MU / TANGENTIAL * deep
        named[f"{count} or {count + 1} particles in contact"] = [(deep, 0.3 * u), (deep, 0.9 * u), (deep, -1.5 * u)]
    yield from (Way(name, stops) for name, stops in named.items())
    for factor in SCALES if full else SCALES[::3]:
        for what, units in (("lengths", scaled(factor, 1.0)), ("energies", scaled(1.0, factor))):
            yield Way(f"{what} × {factor:g}", [(DEPTH, u) for u in (0.1, -0.2, 0.3)], units=units)


def adhesive(work: float = ENERGY, **bodies: Any) -> Scene:
    """A pull-off of the same body."""
    pull = {"kind": "pull_off", "preload": float(jkr(RADIUS, NORMAL, ENERGY).pull_off_force())}
    return {"bodies": BODIES | bodies, "adhesion": {"work_of_adhesion": work}, "experiment": pull}


def refusals() -> dict[str, Scene]:
    """What has no answer, to be said before anything runs."""
    base = Way("refused", [(DEPTH, 0.1)]).scene()
    circle = adhesive(1e6, profile={"kind": "circle", "radius": RADIUS})
    return {
        "a plate without damping, in a tangential": base | {"plate": {"damping": 0.0}},
        "a tangential without [friction]": {name: table for name, table in base.items() if name != "friction"},
        "[friction] and [adhesion] in one tangential": base | {"adhesion": {"work_of_adhesion": ENERGY}},
        "[friction] between two chains": base | {"bodies": base["bodies"] | {"lower": "particles"}},
        "W so large that the contact spans the body": circle | {"experiment": {"kind": "pull_off", "preload": 1.0}},
    }


def measure(bench: Bench) -> Findings:
    """Rows for each way, refusals, adhesion, and the claims of random scenes."""
    rows: list[Row] = []
    for number, way in enumerate(ways(bench.full)):
        run = bench.run(f"way_{number}", way.scene())
        bound = EXACT if way.units == AS_IT_IS else EQUAL
        limit = said("round-off of a history", run)
        rows.append(at_most(f"{way.name}: F_x and work off, over μF_N", way.off(run), bound, SUM, limit))
    for number, (name, scene) in enumerate(refusals().items()):
        answer = bench.run(f"refused_{number}", scene)
        silent = not (isinstance(answer, Refused) and answer.before)
        rows.append(so(f"{name}: not refused before it ran", silent, "–", said("a number where there is none", answer)))
    return Findings([*rows, *_adhesive(bench), *random_rows(bench, RANDOM, "Galin, Mindlin, Maugis and Barquins")])


def _adhesive(bench: Bench) -> Iterator[Row]:
    """W = 0 is Hertz's sum; with energies scaled F_A is JKR's as nearly as it is without."""
    path = {"kind": "path", "displacements": [-0.1, 0.0, 0.1, DEPTH, 0.2, -0.1]}
    run, off = bench.run("no_energy", adhesive(0.0) | {"experiment": path}), math.nan
    if not isinstance(run, Refused):
        x, curve = run.profiles["final"].x, run.curve
        exact = [NORMAL * float(np.sum(np.maximum(0.0, d - x**2 / RADIUS))) for d in curve.displacement]
        off = float(np.abs(np.asarray(curve.force) - exact).max() / max(exact))
    limit = said("round-off", run)
    yield at_most("W = 0: F(d) off, over the largest", off, EXACT, "the sum over particles", limit)
    base = bench.run("energies_1", adhesive())
    for factor in SCALES:
        other, off = bench.run(f"energies_{factor:g}", scaled(1.0, factor).written(adhesive())), math.nan
        if not isinstance(other, Refused) and not isinstance(base, Refused):
            off = abs(found(other, "adhesion_force").value / factor / found(base, "adhesion_force").value - 1.0)
        yield at_most(f"F_A/e off, energies × {factor:g}", off, EQUAL, "the same, not scaled", said("rounding", other))


FRICTION = Study(
    "friction",
    "Friction and adhesion on the rigid plane",
    "The loading history matters where a load is removed and reapplied, over many cycles, and where a particle is at "
    "the contact edge; the contact edge of an adhesive contact of few particles moves in steps. Are the forces those "
    "of Jenkins elements (springs with sliders), and the results within their uncertainties of closed forms?",
    measure,
)
