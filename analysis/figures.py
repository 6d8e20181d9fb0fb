"""What each figure of a run shows: line load (the paper's Fig. 4), force over displacement and over radius (Fig. 8).

Each function returns the description of a chart, in the units of its numbers. Reference: JKR, F̃ = 4ã³ − 4ã^{3/2}
(Eq. 8), scaled on the run's own F_A and a₀, so that only the shapes are compared. A theory is its name with the values
along x and y.
"""

from __future__ import annotations

import math
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
from contact1d.analysis.pressure import Profile
from contact1d.analysis.radius import ContactRadius
from contact1d.analysis.scan import Taken
from contact1d.analysis.shear import stick_margin

Theory = tuple[str, Array, Array]
Legs = Sequence[tuple[str, NDArray[np.int64]]]
"""Of a path: the name of each leg's branch, and its rows of the curve."""
Upwards = tuple[Axis, Array, Sequence[Series]]
"""What a panel of a path has: its axis, the numbers of the path, and what is drawn beside it."""
HEIGHT = 3.2
"""Of the main panel of a path [inch]."""
LEGS = {"loading": (LOADING, 3.2), "forward": (LOADING, 2.6), "backward": (TENSION, 2.6), "settling": ("#bbbbbb", 1.4)}
"""Colour and width of a leg; of other branches as of unloading."""
SEPARATION_SHARE = 1e-3
"""Largest pressure over that of the other states below which a state is not drawn: the bodies are apart."""
FEW = 25
"""Up to so many points a leg shows where they are: a line through one point would be invisible."""
SHOWN_SHARE = 0.01
"""Pressure over the largest one that a figure still shows."""
WIDER = 1.15
"""Half-width of a picture over that of what carries."""
CLEAR = 8.0
"""Largest traction that is shown over its median: a pole at the edge would hide the rest."""
COMPRESSIVE = ", compression positive"


def path(x: Axis, along: Array, legs: Legs, *panels: Upwards, spread: Array | float = 0.0) -> Chart:
    """The path of an experiment, leg by leg; with something beside it the points alone, where these are few.

    Args:
        x, along: what the path is drawn over, (n,).
        legs: of the path.
        panels: what is drawn over it, the main one first.
        spread: uncertainty along x, (n,).
    """
    drawn, spread = [], np.broadcast_to(spread, along.shape)
    for number, (y, column, beside) in enumerate(panels, 1):
        series = []
        for name, rows in [(name, rows) for name, rows in legs if np.isfinite(along[rows]).any()]:
            colour, width = LEGS.get(name, (UNLOADING, 1.4))
            points = len(rows) <= FEW or spread.any()
            look = "-" if not points else "o" if beside else "o-"
            series.append(Series(along[rows], column[rows], name, colour, look, width, dx=spread[rows]))
        y = y if len(panels) == 1 else replace(y, remark="")  # too long for a low panel
        drawn.append(Panel(y, [*series, *beside], height=HEIGHT / number))
    return Chart(x, drawn)


def lines(*theories: Theory) -> list[Series]:
    """The lines of theories."""
    return [Series(x, y, name, look="--") for name, x, y in theories]


def level(value: float, uncertainty: float, name: str) -> list[Series]:
    """A number across a panel, with its uncertainty."""
    band = area(ENDLESS, [value - uncertainty, value + uncertainty], colour=TENSION, opacity=0.3)
    return [band, Series(ENDLESS, np.full(2, value), name, TENSION, ":")]


def reduced(largest: float) -> list[Series]:
    """F/F_A over a/a₀ of JKR up to a radius (the paper's Fig. 8)."""
    a = np.linspace(0.0, largest, 400)
    return [Series(a, 4.0 * a**3 - 4.0 * a**1.5, "JKR", BLACK, "--")]


def detachments(forces: Array) -> Chart:
    """The tensions [FU] at which the bodies parted, (pulls,), in order; their mean with its standard error."""
    share, error = (np.arange(forces.size) + 0.5) / forces.size, float(forces.std(ddof=1)) / math.sqrt(forces.size)
    mean = level(float(forces.mean()), error, f"mean of {forces.size} repeats, standard error")
    legs = [("pulls", np.arange(forces.size))]
    return path(Axis("share of the pulls"), share, legs, (Axis("detachment force", "FU"), np.sort(forces), mean))


def scan(taken: Taken) -> Chart:
    """The points of a scan and the curve that was taken, what is left, and its autocorrelation over the distance."""
    x, lag = Axis("distance from the apex", "LU"), taken.pitch * np.arange(taken.autocorrelation.size)
    points = Series(taken.x, taken.heights, "scan", LOADING, "o", 2.0)
    curve = Series(taken.x, taken.heights - taken.residual, "taken", TENSION)
    left, correlation = (Axis(name, unit, zero=True) for name, unit in (("residual", "LU"), ("autocorrelation", "1")))
    return Chart(
        x,
        [
            Panel(Axis("height", "LU"), [points, curve], height=HEIGHT),
            Panel(left, [Series(taken.x, taken.residual, "", LOADING)], height=0.5 * HEIGHT),
            Panel(correlation, [Series(lag, taken.autocorrelation, "", UNLOADING)], height=0.5 * HEIGHT),
        ],
    )


