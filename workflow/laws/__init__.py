"""Contact laws: the force–displacement curve of a body, and the forces of its particles along any path.

A new law is a module with a `Law` and its `Particles`, a line in `LAWS`, and the LAMMPS fragment of its effect.
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
"""All laws, in the order in which a scene is offered to them: the first that applies is its law."""


def law_of(scene: Scene) -> type[Law]:
    """Return the class of the contact law of a scene: the first of `LAWS` whose `applies` is true for it.

    That is Maugis, Receding or Jkr with adhesion, Relaxing with [viscoelasticity], Frictional with [friction], and
    Independent for any other scene.
    """
    return next(law for law in LAWS if law.applies(scene))
