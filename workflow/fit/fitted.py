"""The result of a fit of a contact model to a curve: values and intervals of the unknowns, forces, and its misfit.

Units are those of the scene, SI: z [m] and F [N], compression positive.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import APPROACH, RETRACT, ForceCurve
from contact1d.workflow.fit.forward import RANGE, Branch
from contact1d.workflow.fit.noise import noises
from contact1d.workflow.fit.plan import STIFFNESS, FitPlan
from contact1d.workflow.fit.search import TWO_SIDED, Solution
from contact1d.workflow.fit.subject import OFFSETS, POINT, SLOPE, Subject, modulus_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
UNITS = {POINT: "m", SLOPE: "N/m", STIFFNESS: "N/m", **dict.fromkeys(OFFSETS.values(), "N")}
"""SI units of the unknowns of the measurement, by name."""


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

    def _jumps(self) -> float:
        """Return the natural logarithm of the likelihood of measured snap-in and snap-out, as intervals of positions.

        The predicted positions have the variance of the parameters. A jump that the curve lacks adds 0; 0 without both.
        """
        slopes = self.solution.problem.derivative(self.subject.jumps_at, self.solution.u)
        variances = np.einsum("ki,ij,kj->k", slopes, self.solution.best.covariance, slopes)
        predicted, total = self.subject.jumps_at(self.solution.values), 0.0
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
        width = 15
        first = min(max(0, int(np.argmin(forces)) - width // 2), max(0, points.size - width))
        points, forces = points[first : first + width], forces[first : first + width]
        parabola = np.vander(np.linspace(-1.0, 1.0, points.size), 3, increasing=True)
        best, offset = self.solution.best, OFFSETS[RETRACT]
        offset = offset if offset in self.values else OFFSETS[APPROACH]
        (noise,) = noises([(best.noise.share, best.noise.memory)], [points])
        rows = noise.whitened(np.column_stack([parabola, forces]))
        powers, *_ = np.linalg.lstsq(rows[:, :-1], rows[:, -1])
        lowest = parabola[int(np.argmin(parabola @ powers))]
        variance = best.deviation**2 * float(lowest @ np.linalg.solve(rows[:, :-1].T @ rows[:, :-1], lowest))
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
