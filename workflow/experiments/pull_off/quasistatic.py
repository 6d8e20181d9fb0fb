"""Pull-off by prescribed displacement: `smooth` and `stepped` where the force is smooth, passes where particles snap.

Each pass is a whole schedule, refined by what the one before found, since the state depends on the way to it.
Pass 1 finds its own way: load up to F_D, unload until the bodies separate. Every further pass starts afresh and holds
the displacements of: F_D; F = 0; a window around the largest tension, four times as fine each time. It ends when two
passes agree. The numbers are those of the last pass, and its schedule is the deck.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve_marks import Peak, largest_tension, rivals, smooth_crossing
from contact1d.workflow.deck.steps import Phase, displacements
from contact1d.workflow.experiments.pull_off.marked import marked_outcome
from contact1d.workflow.experiments.pull_off.smooth import (
    LATTICE_SHARE,
    PLACE_FACTOR,
    SmoothPass,
    critical_shift,
    radius_rate,
    smooth_pass,
)
from contact1d.workflow.experiments.pull_off.stepped import stepped_pass
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.law_error import law_error
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.prescribing import SAME_PLACE, approach, separate, unloading_step
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.trust import UntrustedError, doubts, require_no_contradiction, require_trust
from contact1d.workflow.scene import PullOff
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, LENGTH, Quantity

Array = NDArray[np.float64]
MOST_PASSES = 8
WINDOW_ROWS = 8
"""Rows on either side of the largest tension in a refined pass."""
RIVAL_SHARE = 0.05
"""Teeth of the tension within this share of the largest are looked at more closely."""
ZOOM_FACTOR = 0.25
"""Width of the window of one pass over that of the one before."""
SAME_ROW = 1e-9
"""Displacements nearer than this share of the whole way are one row."""
SCHEDULE_SHARE = 0.3
"""Part of the tolerance that the schedule may use up."""


@dataclass(frozen=True)
class Pass:
    """One whole schedule and its measured states.

    `wanted` is the preload F_D [FU], `refined` all but the first, `settings` those of its deck.
    """

    wanted: float
    phases: tuple[Phase, ...]
    refined: bool
    loading: list[State]
    unloading: list[State]
    settings: Settings

    @property
    def preload(self) -> float:
        """Force at the deepest displacement [FU]."""
        return self.loading[-1].force

    @property
    def falling(self) -> list[State]:
        """The states of the unloading, by falling displacement, each place once: marks may stand on rows."""
        ordered = sorted(self.unloading, key=lambda state: -state.displacement)
        same = SAME_PLACE * (ordered[0].displacement - ordered[-1].displacement)
        found = ordered[:1]
        for state in ordered[1:]:
            if found[-1].displacement - state.displacement > same:
                found.append(state)
        return found

    @property
    def peak(self) -> Peak:
        """The largest tension while unloading."""
        return largest_tension([s.displacement for s in self.falling], [s.force for s in self.falling])

    @property
    def early(self) -> float:
        """How far [LU] before its time the largest tension may have been lost, in the move after it."""
        falling, i = self.falling, self.peak.index
        after = falling[min(i + 1, len(falling) - 1)]
        return self.settings.let_go_early(falling[i].displacement - after.displacement)

    @property
    def cut_short(self) -> float:
        """Tension [FU] that is missed by that: it would have gone on to rise as it did."""
        falling, i = self.falling, self.peak.index
        if not 0 < i < len(falling) - 1:
            return 0.0
        rise = (falling[i - 1].force - falling[i].force) / (falling[i - 1].displacement - falling[i].displacement)
        return max(0.0, rise) * self.early

    @property
    def rivals(self) -> dict[int, float]:
        """How much other teeth, by their highest rows among those that fall, may be higher than the peak [FU]."""
        return rivals([s.displacement for s in self.falling], [s.force for s in self.falling], self.peak)

    @property
    def zero(self) -> State:
        """The state marked F = 0, in a refined pass."""
        return self.unloading[len(self.phases[1].rows) - 1]

    @property
    def critical(self) -> State:
        """The state marked as the largest tension, in a refined pass."""
        return self.unloading[len(self.phases[1].rows) + len(self.phases[2].rows) - 1]

    @property
    def zero_load(self) -> float:
        """Displacement at which the force crosses zero while unloading [LU]."""
        return smooth_crossing([s.displacement for s in self.unloading], [s.force for s in self.unloading], 0.0)


def pull_off_quasistatic(context: RunContext) -> Outcome:
    """F_A, a_cr and a₀ of a scene with `[experiment] kind = "pull_off"`, `method = "quasistatic"`.

    Raises:
        UntrustedError: see `require_trust`; also where passes do not come to agree.
    """
    scene, settings = context.deck.scene, context.deck.settings
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    tolerance = SCHEDULE_SHARE * settings.tolerance
    if scene.is_stepped:
        stepped = stepped_pass(context, experiment.preload, tolerance)
        return _outcome(context, stepped, experiment.preload, stepped.missed)
    if settings.is_smooth:
        smooth = smooth_pass(context, experiment.preload, tolerance)
        return _outcome(context, smooth, experiment.preload, smooth.missed)
    latest = _first(context, experiment.preload)
    window = unloading_step(settings, latest.loading[-1].displacement)
    for _ in range(MOST_PASSES):
        before = latest
        latest = _replay(context, experiment.preload, _refined(before, experiment.preload, window))
        window *= ZOOM_FACTOR
        if _agree(before, latest, experiment.preload, tolerance):
            missed = abs(latest.peak.smooth - before.peak.smooth) + max((0.0, *latest.rivals.values()))
            missed += latest.cut_short
            return _outcome(context, latest, experiment.preload, missed)
    raise UntrustedError(
        f"the pull-off force still changes from {before.peak.tension:.6g} to {latest.peak.tension:.6g} FU after "
        f"{MOST_PASSES} refinements of the path, by more than a tolerance of {settings.tolerance:g} allows: take "
        "a larger [accuracy] tolerance, or stiffer springs or a longer range, with which particles do not snap"
    )


def _first(context: RunContext, preload: float) -> Pass:
    with context.contact("looking for the path") as contact:
        contact.begin("loading")
        loading = approach(contact, preload, 0.0)
        contact.begin("unloading")
        unloading = separate(contact, loading[-1].displacement)
        contact.finish()
        return Pass(preload, contact.phases, False, loading, unloading, contact.settings)


def _refined(known: Pass, preload: float, window: float) -> tuple[Phase, ...]:
    """The schedule of the next pass: loading, unloading to F = 0, pulling to the largest tension, separating."""
    climbed = sorted({s.displacement for s in known.loading if s.force < preload and s is not known.loading[-1]})
    deepest = _displacement_at(known.loading, preload)
    same = SAME_ROW * (deepest - known.falling[-1].displacement)
    loading = [d for d in climbed if d < deepest - same] + [deepest]
    zero = known.zero_load
    peak = known.peak.position
    fine = _window(known, peak, window)
    fine = fine[fine < zero - same]
    coarse = [s.displacement for s in known.unloading if not fine[-1] <= s.displacement <= fine[0]]
    falling = sorted({deepest, zero, peak, *coarse, *fine.tolist()}, reverse=True)
    falling = [d for d in falling if d <= deepest]
    parts = {
        "unloading": [d for d in falling if d >= zero],
        "pulling": [d for d in falling if peak <= d < zero],
        "separating": [d for d in falling if d < peak],
    }
    later = [Phase(name, displacements(rows), state=name != "separating") for name, rows in parts.items()]
    return (Phase("loading", displacements(loading)), *later)


def _window(known: Pass, peak: float, window: float) -> Array:
    """Displacements around the largest tension, falling. Where the tension has several teeth of nearly that height, as
    particles let go one by one, a coarse pass can't tell which is the highest: the window then has all of them. It also
    has what the moves of the coarse pass may have cut off.
    """
    rivals = [s.displacement for s in known.unloading if -s.force >= (1.0 - RIVAL_SHARE) * known.peak.tension]
    step = window / WINDOW_ROWS
    half = max(window, known.early)
    first, last = peak + half, peak - half
    if not known.refined:
        first, last = max(first, *rivals), min(last, *rivals)
    return np.asarray(first - step * np.arange(round((first - last) / step) + 1), dtype=np.float64)


def _displacement_at(states: Sequence[State], force: float) -> float:
    """Displacement of a force on a rising branch, through its two nearest rows."""
    ordered = sorted(states, key=lambda s: s.displacement)
    near = sorted(ordered, key=lambda s: abs(s.force - force))[:2]
    if len(near) < 2 or near[0].force == near[1].force:
        return near[0].displacement
    part = (force - near[0].force) / (near[1].force - near[0].force)
    return near[0].displacement + part * (near[1].displacement - near[0].displacement)


def _replay(context: RunContext, wanted: float, phases: tuple[Phase, ...]) -> Pass:
    with context.contact("the whole path again, finer at the largest tension") as contact:
        states = contact.replay(phases)
        for state in states:
            require_trust(contact.scene, contact.settings, state)
    climbed = len(phases[0].rows)
    return Pass(wanted, phases, True, states[:climbed], states[climbed:], context.deck.settings)


def _agree(before: Pass, latest: Pass, preload: float, tolerance: float) -> bool:
    """Whether two passes give the same results, and the latest has its marked states where they belong."""
    tension, radius = latest.peak.smooth, latest.critical.radius_or_spot
    return (
        abs(tension - before.peak.smooth) <= tolerance * tension
        and latest.peak.uncertainty + latest.cut_short <= tolerance * tension
        and abs(latest.preload - preload) <= tolerance * preload
        and abs(latest.zero.force) <= tolerance * tension
        and tension + latest.critical.force <= tolerance * tension
        and abs(critical_shift(latest.unloading, latest.critical, latest.peak))
        <= max(tolerance * radius.value, LATTICE_SHARE * radius.uncertainty)
    )


def _outcome(context: RunContext, found: Pass | SmoothPass, preload: float, missed: float) -> Outcome:
    """The results of a finished schedule; `missed` by the search for the largest tension [FU]."""
    scene, settings = context.deck.scene, context.deck.settings
    zero, critical, peak = found.zero, found.critical, found.peak
    residual = critical.residual * settings.particles
    states = (*found.loading, *found.unloading)
    critical_radius, zero_radius = critical.radius_or_spot, zero.radius_or_spot
    shift = critical_shift(found.unloading, critical, peak)
    slope = abs(zero_radius.value - critical_radius.value) / peak.smooth
    loaded = found.loading[-1].force
    missed = max(missed, peak.uncertainty) + residual + law_error(scene, settings, critical)
    at_zero = abs(zero.force) + law_error(scene, settings, zero)
    rate = abs(radius_rate(found.unloading, critical))
    # An error of the law moves the place of a flat maximum, too: by a range for one as large as the force.
    reach = 0.0 if settings.law is None else settings.law.longest_range
    by_law = (slope + rate * reach / peak.smooth) * law_error(scene, settings, critical)
    at_critical = abs(shift) + PLACE_FACTOR * rate * peak.misplaced + by_law
    if isinstance(found, Pass):
        at_critical += _rival_radius(found, critical_radius.value, missed)
    quantities = {
        "adhesion_force": Quantity(peak.smooth, missed, FORCE),
        "critical_radius": Quantity(
            max(0.0, critical_radius.value + shift), critical_radius.uncertainty + at_critical, LENGTH
        ),
        "zero_load_radius": Quantity(zero_radius.value, zero_radius.uncertainty + slope * at_zero, LENGTH),
        "preload": Quantity(loaded, abs(loaded - preload), FORCE),
    }
    require_no_contradiction(settings, quantities, found.unloading)
    marked = {"zero_load": zero, "critical": critical}
    by_spacing = {"critical_radius": critical_radius.uncertainty, "zero_load_radius": zero_radius.uncertainty}
    warnings = doubts(scene, settings, states)
    return marked_outcome(quantities, states, marked, found.phases, warnings, by_spacing)


def _rival_radius(found: Pass, radius: float, missed: float) -> float:
    """How far [LU] the radius a_cr may be off because another tooth is the highest: by `missed` [FU] it may be."""
    falling = found.falling
    teeth = [falling[i] for i, excess in found.rivals.items() if excess > -missed]
    return max((abs(s.radius_or_spot.value - radius) for s in teeth), default=0.0)
