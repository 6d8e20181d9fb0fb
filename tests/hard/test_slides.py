"""Hard slides: back and at rest, too fast, off the end, torn off, held by adhesion, chains that do not close."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import RunError, Scene, SettingsError, read_scene, run, write_deck
from tests.scenes import SCENES, refused

MIRRORED = 1e-9
"""Round-off [LU, FU], as a motion with drag leaves it."""


def scene_of(changes: dict[str, Any]) -> Scene:
    """The shipped slide, coarser and quicker."""
    quick = {"cantilever.velocity": 0.02, "accuracy.tolerance": 1e-2, "experiment.distance": 3.0}
    return read_scene(SCENES / "slide.toml").with_(quick | changes)


def test_adhesion_holds_a_slide_that_is_pulled_up() -> None:
    found = run(scene_of({"experiment.normal_force": -0.3})).results
    assert found["static_friction"].value > found["mean_friction"].value > 0.0


def test_a_pull_that_nothing_holds_is_told(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="does not sustain -50 FU"):
        run(scene_of({"experiment.normal_force": -50.0}), tmp_path / "run", figures=False)


def test_a_slide_that_is_none_yet_leaves_its_trace_and_figure(tmp_path: Path) -> None:
    with pytest.raises(RunError, match="no steady sliding yet"):
        run(scene_of({"cantilever.stiffness": 0.02}), tmp_path / "run")
    assert {"friction.csv", "friction.png", "curve.csv"} <= {path.name for path in (tmp_path / "run").iterdir()}
    assert '"mean_friction"' not in (tmp_path / "run" / "results.json").read_text(encoding="utf-8")


def test_a_chain_too_short_for_the_way_is_refused_with_a_number_that_is_enough(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="too short for the sliding distance") as caught:
        write_deck(scene_of({"bodies.particles": 36}), tmp_path / "run")
    assert not (tmp_path / "run").exists()
    enough = int(str(caught.value).partition("Use at least ")[2].partition(" ")[0])
    write_deck(scene_of({"bodies.particles": enough, "bodies.upper_particles": 36}), tmp_path / "run")


def test_a_plate_thrown_off_the_end_is_told_and_its_trace_is_left(tmp_path: Path) -> None:
    """Of a chain that is long enough for the way."""
    thrown = {
        "bodies.particles": 68, "bodies.upper_particles": 36, "bodies.upper_offset": 0.5, "damping.coefficient": 0.01,
        "plate.damping": 0.0, "plate.mass": 36.0, "cantilever": {"stiffness": 0.05, "velocity": 0.05},
    }  # fmt: skip
    with pytest.raises(RunError, match="slid off the lower body"):
        run(scene_of(thrown | {"experiment.distance": 14.0}), tmp_path / "run", figures=False)
    left = {path.name for path in (tmp_path / "run").iterdir()}
    assert {"friction.csv", "curve.csv", "results.json"} <= left


def test_little_drag_throws_no_slide_through_the_other_body_while_it_is_loaded() -> None:
    """The plate would swing to 25 LU below; the drag of the loading is its own, and gone before the drive starts."""
    scene = scene_of({"damping.coefficient": 0.02, "plate.damping": 0.2, "experiment.distance": 4.0})
    friction = run(scene).friction["friction"]
    assert friction[0] == pytest.approx(0.0, abs=0.05 * np.abs(friction).max())


def flat(**bodies: Any) -> dict[str, Any]:
    scene = read_scene(SCENES / "prandtl_tomlinson.toml").model_dump(by_alias=True, exclude_none=True, mode="json")
    return scene | {"bodies": {**scene["bodies"], **bodies}}


@pytest.mark.parametrize(
    ("bodies", "words"),
    [
        (
            {"upper_particles": 34, "particles": 55, "upper_spacing": 1.6},
            "nearest equal lengths: upper_spacing = 1.6176",
        ),
        ({"particles": 8, "upper_particles": 5}, "or particles = 5 and upper_particles = 5 with upper_spacing = 1"),
    ],
)
def test_bodies_without_end_that_cannot_be_are_refused(bodies: dict[str, Any], words: str) -> None:
    assert words in str(refused(flat(**bodies)))


def slid(stiffness: float, load: float, velocity: float = 0.01, **more: Any) -> Any:
    """Flat bodies without end."""
    bodies = {key: more.pop(key) for key in list(more) if key not in ("damping", "accuracy", "path")}
    tables = flat(**bodies) | {"cantilever": {"stiffness": stiffness, "velocity": velocity}}
    way = {"path": more.pop("path")} if "path" in more else {"distance": 4.0}
    tables |= more | {"experiment": {"kind": "slide", "normal_force": load} | way}
    return run(tables)


def test_two_particles_slide_as_one_does() -> None:
    """The rigid plate of two anchors is a line, that of one no rigid body at all."""
    friction = [
        slid(
            0.05 * count, 0.2 * count, damping={"coefficient": 1.0},
            upper_particles=count, particles=6, upper_spacing=6.0 / count,
        ).results.mean_friction.value / count
        for count in (1, 2)
    ]  # fmt: skip
    assert friction[1:] == pytest.approx(friction[:1], rel=5e-3)


SINGLE = {"particles": 4, "lower": "particles"}


def test_a_tolerance_far_below_the_period_has_far_bonds_whose_bins_fit_into_the_box() -> None:
    """Bonds of 10/tolerance spacings in a box of four: LAMMPS wants no bin a hundred times the box."""
    tight = {"accuracy": {"tolerance": 1e-4}, "upper_particles": 4, "bulk_stiffness_tangential": 0.6}
    assert slid(0.4, 0.8, 0.02, **SINGLE, **tight).results.mean_friction.value > 0.0


def test_a_slide_back_over_a_body_that_repeats_itself_is_the_mirror_image() -> None:
    """Off either end of the lower chain there is the next one, to what is beside and below a particle."""
    loose = {"accuracy": {"tolerance": 1e-2}, "upper_particles": 1, "bulk_stiffness": 4.0}
    there, back = (slid(0.5, 0.2, **SINGLE, **loose, path=[[0.01 * way, 3.0]]) for way in (1.0, -1.0))
    for name in ("plate_x", "friction"):
        assert back.friction[name] == pytest.approx(-there.friction[name], abs=MIRRORED)
    for name, one in there.results.items():
        assert back.results[name].value == pytest.approx(one.value, rel=1e-6, abs=MIRRORED), name
    assert back.curve.smallest_distance == pytest.approx(there.curve.smallest_distance, abs=MIRRORED)
