"""Every number that a scene leaves open: chain length, cutoff, table, time step, thresholds, increments.

Each is derived from `[accuracy] tolerance` (relative, on the main results): by its measured share of it, or by the rule
stated beside it. The shares are in `calibration.json`, which `python -m validation.tools.calibration` writes: it turns
every value over a ladder in a number of scenes, at tolerances of 1e-2 to 1e-5, and takes the cheapest that adds a small
part of the tolerance at most to the errors of the main results in each of them; the residual has a set limit, too.

The cutoff of a slide follows from how a particle is held along x by a straight row of opposite ones,

    F_x(x, z) = Σ_j f(r_j) (x − j s)/r_j,    r_j = √((x − j s)² + z²)

a small difference of large sums: at the spacing of the longest range b it is some 1e-2 of one pair's force.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile, left_out
from contact1d.digits import apart
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials.table import FEWEST_POINTS, Table, table_for
from contact1d.workflow.errors import SettingsError as SettingsError
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.law import Law, NotCarriedError, stopped_at
from contact1d.workflow.laws.pairs import of_pairs
from contact1d.workflow.laws.relaxing import creep
from contact1d.workflow.laws.shape import Profile as Undeformed
from contact1d.workflow.laws.shape import Splined, Tabulated, tabulated
from contact1d.workflow.model.chain import (
    chains_of,
    reaches_too_far,
    require_apex,
    require_body,
    require_digits,
    require_memory,
    require_reach,
    require_room,
    require_rows,
    require_travel,
)
from contact1d.workflow.model.dynamics import Motion, measured, motion_of, whole_steps
from contact1d.workflow.scene import Impact, Interaction, Plate, Scene
from contact1d.workflow.scene.remedies import less_compression

FILE = Path(__file__).with_name("calibration.json")


def _value(meaning: str) -> Any:
    return field(metadata={"is": meaning})


@dataclass(frozen=True)
class Calibration:
    """The values, each with its meaning (`meanings`); the study that measures them sets others."""

    cutoff: float = _value("force at an automatic cutoff over the law's own, per unit of tolerance")
    table: float = _value("error of the table over the force scale, per unit of tolerance")
    residual: float = _value("norm of the forces left on the particles over the force scale, per unit of tolerance")
    chain: float = _value("force at the end of an automatic chain over the largest one, per unit of tolerance")
    smooth_increment: float = _value("increment of a smooth search over the longest range, at every tolerance")
    loading_increment: float = _value(
        "increment where pairs snap, and on a rigid plane, over the way from touch to the preload, at every tolerance"
    )
    still_step: float = _value("ω_max·Δt of a motion that comes to rest, without noise, at every tolerance")


def meanings() -> dict[str, str]:
    """What each value is, by its name."""
    return {one.name: one.metadata["is"] for one in fields(Calibration)}


def calibration_of(document: Mapping[str, Any]) -> Calibration:
    """The values in the contents of `calibration.json`. Raises KeyError where one is missing."""
    return Calibration(**{name: float(document["values"][name]["value"]) for name in meanings()})


CALIBRATION = calibration_of(json.loads(FILE.read_text(encoding="utf-8")))


Array = NDArray[np.float64]
REACH = 40.0
"""Reach of the sums, and of the longest cutoff, over the longest range."""
ASIDE, HEIGHTS = 33, 400
"""Positions within half a spacing, and heights, that are examined."""
LEFT_OUT = 0.1
"""Force of a pair at the cutoff over the largest force along x, per unit of tolerance: each pair that comes within
reach, or leaves it, changes that by that much at once."""


def slide_cutoff(law: DoubleExponential, spacing: float, load: float, share: float) -> float:
    """Cutoff [LU] at which a pair's force is LEFT_OUT `share` of the largest force along x [FU].

    Args:
        law: of a pair.
        spacing: of the row [LU].
        load: on a particle [FU], compression positive.
        share: the tolerance.
    """
    holding = max(largest_holding_force(law, spacing, load), np.finfo(float).tiny)
    far = law.repulsion if law.attraction is None else law.attraction
    start = far.range * math.log(far.amplitude / far.range / (LEFT_OUT * share * holding))
    return min(max(start, law.longest_range), REACH * law.longest_range)


def largest_holding_force(law: DoubleExponential, spacing: float, load: float) -> float:
    """max_x F_x [FU] of a particle pressed by a load [FU] onto a rigid chain, at its height in a potential minimum."""
    reach = math.ceil(REACH * law.longest_range / spacing) + 1
    row: Array = np.asarray(spacing * np.arange(-reach, reach + 1), dtype=np.float64)
    heights: Array = np.asarray(law.longest_range * np.geomspace(1e-2, 10.0, HEIGHTS))
    _, upward = _row_forces(law, 0.5 * spacing - row, heights)
    carried = np.flatnonzero(upward >= load)
    height = float(heights[carried[-1]] if carried.size else heights[0])
    x: Array = np.linspace(0.0, 0.5 * spacing, ASIDE)
    along = [float(_row_forces(law, place - row, np.asarray([height]))[0][0]) for place in x.tolist()]
    return float(np.max(np.abs(along)))


def _row_forces(law: DoubleExponential, aside: Array, heights: Array) -> tuple[Array, Array]:
    """Forces along x and z [FU] of pairs so far `aside` [LU], summed, at each of the heights [LU]."""
    distance = np.hypot(aside[None, :], heights[:, None])
    over = law.force(distance) / distance
    return (over * aside).sum(axis=1), over.sum(axis=1) * heights


THERMAL_SIGMAS = 5.0
"""Standard deviations by which a particle's thermal motion brings it nearer."""


