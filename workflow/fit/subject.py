"""What is fitted: a scene whose numbers change, under a contact model and an instrument.

Unknowns are u = log(p/p₀) of a positive parameter p, and lengths or forces over that of the data for the contact point
and the offset of the force. Units are those of the scene, SI.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import APPROACH, ForceCurve
from contact1d.workflow.fit.forward import Body, Branch, ContactModel, cached
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.search import Problem, Unknown
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
POINT, OFFSET = "contact_point", "force_offset"
MEASURED = (POINT, OFFSET, STIFFNESS)
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
            if segment.jump is None:
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
        return Problem(self.unknowns, self.forces, self.curve.forces, runs)

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

    def parts(self, values: Sequence[float]) -> tuple[Branch, float, float, float]:
        """Return (states of the contact, k_c [FU/LU], contact point [LU], offset of the force [FU]).

        `values`: of all unknowns, in their order and units. k_c is infinite where the instrument is no unknown, as a
        rigid one. The states are cached.
        """
        named = dict(zip(self.names, values, strict=True))
        return self._branches(self._factors(values)), named.get(STIFFNESS, math.inf), named[POINT], named[OFFSET]

    def forces(self, values: Sequence[float]) -> Array:
        """Return F [FU], compression positive and with the offset, at every measured position, (n,).

        Points certainly apart, or within a jump of the force, have the offset. Those certainly in contact have the
        force of the contact, continued steeply below its instability. Points of a segment without a jump have the force
        of the contact, and the offset beyond its instability and, on the approach, before the bodies touch.

        `values`: of all unknowns, in their order and units.
        """
        branch, stiffness, point, offset = self.parts(values)
        z = self.curve.positions - point
        forces = np.zeros_like(z)
        for points, held in ((self.held, True), (self.undecided, False)):
            if points.any():
                forces[points] = branch.forces_at(z[points], stiffness, held, self.pitch)
        forces[self.approaching & (z < branch.displacements[0])] = 0.0  # no force before the bodies touch
        return np.asarray(forces + offset)

    def completed(self, u: Array) -> Array:
        """Return a copy of u (p,) with the offset of the force and the contact point set from the measured curve.

        The offset is the baseline; the contact point is the one for which the contact has the largest measured force,
        less the baseline, at its measured position. A contact point that is given has its value. Both are ratios to the
        ranges of measured positions and forces, other unknowns logarithms of ratios to their first guess.
        """
        u, index, measured = u.copy(), self.names.index(POINT), self.curve
        point, offset = self.unknowns[index], self.names.index(OFFSET)
        u[offset] = measured.baseline / self.unknowns[offset].scale
        if point.known is not None:
            u[index] = point.known[0] / point.scale
            return u
        branch, stiffness, *_ = self.parts(self.problem.values(u))
        least, top = int(np.argmin(branch.forces)), int(np.argmax(measured.forces))
        z, F = branch.positions(stiffness)[least:], branch.forces[least:]
        u[index] = (measured.positions[top] - np.interp(measured.forces[top] - measured.baseline, F, z)) / point.scale
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
