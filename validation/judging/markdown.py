"""Tables and texts as Markdown, with what would break them escaped."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table; what would break a cell is escaped."""
    lines: list[Sequence[str]] = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(cell(text) for text in line) + " |" for line in lines) + "\n"


def cell(text: str) -> str:
    """Return `text` on one line, with nothing in it that ends a cell or opens a tag."""
    return re.sub(r"\s+", " ", prose(text.replace("\\", "\\\\").replace("|", "\\|"))).strip()


def prose(text: str) -> str:
    """Return `text` with no tag in it, and `R^{2/3}` as R^(2/3)."""
    return re.sub(r"\^\{([^{}]+)\}", r"^(\1)", text.replace("<", "&lt;"))
