"""What helps a scene that gives no result, found by trying it: changes as the command line has them.

The changes that are known to help against such a failure are tried, what helps most often first. One that does not help
is tried again together with each that is known to help against what it failed by itself; what is likelier comes first:
the cost of a change is its rank, and that of two together the sum of theirs.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from itertools import count

from contact1d.workflow.continuation.trust import (
    ChainEndError,
    DigitsError,
    OffEndError,
    PartedError,
    RestlessError,
    TensionError,
    ThroughError,
    UnsteadyError,
    UntrustedError,
)
from contact1d.workflow.engine.failure import EngineError
from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.runs.change import STEP, rounded
from contact1d.workflow.runs.change import Change as Change
from contact1d.workflow.runs.scales import scales_of
from contact1d.workflow.runs.sliding import (
    automatic_drag,
    chain_of,
    colder,
    drag_of_slide,
    lighter_plate,
    longer_lower_chain,
    longer_way,
    no_pull,
    shorter_way,
    slower_drive,
    stiffer_cantilever,
    stronger_attraction,
    way_within,
)
from contact1d.workflow.scene import Load, Path, PullOff, Scene, SceneError, Slide
from contact1d.workflow.scene.experiments import Span
from contact1d.workflow.scene.quantities import places
from contact1d.workflow.settings.estimate import NotCarriedError
from contact1d.workflow.settings.way import ShortChainError
from contact1d.workflow.units import NUMBER

MOST_TRIALS = 12
"""Changes that are tried at most."""
ENOUGH = 2
"""Changes that help after which no other is tried."""
TOLD = 4
"""Changes that did not help which are named, where none did."""
HELD = 0.9
"""Tension that is tried where a larger one was not held, over the largest one."""
NARROW = 0.8
"""Range of the repulsion over half of the attraction's below which it counts as short."""

Reader = Callable[["Change"], Scene]
"""The scene with a change. Raises SceneError."""
Attempt = Callable[[Scene], object]
"""Runs a scene; raises a Contact1dError where it gives no result."""


@dataclass(frozen=True)
class Tried:
    """What was tried: the changes with which the scene gives a result, and those with which it does not."""

    helped: tuple[Change, ...] = ()
    failed: tuple[Change, ...] = ()

    def __str__(self) -> str:
        """A sentence, or nothing where nothing was tried."""
        if self.helped:
            also = "".join(f", and so does {one}" for one in self.helped[1:])
            return f"Tried: {self.helped[0]} gives a result{also}" + (
                f"; {', '.join(map(str, self.failed))} did not" if self.failed else ""
            )
        more = f" and {len(self.failed) - TOLD} more" if len(self.failed) > TOLD else ""
        return f"Tried in vain: {', '.join(map(str, self.failed[:TOLD]))}{more}" if self.failed else ""


def tried(
    reader: Reader, error: Contact1dError, attempt: Attempt, note: Callable[[str], None], patience: float = math.inf
) -> Tried:
    """Try what may help a scene that failed by `error`.

    Args:
        reader: gives the scene with a change.
        error: why it gives no result without.
        attempt: runs a changed scene.
        note: told of every trial.
        patience: wall time [s] after which no further change is tried.
    """
    until = time.monotonic() + patience
    number = count()  # changes have no order of their own
    waiting = [(cost, next(number), 1, change) for cost, change in enumerate(_changes(reader, Change(), error), 1)]
    helped: list[Change] = []
    failed: list[Change] = []
    while waiting and len(helped) < ENOUGH and len(helped) + len(failed) < MOST_TRIALS and time.monotonic() < until:
        cost, _, together, change = heappop(waiting)
        if change in (*failed, *helped) or (helped and together > 1):
            continue  # where one change helps, there is no need for two
        note(f"trying what helps: {change}")
        try:
            attempt(reader(change))
        except Contact1dError as another:
            failed.append(change)
            for further, one in enumerate(_changes(reader, change, another), 1):
                heappush(waiting, (cost + further, next(number), together + 1, change.then(one)))
        else:
            helped.append(change)
    return Tried(tuple(helped), tuple(failed))


def _changes(reader: Reader, made: Change, error: Contact1dError) -> Iterator[Change]:
    """What may help against `error`, beside the change that was `made` already."""
    if isinstance(error, SceneError):
        if made == Change():
            yield from _ways(error)
        return
    scene = reader(made)
    for what in _kinds(error):
        change = what(scene)
        if change is not None and not change.touches(made):
            yield _in_si(scene, change)


def _in_si(scene: Scene, change: Change) -> Change:
    """The change with units, "33.3pN", where LU and FU are known: a scene file that has them takes no plain number."""
    material, scales = scene.material, scales_of(scene, {})
    if scales is None or material is None or material.length_unit is None or material.force_unit is None:
        return change
    units = {
        ".".join(map(str, place.keys)): place.unit.name
        for place in places(Scene, scene.model_dump(by_alias=True, exclude_none=True))
    }
    values = dict(change.values)
    for key, value in change.values.items():
        unit = units.get(key, NUMBER)
        if isinstance(value, float) and unit != NUMBER and scales.know(unit):
            factor, name = scales.written(value, unit)
            values[key] = f"{value * factor:.3g}{name}"
    return Change(values, change.without)