def interaction_law(scene: Scene) -> DoubleExponential | None:
    """The pair interaction of the scene, or None on a rigid plane."""
    if scene.interaction is None:
        return None
    terms = scene.interaction
    attraction = None if terms.attraction is None else Exponential(terms.attraction.amplitude, terms.attraction.range)
    return DoubleExponential(Exponential(terms.repulsion.amplitude, terms.repulsion.range), attraction)


def cutoff_for(scene: Scene, law: DoubleExponential, share: float, tolerance: float) -> float:
    """The scene's cutoff [LU], or the one beyond which the force is below a share of the force scale.

    In a slide also below what the tolerance leaves of the force along x.
    """
    given = scene.the(Interaction).cutoff
    if given != "auto":
        return given
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, 0.0, tolerance))
    return reach


def innermost_distance(estimate: Law, cutoff: float, displacement: float) -> float:
    """Distance [LU] of the predictor's innermost pair at a displacement [LU]; its grid ends at the cutoff [LU]."""
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """Thermal approach [LU] of two particles on their springs: THERMAL_SIGMAS √(2 k_BT/k)."""
    return THERMAL_SIGMAS * math.sqrt(2.0 * scene.temperature / scene.bulk_stiffness)


def loading_step_of(most: float, step: float) -> float:
    """The `step` [LU] if it is > 0, never more than `most` [LU]."""
    return min(step, most) if step > 0 else most


def plane_stiffness_of(scene: Scene, tolerance: float) -> float:
    """One-sided stiffness of the rigid plane [FU/LU]: that of a particle, k, where particles are fixed in their body.

    An effect that acts on particles has bonds for them, and a plane 1/tolerance times stiffer.
    """
    if scene.bodies.lower != "rigid_plane":
        return 0.0
    return scene.bulk_stiffness if scene.stands else _stiffest_of(scene) / tolerance


def _stiffest_of(scene: Scene) -> float:
    """Bulk spring and what effects add to it [FU/LU]."""
    return scene.bulk_stiffness + sum(effect.added_stiffness for effect in scene.present)


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
ROWS_IN_TIME = 100
"""States of a motion that is followed for a given time."""
FAR_SHARE = 10.0
"""Length of a long bond over the spacing, per 1/tolerance: a lateral move u turns its force by u/2L."""
STAGGER_SHARE = 5e-4
"""Shift of a plate's anchors out of the plane, to and fro, over the chain's length.

No force acts in that direction, but `fix rigid` refuses a body that is nearly a line ("Bad principal moments"): the
least moment of inertia must be more than 1e-7 of the largest, and is 12 STAGGER² = 3e-6 of it.
"""


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


TAIL = 10.0
"""Force of the tail beyond the cutoff, summed over particles, over the force at the cutoff times a particle's share."""
COMPLIANCE_FACTOR = 2.0
"""Error of an equilibrium over that of the force on particles held in place: they follow it, and a table's error, here
at the distances that happen to be there, is half of what it is between two entries on average."""


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


