"""Figures of the studies, drawn as the paper's where it has one."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from contact1d.analysis.plots import THEORY, new_figure
from contact1d.analysis.theory.jkr import jkr_reduced_force
from contact1d.analysis.theory.line_adhesion import barquins_reduced_force, brittle_reduced_force
from validation.judging.figures import COLOURS, MARKERS, Array, Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDE = (9.2, 4.0)


@dataclass(frozen=True)
class ReductionPanel:
    """What the figure of Section 2 shows of one reduction: F(d) with Hertz's in SI, error over spacing/half-width."""

    name: str
    displacement: Array
    force: Array
    hertz: Array
    spacing: Array
    error: Array


def reductions_figure(panels: Sequence[ReductionPanel]) -> Figure:
    """Force over displacement, and its error over the spacing."""
    figure = new_figure(WIDE)
    left, right = figure.subplots(1, 2)
    for panel, colour, marker in zip(panels, COLOURS, MARKERS, strict=False):
        left.loglog(1e9 * panel.displacement, 1e6 * panel.hertz, "-", color=colour, linewidth=1.2)
        left.loglog(1e9 * panel.displacement, 1e6 * panel.force, marker, color=colour, label=panel.name)
        right.loglog(panel.spacing, panel.error, marker + "-", color=colour, label=panel.name, linewidth=0.8)
    ends = np.array([panels[0].spacing.min(), panels[0].spacing.max()])
    right.loglog(ends, 0.5 * ends**2, "--", color=THEORY, label="square of the spacing")
    left.set_xlabel("displacement (nm)")
    left.set_ylabel("force (µN); lines: Hertz")
    right.set_xticks(panels[0].spacing, [f"1/{1.0 / spacing:.0f}" for spacing in panels[0].spacing])
    right.minorticks_off()
    right.set_xlabel("spacing over half-width")
    right.set_ylabel("error of the force")
    for axis in (left, right):
        axis.legend(frameon=False)
    return figure


def slip_figure(forces: Sequence[Series], sticking: Sequence[Series], theory: tuple[Series, Series]) -> Figure:
    """F_x over the way out and around a loop, and the stick radius on the way out, each beside its theory."""
    figure = new_figure(WIDE)
    axes = figure.subplots(1, 2)
    for axis, series, line in zip(axes, (forces, sticking), theory, strict=True):
        axis.plot(line.x, line.y, "-", color=THEORY, linewidth=1.2, label=line.name)
        for i, (one, colour, marker) in enumerate(zip(series, COLOURS, MARKERS, strict=False)):
            every = slice(i, None, len(series))  # all lie on one line: each shows its own part of it
            axis.plot(one.x[every], one.y[every], marker, color=colour, label=one.name, markersize=5, fillstyle="none")
        axis.set_xlabel("displacement over $u^*$")
    axes[0].axhline(0.0, color="black", linewidth=0.8)
    axes[0].set_ylabel(r"$F_x/\mu N$")
    axes[1].set_ylabel("stick radius over contact radius")
    axes[1].legend(frameon=False, loc="lower left", fontsize=9)
    return figure


def heat_figure(
    points: Sequence[Series], solved: Sequence[Series], moving: Sequence[Series], laws: Sequence[Series], still: float
) -> Figure:
    """⟨F⟩/F_max over velocity, by temperature: runs, Smoluchowski, ensemble, textbook; `still`: slow, without heat."""
    figure = new_figure((6.4, 4.6))
    axis = figure.subplots()
    for one, line, copies, law, colour, marker in zip(points, solved, moving, laws, COLOURS, MARKERS, strict=False):
        axis.errorbar(one.x, one.y, one.spread, fmt=marker, color=colour, label=one.name, capsize=3, fillstyle="none")
        axis.plot(line.x, line.y, "-", color=colour, linewidth=1.2)
        axis.plot(copies.x, copies.y, "x", color=colour, markersize=8)
        axis.plot(law.x, law.y, "--", color=colour, linewidth=1.0)
    axis.axhline(still, color=THEORY, linewidth=1.0, linestyle=":", label="slow, without heat")
    axis.plot([], [], "-", color=THEORY, label="Smoluchowski")
    axis.plot([], [], "x", color=THEORY, label="ensemble of equations of motion")
    axis.plot([], [], "--", color=THEORY, label=r"$(\ln v)^{2/3}$")
    axis.set_xscale("log")
    axis.set_ylim(0.0, None)
    axis.set_xlabel("velocity (LU/TU)")
    axis.set_ylabel(r"mean friction over $F_{max}$")
    axis.legend(frameon=False, fontsize=9)
    return figure


