"""From a material to a scene: the interaction with which the model has a wanted F_A and a₀, found by a solver."""

from contact1d.workflow.identify.from_material import MaterialRun, from_material
from contact1d.workflow.identify.material import jkr_target, material_scene
from contact1d.workflow.identify.search import Identified, identify
from contact1d.workflow.identify.start import estimated
from contact1d.workflow.identify.target import IdentifyError, Target, require_reachable

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
