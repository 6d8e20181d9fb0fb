"""The forces on a particle, of a rigid plane or of opposite particles, and the increments of a search."""

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

MOVE_SHARE = 0.25
"""Longest move of a body between two states at rest, over the smallest distance: particles stay in order, down to r
near 0."""
NEAR_SHARE = 0.2
"""Least distance down to which a table follows the law and a search approaches in ever smaller moves, over `closest`: a
table that is smoothed any earlier lets bodies pass that the interaction still carries."""


def loading_step_of(most: float, step: float) -> float:
    """Return the `step` [LU] where it is > 0, but `most` [LU] at most; `most` where it is 0 or negative."""
    return min(step, most) if step > 0 else most


def plane_stiffness_of(scene: Scene, tolerance: float) -> float:
    """Return the one-sided stiffness of the rigid plane [FU/LU] per particle; 0 where the lower body is no rigid plane.

    It is the bulk stiffness k of a particle; with [neighbours] or [noise], whose particles move on bonds of their own,
    it is (k + 4 k_n)/tolerance, with the stiffness k_n of a neighbour spring, 0 without [neighbours].
    """
    if scene.bodies.lower != "rigid_plane":
        return 0.0
    return scene.bulk_stiffness if scene.stands else stiffest_of(scene) / tolerance


def stiffest_of(scene: Scene) -> float:
    """Return the bulk stiffness of a particle [FU/LU], with [neighbours] plus 4 times that of a neighbour spring."""
    return scene.bulk_stiffness + sum(effect.added_stiffness for effect in scene.present)


