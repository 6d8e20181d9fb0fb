"""The record of `[experiment] kind = "path"`."""

from __future__ import annotations

from contact1d.workflow.experiments.path.path import path
from contact1d.workflow.experiments.path.schedule import schedule
from contact1d.workflow.experiments.running.kind import FINER_SPACING, ExperimentKind
from contact1d.workflow.experiments.running.prescribing import in_smaller_steps
from contact1d.workflow.scene import Scene


def advice(scene: Scene) -> str:
    """The rows are the scene's own."""
    return f"What helps is more steps in experiment.displacements; for a radius {FINER_SPACING}, too"


PATH = ExperimentKind(
    run={"quasistatic": in_smaller_steps(path), "dynamic": in_smaller_steps(path)},
    planned=schedule,
    main_results=(
        "adhesion_force", "zero_load_radius", "critical_radius", "largest_force", "largest_radius",
    ),
    advice=advice,
)  # fmt: skip
