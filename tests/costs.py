"""Records of cost studies as tests read them: cost.json, and the table of docs/performance.md that is made of it."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contact1d.workflow.cost.report import (
    EFFECT_COLUMNS,
    Advice,
    CostRecord,
    EffectCost,
    KnobRecord,
    Order,
    VariantRecord,
    effect_row,
)


def effects_markdown(record: CostRecord) -> str:
    """The table of docs/performance.md of what each effect costs, with the advice below it."""
    rows = [EFFECT_COLUMNS, ["---"] * len(EFFECT_COLUMNS)]
    cells = [(f"`{row[0]}`", *row[1:]) for row in map(effect_row, record.effect_costs)]
    table = "".join("| " + " | ".join(row) + " |\n" for row in [*rows, *cells])
    return table + "\n" + "".join(f"- {one.text}\n" for one in record.advice)


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
