"""The command `reproduce`: the paper's statements, one by one."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.arguments import study_names
from contact1d.workflow.cli.ending import CALL_IS_WRONG, FAILS, RUN_FAILED, command, stop


def reproduce(
    only: Annotated[
        list[str] | None,
        typer.Option(
            metavar="NAME",
            help="One study, as often as needed: fig4, table1, …",
            show_default=False,
            autocompletion=study_names,
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the record, the page, figures and runs.")] = Path("reproduced"),
    workers: Annotated[int | None, typer.Option(min=1, help="Runs at a time.", show_default="processors")] = None,
) -> None:
    """Compute every quantitative statement of the paper and lay it beside the printed value and beside theory.

    Leaves reproduce.json, reproduce.html (open it in a browser), VALIDATION.md and the figures in the folder. Runs that
    are there already are not made again, so that a second call, or one after an interruption, goes on; with `--only`
    the other studies of an earlier record stay in it. Exit code 1: a row fails.
    """
    kept = f"finished runs are kept in {out}, and the same command goes on"
    with command("the reproduction", kept=kept, blame=RUN_FAILED) as progress:
        from contact1d.workflow.judging.words import outcome
        from contact1d.workflow.reproduce.studies import NAMES, PAGE
        from contact1d.workflow.reproduce.studies import reproduce as do
        from contact1d.workflow.scene.problems import nearest

        for name in only or ():
            if name not in NAMES:
                meant = nearest(name, NAMES)
                hint = f"did you mean {meant}? " if meant else ""
                stop(f"--only {name}: no such study; {hint}there are {', '.join(NAMES)}", CALL_IS_WRONG)
        record = do(out, only or (), workers, progress)
    for study in record.studies:
        colour = "red" if any(check.verdict == "FAIL" for check in study.checks) else None
        typer.secho(f"{study.name:<16} {outcome(study.checks)}", fg=colour)
        for check in study.checks:
            if check.verdict == "FAIL":
                typer.secho(f"  FAIL {check.name}: {check.value:.6g} {check.unit}, {check.reference:.6g}", fg="red")
    typer.echo(f"\n{outcome(record.checks)}, in {record.wall_s:.0f} s; {out / PAGE}")
    if record.failed:
        raise typer.Exit(FAILS)
