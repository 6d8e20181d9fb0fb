"""Impact: a body that hits the rigid plane with a velocity; its restitution, time of contact, peaks and lost energy.

v and v′ are the velocities [LU/TU] before and after it, M is the mass of the body [MU]. In an oblique impact the
contact point moves along x with v_s = v_t − l ω, l its distance from the centre of mass, I the moment of inertia:

    M v_t′ = −F_t,    I ω′ = l F_t,    v_s′ = −F_t (1 + M l²/I)/M

(K. L. Johnson, Contact Mechanics, 1985, section 11.4), without coupling of normal and tangential displacements.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from contact1d.analysis.polynomial import lowest_minimum, through, value
from contact1d.analysis.shear import stick_radius
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.contact import SLIP_VELOCITY
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import Agreement, Outcome, Reading, Result
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace
from contact1d.workflow.deck.steps import Fly, Phase, launch
from contact1d.workflow.experiments.experiment import Scripted, finer_spacing
from contact1d.workflow.experiments.history import contact_time
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.laws.path import Array, Path
from contact1d.workflow.model.free import FLIGHT, impact, stretch
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Friction, Impact, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, NUMBER, SPIN, TIME, VELOCITY


class ImpactExperiment(Scripted[Impact]):
    """e = −v′/v, the time of contact, the peaks, and ½ M (v² − v′²)."""

    main_results = ("restitution", "contact_time", "peak_force", "peak_displacement", "peak_contact_radius",
                    "tangential_restitution", "impulse_ratio")  # fmt: skip
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
        velocity, mass = self.given(scene).velocity, scene.impact_mass
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
        results |= {"contact_time": contact_time(trace)} if parted else {}
        if scene.viscoelasticity and scene.viscoelasticity.restitution:
            lag = scene.relaxation.retardation_time or 0.0
            doubt = ROUND_OFF * lag / (1.0 - scene.viscoelasticity.restitution)  # of a time as small as that
            results["retardation_time"] = Reading(lag, TIME, {"solver": doubt}, prescribed=True)
        return results | (_along(trace, scene, results["dissipated_energy"]) if scene.is_oblique else {})

    def finish(self, outcome: Outcome, case: Reduction, trace: Trace) -> Outcome:
        """Return the outcome with the check of its energy, and a warning "sticks" where the body does."""
        words = "the body sticks: it comes down again without having parted, so there is no contact_time"
        warnings = {} if "contact_time" in outcome.results else {"sticks": words}
        path = self._path(case, outcome.states)
        checks = self._energy(case, path, outcome.states, outcome.results) if case.scene.is_modelled else {}
        columns = _columns(case, outcome.states, path) if case.scene.is_oblique else {}
        return outcome.adding(warnings=warnings, consistency=checks, columns=columns)

    def _path(self, case: Reduction, states: Sequence[State], dense: int = 4) -> Path:
        """Return the cubics of displacements and velocities of the states, in `dense` steps from one to the next.

        It begins at the first touch, one state before the first one.
        """
        from scipy.interpolate import CubicHermiteSpline

        velocity, slip, step = self.given(case.scene).velocity, case.scene.slip_velocity, case.settings.motion.time_step
        rows = [(0.0, 0.0, velocity, 0.0, slip)]
        for state in states:
            speeds = state.plate_velocity, state.motion.get(SLIP_VELOCITY, 0.0)
            rows.append((state.step * step, state.displacement, speeds[0], state.plate_x, speeds[1]))
        time, d, v, x, s = np.asarray(rows).T
        moved, drawn = CubicHermiteSpline(time, d, v), CubicHermiteSpline(time, x, s)
        moments = np.interp(np.linspace(0.0, len(states), 1 + dense * len(states)), np.arange(len(time)), time)
        return Path(moved(moments), drawn(moments), moments, moved(moments, 1))

    def _energy(
        self, case: Reduction, path: Path, states: Sequence[State], results: Mapping[str, Result]
    ) -> dict[str, Agreement]:
        """Return {"energy": `Agreement`} of the lost kinetic energy with what the contact stores and dissipates.

        {} where the law of the reduced model has no energies. `path`: of the states.
        """
        scene, last = case.scene, states[-1]
        first = _kinetic(scene, self.given(scene).velocity, scene.slip_velocity)
        left = _kinetic(scene, last.plate_velocity, last.motion.get(SLIP_VELOCITY, 0.0))
        peak = results["peak_force"]  # a body that sticks has lost all, whatever its forces
        doubt = max(results["dissipated_energy"].uncertainty / first, peak.uncertainty / peak.value)
        return consistency.energy(case, consistency.Work(path, kinetic=(first, first - left)), doubt)

    def expected(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the expected phases "touching", of one load step, and "impact", as long as on the reduced model."""
        velocity = self.given(scene).velocity
        steps = stretch(settings, velocity)
        count = impact(scene, settings, reduced(scene, settings), velocity).time.size
        first = Phase("touching", (launch(scene, velocity, steps),))
        return first, Phase("impact", (Fly(steps),) * (count - 2), state=True)

    def advice(self, scene: Scene) -> str:
        """Return the advice to use a smaller spacing, as a sentence without a full stop."""
        return f"Use {finer_spacing(scene)}"


