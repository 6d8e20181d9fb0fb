"""Figures of a run, drawn as the paper's: pressure profile (Fig. 4), force over displacement and over radius (Fig. 8).

References in them: JKR, F̃ = 4ã³ − 4ã^{3/2} (Eq. 8); Barquins' cylinder, F̃ = 2.1165 (ã² − √ã). Both are scaled on the
run's own F_A and a₀, so that only the shapes are compared. Each drawing function returns its figure. A theory is its
name with the values along x and y.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import Columns
from contact1d.analysis.plots import (
    COMPRESSION,
    LOADING,
    TENSION,
    THEORY,
    UNLOADING,
    Array,
    beside,
    describe,
    legend,
    mark,
    panels,
)
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import moved_centre

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

BARQUINS = 4.0 ** (4.0 / 3.0) / 3.0
"""2.1165: makes the minimum of BARQUINS (ã² − √ã), at ã = 4^(−2/3) = 0.397, equal to −1: the 2D
cylinder of M. Barquins, J. Adhesion 26 (1988) 1."""
Theory = tuple[str, Array, Array]
State = TypeVar("State")
Legs = Sequence[tuple[str, NDArray[np.int64]]]
"""Of a path: the name of each leg's branch, and its rows of the curve."""
STICKS, SLIPS = COMPRESSION, TENSION
BEFORE = "#bbbbbb"
"""Of what is not measured yet: a contact that forgets its start."""
SEPARATION_SHARE = 1e-3
"""Largest pressure over that of the other states below which a state is not drawn: the bodies are apart."""
FEW = 25
"""Up to so many points a leg shows where they are: a line through one point would be invisible."""
SHOWN_SHARE = 0.01
"""Pressure over the largest one that a figure still shows."""
VIEW = 2.0
"""Largest contact radius that is shown, over itself: beyond is only the tail of an attraction."""
CLEAR = 8.0
"""Largest pressure that is shown over that at a third of the contact radius: a pole at the edge would hide the rest."""
BEYOND = 1.15
"""Half-width of what is shown over that of the contact."""


def pressure_figure(profiles: Mapping[str, Profile], radii: Mapping[str, float]) -> Figure:
    """Pressure over x of each state that has any, one panel below the other, with ±a marked (the paper's Fig. 4)."""
    profiles = _touching(profiles, {name: profile.pressure for name, profile in profiles.items()})
    figure, axes = panels(len(profiles), 1.0 + 2.3 * len(profiles))
    half = max(_half_width(profile) for profile in profiles.values())
    for axis, (name, profile) in zip(axes, profiles.items(), strict=True):
        view = np.abs(profile.x) <= half
        pressure = profile.pressure[view]
        for colour, part in ((COMPRESSION, np.maximum(pressure, 0.0)), (TENSION, np.minimum(pressure, 0.0))):
            axis.fill_between(profile.x[view], part, color=colour, linewidth=0.0, step="mid")
        radius, centre, marked = radii.get(name, math.nan), moved_centre(profile), ""
        if radius > 0.0:
            mark(axis, centre - radius, centre + radius)
            marked = f", contact radius a = {radius:.4g} LU (dashed)"
        describe(axis, y="line load (FU/LU)", title=_state(name) + marked)
        axis.set_ylim(min(1.15 * float(pressure.min()), 0.0), max(1.15 * float(pressure.max()), 0.0) or 1e-12)
        if not np.any(pressure):
            axis.set_yticks([0.0])
            axis.text(0.5, 0.5, "no contact", transform=axis.transAxes, ha="center", color=THEORY)
    axes[0].set_xlim(-half, half)
    axes[-1].set_xlabel("x (LU)")
    return figure


def _touching(states: Mapping[str, State], pressures: Mapping[str, Array]) -> dict[str, State]:
    """The states with a pressure that is more than round-off, or a trace of the others'; of none the first."""
    largest = {name: float(np.abs(p[np.isfinite(p)]).max(initial=0.0)) for name, p in pressures.items()}
    least = SEPARATION_SHARE * max(largest.values())
    return {name: state for name, state in states.items() if largest[name] > least} or dict([*states.items()][:1])


