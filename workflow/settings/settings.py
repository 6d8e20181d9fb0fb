"""Every number that a scene leaves open: chain length, cutoff, table, time step, thresholds, increments.

Each is derived from `[accuracy] tolerance` (relative, on the main results): by its measured share of it
(`workflow.settings.calibration`), or by the rule stated beside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from contact1d.potentials import DoubleExponential
from contact1d.potentials.table import Table, table_for
from contact1d.workflow.scene import Measured, Scene
from contact1d.workflow.scene.remedies import less_compression
from contact1d.workflow.settings.adhesion import estimate_on_plane
from contact1d.workflow.settings.calibration import CALIBRATION, Calibration
from contact1d.workflow.settings.chain import SettingsError as SettingsError
from contact1d.workflow.settings.chain import chains_of, require_body, require_room
from contact1d.workflow.settings.drive import DriveLeg, drive_steps
from contact1d.workflow.settings.dynamics import dynamics_of, stiffest_of
from contact1d.workflow.settings.estimate import ContactEstimate, NotCarriedError, particles_estimate
from contact1d.workflow.settings.scales import (
    cutoff_for,
    force_scale_of,
    innermost_distance,
    interaction_law,
    loading_step_of,
    plane_stiffness_of,
    thermal_motion,
)
from contact1d.workflow.settings.shape import Profile, tabulated
from contact1d.workflow.settings.size import (
    require_apex,
    require_digits,
    require_memory,
    require_reach,
    require_rows,
    require_travel,
)

TABLE_MARGIN = 0.8
"""Distance from which on a table is to follow the law, over the expected smallest one. Measured: the smallest distance
is 0.93 to 1.004 of what the estimate of independent pairs says."""
CLOSEST_SHARE = 0.2
"""Smallest distance that is looked after over the force-free one (with attraction) or the repulsion's range."""
MOVE_SHARE = 0.25
"""Longest move of a body between two states at rest, over the smallest distance: particles stay in order, down to r
near 0."""
NEAR_SHARE = 0.2
"""Least distance down to which a table follows the law and a search comes down in ever smaller moves, over `closest`: a
table that is smoothed any earlier lets bodies through that the law still carries."""
ROWS_IN_TIME = 100
"""States of a motion that is followed for a given time."""
FAR_SHARE = 10.0
"""Length of a long bond over the spacing, per 1/tolerance: a sideways move u bends its force by u/2L."""
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
            the table was chosen to follow the law; None or 0 on a rigid plane.
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
        largest_displacement: what the estimate expects [LU].
        calm_damping, calm_step: damping with which particles snap together and don't swing [FU·TU/LU], and the time
            step for it [TU]; the usual ones where the scene gives its damping. In a slide the one under which it is
            loaded, with which its plate does not swing.
        part: of increments, moves and loads over the usual ones, of a search that begins anew in smaller steps.
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

    @property
    def gentle(self) -> bool:
        """Whether a relaxation moves no particle by more than `longest_move` at a time, and none swings in time."""
        return self.part < 1.0

    @property
    def snaps(self) -> bool:
        """Whether particles snap to the opposite ones and off them."""
        return self.law is not None and self.estimate.snaps

    @cached_property
    def is_toothed(self) -> bool:
        """Whether the tension falls between two of its tops: pairs let go one by one; they snap, or nearly so."""
        return self.snaps or (self.law is not None and self.estimate.tooth(self.particles) < math.inf)

    @property
    def is_smooth(self) -> bool:
        """Whether the force is a smooth function of the displacement: particles, and none of them snaps."""
        return self.law is not None and not self.snaps

    @property
    def strongest(self) -> tuple[float, float]:
        """(distance [LU], tension [FU]) where the force of a row of opposite particles on one is the largest tension.

        Of the estimate, whose grid of distances ends at the cutoff; (0, 0) on a rigid plane.
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
        """Rows of a motion that takes so long [TU], and timesteps of each."""
        total = max(1, math.ceil(duration / self.time_step))
        rows = min(ROWS_IN_TIME, total)
        return rows, math.ceil(total / rows)

    def let_go_early(self, move: float) -> float:
        """How far [LU] before its time a pair lets go of a body that is drawn away by `move` [LU] at a time."""
        return self.estimate.let_go_early(move, self.force_tolerance)

    def in_smaller_steps(self, part: float) -> Settings:
        """The same, with increments and moves that are this part as long, also those of a relaxation.

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
        raise SettingsError(
            f"a load of {scene.experiment.compression:.6g} FU is more than these bodies carry: their particles stand "
            f"on each other from about {error.most:.4g} FU on. Lower the load, or take a stronger repulsion",
            changes=less_compression(scene, error.most),
        ) from None
    except (OverflowError, FloatingPointError, ZeroDivisionError, MemoryError) as error:
        raise SettingsError(
            f"the scene's numbers are too far apart to compute with ({error}): compare its lengths (spacing, ranges, "
            "radius), its energies (amplitudes) and its stiffnesses with each other"
        ) from None
    return chosen


def _require_carried(scene: Scene) -> None:
    """Refuse a load beyond N A/a, the repulsion of N pairs that stand on each other.

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
