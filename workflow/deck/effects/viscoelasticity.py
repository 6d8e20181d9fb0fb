"""Effect [viscoelasticity]: the spring of each particle relaxes, or has a parallel dashpot (`laws.relaxing`).

Its force replaces that of the plane. Atoms keep the loading history, updated at the end of each step.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Scene


def viscoelasticity(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the viscoelastic springs, in the units of the arguments.

    Variables are the stiffness of the plane, the part of it that lasts, and share and time of each term of the Prony
    series, each with fragments of its own, in their order; with a retardation time, in place of these, that time, with
    the fragments of springs with a parallel dashpot. Load steps that are timesteps of one run have their own durations,
    else each lasts a timestep of the motion.
    """
    effect, rows = scene.relaxation, scene.is_stepped
    fragments = ["elapsed_rows" if rows else "elapsed_steps"]
    variables = {"viscoelasticity_stiffness": number(settings.forces.plane_stiffness)}
    if not rows:
        variables["elapsed_step"] = number(settings.motion.time_step)
    if effect.retardation_time:
        variables["retardation_time"] = number(effect.retardation_time)
        return Contribution("viscoelasticity", Stage.CONTACT, (*fragments, "retardation", "relaxed"), variables)
    variables["viscoelasticity_part"] = number(effect.lasting)
    fragments.append("viscoelasticity")
    for arm, term in enumerate(effect.terms, 1):
        variables |= {f"viscoelasticity_share_{arm}": number(term.share)}
        variables |= {f"viscoelasticity_time_{arm}": number(term.time)}
        fragments += [f"decay_{'rows' if rows else 'steps'}:{arm}", f"viscoelasticity_arm:{arm}"]
    arms = range(1, len(effect.terms) + 1)
    fragments += [f"decayed:{len(arms)}"] * rows + [f"relaxing:{len(arms)}"]
    fragments += [*(f"relaxed_arm:{arm}" for arm in arms), "relaxed"]
    return Contribution("viscoelasticity", Stage.CONTACT, tuple(fragments), variables)
