"""From a material to a scene: what is refused, with the nearest that is not; the target; one search to its end."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest

from contact1d import Scene, read_scene
from contact1d.workflow.identify import IdentifyError, Target, identify, jkr_target, material_scene, require_reachable
from tests.scenes import chains

ROUND_OFF = 1e-13
TOLERANCE = 1e-2
"""Of the scene that is searched for, loose so that its runs are quick; the search ends at 0.3 of it."""
REACH = 0.95 * 4.0 / (9.0 * math.sqrt(3.0))
"""F_A R₁/(c a₀³) up to which a target is tried: 95 % of the brittle limit."""
LAW = (0.4, 0.25, 0.2, 0.5)
PULL = {"kind": "pull_off", "preload": 0.5}


def scene_of(profile: dict[str, Any] | None = None, experiment: dict[str, Any] | None = None, **bodies: Any) -> Scene:
    """A pull-off of R = 200 LU."""
    changed = bodies if profile is None else bodies | {"profile": profile}
    accuracy = {"tolerance": TOLERANCE}
    return read_scene(chains(200.0, law=LAW, bodies=changed, accuracy=accuracy, experiment=experiment or PULL))


# The target.


def test_target_is_jkrs() -> None:
    """F_A = 3πγR and E* = 3F_A R/a₀³: Eqs. (7) and (9), γ the surface energy of one side."""
    target = jkr_target(200e9, 1.0, 6.1e-6)
    assert target.adhesion_force == pytest.approx(3.0 * math.pi * 1.0 * 6.1e-6, rel=ROUND_OFF)
    assert 3.0 * target.adhesion_force * 6.1e-6 / target.zero_load_radius**3 == pytest.approx(200e9, rel=ROUND_OFF)
    assert target.adhesion_force == pytest.approx(57.491e-6, rel=1e-5)
    assert target.zero_load_radius == pytest.approx(173.92e-9, rel=1e-4)


# What can be reached.


@pytest.mark.parametrize(("reduction", "share"), [("geike_popov", 1.0), ("mdr", 0.5)])
@pytest.mark.parametrize("spacing", [1.0, 0.5])
def test_border_of_what_can_be_reached_is_the_brittle_limit(reduction: str, share: float, spacing: float) -> None:
    """c = k/2s of both chains in series, R₁ the radius of the chain's own parabola."""
    scene = scene_of(reduction=reduction, spacing=spacing)
    layer, a_0 = 0.83 / (2.0 * spacing), 20.0
    border = REACH * layer * a_0**3 / (200.0 * share)
    require_reachable(scene, Target(0.999 * border, a_0))
    with pytest.raises(IdentifyError):
        require_reachable(scene, Target(1.001 * border, a_0))


def test_error_names_the_nearest_values_and_these_are_accepted() -> None:
    scene, wanted = scene_of(), Target(12.0, 20.0)
    with pytest.raises(IdentifyError) as caught:
        require_reachable(scene, wanted)
    found = re.search(
        r"an adhesion force of 12 FU with a zero-load radius of 20 LU is not possible with springs of this stiffness.*"
        r"the same force with a radius of at least ([\d.e+-]+) LU, "
        r"or the same radius with a force of at most ([\d.e+-]+) FU",
        str(caught.value),
    )
    assert found is not None
    radius, force = float(found[1]), float(found[2])
    assert radius > wanted.zero_load_radius
    assert force < wanted.adhesion_force
    require_reachable(scene, Target(wanted.adhesion_force, radius))
    require_reachable(scene, Target(force, wanted.zero_load_radius))
    for target in (Target(12.0, radius * 0.999), Target(force * 1.001, 20.0)):
        with pytest.raises(IdentifyError):
            require_reachable(scene, target)


def test_jkr_with_the_springs_of_the_mdr_can_be_reached() -> None:
    """F_A R₁/(c a₀³) = 1/6 for every sphere, whatever its material."""
    for modulus, energy, radius in ((200e9, 1.0, 6.1e-6), (1e6, 0.03, 1e-3), (3e9, 0.05, 1e-7)):
        scene, wanted = material_scene(modulus, radius, jkr_target(modulus, energy, radius), tolerance=1e-3)
        require_reachable(scene, wanted)
        assert scene.bodies.profile.curvature_radius is not None
        own, layer = 0.5 * scene.bodies.profile.curvature_radius, 0.5 * scene.bulk_stiffness
        share = wanted.adhesion_force * own / (layer * wanted.zero_load_radius**3)
        assert share == pytest.approx(1.0 / 6.0, rel=10.0 * ROUND_OFF)


