"""A pull-off whose rows are known beforehand, over formulas: where its rows are, its marks, and an end without a top.

F = (d + 0.5)² − 1: no load at 0.5, the largest tension, 1, at −0.5, and fixed grips that let go at −0.9.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from contact1d.analysis.curve_marks import largest_tension
from contact1d.workflow.experiments.pull_off.stepped import _peak, _to_zero, stepped_pass
from contact1d.workflow.experiments.running.trust import DigitsError, UntrustedError
from tests.given import Estimate, GivenContact, at, given_context

LAST, PRELOAD = -0.9, 0.96
"""F_D is at d = 0.9."""


def curve(d: float) -> float:
    """F [FU]; 0 beyond fixed grips."""
    return (d + 0.5) ** 2 - 1.0 if d >= LAST else 0.0


def contact(force: Any = curve, expected: float = 0.52, largest: float = 2.0, **more: Any) -> Any:
    estimate = Estimate(place=lambda load: expected if load == 0.0 else 0.9, apart=lambda share: LAST - share,
                        largest=largest)  # fmt: skip
    return GivenContact(force, **{"stepped": True, "estimate": estimate, "cutoff": 9.0, "force_scale": 0.5} | more)


def passed(one: Any, tolerance: float = 1e-4) -> Any:
    context: Any = given_context(one)
    return stepped_pass(context, PRELOAD, tolerance)


def named(one: Any, name: str) -> list[float]:
    return [s.displacement for s in one.states if s.phase == name]


def test_rows_lead_down_to_no_load_past_the_largest_tension_back_to_it_and_apart() -> None:
    one = contact()
    found = passed(one)
    assert [(p.name, p.state) for p in found.phases] == [
        ("loading", False), ("unloading", True), ("pulling", True), ("separating", False),
    ]  # fmt: skip
    assert one.ended == ["separating"]
    deepest = named(one, "loading")[-1]
    assert deepest == pytest.approx(0.9, abs=1e-5)
    back = named(one, "unloading")
    assert back[:24] == pytest.approx(np.linspace(deepest, 0.52, 25)[1:])
    assert back[24] == pytest.approx(0.52 - (deepest - 0.52) / 24.0)  # as far again, where the force has not crossed 0
    assert abs(found.zero.force) <= 2.0 * 1e-4
    assert back[-1] == found.zero.displacement == pytest.approx(0.5, abs=1e-3)
    zero, pull = back[-1], named(one, "pulling")
    first = zero + (1.0 - 1e-9) * (LAST - zero) * np.arange(1, 49) / 48.0
    assert pull[:48] == pytest.approx(first)
    step = (zero - LAST) / 48.0
    assert pull[48:] == pytest.approx([-0.5 + share * step for share in (0.5, -0.5, 0.25, -0.25, 0.0)], abs=1e-6)
    assert found.critical.displacement == pull[-1]
    assert named(one, "separating") == pytest.approx(np.linspace(pull[-1], 1.05 * LAST, 25)[1:])
    assert found.peak.smooth == pytest.approx(1.0)
    assert found.peak.position == pytest.approx(-0.5, abs=1e-6)
    assert found.missed == pytest.approx(0.0, abs=1e-9)
    assert len(found.loading) == len(named(one, "loading"))
    assert [s.displacement for s in found.unloading] == [*back, *pull, *named(one, "separating")]


def test_what_rows_beside_the_top_change_is_missed() -> None:
    """A crest that is sharp beside the rows."""
    one = contact(lambda d: curve(d) - 0.05 * np.exp(-(((d + 0.511) / 0.01) ** 2)))
    found = passed(one)
    rows = sorted({*[named(one, "unloading")[-1], *named(one, "pulling")[:48]]}, reverse=True)
    force = {s.displacement: s.force for s in one.states}
    before = largest_tension(rows, [force[d] for d in rows])
    assert found.missed == pytest.approx(abs(found.peak.smooth - before.smooth), rel=1e-6)
    assert found.missed > 1e-3


def test_a_contact_that_holds_until_fixed_grips_let_go_has_its_largest_tension_there() -> None:
    """F = 4 (d − 0.5): rows beside the last one stay on the way from no load to there."""
    one = contact(lambda d: 4.0 * (d - 0.5) if d >= LAST else 0.0)
    found = passed(one)
    pull = named(one, "pulling")
    assert min(pull) == pull[47] > LAST
    step = (named(one, "unloading")[-1] - LAST) / 48.0
    assert pull[48:] == pytest.approx([LAST + share * step for share in (0.5, 0.0, 0.25, 0.0, 0.0)], abs=1e-6)
    assert found.peak.smooth == found.peak.tension == pytest.approx(5.6)
    assert found.peak.uncertainty == pytest.approx(1e-9 * 5.6)


def test_the_top_is_the_last_row_of_all_that_fall() -> None:
    falling = [at(0.3, -0.1), at(0.1, -0.4), at(0.2, -0.2), at(0.1, -0.6)]
    found = _peak(falling)
    assert (found.index, found.tension, found.smooth, found.position, found.misplaced) == (2, 0.6, 0.6, 0.1, 0.0)
    assert found.uncertainty == pytest.approx(0.6e-9)
    inner = [*falling, at(0.0, -0.3)]
    d, f = [0.3, 0.2, 0.1, 0.0], [-0.1, -0.2, -0.6, -0.3]
    assert _peak(inner) == largest_tension(d, f)
    assert _peak(inner).uncertainty > 1e-6


@pytest.mark.parametrize("share", [0.99, 1.01])
def test_a_tension_below_the_last_digits_of_all_particles_is_none(share: float) -> None:
    one = contact(force_scale=1e9)
    row = one.row
    one.row = lambda asked: replace(row(asked), residual=share / 40.0)
    if share > 1.0:
        with pytest.raises(DigitsError, match="about 2 FU, is nothing beside 1 FU"):
            passed(one)
    else:
        assert passed(one).peak.smooth == pytest.approx(1.0)


def test_no_load_counts_from_the_tolerance_on_and_is_given_up_after_twelve_tries() -> None:
    for near, rows in ((0.0203, 24), (0.0205, 24)):
        one = contact()
        force = curve(0.52 - 0.0)
        found = _to_zero(one, 0.9, near * force / 0.0204)
        assert (len(found) == rows) == (near > 0.0204)
    jump = contact(lambda d: 0.5 if d > 0.515 else -0.5)
    with pytest.raises(UntrustedError, match="F = 0 is not found near"):
        _to_zero(jump, 0.9, 1e-3)
    assert len(jump.places) == 24 + 12


def test_rows_that_went_through_end_the_way() -> None:
    one = contact()
    row = one.row
    one.row = lambda asked: replace(row(asked), depth=1e-6 if asked.displacement < 0.2 else 0.0)
    with pytest.raises(UntrustedError, match="went through"):
        passed(one)
