"""Path: prescribed displacement, there and back; the curve F(d), its force maximum and its load-free radius.

F_A is the force maximum, a tension, a_cr the contact radius there, and a₀ that at F = 0. Displacements [LU] and forces
[FU] are positive in compression. Pairs of opposite particles that join or separate by an instability snap.
"""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import compress, groupby, pairwise
from operator import itemgetter

import numpy as np

from contact1d.analysis.curve_marks import closes, work_of
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.budget import budgeted, curve_errors, force_errors, of_rows
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.marks import unloading
from contact1d.workflow.continuation.model_branch import UNSEEN
from contact1d.workflow.continuation.outcome import LOSSES, Outcome, Reading, Result
from contact1d.workflow.continuation.planned import Plan
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trace import Trace, of_states
from contact1d.workflow.continuation.trust import doubts, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, DisplaceInTime, Phase, Row, displacements, last_steps, phase_names
from contact1d.workflow.experiments.experiment import Scripted, finer_spacing
from contact1d.workflow.experiments.thermal import CERTAIN, averaged, thermal_rows
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import path_of
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Path, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

Positions = Sequence[tuple[float, bool]]
"""Displacements [LU], and whether the scene asks for the state there."""


class PathExperiment(Scripted[Path]):
    """F_A, a₀ and a_cr of the last unloading; the energy that a closed path dissipates."""

    main_results = ("adhesion_force", "zero_load_radius", "critical_radius", "largest_force", "largest_radius")
    curve_is_result = True

    def run(self, context: RunContext) -> Outcome:
        """Run the schedule, and return the states that the scene asks for and the results with their error budget.

        The states "deepest", that of the largest displacement, and "final" are marked. Where pairs snap, results also
        use the intermediate states after the first one that the scene asks for. In a quasi-static scene whose
        particles may move along x the path is run again in half the steps; warnings are about missing results and
        buckling.

        Raises:
            UntrustedError: bodies pass through each other, particles are not at rest, or the contact reaches the end of
                its chain.
            EngineError: LAMMPS failed.
        """
        scene, settings = context.inputs
        case, positions = self.reduction(scene, settings), positions_of(scene, settings)
        plan = self._plan(context.deck, case.model) if scene.is_stepped else None
        with context.contact(meanwhile=lambda: case.lattice) as contact:
            states = plan.measured(contact) if plan else self.states(contact, positions)
            phases = contact.phases
        asked = np.asarray([is_asked for _, is_asked in positions])
        reported = tuple(compress(states, asked))
        # Where pairs snap, all load steps show the jumps; else equal positions there and back show the energy loss.
        seen = np.flatnonzero(np.logical_or.accumulate(asked) if settings.law.snaps else asked)
        ends = {"deepest": max(reported, key=lambda state: state.displacement), "final": reported[-1]}
        most_tensile = min((states[i] for i in seen), key=lambda state: state.force)
        strongest = (ends["deepest"], most_tensile, ends["final"])
        errors = force_errors(scene, settings, states, strongest)
        whole = of_states(states, case.model)
        trace, shown = whole.chosen(seen), replace(errors, common=errors.common[seen], turning=errors.turning[seen])
        repeated = self._in_half_steps(context, case.model)
        repeats = {source: [repeat.chosen(seen) for repeat in traces] for source, traces in repeated.items()}
        results = budgeted(case, trace, shown, sampled=not self.is_statistical, repeated=repeats)
        warnings = self._missing_results(results, case, phases) | doubts(scene, settings, reported)
        warnings |= _buckling(trace, repeats, settings)
        rows = of_rows(curve_errors(case, whole, errors.common, repeated), asked)
        checks = plan.checks(case, states) if plan else {}
        checks |= {} if self.is_statistical else consistency.balance(scene, states)
        return Outcome(results, reported, ends, phases, warnings, rows=rows, moves=case.moves, consistency=checks)

    def _plan(self, deck: Deck, model: Particles) -> Plan:
        """Return the plan of the load steps on a rigid plane, a phase for each part of rising or falling displacement.

        The state at the end of each phase is written.
        """
        positions = positions_of(deck.scene, deck.settings)
        names, path = phases_of(positions), path_of(np.asarray([position for position, _ in positions]))
        return Plan(deck, model, path, names, last_steps(names).values())

    def states(self, contact: Contact, positions: Positions) -> list[State]:
        """Run the path in LAMMPS and return a state for each of the positions, in order.

        In time each is that in which the particles are at rest.

        Raises:
            EngineError: LAMMPS failed.
            UntrustedError: in a state bodies pass through each other, particles are not at rest, or the contact reaches
                the end of its chain.
        """
        phases = self.planned(contact.scene, contact.settings)
        return contact.replay(phases, relaxed=contact.scene.method == "dynamic")

    def rows(self, scene: Scene, settings: Settings, positions: Positions) -> tuple[Row, ...]:
        """Return the load steps at positions, one for each: `Displace`, in time `DisplaceInTime`.

        In time each lasts 14 times the relaxation time of a particle, rounded up to timesteps.
        """
        if scene.method == "quasistatic":
            return displacements([position for position, _ in positions])
        steps = math.ceil(14.0 * _relaxation_time(scene, settings) / settings.motion.time_step)
        return tuple(DisplaceInTime(float(position), steps) for position, _ in positions)

    def closes(self, trace: Trace, settings: Settings) -> bool:
        """Return whether a path ends in its first state: at the same displacement and force, both in contact or apart.

        Displacements may differ by round-off, forces by the tolerance of the larger one.
        """
        ends = [trace.radius(state) is None for state in (0, len(trace) - 1)]
        return ends[0] == ends[1] and closes(*trace.lists, settings.tolerance)

    def _in_half_steps(self, context: RunContext, model: Particles) -> dict[str, list[Trace]]:
        """Return {"instability": [trace of a second run of the path in half the steps]}.

        The trace has the states at the displacements of the first run alone. {} without [horizontal], and in time.
        Chains that may buckle along x jump to another equilibrium between two load steps, and the equilibrium depends
        on the steps.
        """
        scene, deck = context.deck.scene, context.deck
        if not scene.horizontal or scene.method != "quasistatic":
            return {}
        phases, before = [], 0.0
        for phase in self.planned(scene, deck.settings):
            rows = []
            for row in phase.rows:
                assert isinstance(row, Displace)
                rows += [Displace(0.5 * (before + row.displacement)), row]
                before = row.displacement
            phases.append(replace(phase, rows=tuple(rows)))
        with context.aside(deck) as repeat, repeat.contact("repeating the path in half the steps") as contact:
            states = contact.replay(phases)[1::2]
        return {"instability": [of_states(states, model)]}

    def script(self, branch: Driver, scene: Scene) -> None:
        """Visit the unevaluated approach, in a phase without a name, and the positions of the scene.

        Their phases are "loading" and "unloading". Where pairs snap, the positions in between are visited as well.
        """
        positions = positions_of(scene, branch.settings)
        first, snaps = [asked for _, asked in positions].index(True), branch.settings.law.snaps
        visited = [
            (UNSEEN if i < first else name, name, position)
            for i, (name, (position, asked)) in enumerate(zip(phases_of(positions), positions, strict=True))
            if i < first or asked or snaps
        ]
        for (phase, _), steps in groupby(visited, key=itemgetter(0, 1)):
            branch.begin(phase)
            branch.visit([position for _, _, position in steps])

    def _losses(self, trace: Trace, scene: Scene, settings: Settings) -> dict[str, Reading]:
        """Return the energy that a path dissipates [FU·LU], by name; {} with fewer than 3 states, or without a motion.

        "dissipated_energy", ∫F dd, of a closed path; of an open one "instability_energy", that of its instabilities, ∫F
        dd − ΔE. The latter is left out where no contact forms or separates, or the law has no energy E.
        """
        closed = self.closes(trace, settings)
        gained = 0.0 if closed else _energy_change(trace, settings)
        if gained is None or (work := work_of(*trace.lists)) is None:
            return {}
        errors = {"sampling": work.uncertainty}
        if closed:
            # Springs dissipate nothing, nor does a contact that never separates, if particles neither snap nor buckle.
            may_jump = settings.law.attracts(scene) and (settings.snaps or scene.horizontal or _is_unstable(trace))
            known = not (self.is_statistical or may_jump)
            scale = work.whole if known else None
            return {"dissipated_energy": Reading(work.area, ENERGY, errors, scale=scale, prescribed=known)}
        return {"instability_energy": Reading(work.area - gained, ENERGY, errors)}

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the schedule that runs: a phase for each part of rising or falling displacement.

        They are "loading" and "unloading", the latter also where the displacement stays, and the first one is "loading"
        in any case. Repeated names have a number, "loading_2". The state at the end of each phase is written.
        """
        if scene.is_stepped:
            return self._plan(Deck(scene, settings), reduced(scene, settings)).phases
        positions = positions_of(scene, settings)
        steps = groupby(zip(phases_of(positions), positions, strict=True), key=itemgetter(0))
        return tuple(
            Phase(name, self.rows(scene, settings, [position for _, position in phase]), state=True)
            for name, phase in steps
        )

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of the last unloading, or without attraction of the deepest state, and the lost energy.

        With attraction "adhesion_force" [FU], a positive tension, "critical_radius", "zero_load_radius",
        "cohesive_radius", "fixed_grips_displacement" [LU] and "work_of_separation" [FU·LU]; without it "largest_force"
        [FU], compression positive, and "largest_radius" [LU]. In either case "dissipated_energy" of a closed path, or
        "instability_energy" [FU·LU]. Those that the path does not reach are left out.
        """
        marks = _adhesion(trace, settings) if settings.law.attracts(scene) else _deepest(trace)
        return marks | self._losses(trace, scene, settings)

    def advice(self, scene: Scene) -> str:
        """Return the advice to use more displacements, or a smaller spacing, as a sentence without a full stop."""
        finer = finer_spacing(scene)
        return f"Use more steps in experiment.displacements; for a radius or a force in curve.csv also {finer}"

    def _missing_results(
        self, results: Mapping[str, Result], case: Reduction, phases: Sequence[Phase]
    ) -> dict[str, str]:
        """Return warnings of missing results by name; {} without attraction, or where the path reaches all of them.

        "no_energy": a path with a snap-in or a separation has too few load steps for the energy that is lost there;
        "no_peak": no force maximum within the last unloading; "no_zero_load": the force does not cross 0 in it. Both of
        the latter where the path never unloads and has neither.
        """
        if not case.model.law.attracts(case.scene):
            return {}
        warnings: dict[str, str] = {}
        if _passes_jump(case) and not any(name.startswith(LOSSES) for name in results):
            warnings["no_energy"] = (
                "the path has too few load steps for the energy lost at snap-in or separation, so there is neither a "
                "dissipated_energy nor an instability_energy: use more steps in experiment.displacements"
            )
        marks = {"adhesion_force", "zero_load_radius"}
        if not any(phase.name.startswith("unloading") for phase in phases) and not marks & results.keys():
            never = "the path never unloads the contact, so it gives no"
            warnings |= {"no_peak": f"{never} adhesion_force", "no_zero_load": f"{never} zero_load_radius"}
            return warnings
        if "adhesion_force" not in results:
            warnings["no_peak"] = (
                "the tensile force is largest at an end of the last unloading, so the path gives no adhesion_force: "
                'extend the unloading, or use kind = "pull_off"'
            )
        if "zero_load_radius" not in results:
            warnings["no_zero_load"] = (
                "the force does not cross 0 before separation in the last unloading, so there is no zero_load_radius"
            )
        return warnings


