"""The command `sweep`: a base scene over axes of values."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.arguments import Format, scene_files
from contact1d.workflow.cli.ending import RUN_FAILED, command


def sweep(
    file: Annotated[
        Path,
        typer.Argument(metavar="SWEEP", help="A sweep file (TOML).", show_default=False, autocompletion=scene_files),
    ],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder of the sweep; what is done there is kept.", show_default="sweeps/<name of the file>"),
    ] = None,
    executor: Annotated[str, typer.Option(help="`local`: processes here; `slurm`: jobs of a cluster.")] = "local",
    workers: Annotated[
        int | None, typer.Option(min=1, help="Processes, or jobs, at a time.", show_default="processors")
    ] = None,
    partition: Annotated[str | None, typer.Option(help="Of Slurm.", show_default="its default")] = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
    format_: Annotated[Format, typer.Option("--format", help="Of the figures.")] = Format.PNG,
    parquet: Annotated[bool, typer.Option("--parquet", help="Write the table as Parquet as well.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the end only.")] = False,
) -> None:
    """Run a scene at each point of a sweep; one table, results.csv, has all results.

    The file names a base scene and [[axes]], each with a key of the scene and its values. Broken off at any moment, the
    same command goes on with what is missing. Exit code 3: a point failed or can't be run; the table says why.
    """
    folder = out if out is not None else Path("sweeps") / file.stem
    kept = f"finished runs are kept in {folder}, and the same command goes on"
    with command("the sweep", kept=kept, quiet=quiet) as progress:
        from contact1d.workflow.sweep.sweep import sweep as do
        from contact1d.workflow.sweep.table import TABLE, write_parquet

        done = do(file, folder, executor, workers, format_.value if figures else False, progress, partition)
        if parquet:
            write_parquet(done.folder)
    counts = ", ".join(f"{count} {status}" for status, count in sorted(done.counts.items()))
    typer.echo(f"{counts}; {folder / TABLE}")
    if set(done.counts) != {"done"}:
        raise typer.Exit(RUN_FAILED)
