"""The contact of a body whose attraction has a range (`dugdale`), as a curve and as the load of each cell.

Its states are one curve, from c = 0 over the touch of the apexes to wide contacts. Where d falls along it no state is
stable: in loading the contact jumps to the next point of the curve with the same d, in unloading to the previous one.
There is any number of such limit points, or none but that of the attraction itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.digits import apart
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.dugdale import DOUBLINGS, Dugdale, Zone, covered
from contact1d.workflow.laws.jkr import POINTS, Jkr
from contact1d.workflow.laws.numerics import ROUND_OFF, value_at
from contact1d.workflow.laws.path import Array, Path, legs
from contact1d.workflow.laws.radius import WithRange
from contact1d.workflow.laws.shape import Profile, Splined, beside_kinks
from contact1d.workflow.laws.zoned import Zoned, ZonedCells
from contact1d.workflow.scene import Adhesion, Scene

BETWEEN = 10
"""Points of the curve for each solved contact, by cubics: their error is some 1e-8 of F."""
BEFORE = 1000
"""Points of the curve before contact, where d(c) is explicit."""
APART = -1.0
"""Position on the curve of bodies without a force between them."""


@dataclass(frozen=True, eq=False)
class Maugis(Zoned):
    """A contact whose attraction has a range, as a curve of states by rising a, or c before contact.

    A position on the curve is the index of a point, between two points a fraction; −1 stands for bodies without a force
    between them.

    Attributes:
        range: range h₀ of the attraction [LU].
        table: a profile that is smooth to 1e-12, since the deck uses the same one.
    """

    table = Splined
    rules = (WithRange, WithRange)
    closed_forms = ("adhesive", "zone", "dmt")
    exact = ("zone",)

    range: float = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether the scene has adhesion with a range."""
        return Jkr.applies(scene) and scene.the(Adhesion).range is not None

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Maugis:
        """Return the contact with the scene's range, computed up to a displacement `wanted` [LU] and a load [FU].

        `jkr`: the same contact without a range.

        Raises:
            SettingsError: the attraction would exceed the body, or its range is too short to be resolved.
        """
        return _with_range(jkr, scene.the(Adhesion).range or 0.0, scene.bodies.profile, wanted, load)

    @classmethod
    def range_of(cls, scene: Scene, assumed: float) -> float:
        """Return the range h₀ of the scene's adhesion [LU], `assumed` [LU] where it gives none."""
        return scene.the(Adhesion).range or assumed

    @classmethod
    def cohesive_load(cls, scene: Scene, edge: float, reach: float) -> tuple[float, Callable[[Array], Array]]:
        """Return (force of the attraction beyond the contact edge, −π σ₀ (c² − a²) [FU] ≤ 0, function of the tension
        inside).

        The function gives (2σ₀/π) arctan √((c² − a²)/(a² − r²)) [FU/LU²] ≥ 0 at radii r ≤ a, (n,) [LU].

        Args:
            scene: whose adhesion it is; without a range σ₀ is 0.
            edge: contact radius a [LU].
            reach: radius c ≥ a up to which the attraction acts [LU].
        """
        adhesion, square = scene.the(Adhesion), (reach - edge) * (reach + edge)
        stress, root = adhesion.work / (adhesion.range or math.inf), math.sqrt(square)
        return (
            -stress * math.pi * square,
            lambda r: 2.0 / math.pi * stress * np.arctan2(root, np.sqrt((edge - r) * (edge + r))),
        )

    def particles(self, x: Array, deepest: float) -> MaugisCells:
        """Return the cells at positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""
        return MaugisCells(self, x, deepest)

    @cached_property
    def equations(self) -> Dugdale:
        """Equations of the contact with the attraction σ₀ = W/h₀."""
        return Dugdale(self.profile, self.surface, self.modulus, self.work / self.range, self.range, self.known)

    @cached_property
    def _nodes(self) -> Zone:
        """States (a, c, d, F) at which the equations are solved, by rising contact radius a from 0 to the largest one,
        `known`.

        Radii at which d has an extremum are among them.
        """
        first = 1e-3 * self.known
        edge = np.concatenate([np.linspace(0.0, first, 40, endpoint=False), np.geomspace(first, self.known, 400)])
        edge = beside_kinks(edge, self._corners)
        edge = np.unique(np.concatenate([edge, self._folds(edge)]))
        return self.equations.equilibria(edge)

    @cached_property
    def _corners(self) -> tuple[float, ...]:
        """Contact radii [LU], rising, at which the contact or its attraction ends at a kink of the body; cached."""
        kinks = np.asarray(self.profile.kinks)
        return tuple(sorted(edge for edge in (*kinks, *self.equations.edges(kinks)) if edge < self.known))

    def _folds(self, edge: Array) -> Array:
        """Return the contact radii, (k,) [LU], at which d has an extremum along a rising grid `edge` of them, (n,)
        [LU].

        Empty without any.
        """
        from scipy.optimize import elementwise

        d = self.equations.equilibria(edge).displacement
        slope = np.sign(np.diff(d))
        turns = np.flatnonzero(slope[1:] != slope[:-1]) + 1
        if not turns.size:
            return turns.astype(np.float64)
        extrema = elementwise.find_minimum(
            lambda a, sign: sign * self.equations.equilibria(a).displacement,
            (edge[turns - 1], edge[turns], edge[turns + 1]),
            args=(np.sign(slope[turns]),),
        )
        return np.asarray(extrema.x)

    @cached_property
    def curve(self) -> Zone:
        """All states (a, c, d, F) from c = 0 on, (n,) each: first a = 0 with rising c, before contact, then by rising
        a.

        a is the contact radius, c that up to which the attraction acts [LU]. States before contact are explicit, those
        in contact by cubics between solved ones. d rises and falls along the curve.
        """
        from scipy.interpolate import CubicSpline

        nodes = self._nodes
        reach = nodes.reach[0] * np.linspace(0.0, 1.0, BEFORE, endpoint=False)
        untouched = np.zeros_like(reach)
        columns = [[untouched], [reach], [self.equations.before(reach)], [-math.pi * self.equations.stress * reach**2]]
        # Each stretch between kinks has its own cubics: beyond a kink d rises as a root.
        ends = [0, *np.searchsorted(nodes.edge, self._corners), nodes.edge.size - 1]
        for first, last in pairwise(ends):
            stretch, number = slice(first, last + 1), np.arange(last - first + 1.0)
            edge = np.interp(np.linspace(0.0, last - first, BETWEEN * (last - first) + 1), number, nodes.edge[stretch])
            start = 0 if first == 0 else 1
            columns[0].append(edge[start:])
            for column, values in zip(columns[1:], list(vars(nodes).values())[1:], strict=True):
                column.append(CubicSpline(nodes.edge[stretch], values[stretch])(edge[start:]))
        return Zone(*map(np.concatenate, columns))

    def positions(self, displacements: Array, start: float = APART) -> Array:
        """Return the positions on the curve of states, (m,), of a contact that goes along displacements (m,) [LU].

        A position is the index of a point of `curve`, with a fraction between two points; −1 stands for separated
        bodies. The contact begins at the position `start`, by default separated. Where d turns along the curve it jumps
        to the position with the same d that is next in loading, and previous in unloading: −1 if there is none.
        Separated bodies stay so until d reaches −h₀, where the attraction begins. For d beyond the last point of the
        curve the position is that point.
        """
        d = self.curve.displacement
        first = -math.inf if start == APART else float(np.interp(start, np.arange(d.size), d))
        path, positions = np.append(first, displacements), np.full(displacements.size + 1, start)
        for leg in legs(path):
            before = max(leg.start - 1, 0)
            wanted, point = path[leg], int(max(positions[before], 0.0))
            if wanted[-1] > path[before]:
                low = point + np.searchsorted(np.maximum.accumulate(d[point + 1 :]), wanted)
            else:
                low = point - np.searchsorted(-np.minimum.accumulate(d[point::-1]), -wanted)
            is_held = (low >= 0) & ((positions[before] != APART) | (wanted >= d[0]))
            positions[leg] = np.where(is_held, _between(d, np.clip(low, 0, d.size - 2), wanted), APART)
        return positions[1:]

    def states_at(self, positions: Array) -> Zone:
        """Return the states (a, c, d, F), (m,) each, at positions on the curve, (m,), linear between its points.

        A position is the index of a point of `curve`, with a fraction; at −1, of separated bodies, all columns are 0, d
        too.
        """
        number, held = np.arange(self.curve.edge.size, dtype=np.float64), positions != APART
        columns = vars(self.curve).values()
        return Zone(*(np.where(held, np.interp(positions, number, column), 0.0) for column in columns))

    def solved(self, displacements: Array, positions: Array) -> Zone:
        """Return the states (a, c, d, F), (m,) each, at displacements (m,) [LU], solved to all digits.

        `positions`: index of the nearest point of `curve` with a fraction, (m,), or −1 of separated bodies, of which a,
        c and F are 0. Where no solution is found, a is that of the solved contact next to it, with c by a and d; before
        contact c is linear in the curve. d is as given in any case.
        """
        guess = self.states_at(positions)
        edge, width = np.zeros_like(displacements), np.zeros_like(displacements)
        touching, attracted = guess.edge > 0.0, (guess.edge == 0.0) & (positions != APART)
        if touching.any():
            edge[touching], width[touching] = self._touching(displacements[touching], positions[touching])
        if attracted.any():
            root, success = self._attracted(displacements[attracted], positions[attracted])
            width[attracted] = np.where(success, root, guess.reach[attracted])
        force = np.where(positions == APART, 0.0, self.equations.forces(edge, width, displacements))
        return Zone(edge, np.hypot(edge, width), displacements, force)

    def _touching(self, displacements: Array, positions: Array) -> tuple[Array, Array]:
        """Return (a, s = √(c² − a²)), (m,) [LU] each, of contacts in equilibrium at displacements (m,) [LU].

        `positions`: index of a near point of `curve` with a fraction, (m,). Where no solution is found, a is that of
        the solved contact next to it.
        """
        from scipy.optimize import elementwise

        nodes = self._nodes
        low = np.clip((positions - BEFORE) // BETWEEN, 0, nodes.edge.size - 2).astype(np.intp)
        low -= (nodes.displacement[low] > displacements) & (low > 0)
        low += (nodes.displacement[low + 1] < displacements) & (low < nodes.edge.size - 2)

        def width(edge: Array, d: Array) -> Array:
            """Return s = √(c² − a²), (m,) [LU], at a and d, (m,) [LU], without a singular stress at a; 0 where d >
            g(a).
            """
            return np.maximum(self.profile.height(edge) - d, 0.0) / self.equations.ratio

        def error(edge: Array, d: Array) -> Array:
            """Return the gap at c less the range, (m,) [LU]."""
            return self.equations.gap_error(edge, width(edge, d), d)

        low_end, high_end = nodes.edge[low], nodes.edge[low + 1]
        root = elementwise.find_root(error, (low_end, high_end), args=(displacements,), maxiter=DOUBLINGS)
        is_low = np.abs(error(low_end, displacements)) < np.abs(error(high_end, displacements))
        edge = np.where(root.success, root.x, np.where(is_low, low_end, high_end))
        return edge, width(edge, displacements)

    def _attracted(self, displacements: Array, positions: Array) -> tuple[Array, NDArray[np.bool_]]:
        """Return (c, whether it was found), (m,) each, of bodies that attract each other up to c [LU] and do not touch.

        `displacements`: (m,) [LU]; `positions`: index of a near point of `curve` before contact, with a fraction, (m,).
        """
        from scipy.optimize import elementwise

        low = np.clip(positions.astype(np.intp), 0, BEFORE - 1)
        ends = self.curve.reach[low], self.curve.reach[low + 1]
        root = elementwise.find_root(
            lambda c, d: self.equations.before(c) - d, ends, args=(displacements,), maxiter=DOUBLINGS
        )
        return np.asarray(root.x), np.asarray(root.success)

    def held_at(self, displacement: float) -> float:
        """Return F [FU], compression positive, at a displacement [LU] in unloading from the widest contact.

        It is solved to all digits. The displacement must not be below that at which the contact is lost.
        """
        position = np.interp(displacement, self.held.displacement, self._unloaded[0])
        return float(self.solved(np.asarray([displacement]), np.atleast_1d(position)).force[0])

    # --- interface of a predictor

    @cached_property
    def _round_off(self) -> float:
        """Fall of d along the curve [LU] that counts as round-off."""
        return ROUND_OFF * float(np.ptp(self.curve.displacement))

    @cached_property
    def _unloaded(self) -> tuple[list[float], list[float]]:
        """(Positions on the curve in unloading from the widest contact, displacements [LU] at which it jumps), both
        rising.

        A position is the index of a point of `curve`, with a fraction; both ends of a jump are among them. The first
        displacement is that at which the contact is lost, unless the curve is passed down to c = 0.
        """
        d = self.curve.displacement
        passed = np.flatnonzero(d <= np.append(np.minimum.accumulate(d[::-1])[::-1][1:], np.inf)).tolist()
        positions, jumps = [float(passed[0])], list[float]()
        for before, after in pairwise(passed):
            if after > before + 1 and d[before + 1 : after].max() > d[after] + self._round_off:
                positions.append(float(_between(d, before, d[after])))
                jumps.append(float(d[after]))
            positions.append(float(after))
        return positions, jumps if passed[0] == 0 else [float(d[passed[0]]), *jumps]

    @cached_property
    def held(self) -> Zone:
        """States (a, c, d, F), (k,) each, of a contact that is unloaded from the widest one, by rising d."""
        return self.states_at(np.asarray(self._unloaded[0]))

    @cached_property
    def _grid(self) -> tuple[Array, Array, Array, int]:
        """(Contact radii a [LU], displacements d [LU], forces F [FU] in unloading from the widest contact, by rising d;
        0).

        0 is the index of the least d. Compression is positive.
        """
        return self.held.edge, self.held.displacement, self.held.force, 0

    @property
    def limits(self) -> tuple[float, ...]:
        """Displacements [LU] at which a contact that is unloaded jumps, rising; empty where it never does.

        The first is that at which the contact is lost, unless its force falls to 0 without a jump.
        """
        return tuple(self._unloaded[1])

    @cached_property
    def critical_radius(self) -> float:
        """Contact radius [LU] at the force maximum; 0 where that comes before contact.

        Where the force maximum is at the end of the computed curve, the radius there.
        """
        from scipy.optimize import elementwise

        nodes = self._nodes
        peak = int(np.argmin(nodes.force))
        if not 0 < peak < nodes.edge.size - 1:
            return float(nodes.edge[peak])

        def force(edge: Array) -> Array:
            """Return F, (m,) [FU], in equilibrium at radii a, (m,) [LU]."""
            return self.equations.equilibria(edge).force

        maximum = elementwise.find_minimum(force, tuple(nodes.edge[peak + i : peak + i + 1] for i in (-1, 0, 1)))
        return float(maximum.x[0])

    def half_widths(self, displacements: Array, gap: float) -> Array:
        """Return the radii c(d) up to which bodies attract each other in unloading, (m,) [LU]; one spacing at least.

        `displacements`: (m,) [LU]. The radii are the same for any `gap`, which is not used.
        """
        return np.maximum(self.spacing, self.reaches(displacements))

    def reaches(self, displacements: Array) -> Array:
        """Return the radii c(d) up to which the attraction acts, (m,) [LU], in unloading, at displacements (m,) [LU].

        Beyond the ends of the computed curve those at the ends, also where the contact is lost.
        """
        return np.interp(displacements, self.held.displacement, self.held.reach)

    def require_one_edge(self) -> None:
        """Do nothing, and accept any profile: where the edge would jump, the curve of states has a limit point."""

    def energy(self, displacement: float, radius: float) -> float:
        """Return the energy [FU·LU] of a contact in unloading, of a `radius` a [LU] at a displacement [LU].

        It is relative to separated bodies, and 0 below the displacement at which the contact is lost. For a = 0 the
        bodies attract each other without contact.
        """
        width = (value_at(self.profile.height, radius) - displacement) / self.equations.ratio
        c = math.hypot(radius, width) if radius > 0.0 else value_at(self.reaches, displacement)
        return 0.0 if displacement < self.held.displacement[0] else self.energy_of(radius, c, displacement)

    def energy_of(self, a: float, c: float, d: float) -> float:
        """Return the energy [FU·LU] of a state with contact radius a, radius c of the attraction and displacement d
        [LU].

        0 of separated bodies, c = 0; else it is

        E* ∫₀ᵃ (d−g)² dx − (4σ₀²/E*) ∫ₐᶜ (c²−x²) dx + 4σ₀ ∫ₐᶜ (g−d) √(c²−x²) dx − πc²W
        """
        if c == 0.0:
            return 0.0
        inner = np.linspace(0.0, a, POINTS)
        outer = c * np.sin(np.linspace(math.asin(a / c), 0.5 * math.pi, POINTS))
        pressed = self.modulus * float(np.trapezoid((d - self.profile.height(inner)) ** 2, inner))
        root = np.sqrt((c - outer) * (c + outer))
        attraction = 4.0 * self.equations.stress * float(np.trapezoid((self.profile.height(outer) - d) * root, outer))
        disc = c * c * (c - a) - (c**3 - a**3) / 3.0
        return pressed - 4.0 * self.equations.stress**2 / self.modulus * disc + attraction - math.pi * c * c * self.work

    def energy_at(self, position: float) -> float:
        """Return the energy [FU·LU] of the state at a position on the curve, relative to separated bodies.

        A position is the index of a point of `curve`, with a fraction; 0 at −1, of separated bodies.
        """
        zone = self.states_at(np.asarray([position]))
        return self.energy_of(*(float(column[0]) for column in (zone.edge, zone.reach, zone.displacement)))

    @cached_property
    def snaps_in(self) -> list[float]:
        """Displacements [LU] at which a contact that is loaded jumps, rising; empty where it never does.

        −h₀, where the attraction begins, is among them where d falls along the curve from there on.
        """
        d = self.curve.displacement
        passed = np.flatnonzero(d >= np.maximum.accumulate(d))
        return [float(d[a]) for a, b in pairwise(passed) if d[a + 1 : b].min(initial=np.inf) < d[a] - self._round_off]

    @cached_property
    def _falls(self) -> list[int]:
        """Number of steps along the curve up to each of its points in which the displacement falls, (n,)."""
        falls: list[int] = np.cumsum(np.diff(self.curve.displacement, prepend=-np.inf) < 0.0).tolist()
        return falls

    def lost_between(self, before: float, after: float) -> float:
        """Return the energy [FU·LU] that a jump between two positions on the curve dissipates.

        A position is the index of a point of `curve`, with a fraction; −1, of separated bodies, counts as 0. The jump
        goes from the first limit point, from `before` on, to where the contact arrives at the same d; the energy is the
        difference of these two states. 0 where d is monotonic between the positions but for round-off.
        """
        low, high = sorted((math.ceil(max(before, 0.0)), math.ceil(max(after, 0.0))))
        if self._falls[high] == self._falls[low]:
            return 0.0
        direction = 1 if after > before else -1
        d = direction * self.curve.displacement[low : high + 1][::direction]
        passed = np.maximum.accumulate(d)
        if (passed - d).max() < self._round_off:
            return 0.0
        limit = int(np.argmax(passed == passed[int(np.argmax(passed - d >= self._round_off))]))
        position = float(low + limit if direction > 0 else high - limit)
        beyond = self.positions(np.asarray([direction * (float(d[limit]) + self._round_off)]), position)
        return self.energy_at(position) - self.energy_at(float(beyond[0]))


def _between(column: Array, low: NDArray[np.intp] | int, values: Array) -> Array:
    """Return the positions, (m,), of `values`, (m,), in a `column` of the curve: index plus a fraction 0 … 1.

    `low`: index of the point below each value; a value outside of the interval has the fraction 0 or 1. Where the
    column does not rise from it to the next, the fraction is 0.
    """
    rise = column[low + 1] - column[low]
    share = np.divide(values - column[low], rise, out=np.zeros_like(rise), where=rise > 0.0)
    return low + np.clip(share, 0.0, 1.0)


def _with_range(jkr: Jkr, reach: float, surface: Profile, wanted: float, load: float) -> Maugis:
    """Return the law of an attraction of a range `reach` [LU], with its curve computed as far as an experiment needs.

    Args:
        jkr: the same contact without a range.
        reach: range h₀ [LU].
        surface: actual profile.
        wanted: displacement that the curve must include [LU].
        load: force that it must include [FU].

    Raises:
        SettingsError: the attraction would exceed the body, or its width beyond the contact, c − a = πE*h₀²/4W, is too
            small to be resolved.
    """
    # Over the radius under fixed grips. Measured: at 1e-10 forces are off by 4e-7, and below that the curve is not
    # monotonic.
    least_width = 1e-9
    least = math.sqrt(4.0 * least_width * jkr.fixed_grips[0] * jkr.work / (math.pi * jkr.modulus))
    if reach < least:
        given, most = apart(reach, least)
        raise SettingsError(
            f"an adhesion.range of {given} LU is too short to be resolved beside this contact, at least {most} LU are "
            "needed: the contact is JKR's, which has none: leave adhesion.range out"
        )
    parameters = jkr.parameters | {"range": reach, "surface": surface}
    end = Maugis(**parameters | {"known": jkr.profile.reach}).equations.widest()
    known = min(jkr.known, end)
    while True:
        law = Maugis(**parameters | {"known": known})
        _, displacement, force = law.end
        if law.is_beyond(wanted, load) or (known == end and displacement >= wanted and force >= load):
            return law
        if known == end:
            raise covered(jkr.profile.reach)
        known = min(2.0 * known, end)


@dataclass(frozen=True, eq=False)
class MaugisCells(ZonedCells):
    """The cells of a chain on a rigid plane, with an attraction that has a range."""

    law: Maugis

    def held(self, displacements: Array) -> Array:
        """Return F of the continuous contact, (m,) [FU], compression positive, in unloading, at displacements (m,)
        [LU].

        0 below the displacement at which it is lost; beyond the computed curve the force at its end.
        """
        return self.law.contact_forces(displacements)

    def displacement_at(self, force: float) -> float:
        """Return the largest displacement [LU] that carries a force [FU], compression positive, in unloading, by four
        Newton steps.

        These start from the curve, and are left out where the force does not rise or the contact is about to be lost. A
        tension above the pull-off force has no solution, and the steps may lead far away.
        """
        displacement, step = super().displacement_at(force), 1e-3 * self.law.range
        low, high = self.held(np.asarray([displacement - step, displacement + step])).tolist()
        for _ in range(4 if high > low and displacement - step > self.apart else 0):
            displacement += (force - self.law.held_at(displacement)) * 2.0 * step / (high - low)
        return displacement

    @property
    def limits(self) -> tuple[float, ...]:
        """Displacements [LU] at which a contact that is unloaded jumps, rising; empty where it never does.

        The first is that at which the contact is lost, unless its force falls to 0 without a jump.
        """
        return self.law.limits

    def unloading(self, start: float, end: float, count: int) -> Array:
        """Return the falling displacements, (k,) [LU], of load steps in unloading from `start` to `end` [LU].

        The start is not among them, the end is the last. They are at `count` equal steps of the contact radius down to
        0, or to that at which the contact is lost: a stiff contact is lost in a small part of the displacement. Those
        at or below `end` are left out. Where all are above it, `count` // 2 at equal steps of d follow down to it.
        """
        touching = self.law.held.edge > 0.0
        a, d = self.law.held.edge[touching], self.law.held.displacement[touching]
        steps = np.interp(np.linspace(float(np.interp(start, d, a)), float(a[0]), count + 1)[1:], a, d)
        beyond = np.linspace(float(d[0]), end, count // 2 + 1)[1:] if d[0] > end else np.asarray([])
        return np.append(steps[(steps < start) & (steps > end)], np.append(beyond, [] if beyond.size else [end]))

    def work(self, start: float, every: int) -> float:
        """Return ∫ −F dd [FU·LU] in unloading from `start` [LU] to where the contact is lost, positive where tension
        prevails.

        By the trapezoidal rule over the points of the curve in unloading, both ends of its jumps included; of all these
        points one of `every` so many, from the least d on, and the start.
        """
        d, force = self.law.held.displacement, self.law.held.force
        last = int(np.searchsorted(d, start))
        force = np.append(force[:last], np.interp(start, d, force))
        d = np.append(d[:last], start)
        chosen = np.unique([*range(0, d.size, every), d.size - 1])
        return -float(np.trapezoid(force[chosen], d[chosen]))

    def radii(self, displacements: Array) -> Array:
        """Return the contact radii (m,) [LU] in unloading, at displacements (m,) [LU]; 0 of bodies that attract without
        contact.

        Below the displacement at which the contact is lost it is the radius there, beyond the computed curve that at
        its end.
        """
        return self.law.radii(displacements)

    @property
    def critical_displacement(self) -> float:
        """Displacement [LU] of the largest tension: that of the solved contact, or where it comes before contact, that
        of a point of the curve in unloading.
        """
        law, edge = self.law, np.asarray([self.law.critical_radius])
        if edge[0] > 0.0:
            return float(law.equations.equilibria(edge).displacement[0])
        return float(law.held.displacement[int(np.argmin(law.held.force))])

    @property
    def critical_radius(self) -> float:
        """Contact radius [LU] at the force maximum; 0 where that comes before contact, and that at the end of a curve
        that ends before it.
        """
        return self.law.critical_radius

    @property
    def jumps(self) -> tuple[float, ...]:
        """Displacements [LU] of jumps of the force: in unloading, in loading, and −h₀, where the attraction begins.

        They are not sorted, and −h₀ may be there twice.
        """
        return (*self.limits, *self.law.snaps_in, -self.law.range)

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (energy at the end of a path, energy lost in jumps along it), both [FU·LU].

        The path begins with separated bodies, whose energy is 0.
        """
        positions = self.law.positions(path.displacement).tolist()
        lost = sum(self.law.lost_between(*jump) for jump in pairwise([APART, *positions]))
        return self.law.energy_at(positions[-1]), lost

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the columns of load steps by name, (m,) [LU] each: "displacement" d, "edge" a, "reach" c and "height".

        a is the contact radius, c that up to which the attraction acts, 0 both of separated bodies. States follow the
        curve and its jumps on a `path` that begins with separated bodies. The height is the mean of the transformed
        profile over the contact, 0 where a = 0.
        """
        return self._edges_of(self.law.solved(path.displacement, self.law.positions(path.displacement)))
