"""The figures of a run: which ones its experiment has, with the theory beside the curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import plots, slip_plots
from contact1d.analysis.curve import Curve
from contact1d.analysis.pressure import Profile
from contact1d.analysis.reference.mindlin import mindlin_path, sliding_displacement
from contact1d.analysis.slip import stick_margin
from contact1d.workflow.experiments.running.radii import RadiusRule
from contact1d.workflow.scene import Scene, Tangential

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
Drawings = dict[str, Callable[[], "Figure"]]
SAME_LOAD = 1e-9
"""Change of a load over the load up to which it is one: round-off."""


def drawings(
    scene: Scene,
    values: Mapping[str, float],
    curve: Curve,
    profiles: Mapping[str, Profile],
    friction: Mapping[str, Array],
) -> Drawings:
    """What draws each figure, by the names of the files, the main one first.

    Args:
        scene: what ran.
        values: of the results.
        curve, profiles, friction: as in `Run`.
    """
    radii = {state: _radius(scene, profile) for state, profile in profiles.items()}
    pressure: Drawings = {}
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        pressure["pressure"] = partial(plots.pressure_figure, profiles, radii)
    if isinstance(scene.experiment, Tangential):
        theory = _mindlin(scene, curve, friction)
        loop = partial(slip_plots.tangential_figure, friction, curve.branch, theory)
        return {"tangential": loop, "stick_slip": _stick_slip(scene, profiles, friction), **pressure}
    if friction:
        return {"friction": partial(plots.friction_figure, friction), **pressure}
    if scene.noise is not None:
        return pressure
    forces = partial(plots.force_displacement_figure, curve, values, _theory(scene, values))
    found: Drawings = {"force_displacement": forces}
    if _adheres_over_a_width(values):
        marks = values["adhesion_force"], values["zero_load_radius"]
        found["force_radius"] = partial(plots.force_radius_figure, curve, *marks)
    return found | pressure


def draw(
    folder: Path,
    scene: Scene,
    values: Mapping[str, float],
    curve: Curve,
    profiles: Mapping[str, Profile],
    friction: Mapping[str, Array],
) -> None:
    """Save every figure of a run in its folder."""
    for name, figure in drawings(scene, values, curve, profiles, friction).items():
        plots.save_figure(figure(), folder / f"{name}.png")


def _stick_slip(scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array]) -> Callable[[], Figure]:
    """The stick zone of each state, as the row at its place has it."""
    assert scene.friction is not None
    places, coefficient = columns["tangential_displacement"], scene.friction.coefficient
    margins, radii, moved = {}, {}, {}
    for name, profile in profiles.items():
        row = len(places) - 1 if name == "final" else int(np.argmax(np.abs(places)))
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


def _radius(scene: Scene, profile: Profile) -> float:
    found = RadiusRule(scene, scene.accuracy.tolerance).of(profile)
    return nan if found is None else found.value


def _adheres_over_a_width(values: Mapping[str, float]) -> bool:
    """Whether the run has F_A and an a₀ that is not 0, by which a reduced curve can be divided."""
    return "adhesion_force" in values and values.get("zero_load_radius", 0.0) > 0.0


def _theory(scene: Scene, values: Mapping[str, float]) -> tuple[str, Array, Array] | None:
    """JKR with the run's own F_A and a₀; Hertz, with nothing fitted, for a parabola on a rigid plane; else none."""
    bodies, radius = scene.bodies, scene.bodies.plane_radius
    if radius is None:
        return None
    if _adheres_over_a_width(values):
        curve = plots.jkr_curve(values["adhesion_force"], values["zero_load_radius"], radius)
        return "JKR, same $F_A$ and $a_0$", *curve
    if scene.interaction is None and (places := scene.experiment.places()):
        return "Hertz", *plots.hertz_curve(max(places), radius, scene.bulk_stiffness / bodies.spacing)
    return None