class ThermalPath(PathExperiment):
    """A path under noise: each state is a mean over time. Forces and radii differ at each visit."""

    is_statistical = True

    def run(self, context: RunContext) -> Outcome:
        """Run the path and return its outcome, with a table "means" of the mean forces [FU] and their standard errors.

        Raises:
            UntrustedError: in a mean state bodies pass through each other, or the contact reaches the end of its chain.
            EngineError: LAMMPS failed.
        """
        outcome = super().run(context)
        return replace(outcome, tables={"means": _means(context.deck.settings, outcome.states)})

    def states(self, contact: Contact, positions: Positions) -> list[State]:
        """Run the path in LAMMPS and return the mean state at each of the positions that the scene asks for.

        At an intermediate position it is the last state there.

        Raises:
            UntrustedError: in a mean state bodies pass through each other, or the contact reaches the end of its chain.
            EngineError: LAMMPS failed.
        """
        scene, settings = contact.scene, contact.settings
        states = averaged(contact.replay(self.planned(scene, settings)), positions)
        for state in states:
            require_trust(scene, settings, state)
        return states

    def rows(self, scene: Scene, settings: Settings, positions: Positions) -> tuple[Row, ...]:
        """Return the load steps at each position: 40 of equilibration, and 200 samples where the scene asks for it."""
        return thermal_rows(settings, _relaxation_time(scene, settings), positions)

    def closes(self, trace: Trace, settings: Settings) -> bool:
        """Return whether a path ends at its first displacement, within round-off, whatever the forces.

        Two forces differ by twice the larger at most, which is the tolerance here.
        """
        return closes(*trace.lists, 2.0)


