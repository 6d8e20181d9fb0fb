"""`bodies.spacing = "auto"`: who can have it, what is chosen, and where it is refused in words whose remedies work."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from contact1d import SettingsError, load_run, run, write_deck
from contact1d.workflow.scene import Scene, SceneError, read_scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.settings.spacing import _contact_radius, _up, left_by_lattice, with_spacing

ROUND_OFF = 1e-12
FEWEST, MOST = 30, 5000
"""Particles in a contact radius."""
E_STAR, R, LOAD = 1e9, 1e-3, 1.0
PATH = {"kind": "path", "displacements": [1e-7]}
TANGENTIAL = {"kind": "tangential", "normal_force": LOAD, "displacements": [1e-8]}
PUNCH = {"kind": "flat_punch", "radius": R}


def tables(**more: Any) -> dict[str, Any]:
    """A sphere under a load; `more` is merged into its tables."""
    scene: dict[str, Any] = {
        "title": "automatic",
        "bodies": {
            "particles": "auto", "spacing": "auto", "lower": "rigid_plane",
            "profile": {"kind": "parabola", "radius": R},
        },
        "material": {"contact_modulus": E_STAR, "length_unit": 1.0, "force_unit": 1.0},
        "experiment": {"kind": "load", "force": LOAD},
    }  # fmt: skip
    for name, table in more.items():
        scene[name] = scene.get(name, {}) | table if name != "experiment" else table
    return scene


def chosen(**more: Any) -> Scene:
    """The scene with its spacing."""
    return with_spacing(scene_from_dict(tables(**more)))


def refused(**more: Any) -> list[str]:
    """What is said of a scene that cannot have it."""
    with pytest.raises(SceneError) as caught:
        scene_from_dict(tables(**more))
    return [str(problem) for problem in caught.value.problems]


def test_a_smaller_tolerance_takes_nearer_particles_and_their_stiffness_follows() -> None:
    coarse, fine = (chosen(accuracy={"tolerance": tolerance}) for tolerance in (1e-3, 1e-5))
    assert 3.0 < coarse.bodies.spacing / fine.bodies.spacing < 20.0
    for scene in (coarse, fine):
        assert scene.bulk_stiffness == pytest.approx(E_STAR * scene.bodies.spacing, rel=ROUND_OFF)


def test_a_number_is_left_as_it_is() -> None:
    scene = scene_from_dict(tables(bodies={"spacing": 1e-6}))
    assert with_spacing(scene) is scene


def test_a_flat_punch_is_a_whole_number_of_particles_wide() -> None:
    scene = chosen(bodies={"profile": PUNCH})
    wide = 2.0 * R / scene.bodies.spacing
    assert wide == pytest.approx(round(wide), rel=ROUND_OFF)


@pytest.mark.parametrize("scale", [1e-9, 1e-3, 1e6])
def test_the_unit_of_length_does_not_matter(scale: float) -> None:
    one = chosen().bodies.spacing
    other = chosen(
        bodies={"profile": {"kind": "parabola", "radius": R / scale}},
        material={"length_unit": scale},
    ).bodies.spacing
    assert other * scale == pytest.approx(one, rel=1e-6)  # the same contact, its radius found in steps of another size


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"bodies": {"particles": 100}}, 'bodies.particles = 100: must be "auto" with spacing = "auto"'),
        (
            {"bodies": {"bulk_stiffness": 1.0}},
            "the stiffness of a particle is E* times the spacing; write it, and [mat",
        ),
        ({"bodies": {"bulk_stiffness_tangential": 1.0}}, "it belongs to one particle; remove it: it follows from ν"),
        ({"bodies": {"profile": {"kind": "flat"}}}, "must be a length (LU) of a flat body without an edge"),
        ({"bodies": {"lower": "particles"}}, 'must be a length (LU) with bodies.lower = "particles"'),
        ({"neighbours": {"stiffness": 1.0}}, "must be a length (LU) with [neighbours]: masses, drags and springs"),
        ({"experiment": {"kind": "load", "force": 1.0, "method": "dynamic"}, "damping": {}, "plate": {}}, "[damping]"),
    ],
)
def test_who_cannot_have_it_is_told_why(more: dict[str, Any], words: str) -> None:
    assert any(words in line for line in refused(**more))


@pytest.mark.parametrize("wrong", [None, "lots", 2])
def test_particles_that_are_missing_or_wrong_are_told_once(wrong: Any) -> None:
    scene = tables()
    scene["bodies"] = {key: value for key, value in scene["bodies"].items() if key != "particles"}
    scene["bodies"] |= {} if wrong is None else {"particles": wrong}
    with pytest.raises(SceneError) as caught:
        scene_from_dict(scene)
    assert [problem.path for problem in caught.value.problems] == ["bodies.particles"]


def test_without_a_material_there_is_nothing_to_take_the_stiffness_from() -> None:
    scene = {name: table for name, table in tables().items() if name != "material"}
    with pytest.raises(SceneError, match=r"bodies\.bulk_stiffness: missing; add \[material\] with E"):
        scene_from_dict(scene)


def test_too_many_particles_are_refused_with_a_tolerance_that_works() -> None:
    along = {"friction": {"coefficient": 0.3}, "experiment": TANGENTIAL}
    with pytest.raises(SettingsError, match=f"not kept by {MOST} particles .* Take an accuracy") as caught:
        chosen(accuracy={"tolerance": 1e-7}, **along)
    found = re.search(r"tolerance of (\S+), or", str(caught.value))
    assert found is not None
    assert chosen(accuracy={"tolerance": float(found[1])}, **along).bodies.spacing > 0.0


def test_where_nothing_touches_there_is_no_spacing_to_choose() -> None:
    with pytest.raises(SettingsError, match="nothing touches in this experiment"):
        chosen(experiment={"kind": "path", "displacements": [-1e-6, 0.0]})


def test_a_run_keeps_the_number_and_its_folder_repeats_it(tmp_path: Path) -> None:
    scene = scene_from_dict(tables(experiment=PATH))
    first = run(scene, tmp_path / "first", figures=False)
    kept = read_scene(tmp_path / "first" / "scene.toml")
    assert kept.bodies.given_spacing == first.scene.bodies.given_spacing == with_spacing(scene).bodies.spacing
    again = run(kept, tmp_path / "again", figures=False)
    assert again.results == first.results == load_run(tmp_path / "first").results
    write_deck(scene, tmp_path / "deck")
    assert (tmp_path / "deck" / "system.data").read_text() == (tmp_path / "first" / "system.data").read_text()


def test_a_change_of_the_scene_chooses_anew() -> None:
    scene = scene_from_dict(tables())
    finer = scene.with_({"accuracy.tolerance": 1e-6})
    assert finer.bodies.given_spacing == "auto"
    assert with_spacing(finer).bodies.spacing < with_spacing(scene).bodies.spacing


KINDS: dict[str, dict[str, Any]] = {
    "load": {},
    "path": {"experiment": PATH | {"displacements": [0.0, 1e-6, 2e-7]}},
    "friction": {"friction": {"coefficient": 0.3}, "experiment": TANGENTIAL},
    "pull-off": {"adhesion": {"work_of_adhesion": 0.5}, "experiment": {"kind": "pull_off", "preload": LOAD}},
    "tension": {"adhesion": {"work_of_adhesion": 0.5}, "experiment": {"kind": "load", "force": -1e-3}},
}


@pytest.mark.parametrize("tolerance", [1e-2, 1e-3])
@pytest.mark.parametrize("kind", KINDS)
def test_the_lattice_leaves_no_more_than_the_tolerance_and_is_no_finer_than_that_asks_for(
    kind: str, tolerance: float
) -> None:
    scene = chosen(accuracy={"tolerance": tolerance}, **KINDS[kind])
    count = _contact_radius(scene) / scene.bodies.spacing
    assert FEWEST * 0.99 <= count <= MOST * 1.01
    left = left_by_lattice(scene)
    assert 0.0 < left <= tolerance
    assert left > 0.02 * tolerance or count < 1.1 * FEWEST


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-5])
def test_springs_at_any_place_of_the_apex_are_within_the_tolerance_of_hertz(tolerance: float) -> None:
    """Displacement under the load, F = (4/3) E* √R d^(3/2); springs E* s under x²/R."""
    scene = chosen(accuracy={"tolerance": tolerance})
    s = scene.bodies.spacing
    hertz = (0.75 * LOAD / (E_STAR * math.sqrt(R))) ** (2.0 / 3.0)
    assert _contact_radius(scene) == pytest.approx(math.sqrt(R * hertz), rel=0.02)
    half = int(1.1 * math.sqrt(R * hertz) / s) + 2
    for phase in (0.0, 0.125, 0.25, 0.5):
        heights = (s * (np.arange(-half, half + 1) + phase)) ** 2 / R

        def over(d: float, heights: Any = heights) -> float:
            return float(E_STAR * s * np.maximum(d - heights, 0.0).sum()) - LOAD

        assert brentq(over, 0.5 * hertz, 2.0 * hertz, xtol=1e-20, rtol=1e-12) == pytest.approx(hertz, rel=tolerance)


@pytest.mark.parametrize("scale", [1e-9, 1e-4])
def test_an_adhesive_contact_has_the_same_spacing_in_any_unit_of_length(scale: float) -> None:
    pull = {"adhesion": {"work_of_adhesion": 0.5}, "experiment": {"kind": "pull_off", "preload": LOAD}}
    one = chosen(**pull).bodies.spacing
    there = {
        "bodies": {"profile": {"kind": "parabola", "radius": R / scale}}, "material": {"length_unit": scale},
        "adhesion": {"work_of_adhesion": 0.5 * scale},
    }  # fmt: skip
    assert chosen(**pull | there).bodies.spacing * scale == pytest.approx(one, rel=1e-3)


def test_a_pull_off_counts_particles_in_its_contact_at_zero_force_and_a_punch_in_its_own_radius() -> None:
    work = 0.5
    scene = chosen(adhesion={"work_of_adhesion": work}, experiment={"kind": "pull_off", "preload": LOAD})
    zero = (4.5 * math.pi * work * R**2 / E_STAR) ** (1.0 / 3.0)
    assert _contact_radius(scene) == pytest.approx(zero, rel=0.02)
    assert _contact_radius(chosen(bodies={"profile": PUNCH})) == R


@pytest.mark.parametrize("tolerance", [1e-7, 1.01e-6, 1.234e-4, 9.9e-3])
def test_an_advised_tolerance_has_two_figures_and_is_a_little_larger(tolerance: float) -> None:
    told = float(_up(tolerance))
    assert 1.1 * tolerance <= told * (1.0 + 1e-9) <= 1.21 * tolerance
    assert _up(tolerance) == f"{told:.2g}"


def test_where_nothing_can_be_estimated_the_lattice_is_not_to_blame() -> None:
    """A contact over the whole of its body: the run says so, whatever the spacing."""
    circle = {"profile": {"kind": "circle", "radius": R}, "spacing": 1e-5}
    deep = scene_from_dict(tables(bodies=circle, experiment={"kind": "path", "displacements": [10.0 * R]}))
    with pytest.raises(SettingsError, match="spread over the whole profile"):
        settings_for(deep)
    assert left_by_lattice(deep) == 0.0
