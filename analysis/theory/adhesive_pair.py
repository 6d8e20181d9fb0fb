"""What JKR, DMT and the cylinder have in common: a radius, a contact modulus and a work of adhesion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class AdhesivePair:
    """A curved body and a flat that adhere, any consistent units.

    Args:
        radius: effective radius R [length].
        contact_modulus: E* [stress].
        work_of_adhesion: W = 2 gamma [force/length].

    Raises:
        ValueError: if one of them is not positive.
    """

    radius: float
    contact_modulus: float
    work_of_adhesion: float

    def __post_init__(self) -> None:
        """Check the signs."""
        for name in ("radius", "contact_modulus", "work_of_adhesion"):
            if not getattr(self, name) > 0.0:
                raise ValueError(f"{name} must be positive, got {getattr(self, name)}")
