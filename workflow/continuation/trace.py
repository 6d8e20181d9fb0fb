"""The trace from which results are read: displacements, forces and radii along a path, measured or of the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.continuation.state import RadiusRule, State
from contact1d.workflow.model.reduced import Followed

Array = NDArray[np.float64]
BESIDE = 2
"""Particles beside a contact that carry nothing: a radius is read between the last that carries and the next."""


@dataclass(frozen=True)
class Trace:
    """States in order; arrays (m,).

    Attributes:
        phase: name of each state's phase.
        displacement, force: [LU], [FU].
        asked: whether the scene asks for the state; the others are on the path there.
        along: position along x [LU].
        profile: pressure and shear of a state, by its number.
        contact: radius of a state as it is read off its profile; None where the bodies do not touch.
        rule: what a contact radius is.
        shift: by how much forces were changed from those of the states, (m,) [FU]; 0 where they are these.
        radius_shift: by how many of its own uncertainties each radius is taken too large, (m,); 0 as it is read.
        radius_factor: by which radii are taken larger.
        limit: displacement [LU] below which no contact is held; −inf where none is known.
        doubt: by source, error of the search for the force maximum [FU].
        bracket: under load control, the force maximum that was held and the smallest that was not [FU].
    """

    phase: tuple[str, ...]
    displacement: Array
    force: Array
    asked: NDArray[np.bool_]
    along: Array
    profile: Callable[[int], Profile] = field(repr=False)
    contact: Callable[[int], ContactRadius | None] = field(repr=False)
    rule: RadiusRule = field(repr=False)
    shift: Array | float = 0.0
    radius_shift: Array | float = 0.0
    radius_factor: float = 1.0
    limit: float = -np.inf
    doubt: Mapping[str, float] = field(default_factory=dict)
    bracket: tuple[float, float] | None = None

    def __len__(self) -> int:
        """How many states."""
        return len(self.displacement)

    @property
    def lists(self) -> tuple[list[float], list[float]]:
        """Displacements and forces, as arguments of the functions that read a curve."""
        return self.displacement.tolist(), self.force.tolist()

    def radius(self, state: int) -> float | None:
        """Contact radius [LU]; None where the bodies do not touch."""
        found = self.contact(state)
        return None if found is None else self._perturbed(found, state)

    def radius_or_spot(self, state: int) -> float:
        """The same; 0 where no particle is in tension."""
        found = self.contact(state) or self.rule.or_spot(self.profile(state))
        return self._perturbed(found, state)

    def _perturbed(self, found: ContactRadius, state: int) -> float:
        if found.uncertainty == 0.0:  # a body that ends at an edge
            return found.value
        return max(0.0, self.radius_factor * (found.value + self.shift_of(state) * found.uncertainty))

    def phases(self, *names: str) -> Trace:
        """The states of these phases, "unloading_2" being one of "unloading"."""
        return self.chosen(np.flatnonzero([name.partition("_")[0] in names for name in self.phase]))

    def shift_of(self, state: int) -> float:
        """By how many of its uncertainties the radius of a state is taken too large."""
        return float(np.broadcast_to(self.radius_shift, self.force.shape)[state])

    def own_force(self, state: int) -> float:
        """Force of an unperturbed state [FU]."""
        return float((self.force - self.shift)[state])

    def falling(self) -> Trace:
        """The states that are held, by falling displacement, each once, the last that was measured there."""
        _, last = np.unique(self.displacement[::-1], return_index=True)
        falling = (len(self) - 1 - last)[::-1]
        return self.chosen(falling[self.displacement[falling] >= self.limit])

    def chosen(self, states: Sequence[int] | NDArray[np.intp]) -> Trace:
        """The states of these numbers, in this order."""
        at = np.asarray(states, dtype=np.intp)
        return replace(
            self,
            phase=tuple(self.phase[i] for i in at),
            displacement=self.displacement[at],
            force=self.force[at],
            asked=self.asked[at],
            along=self.along[at],
            shift=np.broadcast_to(self.shift, self.force.shape)[at],
            radius_shift=np.broadcast_to(self.radius_shift, self.force.shape)[at],
            profile=lambda i: self.profile(int(at[i])),
            contact=lambda i: self.contact(int(at[i])),
        )

    def perturbed(
        self, force: Array | float = 0.0, radius_shift: Array | float = 0.0, radius_factor: float = 1.0
    ) -> Trace:
        """With forces changed [FU], and radii changed by a multiple of their uncertainties and by a factor."""
        changed = self.force + force
        bracket = self.bracket
        if bracket is not None:  # of tensions, that the last state is the largest of
            shift = float(changed[-1] - self.force[-1])
            bracket = (bracket[0] - shift, bracket[1] - shift)
        return replace(
            self,
            force=changed,
            shift=changed - self.force,
            radius_shift=radius_shift,
            radius_factor=radius_factor,
            bracket=bracket,
        )


def of_states(states: Sequence[State], asked: Sequence[bool] | None = None, limit: float = -np.inf) -> Trace:
    """The trace of measured states; their radii are kept with them."""
    return Trace(
        tuple(state.phase for state in states),
        np.asarray([state.displacement for state in states]),
        np.asarray([state.force for state in states]),
        np.ones(len(states), dtype=bool) if asked is None else np.asarray(asked, dtype=bool),
        np.asarray([state.plate_x for state in states]),
        lambda i: states[i].profile,
        lambda i: states[i].radius,
        states[0].rule,
        limit=limit,
    )


def of_model(
    phase: Sequence[str],
    displacement: Array,
    along: Array,
    asked: Sequence[bool],
    followed: Followed,
    rule: RadiusRule,
    spacing: float,
    limit: float,
) -> Trace:
    """The trace of the reduced model, with unloaded particles on both sides of the contact."""
    beside = spacing * np.arange(1, BESIDE + 1)
    x = np.concatenate([followed.x[0] - beside[::-1], followed.x, followed.x[-1] + beside])
    none = np.zeros_like(x)

    def profile(state: int) -> Profile:
        pressure = np.pad(followed.force(state), BESIDE) / spacing
        shear = none if followed.shear is None else np.pad(followed.shear(state), BESIDE) / spacing
        return Profile(x, none, none, pressure, shear)

    return Trace(
        tuple(phase),
        displacement,
        followed.total,
        np.asarray(asked, dtype=bool),
        along,
        profile,
        cache(lambda state: rule.of(profile(state))),
        rule,
        limit=limit,
    )
