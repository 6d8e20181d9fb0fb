"""Contacts under noise: averages over a motion, with the standard error of a correlated series.

⟨F⟩(d) = A′(d), A the free energy of the particles at the displacement d
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.curve import SAMPLE_TABLE
from contact1d.analysis.pressure import Profile, mean_pressure
from contact1d.digits import apart
from contact1d.workflow.continuation.contact import Contact
from contact1d.workflow.continuation.context import RunContext
from contact1d.workflow.continuation.outcome import Outcome, Result
from contact1d.workflow.continuation.state import RadiusRule, State
from contact1d.workflow.continuation.trust import UntrustedError, doubts, require_trust
from contact1d.workflow.deck.steps import DisplaceInTime, Phase, UnderLoad
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Load
from contact1d.workflow.units import FORCE, LENGTH, MEAN_PRESSURE

CHUNK = 0.25
"""Time between two samples of a thermal contact over the settling time."""
FEWEST_STEPS = 20
SETTLING_LOOKS = 40
"""Looks (of a quarter of a settling time each) that a thermal contact has to forget its start."""
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


def sampled_phase(name: str, settings: Settings, load: float, samples: int, state: bool = False) -> Phase:
    """A planned phase of samples under a load [FU]."""
    return Phase(name, (UnderLoad(load, chunk_steps(settings)),) * samples, state)


def planned_samples(settings: Settings, load: float) -> tuple[Phase, ...]:
    """The planned schedule of a load under noise."""
    return (
        sampled_phase("settling", settings, load, SETTLING_LOOKS),
        sampled_phase("sampling", settings, load, SAMPLES, state=True),
    )


def standard_error(samples: Sequence[float]) -> float:
    """Standard error of the mean of a correlated series, from the means of BLOCKS blocks."""
    means = [float(np.mean(block)) for block in np.array_split(np.asarray(samples), BLOCKS)]
    return float(np.std(means, ddof=1) / math.sqrt(BLOCKS))


def sample_columns(states: Sequence[State], loads: Sequence[float], settings: Settings) -> dict[str, tuple[float, ...]]:
    """The columns of samples.csv: time [TU], load and force [FU], displacement and contact radius [LU] of each state.

    Args:
        states: in order.
        loads: under which each was measured [FU].
        settings: with the length of a timestep.
    """
    radii = [state.radius for state in states]
    return {
        "time": tuple(state.step * settings.motion.time_step for state in states),
        "load": tuple(loads),
        "displacement": tuple(state.displacement for state in states),
        "force": tuple(state.force for state in states),
        "contact_radius": tuple(math.nan if radius is None else radius.value for radius in radii),
    }


def mean_profile(profiles: Sequence[Profile]) -> Profile:
    """The average over time, particle by particle."""

    def mean(name: str) -> NDArray[np.float64]:
        return np.asarray(np.mean([getattr(profile, name) for profile in profiles], axis=0))

    return Profile(*(mean(name) for name in ("x", "z_lower", "z_upper", "pressure", "shear")))


def mean_state(samples: Sequence[State]) -> State:
    """The mean of samples in the place of one state. Its `residual` is CERTAIN standard errors of the force over N."""
    last, forces = samples[-1], [one.force for one in samples]
    return replace(
        last,
        force=float(np.mean(forces)),
        displacement=float(np.mean([one.displacement for one in samples])),
        profile=mean_profile([one.profile for one in samples]),
        smallest_distance=min(one.smallest_distance for one in samples),
        depth=max(one.depth for one in samples),
        residual=CERTAIN * standard_error(forces) / last.profile.x.size,
    )


def thermal_load(context: RunContext) -> Outcome:
    """d, F, a and F/(πa²) of a load under noise, as means.

    Raises:
        UntrustedError: the bodies separate, or the mean force misses the load; see `require_trust`.
    """
    scene, settings = context.deck.scene, context.deck.settings
    assert isinstance(scene.experiment, Load)
    load, steps = scene.experiment.force, chunk_steps(settings)
    goal = settings.tolerance * max(settings.forces.rest, abs(settings.largest_displacement))
    with context.contact() as contact:
        contact.begin("settling", expected_steps=SETTLING_LOOKS * steps)
        settling = _samples(contact, load, SETTLING_LOOKS)
        contact.begin("sampling", expected_steps=SAMPLES * steps)
        samples: list[State] = []
        while len(samples) < MOST_SAMPLES:
            samples += _samples(contact, load, SAMPLES)
            if standard_error([s.displacement for s in samples]) <= goal:
                break
        contact.write_state()
        contact.finish()
        phases = contact.phases
    for state in samples:
        require_trust(scene, settings, state)
    results = _load_results(context, samples, load)
    warnings = doubts(scene, settings, tuple(samples))
    error = results["displacement"].uncertainty
    if error > goal:
        found, wanted = apart(error, goal, 2)
        warnings["statistics"] = (
            f"standard error of the displacement {found} LU after {MOST_SAMPLES} samples, above {wanted} LU"
        )
    if "contact_radius" not in results:
        warnings["no_radius"] = "the contact has no width, so there is no contact radius"
    states = (*settling, *samples)
    table = {SAMPLE_TABLE: sample_columns(states, [load] * len(states), settings)}
    return Outcome(results, states, {"final": mean_state(samples)}, phases, warnings, tables=table)


def _samples(contact: Contact, load: float, count: int) -> list[State]:
    """So many samples of bodies that still reach each other."""
    found = []
    for _ in range(count):
        state = contact.row(UnderLoad(load, chunk_steps(contact.settings)), trusted=False)
        if contact.settings.forces.law is not None and state.smallest_distance > contact.settings.forces.cutoff:
            raise UntrustedError(
                "the bodies separated under the load and the noise: use a more compressive experiment.force or a lower "
                "noise.temperature"
            )
        found.append(state)
    return found


def _load_results(context: RunContext, samples: list[State], load: float) -> dict[str, Result]:
    """Means with their standard errors; of what is read off a profile, by blocks of samples."""
    scene = context.deck.scene
    forces, displacement = [s.carried for s in samples], [s.displacement for s in samples]
    mean_force, force_error = float(np.mean(forces)), standard_error(forces)
    if abs(mean_force - load) > BALANCE * force_error:
        raise UntrustedError(
            f"not in equilibrium: the mean force {mean_force:.4g} FU differs from the load {load:.4g} FU by "
            f"{abs(mean_force - load) / force_error:.1f} standard errors"
        )
    found = {
        "displacement": Result(float(np.mean(displacement)), LENGTH, {"statistics": standard_error(displacement)}),
        "force": Result(mean_force, FORCE, {"statistics": force_error}),
    }
    rule, mean = RadiusRule(scene, context.deck.settings.tolerance), mean_profile([s.profile for s in samples])
    if (radius := rule.of(mean)) is None:
        return found
    size = max(1, len(samples) // BLOCKS)
    blocks = [samples[i : i + size] for i in range(0, size * BLOCKS, size)]
    radii = [rule.of(mean_profile([s.profile for s in block])) for block in blocks]
    values = [one.value for one in radii if one is not None]
    spread = float(np.std(values, ddof=1) / math.sqrt(len(values))) if len(values) > 1 else radius.value
    pressure = mean_pressure(mean, scene.bodies.spacing, radius.value)
    share = force_error / max(abs(mean_force), 1e-300)
    errors = {"statistics": spread, "discretisation": radius.uncertainty}
    found["contact_radius"] = Result(radius.value, LENGTH, errors, read=radius.uncertainty)
    by_radius = {source: 2.0 * error / radius.value * abs(pressure) for source, error in errors.items()}
    by_radius["statistics"] += share * abs(pressure)
    found["mean_pressure"] = Result(pressure, MEAN_PRESSURE, by_radius, read=by_radius["discretisation"])
    return found


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
        DisplaceInTime(float(position), look)
        for position, asked in positions
        for _ in range(SETTLING_LOOKS + (SAMPLES if asked else 0))
    )


def averaged(states: Sequence[State], positions: Sequence[tuple[float, bool]]) -> list[State]:
    """One state for each position of a path: the mean of its samples, or the last one between two positions."""
    found, first = [], 0
    for _, asked in positions:
        end = first + SETTLING_LOOKS + (SAMPLES if asked else 0)
        samples, last = states[first + SETTLING_LOOKS : end], states[end - 1]
        first = end
        found.append(mean_state(samples) if asked else last)
    return found