def seen(profiles: Mapping[str, Profile]) -> dict[str, Profile]:
    """The states with a pressure that is more than a trace of the others', and of all the width in which one has it."""
    largest = {name: np.abs(profile.pressure).max() for name, profile in profiles.items()}
    least = SEPARATION_SHARE * max(largest.values())
    touching = {name: profile for name, profile in profiles.items() if largest[name] >= least}
    half = max(half_width(profile.x, profile.pressure) for profile in touching.values())
    return {
        name: Profile(*(column[np.abs(profile.x) <= half] for column in vars(profile).values()))
        for name, profile in touching.items()
    }


def pressure(profiles: Mapping[str, Profile], radii: Mapping[str, ContactRadius]) -> Chart:
    """Pressure over x of each state, one panel below the other, with its edges marked (the paper's Fig. 4)."""
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
    """Shear traction over x of each state between ±μp, the particles that stick and those that slip in two colours.

    Args:
        profiles: by state.
        coefficient: μ.
        zones: by state the half-width of the zone that sticks, and the place of the body along x [LU]; its direction.
    """
    panels = []
    for name, profile in profiles.items():
        limit, (radius, place, direction) = coefficient * np.maximum(profile.pressure, 0.0), zones[name]
        shear, note = np.where(limit > 0.0, -profile.shear, 0.0), f"u = {place:.4g} LU"
        series = [*_bars(profile.x, shear, stick_margin(profile, coefficient, direction) > 0.0, ("sticks", "slips"))]
        series += [Series(profile.x, bound, "±μp", BLACK, "--") for bound in (limit, -limit)]
        if radius > 0.0:
            series.append(area([-radius, radius], ENDLESS, colour=COMPRESSION, opacity=0.08))
            note += f", stick radius c = {radius:.4g} LU (shaded)"
        panels.append(Panel(Axis("shear", "FU/LU", zero=True), series, _state(name), note, 2.3))
    return Chart(Axis("x from the middle of the body", "LU"), panels)


def _bars(x: Array, load: Array, first: NDArray[np.bool_], names: tuple[str, str] = ("", "")) -> Iterator[Series]:
    """A bar for each particle, between those beside it; the `first` ones, and the others, in colours of their own."""
    edges = np.repeat(np.concatenate([x[:1], (x[1:] + x[:-1]) / 2.0, x[-1:]]), 2)
    for zone, name, colour in zip((first, ~first), names, (COMPRESSION, TENSION), strict=True):
        yield Series(edges, np.pad(np.repeat(np.where(zone, load, 0.0), 2), 1), name, colour, FILL)


def half_width(x: Array, p: Array) -> float:
    """Half-width of a picture in which a pressure is to be seen, (n,) or of m states (m, n).

    A tenth of the body's where there is none.
    """
    carrying = np.abs(p) > SHOWN_SHARE * np.abs(p).max(axis=-1, keepdims=True)
    reach = np.abs(x[carrying]).max() if carrying.any() else 0.1 * np.abs(x).max()
    return float(WIDER * reach + 2.0 * np.ptp(x) / x.shape[-1])


def _state(name: str) -> str:
    return f"{name.replace('_', ' ')} state"


def body(
    name: str,
    states: Mapping[str, Mapping[str, Array]],
    marks: Mapping[str, Mapping[str, float]],
    theories: Mapping[str, Theory],
) -> Chart:
    """A traction on the body of three dimensions over r, of each state, the closed form beside it.

    Args:
        name: what it is.
        states: its columns by state, `r` [LU], `<name>` and `<name>_uncertainty` [FU/LU²].
        marks: by state what has a radius [LU].
        theories: by state.
    """
    panels = []
    for state, columns in states.items():
        size = np.abs(columns[name])
        shown = size <= CLEAR * np.median(size)
        r, value, spread = (columns[column][shown] for column in ("r", name, f"{name}_uncertainty"))
        series = lines(theories[state]) if state in theories else []
        series.append(Series(r, value, "this run", COMPRESSION, "o", dy=spread))
        for (mark, radius), colour in zip(marks.get(state, {}).items(), (TENSION, BLACK), strict=False):
            if radius > 0.0:
                series.append(upright(radius, name=f"{mark} = {radius:.4g} LU", colour=colour))
        panels.append(Panel(Axis(name.replace("_", " "), "FU/LU²", zero=True), series, _state(state), height=2.6))
    return Chart(Axis("distance from the axis r", "LU", zero=True), panels)
