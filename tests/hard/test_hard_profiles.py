"""Hard profiles: contacts wider than the body, flat punches that adhere, needles, nearly flat cones, long tables."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, RunError, read_scene, run
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.settings import settings_for
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.pull_off import pull_off

LAW = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}
SHORT = {"repulsion": {"amplitude": 0.02, "range": 0.03}, "attraction": {"amplitude": 0.01, "range": 0.06}}
"""So short that a particle feels its opposite alone: exp(−1/0.06) is 6e-8."""
STIFFNESS = 0.83
FORCE = 1e-6
"""Relative, on the plane: the minimiser stops at 1e-6 of the deepest particle's force."""
ADHESION = 1e-4
"""Relative: what the tolerance 1e-3 leaves of a maximum; measured 2e-5 against either reference."""
LAST_FIGURE = 1e-3
"""Relative: the four figures of a displacement in a message."""


def tables(
    profile: dict[str, Any], experiment: dict[str, Any], law: dict[str, Any] | None = None, **bodies: Any
) -> dict[str, Any]:
    """On a rigid plane without a law, on particles with one."""
    made: dict[str, Any] = {
        "title": "hard profile",
        "bodies": {"particles": "auto", "spacing": 1.0, "profile": profile, "bulk_stiffness": STIFFNESS,
                   "lower": "rigid_plane" if law is None else "particles"} | bodies,
        "experiment": experiment,
    }  # fmt: skip
    return made if law is None else made | {"interaction": law}


def path(*displacements: float) -> dict[str, Any]:
    return {"kind": "path", "displacements": list(displacements)}


def done(folder: Path, data: dict[str, Any], figures: bool = False) -> Run:
    return run(read_scene(data), folder / "run", figures=figures)


def exact(finished: Run, heights: np.ndarray[Any, Any]) -> float:
    """Σ k max(0, d − h) at the last state."""
    last = finished.outcome.states[-1]
    return float(STIFFNESS * np.maximum(0.0, last.displacement - heights).sum())


# Contacts wider than their profile.

SAMPLES = np.linspace(0.0, 15.0, 31)
TABLE = {"kind": "table", "r": SAMPLES.tolist(), "z": (SAMPLES**2 / 80.0).tolist()}
WIDE = {
    "circle": {"kind": "circle", "radius": 20.0},
    "table": TABLE,
    "table with a flat rim": {"kind": "table", "r": [0, 2, 4, 6, 8, 10], "z": [0, 0.1, 0.4, 0.9, 0.9, 0.9]},
}


@pytest.mark.parametrize("reduction", ["geike_popov", "mdr"])
@pytest.mark.parametrize("name", ["circle", "table"])
def test_contact_wider_than_its_profile_is_refused_with_the_possible_displacement(
    name: str, reduction: str, tmp_path: Path
) -> None:
    with pytest.raises(SettingsError) as caught:
        done(tmp_path, tables(WIDE[name], path(200.0), reduction=reduction))
    found = re.search(r"at most ([\d.e+-]+) LU is possible", str(caught.value))
    assert found is not None
    assert "cover the profile" in str(caught.value)
    assert not (tmp_path / "run").exists()
    possible = float(found[1]) * (1.0 - LAST_FIGURE)
    results = done(tmp_path, tables(WIDE[name], path(possible), reduction=reduction)).document
    assert results["status"] == "done"
    assert {warning["name"] for warning in results["warnings"]} <= {
        "tolerance",
        "lattice",
        "reduction",
        "slope",
        "body_size",
    }  # of the radius at its very edge, of few particles, of the paper's reduction, of a contact as wide as a body
    assert results["largest_force"]["value"] > 0.0


@pytest.mark.parametrize("name", ["circle", "table"])
def test_chain_wider_than_its_profile_is_refused_with_the_longest(name: str, tmp_path: Path) -> None:
    with pytest.raises(SettingsError) as caught:
        done(tmp_path, tables(WIDE[name], path(0.5), particles=60))
    found = re.search(
        r"the chain of 60 particles is 29.5 LU wide to each side.*at most (\d+) particles", str(caught.value)
    )
    assert found is not None
    assert int(found[1]) == {"circle": 40, "table": 30}[name]
    assert done(tmp_path, tables(WIDE[name], path(0.5), particles=int(found[1]))).document["status"] == "done"


