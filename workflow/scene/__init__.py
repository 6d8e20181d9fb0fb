"""The typed scene: TOML in, either a `Scene` whose tables fit together or every problem at once."""

from contact1d.workflow.scene.effects import (
    Adhesion,
    Cantilever,
    Damping,
    Friction,
    Interaction,
    Neighbours,
    Noise,
    Plate,
    Rate,
    Viscoelasticity,
)
from contact1d.workflow.scene.experiments import History, Hold, Impact, Load, Path, PullOff, Slide, Tangential
from contact1d.workflow.scene.kinds import Kind
from contact1d.workflow.scene.measured import Measured
from contact1d.workflow.scene.problems import Problem, SceneError
from contact1d.workflow.scene.profiles import Profile
from contact1d.workflow.scene.quantities import Table
from contact1d.workflow.scene.read import AnyScene, Scene, read_scene, read_tables
from contact1d.workflow.scene.shapes import Parabola, Shape
from contact1d.workflow.scene.tables import EFFECTS, Bodies, Reduction

__all__ = [
    "EFFECTS",
    "Adhesion",
    "AnyScene",
    "Bodies",
    "Cantilever",
    "Damping",
    "Friction",
    "History",
    "Hold",
    "Impact",
    "Interaction",
    "Kind",
    "Load",
    "Measured",
    "Neighbours",
    "Noise",
    "Parabola",
    "Path",
    "Plate",
    "Problem",
    "Profile",
    "PullOff",
    "Rate",
    "Reduction",
    "Scene",
    "SceneError",
    "Shape",
    "Slide",
    "Table",
    "Tangential",
    "Viscoelasticity",
    "read_scene",
    "read_tables",
]
