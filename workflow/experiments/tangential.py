"""Tangential: friction on a rigid plane, F_x over the displacement u along x, the zone that sticks, what is lost.

A row is one step of each particle's spring and slider, which is exact while a particle is touched all the way.
Between two rows of the scene displacement and position change together, along a straight line; where a particle
begins or ends to touch there is a row of its own.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress, pairwise
from typing import cast

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.shear import slip, stick_margin, stick_radius
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.budget import budgeted, curve_errors, force_errors, of_rows
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.driver import Driver
from contact1d.workflow.continuation.outcome import LATTICE, Outcome, Reading
from contact1d.workflow.continuation.planned import Plan
from contact1d.workflow.continuation.trace import Trace, of_states
from contact1d.workflow.continuation.trust import UntrustedError, doubts
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import places
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.experiment import FINER_SPACING, Scripted
from contact1d.workflow.laws.friction import JenkinsElements, SlidingSprings, Stop, elements_of, stops, without_stops
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Path
from contact1d.workflow.model.reduced import reduced
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Friction, Scene, Tangential
from contact1d.workflow.units import ENERGY, FORCE, LENGTH

Array = NDArray[np.float64]
PRESSING, FORWARD, BACKWARD = "pressing", "forward", "backward"
MOST_TOUCHES = 1.0
"""Rows between two of the scene, per 1/tolerance; a particle between two of them is moved from the first."""
ROUND_OFF = 1e-13
"""Error of tangential forces over the largest of a path, for each row: a history is a sum over all of them."""
STUCK, NOTHING = 3.0, 1e-5
"""Spacings that may slip at both edges together where no particle does, and a loss over all work that is none."""
AS_PREDICTED = 1e-8
"""How far a particle's tangential force may be from what spring and slider make of the row before, over its limit."""


class TangentialExperiment(Scripted[Tangential]):
    """F_N, F_x, a, c and the dissipated energy Σ ∫ |s_i| dδ_i of the last row; a particle has slipped by δ_i.

    Of cycles also what the last one dissipates, ∮ F_x du where it is closed.
    """

    main_results = (
        "tangential_force", "contact_radius", "stick_radius", "dissipated_energy", "dissipated_energy_per_cycle",
    )  # fmt: skip

    def run(self, context: RunContext) -> Outcome:
        """Run the schedule; the forces must be those of the history of each particle."""
        scene, settings = context.deck.scene, context.deck.settings
        case = self.reduction(scene, settings)
        plan = self._plan(context.deck, case.model)
        with context.contact(meanwhile=lambda: case.lattice) as contact:
            states = plan.measured(contact)
            phases = contact.phases
        asked = [one for _, one in passed(scene, _chain(scene, settings), settings)]
        trace = of_states(states, reduced(scene, settings))
        rows = drawn(trace, scene)
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
        """The stops of the model's particles, those that change nothing left out."""
        model = cast("SlidingSprings", branch.model)
        for name, stretch in stretches(passed(scene, model.chain, branch.settings, sparse=True)):
            branch.begin(name)
            branch.visit(*zip(*(stop for stop, _ in stretch), strict=True))

    def read(self, trace: Trace, scene: Scene, settings: Settings) -> Mapping[str, Reading]:
        """What the last row has; forces are compared with Σ |s_i|, the energy with the work of that."""
        rows = drawn(trace, scene)
        last = rows[-1]
        strongest = max(row.carried for row in rows)
        error = ROUND_OFF * len(rows) * strongest + _moved_too_far(scene, settings)
        lost, force = error * scene.experiment.way, float(trace.force[last.state])
        is_unseen = last.dissipated <= lost
        unseen = _unseen_slip(rows, scene)[0] if is_unseen else 0.0
        radius = trace.radius(last.state) or 0.0
        slid = [(trace.radius(row.state) or 0.0) - row.stick.value for row in rows]
        found = {
            "normal_force": Reading(
                force, FORCE, {"solver": ROUND_OFF * abs(force)}, prescribed=scene.experiment.compression is not None
            ),
            # One that is not 0 is compared with itself.
            "tangential_force": Reading(
                last.force, FORCE, {"solver": error, LATTICE: unseen},
                scale=strongest if abs(last.force) <= error + unseen else None,
            ),
            "contact_radius": Reading(radius, LENGTH, prescribed=radius == 0.0),
            # Of a contact that slips as far as its particles show, another lattice may have one that sticks. An annulus
            # that has slipped between the outermost particles leaves no trace when the body goes back.
            "stick_radius": Reading(
                last.stick.value + trace.shift_of(last.state) * last.stick.uncertainty, LENGTH,
                {LATTICE: (max(slid) - slid[-1]) * is_unseen},
                prescribed=radius == 0.0, scale=radius if last.stick.value == 0.0 else None,
            ),
            "dissipated_energy": _energy(rows, lost, scene),
        }  # fmt: skip
        if self.given(scene).cycles:
            start = max(i for i, row in enumerate(rows[1:]) if row.direction < rows[i].direction)  # of the last cycle
            found["dissipated_energy_per_cycle"] = _energy(rows[start:], 4.0 * lost, scene)  # its path is 4 u_m
        return found

    def _plan(self, deck: Deck, model: Particles) -> Plan:
        """The load comes on in one row, then a phase for each stretch to the right ("forward") or to the left."""
        parts = stretches(passed(deck.scene, _chain(deck.scene, deck.settings), deck.settings))
        names = [name for name, stretch in parts for _ in stretch]
        ends = np.cumsum([len(stretch) for _, stretch in parts]) - 1
        depths, along = zip(*(stop for _, stretch in parts for stop, _ in stretch), strict=True)
        path = Path(np.asarray(depths), np.asarray(along), np.zeros(len(names)))
        marks = [end for (name, _), end in zip(parts, ends.tolist(), strict=True) if name != PRESSING]
        return Plan(deck, model, path, names, marks)

    def planned(self, scene: Scene, settings: Settings) -> tuple[Phase, ...]:
        """The load steps that run."""
        return self._plan(Deck(scene, settings), reduced(scene, settings)).phases

    def advice(self, scene: Scene) -> str:
        """A row is exact, so that the lattice alone is left."""
        return f"Use {FINER_SPACING}"


