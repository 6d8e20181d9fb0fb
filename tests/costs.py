"""Records of cost studies as tests read them: cost.json, and the table of docs/performance.md that is made of it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from contact1d.workflow.cost.report import EFFECT_COLUMNS, CostRecord, effect_row


def effects_markdown(record: CostRecord) -> str:
    """The table of docs/performance.md of what each effect costs, with the advice below it."""
    rows = [EFFECT_COLUMNS, ["---"] * len(EFFECT_COLUMNS)]
    cells = [(f"`{row[0]}`", *row[1:]) for row in map(effect_row, record.effect_costs)]
    table = "".join("| " + " | ".join(row) + " |\n" for row in [*rows, *cells])
    return table + "\n" + "".join(f"- {one.text}\n" for one in record.advice)


NUMBERS = {"own", "value", "error", "memory_mb", "with_us", "without_us", "ratio", "ratio_error"}
"""Fields in which null stands for NaN."""


def read_record(path: Path) -> CostRecord:
    """Read a cost.json. Raises OSError, and ValueError where it is none."""
    return TypeAdapter(CostRecord).validate_python(json.loads(path.read_text(encoding="utf-8"), object_hook=_entry))


def _entry(entry: dict[str, Any]) -> dict[str, Any]:
    numbers = {name: math.nan for name, value in entry.items() if value is None and name in NUMBERS}
    empty = {name: {} for name in ("values", "errors") if name in entry and entry[name] is None}
    return entry | numbers | empty
