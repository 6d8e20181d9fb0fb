"""The JKR contact with an edge that recedes at a finite speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial
from itertools import pairwise

import numpy as np

from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.dugdale import Dugdale, Zone
from contact1d.workflow.laws.jkr import Jkr
from contact1d.workflow.laws.numerics import ROUND_OFF, value_at
from contact1d.workflow.laws.path import Array, History, Path
from contact1d.workflow.laws.zoned import Zoned, ZonedCells
from contact1d.workflow.scene import Adhesion, Rate, Scene


@dataclass(frozen=True, eq=False)
class Receding(Zoned):
    """The JKR contact with an edge that recedes at a finite speed and advances at once.

    G = E* (g(a) − d)²/(2πa),    −da/dt = v₀ (G/W − 1)^(1/n)  where G > W,    F = 2E* ∫₀ᵃ (d − g) dx

    Source: D. Maugis, M. Barquins, J. Phys. D 11 (1978) 1989.

    Attributes:
        rate: velocity v₀ [LU/TU] and exponent n of the receding edge.
    """

    in_time = True
    exact = ()

    rate: Rate = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Return whether the scene has adhesion with a rate."""
        return Jkr.applies(scene) and scene.the(Adhesion).rate is not None

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Receding:
        """Return the contact with the scene's rate of the edge, whose curve goes as far as that of `jkr`.

        `wanted` and `load` are not used.

        Raises:
            SettingsError: the experiment is so slow that the contact is JKR's, (v/v₀)ⁿ < 1e-8 with its velocity v.
        """
        rate = scene.the(Adhesion).rate
        assert rate
        speed = getattr(scene.experiment, "velocity", None) or rate.velocity
        least_excess = 1e-8  # (v/v₀)ⁿ of G over W
        if (more := (speed / rate.velocity) ** rate.exponent) < least_excess:
            raise SettingsError(
                f"the contact is JKR's within {more:.1g}: an adhesion.rate whose velocity is so far above "
                f"experiment.velocity, {speed:.4g} LU/TU, changes nothing that is resolved: leave it out"
            )
        return cls(**jkr.parameters, surface=scene.bodies.profile, rate=rate)

    def particles(self, x: Array, deepest: float) -> RecedingCells:
        """Return the cells at positions x, (n,) [LU]; `deepest`: largest expected displacement [LU]."""
        return RecedingCells(self, x, deepest)

    @cached_property
    def equations(self) -> Dugdale:
        """Equations of the contact edge, F and line load, without an attraction beyond the edge."""
        return Dugdale(self.profile, self.surface, self.modulus, 0.0, self.known, self.known)

    def radii(self, displacements: Array) -> Array:
        """Return the contact radii a(d) in equilibrium, (m,) [LU], at displacements (m,) [LU], solved between points of
        the curve.

        Where no solution is found, by linear interpolation in the curve: below pull-off under fixed grips the radius
        there, beyond the end of the curve that at its end.
        """
        from scipy.optimize import elementwise

        x, h, _, least = self._grid
        cell = np.clip(np.searchsorted(h[least:], displacements), 1, h.size - least - 1) + least
        ends = x[cell - 1], x[cell]

        def error(edge: Array, d: Array) -> Array:
            """Return h(a) − d, (m,) [LU]; 0 in equilibrium."""
            return self.opened(edge) - d

        root = elementwise.find_root(error, ends, args=(displacements,))
        return np.where(root.success, root.x, super().radii(displacements))

    def _edge_velocity(self, edge: float, displacement: float) -> float:
        """Return the edge velocity da/dt ≤ 0 [LU/TU] at a contact radius `edge` > 0 and a displacement [LU].

        0 where the energy release rate is at most the work of adhesion, or where the edge is pressed, d ≥ g(a).
        """
        opened = value_at(self.profile.height, edge) - displacement
        excess = self.modulus * opened * opened / (2.0 * math.pi * edge * self.work) - 1.0
        return -self.rate.velocity * excess ** (1.0 / self.rate.exponent) if excess > 0.0 and opened > 0.0 else 0.0

    def _receding(self, edge: float, displacement_at: Callable[[float], float], times: Array) -> Array:
        """Return contact radii a, (m,) [LU], of an edge that recedes by its rate law at times (m,) [TU].

        0 from where a is at most 1e-3 of the radius at pull-off under fixed grips: the contact is lost.

        Args:
            edge: contact radius at the first time [LU], > 0.
            displacement_at: function of the time [TU]: the displacement [LU].
            times: rising [TU].
        """
        from scipy.integrate import solve_ivp

        lost = 1e-3  # radius over that under fixed grips
        least = lost * self.fixed_grips[0]

        def change(time: float, log: Array) -> list[float]:
            # A lost edge is slowed down by a high power, since an end of the motion might not be detected; a trial step
            # may go far beyond.
            """Return [rate of ln a [1/TU]] at a time [TU], by [ln a], a in LU.

            Well below the radius at which the contact is lost it falls to 0.
            """
            radius = max(math.exp(float(log[0])), lost * least)
            return [self._edge_velocity(radius, displacement_at(time)) / radius / (1.0 + (0.5 * least / radius) ** 12)]

        ends, start = (float(times[0]), float(times[-1])), [math.log(edge)]
        radii = np.exp(solve_ivp(change, ends, start, "LSODA", times, rtol=1e-11, atol=1e-11).y[0])
        return np.where(np.maximum.accumulate(radii <= least), 0.0, radii)

    def edges(self, times: Array, displacements: Array) -> Array:
        """Return contact radii a, (m,) [LU], at times (m,) [TU] along displacements (m,) [LU].

        The path begins with separated bodies, and is linear in between. The bodies touch at the displacement 0. Radii
        are 0 before the first touch and from pull-off to the next touch; an edge that advances is in equilibrium, also
        below 0 if it has not been lost.
        """
        radii, edge, turns = np.zeros_like(times), 0.0, np.flatnonzero(np.diff(np.sign(np.diff(displacements)))) + 1
        for first, last in pairwise([0, *turns.tolist(), times.size - 1]):
            leg = slice(first, last + 1)
            d = displacements[leg]
            kept = np.full_like(d, edge)
            if d.size > 1 and edge > 0.0:  # an edge may recede also while the body approaches
                kept = self._receding(edge, partial(np.interp, xp=times[leg], fp=d), times[leg])
            if d[-1] > d[0] or edge == 0.0:
                held = (kept > 0.0) & (d >= self.fixed_grips[1])
                held |= np.maximum.accumulate(d >= -ROUND_OFF * self.spacing)
                kept = np.where(held, np.maximum(kept, self.radii(d)), kept)
            radii[leg] = kept
            edge = float(kept[-1])
        return radii

    def pull_off_times(self, start: float, velocity: float, count: int) -> Array:
        """Return rising times [TU] from 0 on of a pull from equilibrium at a constant velocity, up to separation.

        They are `count` times at equal intervals of the contact radius, from the start to the last one found with
        contact, and `count` at equal intervals of time between the same two, without repetition. After these one more
        follows, the first one found without contact.

        Args:
            start: displacement at the time 0 [LU].
            velocity: of the pull [LU/TU], > 0.
            count: number of times of each kind, both ends included.
        """
        edge, least = value_at(self.radii, start), self.fixed_grips[1]
        end = (start - least) / velocity
        while True:
            times = np.linspace(0.0, end, 4000)
            radii = self._receding(edge, lambda time: start - velocity * time, times)
            if radii[-1] == 0.0:
                break
            end *= 2.0
        held = radii > 0.0
        moments = np.interp(-np.linspace(edge, radii[held][-1], count), -radii[held], times[held])
        return np.append(np.union1d(moments, np.linspace(0.0, moments[-1], count)), times[~held][0])


