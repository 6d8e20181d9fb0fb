"""Claim: under heat a contact lets go at the tension that Smoluchowski's equation says, and later if pulled faster.

Nine pairs too far apart to feel each other: the free energy of the plate is nine times that of a pair, by quadrature.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import Run, run
from contact1d.analysis.reference.boltzmann_pairs import BoltzmannPairs
from contact1d.analysis.reference.detachment import detachment
from contact1d.analysis.reference.interaction import Exponential, PairInteraction
from contact1d.workflow.scene import scene_from_dict

PAIRS, STIFFNESS, DRAG, TEMPERATURE = 9, 2.0, 0.5, 5e-3
REPEATS = 16
SIGMAS = 3.5
INERTIA = 0.02
"""Relative: Smoluchowski's equation leaves it out, and the drag here is twice the critical one."""


def pulled(rate: float, folder: Path, **tables: Any) -> Run:
    return run(scene_from_dict({
        "title": "nine pairs",
        "bodies": {
            "particles": "auto", "spacing": 3.0, "profile": {"kind": "flat_punch", "radius": 13.5},
            "bulk_stiffness": STIFFNESS, "reduction": "geike_popov", "mass": 0.02,
        },
        "interaction": {
            "repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26},
        },
        "damping": {"coefficient": DRAG},
        "noise": {"temperature": TEMPERATURE, "seed": 1},
        "plate": {"mass": 0.1},
        "accuracy": {"tolerance": 1e-2},
        "experiment": {"kind": "pull_off", "preload": 0.1, "loading_rate": rate, "repeats": REPEATS},
    } | tables), folder / f"{rate}", figures=False)  # fmt: skip


def expected(rate: float) -> tuple[float, float]:
    law = PairInteraction(Exponential(0.18, 0.13), Exponential(0.09, 0.26))
    pairs = BoltzmannPairs(law, STIFFNESS, np.zeros(1), TEMPERATURE)
    d = np.linspace(-0.75, 0.45, 1400)
    free = -TEMPERATURE * PAIRS * pairs.log_partition(law.force_free_distance() - d)
    return detachment(d, free, PAIRS * DRAG, TEMPERATURE, rate, float(np.max(np.gradient(free, d))))


@pytest.mark.parametrize("rate", [3e-4, 1e-3])
def test_the_detachment_force_is_that_of_smoluchowskis_equation(rate: float, tmp_path: Path) -> None:
    found, (mean, spread) = pulled(rate, tmp_path), expected(rate)
    error = SIGMAS * spread / np.sqrt(REPEATS) + INERTIA * mean
    assert found.results["detachment_force"].value == pytest.approx(mean, abs=error)
    assert found.results["detachment_force_spread"].value == pytest.approx(spread, rel=SIGMAS / np.sqrt(2 * REPEATS))
    rows = (found.folder / "detachments.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0].startswith("seed,force,time")
    assert len(rows) == REPEATS + 1
    forces = np.asarray([float(row.split(",")[1]) for row in rows[1:]])
    assert found.results["detachment_force"].value == pytest.approx(forces.mean())
    assert len(set(forces.tolist())) > REPEATS // 2


def test_a_faster_pull_is_held_longer() -> None:
    means = [expected(rate)[0] for rate in (1e-5, 1e-4, 1e-3)]
    assert means == sorted(means)
