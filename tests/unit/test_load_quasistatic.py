"""What an error of the force moves at the end of a load: roots of parabolas by numpy, rows that are given."""

from __future__ import annotations

import itertools
import math
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.experiments.load.quasistatic import (
    _radius_spread,
    _stiffness,
    beside,
    load_outcome,
    load_quasistatic,
    moved_by,
)
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.scene import scene_from_dict
from tests.exact import exact_context
from tests.scenes import chains

X = np.arange(5.0)
PROFILE = Profile(X, 0.0 * X, 0.0 * X + 0.1, np.asarray([0.0, 2.0, 3.0, 2.0, 0.0]), 0.0 * X)


class Rule:
    """A contact radius that is given."""

    def __init__(self, value: float | None, uncertainty: float) -> None:
        self._found = None if value is None else ContactRadius(value, uncertainty, 0.0, 0.0, reaches_end=False)

    def of(self, _: Profile) -> ContactRadius | None:
        return self._found


def at(displacement: float, force: float, radius: float | None = None, uncertainty: float = 0.0) -> State:
    rule: Any = Rule(radius, uncertainty)
    return State("loading", displacement, force, PROFILE, 0.1, 0.0, 0.0, rule)


def smallest_way(stiffness: float, bend: float, error: float) -> float:
    """The smallest x > 0 with S x − K x²/2 = error; none on a curve that never comes so far is √(2 error/K)."""
    roots = np.roots([-0.5 * bend, stiffness, -error]) if bend else np.asarray([error / stiffness])
    real = [float(x.real) for x in roots if abs(x.imag) < 1e-12 and x.real > 0.0]
    return min(real) if real and stiffness > 0.0 else math.sqrt(2.0 * error / bend)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_an_error_of_the_force_moves_the_place_as_a_parabola_through_three_rows_says(side: float) -> None:
    """F = F₀ + s w + c w² at a way w from the last row: S = s and K = 2c where the curve softens along the way."""
    for s, c, error, stiffest in itertools.product(
        (0.7, 3.0, -0.5), (0.0, 0.25, 4.0, -0.5), (1e-3, 0.02, 0.3), (0.5, 2.0, 50.0)
    ):
        rows = [at(2.0 + w, 5.0 + s * w + c * w**2) for w in (side * 0.5, side * 0.25, side * 0.125, 0.0)]
        stiffness = min(s, stiffest)
        if c <= 0.0:
            expected = error / (stiffness if stiffness > 0.0 else stiffest)
        else:
            expected = smallest_way(stiffness, 2.0 * c, error)
        assert moved_by(rows, error, stiffest) == pytest.approx(expected, rel=1e-9), (s, c, error, stiffest)


def test_without_two_rows_beside_it_the_least_stiffness_counts() -> None:
    last = at(1.0, 3.0)
    assert moved_by([last], 0.1, 4.0) == pytest.approx(0.025)
    for force, stiffness in ((1.0, 2.0), (-9.0, 4.0), (5.0, 2.0), (3.0, 4.0)):
        assert moved_by([at(0.0, force), last], 0.1, 4.0) == pytest.approx(0.1 / stiffness)


def test_rows_that_tell_a_slope_are_one_beside_the_last_and_one_twice_as_far() -> None:
    """Nearer than a fiftieth of the way they say nothing: here 1 of 50. Those at that very distance count."""

    def ways(*displacements: float) -> list[float]:
        return [state.displacement for state in beside([at(d, 0.0) for d in (*displacements, 0.0)])]

    assert ways(50.0, 2.0, 1.0) == [1.0, 2.0]
    assert ways(50.0, -2.0, -1.0) == [-1.0, -2.0]
    assert ways(50.0, 4.0, 3.0, 1.5) == [1.5, 3.0]
    assert ways(50.0, 1.0, 1.9) == [1.0, 50.0]
    assert ways(50.0, 0.99, 0.5) == [50.0]
    assert ways(0.0, 0.0) == []
    assert ways() == []
    assert ways(0.0, 3.0) == [3.0]


def test_the_stiffness_is_that_to_the_nearest_row_with_another_force() -> None:
    last = at(1.0, 3.0)
    assert _stiffness([at(0.0, 0.0), at(0.6, 2.0), at(0.9, 3.0), at(1.0, 2.5), last]) == pytest.approx(2.5)
    assert _stiffness([at(2.5, 9.0), at(1.5, 2.0), last]) == pytest.approx(2.0)
    assert _stiffness([last]) == math.inf


