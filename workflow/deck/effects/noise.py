"""Effect [noise]: thermal forces of variance 2 γ k_BT/Δt on every particle, with the damping γ (Langevin)."""

from contact1d.workflow.deck.effects import Contribution, Stage, first_upper_anchor, number
from contact1d.workflow.model.settings import Settings
from contact1d.workflow.scene import Noise, Scene


def noise(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the Langevin thermostat of the particles.

    Variables are k_BT, the relaxation time m/γ that `fix langevin` takes, in the units of the arguments, and the seed.
    Where the plate has a drag, there is also a thermostat of one of its anchors. In a slide there are also the drag for
    the time before the drive, where that is another one, and fragments around each measurement that count the heat; in
    other experiments there are none of these.
    """
    variables = {
        "noise_temperature": number(scene.the(Noise).temperature),
        "noise_damp": number(scene.bodies.mass / settings.motion.damping),
        "noise_seed": str(scene.the(Noise).seed),
    }
    fragments: tuple[str, ...] = ("noise",)
    before: tuple[str, ...] = ("steps/heat",)
    after: tuple[str, ...] = ("steps/heating",)
    if settings.motion.plate_damping > 0.0:
        fragments += ("noise_plate",)
        before += ("steps/heat_plate",)
        after = ("steps/heating_plate",)
        variables["noise_plate_damp"] = number(
            settings.motion.plate_mass / settings.chains.upper / settings.motion.plate_damping
        )
        variables["noise_plate_id"] = str(first_upper_anchor(scene, settings))
    if (
        settings.motion.drive and settings.motion.settling_damping != settings.motion.damping
    ):  # until `steps/tallied_heat`
        fragments += ("noise_settling",)
        variables["noise_settling_damp"] = number(scene.bodies.mass / settings.motion.settling_damping)
    if not settings.motion.drive:  # the heat is no result
        before = after = ()
    return Contribution("noise", Stage.DRAG, fragments, variables, step_begin=before, step_end=after)
