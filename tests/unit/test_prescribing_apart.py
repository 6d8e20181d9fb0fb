"""Bodies that are drawn apart or come back, over curves that are formulas; searches anew in smaller steps."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.experiments.running.prescribing import (
    _apart,
    approach,
    back_to,
    in_smaller_steps,
    separate,
    still_held,
    unloading_step,
)
from contact1d.workflow.experiments.running.trust import ThroughError, UntrustedError
from tests.given import PROFILE, Estimate, GivenContact, X, at, given_scene

STEP = {"smooth_step": 0.1, "longest_move": 0.0, "cutoff": 9.0}
"""Increments of a tenth, wherever particles are 0.4 from each other or more; nothing is out of reach."""


def line(**more: Any) -> Any:
    return GivenContact(lambda d: 2.0 * d, **{"closest": lambda d: 1.0} | STEP | more)


def held_at(share: float) -> Profile:
    """Ten particles with a tension of `share` each, all past the largest one of their law."""
    return replace(PROFILE, z_upper=0.0 * X + 5.0, pressure=np.where(np.abs(X) < 5.0, -share, 0.0))


def falling(snaps: bool, **more: Any) -> Any:
    """T = 2 exp(−(d + 0.5)²/0.08), all of it by particles that only lose it."""

    def tension(d: float) -> float:
        return 2.0 * math.exp(-((d + 0.5) ** 2) / 0.08)

    known = {"displacement_step": 0.1, "loading_step": 0.1, "cutoff": 3.0, "estimate": Estimate(snaps=snaps)}
    curves = {"profile": lambda d: held_at(tension(d) / 10.0), "closest": lambda d: 0.5 - d}
    return GivenContact(lambda d: -tension(d), **STEP | known | curves | more)


@pytest.mark.parametrize(("snaps", "growth"), [(False, 1.6), (True, 1.2)])
def test_moves_grow_where_less_than_half_of_the_largest_tension_is_left_and_end_at_a_fiftieth(
    snaps: bool, growth: float
) -> None:
    contact = falling(snaps)
    states = separate(contact, 0.2)
    tension = [-s.force for s in states]
    moves = [before.displacement - after.displacement for before, after in pairwise(states)]
    step = 0.1
    largest = tension[0]
    for i, move in enumerate(moves):
        assert move == pytest.approx(step)
        largest = max(largest, tension[i + 1])
        step *= growth if tension[i + 1] < 0.5 * largest else 1.0
    assert tension[-1] < 0.02 * largest <= tension[-2]
    assert max(moves) > 0.1 * growth**1.9


def test_moves_over_snaps_grow_only_where_no_tooth_can_be_higher_any_more() -> None:
    """Particles nearer than the largest tension's place may each come to hold it: forty of them, 1.6 FU in all."""
    for strongest, grows in ((0.049, True), (0.051, False)):
        law = Estimate(snaps=True, force=np.asarray([0.0, -strongest, -0.01, 0.0]))
        contact = falling(True, estimate=law, cutoff=16.0, profile=lambda d: replace(
            held_at(0.0), z_upper=0.0 * X + (1.0 if d < 0.0 else 9.0)
        ), closest=lambda d: 1.0 if d > -1.35 else 17.0)  # fmt: skip
        moves = -np.diff([s.displacement for s in separate(contact, 0.2)])
        assert (moves.max() > 0.11) == grows


def test_a_tension_from_before_counts_and_one_that_was_never_there_does_not_end_a_way() -> None:
    contact = falling(False)
    assert len(separate(contact, 0.2, 1e3)) == 2  # all of it is nothing beside the one before
    pressed: Any = GivenContact(lambda d: 1.0 + d, closest=lambda d: 0.5 - d, **STEP | {"cutoff": 1.05})
    states = separate(pressed, 0.0)
    assert states[-1].displacement == pytest.approx(-0.6)  # out of reach
    moves = -np.diff([s.displacement for s in states])
    assert moves == pytest.approx(np.full(6, 0.1))


@pytest.mark.parametrize("snaps", [False, True])
def test_a_tooth_that_presses_or_pulls_with_half_of_the_largest_lets_no_move_grow(snaps: bool) -> None:
    """Tensions row by row: none while it presses, none at half; growth where a force of 0 or less than half is left."""
    tension = [0.0, 2.0, -0.1, 1.0, 0.0, 0.9, 0.9]
    growth = 1.2 if snaps else 1.6
    contact = falling(snaps, profile=lambda d: held_at(0.05), closest=lambda d: 0.1)
    row = contact.row

    def given(one: Any) -> Any:
        state = replace(row(one), force=-tension[len(contact.states) - 1])
        return replace(state, smallest_distance=0.1 if len(contact.states) < len(tension) else 9.9)

    contact.row = given
    moves = -np.diff([s.displacement for s in separate(contact, 3.0)])
    assert moves / 0.1 == pytest.approx([1.0, 1.0, 1.0, 1.0, growth, growth**2])


def test_bodies_that_never_part_are_told_after_ten_thousand_rows() -> None:
    contact: Any = GivenContact(lambda d: -1.0, closest=lambda d: 0.1, **STEP)
    with pytest.raises(UntrustedError, match="within 10000 increments"):
        separate(contact, 0.0)
    assert len(contact.places) == 10_001


def test_an_unloading_takes_a_thousand_rows_at_most_or_increments_of_a_search() -> None:
    settings = line(rest=0.3, estimate=Estimate(gap=np.asarray([0.0, 7.0, 40.0]))).settings
    assert unloading_step(settings, 0.5) == pytest.approx(0.1)
    assert unloading_step(settings, 100.0) == pytest.approx(139.7 / 1000.0)


