"""A warning comes where its own limit is passed, and what it advises is enough and no more than that."""

import re
from typing import Any

import numpy as np
import pytest

from contact1d import run
from tests.scenes import LAW, chains

TOLERANCE = 1e-3
PLANE = {"lower": "rigid_plane"}


def contact(**bodies: Any) -> dict[str, Any]:
    """A load of 3 FU on two chains, or on one over a plane, whose springs and pairs are the same per length."""
    spacing = bodies.setdefault("spacing", 1.0)
    law = (LAW[0] * spacing, LAW[1], LAW[2] * spacing, LAW[3])
    only = {"interaction": None} if "lower" in bodies else {}
    experiment = {"kind": "load", "force": 3.0}
    return chains(
        200.0, 0.83 * spacing, law, experiment=experiment, accuracy={"tolerance": TOLERANCE}, bodies=bodies, **only
    )


@pytest.mark.parametrize(("spacing", "lower"), [(2.0, {}), (4.0, PLANE)], ids=str)
def test_an_advised_spacing_is_fine_enough_and_not_eight_times_too_fine(spacing: float, lower: dict[str, Any]) -> None:
    def at(spacing: float) -> str:
        return run(contact(spacing=spacing, **lower)).warnings.get("lattice", "")

    said = re.search(r"about ([\d.e-]+) LU", at(spacing))
    assert said is not None
    assert not at(float(said[1]))
    assert at(8.0 * float(said[1]))


def test_no_spacing_is_advised_by_a_result_while_another_is_unknown() -> None:
    """What is known well at 4 LU is known well enough at 2.7; the radius, which is not, needs 0.3."""
    found = run(contact(spacing=4.0)).warnings
    assert "contact_radius" in found["unknown"]
    assert "displacement" in found["lattice"]
    assert "about" not in found["lattice"]


@pytest.mark.parametrize("particles", [59, 62])
def test_a_chain_is_too_short_where_its_ends_carry_more_than_the_tolerance(particles: int) -> None:
    found = run(contact(particles=particles))
    pressure = np.abs(found.profiles["final"].pressure)
    assert ("chain_end" in found.warnings) == (max(pressure[0], pressure[-1]) > TOLERANCE * pressure.max())


@pytest.mark.parametrize(("cutoff", "warns"), [(1.5, True), (6.0, False)])
def test_a_tail_beyond_the_cutoff_that_matters_is_named(cutoff: float, warns: bool) -> None:
    tables = chains(1000.0, experiment={"kind": "load", "force": 1.0})
    tables["interaction"] = tables["interaction"] | {"cutoff": cutoff}
    assert ("cutoff" in run(tables).warnings) is warns
