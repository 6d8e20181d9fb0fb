"""What programs of this kind get wrong: classes of hard cases, each against bounds that are not the program's own."""

from validation.hard import (
    coarse_paths,
    cohesive,
    extremes,
    faults,
    fits,
    fuzz,
    impacts,
    kinks,
    pairs,
    random_plane,
    random_scenes,
    relaxing,
    scans,
    segments,
    settling,
    thermal,
)
from validation.study import Study

STUDIES: tuple[Study, ...] = (
    *pairs.CLASSES, random_scenes.RANDOM, settling.SETTLING, *thermal.CLASSES, extremes.EXTREMES, faults.FAULTS,
    fuzz.FUZZ, random_plane.RANDOM_PLANE, *kinks.CLASSES, scans.SCANS, coarse_paths.COARSE_PATHS, cohesive.COHESIVE,
    fits.FITS, segments.SEGMENTS, relaxing.RELAXING, impacts.IMPACTS,
)  # fmt: skip
