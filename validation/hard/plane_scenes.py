"""Random scenes on the rigid plane, with their numbers in closed form: pressed, adhesive, drawn along with friction.

For z = c rⁿ all of them follow from d(a) and F(a): without adhesion by Galin, with it by Maugis and Barquins, and under
a tangential displacement by the stick zone's own smaller contact (Ciavarella, Jaeger),

    F_x = μ (F_N − F(c)),    u = μ (E*/G*) (d − d(c))

Only the spacing is fixed, at a few to some tens of particles in the contact radius, whatever the tolerance.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from validation.hard.claims import Tally
from validation.references.indenters import Indenter, with_zero_load_radius
from validation.study import Bench

QUICK, FULL = 20, 200
SEED = 14
REFERENCE = 1e-12
"""Relative error of the closed forms."""
MODULUS = 1.0
NARROW, WIDE = 5.0, 60.0
"""Particles in the contact radius."""
Exact = dict[str, float]
Drawn = tuple[dict[str, Any], dict[str, Any], Exact]
"""Tables beside [bodies] and [experiment], what goes into [bodies] among them; the experiment; the numbers."""


def tally(bench: Bench) -> Tally:
    """What came of the scenes."""
    rng, found = np.random.default_rng(SEED), Tally()
    for number in range(FULL if bench.full else QUICK):
        kind, scene, exact = drawn(rng)
        name = f"plane_{number}"
        found.add(name, kind, bench.run(name, scene), exact, REFERENCE)
    return found


def drawn(rng: np.random.Generator) -> tuple[str, dict[str, Any], Exact]:
    """Its kind, the scene, and its numbers."""
    kind = str(rng.choice(["load", "pull_off", "tangential"]))
    exponent, radius = float(rng.choice([1.0, 2.0, 4.0])), float(10.0 ** rng.uniform(0.0, 2.0))
    slope = float(10.0 ** rng.uniform(-3.0, -1.0))
    law = Indenter(slope * radius ** (1.0 - exponent), exponent, MODULUS)
    spacing = radius / float(np.exp(rng.uniform(math.log(NARROW), math.log(WIDE))))
    tables: dict[str, Any] = {"accuracy": {"tolerance": float(10.0 ** rng.uniform(-4.0, -2.0))}}
    if kind == "load":
        more, experiment, exact = _pressed(law, radius)
    elif kind == "tangential":
        more, experiment, exact = _drawn_along(rng, law, radius, spacing)
    else:
        more, experiment, exact = _adhesive(law, radius)
    bodies = {
        "particles": "auto", "spacing": spacing, "reduction": "mdr", "lower": "rigid_plane", "profile": _profile(law),
        "bulk_stiffness": MODULUS * spacing,
    } | more.pop("bodies", {})  # fmt: skip
    return kind, tables | more | {"bodies": bodies, "experiment": experiment}, exact


def _profile(law: Indenter) -> dict[str, Any]:
    match law.exponent:
        case 1.0:
            return {"kind": "cone", "slope": law.coefficient}
        case 2.0:
            return {"kind": "parabola", "radius": 0.5 / law.coefficient}
    return {"kind": "power", "height": law.coefficient, "radius": 1.0, "exponent": law.exponent}


def _pressed(law: Indenter, radius: float) -> Drawn:
    exact = {"displacement": float(law.displacement(radius)), "contact_radius": radius}
    return {}, {"kind": "load", "force": float(law.force(radius))}, exact


def _drawn_along(rng: np.random.Generator, law: Indenter, radius: float, spacing: float) -> Drawn:
    friction, ratio = float(rng.uniform(0.05, 1.0)), float(rng.uniform(0.67, 1.0))
    stick = radius * float(rng.uniform(0.2, 0.9))
    normal, depth = float(law.force(radius)), float(law.displacement(radius))
    place = friction / ratio * (depth - float(law.displacement(stick)))
    drawn = friction * (normal - float(law.force(stick)))
    tables = {
        "friction": {"coefficient": friction},
        "bodies": {"bulk_stiffness_tangential": ratio * MODULUS * spacing},
    }
    experiment = {"kind": "tangential", "normal_force": normal, "displacements": [0.5 * place, place]}
    return tables, experiment, {"tangential_force": drawn, "contact_radius": radius, "stick_radius": stick}


def _adhesive(law: Indenter, radius: float) -> Drawn:
    """W is such that the contact radius without a load is `radius`."""
    adhesive = with_zero_load_radius(law.coefficient, law.exponent, MODULUS, radius)
    exact = {
        "adhesion_force": adhesive.pull_off_force(),
        "critical_radius": adhesive.critical_radius(),
        "zero_load_radius": adhesive.zero_load_radius(),
    }
    experiment = {"kind": "pull_off", "preload": 0.5 * adhesive.pull_off_force()}
    return {"adhesion": {"work_of_adhesion": adhesive.work_of_adhesion}}, experiment, exact
