"""The command `animate`: the way of a run as moving pictures."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import command


def animate(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="The folder of a finished run.", show_default=False)],
    out: Annotated[
        Path | None, typer.Option(help="The file, .gif or .mp4.", show_default="way.gif in the folder")
    ] = None,
    speed: Annotated[int, typer.Option(min=1, max=50, help="States a second.")] = 10,
    ovito: Annotated[
        bool, typer.Option("--ovito", help="In place of pictures a script in the folder, by which OVITO shows the way.")
    ] = False,
) -> None:
    """Write the way of a run as moving pictures: bodies and springs, particles coloured by pressure, the force.

    It has the states that the run kept: those of its curve, thinned where they are many; or, in states.lammpstrj, too,
    all of them with `[output] states = "all"` in the scene.
    """
    with command("the picture", quiet=True):
        from contact1d.workflow.report.animation import animate as write
        from contact1d.workflow.report.animation import ovito_script

        path = ovito_script(folder) if ovito else write(folder, out, speed)
    typer.echo(path)
