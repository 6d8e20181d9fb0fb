"""Contacts under noise: averages over a motion, with the standard error of a correlated series.

⟨F⟩(d) = A′(d), A the free energy of the particles at the displacement d
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from contact1d.analysis.curve import PROFILE_COLUMNS, SAMPLE_TABLE
from contact1d.analysis.friction import standard_error
from contact1d.analysis.pressure import Profile, mean_pressure
from contact1d.digits import apart
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import LATTICE, Outcome, Reading, Result
from contact1d.workflow.continuation.state import State, radius_rule
from contact1d.workflow.continuation.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.deck.steps import DisplaceInTime, Phase, Row, UnderLoad
from contact1d.workflow.experiments.series import Series, begun, measured, recorded
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE

CHUNK = 0.25
"""Time between two samples of a thermal contact over the settling time."""
FEWEST_STEPS = 20
SETTLING_LOOKS = 40
"""Looks (of a quarter of a settling time each) that a thermal contact has to forget its start: its run-in."""
BLOCKS = 20
"""Blocks whose means give the standard error: each is long against the settling time."""
SAMPLES = 200
"""Samples of a position, and of a load before its statistics are judged, and again until they are good enough."""
MOST_SAMPLES = 2_000
BALANCE = 5.0
"""Standard errors by which the mean force may miss the load."""
APART = 0.5
"""Time between two samples of a position over that of a particle's slowest decay, at least."""
CERTAIN = 2.0
"""Standard errors of a mean that are its uncertainty: the largest of many means is one that chance made large."""


def chunk_steps(settings: Settings) -> int:
    """Timesteps between two samples of a thermal contact."""
    return max(FEWEST_STEPS, math.ceil(CHUNK * settings.motion.settle_time / settings.motion.time_step))


def run_in(name: str, settings: Settings, load: float) -> Phase:
    """The phase in which a contact under a load [FU] forgets its start."""
    return Phase(name, (UnderLoad(load, chunk_steps(settings)),) * SETTLING_LOOKS)


def planned_samples(settings: Settings, load: float) -> tuple[Phase, Phase]:
    """The planned schedule of a load under noise."""
    samples = (UnderLoad(load, chunk_steps(settings)),) * SAMPLES
    return run_in("settling", settings, load), Phase("sampling", samples, state=True)


def blocks_of(samples: Sequence[State]) -> Series:
    """Means over BLOCKS parts of the samples."""
    profiles = recorded([one.profile for one in samples], PROFILE_COLUMNS)
    return Series(recorded(samples, ("displacement", "force", "carried")) | profiles).parts(BLOCKS)


def mean_profile(blocks: Series) -> Profile:
    """The average over time, particle by particle."""
    return Profile(*map(blocks.mean, PROFILE_COLUMNS))


def mean_state(samples: Sequence[State]) -> State:
    """The mean of samples in the place of one state. Its `residual` is CERTAIN standard errors of the force over N."""
    blocks = blocks_of(samples)
    return replace(
        samples[-1],
        force=float(blocks.mean("force")),
        displacement=float(blocks.mean("displacement")),
        profile=mean_profile(blocks),
        smallest_distance=min(one.smallest_distance for one in samples),
        depth=max(one.depth for one in samples),
        residual=CERTAIN * standard_error(blocks["force"]) / len(blocks.mean("x")),
    )


def sample_columns(states: Sequence[State], loads: Sequence[float], settings: Settings) -> dict[str, tuple[float, ...]]:
    """The columns of samples.csv: time [TU], load and force [FU], displacement and contact radius [LU] of each state.

    Args:
        states: in order.
        loads: under which each was measured [FU].
        settings: with the length of a timestep.
    """
    found = recorded(states, ("step", "displacement", "force"))
    radii = [math.nan if state.radius is None else state.radius.value for state in states]
    time = found.pop("step") * settings.motion.time_step
    columns = {"time": time, "load": np.asarray(loads), **found, "contact_radius": np.asarray(radii)}
    return Series(columns).table()


