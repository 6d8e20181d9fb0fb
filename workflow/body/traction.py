"""Pressure p(r) and shear traction q(r) under the body of three dimensions, from the line loads of a run.

Each is the inverse Abel transform of its line load (`analysis.abel`, `analysis.shear`). Its error is the difference
from what every second particle alone gives, the edge's, and where points leave the shape open, the difference from
curves through fewer of them. Whether a pressure has a bound is decided by convergence: from every, every second and
every fourth particle; where the differences do not shrink there is no number. Where the contact is too narrow for that,
a largest pressure off the axis is none.

The line load ends at an edge by a jump that the law of the contact gives: 0 of springs that are pressed or relax, what
dashpots push where a contact grows, E* (d − g(a)) of an edge that is held. Under elastic springs E* per length on a
plane, of a shape g and with a jump J ∝ √a,

    p(r) = (1/π) [E* ∫_r^a g′(x)/√(x² − r²) dx + J/s],   ∂p/∂a = (1/πs) [E* g′(a) + J (1/2a − a/s²)],   s² = a² − r²
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from contact1d.analysis.abel import FEWEST, LineLoad
from contact1d.analysis.curve_marks import vertex
from contact1d.analysis.polynomial import gauss
from contact1d.analysis.pressure import Array, Profile, ZonedProfile
from contact1d.analysis.shear import kinks_of, shear_load
from contact1d.workflow.body.loaded import Loaded, has_apex, through
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Scene, Shape
from contact1d.workflow.units import LINE_PRESSURE, MEAN_PRESSURE, Quantity

MOST = 1000
"""Particles on a side that are used, and radii that p is given at; of more, every second, third …"""
RADII = 100
"""Evenly from 0 to the contact radius, at which q is given, and at its kinks besides."""
ANGLES, ZONED, PIECES = 12, 40, 5
"""Positions of Gauss's at which p(r) is added up to a force, between kinks, and where an attraction with a range acts
beyond the contact, on a small part of it: 3e-7 of the force for µ = 400. And pieces of a body whose shape is a table or
whose springs are not elastic: a corner of its history is a kink of the line load."""
BETWEEN = 21
"""Radii between two particles at which the largest pressure is searched, the vertex of the parabola through three."""
ROUND_OFF = 2e-12
"""Error of a pressure over the stiffness of the layer: of positions beside the depth of the wall that carries them."""
SOLVED = 5e-6
"""Relative error at least of the edge of a contact that adheres: equations give it."""
INSIDE = 1.0 - 1e-9
"""Of the edge, up to which p is given: round-off."""
STEP = 1e-6
"""Of the edge, over which a slope is a difference there."""
SHRINKS = 0.45
"""|p₁ − p₂|/|p₁ − p₄| below which differences shrink: 1/(1 + 2ᵖ) of an order p, ½ of a logarithm, more of a pole."""
NOISE = 0.1
"""Of the tolerance: differences that are smaller, relative to the pressure, are those of the minimiser."""
BESIDE, OPEN = 7, 2.5
"""Where the shape of a load is not known: radii whose largest error is that of the one between them, and how many of
these it may be; measured beside rings that touch again, between whose particles a slope jumps."""
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
        doubt: of the force of the state, relative.
        contact_radius: of the body [LU]; where bodies attract, tension reaches beyond it.
        results: `central_pressure`, p(0), and `peak_pressure`, the largest one [FU/LU²]; without one that has no bound,
            as at a cone's tip, a punch's edge or a rim; with an infinite uncertainty where that is open.
        force, size: ∫ p dA and ∫ |p| dA of the body [FU], a ring of attraction beyond the contact radius included.
        stiffness: dF/dd [FU/LU] of particles that are alone, whatever their springs; None of others.
    """

    r: Array
    pressure: Array
    uncertainty: Array
    doubt: float
    contact_radius: float
    results: Mapping[str, Quantity]
    force: float
    size: float
    stiffness: Quantity | None = None


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
    scene: Scene,
    profiles: Mapping[str, Profile],
    of_radius: Mapping[str, float],
    of_all: float,
    given: Mapping[str, float],
) -> dict[str, BodyPressure]:
    """p(r) of the reported states in which the bodies touch over a width; none where there is no body for them.

    Args:
        scene: what ran.
        profiles: of the reported states.
        of_radius: relative uncertainty of each contact radius, of which pressures under elastic springs are functions.
        of_all: the sum of those of all results, for the pressure under others.
        given: of pressures of each state, by the numbers of the scene that are uncertain.
    """
    if not is_of_a_body(scene):
        return {}
    rule, found = radius_rule(scene, scene.accuracy.tolerance), {}
    for name, profile in profiles.items():
        if (radius := rule.of(profile)) and radius.value > 0.0:
            state = Loaded(scene, profile, radius, rule)
            share = of_radius[name] if state.is_elastic and not scene.bodies.profile.has_edge else of_all
            if law_of(scene).attracts(scene):
                share = max(share, SOLVED)
            if one := _pressure(state, share, given[name]):
                found[name] = replace(one, doubt=one.doubt + of_all)
    return found


