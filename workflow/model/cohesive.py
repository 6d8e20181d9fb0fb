"""The contact of a body whose attraction has a range (`dugdale`), before LAMMPS runs, and as the load of each cell.

Its states are one curve, from c = 0 over the touch of the apexes to wide contacts. Where d falls along it no state is
stable: a contact that is loaded goes on to the next place of the curve with its d, one that is unloaded to the one
before; there are any number of such limit points, or none but that of the attraction itself.

A particle has the integral of q over its cell. Integrals of neighbours add up, so that F is exact at every spacing.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.digits import apart
from contact1d.workflow.model.adhesion import SPANNED, AdhesiveEstimate, elongation
from contact1d.workflow.model.chain import SettingsError
from contact1d.workflow.model.dugdale import DOUBLINGS, Dugdale, Zone, covered
from contact1d.workflow.model.pairs import ContactEstimate, Profile, beside_kinks, plane_estimate
from contact1d.workflow.scene import Impact, Rate, Scene

Array = NDArray[np.float64]
POINTS, FIRST, NEAR = 400, 1e-3, 40
"""Radii at which the equations are solved, the first of them over the last, and how many lie before that one."""
BETWEEN = 10
"""Points of the curve for each of them, by cubics: their error is some 1e-8 of F."""
BEFORE = 1000
"""Points of the curve before contact, where d(c) is explicit."""
APART = -1.0
"""Place on the curve of bodies that do not feel each other."""
ENERGY_PLACES = 4000
"""Positions of the two integrals of an energy."""
LOST, SLOWING, EXACT, FOLLOWED = 1e-3, 12, 1e-11, 4000
"""Edge over that under fixed grips at which a receding one is lost, and the power with which it slows down beyond; the
error of its motion, and times at which a pull looks for equal ways."""
RESOLVED = 1e-9
"""Least way of the attraction beyond the contact over the radius under fixed grips. Measured: at 1e-10 forces are off
by 4e-7, and below that the curve is no longer monotonic."""
SLOWEST = 1e-8
"""Least (v/v₀)ⁿ of a pull."""
SAME = 1e-9
"""Fall of d over its range that is one: others are round-off."""


@dataclass(frozen=True)
class Cells:
    """What the cell of each particle spans on one side of the axis; arrays (n,).

    Attributes:
        inner, outer: its ends [LU].
        below, above: G there [LU²].
        sides: 2 of a particle on the axis, which has a cell on either side; else 1.
    """

    inner: Array
    outer: Array
    below: Array
    above: Array
    sides: Array


@dataclass(frozen=True, eq=False)
class ZonedEstimate(AdhesiveEstimate):
    """A contact whose edges each load step gives.

    Attributes:
        surface: f, whose transform the profile is.
    """

    surface: Profile = field(kw_only=True)

    @property
    @abstractmethod
    def law(self) -> Dugdale:
        """Its equations."""

    def zones(self, x: Array) -> Cells:
        """The cells of particles at positions x, (n,) [LU]."""
        at, half = np.abs(x), 0.5 * self.spacing
        inner, outer = np.maximum(at - half, 0.0), at + half
        sides = np.where(at < 0.25 * self.spacing, 2.0, 1.0)
        # Beyond the body nothing is known, and nothing carries.
        below, above = (self.law.area(np.minimum(end, self.known)) for end in (inner, outer))
        return Cells(inner, outer, below, above, sides)

    def loads(self, cells: Cells, zone: Zone, state: int) -> Array:
        """∫ q dx [FU] over each cell in a state."""
        a, c, d = (float(column[state]) for column in (zone.edge, zone.reach, zone.displacement))
        end = np.minimum(cells.outer, a)
        area = np.where(cells.outer < a, cells.above, self.law.area(np.asarray([a]))[0])
        pressed = self.modulus * np.where(cells.inner < a, d * (end - cells.inner) - (area - cells.below), 0.0)
        low, high = (np.minimum(np.maximum(one, a), c) for one in (cells.inner, cells.outer))
        return np.asarray(cells.sides * (pressed - 2.0 * self.law.stress * (_half_disc(high, c) - _half_disc(low, c))))


@dataclass(frozen=True, eq=False)
class CohesiveEstimate(ZonedEstimate):
    """The curve of a contact whose attraction has a range.

    Attributes:
        range: h₀ [LU].
    """

    range: float = field(kw_only=True)

    @cached_property
    def law(self) -> Dugdale:
        """Its equations."""
        return Dugdale(self.profile, self.surface, self.modulus, self.work / self.range, self.range, self.known)

    @cached_property
    def _nodes(self) -> Zone:
        """Contacts at which the equations are solved, by rising a from 0 on, limit points among them."""
        least = FIRST * self.known
        edge = np.concatenate([np.linspace(0.0, least, NEAR, endpoint=False), np.geomspace(least, self.known, POINTS)])
        edge = beside_kinks(edge, self.profile)
        edge = np.unique(np.concatenate([edge, self._folds(edge)]))
        return self.law.states(edge, self.law.widths(edge))

    def _folds(self, edge: Array) -> Array:
        """a [LU] where d has an extremum, between those of its neighbours on a grid."""
        from scipy.optimize import elementwise

        d = self.law.states(edge, self.law.widths(edge)).displacement
        slope = np.sign(np.diff(d))
        turns = np.flatnonzero(slope[1:] != slope[:-1]) + 1
        if not turns.size:
            return turns.astype(np.float64)
        found = elementwise.find_minimum(
            lambda a, sign: sign * self.law.states(a, self.law.widths(a)).displacement,
            (edge[turns - 1], edge[turns], edge[turns + 1]),
            args=(np.sign(slope[turns]),),
        )
        return np.asarray(found.x)

    @cached_property
    def curve(self) -> Zone:
        """All states, from c = 0 on: before contact, and by cubics between contacts."""
        from scipy.interpolate import CubicSpline

        nodes = self._nodes
        reach = nodes.reach[0] * np.linspace(0.0, 1.0, BEFORE, endpoint=False)
        none = np.zeros_like(reach)
        columns = [[none], [reach], [self.law.before(reach)], [-math.pi * self.law.stress * reach**2]]
        # Each stretch between kinks has its own cubics: beyond a kink d rises as a root.
        ends = [0, *(at for at in np.searchsorted(nodes.edge, self.profile.kinks) if 0 < at < nodes.edge.size - 1)]
        for first, last in pairwise([*ends, nodes.edge.size - 1]):
            own, number = slice(first, last + 1), np.arange(last - first + 1.0)
            edge = np.interp(np.linspace(0.0, last - first, BETWEEN * (last - first) + 1), number, nodes.edge[own])
            start = 0 if first == 0 else 1
            columns[0].append(edge[start:])
            for column, values in zip(columns[1:], list(vars(nodes).values())[1:], strict=True):
                column.append(CubicSpline(nodes.edge[own], values[own])(edge[start:]))
        return Zone(*map(np.concatenate, columns))

    def places(self, displacements: Array, place: float = APART) -> Array:
        """Places on the curve of a contact that goes from one of them along displacements [LU]: indices, or APART."""
        d, found = self.curve.displacement, np.empty(displacements.size)
        first = float(d[0])
        for i, wanted in enumerate(displacements.tolist()):
            if place == APART:
                place = APART if wanted < first else 0.0
            if place != APART:
                at = int(place)
                if wanted > self._at(d, place):
                    further = np.flatnonzero(d[at + 1 :] >= wanted)
                    end = at + 1 + int(further[0]) if further.size else d.size - 1
                    place = _between(d, end - 1, wanted)
                else:
                    back = np.flatnonzero(d[: at + 1] <= wanted)
                    place = _between(d, int(back[-1]), wanted) if back.size else APART
            found[i] = place
        return found

    @staticmethod
    def _at(column: Array, place: float) -> float:
        return float(np.interp(place, np.arange(column.size), column))

    def at(self, places: Array) -> Zone:
        """The states at places of the curve; bodies apart feel nothing, at a displacement that is not known."""
        number, held = np.arange(self.curve.edge.size, dtype=np.float64), places != APART
        return Zone(*(np.where(held, np.interp(places, number, one), 0.0) for one in vars(self.curve).values()))

    def place_of(self, edge: float, reach: float) -> float:
        """The place of a state on the curve, by its a and c [LU]."""
        if reach == 0.0:
            return APART
        column = self.curve.edge if edge > 0.0 else self.curve.reach[: BEFORE + 1]
        start = BEFORE if edge > 0.0 else 0
        return start + float(np.interp(edge or reach, column[start:], np.arange(column.size - start)))

    def solved(self, displacements: Array, places: Array) -> Zone:
        """The states at displacements [LU] near places of the curve, exactly."""
        from scipy.optimize import elementwise

        guess, nodes = self.at(places), self._nodes
        edge, width = np.zeros_like(displacements), np.zeros_like(displacements)
        touching, near = guess.edge > 0.0, (guess.edge == 0.0) & (places != APART)
        if touching.any():
            d = displacements[touching]
            low = np.clip((places[touching] - BEFORE) // BETWEEN, 0, nodes.edge.size - 2).astype(np.intp)
            low -= (nodes.displacement[low] > d) & (low > 0)
            low += (nodes.displacement[low + 1] < d) & (low < nodes.edge.size - 2)

            def error(edge: Array, d: Array) -> Array:
                return self.law.gap_error(edge, np.maximum(self.profile.height(edge) - d, 0.0) / self.law.ratio, d)

            ends = nodes.edge[low], nodes.edge[low + 1]
            found = elementwise.find_root(error, ends, args=(d,), maxiter=DOUBLINGS)
            nearer = np.where(np.abs(error(ends[0], d)) < np.abs(error(ends[1], d)), *ends)
            edge[touching] = np.where(found.success, found.x, nearer)
            width[touching] = np.maximum(self.profile.height(edge[touching]) - d, 0.0) / self.law.ratio
        if near.any():
            d = displacements[near]
            low = np.clip(places[near].astype(np.intp), 0, BEFORE - 1)
            ends = self.curve.reach[low], self.curve.reach[low + 1]
            found = elementwise.find_root(lambda c, d: self.law.before(c) - d, ends, args=(d,), maxiter=DOUBLINGS)
            width[near] = np.where(found.success, found.x, guess.reach[near])
        force = np.where(places == APART, 0.0, self.law.forces(edge, width, displacements))
        return Zone(edge, np.hypot(edge, width), displacements, force)

    def held_at(self, displacement: float) -> float:
        """F [FU] at a displacement [LU] of a contact that is unloaded from the widest, exactly."""
        place = np.interp(displacement, self.held.displacement, self._unloaded[0])
        return float(self.solved(np.asarray([displacement]), np.atleast_1d(place)).force[0])

    # --- what a predictor is asked

    @cached_property
    def _unloaded(self) -> tuple[list[float], list[float]]:
        """Places on the curve that a contact passes which is unloaded from the widest, rising; d [LU] where it jumps.

        At a jump they have both its ends.
        """
        d, least = self.curve.displacement, SAME * float(np.ptp(self.curve.displacement))
        passed = np.flatnonzero(d <= np.append(np.minimum.accumulate(d[::-1])[::-1][1:], np.inf)).tolist()
        places, jumps = [float(passed[0])], list[float]()
        for before, after in pairwise(passed):
            if after > before + 1 and d[before + 1 : after].max() > d[after] + least:
                places.append(_between(d, before, float(d[after])))
                jumps.append(float(d[after]))
            places.append(float(after))
        return places, jumps if passed[0] == 0 else [float(d[passed[0]]), *jumps]

    @cached_property
    def held(self) -> Zone:
        """The states of a contact that is unloaded from the widest, by rising d."""
        return self.at(np.asarray(self._unloaded[0]))

    @cached_property
    def _grid(self) -> tuple[Array, Array, Array, int]:
        return self.held.edge, self.held.displacement, self.held.force, 0

    @property
    def limits(self) -> tuple[float, ...]:
        """Displacements [LU] at which a contact that is unloaded jumps, rising; at the first it is lost."""
        return tuple(self._unloaded[1])

    @cached_property
    def critical_radius(self) -> float:
        """a [LU] at the force maximum; 0 where that comes before contact."""
        from scipy.optimize import elementwise

        nodes = self._nodes
        top = int(np.argmin(nodes.force))
        if not 0 < top < nodes.edge.size - 1:
            return float(nodes.edge[top])

        def force(edge: Array) -> Array:
            return self.law.states(edge, self.law.widths(edge)).force

        found = elementwise.find_minimum(force, tuple(nodes.edge[top + i : top + i + 1] for i in (-1, 0, 1)))
        return float(found.x[0])

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """c(d) [LU] of a contact that is held, at least a spacing."""
        return np.maximum(self.spacing, self.reaches(displacements))

    def reaches(self, displacements: Array) -> Array:
        """The same without regard to the spacing."""
        return np.asarray(np.interp(displacements, self.held.displacement, self.held.reach))

    def require_one_edge(self) -> None:
        """Nothing: where the edge would jump, the curve has a limit point."""

    def energy(self, displacement: float, radius: float) -> float | None:
        """See `energy_of`, of a contact that is unloaded from the widest."""
        width = (float(self.profile.height(np.asarray([radius]))[0]) - displacement) / self.law.ratio
        c = math.hypot(radius, width) if radius > 0.0 else float(self.reaches(np.asarray([displacement]))[0])
        return 0.0 if displacement < self.held.displacement[0] else self.energy_of(radius, c, displacement)

    def energy_of(self, a: float, c: float, d: float) -> float:
        """E* ∫₀ᵃ (d−g)² dx − (4σ₀²/E*) ∫ₐᶜ (c²−x²) dx + 4σ₀ ∫ₐᶜ (g−d) √(c²−x²) dx − πc²W [FU·LU], 0 of bodies apart."""
        if c == 0.0:
            return 0.0
        inner, outer = (
            np.linspace(0.0, a, ENERGY_PLACES),
            c * np.sin(np.linspace(math.asin(a / c), 0.5 * math.pi, ENERGY_PLACES)),
        )
        pressed = self.modulus * float(np.trapezoid((d - self.profile.height(inner)) ** 2, inner))
        root = np.sqrt((c - outer) * (c + outer))
        drawn = 4.0 * self.law.stress * float(np.trapezoid((self.profile.height(outer) - d) * root, outer))
        disc = c * c * (c - a) - (c**3 - a**3) / 3.0
        return pressed - 4.0 * self.law.stress**2 / self.modulus * disc + drawn - math.pi * c * c * self.work

    def energy_at(self, place: float) -> float:
        """The same at a place of the curve."""
        zone = self.at(np.asarray([place]))
        return self.energy_of(*(float(one[0]) for one in (zone.edge, zone.reach, zone.displacement)))

    @cached_property
    def snaps_in(self) -> list[float]:
        """Displacements [LU] at which a contact that is loaded jumps, rising."""
        d = self.curve.displacement
        passed = np.flatnonzero(d >= np.maximum.accumulate(d))
        return [float(d[a]) for a, b in pairwise(passed) if d[a + 1 : b].min(initial=np.inf) < d[a] - SAME * np.ptp(d)]

    def lost_between(self, before: float, after: float) -> float:
        """Energy [FU·LU] that a contact loses as it jumps on its way from one place of the curve to another."""
        low, high = sorted((math.ceil(max(before, 0.0)), math.ceil(max(after, 0.0))))
        way = 1 if after > before else -1
        d = way * self.curve.displacement[low : high + 1][::way]
        least = SAME * float(np.ptp(self.curve.displacement))
        passed = np.maximum.accumulate(d)
        if d.size < 2 or (passed - d).max() < least:
            return 0.0
        top = int(np.argmax(passed == passed[int(np.argmax(passed - d >= least))]))
        place = float(low + top if way > 0 else high - top)
        beyond = self.places(np.asarray([way * (float(d[top]) + least)]), place)
        return self.energy_at(place) - self.energy_at(float(beyond[0]))


@dataclass(frozen=True, eq=False)
class RatedEstimate(ZonedEstimate):
    """JKR's contact, whose edge recedes at a finite speed and advances at once (D. Maugis, M. Barquins, J. Phys. D 11
    (1978) 1989):

        G = E* (g(a) − d)²/(2πa),    −da/dt = v₀ (G/W − 1)^(1/n)  where G > W,    F = 2E* ∫₀ᵃ (d − g) dx

    Attributes:
        rate: v₀ and n.
    """

    rate: Rate = field(kw_only=True)

    @cached_property
    def law(self) -> Dugdale:
        """Without an attraction beyond the edge."""
        return Dugdale(self.profile, self.surface, self.modulus, 0.0, self.known, self.known)

    def radii(self, displacements: Array) -> Array:
        """a(d) [LU] at rest, solved between the places of the predictor: the force of a row depends on it."""
        from scipy.optimize import elementwise

        x, h, _, least = self._grid
        cell = np.clip(np.searchsorted(h[least:], displacements), 1, h.size - least - 1) + least
        ends = x[cell - 1], x[cell]

        def error(edge: Array, d: Array) -> Array:
            return np.asarray(self.profile.height(edge) - elongation(edge, self.modulus, self.work) - d)

        found = elementwise.find_root(error, ends, args=(displacements,))
        return np.where(found.success, found.x, super().radii(displacements))

    def _recedes(self, edge: float, displacement: float) -> float:
        """da/dt [LU/TU]."""
        opened = float(self.profile.height(np.asarray([edge]))[0]) - displacement
        excess = self.modulus * opened * opened / (2.0 * math.pi * edge * self.work) - 1.0
        return -self.rate.velocity * excess ** (1.0 / self.rate.exponent) if excess > 0.0 and opened > 0.0 else 0.0

    def _narrowed(self, edge: float, place: Callable[[float], float], times: Array) -> Array:
        """a [LU] at times (m,) [TU] from the first one on, where it is `edge`; 0 from where it is lost."""
        from scipy.integrate import solve_ivp

        least = LOST * self.fixed_grips[0]

        def change(time: float, log: Array) -> list[float]:
            # A lost edge slows down: an end of the motion would not be found surely; a trial step may go far beyond.
            radius = max(math.exp(float(log[0])), LOST * least)
            return [self._recedes(radius, place(time)) / radius / (1.0 + (0.5 * least / radius) ** SLOWING)]

        ends, start = (float(times[0]), float(times[-1])), [math.log(edge)]
        found = np.exp(solve_ivp(change, ends, start, "LSODA", times, rtol=EXACT, atol=EXACT).y[0])
        return np.where(np.maximum.accumulate(found <= least), 0.0, found)

    def edges(self, times: Array, displacements: Array) -> Array:
        """a [LU] at times (m,) [TU] along displacements (m,) [LU], straight between them, from apart on."""
        found, edge, turns = np.zeros_like(times), 0.0, np.flatnonzero(np.diff(np.sign(np.diff(displacements)))) + 1
        for leg in pairwise([0, *turns.tolist(), times.size - 1]):
            own = slice(leg[0], leg[1] + 1)
            d = displacements[own]
            if d.size > 1 and edge > 0.0 and d[-1] <= d[0]:
                found[own] = self._narrowed(edge, partial(np.interp, xp=times[own], fp=d), times[own])
            else:
                touched = np.maximum.accumulate(d >= -SAME * self.spacing) | (edge > 0.0)
                found[own] = np.where(touched, np.maximum(edge, self.radii(d)), 0.0)
            edge = float(found[own][-1])
        return found

    def pulled(self, start: float, velocity: float, count: int) -> Array:
        """Times [TU] of a pull from rest at which edge or body has gone `count` equal ways, and when it is lost."""
        edge, least = float(self.radii(np.asarray([start]))[0]), self.fixed_grips[1]
        end = (start - least) / velocity
        while True:
            times = np.linspace(0.0, end, FOLLOWED)
            found = self._narrowed(edge, lambda time: start - velocity * time, times)
            if found[-1] == 0.0:
                break
            end *= 2.0
        held = found > 0.0
        ways = np.interp(-np.linspace(edge, found[held][-1], count), -found[held], times[held])
        return np.append(np.union1d(ways, np.linspace(0.0, ways[-1], count)), times[~held][0])


def _half_disc(x: Array, radius: float) -> Array:
    """∫₀ˣ √(c² − x²) dx [LU²]."""
    root = np.sqrt((radius - x) * (radius + x))
    return np.asarray(0.5 * (x * root + radius**2 * np.arctan2(x, root)))


def _between(column: Array, low: int, value: float) -> float:
    """The place of a value in the cell of a column that begins at `low`."""
    start, end = float(column[low]), float(column[min(low + 1, column.size - 1)])
    return low + (min(max((value - start) / (end - start), 0.0), 1.0) if end > start else 0.0)


STOPPING = 200
"""Displacements at which the force is looked at up to where a body stops."""


def stopped_at(scene: Scene, estimate: ContactEstimate, softer: float = 1.0) -> float:
    """Displacement [LU] at which a body that hits the plane is at rest: ∫F dd = ½ M v²; 0 without a velocity.

    F is that of the elastic body, or so many times less. Infinite where that lies beyond what is known of the contact.
    """
    if not isinstance(scene.experiment, Impact):
        return 0.0
    assert scene.plate
    assert scene.plate.mass != "auto"
    energy, deepest = 0.5 * softer * scene.plate.mass * scene.experiment.velocity**2, scene.bodies.spacing
    last = math.inf  # a contact that covers its body only gets deeper
    if isinstance(estimate, AdhesiveEstimate) and estimate.known < estimate.profile.reach:
        last = estimate.end[1]

    def stored(displacement: float) -> float:
        places = np.linspace(0.0, displacement, STOPPING)
        return float(np.trapezoid(estimate.contact_forces(places), places))

    from scipy.optimize import brentq

    while stored(min(deepest, last)) < energy:
        if deepest >= last:
            return math.inf
        deepest *= 2.0
    deepest = min(deepest, last)  # a share of it, since the root is found to an absolute error
    return deepest * float(brentq(lambda share: stored(share * deepest) - energy, 0.0, 1.0))


def estimate_on_plane(scene: Scene, profile: Profile) -> ContactEstimate:
    """The predictor of a scene on a rigid plane; that of one with [adhesion] is known as far as its experiment needs.

    Raises:
        SettingsError: the contact would be as wide as the body, or its edge would jump.
    """
    bodies, stiffness = scene.bodies, scene.bulk_stiffness
    springs = plane_estimate(profile, bodies.spacing, stiffness)
    if not scene.adhesion:
        return springs
    given, load = max([0.0, *scene.experiment.places()]), scene.experiment.compression or 0.0
    known, work, reach = bodies.spacing, scene.adhesion.work, scene.adhesion.range
    estimate, wanted = None, given
    common = springs.gap, springs.force, springs.rest, profile, bodies.spacing, stiffness
    while estimate is None or not (estimate.known == profile.reach or estimate.is_beyond(wanted, load)):
        widest = min(known, profile.reach)
        estimate = AdhesiveEstimate(*common, work=work, known=widest)
        wanted = max(given, stopped_at(scene, estimate))
        known *= 2.0
    if reach and work:
        estimate = _with_range(estimate, reach, bodies.profile, wanted, load)
    elif (rate := scene.adhesion.rate) and work:
        speed = getattr(scene.experiment, "velocity", None) or rate.velocity
        if (more := (speed / rate.velocity) ** rate.exponent) < SLOWEST:
            raise SettingsError(
                f"the contact is JKR's within {more:.1g}: an adhesion.rate whose velocity is so far above "
                f"experiment.velocity, {speed:.4g} LU/TU, changes nothing that is resolved: leave it out"
            )
        own = {one.name: getattr(estimate, one.name) for one in fields(estimate)}
        estimate = RatedEstimate(**own, surface=bodies.profile, rate=rate)
    if bodies.own_count is None:
        widest = float(estimate.radii(np.asarray([max(wanted, estimate.displacement_at(load))]))[0])
        if widest > SPANNED * profile.reach:
            raise SettingsError(
                f"the adhesive contact would cover the body, which ends at {profile.reach:.6g} LU: JKR's theory is for "
                "a contact much smaller than the body. Lower adhesion.work_of_adhesion, the load or the displacement"
            )
    estimate.require_one_edge()
    return estimate


def _with_range(jkr: AdhesiveEstimate, reach: float, surface: Profile, wanted: float, load: float) -> CohesiveEstimate:
    """The predictor of a contact whose attraction has a range [LU], known as far as an experiment needs.

    Raises:
        SettingsError: the attraction would reach past the body, or so little beyond the contact, by c − a = πE*h₀²/4W,
            that no digits show it.
    """
    least = math.sqrt(4.0 * RESOLVED * jkr.fixed_grips[0] * jkr.work / (math.pi * jkr.modulus))
    if reach < least:
        given, most = apart(reach, least)
        raise SettingsError(
            f"an adhesion.range of {given} LU is too short to be resolved beside this contact, at least {most} LU are "
            "needed: the contact is JKR's, which has none: leave adhesion.range out"
        )
    own = {one.name: getattr(jkr, one.name) for one in fields(jkr)} | {"range": reach, "surface": surface}
    end = CohesiveEstimate(**own | {"known": jkr.profile.reach}).law.widest()
    known = min(jkr.known, end)
    while True:
        estimate = CohesiveEstimate(**own | {"known": known})
        _, displacement, force = estimate.end
        if estimate.is_beyond(wanted, load) or (known == end and displacement >= wanted and force >= load):
            return estimate
        if known == end:
            raise covered(jkr.profile.reach)
        known = min(2.0 * known, end)
