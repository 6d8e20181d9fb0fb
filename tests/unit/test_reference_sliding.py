"""Claim: the references of friction, with and without heat, and of detachment under heat agree with closed forms.

One particle of a flat chain is Prandtl's and Tomlinson's; of many, each slides over wells at a common height.
"""

import math

import numpy as np
import pytest

from validation.references.detachment import detachment, detachment_in_time, garg
from validation.references.flat_chain import FlatChain
from validation.references.langevin_ensemble import PulledParticle, ensemble_friction
from validation.references.prandtl_tomlinson import Corrugation, corrugation, slow_friction
from validation.references.thermal_friction import free_corrugation, textbook_friction, thermal_friction

LAW, LOAD = (1.0, 0.5, 0.5, 1.0), 0.2
WELLS = corrugation(LAW, 1.0, LOAD)
BARRIER = 2.0 * float(np.abs(WELLS.coefficients).max())
SPRING, DRAG = 0.5 * WELLS.steepest, 1.0
FLAT = Corrugation(1.0, np.zeros(1))


def test_one_particle_is_that_of_prandtl_and_tomlinson() -> None:
    """A particle: places at which its slip is looked for."""
    assert FlatChain(LAW, 1.0, 1, 1, LOAD, 1.0, 0.06).friction() == pytest.approx(slow_friction(WELLS, 0.06), rel=1e-3)


def test_a_sinusoid_has_the_friction_of_its_ratio() -> None:
    """⟨F⟩/F_max = 0.2015 and 0.5710 at η = 2 and 5, 0 at 1."""
    wave = Corrugation(1.0, np.asarray([0.1]))
    found = [slow_friction(wave, wave.steepest / eta) / wave.largest_force for eta in (1.0, 2.0, 5.0)]
    assert found == pytest.approx([0.0, 0.2015, 0.5710], abs=1e-4)


@pytest.mark.parametrize("velocity", [0.5, 8.0])
def test_a_weak_corrugation_drags_as_perturbation_theory_says(velocity: float) -> None:
    """⟨F⟩ = (A²q³/2γ) ∫ sin(qvt) exp[−kt/γ − q² (kT/k)(1 − e^{−kt/γ})] dt of A cos(qx), A ≪ kT: off by (A/kT)²."""
    height, temperature, q = 0.02, 0.2, 2.0 * math.pi
    spring = temperature * q**2 / 4.0
    wave = Corrugation(1.0, np.asarray([height]))
    found = thermal_friction(wave, FLAT, spring, 1.0, temperature, velocity, places=96)
    t = np.linspace(0.0, 20.0 / spring, 40_001)
    forgets = np.exp(-spring * t)
    weight = forgets * np.exp(-(q**2) * temperature / spring * (1.0 - forgets))
    expected = 0.5 * (height * q) ** 2 * q * float(np.trapezoid(np.sin(q * velocity * t) * weight, t))
    assert found == pytest.approx(expected, rel=1e-2)


def test_without_heat_the_free_energy_is_the_corrugation() -> None:
    cold, heights = free_corrugation(LAW, 1.0, LOAD, 2e-5)
    assert cold.coefficients[:3] == pytest.approx(WELLS.coefficients[:3], rel=5e-3)
    hollow, top = heights.energy(np.asarray([0.5, 0.0]))
    assert top - hollow == pytest.approx(2.0 * WELLS.heights[1], rel=5e-2)


@pytest.mark.slow
def test_the_ensemble_agrees_with_smoluchowski_where_both_hold() -> None:
    """At half the temperature friction would be twelve standard errors larger."""
    temperature, velocity, mass = 0.4 * BARRIER, 1e-2, 0.2
    wells, heights = free_corrugation(LAW, 1.0, LOAD, temperature)
    expected = thermal_friction(wells, heights, SPRING, DRAG, temperature, velocity, mass)
    fine = thermal_friction(wells, heights, SPRING, DRAG, temperature, velocity, mass, finer=8)
    body = PulledParticle(LAW, 1.0, LOAD, 40.0 * SPRING, SPRING / (1.0 - 1.0 / 40.0), mass, 0.1, DRAG, temperature)
    mean, error = ensemble_friction(body, velocity, copies=450, periods=4, time_step=0.1, seed=2)
    assert fine == pytest.approx(expected, rel=2e-3)
    assert mean == pytest.approx(expected, abs=4.0 * error + 0.02 * expected)
    assert error < 0.03 * expected
    assert math.isnan(textbook_friction(WELLS, SPRING, DRAG, temperature, 9.0))


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
    given = d[::4], -energy[::-4], 1.0, 0.02, 1e-3
    slow, in_time = detachment(*given, 0.5), detachment_in_time(*given, -1.0)
    assert in_time[0] == pytest.approx(slow[0], rel=1e-2)
    assert in_time[1] == pytest.approx(slow[1], rel=0.1)
