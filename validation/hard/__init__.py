"""What programs of this kind get wrong: classes of hard cases, each against bounds that are not the program's own."""

from validation.hard import (
    buckling,
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
    pairs,
    plane_adhesive,
    random_plane,
    random_scenes,
    relaxing,
    scans,
    settling,
    slides,
    thermal,
    transient,
)
from validation.study import Study

_STIFFNESS, _SHARP, _SIMILARITY, _CORE = pairs.CLASSES
STUDIES: tuple[Study, ...] = (
    _STIFFNESS, _SHARP, random_scenes.RANDOM, loads.LOADS, settling.SETTLING, loops.LOOPS,
    friction.FRICTION, _SIMILARITY, forces.FORCES, motion.MOTION, modes.EQUIPARTITION, *thermal.CLASSES,
    extremes.EXTREMES, _CORE, buckling.BUCKLING, plane_adhesive.PLANE_ADHESIVE, slides.SLIDES, faults.FAULTS, fuzz.FUZZ,
    random_plane.RANDOM_PLANE, *kinks.CLASSES, scans.SCANS, coarse_paths.COARSE_PATHS, lateral.LATERAL,
    transient.TRANSIENT, cohesive.COHESIVE, fits.FITS, relaxing.RELAXING, impacts.IMPACTS,
)  # fmt: skip
