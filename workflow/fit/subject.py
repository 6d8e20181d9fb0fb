"""What is fitted: a scene whose numbers change, under a contact model and an instrument."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.fit.curve import ForceCurve
from contact1d.workflow.fit.forward import Body, Branch, Model
from contact1d.workflow.fit.plan import STIFFNESS
from contact1d.workflow.fit.search import Problem, Unknown
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
POINT, OFFSET = "contact_point", "force_offset"
MEASURED = (POINT, OFFSET, STIFFNESS)
"""Unknowns that are of the measurement."""


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
    model: Model
    curve: ForceCurve
    unknowns: tuple[Unknown, ...]

    def __post_init__(self) -> None:
        """Which points may be lost, which hold, and which may be before contact."""
        self.names = [one.name for one in self.unknowns]
        n = self.curve.positions.size
        self.held, self.open, self.early = (np.zeros(n, dtype=bool) for _ in range(3))
        for one in self.curve.segments:
            self.held[one.held] = True
            if one.jump is None:
                self.open[one.points] = True
                self.early[one.points] = one.approaches
        self.pitch = float(np.median(np.abs(np.diff(self.curve.positions)))) or 1e-300

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
        scene = self.scene
        for one, value in zip(self.unknowns, values, strict=True):
            if one.name not in MEASURED:
                scene = scene.moved(one.name, value / one.scale)
        return scene

    def branch(self, values: Sequence[float]) -> Branch:
        """The contact's own curve."""
        scene = self.scene_with(values)
        reach = scene.adhesion.range if scene.adhesion else None
        body = Body.of(scene.bodies.profile, self.curve.depth)
        return self.model.branch(body, modulus_of(scene), scene.work_of_adhesion, reach or 0.0)

    def value_of(self, name: str, values: Sequence[float]) -> float:
        """The value of an unknown; of a rigid instrument its stiffness is none."""
        return values[self.names.index(name)] if name in self.names else math.inf

    def forces(self, values: Sequence[float]) -> Array:
        """F [FU] at every measured position."""
        branch, k = self.branch(values), self.value_of(STIFFNESS, values)
        z = self.curve.positions - self.value_of(POINT, values)
        found = np.zeros_like(z)
        for points, held in ((self.held, True), (self.open, False)):
            if points.any():
                found[points] = branch.at(z[points], k, held, self.pitch)
        found[self.early & (z < branch.displacements[0])] = 0.0  # no force before the bodies touch
        return np.asarray(found + self.value_of(OFFSET, values))

    def completed(self, u: Array) -> Array:
        """Unknowns with the contact point such that the largest force is where it was measured."""
        u = u.copy()
        units = {one.name: one.scale for one in self.unknowns}
        u[self.names.index(OFFSET)] = self.curve.baseline / units[OFFSET]
        place = self.unknowns[self.names.index(POINT)]
        if place.known is None:
            values = self.problem.values(u)
            branch = self.branch(values)
            z, F = branch.positions(self.value_of(STIFFNESS, values)), branch.forces
            least = int(np.argmin(F))
            top = int(np.argmax(self.curve.forces))
            at = float(np.interp(self.curve.forces[top] - self.curve.baseline, F[least:], z[least:]))
            u[self.names.index(POINT)] = (float(self.curve.positions[top]) - at) / place.scale
        else:
            u[self.names.index(POINT)] = place.known[0] / place.scale
        return u


def modulus_of(scene: Scene) -> float:
    """E* [FU/LU²] of a contact on a rigid plane."""
    bodies, material = scene.bodies, scene.material
    if bodies.bulk_stiffness != "auto":
        return bodies.bulk_stiffness / bodies.spacing
    assert material is not None
    return material.effective_modulus()
