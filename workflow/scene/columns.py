"""Columns of a table in a text, by their headings; the terms of a Prony series in such a file."""

from __future__ import annotations

import re
from collections import defaultdict
from pathlib import Path

from contact1d.files import read_text
from contact1d.workflow.scene.instrument_file import ProfileFileError
from contact1d.workflow.scene.profile_file import by_heading, rows_in
from contact1d.workflow.scene.quantities import Place
from contact1d.workflow.scene.si_text import NUMBER

NAMES = by_heading(
    {
        "share": "share, g, g_i, gi",
        "share ±": "share_uncertainty, share uncertainty",
        "time": "time, t, tau, tau_i, taui, τ, τ_i, τi, relaxation time, relaxation_time, zeit, temps",
        "time ±": "time_uncertainty, time uncertainty",
        "f": "f, freq, frequency, frequenz, fréquence",
        "ω": "ω, omega, angular frequency, angular_frequency, kreisfrequenz",
        "E": "e, e(t), modulus, relaxation modulus, relaxation_modulus, relaxationsmodul",
        "E'": "e', e′, e’, storage, storage modulus, storage_modulus, speichermodul",
        "E''": "e'', e″, e′′, e’’, e\", loss, loss modulus, loss_modulus, verlustmodul",
    }
)
"""The name of each column by its headings in lower case, without units."""
UNIT = re.compile(r"\s*/?\s*[\[(/]\s*([^\[\]()]*?)\s*[\])]?$")
"""The unit at the end of a heading: storage modulus [MPa], E'/MPa, ω (rad/s)."""
END_OF_NUMBER = re.compile(r"(?<=[\d.])(?=\s*(?:±|\+|$))")
"""Where the unit of a column belongs: at the end of a cell, and before its ±."""
FORM = (
    "has no lines below headings that are known: share and time [s], also share_uncertainty and time_uncertainty [s]; "
    "or t [s] and E [MPa]; or f [Hz] (or ω [rad/s]), E' [MPa] and E'' [MPa]"
)
KEY = "viscoelasticity.terms"


def lines_in(text: str) -> list[tuple[int, defaultdict[str, str]]]:
    """Return the lines below the headings of a table: number, and cells with their units by the names in `NAMES`.

    There is one line at least. A cell is "" where the line or the table lacks it. The headings are the first line that
    names two known columns.

    Raises:
        ProfileFileError: there are no such lines, or more than 100000.
    """
    rows = iter(rows_in(text.replace('"', "").splitlines()))
    for _, cells in rows:
        columns = [(NAMES.get(UNIT.sub("", cell).lower(), ""), " ".join(["", *UNIT.findall(cell)])) for cell in cells]
        if sum(bool(name) for name, _ in columns) > 1:
            break
    lines = []
    for line, cells in rows:
        pairs = zip(columns, cells, strict=False)
        texts = ((name, unit.join(END_OF_NUMBER.split(cell))) for (name, unit), cell in pairs)
        lines.append((line, defaultdict(str, texts)))
    if not lines:
        raise ProfileFileError(FORM)
    return lines


def put_terms(scene: Place, folder: Path) -> dict[str, str]:
    """Replace, in place, a file that viscoelasticity.terms of a scene names by the list of the terms in it.

    Numbers are as in a scene, with the unit of their column and ±. Return the path of each number with file and line,
    for messages, by its dotted key; empty without a file, and where it is wrong, which is reported.

    Args:
        scene: its keys are already checked for their spelling.
        folder: to which the path of the file is relative.
    """
    file, paths, numbers = scene.find(f"{KEY}.file"), dict[str, str](), []
    if not file or not file.above or not isinstance(file.value, str):
        return paths
    try:
        lines = lines_in(read_text(folder / file.value, fallback="latin-1"))
        if not lines[0][1]["share"]:
            raise ProfileFileError(f"has moduli and no shares: contact1d terms {file.value} --out terms.csv fits them")
        for i, (line, cells) in enumerate(lines):
            texts = {key: f"{cells[key]} ± {cells[f'{key} ±']}".rstrip(" ±") for key in ("share", "time")}
            numbers.append({key: float(text) if NUMBER.fullmatch(text) else text for key, text in texts.items()})
            paths |= {f"{KEY}[{i}].{key}": f"{KEY}[{i}].{key} ({file.value}, line {line})" for key in texts}
    except ValueError as error:
        file.fault(str(error))
    else:
        file.above.source = file
        file.above.put(numbers)
    return paths
