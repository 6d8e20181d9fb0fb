"""The set-up of Fig. 9 itself, a curved body on a flat one, beside the independent integrator of the same slide."""

from dataclasses import dataclass, replace

import numpy as np

from validation import slides as whole_slides
from validation.doors import Scene, settings_for
from validation.figures import Panel, Series
from validation.paper.fig9.reading import LOAD, RADIUS, mean, slides, static
from validation.references.slide import Trace
from validation.row import Reference, Row, relative, solver
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
    (leg,) = settings.motion.drive
    period = scene.bodies.spacing / leg.velocity
    trace = whole_slides.integrated(scene, settings, RESIDUAL, round(PERIODS * period / leg.row_time))
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
    by_run = {slides(sweep).names[value,]: one for sweep, values in known.items() for value, one in values.items()}
    words = [f"load of {value:g} FU" for value in known[LOAD]] + [f"radius of {value:g} LU" for value in known[RADIUS]]
    load, names = known[LOAD], slides(LOAD).names
    high = max(load)
    unloaded, loaded = names[0.0,], names[high,]
    ours, theirs = (static(row.runs[loaded]) - static(row.runs[unloaded])), load[high].static - load[0.0].static
    checks = [
        row(f"⟨F⟩ of a curved body, {where}", found(row.runs[name], "mean_friction"), solver(one.mean, SOURCE),
            relative(MEAN, RUN_IN), on=name, wide="the run-in is over sooner than the bound allows for")
        for where, (name, one) in zip(words, by_run.items(), strict=True)
    ] + [
        row("largest friction of a curved body without a load", found(row.runs[unloaded], "static_friction"),
            solver(load[0.0].static, SOURCE), relative(LARGEST, BETWEEN), on=unloaded, wide=SAME_ROWS),
        row(f"what it rises by with the load, from 0 to {high:g} FU", ours / high, solver(theirs / high, SOURCE),
            relative(LARGEST, BETWEEN), on=[unloaded, loaded], wide=SAME_ROWS),
        row.at_most(
            f"friction at every row of the trace off that of the integrator, over its peak, worst of {len(by_run)} "
            "slides",
            max(off_trace(row, name, one) for name, one in by_run.items()),
            Reference(TRACE, "bound that was asked for", "set bound"),
            "table of the law, order of the sums, the rest from which it starts",
            on=list(by_run),
            wide="what was asked for leaves room for heat and neighbours",
        ),
    ]  # fmt: skip
    return checks, _panel(row, LOAD, load, "normal force (FU)"), _panel(row, RADIUS, known[RADIUS], "radius (LU)")


def _panel(row: Rows, sweep: str, known: dict[float, Integrated], along: str) -> Panel:
    """Each value of the integrator is a point of its own."""
    points = slides(sweep)
    places, runs = [value for (value,) in points.names], [row.runs[name] for name in points.every]
    shown = [Series("largest", places, [*map(static, runs)]), Series("mean", places, [*map(mean, runs)])]
    stars = [Series("", [value], [force]) for value, one in known.items() for force in (one.static, one.mean)]
    stars[0] = replace(stars[0], name="integrator")
    return Panel(along, "friction (FU)", shown, stars, title="curved on flat", log="x" * (sweep == RADIUS))
