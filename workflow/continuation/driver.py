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

    A leg is a part of the path between two turns of the loading: it begins where the loading turns. A force is
    approached from the last state. Displacements and forces are positive in compression.
    """

    @property
    def settings(self) -> Settings:
        """The numbers of the run that a scene may leave open: forces, chains, increments, motion."""

    @property
    def model(self) -> Particles:
        """The particles of the reduced model, which are driven or predict what LAMMPS will do."""

    @property
    def scale(self) -> float:
        """The expected force maximum of the unloading [FU], positive; 0 without attraction."""

    def begin(self, name: str) -> None:
        """Begin a phase of this name with the next load step; a repeated name gets a number."""

    def visit(self, positions: Sequence[float] | NDArray[np.float64], along: Sequence[float] | None = None) -> None:
        """Go to displacements [LU] one after another, and to positions `along` x [LU], by default 0."""

    def reach(self, force: float, scale: float) -> None:
        """Go on until the contact carries a `force` [FU], compression positive.

        It is reached within a share of the tolerance of `scale` [FU].
        """

    def maximum(self) -> None:
        """Unload to the force maximum (largest tension); the last state is then at it."""

    def open(self) -> None:
        """Pull the bodies apart, so that the last state has no, or next to no, force."""

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a displacement [LU], or else a force [FU], for a `duration` [TU]; the other argument is None."""

    def follow(self, history: History) -> None:
        """Go through displacements [LU] or forces [FU] over time [TU]; the bodies are apart at first."""

    def fly(self, velocity: float) -> None:
        """Move freely from displacement 0 with an impact velocity [LU/TU] until the bodies separate or stick."""

    def mark(self, name: str) -> None:
        """Report the last state, with its profile, under a name."""
