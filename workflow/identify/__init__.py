"""From a material to a scene: choice of the model, and the interaction that gives a required F_A and a₀."""

from contact1d.workflow.identify.choice import MaterialRun, from_material
from contact1d.workflow.identify.interaction import (
    Identified,
    IdentifyError,
    Target,
    estimated,
    identify,
    jkr_target,
    material_scene,
    require_reachable,
)

__all__ = [
    "Identified",
    "IdentifyError",
    "MaterialRun",
    "Target",
    "estimated",
    "from_material",
    "identify",
    "jkr_target",
    "material_scene",
    "require_reachable",
]
