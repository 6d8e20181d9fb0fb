"""Claims of the force control in time: its search brackets the pull-off force, and its linear estimates are right.

References: a contact that is a mere function, no run; a damped oscillator integrated by scipy; the closed form of
independent springs on a plane, F = (4√2/3)(k/s)√R d^{3/2}.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.analysis.reference.pair_lattice import PairLattice
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.experiments.pull_off.dynamic import BRACKET, Search, missed_teeth, top_of
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.holding import Held, damping_under, overshoot
from contact1d.workflow.scene import Scene, scene_from_dict
from contact1d.workflow.settings.estimate import plane_estimate
from contact1d.workflow.settings.settings import Settings, settings_for
from tests.scenes import chains

NOTHING = np.zeros(3)
PROFILE = Profile(NOTHING, NOTHING, NOTHING, NOTHING, NOTHING)
RULE: Any = None  # no radius is asked for here
SNAPPING = (0.18, 0.03, 0.09, 0.06)
"""Short against the spacing, so that a particle feels its opposite alone; 1.9 times as stiff as the springs."""
ESTIMATED = 1e-3
"""Relative: the estimate's drop of one pair's tension is between points of a grid."""
TIMED = chains(
    200.0,
    damping={"coefficient": "auto"},
    plate={},
    experiment={"kind": "pull_off", "method": "dynamic", "preload": 0.5},
)


def at(displacement: float, force: float) -> State:
    return State("pulling", displacement, force, PROFILE, 1.0, 0.0, 0.0, RULE)


def answer(tension: float, low: float, exact: float, past: float) -> Held:
    """A contact with F = F_A (d² − 1) that breaks where the plate's momentum carries it beyond F_A."""
    held = tension + past * max(0.0, tension - low) < exact
    place = math.sqrt(max(0.0, 1.0 - tension / exact))
    return Held(-tension, (at(place, -tension),), held, 0.0)


@settings(max_examples=300, deadline=None, derandomize=True)
@given(
    st.floats(0.3, 3.0),
    st.one_of(st.floats(0.95, 1.05), st.floats(0.5, 2.0)),
    st.sampled_from((1e-2, 1e-3, 1e-4)),
    st.one_of(st.just(0.0), st.floats(0.0, 0.95)),
)
def test_the_search_brackets_the_pull_off_force(exact: float, wrong: float, tolerance: float, past: float) -> None:
    """Whatever the guess, and also where a plate with momentum breaks the contact at tensions that it could carry."""
    search = Search(tolerance, wrong * exact, lambda tension: past, [Held(0.0, (at(1.0, 0.0),), True, 0.0)])
    for _ in range(60):
        tension = search.next()
        assert search.best < tension < search.broken
        search.learn(answer(tension, search.best, exact, past))
        assert search.best <= exact <= search.broken * (1.0 + 1e-12)
        if search.done:
            break
    assert search.done
    assert search.broken - search.best <= BRACKET * tolerance * search.best


def test_a_good_guess_needs_few_tensions() -> None:
    search = Search(1e-2, 1.001, lambda tension: 0.05, [Held(0.0, (at(1.0, 0.0),), True, 0.0)])
    count = 0
    while not search.done:
        count += 1
        search.learn(answer(search.next(), search.best, 1.0, 0.0))
    assert count <= 5


@pytest.fixture(scope="module")
def scene() -> Scene:
    return scene_from_dict(TIMED)


@pytest.fixture(scope="module")
def own(scene: Scene) -> Settings:
    return settings_for(scene)


def test_automatic_damping_is_critical_under_each_load(scene: Scene, own: Settings) -> None:
    moving = own.plate_mass + own.particles * scene.bodies.mass
    for load in (0.0, -0.2, -0.4):
        drag = own.particles * damping_under(own, load) + own.plate_damping
        assert drag == pytest.approx(2.0 * math.sqrt(own.estimate.stiffness_under(load) * moving), rel=1e-12)
    given_one = replace(own, damped_stiffness=0.0)
    assert damping_under(given_one, -0.4) == own.damping


