"""Every number that a scene leaves open: chain length, cutoff, table, timestep, thresholds, increments.

Each is derived from `[accuracy] tolerance` (relative, on the main results): by its measured share of it, or by the rule
next to it. The shares are in `calibration.json`, which `python -m validation.tools.calibration` writes: it varies every
value over a ladder in a number of scenes, at tolerances of 1e-2 to 1e-5, and takes the cheapest that adds a small part
of the tolerance at most to the errors of the main results in each of them; the residual has a set limit, too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np

from contact1d.digits import apart
from contact1d.potentials.table import FEWEST_POINTS, Table
from contact1d.workflow.errors import SettingsError
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
    MOVE_SHARE,
    NEAR_SHARE,
    Chains,
    Forces,
    Increments,
    PairForces,
    plane_stiffness_of,
    stiffest_of,
)
from contact1d.workflow.scene import Impact, Interaction, Scene
from contact1d.workflow.scene.remedies import less_compression

STAGGER_SHARE = 5e-4
"""Alternating shift of a plate's anchors out of the plane, over the chain's length.

No force acts in that direction, but `fix rigid` refuses a body that is nearly a line ("Bad principal moments"): the
least moment of inertia must be more than 1e-7 of the largest, and is 12 STAGGER² = 3e-6 of it.
"""


@dataclass(frozen=True, eq=False)
class Settings:
    """The numbers of one run, in the scene's LU, FU and TU. Two are equal if they are the same object.

    Attributes:
        tolerance: relative tolerance of the main results; that of a refined pass is smaller than the scene's.
        law: contact law.
        forces: forces on a particle, their cutoff, table and residual.
        chains: numbers of particles.
        increments: displacement increments of a search.
        motion: timestep, masses and damping.
        largest_displacement: largest displacement that the contact law predicts, or that is prescribed [LU].
    """

    tolerance: float
    law: Law
    forces: Forces
    chains: Chains
    increments: Increments
    motion: Motion
    largest_displacement: float = measured("LU")

    def drag(self, damping: float | None = None) -> float:
        """Return the drag on plate and particles together [FU·TU/LU]: N times that of a particle, plus the plate's.

        `damping`: coefficient of a particle [FU·TU/LU]; None: that of these settings.
        """
        coefficient = self.motion.damping if damping is None else damping
        return self.chains.upper * coefficient + self.motion.plate_damping

    @property
    def gentle(self) -> bool:
        """Whether this is a search that restarted in smaller steps, whose increments are scaled by a factor below 1.

        Then a relaxation moves no particle by more than `longest_move` at a time, and none oscillates in time.
        """
        return self.increments.part < 1.0

    @property
    def snaps(self) -> bool:
        """Whether pairs of particles snap in and out by the contact law, so that loading and unloading differ."""
        return self.law.snaps

    @cached_property
    def has_several_maxima(self) -> bool:
        """Whether the tensile force has several maxima: pairs separate one by one, with a snap-out or nearly so.

        False on a rigid plane. Cached.
        """
        return self.snaps or (self.is_smooth and self.law.maxima_distance(self.chains.upper) < math.inf)

    @property
    def is_smooth(self) -> bool:
        """Whether opposite particles interact and none snaps, so that F(d) is smooth; False on a rigid plane."""
        return self.forces.range > 0.0 and not self.snaps

    @property
    def strongest(self) -> tuple[float, float]:
        """(Distance [LU], tension [FU] ≥ 0) at the force maximum of one particle opposite a chain.

        By the contact law on its grid of distances, which ends at the cutoff. Without attraction it is (cutoff, 0), on
        a rigid plane (0, 0), also with adhesion.
        """
        force = self.law.force
        peak = int(force.argmin())
        return self.forces.cutoff * (peak + 1) / force.size, max(0.0, -float(force[peak]))

    def increment(self, smallest_distance: float = math.inf) -> float:
        """Return the longest increment [LU] > 0 of a search from a state with a smallest distance of particles [LU].

        Where F(d) is smooth: a quarter of the distance, at least a fifth of the longest move, at most `smooth_step`.
        Else a quarter of the distance times `part` (0 for an infinite one), at least `displacement_step`, at most
        `loading_step`. In unloading the distance is infinite, the default: `smooth_step`, or else `displacement_step`.
        """
        increments = self.increments
        if not self.is_smooth:
            near = MOVE_SHARE * increments.part * smallest_distance if smallest_distance < math.inf else 0.0
            return min(increments.loading_step, max(increments.displacement_step, near))
        shortest = NEAR_SHARE * increments.longest_move
        return min(increments.smooth_step, max(shortest, MOVE_SHARE * smallest_distance))

    def steps_of(self, duration: float, states: int = 100) -> list[int]:
        """Return the numbers of timesteps of the load steps of a motion of this duration [TU], in order.

        The first load step has one timestep; up to `states` nearly equal ones follow, fewer where there are fewer
        timesteps. Their sum is the duration over the timestep, rounded; [] where that is 0.
        """
        total = round(duration / self.motion.time_step)
        ends = np.unique(np.linspace(1, total, min(states, total - 1) + 1).round())
        return [int(steps) for steps in np.diff(ends, prepend=0.0)]

    def in_smaller_steps(self, part: float) -> Settings:
        """Return a copy with increments and moves, also those of a relaxation, scaled by a factor `part`.

        Its timestep is the settling timestep. Without a plate, its damping is the settling damping, which stops a
        particle that approaches the opposite one before its repulsion does; where the scene gives the damping this is
        the same.
        """
        motion = self.motion
        damping = motion.damping if motion.plate_mass > 0.0 else motion.settling_damping
        timed = replace(motion, damping=damping, time_step=motion.settling_step)
        return replace(self, motion=timed, increments=self.increments.scaled(part))


@lru_cache(maxsize=1)  # a scene whose spacing is chosen has its settings then
def settings_for(scene: Scene, tolerance: float | None = None, calibration: Calibration | None = None) -> Settings:
    """Return the settings of a scene, with a choice of every number that it leaves open but the spacing.

    An automatic spacing must have been replaced before (`with_spacing`). The latest result is cached: the same call
    returns the same object.

    Args:
        scene: whose numbers are left open.
        tolerance: relative, in place of the scene's own, for a refined pass; None: the scene's own.
        calibration: in place of the one that was measured; None: that one.

    Raises:
        SettingsError: the numbers are so far apart that no chain, table or timestep follows from them, a limit of
            size is exceeded, the profile falls within its chain or is covered by the contact, an adhesive contact has
            no solution for the body, the body sticks after an impact, or the bodies cannot carry the load.
        AssertionError: the spacing is "auto".
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


