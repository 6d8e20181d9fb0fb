"""The command `identify`: from a material to a scene, and both methods of the paper's Section 4."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer
from typer import Argument, Option

import contact1d as api
from contact1d.workflow.cli.ending import CALL_IS_WRONG, command, print_lines, stop


def _given(value: str, meaning: str) -> Any:
    """Return a typer option without a default shown; `value` stands for its value in the help."""
    return Option(metavar=value, help=meaning, show_default=False)


def identify(
    material: Annotated[
        Path | None,
        Argument(metavar="MATERIAL", help="A contact in SI (TOML): bodies, attraction, load.", show_default=False),
    ] = None,
    contact_modulus: Annotated[float | None, _given("PA", "E* of the pair of bodies.")] = None,
    surface_energy: Annotated[float | None, _given("J/M2", "γ of one side, half the work of adhesion.")] = None,
    run: Annotated[Path | None, _given("FOLDER", "A finished pull_off, to find its LU and FU.")] = None,
    radius: Annotated[float | None, _given("M", "Effective R of a sphere, to find its interaction.")] = None,
    adhesion_force: Annotated[float | None, _given("N", "Measured F_A, in place of γ.")] = None,
    zero_load_radius: Annotated[float | None, _given("M", "Measured a_0, together with F_A.")] = None,
    length_unit: Annotated[float | None, _given("M", "One LU; default: about 28 particles in a_0.")] = None,
    tolerance: Annotated[float, Option(min=1e-5, max=0.1, help="Relative tolerance of the scene.")] = 1e-3,
    out: Annotated[
        Path | None,
        Option(help="Folder of the scene and its run.", show_default="runs/<name of MATERIAL> or runs/identified"),
    ] = None,
) -> None:
    """Give a material its model, or a model its material (the paper's Section 4).

    With MATERIAL, a file such as

        radius = "5 um"
        upper = { youngs_modulus = "72 GPa", poisson_ratio = 0.17 }
        lower = { youngs_modulus = "72 GPa", poisson_ratio = 0.17 }
        surface_energy = "0.05 J/m²"
        range = "0.3 nm"

    (docs/identify.md has every key): a scene with every number chosen, its run, the predictions of JKR, DMT
    and Maugis-Dugdale, and which of them holds.

    With `--run`: the length and force unit, in metres and newtons, with which a finished pull_off is JKR's contact of
    the material (Eq. 9, Table 1). With `--radius`: a scene whose interaction has JKR's F_A and a_0 of that sphere, or
    measured ones, found by a solver and verified by a run, which stays in the folder.

    Exactly one of the three is given. Options that exclude or lack one another end with exit code 2.
    """
    options = {
        "contact-modulus": contact_modulus, "surface-energy": surface_energy, "radius": radius,
        "adhesion-force": adhesion_force, "zero-load-radius": zero_load_radius, "length-unit": length_unit, "run": run,
    }  # fmt: skip
    given: dict[str, Any] = {name: value for name, value in options.items() if value is not None}
    if problems := _mistakes(given, material):
        stop("\n".join(problems), CALL_IS_WRONG)
    if material is not None:
        _from_material(material, out or Path("runs") / material.stem)
    elif run is not None:
        _units_of_run(run, given["contact-modulus"], given["surface-energy"])
    else:
        _scene_of_sphere(given, tolerance, out or Path("runs/identified"))


def _mistakes(given: Mapping[str, Any], material: Path | None) -> list[str]:
    """Return the messages about options with a wrong value, or that exclude or lack one another.

    Empty if all is right. With MATERIAL any other option is wrong. Numbers must be positive and finite.

    Args:
        given: values of the options that are given, by name, in SI; "run" is a path.
        material: the file; None without one.
    """
    if material is not None:
        names = ", ".join(f"--{name}" for name in given)
        return [f"{names}: not with MATERIAL: give it in the file"] if names else []
    problems = [
        f"--{name} must be greater than 0, not {value:g}"
        for name, value in given.items()
        if name != "run" and not 0.0 < value < float("inf")
    ]
    if ("run" in given) == ("radius" in given):
        problems.append(
            "give MATERIAL, a file that describes a contact; or either --run (to find LU and FU of a run) or "
            "--radius (to find the interaction of a sphere)"
        )
    if "contact-modulus" not in given and problems == []:
        problems.append("--contact-modulus is missing: give E* of the pair of bodies [Pa]")
    measured = {"adhesion-force", "zero-load-radius"} & given.keys()
    if len(measured) == 1:
        problems.append("--adhesion-force and --zero-load-radius go together")
    elif bool(measured) == ("surface-energy" in given):
        problems.append("give --surface-energy, or --adhesion-force together with --zero-load-radius")
    elif "run" in given and (measured or "length-unit" in given):
        problems.append("with --run give only --contact-modulus and --surface-energy: the run has all other values")
    return problems


def _units_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> None:
    """Print LU [m] and FU [N] of a finished run, and its results in SI.

    Args:
        folder: of the run.
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].

    Raises:
        IdentifyError: the folder has no finished run with F_A and a₀ of a sphere.
    """
    from contact1d.workflow.cli.summary import quantities
    from contact1d.workflow.identify.interaction import scales_of_run

    scales, results = scales_of_run(folder, contact_modulus, surface_energy)
    for entry in results.values():
        entry["si"] = scales.in_si(entry["value"], entry["uncertainty"], entry["unit"])
    units = {unit: scales.in_si(1.0, 0.0, unit) for unit in ("LU", "FU")}
    typer.echo("\n".join(quantities(results | {"units": units})))


def _from_material(file: Path, out: Path) -> None:
    """Run the contact of a material file and print its results with the predictions of the theories.

    Warnings follow, and the path of the scene. An error ends the program by SystemExit, with a message.

    Args:
        file: of the material (TOML).
        out: run folder.
    """
    with command("the run", out, source=str(file)) as progress:
        done = api.from_material(file, out, progress)
    from contact1d.workflow.cli.summary import quantities, regime, theory_table

    lines = [done.scene.title, *regime(done), "", *quantities(done.run.document), *theory_table(done)]
    print_lines(lines, {**done.doubts, **done.run.warnings}, done.run.folder / "scene.toml")


def _scene_of_sphere(given: Mapping[str, float], tolerance: float, out: Path) -> None:
    """Find the interaction of a sphere, and print its parameters [FU·LU] and [LU], deviations, and results of the run.

    An error ends the program by SystemExit, with a message.

    Args:
        given: options by name, in SI: E* and R, and γ or F_A with a₀.
        tolerance: relative tolerance of the scene.
        out: run folder.
    """
    modulus, radius = given["contact-modulus"], given["radius"]
    with command("the run", out) as progress:
        from contact1d.workflow.identify import interaction

        if "surface-energy" in given:
            target = interaction.jkr_target(modulus, given["surface-energy"], radius)
        else:
            target = interaction.Target(given["adhesion-force"], given["zero-load-radius"])
        length_unit = given.get("length-unit")
        start = interaction.material_scene(modulus, radius, target, length_unit, tolerance=tolerance)
        finished, runs = interaction.identify(*start, out, progress)
    from contact1d.workflow.cli.summary import quantities
    from contact1d.workflow.units import prefixed

    lines = [f"identified in {runs} run{'s' if runs > 1 else ''}"]
    for (name, wanted), unit in zip(target._asdict().items(), ("N", "m"), strict=True):
        deviation = finished.document[name]["si"]["value"] / wanted - 1.0
        lines.append(f"  {name.replace('_', ' ')}: target {prefixed(wanted, unit)}, deviation {deviation:+.1e}")
    for name, term in finished.scene.interaction or ():
        if name in ("repulsion", "attraction"):
            lines.append(f"  {name:<28} amplitude {term.amplitude:.6g} FU·LU, range {term.range:.6g} LU")
    print_lines([*lines, *quantities(finished.document)], finished.warnings, finished.folder / "scene.toml")
