"""The independent solver of validation/references: the same chains as contact1d, minimised by Newton's method."""

from __future__ import annotations

import numpy as np

from validation.speed.clock import spent
from validation.speed.peers.contacts import (
    A_0,
    CHAIN_WAY,
    CONTACT_MODULUS,
    RADIUS,
    Curve,
    Setting,
    closed_form,
    displacements,
)

NAME = "scipy solver (1D)"
SETTINGS = {
    "hertz": (Setting("a_0/6", 6), Setting("a_0/12", 12), Setting("a_0/28", 28), Setting("a_0/60", 60)),
    "jkr": (Setting("a_0/8", 8), Setting("a_0/12", 12), Setting("a_0/28", 28)),
}

CHAIN = 2.8
"""Half-width of the two chains over a_0: the contact and the reach of the law."""


def load() -> None:
    """Import the solver."""
    import validation.references.solver  # noqa: F401 (loading it is the point)


def curve(contact: str, setting: Setting) -> Curve:
    """Return the curve of one chain on a plane (Hertz), or of two chains with the law that contact1d identified."""
    from validation.references.model import ChainModel
    from validation.references.solver import trace
    from validation.references.tension_radius import state_radius
    from validation.speed.peers.contact1d_peer import identified, own_limit, pair_law

    d = displacements(contact, CHAIN_WAY)
    began = spent()
    if contact == "hertz":
        spacing = A_0 / setting.grid
        particles = 2 * round(1.1 * setting.grid) + 4
        model = ChainModel(particles, CONTACT_MODULUS * spacing, radius=0.5 * RADIUS, spacing=spacing, rigid_plane=True)
        unit, force_unit = 1.0, 1.0
    else:
        scene, unit, force_unit = identified(setting)
        bodies = scene.bodies
        assert bodies.plane_radius is not None
        model = ChainModel(2 * round(CHAIN * setting.grid), scene.bulk_stiffness, pair_law(scene), bodies.plane_radius)
    start_up = spent() - began
    began = spent()
    states = trace(model, d / unit)
    force = np.array([state.force for state in states]) * force_unit
    if contact == "hertz":
        radius = np.full(len(d), np.nan)
        limit = closed_form(contact, d)
        return Curve(d, force, radius, spent() - began, start_up, limit)
    radius = np.array([state_radius(model, state) for state in states]) * unit
    seconds = spent() - began
    return Curve(d, force, radius, seconds, start_up, own_limit(scene, unit, force_unit, d))
