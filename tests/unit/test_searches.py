"""Searches of the displacement over a contact whose curve is known exactly: where they end, and how they go there."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.prescribing import (
    FORCE_ACCURACY,
    MOST_INCREMENTS,
    RETURN_SHARE,
    SEPARATION_SHARE,
    approach,
    back_to,
    separate,
    still_held,
    unloading_step,
)
from contact1d.workflow.experiments.running.trust import (
    RESIDUAL_LIMIT,
    ChainEndError,
    ThroughError,
    UntrustedError,
    doubts,
    require_no_contradiction,
    require_trust,
)
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.units import FORCE, Quantity
from tests.exact import ExactContact
from tests.scenes import chains

SMOOTH, SNAPPING = (0.018, 0.03, 0.009, 0.06), (0.18, 0.03, 0.09, 0.06)
"""Short against the spacing, so that a particle feels its opposite alone: 0.19 and 1.9 times the springs."""


def contact(law: tuple[float, ...], **tables: object) -> ExactContact:
    experiment = {"kind": "pull_off", "preload": 0.3}
    scene = scene_from_dict(chains(100.0, law=law, bodies={"particles": 40}, experiment=experiment) | tables)
    opened = ExactContact(Deck(scene, settings_for(scene)))
    opened.begin("loading")
    return opened


def tallest(opened: ExactContact, low: float, high: float) -> float:
    return opened.pairs.largest_tension(low, high, 2000)[1]


@pytest.mark.parametrize("law", [SMOOTH, SNAPPING])
@pytest.mark.parametrize("force", [0.0, 0.02, 0.3, 1.0])
def test_a_force_is_approached_from_below_in_allowed_increments(law: tuple[float, ...], force: float) -> None:
    opened = contact(law)
    states = approach(opened, force, -0.02)
    near = FORCE_ACCURACY * opened.settings.tolerance * max(force, opened.settings.force_scale)
    assert abs(states[-1].force - force) <= near
    for before, after in pairwise(states):
        longest = opened.settings.increment(before.smallest_distance)
        assert after.displacement - before.displacement <= longest * (1.0 + 1e-12)
    assert len(states) < 80


def test_a_tension_is_approached_from_above_and_the_largest_one_is_never_passed() -> None:
    opened = contact(SMOOTH)
    start = approach(opened, 0.0, 0.0)[-1].displacement
    largest = tallest(opened, -0.3, 0.1)
    for share in (0.3, 0.9, 0.999):
        states = approach(opened, -share * largest, start, direction=-1)
        assert states[-1].force == pytest.approx(-share * largest, abs=1e-5 * largest)
        assert all(after.displacement < start + 1e-12 for after in states)
    with pytest.raises(UntrustedError, match="never reached"):
        approach(opened, -1.01 * largest, start, direction=-1)
    with pytest.raises(UntrustedError, match=r"cannot be approached: the force starts at .* above it already"):
        approach(opened, 0.1, 0.3)


def test_a_force_that_the_curve_jumps_over_is_refused() -> None:
    """Coming near, a snapping row gains a pair on each side at once: far enough out the force falls by a jump."""
    opened = contact(SNAPPING)
    way = [opened.state(d) for d in np.linspace(-0.6, 0.1, 800)]
    force = np.array([state.force for state in way])
    jump = int(np.argmin(np.diff(force)))  # the deepest of the jumps, before which the force is above
    wanted = 0.5 * (force[jump] + force[jump + 1])
    with pytest.raises(UntrustedError, match=r"the force jumps past|cannot be approached"):
        approach(contact(SNAPPING), float(wanted), float(way[jump].displacement) - 1e-3)


@pytest.mark.parametrize("law", [SMOOTH, SNAPPING])
def test_bodies_are_drawn_apart_over_all_their_teeth_and_no_further(law: tuple[float, ...]) -> None:
    opened = contact(law)
    start = approach(opened, 0.3, 0.0)[-1].displacement
    states = separate(opened, start)
    tension = [-state.force for state in states]
    largest = tallest(opened, states[-1].displacement, start)
    assert max(tension) == pytest.approx(largest, rel=0.05)
    assert max(tension) <= largest * (1.0 + 1e-9)
    assert abs(states[-1].force) < SEPARATION_SHARE * max(tension)
    assert still_held(opened, states[-1]) < SEPARATION_SHARE * max(tension)
    moves = -np.diff([state.displacement for state in states])
    first = unloading_step(opened.settings, start)
    assert (moves > 0.0).all()
    assert moves[: int(np.argmax(tension))] == pytest.approx(first)
    assert (np.diff(moves) >= -1e-12).all()
    assert len(states) < MOST_INCREMENTS / 10


def test_what_bodies_can_still_hold_bounds_all_that_they_hold_later() -> None:
    opened = contact(SNAPPING)
    start = approach(opened, 0.3, 0.0)[-1].displacement
    states = separate(opened, start)
    tension = np.array([-state.force for state in states])
    for i, state in enumerate(states):
        assert still_held(opened, state) >= tension[i:].max() - 1e-12


def test_a_search_comes_back_by_half_of_the_smallest_distance_at_a_time() -> None:
    opened = contact(SMOOTH)
    apart = opened.state(-0.2)
    states = back_to(opened, apart, 0.05)
    assert states[-1].displacement == 0.05
    for before, after in pairwise([apart, *states]):
        longest = max(RETURN_SHARE * before.smallest_distance, opened.settings.longest_move)
        assert after.displacement - before.displacement <= longest * (1.0 + 1e-12)
    assert [state.displacement for state in back_to(opened, states[-1], -0.1)] == [-0.1]


def state_of(scene: Scene, **numbers: object) -> State:
    count = 40
    x = np.arange(count) - 0.5 * (count - 1)
    pressure = np.where(np.abs(x) < 8.0, 1.0, np.where(np.abs(x) < 10.0, -0.5, 0.0))
    profile = Profile(x, 0.0 * x, 0.0 * x + 0.1, pressure, 0.0 * x)
    rule: Any = None  # no radius is asked for here
    whole = State("loading", 0.0, float(pressure.sum()), profile, 0.1, 0.0, 0.0, rule)
    return replace(whole, **numbers)


def with_ends(state: State, end: float) -> State:
    pressure = state.profile.pressure.copy()
    pressure[[0, -1]] = end
    return replace(state, profile=replace(state.profile, pressure=pressure))


def test_only_states_at_rest_between_the_ends_of_their_chain_are_trusted() -> None:
    scene = contact(SMOOTH).scene
    settings = settings_for(scene)
    limit = RESIDUAL_LIMIT * settings.tolerance * settings.force_scale
    good = state_of(scene)
    require_trust(scene, settings, replace(good, residual=limit))
    with pytest.raises(UntrustedError, match="not converged"):
        require_trust(scene, settings, replace(good, residual=1.001 * limit))
    with pytest.raises(ThroughError, match="went through each other"):
        require_trust(scene, settings, replace(good, depth=1e-9))
    require_trust(scene, settings, with_ends(good, -0.49))
    require_trust(scene, settings, with_ends(good, 0.49))
    for end in (-0.51, 0.51):
        with pytest.raises(ChainEndError, match="reaches the end of the chain"):
            require_trust(scene, settings, with_ends(good, end))
    punch = scene_from_dict(chains(
        1.0, law=SMOOTH, bodies={"particles": "auto", "profile": {"kind": "flat_punch", "radius": 20.0}},
        experiment={"kind": "pull_off", "preload": 0.3},
    ))  # fmt: skip
    require_trust(punch, settings, with_ends(good, -0.9))


def test_a_chain_that_cuts_the_contact_is_doubted_from_the_tolerance_on() -> None:
    scene = contact(SMOOTH).scene
    settings = settings_for(scene)
    for share, told in ((0.99, False), (1.01, True)):
        states = (state_of(scene), with_ends(state_of(scene), share * settings.tolerance))
        assert ("chain_end" in doubts(scene, settings, states)) == told


def test_a_tension_of_the_runs_own_curve_contradicts_a_smaller_result() -> None:
    scene = contact(SMOOTH).scene
    settings = settings_for(scene)
    found = {"adhesion_force": Quantity(2.0, 0.1, FORCE)}
    for force, residual, fine in ((-2.09, 0.0, True), (-2.11, 0.0, False), (-2.11, 0.011 / 40, True), (3.0, 0.0, True)):
        states = [state_of(scene), state_of(scene, force=force, residual=residual)]
        if fine:
            require_no_contradiction(settings, found, states)
        else:
            with pytest.raises(UntrustedError, match=r"run's own curve has 2\.11 FU"):
                require_no_contradiction(settings, found, states)
