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

from contact1d.analysis.pressure import Array, Profile, ZonedProfile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.continuation.state import State
from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import Followed, Path
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.free import impact
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Impact, Scene

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
        radius_factor: by which radii are multiplied, those without uncertainty excepted.
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
        """Return the number m of states; a trace without states is false."""
        return len(self.displacement)

    @property
    def lists(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """(Displacements [LU], forces [FU]), compression positive: two tuples of m numbers in the states' order."""
        return tuple(self.displacement.tolist()), tuple(self.force.tolist())

    @property
    def legs(self) -> list[Trace]:
        """The parts of the path between turns of the loading, in order, each a trace of its own; [] without states."""
        return [self.chosen(np.flatnonzero(self.leg == number)) for number in np.unique(self.leg)]

    @property
    def search(self) -> Search:
        """The uncertainty of the search for a force maximum since the last turn of the loading.

        Empty where there was none. Its bracket [FU], positive tensions, None under displacement control, is lowered by
        the force that a perturbation adds to the last state.

        Raises:
            IndexError: there are no states.
        """
        search = self.searches.get(int(self.leg[-1]), Search())
        if search.bracket is None:
            return search
        shift = _value_at(self.perturbation.force, -1)
        return replace(search, bracket=(search.bracket[0] - shift, search.bracket[1] - shift))

    @property
    def limit(self) -> float:
        """The largest displacement [LU] below the first state at which the reduced model's force jumps in unloading.

        −inf where there is none. Compression is positive.
        """
        return max((limit for limit in self.model.limits if limit < self.displacement[0]), default=-np.inf)

    def radius(self, state: int) -> float | None:
        """Return the contact radius of a state [LU] ≥ 0, with the perturbation; None where the bodies do not touch.

        Raises:
            ValueError: no radius can be read off a measured profile.
        """
        return self.radius_or_spot(state) if self.contact(state) else None

    def radius_or_spot(self, state: int) -> float:
        """Return the contact radius of a state [LU] ≥ 0, with the perturbation; 0 where the bodies do not touch.

        The latter is uncertain by 1.5 spacings, so that a perturbation may change it. A radius without uncertainty, of
        a body that ends at an edge, is shifted only by a change of displacement.
        """
        radius = self._contact_or_spot(state)
        value = radius.value + self._length_change(state, lambda i: self._contact_or_spot(i).value)
        if radius.uncertainty == 0.0:  # a body that ends at an edge
            return value
        return max(0.0, self.perturbation.radius_factor * (value + self.shift_of(state) * radius.uncertainty))

    def _contact_or_spot(self, state: int) -> ContactRadius:
        """Return the unperturbed radius of a state [LU] with edges and uncertainty; 0 ± 1.5 spacings where none."""
        return self.contact(state) or self.rule.or_spot(self.profile(state))

    def reach(self, state: int) -> float | None:
        """Return the outer radius c of the attraction around the contact in a state [LU], with the perturbation.

        Only a perturbation of displacements changes it. None where the law computes no contact edge, and where the
        attraction ends at the edge.
        """
        profile = self.profile(state)
        if not isinstance(profile, ZonedProfile) or profile.reach <= profile.edge:
            return None

        def reach(i: int) -> float:
            """Return the outer radius of the attraction in a state [LU]; 0 where its profile has none."""
            return float(getattr(self.profile(i), "reach", 0.0))

        return reach(state) + self._length_change(state, reach)

    def _length_change(self, state: int, length: Callable[[int], float]) -> float:
        """Return the change of a length [LU] by the displacement that a perturbation adds to a state; 0 for none.

        It is the displacement times the slope of the length to the nearest state at a sufficient distance, or where
        that is 0 times da/dd of the contact law. `length`: function of a state's number [LU].
        """
        moved = _value_at(self.perturbation.moved, state)
        if not moved:
            return 0.0
        d = self.displacement - self.perturbation.moved
        return moved * (slope(d, state, length) or self.model.law.radius_rate(float(d[state])))

    def phases(self, *names: str) -> Trace:
        """Return the trace of the states of these phases, in order; "unloading_2" counts as a phase "unloading".

        Names are given without numbers; it is empty where no state has one of them.
        """
        return self.chosen(np.flatnonzero([name.partition("_")[0] in names for name in self.phase]))

    def shift_of(self, state: int) -> float:
        """Return the shift that a perturbation adds to the radius of a state, over its uncertainty (dimensionless)."""
        return _value_at(self.perturbation.radius_shift, state)

    def falling(self) -> Trace:
        """Return the trace of the states in contact by falling displacement, of several at the same one the latest.

        In contact are states at or above the largest limit point of the reduced model that lies below the largest
        displacement; without limit points all are.

        Raises:
            ValueError: there are no states.
        """
        _, last = np.unique(self.displacement[::-1], return_index=True)
        falling = self.chosen((len(self) - 1 - last)[::-1])
        return falling.chosen(np.flatnonzero(falling.displacement >= falling.limit))

    def chosen(self, states: Sequence[int] | NDArray[np.intp]) -> Trace:
        """Return the trace of the states of these numbers, in this order, with their part of the perturbation.

        `searches` and `wanted` stay as they are, with the numbers of the whole trace.
        """
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

        {"displacement": [LU]} under prescribed forces over time; {"force": [FU]} at prescribed displacements and under
        a load, at the displacements of this trace; of a free motion, which is computed anew and interpolated at the
        times of the states, both. Compression is positive.
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
        """Return a copy with changed forces, radii and displacements; arguments are (m,) or one float for all states.

        A perturbation that this trace has already stays in its forces and displacements, but no longer changes its
        radii.

        Args:
            force: added to the forces [FU].
            radius_shift: added to each radius, in multiples of its uncertainty.
            radius_factor: by which radii are multiplied, those without uncertainty excepted.
            moved: added to the displacements [LU]; radii follow with their slope.
        """
        changed = self.force + force
        perturbation = Perturbation(changed - self.force, radius_shift, radius_factor, moved)
        return replace(self, displacement=self.displacement + moved, force=changed, perturbation=perturbation)


def _value_at(values: Array | float, state: int) -> float:
    """Return the value of a state, from values (m,) or from one float for all states; its unit is theirs."""
    return values if isinstance(values, float) else float(values[state])


def slope(displacement: Array, state: int, value: Callable[[int], float], least: float = BRANCH_DISTANCE) -> float:
    """Return dv/dd at a state [unit of `value`/LU], to the nearest state at a sufficient distance; 0 without one.

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
    """Return a number for each state, (m,), from 0 on, that rises by 1 where the name of the phase changes."""
    changes = [int(i > 0 and name != phases[i - 1]) for i, name in enumerate(phases)]
    return np.cumsum(changes, dtype=np.int64)


def of_states(
    states: Sequence[State],
    model: Particles,
    leg: Sequence[int] | None = None,
    searches: Mapping[int, Search] | None = None,
    time_step: float = 0.0,
) -> Trace:
    """Return the trace of measured states in their order; its times [TU] are their own plus step · `time_step`.

    Profiles and radii are those of the states; x is the position of the plate.

    Args:
        states: in order, one at least.
        model: the reduced model of their particles.
        leg: for each, how often the loading turned before it; None: it turns between phases.
        searches: for force maxima, by that number.
        time_step: [TU], of a motion in time; 0 for equilibria.

    Raises:
        IndexError: there are no states.
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

    A radius is read between the last particle that carries a load and the next, and cached. The surfaces of its
    profiles are at 0, also of particles out of contact.

    Args:
        phase: name of the phase of each state, (m,).
        leg: for each state, how often the loading turned before it, (m,).
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
        """Return forces of the particles, (n,) [FU], as pressures, (n + 4,) [FU/LU], 0 for two on both sides."""
        return np.pad(forces, margin.size) / spacing

    def profile(state: int) -> Profile:
        """Return pressure and shear of a state [FU/LU] over x [LU], with the contact edges where the law computes them.

        Shear is 0 without a prescribed tangential path. Each call makes a new object.
        """
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
