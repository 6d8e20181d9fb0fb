"""What a run says of the body that its chain stands for: p(r), q(r), the implied work of adhesion, closed forms."""
