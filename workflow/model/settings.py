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

from contact1d.digits import apart
from contact1d.potentials import DoubleExponential, Exponential
from contact1d.potentials.table import Table, table_for
from contact1d.workflow.model.adhesion import estimate_on_plane
from contact1d.workflow.model.chain import SettingsError as SettingsError
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
from contact1d.workflow.model.dynamics import DriveLeg, drive_steps, dynamics_of, stiffest_of
from contact1d.workflow.model.pairs import ContactEstimate, NotCarriedError, Profile, particles_estimate, tabulated
from contact1d.workflow.scene import Measured, Scene
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
PLACES, HEIGHTS = 33, 400
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
    x: Array = np.linspace(0.0, 0.5 * spacing, PLACES)
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
    assert scene.interaction is not None
    if scene.interaction.cutoff != "auto":
        return scene.interaction.cutoff
    reach = law.cutoff_for(share)
    if scene.experiment.motion_is_result and not reaches_too_far(scene, reach):
        return max(reach, slide_cutoff(law, scene.bodies.spacing, 0.0, tolerance))
    return reach


def innermost_distance(estimate: ContactEstimate, cutoff: float, displacement: float) -> float:
    """Distance [LU] of the predictor's innermost pair at a displacement [LU]; its grid ends at the cutoff [LU]."""
    grid = cutoff / estimate.gap.size * np.arange(1, estimate.gap.size + 1)
    return float(np.interp(estimate.rest - displacement, estimate.gap, grid))


def thermal_motion(scene: Scene) -> float:
    """Thermal approach [LU] of two particles on their springs: THERMAL_SIGMAS √(2 k_BT/k)."""
    return (
        0.0 if scene.noise is None else THERMAL_SIGMAS * math.sqrt(2.0 * scene.noise.temperature / scene.bulk_stiffness)
    )


def force_scale_of(scene: Scene, law: DoubleExponential | None, largest: float) -> float:
    """The force maximum of one pair, or without attraction the force of the deepest particle."""
    if law is not None and law.attraction is not None:
        r = law.force_free_distance() + law.longest_range * np.linspace(0.0, 5.0, 2001)
        return float(-law.force(r).min())
    return (largest if largest > 0.0 else 1e-3 * scene.bodies.spacing) * scene.bulk_stiffness / 2


def loading_step_of(law: DoubleExponential | None, spacing: float, step: float) -> float:
    """The `step` [LU] if it is > 0, never more than a quarter of the longest range."""
    limit = 0.25 * law.longest_range if law is not None else 0.1 * spacing
    return min(step, limit) if step > 0 else limit


def plane_stiffness_of(scene: Scene, tolerance: float) -> float:
    """One-sided stiffness of the rigid plane.

    In series with a bond it is exact for a particle on its own (bond and plane 2k each give k), and without one, where
    particles are moved with their body, it is k. Neighbour springs and thermal motion see the bond alone, so with them
    the plane is 1/tolerance times stiffer than the chain.
    """
    if scene.bodies.lower != "rigid_plane":
        return 0.0
    stiffness = scene.bulk_stiffness
    if scene.stands:
        return stiffness
    if scene.neighbours is None and scene.noise is None:
        return 2.0 * stiffness
    neighbours = 0.0 if scene.neighbours is None else scene.neighbours.stiffness
    return (stiffness + 4.0 * neighbours) / tolerance


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


