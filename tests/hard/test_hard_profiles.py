"""Hard profiles: contacts wider than the body, flat punches that adhere, needles, nearly flat cones, long tables."""

import math
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, RunError, SettingsError, run
from tests.scenes import LAW, chains
from validation.references.interaction import PairInteraction

SHORT = (0.02, 0.03, 0.01, 0.06)
"""So short that a particle feels its opposite alone: exp(−1/0.06) is 6e-8."""
STIFFNESS = 0.83
FORCE = 1e-6
"""Relative, on the plane: the minimiser stops at 1e-6 of the deepest particle's force."""
ADHESION = 1e-4
"""Relative: what the tolerance 1e-3 leaves of a maximum; measured 2e-5 against either reference."""
LAST_FIGURE = 1e-3
"""Relative: the four figures of a displacement in a message."""
SAMPLES = np.linspace(0.0, 15.0, 31)
WIDE: dict[str, dict[str, Any]] = {
    "circle": {"kind": "circle", "radius": 20.0},
    "table": {"kind": "table", "r": SAMPLES.tolist(), "z": (SAMPLES**2 / 80.0).tolist()},
    "flat rim": {"kind": "table", "r": [0, 2, 4, 6, 8, 10], "z": [0, 0.1, 0.4, 0.9, 0.9, 0.9]},
}


def done(
    profile: dict[str, Any],
    experiment: dict[str, Any],
    law: tuple[float, ...] | None = None,
    figures: bool = False,
    folder: Path | None = None,
    **bodies: Any,
) -> Run:
    """On a rigid plane without a law, on particles with one."""
    alone: dict[str, Any] = {} if law else {"interaction": None}
    body = {"profile": profile, "lower": "particles" if law else "rigid_plane"} | bodies
    tables = chains(1.0, STIFFNESS, law or LAW, title="hard profile", bodies=body, experiment=experiment, **alone)
    return run(tables, folder, figures)


def path(*displacements: float) -> dict[str, Any]:
    return {"kind": "path", "displacements": list(displacements)}


@pytest.mark.parametrize(("name", "reduction"), [("circle", "mdr"), ("table", "geike_popov")])
def test_contact_wider_than_its_profile_is_refused_with_the_possible_displacement(name: str, reduction: str) -> None:
    with pytest.raises(SettingsError, match="cover the profile") as caught:
        done(WIDE[name], path(200.0), reduction=reduction)
    found = re.search(r"at most ([\d.e+-]+) LU is possible", str(caught.value))
    assert found is not None
    possible = float(found[1]) * (1.0 - LAST_FIGURE)
    run = done(WIDE[name], path(possible), reduction=reduction)
    # Of the radius at its very edge, of few particles, of the paper's reduction, of a contact as wide as a body.
    assert set(run.warnings) <= {"tolerance", "lattice", "reduction", "slope", "body_size"}
    assert run.results.largest_force.value > 0.0


@pytest.mark.parametrize(("name", "longest"), [("circle", 40), ("table", 30)])
def test_chain_wider_than_its_profile_is_refused_with_the_longest(name: str, longest: int) -> None:
    words = f"the chain of 60 particles is 29.5 LU wide to each side.*at most {longest} particles"
    with pytest.raises(SettingsError, match=words):
        done(WIDE[name], path(0.5), particles=60)
    assert done(WIDE[name], path(0.5), particles=longest).status == "done"


def test_profile_whose_reduction_falls_is_refused_with_the_place() -> None:
    """Its own height does not fall, its transform does: beyond the rim f′ = 0 and g ~ 1/x."""
    assert done(WIDE["flat rim"], path(0.2), reduction="geike_popov").status == "done"
    with pytest.raises(SettingsError, match=r"under the reduction mdr falls beyond x = [4-7]\.\d* LU"):
        done(WIDE["flat rim"], path(0.2), reduction="mdr", particles=20)


