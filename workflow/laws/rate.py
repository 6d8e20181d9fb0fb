"""JKR's contact, whose edge recedes at a finite speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import SettingsError
from contact1d.workflow.laws.dugdale import Dugdale, Zone
from contact1d.workflow.laws.jkr import Jkr, elongation
from contact1d.workflow.laws.path import History, Path
from contact1d.workflow.laws.zoned import Zoned, ZonedCells
from contact1d.workflow.scene import Adhesion, Rate, Scene

Array = NDArray[np.float64]
LOST, SLOWING, EXACT, FOLLOWED = 1e-3, 12, 1e-11, 4000
"""Edge over that under fixed grips at which a receding one is lost, and the power with which it slows down beyond; the
error of its motion, and times at which a pull looks for equal ways."""
SLOWEST = 1e-8
"""Least (v/v₀)ⁿ of a pull."""
SAME = 1e-9
"""Fall of d over its range that is one: others are round-off."""
LOOKS_BETWEEN, EDGE_STEP = 20, 0.01
"""Looks for a receding edge between two moments of a history, and its way from one load step to the next, over all."""


@dataclass(frozen=True, eq=False)
class Receding(Zoned):
    """JKR's contact, whose edge recedes at a finite speed and advances at once (D. Maugis, M. Barquins, J. Phys. D 11
    (1978) 1989):

        G = E* (g(a) − d)²/(2πa),    −da/dt = v₀ (G/W − 1)^(1/n)  where G > W,    F = 2E* ∫₀ᵃ (d − g) dx

    Attributes:
        rate: v₀ and n.
    """

    in_time = True
    exact = ()

    rate: Rate = field(kw_only=True)

    @classmethod
    def applies(cls, scene: Scene) -> bool:
        """Of an edge that takes its time."""
        return Jkr.applies(scene) and scene.the(Adhesion).rate is not None

    @classmethod
    def from_jkr(cls, jkr: Jkr, scene: Scene, wanted: float, load: float) -> Receding:
        """See `Jkr`."""
        rate = scene.the(Adhesion).rate
        assert rate
        speed = getattr(scene.experiment, "velocity", None) or rate.velocity
        if (more := (speed / rate.velocity) ** rate.exponent) < SLOWEST:
            raise SettingsError(
                f"the contact is JKR's within {more:.1g}: an adhesion.rate whose velocity is so far above "
                f"experiment.velocity, {speed:.4g} LU/TU, changes nothing that is resolved: leave it out"
            )
        own = {one.name: getattr(jkr, one.name) for one in fields(jkr)}
        return cls(**own, surface=scene.bodies.profile, rate=rate)

    def particles(self, x: Array, deepest: float) -> RecedingCells:
        """See `Law`."""
        return RecedingCells(self, x, deepest)

    @cached_property
    def equations(self) -> Dugdale:
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
            kept = np.full_like(d, edge)
            if d.size > 1 and edge > 0.0:  # an edge that still opens does so while the body comes back, too
                kept = self._narrowed(edge, partial(np.interp, xp=times[own], fp=d), times[own])
            if d[-1] > d[0] or edge == 0.0:
                held = (kept > 0.0) & (d >= self.fixed_grips[1])
                held |= np.maximum.accumulate(d >= -SAME * self.spacing)
                kept = np.where(held, np.maximum(kept, self.radii(d)), kept)
            found[own] = kept
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


@dataclass(frozen=True, eq=False)
class RecedingCells(ZonedCells):
    """The same where the edge recedes at a finite speed."""

    law: Receding

    dense = 4

    @property
    def apart(self) -> float:
        """Where fixed grips would lose a contact that takes its time [LU]."""
        return self.law.fixed_grips[1]

    def held(self, displacements: Array) -> Array:
        """F [FU] at rest."""
        edge = self.law.radii(displacements)
        forces = self.law.equations.forces(edge, np.zeros_like(edge), displacements)
        return np.where(displacements >= self.apart, forces, 0.0)

    def zone(self, path: Path) -> Zone:
        """The edge and F of each state."""
        edge = self.law.edges(path.time, path.displacement)
        none = np.zeros_like(edge)
        return Zone(edge, edge, path.displacement, self.law.equations.forces(edge, none, path.displacement))

    def checked(self, path: Path, finer: int) -> Path:
        """Return the path itself: its load steps have their times."""
        return path

    def energies(self, path: Path) -> tuple[float, float]:
        """U(d, a) of JKR; ∫ (G − W) 2πa da where the edge recedes, and what U jumps by at touch and separation."""
        estimate, zone = self.law, self.zone(path)
        a, d = zone.edge, zone.displacement
        opened = estimate.profile.height(a) - d
        excess = estimate.modulus * opened**2 - 2.0 * math.pi * a * estimate.work
        fell = np.minimum(np.diff(a), 0.0) * (a[1:] > 0.0)
        lost = -float(np.sum(0.5 * (excess[1:] + excess[:-1]) * fell))
        energies = [0.0, *(estimate.energy(float(d[i]), float(a[i])) for i in range(a.size))]
        jumps = np.flatnonzero(np.diff(a > 0.0, prepend=False))
        return energies[-1], lost + sum(energies[at] - energies[at + 1] for at in jumps.tolist())

    def moments(self, deepest: float, velocity: float, count: int) -> Array:
        """See `Particles`: at equal ways of the edge."""
        return self.law.pulled(deepest, velocity, count)

    def refined(self, history: History) -> History:
        """With moments at equal ways of an edge that recedes."""
        history = history.beside([0.0])  # the bodies touch at once
        steps = np.linspace(0.0, len(history.phases) - 1.0, (len(history.phases) - 1) * LOOKS_BETWEEN + 1)
        time, values = (np.interp(steps, np.arange(len(history.phases)), one) for one in (history.time, history.values))
        edge = self.law.edges(time, values)
        passed = np.append(0.0, np.cumsum(np.maximum(-np.diff(edge), 0.0))) / (float(edge.max()) or 1.0)
        more = np.interp(np.arange(EDGE_STEP, float(passed[-1]), EDGE_STEP), passed, steps)
        return history.at(np.union1d(np.arange(float(len(history.phases))), more))

    def prescribed(self, path: Path) -> dict[str, Array]:
        """With the edge of the contact."""
        return self._edges_of(self.zone(path))
