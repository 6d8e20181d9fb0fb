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
        """The numbers of the run that a scene may leave open: forces, numbers of particles, increments, motion."""

    @property
    def model(self) -> Particles:
        """The particles of the reduced model, without their neighbours: driven themselves, or to predict LAMMPS."""

    @property
    def scale(self) -> float:
        """The expected force maximum (largest tension) of the unloading [FU], positive; 0 without attraction."""

    def begin(self, name: str) -> None:
        """Begin a phase of this name with the next load step.

        In LAMMPS's schedule a repeated name gets a number, "loading_2"; on the reduced model it stays as it is.
        """

    def visit(self, positions: Sequence[float] | NDArray[np.float64], along: Sequence[float] | None = None) -> None:
        """Go to displacements [LU], compression positive, in order, and to positions `along` x [LU], by default 0.

        Only a contact that is planned on a rigid plane, or the reduced model, goes along x; a search ignores `along`.

        Raises:
            UntrustedError: under load control, which prescribes no displacement.
        """

    def reach(self, force: float, scale: float) -> None:
        """Load or unload from the last state until the contact carries a `force` [FU], compression positive.

        In LAMMPS it is reached within a share of the tolerance of `scale` [FU]; the reduced model ignores `scale`.

        Raises:
            UntrustedError: in LAMMPS, the contact does not carry the force.
        """

    def maximum(self) -> None:
        """Unload to the force maximum (largest tension); the last state is then at it.

        Where pairs snap in LAMMPS, the last state is that of separated bodies instead, and the next `mark` is of the
        maximum.
        """

    def open(self) -> None:
        """Pull the bodies apart after the force maximum, so that the last state has no, or next to no, force.

        Nothing is done where the search for the maximum has separated them already, and under load control, where the
        last state stays that at the maximum.
        """

    def hold(self, duration: float, displacement: float | None, force: float | None) -> None:
        """Hold a displacement [LU], or else a force [FU], for a `duration` [TU]; the other one is None.

        Compression is positive. In LAMMPS, displacement control needs the displacement and load control the force
        (AssertionError for None); on the reduced model the displacement has priority.
        """

    def follow(self, history: History) -> None:
        """Go through the displacements [LU] or forces [FU] of a history over time [TU]; the bodies are apart at first.

        Raises:
            UntrustedError: in LAMMPS, any contact but one that is planned on a rigid plane.
        """

    def fly(self, velocity: float) -> None:
        """Move freely from displacement 0 with an impact velocity [LU/TU], positive in approach, up to the rebound.

        It ends when the bodies have separated, or when the body moves down again.

        Raises:
            UntrustedError: in LAMMPS, they do neither in 100 times the time of a free motion to the deepest
                displacement.
        """

    def mark(self, name: str) -> None:
        """Report the last state, with its profile, under a name; it is the last one of its phase.

        After a force maximum of pairs that snap in LAMMPS it is the state at that maximum.
        """
