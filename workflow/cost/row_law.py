"""The interaction at another spacing: a row of opposite particles pulls with the same force per length.

A straight row of spacing h pulls on the particle that faces it, at the distance r, with

    F_h(r) = Σ_j f(√(r² + (jh)²)) r/√(r² + (jh)²),

and F_h(r)/h is what two bodies feel of each other per length. Scaled amplitudes keep it only where a particle feels the
opposite one alone (∝ h) or very many (∝ h²). In between the pair law itself must change its shape: here a sum of
exponentials, fitted to the row of the scene's own spacing. That says nothing about forces along x, which come from
particles that face each other and so from the spacing itself.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from contact1d.potentials import DoubleExponential, Exponential
from contact1d.workflow.settings.estimate import row_force

Array = NDArray[np.float64]
TERMS = 12
"""Exponentials of a fit: fewer fit worse, more cancel each other's digits."""
SHORTEST, LONGEST = 0.35, 1.2
"""Their ranges, from so many times the repulsion's to so many times the longest of the law."""
NEAREST, SAMPLES = 0.2, 600
"""Smallest distance of the fit over the force-free one (or over the repulsion's range), and distances in it."""
TAIL = 1e-9
"""Force at the largest distance of the fit over the law's own."""
ROUND_OFF = 1e-13


@dataclass(frozen=True)
class RowLaw(DoubleExponential):
    """A sum of exponentials in place of the scene's law, which `repulsion` and `attraction` go on to name.

    Displacements count from the force-free distance of that law, and cutoffs follow from it.

    Attributes:
        terms: amplitudes of either sign [FU·LU], ranges [LU].
        misfit: largest deviation of the row's force per length over its scale.
    """

    terms: tuple[Exponential, ...] = ()
    misfit: float = 0.0

    def energy(self, r: ArrayLike) -> Array:
        """V(r) [FU·LU]."""
        return np.asarray(sum(term.energy(r) for term in self.terms))

    def force(self, r: ArrayLike) -> Array:
        """−V′(r) [FU]."""
        return np.asarray(sum(term.force(r) for term in self.terms))

    def stiffness(self, r: ArrayLike) -> Array:
        """V″(r) [FU/LU]."""
        return np.asarray(sum(term.stiffness(r) for term in self.terms))

    @property
    def formula(self) -> str:
        """V(r) as text."""
        return " + ".join(f"{term.amplitude:.17g} exp(-r/{term.range:.17g})" for term in self.terms)


@lru_cache(maxsize=16)  # each level of a knob is asked for several times
def row_law(law: DoubleExponential, own: float, spacing: float) -> RowLaw:
    """The pair law whose rows of `spacing` [LU] pull per length as those of `law` do at the spacing `own` [LU]."""
    nearest = NEAREST * (law.repulsion.range if law.attraction is None else law.force_free_distance())
    reach = law.cutoff_for(TAIL)
    r = np.geomspace(nearest, reach, SAMPLES)
    wanted = row_force(law, r, own, reach) / own
    scale = float(-wanted.min() if law.attraction is not None else wanted.max())
    ranges = np.geomspace(SHORTEST * law.repulsion.range, LONGEST * law.longest_range, TERMS)
    rows = [row_force(DoubleExponential(Exponential(1.0, float(t))), r, spacing, reach) / spacing for t in ranges]
    columns = np.column_stack(rows)
    size = np.linalg.norm(columns, axis=0)
    found, *_ = np.linalg.lstsq(columns / size, wanted, rcond=ROUND_OFF)
    amplitudes = found / size
    misfit = float(np.abs(columns @ amplitudes - wanted).max()) / scale
    terms = tuple(Exponential(float(a), float(t)) for a, t in zip(amplitudes, ranges, strict=True))
    return RowLaw(law.repulsion, law.attraction, terms, misfit)
