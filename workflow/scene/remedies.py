"""Suggested fixes of a scene for named failures, carried by their errors."""

from __future__ import annotations

from collections.abc import Iterator

from contact1d.workflow.errors import SceneEdit
from contact1d.workflow.scene.quantities import Unit, keys_of
from contact1d.workflow.scene.read import Scene

STEP = 3.0
"""Load before an edit over that after it, where nothing says how much is carried."""
COLDER = 0.1
"""Temperature after an edit over that before it."""


def less_compression(scene: Scene, carried: float | None = None) -> Iterator[SceneEdit]:
    """The key of the experiment that gives the compressive force, with a smaller one; none where it gives none.

    Args:
        scene: with the experiment.
        carried: a force [FU] that is carried; half of it is taken.
    """
    given = scene.experiment.compression
    force = 0.5 * carried if carried is not None else (given or 0.0) / STEP
    if given and force > 0.0:
        for name, key in keys_of(type(scene.experiment)).items():
            if key.allowed.unit == Unit("FU") and getattr(scene.experiment, key.field) == given:
                yield SceneEdit({f"experiment.{name}": float(f"{force:.3g}")})


def against_passing(scene: Scene) -> Iterator[SceneEdit]:
    """Against bodies that go through each other: less heat, no lateral motion unless it is examined, less load."""
    if scene.noise:
        yield SceneEdit({"noise.temperature": float(f"{COLDER * scene.temperature:.3g}")})
    pulled = scene.experiment.motion_is_result or (scene.plate and "x" in scene.plate.free)
    if scene.horizontal and not pulled:
        yield SceneEdit(without=("horizontal",))
    yield from less_compression(scene)


def longer_chain(scene: Scene) -> Iterator[SceneEdit]:
    """Against a contact that reaches the end of its chain: as many particles as it needs, or less load."""
    bodies = scene.bodies
    if bodies.upper_particles is not None and not bodies.periodic:
        yield SceneEdit({"bodies.upper_particles": 2 * bodies.upper_particles, "bodies.particles": "auto"})
    elif bodies.particles != "auto":
        yield SceneEdit({"bodies.particles": "auto"})
    yield from less_compression(scene)
