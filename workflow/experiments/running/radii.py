"""The contact radius as the contract defines it: which of the two radii a scene has, and where there is none."""

from __future__ import annotations

from dataclasses import dataclass

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius, tensile_radius
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.calibration import CALIBRATION


@dataclass(frozen=True)
class RadiusRule:
    """What the contact radius of a scene is; `tolerance` tells how exact a minimiser leaves a pressure."""

    scene: Scene
    tolerance: float

    def of(self, profile: Profile) -> ContactRadius | None:
        """The contact radius as the contract defines it; None where the bodies do not touch."""
        scene = self.scene
        adhesive = scene.interaction is not None and scene.interaction.attraction is not None
        sign = -1.0 if adhesive else 1.0
        has_edge = scene.bodies.profile.has_edge
        if not (sign * profile.pressure > 0.0).any() and not (has_edge and profile.pressure.any()):
            return None
        if has_edge:
            edge = scene.bodies.reach
            return ContactRadius(edge, 0.0, -edge, edge, reaches_end=False)
        if adhesive:
            return tensile_radius(profile)
        return compressive_radius(profile, CALIBRATION.residual * self.tolerance)

    def or_spot(self, profile: Profile) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension, as where F = 0 and a single pair touches."""
        return self.of(profile) or ContactRadius(0.0, 0.5 * self.scene.bodies.spacing, 0.0, 0.0, reaches_end=False)
