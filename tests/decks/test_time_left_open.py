"""Claim: timesteps, drags and masses that a scene leaves open suit its fastest and its slowest motion, in its deck.

References: stiffnesses of the written-out law, eigenvalues of straight chains, closed forms of critical drags. What a
load needs of a displacement, and the stiffness under it, is that of the planned schedule of the same bodies at rest.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq

from tests.decks.test_lengths_and_forces import SHARES, SLIDING, pair, slide
from tests.decks.written import UPPER, Written, written
from tests.scenes import LAW, chains

RADIUS, SPRING, SPACING, MASS, FORCE = 200.0, 0.7, 0.5, 3.0, 0.5
LOAD = {"kind": "load", "method": "dynamic", "force": FORCE}
PATH = {"kind": "path", "method": "dynamic", "displacements": [0.05]}
AUTO: dict[str, Any] = {"damping": {"coefficient": "auto"}}
STILL = SHARES["still_step"]
"""ω Δt of a motion that comes to rest."""
FEWEST_ROWS, MOST_ROWS, FEWEST_STEPS = 20, 50, 5
"""Rows in a spacing of a drive's way, and timesteps in a row."""
EXACT, SLOPE = 1e-9, 1e-2
"""Relative: round-off; of a difference of forces."""


def deck(**tables: Any) -> Written:
    bodies = {"spacing": SPACING, "mass": MASS} | tables.pop("bodies", {})
    return written(chains(RADIUS, SPRING, **{"experiment": LOAD, **tables}, bodies=bodies))


def sliding(tolerance: float = 1e-3, **changes: Any) -> dict[str, Any]:
    """Tables of a slide; keys of bodies are added, other tables are replaced."""
    bodies = {"spacing": 1.0, "mass": MASS} | changes.pop("bodies", {})
    own = {
        "damping": {"coefficient": 0.3}, "plate": {"free": ["x", "z"], "damping": 0.1},
        "accuracy": {"tolerance": tolerance},
    }  # fmt: skip
    return slide(7.0, **bodies) | own | changes


def stiffest(spring: float, spacing: float, law: tuple[float, ...] = LAW) -> float:
    """Stiffness [FU/LU] of a particle and a row of opposite ones that move against it, at the closest distance."""
    closest = 0.2 * brentq(lambda r: pair(r, law), 0.01, 3.0)
    slope = sum(sign * law[i] / law[i + 1] ** 2 * math.exp(-closest / law[i + 1]) for sign, i in ((1, 0), (-1, 2)))
    return spring + 2.0 * (1.0 + 2.0 * law[1] / spacing) * slope


FASTEST = math.sqrt(stiffest(SPRING, SPACING) / MASS)


def swinging(count: int, mass: float, more: float = 0.0) -> float:
    """Frequency of a plate on the springs of all its particles, which stay behind, and on one of its own."""
    return math.sqrt((count * SPRING + more) / mass)


HEAT: dict[str, Any] = {"noise": {"temperature": 1e-3, "seed": 1}, "damping": {"coefficient": 0.3}}
ALONG = {"horizontal": {}, "bodies": {"bulk_stiffness_tangential": 2.0}}
PULL = {"kind": "pull_off", "method": "dynamic", "preload": FORCE, "velocity": 0.1, "stiffness": 1e4}


@pytest.mark.parametrize(
    ("tables", "longest"),
    [
        ({"damping": {"coefficient": 0.3}}, lambda n: STILL / FASTEST),
        (AUTO, lambda n: STILL / FASTEST),
        ({"neighbours": {"stiffness": 83.0}}, lambda n: STILL * math.sqrt(MASS / stiffest(SPRING + 332.0, SPACING))),
        (ALONG, lambda n: STILL * math.sqrt(MASS / stiffest(2.0, SPACING))),
        (HEAT | {"accuracy": {"tolerance": 1e-2}}, lambda n: min(STILL, math.sqrt(1e-2 / 0.4)) / FASTEST),
        (HEAT | {"accuracy": {"tolerance": 1e-5}}, lambda n: math.sqrt(1e-5 / 0.4) / FASTEST),
        ({"plate": {"mass": 1e-3, "damping": 0.0}}, lambda n: STILL / swinging(n, 1e-3)),
        ({"plate": {"mass": 1e3, "damping": 0.0}}, lambda n: STILL / FASTEST),
        ({"damping": {"coefficient": 500.0}, "plate": {"damping": 1.0}}, lambda n: 0.2 * MASS / 500.0),
        ({"plate": {"mass": 10.0, "damping": 3e3}}, lambda n: 0.2 * 10.0 / 3e3),
        (
            HEAT | {"plate": {"mass": 0.1, "damping": 0.0}, "experiment": PULL, "accuracy": {"tolerance": 1e-2}},
            lambda n: math.sqrt(1e-2 / 0.4) / swinging(n, 0.1, 1e4),
        ),
    ],
)  # fmt: skip
def test_a_timestep_is_as_long_as_the_fastest_motion_its_drag_and_the_bias_of_heat_allow(
    tables: dict[str, Any], longest: Callable[[int], float]
) -> None:
    """The steps of what comes to rest were measured; the bias of ⟨u²⟩ is 0.4 (ω Δt)²; a drag needs γ Δt/m of 0.2."""
    found = deck(**{"damping": {"coefficient": 1e-6}, "plate": {}} | tables)
    assert found.number("time_step") == pytest.approx(longest(len(found.atoms[UPPER])), rel=EXACT)


