"""A measured state of a contact, and its contact radius."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import ClassVar

from contact1d.analysis.pressure import Profile, ZonedProfile, end_pressure_share
from contact1d.analysis.radius import ContactRadius, compressive_radius, held_radius, tensile_radius
from contact1d.workflow.laws import law_of
from contact1d.workflow.model.calibration import CALIBRATION
from contact1d.workflow.scene import Bodies, Scene

OUTSIDE = 1.5
"""Position over the spacing of the second particle of a chain whose apex lies between two."""
INSIDE_SHARE = 0.5
"""Pressure at a chain's end over the largest one from which on the end of the chain is inside the contact."""


@dataclass(frozen=True)
class RadiusRule(ABC):
    """What the contact radius of a scene is, as the contract defines it.

    Attributes:
        bodies: the scene's.
        share: pressure over the largest one that is left of nothing.
        ends_with_chain: whether the end of its chain may cut the contact.
    """

    bodies: Bodies
    share: float
    ends_with_chain: ClassVar[bool] = True

    @abstractmethod
    def of(self, profile: Profile) -> ContactRadius | None:
        """The contact radius; None where the bodies do not touch."""

    def or_spot(self, profile: Profile) -> ContactRadius:
        """The contact radius; 0 where no particle is in tension, as where F = 0 and the pairs at the apex just touch.

        The force maximum is then nearer than the next particle, OUTSIDE spacings from the apex at most.
        """
        return self.of(profile) or ContactRadius(0.0, OUTSIDE * self.bodies.spacing, 0.0, 0.0, reaches_end=False)

    def is_cut(self, profile: Profile) -> bool:
        """Whether the contact's edge, its last loaded particle, is a chain's last particle."""
        return bool(max(abs(profile.pressure[0]), abs(profile.pressure[-1])) > 0.0)


class Compressed(RadiusRule):
    """Up to the last particle that is pressed."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """See `compressive_radius`."""
        return compressive_radius(profile, self.share) if profile.pressure.max() > 0.0 else None


class Held(RadiusRule):
    """Up to where a rigid plane holds the body."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """See `held_radius`."""
        return held_radius(profile) if profile.pressure.any() else None


class Zoned(RadiusRule):
    """Up to the edge that a load step gives; where none is known, as the pressure shows it."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """Exact; 0 of bodies that attract each other and do not touch."""
        if not profile.pressure.any():
            return None
        if not isinstance(profile, ZonedProfile):
            pulled = profile.pressure.min() < 0.0
            return tensile_radius(profile) if pulled else compressive_radius(profile, self.share)
        return ContactRadius(profile.edge, profile.doubt, -profile.edge, profile.edge, reaches_end=False)

    def is_cut(self, profile: Profile) -> bool:
        """Whether the attraction reaches the end of the chain."""
        return bool(profile.pressure[-1] != 0.0)


class InTension(RadiusRule):
    """Up to the force maximum of the tension about the contact."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """See `tensile_radius`."""
        return tensile_radius(profile) if profile.pressure.min() < 0.0 else None

    def is_cut(self, profile: Profile) -> bool:
        """Whether the force maximum is at an end, or the chain is shorter than the compressed middle."""
        pressure = profile.pressure
        largest = float(pressure.min())
        return end_pressure_share(profile) > INSIDE_SHARE or (largest < 0.0 and largest in (pressure[0], pressure[-1]))


@dataclass(frozen=True)
class ToTheEdge(RadiusRule):
    """A body with an edge touches up to there; one that `clings` does so without any force where it stands."""

    clings: bool
    ends_with_chain: ClassVar[bool] = False

    def of(self, profile: Profile) -> ContactRadius | None:
        """Its reach."""
        if not (profile.pressure.any() or (self.clings and (profile.z_upper <= 0.0).any())):
            return None
        edge = self.bodies.reach
        return ContactRadius(edge, 0.0, -edge, edge, reaches_end=False)

    def is_cut(self, profile: Profile) -> bool:
        """The chain ends there as well."""
        return False


def radius_rule(scene: Scene, tolerance: float) -> RadiusRule:
    """The one of a scene; `tolerance` limits the residual of a pressure."""
    share = CALIBRATION.residual * tolerance
    law = law_of(scene)
    if scene.bodies.own_count is not None:
        return ToTheEdge(scene.bodies, share, law.holds)
    if law.tells_edges and scene.is_stepped:
        return Zoned(scene.bodies, share)
    if not scene.adheres:
        return Compressed(scene.bodies, share)
    return (Held if law.holds else InTension)(scene.bodies, share)


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
        plate_x: position of the plate along x [LU], from where it is in system.data.
        step: LAMMPS timestep.
        pushed: force of other effects that presses the upper body onto the lower one [FU].
        plate_velocity: [LU/TU], 0 where the plate's position is prescribed.
        cantilever_force: [FU].
        missing: force that LAMMPS adds up on the plate beside those that are known [FU]; None: it tells none.
        time: of a history [TU].
        motion: of a slide, what `contact.MOTION` and `contact.HEAT` name.
        number: of its row, over all phases.
    """

    phase: str
    displacement: float
    force: float
    profile: Profile
    rule: RadiusRule = field(repr=False, compare=False)
    smallest_distance: float
    depth: float
    residual: float
    plate_x: float
    step: float
    pushed: float = 0.0
    plate_velocity: float = 0.0
    cantilever_force: float = 0.0
    missing: float | None = None
    time: float = 0.0
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
