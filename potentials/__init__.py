"""The interaction of two opposite particles, V(r) = A exp(−r/a) − B exp(−r/b), and its LAMMPS table."""

from contact1d.potentials.double_exponential import DoubleExponential, Exponential

__all__ = ["DoubleExponential", "Exponential"]
