"""What every page is made of. Texts are plain; on a page `F_A` and `R^0.5` become index and exponent."""

from __future__ import annotations

import base64
import html
import re
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, StrictUndefined

INDEX = re.compile(r"(?<!\w)([^\W\d_][\u0303\u0304]?)_(\w{1,3})(?!\w)")
TOGETHER = re.compile(r" ?= ?(?=[\d−-])|(?<=\d) (?=(?:LU|FU|nm|[µm]N|[MG]Pa)\b|%)")
EXPONENT = re.compile(r"\^(?:\{([^{}]+)\}|([−-]?\d+(?:[./]\d+)?|[a-z](?!\w)))")


def environment() -> Environment:
    """A template engine that escapes what it is given, with the filters `symbols` and `paragraphs`, and the style."""
    made = Environment(autoescape=True, undefined=StrictUndefined, trim_blocks=True, lstrip_blocks=True)
    made.filters |= {"symbols": symbols, "paragraphs": paragraphs}
    made.globals["style"] = text_of("contact1d.workflow.pages", "style.css")
    return made


def text_of(package: str, name: str) -> str:
    """A text file that lies beside a package's modules."""
    return files(package).joinpath(name).read_text(encoding="utf-8")


def symbols(text: str) -> str:
    """Return `text` as HTML, escaped: `F_A` has an index, `R^{2/3}` an exponent, no line ends inside `R = 1000 LU`."""
    whole = TOGETHER.sub(lambda found: found[0].replace(" ", "\u00a0"), html.escape(text))
    indexed = INDEX.sub(r"<i>\1</i><sub>\2</sub>", whole)
    return EXPONENT.sub(lambda found: f"<sup>{found[1] or found[2]}</sup>", indexed)


def paragraphs(text: str) -> Sequence[str]:
    """Return the parts of a text that empty lines separate."""
    return [part.strip() for part in re.split(r"\n\s*\n", text) if part.strip()]


def embedded(path: Path) -> str | None:
    """Return a PNG as a `data:` address, or None where it can't be read."""
    try:
        return "data:image/png;base64," + base64.b64encode(path.read_bytes()).decode("ascii")
    except OSError:
        return None
