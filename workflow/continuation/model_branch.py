"""The reduced model in place of LAMMPS: driven by the same script and evaluated by the same reader."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.continuation.state import RadiusRule
from contact1d.workflow.continuation.trace import Trace, of_model
from contact1d.workflow.model.friction import Stop
from contact1d.workflow.model.reduced import Reduced, Sliding
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene

Array = NDArray[np.float64]
COARSE, FINE, ZOOMS = 100, 30, 2
"""Positions of the first look for the force maximum and of each closer one, and how many of these: none where the
curve is smooth, since the model's forces are straight between the points of a grid, whose corners would move a top."""
BETWEEN = 8
"""Intermediate positions towards a force."""
LAST = 1e-9
"""How much of the path from F = 0 to the limit point is left before it."""
MOST_NUMBERS = 400_000
"""Forces that are worked out in a path with dense positions."""


UNSEEN = ""
"""Phase of states that make the history of a path and are none of it."""


class ModelBranch:
    """States of the model, with positions of the required density; they are computed together at the end.

    Attributes:
        model: the particles.
        dense: positions for each step that the scene gives.
        shift: of the displacements that it gives [LU].
    """

    def __init__(self, scene: Scene, settings: Settings, model: Reduced, dense: int = 1, shift: float = 0.0) -> None:
        """Begin apart."""
        self.scene, self.settings, self.model, self.dense, self.shift = scene, settings, model, dense, shift
        self._phase = ""
        self._rows: list[tuple[str, float, bool]] = []
        self._stops: list[tuple[str, Stop, bool]] = []

    @property
    def scale(self) -> float:
        """The force maximum that is expected [FU]."""
        return self.settings.estimate.pull_off_force()

    def begin(self, name: str) -> None:
        """Begin a phase."""
        self._phase = name

    def visit(self, positions: Sequence[float] | Array, asked: Sequence[bool] | None = None) -> None:
        """Displacements [LU] that are known beforehand, and others between them."""
        wanted = [True] * len(positions) if asked is None else asked
        most = max(1, MOST_NUMBERS // max(1, len(positions) * self.model.x.size))
        between = min(self.dense, most)
        for position, one in zip(np.asarray(positions) + self.shift, wanted, strict=True):
            if self._rows and between > 1:
                before = self._rows[-1][1]
                inner = np.linspace(before, float(position), between + 1)[1:-1]
                self._rows += [(self._phase, at, False) for at in inner.tolist()]
            self._rows.append((self._phase, float(position), one))

    def draw(self, stops: Sequence[Stop], asked: Sequence[bool]) -> None:
        """Displacements and positions along x [LU]."""
        self._stops += [(self._phase, stop, one) for stop, one in zip(stops, asked, strict=True)]

    def reach(self, force: float, scale: float) -> None:
        """Go to where a force [FU] is carried."""
        end = self.model.displacement_at(force)
        start = self._rows[-1][1] if self._rows else min(0.0, end) - self.settings.estimate.spacing
        self._rows += [(self._phase, at, True) for at in np.linspace(start, end, BETWEEN + 1)[1:].tolist()]

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """What is held, in equilibrium."""
        if force is not None:
            self.reach(force, abs(force))
        elif displacement is not None:
            self.visit([self.model.apart, displacement])  # what follows from the beginning is as uncertain as the end

    def maximum(self) -> None:
        """Pass the force maximum, densely about it."""
        zero, apart = self._rows[-1][1], self.model.apart
        end = zero + (1.0 - LAST) * (apart - zero)
        dense = COARSE * (2 if self.settings.snaps else 1)
        positions, step = np.linspace(zero, end, dense, retstep=True)
        found = [positions[1:]]
        for _ in range(0 if self.settings.is_smooth else ZOOMS):
            top = float(positions[int(np.argmin(self.model.held(positions)))])
            low, high = max(top - abs(step), end), min(top + abs(step), zero)
            positions, step = np.linspace(high, low, FINE, retstep=True)
            found.append(positions[1:])
        falling = np.unique(np.concatenate(found))[::-1]
        self._rows += [(self._phase, at, True) for at in falling.tolist()]

    def mark(self, name: str) -> None:
        """Nothing is written."""

    def open(self) -> None:
        """Nothing is read off bodies that are apart."""

    def finish(self) -> None:
        """Nothing is left."""

    def trace(self) -> Trace:
        """What a reader sees."""
        rule, spacing = RadiusRule(self.scene, self.settings.tolerance), self.model.estimate.spacing
        if self._stops:
            assert isinstance(self.model, Sliding)
            phases, stops, asked = zip(*self._stops, strict=True)
            displacement, along = (np.asarray(column) for column in zip(*stops, strict=True))
            followed = self.model.drawn(stops)
        else:
            phases, positions, asked = zip(*self._rows, strict=True)
            displacement = np.asarray(positions)
            along, followed = np.zeros_like(displacement), self.model.follow(displacement)
        whole = of_model(phases, displacement, along, asked, followed, rule, spacing, self.model.apart)
        return whole.chosen([i for i, name in enumerate(phases) if name != UNSEEN])
