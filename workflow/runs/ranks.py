"""Whether several MPI ranks can run a scene, with the numbers of one.

Each has the particles of a slice along x (`processors * 1 1`). Sums over the bodies are then added up in another order:
forces differ in their last digits, and what a search or a minimiser makes of them stays within their own thresholds.
"""

from __future__ import annotations

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.engine.launcher import RanksError, launcher_of

FEWEST = 50
"""Particles of a body for each rank: with fewer, telling the neighbours of them takes longer than they do."""


def require_ranks(deck: Deck, ranks: int) -> None:
    """Refuse more ranks than one where they can't, or are no use.

    Raises:
        RanksError: why, and what to do.
    """
    if ranks == 1:
        return
    scene, particles = deck.scene, deck.settings.particles
    if scene.noise is not None:
        raise RanksError(
            "with [noise] each rank draws random forces of its own, so that several give other numbers than one: take "
            "one rank, and seeds side by side (contact1d sweep over noise.seed)"
        )
    if scene.bodies.lower == "rigid_plane":
        raise RanksError(
            "on a rigid plane there are no forces between particles but neighbour springs, so that LAMMPS hands no "
            "particles from rank to rank: take one rank"
        )
    if deck.settings.far > 0.0 and scene.tangential_stiffness > scene.bulk_stiffness:
        raise RanksError(
            "bulk springs that are stiffer along x have anchors far away along x, on other ranks: take one rank, or no "
            "larger bodies.bulk_stiffness_tangential than bulk_stiffness"
        )
    if particles < FEWEST * ranks:
        most = particles // FEWEST
        raise RanksError(
            f"{ranks} ranks for {particles} particles per body are more than can share them: take "
            + (f"at most {most}, {FEWEST} particles each" if most > 1 else "one")
        )
    launcher_of(ranks)
