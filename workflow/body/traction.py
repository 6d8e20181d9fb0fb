"""Pressure p(r) and shear traction q(r) under the body of three dimensions, from the line loads of a run.

Each is the inverse Abel transform of its line load (`analysis.abel`, `analysis.shear`). Its error is the difference
from what every second particle alone gives, the edge's, and where points leave the shape open, the difference from
curves through fewer of them. Whether a pressure has a bound is decided by convergence: from every, every second and
every fourth particle; where the differences do not shrink there is no number. Where the contact is too narrow for that,
a largest pressure off the axis is none.

Under springs E* per length on a plane, of a shape g and with a jump J ∝ √a of the line load at the edge (JKR),

    p(r) = (1/π) [E* ∫_r^a g′(x)/√(x² − r²) dx + J/s],   ∂p/∂a = (1/πs) [E* g′(a) + J (1/2a − a/s²)],   s² = a² − r²
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from operator import itemgetter
from typing import Any

import numpy as np

from contact1d.analysis.abel import FEWEST, LineLoad, line_load
from contact1d.analysis.pressure import Array, Profile, ZonedProfile
from contact1d.analysis.radius import ContactRadius, whole_cells
from contact1d.analysis.shear import kinks_of, shear_load
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.scene import Scene, Shape
from contact1d.workflow.scene.tables import WIDER_THAN_SPHERES
from contact1d.workflow.units import MEAN_PRESSURE, Quantity

MOST = 1000
"""Particles on a side that are used, and radii that p is given at; of more, every second, third …"""
RADII = 100
"""Evenly from 0 to the contact radius, at which q is given, and at its kinks besides."""
BETWEEN = 101
"""Radii between two particles at which the largest pressure is searched."""
TIP, KNOWN_TIP, KINK = 1e-3, 1e-9, 0.5
"""A profile has an apex where so little of a spacing off the axis its slope is that share of the one to a spacing; the
second where the body's own shape is taken, and not what particles make of it."""
ROUND_OFF = 2e-12
"""Error of a pressure over the stiffness of the layer: of positions beside the depth of the wall that carries them."""
INSIDE = 1.0 - 1e-9
"""Of the edge, up to which p is given: round-off."""
STEP = 1e-6
"""Of the edge, over which a slope is a difference there."""
SHRINKS = 0.45
"""|p₁ − p₂|/|p₁ − p₄| below which differences shrink: 1/(1 + 2ᵖ) of an order p, ½ of a logarithm, more of a pole."""
NOISE = 0.1
"""Of the tolerance: differences that are smaller, relative to the pressure, are those of the minimiser."""
NEXT = 0.25
"""Of the difference of the second from the fourth particles, added to that of the first, which may be small by accident
where a kink lies between particles: as much again of the second order."""


@dataclass(frozen=True, eq=False)
class BodyPressure:
    """p(r) of one state; arrays (n,).

    Attributes:
        r: from 0 (under an apex, where p has no bound, from the first particle) to the last particle inside [LU].
        pressure: compression positive [FU/LU²].
        uncertainty: of it [FU/LU²].
        contact_radius: of the body [LU]; where bodies attract, tension reaches beyond it.
        results: `central_pressure`, p(0), and `peak_pressure`, the largest one [FU/LU²]; without one that has no bound,
            as at a cone's tip, a punch's edge or a rim; with an infinite uncertainty where that is open.
    """

    r: Array
    pressure: Array
    uncertainty: Array
    contact_radius: float
    results: Mapping[str, Quantity]


@dataclass(frozen=True, eq=False)
class BodyShear:
    """q(r) of one state; arrays (n,).

    Attributes:
        r: from 0, where q of an apex that slips has no bound and is left out, to the contact radius [LU].
        shear: with which the plane resists a move to the right [FU/LU²].
        uncertainty: of it [FU/LU²].
        edge: the contact radius [LU].
        stick: the stick radius [LU].
    """

    r: Array
    shear: Array
    uncertainty: Array
    edge: float
    stick: float


def is_of_a_body(scene: Scene) -> bool:
    """Whether the line load of a run is that of a body of three dimensions, and known without noise."""
    bodies = scene.bodies
    stands = bodies.reduction == "mdr" or stands_for_spheres(scene)
    one_body = bodies.profile.kind != "flat" and bodies.lower in ("particles", "rigid_plane")
    return stands and one_body and scene.noise is None and not scene.experiment.motion_is_result


def body_pressures(
    scene: Scene, profiles: Mapping[str, Profile], of_radius: float, of_all: float, given: float
) -> dict[str, BodyPressure]:
    """p(r) of the reported states in which the bodies touch over a width; none where there is no body for them.

    Args:
        scene: what ran.
        profiles: of the reported states.
        of_radius: relative uncertainty of the contact radius, of which the pressure under springs is a function.
        of_all: the sum of those of all results, for the pressure under others.
        given: of pressures, by the numbers of the scene that are uncertain.
    """
    if not is_of_a_body(scene):
        return {}
    rule, bodies = radius_rule(scene, scene.accuracy.tolerance), scene.bodies
    alone = bodies.lower == "rigid_plane" and scene.neighbours is None and not bodies.profile.has_edge
    share = of_radius if alone else of_all
    return {
        name: one
        for name, profile in profiles.items()
        if (radius := rule.of(profile))
        and radius.value > 0.0
        and (one := _pressure(scene, profile, radius, alone, share, given))
    }


