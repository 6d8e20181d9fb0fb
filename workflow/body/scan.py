"""The evaluation of a scan, as a sentence and for results.json: what was removed, the noise, the fitted curve."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from contact1d.analysis.scan import ASPERITY, Taken
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import LENGTH, Scales


def scan_entry(scene: Scene, scales: Scales) -> dict[str, Any]:
    """Return {"scan": entry of results.json} with the evaluation of a measured scan; {} where the profile is no scan.

    The entry has "text" (a sentence, in SI where the scales are known), "shape" (of the fitted curve), "points" and
    "patches" (their numbers), and as {"value", "uncertainty", "unit"} "tilt" [°] and the lengths "centre", "offset",
    "noise", "correlation_length" and, of a fitted parabola or circle, "radius", in metres where the scales are known,
    else in LU. Uncertainties of noise and correlation length are 0.
    """
    taken = scene.bodies.profile.taken
    if taken is None:
        return {}

    def length(value: float, uncertainty: float = 0.0) -> Mapping[str, object]:
        """Return {"value", "uncertainty", "unit"} of a length [LU]: in metres where the scales are known, else LU."""
        if scales.known:
            return scales.in_si(value, uncertainty, LENGTH)
        return {"value": value, "uncertainty": uncertainty, "unit": LENGTH}

    angle, spread = (math.degrees(math.atan(slope)) for slope in taken.tilt)
    entry = {
        "text": scales.in_words(in_words(taken)),
        "shape": taken.shape,
        "points": taken.x.size,
        "centre": length(*taken.centre),
        "offset": length(*taken.offset),
        "tilt": {"value": angle, "uncertainty": spread, "unit": "°"},
        "noise": length(taken.noise),
        "correlation_length": length(taken.correlation),
        "patches": taken.patches,
    }
    if taken.shape in CURVED:
        entry["radius"] = length(*_radius(taken))
    return {"scan": entry}


def misfit(scene: Scene) -> dict[str, str]:
    """Return {"scan_fit": warning} where the shape fitted to a scan misses it by more than the noise; else {}.

    {} also for a smooth curve through a scan, and where the profile is no scan. The warning has the RMS difference
    beyond the noise [LU], with three digits.
    """
    taken = scene.bodies.profile.taken
    if taken is None or not taken.missed:
        return {}
    return {
        "scan_fit": f"the scan is no {taken.shape} within its noise: the fit misses {taken.missed:.3g} LU (RMS) beyond "
        'the noise, which no uncertainty includes; use smooth = "auto" in place of fit'
    }


CURVED = ("parabola", "circle")
"""Fitted shapes whose parameter is a radius."""


def _radius(taken: Taken) -> tuple[float, float]:
    """Return (R, its uncertainty at 95 %) [LU] of a fitted parabola or circle, whose one parameter is 1/R."""
    curvature = float(taken.parameters[0])
    return 1.0 / curvature, 0.5 * float(abs(np.diff(taken.deviations[1, :, 0])[0])) / curvature**2


def in_words(taken: Taken) -> str:
    """Return the evaluation of a scan as a sentence without a full stop, lengths in LU.

    It names the number of points, and whether they are on one side of the apex or on both; apex, offset and tilt [°],
    where it was fitted, that were removed; the fitted curve, noise and correlation length, and in how many patches a
    plane would touch the measured surface.
    """
    removed = [f"apex at {_length_text(*taken.centre)}", f"offset {taken.offset[0]:.4g} LU"]
    if taken.tilt[1] > 0.0:
        angle, spread = (math.degrees(math.atan(slope)) for slope in taken.tilt)
        removed.append(f"tilt {angle:.3g} ± {spread:.1g}°")
    fewest, most = taken.counts
    knots = f"{fewest}" if fewest == most else f"{fewest} to {most}"
    curve = f"a smooth curve with {knots} knots" if taken.shape == "smooth" else f"a {taken.shape}"
    if taken.shape in CURVED:
        curve += f", R = {_length_text(*_radius(taken))}"
    correlated = taken.correlation > 0.5 * taken.pitch  # else the noise is white
    noise = f"noise {taken.noise:.3g} LU"
    noise += f", correlation length {taken.correlation:.2g} LU" if correlated else ", not correlated"
    count = f"{taken.patches} patches" if taken.patches > 1 else "one patch"
    height = f"{ASPERITY * taken.noise:.3g} LU above its lowest point"
    sides = "both sides" if taken.both_sides else "one side"
    return (
        f"{taken.x.size} points on {sides} of the apex; removed: {', '.join(removed)}; fitted: {curve}; {noise}; a "
        f"plane {height} would touch the measured surface in {count}"
    )


def _length_text(value: float, uncertainty: float) -> str:
    """Return a length [LU] as text, with ± its uncertainty where that is not 0: "12.3 LU ± 0.1 LU".

    The length has as many digits as two digits of the uncertainty require, 3 at least; 4 without an uncertainty, or
    where the length is 0.
    """
    spread = f" ± {uncertainty:.2g} LU" if uncertainty else ""
    digits = max(3, 2 + math.floor(math.log10(abs(value) / uncertainty))) if value and uncertainty else 4
    return f"{value:.{digits}g} LU{spread}"
