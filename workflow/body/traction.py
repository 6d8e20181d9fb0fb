"""Pressure p(r) and shear traction q(r) under the body of three dimensions, from the line loads of a run.

Each is the inverse Abel transform of its line load (`analysis.abel`, `analysis.shear`). Its error is the difference
from the transform of every second particle, the error of the edge, and for a measured profile the difference from
curves through fewer points. Whether a pressure is bounded is decided by its convergence over every, every second and
every fourth particle; where the differences do not decrease there is no result. Where the contact is too narrow for
that, a largest pressure off the axis is not reported.

The line load ends at an edge by a jump that the law of the contact gives: 0 of elastic or relaxing springs without
adhesion, the force of dashpots where a contact grows, E* (d − g(a)) of an adhesive edge. Under elastic springs E* per
length on a plane, of a shape g and with a jump J ∝ √a,

    p(r) = (1/π) [E* ∫_r^a g′(x)/√(x² − r²) dx + J/s],   ∂p/∂a = (1/πs) [E* g′(a) + J (1/2a − a/s²)],   s² = a² − r²
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
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
from contact1d.workflow.body.loaded import LoadedState, has_apex, through
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Scene, Shape
from contact1d.workflow.units import LINE_PRESSURE, MEAN_PRESSURE, Quantity

INSIDE = 1.0 - 1e-9
"""Largest radius of p over the edge, where p is singular; the difference is round-off."""
STEP = 1e-6
"""Step over the edge of a difference quotient there."""


@dataclass(frozen=True, eq=False)
class BodyPressure:
    """Pressure p(r) of one state; arrays (n,).

    Attributes:
        r: radii from 0, under an apex with a singular p from the first particle, to the last particle inside [LU].
        pressure: p at r, compression positive [FU/LU²].
        uncertainty: uncertainty of p [FU/LU²].
        doubt: relative uncertainty of the force of the state.
        contact_radius: contact radius of the body [LU]; with an attraction tension reaches beyond it.
        results: `central_pressure`, p(0), and `peak_pressure`, the maximum [FU/LU²]; none that is singular, as at a
            cone's tip, a punch's edge or a rim; with an infinite uncertainty where it is open whether it is bounded.
        force, size: ∫ p dA and ∫ |p| dA of the body [FU], a ring of attraction beyond the contact radius included.
        stiffness: dF/dd [FU/LU] of uncoupled particles, whatever their springs; None of others.
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
    """Shear traction q(r) of one state; arrays (n,).

    Attributes:
        r: radii from 0, without the singular q of a slipping apex, to the contact radius [LU].
        shear: q with which the plane resists a move to the right [FU/LU²].
        uncertainty: uncertainty of q [FU/LU²].
    """

    r: Array
    shear: Array
    uncertainty: Array


def is_of_a_body(scene: Scene) -> bool:
    """Return whether a run has pressures p(r) of an axisymmetric body, in equilibrium or over a prescribed history.

    False with noise, in a slide, for a flat profile, on a rigid chain, and with the reduction of Geike and Popov,
    unless it was chosen against the default for a parabola or a circle: two equal spheres then stand for it.
    """
    bodies = scene.bodies
    represents_body = bodies.reduction == "mdr" or stands_for_spheres(scene)
    is_round = bodies.profile.kind != "flat" and bodies.lower in ("particles", "rigid_plane")
    return represents_body and is_round and scene.noise is None and not scene.experiment.motion_is_result


