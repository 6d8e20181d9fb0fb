"""The command `report`: one HTML page for runs or a sweep."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import command


def report(
    folders: Annotated[
        list[Path],
        typer.Argument(metavar="DIR…", help="Run folders, which are overlaid; or one sweep's.", show_default=False),
    ],
    out: Annotated[Path, typer.Option(help="The page.")] = Path("report.html"),
) -> None:
    """Write a page of runs or of a sweep, with figures that answer to the hand; it needs no network, no other file."""
    with command("the report", quiet=True):
        from contact1d.workflow.report.report import report as write

        path = write(folders, out)
    typer.echo(path)