@pytest.mark.parametrize("share", [0.02, 0.3, 0.8, 1.2])
def test_overshoot_of_a_linear_oscillator(scene: Scene, own: Settings, share: float) -> None:
    """The largest place of M x″ + c x′ + K (x − 1) = 0 from rest, beyond 1."""
    mass, stiffness = own.plate_mass + own.particles * scene.bodies.mass, own.estimate.stiffness_under(0.0)
    drag = share * 2.0 * math.sqrt(stiffness * mass)
    times = np.linspace(0.0, 4.0 * math.pi * math.sqrt(mass / stiffness), 4001)
    moved = solve_ivp(
        lambda _, y: (y[1], (stiffness * (1.0 - y[0]) - drag * y[1]) / mass),
        (0.0, times[-1]),
        (0.0, 0.0),
        t_eval=times,
        rtol=1e-9,
        atol=1e-12,
    )
    damped = replace(own, damped_stiffness=0.0, damping=drag / own.particles, plate_damping=0.0)
    found = overshoot(damped, scene.bodies.mass, 0.0, -0.1)
    assert found == pytest.approx(max(0.0, float(moved.y[0].max()) - 1.0), abs=1e-5)


def test_stiffness_of_a_plane_contact(scene: Scene) -> None:
    """dF/dd = 2√2 (k/s) √R d^½ at F = (4√2/3)(k/s) √R d^{3/2}."""
    bodies = scene.bodies.model_copy(update={"spacing": 0.01})
    force, radius, density = 0.5, 200.0, 0.83 / 0.01
    place = (force / (4.0 * math.sqrt(2.0) / 3.0 * density * math.sqrt(radius))) ** (2.0 / 3.0)
    found = plane_estimate(bodies, 0.01, 0.83).stiffness_under(force)
    assert found == pytest.approx(2.0 * math.sqrt(2.0) * density * math.sqrt(radius * place), rel=2e-3)


def test_stiffness_falls_to_the_softest_towards_the_pull_off(own: Settings) -> None:
    largest = own.estimate.pull_off_force()
    found = [own.estimate.stiffness_under(-share * largest) for share in (0.0, 0.5, 0.9, 0.99, 0.998, 1.0, 1.5)]
    assert found == sorted(found, reverse=True)
    assert found[-1] == found[-2] > 0.0


def test_a_contact_that_parted_is_beyond_its_largest_tension(own: Settings) -> None:
    place = own.estimate.parted(0.6)
    assert -own.estimate.contact_force(place) == pytest.approx(0.6 * own.estimate.pull_off_force(), rel=2e-2)
    assert own.estimate.contact_force(place) > own.estimate.contact_force(place + 0.01)


def test_top_of_a_cubic() -> None:
    """−F = 2 − 3x² + x³ through four states: the largest tension, 2, is at x = 0."""
    states = [at(x, -(2.0 - 3.0 * x**2 + x**3)) for x in (0.9, 0.6, 0.3, 0.1)]
    assert top_of(states) == (pytest.approx(0.0, abs=1e-9), pytest.approx(2.0, abs=1e-12))
    assert top_of([at(x, -x) for x in (0.3, 0.2, 0.1)]) is None


def test_a_plate_that_swings_past_a_tooth_misses_what_the_tension_falls_there() -> None:
    """Reference: independent pairs with their folds. The outermost that hold, one at each edge, let go together."""
    law = PairInteraction(Exponential(*SNAPPING[:2]), Exponential(*SNAPPING[2:]))
    pairs = PairLattice(law, 0.83, (np.arange(40) - 19.5) ** 2 / 200.0)
    deepest = pairs.preloaded(0.5)
    stuck = pairs.stuck_after(deepest)
    lets_go = law.force_free_distance() + np.unique(pairs.heights[stuck]) - pairs.snap_off
    falls = [pairs.force(d - 1e-9, stuck) - pairs.force(d + 1e-9, stuck) for d in lets_go]
    for swing in (0.0, 0.3):
        search = Search(1e-2, 1.0, lambda tension, swing=swing: swing, [Held(0.0, (at(1.0, 0.0),), True, 0.0)])
        scene = scene_from_dict(TIMED | chains(100.0, law=SNAPPING, bodies={"particles": 40}))
        missed = missed_teeth(Deck(scene, settings_for(scene)), search)
        assert missed == pytest.approx(swing * max(falls), rel=ESTIMATED)
