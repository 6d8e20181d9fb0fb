"""Pull-off by prescribed displacement, in passes: each pass is a whole schedule, refined by what the one before found.

Pass 1 finds its own way: load up to F_D, unload until the bodies separate. Every further pass starts afresh and holds
the displacements of: F_D; F = 0; a window around the largest tension, four times as fine each time. It ends when two
passes agree. The numbers are those of the last pass, and its schedule is the deck.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from workflow.deck import Phase
from workflow.experiments.bench import Bench
from workflow.experiments.contact import State
from workflow.experiments.marks import Peak, crossing, largest_tension
from workflow.experiments.outcome import Outcome, Quantity, UntrustedError, doubts, radius_of, require_trust
from workflow.experiments.quasistatic import approach, separate
from workflow.units import FORCE, LENGTH

MOST_PASSES = 8
WINDOW_ROWS = 8
"""Rows on either side of the largest tension in a refined pass."""
ZOOM = 0.25
"""Width of the window of one pass over that of the one before."""
SHARE = 0.3
"""Part of the tolerance that the schedule may use up."""


@dataclass(frozen=True)
class Pass:
    """One whole schedule and its measured states."""

    phases: tuple[Phase, ...]
    loading: list[State]
    unloading: list[State]

    @property
    def preload(self) -> float:
        """Force at the deepest displacement [FU]."""
        return self.loading[-1].force

    @property
    def peak(self) -> Peak:
        """The largest tension while unloading."""
        return largest_tension([s.displacement for s in self.unloading], [s.force for s in self.unloading])

    @property
    def zero_load(self) -> tuple[int, float]:
        """Where the force crosses zero while unloading."""
        return crossing([s.displacement for s in self.unloading], [s.force for s in self.unloading], 0.0)


def pull_off_quasistatic(bench: Bench) -> Outcome:
    """F_A, a_cr and a₀ of a scene with `[experiment] kind = "pull_off"`, `method = "quasistatic"`.

    Raises:
        UntrustedError: see `require_trust`; also where passes do not come to agree.
    """
    scene, settings = bench.deck.scene, bench.deck.settings
    experiment = scene.experiment
    assert experiment.kind == "pull_off"
    tolerance = SHARE * scene.accuracy.tolerance
    latest = _first(bench, experiment.preload)
    window = settings.displacement_step
    for _ in range(MOST_PASSES):
        before = latest
        latest = _replay(bench, _refined(before, experiment.preload, window))
        window *= ZOOM
        if _agree(before, latest, experiment.preload, tolerance, settings.force_scale):
            return _outcome(bench, before, latest)
    raise UntrustedError(
        f"the pull-off force still changes from {before.peak.tension:.6g} to {latest.peak.tension:.6g} FU after "
        f"{MOST_PASSES} refinements of the path: loosen [accuracy] tolerance"
    )


def _first(bench: Bench, preload: float) -> Pass:
    step = bench.deck.settings.displacement_step
    with bench.contact() as contact:
        contact.begin("loading", "displace")
        loading = approach(contact, preload, 0.0, step)
        contact.begin("unloading", "displace")
        unloading = separate(contact, loading[-1].displacement, step)
        contact.finish()
        return Pass(contact.phases, loading, unloading)


def _refined(known: Pass, preload: float, window: float) -> tuple[Phase, ...]:
    """The schedule of the next pass: loading, unloading to F = 0, pulling to the largest tension, separating."""
    climbed = sorted({s.displacement for s in known.loading if s.force < preload and s is not known.loading[-1]})
    _, deepest = _force_at(known.loading, preload)
    loading = [d for d in climbed if d < deepest - 1e-9] + [deepest]
    zero = known.zero_load[1]
    peak = known.unloading[known.peak.index].displacement
    fine = peak + window * np.linspace(1.0, -1.0, 2 * WINDOW_ROWS + 1)
    fine = fine[fine < zero - 1e-9]
    coarse = [s.displacement for s in known.unloading if not fine[-1] <= s.displacement <= fine[0]]
    falling = sorted({deepest, zero, *coarse, *fine.tolist()}, reverse=True)
    falling = [d for d in falling if d <= deepest]
    parts = {
        "unloading": [d for d in falling if d >= zero],
        "pulling": [d for d in falling if peak <= d < zero],
        "separating": [d for d in falling if d < peak],
    }
    later = [
        Phase(name, "displace", tuple((d,) for d in rows), state=name != "separating") for name, rows in parts.items()
    ]
    return (Phase("loading", "displace", tuple((d,) for d in loading)), *later)


def _force_at(states: Sequence[State], force: float) -> tuple[int, float]:
    """Displacement of a force on a rising branch, through its two nearest rows."""
    ordered = sorted(states, key=lambda s: s.displacement)
    near = sorted(ordered, key=lambda s: abs(s.force - force))[:2]
    if len(near) < 2 or near[0].force == near[1].force:
        return 0, near[0].displacement
    part = (force - near[0].force) / (near[1].force - near[0].force)
    return 0, near[0].displacement + part * (near[1].displacement - near[0].displacement)


def _replay(bench: Bench, phases: tuple[Phase, ...]) -> Pass:
    with bench.contact() as contact:
        states = contact.replay(phases)
        for state in states:
            require_trust(contact.scene, contact.settings, state)
    climbed = len(phases[0].rows)
    return Pass(phases, states[:climbed], states[climbed:])


def _agree(before: Pass, latest: Pass, preload: float, tolerance: float, scale: float) -> bool:
    tension = latest.peak.tension
    critical = sum(len(phase.rows) for phase in latest.phases[1:3]) - 1
    return (
        abs(tension - before.peak.tension) <= tolerance * tension
        and latest.peak.uncertainty <= tolerance * tension
        and abs(latest.preload - preload) <= tolerance * preload
        and abs(_zero_state(latest).force) <= tolerance * max(tension, scale)
        and tension + latest.unloading[critical].force <= tolerance * tension
    )


def _zero_state(of: Pass) -> State:
    return of.unloading[len(of.phases[1].rows) - 1]


def _outcome(bench: Bench, before: Pass, latest: Pass) -> Outcome:
    scene, settings = bench.deck.scene, bench.deck.settings
    zero = _zero_state(latest)
    critical = latest.unloading[sum(len(phase.rows) for phase in latest.phases[1:3]) - 1]
    peak = latest.peak
    residual = abs(critical.residual) * np.sqrt(settings.particles)
    adhesion = max(abs(peak.tension - before.peak.tension), peak.uncertainty) + _law_share(bench) * peak.tension + residual
    states = (*latest.loading, *latest.unloading)
    radii = {"zero_load": _radius(bench, zero, latest), "critical": _radius(bench, critical, latest)}
    old = radius_of(scene, before.unloading[before.peak.index].profile)
    assert old is not None
    spread = abs(old.value - radii["critical"].value)
    quantities = {
        "adhesion_force": Quantity(peak.tension, float(adhesion), FORCE),
        "critical_radius": Quantity(radii["critical"].value, radii["critical"].uncertainty + spread, LENGTH),
        "zero_load_radius": radii["zero_load"],
        "preload": Quantity(latest.preload, abs(latest.preload - scene.experiment.preload), FORCE),
    }
    return Outcome(
        quantities,
        states,
        {"zero_load": zero.profile, "critical": critical.profile},
        {name: radius.value for name, radius in radii.items()},
        latest.phases,
        doubts(scene, settings, states),
    )


def _law_share(bench: Bench) -> float:
    """Relative error of the force that table and cutoff may cause."""
    settings = bench.deck.settings
    assert settings.table is not None and settings.law is not None
    tail = abs(float(settings.law.force(settings.cutoff)))
    table = settings.table.error_beyond(0.5 * settings.rest)
    return (10.0 * tail + table) / settings.force_scale


def _radius(bench: Bench, state: State, latest: Pass) -> Quantity:
    """Radius of a state, with the part of its uncertainty that the state's distance from its place on the curve makes."""
    radius = radius_of(bench.deck.scene, state.profile)
    if radius is None:
        raise UntrustedError(f"no contact radius at displacement {state.displacement:.4g} LU: no particle is in tension")
    return Quantity(radius.value, radius.uncertainty, LENGTH)
