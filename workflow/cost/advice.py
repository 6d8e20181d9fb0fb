"""What `[accuracy] tolerance` does about it, what a scene could do for less, and combinations worth measuring.

What a tolerance chooses is good in every scene of a study of many (`workflow.settings.calibration`); one scene may
need less.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from contact1d.workflow.cost.change import Change
from contact1d.workflow.cost.knobs import Knob
from contact1d.workflow.cost.record import Advice, VariantRecord
from contact1d.workflow.scene import Scene
from contact1d.workflow.settings.settings import Settings

TARGETS = (1e-2, 1e-3, 1e-4, 1e-5)
KNOB_SHARE = 0.25
"""Part of a tolerance that one knob of a combination may use up."""
WORTHWHILE_SAVING = 0.9
"""CPU time over that of what the tolerance chooses, below which something is worth saying: medians differ by less."""


def combinations(
    knobs: Sequence[Knob], records: Sequence[VariantRecord], base: Change
) -> Iterator[tuple[str, str, Change]]:
    """For each tolerance, every knob at its coarsest value with an error within KNOB_SHARE of it."""
    turned = [knob for knob in knobs if not knob.own_reference and not knob.alternative]
    for target in TARGETS:
        change = base
        found: list[str] = []
        for knob in turned:
            level = _coarsest(knob, records, KNOB_SHARE * target)
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


def choice(scene: Scene, settings: Settings) -> str:
    """What the settings of a scene are, in the words of the knobs."""
    words = []
    if settings.table is not None and scene.interaction is not None:
        words.append(f"table of {settings.table.points} points")
        if scene.interaction.attraction is not None:
            words.append(f"cutoff {settings.cutoff:.3g} LU")
    words.append(f"chain of {settings.particles} particles")
    if scene.method == "dynamic":
        words.append(f"time step {settings.time_step:.3g} TU")
    else:
        words.append(f"residual {settings.force_tolerance / settings.force_scale:.0e}")
        if scene.experiment.kind != "path":
            step = settings.smooth_step if settings.is_smooth else settings.displacement_step
            words.append(f"increment {step:.3g} LU")
    return ", ".join(words)


def advise(tolerance: float, variants: Sequence[VariantRecord], noisy: bool) -> Advice:
    """One line: what `[accuracy] tolerance` chooses and what that was measured to be, and what reaches it for less.

    Args:
        tolerance: that is asked for.
        variants: that compete.
        noisy: whether errors have a standard error.
    """
    chosen = next((one for one in variants if one.knob == "tolerance" and math.isclose(one.value, tolerance)), None)
    reaching = sorted((one for one in variants if one.bound <= tolerance), key=lambda one: one.cpu_s)
    if chosen is None:
        text = f"tolerance {power(tolerance)}: was not run"
    else:
        text = f"tolerance {power(tolerance)}: chooses {chosen.details}: {_measured(chosen)}"
        text += "" if chosen in reaching else ", which is not enough"
    limit = WORTHWHILE_SAVING * chosen.cpu_s if chosen in reaching and chosen is not None else math.inf
    less = [one for one in reaching if one.cpu_s < limit]
    if less:
        text += f"; {'cheaper' if limit < math.inf else 'the cheapest'} in this scene: {said(less[0])}"
    elif limit < math.inf:
        text += "; nothing else that was tried is clearly cheaper"
    else:
        best = min(variants, key=lambda one: one.bound, default=None)
        nearest = "" if best is None else f" (best {best.bound:.1e}{', by its noise' if noisy else ''}: {best.label})"
        text += f"; not reached by any setting tried{nearest}"
    return Advice(tolerance, text, "" if chosen is None else chosen.label, reaching[0].label if reaching else "")


def power(value: float) -> str:
    """`1e-3`."""
    return f"{value:.0e}".replace("e-0", "e-")


def said(one: VariantRecord) -> str:
    """Label, what it is made of if the label does not say it, error and CPU time."""
    details = f" ({one.details})" if one.details and one.knob != "tolerance" else ""
    return f"{one.label}{details}, {_measured(one)}"


def _measured(one: VariantRecord) -> str:
    spread = f" ± {one.spread:.0e}" if one.spread else ""
    return f"error {one.error:.1e}{spread} in {one.cpu_s:.2g} s of CPU"
