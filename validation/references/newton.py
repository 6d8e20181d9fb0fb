"""Damped Newton descent to the minimum that lies downhill: step -(H + lambda 1)^-1 g, never longer than a limit.

H + lambda 1 is made positive definite before it is used, so every step goes downhill, and the limit on the step keeps
it from leaping over a barrier: the descent ends in the basin where a gradient flow would end. A stationary point with
a negative curvature is not accepted but left along its softest direction.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.linalg import LinAlgError, cho_solve_banded, cholesky_banded

from validation.references.interaction import Floats

FIRST_SHIFT = 0.02
"""First trial of lambda over the mean curvature where H is indefinite."""
ALONG_SOFTEST = 0.1
"""Share of the gradient along the softest direction from which on the descent also steps along it."""
SOFTEST_STEP = 0.25
"""Length of such a step over the step limit."""
KICK = 0.01
"""Length over the step limit of the displacement by which a saddle is left."""
SUFFICIENT_DECREASE = 1e-4
"""Share of the linear decrease of the energy that a step must reach (Armijo)."""
SLOPE_BOUND = 0.9
"""Where round-off hides the decrease: how far the slope behind a step may rise, over the slope before it."""
ROUND_OFF = 1e-14
"""Relative uncertainty of the energy of some thousand terms."""
NEAR = 1e-6
"""Newton steps over the step limit below which the gradient alone judges them: energies that nearly cancel are too
coarse to show so small a decrease."""
ITERATIONS = 3000
"""Limit on the number of steps."""
POWER_STEPS = 12
"""Inverse iterations for the softest direction."""


class Descent(NamedTuple):
    """What a descent needs beside the energy.

    Args:
        step_limit: largest change of one degree of freedom in one iteration [LU].
        gradient_tolerance: the descent ends when no component of the gradient exceeds it [FU].
        preferred: direction, shape (dofs,), which picks one of two equal ways down from a saddle.
    """

    step_limit: float
    gradient_tolerance: float
    preferred: Floats


def minimise(
    energy_gradient: Callable[[Floats], tuple[float, Floats]],
    hessian: Callable[[Floats], Floats],
    start: Floats,
    descent: Descent,
) -> Floats:
    """Return the minimum reached downhill from `start`, shape (dofs,) [LU].

    Args:
        energy_gradient: returns U [FU LU] and dU/du, shape (dofs,) [FU].
        hessian: returns d2U/du2 in lower band storage, shape (bandwidth + 1, dofs) [FU/LU].
        start: shape (dofs,) [LU].
        descent: limits, tolerance and the preferred side of a saddle.

    Raises:
        RuntimeError: if the iterations run out or no step goes downhill (an energy that is not finite, for example).
    """
    u = np.array(start, dtype=np.float64)
    energy, gradient = energy_gradient(u)
    for _ in range(ITERATIONS):
        band = hessian(u)
        factor = _factor(band)
        if np.max(np.abs(gradient)) <= descent.gradient_tolerance:
            if factor is not None:
                last = np.asarray(cho_solve_banded((factor, True), gradient))
                return u - last * min(1.0, KICK * descent.step_limit / max(float(np.max(np.abs(last))), 1e-300))
            softest, _ = softest_direction(band, descent.preferred)
            u = u + math.copysign(KICK * descent.step_limit, softest @ descent.preferred) * softest  # off the saddle
            energy, gradient = energy_gradient(u)
            continue
        step = -cho_solve_banded((factor, True), gradient) if factor is not None else _way_down(band, gradient, descent)
        longest = np.max(np.abs(step))
        if factor is not None and longest < NEAR * descent.step_limit:
            new_energy, new_gradient = energy_gradient(u + step)
            if np.linalg.norm(new_gradient) < np.linalg.norm(gradient):
                u, energy, gradient = u + step, new_energy, new_gradient
                continue
        step *= min(1.0, descent.step_limit / longest)
        u, energy, gradient = _search(energy_gradient, u, step, energy, gradient)
    raise RuntimeError(f"no minimum within {ITERATIONS} steps, gradient {np.max(np.abs(gradient)):.3g}")


def softest_direction(band: Floats, first: Floats) -> tuple[Floats, Floats]:
    """Return a direction of (nearly) the lowest curvature and the Cholesky factor of the shifted matrix.

    A few inverse iterations with H + lambda 1, lambda the first of a doubling series that makes it positive definite.

    Args:
        band: symmetric matrix in lower band storage, shape (bandwidth + 1, dofs) [FU/LU].
        first: start of the iteration, shape (dofs,). Where several directions are equally soft it picks their mixture.

    Returns:
        the direction, largest component 1, shape (dofs,), and the factor in lower band storage.
    """
    shift = FIRST_SHIFT * np.mean(np.abs(band[0]))
    shifted = band.copy()
    shifted[0] += shift
    while (factor := _factor(shifted)) is None:
        shift *= 2.0
        shifted[0] = band[0] + shift
    direction = first
    for _ in range(POWER_STEPS):
        direction = cho_solve_banded((factor, True), direction)
        direction = direction / np.max(np.abs(direction))
    return direction, factor


def _factor(band: Floats) -> Floats | None:
    """Return the banded Cholesky factor, or None where the matrix is not positive definite."""
    try:
        return np.asarray(cholesky_banded(band, lower=True, check_finite=True))
    except LinAlgError:
        return None


def _way_down(band: Floats, gradient: Floats, descent: Descent) -> Floats:
    """Return a descent step where H is indefinite: a shifted Newton step, and one along the softest direction.

    The second is taken only where the gradient itself points that way, as it does behind a fold. Where the gradient
    has no share in it (an unstable direction which the flow does not feel yet) the flow would not take it either.
    """
    direction, factor = softest_direction(band, gradient)
    step = -np.asarray(cho_solve_banded((factor, True), gradient))
    unit = direction / np.linalg.norm(direction)
    share = unit @ gradient
    if abs(share) > ALONG_SOFTEST * np.linalg.norm(gradient):
        step *= min(1.0, (1.0 - SOFTEST_STEP) * descent.step_limit / np.max(np.abs(step)))
        step = step - np.sign(share) * SOFTEST_STEP * descent.step_limit * direction
    return step


def _search(
    energy_gradient: Callable[[Floats], tuple[float, Floats]], u: Floats, step: Floats, energy: float, gradient: Floats
) -> tuple[Floats, float, Floats]:
    """Halve the step until the energy falls enough; where round-off hides that, until the slope does not rise."""
    slope = gradient @ step
    hidden = ROUND_OFF * (abs(energy) + np.max(np.abs(u)) * np.max(np.abs(gradient)))
    fraction = 1.0
    while fraction > 1e-15:
        trial = u + fraction * step
        new_energy, new_gradient = energy_gradient(trial)
        change = new_energy - energy
        if change <= SUFFICIENT_DECREASE * fraction * slope:
            return trial, new_energy, new_gradient
        if change <= hidden and new_gradient @ step <= SLOPE_BOUND * abs(slope):
            return trial, new_energy, new_gradient
        fraction *= 0.5
    raise RuntimeError("no step goes downhill: the energy is not finite or not smooth here")