def _pressure(
    scene: Scene, profile: Profile, radius: ContactRadius, alone: bool, share: float, given: float
) -> BodyPressure | None:
    """p(r) of a state; None where too few particles carry it, or they are not alike on both sides.

    `alone`: springs are all that carries, on a plane; `share`: by how much results are off, relative to `_moves`;
    `given`: relative to p.
    """
    wider = WIDER_THAN_SPHERES if stands_for_spheres(scene) else 1.0
    zone = profile if isinstance(profile, ZonedProfile) else None
    held = scene.adhesion is not None and scene.adheres and zone is None
    x, q = profile.x / wider, wider * (whole_cells(profile, radius) if held else profile.pressure)
    shape, layer = scene.bodies.profile, scene.bulk_stiffness / scene.bodies.spacing
    jumps = shape.has_edge or held
    edge = radius.value / wider if jumps or scene.interaction is None else None
    pulled = _attraction(scene, zone)
    if zone:  # of d and the jump at the edge, where the attraction goes on, no pressure depends
        edge, q = zone.edge, layer * (scene.bodies.height(np.asarray([zone.edge])) - scene.bodies.height(x))
    own = -(-(x.size - x.size // 2) // MOST)

    def heights(x: Array, one: Shape = shape) -> Array:
        return layer * scene.bodies.model_copy(update={"profile": one}).height(x)

    unsure = bool(shape.alternatives or shape.deviations)
    body = heights if alone and not unsure else None
    apex = _has_apex(scene, TIP if body is None else KNOWN_TIP)

    def through(line: Array, stride: int) -> LineLoad | None:
        def load(chosen: Array) -> LineLoad:
            return line_load(x[chosen], line[chosen], edge, not jumps, apex, body)

        return _through(x.size, own * stride, load)

    levels = [one for stride in (1, 2, 4) if (one := through(q, stride))]
    if not levels:
        return None
    fine, side = levels[0], x[x.size // 2 :][::own]
    inside = side[(side > 0.0) & (side < fine.edge * INSIDE)]
    r = inside if fine.has_apex else np.append(0.0, inside)
    p, *coarser = (one.pressure(r) - pulled(r) for one in levels)
    # Where g is flat up to an edge that lies between two particles, p is that of a punch, ∝ 1/a.
    moves = np.maximum(np.abs(p), _moves(fine, heights, r) if alone else 0.0)
    if zone:  # the attraction's edge goes with that of the contact
        moves += np.abs(_attraction(scene, zone, STEP)(r) - pulled(r)) / STEP
    spread = radius.uncertainty / radius.value * moves + given * np.abs(p)
    # Of a known shape nothing lies between the particles: where they are too few to show it, its edge alone is open.
    if coarser or body is None:
        spread += _spread(p, *coarser)
    at = np.clip(x, -fine.edge, fine.edge)

    def on(bodies: Sequence[Shape]) -> list[Array]:
        """p(r) of other bodies under as much."""
        less = [heights(at) - heights(at, one) for one in bodies]
        return [one.pressure(r) - pulled(r) for line in less if (one := through(q + line - line[0], 1))]

    others, ways = on(shape.coarser), [on(both) for both in shape.deviations]

    def by_shape(read: Callable[[Array], Any]) -> Any:
        """What the other bodies change of what is read off p, the independent ones in squares."""
        each = [[abs(read(one) - read(p)) for one in both] for both in ways if both]
        return sum(abs(read(one) - read(p)) for one in others) + np.sqrt(
            sum(np.max(both, axis=0) ** 2 for both in each)
        )

    within = np.count_nonzero(side < radius.value / wider)
    told = [one for i, one in enumerate((p, *coarser)) if within >= FEWEST * 2**i]
    noise, top = NOISE * scene.accuracy.tolerance, int(p.argmax())
    # A jump at the edge is a pole, and where the slope jumps inside p is a logarithm.
    smooth = p[top] > 0.0 and not (shape.has_edge or any(kink < radius.value for kink in shape.kinks))
    smooth &= top == 0 or (len(told) == 3 and fine.at_edge <= noise * p[top] * fine.edge)
    near = np.linspace(r[max(0, top - 1)], r[min(top + 1, r.size - 1)], BETWEEN)
    around = fine.pressure(near) - pulled(near)
    hidden = any(kink < radius.value for one in shape.alternatives for kink in one.kinks)
    error, results = spread + share * moves + ROUND_OFF * layer, {}
    for name, place, read, value, is_open, may_have in (
        ("central_pressure", 0, itemgetter(0), p[0], False, True),
        ("peak_pressure", top, np.max, around.max(), hidden, smooth),
    ):
        known = _converges([read(one) for one in told], noise)
        if may_have and not fine.has_apex and (known or unsure):
            known &= not is_open
            off = error[place] + by_shape(read) if known else np.inf
            results[name] = Quantity(float(value), float(off), MEAN_PRESSURE)
    return BodyPressure(r, p, spread + by_shape(np.asarray), radius.value / wider, results)


def _attraction(scene: Scene, zone: ZonedProfile | None, wider: float = 0.0) -> Callable[[Array], Array]:
    """(2σ₀/π) arctan √((c² − a²)/(a² − r²)) [FU/LU²] inside a contact whose attraction has a range; else 0.

    `wider`: relative, by how much a is larger, and c with it.
    """
    if zone is None or scene.adhesion is None or not scene.adhesion.range:
        return np.zeros_like
    stress, more = scene.adhesion.work / scene.adhesion.range, wider * zone.edge
    edge, reach = zone.edge + more, zone.reach + more
    ring = math.sqrt((reach - edge) * (reach + edge))
    return lambda r: 2.0 / np.pi * stress * np.arctan2(ring, np.sqrt((edge - r) * (edge + r)))


def _moves(load: LineLoad, body: Callable[[Array], Array], r: Array) -> Array:
    """|a ∂p/∂a| under springs on a plane at most, without the J/2a of a jump that grows [FU/LU²]."""
    square = (load.edge - r) * (load.edge + r)
    rise = np.diff(body(load.edge * np.asarray([1.0, 1.0 + STEP]))) / STEP
    return (rise - load.at_edge * load.edge**2 / square) / (np.pi * np.sqrt(square))


def _converges(levels: Sequence[float], noise: float) -> bool:
    """Whether a value through every, every second and every fourth particle converges; fewer levels do not suffice."""
    if len(levels) < 3:
        return True
    first, second, fourth = levels
    change = abs(first - second)
    return change <= noise * abs(first) or change < SHRINKS * abs(first - fourth)


def _has_apex(scene: Scene, off: float = TIP) -> bool:
    """Whether the profile has a tip, below which a pressure has no bound, by its slope `off` spacings from the axis."""
    tip, beside = scene.bodies.height(np.array([off, 1.0]) * scene.bodies.spacing)
    return bool(tip > KINK * off * beside)


def _through(size: int, stride: int, load: Callable[[Array], LineLoad]) -> LineLoad | None:
    """The line load through every `stride`-th particle on either side; None where these are too few."""
    right = np.arange(size // 2, size)[::stride]
    left = size - 1 - right[::-1]
    if right.size < FEWEST:
        return None
    try:
        return load(np.concatenate([left[left < right[0]], right]))
    except ValueError:
        return None


def _spread(values: Array, *coarser: Array) -> Array:
    """|fine − coarse|, and a part of the next difference; the value itself where there is no coarser one."""
    levels = (values, *(coarser or (0.0,)))
    spread = sum(share * np.abs(one - next) for share, one, next in zip((1.0, NEXT), levels, levels[1:], strict=False))
    return np.where(np.isfinite(spread), spread, np.abs(values))


def body_shears(
    scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array], contact_radii: Array
) -> dict[str, BodyShear]:
    """q(r) of the reported states in which the bodies touch over a width; none where there is no body for them.

    A flat punch has none: its own singular end has as much shear as pressure.

    Args:
        scene: what ran.
        profiles: of the reported states, "final" or the farthest one.
        columns: of curve.csv, as in `Run.friction`.
        contact_radii: a of each row [LU], NaN where the bodies do not touch.
    """
    if not scene.experiment.goes_along or scene.bodies.reduction != "mdr" or scene.bodies.profile.has_edge:
        return {}
    sticks, edges = columns["stick_radius"], np.nan_to_num(contact_radii)
    kinks = kinks_of(sticks.tolist(), edges.tolist())
    return {
        name: one
        for name, profile in profiles.items()
        if edges[row := row_of(name, columns)] > 0.0
        and (one := _shear(scene, profile, float(edges[row]), kinks[row], float(sticks[row])))
    }


def row_of(state: str, columns: Mapping[str, Array]) -> int:
    """Which load step a reported state is: the last one, or the first of those farthest along x."""
    places = columns["tangential_displacement"]
    return len(places) - 1 if state == "final" else int(np.argmax(np.abs(places)))


def _shear(scene: Scene, profile: Profile, edge: float, kinks: Sequence[float], stick: float) -> BodyShear | None:
    """q(r) of a state; None where too few particles touch."""

    def load(chosen: Array) -> LineLoad:
        return shear_load(profile.x[chosen], -profile.shear[chosen], edge, kinks, _has_apex(scene))

    levels = [one for stride in (1, 2) if (one := _through(profile.x.size, stride, load))]
    if not levels:
        return None
    r = np.unique(np.concatenate([np.linspace(0.0, edge, RADII), kinks]))[levels[0].has_apex :]
    shears = [one.pressure(r) for one in levels]
    return BodyShear(r, shears[0], _spread(*shears), edge, stick)
