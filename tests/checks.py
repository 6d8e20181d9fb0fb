"""A small record of a reproduction: rows of every verdict."""

from __future__ import annotations

import math
from dataclasses import replace

from validation.judging.check import Check
from validation.paper.record import Record, StudyRecord

FORCE = Check(
    study="table1",
    name="adhesion force, R = 1000 LU",
    value=1.48341,
    uncertainty=0.00012,
    unit="FU",
    reference=1.47,
    source="Table 1 of the paper",
    evidence="printed value",
    tolerance=0.015,
    limited_by="print: three digits",
    paper=1.47,
)
BOUND = replace(
    FORCE, study="fig8a", name="distance |ours − JKR| <all N>", value=0.1, uncertainty=0.0, unit="1", reference=0.08,
    source="bound that was asked for", evidence="set bound", comparison="at most", limited_by="range & lattice",
    paper=None,
)  # fmt: skip
LIMIT = replace(
    FORCE, study="fig8a", name="a_cr/a_0", value=0.53, uncertainty=0.001, unit="1", reference=0.63, source="JKR",
    evidence="closed form", tolerance=0.01, limited_by="model", paper=None, differs=True,
)  # fmt: skip
AGAIN = replace(LIMIT, name="F_A again", value=1.0, reference=1.0, differs=False, standing="repeats")
NOTHING = replace(FORCE, name="zero-load radius", value=math.nan, uncertainty=math.nan, unit="LU", reference=28.53)


def record() -> Record:
    table1 = StudyRecord("table1", "Table 1", "The paper says 1 < 2.", "Found F_A.", (FORCE, NOTHING), {}, 3, 90.0)
    fig8a = StudyRecord(
        "fig8a",
        "F(a) is JKR | any N",
        "Says.",
        "One.\n\nTwo.",
        (BOUND, LIMIT, AGAIN),
        {"fig8a.png": 'F "over" a', "no.png": "Lost"},
    )
    return Record((table1, fig8a), {"contact1d": "0.1.0"}, 61.0)