def _ways(error: SceneError) -> Iterator[Change]:
    """What would make a scene of it: every way of its first problem, with the first way of each other."""
    if all(problem.ways for problem in error.problems):
        first, *others = error.problems
        for way in first.ways:
            yield Change(
                {key: value for values in (way, *(other.ways[0] for other in others)) for key, value in values.items()}
            )


def _kinds(error: Contact1dError) -> tuple[Callable[[Scene], Change | None], ...]:
    """What is known to help against such an error, what helps most often first."""
    cause = error.__cause__
    if isinstance(cause, EngineError):  # a trial that took too long says little
        return (colder, _without_horizontal, _softer_core, _weaker_attraction, _smaller_load)
    if isinstance(cause, ThroughError):
        return (
            colder, drag_of_slide, _without_horizontal, _softer_core, _weaker_attraction, _smaller_load,
            _stronger_core, _shorter_attraction,
        )  # fmt: skip
    if isinstance(cause, ChainEndError):
        return (_longer_chain,)
    if isinstance(cause, TensionError):
        return (_held(cause.most),)
    if isinstance(cause, DigitsError):
        return ()  # how much more force is meant, nobody knows
    if isinstance(cause, NotCarriedError):
        return (_smaller_load, _stronger_core)
    if isinstance(cause, ShortChainError):
        return (chain_of(cause.needed, cause.above), way_within(cause.room))
    if isinstance(cause, UnsteadyError):
        return (lighter_plate, slower_drive, longer_way, stiffer_cantilever)
    if isinstance(cause, OffEndError):
        return (longer_lower_chain, shorter_way, automatic_drag)
    if isinstance(cause, PartedError):
        return (colder, no_pull, stronger_attraction, drag_of_slide)
    if isinstance(cause, RestlessError):
        return (automatic_drag, _without_horizontal, _softer_core, _stiffer_springs, _smaller_load, _longer_chain)
    if isinstance(cause, UntrustedError):
        return (_without_horizontal, _softer_core, _stiffer_springs, _smaller_load, _longer_chain)
    return ()


def _without_horizontal(scene: Scene) -> Change | None:
    """Particles of opposite chains that may move aside go past each other: under load a pair is unstable sideways."""
    pulled = isinstance(scene.experiment, Slide) or (scene.plate is not None and "x" in scene.plate.free)
    return None if scene.horizontal is None or pulled else Change(without=("horizontal",))


def _longer_chain(scene: Scene) -> Change | None:
    bodies = scene.bodies
    if bodies.upper_particles is not None and not bodies.periodic:
        return Change({"bodies.upper_particles": 2 * bodies.upper_particles, "bodies.particles": "auto"})
    given = bodies.particles != "auto" and not bodies.profile.has_edge
    return Change({"bodies.particles": "auto"}) if given else _smaller_load(scene)


def _smaller_load(scene: Scene) -> Change | None:
    experiment = scene.experiment
    if isinstance(experiment, PullOff):
        return Change({"experiment.preload": rounded(experiment.preload / STEP)})
    if isinstance(experiment, Load):
        return Change({"experiment.force": rounded(experiment.force / STEP)})
    if isinstance(experiment, Path) and isinstance(experiment.displacements, Span) and experiment.displacements.to > 0:
        return Change({"experiment.displacements.to": rounded(experiment.displacements.to / STEP)})
    if isinstance(experiment, Slide):
        return Change({"experiment.normal_force": rounded(experiment.normal_force / STEP)})
    return None


def _held(most: float) -> Callable[[Scene], Change | None]:
    """Less than the largest tension [FU]."""
    return lambda scene: (
        Change({"experiment.force": rounded(-HELD * most)}) if isinstance(scene.experiment, Load) else None
    )


def _stronger_core(scene: Scene) -> Change | None:
    if scene.interaction is None:
        return None
    key = "interaction.repulsion.amplitude"
    return Change({key: rounded(STEP * scene.interaction.repulsion.amplitude)})


def _softer_core(scene: Scene) -> Change | None:
    """A repulsion that is short beside the attraction makes a well so narrow that pairs snap into it."""
    if scene.interaction is None or scene.interaction.attraction is None:
        return None
    half = 0.5 * scene.interaction.attraction.range
    longer = scene.interaction.repulsion.range < NARROW * half
    return Change({"interaction.repulsion.range": rounded(half)}) if longer else None


def _weaker_attraction(scene: Scene) -> Change | None:
    if scene.interaction is None or scene.interaction.attraction is None:
        return None
    key = "interaction.attraction.amplitude"
    return Change({key: rounded(scene.interaction.attraction.amplitude / STEP)})


def _shorter_attraction(scene: Scene) -> Change | None:
    if scene.interaction is None or scene.interaction.attraction is None:
        return None
    shorter = rounded(0.5 * scene.interaction.attraction.range)
    return Change({"interaction.attraction.range": shorter}) if shorter > scene.interaction.repulsion.range else None


def _stiffer_springs(scene: Scene) -> Change | None:
    given = scene.bodies.bulk_stiffness
    return None if given == "auto" else Change({"bodies.bulk_stiffness": rounded(STEP * given)})
