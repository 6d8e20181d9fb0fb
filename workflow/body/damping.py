"""What LAMMPS's damping models make of an impact: the coefficients whose restitution is nearest to that of the body."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from contact1d.analysis.theory.impact import nearest
from contact1d.workflow.scene import Impact, Scene
from contact1d.workflow.units import RATE, Scales, prefixed


def damping_models(scene: Scene, scales: Scales) -> list[dict[str, Any]]:
    """Return the nearest coefficient η of each damping model over a decade of velocities around that of an impact.

    Each has "model", "coefficient" with "value" and "unit", and "si" where that is known; its "factor" over 2E*T/m of
    the approach; "velocities" [LU/TU], and there "restitution" of the model and "exact" of the body. Empty for any
    scene but an impact of a paraboloid with a retardation time.
    """
    impact = scene.experiment
    if not isinstance(impact, Impact) or not scene.viscoelasticity or scene.bodies.profile.kind != "parabola":
        return []
    time = scene.relaxation.retardation_time
    if not time:
        return []
    velocities = [impact.velocity * 10.0 ** (0.5 * side) for side in (-1, 0, 1)]
    times = [time / scene.impact_time * (velocity / impact.velocity) ** 0.2 for velocity in velocities]
    models = []
    for model, ends in (("viscoelastic", 0.0), ("viscoelastic limit_damping", 1.0)):
        factor, reached, exact = nearest(times, ends)
        value = factor * 2.0 * scene.bulk_stiffness / scene.bodies.spacing * time / scene.impact_mass
        coefficient: dict[str, Any] = {"value": value, "unit": RATE}
        if scales.know(RATE):
            si = scales.in_si(value, 0.0, RATE)
            coefficient["si"] = {name: si[name] for name in ("value", "unit")}
        models.append(
            {"model": model, "coefficient": coefficient, "factor": factor, "velocities": velocities,
             "restitution": reached, "exact": exact}
        )  # fmt: skip
    return models


def damping_in_words(results: Mapping[str, Any]) -> Iterator[str]:
    """Yield a line for each damping model of results.json: its name, η, and its restitution (that of the body)."""
    for entry in results.get("damping_models", ()):
        shown = entry["coefficient"].get("si", entry["coefficient"])
        pairs = zip(entry["restitution"], entry["exact"], strict=True)
        e = ", ".join(f"{reached:.4f} ({exact:.4f})" for reached, exact in pairs)
        size = prefixed(shown["value"], shown["unit"])
        yield f"  {'damping in LAMMPS':<31} {entry['model']}: η = {size}, e = {e} at v/√10, v, √10 v"
