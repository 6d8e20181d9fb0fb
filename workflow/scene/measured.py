"""A measured profile: its points as they are, or a curve that is fitted to them as a scan (`analysis.scan_fit`)."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from annotated_types import MinLen
from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import Auto, Length, SignedLength
from contact1d.workflow.scene.shapes import FEWEST_POINTS, Shape

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contact1d.analysis.scan import Taken

    Array = NDArray[np.float64]

Coordinates = Annotated[tuple[SignedLength, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
CURVE_KEYS = {"smooth": None, "fit": "none"}
"""Keys of a profile by which a curve replaces its points, with their defaults."""
SCAN_KEYS = {"centre": None, "level": False, **CURVE_KEYS}
"""Keys of a profile that say how its points are read as a scan, with their defaults."""
AS_A_SCAN = (
    'of a noisy scan, centre = "auto" with smooth = "auto" or fit = "parabola" takes the apex and a curve that rises'
)
"""The suggested fix for points that are no profile by themselves."""


def is_scan(profile: Mapping[str, Any], keys: Mapping[str, Any] = SCAN_KEYS) -> bool:
    """Return whether a profile's points are those of a scan: one of the `keys` is there and differs from its default.

    "none" counts as the default; a given centre of 0 does not.

    Args:
        profile: values by key.
        keys: default by key; centre, level, smooth and fit where it is not given.
    """
    return any(profile.get(key, default) not in (default, "none") for key, default in keys.items())


def fault_of(r: tuple[float, ...], z: tuple[float, ...]) -> str | None:
    """Return why radii r and heights z [LU] are no profile, with the suggested fix; None if they are one.

    There must be as many radii as heights, at least two (ValueError for one). Radii must begin at 0 and rise, without a
    step above ten times the median one; no height may be below the first, and one must be above it. The first of these
    that is not met is returned.
    """
    if len(r) != len(z):
        return f"must have as many radii as heights, not {len(r)} and {len(z)}"
    steps = [after - before for before, after in pairwise(r)]
    if min(steps) <= 0.0:
        i = next(i for i, step in enumerate(steps) if step <= 0.0)
        return f"radii must increase; {r[i + 1]:.6g} LU follows {r[i]:.6g} LU"
    if r[0] != 0.0:
        return f"must begin at the radius 0, not {r[0]:.6g} LU: the transform needs the slope from the axis on"
    median = statistics.median(steps)
    largest = 10.0 * median
    for i, step in enumerate(steps):
        if step > largest:
            return (
                f"has a gap from r = {r[i]:.6g} LU to {r[i + 1]:.6g} LU: the median step is {median:.4g} LU, and "
                f"the largest gap allowed {largest:.4g} LU; add points there"
            )
    if z[0] - min(z) > max(z) - z[0]:
        return "has heights that decrease from the axis: heights are measured from the plane; change the sign"
    lowest = z.index(min(z))
    if z[lowest] < z[0]:
        off = f"at r = {r[lowest]:.6g} LU the height is lower by {z[0] - z[lowest]:.4g} LU"
        return f"must have its apex at r = 0; {off}; {AS_A_SCAN}"
    if max(z) == z[0]:
        return 'is flat: write kind = "flat_punch"'
    return None


class Measured(Shape):
    """Profile of the upper body: a measured axisymmetric one, from a file or from two lists.

    As it is, it goes through its points by monotone cubics. Where `centre`, `level`, `smooth` or `fit` say how its scan
    is to be read, the points are kept, and the profile is what `analysis.scan_fit` takes of them.
    """

    slow = True
    kind: Literal["table"]
    """measured points, with monotone cubics between them or a fitted curve"""
    file: str | None = None
    """file with the columns r and z, or x and z, if they have units as r [µm] and z [µm], or file of an instrument; of
    positions from −x to x the mean of both sides is taken
    """
    scale: Length | None = None
    """length of one unit of the numbers in a file without units; absent: 1 LU"""
    units: Annotated[tuple[str, str], Field(strict=False)] | None = None
    """units of position and height of a file, such as ["µm", "nm"], in place of scale; with a minus for heights of a
    body seen from above: ["µm", "-nm"]
    """
    centre: Auto[SignedLength] | None = None
    """position of the apex in the scan, or "auto": where both sides of it are alike; absent: 0"""
    level: bool = False
    """whether a tilt of the scan is removed; needs a flat part, or both sides of a given centre"""
    smooth: Annotated[Length | Literal["none", "auto"], Field()] | None = None
    """distance of the knots of a smooth curve that rises from the apex on and replaces the points, or "auto": chosen by
    the noise of the scan
    """
    fit: Literal["none", "parabola", "circle", "power"] = "none"
    """shape that is fitted to the points in place of a smooth curve"""
    x: Coordinates | None = None
    """positions of the points from side to side, in place of r; with centre, level, smooth or fit"""
    r: Coordinates | None = None
    """radii of the points, from 0, rising"""
    z: Coordinates | None = None
    """heights at these radii or positions; that of the apex counts as 0"""

    @model_validator(mode="after")
    def _is_a_profile(self) -> Self:
        """Return this profile unchanged; raise PydanticCustomError where points are missing or are no profile."""
        if problem := self._fault():
            raise PydanticCustomError("scene", "{problem}", {"problem": problem})
        return self

    def _fault(self) -> str | None:
        """Return why positions and heights [LU] are no profile, or are missing, with the suggested fix; None if valid.

        Points that are kept must begin at the axis and rise from there; positions x from side to side need one of the
        keys centre, level, smooth and fit. Of points that a curve replaces it is the reason for which it cannot be
        fitted, or that the keys exclude each other.
        """
        along, z = self.r if self.x is None else self.x, self.z
        if along is None or z is None:
            return "needs a file, or the lists r and z"
        if not self.is_scan:
            return fault_of(along, z) if self.x is None else f"positions x need to be read as a scan: {AS_A_SCAN}"
        if self.smooth not in (None, "none") and self.fit != "none":
            return f'fit = "{self.fit}" is a curve by itself, without smooth: remove one of the two'
        if len(along) != len(z):
            return f"must have as many positions as heights, not {len(along)} and {len(z)}"
        from contact1d.analysis.scan import ScanError  # it loads scipy, which other scenes can do without

        try:
            return fault_of(*self._from_the_axis()) if self.taken and not self.is_curve else None
        except ScanError as error:
            return str(error)

    @property
    def is_scan(self) -> bool:
        """Whether the points are those of a scan, by one of the keys centre (also of 0), level, smooth and fit."""
        return is_scan(vars(self))

    @property
    def is_curve(self) -> bool:
        """Whether a fitted curve replaces the points, by one of the keys smooth and fit.

        False where they are only centred or levelled.
        """
        return is_scan(vars(self), CURVE_KEYS)

    @property
    def taken(self) -> Taken | None:
        """The curve that is fitted to the scan, with its parameters in powers of LU; None where the points are no scan.

        It is there, too, where the points of the scan are kept (only centred or levelled). Cached.

        Raises:
            ScanError: the points determine no such curve.
        """
        return _taken(self)

    def _from_the_axis(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return (radii, heights) [LU] of the points as given, not of a scan.

        Of a scan the mean of its sides without tilt, at evenly spaced radii from 0, with the height 0 there.
        """
        taken = self.taken
        if taken is None:
            return self.r or (), self.z or ()
        r, z = taken.folded()
        return tuple(r.tolist()), tuple(z.tolist())

    @property
    def body(self) -> Shape:
        """The body through the points, or the fitted curve of a scan with smooth or fit; cached."""
        return _body(self)

    def height(self, x: Array) -> Array:
        """Return the height [LU] of the measured body above its apex at positions x [LU]; same shape.

        It is constant beyond the end of the points or the scan. NaN beyond the radius of a fitted circle that ends
        before its scan.
        """
        return self.body.height(x)

    def transformed(self, x: Array) -> Array:
        """Return the height g(x) [LU] of the measured body after the MDR transform at positions x [LU]; same shape.

        It is constant beyond the end of the points or the scan.
        """
        return self.body.transformed(x)

    @property
    def reach(self) -> float:
        """The half-width [LU] of the measured body: of its last point, or of the end of a fitted curve."""
        return self.body.reach

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU], rising, at which the slope of the measured body jumps; empty without any or of a fitted shape."""
        return self.body.kinks

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Other bodies that the points may mean, as a tuple.

        Where the points are kept, two or five: with chords and with corners between the points, and where heights have
        nine digits or fewer three with heights moved by half a digit. Of a curve with a given distance of its knots it
        is one, the curve with half of it (ScanError where the points determine none); of another curve there is none.
        """
        if isinstance(self.smooth, float | int):
            return (self.model_copy(update={"smooth": 0.5 * self.smooth}).body,)
        return self.body.alternatives

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """Bodies through fewer of the points, two, one or none; empty of a curve that replaces the points."""
        return self.body.coarser

    @property
    def deviations(self) -> tuple[tuple[Shape, Shape], ...]:
        """Pairs of curves: half of the difference of a result is its uncertainty at 95 % due to noise of the scan.

        Different pairs are independent. Empty where the points are kept.
        """
        from contact1d.workflow.scene.points import curve_of

        if not self.is_curve or (taken := self.taken) is None:
            return ()
        return tuple((curve_of(taken, more), curve_of(taken, less)) for more, less in taken.deviations)


@lru_cache(maxsize=8)
def _taken(profile: Measured) -> Taken | None:
    """Return the curve that is fitted to the scan of a profile; None where its points are no scan; cached.

    Raises:
        ScanError: the points determine no such curve.
    """
    if not profile.is_scan:
        return None
    import numpy as np

    from contact1d.analysis.scan_fit import take

    along = profile.r if profile.x is None else profile.x
    centre = None if profile.centre == "auto" else profile.centre or 0.0
    length = profile.smooth if isinstance(profile.smooth, float | int) else None
    shape = None if profile.fit == "none" else profile.fit
    return take(np.asarray(along), np.asarray(profile.z), centre, profile.level, length, shape)


@lru_cache(maxsize=8)
def _body(profile: Measured) -> Shape:
    """Return the body through the points of a profile, or the fitted curve of its scan; cached with its curve."""
    from contact1d.workflow.scene.points import Points, curve_of  # it loads scipy as well

    if profile.is_curve and (taken := profile.taken):
        return curve_of(taken, taken.parameters)
    r, z = profile._from_the_axis()
    return Points.model_construct(r=r, z=z)
