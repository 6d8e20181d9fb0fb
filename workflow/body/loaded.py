"""The line load of a state, from which p(r) follows by the inverse Abel transform.

The line load q [FU/LU] is the force on the particles over their spacing, compression positive; c is the stiffness of
the springs per length [FU/LU²].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from contact1d.analysis.abel import FEWEST, LineLoad, line_load
from contact1d.analysis.pressure import Array, Profile, ZonedProfile
from contact1d.analysis.radius import ContactRadius
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.scene import Scene, Shape
from contact1d.workflow.scene.tables import WIDER_THAN_SPHERES


@dataclass(frozen=True, eq=False)
class LoadedState:
    """The line load of a state; for the paper's spheres half as wide as that of the image.

    Attributes:
        scene: the scene of the run.
        profile, radius: profile and contact radius of the state, of the image.
        rule: reads the contact radius off the profile.
    """

    scene: Scene
    profile: Profile
    radius: ContactRadius
    rule: RadiusRule

    @cached_property
    def image_ratio(self) -> float:
        """Width of the image over that of the body (dimensionless): 2 for the paper's spheres, else 1."""
        return WIDER_THAN_SPHERES if stands_for_spheres(self.scene) else 1.0

    @property
    def shape(self) -> Shape:
        """The profile of the body."""
        return self.scene.bodies.profile

    @property
    def zone(self) -> ZonedProfile | None:
        """The profile of a contact whose law gives the edge; None where it does not."""
        return self.profile if isinstance(self.profile, ZonedProfile) else None

    def has_kinks(self, shape: Shape) -> bool:
        """Whether a body of this shape has kinks inside the contact."""
        return any(kink < self.radius.value for kink in shape.kinks)

    @property
    def is_uncoupled(self) -> bool:
        """Whether particles on a plane are uncoupled, so that their load is a function of the body's height."""
        return self.scene.bodies.lower == "rigid_plane" and self.scene.neighbours is None

    @property
    def is_elastic(self) -> bool:
        """Whether the particles are uncoupled linear springs, so that their load is linear in the body's height."""
        return self.is_uncoupled and self.scene.keeps_springs

    @cached_property
    def x(self) -> Array:
        """Positions of the particles along the body, rising, (n,) [LU].

        Half those of the image for the paper's spheres.
        """
        return self.profile.x / self.image_ratio

    @property
    def layer(self) -> float:
        """Stiffness of the springs per length [FU/LU²]."""
        return self.scene.bulk_stiffness / self.scene.bodies.spacing

    def heights(self, x: Array, shape: Shape | None = None) -> Array:
        """Return c h(x) [FU/LU] of the body, or of another shape, at positions x (n,) [LU], (n,).

        C is the stiffness per length.
        """
        bodies = self.scene.bodies
        return self.layer * (bodies if shape is None else bodies.model_copy(update={"profile": shape})).height(x)

    @cached_property
    def edge(self) -> float | None:
        """Half-width of the line load [LU]; None with an interaction of a body without an edge, whose load decays."""
        return None if self.scene.interaction and not self.shape.has_edge else self.radius.value / self.image_ratio

    @cached_property
    def jump(self) -> float | None:
        """The line load just inside the edge [FU/LU], compression positive; None where particles determine it.

        These are the end of a body, and JKR.
        """
        if self.zone:
            return self.zone.jump
        return self.rule.jump

    @cached_property
    def load(self) -> Array:
        """The line load q of the particles, (n,) [FU/LU], compression positive.

        Of linear springs with a known edge it follows from the jump there, and is 0 outside.
        """
        if self.zone and self.is_elastic:
            edge = self.heights(np.asarray([self.zone.edge]))
            return np.where(np.abs(self.x) < self.zone.edge, self.zone.jump + edge - self.heights(self.x), 0.0)
        return self.image_ratio * self.rule.load(self.profile, self.radius)

    @cached_property
    def body(self) -> Callable[[Array], Array] | None:
        """Function κ h(x) [FU/LU] of positions (n,) [LU], κ = −dq/dh at the axis.

        None where the shape is uncertain or has an edge, springs are coupled, or too few particles touch.
        """
        if not self.is_uncoupled or self.shape.has_edge or self.shape.alternatives or self.shape.deviations:
            return None
        if self.is_elastic:
            return self.heights
        inside = np.flatnonzero((self.x > 0.0) & (self.load != 0.0))
        if inside.size < FEWEST:
            return None
        near = inside[[0, max(1, inside.size // 6)]]  # the inner part shows the slope at the axis
        fall, rise = self.load[near[0]] - self.load[near[1]], np.diff(self.heights(self.x[near]))[0]
        slope = float(fall / rise) if rise > 0.0 else 1.0
        return lambda x: slope * self.heights(x)

    def through(self, load: Array, stride: int, first: int = 0) -> LineLoad | None:
        """Return the line load through every `stride`-th particle from number `first` on, on both sides.

        None of too few. `load`: of all particles, (n,) [FU/LU].
        """
        # A known shape is resolved to round-off, one that particles show to a part of a spacing.
        apex = has_apex(self.scene) if self.body is None else has_apex(self.scene, 1e-9)

        def load_of(chosen: Array) -> LineLoad:
            """Return the line load through particles of the chosen numbers."""
            kinks = *self.shape.kinks, self.shape.reach
            return line_load(self.x[chosen], load[chosen], self.edge, self.jump, apex, self.body, kinks)

        return through(self.x.size, stride, load_of, first)


def has_apex(scene: Scene, off: float = 1e-3) -> bool:
    """Whether the profile has a tip, with a singular pressure, by its slope up to `off` spacings from the axis.

    At a tip that slope is more than half of the slope up to one spacing.
    """
    tip, neighbour = scene.bodies.height(np.array([off, 1.0]) * scene.bodies.spacing)
    return bool(tip > 0.5 * off * neighbour)


def through(size: int, stride: int, load: Callable[[Array], LineLoad], first: int = 0) -> LineLoad | None:
    """Return the line load through every `stride`-th particle on either side.

    None where these are too few or not symmetric.

    Args:
        size: number of particles of the chain.
        stride: every how many particles on a side are chosen.
        load: returns the line load through particles of given numbers.
        first: number, from the middle, of the first chosen particle on a side.
    """
    right = np.arange(size // 2 + first, size)[::stride]
    left = size - 1 - right[::-1]
    if right.size < FEWEST:
        return None
    try:
        return load(np.concatenate([left[left < right[0]], right]))
    except ValueError:
        return None
