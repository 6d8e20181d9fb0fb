"""Path: prescribed displacement, there and back; the curve F(d), its force maximum and its load-free radius."""

from __future__ import annotations

import math
from bisect import bisect_left
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import compress, pairwise

import numpy as np

from contact1d.analysis.curve_marks import closes, work_of
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.budget import ForceErrors, budgeted, curve_errors, force_errors, of_rows
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
from contact1d.workflow.deck.steps import Displace, DisplaceInTime, Phase, Row, displacements
from contact1d.workflow.experiments.experiment import FINER_SPACING, Scripted
from contact1d.workflow.experiments.thermal import CERTAIN, averaged, thermal_rows
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import path_of
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Path, Scene
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

Positions = Sequence[tuple[float, bool]]
"""Displacements [LU], and whether the scene asks for the state there."""
RELAXATIONS = 14.0
"""Time that a dynamic path gives the particles at each displacement, over the time constant of their slowest decay."""
ROUND_OFF = 1e-9
ANY_FORCE = 2.0
"""Difference of two forces over the larger of them that none exceeds."""
EARLINESS = 8.0
"""Square of the longest move of bodies that part over the range squared, per unit of tolerance."""


class PathExperiment(Scripted[Path]):
    """F_A, a₀ and a_cr, read off the branch that unloads last; the energy that a closed path dissipates."""

    main_results = ("adhesion_force", "zero_load_radius", "critical_radius", "largest_force", "largest_radius")
    curve_is_result = True

    def run(self, context: RunContext) -> Outcome:
        """Run the schedule."""
        scene, settings = context.deck.scene, context.deck.settings
        case, positions = self.reduction(scene, settings), way(scene, settings)
        plan = self._plan(context.deck, case.model) if scene.is_stepped else None
        with context.contact(meanwhile=lambda: case.lattice) as contact:
            states = plan.measured(contact) if plan else self.states(contact, positions)
            phases = contact.phases
        asked = np.asarray([one for _, one in positions])
        reported = tuple(compress(states, asked))
        # Where pairs snap, all rows show the jumps; else the same positions there and back show what a curve loses.
        seen = np.flatnonzero(np.logical_or.accumulate(asked) if settings.law.snaps else asked)
        ends = {"deepest": max(reported, key=lambda s: s.displacement), "final": reported[-1]}
        strongest = (ends["deepest"], min((states[i] for i in seen), key=lambda s: s.force), ends["final"])
        errors = self.force_errors(scene, settings, states, strongest)
        whole = of_states(states, case.model)
        trace, shown = whole.chosen(seen), replace(errors, common=errors.common[seen], turning=errors.turning[seen])
        repeated = self._in_half_steps(context, case.model)
        others = {name: [other.chosen(seen) for other in traces] for name, traces in repeated.items()}
        results = budgeted(case, trace, shown, sampled=not self.is_statistical, repeated=others)
        warnings = self._missing(results, case, phases) | doubts(scene, settings, reported)
        warnings |= _buckling(trace, others, settings)
        rows = of_rows(curve_errors(case, whole, errors.common, repeated), asked)
        checks = plan.checks(case, states) if plan else {}
        checks |= {} if self.is_statistical else consistency.balance(scene, states)
        return Outcome(results, reported, ends, phases, warnings, rows=rows, moves=case.moves, consistency=checks)

    def _plan(self, deck: Deck, model: Particles) -> Plan:
        """Its load steps on a rigid plane; a phase is written at its end."""
        parts = stretches([position for position, _ in way(deck.scene, deck.settings)])
        names = [name for name, stretch in parts for _ in stretch]
        ends = np.cumsum([len(stretch) for _, stretch in parts]) - 1
        return Plan(deck, model, path_of(np.concatenate([stretch for _, stretch in parts])), names, ends.tolist())

    def states(self, contact: Contact, positions: Positions) -> list[State]:
        """A state at each of the positions; in time when particles are at rest."""
        phases = self.planned(contact.scene, contact.settings)
        return contact.replay(phases, relaxed=contact.scene.method == "dynamic")

    def rows(self, scene: Scene, settings: Settings, positions: Positions) -> tuple[Row, ...]:
        """The load steps at positions."""
        if scene.method == "quasistatic":
            return displacements([position for position, _ in positions])
        steps = math.ceil(RELAXATIONS * _decay(scene, settings) / settings.motion.time_step)
        return tuple(DisplaceInTime(float(position), steps) for position, _ in positions)

    def force_errors(
        self, scene: Scene, settings: Settings, states: Sequence[State], marked: Sequence[State]
    ) -> ForceErrors:
        """Of states: residual forces of particles are independent of each other."""
        return force_errors(scene, settings, states, marked)

    def closes(self, trace: Trace, settings: Settings) -> bool:
        """Whether a path ends in its first state."""
        ends = [trace.radius(state) is None for state in (0, len(trace) - 1)]
        return ends[0] == ends[1] and closes(*trace.lists, settings.tolerance)

    def _in_half_steps(self, context: RunContext, model: Particles) -> dict[str, list[Trace]]:
        """The same states of a second run with twice as many; none where no particle can move aside.

        Chains that may buckle along x jump to another equilibrium between two load steps; to which depends on these.
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
        with context.aside(deck) as other, other.contact("repeating the path in half the steps") as contact:
            states = contact.replay(phases)[1::2]
        return {"instability": [of_states(states, model)]}

    def script(self, branch: Driver, scene: Scene) -> None:
        """The approach, which is not evaluated, and the positions of the scene; where pairs snap also those between."""
        settings, passed = branch.settings, 0
        whole = way(scene, settings)
        first = [asked for _, asked in whole].index(True)
        for name, stretch in stretches([position for position, _ in whole]):
            rows = list(enumerate(whole[passed : passed + len(stretch)], passed))
            passed += len(stretch)
            parts = {
                UNSEEN: [position for i, (position, _) in rows if i < first],
                name: [position for i, (position, asked) in rows if i >= first and (asked or settings.law.snaps)],
            }
            for phase, positions in parts.items():
                if positions:
                    branch.begin(phase)
                    branch.visit(positions)

    def _lost(self, trace: Trace, scene: Scene, settings: Settings) -> dict[str, Reading]:
        """The area of a closed path; of an open one what its instabilities lose, ∫F dd less the energy gained."""
        closed = self.closes(trace, settings)
        gained = 0.0 if closed else _gained(trace, settings)
        if gained is None or (work := work_of(*trace.lists)) is None:
            return {}
        errors = {"sampling": work.uncertainty}
        if closed:
            # Springs lose nothing, nor does a contact that is held all along, where particles neither snap nor buckle.
            may_jump = settings.law.attracts(scene) and (settings.snaps or scene.horizontal or _is_unstable(trace))
            known = not (self.is_statistical or may_jump)
            scale = work.whole if known else None
            return {"dissipated_energy": Reading(work.area, ENERGY, errors, scale=scale, prescribed=known)}
        return {"instability_energy": Reading(work.area - gained, ENERGY, errors)}

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The schedule that runs: a phase for each stretch of rising ("loading") or falling displacement."""
        if scene.is_stepped:
            return self._plan(Deck(scene, settings), reduced(scene, settings)).phases
        positions = way(scene, settings)
        phases, first = [], 0
        for name, stretch in stretches([position for position, _ in positions]):
            rows = self.rows(scene, settings, positions[first : first + len(stretch)])
            phases.append(Phase(name, rows, state=True))
            first += len(stretch)
        return tuple(phases)

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """What the last unloading has, or without adhesion the deepest state; and the energy that is lost."""
        found = _adhesion(trace, settings) if settings.law.attracts(scene) else _largest(trace)
        return found | self._lost(trace, scene, settings)

    def advice(self, scene: Scene) -> str:
        """The load steps are the scene's own."""
        return f"Use more steps in experiment.displacements; for a radius or a force in curve.csv also {FINER_SPACING}"

    def _missing(self, results: Mapping[str, Result], case: Reduction, phases: Sequence[Phase]) -> dict[str, str]:
        """Warnings of results that the path does not reach."""
        if not case.model.law.attracts(case.scene):
            return {}
        warnings: dict[str, str] = {}
        if _passes_jump(case) and not any(name.startswith(LOSSES) for name in results):
            warnings["no_energy"] = (
                "the path has too few load steps to tell what is lost at snap-in or separation, so there is neither a "
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
    """The same under noise: each state is a mean over time. Forces and radii differ at each visit."""

    is_statistical = True

    def run(self, context: RunContext) -> Outcome:
        """With the means and their standard errors."""
        found = super().run(context)
        return replace(found, tables={"means": _means(context.deck.settings, found.states)})

    def states(self, contact: Contact, positions: Positions) -> list[State]:
        """The mean at each of the positions."""
        scene, settings = contact.scene, contact.settings
        states = averaged(contact.replay(self.planned(scene, settings)), positions)
        for state in states:
            require_trust(scene, settings, state)
        return states

    def rows(self, scene: Scene, settings: Settings, positions: Positions) -> tuple[Row, ...]:
        """Equilibration and samples at each."""
        return thermal_rows(settings, _decay(scene, settings), positions)

    def force_errors(
        self, scene: Scene, settings: Settings, states: Sequence[State], marked: Sequence[State]
    ) -> ForceErrors:
        """Of means, the residual of each being its uncertainty over the number of particles."""
        found = super().force_errors(scene, settings, states, marked)
        return replace(found, turning=settings.chains.upper * np.asarray([one.residual for one in states]))

    def closes(self, trace: Trace, settings: Settings) -> bool:
        """Whether the displacement does."""
        return closes(*trace.lists, ANY_FORCE)


def _passes_jump(case: Reduction) -> bool:
    """Whether a contact that is made and lost at once is so along the path."""
    places, jumps = case.scene.experiment.places(), case.model.jumps
    return bool(jumps) and max(places) > 0.0 and (places[0] < 0.0 or min(places) < min(jumps))


def _buckling(trace: Trace, others: Mapping[str, Sequence[Trace]], settings: Settings) -> dict[str, str]:
    """A warning where forces at the same displacements differ between two widths of the load steps."""
    if not others:
        return {}
    (other,) = others["instability"]
    off = np.abs(trace.force - other.force)
    worst, largest = int(off.argmax()), float(np.abs(trace.force).max())
    if off[worst] <= settings.tolerance * largest:
        return {}
    return {
        "buckling": (
            f"at displacement {trace.displacement[worst]:.4g} LU the force is {trace.force[worst]:.4g} FU, and "
            f"{other.force[worst]:.4g} FU in half the steps: the chains buckle along x, and the state depends on the "
            "steps of the path. Leave out [horizontal], or use stiffer [neighbours]"
        )
    }


def _means(settings: Settings, states: Sequence[State]) -> dict[str, tuple[float, ...]]:
    """Columns of means.csv: the mean force at each position, and its standard error."""
    return {
        "displacement": tuple(one.displacement for one in states),
        "force": tuple(one.force for one in states),
        "force_standard_error": tuple(one.residual * settings.chains.upper / CERTAIN for one in states),
    }


def _largest(trace: Trace) -> dict[str, Reading]:
    """Without adhesion: force and radius where the displacement is largest."""
    deepest = int(np.argmax(trace.displacement))
    found = {"largest_force": Reading(float(trace.force[deepest]), FORCE)}
    if (radius := trace.radius(deepest)) is not None:
        found["largest_radius"] = Reading(radius, LENGTH)
    return found


def _adhesion(trace: Trace, settings: Settings) -> dict[str, Reading]:
    """Of the last phase of unloading; where a smooth curve has none, of the last phase.

    Where pairs snap, or an edge has no range, the tension while loading is that at which the bodies snap in.
    """
    apart = [name for name in trace.phase if name.startswith("unloading")]
    if not apart and (settings.snaps or trace.model.jumps):
        return {}
    name = apart[-1] if apart else trace.phase[-1]
    branch = trace.chosen(np.flatnonzero([phase == name for phase in trace.phase]))
    found = unloading(branch, settings)
    if branch.model.limits:
        found |= _fixed_grips(branch)
    return found


def _is_unstable(trace: Trace) -> bool:
    """Whether the contact is made or lost along the path."""
    held = [trace.radius(state) is not None for state in range(len(trace))]
    return any(before != after for before, after in pairwise(held))


def _gained(trace: Trace, settings: Settings) -> float | None:
    """Energy [FU·LU] of the last state without that of the first; None where no contact is made or lost between."""
    ends = ((float(trace.displacement[i]), trace.radius(i) or 0.0) for i in (0, len(trace) - 1))
    first, last = (settings.law.energy(*end) for end in ends)
    return None if first is None or last is None or not _is_unstable(trace) else last - first


def _fixed_grips(branch: Trace) -> dict[str, Reading]:
    """The displacement at which a contact without a range is lost at once: between the last row held and the next."""
    rows = range(len(branch))
    lost = bisect_left(rows, True, key=lambda i: branch.radius(i) is None)
    if not 0 < lost < len(branch):
        return {}
    before, beyond = branch.displacement[lost - 1 : lost + 1].tolist()
    errors = {"sampling": 0.5 * abs(before - beyond)}
    return {"fixed_grips_displacement": Reading(0.5 * (before + beyond), LENGTH, errors)}


def stretches(positions: Sequence[float]) -> list[tuple[str, list[float]]]:
    """Displacements by stretches of one direction: loading, unloading, loading_2, …; the first one is loading's."""
    found: list[tuple[str, list[float]]] = [("loading", [positions[0]])]
    for before, position in pairwise(positions):
        name = "loading" if position > before else "unloading"
        if found[-1][0] != name:
            found.append((name, []))
        found[-1][1].append(position)
    counts: dict[str, int] = {}
    numbered = []
    for name, stretch in found:
        counts[name] = counts.get(name, 0) + 1
        numbered.append((name if counts[name] == 1 else f"{name}_{counts[name]}", stretch))
    return numbered


@lru_cache(maxsize=1)
def way(scene: Scene, settings: Settings) -> list[tuple[float, bool]]:
    """Displacements [LU] of all states, and whether the scene asks for them or they are intermediate.

    Where pairs snap, a path begins before the first of them joins. With `start = "contact"` it then goes to the largest
    displacement before the first one.
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
    found = [(before, False)] if before not in (0.0, goals[0][0]) else []
    for value, one in goals:
        longest = settings.increments.longest_move if value > before else _longest_drop(settings)
        moves = max(1, math.ceil(abs(value - before) / longest - ROUND_OFF))
        found += [(before + (value - before) * i / moves, False) for i in range(1, moves)]
        found.append((value, one))
        before = value
    return found


def _longest_drop(settings: Settings) -> float:
    """Longest move [LU] of separating bodies without premature detachment of particles; inf where
    none snaps.

    A move h puts a joined pair h further apart before it relaxes. It is lost where that is beyond the unstable
    equilibrium next to it, which is 2 √(2 e/|G″|) away at a gap e before the fold of G(r): too early by e = h² |G″|/8.
    With |G″| of the ratio of the stiffnesses over the range b, and a loop as wide as some of that ratio times b,
    h = √(8 tolerance) b leaves a share of `tolerance` of the loop.
    """
    if not settings.snaps:
        return math.inf
    return min(settings.increments.longest_move, math.sqrt(EARLINESS * settings.tolerance) * settings.forces.range)


def _decay(scene: Scene, settings: Settings) -> float:
    """Relaxation time [TU] of a particle on its bulk spring: 2m/γ, overdamped γ/k."""
    mass, stiffness = scene.bodies.mass, scene.bulk_stiffness
    return max(2.0 * mass / settings.motion.damping, settings.motion.damping / stiffness)
