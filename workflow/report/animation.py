"""Animations of the states of a run: bodies and bulk springs, particles coloured by pressure, the force below."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import BadZipFile

import numpy as np

from contact1d.analysis.chart import Chart, Panel
from contact1d.analysis.curve import States, read_states
from contact1d.analysis.plots import DPI, WIDTH, describe, draw_panel, new_figure, plain_axes
from contact1d.files import AnyPath, whole, write_whole
from contact1d.workflow.deck.steps import STATES
from contact1d.workflow.errors import Contact1dError, FolderError
from contact1d.workflow.report.charts import moving
from contact1d.workflow.runs.finished import Run, load_run

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

HEIGHT = 6.0
"""Height of an animation [inch]."""
FORMATS = (".gif", ".mp4")
OVITO = "view_in_ovito.py"


def animate(folder: AnyPath, out: AnyPath | None = None, frames_per_second: int = 10) -> Path:
    """Return the path of an animation, GIF or MP4, of the states of a finished run, after writing it.

    An existing file is replaced.

    Args:
        folder: run folder.
        out: file to write, whose suffix, in small letters, is the format; None: way.gif in the run folder.
        frames_per_second: states per second.

    Raises:
        FolderError: the folder holds no run, or one of a single state or without states.npz that can be read.
        RunError: the run failed.
        Contact1dError: the suffix is neither .gif nor .mp4, or MP4 is wanted without ffmpeg.
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
    try:
        states = read_states(kept)
    except (OSError, ValueError, BadZipFile) as error:
        raise FolderError(f"{kept} cannot be read ({error}): run the scene again") from None
    _draw(run, states, path, frames_per_second)
    return path


def ovito_script(folder: AnyPath) -> Path:
    """Return the path of the script with which OVITO shows the states of a run, after writing it into the run's folder.

    The folder is the absolute one; an earlier script is replaced.

    Raises:
        FolderError: the folder holds no run, or no states.
        RunError: the run failed.
    """
    run = load_run(folder)
    missing = [name for name in (STATES, "system.data") if not (run.folder / name).is_file()]
    if missing:
        raise FolderError(f"{folder} lacks {' and '.join(missing)}, required by OVITO: run the scene again")
    path = run.folder / OVITO
    write_whole(path, files("contact1d.workflow.report").joinpath(OVITO).read_text(encoding="utf-8"))
    return path


def _draw(run: Run, states: States, path: Path, frames_per_second: int) -> None:
    """Write the animation of a run's states, GIF or MP4 by the suffix of `path`: bodies above, the main curve below.

    The curve has a mark at the state. Where the drawing fails, an earlier file stays.
    """
    from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter

    figure = new_figure((WIDTH, HEIGHT))
    above, below = figure.subplots(2, 1, height_ratios=(2.0, 1.0))
    curve, loads, bodies = moving(run, states)
    moves = _bodies(above, run, bodies, loads.panels[0]), _trace(below, curve)
    plain_axes(figure)
    figure.draw_without_rendering()
    figure.set_layout_engine(None)  # the layout is the same for all states
    animation = FuncAnimation(
        figure, lambda frame: [move(frame) for move in moves], frames=len(states.rows), blit=False
    )  # fmt: skip
    writer = (PillowWriter if path.suffix == ".gif" else FFMpegWriter)(fps=frames_per_second)
    with whole(path) as part:
        named = part.with_suffix(part.suffix + path.suffix)  # the writer takes the format from the suffix
        animation.save(str(named), writer=writer, dpi=DPI)
        named.replace(part)


def _bodies(axes: Axes, run: Run, chart: Chart, loads: Panel, most_springs: int = 160) -> Callable[[int], Artist]:
    """Draw the axes of the bodies, and return the function that draws the particles of a state, by its index, there.

    Particles are coloured by pressure; chains of up to `most_springs` particles have bulk springs, which of more would
    be a grey area. On a rigid plane there is the upper body only, and a line at 0.

    Args:
        axes: to draw into.
        run: that is shown.
        chart: heights over x of the upper and the lower body, a row for each state.
        loads: line load of the particles, a row for each state.
        most_springs: number of particles.
    """
    from matplotlib.collections import LineCollection

    (panel,), on_plane = chart.panels, run.scene.bodies.lower == "rigid_plane"
    chains = panel.series[:1] if on_plane else panel.series
    positions = np.concatenate([np.stack(np.broadcast_arrays(line.x, line.y), axis=-1) for line in chains], axis=1)
    pressure = np.tile(loads.series[0].y, len(chains))
    # The bulk springs have no length in the model: a quarter of the height is drawn.
    length, scale = 0.25 * float(np.ptp(panel.y.view)), float(np.abs(pressure).max()) or 1.0
    count = positions.shape[1] // len(chains)
    ends = np.repeat([[0.0, length], [0.0, -length]], count, axis=0)[: positions.shape[1]]
    springs = LineCollection([], colors="#bbbbbb", linewidths=0.6)
    axes.add_collection(springs)
    dots = axes.scatter([], [], c=[], s=12, cmap="coolwarm_r", vmin=-scale, vmax=scale, zorder=3)
    axes.figure.colorbar(dots, ax=axes, label=f"{loads.y.label}, compression positive", shrink=0.9)
    low, high = panel.y.view
    axes.set(xlim=chart.x.view, ylim=(low - length, high + length))
    describe(axes, chart.x.label, panel.y.label, run.scene.title, zero=on_plane)

    def move(frame: int) -> Artist:
        """Draw the particles of the state with this index, and return them."""
        dots.set_offsets(positions[frame])
        dots.set_array(pressure[frame])
        if count <= most_springs:
            springs.set_segments(list(np.stack([positions[frame], positions[frame] + ends], axis=1)))
        return dots

    return move


def _trace(axes: Axes, chart: Chart) -> Callable[[int], Artist]:
    """Draw the main curve, mostly force over displacement, and return the function that puts its mark at a state.

    `axes` is changed; the function takes the index of a state.
    """
    (panel,) = chart.panels
    *curve, state = panel.series
    draw_panel(axes, chart.x, replace(panel, series=curve))
    (mark,) = axes.plot([], [], state.look, color=state.colour, markersize=8)

    def move(frame: int) -> Artist:
        """Put the mark at the state with this index, and return it."""
        mark.set_data(state.x[frame], state.y[frame])
        return mark

    return move
