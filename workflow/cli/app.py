"""The command line. Heavy imports wait until a command runs, so that `contact1d --help` is quick."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contact1d.workflow.cli.cost import cost
from contact1d.workflow.cli.paper import INTERRUPTED, RUN_FAILED, SCENE_IS_WRONG, identify, reproduce, stop
from contact1d.workflow.cli.stability import stability

if TYPE_CHECKING:
    from contact1d.workflow.scene import Scene

SELDOM = 100_000
"""New objects after which Python looks for garbage: at 700, a tenth of what the imports take goes into looking."""

app = typer.Typer(
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Exit codes: 0 done; 2 the scene is wrong, nothing was written; 3 the run failed or its result can't be "
    "trusted, files are kept. Units: LU length, FU force, MU mass, TU = sqrt(MU LU/FU); compression is positive.",
)

SceneFile = Annotated[Path, typer.Argument(metavar="SCENE", help="A scene file (TOML).", show_default=False)]
Set = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="TABLE.KEY=VALUE",
        help="Change one value of the scene, as often as needed: `--set bodies.profile.radius=2000`.",
        show_default=False,
    ),
]
Without = Annotated[
    list[str] | None,
    typer.Option(metavar="EFFECT", help="Leave out an effect's table: `--without noise`.", show_default=False),
]


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
    `lmp -in in.lammps` repeats. Start with `contact1d doctor`, then `contact1d run lammps_inputs/scenes/pull_off.toml`.
    """


@app.command()
def run(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        typer.Option(help="Run folder; an earlier run in it is replaced.", show_default="runs/<name of the scene>"),
    ] = None,
    set_: Set = None,
    without: Without = None,
    figures: Annotated[bool, typer.Option("--figures/--no-figures", help="Draw the figures.")] = True,
    time_limit: Annotated[float, typer.Option(min=0.1, help="Seconds of wall time for LAMMPS, per pass.")] = 3600.0,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="Print the numbers only.")] = False,
) -> None:
    """Run a scene and print its numbers, each with its uncertainty."""
    checked = _read(scene, set_, without)
    from contact1d.workflow.engine.process import start_ahead

    start_ahead()  # LAMMPS loads while numpy and the rest of the program do
    from contact1d.workflow.engine.progress import Silent, choose_progress
    from contact1d.workflow.runs.campaign import FolderError, RunError
    from contact1d.workflow.runs.campaign import run as run_scene
    from contact1d.workflow.settings.settings import SettingsError

    progress = Silent() if quiet else choose_progress()
    try:
        finished = run_scene(checked, _folder(scene, out), figures, progress, time_limit)
    except (FolderError, SettingsError) as error:
        stop(str(error), SCENE_IS_WRONG)
    except RunError as error:
        progress.close()
        stop(f"the run failed: {error}", RUN_FAILED)
    except KeyboardInterrupt:
        progress.close()
        stop("interrupted; no numbers were written", INTERRUPTED)
    progress.close()
    from contact1d.workflow.cli.summary import pressure_plot, quantities

    typer.echo("\n".join(quantities(finished.results)))
    for warning in finished.results["warnings"]:
        typer.secho(f"warning {warning['name']}: {warning['message']}", err=True, fg="yellow")
    if not quiet:
        name, profile = next(iter(finished.outcome.profiles.items()))
        typer.echo(f"\npressure, {name.replace('_', ' ')} state:")
        typer.echo("\n".join(pressure_plot(profile, finished.outcome.radii[name])))
        typer.echo(f"\n{finished.folder}")


@app.command()
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
    checked = _read(scene, set_, without)
    from contact1d.workflow.runs.campaign import FolderError, write_deck
    from contact1d.workflow.settings.settings import SettingsError

    try:
        folder = write_deck(checked, out)
    except (FolderError, SettingsError) as error:
        stop(str(error), SCENE_IS_WRONG)
    typer.echo(f"{folder}: run it there with lmp -in in.lammps")


@app.command()
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
        raise typer.Exit(1)


app.command()(identify)
app.command()(reproduce)
app.command()(cost)
app.command()(stability)


def _read(path: Path, overrides: list[str] | None, without: list[str] | None) -> Scene:
    from contact1d.workflow.scene import SceneError, read_scene

    try:
        return read_scene(path, tuple(overrides or ()), tuple(without or ()))
    except SceneError as error:
        count = len(error.problems)
        lines = [f"{path}: {count} problem{'s' if count > 1 else ''}", *(f"  {problem}" for problem in error.problems)]
        stop("\n".join(lines), SCENE_IS_WRONG)


def _folder(scene: Path, out: Path | None) -> Path:
    return out if out is not None else Path("runs") / scene.stem


def main() -> None:
    """Entry point of the command `contact1d`."""
    gc.set_threshold(SELDOM)
    app(prog_name="contact1d")


if __name__ == "__main__":
    main()
