"""The commands and their options. Heavy imports are inside the commands, so that `contact1d --help` is quick."""

from __future__ import annotations

import atexit
import gc
import os
from enum import StrEnum
from glob import escape, glob
from pathlib import Path
from shlex import quote
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer import Argument, Option

import contact1d as api
from contact1d.workflow.cli.ending import (
    CALL_IS_WRONG,
    FAILS,
    Commands,
    command,
    print_counts,
    print_lines,
    read,
    stop,
)
from contact1d.workflow.cli.identify import identify

if TYPE_CHECKING:
    from contact1d.workflow.runs.finished import Run


app = typer.Typer(
    cls=Commands,
    no_args_is_help=True,
    rich_markup_mode="markdown",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    epilog="Exit codes: 0 done; 1 a check of `doctor` failed; 2 the scene or the call is wrong; "
    "3 the run failed or its result can't be trusted, files are kept; 130 interrupted. "
    "Units: LU length, FU force, MU mass, TU = sqrt(MU LU/FU); compression is positive.",
)


def _version(wanted: bool) -> None:
    """Print the version and end the program by typer.Exit, if it is `wanted`; else do nothing."""
    if wanted:
        typer.echo(f"contact1d {api.__version__}")
        raise typer.Exit


def _cite(wanted: bool) -> None:
    """Print what to cite, in BibTeX, and end the program by typer.Exit, if it is `wanted`; else do nothing."""
    if wanted:
        typer.echo(Path(__file__).with_name("citation.bib").read_text(encoding="utf-8"), nl=False)
        raise typer.Exit


@app.callback()
def contact1d(
    version: Annotated[
        bool, Option("--version", callback=_version, is_eager=True, help="Show the version and exit.")
    ] = False,
    cite: Annotated[
        bool, Option("--cite", callback=_cite, is_eager=True, help="Show what to cite, in BibTeX, and exit.")
    ] = False,
) -> None:
    """Contact, adhesion and friction with the one-dimensional particle model of Geike and Popov, on LAMMPS.

    A scene file describes the bodies, the effects and the experiment. `run` turns it into a LAMMPS
    deck, runs it, and leaves a folder with numbers (results.json), tables (CSV), figures and the deck itself, which
    `lmp -in in.lammps` repeats. Start with `contact1d doctor`, `contact1d new my.toml`, `contact1d run my.toml`.
    """


def scene_files(incomplete: str) -> list[str]:
    """Return the *.toml files and the folders, ending in "/", whose paths begin with `incomplete`, for completion.

    Files come first, both are sorted. Where that is a single folder and no file, it is what is in that folder, and so
    on; empty without any.
    """
    paths = sorted(glob(f"{escape(incomplete)}*"))
    files = [path for path in paths if path.endswith(".toml")]
    folders = [os.path.join(path, "") for path in paths if os.path.isdir(path)]
    return scene_files(folders[0]) if len(folders) == 1 and not files else files + folders


def effect_names(incomplete: str) -> list[str]:
    """Return the names of the effects that begin with `incomplete`, for completion; all for "", [] for none."""
    from contact1d.workflow.scene import EFFECTS

    return [name for name in EFFECTS if name.startswith(incomplete)]


Format = StrEnum("Format", ["PNG", "SVG", "PDF"])
"""File formats of figures."""


SceneFile = Annotated[
    Path,
    Argument(
        metavar="SCENE", help="A scene file (TOML); `new` writes one.", show_default=False, autocompletion=scene_files
    ),
]
Set = Annotated[
    list[str] | None,
    Option(
        "--set",
        metavar="TABLE.KEY=VALUE",
        help="Change one value of the scene, as often as needed: `--set bodies.profile.radius=2000`.",
        show_default=False,
    ),
]
Without = Annotated[
    list[str] | None,
    Option(
        metavar="EFFECT",
        help="Leave out an effect's table: `--without noise`.",
        show_default=False,
        autocompletion=effect_names,
    ),
]
Figures = Annotated[bool, Option("--figures/--no-figures", help="Draw the figures.")]
Quiet = Annotated[bool, Option("--quiet", "-q", help="Print the numbers only.")]
FigureFormat = Annotated[Format, Option("--format", help="File format of the figures.")]


def _parallel(meaning: str) -> Any:
    """Return a typer option of how many of something run at a time, by default as many as there are processors."""
    return Option(min=1, help=meaning, show_default="processors")