def detachment_figure(runs: Series, theory: Series, closed: Series, most: float) -> Figure:
    """Detachment force over the loading rate: runs, Smoluchowski with its spread, Garg, and F_A(T), `most` [FU]."""
    figure = new_figure((6.4, 4.4))
    axis = figure.subplots()
    spread = theory.y * 0.0 if theory.spread is None else theory.spread
    axis.fill_between(theory.x, theory.y - spread, theory.y + spread, color=COLOURS[0], alpha=0.15, linewidth=0.0)
    axis.plot(theory.x, theory.y, "-", color=COLOURS[0], linewidth=1.2, label=theory.name)
    axis.plot(closed.x, closed.y, "--", color=THEORY, linewidth=1.2, label=closed.name)
    axis.errorbar(runs.x, runs.y, runs.spread, fmt="o", color="black", capsize=3, fillstyle="none", label=runs.name)
    axis.axhline(most, color=THEORY, linewidth=1.0, linestyle=":", label="$F_A(T)$")
    axis.set_xscale("log")
    axis.set_ylim(0.0, None)
    axis.set_xlabel("loading rate (FU/TU)")
    axis.set_ylabel("detachment force (FU)")
    axis.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def history_figure(force: Sequence[Series], radius: Sequence[Series], limit: float) -> Figure:
    """F_A and a_cr over the preload, each over its mean (Fig. 6); `limit`: preload at which chains slip past."""
    figure = new_figure(WIDE)
    axes = figure.subplots(1, 2)
    for axis, series, name in zip(axes, (force, radius), (r"$F_A/\bar F_A$", r"$a_{cr}/\bar a_{cr}$"), strict=True):
        for one, colour, marker in zip(series, COLOURS, MARKERS, strict=False):
            axis.plot(one.x, one.y, marker, color=colour, label=one.name, markersize=6, fillstyle="none")
        axis.axvline(limit, color=THEORY, linewidth=1.0, linestyle=":")
        axis.set_xlabel("preload $F_D$ (FU)")
        axis.set_ylabel(name)
        axis.set_ylim(0.9, 1.1)
    axes[0].legend(frameon=False, loc="lower left", fontsize=9)
    axes[1].text(limit, 1.09, " chains slip past\n each other ", ha="right", va="top", fontsize=9, color=THEORY)
    return figure


def scaling_figure(force: Sequence[Series], radius: Sequence[Series]) -> Figure:
    """F_A and a₀ over R, log-log (Fig. 7), with lines of the exponents of JKR, Barquins and of the model."""
    figure = new_figure(WIDE)
    axes = figure.subplots(1, 2)
    slopes = ({"JKR, 1": 1.0, "Barquins, 1/3": 1.0 / 3.0}, {"JKR and Barquins, 2/3": 2.0 / 3.0})
    for axis, series, lines, name in zip(
        axes, (force, radius), slopes, ("adhesion force $F_A$ (FU)", "zero-load radius $a_0$ (LU)"), strict=True
    ):
        for one, colour, marker in zip(series, COLOURS, MARKERS, strict=False):
            axis.loglog(one.x, one.y, marker, color=colour, label=one.name, fillstyle="none")
            axis.loglog(one.x, one.y[0] * np.sqrt(one.x / one.x[0]), "-", color=colour, linewidth=0.8)
        first = series[0]
        for (label, slope), style in zip(lines.items(), ("--", ":"), strict=False):
            axis.loglog(first.x, first.y[0] * (first.x / first.x[0]) ** slope, style, color=THEORY, label=label)
        axis.set_xlabel("radius of curvature $R$ (LU)")
        axis.set_ylabel(name)
        axis.legend(frameon=False, fontsize=9)
    return figure


