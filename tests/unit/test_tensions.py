"""Which tension a pull-off tries next, what brackets it, and where the largest one lies: counted out by the rule.

A share of what is left to the expected one, then both sides of it, then the middle of the bracket.
"""

from __future__ import annotations

import pytest

from contact1d.workflow.experiments.pull_off.dynamic import Search, top_of
from contact1d.workflow.experiments.running.holding import Held
from tests.given import at, held, search

MARGIN = 0.45 * 1e-2


@pytest.mark.parametrize(
    ("known", "tension"),
    [
        (search(), 0.8),
        (search(0.8), 0.96),
        (search(0.8, past=0.5), (1.0 + 0.4) / 1.5),
        (search(1.0 - 5.5 * MARGIN), 1.0 - 1.1 * MARGIN),
        (search(1.0 - 4.5 * MARGIN), 1.0 - MARGIN),
        (search(1.0 - 4.5 * MARGIN, past=2.0), 1.0 - 3.0 * MARGIN),
        (search(1.0 - 1.11 * MARGIN), 1.0 - MARGIN),
        (search(1.0 - 1.09 * MARGIN), 1.0 + MARGIN),
        (search(1.0), 1.0 + MARGIN),
        (search(1.0 + 0.91 * MARGIN), 1.25 * (1.0 + 0.91 * MARGIN)),
        (search(1.0, lost=1.0 + 1.11 * MARGIN, broken=1.2), 1.0 + MARGIN),
        (search(1.0, lost=1.0 + 1.09 * MARGIN, broken=1.2), 1.1),
        (search(1.0, lost=1.0 + 1.09 * MARGIN, broken=1.2, past=1.0), 1.05),
        (search(0.5, lost=0.7, broken=0.7), 0.6),
        (search(2.0), 2.5),
    ],
)
def test_the_next_tension_is_that_of_the_rule(known: Search, tension: float) -> None:
    assert known.next() == pytest.approx(tension, rel=1e-12)


@pytest.mark.parametrize("wide", [0.9, 1.1])
def test_a_guess_that_states_speak_against_gives_way_to_their_parabola(wide: float) -> None:
    """T = wide (1 − x²) at three held states, the guess below them or above what broke."""
    rows = [held(wide * (1.0 - x**2), x) for x in (0.4, 0.3, 0.2)]
    for guess, lost in ((0.5 * wide, 2.0), (3.0, 2.0)):
        known = Search(1e-2, guess, lambda tension: 0.0, rows, lost, lost)
        assert known._expected() == pytest.approx(wide)
        assert Search(1e-2, guess, lambda tension: 0.0, rows[1:], lost, lost)._expected() == guess
    assert Search(1e-2, 1.5, lambda tension: 0.0, rows, 2.0, 2.0)._expected() == 1.5
    more = [held(0.1 * i, 0.9 - 0.1 * i) for i in range(4)]
    assert Search(1e-2, 3.0, lambda tension: 0.0, [*more, *rows], 2.0, 2.0)._expected() == pytest.approx(wide)
    straight = [held(0.1 * i, 1.0 - 0.1 * i) for i in range(3)]
    assert Search(1e-2, 0.1, lambda tension: 0.0, straight)._expected() == 0.1


def test_what_broke_bounds_what_holds_from_above_by_the_momentum_of_the_plate() -> None:
    known = search(0.5, past=0.25)
    assert not known.done
    for tension, lost, broken in ((0.9, 0.9, 1.0), (0.95, 0.9, 1.0), (0.7, 0.7, 0.75)):
        known.learn(Held(-tension, (at(0.0, 0.0),), False, 0.0))
        assert (known.lost, known.broken) == pytest.approx((lost, broken))
        assert known.best == 0.5
    known.learn(held(0.6))
    assert (known.best, known.broken) == pytest.approx((0.6, 0.75))
    for broken, done in ((0.6059, True), (0.6061, False)):
        known.broken = broken
        assert known.done == done
    exact = Search(2.0**-7, 1.0, lambda tension: 0.0, [held(0.0), held(1.0)], broken=1.0 + 2.0**-7)
    assert exact.done


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_top_is_looked_for_within_five_times_the_width_of_the_states(side: float) -> None:
    for widths, there in ((4.9, True), (5.1, False)):
        top = side * widths * 0.2
        states = [at(x, -(3.0 - (x - top) ** 2)) for x in (0.2, 0.1, 0.0)]
        found = top_of(states)
        assert found == (pytest.approx((top, 3.0)) if there else None)
    assert top_of([at(x, -1.0) for x in (0.2, 0.2, 0.0)]) is None
