"""Claims of the passes of a pull-off at rest: what marks a state, what the next pass looks at, when two agree."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import Peak
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, Phase
from contact1d.workflow.experiments.pull_off.quasistatic import (
    RIVAL_SHARE,
    Pass,
    _agree,
    _displacement_at,
    _first,
    _outcome,
    _refined,
    _replay,
    _rival_radius,
)
from contact1d.workflow.experiments.pull_off.smooth import (
    _allowed,
    _falling,
    _increment,
    _near,
    _passed,
    _placed,
    _searched,
    critical_shift,
    radius_rate,
)
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.prescribing import unloading_step
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from tests.exact import ExactContact, ExactContext, exact_context
from tests.scenes import chains

NOTHING = np.zeros(3)
PROFILE = Profile(NOTHING, NOTHING, NOTHING, NOTHING, NOTHING)
SMOOTH, SNAPPING = (0.018, 0.03, 0.009, 0.06), (0.18, 0.03, 0.09, 0.06)
PRELOAD = 0.3
WINDOW_ROWS = 8


class Rule:
    """A contact radius that is given."""

    def __init__(self, value: float, uncertainty: float) -> None:
        self._found = ContactRadius(value, uncertainty, -value, value, reaches_end=False)

    def of(self, _: Profile) -> ContactRadius:
        return self._found


def at(displacement: float, force: float, radius: float = 1.0, uncertainty: float = 0.0) -> State:
    rule: Any = Rule(radius, uncertainty)
    return State("unloading", displacement, force, PROFILE, 1.0, 0.0, 0.0, rule)


def context_of(law: tuple[float, ...], **tables: Any) -> ExactContext:
    experiment = {"kind": "pull_off", "preload": PRELOAD}
    tables = {"accuracy": {"tolerance": 1e-3}} | tables
    return exact_context(
        scene_from_dict(chains(100.0, law=law, bodies={"particles": 40}, experiment=experiment, **tables))
    )


def test_the_radius_goes_on_as_it_does_to_the_nearest_row() -> None:
    """a = 5 + 4 d, and another slope further off."""
    critical = at(0.3, -1.0, 6.2)
    states = [at(0.9, 0.0, 2.0), at(0.35, -0.9, 6.4), critical, at(0.2, -0.8, 5.0), at(0.3, -1.0, 9.9)]
    assert radius_rate(states, critical) == pytest.approx(4.0)
    assert critical_shift(states, critical, Peak(2, 1.0, 0.0, 1.0, 0.27, 0.0)) == pytest.approx(-0.12)


def test_a_radius_is_looked_at_no_closer_than_tolerance_or_lattice_allow() -> None:
    assert _allowed(at(0.0, 0.0, 5.0, 0.3), 1e-2) == pytest.approx(0.15)
    assert _allowed(at(0.0, 0.0, 50.0, 0.3), 1e-2) == pytest.approx(0.5)
    # 4 LU of radius over 1 of displacement, and more of it further off
    states = [at(0.35, -0.9, 6.4), at(0.5, -0.5, 9.0), at(0.3, -1.0, 6.2)]
    for share, near in ((0.99, True), (1.01, False)):
        position = 0.3 + share * 1e-2 * 6.2 / 4.0
        assert _near(states, Peak(1, 1.0, 0.0, 1.0, position, 0.0), 1e-2) == near
        assert _near(states, Peak(1, 1.0, 0.0, 1.0, 0.6 - position, 0.0), 1e-2) == near
        misplaced = 0.5 * share * 1e-2 * 6.2 / 4.0
        assert _placed(states, Peak(1, 1.0, 0.0, 1.0, 0.3, misplaced), 1e-2) == near


def test_a_largest_tension_is_passed_by_three_rows_beyond_it() -> None:
    def states(*tension: float) -> list[State]:
        return [at(-0.1 * i, -t) for i, t in enumerate(tension)]

    assert not _passed(states(1.0, 2.0, 3.0, 2.0, 1.0))
    assert _passed(states(1.0, 2.0, 3.0, 2.0, 1.0, 0.5))
    assert not _passed(states(1.0, 2.0, 3.0, 2.0, 1.0, 3.5))
    assert not _passed(states(-1.0, -2.0, -3.0, -4.0, -5.0))
    assert not _passed(states(0.0, -2.0, -3.0, -4.0, -5.0))
    ordered = _falling([at(0.1, 1.0), at(0.3, 2.0), at(0.1, 3.0)])
    assert [(s.displacement, s.force) for s in ordered] == [(0.3, 2.0), (0.1, 3.0)]


def test_rows_are_denser_than_teeth_as_far_as_there_are_not_too_many() -> None:
    opened = ExactContact(Deck(context_of(SMOOTH).deck.scene, context_of(SMOOTH).deck.settings))
    estimate, usual = opened.settings.estimate, opened.settings.increment()
    assert _increment(opened, 0.0, np.inf) == usual
    tooth = 2.0 * usual
    assert _increment(opened, 0.0, tooth) == pytest.approx(tooth / 4.0)
    way = -estimate.rest + float(estimate.gap[-1])
    assert _increment(opened, 0.0, 1e-9) == pytest.approx(min(usual, way / 1600.0))
    assert _increment(opened, 0.01, 1e-9) == pytest.approx(min(usual, (way + 0.01) / 1600.0))


@pytest.fixture(scope="module")
def passes() -> tuple[ExactContext, Pass, tuple[Phase, ...], Pass]:
    """A first pass over snaps, the schedule that it makes, and the second."""
    context = context_of(SNAPPING)
    first = _first(context, PRELOAD)
    window = unloading_step(context.deck.settings, first.loading[-1].displacement)
    phases = _refined(first, PRELOAD, window)
    return context, first, phases, _replay(context, PRELOAD, phases)


def rows_of(phase: Phase) -> list[float]:
    return [row.displacement for row in phase.rows if isinstance(row, Displace)]


def test_the_next_schedule_goes_down_once_and_back_past_both_marks(passes: Any) -> None:
    context, first, phases, second = passes
    loading, unloading, pulling, separating = map(rows_of, phases)
    assert [phase.state for phase in phases] == [False, True, True, False]
    assert all(after > before for before, after in pairwise(loading))
    way = [*loading[-1:], *unloading[1:], *pulling, *separating]
    assert all(after < before for before, after in pairwise(way))
    assert unloading[0] == loading[-1]
    assert second.preload == pytest.approx(PRELOAD, rel=1e-3)
    assert unloading[-1] == first.zero_load
    assert pulling[-1] == first.peak.position
    assert second.zero.displacement == unloading[-1]
    assert second.critical.displacement == pulling[-1]
    assert abs(second.zero.force) < 0.05 * second.peak.tension
    assert -second.critical.force == pytest.approx(second.peak.tension, rel=0.05)
    step = unloading_step(context.deck.settings, first.loading[-1].displacement) / WINDOW_ROWS
    near = [d for d in way if abs(d - first.peak.position) < 4.0 * step]
    assert np.diff(near).min() == pytest.approx(-step, rel=1e-6)
    rivals = [s.displacement for s in first.unloading if -s.force >= (1.0 - RIVAL_SHARE) * first.peak.tension]
    fine = [before - after for before, after in pairwise(way) if min(rivals) < after < before < max(rivals)]
    assert max(fine, default=0.0) <= step * (1.0 + 1e-6)


def test_marks_of_a_pass_lie_on_its_own_rows(passes: Any) -> None:
    _, first, _, second = passes
    for one in (first, second):
        falling = [s.displacement for s in one.falling]
        assert all(after < before for before, after in pairwise(falling))
        assert all(min(abs(s.displacement - d) for d in falling) < 1e-9 for s in one.unloading)
        assert one.peak.tension == max(-s.force for s in one.falling)
        i = one.peak.index
        rise = (one.falling[i - 1].force - one.falling[i].force) / (falling[i - 1] - falling[i])
        assert one.cut_short == pytest.approx(max(0.0, rise) * one.early)
        assert one.early == pytest.approx(one.settings.let_go_early(falling[i] - falling[i + 1]))
    assert second.early < first.early
    twice = replace(second, unloading=[*second.unloading, second.unloading[3]])
    assert [s.displacement for s in twice.falling] == [s.displacement for s in second.falling]


def test_a_force_on_a_rising_branch_is_on_the_line_through_its_nearest_rows() -> None:
    rows = [at(0.0, 0.0), at(0.1, 0.2), at(0.2, 0.6), at(0.3, 1.4)]
    assert _displacement_at(rows, 0.5) == pytest.approx(0.175)
    assert _displacement_at(rows, 0.7) == pytest.approx(0.225)
    assert _displacement_at(rows[:1], 0.5) == 0.0
    assert _displacement_at([at(0.1, 0.2), at(0.3, 0.2)], 0.2) == 0.1


def test_two_passes_agree_where_nothing_that_is_reported_changed_by_the_tolerance() -> None:
    """Each condition alone: the bound on both sides."""
    peak, tolerance = Peak(2, 2.0, 0.0, 2.0, 0.3, 0.0), 1e-2

    def latest(**changed: Any) -> Any:
        critical = changed.pop("critical", at(0.3, -2.0, 6.0))
        known = {
            "peak": peak, "critical": critical, "preload": 0.5, "zero": at(0.6, 0.0), "cut_short": 0.0,
            "unloading": [at(0.4, -1.0, 6.4), critical],
        }  # fmt: skip
        return SimpleNamespace(**known | changed)

    before: Any = SimpleNamespace(peak=peak)
    assert _agree(before, latest(), 0.5, tolerance)
    for share, agree in ((0.99, True), (1.01, False)):
        off = share * tolerance
        for one in (
            latest(peak=replace(peak, uncertainty=2.0 * off)),
            latest(cut_short=2.0 * off),
            latest(peak=replace(peak, uncertainty=1.2 * off), cut_short=0.8 * off),
            latest(preload=0.5 * (1.0 + off)),
            latest(preload=0.5 * (1.0 - off)),
            latest(zero=at(0.6, 2.0 * off)),
            latest(zero=at(0.6, -2.0 * off)),
            latest(critical=at(0.3, -2.0 * (1.0 - off), 6.0)),
            latest(peak=replace(peak, position=0.3 + off * 6.0 / 4.0)),
            latest(peak=replace(peak, position=0.3 - off * 6.0 / 4.0)),
        ):
            assert _agree(before, one, 0.5, tolerance) == agree
        for sign in (-1.0, 1.0):
            other: Any = SimpleNamespace(peak=replace(peak, smooth=2.0 * (1.0 + sign * off)))
            assert _agree(other, latest(), 0.5, tolerance) == agree


def test_a_tooth_that_may_be_the_highest_lends_its_radius_to_the_claim() -> None:
    found: Any = SimpleNamespace(
        falling=[at(0.5, 0.0, 9.0), at(0.4, 0.0, 8.0), at(0.3, 0.0, 4.0), at(0.2, 0.0, 3.0)],
        rivals={1: -0.05, 3: -0.2},
    )
    assert _rival_radius(found, 7.0, 0.04) == 0.0
    assert _rival_radius(found, 7.0, 0.06) == pytest.approx(1.0)
    assert _rival_radius(found, 7.0, 0.3) == pytest.approx(4.0)


def test_the_parts_of_a_pull_offs_claims_are_those_of_its_rows(passes: Any) -> None:
    """What the search missed is in F_A alone; a state off F = 0 moves a₀ along the chord from a_cr to a₀."""
    context, _, _, second = passes
    plain, missed = (_outcome(context, second, PRELOAD, by).quantities for by in (0.0, 0.01))
    grown = missed["adhesion_force"].uncertainty - plain["adhesion_force"].uncertainty
    assert 0.0 < grown <= 0.01
    assert missed["zero_load_radius"] == plain["zero_load_radius"]
    zero = second.zero
    moved = replace(zero, force=zero.force + 0.1)
    there = second.unloading.index(zero)
    states = [*second.unloading[:there], moved, *second.unloading[there + 1 :]]
    other = _outcome(context, replace(second, unloading=states), PRELOAD, 0.0).quantities
    a_0, a_cr = zero.radius_or_spot.value, second.critical.radius_or_spot.value
    force = plain["adhesion_force"].value
    more = other["zero_load_radius"].uncertainty - plain["zero_load_radius"].uncertainty
    assert more == pytest.approx((0.1 + zero.force - abs(zero.force)) * abs(a_0 - a_cr) / force)
    assert other["preload"].uncertainty == pytest.approx(abs(second.preload - PRELOAD))


@pytest.mark.parametrize("through", [False, True])
def test_a_smooth_search_ends_with_its_marks_and_what_it_found_before_it_drew_apart(through: bool) -> None:
    context = context_of(SMOOTH)
    found, before = _searched(context, PRELOAD, 3e-4, through)
    assert before.smooth == pytest.approx(found.peak.smooth, rel=3e-4)
    assert abs(found.zero.force) <= 3e-4 * settings_for(context.deck.scene).estimate.pull_off_force()
    assert -found.critical.force == pytest.approx(found.peak.smooth, rel=3e-4)
    assert found.missed <= 3e-4 * found.peak.smooth
    assert found.loading[-1].force == pytest.approx(PRELOAD, rel=1e-5)
    lowest = min(s.displacement for s in found.unloading)
    assert found.unloading[-1].displacement == lowest
    assert abs(found.unloading[-1].force) < 0.02 * found.peak.tension
