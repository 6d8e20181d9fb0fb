"""Terminal output of a finished run: its results with uncertainty, the line load, the regime of an adhesive contact."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from contact1d.analysis.radius import moved_centre
from contact1d.workflow.body.damping import damping_in_words
from contact1d.workflow.body.theory import in_words
from contact1d.workflow.runs import inputs
from contact1d.workflow.runs.report import results_in
from contact1d.workflow.units import LENGTH, LINE_PRESSURE, Quantity, prefixed

if TYPE_CHECKING:
    from contact1d.workflow.identify.choice import MaterialRun
    from contact1d.workflow.runs.finished import Run

NAMES = {
    "adhesion_force": "adhesion force (pull-off)",
    "critical_radius": "critical radius a_cr",
    "fixed_grips_displacement": "separation at d, fixed grips",
    "zero_load_radius": "zero-load radius a_0",
    "contact_radius": "contact radius a",
    "loaded_radius": "radius under load",
    "image_contact_radius": "half-width of the image",
    "mean_pressure": "mean pressure",
    "central_pressure": "p(0) on the axis",
    "contact_stiffness": "stiffness dF/dd",
    "adhesion_energy": "energy of adhesion",
    "separation_energy": "separation energy per length",
    "work_of_adhesion": "implied work of adhesion W",
}


def quantities(results: Mapping[str, Any]) -> list[str]:
    """Return lines with the reduction to one dimension, the effects, and each result: value ± uncertainty, theory.

    Values have their unit: in SI, with a prefix, where the units are known, and LU and FU are printed where they are
    not 1 m and 1 N. The uncertainty has two digits, the value as many decimals. A result too uncertain is "not
    reported". Lines on a scan and on uncertain inputs are added where there are any, and the first two lines are left
    out where `results`, the content of results.json, has no reduction.
    """
    lines = list[str]()
    if "reduction" in results:
        lines.append(f"  {'reduction':<31} {_reduction(results)}")
        lines.append(f"  {'effects':<31} {', '.join(results['effects']) or 'none'}")
    if scan := results.get("scan"):
        lines += [f"  {'scan' * (not i):<31} {part}" for i, part in enumerate(scan["text"].split("; "))]
    for name, entry in results_in(results).items():
        label = NAMES.get(name, name.replace("_", " "))
        if state := entry.get("state"):
            label += f", {state.replace('_', ' ')}"
        number = "not reported" if entry["value"] is None else str(Quantity.of(entry))
        lines.append(f"  {label:<31} {number:<32} {', '.join(in_words(results, name))}".rstrip())
    units = {unit: Quantity(**entry) for unit, entry in results.get("units", {}).items()}
    lines += [f"  {'1 ' + unit:<31} {size}" for unit, size in units.items() if size.value != 1.0]
    return [*lines, *damping_in_words(results), *inputs.in_words(results)]


def _reduction(results: Mapping[str, Any]) -> str:
    """Return how the contact was reduced to one dimension, and to which body radii and pressures belong, as one text.

    By the method of dimensionality reduction ("mdr") it is the body itself. Of two equal spheres it is these, and
    results named `image_…` belong to their plane image; of other plane models all radii are those of the image. Of a
    flat body there is no difference.
    """
    reduction = str(results["reduction"])
    if results["scene"]["bodies"]["profile"]["kind"] == "flat":
        return f"{reduction}: the same for a flat body"
    if reduction == "mdr":
        return "mdr: radii and pressures are those of the body"
    if any(name.startswith("image_") for name in results):
        return f"{reduction}: two equal spheres; image_… is of the one-dimensional image"
    return f"{reduction}: the plane model of the paper; radii are those of its image"


def line_load(run: Run, columns: int = 64, rows: int = 9) -> list[str]:
    """Return a plot of the line load of the state that is reported first, as lines of text, with a title.

    It is over x, compression up, with marks at ±a below, in SI where the units are known. Without pressure anywhere it
    is one line that says so; a radius of 0 or wider than the plot has no marks. The marks are about the centre of the
    contact, where that was displaced by more than a spacing. The last line has the units and the width, which has all
    |p| above 1 % of the largest. The run needs its outcome: AssertionError for one that was read from its folder.

    Args:
        run: finished run, with the line load [FU/LU] over x [LU] and the contact radius a [LU].
        columns: width of the plot in characters.
        rows: its height, about.
    """
    assert run.outcome is not None
    name, profile = next(iter(run.outcome.profiles.items()))
    radius, lines = run.outcome.radii[name], [f"\nline load, {name.replace('_', ' ')} state:"]
    largest = float(np.max(np.abs(profile.pressure), initial=0.0))
    if largest == 0.0:
        return [*lines, "  no pressure"]
    visible = np.abs(profile.pressure) > 0.01 * largest
    half = 1.1 * float(np.max(np.abs(profile.x[visible])))
    x = np.linspace(-half, half, columns)
    pressure = np.interp(x, profile.x, profile.pressure, left=0.0, right=0.0)
    step = (pressure.max() - min(pressure.min(), 0.0)) / rows or 1.0
    top, bottom = math.ceil(max(pressure.max(), 0.0) / step), math.floor(min(pressure.min(), 0.0) / step)
    load, load_unit = run.scales.written(float(np.max(np.abs(pressure))), LINE_PRESSURE)
    length, length_unit = run.scales.written(half, LENGTH)
    for level in range(top, bottom - 1, -1):
        is_filled = np.sign(level) * pressure > (abs(level) - 0.5) * step
        bars = "".join(np.where(is_filled, "█", " ")) if level else "─" * columns
        lines.append(f"{level * step * load:>12.3g} {bars}")
    ends = moved_centre(profile) + np.asarray([-radius, radius])
    if radius > 0.0 and np.abs(ends).max() < half:
        edges = np.rint((ends + half) / (2.0 * half) * (columns - 1))
        marks = "".join(np.where(np.isin(np.arange(columns), edges), "^", " "))
        lines.append(f"{'':13}{marks}  ± a")
    extent = f"x from {-half * length:.1f} to {half * length:.1f} {length_unit}"
    return [*lines, f"{load_unit:>12} {extent.center(columns)}"]


THEORY = {"adhesion_force": "N", "zero_load_radius": "m", "critical_radius": "m", "loaded_radius": "m"}
"""Predictions of the theories, with their units."""


def regime(done: MaterialRun) -> Iterator[str]:
    """Yield lines with the parameters of a contact in SI, the theory that holds under its load, and the model.

    Numbers have four digits, with prefixes, the Tabor parameter three. The second of the three lines is absent for a
    contact that is no adhesive sphere.
    """
    contact, theories = done.contact, done.theories
    parameters = [f"E* = {prefixed(contact.contact_modulus, 'Pa')}"]
    if contact.work_of_adhesion:
        parameters.append(f"work of adhesion W = {contact.work_of_adhesion:.4g} J/m²")
        assumed = " (assumed: no range was given)" if "range" not in contact.given else ""
        parameters.append(f"range h_0 = {prefixed(contact.range, 'm')}{assumed}")
    if contact.load is not None:
        parameters.append(f"load {prefixed(contact.load, 'N')}")
    yield f"  {', '.join(parameters)}"
    if theories is not None:
        yield f"  Tabor parameter μ = {theories.tabor:.3g}, {theories.verdict.theory}: {theories.verdict.reason}"
    spacing = done.scene.bodies.spacing * done.run.scales.length
    model = "a chain on a rigid plane" if done.scene.bodies.lower == "rigid_plane" else "two chains of particles"
    count = done.contact_radius / spacing
    yield f"  {model}: {count:.0f} particles in the contact radius, {prefixed(spacing, 'm')} apart"


def theory_table(done: MaterialRun, width: int = 18) -> Iterator[str]:
    """Yield the lines of a table with the predictions of each theory [m], [N], four digits with prefixes.

    The theory that holds at the Tabor parameter, at any load, is marked by *. A quantity that one of the theories lacks
    is left out. No lines without theories of an adhesive sphere.

    Args:
        done: the run of the contact.
        width: of a column in characters.
    """
    theories = done.theories
    if theories is None:
        return
    columns = [f"{name}*" if name == theories.holding else name for name in theories.values]
    yield f"\n  {f'theory, at μ = {theories.tabor:.3g}':<28} {''.join(f'{name:<{width}}' for name in columns)}".rstrip()
    for name, unit in THEORY.items():
        if all(name in marks for marks in theories.values.values()):
            shown = "".join(f"{prefixed(marks[name], unit):<{width}}" for marks in theories.values.values())
            yield f"  {NAMES[name]:<28} {shown}".rstrip()
    yield "  * holds at this μ, that of the material"
