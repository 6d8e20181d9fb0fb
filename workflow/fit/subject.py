"""What is fitted: a scene whose numbers change, under a contact model and an instrument.

Unknowns are u = log(p/p₀) of a positive parameter p, and a ratio to the ranges of the data for the contact point and
the baseline. Bodies apart have the force F₀ + s (z − z₀): F₀ is the offset at the contact point z₀, of each segment its
own, since a drag changes its sign with the velocity; the slope s is common. Units are those of the scene, SI.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import APPROACH, HOLD, RETRACT, ForceCurve
from contact1d.workflow.fit.forward import Body, Branch, ContactModel, cached
from contact1d.workflow.fit.noise import Indices, Resting
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.relaxing import relaxed
from contact1d.workflow.fit.search import Problem, Unknown
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
POINT, SLOPE = "contact_point", "force_slope"
OFFSETS = {APPROACH: "force_offset", HOLD: "force_offset", RETRACT: "force_offset_of_retraction"}
"""Names of the offset of the force by segment."""
MEASURED = (POINT, SLOPE, STIFFNESS, *OFFSETS.values())
"""Names of the unknowns of the measurement, which no scene has."""
Factors = tuple[tuple[str, float], ...]
"""Keys of a scene, and the factors of their numbers."""


@dataclass
class Subject:
    """A scene on a rigid plane and an instrument, of which some numbers are unknown.

    Attributes:
        scene: the scene, with a number at the key of each of its unknowns.
        model: the contact model.
        curve: the measured curve.
        unknowns: of the scene, the instrument and the measurement.
        names: of the unknowns.
        held, apart, undecided, approaching: masks of the points, (n,): in contact, apart, neither known, and of these
            the ones of the approach.
        pitch: median distance of neighbouring positions [LU].
    """

    scene: Scene
    model: ContactModel
    curve: ForceCurve
    unknowns: tuple[Unknown, ...]

    def __post_init__(self) -> None:
        """Set the attributes that follow from curve and unknowns: names, masks of the points, and pitch.

        Without a jump all points of a segment are undecided. A pitch of 0 becomes 1e-300 LU.
        """
        self.names = [unknown.name for unknown in self.unknowns]
        n = self.curve.positions.size
        self.held, self.apart, self.undecided, self.approaching = (np.zeros(n, dtype=bool) for _ in range(4))
        for segment in self.curve.segments:
            self.held[segment.held] = self.apart[segment.apart] = True
            if not segment.is_decided:
                self.undecided[segment.points] = True
                self.approaching[segment.points] = segment.name == APPROACH
        self.pitch = float(np.median(np.abs(np.diff(self.curve.positions)))) or 1e-300
        self._branches = cached(self._branch)

    @property
    def sought(self) -> list[int]:
        """The indices of the unknowns that are parameters of the fit and on which the contact model depends."""
        return [i for i, number in enumerate(self.unknowns) if number.fitted and self.model.depends_on(number.name)]

    @property
    def problem(self) -> Problem:
        """The least-squares problem of the compared points, those of the approach before those of the retraction."""
        runs = tuple(segment.compared for segment in self.curve.segments)
        return Problem(self.unknowns, self.forces, self.curve.forces, runs, self.resting, self.excess)

    def embedded(self, values: Mapping[str, float]) -> Array:
        """Return u of all unknowns, (p,), from values by name, such as those of another fit.

        Unknowns without a value are 0, but the offset of a segment, which is that of the other one.
        """
        offset = next((values[name] for name in OFFSETS.values() if name in values), 0.0)
        u = np.zeros(len(self.unknowns))
        for i, unknown in enumerate(self.unknowns):
            value = values.get(unknown.name, offset if unknown.name in OFFSETS.values() else 0.0)
            u[i] = unknown.inverse(value or unknown.scale * unknown.positive)
        return u

    def scene_with(self, values: Sequence[float]) -> Scene:
        """Return the scene with values of its unknowns, (p,) in their units and order, without checking it.

        Values of the measurement and the instrument are ignored.
        """
        return self._moved(self._factors(values))

    def _factors(self, values: Sequence[float]) -> Factors:
        """Return (dotted key, value over its first guess) of each unknown of the scene, in their order.

        Contact point, offset of the force and stiffness of the instrument are left out.
        """
        numbers = zip(self.unknowns, values, strict=True)
        return tuple((number.name, value / number.scale) for number, value in numbers if number.name not in MEASURED)

    def _moved(self, factors: Factors) -> Scene:
        """Return the scene with the numbers at some dotted keys multiplied by factors, without checking it."""
        scene = self.scene
        for key, factor in factors:
            scene = scene.moved(key, factor)
        return scene

    def _branch(self, factors: Factors) -> Branch:
        """Return the states of the contact of the scene whose numbers at dotted keys are multiplied by factors.

        Displacements [LU] and forces [FU] of the contact model, compression positive, without instrument and offset;
        not cached.
        """
        scene = self._moved(factors)
        reach = law_of(scene).range_of(scene, 0.0)
        body = Body.of(scene.bodies.profile, self.curve.depth)
        return self.model.branch(body, modulus_of(scene), scene.work_of_adhesion, reach)

    def parts(self, values: Sequence[float]) -> tuple[Branch, float, float]:
        """Return (states of the contact, k_c [FU/LU], contact point [LU]).

        `values`: of all unknowns, in their order and units. k_c is infinite where the instrument is no unknown, as a
        rigid one. The states are cached.
        """
        named = dict(zip(self.names, values, strict=True))
        return self._branches(self._factors(values)), named.get(STIFFNESS, math.inf), named[POINT]

    def baseline(self, values: Sequence[float]) -> Array:
        """Return the force [FU] of bodies apart at every measured position, (n,); `values`: of all unknowns."""
        named = dict(zip(self.names, values, strict=True))
        forces = named.get(SLOPE, 0.0) * (self.curve.positions - named[POINT])
        for segment in self.curve.segments:
            name = OFFSETS[segment.name]
            forces[segment.points] += named[name if name in named else OFFSETS[APPROACH]]
        return np.asarray(forces)

    def jumps_at(self, values: Sequence[float]) -> Array:
        """Return the positions z [LU] at which the force begins and at which the contact is lost, (2,).

        `values`: of all unknowns, in their order and units.
        """
        branch, stiffness, point = self.parts(values)
        return np.asarray(point + np.array([branch.displacements[0], branch.snap_out(stiffness)[0]]))

    def apart_at(self, values: Sequence[float]) -> NDArray[np.bool_]:
        """Return the mask of the points at which bodies are apart, (n,); `values`: of all unknowns.

        Where no jump tells, they are those below the first force of the contact on the approach, and below its loss
        on the retraction.
        """
        ends = np.where(self.approaching, *self.jumps_at(values))
        return np.asarray(self.apart | (self.undecided & (self.curve.positions < ends)))

    def excess(self, values: Sequence[float]) -> Array:
        """Return how far the contact exists where the model has none, over the distance of positions, (b,), ≥ 0.

        On the retraction it is the model's loss of the contact above the last position in contact, on the approach its
        first force above the first one. Segments of which it is not known count 0. `values`: of all unknowns.
        """
        begin, loss = self.jumps_at(values)
        held = {segment.name: self.curve.positions[segment.held] for segment in self.curve.segments}
        lengths = [begin - z[0] for name, z in held.items() if name == APPROACH and z.size]
        lengths += [loss - z[-1] for name, z in held.items() if name == RETRACT and z.size]
        return np.asarray(np.maximum(0.0, np.array(lengths)) / self.pitch)

    def resting(self, values: Sequence[float], compared: Sequence[Indices], fewest: int = 30) -> Resting | None:
        """Return the measured forces of bodies apart in compared runs; None where these are too few points.

        Their line has a level for each run, and a slope in forces over the range of positions, which is the last
        column.

        Args:
            values: of all unknowns.
            compared: indices of the points of each run.
            fewest: number of points that show a noise.
        """
        apart = self.apart_at(values)
        runs = [run[apart[run]] for run in compared if apart[run].sum() > 3]
        points = np.concatenate([np.zeros(0, dtype=np.intp), *runs])
        if points.size < fewest:
            return None
        levels = np.repeat(np.eye(len(runs)), [run.size for run in runs], axis=0)
        z = (self.curve.positions[points] - self.curve.positions[points].mean())[:, None]
        return Resting(tuple(runs), self.curve.forces[points], np.hstack([levels, z / self.curve.depth]))

    def terms(self, values: Sequence[float]) -> list[tuple[float, float]]:
        """Return share and relaxation time [s] of each term of the scene's bodies; [] if these do not relax.

        `values`: of all unknowns, in their order and units.
        """
        if self.scene.viscoelasticity is None:
            return []
        effect = self.scene_with(values).viscoelasticity
        return [(term.share, term.time) for term in (effect and effect.terms) or ()]

    def _relaxed(self, values: Sequence[float]) -> Array:
        """Return F [FU] of bodies that relax, with the baseline, at every measured position, (n,).

        With a cantilever the displacement that the measured force F′ tells, z − z₀ − F′/k_c, has its noise. To first
        order F follows from the force f and the stiffness S at that displacement: F = F′ + (f − F′)/(1 + S/k_c).

        `values`: of all unknowns, in their order and units.
        """
        branch, stiffness, point = self.parts(values)
        baseline = self.baseline(values)
        measured = self.curve.forces - baseline
        assert self.curve.times is not None
        d = self.curve.positions - point - measured / stiffness
        forces, slope = relaxed(branch, self.terms(values), self.curve.times, d)
        predicted = forces if math.isinf(stiffness) else measured + (forces - measured) / (1.0 + slope / stiffness)
        return np.asarray(predicted + baseline)

    def decided(self, values: Sequence[float], deviation: float, most: int = 20) -> Subject:
        """Return the subject in which the change between contact and bodies apart has its likeliest place.

        It is sought in segments without a jump, between the forces of the contact and of the baseline; it lies between
        all places whose sum of squares is larger by nine variances of the noise at most. Where the forces of the model
        are continuous, as without adhesion, and where these are more than `most` points, it stays undecided, and moves
        with the parameters: a sum of squares with many minima, one for each point.

        Args:
            values: of all unknowns, in their order and units.
            deviation: standard deviation of the noise [FU].
            most: largest number of such places.
        """
        if not self.model.needs:
            return self
        branch, stiffness, point = self.parts(values)
        level, changes = self.baseline(values), dict[str, tuple[int, int]]()
        for segment in self.curve.segments:
            if segment.is_decided or segment.name not in (APPROACH, RETRACT):
                continue
            i = segment.points
            off = self.curve.forces[i] - level[i]
            contact = branch.forces_at(self.curve.positions[i] - point, stiffness, held=True)
            gain = np.append(0.0, np.cumsum((off - contact) ** 2 - off**2))  # of contact up to a point
            squares = (gain if segment.name == RETRACT else -gain) / deviation**2
            likely = np.flatnonzero(squares < squares.min() + 9.0)
            if likely[-1] - likely[0] < most and likely[0] > 3 and likely[-1] < i.size - 3:
                changes[segment.name] = int(likely[0]) - 1, int(likely[-1])
        return replace(self, curve=replace(self.curve, changes=changes)) if changes else self

    def forces(self, values: Sequence[float]) -> Array:
        """Return F [FU], compression positive and with the baseline, at every measured position, (n,).

        Points certainly apart, or within a jump of the force, have that of the baseline. Those certainly in contact
        have the force of the contact, continued steeply below its instability. Points of a segment without a jump have
        the force of the contact, and none of it beyond its instability and, on the approach, before the bodies touch.

        `values`: of all unknowns, in their order and units.
        """
        if self.scene.viscoelasticity is not None:
            return self._relaxed(values)
        branch, stiffness, point = self.parts(values)
        z = self.curve.positions - point
        forces = np.zeros_like(z)
        for points, held in ((self.held, True), (self.undecided, False)):
            if points.any():
                forces[points] = branch.forces_at(z[points], stiffness, held, self.pitch)
        forces[self.approaching & (z < branch.displacements[0])] = 0.0  # no force before the bodies touch
        return np.asarray(forces + self.baseline(values))

    def completed(self, u: Array) -> Array:
        """Return a copy of u (p,) with the baseline and the contact point set from the measured curve.

        The offsets are the level of the baseline. The contact point is the median of those for which the contact has a
        measured force, less the baseline, at its measured position, over all points with more than half of the largest
        such force: a single point has all the noise. A contact point that is given has its value. All are ratios to the
        ranges of measured positions and forces, other unknowns logarithms of ratios to their first guess.
        """
        u, index, measured = u.copy(), self.names.index(POINT), self.curve
        point = self.unknowns[index]
        for i, unknown in enumerate(self.unknowns):
            if unknown.name in OFFSETS.values():
                u[i] = measured.baseline / unknown.scale
        if point.known is not None:
            u[index] = point.known[0] / point.scale
            return u
        branch, stiffness, _ = self.parts(self.problem.values(u))
        least, off = int(np.argmin(branch.forces)), measured.forces - measured.baseline
        z, F, top = branch.positions(stiffness)[least:], branch.forces[least:], off >= 0.5 * off.max()
        u[index] = float(np.median(measured.positions[top] - np.interp(off[top], F, z))) / point.scale
        return u


def modulus_of(scene: Scene) -> float:
    """Return E* [FU/LU²] of a scene's contact on a rigid plane, of a given bulk stiffness, else of the material.

    A given stiffness is that of a spring, and E* its ratio to the spacing.

    Raises:
        AssertionError: it has neither a bulk stiffness nor a material.
    """
    bodies, material = scene.bodies, scene.material
    if bodies.bulk_stiffness != "auto":
        return bodies.bulk_stiffness / bodies.spacing
    assert material is not None
    return material.effective_modulus()