@dataclass(frozen=True, eq=False)
class Settings:
    """The numbers of one run; units as in the scene. Two are equal if they are the same object.

    Attributes:
        tolerance: that all of this is for; that of a refined pass is smaller than the scene's.
        particles: of the upper body.
        drive: the legs of a slide; `time_step` is that of the first one.
        beyond: how many more the lower body has, where it has any.
        rest: apex distance at displacement 0 [LU].
        law, cutoff, table, table_from: the interaction, its cutoff [LU], its table, and the distance [LU] from which on
            the table was chosen to follow the interaction; None or 0 on a rigid plane.
        closest: smallest distance for which moves and time step are chosen [LU].
        bulk_stiffness: normal bond of a particle to its anchor [FU/LU]; on a rigid plane such that plane and bond in
            series have the scene's value.
        plane_stiffness: one-sided stiffness of the rigid plane [FU/LU]; 0 without one.
        far: length of the long bond that makes normal and tangential stiffness differ [LU]; 0 where they do not.
        force_scale: force of one particle [FU] against which residuals are judged.
        force_tolerance: norm of the residual forces at which a minimisation stops [FU].
        displacement_step: increment of a search where pairs snap, and on a rigid plane [LU].
        loading_step: the same where particles are so far from each other that it is no danger [LU].
        smooth_step: increment of a search elsewhere, where the force is a smooth function of the displacement [LU].
        time_step: [TU].
        damping: coefficient of a particle [FU·TU/LU].
        damped_stiffness: of the contact [FU/LU], for which that is critical; 0 where it is the same under every load.
        plate_mass, plate_damping: [MU], [FU·TU/LU].
        settle_time: about one period of the plate on its contact [TU].
        longest_move: of a body between two states at rest [LU], inf on a rigid plane: a body that is moved by more than
            its particles' distance from the opposite ones is put behind them. A search may come nearer than `closest`,
            in moves down to NEAR_SHARE of this.
        largest_displacement: what the predictor expects [LU].
        calm_damping, calm_step: damping with which particles snap together and don't swing [FU·TU/LU], and the time
            step for it [TU]; the usual ones where the scene gives its damping. In a slide the one under which it is
            loaded, with which its plate does not swing.
        part: of increments, moves and loads over the usual ones, of a search that restarts in smaller steps.
    """

    tolerance: float
    particles: int
    rest: float
    law: DoubleExponential | None
    cutoff: float
    table: Table | None
    table_from: float
    closest: float
    bulk_stiffness: float
    plane_stiffness: float
    far: float
    force_scale: float
    force_tolerance: float
    displacement_step: float
    loading_step: float
    smooth_step: float
    longest_move: float
    time_step: float
    damping: float
    damped_stiffness: float
    plate_mass: float
    plate_damping: float
    settle_time: float
    largest_displacement: float
    estimate: ContactEstimate
    calm_damping: float
    calm_step: float
    part: float = 1.0
    beyond: int = 0
    drive: tuple[DriveLeg, ...] = ()

    @property
    def lower_particles(self) -> int:
        """Particles of the lower body, where it has any."""
        return self.particles + self.beyond

    def drag(self, damping: float | None = None) -> float:
        """On all that moves with the plate [FU·TU/LU], with another coefficient of a particle where one is given."""
        return self.particles * (self.damping if damping is None else damping) + self.plate_damping

    @property
    def gentle(self) -> bool:
        """Whether a relaxation moves no particle by more than `longest_move` at a time, and none oscillates in time."""
        return self.part < 1.0

    @property
    def snaps(self) -> bool:
        """Whether particles snap to the opposite ones and off them."""
        return self.law is not None and self.estimate.snaps

    @cached_property
    def is_toothed(self) -> bool:
        """Whether the tensile force has several maxima: pairs separate one by one; they snap, or nearly so."""
        return self.snaps or (self.law is not None and self.estimate.tooth(self.particles) < math.inf)

    @property
    def is_smooth(self) -> bool:
        """Whether the force is a smooth function of the displacement: particles, and none of them snaps."""
        return self.law is not None and not self.snaps

    @property
    def strongest(self) -> tuple[float, float]:
        """(distance [LU], tension [FU]) of the force maximum of a chain of opposite particles on one.

        Of the predictor, whose grid of distances ends at the cutoff; (0, 0) on a rigid plane.
        """
        if self.law is None:
            return 0.0, 0.0
        force = self.estimate.force
        at = int(force.argmin())
        return self.cutoff * (at + 1) / force.size, max(0.0, -float(force[at]))

    def increment(self, smallest_distance: float = math.inf) -> float:
        """Longest increment [LU] of a search from a state with this smallest distance [LU]; unloading has no such."""
        if not self.is_smooth:
            near = MOVE_SHARE * self.part * smallest_distance if smallest_distance < math.inf else 0.0
            return min(self.loading_step, max(self.displacement_step, near))
        return min(self.smooth_step, max(NEAR_SHARE * self.longest_move, MOVE_SHARE * smallest_distance))

    def rows_of(self, duration: float) -> tuple[int, int]:
        """Load steps of a motion of this duration [TU], and timesteps of each."""
        total = max(1, math.ceil(duration / self.time_step))
        rows = min(ROWS_IN_TIME, total)
        return rows, math.ceil(total / rows)

    def let_go_early(self, move: float) -> float:
        """Premature detachment [LU] of a pair under displacement increments `move` [LU]."""
        return self.estimate.let_go_early(move, self.force_tolerance)

    def in_smaller_steps(self, part: float) -> Settings:
        """The same, with increments and moves, also those of a relaxation, scaled by this factor.

        In time a particle that comes to the opposite one is stopped by drag, not by its core, where the scene leaves
        the drag open; it needs timesteps of its own.
        """
        return replace(
            self,
            part=part,
            damping=self.damping if self.plate_mass > 0.0 else self.calm_damping,
            time_step=self.calm_step,
            displacement_step=part * self.displacement_step,
            loading_step=part * self.loading_step,
            smooth_step=part * self.smooth_step,
            longest_move=part * self.longest_move,
        )


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


