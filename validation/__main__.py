"""`python -m validation paper|hard|speed`, in a checkout: nothing of this is installed."""

import importlib
from pathlib import Path
from typing import Annotated

import typer

from validation.doors import FolderError

app = typer.Typer(no_args_is_help=True, pretty_exceptions_enable=False, help=__doc__)
ROOT = Path(__file__).parents[1]
RESULTS = Path(__file__).parent / "results"
FAILS, CALL_IS_WRONG = 1, 2
Only = Annotated[list[str] | None, typer.Option(metavar="NAME", help="One study, as often as needed.")]
Out = Annotated[Path, typer.Option(help="Folder for record, figures and runs; finished runs are reused.")]
Full = Annotated[bool, typer.Option("--full", help="The long form: hours in place of minutes.")]
Workers = Annotated[int | None, typer.Option(min=1, help="At a time.", show_default="processors")]
COMMANDS: dict[str, tuple[str, int | None, str]] = {
    "paper": ("reproduced", None, "Every statement of the paper, beside the printed value and beside theory."),
    "hard": ("stability", None, "Hard cases, each against a bound that is not the program's own."),
    "speed": ("speed", 1, "Times side by side in one run, one study after the other."),
    "grains": ("grains", 1, "LAMMPS's granular contact models beside exact answers."),
}
"""By the package of the studies: the folder, how many run at a time, and what they are. Exit code 1: a row fails."""


def _add(name: str, folder: str, at_a_time: int | None, words: str) -> None:
    @app.command(name, help=f"{words} Exit code 1: a row fails.")
    def conducted(only: Only = None, out: Out = Path(folder), full: Full = False, workers: Workers = at_a_time) -> None:
        from validation.page import agreement, duration, number
        from validation.study import RECORD, Study, conduct

        chosen: tuple[Study, ...] = importlib.import_module(f"validation.{name}").STUDIES
        try:
            record = conduct(chosen, out, only or (), full, workers, typer.echo)
        except (KeyError, FolderError) as error:
            known = f"--only {error}: no such study; there are {', '.join(one.name for one in chosen)}"
            typer.echo(known if isinstance(error, KeyError) else str(error), err=True)
            raise typer.Exit(CALL_IS_WRONG) from None
        for answer in record.answers:
            typer.echo(f"{answer.name:<16} {agreement(answer.rows)}, in {duration(answer.wall_s)}")
            for row in answer.rows:
                if row.verdict == "FAIL":
                    found, wanted = number(row.value), number(row.reference.value)
                    typer.secho(f"  FAIL {row.name}: {found} {row.unit}, {wanted}", fg="red")
        typer.echo(f"{agreement(record.rows)}; {out / RECORD}")
        if any(row.verdict == "FAIL" for row in record.rows):
            raise typer.Exit(FAILS)


for name, given in COMMANDS.items():
    _add(name, *given)


@app.command()
def pages() -> None:
    """VALIDATION.md, the tables, the times of docs/performance.md and docs/grains.md from validation/results."""
    from contact1d.analysis.plots import save_figure
    from docs.grains import write
    from validation.figures import margins
    from validation.page import margins_of, speed_table, summary, tables_page, write_between
    from validation.study import read_record

    records = {name: read_record(RESULTS / f"{name}.json") for name in ("paper", "hard", "speed")}
    (ROOT / "VALIDATION.md").write_text(summary(**records), encoding="utf-8")
    (RESULTS / "tables.md").write_text(tables_page([records["paper"], records["hard"]]), encoding="utf-8")
    write_between(ROOT / "docs" / "performance.md", "speed", speed_table(records["speed"]))
    save_figure(margins(margins_of(records["hard"])), ROOT / "docs" / "stability" / "margins.png")
    write(read_record(RESULTS / "grains.json"))


@app.command()
def ages() -> None:
    """How old each record is: commits that touch the program, and days."""
    from validation.age import ages as lines

    for line in lines():
        typer.echo(line)


if __name__ == "__main__":
    app()