def slower(scene: Scene, settings: Settings, factor: float = 2.0) -> list[tuple[Scene, Settings]]:
    """Return one or two pairs (scene, settings) of the same motion, to estimate its error in time.

    The first has timesteps `factor` times as long (a whole part of a given duration) and, with [neighbours] or [noise]
    on a rigid plane, a plane `factor` times softer. The second has the usual timestep or a longer one, automatic drags
    times `factor` and automatic masses times its square; it is missing where that changes no number of the motion. The
    mass of particles counts as automatic where the scene does not give it and it has an effect. An error of first order
    in these changes by its own amount at least.
    """
    usual, forces, duration = settings.motion, settings.forces, scene.experiment.lasts
    longer = whole_steps(factor * usual.time_step, duration)
    if not scene.stands and forces.plane_stiffness > 0.0:
        plane = forces.plane_stiffness / factor
        forces = replace(forces, plane_stiffness=plane, bulk_stiffness=_bond_on_plane(scene.bulk_stiffness, plane))
    coarser = [(scene, replace(settings, forces=forces, motion=replace(usual, time_step=longer)))]
    bodies, plate, damping = scene.bodies, scene.plate, scene.damping
    if "mass" not in bodies.model_fields_set and not scene.experiment.is_massless:
        bodies = bodies.model_copy(update={"mass": factor**2 * bodies.mass})
    if plate and plate.mass == "auto":
        plate = plate.model_copy(update={"mass": factor**2 * usual.plate_mass})
    drag = usual.damping * (factor if damping and damping.coefficient == "auto" else 1.0)
    plate_drag = usual.plate_damping * (factor if plate and plate.damping == "auto" else 1.0)
    heavier = scene.model_copy(update={"bodies": bodies, "plate": plate})
    motion = settings_for(heavier, settings.tolerance).motion
    step = whole_steps(motion.time_step, duration)
    motion = replace(motion, damping=drag, plate_damping=plate_drag, time_step=step)
    return [*coarser, (heavier, replace(settings, motion=motion))] if motion != usual else coarser


def _stopped(scene: Scene, law: Law, rounds: int = 4) -> float:
    """Return the displacement [LU] at which a body that hits the plane is at rest, deeper where it relaxes meanwhile.

    0 for any experiment but an impact; infinite beyond the displacement up to which the law knows the force. `rounds`:
    number of iterations of the displacement with the time of the impact, 1 at least; none changes an elastic body's.

    Raises:
        SettingsError: the body sticks to the plane instead of rebounding.
    """
    depth, experiment = stopped_at(scene, law), scene.experiment
    if not isinstance(experiment, Impact):
        return depth
    for _ in range(rounds):
        time = 2.0 * depth / experiment.velocity
        if (softer := law.creep(time)) == 1.0:
            break
        depth = stopped_at(scene, law, softer)
    if sticks := law.sticking(scene.impact_mass, experiment.velocity, time):
        raise SettingsError(
            f"the body sticks: it {sticks[0]}, for longer than is followed, where an impact of the elastic body takes "
            f"some {time:.4g} TU: give {sticks[1]} in [viscoelasticity]"
        )
    return depth


def _bond_on_plane(stiffness: float, plane: float) -> float:
    """Return the stiffness of a bond [FU/LU] that in series with the `plane` has the particle's `stiffness` [FU/LU].

    The plane must be the stiffer one.

    Raises:
        ZeroDivisionError: both are equal, or one is 0.
    """
    return 1.0 / (1.0 / stiffness - 1.0 / plane)


