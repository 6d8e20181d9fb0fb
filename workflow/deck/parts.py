"""What bodies, lower body, units and method bring to a deck beside the effects, and the box around the bodies.

LAMMPS bins the whole box, five integers for a cube of half the reach of the forces: of long chains that is most of the
memory, and of a steep body, whose ends rise far beyond all forces, more than there is.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from contact1d.workflow.deck.effects import LEAST_SLENDERNESS, Contribution, Stage, number
from contact1d.workflow.deck.effects.interaction import SKIN
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.units import DeckUnits
from contact1d.workflow.errors import SettingsError
from contact1d.workflow.model.chain import MIX_UP
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

PLANE_DEPTH = 1e3
"""Distance of the wall's origin below the plane over the deepest expected displacement."""
MINIMISER_ITERATIONS = 20_000
RELAXATION = 0.1
"""First step of a relaxation over the time step of a run in time: ten times as much is 0.5/ω_max."""
GENTLE_RESIDUAL = 1e-3
"""Residual force over one particle's at which gentle moves have led into a minimum that Newton's method finishes."""
CHOSEN_BINS = ("far_bin", "wide_bin")
"""Variables with which effects choose the edge of a bin."""


def standing(scene: Scene, settings: Settings) -> list[Contribution]:
    """A body with fixed particles over a rigid plane that has their springs: in single steps, or moved in time."""
    if not scene.is_stepped:
        clock = Contribution("dynamic", Stage.MOTION, ("clock",), {"time_step": number(settings.motion.time_step)})
        body = Contribution("bodies", Stage.BODIES, ("standing_plate",))
        measured = Contribution("contact", Stage.MEASURED, ("contact_force",))
        return [body, _plane("rigid_plane", scene, settings), measured, clock]
    steps = ("sweep", "along") if scene.experiment.goes_along else ("sweep",)
    motion = Contribution("quasistatic", Stage.MOTION, steps)
    return [Contribution("bodies", Stage.BODIES, ("standing",)), _plane("standing_plane", scene, settings), motion]


def moving(scene: Scene, settings: Settings) -> list[Contribution]:
    """Bodies whose particles find their own positions, each on the spring of its bulk."""
    softer = min(settings.forces.bulk_stiffness, scene.tangential_stiffness)
    coefficient = softer if settings.chains.far else settings.forces.bulk_stiffness
    found = [
        Contribution("bodies", Stage.BODIES, ("bodies",), {"bulk_bond_coefficient": number(coefficient / 2)}),
        Contribution("guide", Stage.GUIDE, ("guide",), {} if scene.horizontal else {"guide_x": "0.0"}),
        _method(scene, settings),
    ]
    if scene.bodies.lower == "rigid_plane":
        found.append(_plane("rigid_plane", scene, settings))
    if scene.bodies.lower == "rigid_chain":
        found.append(Contribution("rigid_chain", Stage.GUIDE, ("rigid_chain",)))
    if scene.bodies.periodic:
        found.append(Contribution("periodic", Stage.BODIES, ("periodic",)))
    return found


def bins(scene: Scene, settings: Settings, brought: Sequence[Contribution]) -> list[Contribution]:
    """The edge of a bin with which the box has MOST_BINS at most; none where it has no more as LAMMPS chooses it.

    LAMMPS's own choice is half the reach of the forces, where nothing that is `brought` has chosen another one.

    Raises:
        SettingsError: even the largest bins are more than LAMMPS can count.
    """
    chosen = [float(part.variables[name]) for part in brought for name in CHOSEN_BINS if name in part.variables]
    atoms = [group for body in bodies(scene, settings) for group in (body.particles, body.anchors, body.far_anchors)]
    everywhere = np.concatenate(atoms)
    edges = np.ptp(everywhere, axis=0) + 2.0 * np.asarray(margins(scene, settings), dtype=np.float64)
    own = edge = max([*chosen, 0.5 * reach(scene, settings)])

    def exceed(edge: float, most: float) -> bool:
        return bool(np.log(np.maximum(edges / edge, 1.0)).sum() > math.log(most))  # the number itself may overflow

    while exceed(edge, MOST_BINS):
        edge *= 2.0
    least = min(edge, float(edges.min()) / LEAST_SLENDERNESS)
    if exceed(least, COUNTED_BINS):
        raise SettingsError(
            f"the bodies would fill a box of {edges[0]:.3g} LU by {edges[2]:.3g} LU, and their forces reach over "
            f"{reach(scene, settings):.3g} LU only: use a smaller load or displacement, stiffer springs or a larger "
            f"radius. {MIX_UP}"
        )
    return [] if edge == own else [Contribution("bins", Stage.MOTION, ("bins",), {"bin_edge": number(least)})]


