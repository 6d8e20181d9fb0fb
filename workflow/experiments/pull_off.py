"""Pull-off: compress by F_D, then find the maximum tensile force.

F_A is the force maximum, a tension, a_cr the contact radius there, and a₀ that at F = 0. A leg is a part of the path
between two turns of the loading. Displacements [LU] and forces [FU] are positive in compression.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.polynomial import through
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.holding import held_phase, overshoot
from contact1d.workflow.continuation.load_control import top_of
from contact1d.workflow.continuation.marks import unloading
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.reduction import Reduction
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


class PullOffExperiment(Scripted[PullOff]):
    """F_A, a_cr and a₀ after a preload."""

    main_results = ("adhesion_force", "zero_load_radius", "critical_radius")
    branches = {"pulling": "unloading", "separating": "unloading", "critical": "unloading"}  # noqa: RUF012

    def is_sampled(self, scene: Scene) -> bool:
        """Return whether the scene gives a velocity.

        The load steps are then known beforehand, so that results have a sampling error.
        """
        return self.given(scene).velocity is not None

    def script(self, branch: Driver, scene: Scene) -> None:
        """Compress, unload to F = 0, retract to the force maximum, separate; as many times as there are cycles.

        The states at F = 0 and at the force maximum are marked "zero_load" and "critical", of several cycles those of
        the last. At a given velocity one cycle of planned displacements over time is followed instead.
        """
        given = self.given(scene)
        if given.velocity:
            branch.follow(_history_at_velocity(branch.model, given))
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
        """Return the results of the last unloading; of several cycles the force maximum of the first one, too.

        "adhesion_force" and "adhesion_force_first" [FU], as positive tensions, "preload" [FU], the force reached in the
        last compression, "critical_radius", "zero_load_radius", "cohesive_radius" [LU] and "work_of_separation"
        [FU·LU]; all but the preload as far as there are any.
        """
        preload = float(trace.phases("loading").force[-1])
        given = Reading(preload, FORCE, {"solver": abs(preload - self.given(scene).preload)}, prescribed=True)
        unloadings = _unloadings(trace)
        results = _marks(unloadings[-1], scene, settings, preload) | {"preload": given}
        if len(unloadings) > 1:
            results["adhesion_force_first"] = _marks(unloadings[0], scene, settings, preload)["adhesion_force"]
        return results

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return phases at the preload, at F = 0, and at 12 tensions up to 1.2 times the expected pull-off force.

        Their names are "loading", "unloading" and "pulling"; they are those of one cycle.
        """
        preload, tension = self.given(scene).preload, settings.law.pull_off_force()
        tensions = [float(-t) for t in np.linspace(0.0, 1.2 * tension, 12 + 1)[1:]]
        return (
            held_phase("loading", scene, settings, (preload,), max(preload, tension)),
            held_phase("unloading", scene, settings, (0.0,), max(preload, tension), state=True),
            held_phase("pulling", scene, settings, tensions, tension, state=True),
        )

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with a check of the preload of each cycle, and with what there is of several cycles.

        Where the scene gives cycles, the curve has a column "cycle", the cycle of each state from 1 on; of more than
        one there is a table "cycles" with "cycle" and "adhesion_force", a positive tension [FU].

        Raises:
            UntrustedError: a state has more tension than the force maximum and its uncertainty.
        """
        scene, settings, given = case.scene, case.settings, self.given(case.scene)
        force = outcome.results["adhesion_force"]
        require_no_contradiction(settings, force.value, force.uncertainty - force.given, outcome.states)
        preloads = [(given.preload, float(leg.force[-1])) for leg in trace.phases("loading").legs]
        checks = consistency.asked(scene, preloads, outcome.states)
        columns, tables, unloadings = {}, {}, _unloadings(trace)
        if given.cycles is not None:
            columns["cycle"] = tuple(float(state.phase.partition("_")[2] or 1) for state in outcome.states)
        if len(unloadings) > 1:
            forces = tuple(_marks(leg, scene, settings, given.preload)["adhesion_force"].value for leg in unloadings)
            tables["cycles"] = {"cycle": tuple(map(float, range(1, len(unloadings) + 1))), "adhesion_force": forces}
        return outcome.adding(columns=columns, tables=tables, consistency=checks)

    def advice(self, scene: Scene) -> str:
        """Return the advice by the method and the interaction, as a sentence without a full stop.

        In time it ends with the limitation of load control, which never reaches the pull-off itself.
        """
        since = ", since load control never reaches the pull-off itself" if scene.method == "dynamic" else ""
        return super().advice(scene) + since


def _history_at_velocity(model: Particles, given: PullOff) -> History:
    """Return the history to the preload and back at the velocity, displacements [LU] over times [TU].

    In unloading its edge recedes by about equal distances, with load steps at F = 0 and halfway there from the preload.
    Phases are "loading", "unloading" up to F = 0, "pulling" up to the force maximum and "separating"; the ends of
    "unloading" and "pulling" are marked "zero_load" and "critical". `given` must have a velocity.
    """
    assert given.velocity is not None
    deepest = model.displacement_at(given.preload)
    velocity, down = given.velocity, np.linspace(0.0, 1.0, 25)

    def pull(back: NDArray[np.float64]) -> tuple[NDArray[np.float64], Path]:
        """Return (F, (k,) [FU], compression positive, at times `back` after the preload (k,) [TU], the whole path).

        The path has the loading before.
        """
        time = np.append(deepest / velocity * (down - 1.0), back)
        displacements = np.append(deepest * down, deepest - velocity * back)
        path = Path(displacements, np.zeros_like(displacements), time)
        return model.follow(path).total[down.size :], path

    back = model.moments(deepest, given.velocity, 120)[1:]
    force, _ = pull(back)
    sides = 3  # load steps on both sides of F = 0, whose time is interpolated by t(F)
    first = max(sides, int(np.argmax(force < 0.0)))
    near = slice(first - sides, first + sides)
    zero_time = float(np.polynomial.Polynomial.fit(force[near], back[near], 2 * sides - 1)(0.0))
    back = np.unique(np.append(back, [0.5 * zero_time, zero_time]))  # a compressed state, whatever the preload
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
        """Run the pulls of all seeds and return the outcome with the mean detachment force.

        Raises:
            UntrustedError: the bodies separate before the pull or not at all, or have passed through each other before
                it, or the contact then reaches the end of its chain.
            EngineError: LAMMPS failed.
        """
        return pull_off_thermal(context, self.given(context.deck.scene))

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the planned phases "loading", "settling", "pulling", up to 1.1 times the predicted pull-off force."""
        return planned_detachment(scene, settings, self.given(scene))


