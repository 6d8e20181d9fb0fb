"""Friction and adhesion on the rigid plane: no friction and endless friction, no way, no load, edges, few particles.

A chain on a plane is a row of springs of its own, so that every number has an exact sum beside it: springs whose ends
slide, s_i <- clip(s_i + k_t du, ±μ f_i), particle by particle in plain numbers (`references.spring_sliders`).
Mindlin's and JKR's closed forms judge the claims of random scenes (`plane_scenes`).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from validation.doors import Run
from validation.hard import plane_scenes
from validation.references.indenters import jkr
from validation.references.spring_sliders import SpringSliders
from validation.row import Row, at_most, so, worst
from validation.study import Bench, Findings, Refused, Study, said
from validation.study import found as result

NAME = "friction"
RADIUS, NORMAL, TANGENTIAL, MU, DEPTH = 1000.0, 1.0, 0.8, 0.3, 0.9
"""Of the body [LU], of its springs [FU/LU], μ, and the displacement [LU] of a contact of 60 particles."""
WAY = 0.5
"""Way along x [LU] after which all slips: μ k_n d/k_t is a third of it."""
EXACT = 1e-10
"""Error over μF_N that round-off leaves in a history of some rows: a particle's limit is a difference of distances from
far below, 1e-13 of it."""
CYCLES, FULL_CYCLES = 50, 200
SCALES = (1e-9, 1e-3, 1e6, 1e9)
EQUAL = 1e-8
"""Of scaled scenes: their numbers are rounded anew."""
FEW = (1, 2, 3, 4, 5)
SUM = "springs that slide, particle by particle"
ENERGY = 0.01
"""W [FU/LU] of the adhesive cases."""


@dataclass(frozen=True)
class Way:
    """Stops (displacement, place) [LU] after a first one at `displacement` of the first, place 0."""

    name: str
    stops: Sequence[tuple[float, float]]
    friction: float = MU
    scale: tuple[float, float] = (1.0, 1.0)
    more: dict[str, Any] = field(default_factory=dict)

    def scene(self) -> dict[str, Any]:
        """Lengths × s, energies × e."""
        s, e = self.scale
        stiffness = e / s**2
        bodies = {
            "particles": "auto", "spacing": s, "reduction": "mdr", "lower": "rigid_plane",
            "profile": {"kind": "parabola", "radius": RADIUS * s},
            "bulk_stiffness": NORMAL * stiffness, "bulk_stiffness_tangential": TANGENTIAL * stiffness,
        }  # fmt: skip
        experiment = {
            "kind": "tangential", "normal_displacement": [d * s for d, _ in self.stops],
            "displacements": [u * s for _, u in self.stops],
        }  # fmt: skip
        return {"bodies": bodies, "friction": {"coefficient": self.friction}, "experiment": experiment} | self.more

    def off(self, run: Run | Refused) -> float:
        """The largest error of F_x over all rows and of the dissipated energy, over μF_N and μF_N times the way."""
        if isinstance(run, Refused) or run.friction is None:
            return math.nan
        s, e = self.scale
        x = run.profiles["final"].x / s
        chain = SpringSliders((x**2 / RADIUS).tolist(), NORMAL, TANGENTIAL, self.friction)
        chain.move(self.stops[0][0], 0.0)
        forces = []
        strongest = chain.normal_force
        for stop in self.stops:
            chain.move(*stop)
            forces.append(chain.tangential_force)
            strongest = max(strongest, chain.normal_force)
        unit = min(self.friction * strongest, TANGENTIAL * WAY * len(x)) or 1.0
        errors = np.abs(np.asarray(run.friction["tangential_force"]) * s / e - forces) / unit
        # The curve's own number: the result of 1 to 3 particles is not reported where it is too uncertain.
        lost = abs(float(run.friction["dissipated_energy"][-1]) / e - chain.dissipated) / (unit * WAY)
        return worst([float(errors.max()), lost])


def ways(full: bool) -> list[Way]:
    """The hard ways."""
    cycles = FULL_CYCLES if full else CYCLES
    edge, slipping = 10.5**2 / RADIUS, MU / TANGENTIAL * (10.5**2 - 5.5**2) / RADIUS
    found = [
        Way("μ = 0", [(DEPTH, u) for u in (0.1, -0.3, WAY)], friction=0.0),
        Way("μ = 1e6", [(DEPTH, u) for u in (0.1, -0.3, 0.2)], friction=1e6),
        Way("no way at all, u = 0", [(DEPTH, 0.0), (DEPTH, 0.0)]),
        Way("the load is taken away while all sticks", [(DEPTH, 0.05), (0.0, 0.05), (0.0, 0.1), (DEPTH, 0.1)]),
        Way("lifted off and put down again", [(DEPTH, 0.2), (-0.5, 0.2), (-0.5, WAY), (DEPTH, WAY), (DEPTH, 0.6)]),
        Way("the contact grows under a tangential load", [(0.3, 0.05), (0.6, 0.1), (DEPTH, 0.15), (DEPTH, 0.3)]),
        Way("the contact grows from the first touch", [(0.0, 0.0), (DEPTH, 0.4 * DEPTH)]),
        Way("the contact shrinks while it slips", [(DEPTH, 0.2), (0.5, 0.35), (0.2, 0.1)]),
        Way(f"{cycles} cycles there and back", [(DEPTH, u) for u in (0.15, -0.15) * cycles]),
    ]
    for nudge in (-1e-12, -1e-15, 0.0, 1e-15, 1e-12):
        stops = [(edge + nudge, slipping + nudge), (edge + nudge, 0.5 * slipping), (edge + nudge, slipping + nudge)]
        found.append(Way(f"a particle on both edges, {nudge:+g} LU", stops))
    for count in FEW:
        deep = (0.5 * count + 0.25) ** 2 / RADIUS
        u = MU / TANGENTIAL * deep
        found.append(
            Way(f"{count} or {count + 1} particles in contact", [(deep, 0.3 * u), (deep, 0.9 * u), (deep, -1.5 * u)])
        )
    for factor in SCALES if full else SCALES[::3]:
        for what, scale in (("lengths", (factor, 1.0)), ("energies", (1.0, factor))):
            found.append(Way(f"{what} × {factor:g}", [(DEPTH, u) for u in (0.1, -0.2, 0.3)], scale=scale))
    return found


def refusals() -> list[tuple[str, dict[str, Any]]]:
    """What has no answer, to be said before anything runs."""
    base = Way("refused", [(DEPTH, 0.1)]).scene()
    without = {name: table for name, table in base.items() if name != "friction"}
    pull = {"experiment": {"kind": "pull_off", "preload": 1.0}, "adhesion": {"work_of_adhesion": 1e6}}
    return [
        ("a plate without damping, in a tangential", base | {"plate": {"damping": 0.0}}),
        ("a tangential without [friction]", without),
        ("[friction] and [adhesion] in one tangential", base | {"adhesion": {"work_of_adhesion": ENERGY}}),
        ("[friction] between two chains", base | {"bodies": base["bodies"] | {"lower": "particles"}}),
        ("W so large that the contact spans the body", _adhesive(1.0) | {"bodies": _limited()} | pull),
    ]


def _adhesive(scale: float, work: float = ENERGY) -> dict[str, Any]:
    """A pull-off of the same body; energies × `scale`."""
    bodies = Way("adhesive", [(DEPTH, 0.0)], scale=(1.0, scale)).scene()["bodies"]
    preload = jkr(RADIUS, NORMAL, ENERGY).pull_off_force() * scale
    return {
        "bodies": bodies,
        "adhesion": {"work_of_adhesion": work * scale},
        "experiment": {"kind": "pull_off", "preload": preload},
    }


def _limited() -> dict[str, Any]:
    """A body that ends: a circle."""
    bodies: dict[str, Any] = _adhesive(1.0)["bodies"]
    return bodies | {"profile": {"kind": "circle", "radius": RADIUS}}


def measure(bench: Bench) -> Findings:
    """Rows for each way, refusals, adhesion, and the claims of random scenes."""
    checks: list[Row] = []
    for number, way in enumerate(ways(bench.full)):
        run = bench.run(f"way_{number}", way.scene())
        bound = EXACT if way.scale == (1.0, 1.0) else EQUAL
        limit = said("round-off of a history", run)
        checks.append(at_most(f"{way.name}: F_x and work off, over μF_N", way.off(run), bound, SUM, limit))
    for number, (name, scene) in enumerate(refusals()):
        answer = bench.run(f"refused_{number}", scene)
        silent = not (isinstance(answer, Refused) and answer.before)
        limit = said("a number where there is none", answer)
        checks.append(so(f"{name}: not refused before it ran", silent, "–", limit))
    checks += adhesive_checks(bench)
    tally = plane_scenes.tally(bench)
    checks += tally.checks(NAME, "Galin, Mindlin, Maugis and Barquins")
    return Findings(checks, tally.drawn())


def adhesive_checks(bench: Bench) -> list[Row]:
    """W = 0 is Hertz's sum; with energies scaled F_A is JKR's as nearly as it is without."""
    checks = []
    path = {"kind": "path", "displacements": [-0.1, 0.0, 0.1, DEPTH, 0.2, -0.1]}
    run = bench.run("no_energy", _adhesive(1.0, work=0.0) | {"experiment": path})
    off = math.nan
    if not isinstance(run, Refused):
        x, curve = run.profiles["final"].x, run.curve
        exact = [NORMAL * float(np.sum(np.maximum(0.0, d - x**2 / RADIUS))) for d in curve.displacement]
        off = float(np.abs(np.asarray(curve.force) - exact).max() / max(exact))
    limit = said("round-off", run)
    checks.append(at_most("W = 0: F(d) off, over the largest", off, EXACT, "the sum over particles", limit))
    base = bench.run("energies_1", _adhesive(1.0))
    for factor in SCALES:
        other = bench.run(f"energies_{factor:g}", _adhesive(factor))
        off = math.nan
        if not isinstance(other, Refused) and not isinstance(base, Refused):
            off = abs(result(other, "adhesion_force").value / factor / result(base, "adhesion_force").value - 1.0)
        limit = said("rounding", other)
        checks.append(at_most(f"F_A/e off, energies × {factor:g}", off, EQUAL, "the same, not scaled", limit))
    return checks


FRICTION = Study(
    NAME,
    "Friction and adhesion on the rigid plane",
    "The loading history matters where a load is removed and reapplied, over many cycles, and where a particle is "
    "at the contact edge; an adhesive contact of few particles has a stepwise edge. Are the forces those of "
    "Jenkins elements, and do the uncertainties agree with closed forms?",
    measure,
)
