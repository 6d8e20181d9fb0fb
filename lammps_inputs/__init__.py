"""LAMMPS text fragments and scenes that ship with the program."""
