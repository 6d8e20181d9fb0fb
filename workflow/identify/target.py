"""What a run is to find, F_A and a₀, and whether springs of a stiffness can have it.

With the radius R₁ of the chain's parabola and the stiffness per length c of both chains in series, F_A R₁/(c a₀³) rises
from 0 to 4/(9√3) = 0.2566 as the range of the interaction falls to 0, where springs break (`line_adhesion`). JKR with
the springs that the MDR gives a material, R₁ = R/2 and c = E*, has 1/6.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.scene import PullOff, Scene

BRITTLE_RATIO = 4.0 / (9.0 * math.sqrt(3.0))
"""F_A R₁/(c a₀³) in the limit of a vanishing range."""
REACHABLE_RATIO = 0.95 * BRITTLE_RATIO
"""Beyond this the range would be so short that each pair snaps by itself."""
ROUNDING = 1.0 + 1e-5
"""Keeps a nearest value possible after it was printed with six digits."""


class IdentifyError(Contact1dError, ValueError):
    """A target that the model can't reach; the message names the nearest one that it can."""


@dataclass(frozen=True)
class Target:
    """What a run is to find: F_A [FU] and a₀ [LU]."""

    adhesion_force: float
    zero_load_radius: float


def require_reachable(scene: Scene, target: Target) -> None:
    """Refuse a target beyond what springs of the scene's stiffness can do.

    Raises:
        IdentifyError: with the nearest zero-load radius and the nearest adhesion force.
    """
    if not isinstance(scene.experiment, PullOff) or scene.interaction is None or scene.interaction.attraction is None:
        raise IdentifyError("only a pull_off with an attraction finds F_A and a₀")
    if scene.bodies.plane_radius is None:
        raise IdentifyError("only a parabola has the F_A and a₀ of JKR's sphere")
    layer = scene.bulk_stiffness / (2.0 * scene.bodies.spacing)
    require_held(target, layer, scene.bodies.plane_radius, ("FU", "LU"))


def require_held(target: Target, layer: float, radius: float, units: tuple[str, str]) -> None:
    """Refuse a target that a layer of springs does not hold, whatever the interaction.

    Args:
        target: F_A and a₀, in `units`.
        layer: stiffness per length of both chains in series [force/length²].
        radius: R₁ of the chain's parabola [length].
        units: of force and length, for the message.

    Raises:
        IdentifyError: with the nearest zero-load radius and the nearest adhesion force.
    """
    force, a_0 = target.adhesion_force, target.zero_load_radius
    if force * radius / (layer * a_0**3) <= REACHABLE_RATIO:
        return
    smallest = ROUNDING * (force * radius / (REACHABLE_RATIO * layer)) ** (1.0 / 3.0)
    largest = REACHABLE_RATIO * layer * a_0**3 / radius / ROUNDING
    newton, metre = units
    raise IdentifyError(
        f"an adhesion force of {force:.6g} {newton} with a zero-load radius of {a_0:.6g} {metre} is more than springs "
        "of this stiffness hold, whatever the interaction. Nearest: the same force with a radius of at least "
        f"{smallest:.6g} {metre}, or the same radius with a force of at most {largest:.6g} {newton}"
    )
