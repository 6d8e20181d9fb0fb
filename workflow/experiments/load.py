"""Load: equilibrium under a normal force.

d [LU] and F [FU] are positive in compression, a is the contact radius [LU].
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.holding import held_phase
from contact1d.workflow.continuation.load_control import FIRST_RISE, LoadBranch
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.experiment import Scripted
from contact1d.workflow.experiments.thermal import planned_samples, thermal_load
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Load, Scene
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE


class LoadExperiment(Scripted[Load]):
    """d, F, a and F/(πa²) under a force. A tension is approached from F = 0, as an experiment would."""

    main_results: ClassVar[tuple[str, ...]] = ("displacement", "force", "contact_radius")

    def run(self, context: RunContext) -> Outcome:
        """Press to the force, or pull to it from F = 0, and return the outcome.

        In time it has a warning "near_pull_off" where the contact does not sustain a tension that is larger by two
        tolerances.

        Raises:
            UntrustedError: the contact does not sustain the force; bodies pass through each other, or do not come to
                rest; or the contact reaches the end of its chain.
            EngineError: LAMMPS failed.
        """
        scene, settings = context.inputs
        load = self.given(scene).force
        surely = scene.method != "dynamic" or LoadBranch(context).holds_more(load)
        outcome = super().run(context)
        if surely:
            return outcome
        doubt = (
            f"the contact does not sustain a tensile force larger by {FIRST_RISE * settings.tolerance:g}: {-load:.6g} "
            f"FU is the pull-off force within the tolerance of {settings.tolerance:g}, and this equilibrium may be "
            "unstable. Use a smaller tolerance, or "
            'kind = "pull_off" for the pull-off force itself'
        )
        return replace(outcome, warnings={"near_pull_off": doubt, **outcome.warnings})

    def script(self, branch: Driver, scene: Scene) -> None:
        """Press to the force in a phase "loading", or pull to a tension from F = 0 in "unloading".

        The last state is marked "final".
        """
        force = self.given(scene).force
        scale = max(abs(force), branch.settings.forces.scale)
        branch.begin("loading")
        branch.reach(max(force, 0.0), scale)
        if force < 0.0:
            branch.begin("unloading")
            branch.reach(force, scale)
        branch.mark("final")

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of the last state, by name.

        "displacement" [LU] and "force" [FU], both positive in compression; where the contact has a radius above 0 also
        "contact_radius" and, with a cohesive zone, "cohesive_radius" [LU], and "mean_pressure" [FU/LU²].
        """
        force, last = self.given(scene).force, len(trace) - 1
        carried = float(trace.force[last])
        missed, is_free = abs(carried - force), force == 0.0
        results = {
            "displacement": Reading(float(trace.displacement[last]), LENGTH),
            "force": Reading(carried, FORCE, {"solver": missed}, prescribed=is_free),
        }
        if trace.radius(last):
            radius = trace.radius_or_spot(last)
            results["contact_radius"] = Reading(radius, LENGTH)
            if (reach := trace.reach(last)) is not None:
                results["cohesive_radius"] = Reading(reach, LENGTH)
            if radius > 0.0:
                area = math.pi * radius**2
                errors = {"solver": missed / area}
                results["mean_pressure"] = Reading(carried / area, MEAN_PRESSURE, errors, prescribed=is_free)
        return results

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with a check of the force, and a warning "no_radius" where the contact has no radius."""
        force = self.given(case.scene).force
        carried = float(trace.force[np.argmin(np.abs(trace.force - force))])
        checks = consistency.asked(case.scene, [(force, carried)], outcome.states)
        return outcome.adding(warnings=_missing_radius(outcome), consistency=checks)

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return one phase, "loading", of one load step in which the force is held, also if it is a tension."""
        force = self.given(scene).force
        scale = max(abs(force), settings.forces.scale)
        return (held_phase("loading", scene, settings, (force,), scale, state=True),)


class ThermalLoad(LoadExperiment):
    """d, F, a and F/(πa²) under a force and noise, as averages over samples."""

    is_statistical = True
    main_results = ("displacement", "contact_radius")

    def run(self, context: RunContext) -> Outcome:
        """Add samples, 200 at a time, until the mean displacement is certain enough, and return the outcome.

        So it is where its standard error is within the tolerance, relative to the larger one of the expected largest
        displacement and the distance of the apexes at displacement 0. After 2000 samples it ends in any case, with a
        warning "statistics" where the error is larger.

        Raises:
            UntrustedError: the bodies separate or pass through each other, the mean force misses the load, or the
                contact reaches the end of its chain.
            EngineError: LAMMPS failed.
        """
        outcome = thermal_load(context, self.given(context.deck.scene).force)
        return outcome.adding(warnings=_missing_radius(outcome))

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the phases "settling" of the run-in and "sampling" of the first 200 samples under the force."""
        return planned_samples(settings, self.given(scene).force)


def _missing_radius(outcome: Outcome) -> dict[str, str]:
    """Return a warning, {"no_radius": text}, of an outcome without a result "contact_radius"; else {}."""
    words = "the contact has no width, so there is no contact radius"
    return {} if "contact_radius" in outcome.results else {"no_radius": words}
