"""Pull-off under heat: the load is drawn off at a steady rate until the bodies part, once for each seed.

The detachment force is the tension when the plate last leaves the place of the largest tension: it scatters, and grows
with the rate, since a slow pull waits longer for a fluctuation that lets go.
"""

from __future__ import annotations

import math

import numpy as np

from contact1d.analysis.curve import DETACHMENTS, SAMPLE_TABLE
from contact1d.workflow.deck.steps import DrawnOff, Phase, Row, UnderLoad
from contact1d.workflow.experiments.pull_off.pulls import BARRIER, pulls, ramp_of, rate_of
from contact1d.workflow.experiments.running.contact import State
from contact1d.workflow.experiments.running.outcome import Outcome
from contact1d.workflow.experiments.running.run_context import RunContext
from contact1d.workflow.experiments.running.sampling import SETTLING_LOOKS, chunk_steps, sample_columns
from contact1d.workflow.experiments.running.trust import doubts
from contact1d.workflow.scene import PullOff, Scene
from contact1d.workflow.settings.settings import Settings
from contact1d.workflow.units import FORCE, Quantity

LAGGING = 0.1
"""Tension that drag takes while the bodies part, over the largest one, from which on it is told."""
FARTHEST = 1.1
"""Tension over that of the estimate at which a planned pull ends."""


def pull_off_thermal(context: RunContext) -> Outcome:
    """Detachment force, mean and spread over the seeds, of a pull-off with [noise].

    Raises:
        UntrustedError: bodies that do not part, or see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    assert isinstance(scene.experiment, PullOff)
    count = scene.experiment.repeats or 1
    found = pulls(context, count)
    forces = np.asarray([one.force for one in found])
    step = ramp_of(scene, settings).rise / math.sqrt(12.0)
    spread = float(forces.std(ddof=1)) if count > 1 else math.nan
    quantities = {}
    if count > 1:
        error = math.hypot(spread, step) / math.sqrt(count)
        quantities["detachment_force_spread"] = Quantity(spread, spread / math.sqrt(2.0 * (count - 1)), FORCE)
    else:
        error = float(abs(forces[0]))  # one pull says nothing of how they scatter
    quantities = {"detachment_force": Quantity(float(forces.mean()), error, FORCE)} | quantities
    own = found[0]
    rows = [row for phase in own.phases for row in phase.rows]
    loads = [_load(rows[state.number], state) for state in own.states]
    return Outcome(
        quantities,
        own.states,
        {"last_held": own.states[own.held].profile},
        {"last_held": math.nan},
        own.phases,
        doubts(scene, settings, own.states) | _lagging(scene, settings),
        tables={
            DETACHMENTS: {
                "seed": tuple(float(one.seed) for one in found),
                "force": tuple(one.force for one in found),
                "time": tuple(one.time for one in found),
            },
            SAMPLE_TABLE: sample_columns(own.states, loads, settings),
        },
    )


def _load(row: Row, state: State) -> float:
    """On the plate in a row [FU], compression positive: given, or the spring's at the row's end."""
    if isinstance(row, DrawnOff):
        return -row.spring * (state.displacement - row.end)
    assert isinstance(row, UnderLoad)
    return row.load


def _lagging(scene: Scene, settings: Settings) -> dict[str, str]:
    """A warning where the load grows by a share of F_A while drag Γ lets F_A move the plate by the range: Γ b Ḟ/F_A."""
    assert isinstance(scene.experiment, PullOff)
    assert settings.law is not None
    drag, largest = settings.particles * settings.damping + settings.plate_damping, settings.estimate.pull_off_force()
    share = drag * settings.law.longest_range * rate_of(scene, settings) / largest**2
    if share < LAGGING:
        return {}
    key, unit = ("velocity", "LU/TU") if scene.experiment.velocity else ("loading_rate", "FU/TU")
    given = scene.experiment.velocity or scene.experiment.loading_rate or 0.0
    return {
        "lagging": (
            f"while the drag on the bodies lets them part, the load grows by {share:.2g} of what holds them: part of "
            f"detachment_force is drag. Below an experiment.{key} of {given * LAGGING / share:.2g} {unit} it "
            "is not"
        )
    }


def planned_thermal(scene: Scene, settings: Settings) -> tuple[Phase, ...]:
    """The schedule up to a tension that the estimate does not hold."""
    experiment = scene.experiment
    assert isinstance(experiment, PullOff)
    ramp, look = ramp_of(scene, settings), chunk_steps(settings)
    rows = ramp.until(FARTHEST * settings.estimate.pull_off_force(), settings.estimate.parted(BARRIER))
    return (
        Phase("loading", (UnderLoad(experiment.preload, look),) * SETTLING_LOOKS),
        Phase("settling", (UnderLoad(0.0, look),) * SETTLING_LOOKS),
        Phase("pulling", tuple(ramp.row(n) for n in range(1, rows + 1)), state=True),
    )