def _passes_jump(case: Reduction) -> bool:
    """Return whether the path goes to d > 0 and also passes a displacement at which the force jumps.

    That is a snap-in, where it begins below 0, or a separation at a finite force, where it goes below the lowest jump.
    False where the law has no jump.
    """
    positions, jumps = case.scene.experiment.places(), case.model.jumps
    return bool(jumps) and max(positions) > 0.0 and (positions[0] < 0.0 or min(positions) < min(jumps))


def _buckling(trace: Trace, repeats: Mapping[str, Sequence[Trace]], settings: Settings) -> dict[str, str]:
    """Return {"buckling": warning} where forces of a trace differ from those of its repetition in half steps, else {}.

    They differ by more than the tolerance of the largest |force|. `repeats`: traces by the source of error; may be
    empty.
    """
    if not repeats:
        return {}
    (halved,) = repeats["instability"]
    off = np.abs(trace.force - halved.force)
    worst, largest = int(off.argmax()), float(np.abs(trace.force).max())
    if off[worst] <= settings.tolerance * largest:
        return {}
    return {
        "buckling": (
            f"at displacement {trace.displacement[worst]:.4g} LU the force is {trace.force[worst]:.4g} FU, and "
            f"{halved.force[worst]:.4g} FU in half the steps: the chains buckle along x, and the state depends on the "
            "steps of the path. Leave out [horizontal], or use stiffer [neighbours]"
        )
    }


