"""What every profile of the upper body can do."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import TYPE_CHECKING, ClassVar

from contact1d.workflow.scene.quantities import Table

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Array = NDArray[np.float64]


class Shape(Table):
    """What all profiles can do; a kind overrides what differs.

    `has_edge`: the body ends at its `reach` by a flank, so that its chain is as long as it is wide and the contact is
    too; others rise, and the contact ends on them.
    """

    has_edge: ClassVar[bool] = False

    @abstractmethod
    def height(self, x: Array) -> Array:
        """Height z(x) = f(|x|) [LU] above the apex as drawn, at the places `x` [LU]; same shape."""

    @abstractmethod
    def transformed(self, x: Array) -> Array:
        """Height g(x) [LU] above the apex after the MDR's transform, at the places `x` [LU]; same shape."""

    @property
    def reach(self) -> float:
        """Half-width [LU] within which there is a body at all."""
        return math.inf

    @property
    def curvature_radius(self) -> float | None:
        """Radius of curvature R at the apex [LU], None where there is none."""
        return None