def _kinetic(scene: Scene, velocity: float, slip: float) -> float:
    """Return the kinetic energy [FU·LU] of a normal velocity and that of the contact point along x [LU/TU].

    It is ½ (M v² + M v_s²/(1 + M l²/I)), without the part of translation and spin that friction does not change.
    """
    return 0.5 * (scene.impact_mass * velocity**2 + scene.slip_mass * slip**2)


def _columns(case: Reduction, states: Sequence[State], path: Path) -> dict[str, tuple[float, ...]]:
    """Return further columns of curve.csv of an oblique impact by name, (m,), an element for each state.

    "contact_point_x" [LU], "slip_velocity" [LU/TU], "tangential_force" [FU] that resists a motion along +x,
    "stick_radius" [LU], 0 where all particles slip; "kinetic_energy" (without the part that friction does not change),
    "normal_energy" and "tangential_energy" of the springs, "slip_energy" so far [FU·LU].

    Args:
        case: the experiment on the reduced model, with friction.
        states: of the run.
        path: of these, with further states between.
    """
    scene, spacing, dense = case.scene, case.scene.bodies.spacing, path.time.size // len(states)
    booked = [column[dense::dense].tolist() for column in case.model.booked(path) or ()]
    slips = [state.motion[SLIP_VELOCITY] for state in states]
    rows = zip((state.plate_velocity for state in states), slips, strict=True)
    coefficient = scene.the(Friction).coefficient
    columns = {
        "contact_point_x": [state.plate_x for state in states],
        "slip_velocity": slips,
        "tangential_force": [-spacing * float(state.profile.shear.sum()) for state in states],
        "stick_radius": [stick_radius(state.profile, coefficient, 0).value for state in states],
        "kinetic_energy": [_kinetic(scene, *row) for row in rows],
        **dict(zip(("normal_energy", "tangential_energy", "slip_energy"), booked, strict=True)),
    }
    return {name: tuple(column) for name, column in columns.items()}


def _along(trace: Trace, scene: Scene, normal: Reading) -> dict[str, Reading]:
    """Return the results along x of an oblique impact by name.

    "tangential_restitution" −v_s′/v_s, left out where v_s = 0, "rebound_tangential_velocity" [LU/TU], "rebound_spin"
    [1/TU], "impulse_ratio" J_t/J_n, and "dissipated_energy" [FU·LU], the loss of kinetic energy in all, equal to
    "slip_energy", since nothing but slip dissipates; the work of slip of all particles checks it.

    Args:
        trace: with free flight at its end.
        scene: of the impact.
        normal: the loss of normal kinetic energy [FU·LU].
    """
    given, slip, mass, lighter = scene.experiment, scene.slip_velocity, scene.impact_mass, scene.slip_mass
    assert isinstance(given, Impact)
    step, back, last = (float(column[-1] - column[-2]) for column in (trace.time, trace.displacement, trace.along))
    back, last = -back / step, last / step
    digits = 2.0 * sys.float_info.epsilon * len(trace)  # of a difference of two positions
    drawn, speed = lighter * (slip - last), abs(slip) or given.velocity
    size = 0.5 * (lighter * slip**2 + mass * given.velocity**2)
    lost = replace(normal, value=normal.value + 0.5 * lighter * (slip**2 - last**2), scale=size)
    results = {
        "dissipated_energy": lost,
        "slip_energy": lost,
        "impulse_ratio": Reading(drawn / (mass * (given.velocity + back)), NUMBER, {"solver": digits}, scale=1.0),
        "rebound_tangential_velocity": Reading(
            (given.tangential_velocity or 0.0) - drawn / mass, VELOCITY, {"solver": digits * speed}, scale=speed
        ),
        "rebound_spin": Reading(
            (given.spin or 0.0) + scene.spin_ratio * drawn / (mass * scene.lever_arm), SPIN,
            {"solver": digits * speed / scene.lever_arm}, speed / scene.lever_arm,
        ),
    }  # fmt: skip
    return results | ({"tangential_restitution": Reading(-last / slip, NUMBER, scale=1.0)} if slip else {})


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
