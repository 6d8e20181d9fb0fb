"""Studies beside the product: what contact1d says, held against references that share no code with it."""
