"""One curve and one plan: what the curve says of the parameters under a contact model, or why it says nothing."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import ForceCurve, Indices
from contact1d.workflow.fit.forward import LAWS, RANGE, Branch, ContactModel
from contact1d.workflow.fit.plan import STIFFNESS, FitPlan
from contact1d.workflow.fit.search import TWO_SIDED, Solution, Unknown, first_look, interval, solved
from contact1d.workflow.fit.subject import OFFSET, POINT, Subject, modulus_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
SOFTEST = 0.4
"""Stiffness of a cantilever over that of the contact, 2E*a, below which the curve is its own bending: at a fifth an
interval of 95 % covers a third of the true moduli; at half of it the intervals hold."""
FEWEST_HELD = 15
"""Points in contact."""
ALIKE = 1e-6
"""Least eigenvalue of the scaled information matrix below which parameters trade off against each other."""
RANGES, BEST = (-4.0, -2.5, -1.0, 0.5, 2.0, 3.5), 3
"""Of a model between two limits: ranges tried (log of the given one), and how many of these starts go on."""
EXACT = 1e-6
"""± over the value of what is given without one."""
WIDEST = 1.0
"""Half-width of an interval, in log p, beyond which a parameter is not known: a factor of e."""


class UndeterminedError(Contact1dError, RuntimeError):
    """Data that do not tell what was asked for; the message says what would help."""

    exit_code = 3


@dataclass(frozen=True)
class Fitted:
    """What a curve says.

    Attributes:
        plan, curve: of which.
        subject: scene, contact model, instrument and unknowns.
        solution: where the fit settled.
        intervals: of 95 %, for each of the fitted parameters and the contact point.
    """

    plan: FitPlan
    curve: ForceCurve
    subject: Subject
    solution: Solution
    intervals: Mapping[str, tuple[float, float]]

    @property
    def model(self) -> str:
        """The name of the contact model."""
        return self.subject.model.name

    @cached_property
    def values(self) -> dict[str, float]:
        """Of all unknowns, in units of the scene."""
        return dict(zip(self.subject.names, self.solution.values, strict=True))

    @cached_property
    def scene(self) -> Scene:
        """The base scene with the found values."""
        return self.subject.scene_with(self.solution.values)

    @cached_property
    def branch(self) -> Branch:
        """The states of the contact."""
        return self.subject.parts(self.solution.values)[0]

    @cached_property
    def forces(self) -> Array:
        """Predicted at all points [FU]."""
        return self.subject.forces(self.solution.values)

    @property
    def correlation(self) -> Array:
        """Of all unknowns."""
        covariance = self.solution.best.covariance
        spread = np.sqrt(np.diag(covariance))
        return np.asarray(covariance / np.outer(spread, spread))

    @cached_property
    def criterion(self) -> float:
        """Bayes's information criterion, −2 log L + p log n: the lower the better.

        The positions of both jumps count here, and in no least squares.
        """
        best, problem = self.solution.best, self.solution.problem
        n = problem.kept.size
        r = best.noise.whitened(problem.residuals(self.solution.u))
        misfit = problem.prior(self.solution.u)[:, -1]
        log = -0.5 * n * math.log(float(r @ r) / n) - 0.5 * best.noise.log_determinant - 0.5 * float(misfit @ misfit)
        log += self._jumps()
        given = self.subject.model.depends_on(RANGE) and RANGE not in self.subject.names  # a number that others lack
        return -2.0 * log + (len(self.subject.names) + given) * math.log(n)

    def jumps_at(self, values: Sequence[float]) -> Array:
        """Positions z [m] at which contact begins and is lost, (2,)."""
        branch, stiffness, point, _ = self.subject.parts(values)
        return np.asarray(point + np.array([branch.displacements[0], branch.snap_out(stiffness)[0]]))

    def _jumps(self) -> float:
        """log L of the brackets of both jumps, where the parameters leave their positions a spread."""
        slopes = self.solution.problem.derivative(self.jumps_at, self.solution.u)
        variance = np.einsum("ki,ij,kj->k", slopes, self.solution.best.covariance, slopes)
        total = 0.0
        for segment, at, known in zip(self.curve.segments, self.jumps_at(self.solution.values), variance, strict=True):
            if segment.jump is not None:
                low, high = self.curve.positions[segment.points[list(segment.jump)]]
                spread = math.sqrt(known + (high - low) ** 2 / 12.0)
                off = (0.5 * (low + high) - at) / spread
                total += math.log(abs(high - low) / spread / math.sqrt(2.0 * math.pi)) - 0.5 * off**2
        return total

    @cached_property
    def misfit(self) -> float:
        """Mean square of the residuals in contact over that of bodies apart: reduced χ². 1 where either is missing."""
        problem = self.solution.problem
        r = problem.residuals(self.solution.u)
        before = self.subject.open & (self.curve.positions < self.values[POINT])
        away = (self.subject.apart | before)[problem.kept]
        return 1.0 if away.all() or not away.any() else float(np.mean(r[~away] ** 2) / np.mean(r[away] ** 2))

    def spread(self) -> Array:
        """95 % half-width of the predicted force at the compared points [FU]."""
        J = self.solution.problem.slopes(self.solution.u)
        return np.asarray(TWO_SIDED * np.sqrt(np.einsum("ij,jk,ik->i", J, self.solution.best.covariance, J)))

    @property
    def contact_stiffness(self) -> float:
        """2E*a [N/m] without load, or where nothing adheres under the largest one."""
        F, least = self.branch.forces, int(np.argmin(self.branch.forces))
        load = 0.0 if F[least] < 0.0 else float(self.curve.forces.max() - self.curve.baseline)
        return 2.0 * modulus_of(self.scene) * float(np.interp(load, F[least:], self.branch.radii[least:]))


def model_of(plan: FitPlan) -> ContactModel:
    """The contact model that a base scene means."""
    return next(one for one in LAWS.values() if one.applies(plan.base))


def compared(found: Fitted, model: ContactModel) -> Fitted:
    """Another contact model on the same points, without intervals."""
    subject = _subject(found.plan, found.curve, model)
    problem = subject.problem.without(found.solution.outliers)
    solution = solved(problem, _starts(subject, found.solution.outliers), judges=False)
    return Fitted(found.plan, found.curve, subject, solution, {})


def _starts(subject: Subject, outliers: Indices) -> list[Array]:
    """Starts of a fit: of a model that takes long those of its two limits, at several ranges."""
    problem = subject.problem.without(outliers)
    if not subject.model.limits:
        return first_look(problem, subject.sought, subject.completed)
    is_range = np.array([name == RANGE for name in subject.names])
    starts = []
    for name in subject.model.limits:
        limit = replace(subject, model=LAWS[name])
        u = first_look(limit.problem.without(outliers), limit.sought, limit.completed)[0]
        starts += [u + step * is_range for step in (RANGES if is_range.any() else (0.0,))]
    starts.sort(key=lambda u: float(np.abs(problem.residuals(u)).sum()))
    return starts[:BEST]


def fitted(plan: FitPlan, curve: ForceCurve, model: ContactModel) -> Fitted:
    """What a curve says of a plan's parameters under a contact model.

    Raises:
        UndeterminedError: it does not tell; what would help.
    """
    subject = _subject(plan, curve, model)
    starts = _starts(subject, np.zeros(0, dtype=np.intp))
    require_apart(subject, starts[0])
    found = solved(subject.problem, starts)
    if found.outliers.size > plan.fit.outliers:
        raise UndeterminedError(
            f"{found.outliers.size} points are no part of the noise, more than outliers = {plan.fit.outliers}: either "
            f"{model.name} does not describe the curve, or a unit or the stiffness is wrong, or the noise is not one "
            "of the instrument; look at the residuals"
        )
    result = Fitted(plan, curve, subject, found, {})
    _require_stiff(result)
    _require_points(result)
    ends = {}
    for i, one in enumerate(subject.unknowns):
        if one.fitted or one.name == POINT:
            low, high = interval(found, i)
            if one.fitted and not max(high - found.u[i], found.u[i] - low) < WIDEST:
                raise UndeterminedError(_open(result, i, low, high))
            ends[one.name] = one.value(low), one.value(high)
    return replace(result, intervals=ends)


def _subject(plan: FitPlan, curve: ForceCurve, model: ContactModel) -> Subject:
    """Scene, instrument and unknowns of a contact model, without the adhesion that one may not have."""
    scene = plan.base if model.needs else plan.base.model_copy(update={"adhesion": None})
    unknowns = []
    for key in dict.fromkeys([*plan.fit.parameters, *plan.known, STIFFNESS]):
        if key == POINT or not model.depends_on(key):
            continue
        value = plan.stiffness if key == STIFFNESS else float(plan.numbers[key].value)
        share = plan.known.get(key, EXACT if key == STIFFNESS else None)
        known = None if share is None else (value, share * value / TWO_SIDED)
        if math.isfinite(value):
            unknowns.append(Unknown(key, value, known=known, fitted=key in plan.fit.parameters))
    point, depth = plan.fit.contact_point, curve.depth
    known = None
    if point != "free":
        known = point, plan.known.get(POINT, 0.0) * abs(point) / TWO_SIDED + EXACT * depth
    unknowns.append(Unknown(POINT, depth, positive=False, known=known))
    unknowns.append(Unknown(OFFSET, float(np.ptp(curve.forces)), positive=False))
    return Subject(scene, model, curve, tuple(unknowns))


def require_apart(subject: Subject, u: Array) -> None:
    """Refuse parameters of which one does what the others do.

    Raises:
        UndeterminedError: with their names.
    """
    problem = subject.problem
    J = problem.slopes(u)
    size = np.linalg.norm(J, axis=0)
    names = subject.names
    if not (size > 0.0).all():
        idle = [name for name, one in zip(names, size, strict=True) if not one > 0.0]
        raise UndeterminedError(f"the curve does not depend on {' and '.join(idle)}: leave it out of parameters")
    unit = J / size
    information = unit.T @ unit
    P = problem.prior(u)[:, :-1] / size * np.linalg.norm(problem.residuals(u))
    values, vectors = np.linalg.eigh(information + P.T @ P)
    if values[0] < ALIKE:
        heavy = [names[i] for i in np.argsort(-np.abs(vectors[:, 0])) if abs(vectors[i, 0]) > 0.2]
        shown = [name for name in heavy if name not in (POINT, OFFSET)]
        if len(shown) < 2:
            raise UndeterminedError(
                f"the curve shows {' and '.join(shown or heavy)} no better than contact point and offset of the force: "
                "are z and F swapped, and is the baseline in the curve?"
            )
        raise UndeterminedError(
            f"{' and '.join(shown)} trade off: one does to the curve what the others undo. Give one of them in "
            'the base scene with its ±, such as radius = "5 ± 0.1 µm", and leave it out of parameters'
        )


def _require_stiff(found: Fitted) -> None:
    k, contact = found.values.get(STIFFNESS, math.inf), found.contact_stiffness
    if k < SOFTEST * contact:
        raise UndeterminedError(
            f"the cantilever ({k:.3g} N/m) is softer than {SOFTEST:g} of the contact ({contact:.3g} N/m)"
            f": the curve shows its own bending: take one of at least {0.5 * contact:.2g} N/m, or a "
            "sharper tip"
        )


def _require_points(found: Fitted) -> None:
    curve = found.curve
    held = int(found.subject.held.sum()) or int((curve.positions > found.values[POINT]).sum())
    if held < FEWEST_HELD:
        raise UndeterminedError(
            f"only {held} points are in contact, and at least {FEWEST_HELD} are needed: sample faster, or push deeper"
        )


def _open(found: Fitted, index: int, low: float, high: float) -> str:
    """Why an interval has no end, and what would help."""
    name, correlation = found.subject.names[index], np.abs(found.correlation[index])
    if name.startswith("adhesion.") and not math.isfinite(low):
        return (
            f"no {name} is seen in the curve beyond its noise: leave [base.adhesion] and its parameters out, as in "
            "Hertz's contact, or average more curves"
        )
    correlation[index] = 0.0
    other = found.subject.names[int(np.argmax(correlation))]
    ends = [found.subject.unknowns[index].value(end) / found.values[name] for end in (low, high)]
    span = f"from {ends[0]:.2g} to {ends[1]:.2g} times its value" if math.isfinite(high - low) else "without an end"
    return (
        f"{name} is known {span} only; it is tied most to {other} (correlation {correlation.max():.2f}): give that "
        "with a smaller ±, push deeper into the contact, or average more curves"
    )
