"""Random scenes of every law and experiment on the plane, a summary of what is wrong, and all numbers.

python -m validation.hard.any_law SEED COUNT FOLDER [LAW or EXPERIMENT ...]     FOLDER/summary.txt, numbers.json
"""

import json
import sys
from collections import Counter
from collections.abc import Iterable
from dataclasses import asdict, replace
from pathlib import Path

from validation.hard.judge import OUTSIDE, Case, Judge
from validation.hard.random_plane import CLASSES, SOURCE
from validation.study import Bench


def any_cases(seed: int, count: int, names: Iterable[str]) -> Iterable[Case]:
    """Scenes of all classes in turn; of the laws and experiments with these names alone."""
    for of in CLASSES:
        kinds = {kind: share for kind, share in of.kinds.items() if not names or {*names} & {*kind.split(", ")}}
        if kinds:
            yield from replace(of, seed=seed, kinds=kinds).cases(count // len(CLASSES) + 1)


def summary(found: Judge) -> str:
    """The rows of the scenes; by law, experiment and name how many are outside or unnamed, and the worst of them."""
    said = [f"{row.verdict} {row.name}: {row.value:.4g}" for row in found.rows("random scenes", SOURCE, OUTSIDE)]
    for title, every in (("OUTSIDE", found.outside), ("UNNAMED", found.unnamed)):
        counts = Counter((n.group, n.name) for n in every)
        worst = {(n.group, n.name): n for n in sorted(every, key=lambda n: n.far)}
        said += [f"{title} {counts[which]}×, worst: {n}" for which, n in worst.items()]
    for title, lists in (("MISSING", found.silent), ("missing, named", found.absent), ("REFUSED", found.refused)):
        said += [f"{title} {name}: {why}" for name, why in lists.items()]
    return "\n".join([*said, f"without an oracle: {dict(found.unjudged)}"])


def main() -> None:
    """`SEED COUNT FOLDER [NAME ...]`."""
    seed, count, folder = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3])
    folder.mkdir(parents=True, exist_ok=True)
    found = Judge()
    for case in any_cases(seed, count, sys.argv[4:]):
        found.add(case, case.run(Bench(folder, folder)))
        print(f"{case.name} {case.words}", flush=True)
    text = summary(found)
    print(text)
    (folder / "summary.txt").write_text(text + "\n", encoding="utf-8")
    (folder / "numbers.json").write_text(json.dumps([asdict(n) for n in found.numbers]), encoding="utf-8")


if __name__ == "__main__":
    main()
