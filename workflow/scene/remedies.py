"""Suggested fixes of a scene for named failures, carried by their errors."""

from __future__ import annotations

from collections.abc import Iterator

from contact1d.workflow.errors import SceneEdit
from contact1d.workflow.scene.quantities import Unit, keys_of
from contact1d.workflow.scene.read import Scene


def less_compression(scene: Scene, carried: float | None = None) -> Iterator[SceneEdit]:
    """Yield one edit of the scene with a smaller compressive force of the experiment [FU], to three significant digits.

    Nothing is yielded where the experiment gives no single compressive force: displacements, a force ≤ 0, a list of
    forces, or a history of them.

    Args:
        scene: with the experiment.
        carried: a force [FU] that is carried: the edit has half of it, whatever the force given; None: a third of the
            force given. Without an edit where it is 0 or less.
    """
    given = scene.experiment.compression
    force = 0.5 * carried if carried is not None else (given or 0.0) / 3.0
    if given and force > 0.0:
        for name, key in keys_of(type(scene.experiment)).items():
            if key.allowed.unit == Unit("FU") and getattr(scene.experiment, key.field) == given:
                yield SceneEdit({f"experiment.{name}": float(f"{force:.3g}")})


def against_passing(scene: Scene) -> Iterator[SceneEdit]:
    """Yield edits of the scene against bodies that penetrate each other, each for itself, as far as they apply to it.

    In this order: with noise a tenth of the temperature, as k_BT [FU·LU]; no [horizontal], unless in a slide or with a
    plate that is free along x; a third of the compressive force [FU], where the experiment gives a single one. Numbers
    are in units of the model, to three digits. None may apply; the scene is not changed.
    """
    if scene.noise:
        yield SceneEdit({"noise.temperature": float(f"{0.1 * scene.temperature:.3g}")})
    pulled = scene.experiment.motion_is_result or (scene.plate and "x" in scene.plate.free)
    if scene.horizontal and not pulled:
        yield SceneEdit(without=("horizontal",))
    yield from less_compression(scene)


def longer_chain(scene: Scene) -> Iterator[SceneEdit]:
    """Yield edits of the scene against a contact that reaches the end of its chain, each for itself.

    First more particles: twice as many of the upper chain, if its number is given and it is not periodic, with "auto"
    as number of lower ones; else "auto" as number of particles, unless it is that already. Then a third of the
    compressive force [FU], to three digits, where the experiment gives a single one. None may apply.
    """
    bodies = scene.bodies
    if bodies.upper_particles is not None and not bodies.periodic:
        yield SceneEdit({"bodies.upper_particles": 2 * bodies.upper_particles, "bodies.particles": "auto"})
    elif bodies.particles != "auto":
        yield SceneEdit({"bodies.particles": "auto"})
    yield from less_compression(scene)
