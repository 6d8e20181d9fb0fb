"""Load: equilibrium under a normal force."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import ClassVar

import numpy as np

from contact1d.workflow.continuation.budget import MARGIN
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.holding import held_phase, stiffness_under
from contact1d.workflow.continuation.load_control import FIRST_RISE, LoadBranch
from contact1d.workflow.continuation.marks import BRANCH_DISTANCE, displacement_under, radius_rate
from contact1d.workflow.continuation.outcome import Outcome, Reading
from contact1d.workflow.continuation.stepped import LOADING_STEPS, curve_steps
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import Phase, displacements
from contact1d.workflow.experiments.experiment import Scripted
from contact1d.workflow.experiments.thermal import planned_samples, thermal_load
from contact1d.workflow.model.cohesive import CohesiveEstimate
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Load, Scene
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE


class LoadExperiment(Scripted[Load]):
    """d, F, a and F/(πa²) under a force. A tension is approached from F = 0, as an experiment would."""

    main_results: ClassVar[tuple[str, ...]] = ("displacement", "force", "contact_radius")

    def run(self, context: RunContext) -> Outcome:
        """In time with a warning where a tension is only just held, or not."""
        scene, settings = context.deck.scene, context.deck.settings
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
        """Press to the force, or pull to it from F = 0."""
        force = self.given(scene).force
        scale = max(abs(force), branch.settings.forces.scale)
        branch.begin("loading")
        branch.reach(max(force, 0.0), scale)
        if force < 0.0:
            branch.begin("unloading")
            branch.reach(force, scale)
        branch.mark("final")

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Results at the last state."""
        force, last = self.given(scene).force, len(trace) - 1
        own, stiffness = float(trace.displacement[last]), stiffness_under(settings, force)
        displacement = displacement_under(trace, last, trace.own_force(last), stiffness)
        missed = abs(displacement_under(trace, last, force, stiffness) - displacement)
        if is_exact := trace.reach(last) is not None:  # nothing else errs, and this is of first order
            missed *= MARGIN
        carried = float(trace.force[last])
        found = {
            "displacement": Reading(displacement, LENGTH, {"solver": missed}),
            "force": Reading(carried, FORCE, {"solver": abs(carried - force)}, prescribed=force == 0.0),
        }
        if trace.radius(last):
            rate = radius_rate(trace, last, BRANCH_DISTANCE) or settings.estimate.radius_rate(own)
            radius = trace.radius_or_spot(last) + rate * (displacement - own)
            found["contact_radius"] = Reading(radius, LENGTH, {"solver": abs(rate) * missed})
            if (reach := trace.reach(last)) is not None and isinstance(settings.estimate, CohesiveEstimate):
                places = np.asarray([own, displacement, displacement - missed, displacement + missed])
                here, there, *ends = settings.estimate.reaches(places).tolist()
                error = abs(there - here) + max(abs(end - there) for end in ends)
                found["cohesive_radius"] = Reading(reach + there - here, LENGTH, {"solver": error})
            if radius > 0.0:
                area = math.pi * radius**2
                off = abs(carried - force) + is_exact * 2.0 * abs(carried * rate) * missed / radius
                errors = {"solver": off / area}
                found["mean_pressure"] = Reading(carried / area, MEAN_PRESSURE, errors, prescribed=force == 0.0)
        return found

    def asked(self, trace: Trace, scene: Scene) -> Sequence[tuple[float, float]]:
        """The load."""
        return [(self.given(scene).force, float(trace.force[-1]))]

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The schedule by the model."""
        force = self.given(scene).force
        if scene.method == "dynamic":
            scale = max(abs(force), settings.forces.scale)
            return (held_phase("loading", scene, settings, (force,), scale, state=True),)
        steps = curve_steps(settings) if scene.is_stepped else LOADING_STEPS
        rows = displacements(np.linspace(0.0, settings.largest_displacement, steps + 1).tolist())
        return (Phase("loading", rows, state=True),)

    def finish(self, outcome: Outcome, scene: Scene, settings: Settings) -> Outcome:
        """A warning where nothing touches."""
        if "contact_radius" in outcome.results:
            return outcome
        missing = {"no_radius": "the contact has no width, so there is no contact radius"}
        return replace(outcome, warnings={**outcome.warnings, **missing})


class ThermalLoad(LoadExperiment):
    """The same under noise, as averages over samples."""

    is_statistical = True
    main_results = ("displacement", "contact_radius")

    def run(self, context: RunContext) -> Outcome:
        """Sample until the mean displacement is known."""
        scene = context.deck.scene
        return self.finish(thermal_load(context, self.given(scene).force), scene, context.deck.settings)

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The run-in and the first samples."""
        return planned_samples(settings, self.given(scene).force)
