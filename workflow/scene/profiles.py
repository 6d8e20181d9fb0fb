"""Shapes of the upper body, each as drawn, z(x), and as the method of dimensionality reduction (MDR) transforms it.

The MDR takes the axisymmetric body z = f(r) to the plane one

    g(x) = |x| ∫₀^|x| f′(r) / √(x² − r²) dr

which with springs E* per length has the body's force, displacement and contact radius (Popov and Heß, Method of
Dimensionality Reduction in Contact Mechanics and Friction, 2015, chapter 3). Powers: g = κ_n f, κ_n =
(√π/2) n Γ(n/2)/Γ((n+1)/2), κ₁ = π/2, κ₂ = 2. Circle: z = R − √(R² − x²), g = x artanh(x/R). An ellipsoid with the half
axes b along and c across its axis is a sphere of radius c, b/c times as high.
"""

from __future__ import annotations

import math
import statistics
from abc import abstractmethod
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self

from annotated_types import Ge, MinLen
from pydantic import BeforeValidator, Discriminator, Field, model_validator
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import Auto, Height, Length, Ratio, SignedRadius, Table, Unit
from contact1d.workflow.scene.si_text import UnitTextError, si_value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contact1d.analysis.scan import Taken

    Array = NDArray[np.float64]

Exponent = Annotated[float, Ge(1.0), Unit("1")]
STEEPEST = 3.0
"""Slope at a measured point over the rise to its neighbour up to which a cubic has no overshoot."""
CELLS = 1_000_000
"""Places times points of a measured profile that are transformed at once, to bound the memory."""

LAST_SHARE = 1.0 - 1e-12
"""The transform of a circle grows without end at its edge, and is taken up to this share of the radius."""


class Shape(Table):
    """What all profiles can do; a kind overrides what differs.

    `has_edge`: the body ends at its `reach` by a flank, so that its chain is as long as it is wide and the contact is
    too; others rise, and the contact ends on them.
    """

    has_edge: ClassVar[bool] = False
    slow: ClassVar[bool] = False
    """Whether the transform takes long, so that a predictor that asks thousands of times has it tabulated."""

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

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU] off the axis at which the slope jumps: a pressure there has no bound, and g′ is not finite."""
        return ()

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """What the body may be instead, by all that is known of it; a formula leaves nothing open."""
        return ()

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """The same with less known of it, in place of an alternative that is no contact."""
        return ()

    @property
    def deviations(self) -> tuple[tuple[Shape, Shape], ...]:
        """Pairs of bodies: half of the difference of each is an independent uncertainty at 95 %; a formula has none."""
        return ()

    @property
    def taken(self) -> Taken | None:
        """What is taken of a scan; None of a shape that is given."""
        return None

    @property
    def steepest(self) -> Self:
        """The steeper one of the two bodies, whose slope and size limit the theory: this one on a plane."""
        return self


class Parabola(Shape):
    """Profile of the upper body: z = x²/2R, of two curved bodies the gap, 1/R = 1/R₁ + 1/R₂."""

    kind: Literal["parabola"]
    """z = x²/2R, the paper's circle"""
    radius: Length
    """radius of curvature R at the apex; with a counter_radius R₁"""
    counter_radius: SignedRadius | None = None
    """radius of curvature R₂ of the lower body, 1/R = 1/R₁ + 1/R₂: positive for a convex one; negative for a concave
    one, a cup, and then larger in magnitude than the radius; absent: a plane
    """

    def height(self, x: Array) -> Array:
        """z = x²/2R."""
        return x**2 / (2 * self.curvature_radius)

    def transformed(self, x: Array) -> Array:
        """g = x²/R."""
        return x**2 / self.curvature_radius

    @property
    def curvature_radius(self) -> float:
        """R, the effective one of both bodies: R₁/(1 + R₁/R₂)."""
        return self.radius / (1.0 + self.radius / (self.counter_radius or math.inf))

    @property
    def steepest(self) -> Self:
        """The body with the smaller radius: the gap of a ball in a cup is flat where the ball itself is steep."""
        radius = min(self.radius, abs(self.counter_radius or math.inf))
        return self.model_copy(update={"radius": radius, "counter_radius": None})


class Circle(Shape):
    """Profile of the upper body: an exact circle, z = R − √(R² − x²)."""

    kind: Literal["circle"]
    """z = R − √(R² − x²), an exact circle"""
    radius: Length
    """radius R"""

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

    kind: Literal["ellipsoid"]
    """z = b − b √(1 − x²/c²), an ellipsoid of revolution about the load"""
    radius: Length
    """half axis c across the load"""
    half_axis: Length = Field(alias="height")
    """half axis b along the load"""

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