def _means(settings: Settings, states: Sequence[State]) -> dict[str, tuple[float, ...]]:
    """Return the columns of means.csv by name, (m,): "displacement" [LU], "force" and "force_standard_error" [FU].

    Forces are means, compression positive.
    """
    return {
        "displacement": tuple(state.displacement for state in states),
        "force": tuple(state.force for state in states),
        "force_standard_error": tuple(state.residual * settings.chains.upper / CERTAIN for state in states),
    }


def _deepest(trace: Trace) -> dict[str, Reading]:
    """Return "largest_force", the force at the largest displacement [FU], and there "largest_radius" [LU] by name.

    The first of several such states counts. The radius is left out where the bodies do not touch.
    """
    deepest = int(np.argmax(trace.displacement))
    results = {"largest_force": Reading(float(trace.force[deepest]), FORCE)}
    if (radius := trace.radius(deepest)) is not None:
        results["largest_radius"] = Reading(radius, LENGTH)
    return results


def _adhesion(trace: Trace, settings: Settings) -> dict[str, Reading]:
    """Return the results of the last phase of unloading, by name; without one, those of the last phase of the trace.

    As far as the phase has them: "adhesion_force" [FU], a positive tension, "critical_radius", "zero_load_radius",
    "cohesive_radius" [LU], "work_of_separation" [FU·LU] and, of a law with a limit point under displacement control,
    "fixed_grips_displacement" [LU]. {} without unloading where pairs snap, or the force of a contact jumps: the tension
    during loading is that of the snap-in.
    """
    unloadings = [name for name in trace.phase if name.startswith("unloading")]
    if not unloadings and (settings.snaps or trace.model.jumps):
        return {}
    name = unloadings[-1] if unloadings else trace.phase[-1]
    branch = trace.chosen(np.flatnonzero([phase == name for phase in trace.phase]))
    marks = unloading(branch, settings)
    if branch.model.limits:
        marks |= _fixed_grips(branch)
    return marks


def _is_unstable(trace: Trace) -> bool:
    """Return whether the contact forms or separates along the path: of two successive states one has a radius.

    The other one has none. False where all states are in contact, or none is.
    """
    held = [trace.radius(state) is not None for state in range(len(trace))]
    return any(before != after for before, after in pairwise(held))