def test_a_cantilever_holds_its_plate_too() -> None:
    """By itself and with the stiffer of both directions of its particles."""
    for cantilever, along in ((0.5, 6.0), (3e4, 2.0), (0.5, 1.0)):
        found = written(sliding(
            bodies={"bulk_stiffness_tangential": along}, cantilever={"stiffness": cantilever, "velocity": 0.1},
            plate={"free": ["x", "z"], "damping": 0.1, "mass": 1e-3},
        ))  # fmt: skip
        held = len(found.atoms[UPPER]) * max(2.0, along) + cantilever
        assert 0.7 * 0.2 < found.number("cantilever_time_step") * math.sqrt(held / 1e-3) <= 0.2 * (1.0 + EXACT)


@pytest.mark.parametrize("mass", [0.2, 40.0, 1e4, "auto"])
def test_an_automatic_drag_is_critical_for_plate_and_particles_on_the_softened_contact(mass: Any) -> None:
    """2√(K M): K is 0.6 of the springs of those within √(2Rd), two in series each; M is all that moves."""
    timeless = deck(experiment={"kind": "load", "force": FORCE})
    touching = 2.0 * math.sqrt(2.0 * RADIUS * timeless.numbers("row_displacement")[-1]) / SPACING
    contact = touching * 0.5 * SPRING
    found = deck(**AUTO, plate={"mass": mass})
    count = len(found.atoms[UPPER])
    plate = count * MASS if mass == "auto" else mass
    assert (found.masses[UPPER], found.plate_mass) == (MASS, pytest.approx(plate))
    drag = found.number("damping_coefficient")
    moving = plate + count * MASS
    assert count * drag == pytest.approx(2.0 * math.sqrt(0.6 * contact * moving), rel=1e-6)
    period = 2.0 * math.pi * math.sqrt(moving / contact)
    assert found.number("row_steps") == math.ceil(10.0 * period / found.number("time_step"))
    noisy = deck(**HEAT, plate={"mass": mass})
    assert "# phase settling: 40 rows" in noisy.text
    assert 40 * noisy.numbers("row_steps")[0] * noisy.number("time_step") >= 8.0 * period


@pytest.mark.parametrize("share", [0.02, 0.3, 1.0, 4.0])
def test_a_light_plate_swings_no_longer_against_its_particles_than_one_of_their_mass(share: float) -> None:
    """Reference: eigenvalues of two masses on a stiff spring, of which the particles have a drag of their own."""
    spring, particles = 1e7, 40 * MASS
    plate = share * particles
    found = deck(**AUTO, plate={"mass": plate}, bodies={"particles": 40, "spacing": 1.0})
    rate, drag = found.number("damping_coefficient") / MASS, 40 * found.number("plate_damping_per_anchor")
    motion = np.array([
        [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0],
        [-spring / plate, spring / plate, -drag / plate, 0.0],
        [spring / particles, -spring / particles, 0.0, -rate],
    ])  # fmt: skip
    values = np.linalg.eigvals(motion)
    swing = values[np.abs(values.imag) > 1.0].real
    assert swing == pytest.approx(-0.25 * rate if share <= 1.0 else -0.5 * rate * share / (1.0 + share), rel=1e-3)


def test_without_a_plate_each_particle_is_damped_on_its_own_spring() -> None:
    assert deck(**AUTO, experiment=PATH).number("damping_coefficient") == pytest.approx(math.sqrt(SPRING * MASS))


def at_rest(spring: float, force: float) -> float:
    """Displacement [LU] of the sliding bodies under a force [FU]."""
    load = {"kind": "load", "force": force}
    of = written(chains(30.0, spring, law=SLIDING, bodies={"spacing": 1.0}, experiment=load))
    return of.numbers("row_displacement")[-1]


