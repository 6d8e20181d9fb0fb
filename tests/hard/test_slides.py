"""Hard slides: back and at rest, too fast, off the end, torn off, held by adhesion, chains that do not close."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import RunError, Scene, SceneError, read_scene, run
from contact1d.workflow.deck.lattice import start_offset
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.runs.campaign import run as run_alone
from validation.references.slide import Integrator
from validation.slides import slide_model

SCENES = Path(__file__).parents[2] / "lammps_inputs" / "scenes"
MIRRORED = 1e-9
"""Round-off [LU, FU], as a motion with drag leaves it."""
TRACE = 1e-3
"""Of the peak: legs other than the first have timesteps of their own, and the inertia of the first one's drag."""


def scene_of(**changes: Any) -> Scene:
    """The shipped slide, coarser and quicker."""
    quick = {"cantilever.velocity": 0.02, "accuracy.tolerance": 1e-2, "experiment.distance": 3.0}
    return read_scene(SCENES / "slide.toml").with_(quick | {k.replace("__", "."): v for k, v in changes.items()})


def test_there_and_back_with_a_rest_is_the_motion_of_the_integrator(tmp_path: Path) -> None:
    path = [[0.02, 1.0], [0.0, 0.5], [-0.02, 2.0], [0.03, 0.5]]
    scene = scene_of(experiment={"kind": "slide", "normal_force": 1.0, "path": path})
    scene = scene.with_({"bodies.particles": 48, "bodies.upper_particles": 32})
    settings = settings_for(scene)
    scene = scene.with_({"bodies.upper_offset": start_offset(scene, settings)})
    found = run(scene, tmp_path / "run", figures=False)
    body, drive, friction = Integrator(slide_model(scene, settings)), 0.0, []
    body.settle(settings.motion.time_step, 1e-6)
    for leg in settings.motion.drive:
        trace = body.run(leg.rows * leg.steps, leg.time_step, leg.velocity, start=drive, every=leg.steps)
        drive += leg.velocity * leg.rows * leg.row_time
        friction.append(trace.friction)
    expected = np.concatenate(friction)
    assert found.friction["friction"] == pytest.approx(expected, abs=TRACE * np.abs(expected).max())
    assert found.friction["drive"][-1] == pytest.approx(1.0 - 2.0 + 0.5, abs=1e-9)
    work, lost, stored = (found.results[n].value for n in ("cantilever_work", "dissipated_energy", "stored_energy"))
    assert work == pytest.approx(lost + stored, abs=5e-3 * work)


def test_adhesion_holds_a_slide_without_load(tmp_path: Path) -> None:
    """Even while the plate is pulled up."""
    found = run(scene_of(experiment__normal_force=-0.3), tmp_path / "run", figures=False).results
    assert found["mean_friction"].value > 0.0
    assert found["static_friction"].value > found["mean_friction"].value


def failure(scene: Scene, folder: Path, tried: bool = False) -> str:
    """What is said, with changes that were tried or without."""
    with pytest.raises(RunError) as caught:
        (run if tried else run_alone)(scene, folder / "run", figures=True)
    return str(caught.value)


def test_a_pull_that_nothing_holds_is_told(tmp_path: Path) -> None:
    assert "does not sustain -50 FU" in failure(scene_of(experiment__normal_force=-50.0), tmp_path)


def test_a_slide_that_is_none_yet_leaves_its_trace_and_figure(tmp_path: Path) -> None:
    assert "no steady sliding yet" in failure(scene_of(cantilever__stiffness=0.02), tmp_path)
    for name in ("friction.csv", "friction.png", "curve.csv"):
        assert (tmp_path / "run" / name).is_file()
    assert '"mean_friction"' not in (tmp_path / "run" / "results.json").read_text(encoding="utf-8")


def test_a_chain_too_short_for_the_way_is_refused_before_the_run(tmp_path: Path) -> None:
    with pytest.raises(SettingsError, match="too short for the sliding distance") as caught:
        run(scene_of(bodies__particles=36), tmp_path / "run")
    assert not (tmp_path / "run").exists()
    words = str(caught.value)
    enough = int(words.partition("Use at least ")[2].partition(" ")[0])
    longer = scene_of(bodies__particles=enough, bodies__upper_particles=36)
    assert run(longer, tmp_path / "run", figures=False).status == "done"


def test_an_upper_chain_of_its_own_that_is_too_short_is_the_one_that_is_named(tmp_path: Path) -> None:
    scene = scene_of(bodies__particles=40, bodies__upper_particles=20)
    words = failure(scene, tmp_path, tried=True)  # how long the trial takes depends on the machine
    assert ": --set bodies.upper_particles=40 --set bodies.particles=auto" in words
    longer = scene.with_({"bodies.upper_particles": 40, "bodies.particles": "auto"})
    assert run(longer, tmp_path / "longer", figures=False).status == "done"


