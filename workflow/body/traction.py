"""Pressure p(r) and shear traction q(r) under the body of three dimensions, from the line loads of a run.

Each is the inverse Abel transform of its line load (`analysis.abel`, `analysis.shear`). Its error is the difference
from what every second particle alone gives, and the edge's. Whether a pressure has a bound is decided by convergence:
from every, every second and every fourth particle; where the differences do not shrink there is no number. Where the
contact is too narrow for that, a largest pressure off the axis is none.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from contact1d.analysis.abel import FEWEST, LineLoad, line_load
from contact1d.analysis.pressure import Array, Profile
from contact1d.analysis.radius import ContactRadius, whole_cells
from contact1d.analysis.shear import kinks_of, shear_load
from contact1d.workflow.body.reading import stands_for_spheres
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.scene import Measured, Scene
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
SHRINKS = 0.45
"""|p₁ − p₂|/|p₁ − p₄| below which differences shrink: 1/(1 + 2ᵖ) of an order p, ½ of a logarithm, more of a pole."""
NOISE = 0.1
"""Of the tolerance: differences that are smaller, relative to the pressure, are those of the minimiser."""


@dataclass(frozen=True, eq=False)
class BodyPressure:
    """p(r) of one state; arrays (n,).

    Attributes:
        r: from 0 (under an apex, where p has no bound, from the first particle) to the last particle inside [LU].
        pressure: compression positive [FU/LU²].
        uncertainty: of it [FU/LU²].
        contact_radius: of the body [LU]; where bodies attract, tension reaches beyond it.
        results: `central_pressure`, p(0), and `peak_pressure`, the largest one [FU/LU²]; without one that has no bound,
            as at a cone's tip, a punch's edge or a rim.
        swings: by how much each of them changes, over the relative change of the contact radius, at most [FU/LU²]; none
            where that is not known.
    """

    r: Array
    pressure: Array
    uncertainty: Array
    contact_radius: float
    results: Mapping[str, Quantity]
    swings: Mapping[str, float]


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


def body_pressures(scene: Scene, profiles: Mapping[str, Profile]) -> dict[str, BodyPressure]:
    """p(r) of the reported states in which the bodies touch over a width; none where there is no body for them."""
    if not is_of_a_body(scene):
        return {}
    rule = radius_rule(scene, scene.accuracy.tolerance)
    return {
        name: one
        for name, profile in profiles.items()
        if (radius := rule.of(profile)) and radius.value > 0.0 and (one := _pressure(scene, profile, radius))
    }


def _pressure(scene: Scene, profile: Profile, radius: ContactRadius) -> BodyPressure | None:
    """p(r) of a state; None where too few particles carry it, or they are not alike on both sides."""
    wider = WIDER_THAN_SPHERES if stands_for_spheres(scene) else 1.0
    held = scene.adhesion is not None and scene.adheres
    x, q = profile.x / wider, wider * (whole_cells(profile, radius) if held else profile.pressure)
    jumps = scene.bodies.profile.has_edge or held
    edge = radius.value / wider if jumps or scene.interaction is None else None
    own = -(-(x.size - x.size // 2) // MOST)

    body = _body(scene)
    apex = _has_apex(scene, TIP if body is None else KNOWN_TIP)

    def load(chosen: Array) -> LineLoad:
        return line_load(x[chosen], q[chosen], edge, not jumps, apex, body)

    levels = [_through(x.size, own * stride, load) for stride in (1, 2, 4)]
    fine = levels[0]
    if fine is None:
        return None
    side = x[x.size // 2 :][::own]
    inside = side[(side > 0.0) & (side < fine.edge * INSIDE)]
    r = inside if fine.has_apex else np.append(0.0, inside)
    p = fine.pressure(r)
    # Of a known shape nothing lies between the particles: where they are too few to show it, its edge alone is open.
    exact = levels[1] is None and fine.body is not None
    spread = (0.0 if exact else _spread(p, levels[1], r)) + radius.uncertainty / radius.value * np.abs(p)
    within = np.count_nonzero(side < radius.value / wider)
    told = [level for i, level in enumerate(levels) if level is not None and within >= FEWEST * 2**i]
    noise, top = NOISE * scene.accuracy.tolerance, int(p.argmax())
    bounded = {}
    if not fine.has_apex:
        if _converges([float(level.pressure([0.0])[0]) for level in told], noise):
            bounded["central_pressure"] = 0
        # A jump at the edge is a pole, and where the slope jumps inside p is a logarithm.
        smooth = not (scene.bodies.profile.has_edge or any(kink < radius.value for kink in scene.bodies.kinks))
        off_axis = smooth and top > 0 and len(told) == 3 and fine.at_edge <= noise * p[top] * fine.edge
        if off_axis:
            off_axis = _converges([float(level.pressure(r).max()) for level in told], noise)
        if p[top] > 0.0 and (off_axis or (smooth and top in bounded.values())):
            bounded["peak_pressure"] = top
    digits = ROUND_OFF * scene.bulk_stiffness / scene.bodies.spacing
    results = {name: Quantity(float(p[at]), float(spread[at]) + digits, MEAN_PRESSURE) for name, at in bounded.items()}
    if bounded.get("peak_pressure"):  # it lies between two particles
        highest = float(fine.pressure(np.linspace(r[top - 1], r[min(top + 1, r.size - 1)], BETWEEN)).max())
        results["peak_pressure"] = Quantity(highest, float(spread[top]), MEAN_PRESSURE)
    swings = {} if fine.body is None else {name: float(_swing(fine, r, p)[at]) for name, at in bounded.items()}
    return BodyPressure(r, p, spread, radius.value / wider, results, swings)


def _body(scene: Scene) -> Callable[[Array], Array] | None:
    """c h(x) [FU/LU] of springs that are all that carries, on a plane; None of others, and of a table of positions."""
    bodies = scene.bodies
    known = not (bodies.profile.has_edge or isinstance(bodies.profile, Measured))
    if bodies.lower != "rigid_plane" or scene.neighbours is not None or not known:
        return None
    layer = scene.bulk_stiffness / bodies.spacing
    return lambda x: layer * bodies.height(x)


def _swing(load: LineLoad, r: Array, p: Array) -> Array:
    """|a ∂p/∂a| at most: of the shape's own pressure, ∝ a^(n − 1), and of the jump's, ∝ a^(−½) in JKR, which cancel."""
    assert load.body is not None
    jump = load.at_edge / (np.pi * np.sqrt((load.edge - r) * (load.edge + r)))
    inner, outer = load.body(load.edge * np.asarray([0.5, 1.0]))
    return max(1.0, float(np.log2(outer / inner))) * np.abs(p - jump) + np.abs(jump)


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


def _spread(values: Array, coarse: LineLoad | None, r: Array) -> Array:
    """|fine − coarse| at r; the value itself where there is no coarser one."""
    spread = np.abs(values) if coarse is None else np.abs(values - coarse.pressure(r))
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

    fine, coarse = (_through(profile.x.size, stride, load) for stride in (1, 2))
    if fine is None:
        return None
    r = np.unique(np.concatenate([np.linspace(0.0, edge, RADII), kinks]))[fine.has_apex :]
    shear = fine.pressure(r)
    return BodyShear(r, shear, _spread(shear, coarse, r), edge, stick)
