"""A finished run in its folder, and what its LU and FU are for a material (Eq. 9 of the paper)."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from contact1d.workflow.errors import Contact1dError, FolderError, RunError
from contact1d.workflow.runs.finished import load_run
from contact1d.workflow.runs.scales import UNIT_FIXING_RESULTS, jkr_scales
from contact1d.workflow.scene import Circle, Parabola
from contact1d.workflow.units import SI, Scales


class FinishedRunError(Contact1dError, ValueError):
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
    try:
        run = load_run(folder)
    except (FolderError, RunError) as error:
        raise FinishedRunError(str(error)) from None
    missing = [name for name in UNIT_FIXING_RESULTS if name not in run.results]
    if missing:
        raise FinishedRunError(f"{folder} has no {' and no '.join(missing)}: use a run of kind pull_off")
    profile = run.scene.bodies.profile
    if not isinstance(profile, Parabola | Circle):
        raise FinishedRunError(f"{folder}: the profile is a {profile.kind}, and JKR is for a sphere")
    force, radius = (run.results[name] for name in UNIT_FIXING_RESULTS)
    if not (force.value > 0.0 and radius.value > 0.0):
        raise FinishedRunError(f"{folder}: F_A and a_0 must be positive; they are {force.value:g} and {radius.value:g}")
    scales = jkr_scales(force, radius, profile.radius, contact_modulus, surface_energy)
    return scales, {name: quantity.entry() for name, quantity in run.results.items() if quantity.unit in SI}
