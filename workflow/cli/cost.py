"""The command `cost`: what accuracy costs in time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.arguments import SceneFile, Set, Without
from contact1d.workflow.cli.ending import command, read


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
        from contact1d.workflow.cost.report import closing, summary, write_report
        from contact1d.workflow.cost.study import cost_of
        from contact1d.workflow.runs.processors import cores
        from contact1d.workflow.settings.settings import settings_for
        from contact1d.workflow.experiments.spacing import with_spacing

        checked = with_spacing(asked)
        settings_for(checked)
        folder.mkdir(parents=True, exist_ok=True)
        record = cost_of(checked, scene.stem, folder, repeats, workers or cores(), progress)
        write_report(record, folder)
    typer.echo("\n".join(summary(record)))
    typer.echo(f"\n{closing(record)}; {folder}")
