"""Compression, then the largest tension held."""

from contact1d.workflow.experiments.pull_off.kind import PULL_OFF

__all__ = ["PULL_OFF"]