def force_displacement_figure(
    curve: Columns, legs: Legs, adhesion: tuple[float, float] | None = None, theory: Theory | None = None
) -> Figure:
    """Force over displacement, leg by leg; beside it a theory, and F_A with its uncertainty."""
    figure, (axis,) = panels()
    displacement, force = curve.displacement, curve.force
    named: set[str] = set()
    for branch, rows in legs:
        colour, width = (LOADING, 3.2) if branch == "loading" else (UNLOADING, 1.4)
        look = {"color": colour, "linewidth": width, "label": _once(branch, named)}
        _line(axis, displacement[rows], force[rows], theory is None, **look)
    if theory is not None:
        name, d, f = theory
        shown = (d >= displacement.min()) & (f <= force.max() + 0.05 * np.ptp(force))
        beside(axis, (name, d[shown], f[shown]))
    describe(axis, "displacement (LU), compression positive", "force (FU), compression positive")
    if adhesion is not None:
        tension, spread = adhesion
        axis.axhspan(-tension - spread, -tension + spread, color=TENSION, alpha=0.3, linewidth=0.0)
        axis.axhline(-tension, color=TENSION, linewidth=1.0, linestyle=":", label=f"$F_A$ = {tension:.4g} FU")
    axis.margins(y=0.09)
    legend(axis, "upper left", None)
    return figure


def force_radius_figure(curve: Columns, adhesion_force: float, zero_load_radius: float) -> Figure:
    """F/F_A over a/a₀ of the unloading branch beside JKR and Barquins (the paper's Fig. 8)."""
    figure, (axis,) = panels()
    radius, force = curve.contact_radius / zero_load_radius, curve.force / adhesion_force
    chosen = (curve.branch == "unloading") & np.isfinite(radius) & (radius > 0.0)
    top = max(1.3, 1.05 * float(radius[chosen].max(initial=0.0)))
    a = np.linspace(0.0, top, 400)
    beside(axis, ("JKR", a, 4.0 * a**3 - 4.0 * a**1.5), "-", 1.6)
    beside(axis, ("Barquins (2D)", a, BARQUINS * (a**2 - np.sqrt(a))), width=1.2)
    spread = curve.contact_radius_uncertainty[chosen] / zero_load_radius
    _points(axis, radius[chosen], force[chosen], spread, "this run, unloading", UNLOADING)
    describe(axis, r"contact radius $a/a_0$", r"force $F/F_A$, compression positive")
    axis.set_xlim(0.0, top)
    axis.set_ylim(-1.25, max(1.0, 1.1 * float(force[chosen].max(initial=0.0))))
    legend(axis, "upper left", None)
    return figure


def load_radius_figure(curve: Columns, theory: Theory | None = None) -> Figure:
    """Force over contact radius of the states that touch; beside it a theory."""
    figure, (axis,) = panels()
    touching = curve.contact_radius > 0.0
    for branch in dict.fromkeys(curve.branch[touching].tolist()):
        chosen = touching & (curve.branch == branch)
        radius, spread = curve.contact_radius[chosen], curve.contact_radius_uncertainty[chosen]
        _points(axis, radius, curve.force[chosen], spread, branch, LOADING if branch == "loading" else UNLOADING)
    if theory is not None:
        beside(axis, theory, "-")
    describe(axis, "contact radius (LU)", "force (FU), compression positive")
    axis.set_xlim(left=0.0)
    legend(axis, "upper left", None)
    return figure


def friction_figure(columns: Mapping[str, Sequence[float] | Array]) -> Figure:
    """Friction over the way of the drive, and the normal force below it."""
    figure, (upper, lower) = panels(2, height_ratios=(2, 1))
    upper.plot(columns["drive"], columns["friction"], color=COMPRESSION, linewidth=1.2)
    describe(upper, y="friction (FU)")
    lower.plot(columns["drive"], columns["normal_force"], color=TENSION, linewidth=1.2)
    describe(lower, "displacement of the drive (LU)", "normal force (FU)", zero=False)
    return figure


def detachments_figure(forces: Array) -> Figure:
    """How often the bodies parted at a tension [FU], their mean with its standard error; shape (pulls,)."""
    figure, (axis,) = panels()
    mean, error = float(forces.mean()), float(forces.std(ddof=1)) / math.sqrt(forces.size)
    bins = max(4, round(2.0 * forces.size ** (1.0 / 3.0)))  # Rice's rule
    axis.hist(forces, bins, color=LOADING, edgecolor="white")
    axis.axvspan(mean - error, mean + error, color=TENSION, alpha=0.3, linewidth=0.0)
    axis.axvline(mean, color=TENSION, linewidth=1.2, label=f"mean of {forces.size} repeats, standard error")
    axis.locator_params(axis="y", integer=True)
    describe(axis, "detachment force (FU)", "pulls", zero=False)
    legend(axis)
    return figure


