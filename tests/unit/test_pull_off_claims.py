"""What a pull-off at rest claims and which rows its next pass has: each part by a formula, over given states."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import Peak
from contact1d.workflow.deck.steps import Displace, Phase, displacements
from contact1d.workflow.experiments.pull_off import quasistatic
from contact1d.workflow.experiments.pull_off.quasistatic import Pass, _outcome, _refined, _window, pull_off_quasistatic
from contact1d.workflow.experiments.pull_off.smooth import SmoothPass
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.trust import UntrustedError
from tests.given import Estimate, GivenContact, at, given_context, given_scene

PRELOAD = 0.3
ZERO = at(0.5, -0.01, 6.0, 0.2)
CRITICAL = at(-0.3, -0.98, 4.0, 0.1, residual=1e-5)
PEAK = Peak(3, 0.98, 0.004, 1.0, -0.32, 0.003)
LOADED = at(0.6, 0.32, 7.0)


def smooth(**changed: Any) -> SmoothPass:
    unloading = [at(0.4, -0.2, 5.5), ZERO, at(-0.25, -0.97, 4.2), CRITICAL]
    known = {"phases": (), "loading": [LOADED], "unloading": unloading, "zero": ZERO, "critical": CRITICAL,
             "peak": PEAK, "missed": 0.0}  # fmt: skip
    return SmoothPass(**(known | changed))


def contact(**more: Any) -> Any:
    return given_context(GivenContact(lambda d: d, **more))


@pytest.mark.parametrize("missed", [0.001, 0.02])
@pytest.mark.parametrize("law", [True, False])
def test_the_claims_of_a_pull_off_are_the_sums_of_their_parts(missed: float, law: bool) -> None:
    """da/dd = 4 at the critical state, and −2 LU per FU on the chord from F = 0 to it."""
    more: dict[str, Any] = {} if law else {"law": None, "table": None, "plane_stiffness": 1e3}
    scene = None if law else given_scene(neighbours={"stiffness": 0.1})
    own = contact(**more, scene=scene)
    settings = own.deck.settings
    found = _outcome(own, smooth(), PRELOAD, missed)
    at_critical, at_zero = (law_error(own.deck.scene, settings, state) for state in (CRITICAL, ZERO))
    reach = settings.law.longest_range if law else 0.0
    force, a_cr, a_0, preload = (
        found.quantities[name] for name in ("adhesion_force", "critical_radius", "zero_load_radius", "preload")
    )
    assert (force.value, a_cr.value, a_0.value, preload.value) == pytest.approx((1.0, 4.0 - 4.0 * 0.02, 6.0, 0.32))
    assert force.uncertainty == pytest.approx(max(missed, 0.004) + 40 * 1e-5 + at_critical)
    by_law = (2.0 + 4.0 * reach) * at_critical
    assert a_cr.uncertainty == pytest.approx(0.1 + 0.08 + 2.0 * 4.0 * 0.003 + by_law)
    assert a_0.uncertainty == pytest.approx(0.2 + 2.0 * (0.01 + at_zero))
    assert preload.uncertainty == pytest.approx(0.02)
    assert found.spacing_uncertainty == {"critical_radius": 0.1, "zero_load_radius": 0.2}
    assert found.radii == {"zero_load": 6.0, "critical": 4.0}
    assert [s.displacement for s in found.states] == [0.6, 0.4, 0.5, -0.25, -0.3]
    assert found.prescribed == {"preload"}


def test_a_slope_goes_with_one_over_the_tension_and_no_radius_is_less_than_none() -> None:
    twice = replace(PEAK, smooth=2.0, tension=1.96, position=-2.3)
    own = contact()
    found = _outcome(own, smooth(peak=twice), PRELOAD, 0.0).quantities
    assert found["critical_radius"].value == 0.0
    error = law_error(own.deck.scene, own.deck.settings, CRITICAL)
    range_ = own.deck.settings.law.longest_range
    expected = 0.1 + 8.0 + 0.024 + (1.0 + 4.0 * range_ / 2.0) * error
    assert found["critical_radius"].uncertainty == pytest.approx(expected)


def test_a_curve_that_exceeds_its_own_result_is_refused() -> None:
    higher = [at(0.4, -1.2, 5.5), *smooth().unloading[1:]]
    with pytest.raises(UntrustedError, match=r"the run's own curve has 1\.2 FU"):
        _outcome(contact(), smooth(unloading=higher), PRELOAD, 0.0)


SAW = [(0.9, 0.4), (0.8, -0.42), (0.7, -0.47), (0.6, -0.5), (0.5, -0.3), (0.4, -0.55), (0.3, -0.6), (0.2, -0.2),
       (0.1, -0.58), (0.0, -0.1)]  # fmt: skip


def saw(refined: bool = True, **changed: Any) -> Pass:
    """Teeth of 0.5, 0.6 and 0.58 FU, a radius of 5 + 2d."""
    unloading = [at(d, f, 5.0 + 2.0 * d, 0.1) for d, f in SAW]
    phases = tuple(Phase("p", displacements([0.0] * n)) for n in (2, 3, 4, 3))
    known = {
        "wanted": PRELOAD, "phases": phases, "refined": refined, "loading": [at(0.0, -0.1), LOADED],
        "unloading": unloading, "settings": contact().deck.settings,
    }  # fmt: skip
    return Pass(**(known | changed))


def test_teeth_that_may_be_higher_widen_the_claim_of_the_critical_radius() -> None:
    """With a miss of 0.3 FU any tooth may be the highest; marks are the last rows of the second and third phase."""
    own = contact()
    known = saw()
    assert (known.zero.displacement, known.critical.displacement) == (0.7, 0.3)
    assert known.preload == 0.32
    spread = []
    for missed in (0.0, 0.3):
        found = _outcome(own, known, PRELOAD, missed).quantities["critical_radius"]
        same = smooth(peak=known.peak, unloading=known.unloading, zero=known.zero, critical=known.critical)
        part = _outcome(own, same, PRELOAD, missed).quantities["critical_radius"]
        spread.append(found.uncertainty - part.uncertainty)
    assert spread == pytest.approx([0.4, 0.6])


def test_the_ends_of_a_branch_cut_nothing_short() -> None:
    settings = contact().deck.settings
    rows = [at(0.3, -0.1), at(0.2, -0.3), at(0.0, -0.9)]
    last, first = saw(unloading=rows, settings=settings), saw(unloading=rows[::-1], settings=settings)
    assert (last.cut_short, last.early) == (0.0, 0.0)
    risen = saw(unloading=[at(0.3, -0.9), at(0.2, -0.3), at(0.0, -0.1)], settings=settings)
    assert (risen.cut_short, risen.early) == (0.0, pytest.approx(0.25 * 0.1))
    assert [s.displacement for s in first.falling] == [0.3, 0.2, 0.0]
    inner = saw(unloading=[at(0.3, -0.1), at(0.25, -0.9), at(0.0, -0.4)], settings=settings)
    assert inner.cut_short == pytest.approx(0.8 / 0.05 * 0.25 * 0.25)
    lost = saw(unloading=[at(0.3, -0.1), at(0.25, -0.9), at(0.0, -0.4)], settings=settings)
    assert lost.early == pytest.approx(0.0625)


def test_places_nearer_than_a_billionth_of_a_thousandth_of_the_way_are_one() -> None:
    rows = [at(0.5, 0.0), at(0.25, -0.5), at(0.25 - 1e-13, -0.7), at(0.2, -0.4), at(-0.5, 0.0)]
    assert [s.force for s in saw(unloading=rows).falling] == [0.0, -0.5, -0.4, 0.0]


@pytest.mark.parametrize(("refined", "first", "last"), [(True, 0.38, 0.22), (False, 0.38, 0.1)])
def test_the_window_is_eight_rows_to_each_side_and_at_first_has_all_teeth_as_high(
    refined: bool, first: float, last: float
) -> None:
    """Of 0.08 LU to each side, in hundredths; at first it goes on to the tooth at 0.1, 0.58 of 0.6 FU."""
    found = _window(saw(refined), 0.3, 0.08)
    assert found == pytest.approx(np.linspace(first, last, round((first - last) / 0.01) + 1))
    wide = _window(saw(refined), 0.3, 0.01)  # the move after the top is 0.1, of which a quarter is let go early
    assert (wide[0], wide[-1]) == pytest.approx((0.325, 0.275 if refined else 0.1), abs=1e-3)


def rows_of(phase: Phase) -> list[float]:
    return [row.displacement for row in phase.rows if isinstance(row, Displace)]


def test_the_next_pass_has_the_rows_before_the_window_its_marks_and_those_after() -> None:
    """Loading keeps its rows that are short of the load, and ends where the line through the nearest two has it."""
    loading = [at(d, f) for d, f in ((0.0, -0.1), (0.5, 0.05), (0.7, 0.15), (0.9, 0.29), (1.0, 0.33), (0.95, 0.311))]
    known = saw(loading=loading)
    phases = _refined(known, PRELOAD, 0.08)
    deepest = 0.9 + 0.05 * (0.01 / 0.021)
    zero = known.zero_load
    fine = np.linspace(0.38, 0.22, 17)
    peak = known.peak.position
    assert 0.2 < peak < 0.4
    assert [phase.name for phase in phases] == ["loading", "unloading", "pulling", "separating"]
    assert [phase.state for phase in phases] == [False, True, True, False]
    fine = np.asarray(peak + 0.01 * np.arange(8, -9, -1))
    down, back, pull, apart = map(rows_of, phases)
    assert down == pytest.approx([0.0, 0.5, 0.7, 0.9, deepest])
    assert back == pytest.approx([deepest, 0.9, zero])
    outer = [d for d, _ in SAW if not fine[-1] <= d <= fine[0]]
    expected = sorted({*np.round(outer, 9), *np.round(fine, 9)}, reverse=True)
    assert pull == pytest.approx([d for d in expected if peak - 1e-9 <= d < zero])
    assert apart == pytest.approx([d for d in expected if d < peak - 1e-9])
    short = _refined(saw(loading=[at(0.0, -0.1), at(0.5, 0.05), at(0.9, 0.29), at(0.95, 0.2995)]), PRELOAD, 0.08)
    assert rows_of(short[0]) == pytest.approx([0.0, 0.5, 0.9, 0.95 + 0.05 * (0.0005 / 0.0095)])
    none = _refined(saw(loading=[at(0.0, -0.1), at(0.95, 0.1), at(0.85, 0.31)]), PRELOAD, 0.08)
    assert rows_of(none[0])[-1] == max(rows_of(none[0])) == rows_of(none[1])[0]


class Passes:
    """Passes whose results are given: each is nearer to 1 by a quarter, and they agree at a certain one."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, agree: int) -> None:
        """They agree at the pass of that number, from 1 on."""
        self.windows: list[float] = []
        self.tolerances: list[float] = []
        self.count, self.agree = 0, agree
        own: dict[str, Any] = {
            "_first": self.first, "_refined": self.refined, "_replay": self.replay, "_agree": self.agreed,
            "_outcome": lambda context, found, preload, missed: (found, missed),
        }  # fmt: skip
        for name, value in own.items():
            monkeypatch.setattr(quasistatic, name, value)

    def one(self) -> Any:
        """Of this number."""
        height = 1.0 + 0.25**self.count
        peak = SimpleNamespace(smooth=height, tension=height)
        return SimpleNamespace(
            number=self.count, peak=peak, cut_short=0.125, rivals={3: -0.4, 5: 0.0625}, loading=[LOADED]
        )

    def first(self, context: Any, preload: float) -> Any:
        """The one that finds its own way."""
        return self.one()

    def refined(self, known: Any, preload: float, window: float) -> Any:
        """Keep the window."""
        assert known.number == self.count
        self.windows.append(window)

    def replay(self, context: Any, preload: float, phases: Any) -> Any:
        """The next."""
        self.count += 1
        return self.one()

    def agreed(self, before: Any, latest: Any, preload: float, tolerance: float) -> bool:
        """At that number."""
        assert latest.number == before.number + 1
        self.tolerances.append(tolerance)
        return latest.number == self.agree