def _unloadings(trace: Trace) -> list[Trace]:
    """Return the legs of unloading and separation as traces, one for each cycle in order; [] without unloading."""
    return trace.phases("unloading", "pulling", "separating", "critical").legs


def _marks(falling: Trace, scene: Scene, settings: Settings, preload: float) -> dict[str, Reading]:
    """Return the force maximum and radii of one unloading by name, those that it has, with their errors.

    "adhesion_force" [FU], a positive tension, "critical_radius" and "zero_load_radius" [LU]; under displacement control
    also "cohesive_radius" [LU] and "work_of_separation" [FU·LU]. Load control is recognised by the bracket of its
    search.

    Args:
        falling: trace of the unloading.
        scene: whose pull-off it is.
        settings: of the run.
        preload: compression positive [FU].
    """
    if falling.search.bracket:
        return _marks_by_load(falling, scene, settings, preload)
    return _marks_by_displacement(falling.falling(), settings)


def _marks_by_displacement(falling: Trace, settings: Settings) -> dict[str, Reading]:
    """Return the results of an unloading under displacement control, by name, those that it has.

    "adhesion_force" [FU], a positive tension, "critical_radius", "zero_load_radius", "cohesive_radius" [LU] and
    "work_of_separation" [FU·LU]. "zero_load_radius" is always there: where the force does not cross 0, as without a
    preload, it is that of the state of least |F| before the maximum.
    """
    held = falling.force[: int(falling.force.argmin()) + 1]  # separated bodies have no load either
    marks, least = unloading(falling, settings), int(np.argmin(np.abs(held)))
    if "zero_load_radius" not in marks:
        marks["zero_load_radius"] = Reading(falling.radius_or_spot(least), LENGTH)
    return marks


