"""What each numerical setting may use up of `[accuracy] tolerance`, as measured: `calibration.json`, read at import.

The file is written by `python -m benchmarks.calibration`, which turns every share over a ladder of values in a number
of scenes, at tolerances of 1e-2 to 1e-5, and takes the cheapest that adds a small part of the tolerance at most to the
errors of the main results in each of them. Nobody types these numbers.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("calibration.json")


@dataclass(frozen=True)
class Calibration:
    """The values; a cost study sets others.

    Attributes:
        cutoff: force at an automatic cutoff over the law's own, per unit of tolerance.
        table: error of the table over the force scale, per unit of tolerance.
        residual: norm of the forces left on the particles over the force scale, per unit of tolerance.
        chain: force at the end of an automatic chain over the largest one, per unit of tolerance.
        smooth_increment: increment of a smooth search over the longest range, the width of the curve's largest tension.
        loading_increment: increment where pairs snap, and on a rigid plane, over the way from touch to the preload.
        still_step: ω_max·Δt of a motion in time that comes to rest, without noise; Verlet's limit is 2.
    """

    cutoff: float
    table: float
    residual: float
    chain: float
    smooth_increment: float
    loading_increment: float
    still_step: float


def shares_of(document: Mapping[str, Any]) -> Calibration:
    """The values in the contents of `calibration.json`. Raises KeyError where one is missing."""
    return Calibration(**{one.name: float(document["shares"][one.name]["value"]) for one in fields(Calibration)})


CALIBRATION = shares_of(json.loads(FILE.read_text(encoding="utf-8")))
