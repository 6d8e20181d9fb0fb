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
from abc import abstractmethod
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, Self

from annotated_types import Ge
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from contact1d.workflow.scene.quantities import Length, Ratio, SignedLength, Table, Unit
from contact1d.workflow.scene.si_text import UnitTextError, si_value

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from contact1d.analysis.scan import Taken

    Array = NDArray[np.float64]

Exponent = Annotated[float, Ge(1.0), Unit("1")]
FEWEST_POINTS = 4
"""Smallest number of points of a measured profile."""


class Shape(Table):
    """The base class of all profiles; each kind overrides what differs.

    `has_edge`: the body ends at its `reach` by a vertical flank, so that its chain is as wide as the body;
    `is_plane`: it has the height 0 wherever there is a body, so that the contact is as wide, too.
    """

    has_edge: ClassVar[bool] = False
    is_plane: ClassVar[bool] = False
    slow: ClassVar[bool] = False
    """Whether the transform takes long, so that a predictor that asks thousands of times has it tabulated."""

    @abstractmethod
    def height(self, x: Array) -> Array:
        """Return the height z(x) = f(|x|) [LU] above the apex as drawn, at the positions `x` [LU]; same shape.

        NaN beyond the radius of a circle or an ellipsoid; constant beyond the last point of a measured profile; 0 of a
        punch beyond its edge, too.
        """

    @abstractmethod
    def transformed(self, x: Array) -> Array:
        """Return the height g(x) [LU] above the apex after the MDR transform, at the positions `x` [LU]; same shape.

        Beyond the end of a body it is finite but has no meaning: constant of a measured profile, 0 of a punch, linear
        of a circle or an ellipsoid.
        """

    @property
    def reach(self) -> float:
        """Half-width [LU] within which there is a body at all; infinite for a parabola, cone, power or periodic flat.

        The radius of a circle, of an ellipsoid across its axis and of a punch, the last point of a measured profile.
        """
        return math.inf

    @property
    def half_width(self) -> float | None:
        """Half-width [LU] of the body: its reach, of a paraboloid the radius of its ball, None where it is infinite."""
        return self.reach if math.isfinite(self.reach) else None

    @property
    def curvature_radius(self) -> float | None:
        """Radius of curvature R at the apex [LU], for two curved bodies 1/R = 1/R₁ + 1/R₂; None where there is none.

        Given for a parabola, a circle and an ellipsoid; None for all others, also for a power of exponent 2, and for a
        measured profile even where a parabola or circle is fitted to it (that curve itself, `Fitted`, has its R).
        """
        return None

    @property
    def degree(self) -> float | None:
        """Exponent n of a body z ∝ |x|ⁿ: 2 of a parabola, 1 of a cone, that of a power; else None."""
        return None

    @property
    def ball_radius(self) -> float | None:
        """Radius [LU] of the ball that the upper body is: of a parabola its own radius, of a circle; else None."""
        return None

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii [LU] off the axis, rising, at which the slope or the curvature jumps, where pieces of a body meet.

        An edge of the body is not among them.
        """
        return ()

    @property
    def slope_jumps(self) -> tuple[float, ...]:
        """The kinks [LU] at which the slope jumps: a pressure there has no bound, and g′ is not finite."""
        return self.kinks

    @property
    def alternatives(self) -> tuple[Shape, ...]:
        """Other bodies that agree with all that is known of this one; empty for all but measured profiles."""
        return ()

    @property
    def coarser(self) -> tuple[Shape, ...]:
        """Bodies through every second point, and through the others, by which the error due to the points is estimated.

        Two, one or none, of measured profiles whose points are kept; empty for all others.
        """
        return ()

    @property
    def deviations(self) -> tuple[tuple[Shape, Shape], ...]:
        """Pairs of bodies: half of the difference of a result between the two is its uncertainty at 95 %.

        Uncertainties of different pairs are independent. Only those of a curve that is fitted to a scan; empty for all
        others.
        """
        return ()

    @property
    def taken(self) -> Taken | None:
        """The curve that is fitted to a scan, also where the points are kept; None for a profile that is no scan."""
        return None

    @property
    def steepest(self) -> Self:
        """The steeper of two curved bodies, on a plane, whose slope and size limit the theory.

        That is for a parabola with a lower body; all other shapes are themselves on a plane, and this is self.
        """
        return self


class Parabola(Shape):
    """Profile of the upper body: z = x²/2R, of two curved bodies the gap, 1/R = 1/R₁ + 1/R₂."""

    kind: Literal["parabola"]
    """z = x²/2R, a ball near its apex"""
    radius: Length
    """radius of curvature R at the apex; with a counter_radius R₁"""
    counter_radius: SignedLength | None = None
    """radius of curvature R₂ of the lower body, 1/R = 1/R₁ + 1/R₂: positive for a convex one; negative for a concave
    one, a cup, and then larger in magnitude than the radius; absent: a plane
    """

    def height(self, x: Array) -> Array:
        """Return the height z = x²/2R [LU] at positions x [LU]; same shape.

        Of two curved bodies it is the gap, 1/R = 1/R₁ + 1/R₂.
        """
        return x**2 / (2 * self.curvature_radius)

    def transformed(self, x: Array) -> Array:
        """Return the height g = x²/R [LU] after the MDR transform at positions x [LU]; same shape.

        Of two curved bodies 1/R = 1/R₁ + 1/R₂.
        """
        return x**2 / self.curvature_radius

    @property
    def curvature_radius(self) -> float:
        """The effective radius R [LU] of both bodies: R₁/(1 + R₁/R₂), on a plane R₁."""
        return self.radius / (1.0 + self.radius / (self.counter_radius or math.inf))

    @property
    def half_width(self) -> float:
        """The effective radius R [LU] of both bodies, that of a ball near its apex."""
        return self.curvature_radius

    @property
    def ball_radius(self) -> float:
        """The radius R₁ [LU] of the upper body alone."""
        return self.radius

    @property
    def degree(self) -> float:
        """The exponent 2 of z ∝ x²."""
        return 2.0

    @property
    def steepest(self) -> Self:
        """A parabola with the smaller magnitude of the two radii, R₁ or R₂ of the lower body, on a plane.

        Without a lower radius it is equal to this one. The gap of a ball in a cup is flat where the ball itself is
        steep.
        """
        radius = min(self.radius, abs(self.counter_radius or math.inf))
        return self.model_copy(update={"radius": radius, "counter_radius": None})


class Circle(Shape):
    """Profile of the upper body: an exact circle, z = R − √(R² − x²)."""

    kind: Literal["circle"]
    """z = R − √(R² − x²), a whole ball"""
    radius: Length
    """radius R"""

    def height(self, x: Array) -> Array:
        """Return the height z = R − √(R² − x²) [LU] at positions |x| ≤ R [LU], NaN beyond; same shape.

        It is calculated without a difference of large numbers.
        """
        return x**2 / (self.radius + ((self.radius - x) * (self.radius + x)) ** 0.5)

    def transformed(self, x: Array) -> Array:
        """Return the height g = x artanh(x/R) [LU] after the MDR transform at positions x [LU]; same shape.

        It grows without bound towards the edge; beyond (1 − 1e-12) R the factor artanh remains constant.
        """
        import numpy as np

        last = 1.0 - 1e-12  # share of the radius up to which g is finite
        share = np.clip(x / self.radius, -last, last)
        return x * np.arctanh(share)

    @property
    def reach(self) -> float:
        """The radius R [LU] of the circle."""
        return self.radius

    @property
    def curvature_radius(self) -> float:
        """The radius R [LU] of the circle."""
        return self.radius

    @property
    def ball_radius(self) -> float:
        """The radius R [LU] of the circle."""
        return self.radius


class Ellipsoid(Shape):
    """Profile of the upper body: an ellipsoid of revolution, z = b − b √(1 − x²/c²)."""

    kind: Literal["ellipsoid"]
    """z = b − b √(1 − x²/c²), an ellipsoid of revolution about the load"""
    radius: Length
    """half axis c perpendicular to the load"""
    half_axis: Length = Field(alias="height")
    """half axis b along the load"""

    def height(self, x: Array) -> Array:
        """Return the height z = b − b √(1 − x²/c²) [LU] at positions |x| ≤ c [LU], NaN beyond; same shape.

        It is b/c times that of a sphere of radius c; b is the half axis along the load.
        """
        return self.half_axis / self.radius * self._sphere.height(x)

    def transformed(self, x: Array) -> Array:
        """Return the height g = (b/c) x artanh(x/c) [LU] after the MDR transform at positions x [LU]; same shape.

        b is the half axis along the load, c across it. Beyond (1 − 1e-12) c the factor artanh remains constant.
        """
        return self.half_axis / self.radius * self._sphere.transformed(x)

    @property
    def _sphere(self) -> Circle:
        """A new, unchecked circle [LU] whose radius is the half axis c across the load."""
        return Circle.model_construct(radius=self.radius)

    @property
    def reach(self) -> float:
        """The half axis c [LU] across the load."""
        return self.radius

    @property
    def curvature_radius(self) -> float:
        """The radius of curvature c²/b [LU] at the apex, c the half axis across the load and b along it."""
        return self.radius**2 / self.half_axis


def _half_angle(text: object) -> object:
    """Return the text unchanged if it is a half angle greater than 0° and less than 90°, "80°" or "1.4 rad".

    Raises:
        PydanticCustomError: it is none, no text, or has an uncertainty.
    """
    problem = 'must be text with a unit, greater than 0° and less than 90°, from the axis to the flank: write "80°"'
    try:
        if isinstance(text, str) and "±" in text:
            problem = 'has no uncertainty: give the slope, its cotangent, with one, slope = "0.18 ± 0.01"'
        elif isinstance(text, str) and 0.0 < si_value(text, "rad")[0] < 0.5 * math.pi:
            return text
    except UnitTextError as error:
        problem = str(error)
    raise PydanticCustomError("scene", "{problem}", {"problem": problem})


class Flanked(Shape):
    """The base class of bodies with a conical flank, whose slope or half angle is given."""

    one_of = ((("slope", "half_angle"), 'give one of the two: slope = 0.1, or half_angle = "80°"'),)

    slope: Ratio | None = None
    """slope s of the flank, the tangent of the angle between flank and plane"""
    half_angle: Annotated[str, BeforeValidator(_half_angle)] | None = None
    """half angle from the axis to the flank, such as "80°" or "1.4 rad", less than 90°, in place of the slope, which
    is its cotangent
    """

    @property
    def rise(self) -> float:
        """The slope s of the flank, dimensionless: as given, else the cotangent of the half angle."""
        return self.slope or 1.0 / math.tan(si_value(self.half_angle or "", "rad")[0])


class Cone(Flanked):
    """Profile of the upper body: z = s |x|."""

    kind: Literal["cone"]
    """z = s |x|"""

    def height(self, x: Array) -> Array:
        """Return the height z = s |x| [LU] at positions x [LU]; same shape."""
        return self.rise * abs(x)

    def transformed(self, x: Array) -> Array:
        """Return the height g = (π/2) s |x| [LU] after the MDR transform at positions x [LU]; same shape."""
        return 0.5 * math.pi * self.rise * abs(x)

    @property
    def degree(self) -> float:
        """The exponent 1 of z ∝ |x|."""
        return 1.0


class Level(Shape):
    """z = 0 wherever there is a body."""

    has_edge = True
    is_plane = True

    def height(self, x: Array) -> Array:
        """Return the height 0 [LU] at all positions x [LU], also beyond an edge; same shape."""
        return 0.0 * abs(x)

    def transformed(self, x: Array) -> Array:
        """Return the height 0 [LU] after the MDR transform at all positions x [LU], also beyond an edge; same shape."""
        return 0.0 * abs(x)


class Flat(Level):
    """Profile of the upper body: z = 0 without end; its chain is periodic (`bodies.periodic`)."""

    kind: Literal["flat"]
    """z = 0 without end, with bodies.periodic"""


class FlatPunch(Level):
    """Profile of the upper body: z = 0 out to the edge, and no body beyond it."""

    kind: Literal["flat_punch"]
    """z = 0 within the radius, no body beyond it"""
    radius: Length
    """radius, a whole number of half spacings and at least 1.5 spacings"""

    @property
    def reach(self) -> float:
        """The radius [LU] of the punch, beyond which there is no body."""
        return self.radius


class CappedPunch(Shape):
    """Profile of the upper body: z = x²/2R out to the edge, and no body beyond it."""

    kind: Literal["capped_punch"]
    """z = x²/2R within the radius b, no body beyond it"""
    radius: Length
    """radius b of the punch, a whole number of spacings and at least 2"""
    cap_radius: Length
    """radius of curvature R of the end"""

    has_edge = True

    def height(self, x: Array) -> Array:
        """Return the height z = x²/2R [LU] at all positions x [LU], also beyond the edge; same shape."""
        return x**2 / (2.0 * self.cap_radius)

    def transformed(self, x: Array) -> Array:
        """Return the height g = x²/R [LU] after the MDR transform at all positions x [LU], also beyond the edge; same
        shape.
        """
        return x**2 / self.cap_radius

    @property
    def reach(self) -> float:
        """The radius b [LU] of the punch, beyond which there is no body."""
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

    @property
    def degree(self) -> float:
        """The exponent n of z ∝ |x|ⁿ."""
        return self.exponent

    def height(self, x: Array) -> Array:
        """Return the height z = h (|x|/a)ⁿ [LU] at positions x [LU]; same shape."""
        return self.height_there * abs(x / self.radius) ** self.exponent

    def transformed(self, x: Array) -> Array:
        """Return the height g = κ_n z [LU] after the MDR transform at positions x [LU]; same shape.

        κ_n = (√π/2) n Γ(n/2)/Γ((n + 1)/2), π/2 for n = 1 and 2 for n = 2.
        """
        from contact1d.analysis.theory.indenters import galin_factor  # it loads numpy, which a scene can do without

        return galin_factor(self.exponent) * self.height(x)
