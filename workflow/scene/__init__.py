"""The typed scene: TOML in, either a `Scene` whose tables fit together or every problem at once."""

from contact1d.workflow.scene.effects import (
    Adhesion,
    Cantilever,
    Damping,
    Exponential,
    Friction,
    Horizontal,
    Interaction,
    Neighbours,
    Noise,
    Plate,
)
from contact1d.workflow.scene.experiments import Experiment, Hold, Load, Method, Path, PullOff, Slide, Span, Tangential
from contact1d.workflow.scene.material import Elastic, Material, Reduction
from contact1d.workflow.scene.problems import Problem, SceneError
from contact1d.workflow.scene.profiles import (
    Circle,
    Cone,
    Ellipsoid,
    Flat,
    FlatPunch,
    Measured,
    Parabola,
    Power,
    Profile,
)
from contact1d.workflow.scene.quantities import Table, Unit
from contact1d.workflow.scene.read import AnyScene, Scene, read_scene, read_tables, scene_from_dict, scene_to_toml
from contact1d.workflow.scene.tables import EFFECTS, Accuracy, Bodies, Output

__all__ = [
    "EFFECTS",
    "Accuracy",
    "Adhesion",
    "AnyScene",
    "Bodies",
    "Cantilever",
    "Circle",
    "Cone",
    "Damping",
    "Elastic",
    "Ellipsoid",
    "Experiment",
    "Exponential",
    "Flat",
    "FlatPunch",
    "Friction",
    "Hold",
    "Horizontal",
    "Interaction",
    "Load",
    "Material",
    "Measured",
    "Method",
    "Neighbours",
    "Noise",
    "Output",
    "Parabola",
    "Path",
    "Plate",
    "Power",
    "Problem",
    "Profile",
    "PullOff",
    "Reduction",
    "Scene",
    "SceneError",
    "Slide",
    "Span",
    "Table",
    "Tangential",
    "Unit",
    "read_scene",
    "read_tables",
    "scene_from_dict",
    "scene_to_toml",
]
