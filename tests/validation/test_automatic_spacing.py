"""Claim: `spacing = "auto"` keeps the tolerance: every number of random scenes on the plane, against closed forms.

References: Galin's z = c rⁿ, with adhesion Maugis and Barquins', with friction the stick zone's own smaller contact
(Ciavarella, Jaeger), F_x = μ (F_N − F(c)), u = μ (E*/G*) (d − d(c)); E* and G* of two bodies with E and ν.
"""

from typing import Any

import numpy as np

from contact1d import run
from contact1d.analysis.theory.indenters import PowerLaw
from validation.hard.judge import Case, Expected, Judge
from validation.paper.tangential import stiffness_ratio

SCENES, SEED = 24, 20
KINDS = ("load", "pull_off", "tangential")
ROUND_OFF = 1e-12
TOLD = 0.1
"""Share of the numbers beyond the tolerance by a claim that names them: rows of a path and readings between particles
are known after the run only. None may be beyond it without a word."""


def drawn(rng: np.random.Generator, kind: str) -> tuple[dict[str, Any], dict[str, float]]:
    """A scene whose units are 1 m and 1 N, and its results by closed forms."""
    moduli = (float(10.0 ** rng.uniform(6.0, 11.0)), float(10.0 ** rng.uniform(6.0, 11.0)))
    ratios = (float(rng.uniform(0.0, 0.5)), float(rng.uniform(0.0, 0.5)))
    modulus = 1.0 / sum((1.0 - nu**2) / e for e, nu in zip(moduli, ratios, strict=True))
    exponent, radius = float(rng.choice([1.0, 1.5, 2.0, 2.0, 3.0, 4.0, 8.0])), float(10.0 ** rng.uniform(-6.0, -3.0))
    law = PowerLaw(float(10.0 ** rng.uniform(-3.0, -1.5)) * radius ** (1.0 - exponent), exponent, modulus)
    profile = {"kind": "power", "height": law.coefficient * radius**exponent, "radius": radius, "exponent": exponent}
    bodies = {"particles": "auto", "spacing": "auto", "lower": "rigid_plane", "profile": profile}
    material = {
        name: {"youngs_modulus": e, "poisson_ratio": nu}
        for name, e, nu in zip(("upper", "lower"), moduli, ratios, strict=True)
    }
    tables: dict[str, Any] = {
        "title": kind, "bodies": bodies, "material": material | {"length_unit": 1.0, "force_unit": 1.0},
        "accuracy": {"tolerance": float(10.0 ** rng.uniform(-4.0, -2.0))},
    }  # fmt: skip
    force, depth = float(law.force(radius)), float(law.displacement(radius))
    if kind == "load":
        exact = {"displacement": depth, "contact_radius": radius}
        return tables | {"experiment": {"kind": "load", "force": force}}, exact
    if kind == "tangential":
        friction, stick = float(rng.uniform(0.05, 1.0)), radius * float(rng.uniform(0.2, 0.9))
        place = friction / stiffness_ratio(moduli, ratios) * (depth - float(law.displacement(stick)))
        experiment = {"kind": kind, "normal_force": force, "displacements": [0.5 * place, place]}
        exact = {
            "tangential_force": friction * (force - float(law.force(stick))),
            "contact_radius": radius,
            "stick_radius": stick,
        }
        return tables | {"friction": {"coefficient": friction}, "experiment": experiment}, exact
    unit = PowerLaw(law.coefficient, exponent, modulus, 1.0).zero_load_radius()  # a₀ is a power of W: W^(1/(2n − 1))
    body = PowerLaw(law.coefficient, exponent, modulus, (radius / unit) ** (2.0 * exponent - 1.0))
    tables["adhesion"] = {"work_of_adhesion": body.work_of_adhesion}
    exact = {"adhesion_force": body.pull_off_force(), "zero_load_radius": radius}
    exact["critical_radius"] = body.critical_radius()
    return tables | {"experiment": {"kind": kind, "preload": 0.5 * body.pull_off_force()}}, exact


def test_an_automatic_spacing_keeps_the_tolerance() -> None:
    rng, judge = np.random.default_rng(SEED), Judge()
    for number in range(SCENES):
        kind = KINDS[number % len(KINDS)]
        scene, exact = drawn(rng, kind)
        judge.add(Case(str(number), kind, kind, scene, Expected(exact, ROUND_OFF)), run(scene))
    assert not [*judge.silent, *judge.unnamed, *judge.outside]
    assert sum(n.named for n in judge.numbers) <= TOLD * len(judge.numbers)