def own_units(units: DeckUnits) -> Contribution:
    """Converts the numbers of a deck with units of its own to LU and FU."""
    variables = {"unit_length": number(units.length), "unit_force": number(units.force)}
    return Contribution("units", Stage.MOTION, ("units",), variables)


def _plane(fragment: str, scene: Scene, settings: Settings) -> Contribution:
    depth = PLANE_DEPTH * max(settings.largest_displacement, scene.bodies.spacing)
    variables = {
        "plane_position": number(-depth),
        "plane_reach": number(depth),
        "plane_half_stiffness": number(settings.forces.plane_stiffness / 2),
    }
    if fragment == "rigid_plane":
        variables["plane_stiffness"] = number(settings.forces.plane_stiffness)
    return Contribution("rigid_plane", Stage.SPRINGS, (fragment,), variables)


def _method(scene: Scene, settings: Settings) -> Contribution:
    if scene.method == "quasistatic":
        variables = {
            "force_tolerance": number(settings.forces.residual),
            "minimiser_iterations": str(MINIMISER_ITERATIONS),
            "relaxation_step": number(RELAXATION * settings.motion.time_step),
        }
        if settings.gentle:
            variables["gentle_move"] = number(settings.increments.longest_move)
            variables["gentle_tolerance"] = number(GENTLE_RESIDUAL * settings.forces.scale)
        return Contribution("quasistatic", Stage.MOTION, ("quasistatic",), variables)
    variables = {"time_step": number(settings.motion.time_step)}
    return Contribution("dynamic", Stage.MOTION, ("dynamic",), variables, integrates="particles")


SIDE_MARGIN = 20.0
"""Free space beside the chains over the spacing, beyond what a slide needs."""
HEAD_MARGIN = 10.0
"""Free space above and below the bodies over the spacing and over the cutoff."""
FLIGHT = 10.0
"""How much more a free plate needs that may fly off between two looks; under a held load LAMMPS stops it."""
BIN_MARGIN = 1e-3
"""Least free space over the length of a long bond: LAMMPS wants no box much thinner than its bins."""
MOST_BINS = 4_000_000
"""Bins beyond which they are made larger: some 100 MB of them."""
COUNTED_BINS = 2**31 / 27
"""Bins of a box that LAMMPS can count: it adds others on each side of each edge."""

Lengths = tuple[float, float, float]


def margins(scene: Scene, settings: Settings) -> Lengths:
    """Free space along x, y and z [LU] between the bodies and the walls of the box."""
    side = SIDE_MARGIN * scene.bodies.spacing + scene.experiment.way
    head = HEAD_MARGIN * max(scene.bodies.spacing, settings.forces.cutoff) + 2 * abs(settings.largest_displacement)
    if scene.plate and (scene.noise or scene.experiment.motion_is_result):
        head *= FLIGHT
    head -= min([0.0, *scene.experiment.places()])
    least = max(BIN_MARGIN * settings.chains.far, LEAST_SLENDERNESS * reach(scene, settings))
    side, flat, head = (math.ceil(max(margin, least)) for margin in (side, 1.0, head))
    return side, flat, head


def reach(scene: Scene, settings: Settings) -> float:
    """Distance [LU] up to which LAMMPS lists neighbours."""
    return settings.forces.cutoff + SKIN * scene.bodies.spacing
