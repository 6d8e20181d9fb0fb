"""Pull-off: compress by F_D, then find the maximum tensile force."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import through
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.holding import held_phase, overshoot
from contact1d.workflow.continuation.load_control import FEWEST_HELD, SPREAD, top_of
from contact1d.workflow.continuation.marks import unloading
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.continuation.trust import require_no_contradiction
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.detachment import planned_detachment, pull_off_thermal
from contact1d.workflow.experiments.experiment import Scripted
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import History, Path
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import PullOff, Scene
from contact1d.workflow.units import FORCE, LENGTH

TENSIONS = 12
"""Of a planned pull under load control, where a run would search."""
RATED_STEPS = 120
"""Load steps of a pull whose edge recedes at a finite speed."""
NEAR_ZERO = 3
"""Load steps on both sides of F = 0 that tell when it is."""
LOADING_STEPS = 24
"""Load steps up to a preload at a velocity."""
LARGEST_TENSION = 1.2
"""The last of these tensions over the expected pull-off force."""


class PullOffExperiment(Scripted[PullOff]):
    """F_A, a_cr and a₀ after a preload."""

    main_results = ("adhesion_force", "zero_load_radius", "critical_radius")
    branches = {"pulling": "unloading", "separating": "unloading", "critical": "unloading"}  # noqa: RUF012

    def is_sampled(self, scene: Scene) -> bool:
        """With an edge that takes time."""
        return self.given(scene).velocity is not None

    def script(self, branch: Driver, scene: Scene) -> None:
        """Compress, unload to F = 0, retract to the force maximum, separate; as many times as there are cycles."""
        given = self.given(scene)
        if given.velocity:
            branch.follow(_pulled(branch.model, given))
            return
        scale = max(given.preload, branch.scale)
        for _ in range(given.cycles or 1):
            branch.begin("loading")
            branch.reach(given.preload, scale)
            branch.begin("unloading")
            branch.reach(0.0, min(branch.scale, scale) or scale)
            branch.mark("zero_load")
            branch.begin("pulling")
            branch.maximum()
            branch.mark("critical")
            branch.begin("separating")
            branch.open()

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """The marks of the last unloading; of several cycles the force maximum of the first one, too."""
        preload = float(trace.phases("loading").force[-1])
        given = Reading(preload, FORCE, {"solver": abs(preload - self.given(scene).preload)}, prescribed=True)
        falls = _unloadings(trace)
        found = _marks(falls[-1], scene, settings, preload) | {"preload": given}
        if len(falls) > 1:
            found["adhesion_force_first"] = _marks(falls[0], scene, settings, preload)["adhesion_force"]
        return found

    def asked(self, trace: Trace, scene: Scene) -> Sequence[tuple[float, float]]:
        """The preload, of each cycle."""
        return [(self.given(scene).preload, float(leg.force[-1])) for leg in trace.phases("loading").legs]

    def tables(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Mapping[str, tuple[float, ...]]]:
        """cycles: the force maximum of each."""
        falls, preload = _unloadings(trace), self.given(scene).preload
        if len(falls) == 1:
            return {}
        forces = tuple(_marks(one, scene, settings, preload)["adhesion_force"].value for one in falls)
        return {"cycles": {"cycle": tuple(map(float, range(1, len(falls) + 1))), "adhesion_force": forces}}

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Preload, no load, and tensions up to more than is expected."""
        preload, tension = self.given(scene).preload, settings.law.pull_off_force()
        tensions = [float(-t) for t in np.linspace(0.0, LARGEST_TENSION * tension, TENSIONS + 1)[1:]]
        return (
            held_phase("loading", scene, settings, (preload,), max(preload, tension)),
            held_phase("unloading", scene, settings, (0.0,), max(preload, tension), state=True),
            held_phase("pulling", scene, settings, tensions, tension, state=True),
        )

    def finish(self, outcome: Outcome, scene: Scene, settings: Settings) -> Outcome:
        """Refuse results that contradict the curve of the run; of cycles the number of each state."""
        found = outcome.results["adhesion_force"]
        require_no_contradiction(settings, found.value, found.uncertainty - found.given, outcome.states)
        if self.given(scene).cycles is None:
            return outcome
        numbers = tuple(float(state.phase.partition("_")[2] or 1) for state in outcome.states)
        return replace(outcome, columns={**outcome.columns, "cycle": numbers})

    def advice(self, scene: Scene) -> str:
        """With the limitation of load control in time."""
        since = ", since load control never reaches the pull-off itself" if scene.method == "dynamic" else ""
        return super().advice(scene) + since


