"""The trace from which results are read: displacements, forces and radii along a path, measured or of the model.

A leg is a part of the path between two turns of the loading, numbered from 0 on. Displacements d [LU] and forces F [FU]
are positive in compression. A limit point is a displacement at which the force of a contact that is unloaded jumps.
"""

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
"""Least distance of two displacements over the whole path at which a change exceeds the interpolation error."""


@dataclass(frozen=True)
class Search:
    """The uncertainty of a force maximum that is due to the search for it.

    Attributes:
        doubt: error of the maximum by source, "sampling" or "instability" [FU].
        bracket: under load control, the largest tension that was carried and the smallest that was not, positive [FU];
            None under displacement control.
    """

    doubt: Mapping[str, float] = field(default_factory=dict)
    bracket: tuple[float, float] | None = None


@dataclass(frozen=True)
class Perturbation:
    """The difference of a trace from the measured one.

    Attributes:
        force: added to each force, (m,) or the same for all [FU].
        radius_shift: added to each radius, in multiples of its uncertainty, (m,) or the same for all.
        radius_factor: by which all radii are multiplied.
        moved: added to displacements; lengths follow with their slope, (m,) or the same for all [LU].
    """

    force: Array | float = 0.0
    radius_shift: Array | float = 0.0
    radius_factor: float = 1.0
    moved: Array | float = 0.0


