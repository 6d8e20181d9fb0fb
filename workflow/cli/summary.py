"""What a finished run says on a terminal: its numbers with uncertainty, its doubts, and the pressure profile."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from contact1d.analysis.pressure import Profile
from contact1d.workflow.units import PREFIXES, rounded

NAMES = {
    "adhesion_force": "adhesion force (pull-off)",
    "critical_radius": "critical radius a_cr",
    "zero_load_radius": "zero-load radius a_0",
    "contact_radius": "contact radius a",
    "mean_pressure": "mean pressure F/(pi a^2)",
    "separation_energy": "separation energy per length",
    "work_of_adhesion": "implied W = 2γ",
}
EXACTNESS = 1e-9
"""A relative uncertainty below it, as of a unit that was given, is left out."""
COLUMNS = 64
ROWS = 9
BLOCK, EMPTY, AXIS = "█", " ", "─"


def quantities(results: Mapping[str, Any]) -> list[str]:
    """One line for each quantity: name, value ± uncertainty, unit; with a [material] also in SI, and the units."""
    lines = []
    for name, entry in results.items():
        if isinstance(entry, dict) and {"value", "uncertainty", "unit"} <= entry.keys():
            label = NAMES.get(name, name.replace("_", " "))
            si = f"  = {in_si(entry['si'])}" if "si" in entry else ""
            lines.append(f"  {label:<28} {rounded(entry['value'], entry['uncertainty'])} {entry['unit']}{si}")
    if "units" in results:
        lines += [f"  {'1 ' + unit:<28} {in_si(entry)}" for unit, entry in results["units"].items()]
    return lines


def in_si(entry: Mapping[str, Any]) -> str:
    """Value ± uncertainty with a prefix: `39.028 ± 0.012 µN`."""
    value, uncertainty, unit = float(entry["value"]), float(entry["uncertainty"]), entry["unit"]
    power = math.floor(math.log10(abs(value)) / 3) if value else 0
    if unit not in ("N", "m", "Pa") or not min(PREFIXES) <= power <= max(PREFIXES):
        power = 0
    scale = 1000.0**power
    spread = uncertainty / scale
    number = rounded(value / scale, spread) if spread > EXACTNESS * abs(value) / scale else f"{value / scale:.5g}"
    return f"{number} {PREFIXES[power]}{unit}"


def pressure_plot(profile: Profile, radius: float) -> list[str]:
    """The pressure over x as bars in a terminal, compression up; the marks below it are at ±a."""
    scale = float(np.max(np.abs(profile.pressure), initial=0.0))
    if scale == 0.0:
        return ["  no pressure"]
    carrying = np.abs(profile.pressure) > 0.01 * scale
    half = 1.1 * float(np.max(np.abs(profile.x[carrying])))
    x = np.linspace(-half, half, COLUMNS)
    pressure = np.interp(x, profile.x, profile.pressure, left=0.0, right=0.0)
    step = (pressure.max() - min(pressure.min(), 0.0)) / ROWS or 1.0
    top, bottom = math.ceil(max(pressure.max(), 0.0) / step), math.floor(min(pressure.min(), 0.0) / step)
    lines = []
    for level in range(top, bottom - 1, -1):
        if level == 0:
            lines.append(f"{0.0:>12.3g} {AXIS * COLUMNS}")
            continue
        reached = pressure > (level - 0.5) * step if level > 0 else pressure < (level + 0.5) * step
        lines.append(f"{level * step:>12.3g} " + "".join(BLOCK if r else EMPTY for r in reached))
    if math.isfinite(radius) and 0.0 < radius < half:
        marks = [EMPTY] * COLUMNS
        for place in (-radius, radius):
            marks[round((place + half) / (2 * half) * (COLUMNS - 1))] = "^"
        lines.append(" " * 13 + "".join(marks) + "  ± a")
    lines.append(f"{'FU/LU':>12} " + f"x from {-half:.1f} to {half:.1f} LU".center(COLUMNS))
    return lines
