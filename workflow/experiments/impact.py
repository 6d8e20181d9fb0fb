"""Impact: a body hits the rigid plane with a velocity; its restitution, time of contact, peaks and lost energy.

v and v′ are the velocities [LU/TU] before and after it, M is the mass of the body [MU].
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from contact1d.analysis.polynomial import lowest_minimum, through, value
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import Agreement, Outcome, Reading, Result
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import Fly, Launch, Phase
from contact1d.workflow.experiments.experiment import Scripted, finer_spacing
from contact1d.workflow.experiments.history import contact_time
from contact1d.workflow.laws.path import Array, Path
from contact1d.workflow.model.free import FLIGHT, impact, stretch
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Impact, Plate, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, NUMBER


class ImpactExperiment(Scripted[Impact]):
    """e = −v′/v, the time of contact, the peaks, and ½ M (v² − v′²)."""

    main_results = ("restitution", "contact_time", "peak_force", "peak_displacement", "peak_contact_radius")
    curve_has_times = True
    branches = {"touching": "impact"}  # noqa: RUF012

    def script(self, branch: Driver, scene: Scene) -> None:
        """Let the body hit the plane and fly on until it separates or sticks; the last state is marked "final"."""
        branch.fly(self.given(scene).velocity)
        branch.mark("final")

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return restitution, energy and peaks by name.

        A body that does not separate sticks and loses all of its energy. "restitution", the velocity after over that
        before, ≥ 0, and 0 if it sticks; "dissipated_energy" [FU·LU], "peak_force" [FU], "peak_displacement" and
        "peak_contact_radius" [LU]; of a body that separates also "contact_time" [TU]. Peaks are those of polynomials
        through the states, the radius of a viscoelastic body that at the peak displacement.
        """
        velocity, mass = self.given(scene).velocity, scene.the(Plate).mass
        assert mass != "auto"
        d, time = trace.displacement, trace.time
        energy, parted = 0.5 * mass * velocity**2, not trace.force[-FLIGHT:].any()
        back = float((d[-2] - d[-1]) / (time[-1] - time[-2])) / velocity if parted else 0.0
        deepest = _peak(trace, d)
        radii = np.asarray([trace.radius(i) or 0.0 for i in range(len(trace))])
        widest = settings.law.untouched_radius(deepest) or _peak(trace, radii)
        lossless = settings.law.is_lossless
        results = {
            "restitution": Reading(back, NUMBER, scale=None if back else 1.0),
            "dissipated_energy": Reading(energy * (1.0 - back**2), ENERGY, scale=energy if lossless else None),
            "peak_force": Reading(_peak(trace, trace.force), FORCE),
            "peak_displacement": Reading(deepest, LENGTH),
            "peak_contact_radius": Reading(widest, LENGTH),
        }
        return results | ({"contact_time": contact_time(trace)} if parted else {})

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with the check of its energy, and a warning "sticks" where the body does."""
        words = "the body sticks: it comes down again without having parted, so there is no contact_time"
        warnings = {} if "contact_time" in outcome.results else {"sticks": words}
        checks = self._energy(case, outcome.states, outcome.results) if case.scene.is_modelled else {}
        return outcome.adding(warnings=warnings, consistency=checks)

    def _energy(self, case: Reduction, states: Sequence[State], results: Mapping[str, Result]) -> dict[str, Agreement]:
        """Return {"energy": `Agreement`} of the lost kinetic energy with what the contact stores and dissipates.

        Between two states the path is the cubic of their displacements and velocities, with three points in between. {}
        where the law of the reduced model has no energies.
        """
        velocity, mass = self.given(case.scene).velocity, case.scene.the(Plate).mass
        assert mass != "auto"
        from scipy.interpolate import CubicHermiteSpline

        step = case.settings.motion.time_step
        time = np.asarray([0.0, *(state.step * step for state in states)])
        moved = CubicHermiteSpline(
            time,
            [0.0, *(state.displacement for state in states)],
            [velocity, *(state.plate_velocity for state in states)],
        )
        dense = np.interp(np.arange(0.0, len(time) - 1 + 1e-9, 0.25), np.arange(len(time)), time)
        path = Path(moved(dense), np.zeros_like(dense), dense, moved(dense, 1))
        first, left = (0.5 * mass * speed**2 for speed in (velocity, states[-1].plate_velocity))
        peak = results["peak_force"]  # a body that sticks has lost all, whatever its forces
        doubt = max(results["dissipated_energy"].uncertainty / first, peak.uncertainty / peak.value)
        return consistency.energy(case, consistency.Work(path, kinetic=(first, first - left)), doubt)

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the expected phases "touching", of one load step, and "impact", as long as on the reduced model."""
        velocity = self.given(scene).velocity
        steps = stretch(settings, velocity)
        count = impact(scene, settings, reduced(scene, settings), velocity).time.size
        first = Phase("touching", (Launch(velocity, steps),))
        return first, Phase("impact", (Fly(steps),) * (count - 2), state=True)

    def advice(self, scene: Scene) -> str:
        """Return the advice to use a smaller spacing, as a sentence without a full stop."""
        return f"Use {finer_spacing(scene)}"


def _peak(trace: Trace, column: Array, near: int = 2) -> float:
    """Return the maximum of a column in its unit, by a polynomial through `near` states on both sides of the largest.

    It is at least the largest value. Only states from the first one with a force on count; where the maximum is next to
    that, the polynomial's value at time 0, the first touch, counts as well. There must be a state with a force, and at
    least 2 `near` further states after the first such one.
    """
    first = int(np.flatnonzero(trace.force)[0])
    time, column = trace.time[first:], column[first:]
    middle = min(max(int(column.argmax()), near), column.size - 1 - near)
    around = slice(middle - near, middle + near + 1)
    width = float(time[middle + near] - time[middle])
    loss = through((time[around] - time[middle]) / width, -column[around])
    top, _ = lowest_minimum(loss, -1.0, 1.0)
    ends = [-value(loss, -float(time[middle]) / width)] if middle == near else []
    return float(max(column.max(), *ends, 0.0 if np.isnan(top) else -value(loss, top)))
