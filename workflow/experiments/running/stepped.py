"""Rows of a deck in which nothing has to come to rest: steps of one run, each in a frame of rows.bin."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from contact1d.analysis.pressure import Profile
from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.lattice import bodies
from contact1d.workflow.deck.parts import PLANE_DEPTH
from contact1d.workflow.deck.steps import Row
from contact1d.workflow.engine.failure import NOT_FINITE
from contact1d.workflow.engine.frames import last_frames
from contact1d.workflow.engine.session import EngineError, Session

Array = NDArray[np.float64]
FRAMES = "rows.bin"
COLUMNS, ALONG = 3, 4
"""Of a frame: id, z, force along z; and that along x, where the plate goes along it."""
MOST_NUMBERS = 1_000_000
"""Of the frames that are read at once, to bound the memory."""


@dataclass
class SteppedRows:
    """Reads what the rows of one deck left.

    Attributes:
        deck: that runs.
        session: where it runs.
        read: bytes of the frames' file that were read before.
    """

    deck: Deck
    session: Session
    read: int = field(default=0, init=False)

    def __post_init__(self) -> None:
        """Know where the particles stand."""
        self._x = bodies(self.deck.scene, self.deck.settings)[0].particles[:, 0]
        self._nothing = np.zeros_like(self._x)

    @property
    def at_once(self) -> int:
        """How many rows are run and read at a time."""
        return max(1, MOST_NUMBERS // len(self._x))

    @property
    def round_off(self) -> float:
        """Error of a particle's force [FU]: the wall's force is a difference of distances from far below."""
        settings = self.deck.settings
        depth = PLANE_DEPTH * max(settings.largest_displacement, self.deck.scene.bodies.spacing)
        return float(np.finfo(np.float64).eps) * depth * settings.plane_stiffness

    def profiles(self, rows: Sequence[Row]) -> list[Profile]:
        """Profiles of the last rows in their order, over x from the body's middle, wherever it is along the plane.

        A particle that carries stands on the plane.

        Raises:
            EngineError: particles were lost, or a number is not finite.
        """
        path, step = self.session.folder / FRAMES, self.session.timestep
        columns = ALONG if self.deck.scene.experiment.goes_along else COLUMNS
        try:
            frames, self.read = last_frames(path, len(rows), len(self._x), columns, self.read)
        except ValueError:
            raise EngineError("atoms are missing", self.session.phase, step, self.session.folder, "") from None
        if not np.isfinite(frames).all():
            raise EngineError(NOT_FINITE, self.session.phase, step, self.session.folder, "")
        units, spacing = self.deck.units, self.deck.scene.bodies.spacing
        heights = units.from_deck(frames[:, :, 0], "LU")
        pressures = units.from_deck(frames[:, :, 1], "FU") / spacing
        surfaces = np.where(pressures != 0.0, 0.0, heights)
        none = self._nothing
        if columns == COLUMNS:
            return [Profile(self._x, none, z, p, none) for z, p in zip(surfaces, pressures, strict=True)]
        shears = units.from_deck(frames[:, :, 2], "FU") / spacing
        return [Profile(self._x, none, z, p, q) for z, p, q in zip(surfaces, pressures, shears, strict=True)]
