"""Sweeps: a run of a base scene at each point of given axes, one table of all results, figures over the axes."""
