"""What speed is measured with: scaling, ranks, decks beside hand-written ones, other solvers."""
