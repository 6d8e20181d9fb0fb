"""The typed scene: TOML in, either a `Scene` whose tables fit together or every problem at once."""

from workflow.scene.experiments import Experiment, Load, Method, Path, PullOff, Slide, Span
from workflow.scene.problems import Problem, SceneError
from workflow.scene.quantities import Table, Unit
from workflow.scene.read import read_scene, scene_from_dict
from workflow.scene.tables import (
    EFFECTS,
    Accuracy,
    Bodies,
    Cantilever,
    Damping,
    Exponential,
    Horizontal,
    Interaction,
    Neighbours,
    Noise,
    Parabola,
    Plate,
    Profile,
    Scene,
)
from workflow.scene.write import scene_to_toml

__all__ = [
    "EFFECTS",
    "Accuracy",
    "Bodies",
    "Cantilever",
    "Damping",
    "Experiment",
    "Exponential",
    "Horizontal",
    "Interaction",
    "Load",
    "Method",
    "Neighbours",
    "Noise",
    "Parabola",
    "Path",
    "Plate",
    "Problem",
    "Profile",
    "PullOff",
    "Scene",
    "SceneError",
    "Slide",
    "Span",
    "Table",
    "Unit",
    "read_scene",
    "scene_from_dict",
    "scene_to_toml",
]
