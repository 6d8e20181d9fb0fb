"""The record of `[experiment] kind = "tangential"`."""

from __future__ import annotations

from contact1d.workflow.experiments.running.kind import FINER_SPACING, ExperimentKind
from contact1d.workflow.experiments.tangential.schedule import schedule
from contact1d.workflow.experiments.tangential.tangential import tangential
from contact1d.workflow.scene import Scene


def advice(scene: Scene) -> str:
    """A row is exact, so that the lattice alone is left."""
    return f"What helps is {FINER_SPACING}"


TANGENTIAL = ExperimentKind(
    run={"quasistatic": tangential},
    planned=schedule,
    main_results=("tangential_force", "contact_radius", "stick_radius", "dissipated_energy"),
    advice=advice,
)
