"""A finished run in its folder, and what its LU and FU are for a material (Eq. 9 of the paper)."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from contact1d.workflow.runs.report import RESULTS
from contact1d.workflow.runs.scales import jkr_scales
from contact1d.workflow.units import SI, Quantity, Scales


class FinishedRunError(ValueError):
    """A folder that holds no run with F_A and a₀ of a sphere; the message says what is missing."""


def scales_of_run(folder: Path, contact_modulus: float, surface_energy: float) -> tuple[Scales, dict[str, Any]]:
    """The scales with which the run is JKR's contact of the material, and the run's quantities that have a unit of LU
    and FU.

    Args:
        folder: run folder of a pull_off, or of a path that found F_A and a₀.
        contact_modulus: E* [Pa].
        surface_energy: γ of one side [J/m²].

    Raises:
        FinishedRunError: no such run, or one without these quantities.
    """
    path = folder / RESULTS
    try:
        results = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise FinishedRunError(f"{path}: {error.strerror}; give the folder of a finished run") from None
    except ValueError:
        raise FinishedRunError(f"{path} is no results file") from None
    if not isinstance(results, dict) or results.get("status") != "done":
        raise FinishedRunError(f"{path}: the run has no numbers; only one with status done can be identified")
    missing = [name for name in ("adhesion_force", "zero_load_radius") if name not in results]
    if missing:
        raise FinishedRunError(f"{path} has no {' and no '.join(missing)}: use a run of kind pull_off")
    try:
        profile = results["scene"]["bodies"]["profile"]
    except (KeyError, TypeError):
        raise FinishedRunError(f"{path} does not say what scene it is of; run that scene anew") from None
    if profile["kind"] not in ("parabola", "circle"):
        raise FinishedRunError(f"{path}: the profile is a {profile['kind']}, and JKR is for a sphere")
    force, radius = (
        Quantity(results[name]["value"], results[name]["uncertainty"], results[name]["unit"])
        for name in ("adhesion_force", "zero_load_radius")
    )
    if not (force.value > 0.0 and radius.value > 0.0):
        raise FinishedRunError(f"{path}: F_A and a_0 must be positive; they are {force.value:g} and {radius.value:g}")
    scales = jkr_scales(force, radius, profile["radius"], contact_modulus, surface_energy)
    quantities = {name: entry for name, entry in results.items() if isinstance(entry, dict) and entry.get("unit") in SI}
    return scales, quantities
