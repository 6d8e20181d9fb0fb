"""The command `stability`: hard cases against their bounds."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import CALL_IS_WRONG, FAILS, RUN_FAILED, command, stop


def stability(
    out: Annotated[Path, typer.Option(help="Folder for the record, the table, figures and runs.")] = Path("stability"),
    full: Annotated[bool, typer.Option("--full", help="The long form: hours in place of minutes.")] = False,
    only: Annotated[
        list[str] | None, typer.Option(metavar="NAME", help="One class, as often as needed.", show_default=False)
    ] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Classes at a time.", show_default="processors")] = None,
) -> None:
    """Hard cases, each against a bound from theory or from an independent solver.

    Leaves stability.json, stability.md and a figure for each class in the folder. Exit code 1: a row fails.
    """
    kept = f"finished runs are kept in {out}, and the same command goes on"
    with command("the suite", kept=kept, blame=RUN_FAILED) as progress:
        from contact1d.workflow.stability.record import TABLE
        from contact1d.workflow.stability.suite import NAMES
        from contact1d.workflow.stability.suite import stability as do

        for name in only or ():
            if name not in NAMES:
                stop(f"--only {name}: no such class; there are {', '.join(NAMES)}", CALL_IS_WRONG)
        record = do(out, only or (), full, workers, progress)
    for answer in record.answers:
        failed = [check for check in answer.found.checks if check.verdict == "FAIL"]
        count = len(answer.found.checks)
        colour = "red" if failed else None
        typer.secho(
            f"{answer.asked.name:<14} {count - len(failed):>3} of {count:>3} pass  {answer.seconds:5.0f} s  "
            f"{answer.asked.title}",
            fg=colour,
        )
        for check in failed:
            typer.secho(f"  FAIL {check.name}: {check.value:.4g} {check.unit}, bound {check.reference:.4g}", fg="red")
    count = len(record.checks)
    typer.echo(f"\n{count - len(record.failed)} of {count} rows pass, in {record.wall_s:.0f} s; {out / TABLE}")
    if record.failed:
        raise typer.Exit(FAILS)
