"""Contact laws, each told once: its curve, its particles along any path, what it needs of a scene and what it tells.

A new law is a module with a `Law` and its `Particles`, a line in `LAWS`, and the fragment that its effect brings.
"""

from contact1d.workflow.laws.friction import Frictional
from contact1d.workflow.laws.jkr import Jkr
from contact1d.workflow.laws.law import Law
from contact1d.workflow.laws.maugis import Maugis
from contact1d.workflow.laws.pairs import Independent
from contact1d.workflow.laws.rate import Receding
from contact1d.workflow.laws.relaxing import Relaxing
from contact1d.workflow.scene import Scene

LAWS: tuple[type[Law], ...] = (Maugis, Receding, Jkr, Relaxing, Frictional, Independent)
"""The first that applies is a scene's."""


def law_of(scene: Scene) -> type[Law]:
    """The law of a scene, without its numbers."""
    return next(one for one in LAWS if one.applies(scene))
