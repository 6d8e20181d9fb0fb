"""Whether a curve determines the parameters of a fit, and their intervals; or the reason why not, with a fix.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the baseline.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.fitted import Fitted
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.search import LEVEL, interval
from contact1d.workflow.fit.subject import OFFSETS, POINT, SLOPE, Subject

Array = NDArray[np.float64]
SOFTEST = 0.4
"""Least stiffness of a cantilever over that of the contact, 2E*a. The curve of a softer one shows its own bending: at a
fifth an interval of 95 % covers a third of the true moduli; at half of it the intervals hold."""


class UndeterminedError(Contact1dError, RuntimeError):
    """Data that do not determine the parameters; the message has a suggested fix."""

    exit_code = 3


def checked(fit: Fitted, widest: float = 1.0, by_profile: bool = True) -> Fitted:
    """Return a fit with the 95 % intervals of parameters and contact point, after checks of the result.

    Args:
        fit: without intervals.
        widest: distance of an end of an interval from the estimate, in log p, beyond which a parameter p is
            undetermined; the contact point and terms of a viscoelasticity may be.
        by_profile: whether the intervals are those of the profile likelihood; else those of the covariance, which cost
            nothing and are symmetric.

    Raises:
        UndeterminedError: as in `fitted`.
    """
    solution, subject = fit.solution, fit.subject
    if solution.outliers.size > fit.plan.fit.outliers:
        raise UndeterminedError(
            f"{solution.outliers.size} points are outliers, more than outliers = {fit.plan.fit.outliers}: either "
            f"{fit.model} does not describe the curve, or a unit or the stiffness is wrong, or the noise is not one "
            'of the instrument; fit one segment, segment = "approach", and look at its residuals'
        )
    _require_stiff(fit)
    _require_points(fit)
    intervals = {}
    for i, unknown in enumerate(subject.unknowns):
        if unknown.fitted or unknown.name == POINT:
            low, high = interval(solution, i) if by_profile else solution.u[i] + solution.average.ends(i, LEVEL)
            free = unknown.name.startswith("viscoelasticity.")  # a term slower than the curve has a wide interval
            if unknown.fitted and not free and not max(high - solution.u[i], solution.u[i] - low) < widest:
                raise UndeterminedError(_undetermined(fit, i, low, high))
            intervals[unknown.name] = unknown.value(low), unknown.value(high)
    return replace(fit, intervals=intervals)


def require_distinct(subject: Subject, u: Array) -> None:
    """Check that the curve depends on each unknown, and that they do not trade off; nothing is returned.

    `u`: logarithm of the ratio of each positive unknown to its scale, the ratio of any other, (p,).

    Raises:
        UndeterminedError: it does not, or they do; with their names.
    """
    problem = subject.problem
    J = problem.slopes(u)
    size = np.linalg.norm(J, axis=0)
    names = subject.names
    if not (size > 0.0).all():
        idle = [name for name, norm in zip(names, size, strict=True) if not norm > 0.0]
        raise UndeterminedError(f"the curve does not depend on {' and '.join(idle)}: leave it out of parameters")
    unit = J / size
    information = unit.T @ unit
    P = problem.prior(u)[:, :-1] / size * np.linalg.norm(problem.residuals(u))
    values, vectors = np.linalg.eigh(information + P.T @ P)
    if values[0] < 1e-6:
        heavy = [names[i] for i in np.argsort(-np.abs(vectors[:, 0])) if abs(vectors[i, 0]) > 0.2]
        shown = [name for name in heavy if name not in (POINT, SLOPE, *OFFSETS.values())]
        if len(shown) < 2:
            raise UndeterminedError(
                f"the curve shows {' and '.join(shown or heavy)} no better than contact point and offset of the force: "
                "are z and F swapped, and is the baseline in the curve?"
            )
        raise UndeterminedError(
            f"{' and '.join(shown)} trade off: the curve determines a combination of them only. Give one of them in "
            'the base scene with its ±, such as radius = "5 ± 0.1 µm", and leave it out of parameters'
        )


def _require_stiff(fit: Fitted) -> None:
    """Check that the cantilever has at least 0.4 of the contact's stiffness; nothing is returned.

    A rigid instrument passes.

    Raises:
        UndeterminedError: it is softer; with the least stiffness to use.
    """
    k, contact = fit.values.get(STIFFNESS, math.inf), fit.contact_stiffness
    if k < SOFTEST * contact:
        raise UndeterminedError(
            f"the cantilever ({k:.3g} N/m) is softer than {SOFTEST:g} of the contact ({contact:.3g} N/m)"
            f": the curve shows its own bending: take one of at least {0.5 * contact:.2g} N/m, or a "
            "sharper tip"
        )


def _require_points(fit: Fitted, fewest: int = 15) -> None:
    """Check that a curve has at least `fewest` points in contact; nothing is returned.

    These are the points after a snap-in and before a snap-out; where the curve has neither, those above the contact
    point.

    Raises:
        UndeterminedError: it has fewer.
    """
    held = int(fit.subject.held.sum()) or int((fit.curve.positions > fit.values[POINT]).sum())
    if held < fewest:
        raise UndeterminedError(
            f"only {held} points are in contact, and at least {fewest} are needed: sample faster, or push deeper"
        )


def _undetermined(fit: Fitted, index: int, low: float, high: float) -> str:
    """Return the message on an unknown whose 95 % interval from `low` to `high`, in log p, is too wide or unbounded.

    It names the strongest correlation; for an adhesion without a lower end it says that the noise hides it. `index`: of
    the unknown.
    """
    name, correlation = fit.subject.names[index], np.abs(fit.correlation[index])
    if name.startswith("adhesion.") and not math.isfinite(low):
        return (
            f"no {name} exceeds the noise of the curve: leave [base.adhesion] and its parameters out, as in "
            "Hertz's contact, or average more curves"
        )
    correlation[index] = 0.0
    correlated = fit.subject.names[int(np.argmax(correlation))]
    ends = [fit.subject.unknowns[index].value(end) / fit.values[name] for end in (low, high)]
    bounds = f"from {ends[0]:.2g} to {ends[1]:.2g} times its value" if math.isfinite(high - low) else "unbounded"
    return (
        f"the interval of {name} is too wide, {bounds}; its strongest correlation is {correlation.max():.2f}, with "
        f"{correlated}: give that with a smaller ±, push deeper into the contact, or average more curves"
    )
