"""Figures of a run, drawn as the paper's: pressure profile (Fig. 4), force over displacement and over radius (Fig. 8).

References in them: JKR, F̃ = 4ã³ − 4ã^{3/2} (Eq. 8); Barquins' cylinder, F̃ = 2.1165 (ã² − √ã). Both are scaled on the
run's own F_A and a₀, so that only the shapes are compared. Each drawing function returns its figure.
"""

from __future__ import annotations

import io
import math
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import Curve
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import moved_centre
from contact1d.analysis.theory.curves import barquins_reduced_force, jkr_reduced_force
from contact1d.files import whole

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
COMPRESSION, TENSION, LOADING, UNLOADING, THEORY = "#0072B2", "#D55E00", "#56B4E9", "#0072B2", "#555555"
"""Okabe and Ito's colours, which the colour-blind can tell apart."""
SIZE = (6.4, 4.2)
DPI = 120
SEPARATION_SHARE = 1e-3
"""Largest pressure over that of the other states below which a state is not drawn: the bodies are apart."""
FEW_ROWS = 20
"""Below this many rows a branch also shows where they are: a line through one row would be invisible."""
SHOWN_SHARE = 0.01
"""Pressure over the largest one that a figure still shows."""


def pressure_figure(profiles: Mapping[str, Profile], radii: Mapping[str, float]) -> Figure:
    """Pressure over x of each state that has any, one panel below the other, with ±a marked (the paper's Fig. 4)."""
    touching = {name: profile for name, profile in profiles.items() if _touches(profile, profiles)}
    profiles = touching or dict(list(profiles.items())[:1])
    figure = new_figure((SIZE[0], 1.0 + 2.3 * len(profiles)))
    axes = figure.subplots(len(profiles), 1, sharex=True, squeeze=False)[:, 0]
    half = max(_half_width(profile) for profile in profiles.values())
    for axis, (name, profile) in zip(axes, profiles.items(), strict=True):
        view = np.abs(profile.x) <= half
        x, pressure = profile.x[view], profile.pressure[view]
        width = 0.8 * float(np.median(np.diff(profile.x)))
        _draw_bars(axis, x, pressure, width)
        axis.axhline(0.0, color="black", linewidth=0.8)
        axis.set_ylabel("line load (FU/LU)")
        marked = _mark_radius(axis, radii.get(name, math.nan), moved_centre(profile))
        axis.set_title(f"{name.replace('_', ' ')} state{marked}", loc="left", fontsize=10)
        axis.set_ylim(min(1.15 * float(pressure.min()), 0.0), max(1.15 * float(pressure.max()), 0.0) or 1e-12)
        if not np.any(pressure):
            axis.set_yticks([0.0])
            axis.text(0.5, 0.5, "no contact", transform=axis.transAxes, ha="center", color=THEORY)
    axes[0].set_xlim(-half, half)
    axes[-1].set_xlabel("x (LU)")
    return figure


def force_displacement_figure(
    curve: Curve, marks: Mapping[str, float], theory: tuple[str, Array, Array] | None = None
) -> Figure:
    """Force over displacement, loading and unloading; beside it a theory: its name, displacement and force."""
    figure = new_figure(SIZE)
    axis = figure.subplots()
    displacement, force = curve.displacement, curve.force
    for branch, colour, style in (("loading", LOADING, "-"), ("unloading", UNLOADING, "-")):
        chosen = curve.branch == branch
        if chosen.any():
            order = np.argsort(displacement[chosen], kind="stable")
            d, f = displacement[chosen][order], force[chosen][order]
            wide = 3.2 if branch == "loading" else 1.4
            marker = "o" if len(d) < FEW_ROWS else ""
            axis.plot(d, f, style, marker=marker, markersize=4, color=colour, linewidth=wide, label=branch)
    if theory is not None:
        name, d, f = theory
        shown = (d >= displacement.min()) & (f <= force.max() + 0.05 * np.ptp(force))
        axis.plot(d[shown], f[shown], "--", color=THEORY, linewidth=1.4, label=name)
    axis.axhline(0.0, color="black", linewidth=0.8)
    adhesion = marks.get("adhesion_force")
    if adhesion:
        axis.axhline(-adhesion, color=TENSION, linewidth=1.0, linestyle=":")
        axis.annotate(
            f"$-F_A$ = \N{MINUS SIGN}{adhesion:.4g} FU", (0.0, -adhesion), xycoords=("axes fraction", "data"),
            xytext=(6, -4), textcoords="offset points", ha="left", va="top", color=TENSION,
        )  # fmt: skip
    axis.set_xlabel("displacement (LU), compression positive")
    axis.margins(y=0.09)
    axis.set_ylabel("force (FU), compression positive")
    axis.legend(frameon=False, loc="upper left")
    return figure


def force_radius_figure(curve: Curve, adhesion_force: float, zero_load_radius: float) -> Figure:
    """F/F_A over a/a₀ of the unloading branch beside JKR and Barquins (the paper's Fig. 8)."""
    figure = new_figure(SIZE)
    axis = figure.subplots()
    radius = curve.contact_radius / zero_load_radius
    force = curve.force / adhesion_force
    chosen = (curve.branch == "unloading") & np.isfinite(radius) & (radius > 0.0)
    top = max(1.3, 1.05 * float(radius[chosen].max(initial=0.0)))
    a = np.linspace(0.0, top, 400)
    axis.plot(a, jkr_reduced_force(a), "-", color=THEORY, linewidth=1.6, label="JKR")
    axis.plot(a, barquins_reduced_force(a), "--", color=THEORY, linewidth=1.2, label="Barquins (2D)")
    axis.plot(radius[chosen], force[chosen], "o", color=UNLOADING, markersize=3.5, label="this run, unloading")
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlim(0.0, top)
    axis.set_ylim(-1.25, max(1.0, 1.1 * float(force[chosen].max(initial=0.0))))
    axis.set_xlabel(r"contact radius $a/a_0$")
    axis.set_ylabel(r"force $F/F_A$, compression positive")
    axis.legend(frameon=False, loc="upper left")
    return figure


