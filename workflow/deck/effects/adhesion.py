"""Effect [adhesion]: d = g(a) − √(2π a W/E*) at the edge a of the contact, the rule of Heß, which makes it JKR's.

With a range it is Maugis and Dugdale's: an attraction σ₀ = W/h₀ beyond the edge (`laws.maugis`). There, and where
the edge takes time, each load step has its edges.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Adhesion, Scene

TOUCH = 1e-9
"""Distance over the spacing at which bodies touch: round-off of a displacement of 0."""


def adhesion(scene: Scene, settings: Settings) -> Contribution:
    """The cells of the particles are in a file of their own. The effect follows the plane. Without W it is none."""
    own, stiffness = scene.the(Adhesion), {"adhesion_stiffness": number(scene.bulk_stiffness)}
    if not own.work:
        return Contribution("adhesion", Stage.CONTACT, ())
    if own.range or own.rate:
        modulus, stress = scene.bulk_stiffness / scene.bodies.spacing, own.work / own.range if own.range else 0.0
        stiffness |= {"adhesion_modulus": number(modulus), "adhesion_stress": number(stress)}
        return Contribution("adhesion", Stage.CONTACT, ("cohesion",), stiffness)
    last = settings.law.parted(0.0) / settings.law.spacing
    variables = stiffness | {
        "adhesion_touch": number(-TOUCH * scene.bodies.spacing),
        "adhesion_last": number(last * scene.bodies.spacing),
    }
    return Contribution("adhesion", Stage.CONTACT, ("adhesion",), variables)