@dataclass(frozen=True)
class Trace:
    """States in order; arrays (m,), with a state for each element.

    Attributes:
        phase: name of each state's phase.
        leg: number of each state's leg, from 0 on: a leg ends where the loading turns.
        displacement, force: [LU], [FU], compression positive.
        along: position along x [LU].
        time: [TU]; 0 where states are equilibria.
        profile: function of a state's number that returns its pressure and shear along x.
        contact: function of a state's number that returns its radius as read off its profile; None where the bodies do
            not touch.
        rule: reads a contact radius off a profile.
        model: the reduced model of the particles, with the limit points of its contact.
        searches: of the legs on which a force maximum was searched for, by the number of the leg.
        wanted: force [FU] that a state was to carry, by the number of the state in the whole trace.
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
        """Return the number of states."""
        return len(self.displacement)

    @property
    def lists(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Displacements [LU] and forces [FU] as two tuples of m numbers, as functions that read a curve take them."""
        return tuple(self.displacement.tolist()), tuple(self.force.tolist())

    @property
    def legs(self) -> list[Trace]:
        """The legs in order, each a trace of its own: the states that share a number in `leg`."""
        return [self.chosen(np.flatnonzero(self.leg == number)) for number in np.unique(self.leg)]

    @property
    def search(self) -> Search:
        """The search for a force maximum on the last leg, empty where there was none.

        Its bracket [FU] is shifted as tension by the perturbation of the last state's force.
        """
        search = self.searches.get(int(self.leg[-1]), Search())
        if search.bracket is None:
            return search
        shift = _value_at(self.perturbation.force, -1)
        return replace(search, bracket=(search.bracket[0] - shift, search.bracket[1] - shift))

    @property
    def limit(self) -> float:
        """The largest displacement [LU] of a limit point of the model below the first state.

        −inf where there is none.
        """
        return max((limit for limit in self.model.limits if limit < self.displacement[0]), default=-np.inf)

    def radius(self, state: int) -> float | None:
        """Return the contact radius of a state [LU], with the perturbation; None where the bodies do not touch."""
        return self.radius_or_spot(state) if self.contact(state) else None

    def radius_or_spot(self, state: int) -> float:
        """Return the contact radius of a state [LU], with the perturbation; 0 where the rule finds no contact.

        The latter is uncertain by 1.5 spacings, so that a perturbation may change it. A radius without uncertainty, of
        a body that ends at an edge, has no shift and no factor; any other is 0 at least.
        """
        radius = self._contact_or_spot(state)
        value = radius.value + self._length_change(state, lambda i: self._contact_or_spot(i).value)
        if radius.uncertainty == 0.0:  # a body that ends at an edge
            return value
        return max(0.0, self.perturbation.radius_factor * (value + self.shift_of(state) * radius.uncertainty))

    def _contact_or_spot(self, state: int) -> ContactRadius:
        """Return the unperturbed radius of a state, as read off its profile [LU]; 0 ± 1.5 spacings without contact."""
        return self.contact(state) or self.rule.or_spot(self.profile(state))

    def reach(self, state: int) -> float | None:
        """Return the outer radius of the cohesive zone, c [LU]; None where the attraction ends at the contact edge."""
        profile = self.profile(state)
        if not isinstance(profile, ZonedProfile) or profile.reach <= profile.edge:
            return None

        def reach(i: int) -> float:
            """Return the outer radius of the cohesive zone in a state [LU], 0 where there is none."""
            return float(getattr(self.profile(i), "reach", 0.0))

        return reach(state) + self._length_change(state, reach)

    def _length_change(self, state: int, length: Callable[[int], float]) -> float:
        """Return the change of a length [LU] by the displacement that a perturbation adds to a state, 0 for none.

        `length`: function of a state's number [LU]. Its slope between states is used, or where that is 0 the law's
        da/dd.
        """
        moved = _value_at(self.perturbation.moved, state)
        if not moved:
            return 0.0
        d = self.displacement - self.perturbation.moved
        return moved * (slope(d, state, length) or self.model.law.radius_rate(float(d[state])))

    def phases(self, *names: str) -> Trace:
        """Return the trace of the states of these phases in order; "unloading_2" counts as a phase "unloading"."""
        return self.chosen(np.flatnonzero([name.partition("_")[0] in names for name in self.phase]))

    def shift_of(self, state: int) -> float:
        """Return the shift that is added to the radius of a state, in multiples of its uncertainty (dimensionless)."""
        return _value_at(self.perturbation.radius_shift, state)

    def falling(self) -> Trace:
        """Return the trace of the states in contact by falling displacement, of several at the same one the last.

        In contact are states above the largest limit point of the model that lies below the largest displacement.
        """
        _, last = np.unique(self.displacement[::-1], return_index=True)
        falling = (len(self) - 1 - last)[::-1]
        limit = max((limit for limit in self.model.limits if limit < self.displacement.max()), default=-np.inf)
        return self.chosen(falling[self.displacement[falling] >= limit])

    def chosen(self, states: Sequence[int] | NDArray[np.intp]) -> Trace:
        """Return the trace of the states of these numbers, in this order; `searches` and `wanted` stay as they are."""
        index, perturbation = np.asarray(states, dtype=np.intp), self.perturbation
        parts = perturbation.force, perturbation.radius_shift, perturbation.moved
        force, shift, moved = (part if isinstance(part, float) else part[index] for part in parts)
        return replace(
            self,
            phase=tuple(map(self.phase.__getitem__, index.tolist())),
            leg=self.leg[index],
            displacement=self.displacement[index],
            force=self.force[index],
            along=self.along[index],
            time=self.time[index],
            perturbation=replace(perturbation, force=force, radius_shift=shift, moved=moved),
            profile=lambda i: self.profile(int(index[i])),
            contact=lambda i: self.contact(int(index[i])),
        )

    def recomputed(self, scene: Scene, settings: Settings, model: Particles) -> dict[str, Array]:
        """Return the columns that are not prescribed, (m,) each, on another model of the particles.

        "displacement" [LU] under prescribed forces over time, "force" [FU] at prescribed displacements or under a load;
        of a free motion, which is computed anew and interpolated at the times of the states, both.
        """
        if self.given == "force":
            return {"displacement": model.displacements_under(self.time, self.force)[0]}
        if self.given:
            return {"force": model.follow(Path(self.displacement, self.along, self.time)).total}
        assert isinstance(scene.experiment, Impact)
        path = impact(scene, settings, model, scene.experiment.velocity)
        columns = {"force": model.follow(path).total, "displacement": path.displacement}
        return {name: np.interp(self.time, path.time, column) for name, column in columns.items()}

    def perturbed(
        self,
        force: Array | float = 0.0,
        radius_shift: Array | float = 0.0,
        radius_factor: float = 1.0,
        moved: Array | float = 0.0,
    ) -> Trace:
        """Return a copy with changed forces, radii and displacements; arguments are (m,) or one number for all states.

        Args:
            force: added to the forces [FU].
            radius_shift: added to each radius, in multiples of its uncertainty.
            radius_factor: by which radii are multiplied.
            moved: added to the displacements [LU].
        """
        changed = self.force + force
        perturbation = Perturbation(changed - self.force, radius_shift, radius_factor, moved)
        return replace(self, displacement=self.displacement + moved, force=changed, perturbation=perturbation)


