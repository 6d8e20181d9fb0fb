"""Hold: a displacement or a force, held for a time while the particles and the plate move.

d [LU] and F [FU] are positive in compression, a is the contact radius [LU].
"""

from __future__ import annotations

from collections.abc import Mapping

from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import Reading
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import DisplaceInTime, Phase, Row, UnderLoad
from contact1d.workflow.experiments.experiment import Scripted
from contact1d.workflow.experiments.history import contact_at_end, relaxation
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Hold, Scene
from contact1d.workflow.units import FORCE, LENGTH


class HoldExperiment(Scripted[Hold]):
    """d, F, a and F/(πa²) at the end, and the change of the free variable since the beginning."""

    main_results = ("displacement", "force", "contact_radius")
    curve_has_times = True

    def script(self, branch: Driver, scene: Scene) -> None:
        """Hold the prescribed displacement or force for its duration, in a phase "holding"; mark the end "final"."""
        held = self.given(scene)
        branch.begin("holding")
        branch.hold(held.duration, held.displacement, held.force)
        branch.mark("final")

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of the last state, and the change of the free variable since the first one, by name.

        "displacement" [LU], "force" [FU], compression positive, and "relaxation" ≥ 0, the change of the displacement
        [LU] under a prescribed force, or of the force [FU] at a prescribed displacement; with a contact radius above 0
        also "contact_radius" [LU] and "mean_pressure" [FU/LU²].
        """
        trace, by_force = trace.phases("holding"), self.given(scene).force is not None
        return {
            "displacement": Reading(float(trace.displacement[-1]), LENGTH, prescribed=not by_force),
            "force": Reading(float(trace.force[-1]), FORCE),
            "relaxation": relaxation(trace, 0, by_force),
            **contact_at_end(trace),
        }

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return one phase, "holding", of the load steps that run.

        They are `UnderLoad` under a prescribed force, else `DisplaceInTime`; the state after the last one is written.
        An approach to F = 0 before a tension is left out.
        """
        held = self.given(scene)
        rows: list[Row] = []
        for steps in settings.steps_of(held.duration):
            if held.force is not None:
                rows.append(UnderLoad(held.force, steps))
            elif held.displacement is not None:
                rows.append(DisplaceInTime(held.displacement, steps))
        return (Phase("holding", tuple(rows), state=True),)
