"""Effect [viscoelasticity]: the spring of each particle relaxes, or has a dashpot beside it (`model.relaxing`).

Its force takes the place of the plane's own. Atoms keep the memory, which goes on at the end of each step.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Viscoelasticity


def viscoelasticity(scene: Scene, settings: Settings) -> Contribution:
    """An arm is a fragment of its own, in the order of the terms."""
    own, elapsed = scene.the(Viscoelasticity), "elapsed_rows" if scene.is_stepped else "elapsed_steps"
    variables = {"viscoelasticity_stiffness": number(settings.forces.plane_stiffness)}
    if own.retardation_time:
        variables["retardation_time"] = number(own.retardation_time)
        return Contribution("viscoelasticity", Stage.DRAG, (elapsed, "retardation", "relaxed"), variables)
    variables["viscoelasticity_part"] = number(own.lasting)
    for arm, term in enumerate(own.terms or (), 1):
        variables |= {
            f"viscoelasticity_share_{arm}": number(term.share),
            f"viscoelasticity_time_{arm}": number(term.time),
        }
    arms = range(1, len(own.terms or ()) + 1)
    before, after = ([f"{name}:{arm}" for arm in arms] for name in ("viscoelasticity_arm", "relaxed_arm"))
    fragments = (elapsed, "viscoelasticity", *before, f"relaxing:{len(arms)}", *after, "relaxed")
    return Contribution("viscoelasticity", Stage.DRAG, fragments, variables)
