"""Approach and retraction of a curve, fitted together and each alone, and the parameters in which they differ.

Two fits have estimates k₁, k₂ of the parameters and s₁, s₂ of the calibrated numbers, which are the same for both. With
the covariances C of each and the precision Λ₀ of the calibration, which both fits use, the calibrated numbers are

    s = Λ⁻¹ (Λ₁ s₁ + Λ₂ s₂ − Λ₀ s₀),    Λ = Λ₁ + Λ₂ − Λ₀,    Λᵢ = (Cᵢ)ₛₛ⁻¹

and the parameters at that s are kᵢ + Gᵢ (s − sᵢ), G = Cₖₛ Cₛₛ⁻¹, with the covariance Cₖₖ − G Cₛₖ.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve
from contact1d.workflow.fit.data import DataError
from contact1d.workflow.fit.forward import ContactModel
from contact1d.workflow.fit.plan import FitPlan
from contact1d.workflow.fit.search import LEVEL
from contact1d.workflow.fit.solution import SURE, Fitted, UndeterminedError, checked, fitted, solution_of
from contact1d.workflow.fit.subject import POINT

Array = NDArray[np.float64]
BOTH = "both"
BAD = 3.0
"""Reduced χ² above which a contact model does not describe a curve. That of the right model is below 2 where the noise
has a memory of 20 in 1000 points."""
Estimated = tuple[float, tuple[float, float]]
"""A value, and the ends of its 95 % interval, in SI."""


@dataclass(frozen=True)
class CurveFit:
    """The fits of a contact model to a curve.

    Attributes:
        curve: the whole curve.
        fits: by what is fitted: "both" segments together, unless they differ; "approach" and "retract" alone.
        differing: names of the parameters, or of the contact point, in which the segments differ.
        refused: why a segment alone has no fit, by its name.
    """

    curve: ForceCurve
    fits: Mapping[str, Fitted]
    differing: tuple[str, ...] = ()
    refused: Mapping[str, str] = field(default_factory=dict)

    @property
    def main(self) -> Fitted:
        """The fit of both segments, else that of the only segment, else that of the retraction if the bodies adhere.

        Without adhesion it is that of the approach.
        """
        if BOTH in self.fits or len(self.fits) == 1:
            return self.fits[BOTH] if BOTH in self.fits else next(iter(self.fits.values()))
        adheres = next(iter(self.fits.values())).subject.model.needs
        return self.fits[RETRACT if adheres else APPROACH]

    @property
    def only_described(self) -> str:
        """The name of the one segment of two that the model describes; "" if it describes both, or there is one."""
        alone = BOTH not in self.fits and len(self.fits) < len(self.curve.segments)
        return next(iter(self.fits)) if alone else ""

    @property
    def shown(self) -> list[Fitted]:
        """The fits that describe the points of the curve, each point once: of both segments, or of each alone."""
        return [self.fits[BOTH]] if BOTH in self.fits else [*self.fits.values()]

    @cached_property
    def estimates(self) -> dict[str, Estimated | None]:
        """The values of parameters and contact point with their 95 % intervals; None where the segments differ; cached.

        Where they agree in one number and differ in another, that one is the mean of both segments, weighted with the
        squares of the inverse intervals, and its interval the mean of their intervals: they share the calibrations.
        """
        shown = self.shown
        estimates: dict[str, Estimated | None] = {}
        for name in shown[0].intervals:
            if name in self.differing:
                estimates[name] = None
                continue
            rows = np.array([(fit.values[name], *fit.intervals[name]) for fit in shown])
            widths = rows[:, 2] - rows[:, 1]
            weights = 1.0 / widths**2 if np.isfinite(widths).all() else np.ones(len(rows))
            value, low, high = (weights @ rows / weights.sum()).tolist()
            estimates[name] = value, (low, high)
        return estimates


def fit_curve(plan: FitPlan, curve: ForceCurve, model: ContactModel) -> CurveFit:
    """Fit a contact model to the segments of a curve, and return the fits.

    A curve with approach and retraction is fitted as a whole and by each segment alone. Where these differ by more than
    chance, and where the model describes one of them alone, there is no fit of the whole. Of bodies that relax there is
    that of the whole only, with the hold, which is left out otherwise.

    Raises:
        DataError: the bodies relax, and the curve has no times.
        UndeterminedError: the curve does not determine the parameters.
    """
    relaxes = plan.base.viscoelasticity is not None
    if relaxes and curve.times is None:
        raise DataError("has no column t with a unit, such as t [s], which a fit with [viscoelasticity] needs")
    curve = curve if relaxes else curve.only(APPROACH, RETRACT)
    if relaxes or len(curve.segments) == 1:
        whole = BOTH if len(curve.segments) > 1 else curve.segments[0].name
        return CurveFit(curve, {whole: fitted(plan, curve, model)})
    together, reason = None, None
    try:
        together = solution_of(plan, curve, model)
    except UndeterminedError as error:  # of a model that describes each segment, but not both
        reason = error
    is_good = together is not None and together.misfit <= BAD
    alone, refused = dict[str, Fitted](), dict[str, str]()
    for segment in curve.segments:
        part, approach = curve.only(segment.name), alone.get(APPROACH)
        try:
            fit = solution_of(plan, part, model, together if is_good else None, approach)
            fit = solution_of(plan, part, model, None, approach) if is_good and fit.misfit > BAD else fit
            alone[segment.name] = checked(fit, by_profile=False)
        except (Contact1dError, ArithmeticError, np.linalg.LinAlgError) as error:
            refused[segment.name] = str(error)
    if not refused and differing(alone[APPROACH], alone[RETRACT]):  # perhaps by skewed intervals
        alone = {name: checked(fit) for name, fit in alone.items()}
        if names := differing(alone[APPROACH], alone[RETRACT]):
            return CurveFit(curve, alone, names)
    good = {name: checked(fit) for name, fit in alone.items() if not is_good and fit.misfit <= BAD}
    if len(good) == 1:
        return CurveFit(curve, good, (), refused)
    if together is None:
        assert reason is not None
        raise reason
    return CurveFit(curve, {BOTH: checked(together), **alone}, (), refused)


def differing(approach: Fitted, retraction: Fitted) -> tuple[str, ...]:
    """Return the names of the parameters, and of the contact point, that differ between two fits by more than chance.

    The probability of a larger difference is below 0.1 % for each, if it is only due to noise. Calibrated numbers, such
    as the stiffness of the cantilever, are the same for both.
    """
    fits = (approach, retraction)
    names = [name for name in approach.intervals if name in retraction.intervals]
    shared = [unknown.name for unknown in approach.subject.unknowns if unknown.known and unknown.name != POINT]
    estimates = [_conditional(fit, names, shared) for fit in fits]
    calibration = [unknown for unknown in approach.subject.unknowns if unknown.name in shared]
    exact = np.array([math.log(unknown.known[0] / unknown.scale) for unknown in calibration if unknown.known])
    precision = np.diag([(unknown.known[0] / unknown.known[1]) ** 2 for unknown in calibration if unknown.known])
    total = sum((estimate.precision for estimate in estimates), -precision)
    weighted = (estimate.precision @ estimate.shared for estimate in estimates)
    calibrated = np.linalg.solve(total, sum(weighted, -precision @ exact))
    first, second = (estimate.values + estimate.slopes @ (calibrated - estimate.shared) for estimate in estimates)
    slopes = estimates[0].slopes - estimates[1].slopes
    sides = np.where(first > second, 0, 1)
    variance = ndtri(0.5 + 0.5 * SURE) ** 2 * np.diag(slopes @ np.linalg.solve(total, slopes.T))
    for estimate, side in zip(estimates, (sides, 1 - sides), strict=True):
        variance += estimate.tails[side, np.arange(len(names))] ** 2 * np.diag(estimate.covariance)
    apart = np.abs(first - second) > np.sqrt(variance)
    return tuple(name for name, is_apart in zip(names, apart, strict=True) if is_apart)


@dataclass(frozen=True)
class _Conditional:
    """Estimates of n parameters of a fit as functions of m calibrated numbers.

    Attributes:
        values: of the parameters, logarithms over their first guess, and the contact point [m], (n,).
        shared: of the calibrated numbers, logarithms over their first guess, (m,).
        slopes: derivatives of the former by the latter, (n, m).
        covariance: of the parameters at given calibrated numbers, (n, n).
        precision: inverse covariance of the calibrated numbers, (m, m).
        tails: lower and upper half-widths of the intervals of the parameters at 99.9 % over their standard deviations,
            (2, n).
    """

    values: Array
    shared: Array
    slopes: Array
    covariance: Array
    precision: Array
    tails: Array


def _conditional(fit: Fitted, names: list[str], shared: list[str]) -> _Conditional:
    """Return the estimates of parameters of a fit by calibrated numbers, averaged over all noises.

    Args:
        fit: the fit.
        names: of the parameters, or the contact point.
        shared: names of the calibrated numbers.
    """
    unknowns = fit.subject.unknowns
    size = np.array([1.0 if unknown.positive else unknown.scale for unknown in unknowns])
    index = [fit.subject.names.index(name) for name in (*names, *shared)]
    average = fit.solution.average
    weights = np.array([estimate.weight for estimate in average.estimates])
    steps = np.array([estimate.step for estimate in average.estimates])
    off = steps - weights @ steps
    covariance = np.einsum("k,kij->ij", weights, [estimate.covariance for estimate in average.estimates])
    covariance = (covariance + off.T @ (weights[:, None] * off)) * np.outer(size, size)
    C, u, n = covariance[np.ix_(index, index)], (fit.solution.u * size)[index], len(names)
    precision = np.linalg.inv(C[n:, n:])
    slopes = C[:n, n:] @ precision
    spread = np.sqrt(np.diag(C)[:n])
    tails = np.empty((2, n))
    for side, sign in enumerate((-1.0, 1.0)):
        for i, name in enumerate(names):
            # Student's distributions over noises of unknown memory have longer tails than the normal one; the profile
            # likelihood has its own half-width, and may be skewed.
            quantiles = [abs(average.quantile(index[i], 0.5 * (1.0 + sign * level))) for level in (SURE, LEVEL)]
            end = unknowns[index[i]].inverse(fit.intervals[name][side])
            reach = max(quantiles[1], abs(end - fit.solution.u[index[i]]))
            tails[side, i] = quantiles[0] / quantiles[1] * reach * size[index[i]] / spread[i]
    return _Conditional(u[:n], u[n:], slopes, C[:n, :n] - slopes @ C[n:, :n], precision, tails)
