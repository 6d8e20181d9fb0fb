"""LAMMPS in a process of its own; it runs any deck and is independent of scenes."""