def samples_figure(columns: Mapping[str, Array], measured: NDArray[np.bool_], mean: float | None = None) -> Figure:
    """Displacement and force over time, what comes before the measurement in grey; the load beside the force.

    Args:
        columns: of samples.csv, `time` [TU], `displacement` [LU], `force` and `load` [FU].
        measured: which rows are.
        mean: of the displacement [LU], where it is a result.
    """
    figure, (upper, lower) = panels(2)
    time = columns["time"]
    for axis, name, unit in ((upper, "displacement", "LU"), (lower, "force", "FU")):
        axis.plot(time[~measured], columns[name][~measured], ".", color=BEFORE, markersize=3)
        axis.plot(time[measured], columns[name][measured], ".-", color=COMPRESSION, markersize=3, linewidth=0.6)
        describe(axis, y=f"{name} ({unit})", zero=False)
    lower.plot(time, columns["load"], color=TENSION, linewidth=1.2, label="load")
    legend(lower)
    if mean is not None:
        upper.axhline(mean, color=TENSION, linewidth=1.2, label="mean")
        legend(upper)
    if not measured.all():
        upper.set_title("grey: run-in", loc="left", fontsize=9, color=THEORY)
    lower.set_xlabel("time (TU)")
    return figure


def body_pressure_figure(
    pressures: Mapping[str, tuple[Array, Array, Array, float]], theories: Mapping[str, Theory]
) -> Figure:
    """p over r of each state, one panel below the other, the closed form beside it.

    Args:
        pressures: r [LU], p and its uncertainty [FU/LU²], and the contact radius [LU] by state.
        theories: by state.
    """
    pressures = _touching(pressures, {name: p for name, (_, p, *_) in pressures.items()})
    figure, axes = panels(len(pressures), 1.2 + 2.6 * len(pressures))
    for axis, (name, (r, p, spread, edge)) in zip(axes, pressures.items(), strict=True):
        shown = np.isfinite(p)
        axis.fill_between(r, p - spread, p + spread, color=COMPRESSION, alpha=0.3, linewidth=0.0)
        axis.plot(r[shown], p[shown], "o", color=COMPRESSION, markersize=3.5, label="this run")
        if name in theories:
            beside(axis, theories[name], "-")
        describe(axis, y="pressure (FU/LU²)", title=_state(name))
        mark(axis, edge, colour=TENSION, label=f"contact radius a = {edge:.4g} LU")
        inner = p[shown & (r <= max(edge / 3.0, r[min(2, r.size - 1)]))]
        top = CLEAR * float(np.abs(inner).max(initial=0.0)) or 1e-12
        axis.set_ylim(max(1.1 * min(float(p[shown].min()), 0.0), -top), min(1.1 * max(float(p[shown].max()), 0.0), top))
        legend(axis)
    axes[-1].set_xlabel("distance from the axis r (LU)")
    widest = max(edge for *_, edge in pressures.values())
    farthest = max(float(r.max()) for r, *_ in pressures.values())
    axes[-1].set_xlim(0.0, 1.05 * min(max(farthest, widest), VIEW * widest))
    return figure


def tangential_figure(columns: Columns, legs: Legs, theory: Array | None = None) -> Figure:
    """F_x over u, leg by leg, and beside it a theory's F_x along the path; the normal force below where it changes.

    Args:
        columns: of curve.csv, `tangential_displacement`, `tangential_force`, `normal_force`.
        legs: of the path, "forward" or "backward".
        theory: u [LU] and F_x [FU] of Cattaneo and Mindlin along the path, (2, n).
    """
    u, force, load = columns.tangential_displacement, columns.tangential_force, columns.normal_force
    varies = float(np.ptp(load)) > 1e-9 * float(np.max(np.abs(load)))
    figure, axes = panels(1 + varies, height_ratios=(2, 1)[: 1 + varies])
    axis = axes[0]
    named: set[str] = set()
    for branch, rows in legs:
        colour = LOADING if branch == "forward" else TENSION
        _line(axis, u[rows], force[rows], theory is None, color=colour, linewidth=2.6, label=_once(branch, named))
    if theory is not None:
        beside(axis, ("Cattaneo–Mindlin", *theory))
    describe(axis, y="tangential force (FU)")
    axis.margins(y=0.09)
    legend(axis, size=None)
    if varies:
        axes[1].plot(u, load, color=SLIPS, linewidth=1.4)
        describe(axes[1], y="normal force (FU)", zero=False)
    axes[-1].set_xlabel("tangential displacement (LU)")
    return figure


