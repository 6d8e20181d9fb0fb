"""Effect [adhesion]: d = g(a) − √(2π a W/E*) at the edge a of the contact, the rule of Heß for JKR contacts.

With a range the contact is that of Maugis and Dugdale: an attraction σ₀ = W/h₀ beyond the edge (`laws.maugis`). With a
range or a rate each load step gives its edges.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Adhesion, Scene


def adhesion(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of adhesion to a rigid plane, in the units of the arguments.

    One without fragments and variables where W is 0. With a range or a rate it is the fragment "cohesion", with the
    stiffness of a particle, that per length, E*, and the stress σ₀, 0 without a range. Else "adhesion", with that
    stiffness and the displacements from which on bodies touch and below which they have separated. The constants of
    each particle are in a separate file.
    """
    effect, stiffness = scene.the(Adhesion), {"adhesion_stiffness": number(scene.bulk_stiffness)}
    if not effect.work:
        return Contribution("adhesion", Stage.CONTACT, ())
    if effect.range or effect.rate:
        modulus = scene.bulk_stiffness / scene.bodies.spacing
        stress = effect.work / effect.range if effect.range else 0.0
        stiffness |= {"adhesion_modulus": number(modulus), "adhesion_stress": number(stress)}
        return Contribution("adhesion", Stage.CONTACT, ("cohesion",), stiffness)
    last = settings.law.parted(0.0) / settings.law.spacing
    variables = stiffness | {
        # Bodies touch within the round-off of a displacement of 0, as in the law.
        "adhesion_touch": number(-1e-9 * scene.bodies.spacing),
        "adhesion_last": number(last * scene.bodies.spacing),
    }
    return Contribution("adhesion", Stage.CONTACT, ("adhesion",), variables)