def test_profile_whose_reduction_falls_is_refused_with_the_place(tmp_path: Path) -> None:
    """Its own height does not fall, its transform does: beyond the rim f′ = 0 and g ~ 1/x."""
    assert done(tmp_path, tables(WIDE["table with a flat rim"], path(0.2), reduction="geike_popov")).status == "done"
    with pytest.raises(SettingsError, match=r"under the reduction mdr falls beyond x = [4-7]\.\d* LU"):
        done(tmp_path, tables(WIDE["table with a flat rim"], path(0.2), reduction="mdr", particles=20))


@pytest.mark.parametrize("reach", [0.3, 0.6, 1.2])
def test_profile_narrower_than_three_particles_is_refused(reach: float, tmp_path: Path) -> None:
    narrow = {"kind": "table", "r": [reach * i / 3 for i in range(4)], "z": [0, 1, 4, 9]}
    with pytest.raises(SettingsError, match=f"ends at {reach:g} LU, .* a bodies.spacing below {reach / 1.5:g} LU"):
        done(tmp_path, tables(narrow, path(0.1)))
    for asked, spacing, found in (("auto", 0.999 * reach / 1.5, 4), (3, 0.999 * reach, 3)):
        of = read_scene(tables(narrow, path(0.1), spacing=spacing, particles=asked))
        assert settings_for(of).chains.upper == found


# Flat punches.

PUNCH = {"kind": "flat_punch", "radius": 10.0}


def largest_tension(law: dict[str, Any]) -> float:
    """Of one pair [FU]: f′ = 0 at r = ln(A b²/(B a²)) ab/(b − a)."""
    A, a = law["repulsion"]["amplitude"], law["repulsion"]["range"]
    B, b = law["attraction"]["amplitude"], law["attraction"]["range"]
    r = math.log(A * b**2 / (B * a**2)) * a * b / (b - a)
    return B / b * math.exp(-r / b) - A / a * math.exp(-r / a)


@pytest.mark.parametrize("reduction", ["geike_popov", "mdr"])
@pytest.mark.parametrize("radius", [1.5, 10.0])
def test_flat_punch_pulls_off_with_the_largest_tension_of_each_pair(
    radius: float, reduction: str, tmp_path: Path
) -> None:
    """Pairs that feel nothing of each other: F_A = N max(−f), whatever the springs."""
    data = tables(
        {"kind": "flat_punch", "radius": radius}, {"kind": "pull_off", "preload": 0.1}, SHORT, reduction=reduction
    )  # fmt: skip
    results = done(tmp_path, data, figures=True).document
    count = round(2.0 * radius)
    assert results["adhesion_force"]["value"] == pytest.approx(count * largest_tension(SHORT), rel=ADHESION)
    for name in ("zero_load_radius", "critical_radius"):
        assert (results[name]["value"], results[name]["uncertainty"]) == (radius, 0.0)
    assert results["warnings"] == []


def test_flat_punch_with_a_longer_range_agrees_with_the_reference(tmp_path: Path) -> None:
    """The particles at the ends have one neighbour less opposite them, so the chain bends and the edges go first."""
    finished = done(tmp_path, tables(PUNCH, {"kind": "pull_off", "preload": 1.0}, LAW))
    pair = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
    reference = pull_off(ChainModel(20, STIFFNESS, pair, heights=np.zeros(20)), 1.0)
    found = finished.document["adhesion_force"]
    assert found["value"] == pytest.approx(reference.adhesion_force, rel=ADHESION)
    assert abs(found["value"] - reference.adhesion_force) < found["uncertainty"]


# Steep, flat, sharp-edged, long, short.