def body_shear_figure(states: Mapping[str, tuple[Array, Array, Array, float, float]]) -> Figure:
    """Shear traction over the distance from the axis of the body of three dimensions, mirrored at the axis.

    Args:
        states: by name r [LU], q(r) and its uncertainty [FU/LU²], contact and stick radius [LU].
    """
    figure, (axis,) = panels()
    for (name, (r, shear, spread, edge, stick)), colour in zip(states.items(), (TENSION, COMPRESSION), strict=False):
        both, values, band = (
            np.concatenate([c * part[::-1], part]) for c, part in ((-1.0, r), (1.0, shear), (1.0, spread))
        )
        axis.fill_between(both, values - band, values + band, color=colour, alpha=0.3, linewidth=0.0)
        axis.plot(both, values, color=colour, linewidth=1.8, label=_state(name))
        if 0.0 < stick < edge:
            mark(axis, -stick, stick, colour=colour)
    describe(axis, "r (LU); dashed: stick radius", "shear traction (FU/LU²)")
    axis.margins(y=0.09)
    legend(axis, size=None)
    return figure


def stick_slip_figure(states: Mapping[str, tuple[Profile, Array, float, float]], coefficient: float) -> Figure:
    """Shear traction over x of each state between ±μp, the particles that stick and those that slip in two colours.

    Args:
        states: by name the profile, the rest of μp of each particle [FU/LU], (n,), 0 where it slips, the half-width
            of the zone that sticks [LU], and the place of the body along x [LU].
        coefficient: μ.
    """
    figure, axes = panels(len(states), 1.0 + 2.3 * len(states))
    half = 0.0
    for axis, (name, (profile, sticking, radius, place)) in zip(axes, states.items(), strict=True):
        x, touched = profile.x, profile.pressure > 0.0
        limit = coefficient * np.maximum(profile.pressure, 0.0)
        for zone, colour, label in ((sticking > 0.0, STICKS, "sticks"), (sticking == 0.0, SLIPS, "slips")):
            chosen = touched & zone
            axis.vlines(x[chosen], 0.0, -profile.shear[chosen], color=colour, linewidth=2.0, label=label)
        beside(axis, ("±μp", x, limit), width=1.2)
        axis.plot(x, -limit, "--", color=THEORY, linewidth=1.2)
        marked = f", stick radius c = {radius:.4g} LU (shaded)" if radius > 0.0 else ""
        describe(axis, y="shear (FU/LU)", title=f"{_state(name)}, u = {place:.4g} LU{marked}")
        if marked:
            axis.axvspan(-radius, radius, color=STICKS, alpha=0.08, linewidth=0.0)
        half = max(half, float(np.abs(x[touched] if touched.any() else x).max()), float(x[1] - x[0]))
        legend(axis, "upper right", 8)
    axes[-1].set_xlim(-BEYOND * half, BEYOND * half)
    axes[-1].set_xlabel("x from the middle of the body (LU)")
    return figure


def _state(name: str) -> str:
    return f"{name.replace('_', ' ')} state"


def _once(name: str, named: set[str]) -> str | None:
    """The name where it was not given before: a legend has each once."""
    first = name not in named
    named.add(name)
    return name if first else None


def _line(axis: Axes, x: Array, y: Array, joined: bool, **look: Any) -> None:
    """A line; where the points are few these are drawn, and joined only if no theory shows what is between them."""
    few = len(x) <= FEW
    axis.plot(x, y, linestyle="-" if joined or not few else "none", marker="o" if few else "", markersize=4, **look)


def _points(axis: Axes, x: Array, y: Array, spread: Array, label: str, colour: str) -> None:
    """Points with the uncertainty of x."""
    axis.hlines(y, x - spread, x + spread, color=colour, alpha=0.3)
    axis.plot(x, y, "o", markersize=3.5, color=colour, label=label)


def _half_width(profile: Profile) -> float:
    size = np.abs(profile.pressure)
    shown = size > SHOWN_SHARE * float(size.max(initial=0.0))
    reach = float(np.abs(profile.x[shown]).max()) if shown.any() else float(np.abs(profile.x).max())
    return min(1.15 * reach + 2.0 * float(np.median(np.diff(profile.x))), float(np.abs(profile.x).max()) + 1.0)
