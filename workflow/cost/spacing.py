"""The same bodies at another spacing: kept are stiffness and drag per length, and of neighbour springs times length.

The force that opposite rows exert per length is kept by another pair law, see `workflow.cost.row_law`.
"""

from __future__ import annotations

from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

SPACING_FACTORS = {"particles": (4.0, 3.0, 2.0, 1.0, 0.5), "rigid_plane": (4.0, 2.0, 1.0, 0.5, 0.125)}
"""Over the scene's own, by the lower body: at a quarter no sum of exponentials keeps the row's force within 1e-4."""


def spacing_is_physics(scene: Scene, own: Settings) -> str:
    """Why the spacing cannot be turned with the physics kept; "" where it can."""
    if scene.bodies.profile.has_edge:
        return "a flat punch is as wide as its particles make it"
    if scene.noise is not None:
        return "thermal motion of a particle belongs to its spacing"
    if scene.interaction is None:
        return ""
    if scene.horizontal is not None:
        return (
            "where particles may move along x, opposite ones hold each other in the period of the spacing, and no pair "
            "law keeps that force at another one"
        )
    if own.estimate.snaps:
        return "particles snap one by one, so that opposite rows are not straight and a snap is as wide as the spacing"
    return ""


def at_spacing(scene: Scene, spacing: float) -> tuple[str, ...]:
    """Scene keys that go with the spacing [LU], but for the interaction."""
    factor, bodies = spacing / scene.bodies.spacing, scene.bodies
    keys = [f"bodies.spacing={spacing!r}", f"bodies.mass={factor * bodies.mass!r}"]
    if bodies.bulk_stiffness != "auto":
        keys.append(f"bodies.bulk_stiffness={factor * scene.bulk_stiffness!r}")
    if bodies.bulk_stiffness_tangential is not None:
        keys.append(f"bodies.bulk_stiffness_tangential={factor * bodies.bulk_stiffness_tangential!r}")
    if scene.neighbours is not None:
        keys.append(f"neighbours.stiffness={scene.neighbours.stiffness / factor!r}")
    if scene.damping is not None and scene.damping.coefficient != "auto":
        keys.append(f"damping.coefficient={factor * scene.damping.coefficient!r}")
    return tuple(keys)
