"""The work of adhesion that an interaction implies: against quadrature of the law, and JKR's where the law is JKR's."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from contact1d import Scene, read_scene
from contact1d.workflow.body.derived import formulas, implied
from contact1d.workflow.identify import estimated, jkr_target, material_scene
from contact1d.workflow.model.settings import settings_for
from contact1d.workflow.units import Quantity
from tests.scenes import chains

TRAPEZOID = 1e-4
"""Relative: the estimate's grid has 4000 steps to the cutoff."""
ROUND_OFF = 1e-12
JKR_SHARE = 0.08
"""Of W: JKR's body has one W at all radii, the chain one at a₀; measured 2 to 7 % for three."""
LAW = (0.4, 0.25, 0.2, 0.5)


def scene_of(**bodies: Any) -> Scene:
    return read_scene(chains(200.0, law=LAW, bodies=bodies, experiment={"kind": "pull_off", "preload": 0.5}))


def row_work(spacing: float) -> float:
    """∫ −f dr from the force-free distance on, f that of a row of opposite particles, by quadrature of the law."""
    A, a, B, b = LAW

    def force(r: float) -> float:
        distances = np.hypot(r, spacing * np.arange(-40, 41))
        pair = A / a * np.exp(-distances / a) - B / b * np.exp(-distances / b)
        return float(np.sum(pair * r / distances))

    rest = brentq(force, 0.05, 2.0)
    return -quad(force, rest, 40.0, epsabs=1e-13, limit=400)[0]


@pytest.mark.parametrize("spacing", [0.5, 1.0, 3.0])
def test_separation_energy_is_the_work_to_part_a_row_over_the_spacing(spacing: float) -> None:
    scene = scene_of(spacing=spacing)
    found = implied(scene, settings_for(scene), {})
    assert set(found) == {"separation_energy"}  # without a radius there is no W
    energy = found["separation_energy"]
    assert energy.value == pytest.approx(row_work(spacing) / spacing, rel=TRAPEZOID)
    assert abs(energy.value - row_work(spacing) / spacing) <= 2.0 * energy.uncertainty
    assert energy.unit == "FU"


@pytest.mark.parametrize(("reduction", "share"), [("mdr", 1.0), ("geike_popov", 4.0)])
def test_work_of_adhesion_is_that_of_the_ring_at_the_edge(reduction: str, share: float) -> None:
    scene = scene_of(reduction=reduction)
    settings, a = settings_for(scene), 20.0
    found = implied(scene, settings, {"zero_load_radius": Quantity(a, 0.0, "LU")})
    line, work = found["separation_energy"].value, found["work_of_adhesion"]
    assert work.value == pytest.approx(share * line / (math.pi * a), rel=ROUND_OFF)
    assert work.unit == "FU/LU"
    assert set(formulas(scene, found)["formulas"]) == set(found)


@pytest.mark.parametrize(("modulus", "energy", "radius"), [(200e9, 1.0, 6.1e-6), (37e9, 0.05, 5e-6), (1e6, 0.03, 1e-3)])
def test_law_that_has_jkrs_force_and_radius_has_its_work_too(modulus: float, energy: float, radius: float) -> None:
    """Found by F_A and a₀ alone; W = 2γ was not told."""
    scene, wanted = material_scene(modulus, radius, jkr_target(modulus, energy, radius), tolerance=1e-3)
    scene = estimated(scene, wanted)
    known = {
        "zero_load_radius": Quantity(wanted.zero_load_radius, 0.0, "LU"),
        "adhesion_force": Quantity(wanted.adhesion_force, 0.0, "FU"),
    }
    work = implied(scene, settings_for(scene), known)["work_of_adhesion"]
    assert scene.material is not None
    assert scene.material.length_unit is not None
    assert scene.material.force_unit is not None
    in_si = scene.material.force_unit / scene.material.length_unit
    assert work.value * in_si == pytest.approx(2.0 * energy, rel=JKR_SHARE)
    assert abs(work.value * in_si - 2.0 * energy) <= work.uncertainty * in_si


def test_nothing_is_implied_without_attraction() -> None:
    data = chains(200.0, law=LAW, experiment={"kind": "load", "force": 0.5})
    del data["interaction"]["attraction"]
    scene = read_scene(data)
    assert implied(scene, settings_for(scene), {"contact_radius": Quantity(20.0, 0.0, "LU")}) == {}
    assert formulas(scene, {}) == {}


def test_uncertainty_reaches_what_the_force_says() -> None:
    scene = scene_of(reduction="mdr")
    tension = 0.3
    known = {"zero_load_radius": Quantity(20.0, 0.0, "LU"), "adhesion_force": Quantity(tension, 0.0, "FU")}
    work = implied(scene, settings_for(scene), known)["work_of_adhesion"]
    assert abs(work.value - tension / (1.5 * math.pi * 200.0)) <= work.uncertainty