def test_what_is_still_held_is_the_largest_tension_of_near_particles_and_the_own_one_of_others() -> None:
    """The largest tension of a pair, 0.2, is at its grid's last distance: 0.25 of the cutoff of 4."""
    law = Estimate(force=np.asarray([-0.2, -0.1, 0.3, 0.0]))
    contact = line(estimate=law, cutoff=4.0, scene=given_scene(bodies={"particles": 40, "spacing": 0.5}))
    distance = np.where(np.arange(40) < 4, 0.99, 1.01)
    pressure = np.zeros(40)
    pressure[:8] = [1.0, 0.0, -0.2, -0.8, 1.0, 0.0, -0.2, -0.8]
    state = replace(at(0.0, 0.0), profile=replace(PROFILE, z_lower=0.0 * X - 1.0, z_upper=distance - 1.0,
                                                 pressure=pressure))  # fmt: skip
    assert still_held(contact, state) == pytest.approx(0.2 * 3 + 0.4 + 0.1 + 0.4)
    edge = replace(state, profile=replace(state.profile, z_upper=0.0 * X, pressure=0.0 * X))
    assert still_held(contact, edge) == 0.0


def test_bodies_are_apart_out_of_reach_or_with_next_to_nothing_left() -> None:
    contact = line(cutoff=4.0, estimate=Estimate(force=np.asarray([0.0, 0.0])))
    cases = [
        (0.019, 0.019, 1.0, 0.1, True), (0.021, 0.0, 1.0, 0.1, False), (0.0, 0.021, 1.0, 0.1, False),
        (-0.019, 0.0, 1.0, 0.1, True), (-0.021, 0.0, 1.0, 0.1, False),
        (0.02, 0.0, 1.0, 0.1, False), (-0.02, 0.0, 1.0, 0.1, False), (5.0, 0.0, 1.0, 4.0, False),
        (0.0, 0.0, 0.0, 0.1, False), (5.0, 5.0, 0.0, 4.1, True), (5.0, 5.0, 1.0, 3.9, False),
        (5.0, 0.0, 1.0, 4.1, True),
    ]  # fmt: skip
    for force, held, largest, closest, apart in cases:
        state = replace(at(0.0, force), smallest_distance=closest, profile=held_at(held / 10.0))
        assert _apart(contact, state, largest) == apart, (force, held, largest, closest)


def test_a_way_back_is_in_halves_of_the_distance_or_longest_moves() -> None:
    def way(end: float, **more: Any) -> list[float]:
        contact = line(**more)
        last = replace(at(0.0, 0.0), smallest_distance=contact._curves[1](0.0))
        states = back_to(contact, last, end)
        assert [s.displacement for s in states] == contact.places
        return contact.places

    near, binary = (lambda d: 0.1), (lambda d: 0.25)
    assert way(0.12, closest=near, longest_move=0.02) == pytest.approx([0.05, 0.1, 0.12])
    assert way(0.2, closest=near, longest_move=0.08) == pytest.approx([0.08, 0.16, 0.2])
    assert way(0.06, closest=near, longest_move=0.08) == pytest.approx([0.06, 0.06])
    assert way(0.125, closest=binary) == [0.125]
    assert way(-3.0, closest=near) == [-3.0]


def test_a_row_that_went_through_is_no_row_of_a_search() -> None:
    contact = line()
    contact.row = lambda row: at(row.displacement, 0.0, depth=1e-6)
    for search in (lambda: approach(contact, 1.0, 0.0), lambda: separate(contact, 0.0)):
        with pytest.raises(ThroughError):
            search()


class Searched:
    """A search in which the bodies go through each other so many times."""

    def __init__(self, times: int) -> None:
        self.left, self.parts = times, list[float]()

    def __call__(self, context: Any) -> Any:
        self.parts.append(context.deck.settings.part)
        self.left -= 1
        if self.left >= 0:
            raise ThroughError(f"through, with {self.left} to come", "press less")
        return "found"


@pytest.mark.parametrize("times", [0, 1, 2, 3])
def test_a_search_that_goes_through_begins_anew_in_a_quarter_and_a_sixteenth_of_its_steps(times: int) -> None:
    contact = line()
    notes: list[str] = []
    deck: Any = SimpleNamespace(scene=contact.scene, settings=contact.settings)
    context: Any = SimpleNamespace(deck=deck, retries=True, progress=SimpleNamespace(note=notes.append))
    search = Searched(times)
    if times < 3:
        assert in_smaller_steps(search)(context) == "found"
        assert context.deck.settings.part == [1.0, 1 / 4, 1 / 16][times]
    else:
        with pytest.raises(ThroughError, match=r"0 to come. Steps 16 times smaller did not help: press less"):
            in_smaller_steps(search)(context)
        assert context.deck is deck
    assert search.parts == [1.0, 1 / 4, 1 / 16][: times + 1]
    assert len(notes) == min(times, 2)


def test_what_heat_drives_through_or_what_is_not_to_be_tried_again_is_told_at_once() -> None:
    contact = line()
    for noise, retries in ((object(), True), (None, False)):
        scene = contact.scene.model_copy(update={"noise": noise})
        context: Any = SimpleNamespace(deck=SimpleNamespace(scene=scene, settings=contact.settings), retries=retries)
        search = Searched(1)
        with pytest.raises(ThroughError, match="0 to come: press less"):
            in_smaller_steps(search)(context)
        assert len(search.parts) == 1
