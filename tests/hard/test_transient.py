"""Claim: while a plate under a held force still moves, displacement, force and radius are right, or are not reported.

A plate of the mass M with the drag c presses a sphere on the plane; particles that touch nothing move with it, those
that touch stand still. With n(d) = (L − 2a)/s free particles of the mass m and the drag γ,

    (M + n m) d″ + (c + n γ) d′ = P − (4/3) E* √R d^(3/2),    a = √(R d).
"""

import math
from typing import Any

import pytest
from scipy.integrate import solve_ivp

from contact1d import run
from tests.scenes import chains

RADIUS, SPACING, FORCE = 1000.0, 0.5, 40.0
PARTICLES, MASS, DRAG = 200, 1e-3, 1e-4
PLATE, DAMPING = 142.0, 60.0
"""A third of the critical drag, so that the plate overshoots; a period is about 10 TU."""
SLACK = 2.0 * PARTICLES * MASS / PLATE
"""Relative: what particles take along when they touch, and swing with."""


@pytest.mark.parametrize("time", [1.0, 5.0, 8.0, 60.0])
def test_a_force_that_is_held_has_its_motion_at_every_time(time: float) -> None:
    def change(_: float, state: Any) -> list[float]:
        d, v = max(state[0], 0.0), state[1]
        free = max(0.0, PARTICLES - 2.0 * math.sqrt(RADIUS * d) / SPACING)
        push = FORCE - 4.0 / 3.0 * math.sqrt(RADIUS) * d**1.5
        return [v, (push - (DAMPING + free * DRAG) * v) / (PLATE + free * MASS)]

    d = float(solve_ivp(change, (0.0, time), [0.0, 0.0], rtol=1e-10, atol=1e-12).y[0, -1])
    exact = {
        "displacement": d,
        "force": 4.0 / 3.0 * math.sqrt(RADIUS) * d**1.5,
        "contact_radius": math.sqrt(RADIUS * d),
    }
    bodies = {"particles": PARTICLES, "spacing": SPACING, "mass": MASS, "reduction": "mdr", "lower": "rigid_plane"}
    found = run(chains(
        RADIUS, SPACING, title="held", interaction=None, bodies=bodies, damping={"coefficient": DRAG},
        accuracy={"tolerance": 1e-2}, plate={"mass": PLATE, "damping": DAMPING},
        experiment={"kind": "hold", "force": FORCE, "duration": time},
    ))  # fmt: skip
    for name, value in exact.items():
        if name in found.results:
            one = found.results[name]
            assert abs(one.value - value) <= one.uncertainty + SLACK * value
            assert one.uncertainty <= 1e-2 * value or any(name in words for words in found.warnings.values())
        else:
            assert name in found.warnings["unknown"]