@pytest.mark.parametrize("reduction", ["geike_popov", "mdr"])
@pytest.mark.parametrize(("slope", "depth"), [(10.0, 100.0), (1e-6, 1e-4)])
def test_steep_and_nearly_flat_cones(slope: float, depth: float, reduction: str, tmp_path: Path) -> None:
    finished = done(tmp_path, tables({"kind": "cone", "slope": slope}, path(0.3 * depth, depth), reduction=reduction))
    x = finished.outcome.states[-1].profile.x
    heights = slope * np.abs(x) * (0.5 * math.pi if reduction == "mdr" else 1.0)
    assert finished.document["largest_force"]["value"] == pytest.approx(exact(finished, heights), rel=FORCE)
    limited = {"reduction"} if reduction == "geike_popov" else {"slope"} if slope > 0.1 else set()
    assert set(finished.warnings) - {"lattice", "tolerance"} == limited


def test_cone_so_flat_that_no_chain_is_long_enough_is_refused() -> None:
    with pytest.raises(SettingsError, match="particles per body, more than"):
        settings_for(read_scene(tables({"kind": "cone", "slope": 1e-9}, path(0.1))))


def test_needle_touches_with_the_two_particles_at_its_apex(tmp_path: Path) -> None:
    """The radius of the largest tension is 0 within half a spacing: it is not reported. The run has figures."""
    needle = tables({"kind": "cone", "slope": 10.0}, {"kind": "pull_off", "preload": 0.01}, LAW)
    found = done(tmp_path, needle, figures=True)
    results = found.document
    assert results["adhesion_force"]["value"] > 2.0 * largest_tension(LAW)
    assert results["zero_load_radius"]["value"] is None
    assert results["zero_load_radius"]["uncertainty"] >= 0.5 * (1.0 - 1e-9)
    assert "zero_load_radius" not in found.results
    assert "zero_load_radius (less than" in found.warnings["unknown"]


@pytest.mark.parametrize("reduction", ["geike_popov", "mdr"])
def test_exponent_50_is_nearly_a_flat_punch(reduction: str, tmp_path: Path) -> None:
    finished = done(
        tmp_path,
        tables({"kind": "power", "exponent": 50.0, "radius": 20.0, "height": 1.0}, path(0.1, 0.5), reduction=reduction),
    )
    factor = 0.5 * math.sqrt(math.pi) * 50.0 * math.gamma(25.0) / math.gamma(25.5) if reduction == "mdr" else 1.0
    heights = factor * np.abs(finished.outcome.states[-1].profile.x / 20.0) ** 50
    assert finished.document["largest_force"]["value"] == pytest.approx(exact(finished, heights), rel=FORCE)
    radius = finished.document["largest_radius" if reduction == "mdr" else "image_largest_radius"]
    assert abs(radius["value"] - 20.0 * (0.5 / factor) ** 0.02) < radius["uncertainty"]


def test_table_of_5000_points_is_its_formula(tmp_path: Path) -> None:
    r = 0.02 * np.arange(5000)
    profile = {"kind": "table", "r": r.tolist(), "z": (r**2 / 100.0).tolist()}
    finished = done(tmp_path, tables(profile, path(0.1, 0.5), reduction="geike_popov"))
    heights = finished.outcome.states[-1].profile.x ** 2 / 100.0
    assert finished.document["largest_force"]["value"] == pytest.approx(exact(finished, heights), rel=FORCE)


@pytest.mark.parametrize("lower", ["rigid_plane", "particles"])
def test_three_particles(lower: str, tmp_path: Path) -> None:
    """The fewest that a body may have: the middle one at the apex."""
    profile = {"kind": "parabola", "radius": 1.0}
    if lower == "rigid_plane":
        finished = done(tmp_path, tables(profile, path(0.1, 0.3), particles=3))
        assert finished.document["largest_force"]["value"] == pytest.approx(STIFFNESS * 0.3, rel=FORCE)
        with pytest.raises(RunError, match="end of the chain"):
            done(tmp_path, tables(profile, path(1.2), particles=3))
        return
    with pytest.raises(RunError, match="end of the chain"):
        done(tmp_path, tables(profile, {"kind": "pull_off", "preload": 0.1}, LAW, particles=3))