@pytest.mark.parametrize("agree", [1, 3, 8, 9])
def test_windows_are_a_quarter_of_the_one_before_until_two_passes_agree_eight_at_most(
    agree: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What the last refinement changed, what rivals may be higher by and what was cut short is missed."""
    passes = Passes(monkeypatch, agree)
    own = contact(estimate=Estimate(snaps=True), tolerance=1e-2, loading_step=0.1, displacement_step=0.1)
    if agree > 8:
        with pytest.raises(UntrustedError, match="after 8 refinements"):
            pull_off_quasistatic(own)
    else:
        found: Any = pull_off_quasistatic(own)
        assert found[0].number == agree
        assert found[1] == pytest.approx(0.25 ** (agree - 1) - 0.25**agree + 0.0625 + 0.125)
    assert passes.windows == pytest.approx([0.1 * 0.25**n for n in range(min(agree, 8))])
    assert passes.tolerances == pytest.approx([0.3e-2] * min(agree, 8))


def test_a_row_inside_of_the_window_gives_way_to_its_finer_ones() -> None:
    """The window goes from peak + 0.08 to peak − 0.08, wherever another row moves the peak to."""
    told = set()
    for place in np.arange(0.2017, 0.45, 0.0031):
        beside = at(float(place), -0.21)
        known = saw(unloading=sorted([*saw().unloading, beside], key=lambda s: -s.displacement))
        rows = [d for phase in _refined(known, PRELOAD, 0.08) for d in rows_of(phase)]
        inside = abs(beside.displacement - known.peak.position) <= 0.08
        assert (beside.displacement in rows) == (not inside)
        told.add(inside)
    assert told == {True, False}