@dataclass(frozen=True, eq=False)
class Settings:
    """The numbers of one run; units as in the scene. Two are equal if they are the same object.

    Attributes:
        tolerance: that all of this is for; that of a refined pass is smaller than the scene's.
        law: of the contact.
        forces, chains, increments, motion: see these.
        largest_displacement: what the predictor expects [LU].
    """

    tolerance: float
    law: Law
    forces: Forces
    chains: Chains
    increments: Increments
    motion: Motion
    largest_displacement: float = measured("LU")

    def drag(self, damping: float | None = None) -> float:
        """On all that moves with the plate [FU·TU/LU], with another coefficient of a particle where one is given."""
        each = self.motion.damping if damping is None else damping
        return self.chains.upper * each + self.motion.plate_damping

    @property
    def gentle(self) -> bool:
        """Whether a relaxation moves no particle by more than `longest_move` at a time, and none oscillates in time."""
        return self.increments.part < 1.0

    @property
    def snaps(self) -> bool:
        """Whether particles snap to the opposite ones and off them."""
        return self.law.snaps

    @cached_property
    def is_toothed(self) -> bool:
        """Whether the tensile force has several maxima: pairs separate one by one; they snap, or nearly so."""
        return self.snaps or (self.is_smooth and self.law.tooth(self.chains.upper) < math.inf)

    @property
    def is_smooth(self) -> bool:
        """Whether the force is a smooth function of the displacement: particles, and none of them snaps."""
        return self.forces.range > 0.0 and not self.snaps

    @property
    def strongest(self) -> tuple[float, float]:
        """(distance [LU], tension [FU]) of the force maximum of a chain of opposite particles on one.

        Of the predictor, whose grid of distances ends at the cutoff; (0, 0) on a rigid plane.
        """
        force = self.law.force
        at = int(force.argmin())
        return self.forces.cutoff * (at + 1) / force.size, max(0.0, -float(force[at]))

    def increment(self, smallest_distance: float = math.inf) -> float:
        """Longest increment [LU] of a search from a state with this smallest distance [LU]; unloading has no such."""
        own = self.increments
        if not self.is_smooth:
            near = MOVE_SHARE * own.part * smallest_distance if smallest_distance < math.inf else 0.0
            return min(own.loading_step, max(own.displacement_step, near))
        return min(own.smooth_step, max(NEAR_SHARE * own.longest_move, MOVE_SHARE * smallest_distance))

    def steps_of(self, duration: float) -> list[int]:
        """Timesteps of each load step of a motion of this duration [TU], the first of which is one timestep."""
        total = round(duration / self.motion.time_step)
        ends = np.unique(np.linspace(1, total, min(ROWS_IN_TIME, total - 1) + 1).round())
        return [int(steps) for steps in np.diff(ends, prepend=0.0)]

    def let_go_early(self, move: float) -> float:
        """Premature detachment [LU] of a pair under displacement increments `move` [LU]."""
        return self.law.let_go_early(move, self.forces.residual)

    def in_smaller_steps(self, part: float) -> Settings:
        """The same, with increments and moves, also those of a relaxation, scaled by this factor.

        In time a particle that comes to the opposite one is stopped by drag, not by its core, where the scene leaves
        the drag open; it needs timesteps of its own.
        """
        motion = self.motion
        damping = motion.damping if motion.plate_mass > 0.0 else motion.calm_damping
        timed = replace(motion, damping=damping, time_step=motion.calm_step)
        return replace(self, motion=timed, increments=self.increments.scaled(part))


def settings_for(scene: Scene, tolerance: float | None = None, calibration: Calibration | None = None) -> Settings:
    """Choose every open number of a scene.

    Args:
        scene: whose numbers are left open.
        tolerance: in place of the scene's own, for a refined pass.
        calibration: in place of the one that was measured, for the study that measures it.

    Raises:
        SettingsError: the numbers are so far apart that no chain, table or time step comes out of them, or the bodies
            can't carry the load.
    """
    try:
        with np.errstate(over="raise", invalid="raise", divide="raise"):
            chosen = _chosen(scene, tolerance or scene.accuracy.tolerance, calibration or CALIBRATION)
    except NotCarriedError as error:
        load, most = apart(scene.experiment.compression or 0.0, error.most, 4)
        raise SettingsError(
            f"a load of {load} FU exceeds what the repulsion of these particles can carry, about {most} FU. "
            "Lower the load, or use a stronger repulsion",
            changes=less_compression(scene, error.most),
        ) from None
    except (OverflowError, FloatingPointError, ZeroDivisionError, MemoryError) as error:
        raise SettingsError(
            f"the magnitudes in this scene differ too much to compute with ({error}): compare its lengths (spacing, "
            "ranges, radius), its energies (amplitudes) and its stiffnesses with each other"
        ) from None
    return chosen


