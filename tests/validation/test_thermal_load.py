"""Claim: a load under noise has the mean and the swing that Boltzmann's weight gives it; they tell its temperature.

References without dynamics: `boltzmann_pairs`, the integral over the distance of each independent pair and the place of
the plate, at any temperature; `thermal_chain`, to first order in the temperature, with neighbours and all pairs. They
share no code and must agree where both hold.

The mean alone tells no temperature where the tolerance is wider than what the noise moves it by: the shipped scene's is
moved by 5e-4 LU. Its swing in time does, ∝ √(k_BT): the variance is compared within its own sample's error.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from contact1d import Run, read_scene, run
from contact1d.workflow.experiments.thermal import RUN_IN_SAMPLES
from tests.scenes import LAW
from tests.validation.test_shipped_scenes import SCENES, THERMAL_PLACES, model_of
from validation.references.boltzmann_pairs import BoltzmannPairs
from validation.references.interaction import Exponential, PairInteraction
from validation.references.model import ChainModel
from validation.references.thermal_chain import displacement_under

Array = NDArray[np.float64]
SIGMAS = 4.0
"""Standard errors: one test in 16 000 would fail by chance, and the seeds are fixed."""
BLOCKS = 20
TELLS = 5.0
"""What noise changes over the standard error: a run that could not tell it from nothing is no test. 8 measured."""
TELLS_SWING = 4.0
"""The same of the variance in time, whose error is a fifth of itself with the few samples of the shipped scene."""
PARTICLES, SPACING, RADIUS, STIFFNESS, FORCE = 41, 4.0, 1000.0, 0.83, 0.25
"""The shipped scene's bodies, so far apart that particles feel their opposite only: then the integral is exact."""
HOT, NEAR, WIDTH = 1e-3, 0.24, 0.13
"""k_BT [FU·LU], ten times the shipped one, and the displacements of the integral [LU]: seven standard deviations."""
COLD, NEXT_ORDER = 2e-5, 0.02
"""k_BT at which the first order is compared with the whole, and by how much of the thermal part they may differ."""
HERE = PairInteraction(Exponential(*LAW[:2]), Exponential(*LAW[2:]))


def exact(temperature: float, width: float = WIDTH) -> tuple[float, float]:
    """Mean and standard deviation of d [LU] by Boltzmann's integral."""
    x = (np.arange(PARTICLES) - 0.5 * (PARTICLES - 1)) * SPACING
    pairs = BoltzmannPairs(HERE, STIFFNESS, x**2 / (2.0 * RADIUS), temperature)
    return pairs.displacement(FORCE, NEAR, width)


def to_first_order(temperature: float, width: float) -> tuple[float, float]:
    model = ChainModel(PARTICLES, STIFFNESS, HERE, radius=RADIUS, spacing=SPACING)
    return displacement_under(model, FORCE, temperature, np.linspace(NEAR - width, NEAR + width, 27))


def swings(finished: Run, deviation: float) -> None:
    """The variance of d in time is that of the reference, and not 0, within the sample's own errors."""
    d = np.asarray(finished.curve.displacement)[RUN_IN_SAMPLES:]
    squares = [float(np.mean((block - d.mean()) ** 2)) for block in np.array_split(d, BLOCKS)]
    error = float(np.std(squares, ddof=1)) / math.sqrt(BLOCKS)
    assert abs(float(np.var(d)) - deviation**2) <= SIGMAS * error
    assert deviation**2 > TELLS_SWING * error


def test_both_references_agree_at_a_low_temperature() -> None:
    rest, _ = to_first_order(1e-3 * COLD, 1e-3)
    one, other = exact(COLD, 0.025), to_first_order(COLD, 0.025)
    assert other[0] - rest == pytest.approx(one[0] - rest, rel=NEXT_ORDER)
    assert other[1] == pytest.approx(one[1], rel=NEXT_ORDER)


def test_the_shipped_scene_has_the_swing_of_its_temperature(tmp_path: Path) -> None:
    """Its mean is held against the same reference in test_shipped_scenes."""
    scene = read_scene(SCENES / "thermal_load.toml")
    assert scene.noise is not None
    _, deviation = displacement_under(model_of(scene), scene.experiment.force, scene.noise.temperature, THERMAL_PLACES)
    swings(run(scene, tmp_path / "run", figures=False), deviation)


@pytest.mark.slow
def test_noise_moves_the_mean_as_boltzmanns_integral_says(tmp_path: Path) -> None:
    changes = (
        f"bodies.particles={PARTICLES}", f"bodies.spacing={SPACING}", f"experiment.force={FORCE}",
        f"noise.temperature={HOT}", "accuracy.tolerance=2e-3",
    )  # fmt: skip
    finished = run(read_scene(SCENES / "thermal_load.toml", changes, ("neighbours",)), tmp_path / "run", figures=False)
    mean, deviation = exact(HOT)
    rest, _ = to_first_order(1e-3 * COLD, 1e-3)
    found = finished.results["displacement"]
    assert abs(found.value - mean) <= SIGMAS * found.uncertainty
    assert abs(mean - rest) > TELLS * found.uncertainty
    swings(finished, deviation)
