"""Means of correlated samples with their standard errors, and how large a chi-square may be by chance."""

from __future__ import annotations

import math

import numpy as np
from scipy.stats import chi2

from validation.references.interaction import Floats

SIGMAS = 4.0
"""Standard errors of the sample: one row in 16 000 fails by chance, and the seeds are fixed."""
CHANCE = 1e-4
"""Of a row that judges a chi-square."""
BLOCKS = 20


def chi_square_bound(count: int) -> float:
    """χ² of `count` block means, whose own errors are known from BLOCKS blocks only: each is an F-variable."""
    return float(chi2.ppf(1.0 - CHANCE, count)) * (BLOCKS - 1) / (BLOCKS - 3)


def block_mean(samples: Floats) -> tuple[Floats, Floats]:
    """Mean and standard error of each column, from blocks."""
    blocks = np.array([block.mean(axis=0) for block in np.array_split(samples, BLOCKS)])
    return samples.mean(axis=0), blocks.std(axis=0, ddof=1) / math.sqrt(BLOCKS)
