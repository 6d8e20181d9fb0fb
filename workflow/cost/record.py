"""What a cost study found, as one value, and cost.json."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from contact1d.workflow.cost.orders import Order

RECORD = "cost.json"


@dataclass(frozen=True)
class VariantRecord:
    """One variant, measured.

    Attributes:
        label: "cutoff 3.67 LU".
        knob, value: which knob, and where it stands; NaN for what is no place on a scale.
        details: what it is made of, where the label does not say it.
        scene_keys: changes that a scene file can say; effects left out are "without …".
        same_physics: whether its errors are errors at all: not where an effect was left out.
        own_reference: whether the errors are against the finest level of its own knob.
        values: main results.
        errors: of each, relative to the reference.
        error, spread: the largest of them, and its standard error from noise (0 without).
        cpu_s: median CPU time in LAMMPS [s].
        cpu_runs: of each run [s].
        total_s: median wall time of a run, LAMMPS and all around it [s].
        steps: minimiser iterations or timesteps.
        memory_mb: peak of the LAMMPS process; NaN where the system does not tell.
        failure: why there are no numbers; "" where there are.
    """

    label: str
    knob: str
    value: float
    details: str = ""
    scene_keys: tuple[str, ...] = ()
    same_physics: bool = True
    own_reference: bool = False
    values: Mapping[str, float] | None = None
    errors: Mapping[str, float] | None = None
    error: float = math.nan
    spread: float = 0.0
    cpu_s: float = math.nan
    cpu_runs: tuple[float, ...] = ()
    total_s: float = math.nan
    steps: int = 0
    memory_mb: float = math.nan
    failure: str = ""

    @property
    def competes(self) -> bool:
        """Whether it has an error against the reference and a cost, to be compared with others."""
        return not self.failure and self.same_physics and not self.own_reference and math.isfinite(self.error)

    @property
    def bound(self) -> float:
        """The error with its standard error on top."""
        return self.error + self.spread


@dataclass(frozen=True)
class KnobRecord:
    """One knob: see `workflow.cost.knobs.Knob`; `order` of its error, None where there is none to be fitted."""

    name: str
    meaning: str
    finer: str
    own: float
    own_reference: bool
    order: Order | None


@dataclass(frozen=True)
class EffectCost:
    """What an effect costs per timestep, or per force evaluation of a minimiser, which is the same work.

    Attributes:
        name: the effect.
        with_us, without_us: CPU time of a step with all effects, and without this one [µs]; medians.
        ratio, ratio_error: of the two, median over turns, and its standard error.
        particles: of both bodies.
        reason: why it cannot be left out; "" where it can.
        changes: what the main results become without it, over those with it, minus 1.
    """

    name: str
    with_us: float
    without_us: float
    ratio: float
    ratio_error: float
    particles: int
    reason: str = ""
    changes: Mapping[str, float] | None = None

    @property
    def ns_per_particle(self) -> float:
        """What it adds to a step, per particle [ns], by the ratio."""
        return 1e3 * self.with_us * (1.0 - 1.0 / self.ratio) / self.particles


@dataclass(frozen=True)
class Advice:
    """What a tolerance chooses, and the cheapest measured variants that reach it.

    Attributes:
        tolerance: asked for.
        text: one line.
        chosen: label of the scene with this `accuracy.tolerance`, "" where it was not run.
        label: of the cheapest, "" where none reaches it.
    """

    tolerance: float
    text: str
    chosen: str
    label: str


@dataclass(frozen=True)
class CostRecord:
    """A whole study.

    Attributes:
        title, scene, method: of the scene; `scene` is its name.
        effects: that it has.
        reference: label of the reference run, with its main results.
        uncertainties: that the reference run itself estimated, relative.
        base: label of what the knobs are turned from.
        base_error: what is left of error there, the floor of every fit.
        repeats: asked for.
        left_out: knobs that are not turned, with the reason.
    """

    title: str
    scene: str
    method: str
    tolerance: float
    effects: tuple[str, ...]
    reference: str
    reference_values: Mapping[str, float]
    reference_uncertainties: Mapping[str, float]
    base: str
    base_error: float
    repeats: int
    knobs: tuple[KnobRecord, ...]
    variants: tuple[VariantRecord, ...]
    effect_costs: tuple[EffectCost, ...]
    left_out: Mapping[str, str]
    pareto: tuple[str, ...]
    advice: tuple[Advice, ...]
    versions: Mapping[str, str]
    wall_s: float

    def variant(self, label: str) -> VariantRecord:
        """The variant of that label."""
        return next(one for one in self.variants if one.label == label)

    def to_json(self) -> str:
        """Return the text of cost.json; what is no number is null."""
        return json.dumps(_plain(asdict(self)), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def read_record(path: Path) -> CostRecord:
    """Read a cost.json. Raises OSError, and ValueError, KeyError or TypeError where it is none."""
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    knobs = [_numbers(one) | {"order": Order(**one["order"]) if one["order"] else None} for one in data["knobs"]]
    variants = [
        _numbers(one) | {"scene_keys": tuple(one["scene_keys"]), "cpu_runs": tuple(one["cpu_runs"])}
        for one in data["variants"]
    ]
    return CostRecord(
        **data
        | {
            "effects": tuple(data["effects"]),
            "knobs": tuple(KnobRecord(**one) for one in knobs),
            "variants": tuple(VariantRecord(**one) for one in variants),
            "effect_costs": tuple(EffectCost(**_numbers(one)) for one in data["effect_costs"]),
            "pareto": tuple(data["pareto"]),
            "advice": tuple(Advice(**one) for one in data["advice"]),
        }
    )


NUMBERS = {"own", "value", "error", "cpu_s", "total_s", "memory_mb", "with_us", "without_us", "ratio", "ratio_error"}
"""Fields in which null stands for NaN."""


def _numbers(entry: Mapping[str, Any]) -> dict[str, Any]:
    return {name: math.nan if value is None and name in NUMBERS else value for name, value in entry.items()}


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {name: _plain(item) for name, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