def _marks_by_load(rested: Trace, scene: Scene, settings: Settings, preload: float) -> dict[str, Reading]:
    """Return the results of an unloading under load control, by name, each with its errors.

    "adhesion_force" F_A [FU], a positive tension, is the middle of the bracket of the search; "zero_load_radius" a₀
    [LU] that of the first state; "critical_radius" a_cr [LU], which load control never reaches, is extrapolated, or
    where there are several maxima that of the last state.

    Args:
        rested: states at rest under rising tensions from F = 0 on, with a bracket.
        scene: whose pull-off it is.
        settings: of the run.
        preload: compression positive [FU].
    """
    assert rested.search.bracket is not None
    best, broken = rested.search.bracket
    tension = 0.5 * (best + broken)
    errors = {"sampling": 0.5 * (broken - best)} | dict(rested.search.doubt)
    zero, last = rested.radius_or_spot(0), len(rested) - 1
    if settings.has_several_maxima:
        # No smooth maximum can be extrapolated. The pull-off may be at the next maximum, with one particle less at each
        # edge, and further off where the bracket of F_A allows it: the maxima lie near F = F_A (1 − y²),
        # y = (a − a_cr)/(a₀ − a_cr).
        radius = rested.radius_or_spot(last)
        beyond = abs(zero - radius) * math.sqrt(2.0 * sum(errors.values()) / tension)
        critical = Reading(radius, LENGTH, {"instability": scene.bodies.spacing + beyond})
    else:
        critical = _critical_radius(rested)
    at_zero = {}
    if settings.has_several_maxima:  # beyond the force maximum the plate would not have come back
        swung = overshoot(settings, scene.bodies.mass, preload, 0.0) * preload
        at_zero["instability"] = abs(critical.value - zero) * min(swung / tension, 1.0)
    return {
        "adhesion_force": Reading(tension, FORCE, errors),
        "critical_radius": critical,
        "zero_load_radius": Reading(zero, LENGTH, at_zero),
    }


def _critical_radius(rested: Trace) -> Reading:
    """Return the radius [LU] at the force maximum of a cubic through the last four states, with its sampling error.

    The radius is a parabola through the last three states, the error twice the change with a parabola for the force.
    With fewer than four states, where a polynomial has no maximum nearby, or where one of the last three is without a
    contact, it is the radius of the last state, uncertain by its whole value.
    """
    few, margin = 4, 2.0  # error over the change with one state less
    count = min(few, len(rested))
    chosen = np.arange(len(rested) - count, len(rested))
    d, force = rested.displacement[chosen], rested.force[chosen]
    tops = [top_of(d[-used:], force[-used:]) for used in (few, few - 1)] if count == few else [None]
    last = rested.radius_or_spot(int(chosen[-1]))
    if any(top is None for top in tops) or any(rested.radius(int(i)) is None for i in chosen[1:]):
        return Reading(last, LENGTH, {"sampling": last})
    d, radii = d[1:], np.asarray([rested.radius_or_spot(int(i)) for i in chosen[1:]])
    width = float(np.ptp(d))
    radius, coarser = (float(through((d - top[0]) / width, radii)[0]) for top in tops if top is not None)
    return Reading(radius, LENGTH, {"sampling": margin * abs(radius - coarser)})
