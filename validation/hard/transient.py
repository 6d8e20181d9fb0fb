"""A force held on a body at rest: displacement, force and radius while the plate moves, and when it has come to rest.

A plate of the mass M with the drag c presses a sphere on the plane; particles that touch nothing move with it, those
that touch stand still. With n(d) = (L − 2a)/s free particles of the mass m and the drag γ,

    (M + n m) d″ + (c + n γ) d′ = P − (4/3) E* √R d^(3/2),    a = √(R d)

by scipy. Particles are so light that what they take along is within SLACK of the displacement.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

from scipy.integrate import solve_ivp

from validation.hard.judge import Case, Expected, judged, rows_of
from validation.hard.surfaces import surface
from validation.study import Bench, Findings, Study

RADIUS, SPACING, FORCE = 1000.0, 0.5, 40.0
"""R [LU], s [LU], P [FU]; E* = 1 FU/LU²."""
PARTICLES, MASS, DRAG = 200, 1e-3, 1e-4
"""N, m [MU], γ [FU·TU/LU]."""
PLATE, DAMPING = 142.0, 60.0
"""M [MU], c [FU·TU/LU]: a third of the critical drag, so that the plate overshoots."""
TIMES, FULL_TIMES = (2.0, 5.0), (1.0, 2.0, 5.0, 8.0, 20.0, 60.0)
"""[TU]; a period is about 10."""
SLACK = 2.0 * PARTICLES * MASS / PLATE
"""Relative error of the reduced motion: what particles take along when they touch, and swing with."""


def cases(full: bool) -> Iterator[Case]:
    """Several times of one transient, each a run of its own."""
    for time in FULL_TIMES if full else TIMES:
        d = displacement(time)
        exact = {
            "displacement": d,
            "force": 4.0 / 3.0 * math.sqrt(RADIUS) * max(d, 0.0) ** 1.5,
            "contact_radius": math.sqrt(RADIUS * max(d, 0.0)),
        }
        scene = surface(RADIUS, "parabola", radius=RADIUS).tables(SPACING, 1e-2)
        scene["bodies"] |= {"particles": PARTICLES, "mass": MASS}
        scene |= {"damping": {"coefficient": DRAG}, "plate": {"mass": PLATE, "damping": DAMPING},
                  "experiment": {"kind": "hold", "force": FORCE, "duration": time}}  # fmt: skip
        yield Case(f"held_{time:g}", f"held for {time:g} TU", "sphere", scene, Expected(exact, SLACK))


def displacement(time: float) -> float:
    """d [LU] at that time, from touch at rest."""

    def change(_: float, state: Any) -> list[float]:
        d, v = state
        touching = 2.0 * math.sqrt(RADIUS * max(d, 0.0)) / SPACING
        free = max(0.0, PARTICLES - touching)
        carried = 4.0 / 3.0 * math.sqrt(RADIUS) * max(d, 0.0) ** 1.5
        return [v, (FORCE - carried - (DAMPING + free * DRAG) * v) / (PLATE + free * MASS)]

    return float(solve_ivp(change, (0.0, time), [0.0, 0.0], rtol=1e-10, atol=1e-12).y[0, -1])


def measure(bench: Bench) -> Findings:
    """Rows of each time."""
    return Findings(rows_of(judged(bench, cases(bench.full)), "the motion of plate and free particles, by scipy"))


TRANSIENT = Study(
    "transient",
    "A force held while the plate moves",
    "While a contact moves towards equilibrium, the residual of its forces is no bound of its errors. Are "
    "displacement, force and radius within their uncertainties at every time, or not reported?",
    measure,
)
