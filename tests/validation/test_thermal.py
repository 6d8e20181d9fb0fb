"""Claim: under heat a load, a path and a pull-off have the means and the swing that Boltzmann's weight gives them, and
a contact separates at the tension that Smoluchowski's equation says.

Reference of a load without dynamics: `thermal_chain`, to first order in the temperature, with neighbours and all
pairs; `validation hard` holds it, and hotter loads, against Boltzmann's integral. The mean alone tells no temperature
where the tolerance is wider than what the noise moves it by: the shipped scene's is moved by 5e-4 LU. Its swing in time
does, ∝ √(k_BT): the variance is compared within its own sample's error.

Of a path and a pull-off nine pairs too far apart to feel each other: the free energy A of the plate is nine times that
of a pair, by quadrature, ⟨F⟩(d) = A′(d), and its density is followed in time as the load grows.
"""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run, load_run, read_scene, run
from contact1d.analysis.curve_marks import largest_tension
from tests.scenes import LAW, SCENES
from validation.paper import detachment
from validation.references.detachment import detachment_in_time, drag_of_pairs
from validation.references.interaction import PairInteraction
from validation.references.model import ChainModel
from validation.references.thermal_chain import displacement_under

Array = NDArray[np.float64]
SIGMAS = 4.0
"""Standard errors: one test in 16 000 would fail by chance, and the seeds are fixed."""
BLOCKS = 20
TELLS = 5.0
"""What heat changes over the standard error: a run that could not tell it from none is no test. 8 measured."""
TELLS_SWING = 4.0
"""The same of the variance in time, whose error is a fifth of itself with the few samples of the shipped scene."""
HERE = PairInteraction.of(*LAW)
SHIPPED = 0.259088
"""Mean displacement of the shipped scene [LU], by `thermal_chain`."""
HOT = 5e-3
"""k_BT of a path [FU·LU]: a tenth of what it takes to part a pair."""
PLACES = (0.1, 0.0, -0.1, -0.15, -0.2, -0.25, -0.3, -0.5)
REPEATS = 16


def swings(finished: Run, deviation: float) -> None:
    """The variance of d in time is that of the reference, and not 0, within the sample's own errors."""
    d = finished.curve.displacement[finished.curve.branch == "sampling"]
    squares = [float(np.mean((block - d.mean()) ** 2)) for block in np.array_split(d, BLOCKS)]
    error = float(np.std(squares, ddof=1)) / math.sqrt(BLOCKS)
    assert abs(float(np.var(d)) - deviation**2) <= SIGMAS * error
    assert deviation**2 > TELLS_SWING * error


def test_the_shipped_scene_has_the_mean_and_the_swing_of_its_temperature() -> None:
    scene = read_scene(SCENES / "thermal_load.toml")
    finished = run(scene)
    assert scene.noise is not None
    assert scene.neighbours is not None
    model = ChainModel(
        finished.profiles["final"].x.size, scene.bulk_stiffness, HERE, radius=1000.0, spacing=scene.bodies.spacing,
        neighbour_stiffness=scene.neighbours.stiffness,
    )  # fmt: skip
    places = np.linspace(0.1, 0.36, 27)  # thirty standard deviations to either side
    mean, deviation = displacement_under(model, 1.0, scene.noise.temperature, places)
    found = finished.results.displacement
    assert mean == pytest.approx(SHIPPED, abs=1e-6)
    assert abs(found.value - mean) <= min(3.0 * found.uncertainty, 1.3e-3)  # four standard errors
    assert finished.warnings == {}
    swings(finished, deviation)


def boltzmann(places: Array) -> Array:
    d, energy = detachment.free_energy(HOT)
    return np.asarray(np.interp(places, d, np.gradient(energy, d)))


def test_a_path_has_at_each_place_the_mean_of_boltzmanns_weight(tmp_path: Path) -> None:
    """And the largest tension is that of the free energy and not of rest; the folder can be read and drawn."""
    scene = detachment.scene(1e-3, 1).with_(
        {"experiment": {"kind": "path", "displacements": list(PLACES)}, "damping.coefficient": 0.3}, without="plate"
    )
    heated = run(scene, tmp_path / "run")
    d, force, error = np.loadtxt(heated.folder / "means.csv", delimiter=",", skiprows=1).T
    assert d.tolist() == pytest.approx(PLACES, abs=1e-12)
    assert np.all(np.abs(force - boltzmann(d)) < SIGMAS * error)
    assert np.all(error < 0.02)
    again = load_run(heated.folder)
    assert force.tolist() == heated.curve.force.tolist() == again.curve.force.tolist()
    assert (heated.folder / "force_displacement.png").is_file()
    assert "tolerance" not in again.warnings
    found = heated.results.adhesion_force
    fine = np.linspace(max(PLACES), min(PLACES), 2000)
    for tension in (-boltzmann(fine).min(), detachment.largest()[0]):
        assert found.value == pytest.approx(tension, abs=2.0 * found.uncertainty)
    still = run(scene.with_(without="noise"))
    resting = largest_tension(still.curve.displacement.tolist(), still.curve.force.tolist()).smooth
    assert resting - found.value > TELLS / 2.0 * found.uncertainty


@pytest.mark.parametrize(("rate", "pulls"), [pytest.param(3e-4, REPEATS, marks=pytest.mark.slow), (1e-2, 10)])
def test_the_detachment_force_is_that_of_smoluchowskis_equation(rate: float, pulls: int) -> None:
    found = run(detachment.scene(rate, pulls))
    mean, spread = detachment.expected(rate)
    results, forces = found.results, found.detachments["force"]
    assert results.detachment_force.value == pytest.approx(mean, abs=SIGMAS * spread / np.sqrt(pulls))
    assert results.detachment_force_spread.value == pytest.approx(spread, rel=SIGMAS / np.sqrt(2 * pulls))
    assert results.detachment_force.value == pytest.approx(forces.mean())
    assert len(set(forces.tolist())) > pulls // 2
    samples, held = found.tables["samples"], found.profiles["last_held"]
    last = np.flatnonzero(-samples["load"] < forces[0])[-1]
    assert found.scene.bodies.spacing * held.pressure.sum() == pytest.approx(samples["force"][last])
    assert samples["displacement"][last] > detachment.barrier() > samples["displacement"][last + 1]


@pytest.mark.slow
def test_a_spring_drawn_off_at_a_velocity_lets_go_as_smoluchowskis_equation_says() -> None:
    """The density of the plate under the spring's force, whose far end begins where it is slack, F = 0 before."""
    drawn = {"kind": "pull_off", "preload": 0.1, "velocity": 2e-3, "stiffness": 0.5, "repeats": REPEATS}
    found = run(detachment.scene(1e-3, REPEATS).with_({"experiment": drawn})).results
    d, energy = detachment.free_energy()
    drag = drag_of_pairs(d, energy, detachment.PAIRS, detachment.STIFFNESS, detachment.DRAG)
    cold, resting = detachment.free_energy(detachment.COLD)
    slack = float(cold[resting.argmin()])
    mean, spread = detachment_in_time(
        d, energy, drag, detachment.TEMPERATURE, 0.5 * 2e-3, detachment.barrier(), 0.5, slack
    )
    assert found["detachment_force"].value == pytest.approx(mean, abs=SIGMAS * spread / np.sqrt(REPEATS))
    assert found["detachment_force_spread"].value == pytest.approx(spread, rel=SIGMAS / np.sqrt(2 * REPEATS))
