"""A measured state of a contact, and its contact radius."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius, compressive_radius, held_radius, tensile_radius
from contact1d.workflow.model.settings import CALIBRATION
from contact1d.workflow.scene import Scene

OUTSIDE = 1.5
"""Position over the spacing of the second particle of a chain whose apex lies between two."""


@dataclass(frozen=True)
class RadiusRule:
    """The definition of the contact radius of a scene; `tolerance` limits the residual of a pressure."""

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

        The force maximum is then nearer than the next particle, OUTSIDE spacings from the apex at most.
        """
        outside = OUTSIDE * self.scene.bodies.spacing
        return self.of(profile) or ContactRadius(0.0, outside, 0.0, 0.0, reaches_end=False)


@dataclass(frozen=True)
class State:
    """One state of a contact, measured in LAMMPS or made by the reduced model.

    Attributes:
        phase: name of its phase.
        displacement: [LU].
        force: of the contact on the plate, compression positive [FU]: the sum over the upper particles.
        profile: pressure and shear along x.
        rule: what the contact radius is.
        smallest_distance: between particles of opposite bodies, or of a particle from the plane [LU].
        depth: how far an upper particle lies below the lower surface [LU]; 0 where none does.
        residual: largest unbalanced force of a particle along a direction in which it may move [FU].
        pushed: force of other effects that presses the upper body onto the lower one [FU].
        plate_velocity: [LU/TU], 0 where the plate's position is prescribed.
        plate_x: position of the plate along x [LU], from where it is in system.data.
        cantilever_force: [FU].
        step: LAMMPS timestep.
        motion: of a slide, what `contact.MOTION` and `contact.HEAT` name.
        number: of its row, over all phases.
    """

    phase: str
    displacement: float
    force: float
    profile: Profile
    rule: RadiusRule = field(repr=False, compare=False)
    smallest_distance: float = 0.0
    depth: float = 0.0
    residual: float = 0.0
    pushed: float = 0.0
    plate_velocity: float = 0.0
    plate_x: float = 0.0
    cantilever_force: float = 0.0
    step: float = 0.0
    motion: Mapping[str, float] = field(default_factory=dict, compare=False)
    number: int = field(default=0, compare=False)

    @property
    def carried(self) -> float:
        """The load in equilibrium with the state [FU]: the contact force and other forces on the body."""
        return self.force - self.pushed

    @cached_property
    def radius(self) -> ContactRadius | None:
        """The contact radius; None where the bodies do not touch."""
        return self.rule.of(self.profile)

    @property
    def radius_or_spot(self) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension."""
        return self.radius or self.rule.or_spot(self.profile)
