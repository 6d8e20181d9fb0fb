"""Ways out of a run: its results and tables as text for other programs, and as a dataset of xarray."""

from __future__ import annotations

import io
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from contact1d.analysis.curve import Columns, put_columns
from contact1d.files import AnyPath, write_whole
from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.units import NUMBER, Quantity

TEX = {"±": r"\pm", "µ": r"\mu ", "·": r"\cdot ", "²": "^2"}
"""Signs in a quantity."""


def kept(text: str, path: AnyPath | None) -> str:
    """The text, which is written to the path if there is one."""
    if path:
        write_whole(Path(path), text)
    return text


def listed(results: Mapping[str, Quantity]) -> Columns:
    """The results as a table, a row for each."""
    parts = ("value", "uncertainty", "unit")
    return Columns({"name": [*results]} | {part: [getattr(one, part) for one in results.values()] for part in parts})


def csv_text(columns: Columns) -> str:
    """A table as a CSV file has it."""
    file = io.StringIO()
    put_columns(file, columns, columns.units)
    return file.getvalue()


def latex(results: Mapping[str, Quantity]) -> str:
    """The results as a tabular: the name, and value, uncertainty and unit."""
    lines = [f"{name.replace('_', ' ')} & ${_tex(one)}$ \\\\" for name, one in results.items()]
    return "\n".join([r"\begin{tabular}{ll}", *lines, r"\end{tabular}", ""])


def _tex(one: Quantity) -> str:
    number, unit = str(one).rsplit(" ", 1) if one.unit != NUMBER else (str(one), "")
    number = re.sub(r"e([+-]\d+)", lambda power: rf"\cdot 10^{{{int(power[1])}}}", number)
    text = number + re.sub(r"[A-Za-z]+", r"\\mathrm{\g<0>}", rf"\,{unit}" if unit else "")
    for sign, tex in TEX.items():
        text = text.replace(sign, tex)
    return text


def dataset(columns: Columns, attributes: Mapping[str, str]) -> Any:
    """The columns over their rows, with units. Raises Contact1dError where xarray isn't installed."""
    try:
        import xarray
    except ImportError:
        raise Contact1dError("a dataset needs xarray: install it with pip install 'contact1d[tables]'") from None
    variables = {
        name: ("row", column, {"units": columns.units[name]} if name in columns.units else {})
        for name, column in columns.items()
    }
    return xarray.Dataset(variables, attrs=attributes)
