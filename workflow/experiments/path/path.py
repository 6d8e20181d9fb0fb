"""Prescribed displacement, there and back: the curve F(d), its largest tension and its load-free radius."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from itertools import pairwise

import numpy as np

from contact1d.analysis.curve_marks import Peak, crossing, largest_tension
from contact1d.analysis.loop import Loop, loop_of
from contact1d.workflow.deck.steps import Phase
from contact1d.workflow.experiments.path.between_rows import missed_between_rows
from contact1d.workflow.experiments.path.schedule import places, schedule
from contact1d.workflow.experiments.path.thermal import CERTAIN, averaged
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import doubts, is_converged, require_trust
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import ENERGY, FORCE, LENGTH, Quantity

PLACE_ERROR = 0.1
"""How well a parabola places a maximum, over the increment of the displacement."""


def path(context: RunContext) -> Outcome:
    """F_A, a₀ and a_cr of a scene with `[experiment] kind = "path"`, read off the branch that unloads last.

    A path that ends where it begins has the energy that it dissipates besides, the area of its loop. A quantity that
    the path does not reach (no tension, no crossing of F = 0) is left out, and a warning says so.

    Raises:
        UntrustedError: see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    phases = schedule(scene, settings)
    with context.contact() as contact:
        in_time = scene.method == "dynamic" and scene.noise is None
        passed = contact.replay(phases, at_rest=partial(is_converged, settings) if in_time else None)
        phases = contact.phases
    if scene.noise is not None:
        passed = averaged(passed, places(scene, settings))
    for state in passed:
        require_trust(scene, settings, state)
    asked = [wanted for _, wanted in places(scene, settings)]
    states = [state for state, wanted in zip(passed, asked, strict=True) if wanted]
    # Where pairs snap, all rows tell the jumps; else the same places there and back tell what a curve loses.
    rows = passed[asked.index(True) :] if settings.estimate.snaps else states
    name = _drawn_off(scene, settings, phases)
    branch = [s for s in rows if s.phase == name]
    quantities, warnings = _adhesion(context, branch) if scene.adheres else (_largest(context, states), {})
    ends = {"deepest": max(states, key=lambda s: s.displacement), "final": states[-1]}
    radii = {name: state.radius for name, state in ends.items()}
    loop = loop_of([s.displacement for s in rows], [s.force for s in rows])
    if loop is not None:
        quantities["dissipated_energy"] = _dissipated(context, states, loop)
    return Outcome(
        quantities,
        tuple(states),
        {name: state.profile for name, state in ends.items()},
        {name: math.nan if radius is None else radius.value for name, radius in radii.items()},
        phases,
        warnings | doubts(scene, settings, tuple(states)),
        tables={} if scene.noise is None else {"means": _means(settings, states)},
        compared_with={} if loop is None else {"dissipated_energy": loop.whole},
    )


def _drawn_off(scene: Scene, settings: Settings, phases: Sequence[Phase]) -> str:
    """The last phase in which the bodies are drawn apart; where a smooth curve has none, the last one says the same.

    Where pairs snap, or an edge has no range, the tension on the way down is that at which the bodies jump together.
    """
    apart = [phase.name for phase in phases if phase.name.startswith("unloading")]
    if apart:
        return apart[-1]
    jumps = settings.estimate.snaps or scene.adhesion is not None
    return "" if jumps else phases[-1].name


def _means(settings: Settings, states: list[State]) -> dict[str, tuple[float, ...]]:
    """Columns of means.csv: the mean force at each place, and its standard error."""
    return {
        "displacement": tuple(one.displacement for one in states),
        "force": tuple(one.force for one in states),
        "force_standard_error": tuple(one.residual * settings.particles / CERTAIN for one in states),
    }


def _dissipated(context: RunContext, states: list[State], loop: Loop) -> Quantity:
    """The loop's area. What the law lacks is the same on both ways; residual forces are not, and of either sign."""
    scene, settings = context.deck.scene, context.deck.settings
    several = settings.particles if scene.noise is not None else math.sqrt(settings.particles)
    residual = several * sum(state.residual for state in states) / len(states)
    strongest = max(states, key=lambda s: abs(s.force))
    share = law_error(scene, settings, strongest) / max(abs(strongest.force), 1e-300)
    return Quantity(loop.area, loop.uncertainty + loop.length * residual + share * abs(loop.area), ENERGY)


