"""A measured profile: its points as they are, or what is taken of a scan of them (`analysis.scan`)."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from annotated_types import MinLen
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.points import AS_A_SCAN, FEWEST_POINTS, SHARP, Piecewise, Points, fault_of
from contact1d.workflow.scene.quantities import Auto, Height, Length, Unit
from contact1d.workflow.scene.shapes import Circle, Parabola, Power, Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contact1d.analysis.scan import Taken

    Array = NDArray[np.float64]

Radii = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
Positions = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
Heights = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
OFF_AXIS = 1
"""Intervals from the axis on of a smooth curve whose slope may rise as it likes: an apex is no kink beside it."""


class Smoothed(Piecewise):
    """A body whose slope is linear between knots: what was taken of a scan."""

    knots: tuple[float, ...]
    slopes: tuple[float, ...]

    @property
    def reach(self) -> float:
        """The last knot."""
        return self.knots[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """The middle of an interval in which the slope rises SHARP times as fast as over all: a jump that was seen so.

        What is infinite at a kink is then no number that depends on the distance of the knots.
        """
        cells = zip(pairwise(self.knots), pairwise(self.slopes), strict=True)
        steep = SHARP * max(self.slopes) / self.reach
        found = [0.5 * (start + end) for (start, end), (low, high) in cells if high - low > steep * (end - start)]
        return tuple(place for place in found if place > self.knots[OFF_AXIS])

    def _curve(self) -> Any:
        return _quadratics(self.knots, self.slopes)


@lru_cache(maxsize=64)
def _quadratics(knots: tuple[float, ...], slopes: tuple[float, ...]) -> Any:
    """The curve of these slopes, 0 on the axis."""
    import numpy as np
    from scipy.interpolate import PPoly

    x, slope = np.asarray(knots), np.asarray(slopes)
    return PPoly(
        np.stack([0.0 * x[1:], np.diff(slope) / np.diff(x), slope[:-1]]), x, extrapolate=False
    ).antiderivative()


class Fitted(Shape):
    """A named shape out to the end of the scan that it was fitted to."""

    slow = True
    inner: Shape
    end: float

    def height(self, x: Array) -> Array:
        """That of the shape."""
        import numpy as np

        return self.inner.height(np.minimum(np.abs(x), self.end))

    def transformed(self, x: Array) -> Array:
        """That of the shape."""
        import numpy as np

        return self.inner.transformed(np.minimum(np.abs(x), self.end))

    @property
    def reach(self) -> float:
        """The end."""
        return min(self.end, self.inner.reach)

    @property
    def curvature_radius(self) -> float | None:
        """That of the shape."""
        return self.inner.curvature_radius


Centre = Annotated[float, Unit("LU")]


class Measured(Shape):
    """Profile of the upper body: a measured axisymmetric one, from a file or from two lists.

    As it is, it goes through its points by monotone cubics. Where `centre`, `level`, `smooth` or `fit` say how its scan
    is to be read, the points are kept, and the profile is what `analysis.scan` takes of them.
    """

    slow = True
    kind: Literal["table"]
    """measured points, monotone cubics between them"""
    file: str | None = None
    """CSV file with the columns r and z, or r [µm] and z [µm], read into the keys r and z, or x and z; from −x to x the
    mean of both sides is taken
    """
    scale: Length | None = None
    """length of one unit of a file's numbers that has no units in it; absent: 1 LU"""
    units: Annotated[tuple[str, str], Field(strict=False)] | None = None
    """units of position and height of a file, such as ["µm", "nm"], in place of scale; with a minus for heights of a
    body seen from above: ["µm", "-nm"]
    """
    centre: Auto[Centre] | None = None
    """position of the apex in the scan, or "auto": looked for, by both sides of it; absent: 0"""
    level: bool = False
    """whether a tilt of the scan is removed; needs a flat part, or both sides of a given centre"""
    smooth: Annotated[Length | Literal["none", "auto"], Field()] | None = None
    """distance of the knots of a smooth curve that rises from the apex on, or "auto": by the noise of the scan"""
    fit: Literal["none", "parabola", "circle", "power"] = "none"
    """shape that is fitted to the points in place of a smooth curve"""
    x: Positions | None = None
    """positions of the points from side to side, in place of r; with centre, level, smooth or fit"""
    r: Radii | None = None
    """radii of the points, from 0, rising"""
    z: Heights | None = None
    """heights at these radii; the first one counts as 0"""

    @model_validator(mode="after")
    def _is_a_profile(self) -> Self:
        along = self.r if self.x is None else self.x
        if along is None or self.z is None:
            raise PydanticCustomError("scene", "needs a file, or the lists r and z")
        problem = self._fault(along, self.z)
        if problem:
            raise PydanticCustomError("scene", "{problem}", {"problem": problem})
        return self

    def _fault(self, along: tuple[float, ...], z: tuple[float, ...]) -> str | None:
        """What keeps it from being a profile."""
        if not self.is_scan:
            return fault_of(along, z) if self.x is None else f"positions x need to be read as a scan: {AS_A_SCAN}"
        if self.smooth not in (None, "none") and self.fit != "none":
            return f'fit = "{self.fit}" is a curve by itself, without smooth: remove one of the two'
        if len(along) != len(z):
            return f"must have as many positions as heights, not {len(along)} and {len(z)}"
        from contact1d.analysis.scan import ScanError  # it loads scipy, which other scenes can do without

        try:
            body = self.body
        except ScanError as error:
            return str(error)
        return fault_of(body.r, body.z) if isinstance(body, Points) else None

    @property
    def is_scan(self) -> bool:
        """Whether the profile is what is taken of the points, and not these themselves."""
        return self.centre is not None or self.level or self.is_curve

    @property
    def is_curve(self) -> bool:
        """Whether the points are given up for a curve."""
        return self.smooth not in (None, "none") or self.fit != "none"

    @property
    def taken(self) -> Taken | None:
        """What is taken of the scan, where there is one."""
        return self._read(self.smooth if isinstance(self.smooth, float | int) else None) if self.is_scan else None

    def _read(self, length: float | None) -> Taken:
        """What is taken with knots at this distance; None: by the noise."""
        centre = None if self.centre == "auto" else self.centre or 0.0
        along = self.r if self.x is None else self.x
        shape = None if self.fit == "none" else self.fit
        return _take(along or (), self.z or (), centre, self.level, length, shape)

    @property
    def body(self) -> Shape:
        """The body that is taken."""
        taken = self.taken
        if taken is None:
            return Points.model_construct(r=self.r or (), z=self.z or ())
        if self.is_curve:
            return _shape_of(taken, taken.parameters)
        r, z = taken.folded()
        return Points.model_construct(r=tuple(r.tolist()), z=tuple(z.tolist()))

    def height(self, x: Array) -> Array:
        """That of the body."""
        return self.body.height(x)

    def transformed(self, x: Array) -> Array:
        """That of the body."""
        return self.body.transformed(x)

    @property
    def reach(self) -> float:
        """That of the body."""
        return self.body.reach

    @property
    def kinks(self) -> tuple[float, ...]:
        """Those of the body."""
        return self.body.kinks

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Those of the points; of a curve with knots at a given distance that with half of it."""
        if not self.is_curve:
            return self.body.alternatives
        finer = [self._read(0.5 * self.smooth)] if isinstance(self.smooth, float | int) else []
        return tuple(_shape_of(one, one.parameters) for one in finer)

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """That of the points; a curve has none."""
        return self.body.coarser

    @property
    def deviations(self) -> tuple[tuple[Shape, Shape], ...]:
        """Curves that the noise of the scan allows as well."""
        if not self.is_curve or (taken := self.taken) is None:
            return ()
        return tuple((_shape_of(taken, more), _shape_of(taken, less)) for more, less in taken.deviations)


@lru_cache(maxsize=8)
def _take(along: tuple[float, ...], z: tuple[float, ...], *how: Any) -> Taken:
    """What is taken of a scan; kept, since every height is asked of it."""
    import numpy as np

    from contact1d.analysis.scan import take

    return take(np.asarray(along), np.asarray(z), *how)


def _shape_of(taken: Taken, parameters: Array) -> Shape:
    """The body with these parameters."""
    first, *more = parameters.tolist()
    if taken.shape == "smooth":
        return Smoothed.model_construct(knots=tuple(taken.knots.tolist()), slopes=(0.0, first, *more))
    inner: Shape
    if taken.shape == "power":
        inner = Power.model_construct(exponent=more[0], radius=float(taken.x[-1] - taken.x[0]), height_there=first)
    else:
        inner = (Circle if taken.shape == "circle" else Parabola).model_construct(radius=1.0 / first)
    return Fitted.model_construct(inner=inner, end=taken.reach)
