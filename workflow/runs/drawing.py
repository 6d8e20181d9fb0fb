"""The figures of a run: which ones its experiment has, with the theory beside the curve."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial
from math import nan, pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import figures, plots
from contact1d.analysis.curve import DETACHMENTS, SAMPLE_COLUMNS, SAMPLE_TABLE, Curve, read_columns
from contact1d.analysis.pressure import Profile
from contact1d.analysis.shear import stick_margin
from contact1d.analysis.theory.indenters import PowerLaw
from contact1d.analysis.theory.mindlin import mindlin_path, sliding_displacement
from contact1d.workflow.body.derived import REPORTED
from contact1d.workflow.body.reading import IMAGE
from contact1d.workflow.body.theory import Case, applying
from contact1d.workflow.body.traction import row_of
from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Scales

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from contact1d.workflow.runs.finished import Run

Array = NDArray[np.float64]
MEASURED = ("sampling", "unloading", "pulling")
"""Branches of a motion under heat that are what is asked for; the others forget how it began."""
Drawings = dict[str, Callable[[], "Figure"]]
FINE = 300
"""Radii at which a closed form is drawn."""
LEAST, LARGEST = 0.05, 1.3
"""Radii over a₀ from and to which JKR is drawn; on a plane from where fixed grips part."""
SAME_LOAD = 1e-9
"""Change of a load over the load up to which it is one: round-off."""


def drawings(run: Run, scales: Scales | None = None) -> Drawings:
    """What draws each figure of a run, by the names of the files, the main one first.

    Args:
        run: finished, or as far as it came.
        scales: in place of the run's own: where they are known the figures are in SI.
    """
    title, scales = f"{run.scene.title}\n(reduction {run.scene.bodies.reduction})", scales or run.scales

    def dressed(draw: Callable[[], Figure]) -> Figure:
        figure = draw()
        figure.suptitle(title, fontsize=11)
        return figure if scales is None else plots.in_si(figure, scales.written)

    plain = _drawings(run)
    if (kept := run.folder / f"{SAMPLE_TABLE}.csv").is_file():
        measured = np.isin(run.curve.branch, MEASURED)
        traces = partial(
            figures.samples_figure, read_columns(kept, SAMPLE_COLUMNS), measured, _values(run).get("displacement")
        )
        plain = plain | {SAMPLE_TABLE: traces} if DETACHMENTS in plain else {SAMPLE_TABLE: traces} | plain
    return {name: partial(dressed, draw) for name, draw in plain.items()}


def draw(run: Run, form: str, scales: Scales | None = None) -> None:
    """Save every figure of a run in its folder; `form`: png, svg or pdf."""
    for name, figure in drawings(run, scales).items():
        plots.save_figure(figure(), run.folder / f"{name}.{form}")


def _drawings(run: Run) -> Drawings:
    """The figures without title, in model units."""
    scene, curve, profiles = run.scene, run.curve, run.profiles
    pressure: Drawings = {}
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        radii = {state: _radius(scene, profile) for state, profile in profiles.items()}
        pressure["pressure"] = partial(figures.pressure_figure, profiles, radii)
    if scene.experiment.goes_along:
        return _sheared(run) | pressure | _body_pressure(run)
    if run.friction:
        return {"friction": partial(figures.friction_figure, run.friction), **pressure}
    if run.detachments and run.detachments["force"].size > 1:
        return {DETACHMENTS: partial(figures.detachments_figure, run.detachments["force"]), **pressure}
    if scene.noise is not None and not scene.experiment.way_is_given:
        return pressure
    values = _values(run)
    beside = _theory(scene, values, curve)
    over_d = None if beside is None else (beside[0], *beside[1][1:])
    found: Drawings = {"force_displacement": partial(figures.force_displacement_figure, curve, values, over_d)}
    if _adheres_over_a_width(values):
        marks = values["adhesion_force"], values["zero_load_radius"]
        found["force_radius"] = partial(figures.force_radius_figure, curve, *marks)
    elif np.unique(curve.contact_radius[curve.contact_radius > 0.0]).size > 1:
        over_a = (beside[0], *beside[1][::2]) if beside is not None and beside[0] == "Hertz" else None
        found["force_radius"] = partial(figures.load_radius_figure, curve, over_a)
    return found | pressure | _body_pressure(run)


def _values(run: Run) -> dict[str, float]:
    """The results by name, of lengths those of the image: they belong to the curve."""
    values = {name: quantity.value for name, quantity in run.results.items()}
    return values | {name.removeprefix(IMAGE): value for name, value in values.items() if name.startswith(IMAGE)}


def _sheared(run: Run) -> Drawings:
    """Force over displacement along x, the stick zone and q(r)."""
    theory = _mindlin(run.scene, run.curve, run.friction)
    loop = partial(figures.tangential_figure, run.friction, run.curve.branch, theory)
    found: Drawings = {"tangential": loop, "stick_slip": _stick_slip(run.scene, run.profiles, run.friction)}
    if shears := run.body_shears:
        lines = {name: (one.r, one.shear, one.edge, one.stick) for name, one in shears.items()}
        found["shear_3d"] = partial(figures.body_shear_figure, lines)
    return found


def _body_pressure(run: Run) -> Drawings:
    """p(r) of the body, where there is one, and the closed form beside it for the state that it speaks of."""
    pressures, case = run.body_pressures, Case(run.scene, run.results)
    theories: dict[str, tuple[str, Array, Array]] = {}
    state = next((name for name in REPORTED if name in pressures), None)
    forms = [form for form in applying(case) if form.pressure is not None] if state is not None else []
    if state is not None and forms and (pressure := forms[0].pressure):
        r = pressures[state].contact_radius * np.sin(np.linspace(0.005, 0.4999 * np.pi, FINE))
        theories[state] = forms[0].name, r, pressure(case, r)
    drawn = {name: (one.r, one.pressure, one.contact_radius) for name, one in pressures.items()}
    return {"pressure_3d": partial(figures.body_pressure_figure, drawn, theories)} if drawn else {}


def _stick_slip(scene: Scene, profiles: Mapping[str, Profile], columns: Mapping[str, Array]) -> Callable[[], Figure]:
    """The stick zone of each state, as the row at its place has it."""
    assert scene.friction is not None
    places, coefficient = columns["tangential_displacement"], scene.friction.coefficient
    states = {}
    for name, profile in profiles.items():
        row = row_of(name, columns)
        moves = np.diff(places[: row + 1], prepend=0.0)
        direction = int(np.sign(moves[moves != 0.0][-1])) if moves.any() else 0
        margin = stick_margin(profile, coefficient, direction)
        states[name] = profile, margin, float(columns["stick_radius"][row]), float(places[row])
    return partial(figures.stick_slip_figure, states, coefficient)


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


def _theory(scene: Scene, values: Mapping[str, float], curve: Curve) -> tuple[str, Array] | None:
    """Name, and a, d, F of JKR: with the run's own F_A and a₀, on a plane with nothing fitted; or of Hertz; or none.

    The image x²/2R₁ on springs E* per length is the contact of R = 2R₁; its a₀ is twice that of the two spheres.
    """
    bodies, half = scene.bodies, scene.bodies.plane_radius
    if half is None:
        return None
    radius, modulus = 2.0 * half, scene.bulk_stiffness / bodies.spacing
    if scene.adhesion is not None and scene.adheres:
        jkr = PowerLaw.sphere(radius, modulus, scene.adhesion.work)
        return "JKR", jkr.curve(jkr.fixed_grips_radius(), LARGEST * jkr.zero_load_radius())
    if _adheres_over_a_width(values):
        force, a_0 = values["adhesion_force"], values["zero_load_radius"]
        fitted = PowerLaw.sphere(radius, 3.0 * force * radius / a_0**3, force / (1.5 * pi * radius))
        return "JKR, same $F_A$ and $a_0$", fitted.curve(LEAST * a_0, LARGEST * a_0)
    if scene.interaction is None:
        hertz = PowerLaw.sphere(radius, modulus)
        return "Hertz", hertz.curve(0.0, hertz.radius_at(max(float(curve.displacement.max()), 0.0)))
    return None