@dataclass(frozen=True, kw_only=True)
class Forces:
    """The forces on a particle on a rigid plane; there is no table, and cutoff, table_from, rest and closest are 0.

    Attributes:
        bulk_stiffness: normal bond of a particle to its anchor [FU/LU].
        plane_stiffness: one-sided stiffness of the rigid plane [FU/LU]; 0 without one.
        table: table of the interaction.
        cutoff: cutoff of the interaction [LU].
        table_from: distance [LU] from which on the table follows the interaction.
        rest: distance of the apexes at displacement 0 [LU].
        closest: smallest distance for which moves and timestep are chosen [LU].
        scale: force of one particle [FU], to which residuals are relative.
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
        """The interaction of a pair of particles; None, since on a rigid plane there is none."""
        return None

    @property
    def range(self) -> float:
        """Longest range of the interaction [LU]; 0, since on a rigid plane there is none."""
        return 0.0

    def with_table(self, scene: Scene, estimate: Law, largest: float, error: float) -> Forces:
        """Return these forces themselves, since on a rigid plane there is no interaction; arguments are ignored.

        Args:
            scene: of the run.
            estimate: contact law.
            largest: largest displacement [LU].
            error: allowed error of a force [FU].
        """
        return self

    def scale_of(self, scene: Scene, deepest: float) -> float:
        """Return the force scale of one particle [FU] > 0: half its bulk stiffness times `deepest` [LU].

        `deepest`: largest length change of a spring; where it is 0 or negative, a thousandth of the spacing counts
        instead.
        """
        return (deepest if deepest > 0.0 else 1e-3 * scene.bodies.spacing) * scene.bulk_stiffness / 2

    def stiffest(self, spacing: float) -> float:
        """Return the largest contact stiffness of a particle [FU/LU]: that of the plane. `spacing` is ignored."""
        return self.plane_stiffness

    def increments(self, spacing: float, largest: float, calibration: Calibration) -> Increments:
        """Return the displacement increments of a search on a rigid plane [LU].

        `displacement_step` and `loading_step` are a tenth of the `spacing` [LU], or less where the calibrated share of
        the displacement `largest` [LU] is smaller and > 0. `smooth_step` is 0 and the longest move infinite.
        """
        loading = loading_step_of(0.1 * spacing, calibration.loading_increment * largest)
        return Increments(loading, loading, 0.0, math.inf)

    def share(self, scene: Scene) -> float:
        """Return the relative error of a force, before a run, since the plane is not quite rigid.

        It is 4 times the stiffness of a neighbour spring over that of the plane; 0 without [neighbours].
        """
        return sum(effect.added_stiffness for effect in scene.present) / self.plane_stiffness

    def error(self, scene: Scene, profile: Profile) -> float:
        """Return the error of the contact force of a state [FU] ≥ 0, by the finite stiffness of the plane.

        It is |Σ F_z| of the upper particles times 4 k_n/k, with the stiffnesses k_n of a neighbour spring and k of the
        plane; 0 without [neighbours].
        """
        return self.share(scene) * abs(scene.bodies.spacing * float(profile.pressure.sum()))


@dataclass(frozen=True, kw_only=True)
class PairForces(Forces):
    """The forces on a particle that interacts with those of the opposite chain."""

    table: Table

    @property
    def law(self) -> DoubleExponential:
        """Interaction of a pair of opposite particles, from which the table is made."""
        return self.table.law

    @property
    def range(self) -> float:
        """Range [LU] of the exponential that dominates at large distance.

        That is the attraction, or without one the repulsion.
        """
        return self.law.longest_range

    def with_table(self, scene: Scene, estimate: Law, largest: float, error: float) -> Forces:
        """Return a copy with a table of the interaction whose force error is at most `error` [FU], from a distance on.

        The distance, `table_from` of the copy, is 0.8 (r − u) with r that of the particles at the apex at the
        displacement `largest` [LU] and u five standard deviations of thermal motion; but at least a fifth of `closest`,
        with noise `closest` itself. A table of 400 000 points may have a larger error. `estimate`: contact law.
        """
        nearest = self.closest * (1.0 if scene.noise else NEAR_SHARE)
        innermost = innermost_distance(estimate, self.cutoff, largest) - thermal_motion(scene)
        margin = 0.8  # measured: the smallest distance is 0.93 to 1.004 of that of the predictor
        start = max(nearest, margin * innermost)
        return replace(self, table_from=start, table=table_for(self.law, self.cutoff, start, error))

    def scale_of(self, scene: Scene, deepest: float) -> float:
        """Return the force scale of one particle [FU] > 0: the largest attraction of one pair.

        Without attraction it is half the bulk stiffness times the largest length change of a spring, `deepest` [LU], or
        a thousandth of the spacing where that is not > 0.
        """
        if self.law.attraction is None:
            return super().scale_of(scene, deepest)
        r = self.law.force_free_distance() + self.law.longest_range * np.linspace(0.0, 5.0, 2001)
        return float(-self.law.force(r).min())

    def stiffest(self, spacing: float) -> float:
        """Return the estimated stiffness [FU/LU] of all pairs of a particle, the nearest ones at `closest`.

        It is 2 (1 + 2a/s) V″(closest), with the range a of the repulsion and the `spacing` s of the particles [LU].
        """
        partners = 1.0 + 2.0 * self.law.repulsion.range / spacing
        return 2.0 * partners * float(self.law.stiffness(self.closest))

    def increments(self, spacing: float, largest: float, calibration: Calibration) -> Increments:
        """Return the displacement increments of a search [LU]; `spacing` is ignored.

        The longest move is a quarter of `closest`. `loading_step` is a quarter of the range of the interaction, or less
        where the calibrated share of the displacement `largest` [LU] is smaller and > 0; `displacement_step` is the
        smaller of both; `smooth_step` is a calibrated share of the range.
        """
        move = MOVE_SHARE * self.closest
        loading = loading_step_of(0.25 * self.range, calibration.loading_increment * largest)
        return Increments(min(loading, move), loading, calibration.smooth_increment * self.range, move)

    def share(self, scene: Scene) -> float:
        """Return the relative error of a force by table and cutoff over the force scale of one particle, before a run.

        It is ten times the force of a pair at the cutoff, which bounds the tail beyond it summed over particles, plus
        the largest error of the table from `table_from` on.
        """
        tail = 10.0 * abs(float(self.law.force(self.cutoff)))
        return (tail + self.table.error_beyond(self.table_from)) / self.scale

    def error(self, scene: Scene, profile: Profile) -> float:
        """Return the error of the contact force of a measured state [FU] ≥ 0, by table and cutoff.

        2 Σ |F_table(r) − f(r)| |z|/r over pairs of opposite particles in the profile, F_table = 0 beyond the cutoff.
        The factor is the error of an equilibrium over that of forces on particles held in place, which follow it. A
        table's error, here at the distances of the state, is half of that between two entries on average. `scene` is
        ignored.
        """
        return 2.0 * left_out(self.law, self.table, profile)


@dataclass(frozen=True)
class Chains:
    """Numbers of particles of both bodies, and the length of the long bonds.

    Attributes:
        upper, lower: particles of the upper and of the lower body; the latter is not used for a rigid plane.
        far: length of the long bond that makes normal and tangential stiffness differ [LU]; 0 where they do not, and
            without [horizontal].
    """

    upper: int
    lower: int
    far: float = measured("LU")


@dataclass(frozen=True)
class Increments:
    """Displacement increments of a search [LU].

    Attributes:
        displacement_step: where pairs snap, and on a rigid plane.
        loading_step: while particles are so far apart that they cannot pass each other.
        smooth_step: where the force of particles is a smooth function of the displacement.
        longest_move: longest move of a body between two states at rest, inf on a rigid plane: a move longer than the
            distance of opposite particles would put them behind each other. A search may approach to less than
            `Forces.closest`, in moves down to a fifth of this.
        part: increments, moves and loads over the usual ones (relative), below 1 in a search that restarts in smaller
            steps.
    """

    displacement_step: float = measured("LU")
    loading_step: float = measured("LU")
    smooth_step: float = measured("LU")
    longest_move: float = measured("LU")
    part: float = 1.0

    def scaled(self, part: float) -> Increments:
        """Return a copy with all lengths multiplied by a factor `part`, and this factor as its own `part`.

        An infinite length stays infinite; a `part` that these increments had before is replaced, not multiplied.
        """
        lengths = {name: part * value for name, value in vars(self).items()}
        return replace(self, **lengths | {"part": part})
