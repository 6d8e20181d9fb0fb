"""A pull-off by tensions, one after the other: which are tried, what brackets it, and what radius and claim follow.

The contact has F = F_A (d² − 1), at rest under every tension up to F_A. Tensions are counted out by the rule: a share
of what is left to the expected one, then both sides of it, then the middle of the bracket.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from contact1d.workflow.experiments.pull_off.dynamic import (
    _critical_radius,
    _outcome,
    _overshoot,
    _pull,
    _radius_between_snaps,
    missed_teeth,
    pull_off_dynamic,
)
from contact1d.workflow.experiments.running.holding import Held, Start, overshoot
from contact1d.workflow.experiments.running.trust import UntrustedError
from tests.given import PULL, Estimate, GivenContact, at, given_context, given_scene, held, search

TIMED: dict[str, Any] = {"damping": {"coefficient": "auto"}, "plate": {}}
SCENE = given_scene(**TIMED, experiment=PULL | {"method": "dynamic"})


def lagrange(places: list[float], place: float) -> np.ndarray:
    """Weights of values at places in the polynomial through them, one product for each."""
    return np.asarray([
        math.prod((place - other) / (one - other) for other in places if other != one) for one in places
    ])  # fmt: skip


def test_the_radius_at_the_top_of_a_cubic_goes_on_as_a_parabola_and_is_known_to_what_one_state_less_changes() -> None:
    """T = 2 − 3x² + x³ has its top at 0; a = 5 + 2x + 4x². The parabola through three states by numpy's own fit."""
    places = [0.9, 0.6, 0.3, 0.1]
    states = [at(x, -(2.0 - 3.0 * x**2 + x**3), 5.0 + 2.0 * x + 4.0 * x**2, 0.1 + x) for x in places]
    found, spread = _critical_radius([at(7.0, -0.1, 3.0), *states])
    c = np.polyfit(places[1:], [-s.force for s in states[1:]], 2)
    other = -c[1] / (2.0 * c[0])
    weights = lagrange(places[1:], 0.0)
    assert found.value == pytest.approx(5.0)
    assert spread == pytest.approx(float(np.abs(weights) @ [0.7, 0.4, 0.2]))
    assert found.uncertainty == pytest.approx(spread + 2.0 * abs(2.0 * other + 4.0 * other**2), rel=1e-6)
    untold = states[1].displacement, states[1].force
    for few in (states[1:], [states[0], at(*untold, None), *states[2:]], [at(x, -x, 2.0, 0.3) for x in (4, 3, 2, 1)]):
        rough, left = _critical_radius(few)
        last = few[-1].radius
        assert last is not None
        assert (rough.value, rough.uncertainty, left) == pytest.approx((last.value, last.value, last.uncertainty))
    bent = [at(x, -(1.0 - x**3 - 0.3 * x), 2.0 + x, 0.3) for x in (0.3, 0.2, 0.1, 0.0)]  # its parabola has a top
    assert _critical_radius(bent)[0].uncertainty == 2.0
    with pytest.raises(UntrustedError, match="no particle is in tension"):
        _critical_radius([*states[:3], at(0.1, -1.9, None)])


def contact(largest: float = 1.0, tops: float | None = None, **more: Any) -> Any:
    """F = `largest` (d² − 1), held up to a tension of `tops`."""

    def place(load: float) -> float | None:
        return None if -load > (largest if tops is None else tops) else math.sqrt(max(0.0, 1.0 + load / largest))

    known = {"estimate": Estimate(largest=largest), "largest_displacement": 3.0, "cutoff": 9.0, "tolerance": 1e-2}
    scene = more.pop("scene", SCENE)
    return GivenContact(
        lambda d: largest * (d**2 - 1.0), place=place, radius=lambda d: 4.0 + 2.0 * d, spread=0.05, scene=scene,
        **known | more,
    )  # fmt: skip


