"""What `identify` prints of a contact that was described by its material: the regime, the run, the theories."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from contact1d.workflow.cli.summary import NAMES, in_si
from contact1d.workflow.units import prefixed

if TYPE_CHECKING:
    from contact1d.workflow.identify import MaterialRun

ROWS = {"adhesion_force": "N", "zero_load_radius": "m", "critical_radius": "m", "loaded_radius": "m"}
"""What the theories say, and its unit."""
LABELS = {**NAMES, "loaded_radius": "radius under the load"}
WIDTH = 18


def regime(found: MaterialRun) -> Iterator[str]:
    """What the contact is, and which theory holds."""
    contact, theories = found.contact, found.theories
    said = [f"E* = {prefixed(contact.contact_modulus, 'Pa')}"]
    if contact.work_of_adhesion:
        said.append(f"work of adhesion W = 2γ = {contact.work_of_adhesion:.4g} J/m²")
        assumed = " (assumed: no range was given)" if contact.range_is_assumed else ""
        said.append(f"range z_0 = {prefixed(contact.range, 'm')}{assumed}")
    if contact.load is not None:
        said.append(f"load {prefixed(contact.load, 'N')}")
    yield f"  {', '.join(said)}"
    if theories is not None:
        yield f"  Tabor's μ = {theories.tabor:.3g}, {theories.verdict.theory}: {theories.verdict.reason}"
    material = found.scene.material
    assert material is not None
    assert material.length_unit is not None
    spacing = found.scene.bodies.spacing * material.length_unit
    what = "a chain on a rigid plane" if found.scene.bodies.lower == "rigid_plane" else "two chains of particles"
    count = found.contact_radius / spacing
    yield f"  {what}: {count:.0f} particles in the contact radius, {prefixed(spacing, 'm')} apart"


def beside_theories(found: MaterialRun) -> Iterator[str]:
    """A table: what the run has, and what each theory says, with the run's deviation from JKR."""
    theories = found.theories
    if theories is None:
        return
    columns = {name: f"{name}*" if name == theories.holding else name for name in theories.values}
    yield f"  {'':<28} {'this run':<26}" + "".join(f"{shown:<{WIDTH}}" for shown in columns.values()) + "beside JKR"
    for name, unit in ROWS.items():
        values = {theory: theories.values[theory].get(name) for theory in columns}
        if None in values.values():
            continue
        own, deviation = _own(found, name), ""
        if own is not None and values["JKR"]:
            deviation = f"{own['value'] / values['JKR'] - 1.0:+.2%}"
        said = "—" if own is None else in_si(own)
        shown = "".join(f"{prefixed(value, unit) if value else '0':<{WIDTH}}" for value in values.values())
        yield f"  {LABELS[name]:<28} {said:<26}{shown}{deviation}"
    yield "  * holds at this μ"


def _own(found: MaterialRun, name: str) -> Mapping[str, Any] | None:
    """The run's own value in SI, as in results.json; the radius under the load is that of the last loading row."""
    if name != "loaded_radius":
        entry = found.run.document.get(name)
        return entry.get("si") if isinstance(entry, dict) else None
    curve, material = found.run.curve, found.scene.material
    loading = [i for i, branch in enumerate(curve.branch) if branch == "loading"]
    if not loading or material is None or material.length_unit is None:
        return None
    radius, spread = curve.contact_radius[loading[-1]], curve.contact_radius_uncertainty[loading[-1]]
    if not math.isfinite(radius):
        return None
    unit = material.length_unit
    return {"value": radius * unit, "uncertainty": spread * unit, "unit": "m"}