def _value_at(values: Array | float, state: int) -> float:
    """Return the value of a state, from values (m,) or from one number for all states; its unit is theirs."""
    return values if isinstance(values, float) else float(values[state])


def slope(displacement: Array, state: int, value: Callable[[int], float], least: float = BRANCH_DISTANCE) -> float:
    """Return dv/dd at a state [unit of `value`/LU], from the nearest state at a sufficient distance.

    0 where there is none.

    Args:
        displacement: of the states, (m,) [LU].
        state: number of the state.
        value: function of a state's number.
        least: distance that the other state must exceed, over the distance of the farthest state.
    """
    distance = np.abs(displacement - displacement[state])
    far = np.flatnonzero(distance > least * float(distance.max()))
    if far.size == 0:
        return 0.0
    near = int(far[np.argmin(distance[far])])
    return (value(near) - value(state)) / float(displacement[near] - displacement[state])


def legs_by_phase(phases: Sequence[str]) -> NDArray[np.int64]:
    """Return the number of the leg of each state, (m,), from 0 on: it rises by 1 where the phase's name changes."""
    changes = [int(i > 0 and name != phases[i - 1]) for i, name in enumerate(phases)]
    return np.cumsum(changes, dtype=np.int64)


def of_states(
    states: Sequence[State],
    model: Particles,
    leg: Sequence[int] | None = None,
    searches: Mapping[int, Search] | None = None,
    time_step: float = 0.0,
) -> Trace:
    """Return the trace of measured states, which keep their radii; its time is that of a state plus step · `time_step`.

    Args:
        states: in order, one at least.
        model: the reduced model of their particles.
        leg: number of the leg of each; None: each phase is one.
        searches: for force maxima, by the number of the leg.
        time_step: [TU], of a motion in time; 0 for equilibria.
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
    """Return the trace of the reduced model along a path, with two unloaded particles on both sides of the contact.

    A radius is read between the last particle that carries a load and the next. The surfaces of its profiles are at 0.

    Args:
        phase: name of the phase of each state, (m,).
        leg: number of the leg of each state, (m,).
        path: displacements, positions and times of the states.
        followed: forces of the particles along it.
        rule: reads the contact radius off a profile.
        model: of the particles.
    """
    spacing = model.law.spacing
    margin = spacing * np.arange(1, 3)
    x = np.concatenate([followed.x[0] - margin[::-1], followed.x, followed.x[-1] + margin])
    none = np.zeros_like(x)

    def of_all(forces: Array) -> Array:
        """Return forces of the particles as pressures [FU/LU], with 0 for the unloaded ones on both sides."""
        return np.pad(forces, margin.size) / spacing

    def profile(state: int) -> Profile:
        """Return pressure and shear of a state, with the edges of its zone where the law has one."""
        pressure = of_all(followed.force(state))
        shear = none if followed.shear is None else of_all(followed.shear(state))
        if followed.zone:
            return ZonedProfile(x, none, none, pressure, shear, *(float(column[state]) for column in followed.zone))
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
