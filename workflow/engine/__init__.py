"""LAMMPS in a process of its own; it runs any deck and knows no scene."""