@pytest.mark.parametrize("guess", [0.6, 0.97, 1.0, 1.5])
def test_a_pull_off_is_bracketed_and_its_radius_is_that_at_no_stiffness(guess: float) -> None:
    one = contact(estimate=Estimate(largest=guess))
    found = pull_off_dynamic(given_context(one))
    known = found.quantities
    force = known["adhesion_force"]
    assert abs(force.value - 1.0) <= force.uncertainty <= 0.006
    assert known["critical_radius"].value == pytest.approx(4.0, abs=0.02)
    assert abs(known["critical_radius"].value - 4.0) <= known["critical_radius"].uncertainty
    assert known["zero_load_radius"].value == pytest.approx(6.0)
    assert (known["preload"].value, known["preload"].uncertainty) == pytest.approx((0.3, 0.0), abs=1e-9)
    assert [(phase.name, phase.state) for phase in found.phases] == [
        ("loading", False), ("unloading", True), ("pulling", False), ("critical", True),
    ]  # fmt: skip
    assert one.ended == ["critical"]
    loads = [row.load for row in one.holds]
    assert loads[:2] == [0.3, 0.0]
    best = max(-load for load in loads if -load <= 1.0)
    assert -loads[-1] == best
    starts = [row.start for row in one.holds]
    parted = [-load > 1.0 for load in loads]
    assert starts[3:-1] == [Start.BACK if before else Start.KEPT for before in parted[2:-2]]
    assert starts[-1] == Start.BACK
    assert force.value == pytest.approx(0.5 * (best + min(-load for load in loads if -load > 1.0)), rel=2e-3)
    assert found.states[-1].force == pytest.approx(-best)
    rests = [row.rest for row in one.holds]
    assert rests == pytest.approx([rests[0]] * len(rests))  # of the larger of preload and guess


@pytest.mark.parametrize("preload", [0.1, 4.0])
def test_rest_is_judged_by_the_larger_of_preload_and_pull_off(preload: float) -> None:
    scene = given_scene(**TIMED, experiment=PULL | {"method": "dynamic", "preload": preload})
    one = contact(scene=scene)
    pull_off_dynamic(given_context(one))
    rests = [row.rest for row in one.holds]
    assert np.asarray(rests) / rests[-1] == pytest.approx([max(preload, 1.0)] * 2 + [1.0] * (len(rests) - 2))


def test_bodies_that_do_not_stick_or_swing_are_no_result() -> None:
    with pytest.raises(UntrustedError, match="the bodies do not stick"):
        pull_off_dynamic(given_context(contact(tops=-0.1)))
    seen = set[float]()
    swinging = contact()
    place = swinging._place

    def once(load: float) -> float | None:
        again = load in seen
        seen.add(load)
        return None if again and load < 0.0 else place(load)

    swinging._place = once
    with pytest.raises(UntrustedError, match=r"held 0\.9.* FU once and not again"):
        pull_off_dynamic(given_context(swinging))


def test_a_bracket_that_never_closes_ends_after_sixty_tensions() -> None:
    one: Any = GivenContact(lambda d: d, place=lambda load: load, scene=SCENE, cutoff=9.0, tolerance=1e-2)
    one.begin("pulling")
    with pytest.raises(UntrustedError, match="not bracketed within 60 tensions"):
        _pull(one, search(past=0.0))
    assert len(one.holds) == 60


def test_a_swing_is_told_by_the_stiffness_under_the_tension_that_held_and_the_drag_under_the_largest() -> None:
    """K = 2 + 0.9 F; γ as the root of it, 0.8 of critical at K = 2."""
    moving = contact().settings.plate_mass + 40 * SCENE.bodies.mass
    drag = 0.8 * 2.0 * math.sqrt(2.0 * moving) / 40
    soft = Estimate(stiffness=lambda load: 2.0 + 0.9 * load)
    one = contact(estimate=soft, damped_stiffness=2.0, damping=drag, plate_damping=0.0)
    ratio = 0.8 * math.sqrt(0.2 / 2.0) * math.sqrt(2.0 / 1.1)
    past = math.exp(-math.pi * ratio / math.sqrt(1.0 - ratio**2))
    assert _overshoot(one.deck, 2.0, 1.0) == pytest.approx(past)


class Snapping(Estimate):
    """Pairs that let go one by one, each of which takes 0.02 FU of the tension with it."""

    snap = (0.4, 0.02)

    def stuck_stiffness(self, displacement: float) -> float:
        """Of all that are stuck when deepest [FU/LU]."""
        return 0.5 * displacement


def toothed(snap: float = 0.02) -> Any:
    estimate = Snapping(snaps=True, force=np.asarray([0.5, -0.03, -0.01, 0.0]))
    estimate.snap = (0.4, snap)
    return contact(estimate=estimate, plate_damping=0.0, damping=0.0, damped_stiffness=0.0)


def test_a_swing_past_a_tooth_misses_a_pair_at_each_edge() -> None:
    """What a snap takes, or where none is known what a pair has at most; a smooth curve misses nothing."""
    known = search(0.5, past=0.3)
    assert missed_teeth(toothed().deck, known) == pytest.approx(2.0 * 0.02 * 0.3)
    assert missed_teeth(toothed(0.0).deck, known) == pytest.approx(2.0 * 0.03 * 0.3)
    assert missed_teeth(contact().deck, known) == 0.0


