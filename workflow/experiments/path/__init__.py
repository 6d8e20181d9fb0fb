"""Prescribed displacement."""

from contact1d.workflow.experiments.path.kind import PATH

__all__ = ["PATH"]
