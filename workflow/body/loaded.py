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
from contact1d.workflow.body.reading import image_ratio
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.scene import Scene, Shape


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
        """Width of the contact in the particle model over that of the body, dimensionless; cached."""
        return image_ratio(self.scene)

    @property
    def shape(self) -> Shape:
        """The profile of the upper body as the scene gives it, a `Shape`, without the transform of the reduction."""
        return self.scene.bodies.profile

    @property
    def zone(self) -> ZonedProfile | None:
        """The profile of the state if the contact law has computed its edge; else None.

        So it is of adhesion with a range. The edge of a viscoelastic body and of one with a rate-dependent adhesion is
        computed as well; that of JKR, of springs and of an interaction is not.
        """
        return self.profile if isinstance(self.profile, ZonedProfile) else None

    def has_kinks(self, shape: Shape) -> bool:
        """Return whether the slope of this shape jumps off the axis, nearer than the contact radius of the state."""
        return any(kink < self.radius.value for kink in shape.slope_jumps)

    @property
    def is_full(self) -> bool:
        """Whether the contact is as wide as a body with an edge that is not plane."""
        return self.shape.has_edge and not self.shape.is_plane and self.radius.value == self.shape.reach

    @property
    def is_uncoupled(self) -> bool:
        """Whether the lower body is a rigid plane and the scene has no springs between neighbours.

        Then the force of a particle is a function of the height of the body above it, as far as it has no memory.
        """
        return self.scene.bodies.lower == "rigid_plane" and self.scene.neighbours is None

    @property
    def is_elastic(self) -> bool:
        """Whether, on a rigid plane without springs between neighbours, particles in contact are linear springs.

        Then the line load inside the contact is linear in the height of the body. False of a viscoelastic body and with
        noise; True with adhesion or friction.
        """
        return self.is_uncoupled and self.scene.keeps_springs

    @cached_property
    def x(self) -> Array:
        """Positions of the particles along the body, rising, 0 at the axis, (n,) [LU]; cached.

        Half of those in the particle model where the results are those of two equal spheres.
        """
        return self.profile.x / self.image_ratio

    @property
    def layer(self) -> float:
        """Stiffness per length [FU/LU²] of the springs of one chain: that of a particle to its bulk, over the spacing.

        It is not that of two chains in series.
        """
        return self.scene.bulk_stiffness / self.scene.bodies.spacing

    def heights(self, x: Array, shape: Shape | None = None) -> Array:
        """Return w c h(w x), (n,) [FU/LU], at positions x (n,) [LU] of the body, or of another `shape` in its place.

        h is the height [LU] above the apex, with the MDR the transformed one; c the stiffness per length of one chain
        (`layer`) [FU/LU²]; w is `image_ratio`: 2 where results are those of two equal spheres (Geike and Popov), else
        1. Beyond the end of the profile it is NaN of a circle or an ellipsoid without the MDR, else finite without
        meaning.
        """
        bodies = self.scene.bodies
        image = bodies if shape is None else bodies.model_copy(update={"profile": shape})
        return self.image_ratio * self.layer * image.height(self.image_ratio * x)

    @cached_property
    def edge(self) -> float | None:
        """Half-width of the line load [LU], that is the contact radius of the body; cached.

        None with an interaction, unless the body has an edge: such a load decays without an end.
        """
        return None if self.scene.interaction and not self.shape.has_edge else self.radius.value / self.image_ratio

    @cached_property
    def jump(self) -> float | None:
        """The line load just inside the edge less that just outside [FU/LU], compression positive; cached.

        It is the law's own where the law computes the edge; else 0, of a load that falls to 0 at its edge, or of an
        interaction. None where only the particles show it: at the edge of a punch, and of JKR.
        """
        if self.zone:
            return self.zone.jump
        return None if self.is_full else self.rule.jump

    @cached_property
    def load(self) -> Array:
        """The line load q of the particles, (n,) [FU/LU], compression positive; cached.

        It is the force of a particle over the spacing (of a cell at JKR's edge over its part inside), multiplied by
        `image_ratio`. Of linear springs whose edge the law computes it is instead the jump there plus c h(edge) − c
        h(x), and 0 from the edge on.
        """
        if self.zone and self.is_elastic:
            edge = self.heights(np.asarray([self.zone.edge]))
            return np.where(np.abs(self.x) < self.zone.edge, self.zone.jump + edge - self.heights(self.x), 0.0)
        return self.image_ratio * self.rule.load(self.profile, self.radius)

    @cached_property
    def body(self) -> Callable[[Array], Array] | None:
        """Function of positions (n,) [LU] that returns a multiple of `heights`, (n,) [FU/LU]; cached.

        For linear springs `heights` itself, else with the slope of the line load at the axis, or `heights` if they do
        not rise there. None where particles are coupled, or the lower body is no rigid plane; where the shape
        is plane, or uncertain (a table or a scan); and where springs are not linear and fewer than 3 particles on
        a side carry a load.
        """
        if not self.is_uncoupled or self.shape.is_plane or self.shape.alternatives or self.shape.deviations:
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
        """Return the line load through every `stride`-th particle on both sides, counted from the middle of the chain.

        None where that leaves fewer than 3 on a side, or positions that differ between both sides.

        Args:
            load: line load at all particles, (n,) [FU/LU].
            stride: every how many particles on a side are used.
            first: number, from 0 at the middle, of the first one on a side.
        """
        # A known shape is resolved to round-off, one that particles show to a part of a spacing.
        apex = has_apex(self.scene) if self.body is None else has_apex(self.scene, 1e-9)

        def load_of(chosen: Array) -> LineLoad:
            """Return the line load through the particles of the `chosen` numbers, rising along the chain.

            Raises:
                ValueError: fewer than 3 positions on a side within the edge, or positions that differ between both
                    sides.
            """
            kinks = *self.shape.kinks, self.shape.reach
            return line_load(self.x[chosen], load[chosen], self.edge, self.jump, apex, self.body, kinks)

        return through(self.x.size, stride, load_of, first)


def has_apex(scene: Scene, off: float = 1e-3) -> bool:
    """Return whether the profile under the reduction has a tip, as a cone, so that the pressure is singular there.

    It has one if its mean slope up to `off` spacings from the axis is more than half of that up to one spacing.
    """
    tip, neighbour = scene.bodies.height(np.array([off, 1.0]) * scene.bodies.spacing)
    return bool(tip > 0.5 * off * neighbour)


def through(size: int, stride: int, load: Callable[[Array], LineLoad], first: int = 0) -> LineLoad | None:
    """Return the line load through every `stride`-th particle on either side of the middle of a chain.

    None where there are fewer than 3 on a side, or where `load` raises ValueError (positions that are not symmetric,
    too few within the edge).

    Args:
        size: number of particles of the chain; a particle in the middle is used once.
        stride: every how many particles on a side are chosen.
        load: returns the line load through particles of given numbers, (k,), rising.
        first: number, from 0 at the middle, of the first chosen particle on a side.
    """
    right = np.arange(size // 2 + first, size)[::stride]
    left = size - 1 - right[::-1]
    if right.size < FEWEST:
        return None
    try:
        return load(np.concatenate([left[left < right[0]], right]))
    except ValueError:
        return None
