"""docs/gallery.md and its figures from validation/gallery.toml: `python -m docs.gallery` in a checkout."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from matplotlib.ticker import EngFormatter, MaxNLocator

from contact1d import Quantity
from contact1d.analysis.chart import THEORY
from contact1d.analysis.plots import new_figure, save_figure
from validation.figures import COLOURS
from validation.gallery import CHAPTERS, PROBLEMS, Problem
from validation.page import number, table, write_between

HEAD = ("problem", "result", "±", "closed form", "error/±")
ROUND_OFF = 1e-7
"""Relative: smaller uncertainties are round-off of a processor, and are not printed."""
COLUMNS, DIGITS = 3, 5
FIELDS = {
    "r": ("r", "m"), "pressure": ("p", "Pa"), "displacement": ("d", "m"), "force": ("F", "N"), "time": ("t", "s"),
    "tangential_displacement": ("u", "m"), "tangential_force": ("T", "N"),
}  # fmt: skip
"""Symbol and unit of each axis."""


def text_of(value: float, unit: str) -> str:
    """Return a number with so many digits and an SI prefix."""
    return str(Quantity(float(f"{value:.{DIGITS - 1}e}"), 0.0, unit))


def cells(problem: Problem) -> tuple[str, ...]:
    """Return a line of the table."""
    result = problem.run.results[problem.quantity]
    share = result.uncertainty / abs(result.value)
    parts = (f"{number(100.0 * share, 2)} %", f"{problem.over:.1f}") if share > ROUND_OFF else ("< 10⁻⁵ %", "< 1")
    values = [text_of(value, result.unit) for value in (result.value, problem.exact["value"])]
    texts = values[0], parts[0], values[1], parts[1]
    return f"[{problem.name}](#{anchor(problem)})", *(text.replace(" ", "\N{NO-BREAK SPACE}") for text in texts)


def anchor(problem: Problem) -> str:
    """Return the name of a problem as part of an address."""
    return "".join(letter if letter.isalnum() else "-" for letter in problem.name.lower())


def problems_of(chapter: dict[str, Any]) -> list[Problem]:
    """Return the problems of a chapter."""
    names = [entry["name"] for entry in chapter["problems"]]
    return [problem for problem in PROBLEMS if problem.name in names]


def draw(problems: list[Problem], path: Path) -> None:
    """Save a panel of each problem: circles of the run, line of the closed form; whole or not at all."""
    rows = math.ceil(len(problems) / COLUMNS)
    figure = new_figure((3.6 * COLUMNS, 2.6 * rows))
    panels = figure.subplots(rows, COLUMNS, squeeze=False).ravel()
    for axis, problem in zip(panels, problems, strict=False):
        of_states = problem.run.body_pressures
        shown = of_states["final"] if problem.axes[0] == "r" else problem.run.curve
        x, y = (shown[name] for name in problem.axes)
        axis.plot(x, y, "o", color=COLOURS[0], markersize=3.5, fillstyle="none", markevery=max(1, x.size // 40))
        view = axis.get_xlim(), axis.get_ylim()
        line = problem.exact["x"], problem.exact["y"]
        axis.plot(*line, "-" if len(line[0]) > 1 else "+", color=THEORY, linewidth=1.0, markersize=12)
        axis.set(xlim=view[0], ylim=view[1])
        for direction, name in zip((axis.xaxis, axis.yaxis), problem.axes, strict=True):
            symbol, unit = FIELDS[name]
            direction.set_label_text(symbol, fontsize=9)
            direction.set_major_formatter(EngFormatter(unit))
            direction.set_major_locator(MaxNLocator(4))
        axis.set_title(problem.name, fontsize=9)
        axis.tick_params(labelsize=8)
    for axis in panels[len(problems) :]:
        axis.set_axis_off()
    save_figure(figure, path)


def lines() -> Iterator[str]:
    """Yield the table of all problems; of each chapter heading and figure, and formula and scene of each problem."""
    yield table(HEAD, [cells(problem) for problem in PROBLEMS])
    for chapter in CHAPTERS:
        figure = f"![Runs and closed forms](gallery_{chapter['number']}.png)"
        yield f"## {chapter['title']}\n\nChapter {chapter['number']} of the handbook.\n\n{figure}\n"
        for problem in problems_of(chapter):
            yield f'<details markdown><summary>{problem.name}</summary>\n\n<a id="{anchor(problem)}"></a>\n'
            yield f'$$\n{problem.formula}\n$$\n\n```toml\ntitle = "{problem.name}"\n\n{problem.scene}```\n'
            yield f"Result: `{problem.quantity}`.\n"
            yield "</details>\n"


def page() -> str:
    """Return what docs/gallery.md shows between its markers."""
    return "\n".join(lines())


if __name__ == "__main__":
    here = Path(__file__).parent
    write_between(here / "gallery.md", "gallery", page())
    for one in CHAPTERS:
        draw(problems_of(one), here / f"gallery_{one['number']}.png")