def reduced_figure(series: Sequence[Series], brittle: bool = False) -> Figure:
    """F/F_A over a/a₀ of many curves beside JKR and Barquins (Fig. 8)."""
    figure = new_figure((6.4, 4.6))
    axis = figure.subplots()
    a = np.linspace(0.0, 1.25, 400)
    axis.plot(a, jkr_reduced_force(a), "-", color=THEORY, linewidth=1.8, label="JKR")
    axis.plot(a, barquins_reduced_force(a), "--", color=THEORY, linewidth=1.2, label="Barquins (2D)")
    if brittle:
        axis.plot(a, brittle_reduced_force(a), ":", color=THEORY, linewidth=1.2, label="range → 0")
    _points(axis, series)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlim(0.0, 1.25)
    axis.set_ylim(-1.15, 1.6)
    axis.set_xlabel(r"contact radius $\tilde a = a/a_0$")
    axis.set_ylabel(r"force $\tilde F = F/F_A$")
    axis.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def closed_form_figure(series: Sequence[Series], laws: Sequence[Series]) -> Figure:
    """F/F_A over a/a₀ of runs (points) and of the model's closed form (lines)."""
    figure = new_figure((6.4, 4.6))
    axis = figure.subplots()
    for law, colour in zip(laws, COLOURS, strict=False):
        axis.plot(law.x, law.y, "-", color=colour, linewidth=1.0)
    _points(axis, series)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlabel("contact radius $a$ (LU)")
    axis.set_ylabel("force $F$ (FU); lines: closed form")
    axis.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def displacement_figure(series: Sequence[Series], law: Series) -> Figure:
    """F/F_A over d R/a₀² of runs (points) and of JKR (line)."""
    figure = new_figure((6.4, 4.4))
    axis = figure.subplots()
    axis.plot(law.x, law.y, "-", color=THEORY, linewidth=1.8, label=law.name)
    _points(axis, series)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlim(-3.0, 0.7)
    axis.set_ylim(-1.15, 1.6)
    axis.set_xlabel(r"displacement $d\,R/a_0^2$")
    axis.set_ylabel("force $F/F_A$")
    axis.legend(frameon=False, fontsize=9, loc="upper left")
    return figure


def pressure_compared_figure(x: Array, ours: Array, places: Array, solver: Array, radius: float) -> Figure:
    """Pressure of the zero-load state, the solver's as a line, the contact radius marked (Fig. 4)."""
    figure = new_figure((6.4, 4.0))
    axis = figure.subplots()
    view = 1.8 * radius if math.isfinite(radius) else float(np.abs(x).max())
    axis.bar(x, ours, width=0.8 * float(np.median(np.diff(x))), color=np.where(ours >= 0.0, COLOURS[0], COLOURS[1]))
    axis.plot(places, solver, "-", color="black", linewidth=1.0, label="independent solver")
    for place in (-radius, radius):
        axis.axvline(place, color="black", linestyle="--", linewidth=1.0)
    axis.annotate("$a_0$", (radius, 0.0), xytext=(radius + 1.0, 0.6 * float(ours.max())))
    axis.set_xlim(-view, view)
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlabel("x (LU)")
    axis.set_ylabel("pressure (FU/LU)")
    axis.legend(frameon=False)
    return figure


def pressure_radius_figure(radius: Array, pressure: Array, jkr: Array, marked: tuple[float, float]) -> Figure:
    """Mean pressure in MPa over a, with JKR's and the paper's place marked."""
    figure = new_figure((6.4, 4.0))
    axis = figure.subplots()
    axis.plot(radius, jkr, "-", color=THEORY, label="JKR, Eq. (8), with the same $F_A$ and $a_0$")
    axis.plot(radius, pressure, "o", color=COLOURS[0], markersize=4, fillstyle="none", label="this program")
    axis.plot(*marked, "*", color=COLOURS[1], markersize=13, label="the paper, about 800 MPa")
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlabel("contact radius $a$ (LU)")
    axis.set_ylabel(r"mean pressure $F/\pi a^2$ (MPa)")
    axis.legend(frameon=False, loc="lower right")
    return figure


def _points(axis: Axes, series: Sequence[Series]) -> None:
    for i, one in enumerate(series):
        colour, marker = COLOURS[i % len(COLOURS)], MARKERS[i % len(MARKERS)]
        axis.plot(one.x, one.y, marker, color=colour, markersize=4, fillstyle="none", label=one.name, linestyle="none")
