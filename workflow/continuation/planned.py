"""Contacts on a rigid plane: a script drives the reduced model, and LAMMPS goes through its load steps in one request.

The model of such a contact has every particle of the deck, with the same numbers, so that its limit points and forces
are known beforehand; each load step is compared with it (`consistency.plan`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile, zoned
from contact1d.workflow.continuation import consistency
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import ContactBranch, RunContext
from contact1d.workflow.continuation.model_branch import ModelBranch
from contact1d.workflow.continuation.outcome import Agreement
from contact1d.workflow.continuation.reduction import Reduction
from contact1d.workflow.continuation.state import State
from contact1d.workflow.continuation.trust import DigitsError, TensionError, require_trust
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Phase, numbered, swept
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, History, Path
from contact1d.workflow.scene import Bodies

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Plan:
    """Load steps on a rigid plane.

    Attributes:
        deck: of the scene.
        model: of its particles.
        path: displacements, positions along x and times of all load steps.
        names: of their phases, (m,); a phase is numbered where its name comes again.
        marks: numbers of load steps whose states are written: a phase ends there.
    """

    deck: Deck
    model: Particles
    path: Path
    names: Sequence[str]
    marks: Collection[int]

    @classmethod
    def of(cls, deck: Deck, branch: ModelBranch) -> Plan:
        """What a script has done on the model."""
        return cls(deck, branch.model, branch.path, branch.phases, branch.marks)

    @cached_property
    def _columns(self) -> dict[str, Array]:
        return self.deck.as_read(self.model.prescribed(self.path))

    @cached_property
    def phases(self) -> tuple[Phase, ...]:
        """The schedule."""
        rows, found = swept(self._columns), list[Phase]()
        begins = [0, *(i for i, (one, other) in enumerate(pairwise(self.names), 1) if one != other)]
        ends = sorted({*begins, *(mark + 1 for mark in self.marks), len(rows)})
        for first, last in pairwise(ends):
            name = numbered(self.names[first], [one.name for one in found]) if first in begins else found[-1].name
            found.append(Phase(name, tuple(rows[first:last]), state=last - 1 in self.marks))
        return tuple(found)

    @cached_property
    def followed(self) -> Followed:
        """What the model carries in these load steps, with their numbers as LAMMPS reads them."""
        return self.model.carried(self._columns)

    def checks(self, case: Reduction, states: Sequence[State], doubt: float = 0.0) -> dict[str, Agreement]:
        """Whether its states contradict the model, and their energies each other; see `consistency`."""
        if not self.deck.scene.is_modelled:
            return {}
        forces = self.followed.total
        found = consistency.plan(self.deck.scene, states, forces)
        return found | consistency.energy(case, consistency.Work(self.path, forces), doubt)

    def measured(self, contact: Contact) -> list[State]:
        """The states that LAMMPS has, with the edges that the law of the contact tells.

        Raises:
            UntrustedError: see `require_trust`.
        """
        states = contact.replay(self.phases, meanwhile=lambda: self.followed)
        followed, bodies, spring = self.followed, contact.scene.bodies, contact.scene.bulk_stiffness
        if followed.zone:
            zones = zip(*(one.tolist() for one in followed.zone), strict=True)
            lost = np.broadcast_to(followed.round_off, followed.total.shape).tolist()
            states = [
                replace(one, profile=_zoned(bodies, spring, one, *zone), residual=one.residual + more)
                for one, zone, more in zip(states, zones, lost, strict=True)
            ]
        if self.path.time.any():
            states = [replace(one, time=time) for one, time in zip(states, self.path.time.tolist(), strict=True)]
        for state in states:
            require_trust(contact.scene, contact.settings, state)
        return states


def _zoned(bodies: Bodies, spring: float, state: State, edge: float, reach: float, *others: float) -> Profile:
    """The profile of a state with its edges [LU]; between them the body is drawn towards the plane."""
    own = state.profile
    if reach > edge:
        heights = bodies.height(own.x) - state.displacement
        surface = np.maximum(heights + own.pressure * bodies.spacing / spring, 0.0)
        own = replace(own, z_upper=np.where(np.abs(own.x) < edge, 0.0, surface))
    return zoned(own, edge, reach, *others)


class PlannedBranch(ContactBranch):
    """States on a rigid plane; LAMMPS runs when the script has ended.

    Attributes:
        plan: what it has run then.
    """

    plan: Plan

    def __init__(self, context: RunContext, meanwhile: Callable[[], object] | None = None) -> None:
        """Prepare a contact."""
        super().__init__(context, meanwhile)
        self._driven = ModelBranch(self.scene, self.settings, self.model, 1, 0.0)
        self._largest: float | None = None

    def begin(self, name: str) -> None:
        """See `Driver`."""
        self._driven.begin(name)

    def visit(self, positions: Sequence[float] | Array, along: Sequence[float] | None = None) -> None:
        """See `Driver`."""
        self._driven.visit(positions, along)

    def reach(self, force: float, scale: float) -> None:
        """See `Driver`.

        Raises:
            TensionError: no contact holds the force.
        """
        self._driven.reach(force, scale)
        if force < 0.0 and self._driven.held > (1.0 - self.settings.tolerance) * force:
            raise TensionError(force, self.scale)
        self.wanted[self._driven.last] = force

    def maximum(self) -> None:
        """See `Driver`."""
        self._driven.maximum()
        self._largest = max(self._largest or 0.0, -self._driven.held)

    def open(self) -> None:
        """See `Driver`."""
        self._driven.open()

    def follow(self, history: History) -> None:
        """See `Driver`; load steps of forces are where the model carries them."""
        self._driven.follow(history)
        self.given = "force" if history.by_force else self.given

    def mark(self, name: str) -> None:
        """See `Driver`."""
        self._driven.mark(name)

    def checks(self, case: Reduction, doubt: float) -> dict[str, Agreement]:
        """See `ContactBranch.checks`, and the plan's."""
        return super().checks(case, doubt) | self.plan.checks(case, self.states, doubt)

    def finish(self) -> None:
        """Run all load steps.

        Raises:
            DigitsError: a force maximum is below the round-off error of positions.
        """
        self.plan = Plan.of(self.contact.deck, self._driven)
        self.states, self.legs = self.plan.measured(self.contact), self._driven.legs
        self.marked = {name: self.states[at] for at, names in self._driven.marks.items() for name in names}
        self._require_digits()

    def _require_digits(self) -> None:
        digits = self.states[-1].residual * self.settings.chains.upper
        if self._largest is not None and self._largest <= digits:
            raise DigitsError(
                f"the force maximum, about {self.scale:.2g} FU, is too small compared with {digits:.2g} FU, the "
                "round-off error of the contact force",
                "use a larger adhesion.work_of_adhesion, or a smaller preload",
            )
