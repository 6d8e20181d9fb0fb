"""Definitions of the contact radius, of which a law names its own (`Law.rules`)."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

from contact1d.analysis.pressure import Array, Profile, ZonedProfile, end_pressure_share
from contact1d.analysis.radius import (
    NEGLIGIBLE,
    ContactRadius,
    compressive_radius,
    covers,
    ends_whole,
    held_radius,
    tensile_radius,
    whole_cells,
    within,
)
from contact1d.workflow.laws.numerics import ROUND_OFF
from contact1d.workflow.scene import Bodies


@dataclass(frozen=True)
class RadiusRule(ABC):
    """A definition of the contact radius by the pressure of the particles.

    Attributes:
        bodies: bodies of the scene.
        share: error of each pressure over the largest one (relative); `Compressed` and `Given` add its effect to the
            uncertainty of a radius where the pressure falls to 0.
        jump: line load [FU/LU] just inside the edge; None where the particles show it.
    """

    bodies: Bodies
    share: float
    jump: ClassVar[float | None] = 0.0

    @abstractmethod
    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the contact radius with its uncertainty and edges [LU]; None where the bodies do not touch.

        Raises:
            ValueError: there are too few particles, or pressures of the wrong sign for this definition.
        """

    def or_spot(self, profile: Profile) -> ContactRadius:
        """Return the contact radius [LU] with its uncertainty and edges; 0 ± 1.5 spacings where the bodies do not
        touch.

        So the pairs at an apex that just touch have a radius, too: the force maximum is nearer than the second
        particle, 1.5 spacings from an apex between two at most.
        """
        return self.of(profile) or ContactRadius(0.0, 1.5 * self.bodies.spacing, 0.0, 0.0)

    def is_cut(self, profile: Profile) -> bool:
        """Return whether the first or the last particle of the chain has a pressure other than 0: the contact reaches
        an end, which may cut it unless the body has an edge.
        """
        return bool(max(abs(profile.pressure[0]), abs(profile.pressure[-1])) > 0.0)

    def load(self, profile: Profile, radius: ContactRadius) -> Array:
        """Return the line load at each particle, (n,) [FU/LU], compression positive; by default force over spacing.

        `radius` is not used by this default, and the array is that of the profile, not a copy.
        """
        return profile.pressure

    def lengths(self, profile: Profile) -> Mapping[str, float]:
        """Return further lengths [LU] of a state, by the names of results; {} by default."""
        return {}


class Compressed(RadiusRule):
    """Contact up to the last particle that is pressed, or up to the edge of the body."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the contact radius at which the pressure falls to 0, with its uncertainty and edges [LU].

        It lies between the outermost compressed particle and the next, or at the last particle of the chain where that
        is compressed. Of a body with an edge it is that edge, to round-off, where the parabola through the last three
        pressures is not below 0 there. None without a compressed particle.

        Raises:
            ValueError: a particle carries tension beside one that is compressed, there are fewer than 3, or a pressure
                is infinite.
        """
        if not profile.pressure.max() > 0.0:
            return None
        if self.bodies.profile.has_edge:
            profile = within(profile, self.bodies.reach)
            if covers(profile, self.bodies.reach):
                return _whole(self.bodies, NEGLIGIBLE)
        return compressive_radius(profile, self.share)


class Held(RadiusRule):
    """Contact up to an edge within a cell, whose particle carries the part of the load inside the edge."""

    jump = None

    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the contact radius [LU] of a pressure that jumps to 0 at its edges, with its uncertainty and edges.

        The pressure of the outermost loaded particle shows which part of its cell is in contact. Of a body with an edge
        the whole cell beside it is in contact where its pressure goes on from those inside. None where all pressures
        are 0.

        Raises:
            ValueError: there are fewer than 3 particles, or a pressure is not finite.
        """
        if not profile.pressure.any():
            return None
        if self.bodies.profile.has_edge and ends_whole(within(profile, self.bodies.reach), ROUND_OFF):
            return _whole(self.bodies, NEGLIGIBLE)
        return held_radius(profile)

    def load(self, profile: Profile, radius: ContactRadius) -> Array:
        """Return the line load at each particle, (n,) [FU/LU], compression positive.

        At the outermost loaded particle on each side, whose cell may be in contact in part, it is extrapolated by a
        parabola from the three inside, and 0 where that particle is outside the edges of `radius`. With fewer than 8
        loaded particles all are force over spacing.
        """
        return whole_cells(profile, radius)


def _whole(bodies: Bodies, share: float) -> ContactRadius:
    """Return the half-width of a body [LU] as its contact radius, uncertain by a `share` of it."""
    return ContactRadius(bodies.reach, share * bodies.reach, -bodies.reach, bodies.reach)


class Given(RadiusRule):
    """Contact up to the edge that the law computes for each state; where it has none, as the pressure shows it."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the contact radius with its uncertainty and edges [LU]; None where all pressures are 0.

        Of a `ZonedProfile` it is its own edge with its own uncertainty, 0 of bodies that attract each other and do not
        touch. Of another profile it is the radius of the largest tension, or without tension that at which the pressure
        falls to 0.

        Raises:
            ValueError: a profile without an edge has fewer than 3 particles.
        """
        if not profile.pressure.any():
            return None
        if not isinstance(profile, ZonedProfile):
            pulled = profile.pressure.min() < 0.0
            return tensile_radius(profile) if pulled else compressive_radius(profile, self.share)
        return ContactRadius(profile.edge, profile.doubt, -profile.edge, profile.edge)

    def is_cut(self, profile: Profile) -> bool:
        """Return whether the last particle of the chain has a force: contact or attraction reaches the end."""
        return bool(profile.pressure[-1] != 0.0)


class WithRange(Given):
    """Contact with an attraction beyond its edge, both as the law computes them for each state."""

    def lengths(self, profile: Profile) -> Mapping[str, float]:
        """Return {"cohesive_radius": radius c [LU] up to which the attraction acts}; {} of a profile without a known
        edge.
        """
        return {"cohesive_radius": profile.reach} if isinstance(profile, ZonedProfile) else {}


class InTension(RadiusRule):
    """Contact up to the largest tension around it."""

    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the radius [LU] of the largest tension, with its uncertainty and edges; None without any tension.

        It is half the distance of the largest tensions on both sides of the centre, 0 where they are the same spot.

        Raises:
            ValueError: there are fewer than 3 particles, or the tension is below 1e-12 of the largest pressure.
        """
        return tensile_radius(profile) if profile.pressure.min() < 0.0 else None

    def is_cut(self, profile: Profile) -> bool:
        """Return whether the chain ends too near to the contact.

        So it is where the largest tension is that of the first or last particle, or where the pressure of one of these
        has more than half of the largest magnitude.
        """
        pressure = profile.pressure
        largest = float(pressure.min())
        return end_pressure_share(profile) > 0.5 or (largest < 0.0 and largest in (pressure[0], pressure[-1]))


class ToTheEdge(RadiusRule):
    """Contact up to the edge of a body; of one that `clings` also at zero force, while particles are on the plane."""

    jump = None
    clings: ClassVar[bool] = False

    def of(self, profile: Profile) -> ContactRadius | None:
        """Return the half-width of the body [LU], uncertainty 0, where any particle has a force; else None.

        A body that adheres (`clings`) touches also where a particle is on the plane without a force.
        """
        touches = profile.pressure.any() or (self.clings and (profile.z_upper <= 0.0).any())
        return _whole(self.bodies, 0.0) if touches else None


class Clinging(ToTheEdge):
    """Contact up to the edge of a body that adheres."""

    clings = True