def _half_angle(text: object) -> object:
    """The text as it is, where it is a half angle. Raises PydanticCustomError."""
    problem = 'must be text with a unit, greater than 0° and less than 90°, from the axis to the flank: write "80°"'
    try:
        if isinstance(text, str) and "±" in text:
            problem = 'has no uncertainty: give the slope, its cotangent, with one, slope = "0.18 ± 0.01"'
        elif isinstance(text, str) and 0.0 < si_value(text, "rad")[0] < 0.5 * math.pi:
            return text
    except UnitTextError as error:
        problem = str(error)
    raise PydanticCustomError("scene", "{problem}", {"problem": problem})


class Cone(Shape):
    """Profile of the upper body: z = s |x|."""

    one_of = ((("slope", "half_angle"), 'give one of the two: slope = 0.1, or half_angle = "80°"'),)

    kind: Literal["cone"]
    """z = s |x|"""
    slope: Ratio | None = None
    """slope s, the tangent of the angle between flank and plane"""
    half_angle: Annotated[str, BeforeValidator(_half_angle)] | None = None
    """half angle from the axis to the flank, such as "80°" or "1.4 rad", less than 90°, in place of the slope, which
    is its cotangent
    """

    @property
    def rise(self) -> float:
        """s."""
        return self.slope or 1.0 / math.tan(si_value(self.half_angle or "", "rad")[0])

    def height(self, x: Array) -> Array:
        """z = s |x|."""
        return self.rise * abs(x)

    def transformed(self, x: Array) -> Array:
        """g = (π/2) s |x|."""
        return 0.5 * math.pi * self.rise * abs(x)


class Level(Shape):
    """z = 0 wherever there is a body."""

    has_edge = True

    def height(self, x: Array) -> Array:
        """z = 0."""
        return 0.0 * abs(x)

    def transformed(self, x: Array) -> Array:
        """g = 0."""
        return 0.0 * abs(x)


class Flat(Level):
    """Profile of the upper body: z = 0 without end; its chain closes on itself (`bodies.periodic`)."""

    kind: Literal["flat"]
    """z = 0 without end, with bodies.periodic"""


class FlatPunch(Level):
    """Profile of the upper body: z = 0 out to the edge, and no body beyond it."""

    kind: Literal["flat_punch"]
    """z = 0 within the radius, no body beyond it"""
    radius: Length
    """radius, a whole number of half spacings"""

    @property
    def reach(self) -> float:
        """The radius."""
        return self.radius


class Power(Shape):
    """Profile of the upper body: z = h (|x|/a)ⁿ."""

    kind: Literal["power"]
    """z = h (|x|/a)ⁿ"""
    exponent: Exponent
    """exponent n"""
    radius: Length
    """radius a at which the height is given"""
    height_there: Length = Field(alias="height")
    """height h at that radius"""

    def height(self, x: Array) -> Array:
        """z = h (|x|/a)ⁿ."""
        return self.height_there * abs(x / self.radius) ** self.exponent

    def transformed(self, x: Array) -> Array:
        """g = κ_n z."""
        from contact1d.analysis.theory.indenters import galin_factor  # it loads numpy, which a scene can do without

        return galin_factor(self.exponent) * self.height(x)


FEWEST_POINTS = 4
"""Points of a measured profile."""
Radii = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
Positions = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
Heights = Annotated[tuple[Height, ...], Field(strict=False), MinLen(FEWEST_POINTS)]
ROUGH, BESIDE = 3.0, 2
"""Ratio of the curvatures at the four points around a cell from which on they show no smooth curve, and how many cells
on either side do not, either."""
SHARP = 8.0
"""Curvature at a point, or at two beside each other, over that at both neighbours from which on the slope jumps."""


