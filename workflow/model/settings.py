"""Every number that a scene leaves open: chain length, cutoff, table, time step, thresholds, increments.

Each is derived from `[accuracy] tolerance` (relative, on the main results): by its measured share of it, or by the rule
stated beside it. The shares are in `calibration.json`, which `python -m validation.tools.calibration` writes: it turns
every value over a ladder in a number of scenes, at tolerances of 1e-2 to 1e-5, and takes the cheapest that adds a small
part of the tolerance at most to the errors of the main results in each of them; the residual has a set limit, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from contact1d.digits import apart
from contact1d.potentials.table import FEWEST_POINTS, Table
from contact1d.workflow.errors import SettingsError as SettingsError
from contact1d.workflow.laws import law_of
from contact1d.workflow.laws.law import Law, NotCarriedError, stopped_at
from contact1d.workflow.laws.pairs import interaction_law, of_pairs
from contact1d.workflow.laws.shape import Profile as Undeformed
from contact1d.workflow.laws.shape import tabulated
from contact1d.workflow.model.calibration import CALIBRATION, Calibration
from contact1d.workflow.model.chain import (
    chains_of,
    require_apex,
    require_body,
    require_digits,
    require_memory,
    require_reach,
    require_room,
    require_rows,
    require_travel,
)
from contact1d.workflow.model.cutoff import cutoff_for
from contact1d.workflow.model.dynamics import Motion, measured, motion_of, whole_steps
from contact1d.workflow.model.forces import (
    CLOSEST_SHARE,
    MOVE_SHARE,
    NEAR_SHARE,
    Chains,
    Forces,
    Increments,
    PairForces,
    plane_stiffness_of,
    stiffest_of,
)
from contact1d.workflow.scene import Impact, Interaction, Plate, Scene
from contact1d.workflow.scene.remedies import less_compression

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
    def has_several_maxima(self) -> bool:
        """Whether the tensile force has several maxima: pairs separate one by one; they snap, or nearly so."""
        return self.snaps or (self.is_smooth and self.law.maxima_distance(self.chains.upper) < math.inf)

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

    def premature_detachment(self, move: float) -> float:
        """Premature detachment [LU] of a pair under displacement increments `move` [LU]."""
        return self.law.premature_detachment(move, self.forces.residual)

    def in_smaller_steps(self, part: float) -> Settings:
        """The same, with increments and moves, also those of a relaxation, scaled by this factor.

        In time a particle that comes to the opposite one is stopped by drag, not by its core, where the scene leaves
        the drag open; it needs timesteps of its own.
        """
        motion = self.motion
        damping = motion.damping if motion.plate_mass > 0.0 else motion.calm_damping
        timed = replace(motion, damping=damping, time_step=motion.calm_step)
        return replace(self, motion=timed, increments=self.increments.scaled(part))


@lru_cache(maxsize=1)  # a scene whose spacing is chosen has its settings then
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


def _stopped(scene: Scene, law: Law) -> float:
    """Displacement [LU] at which a body that hits the plane is at rest, one that relaxes meanwhile deeper.

    Raises:
        SettingsError: it sticks.
    """
    found, given = stopped_at(scene, law), scene.experiment
    if not isinstance(given, Impact):
        return found
    for _ in range(CREEPING):
        time = 2.0 * found / given.velocity
        if (softer := law.creep(time)) == 1.0:
            break
        found = stopped_at(scene, law, softer)
    mass = scene.the(Plate).mass
    assert mass != "auto"
    if sticks := law.sticking(mass, given.velocity, time):
        raise SettingsError(
            f"the body sticks: it {sticks[0]}, for longer than is followed, where an impact of the elastic body takes "
            f"some {time:.4g} TU: give {sticks[1]} in [viscoelasticity]"
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
        largest = estimate.displacement_at(load * estimate.creep(scene.experiment.lasts or 0.0))
    chains = _chains(scene, estimate, forces, largest, calibration.chain * tolerance)
    scale = forces.scale_of(scene, estimate.strained(largest))
    require_digits(scene, chains.upper, forces.rest + largest, tolerance * scale)
    forces = replace(forces, scale=scale, residual=calibration.residual * tolerance * scale)
    forces = forces.with_table(scene, estimate, largest, calibration.table * tolerance * scale)
    stiffest = stiffest_of(scene) + max(0.0, scene.tangential_stiffness - scene.bulk_stiffness)
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
    if bodies.profile.slow:
        shape = tabulated(bodies, bodies.spacing, law_of(scene).table)
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
