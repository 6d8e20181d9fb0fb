"""The commands about the paper: `identify` (Section 4, both ways) and `reproduce`; how any command ends in error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

if TYPE_CHECKING:
    from contact1d.workflow.engine.progress import Progress
    from contact1d.workflow.identify import Identified, Target

ROW_FAILS = 1
SCENE_IS_WRONG = 2
RUN_FAILED = 3
INTERRUPTED = 130


def stop(message: str, code: int) -> NoReturn:
    """Say what is wrong and end with this exit code."""
    typer.secho(message, err=True, fg="red")
    raise typer.Exit(code)


def not_written(folder: Path, error: OSError) -> str:
    """Why nothing could be written to a folder, in words."""
    if folder.exists() and not folder.is_dir():
        return f"{folder} is a file; a folder is needed"
    return f"{folder} cannot be written: {error.strerror or error}"


def identify(
    contact_modulus: Annotated[float, typer.Option(metavar="PA", help="E* of the pair of bodies.", show_default=False)],
    surface_energy: Annotated[
        float | None,
        typer.Option(metavar="J/M2", help="γ of one side, half the work of adhesion.", show_default=False),
    ] = None,
    run: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="A finished pull_off: what are its LU and FU?", show_default=False),
    ] = None,
    radius: Annotated[
        float | None,
        typer.Option(metavar="M", help="R of a sphere, effective: which interaction is its?", show_default=False),
    ] = None,
    adhesion_force: Annotated[
        float | None, typer.Option(metavar="N", help="Measured F_A, in place of γ.", show_default=False)
    ] = None,
    zero_load_radius: Annotated[
        float | None, typer.Option(metavar="M", help="Measured a_0, together with F_A.", show_default=False)
    ] = None,
    length_unit: Annotated[
        float | None, typer.Option(metavar="M", help="One LU; else a_0 gets some 28 particles.", show_default=False)
    ] = None,
    tolerance: Annotated[float, typer.Option(min=1e-5, max=0.1, help="Of the scene, relative.")] = 1e-3,
    out: Annotated[Path, typer.Option(help="Folder of the identified scene and its run.")] = Path("runs/identified"),
) -> None:
    """Give a model its material (the paper's Section 4), or a material its model.

    With `--run`: the length and force unit, in metres and newtons, with which a finished pull_off is JKR's contact of
    the material (Eq. 9, Table 1). With `--radius`: a scene whose interaction has JKR's F_A and a_0 of that sphere, or
    measured ones, found by a solver and verified by a run, which stays in the folder.
    """
    given = {
        "contact-modulus": contact_modulus, "surface-energy": surface_energy, "radius": radius,
        "adhesion-force": adhesion_force, "zero-load-radius": zero_load_radius, "length-unit": length_unit,
    }  # fmt: skip
    wrong = {name: value for name, value in given.items() if not _positive(value)}
    problems = [f"--{name} must be greater than 0, not {value:g}" for name, value in wrong.items()]
    if (run is None) == (radius is None):
        problems.append("give either --run (a model looks for its material) or --radius (a material for its model)")
    measured = adhesion_force is not None and zero_load_radius is not None
    if (adhesion_force is None) != (zero_load_radius is None):
        problems.append("--adhesion-force and --zero-load-radius go together")
    elif measured == (surface_energy is not None):
        problems.append("give --surface-energy, or --adhesion-force together with --zero-load-radius")
    elif run is not None and (measured or length_unit is not None):
        problems.append("with --run only --contact-modulus and --surface-energy have a meaning: the rest is in the run")
    if problems:
        stop("\n".join(problems), SCENE_IS_WRONG)
    if run is not None and surface_energy is not None:
        _units_of_run(run, contact_modulus, surface_energy)
    elif radius is not None:
        from contact1d.workflow.identify import Target, jkr_target

        if adhesion_force is not None and zero_load_radius is not None:
            target = Target(adhesion_force, zero_load_radius)
        else:
            assert surface_energy is not None
            target = jkr_target(contact_modulus, surface_energy, radius)
        _scene_of_material(contact_modulus, radius, target, length_unit, tolerance, out)


def _positive(value: float | None) -> bool:
    return value is None or 0.0 < value < float("inf")


def _units_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> None:
    """Print LU and FU of a finished run, and its results in SI."""
    from contact1d.workflow.cli.summary import quantities
    from contact1d.workflow.identify.finished import FinishedRunError, scales_of_run

    try:
        scales, results = scales_of_run(folder, contact_modulus, surface_energy)
    except FinishedRunError as error:
        stop(str(error), SCENE_IS_WRONG)
    for entry in results.values():
        entry["si"] = scales.in_si(entry["value"], entry["uncertainty"], entry["unit"])
    units = {unit: scales.in_si(1.0, 0.0, unit) for unit in ("LU", "FU")}
    typer.echo("\n".join(quantities(results | {"units": units})))


def _scene_of_material(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None, tolerance: float, out: Path
) -> None:
    """Identify, run, and say what came out."""
    from contact1d.workflow.engine.progress import choose_progress
    from contact1d.workflow.errors import FolderError, RunError
    from contact1d.workflow.identify import IdentifyError, material_scene
    from contact1d.workflow.identify import identify as search
    from contact1d.workflow.settings.settings import SettingsError

    progress: Progress = choose_progress()
    try:
        scene, wanted = material_scene(contact_modulus, radius, target, length_unit, tolerance)
        found = search(scene, wanted, out, progress)
    except (IdentifyError, FolderError, SettingsError) as error:
        progress.close()
        stop(str(error), SCENE_IS_WRONG)
    except RunError as error:
        progress.close()
        stop(f"the run failed: {error}", RUN_FAILED)
    except KeyboardInterrupt:
        progress.close()
        stop("interrupted", INTERRUPTED)
    progress.close()
    _say(found, target)


def _say(found: Identified, target: Target) -> None:
    from contact1d.workflow.cli.summary import in_si, quantities

    results = found.run.document
    lines = [f"identified in {found.runs} run{'s' if found.runs > 1 else ''}"]
    for name, wanted, unit in (
        ("adhesion_force", target.adhesion_force, "N"), ("zero_load_radius", target.zero_load_radius, "m"),
    ):  # fmt: skip
        value = results[name]["si"]["value"]
        asked = in_si({"value": wanted, "uncertainty": 0.0, "unit": unit})
        lines.append(f"  {name.replace('_', ' ')}: wanted {asked}, off by {value / wanted - 1.0:+.1e}")
    terms = found.scene.interaction
    assert terms is not None
    assert terms.attraction is not None
    for name, term in (("repulsion", terms.repulsion), ("attraction", terms.attraction)):
        lines.append(f"  {name:<28} amplitude {term.amplitude:.6g} FU·LU, range {term.range:.6g} LU")
    typer.echo("\n".join([*lines, *quantities(results)]))
    for warning in results["warnings"]:
        typer.secho(f"warning {warning['name']}: {warning['message']}", err=True, fg="yellow")
    typer.echo(f"\n{found.run.folder}/scene.toml")


def reproduce(
    only: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME", help="One study, as often as needed: fig4, table1, …", show_default=False),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the record, the page, figures and runs.")] = Path("reproduced"),
    workers: Annotated[int | None, typer.Option(min=1, help="Runs at a time.", show_default="processors")] = None,
) -> None:
    """Compute every quantitative statement of the paper and lay it beside the printed value and beside theory.

    Leaves reproduce.json, reproduce.html (open it in a browser), VALIDATION.md and the figures in the folder. Runs that
    are there already are not made again, so that a second call, or one after an interruption, goes on; with `--only`
    the other studies of an earlier record stay in it. Exit code 1: a row fails.
    """
    from contact1d.workflow.engine.progress import choose_progress
    from contact1d.workflow.errors import FolderError, RunError
    from contact1d.workflow.identify import IdentifyError
    from contact1d.workflow.reproduce.studies import NAMES, PAGE
    from contact1d.workflow.reproduce.studies import reproduce as do
    from contact1d.workflow.scene.problems import nearest

    for name in only or ():
        if name not in NAMES:
            meant = nearest(name, NAMES)
            hint = f"did you mean {meant}? " if meant else ""
            stop(f"--only {name}: no such study; {hint}there are {', '.join(NAMES)}", SCENE_IS_WRONG)
    progress = choose_progress()
    try:
        record = do(out, only or (), workers, progress)
    except FolderError as error:
        progress.close()
        stop(str(error), SCENE_IS_WRONG)
    except OSError as error:
        progress.close()
        stop(not_written(out, error), SCENE_IS_WRONG)
    except (RunError, IdentifyError) as error:
        progress.close()
        stop(f"the reproduction failed: {error}", RUN_FAILED)
    except KeyboardInterrupt:
        progress.close()
        stop(f"interrupted; finished runs are kept in {out}, and the same command goes on", INTERRUPTED)
    progress.close()
    for study in record.studies:
        passed = sum(check.verdict == "PASS" for check in study.checks)
        colour = None if passed == len(study.checks) else "red"
        typer.secho(f"{study.name:<16} {passed:>3} of {len(study.checks):>3} pass   {study.title}", fg=colour)
        for check in study.checks:
            if check.verdict == "FAIL":
                typer.secho(f"  FAIL {check.name}: {check.value:.6g} {check.unit}, {check.reference:.6g}", fg="red")
    typer.echo(f"\n{record.passed} of {len(record.checks)} rows pass, in {record.wall_s:.0f} s; {out / PAGE}")
    if record.passed < len(record.checks):
        raise typer.Exit(ROW_FAILS)
