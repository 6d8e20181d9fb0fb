"""Prescribed displacement, there and back: the curve F(d), its largest tension and its load-free radius."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

from contact1d.analysis.curve_marks import Peak, crossing, largest_tension
from contact1d.workflow.deck.deck import Phase
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.outcome import Outcome, doubts, require_trust
from contact1d.workflow.experiments.running.radii import radius_of
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, LENGTH, Quantity

RELAXATIONS = 14.0
"""Time that a dynamic path gives the particles at each displacement, over the time constant of their slowest decay."""
ROUND_OFF = 1e-9
EARLY = 8.0
"""Square of the longest move of bodies that part over the range squared, per unit of tolerance."""
PLACE = 0.1
"""How well a parabola places a maximum, over the increment of the displacement."""


def path(context: RunContext) -> Outcome:
    """F_A, a₀ and a_cr of a scene with `[experiment] kind = "path"`, read off the branch that unloads last.

    A quantity that the path does not reach (no tension, no crossing of F = 0) is left out, and a warning says so.

    Raises:
        UntrustedError: see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    phases = schedule(scene, settings)
    with context.contact() as contact:
        passed = contact.replay(phases)
    for state in passed:
        require_trust(scene, settings, state)
    asked = [wanted for _, wanted in _places(scene, settings)]
    states = [state for state, wanted in zip(passed, asked, strict=True) if wanted]
    adhesive = scene.interaction is not None and scene.interaction.attraction is not None
    branch = [s for s in states if s.phase == phases[-1].name]
    quantities, warnings = _adhesion(context, branch) if adhesive else (_largest(context, states), {})
    ends = {"deepest": max(states, key=lambda s: s.displacement).profile, "final": states[-1].profile}
    radii = {name: radius_of(scene, profile) for name, profile in ends.items()}
    return Outcome(
        quantities,
        tuple(states),
        ends,
        {name: math.nan if radius is None else radius.value for name, radius in radii.items()},
        phases,
        warnings | doubts(scene, settings, tuple(states)),
    )


