"""The trace from which results are read: displacements, forces and radii along a path, measured or of the model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile, ZonedProfile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.continuation.state import State
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.free import impact
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Impact, Scene

Array = NDArray[np.float64]
BRANCH_DISTANCE = 0.02
"""Distance of two displacements over the whole path from which on a change is more than interpolation error."""
BESIDE = 2
"""Particles beside a contact that carry nothing: a radius is read between the last that carries and the next."""


@dataclass(frozen=True)
class Search:
    """What the search for a force maximum leaves open.

    Attributes:
        doubt: error of the maximum by source [FU].
        bracket: under load control, the force maximum that was held and the smallest that was not [FU].
    """

    doubt: Mapping[str, float] = field(default_factory=dict)
    bracket: tuple[float, float] | None = None


@dataclass(frozen=True)
class Perturbation:
    """By how much a trace differs from what was measured.

    Attributes:
        force: added, (m,) [FU].
        radius_shift: by how many of its own uncertainties each radius is taken too large, (m,).
        radius_factor: by which radii are taken larger.
        moved: added to displacements, and lengths go along, (m,) [LU].
    """

    force: Array | float = 0.0
    radius_shift: Array | float = 0.0
    radius_factor: float = 1.0
    moved: Array | float = 0.0


@dataclass(frozen=True)
class Trace:
    """States in order; arrays (m,).

    Attributes:
        phase: name of each state's phase.
        leg: number of each state's leg, from 0 on: a leg ends where the loading turns.
        displacement, force: [LU], [FU].
        along: position along x [LU].
        time: [TU]; 0 where states are equilibria.
        profile: pressure and shear of a state, by its number.
        contact: radius of a state as it is read off its profile; None where the bodies do not touch.
        rule: what a contact radius is.
        model: the reduced model of the particles, with the limit points of its contact.
        searches: of the legs on which a force maximum was searched for.
        wanted: force [FU] that a state of the whole trace was to carry, by its number.
        given: what is prescribed of all states: "displacement", "force" over time, a "load", or "" of a free motion.
        perturbation: forces and displacements are changed by it already, lengths as they are read.
    """

    phase: tuple[str, ...]
    leg: NDArray[np.int64]
    displacement: Array
    force: Array
    along: Array
    time: Array
    profile: Callable[[int], Profile] = field(repr=False)
    contact: Callable[[int], ContactRadius | None] = field(repr=False)
    rule: RadiusRule = field(repr=False)
    model: Particles = field(repr=False)
    searches: Mapping[int, Search] = field(default_factory=dict)
    wanted: Mapping[int, float] = field(default_factory=dict)
    given: str = "displacement"
    perturbation: Perturbation = Perturbation()

    def __len__(self) -> int:
        """How many states."""
        return len(self.displacement)

    @property
    def lists(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Displacements and forces, as arguments of the functions that read a curve."""
        return tuple(self.displacement.tolist()), tuple(self.force.tolist())

    @property
    def legs(self) -> list[Trace]:
        """The legs in order."""
        return [self.chosen(np.flatnonzero(self.leg == number)) for number in np.unique(self.leg)]

    @property
    def search(self) -> Search:
        """That of the last leg, its bracket perturbed as the force of the last state is, which it holds."""
        own = self.searches.get(int(self.leg[-1]), Search())
        if own.bracket is None:
            return own
        shift = _of(self.perturbation.force, -1)
        return replace(own, bracket=(own.bracket[0] - shift, own.bracket[1] - shift))

    @property
    def limit(self) -> float:
        """The first limit point below the first state [LU]; −inf where there is none."""
        return max((one for one in self.model.limits if one < self.displacement[0]), default=-np.inf)

    def radius(self, state: int) -> float | None:
        """Contact radius [LU]; None where the bodies do not touch."""
        return self.radius_or_spot(state) if self.contact(state) else None

    def radius_or_spot(self, state: int) -> float:
        """The same; 0 where no particle is in tension."""
        found = self._read(state)
        value = found.value + self._further(state, lambda i: self._read(i).value)
        if found.uncertainty == 0.0:  # a body that ends at an edge
            return value
        return max(0.0, self.perturbation.radius_factor * (value + self.shift_of(state) * found.uncertainty))

    def _read(self, state: int) -> ContactRadius:
        return self.contact(state) or self.rule.or_spot(self.profile(state))

    def reach(self, state: int) -> float | None:
        """How far an attraction goes beyond the contact, c [LU]; None where it ends with that."""
        own = self.profile(state)
        if not isinstance(own, ZonedProfile) or own.reach <= own.edge:
            return None

        def reach(i: int) -> float:
            return float(getattr(self.profile(i), "reach", 0.0))

        return reach(state) + self._further(state, reach)

    def _further(self, state: int, length: Callable[[int], float]) -> float:
        """How much larger a length [LU] is where a state is moved to."""
        moved = _of(self.perturbation.moved, state)
        if not moved:
            return 0.0
        d = self.displacement - self.perturbation.moved
        return moved * (slope(d, state, length) or self.model.law.radius_rate(float(d[state])))

    def phases(self, *names: str) -> Trace:
        """The states of these phases, "unloading_2" being one of "unloading"."""
        return self.chosen(np.flatnonzero([name.partition("_")[0] in names for name in self.phase]))

    def shift_of(self, state: int) -> float:
        """By how many of its uncertainties the radius of a state is taken too large."""
        return _of(self.perturbation.radius_shift, state)

    def falling(self) -> Trace:
        """The states that are held, by falling displacement, each once, the last that was measured there."""
        _, last = np.unique(self.displacement[::-1], return_index=True)
        falling = (len(self) - 1 - last)[::-1]
        limit = max((one for one in self.model.limits if one < self.displacement.max()), default=-np.inf)
        return self.chosen(falling[self.displacement[falling] >= limit])

    def chosen(self, states: Sequence[int] | NDArray[np.intp]) -> Trace:
        """The states of these numbers, in this order."""
        at, own = np.asarray(states, dtype=np.intp), self.perturbation
        parts = own.force, own.radius_shift, own.moved
        force, shift, moved = (one if isinstance(one, float) else one[at] for one in parts)
        return replace(
            self,
            phase=tuple(map(self.phase.__getitem__, at.tolist())),
            leg=self.leg[at],
            displacement=self.displacement[at],
            force=self.force[at],
            along=self.along[at],
            time=self.time[at],
            perturbation=replace(own, force=force, radius_shift=shift, moved=moved),
            profile=lambda i: self.profile(int(at[i])),
            contact=lambda i: self.contact(int(at[i])),
        )

    def again(self, scene: Scene, settings: Settings, model: Particles) -> dict[str, Array]:
        """What is not prescribed of each state, on another model of the particles; a free motion is its own."""
        if self.given == "force":
            return {"displacement": model.displacements_under(self.time, self.force)[0]}
        if self.given:
            return {"force": model.follow(Path(self.displacement, self.along, self.time)).total}
        assert isinstance(scene.experiment, Impact)
        path = impact(scene, settings, model, scene.experiment.velocity)
        columns = {"force": model.follow(path).total, "displacement": path.displacement}
        return {name: np.interp(self.time, path.time, one) for name, one in columns.items()}

    def perturbed(
        self,
        force: Array | float = 0.0,
        radius_shift: Array | float = 0.0,
        radius_factor: float = 1.0,
        moved: Array | float = 0.0,
    ) -> Trace:
        """With forces changed [FU], radii by multiples of their uncertainties and a factor, states moved [LU]."""
        changed = self.force + force
        own = Perturbation(changed - self.force, radius_shift, radius_factor, moved)
        return replace(self, displacement=self.displacement + moved, force=changed, perturbation=own)


