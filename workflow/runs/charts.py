"""The figures of a run as charts, with the closed forms that apply."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from math import nan, pi
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis import figures
from contact1d.analysis.chart import Axis, Chart, Series
from contact1d.analysis.curve import DETACHMENTS, SAMPLE_TABLE
from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.theory.indenters import Ellipsoid, PowerLaw
from contact1d.analysis.theory.mindlin import mindlin_path
from contact1d.workflow.body.cases import Case
from contact1d.workflow.body.derived import REPORTED
from contact1d.workflow.body.reading import IMAGE, image_ratio
from contact1d.workflow.body.theory import applying, drawn_along, indented, sliding_contact
from contact1d.workflow.body.traction import row_of
from contact1d.workflow.continuation.state import radius_rule
from contact1d.workflow.laws import law_of
from contact1d.workflow.runs import inputs
from contact1d.workflow.runs.report import COLUMN_UNITS
from contact1d.workflow.scene import Friction, History
from contact1d.workflow.scene.tables import SPHERES
from contact1d.workflow.units import NUMBER

if TYPE_CHECKING:
    from contact1d.workflow.runs.finished import Run

Array = NDArray[np.float64]
CURVE_COLUMNS = ("displacement", "force", "contact_radius", "branch")
"""Columns that every curve has."""


CONTACT_RADIUS = "contact radius a"
MAIN = {
    "tangential_displacement": "tangential_force", "drive": "friction", "time": "displacement", "displacement": "force",
}  # fmt: skip
"""Columns of the axes of the main curve, y by x; x is the first one that a run has."""
FROM_ZERO = ("contact_radius", "force", "friction", "tangential_force")
"""Columns whose axis includes 0."""


def charts(run: Run) -> dict[str, Chart]:
    """Return the charts of a run by the names of the figures' files without suffix, the main one first.

    They are in SI base units where the units are known, else in units of the model. A figure for which the run has no
    data is missing.

    Raises:
        KeyError: the run failed and has no tables.
    """
    scales, bodies = run.scales, run.scene.bodies
    title = run.scene.title + ("" if bodies.reduction == "mdr" else f"\n(reduction {bodies.reduction})")
    return {
        name: replace(chart, title=title).written(lambda _, unit: scales.base(unit), scales.in_words)
        for name, chart in _charts(run.model)
    }


def axis_of(column: str) -> Axis:
    """Return the axis of a column of the tables: its name in words and its unit of the model.

    Those of forces and contact radii include 0.

    Raises:
        KeyError: the column has no unit, or is not known.
    """
    remark = figures.COMPRESSIVE if column in CURVE_COLUMNS[:2] else ""
    name = "displacement of the drive" if column == "drive" else column.replace("_", " ")
    return Axis(name, COLUMN_UNITS[column], remark, zero=column in FROM_ZERO)


def main_curve(run: Run) -> dict[str, Array]:
    """Return the columns of the main curve by name, (n,) each, that of x first; in units of the model.

    These are tangential force over displacement, friction over drive, displacement over time (the force where
    displacements are prescribed), else force over displacement, compression positive. A normal force that changes is
    the third column. There is an element for each state of the curve; those before a slide is driven are NaN.

    `run` has its tables in units of the model.
    """
    columns = run.friction or run.curve
    over = next(name for name in MAIN if name in columns)
    names = [over, "force" if over == "time" and run.scene.experiment.places() else MAIN[over]]
    if "normal_force" in columns and np.ptp(load := columns["normal_force"]) > 1e-9 * np.abs(load).max():
        names.append("normal_force")  # it is not constant
    missing = np.full(run.curve.force.size - columns[over].size, nan)
    return {name: np.append(missing, columns[name]) for name in names}


def legs_of(run: Run, along: Array) -> list[tuple[str, NDArray[np.int64]]]:
    """Return (name of the branch, indices of its states, (k,)) of each leg of the curve.

    Of a prescribed path, and of a tangential one, a leg begins with the last state of the one before. Of any other
    experiment they are the branches of each cycle, in the order of their first states, sorted by the positions `along`,
    (n,), since a search goes back and forth.
    """
    branch, kind = run.curve.branch, run.scene.experiment
    if kind.history_is_given or kind.goes_along:
        starts = [0, *np.flatnonzero(branch[1:] != branch[:-1]) + 1, branch.size]
        legs = [np.arange(max(start - 1, 0), end) for start, end in pairwise(starts)]
    else:
        order = np.argsort(along, kind="stable")
        names = np.char.add(branch, run.curve.get("cycle", np.zeros(branch.size)).astype(str))
        legs = [order[names[order] == name] for name in dict.fromkeys(names.tolist())]
    return [(str(branch[rows[-1]]), rows) for rows in legs]


def _charts(run: Run) -> Iterator[tuple[str, Chart]]:
    """Yield (name of the file without suffix, chart) of each figure that a run has, the main one first.

    `run` has its tables in units of the model, as have the charts.
    """
    scene, profiles = run.scene, figures.seen(run.profiles)
    over, up, *_ = main_curve(run)
    rule = radius_rule(scene, scene.accuracy.tolerance)
    radii = {state: radius for state in profiles if (radius := rule.of(run.profiles[state]))}
    if run.detachments and run.detachments["force"].size > 1:
        yield DETACHMENTS, figures.detachments(run.detachments["force"])
    if SAMPLE_TABLE in run.tables:
        yield SAMPLE_TABLE, _samples(run)
    if scene.is_oblique:
        yield from _oblique(run)
    if scene.experiment.goes_along:
        yield "tangential", path_chart(run, tangential_force=_mindlin(run))
        yield "stick_slip", figures.stick_slip(profiles, scene.the(Friction).coefficient, _zones(run, profiles))
    elif over != "displacement":
        name = "friction" if run.friction else f"{up}_{over}"
        yield name, path_chart(run, force=_ting(run, over) if up == "force" else [])
    if ("displacement" in (over, up) or isinstance(scene.experiment, History)) and (
        not scene.noise or scene.experiment.history_is_given
    ):
        yield from _under_load(run)
    if all(profile.x.size > 1 for profile in profiles.values()):  # one particle has no pressure over x
        yield "pressure", figures.pressure(profiles, radii)
    marks = _marks(run, radii)
    if pressures := run.body_pressures:
        yield "pressure_3d", figures.body("pressure", pressures, marks, _body_theory(run, marks))
    if "inputs" in run.tables:
        yield "inputs", inputs.chart(run.tables["inputs"])
    if shears := run.body_shears:
        yield "shear_3d", figures.body("shear_stress", shears, marks, {})
    if taken := scene.bodies.profile.taken:
        yield "scan", figures.scan(taken)


def _oblique(run: Run) -> Iterator[tuple[str, Chart]]:
    """Yield ("trajectory", …), ("force_ratio", …) and ("stick_zone", …), the figures of an oblique impact with names.

    They have the displacement over the position of the contact point along x [LU]; tangential over normal force over
    time [TU] beside ±μ; and contact radius and stick radius over time [LU].
    """
    curve, coefficient = run.curve, run.scene.the(Friction).coefficient
    yield "trajectory", path_chart(run, {name: curve[name] for name in ("contact_point_x", "displacement")})
    time, legs, ends = axis_of("time"), legs_of(run, curve.time), curve.time[[0, -1]]
    ratio = np.divide(curve.tangential_force, curve.force, out=np.full_like(curve.force, nan), where=curve.force > 0.0)
    limits = [(f"{sign}μ", ends, np.full(2, float(f"{sign}1")) * coefficient) for sign in "+-"]
    shares = Axis("tangential over normal force", NUMBER)
    yield "force_ratio", figures.path(time, curve.time, legs, (shares, ratio, figures.lines(*limits)))
    sticks = figures.lines(("stick radius", curve.time, curve.stick_radius))
    panel = axis_of("contact_radius"), curve.contact_radius, sticks
    yield "stick_zone", figures.path(time, curve.time, legs, panel)


def path_chart(run: Run, columns: Mapping[str, Array] | None = None, **references: Sequence[Series]) -> Chart:
    """Return the chart of columns over the first one, a panel for each, by default of the main curve.

    In units of the model; each leg of the path is a series of its own, with markers where it has at most 25 points.

    Args:
        run: with its tables in units of the model.
        columns: by name, (n,) each, that of x first; None: the main curve.
        references: further series by the column to which they belong; those of other columns are ignored.
    """
    (over, along), *upwards = (columns or main_curve(run)).items()
    panels = [(axis_of(name), column, references.get(name, ())) for name, column in upwards]
    return figures.path(axis_of(over), along, legs_of(run, along), *panels)


def _samples(run: Run) -> Chart:
    """Return the chart of displacement [LU] and force [FU] over time [TU] of a contact with noise.

    Compression is positive. With lines of the load and, where it is reported, of the mean displacement.
    """
    table, mean = run.tables[SAMPLE_TABLE], run.results.get("displacement")
    references = {"force": figures.lines(("load", table["time"], table["load"]))}
    if mean is not None:
        references["displacement"] = figures.level(mean.value, mean.uncertainty, "mean")
    return path_chart(run, {name: table[name] for name in ("time", "displacement", "force")}, **references)


def _under_load(run: Run) -> Iterator[tuple[str, Chart]]:
    """Yield ("force_displacement", its chart) and ("force_radius", its chart): F [FU] over d and over a [LU].

    Compression is positive. Of a sphere whose F_A and a₀ > 0 are known the latter has F/F_A over a/a₀; of any other
    body it is left out where the radius has fewer than two different values above 0. `run` has its tables in units of
    the model.
    """
    curve, theory, scale, tension = run.curve, _theory(run), _pull_off(run), run.results.get("adhesion_force")
    references = figures.lines(*((name, d, force) for name, _, d, force in theory))
    references += _ting(run, "displacement")
    if tension and tension.value:
        references += figures.level(-tension.value, tension.uncertainty, f"$F_A$ = {tension.value:.4g} FU")
    yield "force_displacement", path_chart(run, {name: curve[name] for name in CURVE_COLUMNS[:2]}, force=references)
    radius = np.where(curve.contact_radius > 0.0, curve.contact_radius, nan)
    x, y = axis_of("contact_radius"), axis_of("force")
    unique = not law_of(run.scene).attracts(run.scene)
    references = figures.lines(*((name, a, force) for name, a, _, force in theory if unique))
    width, height = 1.0, 1.0
    if scale and run.scene.bodies.profile.kind in SPHERES:
        height, width = scale
        x, y = Axis("contact radius $a/a_0$"), replace(y, name="force $F/F_A$", unit=NUMBER)
        references = figures.reduced(float(np.nanmax(radius)) / width)
    elif np.unique(radius[np.isfinite(radius)]).size < 2:
        return
    panel, spread = (y, curve.force / height, references), curve.contact_radius_uncertainty / width
    yield "force_radius", figures.path(x, radius / width, legs_of(run, radius), panel, spread=spread)


def _ting(run: Run, over: str) -> list[Series]:
    """Return a list of F of Lee, Radok and Ting [FU] over a column `over` of the curve, compression positive.

    Empty where they do not apply: to anything but one indentation by a viscoelastic paraboloid, cone or power.
    """
    history = indented(Case(run.scene, run.results))
    return [] if history is None else figures.lines(("Ting", run.curve[over], history.forces(run.curve.time)))


def _pull_off(run: Run) -> tuple[float, float] | None:
    """Return (F_A [FU], tension positive, a₀ > 0 [LU]) of the run; None where either is missing or a₀ is 0.

    Where the run stands for two equal spheres, and reports both their a₀ and that of the one-dimensional image, twice
    as wide, it is that of the image, as in its curve.
    """
    force, radius = run.results.get("adhesion_force"), run.results.get("zero_load_radius")
    radius = run.results.get(f"{IMAGE}zero_load_radius", radius)
    return (force.value, radius.value) if force and radius and radius.value > 0.0 else None


def _zones(run: Run, states: Iterable[str]) -> dict[str, tuple[float, float, int]]:
    """Return (stick radius [LU], tangential displacement [LU], direction of motion) of states by name, from the curve.

    The direction is that of the last motion along x up to the state, 1 or −1, and 0 where there was none.
    """
    zones, displacements = {}, run.curve.tangential_displacement
    for state in states:
        row = row_of(state, run.curve)
        moves = np.trim_zeros(np.diff(displacements[: row + 1], prepend=0.0))
        zones[state] = run.curve.stick_radius[row], displacements[row], int(np.sign(moves[-1:]).sum())
    return zones


def _marks(run: Run, radii: Mapping[str, ContactRadius]) -> dict[str, dict[str, float]]:
    """Return the contact radius and, of a tangential experiment, the stick radius [LU] by state and name in a legend.

    The contact radius is that on the body: half of the image's where this stands for two equal spheres.
    """
    wider = image_ratio(run.scene)
    sticks = _zones(run, radii) if run.scene.experiment.goes_along else {}
    return {
        state: {CONTACT_RADIUS: radius.value / wider} | ({"stick radius c": sticks[state][0]} if sticks else {})
        for state, radius in radii.items()
    }


def _body_theory(run: Run, marks: Mapping[str, Mapping[str, float]]) -> dict[str, figures.Theory]:
    """Return {state: (name, r [LU], p [FU/LU²])} of the first closed form of the pressure, compression positive.

    The state is the first reported one that touches, r from just above 0 to just inside its contact radius, (300,)
    each. {} where no closed form applies, or no reported state is in `marks`.

    `marks`: by state the radii by name [LU], of which the contact radius is needed.
    """
    case = Case(run.scene, run.results)
    for state in (name for name in REPORTED if name in marks):
        for form in applying(case):
            if form.pressure is not None:
                r = marks[state][CONTACT_RADIUS] * np.sin(np.linspace(0.005, 0.4999 * np.pi, 300))
                return {state: (form.name, r, form.pressure(case, r))}
    return {}


def _mindlin(run: Run) -> list[Series]:
    """Return a list of F_x of Cattaneo and Mindlin [FU] over u [LU] along the path, fifty points for each load step.

    Empty where they do not apply: to anything but a paraboloid with friction under a constant load.
    """
    case, u = Case(run.scene, run.results), run.friction["tangential_displacement"]
    if not drawn_along(case):
        return []
    steps = u.size - 1
    dense = np.interp(np.linspace(0.0, steps, 1 + 50 * steps), range(u.size), u)
    force = mindlin_path(dense.tolist(), *sliding_contact(case)[:3])
    return figures.lines(("Cattaneo–Mindlin", dense, np.asarray(force)))


def _theory(run: Run) -> list[tuple[str, Array, Array, Array]]:
    """Return a list of the one (name, a [LU], d [LU], F [FU]) of the body's closed form, (400,), compression positive.

    Empty where there is none. For two chains without a closed form it is JKR's with the run's own F_A and a₀. The image
    x²/2R₁ on springs E* per length is the contact of R = 2R₁; its a₀ is twice that of the two spheres. JKR is drawn up
    to 1.3 a₀, on a plane from the radius at which fixed grips separate; Hertz and others without adhesion from a = 0 to
    the largest displacement of the run.
    """
    scene, half, case, pull_off = run.scene, run.scene.bodies.plane_radius, Case(run.scene, run.results), _pull_off(run)
    radius, work, forms = 2.0 * (half or 0.0), scene.work_of_adhesion, applying(case)
    body: PowerLaw | Ellipsoid
    if not {"pressed", "interaction"} & {*case.law.closed_forms}:  # no curve of a law without closed forms
        return []
    if half is not None:
        name = "JKR" if work else "Hertz"
        body = PowerLaw.sphere(radius, scene.bulk_stiffness / scene.bodies.spacing, work)
    elif forms and case.kind != "flat_punch":
        name, body = forms[0].name, case.body
    else:
        return []
    largest = 1.3
    if work:
        ends = body.fixed_grips_radius(), largest * body.zero_load_radius()
    elif pull_off is not None:
        force, a_0 = pull_off
        name, ends = "JKR, same $F_A$ and $a_0$", (0.05 * a_0, largest * a_0)
        body = PowerLaw.sphere(radius, 3.0 * force * radius / a_0**3, force / (1.5 * pi * radius))
    elif not scene.interaction:
        ends = 0.0, body.radius_at(max(float(run.curve.displacement.max()), 0.0))
    else:
        return []
    return [(name, *body.curve(*ends))]
