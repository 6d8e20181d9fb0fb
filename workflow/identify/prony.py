"""From a table of a relaxation, E(t), or E′ and E″ over the frequency, to the terms of a Prony series.

E(t) = E∞ + Σ Eᵢ e^(−t/τᵢ) and E′ + i E″ = E∞ + Σ Eᵢ/(1 − i/ωτᵢ). The times τᵢ are given, four per factor e, and Eᵢ ≥ 0
follow from non-negative least squares (C. L. Lawson, R. J. Hanson, Solving Least Squares Problems, 1974), which leaves
most of them 0. Residuals are relative to the measured modulus, |E′ + i E″|.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from contact1d.files import AnyPath, read_text
from contact1d.workflow.errors import Contact1dError
from contact1d.workflow.scene.columns import lines_in
from contact1d.workflow.scene.si_text import si_value
from contact1d.workflow.units import EXACTNESS, Quantity

UNITS = {"time": "s", "f": "Hz", "ω": "rad/s"}


@dataclass(frozen=True)
class PronySeries:
    """A Prony series E(t) = E (1 − Σ share (1 − e^(−t/time))) that is fitted to a table.

    Attributes:
        terms: as `viscoelasticity.terms` of a scene has them, {"share": 0.4, "time": "1.5 s"}, with rising times.
            Shares are parts of E and add up to 1 at most.
        modulus: the instantaneous modulus E [Pa]; ± is the largest deviation, and what E exceeds the table by.
        deviation: the largest deviation from the table over its modulus, |E′ + i E″| of a body that oscillates.
        warnings: by name: a table that ends before a plateau.
    """

    terms: list[dict[str, Any]]
    modulus: Quantity
    deviation: float
    warnings: dict[str, str]


def prony_terms(table: AnyPath | Mapping[str, Any]) -> PronySeries:
    """Return the Prony series of a table of E(t) over t, or of E′ and E″ over the frequency, by least squares.

    Shares are not negative.

    Args:
        table: path of a text file, or a mapping of headings to columns, such as a pandas.DataFrame. Headings have
            units: "t [s]", "E [MPa]"; or "f [Hz]" or "ω [rad/s]", with "E' [MPa]", "E'' [MPa]", or "storage modulus
            [MPa]" and "loss modulus [MPa]".

    Raises:
        Contact1dError: the table cannot be read, lacks a column or a unit, has a number that is not allowed, or a
            modulus that does not relax.
    """
    from pandas import DataFrame
    from scipy.optimize import nnls

    file, where, values = "" if hasattr(table, "keys") else str(table), "", []
    try:
        text = read_text(Path(file), fallback="latin-1") if file else DataFrame(table).to_csv(index=False)
        where = f"{file or 'table'}: "
        lines = lines_in(text)
        given = lines[0][1]
        names = ("time", "E") if given["E"] else ("ω" if given["ω"] else "f", "E'", "E''")
        for line, cells in lines:
            for name in names:
                where = f"{file or 'table'}, line {line}: {name} "
                values.append(float(si_value(cells[name], UNITS.get(name, "Pa"))[0]))
                if values[-1] <= 0.0 and (values[-1] or name not in ("time", "E''")):
                    raise ValueError("must be greater than 0")
        t, measured, *imaginary = np.reshape(values, (-1, len(names))).T
        if imaginary:
            t, measured = 1.0 / (t * (2.0 * math.pi if names[0] == "f" else 1.0)), measured + 1j * imaginary[0]
        low, high = min(t[t > 0.0]), max(t)
        times = np.geomspace(low, high, 2 * math.ceil(2.0 * math.log(high / low)))
        ages = np.outer(t, 1.0 / times)
        responses = np.c_[np.ones(t.size), 1.0 / (1.0 - 1j * ages) if imaginary else np.exp(-ages)]
        rows, goal = responses / abs(measured)[:, None], measured / abs(measured)
        moduli, _ = nnls(np.vstack([rows.real, rows.imag]), np.append(goal.real, goal.imag))
    except ValueError as error:
        raise Contact1dError(f"{where}{error}") from None
    total, fitted = math.fsum(moduli), responses @ moduli
    pairs = zip(moduli[1:] / total, times, strict=True)
    terms = [{"share": float(share), "time": f"{time:.6g} s"} for share, time in pairs if share > EXACTNESS]
    if not terms:
        raise Contact1dError(f"{file or 'table'}: its modulus does not relax: leave out [viscoelasticity]")
    deviation, first, last = float(max(abs(fitted / measured - 1.0))), max(fitted.real), min(fitted.real)
    warnings = {
        name: f"{rest:.1%} of the modulus is extrapolated: the table ends before the plateau; measure further"
        for name, rest in (("short_times", 1.0 - first / total), ("long_times", 1.0 - moduli[0] / last))
        if rest > deviation + 0.01
    }
    return PronySeries(terms, Quantity(total, float(deviation * total + total - first), "Pa"), deviation, warnings)
