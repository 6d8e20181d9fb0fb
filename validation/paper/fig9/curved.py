"""The set-up of Fig. 9 itself, a curved body on a flat one, beside the independent integrator of the same slide."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from validation.doors import Scene, settings_for
from validation.figures import Panel, Series
from validation.paper.fig9.reading import LOAD, RADIUS, mean, slides, static
from validation.references.slide import Integrator, Trace
from validation.row import Evidence, Reference, Row, relative, solver
from validation.slides import slide_model
from validation.study import Rows, found

INTEGRATED = {LOAD: (-0.4, 0.0, 1.2), RADIUS: (10.0, 80.0)}
"""Loads [FU] and radii [LU] of which the integrator does as much as it needs."""
PERIODS, LAST = 3.0, 1.0
"""Periods of the drive that it does, and those at their end that its mean is over."""
RESIDUAL = 1e-6
"""Force [FU] below which its bodies rest before they slide."""
TRACE, MEAN, LARGEST = 3e-4, 2e-3, 5e-3
"""Bounds: of the peak of the trace; of ⟨F⟩, over other periods; of the largest friction, between two rows."""
SOURCE = "independent integrator of the whole model, step by step"
SOLVER: Evidence = "independent solver"
RUN_IN = "the run-in: the means are over other periods"
SAME_ROWS = "both take it at the same rows"
BETWEEN = "the largest friction lies between two rows of the trace, of which a spacing has 50"


@dataclass(frozen=True)
class Integrated:
    """What the integrator has: ⟨F⟩, the largest friction before the plate has moved by a spacing [FU], its trace."""

    mean: float
    static: float
    trace: Trace


def integrated(scene: Scene) -> Integrated:
    """A slide of the scene by the integrator, measured where the program measures."""
    settings = settings_for(scene)
    body = Integrator(slide_model(scene, settings))
    body.settle(settings.motion.time_step, RESIDUAL, drag=settings.motion.settling_damping)
    (leg,) = settings.motion.drive
    period = scene.bodies.spacing / leg.velocity
    rows = min(leg.rows, round(PERIODS * period / leg.row_time))
    trace = body.run(rows * leg.steps, leg.time_step, leg.velocity, every=leg.steps)
    impulse = np.interp(trace.time[-1] - LAST * period, trace.time, trace.impulse)
    before = trace.place < scene.bodies.spacing
    return Integrated(float(trace.impulse[-1] - impulse) / (LAST * period), float(trace.friction[before].max()), trace)


def off_trace(row: Rows, name: str, known: Integrated) -> float:
    """Largest difference of the traces over the peak."""
    wanted = known.trace.friction
    ours = row.runs[name].friction["friction"][: len(wanted)]
    if len(ours) < len(wanted):
        return float("nan")
    return float(np.abs(ours - wanted).max() / np.abs(wanted).max())


def curved_checks(row: Rows) -> tuple[list[Row], Panel, Panel]:
    """Friction over load and radius."""
    known = {
        sweep: {value: integrated(slides(sweep).scenes[value,]) for value in values}
        for sweep, values in INTEGRATED.items()
    }
    load, names = known[LOAD], slides(LOAD).names
    low, high = 0.0, max(load)
    rise = [
        (of[high] - of[low]) / (high - low)
        for of in (
            {value: static(row.runs[names[value,]]) for value in (low, high)},
            {value: load[value].static for value in (low, high)},
        )
    ]
    checks = [
        _mean_row(row, names[value,], f"load of {value:g} FU", one) for value, one in load.items()
    ] + [
        _mean_row(row, slides(RADIUS).names[value,], f"radius of {value:g} LU", one)
        for value, one in known[RADIUS].items()
    ]  # fmt: skip
    checks += [
        row("largest friction of a curved body without a load", static(row.runs[names[0.0,]]),
            solver(load[0.0].static, SOURCE), relative(LARGEST, BETWEEN),
            uncertainty=found(row.runs[names[0.0,]], "static_friction").uncertainty, unit="FU", on=[names[0.0,]],
            wide=SAME_ROWS),
        row(f"what it rises by with the load, from 0 to {high:g} FU", rise[0], solver(rise[1], SOURCE),
            relative(LARGEST, BETWEEN), on=[names[0.0,], names[high,]], wide=SAME_ROWS),
    ]  # fmt: skip
    worst = {
        names_of: off_trace(row, names_of, one)
        for sweep, values in known.items()
        for names_of, one in ((slides(sweep).names[value,], one) for value, one in values.items())
    }
    checks.append(
        row.at_most(
            f"friction at every row of the trace off that of the integrator, over its peak, worst of {len(worst)} "
            "slides",
            max(worst.values()),
            Reference(TRACE, "bound that was asked for", "set bound"),
            "table of the law, order of the sums, the rest from which it starts",
            on=list(worst),
            wide="what was asked for leaves room for heat and neighbours",
        )
    )
    return checks, _panel(row, LOAD, known, "normal force (FU)"), _panel(row, RADIUS, known, "radius (LU)")


def _mean_row(row: Rows, name: str, words: str, known: Integrated) -> Row:
    result = found(row.runs[name], "mean_friction")
    return row(f"⟨F⟩ of a curved body, {words}", result, solver(known.mean, SOURCE), relative(MEAN, RUN_IN),
               on=[name], wide="the run-in is over sooner than the bound allows for")  # fmt: skip


def _panel(row: Rows, sweep: str, known: dict[str, dict[float, Integrated]], along: str) -> Panel:
    points = slides(sweep)
    places = np.asarray([value for (value,) in points.names])

    def series(words: str, values: Sequence[float]) -> Series:
        return Series(words, places, np.asarray(values))

    runs = [row.runs[name] for name in points.every]
    shown = [series("largest", [static(run) for run in runs]), series("mean", [mean(run) for run in runs])]
    for value, one in known[sweep].items():
        label = "" if value != min(known[sweep]) else "integrator"
        shown.append(Series(label, np.full(2, value), np.asarray([one.static, one.mean])))
    return Panel(along, "friction (FU)", shown[:2], _stars(shown[2:]), title="curved on flat",
                 log="x" * (sweep == RADIUS))  # fmt: skip


def _stars(shown: Sequence[Series]) -> list[Series]:
    """Each value of the integrator as a point of its own."""
    return [
        Series(one.name if i == 0 else "", one.x[i : i + 1], one.y[i : i + 1])
        for one in shown
        for i in range(len(one.x))
    ]