def test_between_teeth_a_radius_is_known_to_a_particle_and_what_the_bracket_leaves() -> None:
    scene = given_scene(**TIMED, bodies={"particles": 40, "spacing": 0.5}, experiment=PULL | {"method": "dynamic"})
    one: Any = given_context(contact(scene=scene))
    found, spread = _radius_between_snaps(one, at(0.0, -1.0, 4.0, 0.1), 6.5, 0.02)
    assert spread == pytest.approx(0.6)
    assert (found.value, found.uncertainty) == pytest.approx((4.0, 0.6 + 2.5 * 0.2))
    assert _radius_between_snaps(one, at(0.0, -1.0, 6.5, 0.1), 4.0, 0.02)[0].uncertainty == pytest.approx(0.6 + 0.5)


def outcome(one: Any, unbalance: float = 0.0, zero_force: float = 0.0) -> Any:
    known = search(past=0.0)
    places = (0.9, 0.6, 0.3, 0.1)
    states = [(x, 1.0 - x**2, {"radius": 4.0 + 2.0 * x, "uncertainty": 0.05}) for x in places]
    known.held = [Held(0.0, (at(1.0, zero_force, 6.0, 0.1),), True, 0.0), *(held(t, x, **m) for x, t, m in states)]
    known.broken = known.best * (1.0 + 8e-3)
    last = known.held[-1]
    loaded = Held(0.3, (at(1.2, 0.35, 7.0),), True, 0.07)
    critical = Held(last.load, last.states, True, unbalance)
    return known, _outcome(given_context(one), known, loaded, critical, ())


def test_the_claims_of_a_pull_off_are_its_bracket_and_what_was_not_at_rest() -> None:
    """a₀ goes along the chord from a_cr to it by what its force is off F = 0."""
    known, found = outcome(contact(), 0.002, -0.01)
    quantities = found.quantities
    force = quantities["adhesion_force"]
    assert force.value == pytest.approx(0.99 * (1.0 + 4e-3))
    assert force.uncertainty == pytest.approx(0.99 * 4e-3 + 0.002)
    slope = abs(6.0 - quantities["critical_radius"].value) / force.value
    assert quantities["zero_load_radius"].uncertainty == pytest.approx(0.1 + 0.01 * slope)
    assert (quantities["preload"].value, quantities["preload"].uncertainty) == (0.35, 0.07)
    assert quantities["critical_radius"].value == pytest.approx(4.0, abs=1e-6)
    weights = lagrange([0.6, 0.3, 0.1], 0.0)
    assert found.spacing_uncertainty == {
        "critical_radius": pytest.approx(0.05 * float(np.abs(weights).sum())), "zero_load_radius": 0.1,
    }  # fmt: skip
    assert [s.displacement for s in found.states] == [1.2, 1.0, 0.9, 0.6, 0.3, 0.1]
    assert found.radii == {"zero_load": 6.0, "critical": 4.2}
    assert known.best == pytest.approx(0.99)


@pytest.mark.parametrize("drag", [0.0, 0.5])
def test_over_teeth_the_swing_after_the_preload_is_in_the_claim_of_the_radius_at_no_load(drag: float) -> None:
    """As far as the largest tension at most: beyond that the plate would not have come back."""
    one = toothed()
    stiffness = 0.5 * 3.0
    mass = one.settings.plate_mass + 40 * SCENE.bodies.mass
    one = contact(estimate=one.settings.estimate, damped_stiffness=0.0, damping=0.0,
                  plate_damping=drag * 2.0 * math.sqrt(stiffness * mass))  # fmt: skip
    _, found = outcome(one, 0.0, -0.01)
    quantities = found.quantities
    force = quantities["adhesion_force"].value
    swing = math.exp(-math.pi * drag / math.sqrt(1.0 - drag**2))
    assert overshoot(one.settings, SCENE.bodies.mass, 0.35, 0.0) == pytest.approx(swing)
    half = 0.99 * 4e-3
    spread = 0.05 + 1.0
    beyond = (6.0 - 4.2) * math.sqrt(2.0 * half / force)
    assert quantities["critical_radius"].uncertainty == pytest.approx(spread + beyond)
    slope = (6.0 - 4.2) / force
    at_zero = 0.01 + min(swing * 0.35, force)
    assert quantities["zero_load_radius"].uncertainty == pytest.approx(0.1 + slope * at_zero)
