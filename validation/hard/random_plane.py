"""Random scenes of every profile, law and experiment on the rigid plane, each number and some points of p(r) judged."""

from validation.hard.draws import RandomClass
from validation.hard.judge import OUTSIDE, Judge
from validation.row import Row, tables_beside
from validation.study import Bench, Lines, Study

SOURCE, TING = "the MDR by quadrature of the body", "Lee, Radok and Ting"
CLASSES = [RandomClass(name, **table) for name, table in tables_beside(__file__).items()]
PLANE, COHESIVE, RELAXING, IMPACTS, *_ = CLASSES


def random_rows(bench: Bench, of: RandomClass, source: str) -> list[Row]:
    """Rows of a class in the form that is asked for."""
    judge = Judge()
    for case in of.cases(of.full if bench.full else of.quick):
        judge.add(case, case.run(bench))
    return judge.rows(f"random scenes of seed {of.seed}", source, OUTSIDE)


def measure(bench: Bench) -> Lines:
    """Rows of the random scenes."""
    return random_rows(bench, PLANE, SOURCE)


RANDOM_PLANE = Study(
    "random_plane",
    "Random scenes on the rigid plane, with kinks and loops",
    "Are all results within their uncertainties, and those whose uncertainty exceeds the tolerance named by a "
    "warning, where the slope of the profile jumps inside the contact, where a table of points describes the body, "
    "along coarse loops with instabilities, and in small cycles with slip?",
    measure,
)
