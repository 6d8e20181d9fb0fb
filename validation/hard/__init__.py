"""What programs of this kind get wrong: classes of hard cases, each against bounds that are not the program's own."""

from validation.hard import (
    coarse_paths,
    cohesive,
    extremes,
    faults,
    fits,
    forces,
    friction,
    fuzz,
    impacts,
    kinks,
    lateral,
    loads,
    loops,
    modes,
    motion,
    plane_adhesive,
    pressed,
    random_plane,
    random_scenes,
    relaxing,
    scans,
    settling,
    sharp,
    similarity,
    slides,
    stiffness,
    thermal,
    transient,
)
from validation.study import Study

STUDIES: tuple[Study, ...] = (
    stiffness.STIFFNESS, sharp.SHARP, random_scenes.RANDOM, loads.LOADS, settling.SETTLING, loops.LOOPS,
    friction.FRICTION, similarity.SIMILARITY, forces.FORCES, motion.MOTION, modes.EQUIPARTITION, *thermal.CLASSES,
    extremes.EXTREMES, *pressed.CLASSES, plane_adhesive.ADHESIVE, slides.SLIDES, faults.FAULTS, fuzz.FUZZ,
    random_plane.RANDOM_PLANE, *kinks.CLASSES, scans.SCANS, coarse_paths.COARSE_PATHS, lateral.LATERAL,
    transient.TRANSIENT, cohesive.COHESIVE, fits.FITS, relaxing.RELAXING,
    impacts.IMPACTS,
)  # fmt: skip