def _pressure(state: Loaded, share: float, given: float) -> BodyPressure | None:
    """p(r) of a state; None where too few particles carry it, or they are not alike on both sides.

    `share`: by how much results are off, relative to `_moves`; `given`: relative to p.
    """
    scene, x, zone = state.scene, state.x, state.zone
    own = -(-(x.size - x.size // 2) // MOST)
    levels = [one for stride in (1, 2, 4) if (one := state.through(state.load, own * stride))]
    if not levels:
        return None
    fine, side, (ring, pulled) = levels[0], x[x.size // 2 :][::own], _drawn(scene, zone)
    inside = side[(side > 0.0) & (side < fine.edge * INSIDE)]
    r = inside if fine.has_apex else np.append(0.0, inside)
    node, area = _nodes(state, fine.edge, ZONED if ring else ANGLES)
    where = np.append(r, node)
    p, *coarser = (one.pressure(where) - pulled(where) for one in levels)
    forces = area * p[r.size :]
    p, *coarser = (one[: r.size] for one in (p, *coarser))
    # Where g is flat up to an edge that lies between two particles, p is that of a punch, ∝ 1/a.
    at_most = _moves(fine, fine.body or state.heights, r, -1.0 if state.is_elastic else 1.0) if state.is_alone else 0.0
    moves = np.maximum(np.abs(p), at_most)
    if zone:  # the attraction's edge goes with that of the contact
        moves += np.abs(_drawn(scene, zone, STEP)[1](r) - pulled(r)) / STEP
    spread = state.radius.uncertainty / state.radius.value * moves
    spread = _between(state, own, spread, [p, *coarser], lambda line: line.pressure(r) - pulled(r))
    by_shape = _by_shape(state, own, r, p, pulled)
    within = np.count_nonzero(side < state.radius.value / state.wider)
    told = [one for i, one in enumerate((p, *coarser)) if within >= FEWEST * 2**i]
    error = spread + share * moves + given * np.abs(p) + ROUND_OFF * state.layer
    if zone:  # a layer acts as a jump, but for the particle that is in it
        error += zone.layer / (np.pi * np.sqrt(fine.edge**2 - r**2)) * (r > fine.edge - scene.bodies.spacing)
    results = {
        name: replace(one, uncertainty=one.uncertainty or float(error[place] + by_shape(read)))
        for name, (one, place, read) in _largest(state, fine, r, told, lambda r: fine.pressure(r) - pulled(r)).items()
    }
    force, size = float(forces.sum()) + ring, float(np.abs(forces).sum()) - ring
    edge, stiffness = state.radius.value / state.wider, _stiffness(state, share)
    doubt = _added_up(state) / (size or 1.0)
    return BodyPressure(r, p, error + by_shape(np.asarray), doubt, edge, results, force, size, stiffness)


def _between(
    state: Loaded, stride: int, spread: Array, levels: Sequence[Array], pressure: Callable[[LineLoad], Array]
) -> Array:
    """The error of p, (n,), with what lies between particles, by levels of them.

    Of a known shape nothing does: where they are too few to show it, its edge alone is open.
    """
    p, *coarser = levels
    known = not coarser and state.body is not None
    if not known:
        spread = spread + _spread(p, *coarser)
    if state.is_elastic or not state.is_alone:
        return spread
    if known:
        inside = np.count_nonzero(state.x[state.x.size // 2 :: stride] < (state.edge or math.inf))
        spread = spread + np.abs(p) / (2.0 * inside) ** 2
    if other := state.through(state.load, 2 * stride, stride):  # one difference may be 0 by chance
        spread = np.maximum(spread, np.abs(pressure(other) - p))
    return np.asarray(OPEN * sliding_window_view(np.pad(spread, BESIDE // 2, "edge"), BESIDE).max(axis=1))


def _added_up(state: Loaded) -> float:
    """Most by which the sum of the particles is off ∫ q dx [FU]: Δ²/12 of each change of slope (Euler, Maclaurin)."""
    if state.jump != 0.0:
        return 0.0
    bends = np.abs(np.convolve(state.load, (1.0, -2.0, 1.0)))
    return float(bends.sum()) * state.scene.bodies.spacing / state.wider / 12.0


def _stiffness(state: Loaded, share: float) -> Quantity | None:
    """dF/dd = −∫ (dq/dh) dx of springs whose forces are functions of d − h, which is 2E*a of linear ones.

    Between two particles the slope is that of the straight line; `share`: what the results are off, relatively.
    """
    edge = state.edge
    if not state.is_alone or edge is None or state.jump != 0.0 or state.shape.has_edge:
        return None
    sides = []
    for stride in (1, 2):
        right = np.flatnonzero((state.x >= 0.0) & (state.x < edge * INSIDE))[::stride]
        x, q = np.append(state.x[right], edge), np.append(state.load[right], 0.0)
        rise, fall = np.diff(state.heights(x) / state.layer), -np.diff(q)
        slope = np.divide(fall, rise, out=np.zeros_like(fall), where=rise > 0.0)
        sides.append(
            float(2.0 * np.sum(slope * np.diff(x, prepend=0.0)[1:]) + 2.0 * slope[0] * x[0]) if fall.size else 0.0
        )
    fine, coarse = sides
    return Quantity(fine, abs(fine - coarse) + share * fine, LINE_PRESSURE)


def _by_shape(
    state: Loaded, stride: int, r: Array, p: Array, pulled: Callable[[Array], Array]
) -> Callable[[Callable[[Array], Any]], Any]:
    """What the bodies that this one may be change of what is read off p(r), the independent ones in squares."""
    shape, at = state.shape, state.x if state.edge is None else np.clip(state.x, -state.edge, state.edge)

    def on(bodies: Sequence[Shape]) -> list[Array]:
        """p(r) of other bodies under as much."""
        less = [state.heights(at) - state.heights(at, one) for one in bodies]
        return [
            one.pressure(r) - pulled(r) for line in less if (one := state.through(state.load + line - line[0], stride))
        ]

    others, ways = on(shape.coarser), [on(both) for both in shape.deviations]

    def change(read: Callable[[Array], Any]) -> Any:
        each = [[abs(read(one) - read(p)) for one in both] for both in ways if both]
        return sum(abs(read(one) - read(p)) for one in others) + np.sqrt(
            sum(np.max(both, axis=0) ** 2 for both in each)
        )

    return change


def _largest(
    state: Loaded, fine: LineLoad, r: Array, levels: Sequence[Array], pressure: Callable[[Array], Array]
) -> dict[str, tuple[Quantity, int, Callable[[Array], Any]]]:
    """p(0) and the largest pressure where they have a bound, each with the radius and the reader of its error.

    An uncertainty is 0 where it is to be found so, infinite where nothing shows that there is a bound.
    """
    scene, shape, p = state.scene, state.shape, levels[0] if levels else pressure(r)
    noise, top, unsure = NOISE * scene.accuracy.tolerance, int(p.argmax()), bool(shape.alternatives or shape.deviations)
    smooth = p[top] > 0.0 and (top == 0 or len(levels) == 3) and _is_bounded(state, fine, top, noise * p[top])
    peak = p[top]
    if smooth and top:  # on the axis it is one by symmetry
        near = np.linspace(r[top - 1], r[min(top + 1, r.size - 1)], BETWEEN)
        p_near = pressure(near)
        highest = int(p_near.argmax())
        peak = vertex(near, p_near, highest, 1)[1] if 0 < highest < BETWEEN - 1 else p_near[highest]
    hidden = any(map(state.has_kinks, shape.alternatives))
    found: dict[str, tuple[Quantity, int, Callable[[Array], Any]]] = {}
    for name, place, read, value, is_open, may_have in (
        ("central_pressure", 0, itemgetter(0), p[0], False, True),
        ("peak_pressure", top, np.max, peak, hidden, smooth),
    ):
        known = _converges([read(one) for one in levels], noise)
        if may_have and not fine.has_apex and (known or unsure):
            off = 0.0 if known and not is_open else np.inf
            found[name] = Quantity(float(value), off, MEAN_PRESSURE), place, read
    return found


def _is_bounded(state: Loaded, fine: LineLoad, top: int, noise: float) -> bool:
    """Whether the largest pressure of the particles is one: a jump at the edge is a pole, a kink inside a logarithm.

    A jump that the law tells is one, however small; particles show no better than their errors.
    """
    if state.shape.has_edge or state.has_kinks(state.shape):
        return False
    pole = 0.0 if state.zone else noise * fine.edge
    return (top == 0 and state.jump is None) or fine.at_edge <= pole


def _nodes(state: Loaded, edge: float, angles: int) -> tuple[Array, Array]:
    """Radii r = a sin θ [LU] at which p(r) is added up over the contact, between kinks, and the area of each [LU²]."""
    node, weight = gauss(angles)
    share = 0.5 * (node + 1.0)
    kinks = [kink / edge for kink in state.shape.kinks if kink < edge]
    if state.shape.slow or not state.is_elastic:
        kinks += [piece / PIECES for piece in range(1, PIECES)]
    ends = np.arcsin(sorted({0.0, *kinks, 1.0}))
    width = np.diff(ends)[:, None]
    angle = (ends[:-1, None] + width * share * share * (3.0 - 2.0 * share)).ravel()  # dense at both ends of a piece
    step = (0.5 * width * weight * 6.0 * share * (1.0 - share)).ravel()
    r = edge * np.sin(angle)
    return r, 2.0 * np.pi * r * edge * np.cos(angle) * step


def _drawn(scene: Scene, zone: ZonedProfile | None, wider: float = 0.0) -> tuple[float, Callable[[Array], Array]]:
    """See `Law.cohesive_load`; `wider`: relative, by how much a is larger, and c with it."""
    if zone is None:
        return 0.0, np.zeros_like
    edge, reach = zone.edge, zone.reach
    return law_of(scene).cohesive_load(scene, edge + wider * edge, reach + wider * edge)


def _moves(load: LineLoad, body: Callable[[Array], Array], r: Array, way: float) -> Array:
    """|a ∂p/∂a| under springs on a plane at most, without the J/2a of a jump that grows [FU/LU²].

    `way`: −1 where both parts are known to be of that edge, else 1.
    """
    square = (load.edge - r) * (load.edge + r)
    rise = np.diff(body(load.edge * np.asarray([1.0, 1.0 + STEP]))) / STEP
    return (rise + way * load.at_edge * load.edge**2 / square) / (np.pi * np.sqrt(square))


def _converges(levels: Sequence[float], noise: float) -> bool:
    """Whether a value through every, every second and every fourth particle converges; fewer levels do not suffice."""
    if len(levels) < 3:
        return True
    first, second, fourth = levels
    change = abs(first - second)
    return change <= noise * abs(first) or change < SHRINKS * abs(first - fourth)


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
        return shear_load(profile.x[chosen], -profile.shear[chosen], edge, kinks, has_apex(scene))

    levels = [one for stride in (1, 2) if (one := through(profile.x.size, stride, load))]
    if not levels:
        return None
    r = np.unique(np.concatenate([np.linspace(0.0, edge, RADII), kinks]))[levels[0].has_apex :]
    shears = [one.pressure(r) for one in levels]
    return BodyShear(r, shears[0], _spread(*shears), edge, stick)
