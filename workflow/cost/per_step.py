"""What each effect costs per step: the same number of timesteps with all effects and without one, turn by turn.

A timestep evaluates every force once, and so does a step of a minimiser; reading tables and setting up is left out.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median, stdev

from contact1d.workflow.cost.change import Change
from contact1d.workflow.cost.record import EffectCost
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace, Draw
from contact1d.workflow.deck.system import write_system
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.scene import Scene, SceneError
from contact1d.workflow.settings.settings import settings_for

STEPS = 2_000
TURNS = 7
MEDIAN_ERROR = 1.25
"""Standard error of a median over that of a mean."""


def without_effects(scene: Scene) -> tuple[dict[str, Change], dict[str, str]]:
    """How to leave out each effect that can be, by its name; and why others cannot."""
    has_one = scene.experiment.motion_is_result or scene.experiment.goes_along
    method = () if has_one else (f"experiment.method={scene.method}",)
    changes, reasons = {}, {}
    for effect in scene.effects:
        change = Change(method, (effect,))
        try:
            change.scene(scene)
        except SceneError as error:
            reasons[effect] = "; ".join(f"{problem.path} {problem.message}" for problem in error.problems)
        else:
            changes[effect] = change
    return changes, reasons


def standing_without(scene: Scene) -> dict[str, Deck]:
    """Decks of a slide without what it could not run without, but take steps: by the effect, and "" where none pulls.

    With the settings of the whole scene, so that they have its particles, its cutoff and its table.
    """
    if not scene.experiment.motion_is_result:
        return {}
    gone: dict[str, tuple[str, ...]] = {"cantilever": ("cantilever",), "plate": ("cantilever", "plate")}
    if scene.noise is None:
        gone["damping"] = ("damping",)
    settings = settings_for(scene)
    return {
        effect: Deck(scene.model_copy(update=dict.fromkeys(names)), settings)
        for effect, names in gone.items()
        if effect in scene.effects
    }


def effect_costs(scene: Scene, folder: Path, turns: int = TURNS) -> tuple[EffectCost, ...]:
    """CPU time of a step with and without each effect; medians over `turns` (at least 2) blocks of STEPS steps.

    A plate that is pulled is measured beside a deck without cantilever, with and without it.
    """
    changes, reasons = without_effects(scene)
    scenes = {"": scene} | {effect: change.scene(scene) for effect, change in changes.items()}
    with ExitStack() as stack:
        decks = {effect: Deck(changed, settings_for(changed)) for effect, changed in scenes.items()}
        decks |= (standing := standing_without(scene))
        sessions = {
            effect: stack.enter_context(opened(deck, folder / f"step_{effect}")) for effect, deck in decks.items()
        }
        times = _interleaved(sessions, {effect: _steps(deck) for effect, deck in decks.items()}, turns)
    particles = settings_for(scene).particles * scene.chains
    return tuple(
        _cost(effect, times, particles, "cantilever" if effect == "plate" and effect in standing else "")
        if effect in decks
        else _cost_of_all(effect, times, particles, reasons)
        for effect in scene.effects
    )


def _cost(effect: str, times: Mapping[str, list[float]], particles: int, beside: str) -> EffectCost:
    ratios = [both / without for both, without in zip(times[beside], times[effect], strict=True)]
    error = MEDIAN_ERROR * stdev(ratios) / math.sqrt(len(ratios))
    return EffectCost(effect, median(times[beside]), median(times[effect]), median(ratios), error, particles)


def _cost_of_all(
    effect: str, times: Mapping[str, list[float]], particles: int, reasons: Mapping[str, str]
) -> EffectCost:
    none = math.nan
    return EffectCost(effect, median(times[""]), none, none, none, particles, reasons[effect])


@contextmanager
def opened(deck: Deck, folder: Path) -> Iterator[Session]:
    """A session in which the deck's scene stands at displacement 0, ready for timesteps."""
    folder.mkdir(parents=True)
    write_system(deck, folder)
    with Engine.session(folder) as session:
        session.execute(deck.head + deck.begin("standing"), phase="setting up")
        yield session


def _steps(deck: Deck) -> str:
    """STEPS steps: of time, or where nothing has to come to rest as many rows."""
    row = Draw(0.0, 0.0) if deck.scene.experiment.goes_along else Displace(0.0)
    return deck.in_one_run((row,) * STEPS) if deck.stepped else f"run {STEPS}"


def _interleaved(sessions: Mapping[str, Session], texts: Mapping[str, str], turns: int) -> dict[str, list[float]]:
    """CPU time of a step [µs] in each turn of each session; the first block warms up."""
    blocks: dict[str, list[float]] = {effect: [] for effect in sessions}
    for _ in range(turns + 1):
        for effect, session in sessions.items():
            before = session.lammps_cpu_seconds
            session.execute(texts[effect])
            blocks[effect].append(1e6 * (session.lammps_cpu_seconds - before) / STEPS)
    return {effect: times[1:] for effect, times in blocks.items()}
