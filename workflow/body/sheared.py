"""Closed forms of bodies drawn along a plane with friction: Cattaneo and Mindlin (`analysis.theory.mindlin`).

Of a sphere under one load N they say F_x and c on any way there and back, and a; under a displacement N as well.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from contact1d.analysis.theory import mindlin
from contact1d.workflow.body.closed_form import Case, ClosedForm
from contact1d.workflow.scene import Parabola, Tangential

SAME = 1e-12
"""Relative change up to which a load is one load."""


def _load(case: Case) -> tuple[float, float] | None:
    """N [FU] and d [LU] of Hertz's contact; None where there is no sphere, no contact, or more than one load."""
    experiment = case.scene.experiment
    if not isinstance(experiment, Tangential) or case.radius is None or case.scene.friction is None:
        return None
    given = experiment.normal_forces() or experiment.places()
    if not min(given) > 0.0 or max(given) - min(given) > SAME * max(given):
        return None
    stiffness = 4.0 / 3.0 * case.contact_modulus * math.sqrt(case.radius)
    if experiment.normal_forces():
        return given[0], (given[0] / stiffness) ** (2.0 / 3.0)
    return stiffness * given[0] ** 1.5, given[0]


def _applies(case: Case) -> str:
    friction = case.scene.friction
    if friction is None or friction.coefficient == 0.0 or not isinstance(case.scene.bodies.profile, Parabola):
        return ""
    return "a paraboloid under one load, drawn along a plane with friction" if _load(case) else ""


def _values(case: Case) -> Mapping[str, float]:
    scene, experiment, loaded = case.scene, case.scene.experiment, _load(case)
    assert scene.friction is not None
    assert isinstance(experiment, Tangential)
    assert loaded is not None
    assert case.radius is not None
    load, depth = loaded
    edge = math.sqrt(case.radius * depth)
    coefficient = scene.friction.coefficient
    sliding = mindlin.sliding_displacement(coefficient, scene.tangential_stiffness / scene.bulk_stiffness, depth)
    places = experiment.along()
    said = {
        "tangential_force": mindlin.mindlin_path(places, load, coefficient, sliding)[-1],
        "contact_radius": edge,
        "stick_radius": mindlin.mindlin_stick_path(places, edge, sliding)[-1],
    }
    return said if experiment.normal_forces() else said | {"normal_force": load}


SOURCE = "C. Cattaneo 1938; R. D. Mindlin, H. Deresiewicz, J. Appl. Mech. 20 (1953) 327"
SHEARED = (ClosedForm("Cattaneo and Mindlin", SOURCE, _applies, _values),)
"""Of bodies on a plane with friction."""
