"""Pull-off as the paper does it: preload F_D, then tensions F_Z, each held until rest or separation, iterated.

The search keeps the last state that held and comes back to it when a tension breaks the contact. Close to the pull-off
the tension over displacement is a parabola: the vertex through the last three held states tells where to look. The
schedule that it ends with rises through the tensions that held to the one that broke; it is run from the start, and the
numbers are those of that run.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from workflow.deck import Phase
from workflow.experiments.bench import Bench
from workflow.experiments.contact import Contact, State
from workflow.experiments.dynamic import LOST, Held, hold
from workflow.experiments.outcome import Outcome, Quantity, UntrustedError, doubts, radius_of, require_trust
from workflow.fragments import fragment
from workflow.scene import Scene
from workflow.units import FORCE, LENGTH

MOST_LEVELS = 60
BRACKET = 1.0
"""Width of the final bracket of the tension over the tolerance."""
AIM = 0.35
"""Distance from the expected pull-off force at which both sides are tried, over the tolerance."""
FIRST_LEVEL = 0.6
"""First tension over the estimated pull-off force."""


@dataclass
class Search:
    """Tensions tried so far; `held` are the ones that held, rising, the first of them F = 0."""

    tolerance: float
    guess: float
    held: list[Held] = field(default_factory=list)
    lost: Held | None = None

    @property
    def best(self) -> float:
        """The largest tension that held [FU]."""
        return -self.held[-1].load

    @property
    def broken(self) -> float | None:
        """The smallest tension that broke the contact [FU]."""
        return None if self.lost is None else -self.lost.load

    @property
    def done(self) -> bool:
        """Whether the bracket is narrow enough."""
        return self.broken is not None and self.broken - self.best <= BRACKET * self.tolerance * self.broken

    def next(self) -> float:
        """The tension to try next [FU]."""
        low, high = self.best, self.broken
        expected = self._vertex()
        if expected is not None:
            margin = AIM * self.tolerance * expected
            for tension in (expected - margin, expected + margin):
                if low + 0.1 * margin < tension < (high - 0.1 * margin if high is not None else np.inf):
                    return min(tension, 1.5 * low)
        if high is not None:
            return 0.5 * (low + high)
        return FIRST_LEVEL * self.guess if low == 0.0 else low + 0.25 * max(self.guess, low)

    def _vertex(self) -> float | None:
        """Top of the parabola of tension over displacement through the last three held states."""
        if len(self.held) < 4:
            return None
        d = np.asarray([h.last.displacement for h in self.held[-3:]])
        tension = np.asarray([-h.load for h in self.held[-3:]])
        a, b, c = np.polyfit(d - d[-1], tension, 2)
        top = c - b**2 / (4 * a) if a < 0 else None
        return float(top) if top is not None and top > self.best else None


def pull_off_dynamic(bench: Bench) -> Outcome:
    """F_A, a_cr and a₀ of a scene with `[experiment] kind = "pull_off"`, `method = "dynamic"`.

    Raises:
        UntrustedError: see `hold`; also where the schedule does not repeat what the search found.
    """
    scene = bench.deck.scene
    assert scene.experiment.kind == "pull_off"
    preload = scene.experiment.preload
    with bench.contact("looking for the pull-off force") as contact:
        first, search = _search(contact, preload)
    phases = _schedule(first, search)
    with bench.contact("the tensions that were found, from the start") as contact:
        states = contact.replay(phases)
    return _outcome(bench, search, phases, states)


def _search(contact: Contact, preload: float) -> tuple[Held, Search]:
    guess = contact.settings.estimate.pull_off_force()
    scale = max(preload, guess)
    contact.begin("loading", "load")
    first = hold(contact, preload, scale)
    contact.begin("unloading", "load")
    zero = hold(contact, 0.0, scale)
    if not (first.held and zero.held):
        raise UntrustedError("the contact is lost before any tension is applied: the bodies do not stick")
    search = Search(contact.scene.accuracy.tolerance, guess, [zero])
    contact.begin("pulling", "load")
    contact.run_fragment(fragment("steps/save").commands)
    for _ in range(MOST_LEVELS):
        tension = search.next()
        result = hold(contact, -tension, scale)
        if result.held:
            search.held.append(result)
            contact.run_fragment(fragment("steps/save").commands)
        else:
            search.lost = result
            contact.run_fragment(fragment("steps/restore").commands)
        if search.done:
            return first, search
    raise UntrustedError(
        f"the pull-off force was not bracketed within {MOST_LEVELS} tensions: it is above {search.best:.6g} FU"
    )


def _schedule(first: Held, search: Search) -> tuple[Phase, ...]:
    zero, *held = search.held
    assert search.lost is not None
    rows = tuple((h.load, h.steps) for h in held)
    lost = (search.lost.load, search.lost.steps + search.lost.steps // 4)
    return (
        Phase("loading", "load", ((first.load, first.steps),)),
        Phase("unloading", "load", ((zero.load, zero.steps),), state=True),
        Phase("pulling", "load", rows, state=True),
        Phase("separating", "load", (lost,)),
    )


def _outcome(bench: Bench, search: Search, phases: tuple[Phase, ...], states: list[State]) -> Outcome:
    scene, settings = bench.deck.scene, bench.deck.settings
    assert search.broken is not None
    assert scene.experiment.kind == "pull_off"
    loaded, zero, *held, lost = states
    for state in (loaded, zero, *held):
        require_trust(scene, settings, state)
    critical = held[-1]
    if -lost.force > LOST * search.broken or abs(critical.force + search.best) > 1e-2 * search.best:
        raise UntrustedError(
            "run from the start, the schedule of the search does not break the contact where the search did"
        )
    adhesion = 0.5 * (search.best + search.broken)
    half = 0.5 * (search.broken - search.best) + abs(critical.force + search.best)
    radii = {name: radius_of(scene, state.profile) for name, state in (("zero_load", zero), ("critical", critical))}
    zero_radius, critical_radius = radii["zero_load"], radii["critical"]
    if zero_radius is None or critical_radius is None:
        raise UntrustedError("no contact radius: no particle is in tension")
    value, spread = _critical_radius(scene, held, adhesion, critical_radius.value)
    slope = abs(critical_radius.value - zero_radius.value) / adhesion
    quantities = {
        "adhesion_force": Quantity(adhesion, half, FORCE),
        "critical_radius": Quantity(value, critical_radius.uncertainty + spread, LENGTH),
        "zero_load_radius": Quantity(zero_radius.value, zero_radius.uncertainty + slope * abs(zero.force), LENGTH),
        "preload": Quantity(loaded.force, abs(loaded.force - scene.experiment.preload), FORCE),
    }
    profiles = {"zero_load": zero.profile, "critical": critical.profile}
    values = {"zero_load": zero_radius.value, "critical": critical_radius.value}
    rest = (loaded, zero, *held)
    return Outcome(quantities, rest, profiles, values, phases, doubts(scene, settings, rest))


def _critical_radius(scene: Scene, held: list[State], adhesion: float, last: float) -> tuple[float, float]:
    """Radius at the pull-off itself: near it a falls with √(F_A − F), so the last two held states lead there."""
    if len(held) < 2:
        return last, last
    radii = [radius_of(scene, state.profile) for state in held[-2:]]
    if radii[0] is None or radii[1] is None:
        return last, last
    root = [max(adhesion + state.force, 0.0) ** 0.5 for state in held[-2:]]
    if root[0] <= root[1]:
        return last, abs(radii[0].value - radii[1].value)
    slope = (radii[0].value - radii[1].value) / (root[0] - root[1])
    step = slope * root[1]
    return last - step, abs(step)
