"""Effect [cantilever]: F_x = c (v t − X) pulls the plate along x through a spring whose far end moves at velocity v.

Plate and particles move at v on average, and so does their heat bath: drag is relative to v, not to rest,

    F_i = −γ (v_i − v)  on each upper particle,    F = −c_plate (V − v)  on the plate,

since the bulk moves with its body. Otherwise the cantilever would measure a drag that is no friction of the contact.
"""

from contact1d.workflow.deck.effects import Contribution, Stage, first_upper_anchor, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Cantilever, Scene


def cantilever(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the spring along x and its drive, in the units of the arguments.

    Variables are the atom ID of an upper anchor, the stiffness, the drag of a particle and of the plate, and as lists,
    with a value for each leg of the drive, velocity and timestep. A fragment after each measurement adds up energies.
    The fragments that start the drive and begin further legs are those of phases, and not in it.
    """
    legs = settings.motion.drive
    velocities, clocks = [leg.velocity for leg in legs], [leg.time_step for leg in legs]
    variables = {
        "cantilever_grip_id": str(first_upper_anchor(scene, settings)),
        "cantilever_stiffness": number(scene.the(Cantilever).stiffness),
        "cantilever_velocity": " ".join(map(number, velocities)),
        "cantilever_time_step": " ".join(map(number, clocks)),
        "cantilever_drag": number(settings.motion.damping),
        "cantilever_plate_drag": number(settings.motion.plate_damping),
    }
    return Contribution(
        "cantilever",
        Stage.PULL,
        ("cantilever",),
        variables,
        step_end=("steps/measured_energy",),
        integrates="cantilever_driver",
    )