CREEPING = 4
"""Looks for how deep a body goes that relaxes meanwhile, each with the time of the one before."""
LEAST_BACK = 1e-5
"""Restitution that is followed: with less a body creeps out for so long that it counts as stuck."""
FLOWS = 1.96
"""Creep over that of half the time, up to which a body comes back: 2 of a fluid. Measured of a sphere: 1.95 does."""
INERTIA, LONGER = 4.0, 2.0
"""Masses that the program chose, in a slower motion over the usual one; its drags, which go with the root, and the
timesteps of a coarser one. What is of first order in these changes by its own amount at least."""


def slower(scene: Scene, settings: Settings) -> list[tuple[Scene, Settings]]:
    """A motion in longer timesteps, on a less rigid plane; and with more mass and drag where these are not given."""
    own, forces, duration = settings.motion, settings.forces, scene.experiment.lasts
    longer = whole_steps(LONGER * own.time_step, duration)
    if not scene.stands and forces.plane_stiffness > 0.0:
        plane = forces.plane_stiffness / LONGER
        forces = replace(forces, plane_stiffness=plane, bulk_stiffness=_beside_plane(scene.bulk_stiffness, plane))
    found = [(scene, replace(settings, forces=forces, motion=replace(own, time_step=longer)))]
    bodies, plate, damping = scene.bodies, scene.plate, scene.damping
    if "mass" not in bodies.model_fields_set and not scene.experiment.is_massless:
        bodies = bodies.model_copy(update={"mass": INERTIA * bodies.mass})
    if plate and plate.mass == "auto":
        plate = plate.model_copy(update={"mass": INERTIA * own.plate_mass})
    drags = {
        "damping": own.damping * (LONGER if damping and damping.coefficient == "auto" else 1.0),
        "plate_damping": own.plate_damping * (LONGER if plate and plate.damping == "auto" else 1.0),
    }
    heavier = scene.model_copy(update={"bodies": bodies, "plate": plate})
    motion = settings_for(heavier, settings.tolerance).motion
    motion = replace(
        motion, damping=drags["damping"], plate_damping=drags["plate_damping"],
        time_step=whole_steps(motion.time_step, duration),
    )  # fmt: skip
    return [*found, (heavier, replace(settings, motion=motion))] if motion != own else found


def _stopped(scene: Scene, estimate: Law) -> float:
    """Displacement [LU] at which a body that hits the plane is at rest, one that relaxes meanwhile deeper.

    Raises:
        SettingsError: it sticks. Dashpots, T dF/dd, stop a body by themselves, where F = M v/T, and it creeps out with
            d/T; and one that flows, so that twice the time is twice the creep, loses what would bring it back.
    """
    found, given, law = stopped_at(scene, estimate), scene.experiment, scene.viscoelasticity
    if law is None or not isinstance(given, Impact):
        return found
    for _ in range(CREEPING):
        found = stopped_at(scene, estimate, creep(law, time := 2.0 * found / given.velocity))
    if retarded := law.retardation_time:
        mass = scene.the(Plate).mass
        assert mass != "auto"
        out = estimate.displacement_at(mass * given.velocity / retarded) / retarded
        sticks = "creeps out on its dashpots", out < LEAST_BACK * given.velocity, "a shorter retardation_time"
    else:
        sticks = "flows", creep(law, 2.0 * time) > FLOWS * creep(law, time), "longer times of terms"
    if sticks[1]:
        raise SettingsError(
            f"the body sticks: it {sticks[0]}, for longer than is followed, where an impact of the elastic body takes "
            f"some {time:.4g} TU: give {sticks[2]} in [viscoelasticity]"
        )
    return found


def _beside_plane(stiffness: float, plane: float) -> float:
    """Stiffness of a bond [FU/LU] that in series with the plane has the particle's."""
    return 1.0 / (1.0 / stiffness - 1.0 / plane)