def _pulled(model: Particles, given: PullOff) -> History:
    """Down to the preload and back at the velocity, with load steps at equal ways of the edge."""
    assert given.velocity is not None
    deepest = model.displacement_at(given.preload)
    down = np.linspace(0.0, 1.0, LOADING_STEPS + 1)

    velocity = given.velocity

    def pull(back: NDArray[np.float64]) -> tuple[NDArray[np.float64], Path]:
        """F [FU] at times after the preload [TU], and the whole path."""
        time = np.append(deepest / velocity * (down - 1.0), back)
        places = np.append(deepest * down, deepest - velocity * back)
        path = Path(places, np.zeros_like(places), time)
        return model.follow(path).total[down.size :], path

    back = model.moments(deepest, given.velocity, RATED_STEPS)[1:]
    force, _ = pull(back)
    first = max(NEAR_ZERO, int(np.argmax(force < 0.0)))
    near = slice(first - NEAR_ZERO, first + NEAR_ZERO)  # a load step at F = 0, by t(F)
    zero_time = float(np.polynomial.Polynomial.fit(force[near], back[near], 2 * NEAR_ZERO - 1)(0.0))
    back = np.unique(np.append(back, [0.5 * zero_time, zero_time]))  # one is pressed whatever the preload
    force, path = pull(back)
    top = int(np.argmin(force))
    zero = int(np.argmin(np.abs(force[: top + 1])))
    counts = {"loading": down.size, "unloading": zero + 1, "pulling": top - zero, "separating": back.size - top - 1}
    phases = tuple(name for name, count in counts.items() for _ in range(count))
    marks = {"unloading": "zero_load", "pulling": "critical"}
    return History(phases, path.time, path.displacement, by_force=False, marks=marks)


class ThermalPullOff(PullOffExperiment):
    """The detachment force of each pull under noise: a ramp until the bodies separate, once for each seed."""

    is_statistical = True

    def run(self, context: RunContext) -> Outcome:
        """Pull."""
        return pull_off_thermal(context, self.given(context.deck.scene))

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Up to a tension that the predictor does not hold."""
        return planned_detachment(scene, settings, self.given(scene))


def _unloadings(trace: Trace) -> list[Trace]:
    """The legs of falling displacement."""
    return [leg for leg in trace.phases("unloading", "pulling", "separating", "critical").legs if len(leg)]


def _marks(falling: Trace, scene: Scene, settings: Settings, preload: float) -> dict[str, Reading]:
    """Of one unloading, under load or under displacement control."""
    if falling.search.bracket:
        return _under_load(falling, scene, settings, preload)
    return _held(falling.falling(), settings)


def _held(falling: Trace, settings: Settings) -> dict[str, Reading]:
    """The marks of an unloading under displacement control, which begins at F = 0 where there was no preload."""
    held = falling.force[: int(falling.force.argmin()) + 1]  # what is apart has no load either
    found, least = unloading(falling, settings), int(np.argmin(np.abs(held)))
    return (
        found
        if "zero_load_radius" in found
        else found | {"zero_load_radius": Reading(falling.radius_or_spot(least), LENGTH)}
    )


def _under_load(rested: Trace, scene: Scene, settings: Settings, preload: float) -> dict[str, Reading]:
    """F_A in the middle of the bracket; a_cr, which load control never sees, extrapolated over the displacement."""
    assert rested.search.bracket is not None
    best, broken = rested.search.bracket
    tension = 0.5 * (best + broken)
    errors = {"sampling": 0.5 * (broken - best)} | dict(rested.search.doubt)
    zero, last = rested.radius_or_spot(0), len(rested) - 1
    if settings.has_several_maxima:
        # A tooth has no smooth top to go on to. The pull-off may be at the next one, with one particle less at each
        # edge, and further off where tension is left to it: the tops lie near F = F_A (1 − y²),
        # y = (a − a_cr)/(a₀ − a_cr).
        radius = rested.radius_or_spot(last)
        beyond = abs(zero - radius) * math.sqrt(2.0 * sum(errors.values()) / tension)
        critical = Reading(radius, LENGTH, {"instability": scene.bodies.spacing + beyond})
    else:
        critical = _extrapolated(rested)
    at_zero = {}
    if settings.has_several_maxima:  # beyond the largest tension the plate would not have come back
        swung = overshoot(settings, scene.bodies.mass, preload, 0.0) * preload
        at_zero["instability"] = abs(critical.value - zero) * min(swung / tension, 1.0)
    return {
        "adhesion_force": Reading(tension, FORCE, errors),
        "critical_radius": critical,
        "zero_load_radius": Reading(zero, LENGTH, at_zero),
    }


def _extrapolated(rested: Trace) -> Reading:
    """The radius as a parabola through the last three states, where a cubic through four has its force maximum.

    A parabola through three estimates the error of both.
    """
    count = min(FEWEST_HELD, len(rested))
    at = np.arange(len(rested) - count, len(rested))
    d, force = rested.displacement[at], rested.force[at]
    tops = (
        [top_of(d[-few:], force[-few:]) for few in (FEWEST_HELD, FEWEST_HELD - 1)] if count == FEWEST_HELD else [None]
    )
    last = rested.radius_or_spot(int(at[-1]))
    if any(top is None for top in tops) or any(rested.radius(int(i)) is None for i in at[1:]):
        return Reading(last, LENGTH, {"sampling": last})
    places, radii = d[1:], np.asarray([rested.radius_or_spot(int(i)) for i in at[1:]])
    width = float(np.ptp(places))
    value, other = (float(through((places - top[0]) / width, radii)[0]) for top in tops if top is not None)
    return Reading(value, LENGTH, {"sampling": SPREAD * abs(value - other)})