@dataclass(frozen=True)
class Drawn:
    """What friction made of one state.

    Attributes:
        position: of the plate along x [LU].
        force: with which the body resists a move to the right [FU].
        carried: Σ |s_i|, of all particles whichever way they push [FU].
        dissipated: energy since the start [FU·LU].
        wrong: how far a particle's force is from what its spring and slider make of the row before [FU].
        trace, state: where it was read.
        scene: with the coefficient of friction.
        direction: of the last move.
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
        """Half-width of the zone that sticks; a flat punch sticks or slips as a whole."""
        profile, coefficient = self.trace.profile(self.state), self.scene.the(Friction).coefficient
        if self.scene.bodies.own_count is None:
            return stick_radius(profile, coefficient, self.direction)
        edge = self.trace.contact(self.state)
        sticks = edge is not None and stick_margin(profile, coefficient, self.direction).any()
        return edge if sticks and edge is not None else ContactRadius(0.0, 0.0, 0.0, 0.0, reaches_end=False)


def drawn(trace: Trace, scene: Scene) -> list[Drawn]:
    """What friction made of each state, from the one before it; at the first the load is just there."""
    coefficient, spacing, stiffness, _ = _springs(trace)
    rows: list[Drawn] = []
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
        rows.append(Drawn(position, float(force.sum()), carried, dissipated, wrong, trace, i, scene, direction))
    return rows


def _springs(trace: Trace) -> tuple[float, float, float, float]:
    """μ, the spacing [LU], and the tangential and normal stiffness of a particle [FU/LU] of the chain of a trace."""
    law = cast("SlidingSprings", trace.model).law
    return law.coefficient, law.spacing, law.ratio * law.stiffness, law.stiffness


def _energy(rows: Sequence[Drawn], lost: float, scene: Scene) -> Reading:
    """What is dissipated from the first of the rows to the last; `lost`: error of tangential forces [FU·LU].

    Where no particle slips, less is lost than `_unseen_slip`; that is 0 of a body with an edge, which sticks or slips
    as a whole.
    """
    dissipated = rows[-1].dissipated - rows[0].dissipated
    if abs(dissipated) > lost:
        return Reading(dissipated, ENERGY, {"solver": lost})
    work = sum(0.5 * (a.carried + b.carried) * abs(b.position - a.position) for a, b in pairwise(rows))
    force, way = _unseen_slip(rows, scene)
    most = force * way
    known = most <= NOTHING * work
    return Reading(dissipated, ENERGY, {"solver": lost, LATTICE: most}, scale=work if known else None, prescribed=known)


def _unseen_slip(rows: Sequence[Drawn], scene: Scene) -> tuple[float, float]:
    """Force [FU] and distance [LU] of the slip between the outermost particles, at most, where none of these slips.

    The annulus that slips is as wide as k_t u/(μ Δf) spacings, with Δf the difference of the normal forces of the two
    outermost particles, and one at most; its forces are below k_t u and μ f, and it slips by as much as the sliders
    are moved beyond what a rising load lets them carry, k_t |Δu| − μ k_n Δd. A body with an edge has none.
    """
    coefficient, spacing, stiffness, normal = _springs(rows[0].trace)
    outer = [np.sort(row.trace.profile(row.state).pressure) for row in rows]
    # Both edges are alike: the next particle is the third.
    second, first = max(((p[p > 0.0][2], p[p > 0.0][0]) for p in outer if (p > 0.0).sum() > 2), default=(0.0, 0.0))
    limit, rise = (spacing * coefficient * float(one) for one in (second, second - first))
    slipped = 0.0
    for before, after in pairwise(rows):
        deeper = after.trace.displacement[after.state] - before.trace.displacement[before.state]
        moved = abs(after.position - before.position) - coefficient * normal * deeper / stiffness
        slipped += max(0.0, float(moved)) if after.position != before.position or deeper < 0.0 else 0.0
    force = stiffness * max(abs(row.position) for row in rows)
    share = min(1.0, force / rise) if rise > 0.0 else 1.0
    return STUCK * share * min(force, limit) * (scene.bodies.own_count is None), slipped


def _require_history(trace: Trace, rows: Sequence[Drawn]) -> None:
    """Refuse forces that are not the history's."""
    coefficient, spacing = rows[0].scene.the(Friction).coefficient, rows[0].scene.bodies.spacing
    limit = max(coefficient * spacing * float(trace.profile(i).pressure.max()) for i in range(len(trace)))
    for row in rows:
        if row.wrong > AS_PREDICTED * limit:
            raise UntrustedError(
                f"the tangential force of a particle differs by {row.wrong:.2g} FU from that of its spring and slider "
                f"after the previous load step, at displacement {trace.displacement[row.state]:.4g} LU and tangential "
                f"displacement {row.position:.4g} LU (phase {trace.phase[row.state]}): the contact history was lost. "
                "Use smaller load steps"
            )


