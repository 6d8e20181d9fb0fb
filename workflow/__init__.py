"""The pipeline: a scene, its settings, its deck, LAMMPS at work on it, experiments, and the runs that users start."""