def test_a_drive_beyond_what_particles_follow_is_warned(tmp_path: Path) -> None:
    found = run(scene_of(cantilever__velocity=0.3, experiment__distance=12.0), tmp_path / "run", figures=False)
    assert "the bodies cannot follow" in found.warnings["fast"]
    assert "drag" in found.warnings


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
        ({"profile": {"kind": "parabola", "radius": 30.0}}, "not with a body that is not flat"),
        ({"periodic": False}, "needs bodies.periodic"),
        ({"bulk_stiffness_tangential": 2.0}, "must be at most bulk_stiffness"),
        ({"particles": "auto"}, "must be a number with bodies.periodic"),
    ],
)
def test_bodies_without_end_that_cannot_be_are_refused(bodies: dict[str, Any], words: str) -> None:
    with pytest.raises(SceneError) as caught:
        read_scene(flat(**bodies))
    assert words in str(caught.value)


def test_two_and_three_particles_slide_as_one_does(tmp_path: Path) -> None:
    """The rigid plate of two anchors is a line, that of one no rigid body at all."""
    alone = None
    for count in (1, 2, 3):
        tables = flat(upper_particles=count, particles=6, upper_spacing=6.0 / count)
        tables["cantilever"] = {"stiffness": 0.05 * count, "velocity": 0.01}
        tables["experiment"] = {"kind": "slide", "normal_force": 0.2 * count, "distance": 4.0}
        tables["damping"] = {"coefficient": 1.0}
        each = run(tables, tmp_path / str(count), figures=False).results["mean_friction"].value / count
        alone = alone or each
        assert each == pytest.approx(alone, rel=5e-3)


def test_a_tolerance_far_below_the_period_has_far_bonds_whose_bins_fit_into_the_box(tmp_path: Path) -> None:
    """Bonds of 10/tolerance spacings in a box of four: LAMMPS wants no bin a hundred times the box."""
    tables = flat(upper_particles=4, particles=4, lower="particles", bulk_stiffness_tangential=0.6)
    tables |= {"accuracy": {"tolerance": 1e-4}, "cantilever": {"stiffness": 0.4, "velocity": 0.02}}
    tables["experiment"] = {"kind": "slide", "normal_force": 0.8, "distance": 4.0}
    assert run(tables, tmp_path / "run", figures=False).results["mean_friction"].value > 0.0


def test_little_drag_throws_no_slide_through_the_other_body_while_it_is_loaded(tmp_path: Path) -> None:
    """The plate would swing to 25 LU below; the drag of the loading is its own, and gone before the drive starts."""
    scene = scene_of(damping__coefficient=0.02, plate__damping=0.2, experiment__distance=4.0)
    found = run(scene, tmp_path / "run", figures=False)
    text = (tmp_path / "run" / "in.lammps").read_text(encoding="utf-8")
    drags = text.partition("row_damping index ")[2].split("\n")[0].split()
    assert float(drags[0]) > 0.02
    assert float(drags[-1]) == 0.02
    assert found.friction["friction"][0] == pytest.approx(0.0, abs=0.05 * np.abs(found.friction["friction"]).max())


def test_a_slide_that_only_rests_is_not_asked_for_periods(tmp_path: Path) -> None:
    resting = scene_of(experiment={"kind": "slide", "normal_force": 1.0, "path": [[0.0, 1.0]]})
    found = run(resting, tmp_path / "run", figures=False)
    assert "unsteady" not in found.warnings
    assert "mean_friction" not in found.results


def test_the_pair_that_is_named_closes_and_has_as_many_particles() -> None:
    with pytest.raises(SceneError, match="or particles = 5 and upper_particles = 5 with upper_spacing = 1"):
        read_scene(flat(particles=8, upper_particles=5))
    assert read_scene(flat(particles=5, upper_particles=5, upper_spacing=1.0)).bodies.upper_particles == 5


def test_a_slide_back_over_a_body_that_repeats_itself_is_the_mirror_image(tmp_path: Path) -> None:
    """Off either end of the lower chain there is the next one, to what is beside and below a particle."""
    found = {}
    for way in (1.0, -1.0):
        tables = flat(upper_particles=1, particles=4, lower="particles", bulk_stiffness=4.0)
        tables |= {"accuracy": {"tolerance": 1e-2}, "cantilever": {"stiffness": 0.5, "velocity": 0.01}}
        tables["experiment"] = {"kind": "slide", "normal_force": 0.2, "path": [[0.01 * way, 3.0]]}
        found[way] = run(tables, tmp_path / str(way), figures=False)
    there, back = (found[way].friction for way in (1.0, -1.0))
    assert back["plate_x"] == pytest.approx(-there["plate_x"], abs=MIRRORED)
    assert back["friction"] == pytest.approx(-there["friction"], abs=MIRRORED)
    for name, one in found[1.0].results.items():
        assert found[-1.0].results[name].value == pytest.approx(one.value, rel=1e-6, abs=MIRRORED), name
    seen = [
        [(state.smallest_distance, state.profile.z_lower[0]) for state in one.outcome.states]
        for one in found.values()
        if one.outcome
    ]
    np.testing.assert_allclose(seen[1], seen[0], rtol=0.0, atol=MIRRORED)
