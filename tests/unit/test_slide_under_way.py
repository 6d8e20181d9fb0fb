"""A slide from its load to its end, over states that are given: at rest, its rows, its ends."""

from __future__ import annotations

from contextlib import contextmanager
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.deck.steps import Hold, UnderLoad
from contact1d.workflow.experiments.running.contact import TOLD
from contact1d.workflow.experiments.running.holding import Start, at_rest, hold_row
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps
from contact1d.workflow.experiments.running.trust import OffEndError, PartedError, RestlessError, UnsteadyError
from contact1d.workflow.experiments.slide.findings import outcome_of
from contact1d.workflow.experiments.slide.kind import planned
from contact1d.workflow.experiments.slide.loading import loaded, loading_phase
from contact1d.workflow.experiments.slide.slide import leg_begin, leg_name, slide
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.given import PROFILE, X, at
from tests.unit.test_settings_similarity import SCENES
from tests.unit.test_slide_motion import Given, rows_of

FORCE = 1.0


def scene_of(heat: bool = False, **slide: Any) -> Scene:
    tables = SCENES["slide of few particles over another spacing"]
    noise = {"noise": {"temperature": 1e-3, "seed": 1}} if heat else {}
    return scene_from_dict(tables | noise | {"experiment": tables["experiment"] | slide})


def pushed(friction: float = 0.0, pull: float = 0.0, speed: float = 0.0, **more: Any) -> Any:
    """A plate under FORCE, with this friction against +x [FU] on particles 1.3 LU apart, and a cantilever's pull."""
    shear = np.full(X.size, -friction / 1.3 / X.size)
    profile = replace(PROFILE, shear=shear)
    return at(0.2, FORCE, profile=profile, cantilever_force=pull, motion={"vcm(plate,x)": speed}, **more)


class Loading:
    """Gives these states, one after the other, the last again and again."""

    def __init__(self, *states: Any, scene: Scene | None = None, **changed: Any) -> None:
        """Of a slide."""
        self.scene = scene or scene_of()
        self.settings: Settings = replace(settings_for(self.scene), **changed)
        self.rows: list[Any] = []
        self.begun: list[tuple[str, Any]] = []
        self._states = list(states)

    def begin(self, name: str, fragments: tuple[str, ...] = (), expected_steps: int | None = None) -> None:
        """Note it."""
        self.begun.append((name, expected_steps))

    def row(self, row: Any) -> Any:
        """The next."""
        self.rows.append(row)
        return self._states.pop(0) if len(self._states) > 1 else self._states[0]


def opened(*states: Any, **more: Any) -> Any:
    return Loading(*states, **more)


CALM = {"calm_damping": 0.9}
"""Drag of the way that is not the scene's own, 0.3."""


def test_a_plate_is_loaded_with_a_drag_of_the_way_and_then_has_its_own() -> None:
    last = pushed()
    contact = opened(pushed(), last, **CALM)
    calm = replace(contact.settings, damping=0.9)
    assert loaded(contact, FORCE) is last
    first, own = contact.rows
    assert first == hold_row(contact.scene, calm, FORCE, FORCE, Start.KEPT)
    assert own == hold_row(contact.scene, contact.settings, FORCE, FORCE, Start.HERE)
    assert contact.begun == [("loading", None)]
    same = opened(pushed(), calm_damping=contact.settings.damping)
    loaded(same, FORCE)
    assert len(same.rows) == 1
    assert loading_phase(contact.scene, contact.settings, FORCE).rows == (first, own)
    assert len(loading_phase(same.scene, same.settings, FORCE).rows) == 1
    assert loading_phase(contact.scene, contact.settings, 0.0).rows[0] == hold_row(
        contact.scene, calm, 0.0, contact.settings.force_scale, Start.KEPT
    )
    assert loading_phase(contact.scene, contact.settings, -0.5).rows[0] == hold_row(
        contact.scene, calm, -0.5, 0.5, Start.KEPT
    )


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_rest_along_x_is_that_of_friction_and_pull_and_of_the_speed(side: float) -> None:
    """The drag of all particles and the plate is not to carry more than the threshold, nor the two to differ by it."""
    probe = opened(pushed(), **CALM)
    near, drag = at_rest(probe.settings, FORCE), 12 * 0.9 + 0.1
    assert probe.settings.particles == 12
    for share, rows in ((0.99, 1), (1.01, 2)):
        for state in (
            pushed(0.4, 0.4 - side * share * near), pushed(-0.4, side * share * near - 0.4),
            pushed(0.3, 0.3, side * share * near / drag),
        ):  # fmt: skip
            contact = opened(state, pushed(), **CALM)
            loaded(contact, FORCE)
            assert len(contact.rows) == rows + 1
            if rows == 2:
                again = contact.rows[1]
                assert isinstance(again, Hold)
                assert (again.rest, again.start, again.damping) == (0.0, Start.HERE, 0.9)
                assert again.steps == round(contact.settings.settle_time / contact.settings.time_step)


def test_a_plate_that_swings_on_along_x_is_told_after_fifty_rows() -> None:
    contact = opened(pushed(0.5, 0.0, 0.125), **CALM)
    steps = round(contact.settings.settle_time / contact.settings.time_step)
    with pytest.raises(RestlessError, match=rf"within {50 * steps} timesteps: it is left with 0\.12 LU/TU"):
        loaded(contact, FORCE)
    assert len(contact.rows) == 1 + 50
    with pytest.raises(PartedError, match="do not hold a normal force of -1 FU"):
        loaded(opened(replace(pushed(), displacement=-99.0, smallest_distance=99.0, force=0.0)), -1.0)


