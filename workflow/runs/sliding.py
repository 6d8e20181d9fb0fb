"""Changes that may help a slide which gives no result; each returns None where it does not apply."""

from __future__ import annotations

import math
from collections.abc import Callable

from contact1d.workflow.runs.change import STEP, Change, rounded
from contact1d.workflow.scene import Scene, Slide
from contact1d.workflow.settings.scales import interaction_law
from contact1d.workflow.settings.settings import settings_for
from contact1d.workflow.settings.way import SHORTEST, cantilever_swing

ENOUGH = 8.0
"""Way over the spacing of a longer one at least: some periods more than a mean needs."""


def chain_of(below: int, above: int) -> Callable[[Scene], Change | None]:
    """A lower chain of so many particles under as many as there are."""
    return lambda _: Change({"bodies.particles": below, "bodies.upper_particles": above})


def way_within(room: float) -> Callable[[Scene], Change | None]:
    """A distance that a chain has room for [LU], if that is enough for a mean."""

    def within(scene: Scene) -> Change | None:
        has = isinstance(scene.experiment, Slide) and scene.experiment.distance is not None
        enough = room >= SHORTEST * scene.bodies.spacing
        return Change({"experiment.distance": math.floor(100.0 * room) / 100.0}) if has and enough else None

    return within


def longer_way(scene: Scene) -> Change | None:
    """More periods of a slide, on a lower chain that is as much longer."""
    experiment = scene.experiment
    if not isinstance(experiment, Slide) or experiment.distance is None:
        return None
    longer = rounded(max(STEP * experiment.distance, ENOUGH * scene.bodies.spacing))
    chain = {} if scene.bodies.particles == "auto" else _longer_by(scene, longer - experiment.distance)
    return Change({"experiment.distance": longer, **chain})


def slower_drive(scene: Scene) -> Change | None:
    """One whose way takes some swings of the plate on its cantilever; none where it does already, or is too short."""
    experiment, cantilever = scene.experiment, scene.cantilever
    if not isinstance(experiment, Slide) or experiment.distance is None or cantilever is None:
        return None
    if experiment.distance < SHORTEST * scene.bodies.spacing:
        return None
    slower = experiment.distance / (STEP * cantilever_swing(scene, settings_for(scene)))
    return Change({"cantilever.velocity": rounded(slower)}) if STEP * slower < cantilever.velocity else None


def longer_lower_chain(scene: Scene) -> Change | None:
    """As much longer on both sides as the way is."""
    return Change(_longer_by(scene, scene.experiment.way)) if not scene.bodies.periodic else None


def shorter_way(scene: Scene) -> Change | None:
    """Less of a distance."""
    experiment = scene.experiment
    if not isinstance(experiment, Slide) or experiment.distance is None:
        return None
    return Change({"experiment.distance": rounded(experiment.distance / STEP)})


def stiffer_cantilever(scene: Scene) -> Change | None:
    """One that is wound up sooner."""
    if scene.cantilever is None:
        return None
    return Change({"cantilever.stiffness": rounded(STEP * scene.cantilever.stiffness)})


def automatic_drag(scene: Scene) -> Change | None:
    """Critical for the contact, of particles and plate."""
    values: dict[str, object] = {}
    if scene.damping is not None and scene.damping.coefficient != "auto":
        values["damping.coefficient"] = "auto"
    if scene.plate is not None and scene.noise is None and scene.plate.damping != "auto":
        values["plate.damping"] = "auto"
    return Change(values) if values else None


def drag_of_slide(scene: Scene) -> Change | None:
    """The same in a slide: with little drag a heavy plate swings through the other body as it is loaded."""
    return automatic_drag(scene) if isinstance(scene.experiment, Slide) else None


def colder(scene: Scene) -> Change | None:
    """A tenth of the heat, and no more than a tenth of the depth of a pair's well, which is what holds particles."""
    if scene.noise is None:
        return None
    lower, law = 0.1 * scene.noise.temperature, interaction_law(scene)
    if law is not None and law.attraction is not None:
        lower = min(lower, -0.1 * float(law.energy(law.force_free_distance())))
    return Change({"noise.temperature": rounded(lower)})


def lighter_plate(scene: Scene) -> Change | None:
    """One as heavy as its particles, in place of a heavier one, which the cantilever swings for longer than the way."""
    if scene.plate is None or scene.plate.mass == "auto":
        return None
    heavy = scene.plate.mass > settings_for(scene).particles * scene.bodies.mass
    return Change({"plate.mass": "auto"}) if heavy else None


def no_pull(scene: Scene) -> Change | None:
    """Adhesion alone."""
    pulled = isinstance(scene.experiment, Slide) and scene.experiment.normal_force < 0.0
    return Change({"experiment.normal_force": 0.0}) if pulled else None


def stronger_attraction(scene: Scene) -> Change | None:
    """A stronger law of the same force-free distance."""
    terms = scene.interaction
    if terms is None or terms.attraction is None:
        return None
    return Change(
        {
            "interaction.attraction.amplitude": rounded(STEP * terms.attraction.amplitude),
            "interaction.repulsion.amplitude": rounded(STEP * terms.repulsion.amplitude),
        }
    )


def _longer_by(scene: Scene, way: float) -> dict[str, object]:
    """The lower chain of a body that ends, longer by a way [LU] on both sides."""
    if scene.bodies.periodic:
        return {}
    settings = settings_for(scene)
    longer = settings.lower_particles + 2 * math.ceil(way / scene.bodies.spacing)
    return {"bodies.particles": longer, "bodies.upper_particles": settings.particles}