@pytest.mark.parametrize(
    ("scene", "words"),
    [
        (scene_of(experiment={"kind": "path", "displacements": [0.1]}), "only a pull_off with an attraction"),
        (scene_of(experiment={"kind": "load", "force": 1.0}), "only a pull_off with an attraction"),
        (scene_of({"kind": "circle", "radius": 200.0}), "only a parabola has the F_A and a₀ of JKR's sphere"),
        (scene_of({"kind": "cone", "slope": 0.1}), "only a parabola"),
    ],
)
def test_scene_that_is_no_pull_off_of_a_parabola_is_refused(scene: Scene, words: str, tmp_path: Path) -> None:
    with pytest.raises(IdentifyError, match=words):
        require_reachable(scene, Target(1.0, 20.0))
    with pytest.raises(IdentifyError, match=words):
        identify(scene, Target(1.0, 20.0), tmp_path / "run")
    assert not (tmp_path / "run").exists()


# The scene of a material.


def test_scene_of_a_material_has_its_radius_stiffness_and_target() -> None:
    si = jkr_target(200e9, 1.0, 6.1e-6)
    scene, wanted = material_scene(200e9, 6.1e-6, si, tolerance=TOLERANCE)
    assert scene.material is not None
    length, force = scene.material.length_unit, scene.material.force_unit
    assert length is not None
    assert force is not None
    assert wanted.adhesion_force * force == pytest.approx(si.adhesion_force, rel=ROUND_OFF)
    assert wanted.zero_load_radius * length == pytest.approx(si.zero_load_radius, rel=ROUND_OFF)
    assert scene.bodies.profile.curvature_radius == pytest.approx(6.1e-6 / length, rel=ROUND_OFF)
    assert wanted.zero_load_radius == pytest.approx(28.5, rel=ROUND_OFF)
    assert scene.bulk_stiffness == pytest.approx(1.0, rel=ROUND_OFF)
    assert 0.5 * scene.bulk_stiffness * force / length**2 == pytest.approx(200e9, rel=ROUND_OFF)
    assert (scene.bodies.reduction, scene.accuracy.tolerance) == ("mdr", TOLERANCE)


def test_coarse_length_unit_is_refused_with_the_coarsest() -> None:
    si = jkr_target(200e9, 1.0, 6.1e-6)
    with pytest.raises(IdentifyError) as caught:
        material_scene(200e9, 6.1e-6, si, length_unit=50e-9, tolerance=1e-3)
    assert "a length unit of 5e-08 m gives 3.5 particles in the zero-load radius of 1.739e-07 m" in str(caught.value)
    found = re.search(r"at most ([\d.e+-]+) m for 8$", str(caught.value))
    assert found is not None
    coarsest = float(found[1])
    assert coarsest == pytest.approx(si.zero_load_radius / 8.0, rel=1e-3)
    material_scene(200e9, 6.1e-6, si, length_unit=0.999 * coarsest, tolerance=1e-3)
    with pytest.raises(IdentifyError):
        material_scene(200e9, 6.1e-6, si, length_unit=1.001 * coarsest, tolerance=1e-3)


# One search.


def test_search_ends_at_its_target_and_keeps_the_shape_of_the_law(tmp_path: Path) -> None:
    """F_A R₁/(c a₀³) = 0.15, below JKR's 1/6; the scene's own law has 0.95 FU and 11.6 LU or so."""
    scene = scene_of()
    a_0 = 13.0
    target = Target(0.15 * 0.415 * a_0**3 / 200.0, a_0)
    found = identify(scene, target, tmp_path / "run")
    assert 1 <= found.runs <= 5
    assert max(map(abs, found.deviations)) < 0.3 * TOLERANCE * 1.01
    results = json.loads((tmp_path / "run" / "results.json").read_text())
    assert results == found.run.document
    force, radius = results["adhesion_force"]["value"], results["zero_load_radius"]["value"]
    assert force / target.adhesion_force - 1.0 == pytest.approx(found.deviations[0], abs=ROUND_OFF)
    assert radius / target.zero_load_radius - 1.0 == pytest.approx(found.deviations[1], abs=ROUND_OFF)
    assert read_scene(results["scene"]) == found.scene
    law = found.scene.interaction
    assert law is not None
    assert law.attraction is not None
    assert law.repulsion.amplitude / law.attraction.amplitude == pytest.approx(2.0, rel=ROUND_OFF)
    assert law.attraction.range / law.repulsion.range == pytest.approx(2.0, rel=ROUND_OFF)
    assert found.scene == scene.model_copy(update={"interaction": law})
