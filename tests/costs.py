"""Records of cost studies as tests read them: cost.json, and the table of docs/performance.md that is made of it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from pydantic import TypeAdapter

from contact1d.workflow.cost.report import CostRecord, table


def markdown(record: CostRecord) -> str:
    """The table of docs/performance.md."""
    header, *rows = table(record)
    cells = [header, ["---"] * len(header), *((f"`{name}`", *others) for name, *others in rows)]
    return "".join("| " + " | ".join(row) + " |\n" for row in cells)


NUMBERS = {"h", "error", "memory_mb", "without_us", "ratio", "ratio_error"}
"""Fields in which null stands for NaN."""


def read_record(path: Path) -> CostRecord:
    """Read a cost.json. Raises OSError, and ValueError where it is none."""
    return TypeAdapter(CostRecord).validate_python(json.loads(path.read_text(encoding="utf-8"), object_hook=_entry))


def _entry(entry: dict[str, Any]) -> dict[str, Any]:
    return entry | {name: math.nan for name, value in entry.items() if value is None and name in NUMBERS}
