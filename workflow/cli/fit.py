"""The command `fit`: from measured force curves to parameters of a scene."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import CALL_IS_WRONG, RUN_FAILED, command, problems_in, say, stop


def fit(
    file: Annotated[Path, typer.Argument(metavar="FIT", help="A fit file (TOML).", show_default=False)],
    out: Annotated[Path | None, typer.Option(help="Folder.", show_default="fits/<name of the file>")] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes, of several curves.", show_default="processors")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the numbers only.")] = False,
) -> None:
    """Fit parameters of a scene, such as E and W, to a measured force curve, or to each of many.

    The file names the data (CSV with columns z or d, and F, with units), parameters, the instrument and a base scene.
    Leaves fit.json, curve.csv and fit.png; of several curves fits.csv, histograms and maps. Exit code 3: the data do
    not tell what was asked for, and the message says what would help.
    """
    folder = out if out is not None else Path("fits") / file.stem
    with command("the fit", folder, "what is known was written", quiet) as progress:
        from contact1d.workflow.fit.data import is_series
        from contact1d.workflow.fit.fit import fit as do
        from contact1d.workflow.fit.many import TABLE, fit_many
        from contact1d.workflow.fit.plan import read_fit
        from contact1d.workflow.fit.report import lines
        from contact1d.workflow.scene import SceneError

        try:
            plan = read_fit(file)
        except SceneError as error:
            stop(problems_in(str(file), error), CALL_IS_WRONG)
        if is_series(plan):
            done = fit_many(file, folder, workers, progress)
            progress.close()
            counts = ", ".join(f"{count} {status}" for status, count in sorted(done.counts.items()))
            typer.echo(f"{counts}; {folder / TABLE}")
            if set(done.counts) != {"done"}:
                raise typer.Exit(RUN_FAILED)
            return
        found = do(file, folder=folder, progress=progress)
        progress.close()
        say(lines(found), found.warnings, folder)
