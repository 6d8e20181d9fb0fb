"""How the results change with the uncertain numbers of a scene, and which of these matters most."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contact1d.analysis.chart import BLACK, COMPRESSION, FILL, LOADING, TENSION, UNLOADING, Axis, Chart, Panel, Series
from contact1d.workflow.continuation.outcome import Outcome, in_squares
from contact1d.workflow.runs.accuracy import main_results
from contact1d.workflow.scene import Scene

COLOURS = (COMPRESSION, TENSION, LOADING, UNLOADING, BLACK)
OF_INPUT = ("input", "half_width")
"""Columns of the table that are no changes of results."""
WIDTH = 0.8
"""Of the bars of one input, over the distance of inputs."""


def inputs_of(scene: Scene, outcome: Outcome) -> dict[str, Any]:
    """The table `inputs`: each input, its 95 % half-width over its value, and the change of each main result over that.

    Empty where a scene is known exactly. A deviation of a measured profile has no width.
    """
    keys = list(dict.fromkeys(move.key for move in outcome.moves))
    if not keys:
        return {}
    found: dict[str, Any] = {"input": keys, "half_width": [scene.shares.get(key, np.nan) for key in keys]}
    for name, one in main_results(scene, outcome.results).items():
        own = [in_squares([move for move in outcome.moves if move.key == key], name) for key in keys]
        found[name] = [change / one.size if one.size else np.nan for change in own]
    return found


def entries(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """The same as results.json has it: a table for each input."""
    rows = [dict(zip(table, row, strict=True)) for row in zip(*table.values(), strict=True)]
    return [{name: value for name, value in row.items() if value == value} for row in rows]


def chart(table: Mapping[str, Any]) -> Chart:
    """Bars of the changes in percent, by input."""
    names = [name for name in table if name not in OF_INPUT]
    words = [key.partition(".")[2].replace("profile.", "") for key in table["input"]]
    ticks = {float(i): one.replace(".", " ").replace("_", " ") for i, one in enumerate(words)}
    series, width = [], WIDTH / max(len(names), 1)
    for number, name in enumerate(names):
        left = np.arange(len(ticks)) + width * number - 0.5 * WIDTH
        x = np.add.outer(left, [0.0, 0.0, width, width, np.nan]).ravel()
        y = np.outer(table[name], [0.0, 100.0, 100.0, 0.0, np.nan]).ravel()
        series.append(Series(x, y, name.replace("_", " "), COLOURS[number % len(COLOURS)], FILL))
    panel = Panel(Axis("change at the ends of the input (%)", zero=True), series)
    return Chart(Axis("input", ticks=ticks), [panel])


def in_words(found: Mapping[str, Any]) -> list[str]:
    """Lines for a terminal, the input that matters most first; `found`: what results.json holds."""
    rows = [({name: one[name] for name in one if name not in OF_INPUT}, one) for one in found.get("inputs", ())]
    lines = []
    for changes, one in sorted(rows, key=lambda row: -max(row[0].values(), default=0.0)):
        width = f" ± {100.0 * one['half_width']:.2g} %" if "half_width" in one else ""
        said = ", ".join(f"{name.replace('_', ' ')} ± {100.0 * value:.2g} %" for name, value in changes.items())
        lines.append(f"  {one['input']}{width}: {said}")
    return ["\nchanges with the inputs, the largest first:", *lines] if lines else []
