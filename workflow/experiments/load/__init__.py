"""Equilibrium under a normal force."""

from contact1d.workflow.experiments.load.kind import LOAD

__all__ = ["LOAD"]