def _require_carried(scene: Scene) -> None:
    """Refuse a load beyond N A/a, the repulsion of N pairs at zero distance.

    Raises:
        NotCarriedError: with N A/a [FU].
    """
    bodies, load = scene.bodies, scene.experiment.compression
    particles = bodies.particles if bodies.upper_particles is None else bodies.upper_particles
    if load is None or particles == "auto":
        return
    repulsion = scene.the(Interaction).repulsion
    most = particles * repulsion.amplitude / repulsion.range
    if load > most:
        raise NotCarriedError(most)


def _chosen(scene: Scene, tolerance: float, calibration: Calibration) -> Settings:
    """Forces, load, chains, table, motion, increments: each by what was chosen before it."""
    bodies = scene.bodies
    require_room(bodies)
    forces, estimate = _forces(scene, tolerance, calibration)
    load = scene.experiment.compression
    if load is None:
        largest = max(scene.experiment.places(), default=0.0) or _stopped(scene, estimate)
    else:
        largest = estimate.displacement_at(load * creep(scene.viscoelasticity, scene.experiment.lasts or 0.0))
    chains = _chains(scene, estimate, forces, largest, calibration.chain * tolerance)
    # A punch that adheres and carries nothing is not deep, and yet its springs hold it up to its limit.
    scale = forces.scale_of(scene, max(largest, -estimate.parted(0.0)) if estimate.holds else largest)
    require_digits(scene, chains.upper, forces.rest + largest, tolerance * scale)
    forces = replace(forces, scale=scale, residual=calibration.residual * tolerance * scale)
    forces = forces.with_table(scene, estimate, largest, calibration.table * tolerance * scale)
    stiffest = _stiffest_of(scene) + max(0.0, scene.tangential_stiffness - scene.bulk_stiffness)
    stiffest += forces.stiffest(bodies.spacing)
    motion = motion_of(scene, tolerance, estimate, largest, chains.upper, stiffest, calibration.still_step)
    increments = forces.increments(bodies.spacing, largest, calibration)
    require_rows(scene, increments.longest_move, motion.drive)
    different = scene.horizontal and scene.tangential_stiffness != scene.bulk_stiffness
    chains = replace(chains, far=FAR_SHARE / tolerance * bodies.spacing if different else 0.0)
    return Settings(tolerance, estimate, forces, chains, increments, motion, largest)


def _forces(scene: Scene, tolerance: float, calibration: Calibration) -> tuple[Forces, Law]:
    """Springs, plane and interaction, without table and scales; the predictor of the contact that they make."""
    law, bodies, spring = interaction_law(scene), scene.bodies, scene.bulk_stiffness
    shape: Undeformed = bodies
    if bodies.profile.slow:  # with a range the predictor's shape is that of the deck
        shape = tabulated(bodies, bodies.spacing, Splined if law_of(scene).has_range else Tabulated)
    if law is None:
        plane = plane_stiffness_of(scene, tolerance)
        bond = spring if scene.stands else _beside_plane(spring, plane)
        return Forces(bulk_stiffness=bond, plane_stiffness=plane), law_of(scene).of(scene, shape)
    cutoff = cutoff_for(scene, law, calibration.cutoff * tolerance, tolerance)
    require_reach(scene, cutoff)
    rest, closest = cutoff, CLOSEST_SHARE * law.repulsion.range
    if law.attraction is not None:
        rest = law.force_free_distance()
        closest = CLOSEST_SHARE * rest
    estimate = of_pairs(law, shape, bodies.own_spacing, spring, cutoff, rest, chains=scene.chains, row=bodies.spacing)
    _require_carried(scene)
    table = Table(law, cutoff, FEWEST_POINTS)  # until it is known how near particles come
    return PairForces(bulk_stiffness=spring, table=table, cutoff=cutoff, rest=rest, closest=closest), estimate


def _chains(scene: Scene, estimate: Law, forces: Forces, largest: float, share: float) -> Chains:
    """As many particles as the contact needs, or as the scene gives. Raises SettingsError where they do not fit."""
    upper, lower = chains_of(scene, estimate, largest, share)
    require_body(scene.bodies, largest, upper)
    require_apex(scene, upper, forces.cutoff)
    require_memory(scene, max(upper, lower), forces.cutoff)
    require_travel(scene, largest, forces.cutoff)
    return Chains(upper, lower, 0.0)
