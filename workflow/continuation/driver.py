"""The driver of a script: LAMMPS under displacement or load control, or the reduced model."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from contact1d.workflow.laws.particles import Particles
from contact1d.workflow.laws.path import History
from contact1d.workflow.model.settings import Settings


class Driver(Protocol):
    """The moves of a contact from state to state, forward and back as often as a script requires.

    A leg begins where the loading turns; a force is approached from the last state.
    """

    @property
    def settings(self) -> Settings:
        """The numbers of the run."""

    @property
    def model(self) -> Particles:
        """The particles of the reduced model."""

    @property
    def scale(self) -> float:
        """The expected force maximum [FU]."""

    def begin(self, name: str) -> None:
        """Begin a phase with the next load step."""

    def visit(self, positions: Sequence[float] | NDArray[np.float64], along: Sequence[float] | None = None) -> None:
        """Go to displacements [LU] one after another, and to positions along x [LU]."""

    def reach(self, force: float, scale: float) -> None:
        """Go on until the contact carries a force [FU], within a share of the tolerance of `scale` [FU]."""

    def maximum(self) -> None:
        """Unload to the force maximum; the last state is then at it."""

    def open(self) -> None:
        """Pull the bodies apart."""

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a displacement [LU] or a force [FU] for a time [TU]."""

    def follow(self, history: History) -> None:
        """Go through displacements or forces over time; the bodies are apart at first."""

    def fly(self, velocity: float) -> None:
        """Move freely from d = 0 with an impact velocity [LU/TU] until the bodies separate or stick."""

    def mark(self, name: str) -> None:
        """Report the last state under a name."""
