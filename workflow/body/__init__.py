"""Results of the body that a chain represents: p(r), q(r), the implied work of adhesion, closed forms."""
