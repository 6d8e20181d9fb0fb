"""The figures of a run: which ones its experiment has, with the theory beside the curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import body_plots, plots, slip_plots
from contact1d.analysis.curve import DETACHMENTS, SAMPLE_TABLE, Curve, read_samples
from contact1d.analysis.pressure import Profile
from contact1d.analysis.slip import stick_margin
from contact1d.analysis.theory.mindlin import mindlin_path, sliding_displacement
from contact1d.analysis.time_plots import samples_figure
from contact1d.workflow.body.closed_form import Case
from contact1d.workflow.body.pressure import REPORTED, body_pressures
from contact1d.workflow.body.shear import body_shears, row_of
from contact1d.workflow.body.theory import applying
from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.scene import Scene, Tangential
from contact1d.workflow.units import Quantity, Scales

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
MEASURED = ("sampling", "unloading", "pulling")
"""Branches of a motion under heat that are what is asked for; the others forget how it began."""
Drawings = dict[str, Callable[[], "Figure"]]
FINE = 300
"""Radii at which a closed form is drawn."""
SAME_LOAD = 1e-9
"""Change of a load over the load up to which it is one: round-off."""


def drawings(
    scene: Scene,
    values: Mapping[str, float],
    curve: Curve,
    profiles: Mapping[str, Profile],
    friction: Mapping[str, Array],
    detachments: Mapping[str, Array],
    scales: Scales | None = None,
    folder: Path | None = None,
) -> Drawings:
    """What draws each figure, by the names of the files, the main one first.

    Args:
        scene: what ran.
        values: of the results.
        curve, profiles, friction, detachments: as in `Run`.
        scales: of the run, where its units are known: the figures are in SI then.
        folder: of the run, where samples.csv is, if it has one.
    """
    title = f"{scene.title}\n(reduction {scene.bodies.reduction})"

    def dressed(draw: Callable[[], Figure]) -> Figure:
        figure = body_plots.entitled(draw(), title)
        return figure if scales is None else body_plots.in_si(figure, scales.written)

    plain = _drawings(scene, values, curve, profiles, friction, detachments)
    if folder is not None and (kept := folder / f"{SAMPLE_TABLE}.csv").is_file():
        traces = partial(
            samples_figure, read_samples(kept), np.isin(curve.branch, MEASURED), values.get("displacement")
        )
        plain = plain | {SAMPLE_TABLE: traces} if DETACHMENTS in plain else {SAMPLE_TABLE: traces} | plain
    return {name: partial(dressed, draw) for name, draw in plain.items()}


def _drawings(
    scene: Scene,
    values: Mapping[str, float],
    curve: Curve,
    profiles: Mapping[str, Profile],
    friction: Mapping[str, Array],
    detachments: Mapping[str, Array],
) -> Drawings:
    """The figures without title, in model units."""
    radii = {state: _radius(scene, profile) for state, profile in profiles.items()}
    pressure: Drawings = {}
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        pressure["pressure"] = partial(plots.pressure_figure, profiles, radii)
    if isinstance(scene.experiment, Tangential):
        theory = _mindlin(scene, curve, friction)
        loop = partial(slip_plots.tangential_figure, friction, curve.branch, theory)
        sheared: Drawings = {"tangential": loop, "stick_slip": _stick_slip(scene, profiles, friction)}
        if shears := body_shears(scene, profiles, friction, curve.contact_radius):
            lines = {name: (one.r, one.shear, one.edge, one.stick) for name, one in shears.items()}
            sheared["shear_3d"] = partial(slip_plots.body_shear_figure, lines)
        return sheared | pressure | _body_pressure(scene, values, profiles)
    if friction:
        return {"friction": partial(plots.friction_figure, friction), **pressure}
    if detachments and detachments["force"].size > 1:
        return {DETACHMENTS: partial(plots.detachments_figure, detachments["force"]), **pressure}
    if scene.noise is not None and not scene.experiment.way_is_given:
        return pressure
    forces = partial(
        plots.force_displacement_figure, curve, values, _theory(scene, values, float(curve.displacement.max()))
    )
    found: Drawings = {"force_displacement": forces}
    if _adheres_over_a_width(values):
        marks = values["adhesion_force"], values["zero_load_radius"]
        found["force_radius"] = partial(plots.force_radius_figure, curve, *marks)
    elif np.unique(curve.contact_radius[curve.contact_radius > 0.0]).size > 1:
        found["force_radius"] = partial(plots.load_radius_figure, curve, _hertz_over_radius(scene, curve))
    return found | pressure | _body_pressure(scene, values, profiles)


def draw(
    folder: Path,
    scene: Scene,
    values: Mapping[str, float],
    curve: Curve,
    profiles: Mapping[str, Profile],
    friction: Mapping[str, Array],
    detachments: Mapping[str, Array],
    scales: Scales | None,
    form: str,
) -> None:
    """Save every figure of a run in its folder; `form`: png, svg or pdf."""
    for name, figure in drawings(scene, values, curve, profiles, friction, detachments, scales, folder).items():
        plots.save_figure(figure(), folder / f"{name}.{form}")


def _body_pressure(scene: Scene, values: Mapping[str, float], profiles: Mapping[str, Profile]) -> Drawings:
    """p(r) of the body, where there is one, and the closed form beside it for the state that it speaks of."""
    pressures = body_pressures(scene, profiles)
    if not pressures:
        return {}
    case = Case(scene, {name: Quantity(value, 0.0, "") for name, value in values.items()})
    theories: dict[str, tuple[str, Array, Array]] = {}
    state = next((name for name in REPORTED if name in pressures), "")
    for form in applying(case) if state else []:
        if form.pressure is not None and state not in theories:
            r = pressures[state].contact_radius * np.sin(np.linspace(0.005, 0.4999 * np.pi, FINE))
            theories[state] = form.name, r, form.pressure(case, r)
    drawn = {name: (one.r, one.pressure, one.contact_radius) for name, one in pressures.items()}
    return {"pressure_3d": partial(body_plots.body_pressure_figure, drawn, theories)}


def _stick_slip(scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array]) -> Callable[[], Figure]:
    """The stick zone of each state, as the row at its place has it."""
    assert scene.friction is not None
    places, coefficient = columns["tangential_displacement"], scene.friction.coefficient
    margins, radii, moved = {}, {}, {}
    for name, profile in profiles.items():
        row = row_of(name, columns)
        moves = np.diff(places[: row + 1], prepend=0.0)
        direction = int(np.sign(moves[moves != 0.0][-1])) if moves.any() else 0
        margins[name] = stick_margin(profile, coefficient, direction)
        radii[name], moved[name] = float(columns["stick_radius"][row]), float(places[row])
    return partial(slip_plots.stick_slip_figure, profiles, coefficient, margins, radii, moved)


def _mindlin(scene: Scene, curve: Curve, columns: Mapping[str, Array]) -> Array | None:
    """Cattaneo and Mindlin at the places of a parabola under one load; else None."""
    places, loads = columns["tangential_displacement"], columns["normal_force"]
    if scene.bodies.plane_radius is None or scene.friction is None or not scene.friction.coefficient:
        return None
    if np.ptp(loads) > SAME_LOAD * loads.max():
        return None
    ratio, coefficient = scene.tangential_stiffness / scene.bulk_stiffness, scene.friction.coefficient
    sliding = sliding_displacement(coefficient, ratio, float(curve.displacement[0]))
    return np.asarray(mindlin_path(places.tolist(), float(loads[0]), coefficient, sliding))


def _hertz_over_radius(scene: Scene, curve: Curve) -> tuple[str, Array, Array] | None:
    """Hertz's radius √(2 R₁ d) of the plane parabola x²/2R₁ and force, without adhesion on a plane; else none."""
    bodies, radius = scene.bodies, scene.bodies.plane_radius
    if radius is None or scene.interaction is not None or scene.adheres:
        return None
    d, force = plots.hertz_curve(float(curve.displacement.max()), radius, scene.bulk_stiffness / bodies.spacing)
    return "Hertz", np.sqrt(2.0 * radius * d), force