def _columns(rows: Sequence[Drawn]) -> dict[str, tuple[float, ...]]:
    """What curve.csv has beside the columns of every curve."""
    return {
        "tangential_displacement": tuple(row.position for row in rows),
        "tangential_force": tuple(row.force for row in rows),
        "normal_force": tuple(float(row.trace.force[row.state]) for row in rows),
        "stick_radius": tuple(row.stick.value for row in rows),
        "stick_radius_uncertainty": tuple(row.stick.uncertainty for row in rows),
        "dissipated_energy": tuple(row.dissipated for row in rows),
    }


def _chain(scene: Scene, settings: Settings) -> JenkinsElements:
    """The sliders of the chain that runs."""
    return elements_of(scene, places(settings.chains.upper, scene.bodies.spacing))


def passed(scene: Scene, chain: JenkinsElements, settings: Settings, sparse: bool = False) -> list[tuple[Stop, bool]]:
    """Displacement and position [LU] of every row in order, and whether the scene asks for it.

    `sparse`: without those from which it goes straight on.
    """
    assert isinstance(scene.experiment, Tangential)
    asked = stops(scene.experiment, chain)
    first, *others = without_stops(asked) if sparse else asked
    found, most = [(first, False)], _most(settings)
    before = first
    for stop in others:
        touches = chain.touches(before[0], stop[0])
        if len(touches) > most:
            touches = [touches[i] for i in np.linspace(0, len(touches) - 1, most).round().astype(int)]
        if stop[1] != before[1]:
            slope = (stop[1] - before[1]) / (stop[0] - before[0]) if touches else 0.0
            found += [((depth, before[1] + slope * (depth - before[0])), False) for depth in touches]
        found.append((stop, True))
        before = stop
    return found


def stretches(way: Sequence[tuple[Stop, bool]]) -> list[tuple[str, list[tuple[Stop, bool]]]]:
    """Rows by stretches of one direction, the load first."""
    moves = [after[1] - before[1] for (before, _), (after, _) in pairwise(way)]
    direction = BACKWARD if next((move for move in moves if move), 1.0) < 0.0 else FORWARD
    found = [(PRESSING, [way[0]])]
    counts: dict[str, int] = {}
    for row, moved in zip(way[1:], moves, strict=True):
        if moved:
            direction = FORWARD if moved > 0.0 else BACKWARD
        if found[-1][0].partition("_")[0] != direction:
            counts[direction] = counts.get(direction, 0) + 1
            found.append((direction if counts[direction] == 1 else f"{direction}_{counts[direction]}", []))
        found[-1][1].append(row)
    return found


def _moved_too_far(scene: Scene, settings: Settings) -> float:
    """By how much [FU] tangential forces may be off: of particles that begin to touch between two load steps."""
    assert isinstance(scene.experiment, Tangential)
    chain, most, error = _chain(scene, settings), _most(settings), 0.0
    for before, stop in pairwise(stops(scene.experiment, chain)):
        touches = len(chain.touches(before[0], stop[0]))
        if touches > most:
            error += 2.0 * touches * chain.tangential * abs(stop[1] - before[1]) / most
    return error


def _most(settings: Settings) -> int:
    return max(1, round(MOST_TOUCHES / settings.tolerance))
