"""Random scenes of every profile, law and experiment on the rigid plane, each number and some points of p(r) judged."""

from __future__ import annotations

from validation.hard.draws import ANY, SAMPLED, RandomClass
from validation.hard.judge import OUTSIDE, Judge
from validation.row import Row
from validation.study import Bench, Findings, Study

SOURCE, TING = "the MDR by quadrature of the body", "Lee, Radok and Ting"
PLANE = RandomClass(
    "plane", 20261201, 25, 500,
    {"JKR, path": 0.33, "friction, tangential": 0.12, "JKR, load": 0.08, "JKR, tension": 0.08, "JKR, pull_off": 0.17,
     "elastic, load": 0.11, "elastic, path": 0.11}, ANY, kinked=0.3,
)  # fmt: skip
COHESIVE = RandomClass(
    "cohesive", 20261125, 20, 200,
    {"Maugis, load": 1.0, "Maugis, tension": 1.0, "Maugis, pull_off": 2.0, "Maugis, path": 2.0},
    ("parabola", "cone", "power", "circle", "ellipsoid", SAMPLED),
)  # fmt: skip
RELAXING = RandomClass(
    "relaxing", 20261126, 20, 200,
    {"Prony, one maximum": 0.25, "Kelvin–Voigt, one maximum": 0.05, "Prony, sawtooth": 0.3,
     "Kelvin–Voigt, sawtooth": 0.05, "Prony, creep": 0.35},
)  # fmt: skip
IMPACTS = RandomClass(
    "impacts", 20261126, 20, 200,
    {"elastic, impact": 0.1, "Kelvin–Voigt, impact": 0.2, "Prony, impact": 0.3, "JKR, impact": 0.2,
     "rate, drawn off": 0.2},
)  # fmt: skip
IN_TIME = RandomClass(
    "in_time", 20261127, 0, 0,
    {"rate, one maximum": 2.0, "JKR, one maximum": 1.0, "Kelvin–Voigt, creep": 2.0, "far Prony, one maximum": 1.0,
     "far Prony, impact": 1.0, "elastic, in time": 1.0},
)  # fmt: skip
PUNCHES = RandomClass("punches", 20261127, 0, 0, {"Prony, one maximum": 1.0, "Prony, sawtooth": 1.0}, ("flat_punch",))
CLASSES = (PLANE, COHESIVE, RELAXING, IMPACTS, IN_TIME, PUNCHES)


def random_rows(bench: Bench, of: RandomClass, source: str) -> list[Row]:
    """Rows of a class in the form that is asked for."""
    judge = Judge()
    for case in of.cases(of.full if bench.full else of.quick):
        judge.add(case, case.run(bench))
    return judge.rows(f"random scenes of seed {of.seed}", source, OUTSIDE)


def measure(bench: Bench) -> Findings:
    """Rows of the random scenes."""
    return Findings(random_rows(bench, PLANE, SOURCE))


RANDOM_PLANE = Study(
    "random_plane",
    "Random scenes on the rigid plane, with kinks and loops",
    "Are all results within their uncertainties, and those whose uncertainty exceeds the tolerance named by a "
    "warning, where the slope of the profile jumps inside the contact, where a table of points describes the body, "
    "along coarse loops with instabilities, and in small cycles with slip?",
    measure,
)
