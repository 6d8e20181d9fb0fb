"""Equilibrium under a normal force."""
