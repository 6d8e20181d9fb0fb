"""Errors of the main results, relative to a reference of much higher accuracy; the largest stands for a variant."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from contact1d.workflow.cost.record import VariantRecord
from contact1d.workflow.experiments import kind_of
from contact1d.workflow.scene import Scene
from contact1d.workflow.units import Quantity


def is_sampled(scene: Scene) -> bool:
    """Whether results are averages over a motion, whose uncertainty is a standard error: with noise, and of a slide."""
    return scene.noise is not None or scene.experiment.motion_is_result


def main_results(scene: Scene, quantities: Mapping[str, Quantity]) -> dict[str, Quantity]:
    """Those that have a relative error: present and not 0. With noise the force that a load holds is no result."""
    names = [name for name in kind_of(scene).main_results if scene.noise is None or name != "force"]
    named = {name: quantities[name] for name in names if name in quantities}
    return {name: one for name, one in named.items() if one.value != 0.0 and math.isfinite(one.value)}


def judged(
    record: VariantRecord, quantities: Mapping[str, Quantity], reference: Mapping[str, Quantity], noisy: bool
) -> VariantRecord:
    """The record with its errors; one that lacks a main result has failed.

    Args:
        record: a variant that ran.
        quantities: that it found.
        reference: main results of the reference.
        noisy: whether uncertainties are standard errors, from which those of the errors follow (`is_sampled`).
    """
    if missing := [name for name in reference if name not in quantities]:
        return replace(record, failure=f"found no {' and no '.join(missing)}")
    values = {name: quantities[name].value for name in reference}
    errors = {name: abs(values[name] / reference[name].value - 1.0) for name in reference}
    worst = max(errors, key=lambda name: errors[name])
    spread = 0.0
    if noisy:
        both = math.hypot(quantities[worst].uncertainty, reference[worst].uncertainty)
        spread = both / abs(reference[worst].value)
    return replace(record, values=values, errors=errors, error=errors[worst], spread=spread)
