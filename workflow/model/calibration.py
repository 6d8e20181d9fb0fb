"""Shares of the tolerance that open numbers of a scene may use up, as they were measured."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any

FILE = Path(__file__).with_name("calibration.json")


def _value(meaning: str) -> Any:
    """Return a required dataclass field (no default), whose metadata is {"is": meaning}."""
    return field(metadata={"is": meaning})


@dataclass(frozen=True)
class Calibration:
    """Shares of the tolerance, and increments, each with its meaning (`meanings`); the study of them sets others.

    All are dimensionless: relative to the tolerance and to the length or force that the meaning names.
    """

    cutoff: float = _value("force at an automatic cutoff over the law's own, per unit of tolerance")
    table: float = _value("error of the table over the force scale, per unit of tolerance")
    residual: float = _value("norm of the forces left on the particles over the force scale, per unit of tolerance")
    chain: float = _value("force at the end of an automatic chain over the largest one, per unit of tolerance")
    smooth_increment: float = _value("increment of a smooth search over the longest range, at every tolerance")
    loading_increment: float = _value(
        "increment where pairs snap, and on a rigid plane, over the way from touch to the preload, at every tolerance"
    )
    still_step: float = _value("ω_max·Δt of a motion that comes to rest, without noise, at every tolerance")


def meanings() -> dict[str, str]:
    """Return the meaning of each field of `Calibration` as text, by its name, in the order of the fields."""
    return {entry.name: entry.metadata["is"] for entry in fields(Calibration)}


def calibration_of(document: Mapping[str, Any]) -> Calibration:
    """Return the values in the contents of `calibration.json` as floats; entries of other names are ignored.

    Raises:
        KeyError: a value is missing.
    """
    return Calibration(**{name: float(document["values"][name]["value"]) for name in meanings()})


CALIBRATION = calibration_of(json.loads(FILE.read_text(encoding="utf-8")))
