"""The fit of a contact model to a curve: the parameters of a plan with their intervals, or why none can be given.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the offset of the force. Units are those of the scene, SI: z [m] and F [N], compression positive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve, Indices
from contact1d.workflow.fit.forward import LAWS, RANGE, Branch, ContactModel
from contact1d.workflow.fit.noise import noises
from contact1d.workflow.fit.plan import STIFFNESS, FitPlan
from contact1d.workflow.fit.search import LEVEL, TWO_SIDED, Solution, Unknown, global_search, interval, solved
from contact1d.workflow.fit.subject import OFFSETS, POINT, SLOPE, Subject, modulus_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
UNITS = {POINT: "m", SLOPE: "N/m", STIFFNESS: "N/m", **dict.fromkeys(OFFSETS.values(), "N")}
"""SI units of the unknowns of the measurement, by name."""
SURE = 0.999
"""Probability from which on a difference or a slope of the baseline is no chance."""
SOFTEST = 0.4
"""Least stiffness of a cantilever over that of the contact, 2E*a. The curve of a softer one shows its own bending: at a
fifth an interval of 95 % covers a third of the true moduli; at half of it the intervals hold."""


class UndeterminedError(Contact1dError, RuntimeError):
    """Data that do not determine the parameters; the message has a suggested fix."""

    exit_code = 3


@dataclass(frozen=True)
class Fitted:
    """The fit of a contact model to a curve.

    Attributes:
        plan: the fit file.
        curve: the measured curve.
        subject: scene, contact model, instrument and unknowns.
        solution: the converged fit.
        intervals: of 95 %, (lower, upper) in SI, by the names of the fitted parameters and of the contact point, where
            they may be infinite; empty where a model is compared only.
    """

    plan: FitPlan
    curve: ForceCurve
    subject: Subject
    solution: Solution
    intervals: Mapping[str, tuple[float, float]]

    @property
    def model(self) -> str:
        """The name of the contact model: "Maugis", "JKR", "DMT" or "Hertz"."""
        return self.subject.model.name

    @cached_property
    def values(self) -> dict[str, float]:
        """The values of all unknowns by name, in SI; cached.

        Parameters and numbers with ± of the scene have their dotted keys, then come "instrument.stiffness" [N/m],
        unless it is rigid, "contact_point" [m] and "force_offset" [N].
        """
        return dict(zip(self.subject.names, self.solution.values, strict=True))

    @cached_property
    def scene(self) -> Scene:
        """The base scene with the fitted values of its unknown numbers, unchecked; cached.

        Without [adhesion] where the contact model has none.
        """
        return self.subject.scene_with(self.solution.values)

    @cached_property
    def branch(self) -> Branch:
        """The states of the fitted contact along its rising path: d [m] and F [N], compression positive; cached.

        Contact point and offset of the measurement are left out, so that the bodies touch at 0.
        """
        return self.subject.parts(self.solution.values)[0]

    @cached_property
    def forces(self) -> Array:
        """The predicted force [N], compression positive and with the offset, at all points of the curve, (n,).

        It is cached.
        """
        return self.subject.forces(self.solution.values)

    @property
    def baseline(self) -> Array:
        """The force [N] of bodies apart at all points of the curve, (n,): offset and slope."""
        return self.subject.baseline(self.solution.values)

    def unit(self, name: str) -> str:
        """Return the SI unit of an unknown as text: of a dotted key of the scene, or of the measurement.

        Raises:
            KeyError: there is no such unknown.
        """
        return UNITS.get(name) or self.plan.unit(name)

    def deviation(self, name: str) -> float:
        """Return the standard deviation of an unknown by its covariance, in its unit."""
        index = self.subject.names.index(name)
        spread = math.sqrt(self.solution.best.covariance[index, index])
        return abs(self.subject.unknowns[index].slope(float(self.solution.u[index]))) * spread

    @property
    def cost_of_baseline(self) -> float:
        """How many times as wide the unknown offset makes the widest interval of a parameter; 1 with a baseline.

        The intervals are those of the covariance, with and without the offset of the segments as an unknown.
        """
        known = [unknown.name for unknown in self.subject.unknowns if unknown.known]
        resting = self.subject.resting(self.solution.values, self.solution.problem.runs)
        if resting is not None or any(name in known for name in OFFSETS.values()):
            return 1.0
        names, C = self.subject.names, self.solution.best.covariance
        apart = [i for i, name in enumerate(names) if name in OFFSETS.values()]
        sought = self.subject.sought
        gained = C[np.ix_(sought, apart)] @ np.linalg.solve(C[np.ix_(apart, apart)], C[np.ix_(apart, sought)])
        full = np.diag(C)[sought]
        return float(np.sqrt(full / (full - np.diag(gained))).max(initial=1.0))

    @property
    def correlation(self) -> Array:
        """The correlation matrix of all unknowns in their order, (p, p), −1 … 1, with a diagonal of 1."""
        covariance = self.solution.best.covariance
        spread = np.sqrt(np.diag(covariance))
        return np.asarray(covariance / np.outer(spread, spread))

    @cached_property
    def criterion(self) -> float:
        """The Bayesian information criterion, −2 log L + p log n, but for a constant: the lower the better; cached.

        n is the number of compared points, p that of unknowns, and one more where the model uses a given range h₀.
        Unlike in the least squares the positions of both jumps count.
        """
        best, problem = self.solution.best, self.solution.problem
        n = problem.kept.size
        r = best.noise.whitened(problem.residuals(self.solution.u))
        misfit = problem.prior(self.solution.u)[:, -1]
        log = -0.5 * n * math.log(float(r @ r) / n) - 0.5 * best.noise.log_determinant - 0.5 * float(misfit @ misfit)
        log += self._jumps()
        # A given range is a number, too, that the other models lack.
        given = self.subject.model.depends_on(RANGE) and RANGE not in self.subject.names
        return -2.0 * log + (len(self.subject.names) + given) * math.log(n)

    def jumps_at(self, values: Sequence[float]) -> Array:
        """Return the positions z of the piezo [m] at which the force begins and at which the contact is lost, (2,).

        `values`: of all unknowns, in their order and units.
        """
        branch, stiffness, point = self.subject.parts(values)
        return np.asarray(point + np.array([branch.displacements[0], branch.snap_out(stiffness)[0]]))

    def _jumps(self) -> float:
        """Return the natural logarithm of the likelihood of measured snap-in and snap-out, as intervals of positions.

        The predicted positions have the variance of the parameters. A jump that the curve lacks adds 0; 0 without both.
        """
        slopes = self.solution.problem.derivative(self.jumps_at, self.solution.u)
        variances = np.einsum("ki,ij,kj->k", slopes, self.solution.best.covariance, slopes)
        predicted, total = self.jumps_at(self.solution.values), 0.0
        for segment in self.curve.segments:
            if segment.jump is not None:
                i = 0 if segment.name == APPROACH else 1
                position, variance = predicted[i], variances[i]
                low, high = self.curve.positions[segment.points[list(segment.jump)]]
                spread = math.sqrt(variance + (high - low) ** 2 / 12.0)
                off = (0.5 * (low + high) - position) / spread
                total += math.log(abs(high - low) / spread / math.sqrt(2.0 * math.pi)) - 0.5 * off**2
        return total

    @cached_property
    def misfit(self) -> float:
        """The reduced χ² (dimensionless): mean square of the residuals in contact over that of bodies apart; cached.

        Of compared points only; bodies apart have residuals from a line of their own, of which the fit can spoil
        nothing. 1 where there are too few points of one kind.
        """
        problem, values = self.solution.problem, self.solution.values
        resting = self.subject.resting(values, problem.runs)
        r = problem.residuals(self.solution.u)[~self.subject.apart_at(values)[problem.kept]]
        if resting is None or not r.size:
            return 1.0
        _, squares, *_ = np.linalg.lstsq(resting.columns, resting.forces)
        return float(np.mean(r**2) / (squares[0] / (resting.forces.size - resting.columns.shape[1])))

    @property
    def pull_off(self) -> tuple[float, float]:
        """The measured pull-off force, positive in tension, and its ± of 95 % [N], by no contact model.

        It is the offset less the least value of a parabola through 15 points of the retraction around that of the least
        force, none of them beyond the jump; the ± is that of the parabola and of the offset under the fit's noise. NaN
        without a retraction.
        """
        last = self.curve.segments[-1]
        if last.name != RETRACT:
            return math.nan, math.nan
        points = last.held if last.held.size else last.points
        points = points[np.isin(points, self.solution.problem.kept)]
        forces = (self.curve.forces - self.baseline)[points]
        first = min(max(0, int(np.argmin(forces)) - 7), max(0, points.size - 15))
        points, forces = points[first : first + 15], forces[first : first + 15]
        x = np.linspace(-1.0, 1.0, points.size)
        best, offset = self.solution.best, OFFSETS[RETRACT]
        offset = offset if offset in self.values else OFFSETS[APPROACH]
        (noise,) = noises([(best.noise.share, best.noise.memory)], [points])
        rows = noise.whitened(np.column_stack([np.ones_like(x), x, x**2, forces]))
        powers, *_ = np.linalg.lstsq(rows[:, :3], rows[:, 3])
        parabola = np.vander(x, 3, increasing=True)
        lowest = parabola[int(np.argmin(parabola @ powers))]
        variance = best.deviation**2 * float(lowest @ np.linalg.solve(rows[:, :3].T @ rows[:, :3], lowest))
        variance += self.deviation(offset) ** 2
        return -float(lowest @ powers), TWO_SIDED * math.sqrt(variance)

    def spread(self) -> Array:
        """Return the 95 % half-width [N], ≥ 0, of the predicted force at the compared points, (n,).

        It is that of the parameters by their covariance, without the noise of the points.
        """
        J = self.solution.problem.slopes(self.solution.u)
        return np.asarray(TWO_SIDED * np.sqrt(np.einsum("ij,jk,ik->i", J, self.solution.best.covariance, J)))

    @property
    def contact_stiffness(self) -> float:
        """The stiffness 2E*a [N/m] of the contact at zero load; without adhesion at the largest load of the curve.

        a is the contact radius; of the Maugis model a + √(c² − a²), with the radius c of the attraction.
        """
        F, least = self.branch.forces, int(np.argmin(self.branch.forces))
        load = 0.0 if F[least] < 0.0 else float(self.curve.forces.max() - self.curve.baseline)
        return 2.0 * modulus_of(self.scene) * float(np.interp(load, F[least:], self.branch.radii[least:]))


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
    """Return starts (p,) of a fit: for JKR, DMT and Hertz up to four of a global search, the best first.

    For Maugis these are the three best of twelve: JKR's and DMT's best fits, each at six ranges h₀ from e^−4 to e^3.5
    times the given one; or both fits where the range is no unknown. Those of DMT are left out for a body without a
    radius of curvature, such as a cone. A start has the logarithm of the ratio of each positive unknown to its first
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
        u = global_search(limit.problem.without(outliers), limit.sought, limit.completed)[0]
        starts += [u + step * is_range for step in ranges]
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
            "of the instrument; look at the residuals"
        )
    _require_stiff(fit)
    _require_points(fit)
    intervals = {}
    for i, unknown in enumerate(subject.unknowns):
        if unknown.fitted or unknown.name == POINT:
            if by_profile:
                low, high = interval(solution, i)
            else:
                low, high = (solution.u[i] + solution.average.quantile(i, 0.5 + side * LEVEL) for side in (-0.5, 0.5))
            free = unknown.name.startswith("viscoelasticity.")  # a term slower than the curve has a wide interval
            if unknown.fitted and not free and not max(high - solution.u[i], solution.u[i] - low) < widest:
                raise UndeterminedError(_undetermined(fit, i, low, high))
            intervals[unknown.name] = unknown.value(low), unknown.value(high)
    return replace(fit, intervals=intervals)


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
    best = line.best.step[-1]
    low, high = (best + line.quantile(-1, 0.5 * (1.0 + side * SURE)) for side in (-1.0, 1.0))
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
