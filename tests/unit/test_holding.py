"""Claims of a load that is held in time: when it counts as at rest, as lost, as gone through, and as never to rest.

States are given one after the other; no LAMMPS.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, Hold, Phase
from contact1d.workflow.experiments.path.path import path
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.holding import (
    FEWEST_STEPS,
    MOST_HOLDS,
    Start,
    _apart,
    _through,
    at_rest,
    damping_under,
    hold,
    hold_row,
    press,
)
from contact1d.workflow.experiments.running.trust import RestlessError, ThroughError, UntrustedError
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.exact import ExactContact, exact_context
from tests.given import Estimate
from tests.scenes import chains

X = np.arange(40) - 19.5
PROFILE = Profile(
    X, 0.0 * X, 0.0 * X + 0.1, np.where(np.abs(X) < 8.0, 1.0, np.where(np.abs(X) < 10, -0.5, 0.0)), 0.0 * X
)
ROUND = {"kind": "parabola", "radius": 100.0}
RULE: Any = None
SNAPPING = (0.18, 0.03, 0.09, 0.06)


class Given:
    """A contact that has these states, one after the other, the last again and again."""

    def __init__(self, *states: State, law: tuple[float, ...] = (0.018, 0.03, 0.009, 0.06), **changed: Any) -> None:
        tables = chains(100.0, law=law, bodies={"particles": 40}, damping={"coefficient": "auto"}, plate={},
                        experiment={"kind": "pull_off", "method": "dynamic", "preload": 0.3})  # fmt: skip
        self.scene = scene_from_dict(tables)
        self.settings = replace(settings_for(self.scene), **changed)
        self.rows: list[Hold] = []
        self._states = list(states)

    def row(self, row: Hold) -> State:
        """The next."""
        self.rows.append(row)
        return self._states.pop(0) if len(self._states) > 1 else self._states[0]


def at(force: float, displacement: float = 0.1, velocity: float = 0.0, pushed: float = 0.0) -> State:
    state = State("loading", displacement, force, PROFILE, 0.05, 0.0, 0.0, RULE)
    return replace(state, plate_velocity=velocity, pushed=pushed)


LOAD, SCALE = 0.3, 0.5


def opened(*states: State, **changed: Any) -> Any:
    return Given(*states, **changed)


def test_a_load_is_held_where_it_is_balanced_and_stays_so() -> None:
    near = at_rest(opened(at(0.0)).settings, SCALE)
    assert near == pytest.approx(0.1 * opened(at(0.0)).settings.tolerance * SCALE)
    for share, rows in ((0.99, 1), (1.01, 2)):
        for sign in (-1.0, 1.0):
            contact = opened(at(LOAD + sign * share * near), at(LOAD))
            held = hold(contact, LOAD, SCALE)
            assert (held.held, len(held.states), held.load) == (True, rows, LOAD)
    pushed = opened(at(LOAD + 0.2, pushed=0.2))
    assert hold(pushed, LOAD, SCALE).unbalance == pytest.approx(0.0, abs=1e-12)


def test_a_plate_that_moves_is_not_at_rest_and_what_drag_carries_is_in_the_claim() -> None:
    first = opened(at(LOAD))
    row = hold_row(first.scene, first.settings, LOAD, SCALE, Start.KEPT)
    moving = first.settings.plate_mass + first.settings.particles * first.scene.bodies.mass
    for share, rows in ((0.99, 1), (1.01, 2)):
        speed = share * row.rest / row.drag
        contact = opened(at(LOAD, velocity=-speed), at(LOAD))
        held = hold(contact, LOAD, SCALE)
        assert len(held.states) == rows
        if rows == 1:
            assert held.unbalance == pytest.approx(row.drag * speed * moving / first.settings.plate_mass)


def test_particles_that_are_part_of_the_plate_are_no_weight_beside_it() -> None:
    contact = opened(at(LOAD))
    contact.scene = scene_from_dict({
        "title": "Adhesion in time",
        "bodies": {"particles": 40, "spacing": 1.0, "bulk_stiffness": 1.0, "lower": "rigid_plane", "profile": ROUND},
        "adhesion": {"work_of_adhesion": 0.01},
        "damping": {"coefficient": "auto"},
        "plate": {},
        "experiment": {"kind": "load", "method": "dynamic", "force": LOAD},
    })  # fmt: skip
    contact.settings = settings_for(contact.scene)
    row = hold_row(contact.scene, contact.settings, LOAD, SCALE, Start.KEPT)
    speed = 0.9 * row.rest / row.drag
    slow = opened(at(LOAD, velocity=-speed))
    slow.scene, slow.settings = contact.scene, contact.settings
    assert hold(slow, LOAD, SCALE).unbalance == pytest.approx(row.drag * speed)


def test_rows_go_on_from_where_the_last_ended_and_look_closer_where_the_plate_stood_still() -> None:
    contact = opened(at(LOAD + 0.1), at(LOAD + 0.1, velocity=1e9), at(LOAD + 0.05), at(LOAD))
    hold(contact, LOAD, SCALE, Start.BACK)
    assert [row.start for row in contact.rows] == [Start.BACK, Start.HERE, Start.HERE, Start.HERE]
    rests = np.array([row.rest for row in contact.rows])
    assert rests / rests[0] == pytest.approx([1.0, 0.5, 0.5, 0.25])


def test_a_contact_is_lost_out_of_reach_or_where_it_moves_off_with_less_than_pulls() -> None:
    settings = opened(at(0.0)).settings
    far = replace(at(0.0, -5.0), smallest_distance=1.01 * settings.cutoff)
    assert not hold(opened(far), -0.2, SCALE).held
    assert not hold(opened(replace(far, force=0.1)), LOAD, SCALE).held
    pull = -0.2
    for share, velocity, lost in ((0.69, -0.1, True), (0.71, -0.1, False), (0.69, 0.1, False)):
        away = at(share * pull, -5.0, velocity)
        contact = opened(away, at(pull))
        held = hold(contact, pull, SCALE)
        assert held.held == (not lost)
        assert held.unbalance == pytest.approx(abs(share - 1.0) * 0.2 if lost else 0.0, abs=1e-12)
        if not lost:  # the next row goes on until nothing can be felt any more
            assert contact.rows[1].parted == _apart(contact.settings) < contact.rows[0].parted
    assert len(hold(opened(at(share * pull, 0.0, -0.1), at(pull)), pull, SCALE).states) == 2  # not yet past that place


def test_a_plate_beyond_where_it_can_swing_to_has_gone_through() -> None:
    settings = opened(at(0.0)).settings
    beyond = _through(settings)
    way = settings.largest_displacement - settings.rest + settings.cutoff
    assert beyond == pytest.approx(settings.largest_displacement + 2.0 * max(way, 1.0))
    with pytest.raises(ThroughError, match="went on to"):
        hold(opened(at(0.1, 1.001 * beyond)), LOAD, SCALE)
    assert hold(opened(at(0.1, 0.999 * beyond), at(LOAD)), LOAD, SCALE).held


def test_what_never_comes_to_rest_is_said_after_so_many_rows() -> None:
    contact = opened(at(LOAD + 0.1))
    with pytest.raises(RestlessError, match=rf"within {MOST_HOLDS * FEWEST_STEPS} timesteps .*0\.1 FU"):
        replaced = hold_row(contact.scene, contact.settings, LOAD, SCALE, Start.KEPT)
        contact.settings = replace(contact.settings, settle_time=contact.settings.settle_time * 10 / replaced.steps)
        hold(contact, LOAD, SCALE)
    assert len(contact.rows) == MOST_HOLDS


@pytest.mark.parametrize(("part", "loads"), [(1.0, [0.3]), (0.25, [0.075, 0.15, 0.225, 0.3])])
def test_a_load_comes_on_at_once_or_in_as_many_parts_as_a_search_in_smaller_steps_says(
    part: float, loads: list[float]
) -> None:
    contact = opened(*(at(load) for load in loads), part=part)
    held = press(contact, LOAD, SCALE)
    assert [row.load for row in contact.rows] == pytest.approx(loads)
    assert held.held
    assert [state.force for state in held.states] == pytest.approx(loads)
    nothing = opened(at(0.0), part=part)
    assert press(nothing, 0.0, SCALE).held
    assert len(nothing.rows) == 1


def test_automatic_drag_follows_the_contact_down_and_is_not_less_than_critical_while_gentle() -> None:
    contact = opened(at(0.0))
    settings = contact.settings
    assert damping_under(settings, -10.0) < damping_under(settings, -0.01) < damping_under(settings, 0.3)
    gentle = settings.in_smaller_steps(0.25)
    if gentle.gentle:
        assert damping_under(gentle, 0.3) == damping_under(gentle, 0.0) == gentle.calm_damping
        assert damping_under(gentle, -0.01) == pytest.approx(
            gentle.damping * damping_under(settings, -0.01) / settings.damping
        )
    stiffest = replace(settings, damped_stiffness=1e-9 * settings.damped_stiffness)
    assert damping_under(stiffest, 0.3) == pytest.approx(settings.damping / 0.6**0.5)
    toothed = opened(at(0.0), law=SNAPPING).settings
    assert toothed.is_toothed
    assert damping_under(toothed, -0.01) == damping_under(toothed, 0.3)


class Slowly(ExactContact):
    """A row comes to rest after so many repeats."""

    repeats, seen = 3, 0

    def rows(self, rows: Any) -> list[State]:
        """One after the other."""
        return [self.row(row) for row in rows]

    def row(self, row: Any) -> State:
        """A residual as long as it moves."""
        self.seen += 1
        moves = self.seen <= self.repeats
        return replace(self.state(row.displacement), residual=1.0 if moves else 0.0)


@pytest.mark.parametrize(("repeats", "rows"), [(0, 1), (3, 4), (10**6, 201)])
def test_a_row_that_does_not_end_at_rest_is_repeated_until_it_does(repeats: int, rows: int) -> None:
    scene = scene_from_dict(chains(100.0, bodies={"particles": 40}, experiment={"kind": "pull_off", "preload": 0.3}))
    contact = Slowly(Deck(scene, settings_for(scene)))
    contact.repeats = repeats
    (state,) = contact.replay((Phase("loading", (Displace(0.1),)),), at_rest=lambda state: state.residual == 0.0)
    assert contact.seen == rows
    assert (state.residual == 0.0) == (repeats < 10**6)


def test_a_path_in_time_waits_for_rest_and_one_at_rest_refuses_what_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tests.exact.ExactContact", Slowly)
    experiment = {"kind": "path", "displacements": [0.0, 0.1, 0.0]}
    still = chains(100.0, law=(0.018, 0.03, 0.009, 0.06), bodies={"particles": 40}, experiment=experiment)
    moving = still | {"damping": {"coefficient": "auto"}, "experiment": experiment | {"method": "dynamic"}}
    outcome = path(exact_context(scene_from_dict(moving)))
    assert all(state.residual == 0.0 for state in outcome.states)
    with pytest.raises(UntrustedError, match="not converged"):
        path(exact_context(scene_from_dict(still)))


def test_starts_are_the_numbers_that_the_fragment_knows() -> None:
    """-1 goes back, 0 goes on, 1 keeps the place: see `fragments/steps/hold.lmp`."""
    contact = opened(at(0.0))
    rows = [
        hold_row(contact.scene, contact.settings, 0.1, 0.5, start) for start in (Start.BACK, Start.HERE, Start.KEPT)
    ]
    assert [row.start for row in rows] == [-1, 0, 1]


def test_a_load_that_presses_is_not_lost_within_reach() -> None:
    """However little it carries for a while; a plate that stands still under a tension is not either."""
    for load, velocity, force in ((0.3, -0.1, 0.0), (0.0, -0.1, 0.0), (-0.2, 0.0, 0.0)):
        contact = opened(at(force, -5.0, velocity), at(load))
        assert hold(contact, load, SCALE).held
        assert len(contact.rows) == 2


def test_a_load_that_never_rests_is_given_fifty_rows() -> None:
    contact = opened(at(LOAD + 0.1))
    with pytest.raises(RestlessError):
        hold(contact, LOAD, SCALE)
    assert len(contact.rows) == 50


def test_drag_follows_the_stiffness_down_to_none_and_up_to_the_stiffest() -> None:
    """γ √(K/K₀), K/K₀ between 0 and 1/0.6, by an estimate that is given."""
    known = opened(at(0.0))
    for stiffness, share in ((0.25, 0.25), (-3.0, 0.0), (1.6, 1.6), (9.0, 1.0 / 0.6)):
        estimate = Estimate(stiffness=lambda load, stiffness=stiffness: 2.0 * stiffness)
        settings = replace(known.settings, estimate=estimate, damped_stiffness=2.0, damping=0.7)
        assert damping_under(settings, 0.3) == pytest.approx(0.7 * share**0.5)
        gentle = replace(settings, part=0.25, calm_damping=5.0)
        assert [damping_under(gentle, load) for load in (0.3, 0.0)] == [5.0, 5.0]
        assert damping_under(gentle, -0.1) == pytest.approx(0.7 * share**0.5)
        assert damping_under(replace(gentle, damped_stiffness=0.0), 0.3) == 0.7


@pytest.mark.parametrize("part", [1.0, 0.6, 0.25])
def test_parts_of_a_load_that_is_lost_on_the_way_are_kept(part: float) -> None:
    """In round(1/part) steps: the second of four is lost here."""
    away = replace(at(0.0, -99.0), smallest_distance=99.0)
    contact = opened(at(LOAD * part if part < 0.5 else LOAD / round(1.0 / part)), away, part=part)
    held = press(contact, LOAD, SCALE)
    count = round(1.0 / part)
    assert [row.load for row in contact.rows] == pytest.approx([LOAD * (i + 1) / count for i in range(min(count, 2))])
    assert held.held == (count == 1)
    assert len(held.states) == min(count, 2)


def test_the_drag_of_a_row_is_that_of_all_particles_and_the_plate() -> None:
    """Over the inertia that LAMMPS does not count, as the force at rest is; a tension is lost where 60 % are left."""
    contact = opened(at(0.0), plate_damping=0.7, damping=0.03, damped_stiffness=0.0)
    settings = replace(contact.settings, estimate=Estimate(apart=lambda share: -7.0 - share), cutoff=2.0, rest=0.4)
    heavy = 1.0 + 40 * contact.scene.bodies.mass / settings.plate_mass
    for load, parted in ((0.0, 0.4 - 2.0 - 1.0), (-0.1, -7.6)):
        row = hold_row(contact.scene, settings, load, 0.5, Start.HERE)
        assert row.drag == pytest.approx((40 * 0.03 + 0.7) / heavy)
        assert row.rest == pytest.approx(0.1 * settings.tolerance * 0.5 / heavy)
        assert row.damping == 0.03
        assert row.parted == pytest.approx(parted)
        assert row.load == load
        assert (row.steps - 1) * settings.time_step < 10.0 * settings.settle_time <= row.steps * settings.time_step
    short = hold_row(contact.scene, replace(settings, settle_time=1e-9), 0.1, 0.5, Start.HERE)
    assert short.steps == 20
