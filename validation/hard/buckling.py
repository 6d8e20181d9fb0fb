"""Aligned pairs that buckle sideways.

A pair at the distance r that repels with f is pushed sideways by f u/r for an offset u of its particles, and held by
both springs in series, k_t/2: unstable where k_t < 2 f/r.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from validation.doors import Contact, Displace, contact_of
from validation.hard.cases import LAW, PairCase, shaped
from validation.row import Row, at_most
from validation.study import Bench, Findings, Study

BUCKLED = (0.9, 0.98, 1.02, 1.1)
"""Force of a pair over that at which it buckles."""
TANGENTIAL = 4.0
"""Tangential stiffness [FU/LU]: a pair then buckles at a third of its core's force."""
PUSH = 1e-5
"""Offset that is given to the pairs [LU]."""


def _force(r: float) -> float:
    return float(LAW.force(np.array(r)))


def measure(bench: Bench) -> Findings:
    """Pairs that are pushed aside a little: below the critical force they come back, above it they go on."""
    most = _force(float(brentq(lambda r: 2.0 * _force(r) / r - TANGENTIAL, 1e-4, 0.023)))
    return Findings([_row(bench, share, share * most) for share in BUCKLED])


def _row(bench: Bench, share: float, force: float) -> Row:
    r = float(brentq(lambda r: _force(r) - force, 1e-5, 0.0236, xtol=1e-16))
    case = PairCase("buckling", 0.5, shaped("flat_punch", 3, 0.0), 3)
    d = LAW.force_free_distance() - (r - 2.0 * force / case.stiffness)
    bodies = case.scene()["bodies"] | {"bulk_stiffness_tangential": TANGENTIAL}
    path = {"kind": "path", "displacements": [d]}
    with contact_of(case.scene() | {"bodies": bodies, "horizontal": {}, "experiment": path},
                    bench.folder / f"pushed_{share:g}") as contact:  # fmt: skip
        offset = _pushed(contact, d)
    words, value = ("left of the push", offset / PUSH) if share < 1.0 else (
        "push over where it ends", PUSH / max(offset, 1e-300))  # fmt: skip
    return at_most(f"{words}, pair at {share:g} of the force at which it buckles", value, 0.5, "k_t = 2 f/r",
                   "where the minimiser stops: some of the push")  # fmt: skip


def _pushed(contact: Contact, d: float) -> float:
    """How far particles are in the end from where they stood aligned at the displacement d [LU], after a push.

    Sideways or in height: pairs that buckle may slip past each other until they are aligned again.
    """
    contact.begin("loading")
    moves = math.ceil(d / contact.settings.increments.longest_move)
    for i in range(moves):  # in one move they would pass each other
        contact.row(Displace(d * (i + 1) / moves))
    contact.finish()
    before = contact.session.atoms("x")["x"][:6]
    contact.session.execute(f"displace_atoms upper move {PUSH!r} 0 0 units box\n", phase="pushed")
    contact.session.execute("min_style fire\nminimize 0.0 1e-13 20000 20000\n")
    return float(np.max(np.abs(contact.session.atoms("x")["x"][:6] - before)))


BUCKLING = Study(
    "buckling",
    "Buckling of aligned chains",
    "Two chains with opposite particles under load are in unstable equilibrium above a critical force, which a "
    "symmetric calculation does not leave without a perturbation. Do displaced pairs return below the critical force,"
    " and move away above it?",
    measure,
)
