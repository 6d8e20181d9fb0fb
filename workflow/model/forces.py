"""What acts on a particle, on a rigid plane and opposite others; and the increments of a search."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from contact1d.analysis.pressure import Profile, left_out
from contact1d.potentials import DoubleExponential
from contact1d.potentials.table import Table, table_for
from contact1d.workflow.laws.law import Law
from contact1d.workflow.model.calibration import Calibration
from contact1d.workflow.model.cutoff import innermost_distance, thermal_motion
from contact1d.workflow.model.dynamics import measured
from contact1d.workflow.scene import Scene

TABLE_MARGIN = 0.8
"""Distance from which on a table is to follow the law, over the expected smallest one. Measured: the smallest distance
is 0.93 to 1.004 of what the predictor of independent pairs says."""
CLOSEST_SHARE = 0.2
"""Smallest distance that is looked after over the force-free one (with attraction) or the repulsion's range."""
MOVE_SHARE = 0.25
"""Longest move of a body between two states at rest, over the smallest distance: particles stay in order, down to r
near 0."""
NEAR_SHARE = 0.2
"""Least distance down to which a table follows the law and a search comes down in ever smaller moves, over `closest`: a
table that is smoothed any earlier lets bodies pass that the interaction still carries."""
TAIL = 10.0
"""Force of the tail beyond the cutoff, summed over particles, over the force at the cutoff times a particle's share."""
COMPLIANCE_FACTOR = 2.0
"""Error of an equilibrium over that of the force on particles held in place: they follow it, and a table's error, here
at the distances that happen to be there, is half of what it is between two entries on average."""


def loading_step_of(most: float, step: float) -> float:
    """The `step` [LU] if it is > 0, never more than `most` [LU]."""
    return min(step, most) if step > 0 else most


def plane_stiffness_of(scene: Scene, tolerance: float) -> float:
    """One-sided stiffness of the rigid plane [FU/LU]: that of a particle, k, where particles are fixed in their body.

    An effect that acts on particles has bonds for them, and a plane 1/tolerance times stiffer.
    """
    if scene.bodies.lower != "rigid_plane":
        return 0.0
    return scene.bulk_stiffness if scene.stands else stiffest_of(scene) / tolerance


def stiffest_of(scene: Scene) -> float:
    """Bulk spring and what effects add to it [FU/LU]."""
    return scene.bulk_stiffness + sum(effect.added_stiffness for effect in scene.present)


@dataclass(frozen=True, kw_only=True)
class Forces:
    """What acts on a particle on a rigid plane, which has no table, and 0 for cutoff, rest, table_from and closest.

    Attributes:
        table, cutoff, table_from: of an interaction, its cutoff [LU], and the distance [LU] from which on the table was
            chosen to follow it.
        rest: apex distance at displacement 0 [LU].
        closest: smallest distance for which moves and time step are chosen [LU].
        bulk_stiffness: normal bond of a particle to its anchor [FU/LU].
        plane_stiffness: one-sided stiffness of the rigid plane [FU/LU]; 0 without one.
        scale: force of one particle [FU] against which residuals are judged.
        residual: norm of the residual forces at which a minimisation stops [FU].
    """

    bulk_stiffness: float = measured("FU/LU")
    plane_stiffness: float = measured("FU/LU", 0.0)
    table: Table | None = None
    cutoff: float = measured("LU", 0.0)
    table_from: float = measured("LU", 0.0)
    rest: float = measured("LU", 0.0)
    closest: float = measured("LU", 0.0)
    scale: float = measured("FU", 0.0)
    residual: float = measured("FU", 0.0)

    @property
    def law(self) -> DoubleExponential | None:
        """The interaction."""
        return None

    @property
    def range(self) -> float:
        """Longest range of the interaction [LU]; 0 without one."""
        return 0.0

    def with_table(self, scene: Scene, estimate: Law, largest: float, error: float) -> Forces:
        """With a table of the law that follows it to an error [FU] from the smallest distance on that is expected."""
        return self

    def scale_of(self, scene: Scene, deepest: float) -> float:
        """The force of the deepest particle [FU], so deep [LU]."""
        return (deepest if deepest > 0.0 else 1e-3 * scene.bodies.spacing) * scene.bulk_stiffness / 2

    def stiffest(self, spacing: float) -> float:
        """The largest stiffness [FU/LU] that the opposite body has for a particle."""
        return self.plane_stiffness

    def increments(self, spacing: float, largest: float, calibration: Calibration) -> Increments:
        """Increments of searches, by the spacing [LU]."""
        loading = loading_step_of(0.1 * spacing, calibration.loading_increment * largest)
        return Increments(loading, loading, 0.0, math.inf)

    def share(self, scene: Scene) -> float:
        """Relative error of a force, before a run: the plane is not quite rigid for springs between particles."""
        return sum(effect.added_stiffness for effect in scene.present) / self.plane_stiffness

    def error(self, scene: Scene, profile: Profile) -> float:
        """Error of the force of a measured state [FU]."""
        return self.share(scene) * abs(scene.bodies.spacing * float(profile.pressure.sum()))


