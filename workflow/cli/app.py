"""The command line. Heavy imports wait until a command runs, so that `contact1d --help` is quick."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.arguments import Format, SceneFile, Set, Without
from contact1d.workflow.cli.ending import FAILS, Commands, command, read, say
from contact1d.workflow.cli.identify import identify
from contact1d.workflow.cli.scenes import new, schema
from contact1d.workflow.cli.studies import animate, cost, report, sweep

GARBAGE_THRESHOLD = 100_000
"""New objects after which Python looks for garbage: at 700, a tenth of what the imports take goes into looking."""

app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Exit codes: 0 done; 1 a check of `doctor` fails; 2 the scene or the call is wrong; "
    "3 the run failed or its result can't be trusted, files are kept; 130 interrupted. "
    "Units: LU length, FU force, MU mass, TU = sqrt(MU LU/FU); compression is positive.",
)


def _version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        typer.echo(f"contact1d {version('contact1d')}")
        raise typer.Exit


@app.callback()
def contact1d(
    version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
) -> None:
    """Contact, adhesion and friction with the one-dimensional particle model of Geike and Popov, on LAMMPS.

    A scene file says what the bodies are, which effects act and what is done with them. `run` turns it into a LAMMPS
    deck, runs it, and leaves a folder with numbers (results.json), tables (CSV), figures and the deck itself, which
    `lmp -in in.lammps` repeats. Start with `contact1d doctor`, `contact1d new my.toml`, `contact1d run my.toml`.
    """


def run(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        typer.Option(help="Run folder; an earlier run in it is replaced.", show_default="runs/<name of the scene>"),
    ] = None,
    set_: Set = None,
    without: Without = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
    format_: Annotated[Format, typer.Option("--format", help="Of the figures.")] = Format.PNG,
    time_limit: Annotated[float, typer.Option(min=0.1, help="Seconds of wall time for LAMMPS, per pass.")] = 3600.0,
    workers: Annotated[
        int | None, typer.Option(min=1, help="Repeats of a thermal pull-off at a time.", show_default="processors")
    ] = None,
    ranks: Annotated[int, typer.Option(min=1, help="MPI ranks (processors) that share one large contact.")] = 1,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the numbers only.")] = False,
) -> None:
    """Run a scene and print its numbers, each with its uncertainty."""
    folder = out if out is not None else Path("runs") / scene.stem
    with command("the run", folder, "no numbers were written", quiet) as progress:
        checked = read(scene, set_, without, progress)
        from contact1d.workflow.engine.process import start_ahead

        if ranks == 1:
            start_ahead()  # LAMMPS loads while numpy and the rest of the program do
        from contact1d.workflow.runs.advised import run as run_scene

        finished = run_scene(
            checked, folder, format_.value if figures else False, progress, time_limit, workers=workers, ranks=ranks
        )
    from contact1d.workflow.cli.summary import pressure_plot, quantities

    say(quantities(finished.document), finished.warnings)
    if not quiet:
        assert finished.outcome is not None
        name, profile = next(iter(finished.outcome.profiles.items()))
        typer.echo(f"\nline load, {name.replace('_', ' ')} state:")
        units = finished.document.get("units")
        typer.echo("\n".join(pressure_plot(profile, finished.outcome.radii[name], units)))
        typer.echo(f"\n{finished.folder}")


def deck(
    scene: SceneFile,
    out: Annotated[Path, typer.Option(help="Folder for in.lammps, system.data and the table.", show_default=False)],
    set_: Set = None,
    without: Without = None,
) -> None:
    """Write the LAMMPS deck of a scene without running it.

    Where a run searches (load, pull_off), the deck holds an estimated schedule; the deck that `run` leaves behind holds
    the one that its search ended with.
    """
    with command("writing the deck", out, quiet=True):
        checked = read(scene, set_, without)
        from contact1d.workflow.runs.campaign import write_deck

        folder = write_deck(checked, out)
    typer.echo(f"{folder}: run it there with lmp -in in.lammps")


def doctor() -> None:
    """Check whether this installation is whole: packages, MPI library, LAMMPS and what it must be able to do."""
    from contact1d.workflow.cli.doctor import checks

    bad = 0
    for check in checks():
        bad += not check.ok
        typer.secho(f"{'ok  ' if check.ok else 'FAIL'} {check.name}: {check.detail}", fg=None if check.ok else "red")
        if not check.ok and check.advice:
            typer.echo(f"     {check.advice}")
    if bad:
        raise typer.Exit(FAILS)


for one in (new, run, sweep, report, animate, deck, cost, identify, schema, doctor):
    app.command()(one)


def main() -> None:
    """Entry point of the command `contact1d`."""
    gc.set_threshold(GARBAGE_THRESHOLD)
    app(prog_name="contact1d")


if __name__ == "__main__":
    main()
