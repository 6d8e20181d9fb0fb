"""Force curves in the files of instruments, as afmformats reads them (the extra `curves`)."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from contact1d.workflow.fit.headings import DataError
from contact1d.workflow.fit.plan import FitPlan

if TYPE_CHECKING:
    from pandas import DataFrame

NamedTable = tuple[str, tuple[float, float] | None, "Callable[[], DataFrame]"]
"""Name of a curve, its position in a map or None, and a function that reads its columns in SI."""
ENDINGS = (".jpk-force", ".jpk-force-map", ".jpk-qi-data", ".jpk-qi-series", ".ibw", ".h5", ".tab")
"""Endings of the names of files of instruments."""


def instrument_curves(path: Path, plan: FitPlan) -> Iterator[NamedTable]:
    """Yield (name, position (x, y) [m] or None, function that reads the columns) of each curve of an instrument's file.

    The name of one of several curves ends with its number in the file.

    Raises:
        DataError: afmformats is not installed or can't read the file, or a spring constant is missing.
    """
    try:
        from afmformats import errors, load_data
    except ImportError:
        raise DataError(
            'is a file of an instrument, which afmformats reads: pip install "contact1d[curves]", or export the curve '
            "as CSV"
        ) from None
    logging.getLogger("afmformats").setLevel(logging.CRITICAL + 1)  # it logs the errors that it raises
    try:
        curves = load_data(path)
    except (Exception, errors.AFMFileFormatError, errors.MissingMetaDataError) as error:  # no exceptions by their class
        reason = str(error).partition("\n")[0]
        raise DataError(f"afmformats can't read it ({type(error).__name__}: {reason}); export it as CSV") from None
    for curve in curves:
        x, y = (float(curve.metadata.get(f"position {axis}", math.nan)) for axis in "xy")
        is_map = len(curves) > 1
        yield path.stem + f"-{curve.enum}" * is_map, (x, y) if is_map else None, partial(_columns, curve, plan)


def _columns(curve: Any, plan: FitPlan) -> DataFrame:
    """Return the columns of a curve of afmformats in SI, indexed by the number of the point, from 1.

    z or d, F or deflection, segment, and t where it is known. Heights grow away from the sample, z and d towards it.
    The force over the spring constant of the file is the deflection, so that the stiffness of the plan replaces it.

    Raises:
        DataError: the plan has no stiffness; the message then has that of the file.
    """
    from pandas import DataFrame

    spring, is_rigid = curve.metadata.get("spring constant"), not math.isfinite(plan.stiffness)
    names = ["height (measured)", "height (piezo)", "tip position"][2 * is_rigid :]
    column = next((name for name in names if name in curve), None)
    if column is None:
        known = f', as in the file: stiffness = "{spring:.6g} N/m"' if spring else ""
        raise DataError(f"has heights of the piezo and no indentation: give [instrument] stiffness{known}")
    along, force = "d" if column == names[-1] else "z", "F" if is_rigid or not spring else "deflection"
    table = DataFrame({along: -curve[column], force: curve["force"], "segment": curve["segment"]})
    if "time" in curve:
        table["t"] = curve["time"]
    if force == "deflection":
        table[force] /= spring
    return table.set_axis(table.index + 1, axis="index")