def body_pressures(
    scene: Scene,
    profiles: Mapping[str, Profile],
    of_radius: Mapping[str, float],
    of_all: float,
    given: Mapping[str, float],
    moved: Mapping[str, float],
) -> dict[str, BodyPressure]:
    """Return p(r) of the given states by name; {} where the run represents no axisymmetric body.

    That is with noise, in a slide, of a flat profile, on a rigid chain, and with the reduction of Geike and Popov,
    unless two equal spheres stand for it. A state without a contact radius above 0, or with too few particles in
    contact, is left out.

    Args:
        scene: the scene of the run.
        profiles: the profiles of the reported states, by name.
        of_radius: relative uncertainty of each contact radius, of which pressures under linear springs are functions.
        of_all: sum of the relative uncertainties of all results, for the pressure under other springs; added to `doubt`
            of each pressure.
        given: relative uncertainty of the pressures of each state by the uncertain numbers of the scene.
        moved: error of the displacement of each state [LU], which counts for a curved body in full contact.

    Raises:
        KeyError: `of_radius`, `given` or `moved` lacks a state in contact.
        ValueError: no radius can be read off a profile: too few particles, or tension where the law has none.
    """
    if not is_of_a_body(scene):
        return {}
    rule, pressures = radius_rule(scene, scene.accuracy.tolerance), {}
    for name, profile in profiles.items():
        if (radius := rule.of(profile)) and radius.value > 0.0:
            state = LoadedState(scene, profile, radius, rule)
            share = of_radius[name] if state.is_elastic and not scene.bodies.profile.is_plane else of_all
            if law_of(scene).attracts(scene):
                share = max(share, 5e-6)  # the error of the equations for an adhesive edge
            if pressure := _pressure(state, share, given[name], moved[name]):
                pressures[name] = replace(pressure, doubt=pressure.doubt + of_all)
    return pressures


