"""The fit of a contact model to a curve by the parameters of a plan: its unknowns, its starts, and its solution.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the offset of the force. Units are those of the scene, SI: z [m] and F [N], compression positive.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve, Indices
from contact1d.workflow.fit.determined import checked, require_distinct
from contact1d.workflow.fit.fitted import Fitted
from contact1d.workflow.fit.forward import LAWS, RANGE, ContactModel
from contact1d.workflow.fit.plan import STIFFNESS, FitPlan
from contact1d.workflow.fit.search import TWO_SIDED, Solution, Unknown, global_search, solved
from contact1d.workflow.fit.subject import OFFSETS, POINT, SLOPE, Subject

Array = NDArray[np.float64]
SURE = 0.999
"""Probability from which on a difference or a slope of the baseline is no chance."""


def model_of(plan: FitPlan) -> ContactModel:
    """Return the contact model that a base scene means, the first of these that has all it needs.

    Maugis with a range of the adhesion, else JKR with a work of adhesion, else Hertz. DMT is never meant, since it
    needs more than JKR.
    """
    return next(model for model in LAWS.values() if model.applies(plan.base))


def compared(fit: Fitted, model: ContactModel) -> Fitted:
    """Return the fit of another contact model to the points of `fit`, with its outliers excluded and no further ones.

    `intervals` is empty, and nothing is checked: the parameters may be undetermined.
    """
    subject = _subject(fit.plan, fit.curve, model, SLOPE in fit.subject.names)
    problem = subject.problem.without(fit.solution.outliers)
    solution = solved(problem, _starts(subject, fit.solution.outliers), rejects=False)
    return Fitted(fit.plan, fit.curve, subject, solution, {})


def _starts(subject: Subject, outliers: Indices) -> list[Array]:
    """Return starts (p,) of a fit: for JKR, DMT and Hertz those of a global search, the best first.

    For Maugis these are the three best of JKR's and DMT's, each at six ranges h₀ from e^−4 to e^3.5 times the given
    one; or as they are where the range is no unknown. Those of DMT are left out for a body without a radius of
    curvature, such as a cone. A start has the logarithm of the ratio of each positive unknown to its first
    guess, the ratio of the contact point and of the offset to the range of the data.

    `outliers`: indices of points that are left out.
    """
    problem = subject.problem.without(outliers)
    if not subject.model.limits:
        return global_search(problem, subject.sought, subject.completed)
    is_range = np.array([name == RANGE for name in subject.names])
    ranges = np.arange(-4.0, 4.0, 1.5) if is_range.any() else np.zeros(1)  # log(h₀ / the given one)
    starts = []
    for model in (LAWS[name] for name in subject.model.limits if LAWS[name].applies(subject.scene)):
        limit = replace(subject, model=model)
        searched = global_search(limit.problem.without(outliers), limit.sought, limit.completed)
        starts += [u + step * is_range for u in searched for step in ranges]
    starts.sort(key=lambda u: float(np.abs(problem.residuals(u)).sum()))
    return starts[:3]


def fitted(plan: FitPlan, curve: ForceCurve, model: ContactModel) -> Fitted:
    """Fit a contact model to a curve, and return the fit with the 95 % intervals of parameters and contact point.

    Args:
        plan: with the parameters.
        curve: the measured curve.
        model: the contact model.

    Raises:
        UndeterminedError: the curve does not determine the parameters, has too many outliers or too few points in
            contact, or the cantilever is too soft.
    """
    return checked(solution_of(plan, curve, model))


def solution_of(
    plan: FitPlan,
    curve: ForceCurve,
    model: ContactModel,
    near: Fitted | None = None,
    approach: Fitted | None = None,
) -> Fitted:
    """Fit a contact model to a curve, and return the fit without intervals and without checks of the result.

    The baseline has a slope if the plan says so, or by "auto" if the forces of bodies apart show one at 99.9 %.

    Args:
        plan: with the parameters.
        curve: the measured curve.
        model: the contact model.
        near: a fit of the same model to a similar curve, from which the search begins; None: it is global.
        approach: of a retraction alone, the fit of the approach, whose offset counts where the retraction has none.

    Raises:
        UndeterminedError: the curve does not depend on a parameter, or parameters trade off.
    """
    none = np.zeros(0, dtype=np.intp)
    subject = _subject(plan, curve, model, plan.baseline == "sloped", approach)
    starts = _starts(subject, none) if near is None else [subject.embedded(near.values)]
    require_distinct(subject, starts[0])
    solution = solved(subject.problem, starts)
    decided = subject.decided(solution.values, solution.best.deviation)
    if decided is not subject:
        subject, curve = decided, decided.curve
        solution = solved(subject.problem, [solution.u])
    if plan.baseline == "auto" and _is_sloped(subject, solution):
        sloped = _subject(plan, curve, model, True, approach)
        values = dict(zip(subject.names, solution.values, strict=True))
        subject, solution = sloped, solved(sloped.problem, [sloped.embedded(values)])
    return Fitted(plan, curve, subject, solution, {})


def _is_sloped(subject: Subject, solution: Solution) -> bool:
    """Return whether the forces of bodies apart exclude a baseline without slope at 99.9 %, over all noises."""
    resting = subject.resting(solution.values, solution.problem.runs)
    if resting is None:
        return False
    line = resting.line()
    low, high = line.best.step[-1] + line.ends(-1, SURE)
    return not low < 0.0 < high


def _subject(
    plan: FitPlan, curve: ForceCurve, model: ContactModel, sloped: bool, approach: Fitted | None = None
) -> Subject:
    """Return the scene, instrument and unknowns of a contact model for a curve; the scene lacks [adhesion] for Hertz.

    The unknowns are, in this order, the parameters and then numbers with ± on which the forces depend, the instrument's
    stiffness where it is finite, the contact point, the offset of the force of each segment and, if `sloped`, the slope
    of the baseline. A number with ± has a calibration, as has a contact point that is given; a stiffness without ± one
    of 1e-6. A retraction that ends in contact has the offset of the approach: of the same curve, or as a calibration
    that of a fit of the `approach`.
    """
    scene = plan.base if model.needs else plan.base.model_copy(update={"adhesion": None})
    exact = 1e-6  # ± over the value of a number that is given without one
    unknowns = []
    for key in dict.fromkeys([*plan.fit.parameters, *plan.known, STIFFNESS]):
        if key == POINT or not model.depends_on(key):
            continue
        value = plan.stiffness if key == STIFFNESS else float(plan.numbers[key].value)
        share = plan.known.get(key, exact if key == STIFFNESS else None)
        known = None if share is None else (value, share * value / TWO_SIDED)
        if math.isfinite(value):
            most = 1.0 if key.endswith(".share") else math.inf
            unknowns.append(Unknown(key, value, known=known, fitted=key in plan.fit.parameters, most=most))
    point, depth = plan.fit.contact_point, curve.depth
    known = None
    if point != "free":
        known = point, plan.known.get(POINT, 0.0) * abs(point) / TWO_SIDED + exact * depth
    unknowns.append(Unknown(POINT, depth, positive=False, known=known))
    range_of_forces = float(np.ptp(curve.forces))
    for name in dict.fromkeys(OFFSETS[segment.name] for segment in curve.segments):
        known, ends = None, curve.segments[-1].ends_in_contact and name == OFFSETS[RETRACT]
        if ends and len(curve.segments) > 1:
            continue  # the offset of the approach is the only one that is seen
        if ends and approach is not None:
            known = approach.values[OFFSETS[APPROACH]], approach.deviation(OFFSETS[APPROACH])
        unknowns.append(Unknown(name, range_of_forces, positive=False, known=known))
    if sloped:
        unknowns.append(Unknown(SLOPE, range_of_forces / depth, positive=False))
    return Subject(scene, model, curve, tuple(unknowns))
