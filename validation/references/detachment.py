"""Detachment under heat and a growing pull, by Smoluchowski's equation: no dynamics, no fluctuations.

A plate with the drag Γ feels at the displacement d the free energy A(d) of its pairs and a tension F = Ḟ t. Overdamped,
it leaves its well after the mean time

    τ(F) = (Γ/kT) ∫ dy exp(U(y)/kT) ∫_{-∞}^{y} exp(−U(y′)/kT) dy′,    U(y) = A(−y) − F y

over y = −d from the well to well beyond the barrier; S′(F) = −S/(τ Ḟ), and ⟨F⟩ = ∫ S dF (Hänggi and others 1990).
Where the load grows while the plate leaves its well, the density itself is followed in time,

    ∂p/∂t = ∂/∂y [ U′(y, t) p + kT ∂p/∂y ]/Γ,    S = ∫ p h dy,

h(y, t) the chance to be on the near side of the barrier then or at any later time, by the equation backward in time.

Garg's closed form (1995) takes the barrier as ΔE₀ (1 − F/F_A)^{3/2}, the form next to the fold, for all of it.
"""

import math

import numpy as np
from scipy.linalg import solve_banded

from validation.references.numerics import Floats, Pair

TENSIONS = 300
SMALL = 1e-5
"""Difference of an energy over kT below which B(x) is its series."""
GONE, MOST_STEPS = 1e-6, 30_000
"""Share of the density that counts as none, and steps of the load after which it is not waited for."""


def drag_of_pairs(displacement: Floats, free_energy: Floats, pairs: int, stiffness: float, drag: float) -> Floats:
    """Γ(d) = N γ [(1 − c)² + c²] [FU·TU/LU] of N opposite pairs, by what either particle moves where the plate does.

    c = A″/(N k): half of the way goes to the lower particle where both stand on each other, nothing where they are
    apart. A [FU·LU] at even places d [LU], k [FU/LU] of each spring, γ [FU·TU/LU] of each particle.
    """
    lower = np.gradient(np.gradient(free_energy, displacement), displacement) / (pairs * stiffness)
    return pairs * drag * ((1.0 - lower) ** 2 + lower**2)


def escape_time(place: Floats, energy: Floats, barrier: int, drag: float, temperature: float) -> float:
    """τ [TU] from the deepest of the first `barrier` places of the energy U [FU·LU] to the last place y [LU]."""
    step = place[1] - place[0]
    u = (energy - energy.min()) / temperature
    inner = np.cumsum(np.exp(-u)) * step
    start = int(np.argmin(u[:barrier]))
    outer = np.exp(u[start:]) * inner[start:]
    return float(drag / temperature * outer.sum() * step)


def detachment(
    displacement: Floats, free_energy: Floats, drag: float, temperature: float, rate: float, strongest: float
) -> Pair:
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
    rates = np.array([1.0 / escape_time(y, energy - F * y, barrier, drag, temperature) for F in tensions])
    step = tensions[1] - tensions[0]
    survival = np.exp(-np.concatenate([[0.0], np.cumsum(0.5 * (rates[1:] + rates[:-1]))]) * step / rate)
    return _moments(survival, tensions)