@pytest.mark.parametrize(
    ("spring", "mass", "drag"),
    [
        (2.0, 1.0, 1e-4),
        (2.0, 1.0, 2.0),
        (2000.0, 300.0, 1e-2),
        (2.0, 300.0, 30.0),
        (2000.0, 1e5, 30.0),
        (2.0, 1e6, 0.3),
    ],
)  # fmt: skip
def test_a_slide_is_loaded_under_its_own_drag_where_that_is_enough_and_no_more_than_ten_times_that(
    spring: float, mass: float, drag: float
) -> None:
    """Enough is critical for the plate on 0.6 of what holds it, 2√(0.6 K M)/N, and lets steps stop no particle.

    What holds it is the softer one of the springs that touch and the law, and it has time for half a swing on that.
    """
    plate = {"free": ["x", "z"], "damping": 0.1, "mass": mass}
    bodies = {"bulk_stiffness": spring, "bulk_stiffness_tangential": 2.0}
    found = written(sliding(damping={"coefficient": drag}, plate=plate, bodies=bodies))
    count = len(found.atoms[UPPER])
    moving = mass + count * MASS
    law = 2.0 * SLOPE / (at_rest(spring, 1.0 + SLOPE) - at_rest(spring, 1.0 - SLOPE))
    touching = 2.0 * math.sqrt(60.0 * at_rest(spring, 1.0))
    held = min(law, max(1.0, touching) * 0.5 * spring)
    step = found.number("cantilever_time_step")
    critical = 2.0 * math.sqrt(0.6 * held * moving) / count
    within = 0.4 * MASS / step
    used = found.numbers("row_damping")
    assert used[-1] == drag
    if critical <= drag <= 10.0 * critical:
        assert used == [drag]
    elif critical < within / 1.3:  # rows take whole numbers of steps
        assert used == [pytest.approx(critical, rel=SLOPE), drag]
        noisy = written(sliding(damping={"coefficient": drag}, plate=plate, bodies=bodies, noise=HEAT["noise"]))
        assert noisy.number("noise_settling_damp") == pytest.approx(MASS / critical, rel=SLOPE)
    else:
        assert used[0] <= within * (1.0 + EXACT)
    swing = 2.0 * math.pi * math.sqrt(moving / (max(1.0, touching) * 0.5 * spring))
    longest = max(swing, math.pi * math.sqrt(moving / held))
    assert found.numbers("row_steps")[0] * step == pytest.approx(10.0 * longest, rel=2.0 * SLOPE, abs=step)


@pytest.mark.parametrize("neighbours", [0.0, 0.3, 20.0])
def test_the_stiffest_motion_of_two_chains_is_no_stiffer_than_what_a_relaxation_is_made_for(neighbours: float) -> None:
    """Reference: eigenvalues of two straight chains face to face at the closest distance, pairs in line alone."""
    springs = {"stiffness": neighbours} if neighbours else None
    bodies = {"particles": 30, "spacing": 1.0, "mass": 1.0, "bulk_stiffness_tangential": 1.1}
    found = deck(bodies=bodies, neighbours=springs, horizontal={}, experiment={"kind": "load", "force": 0.05})
    between = 2.0 * np.eye(30) - np.eye(30, k=1) - np.eye(30, k=-1)
    opposite = 0.5 * (stiffest(0.0, math.inf)) * np.eye(30)
    chain = 1.1 * np.eye(30) + neighbours * between + opposite
    values = np.linalg.eigvalsh(np.block([[chain, -opposite], [-opposite, chain]]))
    assert values.max() <= (0.5 / (10.0 * found.number("relaxation_step"))) ** 2 <= 1.3 * values.max()


@pytest.mark.parametrize(
    ("tolerance", "product", "path"),
    [(1e-1, 0.2, [[0.1, 3.7], [0.0, 0.5], [-0.31, 2.0]]), (1e-3, 0.2, [[0.004, 2.0]]), (1e-5, 0.02, [[0.1, 2.0]])],
)
def test_rows_and_timesteps_make_the_drives_way_exactly(
    tolerance: float, product: float, path: list[list[float]]
) -> None:
    """No step is longer than it may be, which shrinks with the root of the tolerance, and none is needlessly short.

    Every spacing has its rows, of ten steps where it has time for that.
    """
    found = written(sliding(tolerance, experiment={"kind": "slide", "normal_force": 1.0, "path": path}))
    longest = product / math.sqrt(stiffest(2.0, 1.0, SLIDING) / MASS)
    clocks, phases = found.numbers("cantilever_time_step"), found.text.split("# phase sliding")[1:]
    assert found.numbers("cantilever_velocity") == [velocity for velocity, _ in path]
    for phase, step, (velocity, distance) in zip(phases, clocks, path, strict=True):
        steps = Written({"in.lammps": phase}).numbers("row_steps")
        time = distance / (abs(velocity) or 0.1)
        assert sum(steps) * step == pytest.approx(time, rel=1e-12)
        assert {*steps} == {steps[0]}
        assert steps[0] % FEWEST_STEPS == 0
        assert step <= longest * (1.0 + EXACT)
        assert steps[0] == FEWEST_STEPS or time / len(steps) / (steps[0] - FEWEST_STEPS) > longest
        wanted = np.clip(time / distance / longest / 10.0, FEWEST_ROWS, MOST_ROWS)
        assert len(steps) / distance == pytest.approx(wanted, abs=1.0 + 1.0 / distance)