def test_a_radius_goes_with_the_place_or_where_no_row_tells_with_the_force() -> None:
    estimate = SimpleNamespace(pull_off_force=lambda: 2.0)
    context: Any = SimpleNamespace(deck=SimpleNamespace(settings=SimpleNamespace(estimate=estimate)))
    rows = [at(0.0, 0.0, 3.0), at(0.5, 1.0, 5.0), at(1.0, 4.0, 6.0)]
    assert _radius_spread(context, rows, 6.0, (0.3, 0.01)) == pytest.approx(0.02)
    assert _radius_spread(context, rows[-1:], 6.0, (0.3, 0.01)) == pytest.approx(0.3 * 6.0 / 4.0)
    assert _radius_spread(context, [at(1.0, -0.5, 6.0)], 6.0, (0.3, 0.01)) == pytest.approx(0.3 * 6.0 / 2.0)
    assert _radius_spread(context, [at(0.5, 1.0), rows[-1]], 6.0, (0.3, 0.01)) == pytest.approx(0.3 * 6.0 / 4.0)


def scene_of(force: float, **tables: Any) -> Any:
    law = (0.018, 0.03, 0.009, 0.06)
    return scene_from_dict(
        chains(100.0, law=law, bodies={"particles": 40}, experiment={"kind": "load", "force": force}, **tables)
    )


def test_a_load_says_what_it_leaves_open_and_what_it_has_not() -> None:
    """p = F/πa² by the profile's own sum; a body that touches nowhere or at a spot has no radius."""
    context = exact_context(scene_of(0.4))
    rows = (at(0.0, 0.0, 2.0, 0.1), at(0.5, 3.0, 3.0, 0.1), at(1.0, 7.0, 4.0, 0.25))
    found = load_outcome(context, rows, (), 0.07, 0.02)
    known = found.quantities
    assert (known["force"].value, known["force"].uncertainty) == (7.0, 0.07)
    assert (known["displacement"].value, known["displacement"].uncertainty) == (1.0, 0.02)
    spread = 0.25 + 0.02 * 2.0
    assert known["contact_radius"].uncertainty == pytest.approx(spread)
    pressure = 7.0 / (math.pi * 16.0)
    assert known["mean_pressure"].value == pytest.approx(pressure)
    assert known["mean_pressure"].uncertainty == pytest.approx(pressure * (2.0 * spread / 4.0 + 0.07 / 7.0))
    assert found.spacing_uncertainty == {
        "contact_radius": 0.25, "mean_pressure": pytest.approx(pressure * 2.0 * 0.25 / 4.0)
    }  # fmt: skip
    assert found.radii == {"final": 4.0}
    assert found.prescribed == frozenset()
    assert load_outcome(exact_context(scene_of(0.0)), rows, (), 0.0, 0.0).prescribed == {"force", "mean_pressure"}
    for last in (at(1.0, 7.0), at(1.0, 7.0, 0.0, 1.5)):
        none = load_outcome(context, (*rows[:2], last), (), 0.07, 0.02)
        assert set(none.quantities) == {"displacement", "force"}
        assert "no_radius" in none.warnings
    assert "no_radius" not in found.warnings


@pytest.mark.parametrize("force", [0.4, 0.0, -0.04])
def test_a_force_is_claimed_to_what_it_misses_and_what_the_law_leaves(force: float) -> None:
    """A tension is approached from F = 0 in a phase of its own."""
    scene = scene_of(force)
    context = exact_context(scene)
    found = load_quasistatic(context)
    last = found.states[-1]
    open_ = abs(last.force - force) + law_error(scene, context.deck.settings, last)
    assert found.quantities["force"].uncertainty == pytest.approx(open_)
    moved = moved_by(found.states, open_, _stiffness(list(found.states)))
    assert found.quantities["displacement"].uncertainty == pytest.approx(moved)
    assert [phase.name for phase in found.phases] == ["loading", "unloading"][: 1 + (force < 0.0)]
    assert found.phases[-1].state
    turn = next(s for s in found.states if s.phase == "loading" and abs(s.force) < 1e-4) if force < 0.0 else last
    assert turn.force == pytest.approx(max(force, 0.0), abs=1e-4)
