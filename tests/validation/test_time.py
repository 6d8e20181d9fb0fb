"""Bodies that relax, hit and peel at a rate, against quadratures, closed forms and an ODE of the test's own."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

from contact1d import Run, SceneError, read_scene, run

E, R = 1.0, 1.0
SOLID = [{"share": 0.5, "time": 1.0}]


def scene(experiment: dict[str, Any], spacing: float = 0.02, profile: Any = None, **tables: Any) -> dict[str, Any]:
    bodies = {"particles": "auto", "spacing": spacing, "bulk_stiffness": E * spacing, "lower": "rigid_plane"}
    profile = profile or {"kind": "parabola", "radius": R}
    return {"title": "time", "bodies": bodies | {"profile": profile}, "experiment": experiment, **tables}


def done(experiment: dict[str, Any], folder: Path | None = None, **given: Any) -> Run:
    return run(read_scene(scene(experiment, **given)), folder, figures=False)


def inside(found: Run, name: str, exact: float, relative: float) -> bool:
    """Whether a result is the exact one within its uncertainty, which is no more than that part of it."""
    one = found.results[name]
    return abs(one.value - exact) <= one.uncertainty <= relative * abs(exact)


def history(key: str, *points: tuple[float, float], **more: Any) -> dict[str, Any]:
    return {"kind": "history", key: [list(point) for point in points], **more}


def test_a_punch_is_the_material_function() -> None:
    """F = 2 a E d (1 − g (1 − e^(−t/τ))) after a jump, τ ≫ the jump."""
    terms = [{"share": 0.4, "time": 2.0}, {"share": 0.3, "time": 30.0}]
    found = done(
        history("displacement", (0, 0.1), (5, 0.1)), spacing=0.1, profile={"kind": "flat_punch", "radius": 1.0},
        viscoelasticity={"terms": terms},
    )  # fmt: skip
    relaxed = 1.0 - sum(term["share"] * (1.0 - math.exp(-5.0 / term["time"])) for term in terms)
    assert found.results.force.value == pytest.approx(2.0 * 0.1 * relaxed, rel=1e-6, abs=0.0)


def test_creep_under_a_held_force() -> None:
    """a³ = (3R/4) ∫ C dF: C of a standard solid is 2 − e^(−t/2τ), of the ramp its mean."""
    found = done(history("force", (0, 0), (1, 0.05), (4, 0.05)), viscoelasticity={"terms": SOLID})
    creep = quad(lambda s: 2.0 - math.exp(-0.5 * (4.0 - s)), 0.0, 1.0)[0]
    assert inside(found, "contact_radius", (0.75 * R * 0.05 * creep) ** (1.0 / 3.0), 2e-3)


def test_a_force_held_and_drawn_back_shows_the_modulus_without_creep() -> None:
    """The jumps of both rates at the corner are those of the body at once, 2 E* a."""
    found = done(history("force", (0, 0), (1, 0.05), (2, 0.05), (6, 0)), viscoelasticity={"terms": SOLID})
    a = found.curve.contact_radius[np.flatnonzero(found.curve.branch == "holding")[-1]]
    assert inside(found, "creep_corrected_stiffness", 2.0 * E * float(a), 5e-2)


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "shares": ({"viscoelasticity": {"terms": [{"share": 0.7, "time": 1.0}, {"share": 0.5, "time": 1.0}]}}, "not 1.2"),
    "time": ({"viscoelasticity": {"terms": [{"share": 0.7, "time": 0.0}]}}, "greater than 0"),
    "back": ({"experiment": history("displacement", (0, 0), (2, 0.1), (1, 0))}, "times must rise; 1 follows 2"),
    "apart": ({"experiment": history("displacement", (0, 0), (2, 0))}, "never touch"),
    "steps": (
        {"experiment": history("force", (0, 0), (9, 0.1), steps=3)},
        "longer than the shortest time of the body, 1",
    ),
    "jump": (
        {"viscoelasticity": {"retardation_time": 1.0}, "experiment": history("displacement", (0, 0.1), (1, 0.2))},
        "dashpots resist a jump",
    ),
    "adhesion": ({"adhesion": {"work_of_adhesion": 0.01}}, r"not with \[viscoelasticity\]"),
    "load": ({"experiment": {"kind": "load", "force": 0.1}}, 'use kind = "history"'),
    "plate": ({"experiment": {"kind": "impact", "velocity": 1.0}}, "it has the mass of the body"),
    "mass": ({"experiment": {"kind": "impact", "velocity": 1.0}, "plate": {}}, "must be given in an impact"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_a_sentence(name: str) -> None:
    right = scene(history("displacement", (0, 0), (1, 0.1), (2, 0)), viscoelasticity={"terms": SOLID})
    changes, words = WRONG[name]
    with pytest.raises(SceneError, match=words):
        read_scene(right | changes)
