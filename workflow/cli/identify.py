"""The command `identify`: from a material to a scene, and the paper's Section 4, both ways."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from contact1d.workflow.cli.ending import CALL_IS_WRONG, command, problems_in, say, stop

if TYPE_CHECKING:
    from contact1d.workflow.identify import Target


def identify(
    material: Annotated[
        Path | None,
        typer.Argument(
            metavar="MATERIAL", help="A contact in SI (TOML): bodies, attraction, load.", show_default=False
        ),
    ] = None,
    contact_modulus: Annotated[
        float | None, typer.Option(metavar="PA", help="E* of the pair of bodies.", show_default=False)
    ] = None,
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
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder of the scene and its run.", show_default="runs/<name of MATERIAL> or runs/identified"
        ),
    ] = None,
) -> None:
    """Give a material its model, or a model its material (the paper's Section 4).

    With MATERIAL, a file such as

        radius = "5 um"
        upper = { youngs_modulus = "72 GPa", poisson_ratio = 0.17 }
        lower = { youngs_modulus = "72 GPa", poisson_ratio = 0.17 }
        surface_energy = "0.05 J/m²"
        range = "0.3 nm"

    (docs/identify.md has every key): a scene with everything chosen, its run, with JKR, DMT and Maugis-Dugdale beside
    it; or which theory holds, with its value, where no chain can stand for the contact.

    With `--run`: the length and force unit, in metres and newtons, with which a finished pull_off is JKR's contact of
    the material (Eq. 9, Table 1). With `--radius`: a scene whose interaction has JKR's F_A and a_0 of that sphere, or
    measured ones, found by a solver and verified by a run, which stays in the folder.
    """
    given = {
        "contact-modulus": contact_modulus, "surface-energy": surface_energy, "radius": radius,
        "adhesion-force": adhesion_force, "zero-load-radius": zero_load_radius, "length-unit": length_unit,
    }  # fmt: skip
    if material is not None:
        others = [f"--{name}" for name, value in given.items() if value is not None] + ["--run"] * (run is not None)
        if others:
            stop(f"{', '.join(others)}: with MATERIAL everything is in the file", CALL_IS_WRONG)
        _from_material(material, out or Path("runs") / material.stem)
        return
    out = out or Path("runs/identified")
    if problems := _mistakes({name: value for name, value in given.items() if value is not None}, run):
        stop("\n".join(problems), CALL_IS_WRONG)
    assert contact_modulus is not None
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


def _mistakes(given: Mapping[str, float], run: Path | None) -> list[str]:
    """What is wrong with the options `given`, or with having them together."""
    wrong = {name: value for name, value in given.items() if not 0.0 < value < float("inf")}
    problems = [f"--{name} must be greater than 0, not {value:g}" for name, value in wrong.items()]
    if (run is None) == ("radius" not in given):
        problems.append(
            "give MATERIAL, a file that describes a contact; or either --run (a model looks for its material) or "
            "--radius (a material for its model)"
        )
    if "contact-modulus" not in given and problems == []:
        problems.append("--contact-modulus is missing: E* of the pair of bodies [Pa]")
    measured = {"adhesion-force", "zero-load-radius"} & given.keys()
    if len(measured) == 1:
        problems.append("--adhesion-force and --zero-load-radius go together")
    elif bool(measured) == ("surface-energy" in given):
        problems.append("give --surface-energy, or --adhesion-force together with --zero-load-radius")
    elif run is not None and (measured or "length-unit" in given):
        problems.append("with --run only --contact-modulus and --surface-energy have a meaning: the rest is in the run")
    return problems


def _units_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> None:
    """Print LU and FU of a finished run, and its results in SI."""
    from contact1d.workflow.cli.summary import quantities
    from contact1d.workflow.identify.interaction import scales_of_run

    scales, results = scales_of_run(folder, contact_modulus, surface_energy)
    for entry in results.values():
        entry["si"] = scales.in_si(entry["value"], entry["uncertainty"], entry["unit"])
    units = {unit: scales.in_si(1.0, 0.0, unit) for unit in ("LU", "FU")}
    typer.echo("\n".join(quantities(results | {"units": units})))


def _from_material(file: Path, out: Path) -> None:
    """Choose, run, and say what came out beside the theories."""
    from contact1d.workflow.scene import SceneError

    with command("the run", out) as progress:
        from contact1d.workflow.identify import from_material

        try:
            found = from_material(file, out, progress)
        except SceneError as error:
            stop(problems_in(str(file), error.problems), CALL_IS_WRONG)
    from contact1d.workflow.cli.summary import beside_theories, quantities, regime

    table = list(beside_theories(found))
    lines = [
        found.contact.scene.title,
        *regime(found),
        "",
        *quantities(found.run.document),
        *([""] if table else []),
        *table,
    ]
    say(lines, {**found.doubts, **found.run.warnings}, found.run.folder / "scene.toml")


def _scene_of_material(
    contact_modulus: float, radius: float, target: Target, length_unit: float | None, tolerance: float, out: Path
) -> None:
    """Identify, run, and say what came out."""
    with command("the run", out) as progress:
        from contact1d.workflow.identify import identify as search
        from contact1d.workflow.identify import material_scene

        scene, wanted = material_scene(contact_modulus, radius, target, length_unit, tolerance)
        found = search(scene, wanted, out, progress)
    from contact1d.workflow.cli.summary import in_si, quantities

    results, terms = found.run.document, found.scene.interaction
    lines = [f"identified in {found.runs} run{'s' if found.runs > 1 else ''}"]
    for (name, asked), unit in zip(vars(target).items(), ("N", "m"), strict=True):
        said = in_si({"value": asked, "uncertainty": 0.0, "unit": unit})
        off = results[name]["si"]["value"] / asked - 1.0
        lines.append(f"  {name.replace('_', ' ')}: wanted {said}, off by {off:+.1e}")
    for name, term in terms or ():
        if name in ("repulsion", "attraction"):
            lines.append(f"  {name:<28} amplitude {term.amplitude:.6g} FU·LU, range {term.range:.6g} LU")
    say([*lines, *quantities(results)], found.run.warnings, found.run.folder / "scene.toml")