def thermal_load(context: RunContext, load: float) -> Outcome:
    """d, F, a and F/(πa²) of a load [FU] under noise, as means.

    Raises:
        UntrustedError: the bodies separate, or the mean force misses the load; see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    goal = settings.tolerance * max(settings.forces.rest, abs(settings.largest_displacement))
    settling, sampling = planned_samples(settings, load)
    samples: list[State] = []
    with context.contact() as contact:
        settled = _looks(contact, begun(contact, settling))
        rows, error = begun(contact, sampling), math.inf
        while error > goal and len(samples) < MOST_SAMPLES:
            samples += _looks(contact, rows)
            blocks = blocks_of(samples)
            error = standard_error(blocks["displacement"])
        contact.write_state()
        contact.finish()
        phases = contact.phases
    for state in samples:
        require_trust(scene, settings, state)
    results = measured(blocks, partial(read, rule=radius_rule(scene, settings.tolerance)))
    require_balance(results["force"], load)
    warnings = doubts(scene, settings, tuple(samples))
    if error > goal:
        found, wanted = apart(error, goal, 2)
        warnings["statistics"] = (
            f"standard error of the displacement {found} LU after {MOST_SAMPLES} samples, above {wanted} LU"
        )
    states = (*settled, *samples)
    table = {SAMPLE_TABLE: sample_columns(states, [load] * len(states), settings)}
    return Outcome(results, states, {"final": mean_state(samples)}, phases, warnings, tables=table)


def _looks(contact: Contact, rows: Sequence[Row]) -> list[State]:
    """The states of load steps, in which the bodies still reach each other."""
    found = []
    for row in rows:
        state = contact.row(row, trusted=False)
        if 0.0 < contact.settings.forces.cutoff < state.smallest_distance:  # 0 on a plane
            raise UntrustedError(
                "the bodies separated under the load and the noise: use a more compressive experiment.force or a lower "
                "noise.temperature"
            )
        found.append(state)
    return found


def read(blocks: Series, rule: RadiusRule) -> dict[str, Reading]:
    """Means of displacement and force, and what is read off the mean profile."""
    found = {
        "displacement": Reading(float(blocks.mean("displacement")), LENGTH),
        "force": Reading(float(blocks.mean("carried")), FORCE),
    }
    profile = mean_profile(blocks)
    if (radius := rule.of(profile)) is None:
        return found
    pressure = mean_pressure(profile, rule.bodies.spacing, radius.value)
    between = 2.0 * radius.uncertainty / radius.value * abs(pressure)
    return found | {
        "contact_radius": Reading(radius.value, LENGTH, {LATTICE: radius.uncertainty}),
        "mean_pressure": Reading(pressure, MEAN_PRESSURE, {LATTICE: between}),
    }


def require_balance(force: Result, load: float) -> None:
    """Refuse a mean force that misses its load [FU] by more than its scatter.

    Raises:
        UntrustedError: by how many standard errors it does.
    """
    off = abs(force.value - load)
    if off > BALANCE * force.uncertainty:
        raise UntrustedError(
            f"not in equilibrium: the mean force {force.value:.4g} FU differs from the load {load:.4g} FU by "
            f"{off / force.uncertainty:.1f} standard errors"
        )


def thermal_rows(
    settings: Settings, decay: float, positions: Sequence[tuple[float, bool]]
) -> tuple[DisplaceInTime, ...]:
    """The load steps of a path: at each position equilibration, and where the scene asks for the state also sampling.

    Args:
        settings: of the scene.
        decay: time constant of a particle [TU].
        positions: displacement [LU], and whether the scene asks for it.
    """
    look = max(chunk_steps(settings), math.ceil(APART * decay / settings.motion.time_step))
    return tuple(
        DisplaceInTime(float(position), look) for position, asked in positions for _ in range(_looks_at(asked))
    )


def averaged(states: Sequence[State], positions: Sequence[tuple[float, bool]]) -> list[State]:
    """One state for each position of a path: the mean of its samples, or the last one between two positions."""
    ends = np.cumsum([_looks_at(asked) for _, asked in positions]).tolist()
    return [
        mean_state(states[end - SAMPLES : end]) if asked else states[end - 1]
        for end, (_, asked) in zip(ends, positions, strict=True)
    ]


def _looks_at(asked: bool) -> int:
    """Load steps at a position."""
    return SETTLING_LOOKS + asked * SAMPLES