def run(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        Option(help="Run folder; an earlier run in it is replaced.", show_default="runs/<name of the scene>"),
    ] = None,
    set_: Set = None,
    without: Without = None,
    figures: Figures = True,
    format_: FigureFormat = Format.PNG,
    time_limit: Annotated[float, Option(min=0.1, help="Seconds of wall time for LAMMPS, per pass.")] = 3600.0,
    workers: Annotated[int | None, _parallel("Repeats of a thermal pull-off in parallel.")] = None,
    ranks: Annotated[int, Option(min=1, help="MPI ranks (processors) that share one large contact.")] = 1,
    quiet: Quiet = False,
) -> None:
    """Run a scene and print its numbers, each with its uncertainty.

    Leaves a folder with numbers, tables, figures and the LAMMPS deck. Warnings are printed on standard error. Of a
    wrong scene nothing is written (exit code 2); a run that failed has exit code 3.
    """
    folder = out or Path("runs") / scene.stem
    with command("the run", folder, "no numbers were written", quiet) as progress:
        from contact1d.workflow.engine.process import start_ahead

        if ranks == 1:
            start_ahead()  # LAMMPS loads while numpy and the rest of the program do
        checked = read(scene, set_, without, progress)

        def printed(finished: Run) -> None:
            """Close the progress and print the results and warnings of a run.

            Unless `quiet` its line load and its folder follow.
            """
            progress.close()
            from contact1d.workflow.cli.summary import line_load, quantities

            print_lines(quantities(finished.document), finished.warnings)
            if not quiet:
                print_lines(line_load(finished), {}, finished.folder)

        wanted = format_.value if figures else False
        api.run(checked, folder, wanted, progress, time_limit, workers=workers, ranks=ranks, printed=printed)


def deck(
    scene: SceneFile,
    out: Annotated[Path, Option(help="Folder for in.lammps, system.data and the table.", show_default=False)],
    set_: Set = None,
    without: Without = None,
) -> None:
    """Write the LAMMPS deck of a scene without running it.

    Prints the folder. An earlier run or deck in it is replaced. Where a run searches (load, pull_off), the deck has an
    estimated schedule; the deck in the folder of a finished run has the final one.
    """
    with command("writing the deck", out, quiet=True):
        folder = api.write_deck(read(scene, set_, without), out)
    typer.echo(f"{folder}: run it there with lmp -in in.lammps")


def doctor() -> None:
    """Check the installation: packages, MPI library, LAMMPS and its styles.

    Prints a line for each check, with a suggested fix where it failed. Exit code 1: a check failed.
    """
    from contact1d.workflow.cli.doctor import checks

    failed = 0
    for check in checks():
        failed += not check.ok
        typer.secho(f"{'ok  ' if check.ok else 'FAIL'} {check.name}: {check.detail}", fg=None if check.ok else "red")
        if not check.ok and check.advice:
            typer.echo(f"     {check.advice}")
    if failed:
        raise typer.Exit(FAILS)


def sweep(
    file: Annotated[
        Path,
        Argument(metavar="SWEEP", help="A sweep file (TOML).", show_default=False, autocompletion=scene_files),
    ],
    out: Annotated[
        Path | None,
        Option(help="Folder of the sweep; its finished points stay.", show_default="sweeps/<name of the file>"),
    ] = None,
    executor: Annotated[str, Option(help="`local`: processes here; `slurm`: jobs of a cluster.")] = "local",
    workers: Annotated[int | None, _parallel("Processes or jobs in parallel.")] = None,
    partition: Annotated[str | None, Option(help="Partition of Slurm.", show_default="its default")] = None,
    figures: Figures = True,
    format_: FigureFormat = Format.PNG,
    parquet: Annotated[bool, Option("--parquet", help="Write the table as Parquet as well.")] = False,
    quiet: Annotated[bool, Option("--quiet", "-q", help="Print the summary only.")] = False,
) -> None:
    """Run a scene at each point of a sweep; one table, results.csv, has all results.

    The file names a base scene and [[axes]], each with a key of the scene and its values. After an interruption the
    same command continues with the missing points. Prints the number of points by status and the path of the table.
    Exit code 3: a point failed or can't be run; the table says why.
    """
    folder = out or Path("sweeps") / file.stem
    kept = f"finished runs are kept in {folder}, and the same command continues"
    with command("the sweep", kept=kept, quiet=quiet) as progress:
        from contact1d.workflow.sweep.table import TABLE, write_parquet

        done = api.sweep(file, folder, executor, workers, format_.value if figures else False, progress, partition)
        if parquet:
            write_parquet(done.folder)
    print_counts(done.counts, folder / TABLE)


