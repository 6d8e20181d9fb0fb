"""A study of one run and of one that is refused, in a module that a process of its own imports quickly."""

from validation.figures import Panel, Series, figure
from validation.study import Bench, Findings, Refused, Study, claim_row

PLANE = {
    "bodies": {
        "particles": 21, "spacing": 1.0, "profile": {"kind": "flat_punch", "radius": 10.5}, "bulk_stiffness": 0.5,
        "lower": "rigid_plane",
    },
    "experiment": {"kind": "path", "displacements": [0.1]},
}  # fmt: skip


def measure(bench: Bench) -> Findings:
    """A punch on a plane: N k d; and a scene that is refused."""
    found, wrong = bench.run("punch", PLANE), bench.run("wrong", PLANE | {"noise": {}})
    assert not isinstance(found, Refused)
    force = found.results["largest_force"]
    rows = [claim_row("force", found, "largest_force", 21 * 0.5 * 0.1, "N k d"),
            claim_row("refused", wrong, "largest_force", 1.0, "nothing")]  # fmt: skip
    series = Series("run", found.curve.displacement, found.curve.force)
    assert force.unit == "FU"
    return Findings(rows, figure("Force", Panel("d", "F", [series])))


PUNCH = Study("small", "A punch", "Is it N k d?", measure)
