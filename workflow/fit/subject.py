"""What is fitted: a scene whose numbers change, under a contact model and an instrument."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.forward import Body, Branch, ContactModel, kept
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.search import Problem, Unknown
from contact1d.workflow.laws import law_of
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
POINT, OFFSET = "contact_point", "force_offset"
MEASURED = (POINT, OFFSET, STIFFNESS)
"""Unknowns that are of the measurement."""
Factors = tuple[tuple[str, float], ...]
"""Keys of a scene, and what their numbers are multiplied by."""


@dataclass
class Subject:
    """A scene on a rigid plane and an instrument, of which some numbers are unknown.

    Attributes:
        scene: with a number at each unknown's key.
        model: the contact model.
        curve: what was measured.
        unknowns: of the scene, the instrument and the measurement.
    """

    scene: Scene
    model: ContactModel
    curve: ForceCurve
    unknowns: tuple[Unknown, ...]

    def __post_init__(self) -> None:
        """Which points hold and which are apart, and without a jump which may be either, or before contact."""
        self.names = [one.name for one in self.unknowns]
        n = self.curve.positions.size
        self.held, self.apart, self.open, self.early = (np.zeros(n, dtype=bool) for _ in range(4))
        for one in self.curve.segments:
            self.held[one.held] = self.apart[one.apart] = True
            if one.jump is None:
                self.open[one.points] = True
                self.early[one.points] = one.approaches
        self.pitch = float(np.median(np.abs(np.diff(self.curve.positions)))) or 1e-300
        self._branches = kept(self._branch)

    @property
    def sought(self) -> list[int]:
        """The unknowns that are asked for and that the contact model knows."""
        return [i for i, one in enumerate(self.unknowns) if one.fitted and self.model.depends_on(one.name)]

    @property
    def problem(self) -> Problem:
        """The least-squares problem."""
        runs = tuple(one.compared for one in self.curve.segments)
        return Problem(self.unknowns, self.forces, self.curve.forces, runs)

    def scene_with(self, values: Sequence[float]) -> Scene:
        """The scene with these values of its unknowns, unchecked."""
        return self._moved(self._factors(values))

    def _factors(self, values: Sequence[float]) -> Factors:
        numbers = zip(self.unknowns, values, strict=True)
        return tuple((one.name, value / one.scale) for one, value in numbers if one.name not in MEASURED)

    def _moved(self, factors: Factors) -> Scene:
        scene = self.scene
        for key, factor in factors:
            scene = scene.moved(key, factor)
        return scene

    def _branch(self, factors: Factors) -> Branch:
        scene = self._moved(factors)
        reach = law_of(scene).range_of(scene, 0.0)
        body = Body.of(scene.bodies.profile, self.curve.depth)
        return self.model.branch(body, modulus_of(scene), scene.work_of_adhesion, reach)

    def parts(self, values: Sequence[float]) -> tuple[Branch, float, float, float]:
        """The contact's own curve; and k_c [FU/LU], contact point [LU] and offset of the force [FU]."""
        named = dict(zip(self.names, values, strict=True))
        return self._branches(self._factors(values)), named.get(STIFFNESS, math.inf), named[POINT], named[OFFSET]

    def forces(self, values: Sequence[float]) -> Array:
        """F [FU] at every measured position."""
        branch, stiffness, point, offset = self.parts(values)
        z = self.curve.positions - point
        found = np.zeros_like(z)
        for points, held in ((self.held, True), (self.open, False)):
            if points.any():
                found[points] = branch.at(z[points], stiffness, held, self.pitch)
        found[self.early & (z < branch.displacements[0])] = 0.0  # no force before the bodies touch
        return np.asarray(found + offset)

    def completed(self, u: Array) -> Array:
        """Unknowns with the contact point such that the largest force is where it was measured."""
        u, place, measured = u.copy(), self.names.index(POINT), self.curve
        point, offset = self.unknowns[place], self.names.index(OFFSET)
        u[offset] = measured.baseline / self.unknowns[offset].scale
        if point.known is not None:
            u[place] = point.known[0] / point.scale
            return u
        branch, stiffness, *_ = self.parts(self.problem.values(u))
        least, top = int(np.argmin(branch.forces)), int(np.argmax(measured.forces))
        z, F = branch.positions(stiffness)[least:], branch.forces[least:]
        u[place] = (measured.positions[top] - np.interp(measured.forces[top] - measured.baseline, F, z)) / point.scale
        return u


def modulus_of(scene: Scene) -> float:
    """E* [FU/LU²] of a contact on a rigid plane."""
    bodies, material = scene.bodies, scene.material
    if bodies.bulk_stiffness != "auto":
        return bodies.bulk_stiffness / bodies.spacing
    assert material is not None
    return material.effective_modulus()
