"""Normal load, then tangential displacement with friction."""

from contact1d.workflow.experiments.tangential.kind import TANGENTIAL

__all__ = ["TANGENTIAL"]