def test_under_heat_a_plate_forgets_its_start() -> None:
    last = pushed()
    contact = opened(*[pushed(0.1)] * (SETTLING_LOOKS - 1), last, scene=scene_of(heat=True))
    assert loaded(contact, FORCE) is last
    steps = chunk_steps(contact.settings)
    assert contact.rows == [UnderLoad(FORCE, steps)] * SETTLING_LOOKS
    assert contact.begun == [("loading", SETTLING_LOOKS * steps)]
    assert loading_phase(contact.scene, contact.settings, FORCE).rows == tuple(contact.rows)


def test_legs_are_named_and_begun_as_the_drive_turns() -> None:
    assert [leg_name(n) for n in range(3)] == ["sliding", "sliding_2", "sliding_3"]
    cold, hot = scene_of(), scene_of(heat=True)
    assert [leg_begin(cold, n) for n in range(3)] == [("steps/drive",), ("steps/turn",), ("steps/turn",)]
    assert leg_begin(hot, 0) == ("steps/drive", TOLD)
    path = scene_of(distance=None, path=[[0.1, 3.0], [-0.1, 3.0]])
    phases = planned(path, settings_for(path))
    assert [(phase.name, phase.state) for phase in phases] == [
        ("loading", False), ("sliding", False), ("sliding_2", True),
    ]  # fmt: skip


class Sliding:
    """The states of a motion in formulas, after a loading that is at rest at once; it may end early."""

    def __init__(self, scene: Scene, change: Any = lambda number, state: state) -> None:
        """`change`: of the state of a row, by its number."""
        self.scene, self.settings = scene, settings_for(scene)
        given = Given(scene, self.settings)
        start, states = rows_of(given)
        self.start = replace(pushed(), motion=start.motion | {"vcm(plate,x)": 0.0}, step=start.step)
        self.states = [
            change(n, replace(self.start, motion=s.motion, step=s.step, plate_x=s.plate_x - start.plate_x,
                              displacement=s.displacement, cantilever_force=s.cantilever_force, profile=replace(
                                  PROFILE, shear=np.full(X.size, float(s.profile.shear.sum()) / X.size))))
            for n, s in enumerate(states)
        ]  # fmt: skip
        self.deck = SimpleNamespace(scene=scene, settings=self.settings)
        self.left: Any = None
        self.phases: tuple[Any, ...] = ()
        self.rows: list[Any] = []
        self.ended: list[str] = []
        self.begun: list[tuple[str, Any, Any]] = []

    @contextmanager
    def contact(self) -> Any:
        """This."""
        yield self

    def begin(self, name: str, fragments: tuple[str, ...] = (), expected_steps: int | None = None) -> None:
        """Note it."""
        self.begun.append((name, fragments, expected_steps))

    def row(self, row: Any) -> Any:
        """At rest under a load, then the next of the motion."""
        if isinstance(row, Hold):
            return self.start
        self.rows.append(row)
        return self.states[len(self.rows) - 1]

    def write_state(self) -> None:
        """Note it."""
        self.ended.append("state")

    def finish(self) -> None:
        """Note it."""
        self.ended.append("end")


def test_a_slide_is_all_rows_of_its_drive() -> None:
    contact: Any = Sliding(scene_of())
    found = slide(contact)
    (leg,) = contact.settings.drive
    assert contact.rows == [UnderLoad(FORCE, leg.steps)] * leg.rows
    assert contact.begun[-1] == ("sliding", ("steps/drive",), leg.rows * leg.steps)
    assert contact.ended == ["state", "end"]
    known = outcome_of(contact.deck, contact.start, contact.states, ())
    assert found.quantities == known.quantities
    assert found.states == (contact.start, *contact.states)
    assert contact.left is None


def test_a_path_of_the_drive_may_end_without_sliding_and_one_way_may_not() -> None:
    """Two periods: too few for a mean."""
    short: Any = Sliding(scene_of(distance=2.0))
    with pytest.raises(UnsteadyError, match="2 whole periods"):
        slide(short)
    assert short.left.quantities.keys() == {
        "cantilever_work", "dissipated_energy", "stored_energy", "slips", "static_friction",
    }  # fmt: skip
    path: Any = Sliding(scene_of(distance=None, path=[[0.1, 2.0], [-0.1, 1.0]]))
    found = slide(path)
    assert path.left is None
    assert [name for name, _, _ in path.begun] == ["loading", "sliding", "sliding_2"]
    assert len(found.states) == 1 + sum(leg.rows for leg in path.settings.drive)


@pytest.mark.parametrize("row", [0, 20])
def test_a_slide_that_ends_early_leaves_what_it_has(row: int) -> None:
    contact: Any = Sliding(scene_of(), lambda n, s: replace(s, smallest_distance=99.0) if n == row else s)
    with pytest.raises(PartedError, match="the bodies parted on the way"):
        slide(contact)
    if row:
        assert contact.left.states == (contact.start, *contact.states[:row])
    else:
        assert contact.left is None
    off: Any = Sliding(scene_of(), lambda n, s: replace(s, plate_x=1e3) if n == row else s)
    with pytest.raises(OffEndError, match="ran off the lower body"):
        slide(off)
