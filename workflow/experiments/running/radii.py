"""The contact radius as the contract defines it: which of the two radii a scene has, and where there is none."""

from __future__ import annotations

from dataclasses import dataclass

from contact1d.analysis.held import held_radius
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius, tensile_radius
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.calibration import CALIBRATION

OUTSIDE = 1.5
"""Place over the spacing of the second particle of a chain whose apex lies between two."""


@dataclass(frozen=True)
class RadiusRule:
    """What the contact radius of a scene is; `tolerance` tells how exact a minimiser leaves a pressure."""

    scene: Scene
    tolerance: float

    def of(self, profile: Profile) -> ContactRadius | None:
        """The contact radius as the contract defines it; None where the bodies do not touch."""
        scene = self.scene
        has_edge, on_plane = scene.bodies.profile.has_edge, scene.bodies.lower == "rigid_plane"
        # A punch that adheres and stands on the plane without any force is held all over.
        held = has_edge and scene.adhesion is not None and bool((profile.z_upper <= 0.0).any())
        carries = ((has_edge or on_plane) and profile.pressure.any()) or held
        if not (-profile.pressure if scene.adheres else profile.pressure).max() > 0.0 and not carries:
            return None
        if has_edge:
            edge = scene.bodies.reach
            return ContactRadius(edge, 0.0, -edge, edge, reaches_end=False)
        if scene.adheres:
            return held_radius(profile) if on_plane else tensile_radius(profile)
        return compressive_radius(profile, CALIBRATION.residual * self.tolerance)

    def or_spot(self, profile: Profile) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension, as where F = 0 and the pairs at the apex just touch.

        The largest tension is then nearer than the next particle, OUTSIDE spacings from the apex at most.
        """
        outside = OUTSIDE * self.scene.bodies.spacing
        return self.of(profile) or ContactRadius(0.0, outside, 0.0, 0.0, reaches_end=False)
