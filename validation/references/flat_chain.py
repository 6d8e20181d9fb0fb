"""The slow friction of so many particles on a rigid row, all on one plate that is free to rise under a constant load.

Particle i, at (x_i, z_i), hangs by springs (k_t, k_n) on its place a_i in a plate at (X, Z); the row has s:

    E = Σ_i [Σ_j V(r_ij) + k_t (x_i − a_i − X)²/2 + k_n (z_i − Z)²/2] + N F Z,    a_i = i m s/N

As X grows E is at rest in all x_i, z_i and Z, and slips where it ceases to be at a minimum. One particle is that of
Prandtl and Tomlinson; without end the plate no longer moves as one of them slips (`incommensurate`). Between them the
plate gives way to each slip, and friction is lower by a share that falls as 1/N.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from validation.references.interaction import Floats, LawNumbers, PairInteraction

State = tuple[Floats, Floats, float]
"""x_i, z_i and Z [LU]."""
REACH = 45
"""Particles of the row to each side: what is left out is below e^−45 B/b where b = s."""
PLACES, HALVINGS = 100, 6
"""Places of the plate within s at least, and halvings of the way between two, within which a slip is found."""
SLIP = 0.12
"""Way of a particle between two places over s from which on it slips."""
RUN_IN = 1.3
"""Way over the spacing before friction is looked at: each particle has slipped."""
RESIDUAL, MOST, LONGEST, FLOW = 1e-10, 50_000, 0.02, 1.0
"""Force at rest over B/b; iterations; Newton's longest move over s; a move downhill over force times curvature."""


@dataclass(frozen=True)
class FlatChain:
    """The chain.

    Attributes:
        law: A [FU·LU], a [LU], B [FU·LU], b [LU].
        spacing: s [LU].
        count, below: N and m, without a common divisor.
        load: F of a particle [FU].
        normal_stiffness, tangential_stiffness: k_n, k_t [FU/LU].
    """

    law: LawNumbers
    spacing: float
    count: int
    below: int
    load: float
    normal_stiffness: float
    tangential_stiffness: float

    @cached_property
    def pair(self) -> PairInteraction:
        """The same law."""
        return PairInteraction.of(*self.law)

    @property
    def places(self) -> Floats:
        """a_i [LU]."""
        return np.arange(self.count) * self.below * self.spacing / self.count

    def friction(self) -> float:
        """Mean force along x on a particle [FU] for v → 0: the energy that slips lose on a way s/N, over s.

        Every s/N of X the chain is the same again, with other particles in the old ones' places.

        Raises:
            ArithmeticError: the particles come to rest nowhere.
        """
        steps = math.ceil(PLACES / self.count)
        way = self.spacing / self.count / steps
        state = self._at_rest(0.0, self.places, np.full(self.count, self.law[3]), self.law[3])
        lost, run_in = 0.0, math.ceil(RUN_IN * self.count) * steps
        for step in range(run_in + steps):
            begin, end, after = step * way, (step + 1) * way, self._at_rest((step + 1) * way, *state)
            if step >= run_in and self._slipped(state, after):
                before, new = state, after
                for _ in range(HALVINGS):
                    middle = 0.5 * (begin + end)
                    there = self._at_rest(middle, *before)
                    if self._slipped(before, there):
                        end, new = middle, there
                    else:
                        begin, before = middle, there
                work = 0.5 * (end - begin) * (self._pull(begin, before) + self._pull(end, new))
                lost += self._energy(begin, before) - self._energy(end, new) + work
            state = after
        return lost / self.spacing

    def _slipped(self, before: State, after: State) -> bool:
        return float(np.abs(after[0] - before[0]).max()) > SLIP * self.spacing

    def _pull(self, plate: float, state: State) -> float:
        """Force along x on the plate [FU]."""
        return self.tangential_stiffness * float(np.sum(self.places + plate - state[0]))

    def _energy(self, plate: float, state: State) -> float:
        x, z, height = state
        springs = self.tangential_stiffness * (x - self.places - plate) ** 2 + self.normal_stiffness * (z - height) ** 2
        pairs = self.pair.energy(self._distances(x, z)[1])
        return float(pairs.sum() + 0.5 * springs.sum()) + self.count * self.load * height

    def _at_rest(self, plate: float, x: Floats, z: Floats, height: float) -> State:
        """The minimum of E that lies downhill: Newton's method near it, else along the forces."""
        count, k_n, scale = self.count, self.normal_stiffness, self.law[2] / self.law[3]
        for _ in range(MOST):
            along, up, xx, zz, xz = self._row(x, z)
            along += self.tangential_stiffness * (x - self.places - plate)
            up += k_n * (z - height)
            xx, zz = xx + self.tangential_stiffness, zz + k_n
            lift = k_n * np.sum(height - z) + self.load * count
            if max(np.abs(along).max(), np.abs(up).max(), abs(lift)) < RESIDUAL * scale:
                return x, z, height
            bend = xx * zz - xz**2
            if (bend > 0.0).all() and (xx > 0.0).all():
                own = (xz * up - zz * along) / bend, (xz * along - xx * up) / bend
                given = -xz * k_n / bend, xx * k_n / bend  # where the plate rises by 1
                stiff = k_n * (count - given[1].sum())
                rise = (k_n * own[1].sum() - lift) / stiff
                dx, dz = own[0] + given[0] * rise, own[1] + given[1] * rise
                if stiff > 0.0 and max(np.abs(dx).max(), np.abs(dz).max(), abs(rise)) < LONGEST * self.spacing:
                    x, z, height = x + dx, z + dz, height + rise
                    continue
            move = FLOW / np.max(np.abs(xx) + np.abs(zz) + 2.0 * np.abs(xz))
            x, z, height = x - move * along, z - move * up, height - move * lift / count
        raise ArithmeticError("the chain comes to rest nowhere")

    def _row(self, x: Floats, z: Floats) -> tuple[Floats, Floats, Floats, Floats, Floats]:
        """∂U/∂x, ∂U/∂z, and the second derivatives xx, zz, xz of each particle's energy over the row."""
        aside, r = self._distances(x, z)
        _, force, rise = self.pair.evaluate(r)
        cos, sin, turn = aside / r, z[:, None] / r, force / r
        return (
            -(force * cos).sum(axis=1),
            -(force * sin).sum(axis=1),
            -(rise * cos**2 + turn * sin**2).sum(axis=1),
            -(rise * sin**2 + turn * cos**2).sum(axis=1),
            ((turn - rise) * cos * sin).sum(axis=1),
        )

    def _distances(self, x: Floats, z: Floats) -> tuple[Floats, Floats]:
        """Along x, and in all, of each particle from those of the row around it [LU]."""
        nearest = np.round(x / self.spacing)[:, None]
        aside = x[:, None] - self.spacing * (nearest + np.arange(-REACH, REACH + 1)[None, :])
        return aside, np.hypot(aside, z[:, None])
