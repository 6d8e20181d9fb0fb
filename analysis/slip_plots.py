"""Figures of friction on a rigid plane: F_x over the way beside Mindlin, and which zone sticks and which slips."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.plots import COMPRESSION, LOADING, SIZE, TENSION, THEORY, new_figure
from contact1d.analysis.pressure import Profile

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Array = NDArray[np.float64]
STICKS, SLIPS = COMPRESSION, TENSION
BEYOND = 1.15
"""Half-width of what is shown over that of the contact."""
FEW_ROWS = 25
"""Rows of a branch up to which each of them is marked."""


def tangential_figure(columns: Mapping[str, Array], branches: NDArray[np.str_], theory: Array | None = None) -> Figure:
    """F_x over u, and beside it a theory's F_x at the same places; the normal force below where it changes.

    Args:
        columns: of curve.csv, `tangential_displacement`, `tangential_force`, `normal_force`.
        branches: "forward" or "backward" of each row.
        theory: F_x [FU] of Cattaneo and Mindlin, (n,).
    """
    figure = new_figure(SIZE)
    u, force, load = (columns[f"{name}"] for name in ("tangential_displacement", "tangential_force", "normal_force"))
    varies = float(np.ptp(load)) > 1e-9 * float(np.max(np.abs(load)))
    axes = figure.subplots(1 + varies, 1, sharex=True, squeeze=False, height_ratios=(2, 1)[: 1 + varies])[:, 0]
    axis = axes[0]
    for branch, colour in (("forward", LOADING), ("backward", TENSION)):
        chosen = branches == branch
        if chosen.any():
            # A branch begins where the one before it ended.
            lines = np.flatnonzero(chosen)
            for i, part in enumerate(np.split(lines, np.flatnonzero(np.diff(lines) > 1) + 1)):
                rows = np.concatenate([[part[0] - 1], part]) if part[0] > 0 else part
                marker = "o" if len(rows) <= FEW_ROWS else ""
                label = branch if i == 0 else None
                axis.plot(u[rows], force[rows], marker=marker, markersize=4, color=colour, linewidth=2.6, label=label)
    if theory is not None:
        axis.plot(u, theory, "--", color=THEORY, linewidth=1.4, label="Cattaneo–Mindlin")
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.margins(y=0.09)
    axis.set_ylabel("tangential force (FU)")
    axis.legend(frameon=False, loc="best")
    if varies:
        axes[1].plot(u, load, color=SLIPS, linewidth=1.4)
        axes[1].set_ylabel("normal force (FU)")
    axes[-1].set_xlabel("displacement along x (LU)")
    return figure


def body_shear_figure(states: Mapping[str, tuple[Array, Array, float, float]]) -> Figure:
    """Shear traction over the distance from the axis of the body of three dimensions, mirrored at the axis.

    Args:
        states: by name r [LU], q(r) [FU/LU²], contact and stick radius [LU].
    """
    figure = new_figure(SIZE)
    axis = figure.subplots()
    for (name, (r, shear, edge, stick)), colour in zip(states.items(), (TENSION, COMPRESSION), strict=False):
        both, values = np.concatenate([-r[::-1], r]), np.concatenate([shear[::-1], shear])
        axis.plot(both, values, color=colour, linewidth=1.8, label=f"{name.replace('_', ' ')} state")
        for side in (-1.0, 1.0) if 0.0 < stick < edge else ():
            axis.axvline(side * stick, color=colour, linewidth=1.0, linestyle="--")
    axis.axhline(0.0, color="black", linewidth=0.8)
    axis.set_xlabel("r (LU); dashed: stick radius")
    axis.set_ylabel("shear traction (FU/LU²)")
    axis.margins(y=0.09)
    axis.legend(frameon=False, loc="best")
    return figure


def stick_slip_figure(
    profiles: Mapping[str, Profile],
    coefficient: float,
    sticking: Mapping[str, Array],
    radii: Mapping[str, float],
    places: Mapping[str, float],
) -> Figure:
    """Shear traction over x of each state between ±μp, the particles that stick and those that slip in two colours.

    Args:
        profiles: by the names of the states.
        coefficient: μ.
        sticking: what is left of μp of each particle [FU/LU], (n,); 0 where it slips.
        radii: half-width of the zone that sticks [LU].
        places: of the body along x [LU].
    """
    figure = new_figure((SIZE[0], 1.0 + 2.3 * len(profiles)))
    axes = figure.subplots(len(profiles), 1, squeeze=False)[:, 0]
    for axis, (name, profile) in zip(axes, profiles.items(), strict=True):
        touched = profile.pressure > 0.0
        limit = coefficient * np.maximum(profile.pressure, 0.0)
        x = profile.x
        for chosen, colour, label in (
            (touched & (sticking[name] > 0.0), STICKS, "sticks"),
            (touched & (sticking[name] == 0.0), SLIPS, "slips"),
        ):
            axis.vlines(x[chosen], 0.0, -profile.shear[chosen], color=colour, linewidth=2.0, label=label)
        axis.plot(x, limit, "--", color=THEORY, linewidth=1.2, label="±μp")
        axis.plot(x, -limit, "--", color=THEORY, linewidth=1.2)
        axis.axhline(0.0, color="black", linewidth=0.8)
        radius = radii.get(name, math.nan)
        marked = ""
        if math.isfinite(radius) and radius > 0.0:
            axis.axvspan(-radius, radius, color=STICKS, alpha=0.08, linewidth=0.0)
            marked = f", stick radius c = {radius:.4g} LU (shaded)"
        half = float(np.abs(x[touched]).max()) if touched.any() else float(np.abs(x).max())
        half = max(half, float(x[1] - x[0]))
        axis.set_xlim(-BEYOND * half, BEYOND * half)
        axis.set_title(f"{name.replace('_', ' ')} state, u = {places[name]:.4g} LU{marked}", loc="left", fontsize=10)
        axis.set_ylabel("shear (FU/LU)")
        axis.legend(frameon=False, loc="upper right", fontsize=8)
    axes[-1].set_xlabel("x from the body's middle (LU)")
    return figure
