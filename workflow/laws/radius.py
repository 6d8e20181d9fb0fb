"""What the contact radius is that a law has, as the contract defines it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from contact1d.analysis.pressure import Array, Profile, ZonedProfile, end_pressure_share
from contact1d.analysis.radius import ContactRadius, compressive_radius, held_radius, tensile_radius, whole_cells
from contact1d.workflow.scene import Bodies

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
        jump: line load [FU/LU] just inside the edge; None where the particles show it.
    """

    bodies: Bodies
    share: float
    ends_with_chain: ClassVar[bool] = True
    jump: ClassVar[float | None] = 0.0

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

    def load(self, profile: Profile, radius: ContactRadius) -> Array:
        """Line load [FU/LU] at each of the particles, (n,)."""
        return profile.pressure

    def lengths(self, profile: Profile) -> Mapping[str, float]:
        """What else [LU] is known of a state, by the names of results."""
        return {}


class Compressed(RadiusRule):
    """Up to the last particle that is pressed."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """See `compressive_radius`."""
        return compressive_radius(profile, self.share) if profile.pressure.max() > 0.0 else None


class Held(RadiusRule):
    """Up to where a rigid plane holds the body: the edge leaves a particle a share of its cell."""

    jump = None

    def of(self, profile: Profile) -> ContactRadius | None:
        """See `held_radius`."""
        return held_radius(profile) if profile.pressure.any() else None

    def load(self, profile: Profile, radius: ContactRadius) -> Array:
        """See `whole_cells`."""
        return whole_cells(profile, radius)


class Given(RadiusRule):
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

    def lengths(self, profile: Profile) -> Mapping[str, float]:
        """How far the attraction goes, c."""
        return {"cohesive_radius": profile.reach} if isinstance(profile, ZonedProfile) else {}


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


class ToTheEdge(RadiusRule):
    """A body with an edge touches up to there; one that `clings` does so without any force, where it stands."""

    ends_with_chain = False
    jump = None
    clings: ClassVar[bool] = False

    def of(self, profile: Profile) -> ContactRadius | None:
        """Its reach."""
        touches = profile.pressure.any() or (self.clings and (profile.z_upper <= 0.0).any())
        edge = self.bodies.reach
        return ContactRadius(edge, 0.0, -edge, edge, reaches_end=False) if touches else None

    def is_cut(self, profile: Profile) -> bool:
        """The chain ends there as well."""
        return False


class Clinging(ToTheEdge):
    """One that adheres."""

    clings = True
