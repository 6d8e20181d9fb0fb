"""A contact before its run: radius and force of the body that was asked for, by the method of dimensionality reduction.

With g(x) = |x| ∫ f′/√(x² − r²) dr, E* per length and Heß's rule at the edge, d = g(a) − √(2πaW/E*),

    F(a) = 2 E* [a d − ∫₀ᵃ g dx]

which is JKR's for a sphere and exact for any axisymmetric body with one contact.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.identify.contact import AskedContact
from contact1d.workflow.identify.target import IdentifyError
from contact1d.workflow.scene import scene_from_dict

SHORTEST, LONGEST, PLACES = 1e-12, 1e4, 8000
"""Radii [m] among which that of a contact is looked for, in a geometric row, and how many."""
INSIDE = 0.999999
"""Largest of them over the half-width of a body that ends: the transform of a circle has no bound there."""


def profile_in(contact: AskedContact, unit: float) -> dict[str, Any]:
    """The profile in units of the scene [m]."""
    profile = dict(contact.profile)
    for key in ("radius", "height"):
        if key in profile:
            profile[key] /= unit
    for key in ("r", "z"):
        if key in profile:
            profile[key] = [value / unit for value in profile[key]]
    return profile


def curve(contact: AskedContact) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Contact radii [m], rising, and the forces F(a) [N] by the module's equation."""
    body = scene_from_dict(_stand_in(contact)).bodies  # in metres
    reach = body.profile.reach
    if body.profile.has_edge:
        radii = np.asarray([reach])
        return radii, np.asarray([math.inf])
    radii = np.geomspace(SHORTEST, min(LONGEST, INSIDE * reach), PLACES)
    with np.errstate(over="ignore"):
        heights = body.profile.transformed(radii)
    radii, heights = radii[np.isfinite(heights)], heights[np.isfinite(heights)]
    steps = np.diff(radii, prepend=0.0)
    below = np.cumsum(0.5 * (heights + np.concatenate([[0.0], heights[:-1]])) * steps)
    stretch = np.sqrt(2.0 * math.pi * radii * contact.work_of_adhesion / contact.contact_modulus)
    return radii, 2.0 * contact.contact_modulus * (radii * (heights - stretch) - below)


def _stand_in(contact: AskedContact) -> dict[str, Any]:
    """Any scene with the profile in metres."""
    return {
        "title": contact.title,
        "bodies": {
            "particles": "auto",
            "spacing": 0.5 * float(contact.profile["radius"]) if contact.profile["kind"] == "flat_punch" else 1.0,
            "profile": profile_in(contact, 1.0),
            "reduction": "mdr",
            "lower": "rigid_plane",
            "bulk_stiffness": 1.0,
        },
        "experiment": {"kind": "load", "force": 1.0},
    }


def contact_radius(contact: AskedContact) -> float:
    """The contact radius [m] that spacings are counted in: at F = 0 with attraction, else under the load."""
    radii, forces = curve(contact)
    if len(radii) == 1:
        return float(radii[0])
    wanted = 0.0 if contact.work_of_adhesion else contact.load or 0.0
    above = np.flatnonzero(forces < wanted)
    if above.size == 0 or above[-1] + 1 == len(radii):
        raise IdentifyError(
            f"no contact radius between {radii[0]:.3g} and {radii[-1]:.3g} m has a force of {wanted:g} N: compare the "
            "profile's lengths, the load and the contact modulus with each other"
        )
    at = int(above[-1])
    return float(np.interp(wanted, forces[at : at + 2], radii[at : at + 2]))


def largest_tension(contact: AskedContact) -> float:
    """The largest tension under a fixed load [N]."""
    radii, forces = curve(contact)
    if len(radii) > 1:
        return max(-float(forces.min()), 1e-300)
    stretch = math.sqrt(2.0 * math.pi * radii[0] * contact.work_of_adhesion / contact.contact_modulus)
    return 2.0 * contact.contact_modulus * float(radii[0]) * stretch  # a punch parts at once (Kendall)
