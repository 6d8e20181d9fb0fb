"""What a table and its cutoff leave out of a law, summed over the pairs of a state."""

from __future__ import annotations

import numpy as np

from contact1d.analysis.pressure import Profile, spacing_of
from contact1d.potentials import DoubleExponential
from contact1d.potentials.table import Table

TAIL_REACH = 5.0
"""Ranges of the law beyond the cutoff up to which its tail is summed: all but a share exp(-5) of it."""


def left_out(law: DoubleExponential, table: Table, profile: Profile) -> float:
    """Σ |F_table(r) - f(r)| |z|/r [FU] of a profile, offset by offset along the chain: memory for one row of pairs."""
    reach = table.cutoff + TAIL_REACH * law.longest_range
    x, lower, upper = profile.x, profile.z_lower, profile.z_upper
    spacing = spacing_of(x)
    near = np.flatnonzero(upper - lower < reach)
    total = 0.0
    farthest = int(reach / spacing)
    for offset in range(-farthest, farthest + 1):
        first = near[(near + offset >= 0) & (near + offset < len(x))]
        across, up = x[first + offset] - x[first], upper[first] - lower[first + offset]
        r = np.maximum(np.hypot(across, up), table.core)
        kept = np.where(r <= table.cutoff, table.force(np.minimum(r, table.cutoff)), 0.0)
        total += float(np.sum(np.where(r < reach, np.abs(kept - law.force(r)) * np.abs(up) / r, 0.0)))
    return total
