"""Claim: the references of friction and detachment under heat meet closed forms, and each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from validation.paper import heat
from validation.references.detachment import detachment, garg
from validation.references.langevin_ensemble import ensemble_friction
from validation.references.prandtl_tomlinson import Corrugation, corrugation
from validation.references.thermal_friction import free_corrugation, textbook_friction, thermal_friction

FLAT = Corrugation(1.0, np.zeros(1))
SECOND_ORDER = 1e-2
"""Of ⟨F⟩: (A/kT)², the next order of the corrugation."""
STEPS = 2e-3
"""Of ⟨F⟩: places and timesteps of the density."""
SIGMAS, INERTIA = 4.0, 0.02
"""Standard errors of the ensemble; and what the first order in the mass leaves of ⟨F⟩ there."""


@pytest.mark.parametrize("velocity", [0.5, 8.0])
def test_a_weak_corrugation_drags_as_perturbation_theory_says(velocity: float) -> None:
    """⟨F⟩ = (A²q³/2γ) ∫ sin(qvt) exp[−kt/γ − q² (kT/k)(1 − e^{−kt/γ})] dt of A cos(qx), A ≪ kT."""
    height, drag, temperature, q = 0.02, 1.0, 0.2, 2.0 * math.pi
    spring = temperature * q**2 / 4.0
    wave = Corrugation(1.0, np.asarray([height]))
    found = thermal_friction(wave, FLAT, spring, drag, temperature, velocity, places=128)
    t = np.linspace(0.0, 20.0 * drag / spring, 40_001)
    forgets = np.exp(-spring * t / drag)
    weight = forgets * np.exp(-(q**2) * temperature / spring * (1.0 - forgets))
    expected = (height * q) ** 2 * q / (2.0 * drag) * float(np.trapezoid(np.sin(q * velocity * t) * weight, t))
    assert found == pytest.approx(expected, rel=SECOND_ORDER)


def test_without_heat_the_free_energy_is_the_corrugation() -> None:
    cold, heights = free_corrugation(heat.LAW, heat.SPACING, heat.LOAD, 2e-5)
    wells = corrugation(heat.LAW, heat.SPACING, heat.LOAD)
    assert cold.coefficients[:3] == pytest.approx(wells.coefficients[:3], rel=5e-3)
    assert heights.energy(np.asarray(0.0)) > heights.energy(np.asarray(0.5))


def test_finer_places_and_times_change_nothing() -> None:
    wells, heights = free_corrugation(heat.LAW, heat.SPACING, heat.LOAD, heat.SHARES[0] * heat.BARRIER)
    given = heat.SPRING, heat.DRAG, heat.SHARES[0] * heat.BARRIER, 2e-3
    coarse = thermal_friction(wells, heights, *given)
    assert thermal_friction(wells, heights, *given, places=400) == pytest.approx(coarse, rel=STEPS)
    assert thermal_friction(wells, heights, *given, finer=8) == pytest.approx(coarse, rel=STEPS)


def test_the_ensemble_agrees_with_smoluchowski_where_both_hold() -> None:
    share, velocity = heat.SHARES[1], 2e-2
    mean, error = ensemble_friction(heat.body(share), velocity, copies=200, periods=5, time_step=0.05, seed=2)
    expected = heat.smoluchowski(share, velocity)
    assert mean == pytest.approx(expected, abs=SIGMAS * error + INERTIA * expected)
    assert error < 0.03 * expected


def test_the_textbooks_law_is_the_limit_of_a_vanishing_temperature() -> None:
    """Off by 24 % at kT = 0.05 of the barrier, a third of that at 0.02, and without a value for fast drives."""
    off = []
    for share in (0.05, 0.02):
        wells, heights = free_corrugation(heat.LAW, heat.SPACING, heat.LOAD, share * heat.BARRIER)
        given = heat.SPRING, heat.DRAG, share * heat.BARRIER, 2e-4
        off.append(1.0 - textbook_friction(heat.WELLS, *given) / thermal_friction(wells, heights, *given))
    assert 0.0 < off[1] < 0.5 * off[0]
    assert math.isnan(textbook_friction(heat.WELLS, heat.SPRING, heat.DRAG, heat.SHARES[0] * heat.BARRIER, 0.2))


def test_gargs_form_is_smoluchowskis_for_high_barriers() -> None:
    """Of a cubic well, which is its own form next to the fold: nearer as the barrier grows over kT."""
    d = np.linspace(-3.0, 2.2, 2000)  # A′ = −F_A at d = 0
    energy = -(0.5 * d - d**3 / 6.0 / 2.0)  # −A′ = 1/2 − d²/4: F_A = 1/2, F″ = 1/2, of y = −d
    beyond = d < -2.6
    energy[beyond] = energy[beyond][-1]
    off = []
    for temperature in (0.02, 0.002):
        mean, spread = detachment(d, -energy[::-1], 1.0, temperature, 1e-5, 0.5)
        off.append(abs(garg(0.5, 0.5, 1.0, temperature, 1e-5) - mean))
        assert off[-1] < spread
    assert off[1] < off[0]
