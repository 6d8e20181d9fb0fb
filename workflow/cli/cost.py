"""The command `cost`: what accuracy costs in time."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from contact1d.workflow.cli.paper import INTERRUPTED, RUN_FAILED, SCENE_IS_WRONG, not_written, stop


def cost(
    scene: Annotated[Path, typer.Argument(metavar="SCENE", help="A scene file (TOML).", show_default=False)],
    out: Annotated[
        Path | None,
        typer.Option(help="Folder for cost.json, cost.csv, cost.png.", show_default="costs/<name of the scene>"),
    ] = None,
    set_: Annotated[
        list[str] | None,
        typer.Option("--set", metavar="TABLE.KEY=VALUE", help="Change one value of the scene.", show_default=False),
    ] = None,
    without: Annotated[
        list[str] | None, typer.Option(metavar="EFFECT", help="Leave out an effect's table.", show_default=False)
    ] = None,
    repeats: Annotated[int, typer.Option(min=1, help="Runs of each variant; times are their medians.")] = 3,
    workers: Annotated[int | None, typer.Option(min=1, help="Runs at a time.", show_default="processors")] = None,
) -> None:
    """Measure what accuracy costs in time: every numerical knob of a scene, its error beside its CPU time.

    Leaves cost.json, cost.csv and a work-precision figure, cost.png, and says for each tolerance what reaches it at
    the least cost. The scene itself is not changed.
    """
    from concurrent.futures.process import BrokenProcessPool

    from contact1d.workflow.scene import SceneError, read_scene

    try:
        checked = read_scene(scene, tuple(set_ or ()), tuple(without or ()))
    except SceneError as error:
        count = len(error.problems)
        lines = [f"{scene}: {count} problem{'s' if count > 1 else ''}", *(f"  {problem}" for problem in error.problems)]
        stop("\n".join(lines), SCENE_IS_WRONG)
    from contact1d.workflow.cost.report import closing, summary, write_report
    from contact1d.workflow.cost.study import cost_of
    from contact1d.workflow.engine.progress import choose_progress
    from contact1d.workflow.engine.session import EngineError
    from contact1d.workflow.errors import RunError
    from contact1d.workflow.runs.cores import cores
    from contact1d.workflow.settings.settings import SettingsError, settings_for

    folder = out if out is not None else Path("costs") / scene.stem
    progress = choose_progress()
    try:
        settings_for(checked)
        folder.mkdir(parents=True, exist_ok=True)
        record = cost_of(checked, scene.stem, folder, repeats, workers or cores(), progress)
        write_report(record, folder)
    except SettingsError as error:
        progress.close()
        stop(str(error), SCENE_IS_WRONG)
    except OSError as error:
        progress.close()
        stop(not_written(folder, error), SCENE_IS_WRONG)
    except (RunError, EngineError) as error:
        progress.close()
        stop(f"the study failed: {getattr(error, 'message', error)}", RUN_FAILED)
    except BrokenProcessPool:
        progress.close()
        stop(
            "the study failed: a process of it was killed, most often because the machine was out of memory", RUN_FAILED
        )
    except KeyboardInterrupt:
        progress.close()
        stop("interrupted; nothing was written", INTERRUPTED)
    progress.close()
    typer.echo("\n".join(summary(record)))
    typer.echo(f"\n{closing(record)}; {folder}")
