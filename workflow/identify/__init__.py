"""From a material to a scene: the interaction with which the model has a wanted F_A and a₀, found by a solver."""

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
