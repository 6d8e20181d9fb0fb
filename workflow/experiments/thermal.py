"""Contacts under noise: averages over a motion, with the standard error of a correlated series.

⟨F⟩(d) = A′(d), A the free energy of the particles at the displacement d.
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
from contact1d.workflow.continuation.trust import doubts, require_trust
from contact1d.workflow.deck.steps import DisplaceInTime, Phase, Row, UnderLoad
from contact1d.workflow.errors import UntrustedError
from contact1d.workflow.experiments.series import Series, measured, recorded
from contact1d.workflow.laws.radius import RadiusRule
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE

RUN_IN_SAMPLES = 40
"""Samples of the run-in, in which a thermal contact forgets its start: ten settling times (`chunk_steps`)."""
BLOCKS = 20
"""Blocks whose means give the standard error: each is long compared with the settling time."""
SAMPLES = 200
"""Samples at a position; samples of a load between two looks at its standard error."""
CERTAIN = 2.0
"""Uncertainty of a mean over its standard error: the largest of many means is large by chance."""


def chunk_steps(settings: Settings) -> int:
    """Return the timesteps between two samples of a thermal contact: a quarter of the settling time, 20 at least."""
    return max(20, math.ceil(0.25 * settings.motion.settle_time / settings.motion.time_step))


def run_in(name: str, settings: Settings, load: float) -> Phase:
    """Return a phase of 40 load steps under a load [FU], compression positive, in which a contact forgets its start.

    `name`: name of the phase.
    """
    return Phase(name, (UnderLoad(load, chunk_steps(settings)),) * RUN_IN_SAMPLES)


def planned_samples(settings: Settings, load: float) -> tuple[Phase, Phase]:
    """Return the phases "settling" (40 load steps) and "sampling" (200) under a load [FU], compression positive."""
    samples = (UnderLoad(load, chunk_steps(settings)),) * SAMPLES
    return run_in("settling", settings, load), Phase("sampling", samples, state=True)


def blocks_of(samples: Sequence[State]) -> Series:
    """Return the means over 20 parts of the samples, in order, as a series; 20 samples at least are needed.

    Its columns are "displacement" [LU], "force", that of the contact, and "carried", the load that it balances [FU],
    (20,), and those of the profile by the names of its fields, (20, particles).
    """
    profiles = recorded([sample.profile for sample in samples], PROFILE_COLUMNS)
    return Series(recorded(samples, ("displacement", "force", "carried")) | profiles).parts(BLOCKS)


def mean_profile(blocks: Series) -> Profile:
    """Return the profile averaged over the blocks of time, particle by particle."""
    return Profile(*map(blocks.mean, PROFILE_COLUMNS))


def mean_state(samples: Sequence[State]) -> State:
    """Return the mean of samples as a state whose `residual` [FU] is two standard errors of the force over N particles.

    Displacement, force and profile are means, the smallest distance is the least and the depth the largest of all
    samples; all else is that of the last one.
    """
    blocks = blocks_of(samples)
    return replace(
        samples[-1],
        force=float(blocks.mean("force")),
        displacement=float(blocks.mean("displacement")),
        profile=mean_profile(blocks),
        smallest_distance=min(sample.smallest_distance for sample in samples),
        depth=max(sample.depth for sample in samples),
        residual=CERTAIN * standard_error(blocks["force"]) / len(blocks.mean("x")),
    )


def sample_columns(states: Sequence[State], loads: Sequence[float], settings: Settings) -> dict[str, tuple[float, ...]]:
    """Return the columns of samples.csv by name, (m,): time [TU], load, force [FU], displacement, contact radius [LU].

    The names are "time", "load", "displacement", "force" and "contact_radius", which is NaN where the bodies do not
    touch. Forces are positive in compression.

    Args:
        states: in order, (m,).
        loads: load under which each was measured [FU].
        settings: with the length of a timestep.
    """
    measurements = recorded(states, ("step", "displacement", "force"))
    radii = [math.nan if state.radius is None else state.radius.value for state in states]
    time = measurements.pop("step") * settings.motion.time_step
    columns = {"time": time, "load": np.asarray(loads), **measurements, "contact_radius": np.asarray(radii)}
    return Series(columns).table()


def thermal_load(context: RunContext, load: float, most_samples: int = 2_000) -> Outcome:
    """Run a contact under a load [FU], compression positive, with noise, and return the outcome: means of the samples.

    Its results are "displacement" [LU], "force" [FU] and, in contact, "contact_radius" [LU] and "mean_pressure"
    [FU/LU²]. Samples are added, 200 at a time, until the standard error of the displacement is within the tolerance,
    relative to the larger one of the expected largest displacement and the distance of the apexes at displacement 0;
    with a warning "statistics" where `most_samples` do not reach it. The mean state is marked "final"; the table
    "samples" also has those of the run-in.

    Raises:
        UntrustedError: the bodies separate or pass through each other, the mean force misses the load, or the contact
            reaches the end of its chain.
        EngineError: LAMMPS failed.
    """
    scene, settings = context.inputs
    goal = settings.tolerance * max(settings.forces.rest, abs(settings.largest_displacement))
    settling, sampling = planned_samples(settings, load)
    samples: list[State] = []
    with context.contact() as contact:
        settled = _sampled_states(contact, contact.begin_phase(settling))
        rows, error = contact.begin_phase(sampling), math.inf
        while error > goal and len(samples) < most_samples:
            samples += _sampled_states(contact, rows)
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
        reached, wanted = apart(error, goal, 2)
        warnings["statistics"] = (
            f"standard error of the displacement {reached} LU after {most_samples} samples, above {wanted} LU"
        )
    states = (*settled, *samples)
    table = {SAMPLE_TABLE: sample_columns(states, [load] * len(states), settings)}
    return Outcome(results, states, {"final": mean_state(samples)}, phases, warnings, tables=table)


def _sampled_states(contact: Contact, rows: Sequence[Row]) -> list[State]:
    """Run load steps and return their states, one for each, which need not be at rest.

    Raises:
        UntrustedError: the bodies are separated: no particle is within the cutoff of the other body. Never on a plane.
        EngineError: LAMMPS failed.
    """
    states = []
    for row in rows:
        state = contact.row(row, trusted=False)
        if 0.0 < contact.settings.forces.cutoff < state.smallest_distance:  # 0 on a plane
            raise UntrustedError(
                "the bodies separated under the load and the noise: use a more compressive experiment.force or a lower "
                "noise.temperature"
            )
        states.append(state)
    return states


def read(blocks: Series, rule: RadiusRule) -> dict[str, Reading]:
    """Return means of "displacement" [LU] and "force" [FU], "contact_radius" [LU] and "mean_pressure" [FU/LU²].

    The force is the load that the contact carries, compression positive. The last two are those of the mean profile,
    the pressure its force over πa²; they are left out where it shows no contact, or one of no width. Their errors are
    those by the interpolation of the radius.
    """
    results = {
        "displacement": Reading(float(blocks.mean("displacement")), LENGTH),
        "force": Reading(float(blocks.mean("carried")), FORCE),
    }
    profile = mean_profile(blocks)
    if (radius := rule.of(profile)) is None or radius.value == 0.0:
        return results
    pressure = mean_pressure(profile, rule.bodies.spacing, radius.value)
    between = 2.0 * radius.uncertainty / radius.value * abs(pressure)
    return results | {
        "contact_radius": Reading(radius.value, LENGTH, {LATTICE: radius.uncertainty}),
        "mean_pressure": Reading(pressure, MEAN_PRESSURE, {LATTICE: between}),
    }


def require_balance(force: Result, load: float, most: float = 5.0) -> None:
    """Refuse a mean force that misses its load [FU] by more than `most` of its uncertainties (standard errors).

    Nothing is returned.

    Raises:
        UntrustedError: the message has the difference in standard errors.
    """
    off = abs(force.value - load)
    if off > most * force.uncertainty:
        raise UntrustedError(
            f"not in equilibrium: the mean force {force.value:.4g} FU differs from the load {load:.4g} FU by "
            f"{off / force.uncertainty:.1f} standard errors"
        )


def thermal_rows(
    settings: Settings, decay: float, positions: Sequence[tuple[float, bool]]
) -> tuple[DisplaceInTime, ...]:
    """Return the load steps of a path: 40 of equilibration at a position, and 200 samples if the scene asks for it.

    They are as long as the time between two samples of a thermal contact, and half of `decay` at least.

    Args:
        settings: of the scene.
        decay: time constant of a particle [TU].
        positions: displacement [LU], and whether the scene asks for it.
    """
    # Samples are half a time constant apart at least.
    look = max(chunk_steps(settings), math.ceil(0.5 * decay / settings.motion.time_step))
    return tuple(
        DisplaceInTime(float(position), look) for position, asked in positions for _ in range(_steps_at(asked))
    )


def averaged(states: Sequence[State], positions: Sequence[tuple[float, bool]]) -> list[State]:
    """Return one state for each position of a path: the mean of its 200 samples, of an intermediate one the last state.

    Args:
        states: of all load steps, in order.
        positions: displacement [LU], and whether the scene asks for its state.
    """
    ends = np.cumsum([_steps_at(asked) for _, asked in positions]).tolist()
    return [
        mean_state(states[end - SAMPLES : end]) if asked else states[end - 1]
        for end, (_, asked) in zip(ends, positions, strict=True)
    ]


def _steps_at(asked: bool) -> int:
    """Return the number of load steps at a position: 40 of equilibration, and 200 samples of a state of the scene."""
    return RUN_IN_SAMPLES + asked * SAMPLES
