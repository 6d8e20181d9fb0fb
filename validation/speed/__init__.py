"""Times, side by side in one run: generated decks, the paper's plain way, size, MPI ranks, other people's solvers."""

from validation.speed import overhead, peers, plain, scaling, tolerance
from validation.study import Study

STUDIES: tuple[Study, ...] = (
    tolerance.TOLERANCE, plain.PLAIN, overhead.OVERHEAD, scaling.OUTSIDE, scaling.SCALING, scaling.RANKS, peers.PEERS,
)  # fmt: skip
