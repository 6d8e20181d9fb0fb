"""Effect [viscoelasticity]: the spring of each particle relaxes, or has a dashpot beside it (`laws.relaxing`).

Its force takes the place of the plane's own. Atoms keep the memory, which goes on at the end of each step.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene, Viscoelasticity


def viscoelasticity(scene: Scene, settings: Settings) -> Contribution:
    """An arm is a fragment of its own, in the order of the terms."""
    own, rows = scene.the(Viscoelasticity), scene.is_stepped
    fragments = ["elapsed_rows" if rows else "elapsed_steps"]
    variables = {"viscoelasticity_stiffness": number(settings.forces.plane_stiffness)}
    if not rows:
        variables["elapsed_step"] = number(settings.motion.time_step)
    if own.retardation_time:
        variables["retardation_time"] = number(own.retardation_time)
        return Contribution("viscoelasticity", Stage.CONTACT, (*fragments, "retardation", "relaxed"), variables)
    variables["viscoelasticity_part"] = number(own.lasting)
    fragments.append("viscoelasticity")
    for arm, term in enumerate(own.terms or (), 1):
        variables |= {f"viscoelasticity_share_{arm}": number(term.share)}
        variables |= {f"viscoelasticity_time_{arm}": number(term.time)}
        fragments += [f"decay_{'rows' if rows else 'steps'}:{arm}", f"viscoelasticity_arm:{arm}"]
    arms = range(1, len(own.terms or ()) + 1)
    fragments += [f"decayed:{len(arms)}"] * rows + [f"relaxing:{len(arms)}"]
    fragments += [*(f"relaxed_arm:{arm}" for arm in arms), "relaxed"]
    return Contribution("viscoelasticity", Stage.CONTACT, tuple(fragments), variables)
