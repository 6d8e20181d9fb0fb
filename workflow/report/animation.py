"""The states of a run as an animation: bodies and bulk springs, particles coloured by pressure, the force beneath."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import States, read_states
from contact1d.analysis.plots import COMPRESSION, DPI, TENSION, describe, in_si, panels, plain_axes
from contact1d.files import whole, write_whole
from contact1d.workflow.deck.steps import STATES
from contact1d.workflow.errors import Contact1dError, FolderError
from contact1d.workflow.report.charts import window
from contact1d.workflow.runs.campaign import AnyPath
from contact1d.workflow.runs.finished import Run, legs_of, load_run, main_curve

if TYPE_CHECKING:
    from matplotlib.axes import Axes

HEIGHT = 6.0
"""Of the picture [inch]."""
FORMATS = (".gif", ".mp4")
OVITO = "view_in_ovito.py"
SPRINGS_SHOWN = 160
"""Particles up to which each bulk spring is drawn; of more they would be a grey field."""
SPRING_LENGTH = 0.25
"""Length at which a spring is drawn, over the height of the picture: a bulk has none in the model."""


def animate(folder: AnyPath, out: AnyPath | None = None, frames_per_second: int = 10) -> Path:
    """Write the way of a finished run as GIF or MP4.

    Args:
        folder: the run folder.
        out: the file, by its ending; None: way.gif in the folder.
        frames_per_second: states a second.

    Returns:
        The file's path.

    Raises:
        FolderError: the folder holds no finished run, or one of a single state.
        Contact1dError: the ending is another one, or MP4 is asked for and there is no ffmpeg.
    """
    run = load_run(folder)
    path = Path(out) if out is not None else run.folder / "way.gif"
    if path.suffix not in FORMATS:
        raise Contact1dError(f"{path}: the name of an animation ends in {' or '.join(FORMATS)}")
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise Contact1dError("MP4 needs the program ffmpeg: install it, or take a name that ends in .gif")
    kept = run.folder / "states.npz"
    if not kept.is_file() or len(run.curve.force) < 2:
        raise FolderError(f"{folder} has a single state; an animation needs a path, pull_off, tangential or slide")
    _draw(run, read_states(kept), path, frames_per_second)
    return path


def ovito_script(folder: AnyPath) -> Path:
    """Put the script beside the states of a run with which OVITO shows them; returns its path.

    Raises:
        FolderError: the folder holds no finished run, or no states.
    """
    run = load_run(folder)
    missing = [name for name in (STATES, "system.data") if not (run.folder / name).is_file()]
    if missing:
        raise FolderError(f"{folder} lacks {' and '.join(missing)}, required by OVITO: run the scene again")
    path = run.folder / OVITO
    write_whole(path, files("contact1d.workflow.report").joinpath(OVITO).read_text(encoding="utf-8"))
    return path


def _draw(run: Run, states: States, path: Path, frames_per_second: int) -> None:
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter

    figure, (bodies, trace) = panels(2, HEIGHT, sharex=False, height_ratios=(2.0, 1.0))
    moves = _bodies(bodies, run, states), _trace(trace, run, states)
    plain_axes(in_si(figure, run.scales))

    def show(frame: int) -> list[Any]:
        return [artist for move in moves for artist in move(frame)]

    moving = FuncAnimation(figure, show, frames=len(states.rows), blit=False)
    writer = (PillowWriter if path.suffix == ".gif" else FFMpegWriter)(fps=frames_per_second)
    with whole(path) as part:
        named = part.with_suffix(part.suffix + path.suffix)  # the writer goes by the ending
        moving.save(str(named), writer=writer, dpi=DPI)
        named.replace(part)


def _bodies(axis: Axes, run: Run, states: States) -> Callable[[int], list[Any]]:
    """Particles, coloured by pressure, with their bulk springs; returns what moves them. A plane has no particles."""
    from matplotlib.collections import LineCollection

    half, view = window(states)
    x, low, high, pressure = (a[:, view] for a in (states.x, states.z_lower, states.z_upper, states.pressure))
    bottom, top = float(low.min()), float(high.max())
    length = SPRING_LENGTH * ((top - bottom) or 1.0)
    scale = float(np.abs(pressure).max()) or 1.0
    springs = LineCollection([], colors="#bbbbbb", linewidths=0.6)
    axis.add_collection(springs)
    look: dict[str, Any] = {"cmap": "coolwarm_r", "vmin": -scale, "vmax": scale, "s": 12, "zorder": 3}
    chains = [(axis.scatter(x[0], high[0], c=pressure[0], **look), high, length)]
    has_plane = run.scene.bodies.lower == "rigid_plane"
    if not has_plane:
        chains.append((axis.scatter(x[0], low[0], c=pressure[0], **look), low, -length))
    axis.figure.colorbar(chains[0][0], ax=axis, label="line load (FU/LU), compression positive", shrink=0.9)
    axis.set(xlim=(-half, half), ylim=(bottom - 1.1 * length, top + 1.1 * length))
    describe(axis, "x (LU)", "z (LU), magnified", run.scene.title, zero=has_plane)

    def move(frame: int) -> list[Any]:
        for dots, z, _ in chains:
            dots.set_offsets(np.column_stack([x[frame], z[frame]]))
            dots.set_array(pressure[frame])
        if x.shape[1] <= SPRINGS_SHOWN:
            springs.set_segments([line for _, z, end in chains for line in _segments(x[frame], z[frame], end)])
        return [*(dots for dots, _, _ in chains), springs]

    return move


def _segments(x: NDArray[np.float32], z: NDArray[np.float32], length: float) -> list[Any]:
    return [((a, b), (a, b + length)) for a, b in zip(x.tolist(), z.tolist(), strict=True)]


def _trace(axis: Axes, run: Run, states: States) -> Callable[[int], list[Any]]:
    """The main curve with a mark; returns what moves it."""
    (x_name, (x_unit, x)), (y_name, (y_unit, y)) = main_curve(run.model).items()
    for _, rows in legs_of(run, x):
        axis.plot(x[rows], y[rows], color=COMPRESSION, linewidth=1.2)
    describe(axis, f"{x_name} ({x_unit})", f"{y_name} ({y_unit})")
    (mark,) = axis.plot([], [], "o", color=TENSION, markersize=8)

    def move(frame: int) -> list[Any]:
        row = states.rows[frame]
        mark.set_data([x[row]], [y[row]])
        return [mark]

    return move
