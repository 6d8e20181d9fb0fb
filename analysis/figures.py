"""What each figure of a run shows: line load (the paper's Fig. 4), force over displacement and over radius (Fig. 8).

Each function returns the description of a chart, in the units of its numbers. Reference: JKR, F̃ = 4ã³ − 4ã^{3/2}
(Eq. 8), scaled by F_A and a₀ of the run, so that only the shapes are compared. A theory is its name with the values
along x and y.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.chart import (
    BLACK,
    COMPRESSION,
    ENDLESS,
    FILL,
    LOADING,
    TENSION,
    UNLOADING,
    Array,
    Axis,
    Chart,
    Panel,
    Series,
    area,
    upright,
)
from contact1d.analysis.friction import standard_error
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.scan import Taken
from contact1d.analysis.shear import stick_margin

Theory = tuple[str, Array, Array]
Legs = Sequence[tuple[str, NDArray[np.int64]]]
"""The branch of each leg of a path, and the rows of the curve that belong to it."""
Upwards = tuple[Axis, Array, Sequence[Series]]
"""A panel of a path: its axis, the numbers of the path, and the series drawn with it for comparison."""
HEIGHT = 3.2
"""Height of the main panel of a path [inch]."""
LEGS = {"loading": (LOADING, 3.2), "forward": (LOADING, 2.6), "backward": (TENSION, 2.6), "settling": ("#bbbbbb", 1.4)}
"""Colour and width of a leg, by its branch; other branches are drawn as unloading."""
COMPRESSIVE = ", compression positive"


def path(x: Axis, along: Array, legs: Legs, *panels: Upwards, spread: Array | float = 0.0) -> Chart:
    """Return the chart of an experiment's path, stretch by stretch, a panel for each of `panels`, all over `x`.

    A stretch of at most 25 points is drawn with markers, and all are where any `spread` is not 0, without lines where
    the panel has compared series; others are lines. Stretches without any finite position are left out. Of several
    panels the axes upwards lose their remark.

    Args:
        x: the axis along x.
        along: what the path is drawn over, (n,), in the unit of that axis.
        legs: stretches of the path: (name, indices of its points); the name, such as loading, determines its colour,
            that of unloading for an unknown name.
        panels: the main one first, which is the highest: (axis, values (n,) in its unit, series drawn beside these).
        spread: uncertainty along x, (n,), in its unit.
    """
    drawn, spread = [], np.broadcast_to(spread, along.shape)
    few = 25  # points that are marked: a line through a single one would be invisible
    for number, (y, column, compared) in enumerate(panels, 1):
        series = []
        for name, rows in legs:
            if not np.isfinite(along[rows]).any():
                continue
            colour, width = LEGS.get(name, (UNLOADING, 1.4))
            points = len(rows) <= few or spread.any()
            look = "-" if not points else "o" if compared else "o-"
            series.append(Series(along[rows], column[rows], name, colour, look, width, dx=spread[rows]))
        y = y if len(panels) == 1 else replace(y, remark="")  # too long for a low panel
        drawn.append(Panel(y, [*series, *compared], height=HEIGHT / number))
    return Chart(x, drawn)


def lines(*theories: Theory) -> list[Series]:
    """Return a dashed line for each theory, (name, x, y), named as it; an empty list without one."""
    return [Series(x, y, name, look="--") for name, x, y in theories]


def level(value: float, uncertainty: float, name: str) -> list[Series]:
    """Return a band of ± the uncertainty and a dotted line at a value, across a panel, in the unit of its axis.

    The band comes first and has no name; `name` is that of the line.
    """
    band = area(ENDLESS, [value - uncertainty, value + uncertainty], colour=TENSION, opacity=0.3)
    return [band, Series(ENDLESS, np.full(2, value), name, TENSION, ":")]


def reduced(largest: float) -> list[Series]:
    """Return F/F_A over a/a₀ of JKR as a list of one dashed line, from 0 to the radius `largest` (the paper's Fig. 8).

    Both are dimensionless, F positive in compression, 400 points.
    """
    a = np.linspace(0.0, largest, 400)
    return [Series(a, 4.0 * a**3 - 4.0 * a**1.5, "JKR", BLACK, "--")]


def detachments(forces: NDArray[np.float64]) -> Chart:
    """Return the chart of the tensions at which the bodies separated, in ascending order over the share of the pulls.

    Their mean is a line, with a band of ± its standard error.

    Args:
        forces: these tensions, positive, (pulls,) [FU], two at least.
    """
    share = (np.arange(forces.size) + 0.5) / forces.size
    mean = level(float(forces.mean()), standard_error(forces), f"mean of {forces.size} repeats, standard error")
    legs = [("pulls", np.arange(forces.size))]
    return path(Axis("share of the pulls"), share, legs, (Axis("detachment force", "FU"), np.sort(forces), mean))


def scan(taken: Taken) -> Chart:
    """Return the chart of a scan in three panels: points and fitted curve, residual [LU], its autocorrelation.

    The first two are over the distance from the apex [LU], with its sign; the third is over the lag, on the same axis.
    """
    x, lag = Axis("distance from the apex", "LU"), taken.pitch * np.arange(taken.autocorrelation.size)
    points = Series(taken.x, taken.heights, "scan", LOADING, "o", 2.0)
    curve = Series(taken.x, taken.heights - taken.residual, "fitted", TENSION)
    residual, correlation = Axis("residual", "LU", zero=True), Axis("autocorrelation", zero=True)
    return Chart(
        x,
        [
            Panel(Axis("height", "LU"), [points, curve], height=HEIGHT),
            Panel(residual, [Series(taken.x, taken.residual, "", LOADING)], height=0.5 * HEIGHT),
            Panel(correlation, [Series(lag, taken.autocorrelation, "", UNLOADING)], height=0.5 * HEIGHT),
        ],
    )


def seen(profiles: Mapping[str, Profile]) -> dict[str, Profile]:
    """Return the profiles of the states in contact, by name, cut to the width in which one of them has a pressure.

    A state whose largest |pressure| is below 1e-3 of that of the others has none: the bodies are apart, and it is left
    out. Where no state has a pressure all stay. The width is the same for all, |x| up to 1.15 times the farthest
    particle with more than 1 % of the largest |pressure| of its state, and two spacings more.

    Raises:
        ValueError: no profiles.
    """
    largest = {name: np.abs(profile.pressure).max() for name, profile in profiles.items()}
    least = 1e-3 * max(largest.values())
    touching = {name: profile for name, profile in profiles.items() if largest[name] >= least}
    half = max(half_width(profile.x, profile.pressure) for profile in touching.values())
    return {
        name: Profile(*(column[np.abs(profile.x) <= half] for column in vars(profile).values()))
        for name, profile in touching.items()
    }


def pressure(profiles: Mapping[str, Profile], radii: Mapping[str, ContactRadius]) -> Chart:
    """Return the chart of line load [FU/LU] over x [LU], compression positive, a panel for each state (paper's Fig. 4).

    A state without any pressure has the note "no contact".

    Args:
        profiles: by state.
        radii: by state, whose edges are marked; a state without one, or with radius 0, has no marks.
    """
    panels = []
    for name, profile in profiles.items():
        series = [*_bars(profile.x, profile.pressure, profile.pressure > 0.0)]
        radius, note = radii.get(name), "" if profile.pressure.any() else "no contact"
        if radius and radius.value > 0.0:
            series.append(upright(radius.left, radius.right))
            note = f"contact radius a = {radius.value:.4g} LU (dashed)"
        panels.append(Panel(Axis("line load", "FU/LU", zero=True), series, _state(name), note, 2.3))
    return Chart(Axis("x", "LU"), panels)


def stick_slip(
    profiles: Mapping[str, Profile], coefficient: float, zones: Mapping[str, tuple[float, float, int]]
) -> Chart:
    """Return the chart of the shear [FU/LU] over x [LU] of each state between ±μp, with slip in another colour.

    The shear is that on the lower body, 0 where the pressure is not compressive. The stick zone is shaded, |x| up to
    its half-width.

    Args:
        profiles: by state.
        coefficient: μ.
        zones: by state (half-width of the stick zone [LU], position of the body along x [LU], direction of its motion,
            1, -1 or 0).

    Raises:
        KeyError: a state without a zone.
    """
    panels = []
    for name, profile in profiles.items():
        limit, (radius, position, direction) = coefficient * np.maximum(profile.pressure, 0.0), zones[name]
        shear, note = np.where(limit > 0.0, -profile.shear, 0.0), f"u = {position:.4g} LU"
        series = [*_bars(profile.x, shear, stick_margin(profile, coefficient, direction) > 0.0, ("sticks", "slips"))]
        series += [Series(profile.x, bound, "±μp", BLACK, "--") for bound in (limit, -limit)]
        if radius > 0.0:
            series.append(area([-radius, radius], ENDLESS, colour=COMPRESSION, opacity=0.08))
            note += f", stick radius c = {radius:.4g} LU (shaded)"
        panels.append(Panel(Axis("shear", "FU/LU", zero=True), series, _state(name), note, 2.3))
    return Chart(Axis("x from the middle of the body", "LU"), panels)


def _bars(x: Array, load: Array, first: NDArray[np.bool_], names: tuple[str, str] = ("", "")) -> Iterator[Series]:
    """Yield two outlines of bars, of the line load of the particles in `first` and of the others, in two colours.

    A bar reaches half-way to the neighbours of its particle; that of a particle of the other kind has the height 0.

    Args:
        x: positions, rising, (n,) [LU].
        load: line load, (n,) [FU/LU].
        first: which particles are in the first outline, (n,).
        names: of both outlines in the legend.
    """
    edges = np.repeat(np.concatenate([x[:1], (x[1:] + x[:-1]) / 2.0, x[-1:]]), 2)
    for zone, name, colour in zip((first, ~first), names, (COMPRESSION, TENSION), strict=True):
        yield Series(edges, np.pad(np.repeat(np.where(zone, load, 0.0), 2), 1), name, colour, FILL)


def half_width(x: Array, p: Array) -> float:
    """Return the half-width of a figure of a pressure, in the unit of x, for p (n,) or of m states (m, n), and x as p.

    It is 1.15 times the largest |x| at which |p| exceeds 1 % of the largest |p| of its state; where there is none, 1.15
    times a tenth of the largest |x|; and two spacings more.
    """
    carrying = np.abs(p) > 0.01 * np.abs(p).max(axis=-1, keepdims=True)
    reach = np.abs(x[carrying]).max() if carrying.any() else 0.1 * np.abs(x).max()
    return float(1.15 * reach + 2.0 * np.ptp(x) / x.shape[-1])


def _state(name: str) -> str:
    """Return the name of a state as a title, blanks for underscores and " state" behind: `zero load state`."""
    return f"{name.replace('_', ' ')} state"


def body(
    name: str,
    states: Mapping[str, Mapping[str, Array]],
    marks: Mapping[str, Mapping[str, float]],
    theories: Mapping[str, Theory],
) -> Chart:
    """Return the chart of a traction on the three-dimensional body over r, in a panel for each state.

    Values of the run of more than 8 times their median magnitude in the state, near a pole at the edge, are left out,
    none where the median is 0; closed forms are drawn whole.

    Args:
        name: of the traction, and of its column.
        states: its columns by state, `r` [LU], `<name>` and `<name>_uncertainty` [FU/LU²].
        marks: by state the radii to mark, by name [LU]: of the first two those above 0; a state may have none.
        theories: by state (name, r [LU], values [FU/LU²]) of its closed form; a state may have none.
    """
    panels = []
    for state, columns in states.items():
        size = np.abs(columns[name])
        shown = ~(size > 8.0 * (np.nanmedian(size) or np.inf))  # a pole at the edge would hide the rest
        r, value, spread = (columns[column][shown] for column in ("r", name, f"{name}_uncertainty"))
        series = lines(theories[state]) if state in theories else []
        series.append(Series(r, value, "this run", COMPRESSION, "o", dy=spread))
        for (mark, radius), colour in zip(marks.get(state, {}).items(), (TENSION, BLACK), strict=False):
            if radius > 0.0:
                series.append(upright(radius, name=f"{mark} = {radius:.4g} LU", colour=colour))
        panels.append(Panel(Axis(name.replace("_", " "), "FU/LU²", zero=True), series, _state(state), height=2.6))
    return Chart(Axis("distance from the axis r", "LU", zero=True), panels)
