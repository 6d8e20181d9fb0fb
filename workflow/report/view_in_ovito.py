"""The states of a run in OVITO: particles coloured by the force of the opposite body, springs as bonds.

With OVITO's Python module (`pip install ovito`), or as a script of OVITO Pro,

    python view_in_ovito.py

writes two files from states.lammpstrj and system.data into the folder of the script: way.ovito, a session that every
OVITO opens (File, Load Session State) and plays, and way.png, the state with the largest force. Heights are drawn
larger than x, by the same factor in all states. Blue is compression, red tension, on one scale for all states.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from ovito import scene
from ovito.io import import_file
from ovito.modifiers import (
    AffineTransformationModifier,
    ColorCodingModifier,
    ComputePropertyModifier,
    DeleteSelectedModifier,
    ExpressionSelectionModifier,
    LoadTrajectoryModifier,
)
from ovito.vis import ColorLegendOverlay, TachyonRenderer, Viewport

SHAPE = 0.35
"""Height of the bodies in the picture over their width."""
SIZE = (1600, 900)
"""Width and height of the picture [pixel]."""
PRESS = "ParticleType == 2 ? Force.Z : (ParticleType == 1 ? -Force.Z : 0)"
"""Force that presses a particle onto the opposite body [FU], in OVITO's syntax; types: 1 lower, 2 upper particles."""
COLOURS = np.array([[0.70, 0.02, 0.15], [0.86, 0.86, 0.86], [0.02, 0.30, 0.70]])


def main(folder: Path) -> None:
    """Load the states of a run in a folder, choose view and colours, and write way.ovito and way.png there.

    Earlier ones are replaced. The path of way.ovito is printed.
    """
    pipeline = import_file(str(folder / "system.data"))
    trajectory = LoadTrajectoryModifier()
    trajectory.source.load(str(folder / "states.lammpstrj"))
    pipeline.modifiers.append(trajectory)
    pipeline.modifiers.append(ComputePropertyModifier(output_property="Press", expressions=[PRESS]))
    states = [pipeline.compute(i).particles for i in range(pipeline.num_frames)]
    half, height, spacing, largest, frame = extents(states)
    colours = ColorCodingModifier(property="Press", start_value=-largest, end_value=largest)
    colours.gradient = ColorCodingModifier.Gradient(COLOURS)
    larger = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, SHAPE * 2.0 * half / height, 0.0]]
    size = f"ParticleType > 2 ? {0.1 * spacing} : {0.4 * spacing}"
    for modifier in (
        ExpressionSelectionModifier(expression=f"ParticleType > 4 || abs(Position.X) > {half}"),
        DeleteSelectedModifier(),
        AffineTransformationModifier(transformation=larger, operate_on={"particles"}),
        ComputePropertyModifier(output_property="Radius", expressions=[size]),
        colours,
    ):
        pipeline.modifiers.append(modifier)
    data = pipeline.compute(frame)
    if data.particles.bonds is not None:
        data.particles.bonds.vis.width = 0.12 * spacing
    data.cell.vis.enabled = False
    pipeline.add_to_scene()
    view = Viewport(type=Viewport.Type.Front)
    title = "force on a particle (FU): blue: compressive, red: tensile"
    view.overlays.append(ColorLegendOverlay(modifier=colours, title=title, font_size=0.06, format_string="%.3g"))
    view.zoom_all(size=SIZE)
    scene.save(str(folder / "way.ovito"))
    flat = TachyonRenderer(ambient_occlusion=False, shadows=False)  # on the processor: needs no graphics driver
    picture = str(folder / "way.png")
    view.render_image(filename=picture, size=SIZE, frame=frame, background=(1.0, 1.0, 1.0), renderer=flat)
    print(folder / "way.ovito")


def extents(states: list[Any], least_share: float = 0.01) -> tuple[float, float, float, float, int]:
    """Return half-width, height and spacing of the view [LU], largest |force| on a particle [FU], and index of a state.

    That state is the one with the largest |sum of forces| on the upper body. The half-width is 1.2 times the largest
    |x| of all particles with more than `least_share` of the largest force, plus two spacings; the height is that of
    both bodies in it, or the spacing where it is 0. Without any force the largest is 1, and the spacing of a single
    particle is 1.

    Args:
        states: particles of each state, with type, position and `Press`, the force onto the opposite body [FU].
        least_share: of the largest force.
    """
    kinds = np.asarray(states[0]["Particle Type"])
    press = np.asarray([state["Press"] for state in states])
    positions = np.asarray([state["Position"] for state in states])
    upper, bodies = kinds == 2, kinds <= 2
    largest = float(np.abs(press).max()) or 1.0
    spacing = float(np.median(np.diff(positions[0, upper, 0]))) if upper.sum() > 1 else 1.0
    loaded = np.abs(positions[:, :, 0])[np.abs(press) > least_share * largest]
    half = 1.2 * float(loaded.max(initial=0.0)) + 2.0 * spacing
    heights = positions[:, :, 2][bodies & (np.abs(positions[:, :, 0]) <= half)]
    frame = int(np.argmax(np.abs(press[:, upper].sum(axis=1))))
    return half, float(np.ptp(heights)) or spacing, spacing, largest, frame


if __name__ == "__main__":
    main(Path(__file__).resolve().parent)
