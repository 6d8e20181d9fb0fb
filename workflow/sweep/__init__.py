"""A base scene and axes to a run for each point, one table of all results, and figures over the axes."""