def detachment_in_time(
    displacement: Floats,
    free_energy: Floats,
    drag: float | Floats,
    temperature: float,
    rate: float,
    barrier: float,
    spring: float = 0.0,
    end: float = 0.0,
) -> Pair:
    """Mean and standard deviation of the detachment force [FU], by the density of the plate as the load grows.

    It begins as Boltzmann's without load and ends where the places end; the force is that of the last time at the
    barrier. With a spring, whose far end is drawn off, the force is the spring's with the plate there.

    Args:
        displacement: even places d [LU], rising, from well beyond the barrier, out of reach, to behind the well.
        free_energy: A(d) [FU·LU].
        drag: Γ [FU·TU/LU]; one, or one for each place.
        temperature: kT [FU·LU].
        rate: Ḟ [FU/TU]; of a spring k v.
        barrier: d [LU] beyond which the plate has detached.
        spring: k [FU/LU]; 0: a load.
        end: d [LU] at which the spring's far end begins.

    Raises:
        ArithmeticError: the plate stays, or was never held.
    """
    y, energy = -displacement[::-1], free_energy[::-1]
    h, held, middle = y[1] - y[0], y < -barrier, 0.5 * (y[1:] + y[:-1])
    step = np.max(np.gradient(energy, y)) / rate / TENSIONS
    own = np.diff(energy) / h + spring * (middle + end)
    start = energy + 0.5 * spring * (y + end) ** 2
    p = np.where(held, np.exp(-(start - start[held].min()) / temperature), 0.0)
    p /= p.sum()
    drags = np.broadcast_to(drag, y.shape)[::-1]
    share = temperature / (0.5 * (drags[1:] + drags[:-1])) / h**2 * step

    def bands(force: float) -> Floats:
        return implicit(share, h / temperature * (own - force), absorbing=True)

    forces, densities = [0.0], [p]
    while densities[-1][held].sum() > GONE:
        if len(forces) > MOST_STEPS:
            raise ArithmeticError("the plate is not drawn off")
        forces.append(forces[-1] + rate * step)
        p = solve_banded((1, 1), bands(forces[-1]), densities[-1], check_finite=False)
        p[-1] = 0.0
        densities.append(p)
    returns, stays = held.astype(np.float64), []  # chance to be held then or later, by place
    for force, density in zip(reversed(forces), reversed(densities), strict=True):
        stays.append(density @ returns)
        forward = bands(force)
        transposed = np.zeros_like(forward)
        transposed[1], transposed[0, 1:], transposed[2, :-1] = forward[1], forward[2, :-1], forward[0, 1:]
        returns[-1] = 0.0
        returns = np.where(held, 1.0, solve_banded((1, 1), transposed, returns, check_finite=False))
    return _moments(np.array(stays[::-1]), np.array(forces) - spring * (end - barrier))


def _moments(survival: Floats, force: Floats) -> Pair:
    """Mean and standard deviation of the force at which a plate detaches, by the share held at rising forces."""
    mean = force[0] + np.trapezoid(survival, force)
    square = force[0] ** 2 + 2.0 * np.trapezoid(force * survival, force)
    return float(mean), float(np.sqrt(max(square - mean**2, 0.0)))


def implicit(share: Floats, rise: Floats, absorbing: bool = False) -> Floats:
    """Return the implicit step of a density, as `solve_banded` has it: the rows of a matrix beside its diagonal.

    Fluxes as of Scharfetter and Gummel, D Δt/h² [B(Δu) p_i − B(−Δu) p_{i+1}], B(x) = x/(e^x − 1).

    Args:
        share: D Δt/h² from each place to the next.
        rise: Δu from each place to the next, over kT.
        absorbing: whether nothing comes back from the last place.
    """
    small = np.abs(rise) < SMALL
    there = share * np.where(small, 1.0 - 0.5 * rise, rise / np.expm1(np.where(small, 1.0, rise)))
    back = there + share * rise  # B(−x) = B(x) + x
    if absorbing:
        there[-1], back[-1] = 2.0 * share[-1], 0.0
    matrix = np.zeros((3, rise.size + 1))
    matrix[1] = 1.0
    matrix[1, :-1] += there
    matrix[1, 1:] += back
    matrix[0, 1:], matrix[2, :-1] = -back, -there
    return matrix


def garg(strongest: float, bend: float, drag: float, temperature: float, rate: float) -> float:
    """The most likely force [FU] at which a growing load leaves a well, F_A [1 − ((kT/ΔE₀) ln X)^{2/3}].

        ΔE₀ = (4√2/3) F_A^{3/2}/√|F″|,    X = √(2 |F″| F_A)/(2πΓ) · (2/3) F_A (kT/ΔE₀)/Ḟ

    It holds for 1 ≪ ln X ≪ ΔE₀/kT: slow pulls, so that heat causes the detachment, and near the fold. NaN for X < 1.

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
