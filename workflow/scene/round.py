"""Round bodies as they are, up to their rim: a sphere, and an ellipsoid of revolution pressed along its axis.

Sphere z = R − √(R² − x²), transform g = x artanh(x/R). An ellipsoid with the half axes b along and c across its axis is
a sphere of radius c, b/c times as high; its radius of curvature at the apex is c²/b.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

from pydantic import Field

from contact1d.workflow.scene.quantities import Length
from contact1d.workflow.scene.shape import Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]

LAST_SHARE = 1.0 - 1e-12
"""The transform of a circle grows without end at its edge, and is taken up to this share of the radius."""


class Circle(Shape):
    """Profile of the upper body: an exact circle, z = R − √(R² − x²)."""

    kind: Literal["circle"] = Field(description="z = R − √(R² − x²), an exact circle")
    radius: Length = Field(description="radius R")

    def height(self, x: Array) -> Array:
        """z = R − √(R² − x²), written without the difference of large numbers."""
        return x**2 / (self.radius + ((self.radius - x) * (self.radius + x)) ** 0.5)

    def transformed(self, x: Array) -> Array:
        """g = x artanh(x/R)."""
        import numpy as np

        share = np.clip(x / self.radius, -LAST_SHARE, LAST_SHARE)
        return np.asarray(x * np.arctanh(share))

    @property
    def reach(self) -> float:
        """R."""
        return self.radius

    @property
    def curvature_radius(self) -> float:
        """R."""
        return self.radius


class Ellipsoid(Shape):
    """Profile of the upper body: an ellipsoid of revolution, z = b − b √(1 − x²/c²)."""

    kind: Literal["ellipsoid"] = Field(description="z = b − b √(1 − x²/c²), an ellipsoid of revolution about the load")
    radius: Length = Field(description="half axis c across the load")
    half_axis: Length = Field(alias="height", description="half axis b along the load")

    def height(self, x: Array) -> Array:
        """z = b (x/c)²/(1 + √(1 − x²/c²))."""
        share = x / self.radius
        return self.half_axis * share**2 / (1.0 + ((1.0 - share) * (1.0 + share)) ** 0.5)

    def transformed(self, x: Array) -> Array:
        """g = (b/c) x artanh(x/c)."""
        import numpy as np

        share = np.clip(x / self.radius, -LAST_SHARE, LAST_SHARE)
        return np.asarray(self.half_axis * share * np.arctanh(share))

    @property
    def reach(self) -> float:
        """c."""
        return self.radius

    @property
    def curvature_radius(self) -> float:
        """c²/b."""
        return self.radius**2 / self.half_axis