def load_radius_figure(curve: Curve, theory: tuple[str, Array, Array] | None = None) -> Figure:
    """Force over contact radius of the states that touch; beside it a theory: its name, radius and force."""
    figure = new_figure(SIZE)
    axis = figure.subplots()
    touching = curve.contact_radius > 0.0
    for branch in dict.fromkeys(curve.branch[touching].tolist()):
        chosen = touching & (curve.branch == branch)
        axis.plot(curve.contact_radius[chosen], curve.force[chosen], "o", markersize=3.5, label=branch)
    if theory is not None:
        name, radius, force = theory
        axis.plot(radius, force, "-", color=THEORY, linewidth=1.4, zorder=0, label=name)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlim(left=0.0)
    axis.set_xlabel("contact radius (LU)")
    axis.set_ylabel("force (FU), compression positive")
    axis.legend(frameon=False, loc="upper left")
    return figure


def friction_figure(columns: Mapping[str, Sequence[float] | Array]) -> Figure:
    """Friction over the way of the drive, and the normal force below it."""
    figure = new_figure(SIZE)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    upper.plot(columns["drive"], columns["friction"], color=COMPRESSION, linewidth=1.2)
    upper.axhline(0.0, color="black", linewidth=0.8)
    upper.set_ylabel("friction (FU)")
    lower.plot(columns["drive"], columns["normal_force"], color=TENSION, linewidth=1.2)
    lower.set_ylabel("normal force (FU)")
    lower.set_xlabel("way of the drive (LU)")
    return figure


def detachments_figure(forces: Array) -> Figure:
    """How often the bodies parted at a tension [FU], their mean with its standard error; shape (pulls,)."""
    figure = new_figure(SIZE)
    axis = figure.subplots()
    mean, error = float(forces.mean()), float(forces.std(ddof=1)) / math.sqrt(forces.size)
    bins = max(4, round(2.0 * forces.size ** (1.0 / 3.0)))  # Rice's rule
    axis.hist(forces, bins, color=LOADING, edgecolor="white")
    axis.axvspan(mean - error, mean + error, color=TENSION, alpha=0.3, linewidth=0.0)
    axis.axvline(mean, color=TENSION, linewidth=1.2, label=f"mean of {forces.size} pulls, standard error")
    axis.locator_params(axis="y", integer=True)
    axis.set_xlabel("detachment force (FU)")
    axis.set_ylabel("pulls")
    axis.legend(frameon=False, fontsize=9)
    return figure


def new_figure(size: tuple[float, float]) -> Figure:
    """Return an empty figure of that size [inch], without the state that pyplot keeps; a notebook shows it."""
    return _figure_class()(figsize=size, dpi=DPI, layout="constrained")


@cache
def _figure_class() -> type[Figure]:
    from matplotlib.figure import Figure

    class ShownFigure(Figure):
        def _repr_png_(self) -> bytes:
            """A notebook asks for it; a plain Figure is shown only where pyplot was imported."""
            shown = io.BytesIO()
            self.savefig(shown, format="png")
            return shown.getvalue()

    return ShownFigure


def plain_axes(figure: Figure) -> Figure:
    """Take away the lines above and to the right of each axis; returns the figure."""
    for axis in figure.axes:
        axis.spines[["top", "right"]].set_visible(False)
    return figure


def save_figure(figure: Figure, path: Path) -> None:
    """Save in the format that the name ends on (png, svg, pdf), whole or not at all."""
    plain_axes(figure)
    with whole(path) as part:
        figure.savefig(part, format=path.suffix[1:])


def _draw_bars(axis: Axes, x: Array, height: Array, width: float) -> None:
    """Bars coloured by sign, as one artist: `Axes.bar` makes one per bar, which takes four times as long."""
    from matplotlib.collections import PolyCollection

    left, right, zero = x - 0.5 * width, x + 0.5 * width, np.zeros_like(x)
    corners = np.stack([np.stack([left, left, right, right]), np.stack([zero, height, height, zero])]).T
    colours = np.where(height >= 0.0, COMPRESSION, TENSION).tolist()
    axis.add_collection(PolyCollection(list(corners), facecolors=colours, linewidths=0.0))


def _touches(profile: Profile, profiles: Mapping[str, Profile]) -> bool:
    """Whether a state's pressure is more than the far tail of a separated pair, beside the other states'."""
    largest = max(float(np.abs(other.pressure).max(initial=0.0)) for other in profiles.values())
    return float(np.abs(profile.pressure).max(initial=0.0)) > SEPARATION_SHARE * largest


def _half_width(profile: Profile) -> float:
    size = np.abs(profile.pressure)
    shown = size > SHOWN_SHARE * float(size.max(initial=0.0))
    reach = float(np.abs(profile.x[shown]).max()) if shown.any() else float(np.abs(profile.x).max())
    return min(1.15 * reach + 2.0 * float(np.median(np.diff(profile.x))), float(np.abs(profile.x).max()) + 1.0)


def _mark_radius(axis: Axes, radius: float, centre: float) -> str:
    """Draw ±a around the contact's centre and return what the title says of it."""
    if not math.isfinite(radius) or radius <= 0.0:
        return ""
    for place in (centre - radius, centre + radius):
        axis.axvline(place, color="black", linewidth=1.0, linestyle="--")
    return f", contact radius a = {radius:.4g} LU (dashed)"