def _energy_change(trace: Trace, settings: Settings) -> float | None:
    """Return the energy [FU·LU] of the contact in the last state less that in the first.

    None where no contact forms or separates along the path, or the law has no energy.
    """
    ends = ((float(trace.displacement[i]), trace.radius(i) or 0.0) for i in (0, len(trace) - 1))
    first, last = (settings.law.energy(*end) for end in ends)
    return None if first is None or last is None or not _is_unstable(trace) else last - first


def _fixed_grips(branch: Trace) -> dict[str, Reading]:
    """Return "fixed_grips_displacement" [LU], where the contact is lost under displacement control.

    It is midway between the last state in contact and the next, uncertain by half of their distance. {} where the
    branch begins apart or ends in contact.
    """
    rows = range(len(branch))
    lost = bisect_left(rows, True, key=lambda i: branch.radius(i) is None)
    if not 0 < lost < len(branch):
        return {}
    before, beyond = branch.displacement[lost - 1 : lost + 1].tolist()
    errors = {"sampling": 0.5 * abs(before - beyond)}
    return {"fixed_grips_displacement": Reading(0.5 * (before + beyond), LENGTH, errors)}


def phases_of(positions: Positions) -> list[str]:
    """Return the name of the phase of each position: "loading", "unloading", "loading_2", … for each direction in turn.

    The first is "loading", if only with the first position. A position equal to the one before counts as unloading.
    """
    rises = (after > before for (before, _), (after, _) in pairwise(positions))
    return phase_names(["loading", *("loading" if rise else "unloading" for rise in rises)])


@lru_cache(maxsize=1)
def positions_of(scene: Scene, settings: Settings) -> list[tuple[float, bool]]:
    """Return a list of (displacement [LU], whether the scene asks for it) of all states in order.

    It is cached, and must not be changed. The others are intermediate, no farther apart than the settings allow. The
    path begins at 0, which is not in the list, or at its first displacement where that is below 0; where pairs snap the
    list begins with a displacement before the first snap-in. With `start = "contact"` it then goes to the largest
    displacement, not asked for there, before the first one of the scene.
    """
    experiment, estimate, before = scene.experiment, settings.law, 0.0
    assert isinstance(experiment, Path)
    asked = experiment.places()
    if settings.snaps:
        before = min(0.0, estimate.rest - estimate.joins - settings.increments.longest_move)
    goals = [(value, True) for value in asked]
    if experiment.start == "contact":
        goals.insert(0, (max(asked), False))
    before = min(before, goals[0][0])
    positions = [(before, False)] if before not in (0.0, goals[0][0]) else []
    for goal, is_asked in goals:
        longest = settings.increments.longest_move if goal > before else _longest_unloading(settings)
        moves = max(1, math.ceil(abs(goal - before) / longest - 1e-9))  # round-off adds no move
        positions += [(before + (goal - before) * i / moves, False) for i in range(1, moves)]
        positions.append((goal, is_asked))
        before = goal
    return positions


def _longest_unloading(settings: Settings) -> float:
    """Return the longest move [LU] of separating bodies without premature detachment of particles; inf if none snaps.

    It is at most the longest move in loading. A move h puts a joined pair h further apart before it relaxes. The pair
    detaches where that is beyond the unstable equilibrium next to it, which is 2 √(2 e/|G″|) away at a gap e before the
    fold of G(r): too early by e = h² |G″|/8. With |G″| about the ratio of the stiffnesses over the range b, and a
    hysteresis about as wide as that ratio times b, h = √(8 tolerance) b leaves an error of a share of `tolerance` of
    the hysteresis.
    """
    if not settings.snaps:
        return math.inf
    return min(settings.increments.longest_move, math.sqrt(8.0 * settings.tolerance) * settings.forces.range)


def _relaxation_time(scene: Scene, settings: Settings) -> float:
    """Return the relaxation time [TU] of a particle on its bulk spring, the longer of 2m/γ and, overdamped, γ/k.

    Raises:
        ZeroDivisionError: the particle has no drag γ.
    """
    mass, stiffness = scene.bodies.mass, scene.bulk_stiffness
    return max(2.0 * mass / settings.motion.damping, settings.motion.damping / stiffness)