def _largest(context: RunContext, states: list[State]) -> dict[str, Quantity]:
    """Without adhesion: force and radius where the displacement is largest."""
    deepest = max(states, key=lambda s: s.displacement)
    quantities = {"largest_force": Quantity(deepest.force, _noise(context, deepest), FORCE)}
    radius = deepest.radius
    if radius is not None:
        quantities["largest_radius"] = Quantity(radius.value, radius.uncertainty, LENGTH)
    return quantities


def _adhesion(context: RunContext, branch: list[State]) -> tuple[dict[str, Quantity], dict[str, str]]:
    settings = context.deck.settings
    if not branch:
        never = "the path never draws the bodies apart, so it gives no"
        return {}, {"no_peak": f"{never} adhesion_force", "no_zero_load": f"{never} zero_load_radius"}
    displacement, force = [s.displacement for s in branch], [s.force for s in branch]
    quantities: dict[str, Quantity] = {}
    warnings: dict[str, str] = {}
    peak = largest_tension(displacement, force)
    if 0 < peak.index < len(branch) - 1 and peak.tension > 0:
        missed = max(peak.uncertainty, missed_between_rows(context.deck.scene, settings, displacement) * peak.smooth)
        missed += _cut_short(settings, branch, peak.index) + _noise(context, branch[peak.index])
        quantities["adhesion_force"] = Quantity(peak.smooth, missed, FORCE)
        critical = _critical_radius(branch, peak, context.deck.scene.bodies.profile.has_edge)
        if critical is not None:
            quantities["critical_radius"] = critical
    else:
        warnings["no_peak"] = (
            "the largest tension lies at an end of the last way apart, so the path gives no adhesion_force: "
            'go further back, or use kind = "pull_off"'
        )
    if context.deck.scene.adhesion is not None:
        quantities |= _fixed_grips(branch)
    zero = _zero_load(branch, displacement, force)
    if zero is None:
        warnings["no_zero_load"] = "the force does not pass 0 on the last way apart, so there is no zero_load_radius"
    else:
        quantities["zero_load_radius"] = zero
    return quantities, warnings


def _cut_short(settings: Settings, branch: list[State], index: int) -> float:
    """Tension [FU] that is lost with pairs that let go before their time, in the move after the largest one."""
    before, here, after = branch[index - 1 : index + 2]
    rise = (before.force - here.force) / (before.displacement - here.displacement)
    return max(0.0, rise) * settings.let_go_early(here.displacement - after.displacement)


def _fixed_grips(branch: list[State]) -> dict[str, Quantity]:
    """The displacement at which a contact without a range lets go at once: between the last row held and the next."""
    for held, apart in pairwise(branch):
        if held.radius is not None and apart.radius is None:
            middle = 0.5 * (held.displacement + apart.displacement)
            return {"fixed_grips_displacement": Quantity(middle, abs(held.displacement - middle), LENGTH)}
    return {}


def _critical_radius(branch: list[State], peak: Peak, has_edge: bool) -> Quantity | None:
    """a at the vertex of a smooth maximum, linear between the rows beside it; at the last row before a snap.

    A body that ends at an edge is in contact up to there or not at all.
    """
    rows = branch[peak.index - 1 : peak.index + 2]
    radii = [row.radius for row in rows]
    if radii[1] is None:
        return None
    if radii[0] is None or radii[2] is None:
        return Quantity(radii[1].value, 0.0 if has_edge else radii[1].value, LENGTH)
    values = [radius.value for radius in radii if radius is not None]
    if peak.position == rows[1].displacement:
        return Quantity(values[1], radii[1].uncertainty + abs(values[0] - values[1]), LENGTH)
    places = [row.displacement for row in rows]
    value = float(np.interp(peak.position, places[::-1], values[::-1]))
    bend = abs(values[1] - 0.5 * (values[0] + values[2]))
    return Quantity(value, radii[1].uncertainty + bend + PLACE_ERROR * abs(values[0] - values[2]), LENGTH)


def _zero_load(branch: list[State], displacement: list[float], force: list[float]) -> Quantity | None:
    try:
        index, place = crossing(displacement, force, 0.0)
    except ValueError:
        return None
    first, second = branch[index].radius, branch[index + 1].radius
    if first is None or second is None:
        return None
    gap = displacement[index + 1] - displacement[index]
    part = (place - displacement[index]) / gap if gap else 0.0
    value = first.value + part * (second.value - first.value)
    bend = 0.125 * abs(second.value - first.value)
    return Quantity(value, max(first.uncertainty, second.uncertainty) + bend, LENGTH)


def _noise(context: RunContext, state: State) -> float:
    """What residual forces on the particles may add up to, and the error of the law [FU]."""
    scene, settings = context.deck.scene, context.deck.settings
    return state.residual * settings.particles + law_error(scene, settings, state)
