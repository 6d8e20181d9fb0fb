"""Effect [plate]: the upper plate is a rigid body, M Z″ = F_contact − F_load − c Z′ (Eq. 5 of the paper)."""

from contact1d.workflow.deck.effects import MOST_BINS_ACROSS, Contribution, Stage, number
from contact1d.workflow.model.settings import STAGGER_SHARE, Settings
from contact1d.workflow.scene import Plate, Scene


def plate(scene: Scene, settings: Settings) -> Contribution:
    """Return the deck part (fragments, variables) of the rigid plate, in the units of the arguments.

    Variables are the drag per anchor, 0 where there is noise, whose thermostat has it, and as a word of LAMMPS whether
    the plate is free along x; of a body that hits obliquely also m l²/I of its spin. Its mass is in system.data,
    distributed over its anchors. A plate of one anchor has a fragment of its own; one that a spring retracts also that
    of the spring, and a wide one with an interaction that of larger bins.
    """
    anchors = settings.chains.upper * (1 if settings.chains.far == 0.0 else 2)
    alone = anchors == 1
    free = {True: "NULL", False: "0.0"} if alone else {True: "on", False: "off"}
    moves_along = "x" in scene.the(Plate).free or scene.is_oblique
    # Drag on the plate comes with heat where there is noise, and then from there.
    drag = 0.0 if scene.noise else settings.motion.plate_damping
    variables = {"plate_damping_per_anchor": number(drag / anchors), "plate_free_x": free[moves_along]}
    fragments: tuple[str, ...] = ("plate_alone" if alone else "plate",)
    if scene.experiment.is_retracted:
        fragments = ("drawn", *fragments)
    if scene.is_oblique:
        fragments = ("spin", *fragments)
        variables["spin_ratio"] = number(scene.spin_ratio)
    width = 2.0 * STAGGER_SHARE * settings.chains.upper * scene.bodies.own_spacing
    wide_bin = width / MOST_BINS_ACROSS
    if scene.interaction and wide_bin > max(settings.forces.cutoff, settings.chains.far / MOST_BINS_ACROSS):
        fragments += ("wide",)
        variables["wide_bin"] = number(wide_bin)
    return Contribution("plate", Stage.PLATE, fragments, variables, integrates="plate")