class Piecewise(Shape):
    """A body whose curve is polynomials of up to the third degree between points."""

    slow = True

    @abstractmethod
    def _curve(self) -> Any:
        """Its `scipy.interpolate.PPoly`, from the axis to its end."""

    def height(self, x: Array) -> Array:
        """z(|x|) − z(0)."""
        import numpy as np

        return np.asarray(self._curve()(np.minimum(np.abs(x), self.reach)))

    def transformed(self, x: Array) -> Array:
        """g, exactly: the slope is a parabola p₀ + p₁ r + p₂ r² between two points.

        ∫ (p₀ + p₁ r + p₂ r²)/√(x² − r²) dr = (p₀ + p₂ x²/2) arcsin(r/x) − (p₁ + p₂ r/2) √(x² − r²).
        """
        import numpy as np

        radii, p_0, p_1, p_2 = _slopes(self._curve())
        flat = np.minimum(np.abs(np.ravel(x)), self.reach)
        g = np.zeros_like(flat)
        chunk = max(1, CELLS // len(p_0))
        for start in range(0, flat.size, chunk):
            place = flat[start : start + chunk, None]
            ends = np.minimum(radii, place)
            angle = np.arcsin(ends / np.where(place > 0.0, place, 1.0))
            root = np.sqrt((place - ends) * (place + ends))
            parts = (p_0 + 0.5 * p_2 * place**2) * np.diff(angle, axis=1)
            parts -= p_1 * np.diff(root, axis=1) + 0.5 * p_2 * np.diff(ends * root, axis=1)
            g[start : start + chunk] = place[:, 0] * parts.sum(axis=1)
        return g.reshape(np.shape(x))


class Points(Piecewise):
    """A body that is known at points (r, z), from r = 0 on.

    Between them it is a monotone cubic: no overshoot, a paraboloid met exactly, and a continuous slope but at points
    where that jumps, as at the edge of a land.
    """

    sharp: ClassVar[float] = SHARP
    r: tuple[float, ...]
    z: tuple[float, ...]

    @property
    def reach(self) -> float:
        """The last radius."""
        return self.r[-1]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the points show that."""
        x, _, corners = _points(self.r, self.z, self.sharp)
        return tuple(x[corners].tolist())

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Where the points show no smooth curve, chords, and the corners in which neighbouring chords meet.

        A body whose slope only rises is between the two. Of heights with few digits, also the apex half a digit lower.
        """
        found: list[Shape] = [kind.model_construct(r=self.r, z=self.z) for kind in (Chords, Corners)]
        if digit := _digit(self.z):
            found.append(Points.model_construct(r=self.r, z=(self.z[0] - 0.5 * digit, *self.z[1:])))
        return tuple(found)

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """The curve through every second point, or through the others."""
        r, z = self.r, self.z
        fewer = [((r[0], *r[first:-1:2], r[-1]), (z[0], *z[first:-1:2], z[-1])) for first in (1, 2)]
        return tuple(Points.model_construct(r=r, z=z) for r, z in fewer if len(r) >= FEWEST_POINTS)

    def _curve(self) -> Any:
        return _spline(self.r, self.z)


class Chords(Points):
    """A measured profile that is straight between its points, where these show no smooth curve."""

    def _curve(self) -> Any:
        return _angular(self.r, self.z, False)


class Corners(Points):
    """The same with a corner in each such cell where the chords on both sides of it meet in it.

    Kinks are also where the points do not exclude that the slope jumps.
    """

    sharp: ClassVar[float] = ROUGH

    def _curve(self) -> Any:
        return _angular(self.r, self.z, True)


MOST_DIGITS, NEARLY = 10, 1e-4
"""Digits of heights that are rounded, at most, and how near to a whole multiple one is one."""
LEAST_JUMP = 1e-6
"""Such a jump over the largest slope at least: others are round-off."""
INSIDE = 1e-3
"""Of a cell, the least distance of such a jump from its ends: there the points beside it would have shown it."""
FLANK = 3
"""Points on either side of a jump whose parabola goes on to where it meets the other one."""


@lru_cache(maxsize=8)
def _points(r: tuple[float, ...], z: tuple[float, ...], sharpness: float = SHARP) -> tuple[Array, Array, list[int]]:
    """Radii and heights with a point where the slope jumps between two, and the numbers of all at which it does.

    It jumps between two points whose curvatures are in sum `sharpness` times those beside them: where the parabolas of
    either side meet, or at a point where they do not meet between two. The body is even in x.
    """
    import numpy as np

    x, y = np.asarray(r), np.asarray(z) - z[0]
    slope = np.diff(np.append(y[1], y)) / np.diff(np.append(-x[1], x))
    jump = np.abs(np.diff(slope))
    curvature = jump / np.append(2.0 * x[1], x[2:] - x[:-2])
    curvature[jump <= LEAST_JUMP * np.abs(slope).max()] = 0.0
    beside = np.maximum(curvature[:-3], curvature[3:])
    excess = curvature[1:-2] + curvature[2:-1] - sharpness * beside
    found, taken = dict[float, float](), set[int]()
    for i in np.argsort(-excess) + 1:
        if excess[i - 1] <= 0.0 or taken & {i, i + 1}:
            continue
        left, right, step = slice(max(0, i + 1 - FLANK), i + 1), slice(i + 1, i + 1 + FLANK), x[i + 1] - x[i]
        lines = [np.polyfit((x[own] - x[i]) / step, y[own], min(2, len(x[own]) - 1)) for own in (left, right)]
        meet = [
            one.real for one in np.roots(np.polysub(*lines)) if one.imag == 0.0 and INSIDE < one.real < 1.0 - INSIDE
        ]
        if len(meet) == 1:
            taken |= {i, i + 1}
            found[float(x[i] + step * meet[0])] = float(np.polyval(lines[0], meet[0]))
    single = curvature[1:-1] > sharpness * np.maximum(curvature[:-2], curvature[2:])
    for i in {*(np.flatnonzero(single) + 1)} - taken:
        found[float(x[i])] = float(y[i])
    every = dict(zip(x.tolist(), y.tolist(), strict=True)) | found
    places = sorted(every)
    return np.asarray(places), np.asarray([every[one] for one in places]), [places.index(one) for one in sorted(found)]


def _cornered(r: tuple[float, ...], z: tuple[float, ...]) -> dict[str, tuple[float, ...]]:
    """The points, and in each cell the one where the chords on both sides of it meet, if they do there."""
    import numpy as np

    x, y = np.asarray(r), np.asarray(z)
    slope = np.diff(y) / np.diff(x)
    before, after, start, end = slope[:-2], slope[2:], slice(1, -2), slice(2, -1)
    with np.errstate(divide="ignore", invalid="ignore"):
        meet = (y[end] - y[start] + before * x[start] - after * x[end]) / (before - after)
    # Where a point is a corner by itself, it is not beside it.
    own = np.isin(x, _points(r, z)[0][_points(r, z)[2]])
    inside = (meet > x[start]) & (meet < x[end]) & ~own[start] & ~own[end]
    places = np.append(x, meet[inside])
    heights = np.append(y, (y[start] + before * (meet - x[start]))[inside])
    order = np.argsort(places)
    return {"r": tuple(places[order].tolist()), "z": tuple(heights[order].tolist())}


def _digit(z: tuple[float, ...]) -> float:
    """The power of ten of which all heights are whole multiples; 0 where that is beyond MOST_DIGITS of the largest."""
    import numpy as np

    heights = np.asarray(z)
    first = math.ceil(math.log10(np.abs(heights).max()))
    for power in range(first, first - MOST_DIGITS, -1):
        whole = heights / 10.0**power
        if np.abs(whole - whole.round()).max() < NEARLY:
            return float(10.0**power)
    return 0.0


@lru_cache(maxsize=8)
def _angular(r: tuple[float, ...], z: tuple[float, ...], corners: bool) -> Any:
    """The curve through the points, straight in rough cells, or with a corner there."""
    import numpy as np
    from scipy.interpolate import PPoly

    own, points = _spline(r, z), _cornered(r, z) if corners else {"r": r, "z": z}
    x, y = np.asarray(points["r"]), np.asarray(points["z"]) - z[0]
    places = np.union1d(own.x, x)
    start, cell = places[:-1], np.searchsorted(np.asarray(r), places[:-1], side="right") - 1
    smooth = [own.derivative(k)(start) / math.factorial(k) for k in (3, 2, 1)]
    chord = (np.diff(y) / np.diff(x))[np.searchsorted(x, start, side="right") - 1]
    straight = [0.0 * start, 0.0 * start, chord]
    curve = np.where(_is_rough(r, z)[cell], straight, smooth)
    heights = np.where(_is_rough(r, z)[cell], np.interp(start, x, y), own(start))
    return PPoly(np.vstack([curve, heights]), places, extrapolate=False)


def _is_rough(r: tuple[float, ...], z: tuple[float, ...]) -> NDArray[np.bool_]:
    """Of each cell, whether the curvatures at the points around it, or near by, differ by more than ROUGH, (n − 1,)."""
    import numpy as np

    x, y = np.asarray((-r[1], *r)), np.asarray((z[1], *z))
    slope = np.diff(y) / np.diff(x)
    bend = np.diff(slope) / (x[2:] - x[:-2])
    bend = np.concatenate([bend[1:2], bend, bend[-1:], bend[-1:]])  # of the points from −1 to n
    around = np.lib.stride_tricks.sliding_window_view(bend, 4)
    low, high = around.min(axis=1), around.max(axis=1)
    least = LEAST_JUMP * np.abs(slope).max() / x[-1]
    rough = (np.abs(around).max(axis=1) > least) & ((low <= 0.0) | (high > ROUGH * low))
    return np.asarray(np.convolve(rough, np.ones(2 * BESIDE + 1), mode="same") > 0.0)


@lru_cache(maxsize=8)
def _spline(r: tuple[float, ...], z: tuple[float, ...]) -> Any:
    """Monotone cubics through the points, z(0) = 0; kept, since a chain's length is found by asking many times.

    The slope at a point is that of the parabola through it and its neighbours, so that a sphere's paraboloid is met
    exactly, but no more than STEEPEST times the rise to either side, and 0 where that changes its sign: then no cubic
    overshoots (F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17 (1980) 238). Where the slope jumps, each side has
    its own.
    """
    import numpy as np
    from scipy.interpolate import PPoly

    x, y, corners = _points(r, z)
    ends = [0]
    for corner in corners:
        if corner - ends[-1] >= MIDDLE and corner <= len(x) - 1 - MIDDLE:
            ends.append(corner)
    ends.append(len(x) - 1)
    pieces = [_cubics(x[first : last + 1], y[first : last + 1]) for first, last in pairwise(ends)]
    return PPoly(np.concatenate(pieces, axis=1), x, extrapolate=False)


MIDDLE = 2
"""Points that a curve needs beside the one where its slope jumps."""


def _cubics(x: Array, y: Array) -> Array:
    """Coefficients of monotone cubics through the points (x, y), (4, n − 1), as `PPoly` has them."""
    import numpy as np
    from scipy.interpolate import CubicHermiteSpline

    step, rise = np.diff(x), np.diff(y) / np.diff(x)
    before, after = rise[:-1], rise[1:]
    inner = (step[1:] * before + step[:-1] * after) / (step[1:] + step[:-1])
    first = rise[0] + step[0] / (step[0] + step[1]) * (rise[0] - rise[1])
    last = rise[-1] + step[-1] / (step[-1] + step[-2]) * (rise[-1] - rise[-2])
    least = np.concatenate([rise[:1], np.where(np.abs(before) < np.abs(after), before, after), rise[-1:]])
    turns = np.concatenate([[False], before * after <= 0.0, [False]])
    wanted = np.concatenate([[first], inner, [last]])
    limit = np.where(turns, 0.0, STEEPEST * np.abs(least))
    slopes = np.sign(least) * np.clip(np.sign(least) * wanted, 0.0, limit)
    return np.asarray(CubicHermiteSpline(x, y, slopes).c)


def _slopes(curve: Any) -> tuple[Array, Array, Array, Array]:
    """Radii, shape (n,), and p₀, p₁, p₂ of the slope p₀ + p₁ r + p₂ r² between them, each of shape (n − 1,)."""
    square, linear, constant = curve.derivative().c
    start = curve.x[:-1]
    return curve.x, constant - linear * start + square * start**2, linear - 2.0 * square * start, square


AS_A_SCAN = (
    'of a noisy scan, centre = "auto" with smooth = "auto" or fit = "parabola" takes the apex and a curve that rises'
)
"""The way out for points that are no profile by themselves."""
SCAN_KEYS = ("centre", "level", "smooth", "fit")
"""Keys of a table that say how its scan is read."""
GAP = 10.0
"""A step of the radii counts as a gap beyond this many times the median step."""


def fault_of(r: tuple[float, ...], z: tuple[float, ...]) -> str | None:
    """What keeps the points (r, z) from being a profile, with what would do; None where nothing does."""
    if len(r) != len(z):
        return f"must have as many radii as heights, not {len(r)} and {len(z)}"
    steps = [after - before for before, after in pairwise(r)]
    if min(steps) <= 0.0:
        at = next(at for at, step in enumerate(steps) if step <= 0.0)
        return f"radii must increase; {r[at + 1]:.6g} follows {r[at]:.6g}"
    if r[0] != 0.0:
        return f"must begin at the radius 0, not {r[0]:.6g}: the transform needs the slope from the axis on"
    middle = statistics.median(steps)
    for at, step in enumerate(steps):
        if step > GAP * middle:
            return (
                f"has a gap from r = {r[at]:.6g} to {r[at + 1]:.6g}: the median step is {middle:.4g}, and "
                f"the largest gap allowed {GAP * middle:.4g}; add points there"
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
    """units of position and height of a file without units in it, such as ["µm", "nm"], in place of scale"""
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


Profile = Annotated[Parabola | Circle | Ellipsoid | Cone | Flat | FlatPunch | Power | Measured, Discriminator("kind")]
