"""The line load of a state, of which p(r) is made."""

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

INNER = 6
"""Part of the particles in a contact that show the slope of its load at the axis."""
TIP, KNOWN_TIP, KINK = 1e-3, 1e-9, 0.5
"""A profile has an apex where so little of a spacing off the axis its slope is that share of the one to a spacing; the
second where the body's own shape is taken, and not what particles make of it."""


@dataclass(frozen=True, eq=False)
class Loaded:
    """The line load of a state, of which p(r) is made; that of the paper's spheres as half as wide.

    Attributes:
        scene: what ran.
        profile, radius: of the state.
        rule: what its contact radius is.
    """

    scene: Scene
    profile: Profile
    radius: ContactRadius
    rule: RadiusRule

    @cached_property
    def wider(self) -> float:
        """Image over body."""
        return WIDER_THAN_SPHERES if stands_for_spheres(self.scene) else 1.0

    @property
    def shape(self) -> Shape:
        """Of the body."""
        return self.scene.bodies.profile

    @property
    def zone(self) -> ZonedProfile | None:
        """The profile, where its law tells where the contact ends."""
        return self.profile if isinstance(self.profile, ZonedProfile) else None

    def has_kinks(self, shape: Shape) -> bool:
        """Whether a body has kinks inside the contact."""
        return any(kink < self.radius.value for kink in shape.kinks)

    @property
    def is_alone(self) -> bool:
        """Whether particles on a plane carry by themselves, so that their load is a function of the body's height."""
        return self.scene.bodies.lower == "rigid_plane" and self.scene.neighbours is None

    @property
    def is_elastic(self) -> bool:
        """Whether that function is a straight line of the springs' own slope."""
        return self.is_alone and self.scene.keeps_springs

    @cached_property
    def x(self) -> Array:
        """Positions [LU], (n,)."""
        return self.profile.x / self.wider

    @property
    def layer(self) -> float:
        """Stiffness of the springs [FU/LU²]."""
        return self.scene.bulk_stiffness / self.scene.bodies.spacing

    def heights(self, x: Array, shape: Shape | None = None) -> Array:
        """c h(x) of the body [FU/LU], or of another one."""
        bodies = self.scene.bodies
        return self.layer * (bodies if shape is None else bodies.model_copy(update={"profile": shape})).height(x)

    @cached_property
    def edge(self) -> float | None:
        """Where the load of the contact ends [LU]; None where it fades out."""
        return None if self.scene.interaction and not self.shape.has_edge else self.radius.value / self.wider

    @cached_property
    def jump(self) -> float | None:
        """The load just inside the edge [FU/LU]; None where the particles show it: at the end of a body, and of JKR."""
        if self.zone:
            return self.zone.jump
        return self.rule.jump

    @cached_property
    def load(self) -> Array:
        """q [FU/LU] of the particles, (n,); of springs with a straight load what the edge and the jump there say."""
        if self.zone and self.is_elastic:
            edge = self.heights(np.asarray([self.zone.edge]))
            return np.where(np.abs(self.x) < self.zone.edge, self.zone.jump + edge - self.heights(self.x), 0.0)
        return self.wider * self.rule.load(self.profile, self.radius)

    @cached_property
    def body(self) -> Callable[[Array], Array] | None:
        """κ h(x) [FU/LU], κ = −dq/dh at the axis; None where the shape of a body is open, or springs are not alone."""
        if not self.is_alone or self.shape.has_edge or self.shape.alternatives or self.shape.deviations:
            return None
        if self.is_elastic:
            return self.heights
        inside = np.flatnonzero((self.x > 0.0) & (self.load != 0.0))
        if inside.size < FEWEST:
            return None
        near = inside[[0, max(1, inside.size // INNER)]]
        fall, rise = self.load[near[0]] - self.load[near[1]], np.diff(self.heights(self.x[near]))[0]
        slope = float(fall / rise) if rise > 0.0 else 1.0
        return lambda x: slope * self.heights(x)

    def through(self, load: Array, stride: int, first: int = 0) -> LineLoad | None:
        """The line load through every `stride`-th particle on either side, from the first one or a later one on."""
        apex = has_apex(self.scene, TIP if self.body is None else KNOWN_TIP)

        def of(chosen: Array) -> LineLoad:
            kinks = *self.shape.kinks, self.shape.reach
            return line_load(self.x[chosen], load[chosen], self.edge, self.jump, apex, self.body, kinks)

        return through(self.x.size, stride, of, first)


def has_apex(scene: Scene, off: float = TIP) -> bool:
    """Whether the profile has a tip, below which a pressure has no bound, by its slope `off` spacings from the axis."""
    tip, beside = scene.bodies.height(np.array([off, 1.0]) * scene.bodies.spacing)
    return bool(tip > KINK * off * beside)


def through(size: int, stride: int, load: Callable[[Array], LineLoad], first: int = 0) -> LineLoad | None:
    """The line load through every `stride`-th particle on either side; None where these are too few."""
    right = np.arange(size // 2 + first, size)[::stride]
    left = size - 1 - right[::-1]
    if right.size < FEWEST:
        return None
    try:
        return load(np.concatenate([left[left < right[0]], right]))
    except ValueError:
        return None
