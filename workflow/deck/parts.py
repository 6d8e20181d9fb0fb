"""The parts of bodies, lower body, units and method in a deck, besides those of the effects; the simulation box.

LAMMPS bins the whole box, with five integers for a cube of half the reach of the forces: for long chains that is most
of the memory, and for a steep body, whose ends rise far beyond all forces, more than there is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contact1d.workflow.deck.effects import LEAST_SLENDERNESS, Contribution, Stage, number, skin
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.units import DeckUnits
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.chain import MIX_UP
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Impact, Scene

MINIMISER_ITERATIONS = 20_000
CHOSEN_BINS = ("far_bin", "wide_bin")
"""Variables with which effects choose the edge of a bin."""


def rigidly_mounted(scene: Scene, settings: Settings) -> list[Contribution]:
    """Return the deck parts (fragments, variables) of an upper body with fixed particles over a rigid plane.

    The plane has the springs of the particles. A list, in this order, of body, plane, and motion by one timestep for
    each load step; in a dynamic scene of body, plane, measured force and clock.
    """
    if not scene.is_stepped:
        clock = Contribution("dynamic", Stage.MOTION, ("clock",), {"time_step": number(settings.motion.time_step)})
        body = Contribution("bodies", Stage.BODIES, ("standing_plate",))
        measured = Contribution("contact", Stage.MEASURED, ("contact_force",))
        return [body, _plane("rigid_plane", scene, settings), measured, clock]
    steps = ("sweep", "along") if scene.experiment.goes_along else ("sweep",)
    motion = Contribution("quasistatic", Stage.MOTION, steps)
    return [Contribution("bodies", Stage.BODIES, ("standing",)), _plane("standing_plane", scene, settings), motion]


def free_to_move(scene: Scene, settings: Settings) -> list[Contribution]:
    """Return the deck parts (fragments, variables) of bodies with free particles, each on the spring of its bulk.

    A list of bodies, guide (the fixes that keep particles from moving along y, without [horizontal] also along x) and
    method, and as the scene has them of the rigid plane, the rigid chain and the periodic box, in this order.
    """
    softer = min(settings.forces.bulk_stiffness, scene.tangential_stiffness)
    coefficient = softer if settings.chains.far else settings.forces.bulk_stiffness
    parts = [
        Contribution(
            "bodies",
            Stage.BODIES,
            ("bodies",),
            {"bulk_bond_coefficient": number(coefficient / 2)},
            springs=("bulk_springs",),
        ),
        Contribution("guide", Stage.GUIDE, ("guide",), {} if scene.horizontal else {"guide_x": "0.0"}),
        _method(scene, settings),
    ]
    if scene.bodies.lower == "rigid_plane":
        parts.append(_plane("rigid_plane", scene, settings))
    if scene.bodies.lower == "rigid_chain":
        parts.append(Contribution("rigid_chain", Stage.GUIDE, ("rigid_chain",)))
    if scene.bodies.periodic:
        parts.append(Contribution("periodic", Stage.BODIES, ("periodic",)))
    return parts


def bins(scene: Scene, settings: Settings, parts: Sequence[Contribution], most: int = 4_000_000) -> list[Contribution]:
    """Return [part], one that enlarges the bins of LAMMPS's neighbour lists, so that the box has `most` at most; or [].

    [] where it has no more anyway: then the edge of a bin is half the reach of the forces, LAMMPS's choice, or what one
    of the `parts` has set, if that is larger. Else the edge is doubled until it suffices, but to 50 times the shortest
    edge of the box at most, so that there may be more than `most`. By default bins take some 100 MB.

    Raises:
        SettingsError: the box has too many bins for LAMMPS, even of the largest size.
    """
    chosen = [float(part.variables[name]) for part in parts for name in CHOSEN_BINS if name in part.variables]
    corners = [body.corners for body in bodies(scene, settings)]
    edges = np.ptp(np.concatenate(corners), axis=0) + 2.0 * np.asarray(margins(scene, settings), dtype=np.float64)
    default = edge = max([*chosen, 0.5 * reach(scene, settings)])

    def exceed(bin_edge: float, limit: float) -> bool:
        """Return whether the box has more bins of this edge [LU] than the limit, a number of bins."""
        return bool(np.log(np.maximum(edges / bin_edge, 1.0)).sum() > math.log(limit))  # the number may overflow

    while exceed(edge, most):
        edge *= 2.0
    least = min(edge, float(edges.min()) / LEAST_SLENDERNESS)
    countable = 2**31 / 27  # LAMMPS adds bins on each side of each edge, and counts them with 32 bits
    if exceed(least, countable):
        raise SettingsError(
            f"the bodies would fill a box of {edges[0]:.3g} LU by {edges[2]:.3g} LU, and their forces reach over "
            f"{reach(scene, settings):.3g} LU only: use a smaller load or displacement, stiffer springs or a larger "
            f"radius. {MIX_UP}"
        )
    return [] if edge == default else [Contribution("bins", Stage.MOTION, ("bins",), {"bin_edge": number(least)})]


def unit_conversion(units: DeckUnits) -> Contribution:
    """Return the part with the variables that convert the numbers of a deck with rescaled units to LU and FU.

    They are one deck unit of length [LU] and of force [FU].
    """
    variables = {"unit_length": number(units.length), "unit_force": number(units.force)}
    return Contribution("units", Stage.MOTION, ("units",), variables)


def plane_depth(scene: Scene, settings: Settings) -> float:
    """Return the depth of the wall's origin below the plane, positive [LU].

    It is 1000 times the larger one of the largest displacement and the spacing of the lower body.
    """
    return 1e3 * max(settings.largest_displacement, scene.bodies.spacing)


def _plane(fragment: str, scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part of a rigid plane: a one-sided wall with its stiffness, by the fragment of this name.

    Variables are the z of the wall's origin, below 0, its reach, of the same magnitude, and half its stiffness, for
    "rigid_plane" also the whole, in the units [LU], [FU/LU] of `scene` and `settings`.
    """
    depth = plane_depth(scene, settings)
    variables = {
        "plane_position": number(-depth),
        "plane_reach": number(depth),
        "plane_half_stiffness": number(settings.forces.plane_stiffness / 2),
    }
    if fragment == "rigid_plane":
        variables["plane_stiffness"] = number(settings.forces.plane_stiffness)
    return Contribution("rigid_plane", Stage.SPRINGS, (fragment,), variables)


