"""From a material to a scene: choice of the model, and the interaction that gives a required F_A and a₀."""