def _of(values: Array | float, state: int) -> float:
    """What a state has of values, (m,), or of one that all have."""
    return values if isinstance(values, float) else float(values[state])


def slope(displacement: Array, state: int, value: Callable[[int], float], least: float = BRANCH_DISTANCE) -> float:
    """dv/dd at a state, from the nearest other one that is farther than a share `least` of the whole path."""
    away = np.abs(displacement - displacement[state])
    others = np.flatnonzero(away > least * float(away.max()))
    if others.size == 0:
        return 0.0
    near = int(others[np.argmin(away[others])])
    return (value(near) - value(state)) / float(displacement[near] - displacement[state])


def legs_by_phase(phases: Sequence[str]) -> NDArray[np.int64]:
    """A leg for each phase, (m,)."""
    changes = [int(i > 0 and name != phases[i - 1]) for i, name in enumerate(phases)]
    return np.cumsum(changes, dtype=np.int64)


def of_states(
    states: Sequence[State],
    model: Particles,
    leg: Sequence[int] | None = None,
    searches: Mapping[int, Search] | None = None,
    time_step: float = 0.0,
) -> Trace:
    """The trace of measured states; their radii are kept with them.

    Args:
        states: in order.
        model: of their particles.
        leg: number of the leg of each; None: each phase is one.
        searches: see `Trace`.
        time_step: [TU], of a motion in time.
    """
    phases = tuple(state.phase for state in states)
    return Trace(
        phases,
        legs_by_phase(phases) if leg is None else np.asarray(leg, dtype=np.int64),
        np.asarray([state.displacement for state in states]),
        np.asarray([state.force for state in states]),
        np.asarray([state.plate_x for state in states]),
        np.asarray([time_step * state.step + state.time for state in states]),
        lambda i: states[i].profile,
        lambda i: states[i].radius,
        states[0].rule,
        model,
        searches or {},
    )


def of_model(
    phase: Sequence[str], leg: Sequence[int], path: Path, followed: Followed, rule: RadiusRule, model: Particles
) -> Trace:
    """The trace of the reduced model along a path, with unloaded particles on both sides of the contact."""
    spacing = model.law.spacing
    beside = spacing * np.arange(1, BESIDE + 1)
    x = np.concatenate([followed.x[0] - beside[::-1], followed.x, followed.x[-1] + beside])
    none = np.zeros_like(x)

    def of_all(forces: Array) -> Array:
        return np.concatenate([none[:BESIDE], forces, none[:BESIDE]]) / spacing

    def profile(state: int) -> Profile:
        pressure = of_all(followed.force(state))
        shear = none if followed.shear is None else of_all(followed.shear(state))
        if followed.zone:
            return ZonedProfile(x, none, none, pressure, shear, *(float(one[state]) for one in followed.zone))
        return Profile(x, none, none, pressure, shear)

    return Trace(
        tuple(phase),
        np.asarray(leg, dtype=np.int64),
        path.displacement,
        followed.total,
        path.along,
        path.time,
        profile,
        cache(lambda state: rule.of(profile(state))),
        rule,
        model,
    )
