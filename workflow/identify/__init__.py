"""From a material to a scene: the interaction with which the model has a wanted F_A and a₀, found by a solver."""

from workflow.identify.material import jkr_target, material_scene
from workflow.identify.search import Identified, identify
from workflow.identify.start import estimated
from workflow.identify.target import IdentifyError, Target, require_reachable

__all__ = [
    "Identified",
    "IdentifyError",
    "Target",
    "estimated",
    "identify",
    "jkr_target",
    "material_scene",
    "require_reachable",
]
