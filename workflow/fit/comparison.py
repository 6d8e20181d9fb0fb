"""Approach and retraction of a curve, fitted together and each alone, and the parameters in which they differ.

Two fits have estimates k₁, k₂ of a parameter, whose difference has the variance

    var(k₁) + var(k₂) − 2 cov(k₁, k₂),    cov(k₁, k₂) = cov(k₁, s) Λ cov(s, k₂)

where s are the calibrated numbers, which both fits share, and Λ is the precision of their calibration.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.special import ndtri

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve
from contact1d.workflow.fit.data import DataError
from contact1d.workflow.fit.determined import UndeterminedError, checked
from contact1d.workflow.fit.fitted import Fitted
from contact1d.workflow.fit.forward import ContactModel
from contact1d.workflow.fit.plan import FitPlan
from contact1d.workflow.fit.search import LEVEL
from contact1d.workflow.fit.solution import SURE, fitted, solution_of
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

    def by_segment(self, name: str) -> dict[str, Estimated]:
        """Return the estimate of a number under "", or those of the segments by their names where these differ."""
        estimate = self.estimates[name]
        if estimate is not None:
            return {"": estimate}
        return {segment: (fit.values[name], fit.intervals[name]) for segment, fit in self.fits.items()}


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

    The probability of a larger difference is below 0.1 % for each, if it is only due to noise. The calibrated numbers,
    such as the stiffness of the cantilever, are the same for both.
    """
    names = [name for name in approach.intervals if name in retraction.intervals]
    calibrations = {unknown.name: unknown.known for unknown in approach.subject.unknowns if unknown.name != POINT}
    exactness = {name: (known[0] / known[1]) ** 2 for name, known in calibrations.items() if known}
    (first, first_tails, first_shared), (second, second_tails, second_shared) = (
        _uncertain(fit, names, list(exactness)) for fit in (approach, retraction)
    )
    (lower, upper), (second_lower, second_upper) = first_tails**2, second_tails**2
    variance = np.where(first > second, lower + second_upper, upper + second_lower)
    common = np.einsum("is,s,is->i", first_shared, np.array([*exactness.values()]), second_shared)
    apart = (first - second) ** 2 > variance - 2.0 * ndtri(0.5 + 0.5 * SURE) ** 2 * common
    return tuple(name for name, is_apart in zip(names, apart, strict=True) if is_apart)


def _uncertain(fit: Fitted, names: list[str], shared: list[str]) -> tuple[Array, Array, Array]:
    """Return the values of n parameters of a fit, their uncertainties, and their covariances with m calibrated numbers.

    These are (n,), (2, n) and (n, m): of logarithms over the first guess, and of the contact point in m. The
    uncertainties are the half-widths of the intervals of 99.9 % below and above. Student's distributions over noises of
    unknown memory have longer tails than the normal one; the profile likelihood may be skewed.

    Args:
        fit: with intervals.
        names: of the parameters, or the contact point.
        shared: names of the calibrated numbers.
    """
    subject, average, u = fit.subject, fit.solution.average, fit.solution.u
    index, calibrated = ([subject.names.index(name) for name in keys] for keys in (names, shared))
    size = np.array([1.0 if subject.unknowns[i].positive else subject.unknowns[i].scale for i in index])
    tails = np.empty((2, len(names)))
    for column, i in enumerate(index):
        sure, usual = (np.abs(average.ends(i, coverage)) for coverage in (SURE, LEVEL))
        ends = np.array([subject.unknowns[i].inverse(end) for end in fit.intervals[names[column]]])
        tails[:, column] = sure / usual * np.maximum(usual, np.abs(ends - u[i]))
    return u[index] * size, tails * size, average.covariance[np.ix_(index, calibrated)] * size[:, None]