def largest_tension(numbers: tuple[float, ...]) -> float:
    """Of one pair [FU]."""
    law = PairInteraction.of(*numbers)
    return -float(law.force(np.array(law.extremum_distance(1))))


@pytest.mark.parametrize(("radius", "reduction"), [(1.5, "mdr"), (10.0, "geike_popov")])
def test_flat_punch_pulls_off_with_the_largest_tension_of_each_pair(radius: float, reduction: str) -> None:
    """Pairs that feel nothing of each other: F_A = N max(−f), whatever the springs."""
    pull = {"kind": "pull_off", "preload": 0.1}
    found = done({"kind": "flat_punch", "radius": radius}, pull, SHORT, reduction=reduction)
    force = round(2.0 * radius) * largest_tension(SHORT)
    assert found.results.adhesion_force.value == pytest.approx(force, rel=ADHESION)
    for name in ("zero_load_radius", "critical_radius"):
        assert (found.results[name].value, found.results[name].uncertainty) == (radius, 0.0)
    assert found.warnings == {}


ROUND = 0.5 * math.sqrt(math.pi) * 50.0 * math.gamma(25.0) / math.gamma(25.5)
"""Of a power of 50, its transform over its height."""
FORMULAS: dict[str, tuple[dict[str, Any], float, str, Callable[[Any], Any]]] = {
    "steep cone": ({"kind": "cone", "slope": 10.0}, 100.0, "mdr", lambda x: 5.0 * math.pi * np.abs(x)),
    "nearly flat cone": ({"kind": "cone", "slope": 1e-6}, 1e-4, "geike_popov", lambda x: 1e-6 * np.abs(x)),
    "nearly a punch": (
        {"kind": "power", "exponent": 50.0, "radius": 20.0, "height": 1.0}, 0.5, "mdr",
        lambda x: ROUND * np.abs(x / 20.0) ** 50,
    ),
}  # fmt: skip


@pytest.mark.parametrize("name", FORMULAS)
def test_force_is_the_sum_over_springs_under_the_formula(name: str) -> None:
    """Σ k max(0, d − h)."""
    profile, depth, reduction, height = FORMULAS[name]
    found = done(profile, path(0.3 * depth, depth), reduction=reduction)
    force = STIFFNESS * np.maximum(0.0, depth - height(found.profiles["deepest"].x)).sum()
    assert found.results.largest_force.value == pytest.approx(force, rel=FORCE)
    doubted = {"reduction"} if reduction == "geike_popov" else {"slope"}
    assert "cone" not in name or set(found.warnings) - {"lattice", "tolerance"} == doubted
    if name == "nearly a punch":
        radius = found.results.largest_radius
        assert abs(radius.value - 20.0 * (0.5 / ROUND) ** 0.02) < radius.uncertainty


def test_needle_touches_with_the_two_particles_at_its_apex() -> None:
    """The radius of the largest tension is 0 within half a spacing: it is not reported. The run has figures."""
    found = done({"kind": "cone", "slope": 10.0}, {"kind": "pull_off", "preload": 0.01}, LAW, figures=True)
    assert found.results.adhesion_force.value > 2.0 * largest_tension(LAW)
    assert found.document["zero_load_radius"]["value"] is None
    assert found.document["zero_load_radius"]["uncertainty"] >= 0.5 * (1.0 - 1e-9)
    assert "zero_load_radius (less than" in found.warnings["unknown"]


def test_three_particles_are_the_fewest_and_touch_with_the_middle_one(tmp_path: Path) -> None:
    profile = {"kind": "parabola", "radius": 1.0}
    found = done(profile, path(0.1, 0.3), particles=3)
    assert found.results.largest_force.value == pytest.approx(STIFFNESS * 0.3, rel=FORCE)
    for deeper, law in ((path(1.2), None), ({"kind": "pull_off", "preload": 0.1}, LAW)):
        with pytest.raises(RunError, match="end of the chain"):
            done(profile, deeper, law, folder=tmp_path, particles=3)
