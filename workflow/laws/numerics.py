"""Numerical limits that several laws share."""

from __future__ import annotations

ROUND_OFF = 1e-9
"""Relative difference of two displacements, positions or moments that counts as round-off."""
NARROWEST = 1e-12
"""Least height, over the spacing, over which a cell comes to touch or separates: no formula may divide by 0."""