def fit(
    file: Annotated[Path, Argument(metavar="FIT", help="A fit file (TOML).", show_default=False)],
    out: Annotated[Path | None, Option(help="Folder.", show_default="fits/<name of the file>")] = None,
    workers: Annotated[int | None, _parallel("Processes, of several curves.")] = None,
    quiet: Quiet = False,
) -> None:
    """Fit parameters of a scene, such as E and W, to a measured force curve, or to each of many.

    The file names the data (CSV with columns z or d, and F, with units), parameters, the instrument and a base scene.
    Leaves fit.json, curve.csv and fit.png; of several curves fits.csv, histograms and maps. Exit code 3: the data do
    not determine the parameters, and the message suggests a fix.
    """
    folder = out or Path("fits") / file.stem
    with command("the fit", folder, "the results so far were written", quiet, str(file)) as progress:
        from contact1d.workflow.fit.data import is_series
        from contact1d.workflow.fit.many import TABLE
        from contact1d.workflow.fit.plan import read_fit
        from contact1d.workflow.fit.report import lines

        if is_series(read_fit(file)):
            done = api.fit_many(file, folder, workers, progress)
            progress.close()
            print_counts(done.counts, folder / TABLE)
            return
        fitted = api.fit(file, folder=folder, progress=progress)
        progress.close()
        print_lines(lines(fitted), fitted.warnings, folder)


def cost(
    scene: SceneFile,
    out: Annotated[
        Path | None,
        Option(help="Folder for cost.json and cost.png.", show_default="costs/<name of the scene>"),
    ] = None,
    set_: Set = None,
    without: Without = None,
    repeats: Annotated[int, Option(min=1, help="Runs of each variant; times are their medians.")] = 3,
    workers: Annotated[int | None, _parallel("Runs in parallel.")] = None,
) -> None:
    """Measure the cost of accuracy: true error and CPU time of a scene over its tolerance, settings and effects.

    Prints a row for each: error against a run that is finer in all, time, the dominant error; then what to do. Leaves
    cost.json and cost.png, a work-precision figure. The scene itself is not changed.
    """
    folder = out or Path("costs") / scene.stem
    with command("the study", kept="run it again from the start") as progress:
        checked = read(scene, set_, without)
        from contact1d.workflow.cost.report import summary, write_report
        from contact1d.workflow.cost.study import cost_of
        from contact1d.workflow.experiments.spacing import with_spacing
        from contact1d.workflow.model.settings import settings_for
        from contact1d.workflow.runs.processors import cores

        settings_for(with_spacing(checked))
        folder.mkdir(parents=True, exist_ok=True)
        record = cost_of(checked, folder, repeats, workers or cores(), progress)
        write_report(record, folder)
    print_lines(summary(record), {}, folder)


def report(
    folders: Annotated[
        list[Path],
        Argument(metavar="DIR…", help="Run folders, shown together, or one of a sweep or fit.", show_default=False),
    ],
    out: Annotated[Path, Option(help="HTML file to write; .html is added.")] = Path("report.html"),
) -> None:
    """Write a page of runs, a sweep or a fit, with interactive figures; it needs no network and no other file.

    Prints the path. An earlier page is replaced, any other file is not (exit code 2).
    """
    with command("the report", quiet=True):
        from contact1d.workflow.report.report import report as write

        path = write(folders, out)
    typer.echo(path)


def animate(
    folder: Annotated[Path, Argument(metavar="DIR", help="The folder of a finished run.", show_default=False)],
    out: Annotated[
        Path | None, Option(help="File to write, .gif or .mp4.", show_default="way.gif in the folder")
    ] = None,
    speed: Annotated[int, Option(min=1, max=50, help="States per second.")] = 10,
    ovito: Annotated[bool, Option("--ovito", help="Write a script for OVITO into the folder instead.")] = False,
) -> None:
    """Write an animation of the loading history of a run: bodies and springs, particles coloured by pressure, force.

    Prints the path; an existing file is replaced. It has the states that the run kept: those of its curve, thinned
    where they are many; or, in states.lammpstrj, too, all of them with `[output] states = "all"` in the scene.
    """
    with command("the animation", quiet=True):
        from contact1d.workflow.report.animation import animate as write
        from contact1d.workflow.report.animation import ovito_script

        path = ovito_script(folder) if ovito else write(folder, out, speed)
    typer.echo(path)


Kind = StrEnum("Kind", ["PULL_OFF", "LOAD", "PATH", "HOLD", "HISTORY", "IMPACT", "SLIDE", "TANGENTIAL"])
"""The experiments for which `new` has a scene."""
Profile = StrEnum("Profile", ["PARABOLA", "CIRCLE", "ELLIPSOID", "CONE", "FLAT_PUNCH", "POWER"])
"""The profiles that need no file of measured heights."""


