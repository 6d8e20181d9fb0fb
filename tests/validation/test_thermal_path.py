"""Claim: a path under heat has at each place the mean force of Boltzmann's weight, within its own standard error.

Nine pairs too far apart to feel each other: ⟨F⟩(d) = A′(d) of the free energy by quadrature, at any temperature.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from contact1d import Run, load_run, read_scene, run
from contact1d.analysis.curve_marks import largest_tension
from validation.paper import detachment

SIGMAS = 4.0
"""Standard errors: one row in 16 000 would fail by chance, and the seed is fixed."""
TELLS = 5.0
"""What heat takes from the largest tension, over its uncertainty: a run that could not tell it from none is no test."""
HOT = 5e-3
"""k_BT [FU·LU]: a tenth of what it takes to part a pair."""
PLACES = (0.1, 0.0, -0.1, -0.15, -0.2, -0.25, -0.3, -0.5)


@pytest.fixture(scope="module")
def heated(tmp_path_factory: pytest.TempPathFactory) -> Run:
    scene = detachment.scene(1e-3, 1).with_(
        {"experiment": {"kind": "path", "displacements": list(PLACES)}, "damping.coefficient": 0.3}, without="plate"
    )
    return run(scene, tmp_path_factory.mktemp("path") / "run")


def boltzmann(places: np.ndarray) -> np.ndarray:
    d, energy = detachment.free_energy(HOT)
    return np.asarray(np.interp(places, d, np.gradient(energy, d)))


def test_each_row_is_the_mean_of_boltzmanns_weight(heated: Run) -> None:
    rows = np.loadtxt(heated.folder / "means.csv", delimiter=",", skiprows=1)
    d, force, error = rows.T
    assert d.tolist() == pytest.approx(PLACES, abs=1e-12)
    assert force.tolist() == heated.curve.force.tolist()
    assert np.all(np.abs(force - boltzmann(d)) < SIGMAS * error)
    assert np.all(error < 0.02)


def test_the_largest_tension_is_that_of_the_free_energy_and_not_of_rest(heated: Run) -> None:
    found = heated.results["adhesion_force"]
    fine = np.linspace(max(PLACES), min(PLACES), 2000)
    assert found.value == pytest.approx(-boltzmann(fine).min(), abs=2.0 * found.uncertainty)
    assert found.value == pytest.approx(detachment.largest()[0], abs=2.0 * found.uncertainty)
    still = run(heated.scene.with_(without="noise"), heated.folder.parent / "still", figures=False)
    tension = largest_tension(still.curve.displacement.tolist(), still.curve.force.tolist()).smooth
    assert tension - found.value > TELLS / 2.0 * found.uncertainty


def test_the_folder_can_be_read_and_drawn(heated: Run) -> None:
    again = load_run(heated.folder)
    assert again.curve.force.tolist() == heated.curve.force.tolist()
    assert (heated.folder / "force_displacement.png").is_file()
    assert "tolerance" not in again.warnings


def test_the_same_places_there_and_back_are_the_same(tmp_path: Path) -> None:
    """Without pairs that snap nothing is lost on the way, within what the means are known to."""
    scene = read_scene({
        "title": "there and back under heat",
        "bodies": {
            "particles": 5, "spacing": 3.0, "profile": {"kind": "flat_punch", "radius": 7.5}, "bulk_stiffness": 2.0,
            "reduction": "geike_popov", "mass": 0.02,
        },
        "interaction": {
            "repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26},
        },
        "damping": {"coefficient": 0.3},
        "noise": {"temperature": HOT, "seed": 4},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "path", "displacements": {"from": 0.05, "to": -0.2, "steps": 2}},
    })  # fmt: skip
    lost = run(scene, tmp_path / "run", figures=False).results["dissipated_energy"]
    assert abs(lost.value) <= 2.0 * lost.uncertainty
