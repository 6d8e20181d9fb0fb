"""What to do about it: the cheapest measured variant for each tolerance, and combinations worth measuring."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from workflow.cost.change import Change
from workflow.cost.knobs import Knob
from workflow.cost.record import Advice, VariantRecord

TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
SHARE = 0.25
"""Part of a tolerance that one knob of a combination may use up."""


def combinations(
    knobs: Sequence[Knob], records: Sequence[VariantRecord], base: Change
) -> Iterator[tuple[str, str, Change]]:
    """For each tolerance, every knob at its coarsest value whose error is within SHARE of it: label, what, change."""
    turned = [knob for knob in knobs if not knob.own_reference and not knob.alternative]
    for target in TARGETS:
        change = base
        found: list[str] = []
        for knob in turned:
            level = _coarsest(knob, records, SHARE * target)
            if level is not None:
                change += knob.levels[level].change
                found.append(knob.levels[level].label)
        if found:
            yield f"combined for {power(target)}", ", ".join(found), change


def _coarsest(knob: Knob, records: Sequence[VariantRecord], error: float) -> int | None:
    """Index of the coarsest level within that error; of a knob without a scale of errors, of the cheapest one."""
    measured = {one.label: one for one in records if one.knob == knob.name and one.competes and one.error <= error}
    within = [i for i, level in enumerate(knob.levels) if level.label in measured]
    if not within:
        return None
    if knob.name == "damping":
        return min(within, key=lambda i: measured[knob.levels[i].label].cpu_s)
    return (max if knob.finer == "smaller" else min)(within, key=lambda i: knob.levels[i].value)


def advise(tolerance: float, variants: Sequence[VariantRecord], noisy: bool) -> Advice:
    """One line: the cheapest of `variants` that reaches `tolerance`, and the cheapest that a scene file can say."""
    reaching = sorted((one for one in variants if one.bound <= tolerance), key=lambda one: one.cpu_s)
    asked = f"tolerance {power(tolerance)}"
    if not reaching:
        best = min(variants, key=lambda one: one.bound, default=None)
        nearest = "" if best is None else f" (best {best.bound:.1e}{', by its noise' if noisy else ''}: {best.label})"
        return Advice(tolerance, f"{asked}: not reached by any setting tried{nearest}", "", "")
    cheapest = reaching[0]
    text = f"{asked}: {said(cheapest)}"
    plain = next((one for one in reaching if not one.settings), None)
    if plain is not None and plain is not cheapest:
        text += f"; by the scene file alone: {said(plain)}"
    return Advice(tolerance, text, cheapest.label, "" if plain is None else plain.label)


def power(value: float) -> str:
    """`1e-3`."""
    return f"{value:.0e}".replace("e-0", "e-")


def said(one: VariantRecord) -> str:
    """Label, CPU time and error."""
    spread = f" ± {one.spread:.0e}" if one.spread else ""
    label = f"{one.label} ({one.details})" if one.details else one.label
    return f"{label}, {one.cpu_s:.2g} s of CPU, error {one.error:.1e}{spread}"