@dataclass(frozen=True, kw_only=True)
class PairForces(Forces):
    """What acts on a particle that feels those of the opposite chain."""

    table: Table

    @property
    def law(self) -> DoubleExponential:
        """The interaction."""
        return self.table.law

    @property
    def range(self) -> float:
        """Longest range of the interaction [LU]."""
        return self.law.longest_range

    def with_table(self, scene: Scene, estimate: Law, largest: float, error: float) -> Forces:
        """See `Forces`; `largest`: the displacement [LU]."""
        nearest = self.closest * (1.0 if scene.noise else NEAR_SHARE)
        innermost = innermost_distance(estimate, self.cutoff, largest) - thermal_motion(scene)
        start = max(nearest, TABLE_MARGIN * innermost)
        return replace(self, table_from=start, table=table_for(self.law, self.cutoff, start, error))

    def scale_of(self, scene: Scene, deepest: float) -> float:
        """The force maximum of one pair [FU]; without attraction as on a plane."""
        if self.law.attraction is None:
            return super().scale_of(scene, deepest)
        r = self.law.force_free_distance() + self.law.longest_range * np.linspace(0.0, 5.0, 2001)
        return float(-self.law.force(r).min())

    def stiffest(self, spacing: float) -> float:
        """Of nearby opposite particles."""
        rows = 1.0 + 2.0 * self.law.repulsion.range / spacing
        return 2.0 * rows * float(self.law.stiffness(self.closest))

    def increments(self, spacing: float, largest: float, calibration: Calibration) -> Increments:
        """By the range of the interaction."""
        move = MOVE_SHARE * self.closest
        loading = loading_step_of(0.25 * self.range, calibration.loading_increment * largest)
        return Increments(min(loading, move), loading, calibration.smooth_increment * self.range, move)

    def share(self, scene: Scene) -> float:
        """What table and cutoff may cause."""
        tail = TAIL * abs(float(self.law.force(self.cutoff)))
        return (tail + self.table.error_beyond(self.table_from)) / self.scale

    def error(self, scene: Scene, profile: Profile) -> float:
        """COMPLIANCE_FACTOR Σ |F_table(r) - f(r)| |z|/r over opposite particles, F_table = 0 beyond the cutoff."""
        return COMPLIANCE_FACTOR * left_out(self.law, self.table, profile)


@dataclass(frozen=True)
class Chains:
    """Particles of the upper body, of the lower one where it has any, and the length of the long bonds.

    Attributes:
        upper, lower: how many.
        far: length of the long bond that makes normal and tangential stiffness differ [LU]; 0 where they do not.
    """

    upper: int
    lower: int
    far: float = measured("LU")


@dataclass(frozen=True)
class Increments:
    """Displacement increments of a search [LU].

    Attributes:
        displacement_step: where pairs snap, and on a rigid plane.
        loading_step: the same where particles are so far from each other that it is no danger.
        smooth_step: elsewhere, where the force is a smooth function of the displacement.
        longest_move: of a body between two states at rest, inf on a rigid plane: a body that is moved by more than
            its particles' distance from the opposite ones is put behind them. A search may come nearer than `closest`,
            in moves down to NEAR_SHARE of this.
        part: of increments, moves and loads over the usual ones, of a search that restarts in smaller steps.
    """

    displacement_step: float = measured("LU")
    loading_step: float = measured("LU")
    smooth_step: float = measured("LU")
    longest_move: float = measured("LU")
    part: float = 1.0

    def scaled(self, part: float) -> Increments:
        """All of them by this factor."""
        lengths = {name: part * value for name, value in vars(self).items()}
        return replace(self, **lengths | {"part": part})
