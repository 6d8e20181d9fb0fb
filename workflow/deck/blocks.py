"""Fragments put together: blocks with the variables that they need, commands, lists over several lines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from contact1d.workflow.deck.fragments import fragment

NUMBERS_PER_LINE = 6


def block(name: str, variables: Mapping[str, str]) -> str:
    """A fragment with its header, below the variables that it needs."""
    lines = "".join(f"variable        {key} index {value}\n" for key, value in variables.items())
    piece = fragment(name)
    header = 5 if piece.redefines else 4
    comments = piece.text[: len(piece.text) - len(piece.text.split("\n", header)[header])]
    return comments + lines + piece.text[len(comments) :]


def commands(names: Sequence[str]) -> str:
    """The commands of fragments, one after the other."""
    return "".join(fragment(name).commands for name in names)


def listed(name: str, texts: Sequence[str]) -> str:
    """`variable … index` over several lines."""
    lines = [" ".join(texts[i : i + NUMBERS_PER_LINE]) for i in range(0, len(texts), NUMBERS_PER_LINE)]
    return f"variable        {name} index " + " &\n                ".join(lines) + "\n"
