"""The program's own impacts, beside LAMMPS's models and what is exact."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from validation.grains import cases
from validation.grains.cases import OURS, SPHERES, WORK_OF_ADHESION, at_number, row_name
from validation.references.grains import kelvin_voigt
from validation.row import Reference, Row, claim, solver
from validation.study import NOTHING, Bench, Findings, Refused, found, said

RADIUS, MASS = 1000.0, math.sqrt(1000.0)
"""[LU], [MU]: with E* = 1 and v = 1 the time T of a Kelvin-Voigt body is 1, and d about 1."""
WORK = 0.01
"""W [FU/LU] of the adhesive body."""
BODIES = {"profile": {"kind": "parabola", "radius": RADIUS}, "reduction": "mdr", "lower": "rigid_plane"}
FINE = BODIES | {"particles": "auto", "spacing": 0.25, "bulk_stiffness": 0.25}
"""Of the largest force, which a stiff dashpot has early, when few particles touch."""
LONG = BODIES | {"particles": 301, "spacing": 1.0, "bulk_stiffness": 1.0}
"""Longer than the deepest adhesive contact."""
TOLERANCE = {"tolerance": 1e-4}
FORCE_UNIT = MASS
"""m v/T."""
STICKING = math.sqrt(
    (WORK / WORK_OF_ADHESION) ** (5 / 3) * RADIUS ** (4 / 3) / MASS
) * SPHERES.sticking_velocity(1.0)  # fmt: skip
"""v_s [LU/TU]: ½ m v_s² is as (W⁵R⁴/E*²)^(1/3)."""


def impacts(bench: Bench) -> Findings:
    """Kelvin-Voigt bodies, and adhesive ones."""
    rows: list[Row] = []
    for A in cases.NUMBERS:
        exact = kelvin_voigt(A)
        wanted = {"restitution": exact.restitution}
        if A in cases.TIMED:
            wanted |= {"contact_time": exact.contact_time, "peak_force": exact.peak_force}
        known = {name: solver(value, "Kelvin-Voigt body, its motion integrated") for name, value in wanted.items()}
        body = {"bodies": FINE, "viscoelasticity": {"retardation_time": A}}
        rows += _rows(bench, at_number(A), 1.0, body, known)
    for over in cases.OVER_STICKING:
        known = {"restitution": Reference(math.sqrt(1.0 - over**-2) if over > 1.0 else 0.0, "e² = 1 − (v_s/v)²")}
        adheres = {"bodies": LONG, "adhesion": {"work_of_adhesion": WORK}}
        rows += _rows(bench, f"v = {over:g} v_s", over * STICKING, adheres, known)
    return Findings(rows)


def _rows(
    bench: Bench, at: str, velocity: float, tables: Mapping[str, Any], known: Mapping[str, Reference]
) -> Iterator[Row]:
    experiment = {"kind": "impact", "velocity": velocity}
    run = bench.run(at.replace(" ", ""), {**tables, "plate": {"mass": MASS}, "accuracy": TOLERANCE,
                                          "experiment": experiment})  # fmt: skip
    bound = claim(said("what the run states", run))
    for name, exact in known.items():
        one = NOTHING if isinstance(run, Refused) else found(run, name)
        unit = FORCE_UNIT if name == "peak_force" else 1.0
        yield Row(row_name(OURS, at, name), one.value / unit, exact, bound, one.uncertainty / unit)
