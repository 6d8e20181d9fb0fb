"""Effect [friction]: |s| ≤ μ f of each particle on a rigid plane, s its tangential force k_t u up to there."""

from contact1d.workflow.deck.effects import Contribution, Stage, number, sphere_radius
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Friction, Scene


def friction(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of friction on a rigid plane, in the units of the arguments.

    Variables are the normal stiffness of the plane, the tangential one of a particle, μ, and the height z of the wall,
    the negative radius of the particles. It has the `atom_style` sphere: particles are spheres in system.data.
    """
    variables = {
        "friction_normal_stiffness": number(settings.forces.plane_stiffness),
        "friction_tangential_stiffness": number(scene.tangential_stiffness),
        "friction_coefficient": number(scene.the(Friction).coefficient),
        "friction_level": number(-sphere_radius(scene, settings)),
    }
    return Contribution("friction", Stage.CONTACT, ("friction",), variables, atom_style="sphere")
