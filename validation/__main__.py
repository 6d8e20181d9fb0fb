"""`python -m validation paper|hard`: in a checkout, since nothing of this is installed."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.ending import CALL_IS_WRONG, FAILS, RUN_FAILED, command, stop

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, help=__doc__)
Only = Annotated[list[str] | None, typer.Option(metavar="NAME", help="One study, as often as needed.")]
Workers = Annotated[int | None, typer.Option(min=1, help="At a time; as many as there are processors.")]


@app.command()
def paper(only: Only = None, out: Path = Path("reproduced"), workers: Workers = None) -> None:
    """Every quantitative statement of the paper, beside the printed value and beside theory. Exit code 1: a row fails."""
    with command("the reproduction", kept=f"finished runs are kept in {out}", blame=RUN_FAILED) as progress:
        from validation.judging.words import outcome
        from validation.paper.studies import NAMES, PAGE, reproduce

        for name in only or ():
            if name not in NAMES:
                stop(f"--only {name}: no such study; there are {', '.join(NAMES)}", CALL_IS_WRONG)
        record = reproduce(out, only or (), workers, progress)
    typer.echo(f"{outcome(record.checks)}, in {record.wall_s:.0f} s; {out / PAGE}")
    if record.failed:
        raise typer.Exit(FAILS)


@app.command()
def hard(only: Only = None, full: bool = False, out: Path = Path("stability"), workers: Workers = None) -> None:
    """Hard cases, each against a bound from theory or from an independent solver. Exit code 1: a row fails."""
    with command("the suite", kept=f"finished runs are kept in {out}", blame=RUN_FAILED) as progress:
        from validation.hard.record import TABLE
        from validation.hard.suite import NAMES, stability

        for name in only or ():
            if name not in NAMES:
                stop(f"--only {name}: no such class; there are {', '.join(NAMES)}", CALL_IS_WRONG)
        record = stability(out, only or (), full, workers, progress)
    count = len(record.checks)
    typer.echo(f"{count - len(record.failed)} of {count} rows pass, in {record.wall_s:.0f} s; {out / TABLE}")
    if record.failed:
        raise typer.Exit(FAILS)


if __name__ == "__main__":
    app()
