"""Tangential: friction on a rigid plane, F_x over the displacement u along x, the stick zone, the dissipated energy.

A load step is one step of each particle's spring and slider, which is exact while the particle stays in contact.
Between two load steps of the scene displacement and position change together, along a straight line, with a further
load step wherever a particle comes into contact or leaves it.

F_N is the normal force, compression positive, s_i the tangential force of a particle [FU]; to the right is along +x.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress, groupby, pairwise
from operator import itemgetter
from typing import cast

import numpy as np

from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.shear import slip, stick_margin, stick_radius
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.budget import budgeted, curve_errors, force_errors, of_rows
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import LATTICE, Outcome, Reading
from contact1d.workflow.continuation.planned import Plan
from contact1d.workflow.continuation.trace import Trace, of_states
from contact1d.workflow.continuation.trust import doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import particle_positions
from contact1d.workflow.deck.steps import Phase, last_steps, phase_names
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments.experiment import Scripted, finer_spacing
from contact1d.workflow.laws.friction import JenkinsElements, SlidingSprings, Stop, elements_of, stops, without_stops
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Path
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Friction, Scene, Tangential
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

PRESSING, FORWARD, BACKWARD = "pressing", "forward", "backward"


class TangentialExperiment(Scripted[Tangential]):
    """F_N, F_x, a, c and the dissipated energy Σ ∫ |s_i| dδ_i of the last load step, δ_i the slip of a particle.

    With cycles also the dissipated energy of the last one, ∮ F_x du where it is closed.
    """

    main_results = (
        "tangential_force", "contact_radius", "stick_radius", "dissipated_energy", "dissipated_energy_per_cycle",
    )  # fmt: skip

    def run(self, context: RunContext) -> Outcome:
        """Run the schedule and return the outcome, with the states that the scene asks for.

        The last one is marked "final", and "farthest" the first one of the largest |position| along x.

        Raises:
            UntrustedError: tangential forces are not those of each particle's history, or the contact reaches the end
                of its chain.
            EngineError: LAMMPS failed.
        """
        scene, settings = context.inputs
        case = self.reduction(scene, settings)
        plan = self._plan(context.deck, case.model)
        with context.contact(meanwhile=lambda: case.lattice) as contact:
            states = plan.measured(contact)
            phases = contact.phases
        asked = [is_asked for _, is_asked in load_steps(scene, _chain(scene, settings), settings)]
        trace = of_states(states, reduced(scene, settings))
        rows = slid_states(trace, scene)
        _require_history(trace, rows)
        reported, kept = list(compress(states, asked)), list(compress(rows, asked))
        errors = force_errors(scene, settings, states, (states[-1],))
        results = budgeted(case, trace, errors)
        warnings = doubts(scene, settings, tuple(reported))
        farthest = int(np.argmax([abs(row.position) for row in kept]))
        marked = {"farthest": reported[farthest], "final": reported[-1]}
        checks = plan.checks(case, states)
        loads = zip(self.given(scene).normal_forces(), (state.force for state in reported), strict=False)
        checks |= consistency.asked(scene, list(loads), states)
        points = of_rows(curve_errors(case, trace, errors.common), np.asarray(asked))
        return Outcome(
            results,
            tuple(reported),
            marked,
            phases,
            warnings,
            _columns(kept),
            points,
            moves=case.moves,
            consistency=checks,
        )

    def script(self, branch: Driver, scene: Scene) -> None:
        """Visit the displacements and positions of the scene on the reduced model, in phases of one direction along x.

        Those in between on a straight path at constant displacement, which change no later state, are left out.
        """
        model = cast("SlidingSprings", branch.model)
        steps = load_steps(scene, model.chain, branch.settings, sparse=True)
        for name, phase in groupby(zip(phases_of(steps), steps, strict=True), key=itemgetter(0)):
            branch.begin(name)
            branch.visit(*zip(*(stop for _, (stop, _) in phase), strict=True))

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """Return the results of the last state by name.

        Those near 0 have as the scale of their uncertainty the largest Σ |s_i| or its work, s_i the tangential force of
        a particle. "normal_force", compression positive, and "tangential_force" [FU],
        with which the body resists a move to the right, "contact_radius", 0 without contact, and "stick_radius" [LU],
        "dissipated_energy" [FU·LU] since the start and, with cycles, "dissipated_energy_per_cycle" of the last one. The
        round-off of tangential forces adds up along the history, by 1e-13 of the largest Σ |s_i| in each load step.
        """
        rows, round_off = slid_states(trace, scene), 1e-13
        last = rows[-1]
        strongest = max(row.carried for row in rows)
        error = round_off * len(rows) * strongest + _contact_error(scene, settings)
        lost, force = error * scene.experiment.excursion, float(trace.force[last.state])
        is_unseen = last.dissipated <= lost
        unseen = _unseen_slip(rows, scene)[0] if is_unseen else 0.0
        radius = trace.radius(last.state) or 0.0
        slid = [(trace.radius(row.state) or 0.0) - row.stick.value for row in rows]
        results = {
            "normal_force": Reading(
                force, FORCE, {"solver": round_off * abs(force)}, prescribed=scene.experiment.compression is not None
            ),
            # A force that is not 0 is its own scale.
            "tangential_force": Reading(
                last.force, FORCE, {"solver": error, LATTICE: unseen},
                scale=strongest if abs(last.force) <= error + unseen else None,
            ),
            "contact_radius": Reading(radius, LENGTH, prescribed=radius == 0.0),
            # Where all particles slip, one may stick on another lattice. An annulus that has slipped between the
            # outermost particles leaves no trace when the body moves back.
            "stick_radius": Reading(
                last.stick.value + trace.shift_of(last.state) * last.stick.uncertainty, LENGTH,
                {LATTICE: (max(slid) - slid[-1]) * is_unseen},
                prescribed=radius == 0.0, scale=radius if last.stick.value == 0.0 else None,
            ),
            "dissipated_energy": _energy(rows, lost, scene),
        }  # fmt: skip
        if self.given(scene).cycles:
            start = max(i for i, row in enumerate(rows[1:]) if row.direction < rows[i].direction)  # of the last cycle
            results["dissipated_energy_per_cycle"] = _energy(rows[start:], 4.0 * lost, scene)  # its path is 4 u_m
        return results

    def _plan(self, deck: Deck, model: Particles) -> Plan:
        """Return the plan of the load steps: the load in one step, "pressing", then a phase for each stretch along x.

        These are named "forward" or "backward", numbered where repeated; the state at the end of each is written.
        """
        steps = load_steps(deck.scene, _chain(deck.scene, deck.settings), deck.settings)
        names, (depths, along) = phases_of(steps), zip(*(stop for stop, _ in steps), strict=True)
        path = Path(np.asarray(depths), np.asarray(along), np.zeros(len(names)))
        marks = [last for name, last in last_steps(names).items() if name != PRESSING]
        return Plan(deck, model, path, names, marks)

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """Return the phases of the load steps that run: "pressing", "forward", "backward", numbered where repeated."""
        return self._plan(Deck(scene, settings), reduced(scene, settings)).phases

    def advice(self, scene: Scene) -> str:
        """Return the advice to use a smaller spacing, as a sentence without a full stop: the load steps are exact."""
        return f"Use {finer_spacing(scene)}"


@dataclass(frozen=True)
class SlidState:
    """The friction of one state.

    Attributes:
        position: position of the plate along x [LU].
        force: tangential force with which the body resists a move to the right [FU].
        carried: Σ |s_i| over the tangential forces of all particles [FU].
        dissipated: energy since the start [FU·LU].
        wrong: largest difference of a particle's force from that of its spring and slider after the state before [FU].
        trace, state: the trace and the number of the state in it.
        scene: with the coefficient of friction.
        direction: sign of the last move along x; 0 before the first one.
    """

    position: float
    force: float
    carried: float
    dissipated: float
    wrong: float
    trace: Trace
    state: int
    scene: Scene
    direction: int

    @cached_property
    def stick(self) -> ContactRadius:
        """Half-width c of the stick zone with its uncertainty and edges [LU], 0 where all particles slip; cached.

        A body with an edge, as a flat punch, sticks or slips as a whole: c is its half-width, or 0 without an
        uncertainty, also where it does not touch.
        """
        profile, coefficient = self.trace.profile(self.state), self.scene.the(Friction).coefficient
        if self.scene.bodies.own_count is None:
            return stick_radius(profile, coefficient, self.direction)
        edge = self.trace.contact(self.state)
        sticks = edge is not None and stick_margin(profile, coefficient, self.direction).any()
        return edge if sticks and edge is not None else ContactRadius(0.0, 0.0, 0.0, 0.0)


def slid_states(trace: Trace, scene: Scene) -> list[SlidState]:
    """Return the friction of each state of a trace, in order; the first one is under the normal load alone.

    The dissipated energy is added up from 0 in the first state, by the slip of each particle that follows from its
    spring and slider; `wrong` compares its force with these. The model of the trace must be one of friction.
    """
    coefficient, spacing, stiffness, _ = _springs(trace)
    rows: list[SlidState] = []
    dissipated, direction, before, limit = 0.0, 0, np.empty(0), np.empty(0)
    for i in range(len(trace)):
        profile = trace.profile(i)
        force, next_limit = -spacing * profile.shear, spacing * coefficient * np.maximum(profile.pressure, 0.0)
        wrong = 0.0
        if i:
            moved = float(trace.along[i] - trace.along[i - 1])
            direction = int(np.sign(moved)) or direction
            row = slip(before, np.full_like(force, stiffness * moved), limit, next_limit, stiffness)
            wrong = float(np.abs(force - row.force).max())
            dissipated += float(row.work.sum())
        before, limit = force, next_limit
        carried = float(np.abs(force).sum())
        position = float(trace.along[i])
        rows.append(SlidState(position, float(force.sum()), carried, dissipated, wrong, trace, i, scene, direction))
    return rows


def _springs(trace: Trace) -> tuple[float, float, float, float]:
    """Return (coefficient of friction, spacing [LU], tangential, normal stiffness of a particle [FU/LU]) of a trace."""
    law = cast("SlidingSprings", trace.model).law
    return law.coefficient, law.spacing, law.ratio * law.stiffness, law.stiffness


def _energy(rows: Sequence[SlidState], error: float, scene: Scene) -> Reading:
    """Return the energy [FU·LU] dissipated from the first state of `rows` to the last, with its errors.

    Where it is within the `error` due to the error of tangential forces [FU·LU], no particle slips. An annulus between
    the outermost particles may then slip unseen: at most its force times its slip is a further error. Where that is
    below 1e-5 of the work Σ |s_i| |Δu|, the energy counts as prescribed, with this work as the scale of its
    uncertainty; so it does of a body with an edge, which sticks or slips as a whole.
    """
    dissipated = rows[-1].dissipated - rows[0].dissipated
    if abs(dissipated) > error:
        return Reading(dissipated, ENERGY, {"solver": error})
    work = sum(0.5 * (a.carried + b.carried) * abs(b.position - a.position) for a, b in pairwise(rows))
    force, distance = _unseen_slip(rows, scene)
    most = force * distance
    known = most <= 1e-5 * work
    errors = {"solver": error, LATTICE: most}
    return Reading(dissipated, ENERGY, errors, scale=work if known else None, prescribed=known)


def _unseen_slip(rows: Sequence[SlidState], scene: Scene) -> tuple[float, float]:
    """Return (force [FU], distance [LU]) ≥ 0 at most of the slip between the outermost particles, where none slips.

    The annulus that slips is k_t u/(μ Δf) spacings wide, one at most: u is the largest |position| along x, Δf the
    difference of the normal forces of the two outermost particles on a side. The force is that share of the smaller one
    of k_t u and μ f, f the normal force of the inner one of the two, times 3 for both edges. The distance adds up, over
    all states, by how much the sliders move beyond what a rising load lets them carry, |Δu| − μ k_n Δd/k_t if above 0.
    The force is 0 of a body with an edge, and where no state has more than two particles in contact.
    """
    coefficient, spacing, stiffness, normal = _springs(rows[0].trace)
    outer = [np.sort(row.trace.profile(row.state).pressure) for row in rows]
    # Both edges are alike: the next particle is the third.
    second, first = max(((p[p > 0.0][2], p[p > 0.0][0]) for p in outer if (p > 0.0).sum() > 2), default=(0.0, 0.0))
    limit, rise = (spacing * coefficient * float(pressure) for pressure in (second, second - first))
    slipped = 0.0
    for before, after in pairwise(rows):
        deeper = after.trace.displacement[after.state] - before.trace.displacement[before.state]
        moved = abs(after.position - before.position) - coefficient * normal * deeper / stiffness
        slipped += max(0.0, float(moved)) if after.position != before.position or deeper < 0.0 else 0.0
    force = stiffness * max(abs(row.position) for row in rows)
    share = min(1.0, force / rise) if rise > 0.0 else 1.0
    return 3.0 * share * min(force, limit) * (scene.bodies.own_count is None), slipped


def _require_history(trace: Trace, rows: Sequence[SlidState], tolerance: float = 1e-8) -> None:
    """Refuse tangential forces off those of springs and sliders by more than a share of the largest friction force.

    Nothing is returned.

    Args:
        trace: of all states.
        rows: the friction of each of them.
        tolerance: share of the coefficient of friction times the largest normal force of a particle.

    Raises:
        UntrustedError: names the first such state.
    """
    coefficient, spacing = rows[0].scene.the(Friction).coefficient, rows[0].scene.bodies.spacing
    limit = max(coefficient * spacing * float(trace.profile(i).pressure.max()) for i in range(len(trace)))
    for row in rows:
        if row.wrong > tolerance * limit:
            raise UntrustedError(
                f"the tangential force of a particle differs by {row.wrong:.2g} FU from that of its spring and slider "
                f"after the previous load step, at displacement {trace.displacement[row.state]:.4g} LU and tangential "
                f"displacement {row.position:.4g} LU (phase {trace.phase[row.state]}): the contact history was lost. "
                "Use smaller load steps"
            )


def _columns(rows: Sequence[SlidState]) -> dict[str, tuple[float, ...]]:
    """Return the additional columns of curve.csv by name, (m,): lengths [LU], forces [FU], energy [FU·LU].

    "tangential_displacement", "tangential_force", "normal_force", compression positive, "stick_radius",
    "stick_radius_uncertainty" and "dissipated_energy", since the start.
    """
    return {
        "tangential_displacement": tuple(row.position for row in rows),
        "tangential_force": tuple(row.force for row in rows),
        "normal_force": tuple(float(row.trace.force[row.state]) for row in rows),
        "stick_radius": tuple(row.stick.value for row in rows),
        "stick_radius_uncertainty": tuple(row.stick.uncertainty for row in rows),
        "dissipated_energy": tuple(row.dissipated for row in rows),
    }


def _chain(scene: Scene, settings: Settings) -> JenkinsElements:
    """Return the springs and sliders of the particles of the upper chain, with the friction of the scene."""
    return elements_of(scene, particle_positions(settings.chains.upper, scene.bodies.spacing))


def load_steps(
    scene: Scene, chain: JenkinsElements, settings: Settings, sparse: bool = False
) -> list[tuple[Stop, bool]]:
    """Return ((displacement, position) [LU], whether the scene asks for it) of every load step in order.

    The first presses the bodies together, at position 0; the others that the scene does not ask for are where a
    particle comes into contact or leaves it on a path along x, evenly chosen where there are more of them between two
    stops than the inverse of the tolerance. With `sparse`, stops of the scene on a straight path at constant
    displacement are left out.
    """
    assert isinstance(scene.experiment, Tangential)
    asked = stops(scene.experiment, chain)
    first, *later = without_stops(asked) if sparse else asked
    steps, most = [(first, False)], _most_between(settings)
    before = first
    for stop in later:
        touches = chain.touches(before[0], stop[0])
        if len(touches) > most:
            touches = [touches[i] for i in np.linspace(0, len(touches) - 1, most).round().astype(int)]
        if stop[1] != before[1]:
            slope = (stop[1] - before[1]) / (stop[0] - before[0]) if touches else 0.0
            steps += [((depth, before[1] + slope * (depth - before[0])), False) for depth in touches]
        steps.append((stop, True))
        before = stop
    return steps


def phases_of(steps: Sequence[tuple[Stop, bool]]) -> list[str]:
    """Return the name of the phase of each load step: "pressing" of the first, then "forward", "backward", "forward_2".

    Load steps that do not move along x belong to the phase before, and those before the first move to the phase of that
    move.
    """
    moves = [after[1] - before[1] for (before, _), (after, _) in pairwise(steps)]
    direction = BACKWARD if next((move for move in moves if move), 1.0) < 0.0 else FORWARD
    names = [PRESSING]
    for moved in moves:
        if moved:
            direction = FORWARD if moved > 0.0 else BACKWARD
        names.append(direction)
    return phase_names(names)


def _contact_error(scene: Scene, settings: Settings) -> float:
    """Return the error [FU] ≥ 0 of tangential forces by particles that come into contact between two load steps.

    It adds up over the path. 0 where each particle that comes into contact or leaves it has a load step of its own.
    """
    assert isinstance(scene.experiment, Tangential)
    chain, most, error = _chain(scene, settings), _most_between(settings), 0.0
    for before, stop in pairwise(stops(scene.experiment, chain)):
        touches = len(chain.touches(before[0], stop[0]))
        if touches > most:
            error += 2.0 * touches * chain.tangential * abs(stop[1] - before[1]) / most
    return error


def _most_between(settings: Settings) -> int:
    """Return how many load steps lie between two of the scene at most: the inverse of the tolerance, 1 at least.

    A particle that comes into contact between two of these moves along from the first, an error of one in so many.
    """
    return max(1, round(1.0 / settings.tolerance))
