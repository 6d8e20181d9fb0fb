"""Contacts on a rigid plane: a script drives the reduced model, and LAMMPS goes through its load steps in one request.

The model of such a contact has every particle of the deck, with the same numbers, so that its limit points and forces
are known beforehand; the force of each load step is compared with that of the model (`consistency.plan`).

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contact1d.analysis.pressure import Array, Profile, ZonedProfile
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import ContactBranch
from contact1d.workflow.continuation.model_branch import ModelBranch
from contact1d.workflow.continuation.outcome import Agreement
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase, last_steps, phase_names, swept
from contact1d.workflow.errors import TensionError, UntrustedError
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.scene import Bodies


@dataclass(frozen=True, eq=False)
class Plan:
    """The planned load steps of a contact on a rigid plane.

    Attributes:
        deck: of the scene.
        model: the particles of the reduced model.
        path: displacements, positions along x and times of all load steps.
        names: of their phases, (m,); a phase is numbered where its name is repeated.
        marks: numbers of load steps at the end of a phase whose states are written.
    """

    deck: Deck
    model: Particles
    path: Path
    names: Sequence[str]
    marks: Collection[int]

    @classmethod
    def of(cls, deck: Deck, branch: ModelBranch) -> Plan:
        """Return the plan of all load steps of a branch of the reduced model, with its marked states."""
        return cls(deck, branch.model, branch.path, branch.phases, branch.marks)

    @cached_property
    def _columns(self) -> dict[str, Array]:
        """The numbers that LAMMPS reads for each load step, (m,), by name, to the 15 digits of its input; cached.

        "displacement" [LU]; by the contact law also "place" along x [LU]; contact radius "edge", outer radius of the
        attraction "reach" and "height" [LU]; or "duration" [TU] and final "velocity" [LU/TU].
        """
        return self.deck.as_read(self.model.prescribed(self.path))

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """The load steps as named phases, in order, numbered where a name is repeated ("loading_2"); cached.

        The state of a phase's last load step is written where that is marked.
        """
        rows, phases, first = swept(self._columns), list[Phase](), 0
        for name, last in last_steps(phase_names(self.names)).items():
            phases.append(Phase(name, tuple(rows[first : last + 1]), state=last in self.marks))
            first = last + 1
        return tuple(phases)

    @cached_property
    def followed(self) -> Followed:
        """The forces of the reduced model in the load steps, with the numbers that LAMMPS reads; cached."""
        return self.model.carried(self._columns)

    def checks(self, case: Reduction, states: Sequence[State], doubt: float = 0.0) -> dict[str, Agreement]:
        """Return {"plan": …, "energy": …}: the agreement of forces with the model, and of its work with its energies.

        {} where the model lacks an effect of the scene; "plan" alone where the contact law has no expression for its
        energies. `case`: the
        experiment on the reduced model; `states`: of all load steps; `doubt`: the relative uncertainty of the energy
        that the run reports.
        """
        if not self.deck.scene.is_modelled:
            return {}
        forces = self.followed.total
        checks = consistency.plan(self.deck.scene, states, forces)
        return checks | consistency.energy(case, consistency.Work(self.path, forces), doubt)

    def measured(self, contact: Contact) -> list[State]:
        """Run all load steps in LAMMPS and return a state for each, in order.

        Where the contact law computes contact edges, these and the round-off errors that it adds to residuals are put
        in; times [TU] are those of the path, 0 of equilibria.

        Raises:
            EngineError: LAMMPS failed.
            UntrustedError: a state is no result, as where forces are too small for the digits of positions.
        """
        states = contact.replay(self.phases, meanwhile=lambda: self.followed)
        followed, bodies, spring = self.followed, contact.scene.bodies, contact.scene.bulk_stiffness
        if followed.zone:
            zones = zip(*(column.tolist() for column in followed.zone), strict=True)
            round_off = np.broadcast_to(followed.round_off, followed.total.shape).tolist()
            states = [
                replace(state, profile=_zoned(bodies, spring, state, zone), residual=state.residual + error)
                for state, zone, error in zip(states, zones, round_off, strict=True)
            ]
        if self.path.time.any():
            states = [replace(state, time=time) for state, time in zip(states, self.path.time.tolist(), strict=True)]
        for state in states:
            require_trust(contact.scene, contact.settings, state)
        return states


def _zoned(bodies: Bodies, spring: float, state: State, zone: Sequence[float]) -> Profile:
    """Return the profile of a state with the zone of its contact edge.

    Where the attraction reaches beyond the edge, upper surfaces inside it are on the plane, others at the height of the
    body on its springs, but not below the plane; else they stay.

    Args:
        bodies: whose profile it is.
        spring: stiffness of a particle [FU/LU].
        state: read off LAMMPS, which knows no edge.
        zone: contact radius, outer radius of the attraction [LU], jump of the line load at the edge [FU/LU] and, where
            the law has them, uncertainty of the edge [LU] and rise of the line load inside it [FU/LU].
    """
    (edge, reach, *_), profile = zone, state.profile
    if reach > edge:
        heights = bodies.height(profile.x) - state.displacement
        surface = np.maximum(heights + profile.pressure * bodies.spacing / spring, 0.0)
        profile = replace(profile, z_upper=np.where(np.abs(profile.x) < edge, 0.0, surface))
    return ZonedProfile(*vars(profile).values(), *zone)


class PlannedBranch(ContactBranch):
    """The states of a contact on a rigid plane.

    LAMMPS runs when the script has ended (`finish`), and then there are states.

    Attributes:
        plan: the load steps that LAMMPS has run.
    """

    plan: Plan

    @cached_property
    def driver(self) -> ModelBranch:
        """The reduced model, on which a script plans the load steps."""
        return ModelBranch(self.scene, self.settings, self.model, 1, 0.0)

    def checks(self, case: Reduction, doubt: float) -> dict[str, Agreement]:
        """Return the checks of the states by name: "balance", "plan" and "energy".

        They compare the contact force with the sum on the plate, where LAMMPS has it; with the reduced model, unless
        this lacks an effect of the scene; and then also work with energy, where the contact law has one. `case`: the
        experiment on the reduced model; `doubt`: the relative uncertainty of the energy that the run reports.

        Raises:
            AttributeError: before `finish`.
        """
        return super().checks(case, doubt) | self.plan.checks(case, self.states, doubt)

    def finish(self) -> None:
        """Run all planned load steps in LAMMPS, and only then set `plan`, `states` and all that belongs to them.

        Raises:
            TensionError: a tension exceeds the force maximum of the model by more than the relative tolerance.
            EngineError: LAMMPS failed.
            UntrustedError: a state is no result; a force maximum is below the round-off error of positions.
        """
        driven = self.driver
        for state, force in driven.wanted.items():
            if force < 0.0 and driven.held(state) > (1.0 - self.settings.tolerance) * force:
                raise TensionError(force, self.scale)
        self.plan, self.given, self.wanted = Plan.of(self.contact.deck, driven), driven.given, driven.wanted
        self.states, self.legs = self.plan.measured(self.contact), driven.legs
        self.marked = {name: self.states[i] for i, names in driven.marks.items() for name in names}
        digits = self.states[-1].residual * self.settings.chains.upper
        tensions = [-self.driver.held(state) for state in self.driver.peaks]
        if tensions and max(tensions) <= digits:
            raise UntrustedError(
                f"the force maximum, about {self.scale:.2g} FU, is too small compared with {digits:.2g} FU, the "
                "round-off error of the contact force",
                "use a larger adhesion.work_of_adhesion, or a smaller preload",
            )
