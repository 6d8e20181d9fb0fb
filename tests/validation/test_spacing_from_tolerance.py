"""Claim: where nobody gave a spacing it follows from the tolerance: contacts described in SI keep 1e-2 to 1e-4.

References: Galin's closed forms of z = c rⁿ, and with adhesion those of Maugis and Barquins. Scenes have a spacing that
somebody gave; of these `contact1d stability --only friction` counts what is off and not told.
"""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from contact1d import run
from contact1d.analysis.reference.adhesive_power import AdhesivePower
from contact1d.analysis.reference.sneddon import PowerLaw
from contact1d.workflow.identify.choice import chosen
from contact1d.workflow.identify.contact import read_contact
from contact1d.workflow.stability.claims import Tally

CONTACTS, SEED = 20, 7
MODULUS = 50e9
ROUND_OFF = 1e-12
TOLD = 0.2
"""Share of the numbers beyond the tolerance by a claim that names them; measured 0.05. The spacing is chosen by sums,
before rows are known; none may be beyond it without a word."""


def drawn(rng: np.random.Generator) -> tuple[str, dict[str, Any], dict[str, float]]:
    """A kind, a contact in SI, and its results by closed forms."""
    exponent, radius = float(rng.choice([1.0, 2.0, 4.0])), float(10.0 ** rng.uniform(-6.0, -3.0))
    law = PowerLaw(float(10.0 ** rng.uniform(-3.0, -1.5)) * radius ** (1.0 - exponent), exponent, MODULUS)
    profile: dict[str, Any] = {"kind": "power", "height": law.coefficient * radius**exponent, "radius": radius}
    profile["exponent"] = exponent
    if exponent == 1.0:
        profile = {"kind": "cone", "slope": law.coefficient}
    elif exponent == 2.0:
        profile = {"kind": "parabola", "radius": 0.5 / law.coefficient}
    contact = {"profile": profile, "contact_modulus": MODULUS, "tolerance": float(10.0 ** rng.uniform(-4.0, -2.0))}
    if rng.random() < 0.5:
        exact = {"displacement": float(law.displacement(radius)), "contact_radius": radius}
        return "pressed", contact | {"load": float(law.force(radius))}, exact
    body = AdhesivePower.with_zero_load_radius(law.coefficient, exponent, MODULUS, radius)
    exact = {
        "adhesion_force": body.pull_off_force(),
        "critical_radius": body.critical_radius(),
        "zero_load_radius": body.zero_load_radius(),
    }
    return "adhesive", contact | {"work_of_adhesion": body.work_of_adhesion, "range": 1e-15}, exact


def test_contacts_in_si_keep_the_tolerance_that_was_asked_for(tmp_path: Path) -> None:
    rng, tally = np.random.default_rng(SEED), Tally()
    for number in range(CONTACTS):
        kind, contact, exact = drawn(rng)
        scene = chosen(read_contact(contact)).scene
        assert scene.material is not None
        length, force = scene.material.length_unit, scene.material.force_unit
        assert length is not None
        assert force is not None
        exact = {name: value / (force if name == "adhesion_force" else length) for name, value in exact.items()}
        tally.add(str(number), kind, run(scene, tmp_path / str(number), figures=False), exact, ROUND_OFF)
    assert tally.scenes["pressed"] > 5
    assert tally.scenes["adhesive"] > 5
    assert not [error for error in tally.errors if error.over_tolerance > 1.0 and not error.told]
    assert not [error for error in tally.errors if error.over_claim > 1.0]
    assert sum(error.told for error in tally.errors) <= TOLD * len(tally.errors)


@pytest.mark.parametrize(("tolerance", "fewest"), [(1e-2, 30), (1e-3, 30), (1e-4, 80), (1e-5, 250)])
def test_a_smaller_tolerance_takes_more_particles_by_the_square_root(tolerance: float, fewest: int) -> None:
    choice = chosen(read_contact({"radius": "5 um", "contact_modulus": "40 GPa", "work_of_adhesion": 0.1,
                                  "tolerance": tolerance}))  # fmt: skip
    assert choice.scene.material is not None
    assert choice.scene.material.length_unit is not None
    count = choice.contact_radius / choice.scene.material.length_unit
    assert fewest <= count <= max(30.0, 1.3 * 90.0 * math.sqrt(1e-4 / tolerance)) + 1.0