def schedule(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """One phase for each stretch of rising ("loading") or falling ("unloading") displacement."""
    dynamic = scene.method == "dynamic"
    rest = (math.ceil(RELAXATIONS * _decay(scene, settings) / settings.time_step),) if dynamic else ()
    values = [value for value, _ in _places(scene, settings)]
    stretches: list[tuple[str, list[float]]] = [("loading", [values[0]])]
    for before, value in pairwise(values):
        branch = "loading" if value > before else "unloading"
        if stretches[-1][0] != branch:
            stretches.append((branch, []))
        stretches[-1][1].append(value)
    stretches = [(branch, rows) for branch, rows in stretches if rows]
    counts: dict[str, int] = {}
    phases = []
    for branch, rows in stretches:
        counts[branch] = counts.get(branch, 0) + 1
        name = branch if counts[branch] == 1 else f"{branch}_{counts[branch]}"
        kind = "displace_dynamic" if dynamic else "displace"
        phases.append(Phase(name, kind, tuple((float(d), *rest) for d in rows), state=True))
    return tuple(phases)


def _places(scene: Scene, settings: Settings) -> list[tuple[float, bool]]:
    """Displacements [LU] of all rows, and whether the scene asks for them or they lie on the way between two of those.

    The way starts at 0, where the bodies stand in system.data, unless the first displacement draws them apart: from
    there it is the state that comes from far away.
    """
    assert scene.experiment.kind == "path"
    places: list[tuple[float, bool]] = []
    before = 0.0
    for value in scene.experiment.values():
        longest = settings.longest_move if value > before else _longest_drop(scene, settings)
        moves = max(1, math.ceil(abs(value - before) / longest - ROUND_OFF))
        if not places and value < before:
            moves = 1
        places += [(before + (value - before) * i / moves, False) for i in range(1, moves)]
        places.append((value, True))
        before = value
    return places


def _longest_drop(scene: Scene, settings: Settings) -> float:
    """Longest move [LU] by which bodies that part keep the particles that the law still holds: inf where none snaps.

    A move h puts a stuck pair h further apart before it relaxes. It lets go where that is beyond the unstable place
    next to it, which is 2 √(2 e/|G″|) away at a gap e before the fold of G(r): too early by e = h² |G″|/8. With |G″| of
    the ratio of the stiffnesses over the range b, and a loop as wide as some of that ratio times b,
    h = √(8 tolerance) b leaves a share of `tolerance` of the loop.
    """
    if settings.law is None or settings.is_smooth:
        return math.inf
    return min(settings.longest_move, math.sqrt(EARLY * scene.accuracy.tolerance) * settings.law.longest_range)


def _decay(scene: Scene, settings: Settings) -> float:
    """Time constant [TU] with which a particle on its bulk spring comes to rest: 2m/γ, overdamped γ/k."""
    mass, stiffness = scene.bodies.mass, scene.bulk_stiffness
    return max(2.0 * mass / settings.damping, settings.damping / stiffness)


def _largest(context: RunContext, states: list[State]) -> dict[str, Quantity]:
    """Without adhesion: force and radius where the displacement is largest."""
    deepest = max(states, key=lambda s: s.displacement)
    quantities = {"largest_force": Quantity(deepest.force, _noise(context, deepest), FORCE)}
    radius = radius_of(context.deck.scene, deepest.profile)
    if radius is not None:
        quantities["largest_radius"] = Quantity(radius.value, radius.uncertainty, LENGTH)
    return quantities


def _adhesion(context: RunContext, branch: list[State]) -> tuple[dict[str, Quantity], dict[str, str]]:
    scene = context.deck.scene
    displacement, force = [s.displacement for s in branch], [s.force for s in branch]
    quantities: dict[str, Quantity] = {}
    warnings: dict[str, str] = {}
    peak = largest_tension(displacement, force)
    if 0 < peak.index < len(branch) - 1 and peak.tension > 0:
        quantities["adhesion_force"] = Quantity(
            peak.smooth, peak.uncertainty + _noise(context, branch[peak.index]), FORCE
        )
        critical = _critical_radius(scene, branch, peak)
        if critical is not None:
            quantities["critical_radius"] = critical
    else:
        warnings["no_peak"] = (
            "the largest tension lies at an end of the last branch, so the path gives no adhesion_force: "
            'go further back, or use kind = "pull_off"'
        )
    zero = _zero_load(context, branch, displacement, force)
    if zero is None:
        warnings["no_zero_load"] = "the force does not pass 0 on the last branch, so there is no zero_load_radius"
    else:
        quantities["zero_load_radius"] = zero
    return quantities, warnings


def _critical_radius(scene: Scene, branch: list[State], peak: Peak) -> Quantity | None:
    """a at the vertex of a smooth maximum, linear between the rows beside it; at the last row before a snap."""
    rows = branch[peak.index - 1 : peak.index + 2]
    radii = [radius_of(scene, row.profile) for row in rows]
    if radii[1] is None:
        return None
    if radii[0] is None or radii[2] is None:
        return Quantity(radii[1].value, radii[1].value, LENGTH)
    values = [radius.value for radius in radii if radius is not None]
    if peak.position == rows[1].displacement:
        return Quantity(values[1], radii[1].uncertainty + abs(values[0] - values[1]), LENGTH)
    places = [row.displacement for row in rows]
    value = float(np.interp(peak.position, places[::-1], values[::-1]))
    bend = abs(values[1] - 0.5 * (values[0] + values[2]))
    return Quantity(value, radii[1].uncertainty + bend + PLACE * abs(values[0] - values[2]), LENGTH)


def _zero_load(
    context: RunContext, branch: list[State], displacement: list[float], force: list[float]
) -> Quantity | None:
    try:
        index, place = crossing(displacement, force, 0.0)
    except ValueError:
        return None
    first, second = (radius_of(context.deck.scene, branch[i].profile) for i in (index, min(index + 1, len(branch) - 1)))
    if first is None or second is None:
        return None
    gap = displacement[min(index + 1, len(branch) - 1)] - displacement[index]
    part = (place - displacement[index]) / gap if gap else 0.0
    value = first.value + part * (second.value - first.value)
    bend = 0.125 * abs(second.value - first.value)
    return Quantity(value, max(first.uncertainty, second.uncertainty) + bend, LENGTH)


def _noise(context: RunContext, state: State) -> float:
    """What residual forces on the particles may add up to, and the error of the law [FU]."""
    scene, settings = context.deck.scene, context.deck.settings
    return state.residual * settings.particles + law_error(scene, settings, state)
