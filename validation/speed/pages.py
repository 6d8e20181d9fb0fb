"""Tables of pages: what stands between `<!-- name: begin -->` and `<!-- name: end -->` is written by a command."""

from __future__ import annotations

from pathlib import Path


def between(page: Path, name: str) -> tuple[str, str, str]:
    """What is before, between and after the markers of that name, which belong to the outer parts.

    Raises:
        ValueError: the page has no such markers.
    """
    begin, end = f"<!-- {name}: begin -->\n", f"<!-- {name}: end -->\n"
    before, first, rest = page.read_text(encoding="utf-8").partition(begin)
    inner, last, after = rest.partition(end)
    if not (first and last):
        raise ValueError(f"{page} has no markers {begin.strip()} and {end.strip()}")
    return before + begin, inner, end + after


def write_between(page: Path, name: str, text: str) -> None:
    """Put a text between the markers. Raises ValueError: the page has none."""
    before, _, after = between(page, name)
    page.write_text(before + text + after, encoding="utf-8")