def _require_carried(scene: Scene) -> None:
    """Refuse a load beyond N A/a, the repulsion of N pairs at zero distance, with its amplitude A and range a.

    N is the number of the upper body. Nothing is refused where it is automatic, or where displacements are prescribed.

    Raises:
        NotCarriedError: has N A/a [FU] as `most`.
        StopIteration: the scene has no interaction.
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
    """Return the settings of a scene: forces, load, chains, table, motion and increments are chosen in this order.

    `tolerance`: relative; `calibration`: shares of it that each number may use up.

    Raises:
        SettingsError: a limit of size, no solution of the law for this body, or an impact after which the body sticks.
        NotCarriedError: a load beyond the repulsion.
        OverflowError, FloatingPointError, ZeroDivisionError: the magnitudes in the scene differ too much.
    """
    bodies = scene.bodies
    require_room(bodies)
    forces, estimate = _forces(scene, tolerance, calibration)
    load = scene.experiment.compression
    if load is None:
        largest = max(scene.experiment.places(), default=0.0) or _stopped(scene, estimate)
    else:
        largest = estimate.displacement_at(load * estimate.creep(scene.experiment.lasts or 0.0))
    chains = _chains(scene, estimate, forces, largest, calibration.chain * tolerance)
    scale = forces.scale_of(scene, estimate.largest_length_change(largest))
    require_digits(scene, chains.upper, forces.rest + largest, tolerance * scale)
    forces = replace(forces, scale=scale, residual=calibration.residual * tolerance * scale)
    forces = forces.with_table(scene, estimate, largest, calibration.table * tolerance * scale)
    stiffest = stiffest_of(scene) + max(0.0, scene.tangential_stiffness - scene.bulk_stiffness)
    stiffest += forces.stiffest(bodies.spacing)
    motion = motion_of(scene, tolerance, estimate, largest, chains.upper, stiffest, calibration.still_step)
    increments = forces.increments(bodies.spacing, largest, calibration)
    require_rows(scene, increments.longest_move, motion.drive)
    different = scene.horizontal and scene.tangential_stiffness != scene.bulk_stiffness
    # A lateral move u turns the force of a long bond by u/2L.
    chains = replace(chains, far=10.0 / tolerance * bodies.spacing if different else 0.0)
    return Settings(tolerance, estimate, forces, chains, increments, motion, largest)


def _forces(scene: Scene, tolerance: float, calibration: Calibration) -> tuple[Forces, Law]:
    """Return (the forces on a particle, the contact law), before chains and table are chosen.

    On a rigid plane the forces are springs and plane; with [neighbours] or [noise] the bond of a particle is stiffer
    than given, so that with the plane in series it has the given stiffness. Of opposite chains they have the
    interaction, its cutoff and a preliminary table. Force scale and residual are 0 in both. `tolerance`: relative.

    Raises:
        SettingsError: the cutoff reaches too far, or the law has no solution for this body.
        NotCarriedError: a load beyond the repulsion.
    """
    law, bodies, spring = interaction_law(scene), scene.bodies, scene.bulk_stiffness
    shape: Undeformed = bodies
    if bodies.profile.slow:
        shape = tabulated(bodies, bodies.spacing, law_of(scene).table)
    if law is None:
        plane = plane_stiffness_of(scene, tolerance)
        bond = spring if scene.stands else _bond_on_plane(spring, plane)
        return Forces(bulk_stiffness=bond, plane_stiffness=plane), law_of(scene).of(scene, shape)
    cutoff = cutoff_for(scene, law, calibration.cutoff * tolerance, tolerance)
    require_reach(scene, cutoff)
    rest, length = cutoff, law.repulsion.range
    if law.attraction is not None:
        rest = length = law.force_free_distance()
    closest = 0.2 * length  # the smallest distance for which moves and timestep are chosen
    estimate = of_pairs(law, shape, bodies.own_spacing, spring, cutoff, rest, chains=scene.chains, row=bodies.spacing)
    _require_carried(scene)
    table = Table(law, cutoff, FEWEST_POINTS)  # until it is known how near particles come
    return PairForces(bulk_stiffness=spring, table=table, cutoff=cutoff, rest=rest, closest=closest), estimate


def _chains(scene: Scene, estimate: Law, forces: Forces, largest: float, share: float) -> Chains:
    """Return the numbers of particles of both bodies, as the scene gives them or the contact needs them.

    `far`, the length of long bonds, is 0 in the result.

    Args:
        scene: whose chains they are.
        estimate: contact law.
        forces: with the cutoff.
        largest: largest displacement [LU].
        share: relative force at the end of an automatic chain.

    Raises:
        SettingsError: they do not fit the profile, the displacement or the memory of the machine.
    """
    upper, lower = chains_of(scene, estimate, largest, share)
    require_body(scene.bodies, largest, upper)
    require_apex(scene, upper, forces.cutoff)
    require_memory(scene, max(upper, lower), forces.cutoff)
    require_travel(scene, largest, forces.cutoff)
    return Chains(upper, lower, 0.0)
