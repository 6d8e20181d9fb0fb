"""Records of cost studies as tests read them: cost.json, and the table of docs/performance.md that is made of it."""

from __future__ import annotations

from pathlib import Path

from pydantic import TypeAdapter

from contact1d.workflow.cost.report import CostRecord, table


def markdown(record: CostRecord) -> str:
    """The table of docs/performance.md, and what to do."""
    header, *rows = table(record)
    cells = [header, ["---"] * len(header), *((f"`{name}`", *others) for name, *others in rows)]
    return "".join("| " + " | ".join(row) + " |\n" for row in cells) + f"\n{record.advice}\n"


def read_record(path: Path) -> CostRecord:
    """Read a cost.json. Raises OSError, and ValueError where it is none."""
    return TypeAdapter(CostRecord).validate_json(path.read_text(encoding="utf-8"))
