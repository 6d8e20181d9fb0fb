"""The same body at another spacing: kept are stiffness and drag per length, and of neighbour springs times length."""

from __future__ import annotations

from contact1d.workflow.scene import Scene

SPACING_FACTORS = (4.0, 2.0, 1.0, 0.5, 0.125)
"""Over the scene's own."""


def spacing_is_physics(scene: Scene) -> str:
    """Why the spacing cannot be turned with the physics kept; "" where it can."""
    if scene.bodies.profile.has_edge:
        return "a flat punch is as wide as its particles make it"
    if scene.noise is not None:
        return "thermal motion of a particle belongs to its spacing"
    if scene.interaction is not None:
        return "the force of a row of opposite particles belongs to its spacing: no amplitudes keep it at another one"
    return ""


def at_spacing(scene: Scene, spacing: float) -> tuple[str, ...]:
    """Scene keys that go with the spacing [LU]."""
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
