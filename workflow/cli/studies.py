"""The commands over many runs, `sweep` and `cost`, and over finished ones, `report` and `animate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.arguments import Format, SceneFile, Set, Without, scene_files
from contact1d.workflow.cli.ending import RUN_FAILED, command, read


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


def cost(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for cost.json, cost.csv, cost.png.", show_default="costs/<name of the scene>"),
    ] = None,
    set_: Set = None,
    without: Without = None,
    repeats: Annotated[int, typer.Option(min=1, help="Runs of each variant; times are their medians.")] = 3,
    workers: Annotated[int | None, typer.Option(min=1, help="Runs at a time.", show_default="processors")] = None,
) -> None:
    """Measure what accuracy costs in time: every numerical knob of a scene, its error beside its CPU time.

    Leaves cost.json, cost.csv and a work-precision figure, cost.png, and says for each tolerance what reaches it at
    the least cost. The scene itself is not changed.
    """
    folder = out if out is not None else Path("costs") / scene.stem
    with command("the study", kept="it begins anew next time") as progress:
        asked = read(scene, set_, without)
        from contact1d.workflow.cost.report import summary, write_report
        from contact1d.workflow.cost.study import cost_of
        from contact1d.workflow.experiments.spacing import with_spacing
        from contact1d.workflow.model.settings import settings_for
        from contact1d.workflow.runs.processors import cores

        checked = with_spacing(asked)
        settings_for(checked)
        folder.mkdir(parents=True, exist_ok=True)
        record = cost_of(checked, scene.stem, folder, repeats, workers or cores(), progress)
        write_report(record, folder)
    typer.echo("\n".join(summary(record)) + f"; {folder}")


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