@dataclass(frozen=True, eq=False)
class RecedingCells(ZonedCells):
    """The cells of a chain on a rigid plane, in a contact whose edge recedes at a finite speed."""

    law: Receding

    dense = 4

    def held(self, displacements: Array) -> Array:
        """Return F of the continuous contact in equilibrium, (m,) [FU], compression positive, at displacements (m,)
        [LU].

        0 below the displacement of pull-off under fixed grips.
        """
        edge = self.law.radii(displacements)
        forces = self.law.equations.forces(edge, np.zeros_like(edge), displacements)
        return np.where(displacements >= self.apart, forces, 0.0)

    def zone(self, path: Path) -> Zone:
        """Return the states (a, c = a, d, F), (m,) each, of a path that begins with separated bodies.

        The contact radius a [LU] is also the radius c of the attraction, 0 without contact; F [FU] is positive in
        compression.
        """
        edge = self.law.edges(path.time, path.displacement)
        no_width = np.zeros_like(edge)
        return Zone(edge, edge, path.displacement, self.law.equations.forces(edge, no_width, path.displacement))

    def energies(self, path: Path) -> tuple[float, float]:
        """Return (U(d, a) of JKR at the end of a path, energy lost along it), both [FU·LU].

        The path begins with separated bodies, whose U is 0. Losses are ∫ (G − W) 2πa da at a receding edge, and the
        jumps of U at touch and pull-off.
        """
        law, zone = self.law, self.zone(path)
        a, d = zone.edge, zone.displacement
        opened = law.profile.height(a) - d
        excess = law.modulus * opened**2 - 2.0 * math.pi * a * law.work
        receded = np.minimum(np.diff(a), 0.0) * (a[1:] > 0.0)
        lost = -float(np.sum(0.5 * (excess[1:] + excess[:-1]) * receded))
        energies = [0.0, *(law.energy(float(d[i]), float(a[i])) for i in range(a.size))]
        jumps = np.flatnonzero(np.diff(a > 0.0, prepend=False))
        return energies[-1], lost + sum(energies[jump] - energies[jump + 1] for jump in jumps.tolist())

    def moments(self, deepest: float, velocity: float, count: int) -> Array:
        """Return the rising times [TU] from 0 on of load steps of a pull-off from `deepest` [LU] at a `velocity`
        [LU/TU].

        They are `count` times at equal intervals of the contact radius, from the start to the last one found with
        contact, and `count` at equal intervals of time between the same two, without repetition. After these one more
        follows, the first one found without contact.
        """
        return self.law.pull_off_times(deepest, velocity, count)

    def refined(self, history: History) -> History:
        """Return a history with further moments on both sides of a touch, and at equal steps of an edge that recedes.

        `history`: of displacements; all its moments remain. A touch is a passage of the displacement 0, in either
        direction; a step of the edge is 0.01 of the largest contact radius.
        """
        looks = 20  # edges computed from one moment to the next
        edge_step = 0.01  # over the largest radius
        history = history.refined_at([0.0])  # the bodies touch at once
        steps = np.linspace(0.0, len(history.phases) - 1.0, (len(history.phases) - 1) * looks + 1)
        columns = history.time, history.values
        time, values = (np.interp(steps, np.arange(len(history.phases)), column) for column in columns)
        edge = self.law.edges(time, values)
        passed = np.append(0.0, np.cumsum(np.maximum(-np.diff(edge), 0.0))) / (float(edge.max()) or 1.0)
        more = np.interp(np.arange(edge_step, float(passed[-1]), edge_step), passed, steps)
        return history.resampled(np.union1d(np.arange(float(len(history.phases))), more))

    def prescribed(self, path: Path) -> dict[str, Array]:
        """Return the columns of load steps by name, (m,) [LU] each: "displacement" d, "edge" a, "reach" and "height".

        a is the contact radius, 0 without contact, and the attraction ends there, so that the reach is a, too. The
        height is the mean of the transformed profile over the contact, 0 where a = 0. The path begins with separated
        bodies.
        """
        return self._edges_of(self.zone(path))