def new(
    name: Annotated[Path, Argument(metavar="NAME", help="File to write; .toml is added if absent.")],
    kind: Annotated[Kind, Option(help="The experiment.")] = Kind.PULL_OFF,
    profile: Annotated[Profile | None, Option(help="Shape of the upper body.", show_default="parabola")] = None,
    material: Annotated[
        str | None,
        Option(metavar="UPPER/LOWER", help="Of `contact1d materials`, or `rigid`.", show_default="steel/glass"),
    ] = None,
) -> None:
    """Write a scene file in SI to start from: it runs as it is, with every key explained and its allowed values.

    An existing file is not overwritten, and its folder must exist (exit code 2).
    """
    if name.name in ("", ".."):
        stop(f"{name} is a folder; give the file a name", CALL_IS_WRONG)
    path = name if name.suffix == ".toml" else name.with_name(name.name + ".toml")
    from contact1d.workflow.cli.starter import starter

    _write(path, starter(kind.value, profile and profile.value, material), "choose another name")
    typer.echo(f"{path}: run it with contact1d run {quote(str(path))}")


def materials() -> None:
    """List the named materials, a line each: Young's modulus, Poisson's ratio, and where they are from."""
    from contact1d.workflow.scene.materials import MATERIALS

    for name, material in MATERIALS.items():
        typer.echo(f"{name:<16}{material['youngs_modulus']:>9}  ν = {material['poisson_ratio']:<6}{material['source']}")


def terms(
    table: Annotated[Path, Argument(metavar="TABLE", help="E over t, or E' and E'' over f (CSV with units).")],
    out: Annotated[Path, Option(help="New file for the terms.")] = Path("terms.csv"),
) -> None:
    """Find the terms of a Prony series in a table of a relaxation, for `viscoelasticity.terms = { file = … }`.

    The table has the columns t [s] and E [MPa], or f [Hz] (or ω [rad/s]), E' [MPa] and E'' [MPa]. Prints the
    instantaneous modulus and the largest deviation from the table; an existing file is not overwritten (exit code 2).
    """
    series = api.prony_terms(table)
    lines = (f"{term['share']},{term['time'].removesuffix(' s')}\n" for term in series.terms)
    _write(out, "share,time [s]\n" + "".join(lines), "choose another name")
    words = f"instantaneous modulus: {series.modulus}\nlargest deviation from the table: {series.deviation:.2%}"
    print_lines([words], series.warnings, out)


def schema(
    out: Annotated[Path | None, Option(help="Write it to this new file.", show_default="printed")] = None,
) -> None:
    """Print the JSON schema of scene files, with which an editor completes keys, explains them and marks mistakes.

    With `--out` it is written to that file instead; an existing file is not overwritten (exit code 2).

    For taplo, or Even Better TOML in VS Code: `contact1d schema --out scene.schema.json` beside your scenes, and in
    each of them the first line `#:schema scene.schema.json`.
    """
    from contact1d.workflow.scene.schema import schema_text

    if out is None:
        typer.echo(schema_text(), nl=False)
        return
    _write(out, schema_text(), "remove it first, or choose another name")
    typer.echo(f"{out}: in a scene file beside it, write as first line #:schema {out.name}")


def _write(path: Path, text: str, instead: str) -> None:
    """Write a new file in UTF-8, complete or not at all.

    A file or folder that is in the way, or a missing parent folder, ends the program by SystemExit with exit code 2 and
    a message, and nothing is replaced. Other errors of the system are raised.

    Args:
        path: of the file.
        text: its content.
        instead: what to do where the file exists, for the message.
    """
    if path.parent.is_file():
        stop(f"{path.parent} is a file; a folder is needed", CALL_IS_WRONG)
    if not path.parent.is_dir():
        stop(f"there is no folder {path.parent}; make it first: mkdir -p {quote(str(path.parent))}", CALL_IS_WRONG)
    try:
        with path.open("x", encoding="utf-8") as file:
            file.write(text)
    except FileExistsError:
        stop(f"{path} exists and is not overwritten; {instead}", CALL_IS_WRONG)
    except OSError:
        path.unlink(missing_ok=True)  # no incomplete file is left
        raise


for function in (new, run, sweep, fit, report, animate, deck, cost, identify, materials, terms, schema, doctor):
    app.command()(function)


def main() -> None:
    """Run the command of sys.argv, as the entry point of `contact1d`; it ends by SystemExit with the exit code.

    For speed it changes the garbage collection of this process, and keeps pydantic from loading plugins.
    """
    gc.set_threshold(300_000)  # more objects than a run with figures makes; at 700, garbage collection is a tenth of it
    atexit.register(gc.freeze)  # the system takes back all memory at once
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")  # pydantic searches every installed package for them
    app(prog_name="contact1d")


if __name__ == "__main__":
    main()
