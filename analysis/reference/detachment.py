"""Detachment under heat and a growing pull, by Smoluchowski's equation: no dynamics, no fluctuations.

A plate with the drag Γ feels at the displacement d the free energy A(d) of its pairs and a tension F = Ḟ t. Overdamped,
it leaves its well after the mean time

    τ(F) = (Γ/kT) ∫ dy exp(U(y)/kT) ∫_{-∞}^{y} exp(−U(y′)/kT) dy′,    U(y) = A(−y) − F y

over y = −d from the well to well beyond the barrier; S′(F) = −S/(τ Ḟ), and ⟨F⟩ = ∫ S dF (Hänggi and others 1990).
Where the load grows while the plate leaves its well, the density itself is followed in time,

    ∂p/∂t = ∂/∂y [ U′(y, t) p + kT ∂p/∂y ]/Γ,    S = share of it that is not beyond the barrier.

Garg's closed form (1995) takes the barrier as ΔE₀ (1 − F/F_A)^{3/2}, the form next to the fold, for all of it.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
TENSIONS = 300


def escape_time(place: Array, energy: Array, barrier: int, drag: float, temperature: float) -> float:
    """τ [TU] from the deepest of the first `barrier` places of the energy U [FU·LU] to the last place y [LU]."""
    step = place[1] - place[0]
    u = (energy - energy.min()) / temperature
    inner = np.cumsum(np.exp(-u)) * step
    start = int(np.argmin(u[:barrier]))
    outer = np.exp(u[start:]) * inner[start:]
    return float(drag / temperature * outer.sum() * step)


def detachment(
    displacement: Array, free_energy: Array, drag: float, temperature: float, rate: float, strongest: float
) -> tuple[float, float]:
    """Mean and standard deviation of the detachment force [FU].

    Args:
        displacement: even places d [LU], rising, from well beyond the barrier, out of reach, to behind the well.
        free_energy: A(d) [FU·LU].
        drag: Γ [FU·TU/LU].
        temperature: kT [FU·LU].
        rate: Ḟ [FU/TU].
        strongest: the largest tension −A′ [FU], beyond which nothing holds.
    """
    tensions = np.linspace(0.0, 1.2 * strongest, TENSIONS)
    y, energy = -displacement[::-1], free_energy[::-1]
    barrier = int(np.argmax(np.gradient(energy, y)))
    rates = np.asarray([1.0 / escape_time(y, energy - F * y, barrier, drag, temperature) for F in tensions])
    step = tensions[1] - tensions[0]
    survival = np.exp(-np.concatenate([[0.0], np.cumsum(0.5 * (rates[1:] + rates[:-1]))]) * step / rate)
    mean = float(np.trapezoid(survival, tensions))
    square = float(2.0 * np.trapezoid(tensions * survival, tensions))
    return mean, float(np.sqrt(max(square - mean**2, 0.0)))


def garg(strongest: float, bend: float, drag: float, temperature: float, rate: float) -> float:
    """The most likely force [FU] at which a growing load leaves a well, F_A [1 − ((kT/ΔE₀) ln X)^{2/3}].

        ΔE₀ = (4√2/3) F_A^{3/2}/√|F″|,    X = √(2 |F″| F_A)/(2πΓ) · (2/3) F_A (kT/ΔE₀)/Ḟ

    It holds for 1 ≪ ln X ≪ ΔE₀/kT: slow pulls, so that it is heat that lets go, and near the fold. NaN for X < 1.

    Args:
        strongest: F_A [FU], the largest force that holds.
        bend: |F″| where it is [FU/LU²].
        drag: Γ [FU·TU/LU].
        temperature: kT [FU·LU].
        rate: Ḟ [FU/TU].
    """
    barrier = 4.0 * math.sqrt(2.0) / 3.0 * strongest**1.5 / math.sqrt(bend)
    attempts = math.sqrt(2.0 * bend * strongest) / (2.0 * math.pi * drag)
    x = attempts * 2.0 / 3.0 * strongest * temperature / barrier / rate
    return strongest * (1.0 - (temperature / barrier * math.log(x)) ** (2.0 / 3.0)) if x >= 1.0 else math.nan
