"""A normal force, and a cantilever that pulls."""

from contact1d.workflow.experiments.slide.kind import SLIDE

__all__ = ["SLIDE"]