def _pressure(state: LoadedState, share: float, given: float, moved: float, most: int = 1000) -> BodyPressure | None:
    """Return p(r) [FU/LU²], compression positive, of the axisymmetric body from the line load of a state.

    With its uncertainty, integrals and stiffness; r goes from 0, or under a tip from the first particle off the axis,
    to the last particle inside the edge. None where fewer than 3 particles on a side are inside, or they are not
    symmetric.

    Args:
        state: the line load of the state.
        share: relative error of the results; it is multiplied by the change of p with the relative contact radius.
        given: relative error of p by the uncertain numbers of the scene.
        moved: error of the displacement [LU], with which p changes in full contact as that of a flat punch.
        most: particles on a side that are used at most; of more, every second, third …
    """
    scene, x, zone = state.scene, state.x, state.zone
    stride = -(-(x.size - x.size // 2) // most)
    lines = [line for coarseness in (1, 2, 4) if (line := state.through(state.load, coarseness * stride))]
    if not lines:
        return None
    fine, side, (ring, attraction) = lines[0], x[x.size // 2 :][::stride], _attraction(scene, zone)
    inside = side[(side > 0.0) & (side < fine.edge * INSIDE)]
    r = inside if fine.has_apex else np.append(0.0, inside)
    # An attraction with a range acts on a small part of the contact: 40 nodes leave 3e-7 of the force at µ = 400.
    node, area = _nodes(state, fine.edge, 40 if ring else 12)
    radii = np.append(r, node)
    pressures = [line.pressure(radii) - attraction(radii) for line in lines]
    forces = area * pressures[0][r.size :]
    levels = [pressure[: r.size] for pressure in pressures]
    p = levels[0]
    # Where g is flat up to an edge that lies between two particles, p is that of a punch, ∝ 1/a.
    sensitivity = np.abs(p)
    if state.is_uncoupled:
        sign = -1.0 if state.is_elastic else 1.0
        sensitivity = np.maximum(sensitivity, _edge_sensitivity(fine, fine.body or state.heights, r, sign))
    if zone:  # the edge of the attraction moves with that of the contact
        sensitivity += np.abs(_attraction(scene, zone, STEP)[1](r) - attraction(r)) / STEP
    spread = state.radius.uncertainty / state.radius.value * sensitivity
    spread = _with_discretisation(state, stride, spread, levels, lambda line: line.pressure(r) - attraction(r))
    shape_error = _shape_error(state, stride, r, p, attraction)
    within = np.count_nonzero(side < state.radius.value / state.image_ratio)
    resolved = [level for i, level in enumerate(levels) if within >= FEWEST * 2**i]
    # 2e-12 of the layer: round-off of positions, compared with the depth of the wall that carries them.
    error = spread + share * sensitivity + given * np.abs(p) + 2e-12 * state.layer
    if state.is_full:
        error += state.layer * moved / (np.pi * np.sqrt((fine.edge - r) * (fine.edge + r)))
    if zone:  # a layer acts as a jump, but for the particle that is in it
        error += zone.layer / (np.pi * np.sqrt(fine.edge**2 - r**2)) * (r > fine.edge - scene.bodies.spacing)
    results = {
        name: Quantity(value, float(error[index] + shape_error(read)) if is_known else np.inf, MEAN_PRESSURE)
        for name, index, read, value, is_known in _bounded_pressures(
            state, fine, r, resolved, lambda r: fine.pressure(r) - attraction(r)
        )
    }
    force, size = float(forces.sum()) + ring, float(np.abs(forces).sum()) - ring
    edge, stiffness = state.radius.value / state.image_ratio, _stiffness(state, share)
    doubt = _sum_error(state) / (size or 1.0)
    return BodyPressure(r, p, error + shape_error(np.asarray), doubt, edge, results, force, size, stiffness)


def _with_discretisation(
    state: LoadedState, stride: int, spread: Array, levels: Sequence[Array], pressure: Callable[[LineLoad], Array]
) -> Array:
    """Return the error of p with the discretisation error added to `spread`, (n,) [FU/LU²].

    Added is the difference of p between levels of particles, for a single level |p|, but nothing for a single level of
    a shape given by a formula: its edge alone is uncertain. On a plane under springs that are not linear, then
    |p|/(2m)² is added for a single level of a shape given by a formula, with m particles on a side inside; the error is
    at least the change with the other half of the particles; and last it becomes 2.5 times the largest at seven radii
    around: that was measured with rings that come into contact again, between whose particles a slope jumps.

    Args:
        state: the line load of the state.
        stride: every how many particles are used.
        spread: error of p so far, (n,).
        levels: p through every, every second and every fourth of these particles, as far as there are enough, (n,)
            each.
        pressure: p at the same radii of a line load.
    """
    p, *coarser = levels
    known = not coarser and state.body is not None
    if not known:
        spread = spread + _level_difference(p, *coarser)
    if state.is_elastic or not state.is_uncoupled:
        return spread
    if known:
        inside = np.count_nonzero(state.x[state.x.size // 2 :: stride] < (state.edge or math.inf))
        spread = spread + np.abs(p) / (2.0 * inside) ** 2
    if rest := state.through(state.load, 2 * stride, stride):  # a single difference may be 0 by chance
        spread = np.maximum(spread, np.abs(pressure(rest) - p))
    width = 7
    return np.asarray(2.5 * sliding_window_view(np.pad(spread, width // 2, "edge"), width).max(axis=1))


def _sum_error(state: LoadedState) -> float:
    """Return the largest error [FU] ≥ 0 of the sum over particles for ∫ q dx: Δ²/12 of each change of slope.

    Δ is the distance of particles along the body (Euler, Maclaurin). Where the line load ends by a jump, known or not,
    it is 0, but of a curved body in full contact Δ²/24 of the slope at both edges.
    """
    if state.is_full:
        before, last = np.diff(state.load)[-2:]
        bends = np.abs([2.0 * last - before])
    elif state.jump != 0.0:
        return 0.0
    else:
        bends = np.abs(np.convolve(state.load, (1.0, -2.0, 1.0)))
    return float(bends.sum()) * state.scene.bodies.spacing / state.image_ratio / 12.0


def _stiffness(state: LoadedState, share: float) -> Quantity | None:
    """Return dF/dd = −∫ (dq/dh) dx [FU/LU] of springs whose forces are functions of d − h; with the MDR 2E*a if linear.

    Between two particles the slope is that of a straight line; `share` is the relative error of the results. The
    uncertainty is the change with every second particle, and that share. None of coupled springs or two chains, of a
    body with an edge, and of a load that has no edge, or may jump there.
    """
    edge = state.edge
    if not state.is_uncoupled or edge is None or state.jump != 0.0 or state.shape.has_edge:
        return None
    sides = []
    for stride in (1, 2):
        right = np.flatnonzero((state.x >= 0.0) & (state.x < edge * INSIDE))[::stride]
        x, q = np.append(state.x[right], edge), np.append(state.load[right], 0.0)
        rise, fall = np.diff(state.heights(x) / state.layer), -np.diff(q)
        slope = np.divide(fall, rise, out=np.zeros_like(fall), where=rise > 0.0)
        slope[: np.argmax(rise > 0.0)] = slope[np.argmax(rise > 0.0)]  # on a plane end it is that beside it
        sides.append(
            float(2.0 * np.sum(slope * np.diff(x, prepend=0.0)[1:]) + 2.0 * slope[0] * x[0]) if fall.size else 0.0
        )
    fine, coarse = sides
    return Quantity(fine, abs(fine - coarse) + share * fine, LINE_PRESSURE)


def _shape_error(
    state: LoadedState, stride: int, r: Array, p: Array, attraction: Callable[[Array], Array]
) -> Callable[[Callable[[Array], Any]], Any]:
    """Return a function of a reader of p(r): the change, ≥ 0, of its reading for the possible shapes, in its unit.

    A reader takes p at the radii r, (n,), and returns a number or an array. Changes with independent shapes are added
    in squares, those with coarser ones as they are; 0 for a shape given by a formula.

    Args:
        state: the line load of the state.
        stride: every how many particles are used.
        r: radii, (n,) [LU].
        p: pressure there of the shape itself, (n,) [FU/LU²].
        attraction: tension inside by an attraction beyond the edge, ≥ 0 [FU/LU²], of radii.
    """
    shape, x = state.shape, state.x if state.edge is None else np.clip(state.x, -state.edge, state.edge)

    def pressures_of(shapes: Sequence[Shape]) -> list[Array]:
        """Return a list of p(r), (n,) [FU/LU²], of other shapes under the same displacement.

        Shapes under which too few particles are in contact are left out.
        """
        changes = [state.heights(x) - state.heights(x, alternative) for alternative in shapes]
        lines = [state.through(state.load + change - change[0], stride) for change in changes]
        return [line.pressure(r) - attraction(r) for line in lines if line]

    coarser, deviations = pressures_of(shape.coarser), [pressures_of(pair) for pair in shape.deviations]

    def change(read: Callable[[Array], Any]) -> Any:
        """Return the change ≥ 0 of a reading, in its unit: of coarser shapes the sum, of independent ones by squares.

        Of the two shapes of a pair the larger change counts.
        """
        independent = [[abs(read(varied) - read(p)) for varied in pair] for pair in deviations if pair]
        return sum(abs(read(varied) - read(p)) for varied in coarser) + np.sqrt(
            sum(np.max(pair, axis=0) ** 2 for pair in independent)
        )

    return change


def _bounded_pressures(
    state: LoadedState, fine: LineLoad, r: Array, levels: Sequence[Array], pressure: Callable[[Array], Array]
) -> Iterator[tuple[str, int, Callable[[Array], Any], float, bool]]:
    """Yield (name, index in r, reader, value [FU/LU²], whether its error is known) of p(0) and of the largest p.

    The names are "central_pressure" and "peak_pressure", that of the vertex between radii; the reader is a function
    that takes p, (n,), and returns the first element or the largest. Both are left out under a tip, and the peak where
    it is singular (at an edge or a kink), not above 0, or off the axis of a contact too narrow for three levels. A
    pressure that does not converge over the levels is left out, or if the shape is uncertain (a table or a scan) has an
    unknown error; that of a peak is unknown, too, where another possible shape has a kink inside the contact.

    Args:
        state: the line load of the state.
        fine: line load through the finest level of particles.
        r: radii, (n,) [LU].
        levels: p through every, every second and every fourth particle, as far as the contact is wide enough, (n,)
            each.
        pressure: p at other radii.
    """
    scene, shape, p = state.scene, state.shape, levels[0] if levels else pressure(r)
    # Smaller differences, relative to the pressure, are those of the minimiser.
    noise, top, unsure = 0.1 * scene.accuracy.tolerance, int(p.argmax()), bool(shape.alternatives or shape.deviations)
    smooth = p[top] > 0.0 and (top == 0 or len(levels) == 3) and _is_bounded(state, fine, top, noise * p[top])
    peak = p[top]
    if smooth and top:  # on the axis it is a maximum by symmetry
        near = np.linspace(r[top - 1], r[min(top + 1, r.size - 1)], 21)
        p_near = pressure(near)
        highest = int(p_near.argmax())
        peak = vertex(near, p_near, highest, 1)[1] if 0 < highest < near.size - 1 else p_near[highest]
    hidden = any(map(state.has_kinks, shape.alternatives))
    for name, index, read, value, is_open, may_have in (
        ("central_pressure", 0, itemgetter(0), p[0], False, True),
        ("peak_pressure", top, np.max, peak, hidden, smooth),
    ):
        known = _converges([read(level) for level in levels], noise)
        if may_have and not fine.has_apex and (known or unsure):
            yield name, index, read, float(value), known and not is_open


def _is_bounded(state: LoadedState, fine: LineLoad, top: int, noise: float) -> bool:
    """Return whether the largest pressure is bounded: no jump above 0 of the line load at the edge, no kink inside.

    A jump is a pole, a kink a logarithmic singularity. A jump that the law gives with the edge counts however small it
    is, any other if it exceeds the errors; where only particles show one (JKR), it does not count if p is largest on
    the axis. False of a body with an edge.

    Args:
        state: the line load of the state.
        fine: line load through the finest level of particles.
        top: index of the largest pressure; 0 is on the axis.
        noise: error of a pressure [FU/LU²].
    """
    if state.shape.has_edge or state.has_kinks(state.shape):
        return False
    pole = 0.0 if state.zone else noise * fine.edge
    return (top == 0 and state.jump is None) or fine.at_edge <= pole


def _nodes(state: LoadedState, edge: float, angles: int) -> tuple[Array, Array]:
    """Return (radii r = a sin θ [LU], area of the ring of each [LU²]), (k,) each, for the quadrature of p(r).

    Both edges r = 0 and r = a are left out; the areas add up to πa².

    Args:
        state: the line load of the state.
        edge: the radius a of the contact [LU].
        angles: Gauss nodes in each part between two kinks; the radius of a body whose shape is a table or a scan, or
            whose springs are not linear, is also divided in five: a corner of its history is a kink of the line load.
    """
    node, weight = gauss(angles)
    share = 0.5 * (node + 1.0)
    kinks = [kink / edge for kink in state.shape.kinks if kink < edge]
    if state.shape.slow or not state.is_elastic:
        parts = 5
        kinks += [part / parts for part in range(1, parts)]
    ends = np.arcsin(sorted({0.0, *kinks, 1.0}))
    width = np.diff(ends)[:, None]
    angle = (ends[:-1, None] + width * share * share * (3.0 - 2.0 * share)).ravel()  # dense at both ends of a piece
    step = (0.5 * width * weight * 6.0 * share * (1.0 - share)).ravel()
    r = edge * np.sin(angle)
    return r, 2.0 * np.pi * r * edge * np.cos(angle) * step


def _attraction(scene: Scene, zone: ZonedProfile | None, growth: float = 0.0) -> tuple[float, Callable[[Array], Array]]:
    """Return (force [FU] ≤ 0 of the attraction beyond the edge, tension ≥ 0 [FU/LU²] that it causes inside).

    The tension is a function of radii (n,) [LU], (n,). 0 and zeros without a zone, and for laws without such an
    attraction.

    Args:
        scene: whose attraction it is.
        zone: the profile with the edges of contact and attraction; None: the law has computed none.
        growth: share by which edge and reach are larger than those of the profile, relative to the edge.
    """
    if zone is None:
        return 0.0, np.zeros_like
    edge, reach = zone.edge, zone.reach
    return law_of(scene).cohesive_load(scene, edge + growth * edge, reach + growth * edge)


def _edge_sensitivity(load: LineLoad, body: Callable[[Array], Array], r: Array, sign: float) -> Array:
    """Return a ∂p/∂a, (n,) [FU/LU²], at radii inside the edge a, under springs on a plane, of either sign.

    That is [E* a g′(a) + `sign` J a²/(a² − r²)]/π√(a² − r²), with J the jump of the line load at the edge; the change
    of p by the growth of the jump, J/2a, is left out.

    Args:
        load: the line load, with edge and jump.
        body: function of a position that returns E* g [FU/LU].
        r: radii inside the edge, (n,) [LU].
        sign: −1 where both parts are known to have the same edge, else 1: the sum of their magnitudes for a jump above
            0.
    """
    square = (load.edge - r) * (load.edge + r)
    rise = np.diff(body(load.edge * np.asarray([1.0, 1.0 + STEP]))) / STEP
    return (rise + sign * load.at_edge * load.edge**2 / square) / (np.pi * np.sqrt(square))


def _converges(levels: Sequence[float], noise: float, ratio: float = 0.45) -> bool:
    """Return whether a value through every, every second and every fourth particle converges; True with fewer levels.

    |p₁ − p₂|/|p₁ − p₄| is 1/(1 + 2ᵖ) for an order of convergence p, ½ for a logarithm, and more for a pole.

    Args:
        levels: the values p₁, p₂ and p₄, all in one unit.
        noise: change over |p₁| up to which p₁ and p₂ count as equal.
        ratio: the quotient must be below this.
    """
    if len(levels) < 3:
        return True
    first, second, fourth = levels
    change = abs(first - second)
    return change <= noise * abs(first) or change < ratio * abs(first - fourth)


def _level_difference(values: Array, *coarser: Array) -> Array:
    """Return |fine − coarse| and a quarter of the next difference, added, (n,) in the unit of the values.

    Without a coarser level, and where the sum is not finite, it is the magnitude of the value. The first difference may
    be small by accident where a kink lies between particles; a quarter of the next one is as large at an order of
    convergence of 2.
    """
    levels = (values, *(coarser or (0.0,)))
    pairs = zip((1.0, 0.25), levels, levels[1:], strict=False)
    spread = sum(share * np.abs(fine - coarse) for share, fine, coarse in pairs)
    return np.where(np.isfinite(spread), spread, np.abs(values))


def body_shears(
    scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array], contact_radii: Array
) -> dict[str, BodyShear]:
    """Return the shear traction q(r) of the reported states of a tangential experiment, by name; else {}.

    {} also with the reduction of Geike and Popov, and of a body with an edge, where the shear is as singular as the
    pressure. A state without a contact radius above 0, or with fewer than 3 particles in contact on a side, is left
    out.

    Args:
        scene: the scene of the run.
        profiles: profiles of the reported states, "final" or the farthest one.
        columns: columns of curve.csv by name, among them "stick_radius" and "tangential_displacement" [LU], (m,).
        contact_radii: a of each load step, (m,) [LU], NaN where the bodies do not touch.
    """
    if not scene.experiment.goes_along or scene.bodies.reduction != "mdr" or scene.bodies.profile.has_edge:
        return {}
    edges = np.nan_to_num(contact_radii)
    kinks = kinks_of(columns["stick_radius"].tolist(), edges.tolist())
    return {
        name: shear
        for name, profile in profiles.items()
        if edges[row := row_of(name, columns)] > 0.0
        and (shear := _shear(scene, profile, float(edges[row]), kinks[row]))
    }


def row_of(state: str, columns: Mapping[str, Array]) -> int:
    """Return the index, from 0 on, of the load step of a reported state in a tangential experiment.

    Of "final" it is the last one; of any other name the first with the largest magnitude of the column
    "tangential_displacement".
    """
    positions = columns["tangential_displacement"]
    return len(positions) - 1 if state == "final" else int(np.argmax(np.abs(positions)))


def _shear(scene: Scene, profile: Profile, edge: float, kinks: Sequence[float]) -> BodyShear | None:
    """Return q(r) [FU/LU²] of a state, at 100 radii from 0 to the contact radius and at the kinks.

    q resists a move to the right. r = 0 is left out under a tip, where q is singular. None where fewer than 3 particles
    on a side are in contact, or they are not symmetric. The uncertainty is the difference from every second particle,
    without enough of these |q|.

    Args:
        scene: the scene of the run.
        profile: of the state.
        edge: contact radius [LU].
        kinks: radii at which q has kinks [LU].
    """

    def load(chosen: Array) -> LineLoad:
        """Return the line shear through particles of the chosen numbers, positive against a move to the right [FU/LU].

        Raises:
            ValueError: fewer than 3 positions on a side within the edge, or positions that differ between both sides.
        """
        return shear_load(profile.x[chosen], -profile.shear[chosen], edge, kinks, has_apex(scene))

    levels = [level for stride in (1, 2) if (level := through(profile.x.size, stride, load))]
    if not levels:
        return None
    r = np.unique(np.concatenate([np.linspace(0.0, edge, 100), kinks]))[levels[0].has_apex :]
    shears = [level.pressure(r) for level in levels]
    return BodyShear(r, shears[0], _level_difference(*shears))
