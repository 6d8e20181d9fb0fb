"""Effect [horizontal]: particles may also move along x, against k_t u_x; k_t may differ from the normal stiffness."""

import math

from contact1d.workflow.deck.effects import LEAST_SLENDERNESS, MOST_BINS_ACROSS, Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def horizontal(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the motion of particles along x.

    The fragment "horizontal" without variables where springs are as stiff along x as along z. Else also "far", the long
    bonds that make up the difference, with their type, half the difference of the stiffnesses, length and the edge of
    the bins of LAMMPS's neighbour lists, in the units of the arguments.
    """
    if settings.chains.far == 0.0:
        return Contribution("horizontal", Stage.SPRINGS, ("horizontal",))
    # A body without end is a box as narrow as its period, whatever the length of its far bonds.
    narrow = settings.chains.lower * scene.bodies.spacing if scene.bodies.periodic else math.inf
    difference = abs(scene.tangential_stiffness - settings.forces.bulk_stiffness)
    longest_bin = max(settings.chains.far / MOST_BINS_ACROSS, settings.forces.cutoff)
    variables = {
        "far_bond_type": "3" if scene.neighbours else "2",
        "far_bond_coefficient": number(difference / 2),
        "far_length": number(settings.chains.far),
        "far_bin": number(min(longest_bin, narrow / LEAST_SLENDERNESS)),
    }
    return Contribution("horizontal", Stage.SPRINGS, ("horizontal", "far"), variables, springs=("far_springs",))