def _method(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part of the method: relaxation by the minimiser in a quasi-static scene, else motion in time.

    Variables are the residual force, the most iterations and the first step of a relaxation, and, where the
    minimiser is to make short moves, their length and the residual up to which it does; of a motion the timestep.
    """
    if scene.method == "quasistatic":
        variables = {
            "force_tolerance": number(settings.forces.residual),
            "minimiser_iterations": str(MINIMISER_ITERATIONS),
            # The first step of a relaxation: ten times as much is 0.5/ω_max.
            "relaxation_step": number(0.1 * settings.motion.time_step),
        }
        if settings.gentle:
            variables["gentle_move"] = number(settings.increments.longest_move)
            # Below this residual gentle moves have led into a minimum, in which Newton's method converges.
            variables["gentle_tolerance"] = number(1e-3 * settings.forces.scale)
        return Contribution("quasistatic", Stage.MOTION, ("quasistatic",), variables)
    variables = {"time_step": number(settings.motion.time_step)}
    return Contribution("dynamic", Stage.MOTION, ("dynamic",), variables, integrates="particles")


def margins(scene: Scene, settings: Settings) -> tuple[float, float, float]:
    """Return the free space along x, y and z [LU] on each side between the bodies and the walls of the box.

    They are rounded up to whole numbers: along x 20 spacings and the largest displacement of the drive or the path
    along x, or that of a body that hits obliquely; along y 1 LU; along z ten spacings or ten cutoffs, whichever is
    more, and twice the largest displacement, both ten times as much for a free plate with noise or in a slide, and the
    largest prescribed separation. More where the box would be thin compared with bins or long bonds.
    """
    spacing = scene.bodies.spacing
    side = 20.0 * spacing + scene.experiment.excursion
    if isinstance(scene.experiment, Impact):  # twice as long as half an oscillation
        side += 2.0 * math.pi * abs(scene.slip_velocity) * settings.largest_displacement / scene.experiment.velocity
    head = 10.0 * max(spacing, settings.forces.cutoff) + 2 * abs(settings.largest_displacement)
    if scene.plate and (scene.noise or scene.experiment.motion_is_result):
        head *= 10.0  # a free plate may fly off between two measurements; under a held load LAMMPS stops it
    head -= min([0.0, *scene.experiment.places()])
    # LAMMPS wants no box much thinner than its bins, nor than long bonds.
    least = max(1e-3 * settings.chains.far, LEAST_SLENDERNESS * reach(scene, settings))
    side, flat, head = (math.ceil(max(margin, least)) for margin in (side, 1.0, head))
    return side, flat, head


def reach(scene: Scene, settings: Settings) -> float:
    """Return the distance [LU] up to which LAMMPS lists neighbours: cutoff and half a spacing as skin."""
    return settings.forces.cutoff + skin(scene)
