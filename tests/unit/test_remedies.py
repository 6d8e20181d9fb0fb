"""What helps a scene that gives no result: which changes are tried, in which order, and what is said of them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from contact1d.workflow.continuation.trust import (
    ChainEndError,
    OffEndError,
    PartedError,
    ThroughError,
    UnsteadyError,
    UntrustedError,
)
from contact1d.workflow.errors import Contact1dError, RunError
from contact1d.workflow.runs import remedies
from contact1d.workflow.runs.remedies import Change, Tried, tried
from contact1d.workflow.scene import Scene, SceneError, read_scene, scene_from_dict
from contact1d.workflow.settings.estimate import NotCarriedError
from contact1d.workflow.settings.settings import SettingsError
from tests.scenes import chains

LAW = (0.18, 0.13, 0.09, 0.26)
PULL = {"kind": "pull_off", "preload": 3.0}


def scene_of(**changes: Any) -> Scene:
    return scene_from_dict(chains(1000.0, law=LAW, experiment=PULL, horizontal={}) | changes)


def failed(cause: Exception) -> RunError:
    error = RunError("it failed", Path("nowhere"))
    error.__cause__ = cause
    return error


def attempts(holds: Callable[[Scene], bool], cause: Exception) -> tuple[Callable[[Scene], None], list[Scene]]:
    """An attempt that fails by `cause` where a scene does not hold, and the scenes that it was asked for."""
    seen: list[Scene] = []

    def attempt(scene: Scene) -> None:
        seen.append(scene)
        if not holds(scene):
            raise failed(cause)

    return attempt, seen


def found(scene: Scene, error: Contact1dError, holds: Callable[[Scene], bool], then: Exception | None = None) -> Tried:
    attempt, _ = attempts(holds, then or ThroughError("through"))
    return tried(lambda change: read_scene(scene, change.overrides, change.without), error, attempt, lambda _: None)


def test_horizontal_is_left_out_first_where_bodies_went_through_each_other() -> None:
    done = found(scene_of(), failed(ThroughError("through")), lambda scene: scene.horizontal is None)
    assert done.helped == (Change(without=("horizontal",)),)
    assert str(done).startswith(
        "Tried: --without horizontal gives a result; --set interaction.attraction.amplitude=0.03, "
    )


def test_two_changes_that_help_are_enough() -> None:
    done = found(scene_of(), failed(ThroughError("through")), lambda _: True)
    assert str(done) == (
        "Tried: --without horizontal gives a result, and so does --set interaction.attraction.amplitude=0.03"
    )


def test_changes_go_together_where_none_alone_helps() -> None:
    def holds(scene: Scene) -> bool:
        return scene.horizontal is None and scene.experiment.compression == 1.0

    done = found(scene_of(), failed(ThroughError("through")), holds)
    (both,) = done.helped[:1]
    assert both == Change({"experiment.preload": 1.0}, ("horizontal",))
    assert str(both) == "--without horizontal --set experiment.preload=1.0"
    assert read_scene(scene_of(), both.overrides, both.without).horizontal is None


def test_longer_chain_is_tried_where_the_contact_reaches_its_end_and_then_what_fails_there() -> None:
    def holds(scene: Scene) -> bool:
        return scene.bodies.particles == "auto" and scene.horizontal is None

    scene = scene_of().with_({"bodies.particles": 67})
    done = found(scene, failed(ChainEndError("end")), holds)
    assert Change({"bodies.particles": "auto"}, ("horizontal",)) in done.helped


def test_load_that_is_not_carried_is_lowered() -> None:
    error = SettingsError("more than these bodies carry")
    error.__cause__ = NotCarriedError(2.0)
    assert found(scene_of(), error, lambda _: True).helped[0] == Change({"experiment.preload": 1.0})


def test_way_that_is_too_deep_is_made_shorter() -> None:
    way = {"kind": "path", "displacements": {"from": 0.0, "to": 6.0, "steps": 40}}
    scene = scene_from_dict(chains(1000.0, law=LAW, experiment=way))
    done = found(scene, failed(ThroughError("through")), lambda scene: max(scene.experiment.places()) < 3.0)
    assert str(done.helped[0]) == "--set experiment.displacements.to=2.0"


def test_law_that_never_attracts_is_mended_by_either_range() -> None:
    bad = chains(1000.0, law=LAW, experiment=PULL)
    bad["interaction"]["repulsion"]["range"] = 0.39
    with pytest.raises(SceneError) as caught:
        scene_from_dict(bad)
    attempt, seen = attempts(lambda _: True, ThroughError("through"))
    done = tried(lambda change: read_scene(bad, change.overrides), caught.value, attempt, lambda _: None)
    assert done.helped == (
        Change({"interaction.attraction.range": 0.78}),
        Change({"interaction.repulsion.range": 0.13}),
    )
    assert [scene.interaction is not None for scene in seen] == [True, True]


def test_effect_that_the_experiment_is_about_is_never_left_out() -> None:
    sliding = chains(30.0, law=(1.0, 0.5, 0.5, 1.0)) | {
        "horizontal": {},
        "damping": {"coefficient": "auto"},
        "plate": {"free": ["x", "z"]},
        "cantilever": {"stiffness": 20.0, "velocity": 0.05},
        "experiment": {"kind": "slide", "normal_force": 1.0, "distance": 6.0},
    }
    done = found(scene_from_dict(sliding), failed(ThroughError("through")), lambda _: True)
    assert all("horizontal" not in change.without for change in (*done.helped, *done.failed))


def test_nothing_is_tried_against_what_no_change_of_the_scene_helps() -> None:
    assert str(found(scene_of(), failed(OSError("no space left")), lambda _: True)) == ""


def test_what_was_tried_in_vain_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(remedies, "MOST_TRIALS", 3)
    said = str(found(scene_of(), failed(UntrustedError("no end in sight")), lambda _: False))
    assert said.startswith("Tried in vain: --without horizontal, --set bodies.bulk_stiffness=")
    assert said.count("--set") == 2


def slide_of(**changes: Any) -> Scene:
    """The shipped slide."""
    shipped = Path(__file__).parents[2] / "lammps_inputs" / "scenes" / "slide.toml"
    return read_scene(shipped).with_({key.replace("__", "."): value for key, value in changes.items()})


def test_slide_that_is_none_yet_goes_a_longer_way_on_a_longer_chain_or_has_a_stiffer_cantilever() -> None:
    way = found(slide_of(), failed(UnsteadyError("not yet")), lambda _: True)
    assert way.helped == (Change({"experiment.distance": 24.0}), Change({"cantilever.stiffness": 1.5}))
    given = slide_of(bodies__particles=60, bodies__upper_particles=36)
    longer = found(given, failed(UnsteadyError("not yet")), lambda _: True).helped[0]
    assert longer.values == {"experiment.distance": 24.0, "bodies.particles": 92, "bodies.upper_particles": 36}


def test_plate_that_runs_off_has_more_below_it() -> None:
    given = slide_of(bodies__particles=60, bodies__upper_particles=36)
    longer = found(given, failed(OffEndError("off")), lambda _: True).helped[0]
    assert longer.values == {"bodies.particles": 76, "bodies.upper_particles": 36}


def test_pull_that_nothing_holds_is_none() -> None:
    pulled = found(slide_of(experiment__normal_force=-5.0), failed(PartedError("part")), lambda _: True)
    assert pulled.helped[0] == Change({"experiment.normal_force": 0.0})


def test_slide_that_goes_through_as_it_is_loaded_has_more_drag() -> None:
    light = slide_of(damping__coefficient=0.01, plate__damping=0.0)
    drag = found(light, failed(ThroughError("through")), lambda scene: scene.plate is not None).helped[0]
    assert drag == Change({"damping.coefficient": "auto", "plate.damping": "auto"})


def test_a_way_of_less_than_some_periods_is_made_one_of_some() -> None:
    way = found(slide_of(experiment__distance=0.1), failed(UnsteadyError("not yet")), lambda _: True).helped[0]
    assert way == Change({"experiment.distance": 8.0})


def test_a_heavy_plate_is_made_lighter_before_a_slide_is_made_longer() -> None:
    heavy = slide_of(plate__mass=1e5)
    assert found(heavy, failed(UnsteadyError("not yet")), lambda _: True).helped[0] == Change({"plate.mass": "auto"})


@pytest.mark.parametrize("error", [ThroughError("through"), PartedError("part")])
def test_heat_that_throws_particles_out_is_lowered_first(error: UntrustedError) -> None:
    """To a tenth of the depth of a well: 0.0625 FU·LU at a distance of ln 4 LU."""
    hot = slide_of(noise={"temperature": 10.0, "seed": 1})
    assert found(hot, failed(error), lambda _: True).helped[0] == Change({"noise.temperature": 0.00625})


def test_of_many_changes_in_vain_the_first_are_named() -> None:
    changes = tuple(Change({"experiment.distance": float(n)}) for n in range(7))
    said = str(Tried(failed=changes))
    assert said.endswith("--set experiment.distance=3.0 and 3 more")
    assert " more" not in str(Tried(failed=changes[:4]))


def test_a_drive_that_is_over_before_the_plate_swings_is_made_slower() -> None:
    """116 MU on 0.5 FU/LU swing once in 95.7 TU: 8 LU in three of that."""
    quick = slide_of(cantilever__velocity=50.0)
    slower = found(quick, failed(UnsteadyError("not yet")), lambda _: True).helped[0]
    assert slower == Change({"cantilever.velocity": 0.0279})
