"""A contact of two chains under a load at a low temperature: particles swing harmonically about their equilibrium.

At a fixed displacement d the free energy is, to first order in kT, A(d) = E(d) + (kT/2) ln det H(d), E the energy of
the equilibrium and H the Hessian there. Under the load F a plate that is free to move has the weight
exp((F d - A(d))/kT), whatever its mass. For independent pairs at any temperature see `boltzmann_pairs`.
"""

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import cholesky_banded

from validation.references.energy import EnergySurface
from validation.references.interaction import Floats
from validation.references.model import ChainModel
from validation.references.solver import trace

NODES = 2001
"""Displacements of the average; between the given ones A is a cubic spline."""


def displacement_under(model: ChainModel, load: float, temperature: float, places: Floats) -> tuple[float, float]:
    """Return the mean displacement of a free plate and its standard deviation in time [LU].

    Args:
        model: two chains whose particles do not snap.
        load: F, compression positive [FU].
        temperature: kT, small against the energies of a pair [FU LU].
        places: displacements, rising or falling, that reach many standard deviations to both sides, shape (n,) [LU].
    """
    surface, energies = EnergySurface(model), []
    for state in trace(model, places):
        u = np.stack([state.lower, state.upper], axis=1)[:, :, 2 - surface.directions :].ravel()
        factor = cholesky_banded(surface.hessian(u, state.displacement), lower=True)
        energies.append(state.energy + temperature * np.log(factor[0]).sum())
    order = np.argsort(places)
    d = np.linspace(places.min(), places.max(), NODES)
    exponent = (load * d - CubicSpline(places[order], np.array(energies)[order])(d)) / temperature
    weight = np.exp(exponent - exponent.max())
    weight /= weight.sum()
    mean = d @ weight
    return mean, float(np.sqrt((d - mean) ** 2 @ weight))
