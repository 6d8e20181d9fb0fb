"""The changes of the results with the uncertain inputs of a scene: numbers with ± and measured profiles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from contact1d.analysis.chart import BLACK, COMPRESSION, FILL, LOADING, TENSION, UNLOADING, Axis, Chart, Panel, Series
from contact1d.workflow.continuation.outcome import Outcome, in_squares
from contact1d.workflow.runs.accuracy import main_results
from contact1d.workflow.scene import Scene

COLOURS = (COMPRESSION, TENSION, LOADING, UNLOADING, BLACK)
INPUT_COLUMNS = ("input", "half_width")
"""Columns of the table that are no changes of results."""


def inputs_of(scene: Scene, outcome: Outcome) -> dict[str, Any]:
    """Return the table `inputs`, by column: each input, its 95 % half-width, and the change of each main result.

    Columns are "input" (dotted keys), "half_width", and one of the name of each main result. Half-width and changes are
    relative to the values, dimensionless; a change is the larger one of both directions, ≥ 0. {} for a scene without
    uncertain inputs. A measured profile is one input, whose deviations add in squares and have no half-width (NaN); a
    result of size 0 has no relative change (NaN).
    """
    inputs = [move.key.partition(":")[0] for move in outcome.moves]
    keys = list(dict.fromkeys(inputs))
    if not keys:
        return {}
    table: dict[str, Any] = {"input": keys, "half_width": [scene.shares.get(key, np.nan) for key in keys]}
    for name, result in main_results(scene, outcome.results).items():
        pairs = list(zip(inputs, outcome.moves, strict=True))
        changes = [in_squares([move for name_of_input, move in pairs if name_of_input == key], name) for key in keys]
        size = abs(result.value) or result.size
        table[name] = [change / size if size else np.nan for change in changes]
    return table


def entries(table: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Return the table `inputs` as in results.json: a dict by column for each input, without what is NaN.

    `table`: columns of one length, by name; [] is returned without any.
    """
    rows = [dict(zip(table, row, strict=True)) for row in zip(*table.values(), strict=True)]
    return [{name: value for name, value in row.items() if value == value} for row in rows]


def chart(table: Mapping[str, Any]) -> Chart:
    """Return the bar chart of the relative changes of results [%] with the inputs of the table `inputs`.

    The inputs are one below the other, the largest change at the top. A change that is NaN has no bar.
    """
    names = [name for name in table if name not in INPUT_COLUMNS]
    changes = np.nan_to_num([table[name] for name in names])
    order = np.argsort(-changes.max(axis=0, initial=0.0), kind="stable")
    words = [table["input"][row].partition(".")[2].replace("profile.", "") for row in order]
    ticks = {-float(i): text.replace(".", " ").replace("_", " ") for i, text in enumerate(words)}
    filled = 0.8  # share of the axis that bars cover
    series, width = [], filled / max(len(names), 1)
    for number, name in enumerate(names):
        top = 0.5 * filled - np.arange(len(ticks)) - width * number
        x = np.outer(changes[number, order], [0.0, 100.0, 100.0, 0.0, np.nan]).ravel()
        y = np.subtract.outer(top, [0.0, 0.0, width, width, np.nan]).ravel()
        series.append(Series(x, y, name.replace("_", " "), COLOURS[number % len(COLOURS)], FILL))
    panel = Panel(Axis("", ticks=ticks), series, "each input varied over its uncertainty")
    return Chart(Axis("change of the result (%)", zero=True), [panel])


def in_words(document: Mapping[str, Any]) -> list[str]:
    """Return lines on the inputs of results.json for a terminal: a heading, then the inputs, the largest change first.

    Changes are in percent, in two digits. [] where the document has no inputs.
    """
    rows = [
        ({name: change for name, change in row.items() if name not in INPUT_COLUMNS}, row)
        for row in document.get("inputs", ())
    ]
    lines = []
    for changes, row in sorted(rows, key=lambda pair: -max(pair[0].values(), default=0.0)):
        width = f" ± {100.0 * row['half_width']:.2g} %" if "half_width" in row else ""
        text = ", ".join(f"{name.replace('_', ' ')} ± {100.0 * value:.2g} %" for name, value in changes.items())
        lines.append(f"  {row['input']}{width}: {text}")
    return ["\nchanges with the inputs, the largest first:", *lines] if lines else []
