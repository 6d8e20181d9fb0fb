"""The paper's numbers, and the scenes that stand for its experiments.

Geike and Popov, Tribology International 40 (2007). Neither interaction nor bulk stiffness is printed. The interaction
is identified by the first row of Table 1. The stiffness of 1 FU/LU was chosen: with it the curve of R = 1000
lies nearest to JKR's, so the nearness of that curve and the mean pressure are not predictions. The other rows of the
table, the exponents, and that curves of other R and N fall on the same one, are.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path

from contact1d.workflow.errors import FolderError, RunError
from contact1d.workflow.identify import Target, identify
from contact1d.workflow.runs.finished import load_run
from contact1d.workflow.runs.report import versions
from contact1d.workflow.scene import Scene, read_scene, scene_from_dict

CONTACT_MODULUS = 200e9
"""E* of the paper's example [Pa]."""
SURFACE_ENERGY = 1.0
"""γ of the paper's example [J/m²]."""


@dataclass(frozen=True)
class Row:
    """A row of Table 1: R and a₀ [LU], F_A [FU], one LU [m], one FU [N]."""

    radius: float
    zero_load_radius: float
    adhesion_force: float
    length_unit: float
    force_unit: float


TABLE_1 = (
    Row(1000.0, 28.53, 1.47, 6.1e-9, 39.0e-6),
    Row(1600.0, 36.14, 1.87, 7.7e-9, 61.8e-6),
    Row(2000.0, 40.36, 2.09, 8.6e-9, 77.6e-6),
)
HALF_DIGIT = {"a_0": 0.005, "F_A": 0.005, "one LU": 0.05, "one FU": 0.05}
"""Rounding of the printed numbers, in their units."""
LOCAL_SPACING = 4.0
"""Spacing of the scenes in the local limit, wider than the cutoff of some 3.8 LU: only opposite particles meet."""


def calibrated(folder: Path) -> Scene:
    """The paper's scene with the interaction that gives the first row of Table 1; `folder` for the runs.

    An identification that is there already, of the same scene and versions, holds.
    """
    scene = read_scene(Path(str(files("contact1d.lammps_inputs") / "scenes" / "paper.toml")))
    first = TABLE_1[0]
    target = Target(first.adhesion_force, first.zero_load_radius)
    return _identified(scene, target, folder) or identify(scene, target, folder).scene


def _identified(scene: Scene, target: Target, folder: Path) -> Scene | None:
    """The scene of a finished run in `folder` that is `scene` but for the interaction, and has its target."""
    try:
        run = load_run(folder)
        reached = [run.results[name].value for name in ("adhesion_force", "zero_load_radius")]
    except (FolderError, RunError, KeyError):
        return None
    found = run.scene
    same = found.model_copy(update={"interaction": scene.interaction}) == scene
    wanted = (target.adhesion_force, target.zero_load_radius)
    near = all(abs(a / b - 1.0) < scene.accuracy.tolerance for a, b in zip(reached, wanted, strict=True))
    return found if same and near and run.document.get("versions") == versions() else None


def changed(scene: Scene, *overrides: str) -> Scene:
    """The scene with `table.key=value` changed."""
    return scene_from_dict(scene, overrides)


def curve_scene(scene: Scene, deepest: float, steps: int) -> Scene:
    """The scene's F(a) by prescribed displacement: from 0 to `deepest` [LU] and back to separation in `steps`."""
    back = [deepest - (deepest + 1.5 * separation(scene)) * i / steps for i in range(steps + 1)]
    return changed(scene, f"experiment={{ kind = 'path', displacements = {[round(d, 6) for d in back]} }}")


def separation(scene: Scene) -> float:
    """Displacement [LU] of some two ranges, at which the contact has let go."""
    assert scene.interaction is not None
    assert scene.interaction.attraction is not None
    return scene.interaction.attraction.range


def local(scene: Scene, spacing: float = LOCAL_SPACING) -> Scene:
    """The scene in the local limit: no neighbour springs, and particles so wide apart that only opposite ones meet.

    Stiffness and interaction per length are those of the scene, whose spacing is 1 LU.
    """
    data = scene.model_dump(by_alias=True, exclude_none=True)
    data.pop("neighbours", None)
    data["bodies"] |= {
        "spacing": spacing,
        "particles": "auto",
        "bulk_stiffness": spacing * scene.bulk_stiffness / scene.bodies.spacing,
    }
    for term in ("repulsion", "attraction"):
        data["interaction"][term]["amplitude"] *= spacing / scene.bodies.spacing
    return scene_from_dict(data)


def with_radius(scene: Scene, radius: float) -> Scene:
    """The scene with another R [LU]."""
    return changed(scene, f"bodies.profile.radius={radius}")
