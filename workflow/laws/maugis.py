"""The contact of a body whose attraction has a range (`dugdale`), before LAMMPS runs, and as the load of each cell.

Its states are one curve, from c = 0 over the touch of the apexes to wide contacts. Where d falls along it no state is
stable: a contact that is loaded goes on to the next place of the curve with its d, one that is unloaded to the one
before; there are any number of such limit points, or none but that of the attraction itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.digits import apart
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.dugdale import DOUBLINGS, Dugdale, Zone, covered
from contact1d.workflow.laws.jkr import Jkr
from contact1d.workflow.laws.path import Path, legs
from contact1d.workflow.laws.shape import Profile, Splined, beside_kinks
from contact1d.workflow.laws.zoned import Zoned, ZonedCells
from contact1d.workflow.scene import Adhesion, Scene

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
RESOLVED = 1e-9
"""Least way of the attraction beyond the contact over the radius under fixed grips. Measured: at 1e-10 forces are off
by 4e-7, and below that the curve is no longer monotonic."""
SAME = 1e-9
"""Fall of d over its range that is one: others are round-off."""
STIFF = 1e-3
"""Distance over the range of an attraction of two displacements whose forces give a stiffness."""
LOOKS = 4
"""Steps from the curve to a force by the equations."""


@dataclass(frozen=True, eq=False)
class Maugis(Zoned):
    """The curve of a contact whose attraction has a range.

    Attributes:
        range: h₀ [LU].
        table: the predictor's shape is that of the deck.
    """

    table = Splined
    beside = ("adhesive", "zone", "dmt")
    exact = ("zone",)

    range: float = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Of an attraction with a range."""
        return Jkr.applies(scene) and scene.the(Adhesion).range is not None

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Maugis:
        """See `Jkr`."""
        return _with_range(jkr, scene.the(Adhesion).range or 0.0, scene.bodies.profile, wanted, load)

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """The scene's."""
        return scene.the(Adhesion).range or assumed

    @classmethod
    def drawn(cls, scene: Scene, edge: float, reach: float) -> tuple[float, Callable[[Array], Array]]:
        """−σ₀ π (c² − a²), and (2σ₀/π) arctan √((c² − a²)/(a² − r²))."""
        adhesion, square = scene.the(Adhesion), (reach - edge) * (reach + edge)
        stress, root = adhesion.work / (adhesion.range or math.inf), math.sqrt(square)
        return (
            -stress * math.pi * square,
            lambda r: 2.0 / math.pi * stress * np.arctan2(root, np.sqrt((edge - r) * (edge + r))),
        )

    def particles(self, x: Array, deepest: float) -> MaugisCells:
        """See `Law`."""
        return MaugisCells(self, x, deepest)

    @cached_property
    def equations(self) -> Dugdale:
        """Its equations."""
        return Dugdale(self.profile, self.surface, self.modulus, self.work / self.range, self.range, self.known)

    @cached_property
    def _nodes(self) -> Zone:
        """Contacts at which the equations are solved, by rising a from 0 on, limit points among them."""
        least = FIRST * self.known
        edge = np.concatenate([np.linspace(0.0, least, NEAR, endpoint=False), np.geomspace(least, self.known, POINTS)])
        edge = beside_kinks(edge, self.profile)
        edge = np.unique(np.concatenate([edge, self._folds(edge)]))
        return self.equations.states(edge, self.equations.widths(edge))

    def _folds(self, edge: Array) -> Array:
        """a [LU] where d has an extremum, between those of its neighbours on a grid."""
        from scipy.optimize import elementwise

        d = self.equations.states(edge, self.equations.widths(edge)).displacement
        slope = np.sign(np.diff(d))
        turns = np.flatnonzero(slope[1:] != slope[:-1]) + 1
        if not turns.size:
            return turns.astype(np.float64)
        found = elementwise.find_minimum(
            lambda a, sign: sign * self.equations.states(a, self.equations.widths(a)).displacement,
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
        columns = [[none], [reach], [self.equations.before(reach)], [-math.pi * self.equations.stress * reach**2]]
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
        d = self.curve.displacement
        start = -math.inf if place == APART else float(np.interp(place, np.arange(d.size), d))
        every, found = np.append(start, displacements), np.full(displacements.size + 1, place)
        for leg in legs(every):
            before = max(leg.start - 1, 0)
            wanted, at = every[leg], int(max(found[before], 0.0))
            if wanted[-1] > every[before]:
                low = at + np.searchsorted(np.maximum.accumulate(d[at + 1 :]), wanted)
            else:
                low = at - np.searchsorted(-np.minimum.accumulate(d[at::-1]), -wanted)
            is_held = (low >= 0) & ((found[before] != APART) | (wanted >= d[0]))
            found[leg] = np.where(is_held, _between(d, np.clip(low, 0, d.size - 2), wanted), APART)
        return found[1:]

    def at(self, places: Array) -> Zone:
        """The states at places of the curve; bodies apart feel nothing, at a displacement that is not known."""
        number, held = np.arange(self.curve.edge.size, dtype=np.float64), places != APART
        return Zone(*(np.where(held, np.interp(places, number, one), 0.0) for one in vars(self.curve).values()))

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
                return self.equations.gap_error(
                    edge, np.maximum(self.profile.height(edge) - d, 0.0) / self.equations.ratio, d
                )

            ends = nodes.edge[low], nodes.edge[low + 1]
            found = elementwise.find_root(error, ends, args=(d,), maxiter=DOUBLINGS)
            nearer = np.where(np.abs(error(ends[0], d)) < np.abs(error(ends[1], d)), *ends)
            edge[touching] = np.where(found.success, found.x, nearer)
            width[touching] = np.maximum(self.profile.height(edge[touching]) - d, 0.0) / self.equations.ratio
        if near.any():
            d = displacements[near]
            low = np.clip(places[near].astype(np.intp), 0, BEFORE - 1)
            ends = self.curve.reach[low], self.curve.reach[low + 1]
            found = elementwise.find_root(lambda c, d: self.equations.before(c) - d, ends, args=(d,), maxiter=DOUBLINGS)
            width[near] = np.where(found.success, found.x, guess.reach[near])
        force = np.where(places == APART, 0.0, self.equations.forces(edge, width, displacements))
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
                places.append(float(_between(d, before, d[after])))
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
            return self.equations.states(edge, self.equations.widths(edge)).force

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

    def energy(self, displacement: float, radius: float) -> float:
        """See `energy_of`, of a contact that is unloaded from the widest."""
        width = (float(self.profile.height(np.asarray([radius]))[0]) - displacement) / self.equations.ratio
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
        drawn = 4.0 * self.equations.stress * float(np.trapezoid((self.profile.height(outer) - d) * root, outer))
        disc = c * c * (c - a) - (c**3 - a**3) / 3.0
        return pressed - 4.0 * self.equations.stress**2 / self.modulus * disc + drawn - math.pi * c * c * self.work

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

    @cached_property
    def _falls(self) -> list[int]:
        """How often the displacement falls along the curve, up to each of its points."""
        found: list[int] = np.cumsum(np.diff(self.curve.displacement, prepend=-np.inf) < 0.0).tolist()
        return found

    def lost_between(self, before: float, after: float) -> float:
        """Energy [FU·LU] that a contact loses as it jumps on its way from one place of the curve to another."""
        low, high = sorted((math.ceil(max(before, 0.0)), math.ceil(max(after, 0.0))))
        if self._falls[high] == self._falls[low]:
            return 0.0
        way = 1 if after > before else -1
        d = way * self.curve.displacement[low : high + 1][::way]
        least = SAME * float(np.ptp(self.curve.displacement))
        passed = np.maximum.accumulate(d)
        if (passed - d).max() < least:
            return 0.0
        top = int(np.argmax(passed == passed[int(np.argmax(passed - d >= least))]))
        place = float(low + top if way > 0 else high - top)
        beyond = self.places(np.asarray([way * (float(d[top]) + least)]), place)
        return self.energy_at(place) - self.energy_at(float(beyond[0]))


def _between(column: Array, low: NDArray[np.intp] | int, values: Array) -> Array:
    """The places of values, (m,), in the cells of a column that begin at `low`."""
    rise = column[low + 1] - column[low]
    share = np.divide(values - column[low], rise, out=np.zeros_like(rise), where=rise > 0.0)
    return np.asarray(low + np.clip(share, 0.0, 1.0))


def _with_range(jkr: Jkr, reach: float, surface: Profile, wanted: float, load: float) -> Maugis:
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
    end = Maugis(**own | {"known": jkr.profile.reach}).equations.widest()
    known = min(jkr.known, end)
    while True:
        estimate = Maugis(**own | {"known": known})
        _, displacement, force = estimate.end
        if estimate.is_beyond(wanted, load) or (known == end and displacement >= wanted and force >= load):
            return estimate
        if known == end:
            raise covered(jkr.profile.reach)
        known = min(2.0 * known, end)


@dataclass(frozen=True, eq=False)
class MaugisCells(ZonedCells):
    """The same where the attraction has a range."""

    law: Maugis

    @property
    def apart(self) -> float:
        """Where a contact that is unloaded feels nothing any more [LU]."""
        return float(self.law.held.displacement[0])

    def held(self, displacements: Array) -> Array:
        """F [FU] of a contact that is unloaded."""
        return self.law.contact_forces(displacements)

    def displacement_at(self, force: float) -> float:
        """By the equations, from the displacement between points of the curve on."""
        found, step = super().displacement_at(force), STIFF * self.law.range
        low, high = self.held(np.asarray([found - step, found + step])).tolist()
        for _ in range(LOOKS if high > low and found - step > self.apart else 0):
            found += (force - self.law.held_at(found)) * 2.0 * step / (high - low)
        return found

    @property
    def limits(self) -> tuple[float, ...]:
        """Where it jumps [LU]."""
        return self.law.limits

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Evenly in the radius, since a stiff contact is lost on a small part of the way, and beyond it in d."""
        own = self.law.held
        touching = own.edge > 0.0
        a, d = own.edge[touching], own.displacement[touching]
        rows = np.interp(np.linspace(float(np.interp(start, d, a)), float(a[0]), count + 1)[1:], a, d)
        beyond = np.linspace(float(d[0]), end, count // 2 + 1)[1:] if d[0] > end else np.asarray([])
        return np.append(rows[(rows < start) & (rows > end)], np.append(beyond, [] if beyond.size else [end]))

    def work(self, start: float, every: int) -> float:
        """By the points of the curve, which has kinks where the bodies touch and jumps."""
        d, force = self.law.held.displacement, self.law.held.force
        last = int(np.searchsorted(d, start))
        at, own = np.append(d[:last], start), np.append(force[:last], np.interp(start, d, force))
        chosen = np.unique([*range(0, at.size, every), at.size - 1])
        return -float(np.trapezoid(own[chosen], at[chosen]))

    def radii(self, displacements: Array) -> Array:
        """See `Particles.radii`."""
        return self.law.radii(displacements)

    @property
    def top(self) -> float:
        """See `Particles`; of one that comes before contact the place on the curve."""
        law, edge = self.law, np.asarray([self.law.critical_radius])
        if edge[0] > 0.0:
            return float(law.equations.states(edge, law.equations.widths(edge)).displacement[0])
        return float(law.held.displacement[int(np.argmin(law.held.force))])

    @property
    def critical_radius(self) -> float:
        """See `Particles.critical_radius`."""
        return self.law.critical_radius

    @property
    def jumps(self) -> tuple[float, ...]:
        """There, where a contact that is loaded jumps, and where the attraction begins."""
        return (*self.limits, *self.law.snaps_in, -self.law.range)

    def energies(self, path: Path) -> tuple[float, float]:
        """U(a, c, d) of Maugis; what it jumps by from one place of the curve to another."""
        places = self.law.places(path.displacement).tolist()
        lost = sum(self.law.lost_between(*way) for way in pairwise([APART, *places]))
        return self.law.energy_at(places[-1]), lost

    def prescribed(self, path: Path) -> dict[str, Array]:
        """With the edges of the contact, from limit point to limit point of the curve."""
        return self._edges_of(self.law.solved(path.displacement, self.law.places(path.displacement)))