def _require_carried(scene: Scene) -> None:
    """Refuse a load beyond N A/a, the repulsion of N pairs at zero distance.

    Raises:
        NotCarriedError: with N A/a [FU].
    """
    bodies, load = scene.bodies, scene.experiment.compression
    particles = bodies.particles if bodies.upper_particles is None else bodies.upper_particles
    if load is None or scene.interaction is None or particles == "auto":
        return
    repulsion = scene.interaction.repulsion
    most = particles * repulsion.amplitude / repulsion.range
    if load > most:
        raise NotCarriedError(most)


def _chosen(scene: Scene, tolerance: float, calibration: Calibration) -> Settings:
    law = interaction_law(scene)
    bodies = scene.bodies
    require_room(bodies)
    shape: Profile = tabulated(bodies, bodies.spacing) if isinstance(bodies.profile, Measured) else bodies
    plane = plane_stiffness_of(scene, tolerance)
    in_series = law is None and not scene.stands
    bond = 1.0 / (1.0 / scene.bulk_stiffness - 1.0 / plane) if in_series else scene.bulk_stiffness
    cutoff, rest, closest = 0.0, 0.0, 0.0
    if law is None:
        estimate = estimate_on_plane(scene, shape)
    else:
        cutoff = cutoff_for(scene, law, calibration.cutoff * tolerance, tolerance)
        require_reach(scene, cutoff)
        rest = law.force_free_distance() if law.attraction is not None else cutoff
        closest = CLOSEST_SHARE * (rest if law.attraction is not None else law.repulsion.range)
        estimate = particles_estimate(
            law, shape, bodies.own_spacing, scene.bulk_stiffness, cutoff, rest, chains=scene.chains, row=bodies.spacing
        )
        _require_carried(scene)
    load = scene.experiment.compression
    largest = max(scene.experiment.places()) if load is None else estimate.displacement_at(load)
    particles, lower = chains_of(scene, estimate, largest, calibration.chain * tolerance)
    require_body(bodies, largest, particles)
    require_apex(scene, particles, cutoff)
    require_memory(scene, max(particles, lower), cutoff)
    require_travel(scene, largest, cutoff)
    force_scale = force_scale_of(scene, law, largest)
    require_digits(scene, particles, rest + largest, tolerance * force_scale)
    table_from, table = 0.0, None
    if law is not None:
        nearest = closest if scene.noise is not None else NEAR_SHARE * closest
        table_from = max(
            nearest, TABLE_MARGIN * (innermost_distance(estimate, cutoff, largest) - thermal_motion(scene))
        )
        table = table_for(law, cutoff, table_from, calibration.table * tolerance * force_scale)
    stiffest = stiffest_of(scene, law, closest, plane)
    dynamics = dynamics_of(scene, tolerance, estimate, largest, particles, stiffest, calibration.still_step)
    drive = drive_steps(scene, dynamics.time_step)
    different = scene.horizontal is not None and scene.tangential_stiffness != scene.bulk_stiffness
    longest_move = MOVE_SHARE * closest if law is not None else math.inf
    require_rows(scene, longest_move, drive)
    loading_step = loading_step_of(law, bodies.spacing, calibration.loading_increment * largest)
    return Settings(
        tolerance=tolerance,
        particles=particles,
        beyond=lower - particles,
        rest=rest,
        law=law,
        cutoff=cutoff,
        table=table,
        table_from=table_from,
        closest=closest,
        bulk_stiffness=bond,
        plane_stiffness=plane,
        far=FAR_SHARE / tolerance * bodies.spacing if different else 0.0,
        force_scale=force_scale,
        force_tolerance=calibration.residual * tolerance * force_scale,
        displacement_step=min(loading_step, longest_move),
        loading_step=loading_step,
        smooth_step=calibration.smooth_increment * law.longest_range if law is not None else 0.0,
        longest_move=longest_move,
        largest_displacement=largest,
        estimate=estimate,
        time_step=drive[0].time_step if drive else dynamics.time_step,
        drive=drive,
        damping=dynamics.damping,
        damped_stiffness=dynamics.damped_stiffness,
        plate_mass=dynamics.plate_mass,
        plate_damping=dynamics.plate_damping,
        settle_time=dynamics.settle_time,
        calm_damping=dynamics.calm_damping,
        calm_step=dynamics.calm_step,
    )
