"""Claims of what experiments make of states: errors are propagated as calculus says, searches stay inside brackets.

Reference: finite differences, quadrature, and curves that are given by formulas.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from contact1d.analysis.curve_marks import Peak
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.deck.steps import Displace, DrawnOff, Hold, UnderLoad
from contact1d.workflow.experiments import planned
from contact1d.workflow.experiments.load.quasistatic import load_outcome, load_quasistatic
from contact1d.workflow.experiments.path.path import _critical_radius, _zero_load, path
from contact1d.workflow.experiments.pull_off.pulls import Ramp
from contact1d.workflow.experiments.pull_off.quasistatic import pull_off_quasistatic
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome, anywhere_between, unmet
from contact1d.workflow.experiments.running.prescribing import OVERSHOOT, _around, _next, curve_steps
from contact1d.workflow.experiments.running.sampling import mean_profile, sample_columns
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.units import FORCE, LENGTH, Quantity
from tests.exact import ExactContact, exact_context
from tests.scenes import chains

NOTHING = np.zeros(3)
PROFILE = Profile(NOTHING, NOTHING, NOTHING, NOTHING, NOTHING)
SMOOTH, SNAPPING = (0.018, 0.03, 0.009, 0.06), (0.18, 0.03, 0.09, 0.06)
ROUND_OFF = 1e-9
TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
PULL = {"kind": "pull_off", "preload": 0.3}


def contact(law: tuple[float, ...] = SMOOTH, **tables: Any) -> dict[str, Any]:
    return chains(100.0, law=law, bodies={"particles": 40}, **tables)


class Rule:
    """A contact radius that is given."""

    def __init__(self, value: float | None, uncertainty: float = 0.0) -> None:
        self._found = None if value is None else ContactRadius(value, uncertainty, -value, value, reaches_end=False)

    def of(self, _: Profile) -> ContactRadius | None:
        return self._found


def at(displacement: float, force: float, radius: float | None = None, uncertainty: float = 0.0) -> State:
    rule: Any = Rule(radius, uncertainty)
    return State("unloading", displacement, force, PROFILE, 1.0, 0.0, 0.0, rule)


def test_errors_of_force_and_place_go_into_radius_and_pressure_as_their_slopes_say() -> None:
    """a(d) of the exact pairs by finite differences; p = F/πa², so that δp/p = δF/F + 2 δa/a."""
    context = exact_context(scene_from_dict(contact(experiment={"kind": "load", "force": 0.4})))
    found = load_quasistatic(context)
    bare, forced, moved = (
        load_outcome(context, found.states, found.phases, *errors).quantities
        for errors in ((0.0, 0.0), (1e-3, 0.0), (0.0, 1e-4))
    )
    beside = found.states[-1]
    others = sorted(found.states[:-1], key=lambda s: abs(s.displacement - beside.displacement))
    far = next(s for s in others if abs(s.displacement - beside.displacement) > 1e-3)
    assert far.radius is not None
    assert beside.radius is not None
    slope = (beside.radius.value - far.radius.value) / (beside.displacement - far.displacement)
    grown = moved["contact_radius"].uncertainty - bare["contact_radius"].uncertainty
    assert grown == pytest.approx(1e-4 * abs(slope), rel=0.3)
    assert forced["contact_radius"].uncertainty == bare["contact_radius"].uncertainty
    pressure, radius, force = (bare[name] for name in ("mean_pressure", "contact_radius", "force"))
    for one in (bare, forced, moved):
        share = 2.0 * one["contact_radius"].uncertainty / radius.value + one["force"].uncertainty / force.value
        assert one["mean_pressure"].uncertainty == pytest.approx(share * pressure.value)
    assert found.spacing_uncertainty["mean_pressure"] == pytest.approx(
        2.0 * found.spacing_uncertainty["contact_radius"] / radius.value * pressure.value
    )


class Restless(ExactContact):
    """Each particle is left with a force."""

    left = 1e-7

    def state(self, displacement: float, velocity: float = 0.0) -> State:
        """At a displacement [LU]."""
        return replace(super().state(displacement, velocity), residual=self.left)


@pytest.mark.parametrize(
    ("run", "experiment", "name"),
    [
        (load_quasistatic, {"kind": "load", "force": 0.4}, "force"),
        (pull_off_quasistatic, PULL, "adhesion_force"),
        (path, {"kind": "path", "displacements": [0.1, 0.05, 0.0, -0.02, -0.03, -0.04, -0.05, -0.1]}, "adhesion_force"),
    ],
)
def test_what_particles_are_left_with_adds_up_in_the_claim(
    run: Any, experiment: dict[str, Any], name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    scene = scene_from_dict(contact(experiment=experiment))
    at_rest = run(exact_context(scene)).quantities[name]
    monkeypatch.setattr("tests.exact.ExactContact", Restless)
    restless = run(exact_context(scene)).quantities[name]
    assert restless.value == at_rest.value
    assert restless.uncertainty - at_rest.uncertainty == pytest.approx(40 * Restless.left, rel=1e-6)


@pytest.mark.parametrize("bend", [-0.5, 0.0, 0.3])
@pytest.mark.parametrize("place", [-0.7, -0.2, 0.4])
def test_the_radius_at_a_maximum_between_rows_is_known_to_what_the_rows_bend(bend: float, place: float) -> None:
    """a = 20 + 2 t + bend t² at rows t = 1, 0, −1."""
    rows = [at(t, -1.0, 20.0 + 2.0 * t + bend * t**2, 0.5) for t in (2.0, 1.0, 0.0, -1.0, -2.0)]
    peak = Peak(2, 1.0, 0.0, 1.0, place, 0.0)
    found = _critical_radius(rows, peak, has_edge=False)
    assert found is not None
    error = abs(found.value - (20.0 + 2.0 * place + bend * place**2))
    assert error <= abs(bend) / 4.0 + ROUND_OFF
    assert found.uncertainty == pytest.approx(0.5 + abs(bend) + 0.1 * 4.0)  # lattice, bend, a tenth of two increments
    on_row = _critical_radius(rows, replace(peak, position=0.0), has_edge=False)
    assert on_row is not None
    assert (on_row.value, on_row.uncertainty) == pytest.approx((20.0, 0.5 + abs(2.0 + bend)))
    torn = [*rows[:3], at(-1.0, 0.0)]
    assert _critical_radius(torn, peak, has_edge=False) == Quantity(20.0, 20.0, LENGTH)
    assert _critical_radius(torn, peak, has_edge=True) == Quantity(20.0, 0.0, LENGTH)


def test_the_radius_at_no_load_lies_as_far_between_two_rows_as_the_force_does() -> None:
    rows = [at(d, 2.0 * d - 0.5, 10.0 + 3.0 * d, 0.1 * (1.0 + d)) for d in (1.0, 0.5, 0.0, -0.5)]
    found = _zero_load(rows, [s.displacement for s in rows], [s.force for s in rows])
    assert found is not None
    assert found.value == pytest.approx(10.75)
    assert found.uncertainty == pytest.approx(0.15 + 1.5 / 8.0)
    assert _zero_load(rows[:1], [1.0], [1.5]) is None
    assert _zero_load([*rows[:2], at(0.0, -0.5)], [1.0, 0.5, 0.0], [1.5, 0.5, -0.5]) is None


@pytest.mark.parametrize("spring", [0.0, 0.4])
def test_a_ramp_is_as_steep_as_it_says(spring: float) -> None:
    """The tension after `until` rows is reached and was not before; work is the integral of the tension on the way."""
    ramp = Ramp(10, 0.003, 1000, spring, 0.2 if spring else 0.0)
    for tension, place in ((0.05, -0.1), (0.5, 0.3), (0.31, -1.0)):
        rows = ramp.until(tension, place)
        assert ramp.tension(rows, place) >= tension - ROUND_OFF
        assert ramp.tension(rows - 1, place) < tension
    row = ramp.row(7)
    assert isinstance(row, DrawnOff if spring else UnderLoad)
    if isinstance(row, DrawnOff):
        assert spring * (-0.3 - row.end) == pytest.approx(ramp.tension(7, -0.3))
    else:
        assert row.load == pytest.approx(-ramp.tension(7, 0.0))
    work = quad(lambda place: ramp.tension(80, place), -0.9, -0.1)[0]
    assert ramp.work(80, -0.9, -0.1) == pytest.approx(work)


@given(st.floats(-2.0, 2.0), st.floats(0.1, 3.0), st.floats(0.2, 4.0), st.sampled_from((1, -1)))
def test_the_next_place_of_a_search_is_the_roots_or_inside_its_bracket(
    start: float, width: float, slope: float, direction: int
) -> None:
    """On a straight line the secant meets the force at once; on any other it stays off both ends of the bracket."""
    before, beyond = at(start, 1.0), at(start + direction * width, 1.0 + direction * slope * width)
    wanted = 1.0 + 0.3 * direction * slope * width
    assert _next(before, beyond, [before], wanted, 9.0) == pytest.approx(start + 0.3 * direction * width)
    for part in (-1.0, 0.0, 1.0, 2.0):
        place = _next(before, beyond, [before], 1.0 + part * direction * slope * width, 9.0)
        assert 0.04 * width < abs(place - start) < 0.96 * width
    step = direction * 0.1 * width
    behind = at(start - step, 1.0 - slope * step)
    near = _next(before, None, [behind, before], 1.0 + 0.5 * slope * step, step)
    assert near - start == pytest.approx(0.5 * OVERSHOOT * step)
    for far in (1.0 + 3.0 * slope * step, 1.0 - slope * step):
        assert _next(before, None, [behind, before], far, step) - start == pytest.approx(step)
    assert _next(before, None, [before], 5.0, step) - start == pytest.approx(step)
    assert _next(before, None, [replace(behind, force=1.0), before], 5.0, step) - start == pytest.approx(step)


def test_a_force_lies_between_the_last_row_short_of_it_and_the_next() -> None:
    rows = [at(0.1 * i, 0.1 * i) for i in range(6)]
    for direction, ordered in ((1, rows), (-1, rows[::-1])):
        before, beyond = _around(ordered, 0.25, direction)
        assert before is not None
        assert beyond is not None
        assert sorted((before.force, beyond.force)) == pytest.approx([0.2, 0.3])
        assert direction * (before.force - beyond.force) < 0.0
    assert _around(rows, 0.9, 1) == (rows[-1], None)
    assert _around(rows, -0.1, 1) == (None, rows[0])
    assert _around(rows[:1], 0.5, 1) == (None, None)


def test_a_long_chain_has_fewer_increments_and_never_fewer_than_a_search() -> None:
    settings = settings_for(scene_from_dict(contact(experiment=PULL)))
    assert [curve_steps(replace(settings, particles=n)) for n in (10, 2000, 4000, 10**6)] == [100, 100, 50, 24]


def places(name: str, **tables: Any) -> list[float]:
    """Displacements of a planned phase."""
    scene = scene_from_dict(contact(**tables))
    phase = next(phase for phase in planned(scene, settings_for(scene)) if phase.name == name)
    return [row.displacement for row in phase.rows if isinstance(row, Displace)]


def test_a_planned_way_goes_down_from_where_the_bodies_stand_and_back_until_they_are_apart() -> None:
    for experiment in ({"kind": "load", "force": 0.4}, PULL):
        scene = scene_from_dict(contact(experiment=experiment))
        settings = settings_for(scene)
        down = places("loading", experiment=experiment)
        assert (down[0], down[-1]) == (0.0, settings.largest_displacement)
        assert np.diff(down) == pytest.approx(np.full(len(down) - 1, settings.largest_displacement / (len(down) - 1)))
        phases = planned(scene, settings)
        assert phases[-1].state
    back = places("unloading", experiment=PULL)
    assert back[0] == down[-1]
    assert back[-1] == pytest.approx(settings.rest - settings.cutoff)  # nothing is felt any more
    assert (np.diff(back) < 0.0).all()


def test_planned_tensions_rise_from_none_to_beyond_what_is_held() -> None:
    scene = scene_from_dict(contact(**TIMED, experiment=PULL | {"method": "dynamic"}))
    settings = settings_for(scene)
    loading, unloading, pulling = planned(scene, settings)
    rows = [[row.load for row in phase.rows if isinstance(row, Hold)] for phase in (loading, unloading, pulling)]
    largest = settings.estimate.pull_off_force()
    assert rows[:2] == [[0.3], [0.0]]
    assert not loading.state
    assert unloading.state
    assert pulling.state
    steps = np.diff([0.0, *rows[2]])
    assert steps == pytest.approx(np.full(len(rows[2]), -1.2 * largest / len(rows[2])))
    assert -rows[2][-1] == pytest.approx(1.2 * largest)
    near = max(0.3, largest)
    rests = [row.rest for phase in (loading, unloading, pulling) for row in phase.rows if isinstance(row, Hold)]
    assert rests[:2] == [pytest.approx(rests[2] * near / largest)] * 2


def outcome(**quantities: Quantity) -> Outcome:
    return Outcome(quantities, (), {}, {}, ())


def test_results_are_unmet_from_the_tolerance_on_and_never_those_that_are_given() -> None:
    scene = scene_from_dict(contact(experiment=PULL, accuracy={"tolerance": 1e-2}))
    known = outcome(
        adhesion_force=Quantity(-2.0, 0.019, FORCE), critical_radius=Quantity(3.0, 0.031, LENGTH),
        zero_load_radius=Quantity(0.0, 0.1, LENGTH), preload=Quantity(1.0, 0.5, FORCE),
        force=Quantity(0.0, 0.1, FORCE),
    )  # fmt: skip
    known = replace(known, prescribed=frozenset({"preload"}))
    shares = unmet(scene, known)
    assert shares == {"critical_radius": pytest.approx(0.031 / 3.0), "zero_load_radius": math.inf}
    assert set(unmet(scene, replace(known, compared_with={"critical_radius": 4.0}))) == {"zero_load_radius"}
    assert set(unmet(scene, replace(known, centring={"critical_radius": 0.002}))) == {"zero_load_radius"}
    heat = scene.model_copy(update={"noise": object()})
    assert unmet(heat, known) == {}


def test_what_the_lattice_leaves_open_is_added_to_each_claim_and_told_from_the_tolerance_on() -> None:
    tables = chains(100.0, law=SMOOTH, bodies={"spacing": 4.0}, experiment={"kind": "load", "force": 2.0})
    scene = scene_from_dict(tables)
    settings = settings_for(scene)
    known = outcome(
        force=Quantity(2.0, 0.1, FORCE), displacement=Quantity(0.1, 0.001, LENGTH),
        contact_radius=Quantity(5.0, 0.2, LENGTH), mean_pressure=Quantity(0.02, 0.001, "FU/LU²"),
    )  # fmt: skip
    found = anywhere_between(scene, settings, known)
    assert found.centring
    for name, one in found.quantities.items():
        assert one.uncertainty == pytest.approx(known.quantities[name].uncertainty + found.centring.get(name, 0.0))
        assert found.on_own_lattice[name].uncertainty == pytest.approx(known.quantities[name].uncertainty)
    if "contact_radius" in found.centring:
        share = 2.0 * found.centring["contact_radius"] / 5.0
        assert found.centring["mean_pressure"] == pytest.approx(share * 0.02)
    least = max(part / abs(known.quantities[name].value) for name, part in found.centring.items())
    assert ("lattice" in found.warnings) == (least > scene.accuracy.tolerance)


def test_means_and_samples_are_those_of_their_states() -> None:
    profiles = [Profile(*(np.arange(4.0) + i + 10 * n for n in range(5))) for i in (0.0, 1.0, 5.0)]
    mean = mean_profile(profiles)
    for n, name in enumerate(("x", "z_lower", "z_upper", "pressure", "shear")):
        assert getattr(mean, name) == pytest.approx(np.arange(4.0) + 2.0 + 10 * n)
    settings = replace(settings_for(scene_from_dict(contact(experiment=PULL))), time_step=0.02)
    states = [replace(at(0.1 * i, -0.2 * i, 3.0 + i if i else None), step=50.0 * i) for i in range(3)]
    table = sample_columns(states, [1.0, 2.0, 3.0], settings)
    assert table["time"] == pytest.approx((0.0, 1.0, 2.0))
    assert table["force"] == pytest.approx((0.0, -0.2, -0.4))
    assert table["displacement"] == pytest.approx((0.0, 0.1, 0.2))
    assert table["contact_radius"] == pytest.approx((math.nan, 4.0, 5.0), nan_ok=True)
    assert table["load"] == (1.0, 2.0, 3.0)