def _radius(scene: Scene, profile: Profile) -> float:
    found = RadiusRule(scene, scene.accuracy.tolerance).of(profile)
    return nan if found is None else found.value


def _adheres_over_a_width(values: Mapping[str, float]) -> bool:
    """Whether the run has F_A and an a₀ that is not 0, by which a reduced curve can be divided."""
    return "adhesion_force" in values and values.get("zero_load_radius", 0.0) > 0.0


def _theory(scene: Scene, values: Mapping[str, float], deepest: float) -> tuple[str, Array, Array] | None:
    """JKR, with the run's own F_A and a₀ or on a rigid plane with nothing fitted; Hertz there; else none."""
    bodies, radius = scene.bodies, scene.bodies.plane_radius
    if radius is None:
        return None
    if scene.adhesion is not None and scene.adheres:
        return "JKR", *plots.jkr_on_plane(2.0 * radius, scene.bulk_stiffness / bodies.spacing, scene.adhesion.work)
    if _adheres_over_a_width(values):
        curve = plots.jkr_curve(values["adhesion_force"], values["zero_load_radius"], radius)
        return "JKR, same $F_A$ and $a_0$", *curve
    if scene.interaction is None:
        return "Hertz", *plots.hertz_curve(deepest, radius, scene.bulk_stiffness / bodies.spacing)
    return None
