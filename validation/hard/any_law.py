"""Random scenes of every law and experiment on the plane, each number and some points of p(r) beside an oracle.

python -m validation.hard.any_law SEED COUNT FOLDER [LAW ...]     a summary, and FOLDER/scenes.jsonl, summary.txt
python -m validation.hard.any_law dashpots|times|pressures|paths FOLDER     fixed lists (`any_law_lists`)

Laws are elastic, JKR, Maugis, rate, Prony, Kelvin–Voigt, friction; naming some draws these alone. The generators are
those of the studies beside, and `any_law_draws`; the judge is that of `random_plane`.
"""

from __future__ import annotations

import json
import math
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from validation.doors import Run
from validation.hard import any_law_draws, any_law_lists, cohesive_draws, impact_draws, plane_draws, relaxing_draws
from validation.hard.plane_bodies import Scene
from validation.hard.plane_draws import Drawn
from validation.hard.random_plane import Found, Number, judge, outside, run_of, unnamed
from validation.study import Bench

GENERATORS = (
    (any_law_draws.scene_of, 0.3), (relaxing_draws.scene_of, 0.25), (plane_draws.scene_of, 0.2),
    (impact_draws.scene_of, 0.15), (cohesive_draws.scene_of, 0.1),
)  # fmt: skip
IN_TIME, HELD = 0.3, 50.0
"""Share of loads, and how long a displacement is held [TU]."""
SHIFTS, CLOSER, WIDEST = 8, 0.01, 10.0
"""Spacings, and by how much each is closer; rms errors that an uncertainty above the tolerance may have."""
FAR, CLOSE = 3.0, 0.1
"""Uncertainties beyond which a number is wrong; error over the uncertainty of one that may be too wide."""


def law_of(scene: Scene) -> str:
    """The law of a scene."""
    adhesion, relaxing = scene.get("adhesion", {}), scene.get("viscoelasticity", {})
    if relaxing:
        return "Prony" if "terms" in relaxing else "Kelvin–Voigt"
    if adhesion:
        return "rate" if "rate" in adhesion else "Maugis" if "range" in adhesion else "JKR"
    return "friction" if "friction" in scene else "elastic"


def drawn(seed: int, number: int) -> Drawn | None:
    """The scene of that number, by its law and experiment; None where its generator has none."""
    shares = [share for _, share in GENERATORS]
    i = int(np.random.default_rng((seed, number, 1)).choice(len(GENERATORS), p=shares))
    try:
        one = GENERATORS[i][0](seed, number)
    except ValueError:
        return None
    if one is None:
        return None
    one = in_time(one, np.random.default_rng((seed, number, 2)))
    kind = one.scene["experiment"]["kind"]
    more = f" {next(iter(set(one.scene['experiment']) & {'force', 'displacement'}), '')}" if kind == "history" else ""
    return replace(one, group=f"{law_of(one.scene)}, {kind}{more}")


def in_time(one: Drawn, rng: np.random.Generator) -> Drawn:
    """A part of the loads without units comes to rest in time: under its force, or at its displacement."""
    experiment = one.scene["experiment"]
    if experiment["kind"] != "load" or one.in_si or "material" in one.scene or rng.random() > IN_TIME:
        return one
    tables: Scene = {"damping": {"coefficient": "auto"}}
    if rng.random() < 0.5 or one.exact["displacement"] <= 0.0:
        tables["plate"] = {}
    else:
        tables["experiment"] = {"kind": "hold", "displacement": one.exact["displacement"], "duration": HELD}
    return replace(one, scene=one.scene | tables, words=f"{one.words}, in time")


def draws(seed: int, count: int, laws: list[str]) -> Iterator[tuple[str, Drawn]]:
    """So many scenes, those of some laws alone."""
    number, made = 0, 0
    while made < count:
        one = drawn(seed, number)
        if one is not None and (not laws or one.group.split(",")[0] in laws):
            made += 1
            yield f"{seed}_{number}", one
        number += 1


def conducted(scenes: Iterator[tuple[str, Drawn]], folder: Path) -> Found:
    """Run and judge; each scene is a line of scenes.jsonl."""
    folder.mkdir(parents=True, exist_ok=True)
    bench, found = Bench(folder, folder), Found()
    with (folder / "scenes.jsonl").open("w", encoding="utf-8") as lines:
        for name, one in scenes:
            before, begun = len(found.numbers), time.perf_counter()
            judge(found, name, one, run_of(bench, name, one.scene))
            of_it = [vars(n) for n in found.numbers[before:]]
            line = {"name": name, "group": one.group, "words": one.words, "scene": one.scene, "numbers": of_it,
                    "refused": found.refused.get(name), "seconds": time.perf_counter() - begun}  # fmt: skip
            lines.write(json.dumps(line, ensure_ascii=False) + "\n")
            lines.flush()
            worst = max((n["over"] for n in of_it), default=0.0)
            print(f"{name} {one.group}: {one.words}; {len(of_it)} numbers, worst {worst:.3g} u, "
                  f"{line['seconds']:.1f} s {line['refused'] or ''}"[:230], flush=True)  # fmt: skip
    return found


def summary(found: Found) -> str:
    """By law and experiment and number: how many, outside, beyond 3 ±, the farthest, the widest ±; then the lists."""
    table: dict[tuple[str, str], list[Number]] = defaultdict(list)
    for n in found.numbers:
        table[n.group, n.name].append(n)
    said = [f"{'law, experiment':<28} {'number':<28} all out far   worst off/tol   ±/tol"]
    for (group, name), some in sorted(table.items()):
        out, far = (sum(not n.over <= limit for n in some) for limit in (1.0, FAR))
        said.append(f"{group:<28} {name:<28} {len(some):3} {out:3} {far:3} {max(n.over for n in some):7.2g} "
                    f"{max(n.far for n in some):7.2g} {max(n.wide for n in some):7.2g}")  # fmt: skip
    off, quiet = outside(found), unnamed(found)
    wide = [n for n in found.numbers if n.wide > 1.0 and n.over < CLOSE]
    said.append(f"{len(found.numbers)} numbers of {sum(found.scenes.values())} scenes; {len(off)} outside, "
                f"{sum(not n.over <= FAR for n in off)} beyond 3 ±, {len(quiet)} unnamed, {len(wide)} perhaps too "
                f"wide, {len(found.refused)} refused")  # fmt: skip
    for title, every in (("OUTSIDE", off), ("UNNAMED", quiet), ("WIDE", wide)):
        counts = Counter((n.group, n.name) for n in every)
        worst = {(n.group, n.name): n for n in sorted(every, key=lambda n: (n.far, n.wide))}
        said += [f"{title} {counts[which]}×, {n.scene} [{n.group}: {n.words}] {n.name}: {n.value:.9g} ± "
                 f"{n.uncertainty:.2g}, right {n.reference:.9g}; {n.over:.3g} u, {n.far:.3g} tol, ± {n.wide:.3g} tol"
                 for which, n in worst.items()]  # fmt: skip
    for title, lists in (("MISSING WITHOUT A WORD", found.silent), ("missing", found.absent)):
        said += [f"{title} {name}: {len(some)}, {some[:3]}" for name, some in lists.items()]
    said += [f"REFUSED {name} {why[:300]}" for name, why in found.refused.items()]
    return "\n".join([*said, f"without an oracle: {dict(found.unjudged)}"])


def main() -> None:
    """`SEED COUNT FOLDER [LAW ...]`, or the name of a list and a folder."""
    if sys.argv[1] in any_law_lists.LISTS:
        folder = Path(sys.argv[2])
        report(conducted(any_law_lists.LISTS[sys.argv[1]](), folder), folder)
        return
    seed, count, folder, laws = int(sys.argv[1]), int(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]
    scenes = dict(draws(seed, count, laws))
    found = conducted(iter(scenes.items()), folder)
    report(found, folder)
    for line in too_wide(found, scenes, folder):
        print(line)


def too_wide(found: Found, scenes: Mapping[str, Drawn], folder: Path) -> Iterator[str]:
    """Of the widest ± of each number: whether it is wider than 10 rms errors over eight spacings beside its own."""
    wide = {
        (n.group, n.name): n for n in sorted(found.numbers, key=lambda n: n.wide) if n.wide > 1.0 and n.over < CLOSE
    }
    for n in wide.values():
        one, errors = scenes[n.scene], []
        spacing = one.scene["bodies"]["spacing"]
        if (
            isinstance(spacing, str)
            or n.name.startswith("p(r)")
            or one.scene["bodies"]["profile"]["kind"] == "flat_punch"
        ):
            continue
        for i in range(SHIFTS):
            bodies = one.scene["bodies"] | {"spacing": spacing / (1.0 + CLOSER * i)}
            bodies |= {"bulk_stiffness": bodies["spacing"]} if "bulk_stiffness" in bodies else {}
            run = run_of(Bench(folder, folder), f"{n.scene}_{i}", one.scene | {"bodies": bodies})
            if isinstance(run, Run) and n.name in run.results:
                errors.append(run.results[n.name].value - n.reference)
        rms = float(np.sqrt(np.mean(np.square(errors)))) if errors else math.nan
        if n.uncertainty > WIDEST * rms:
            error = f"± {n.uncertainty:.2g}, {n.wide:.3g} tol, rms error {rms:.2g}"
            yield f"TOO WIDE {n.scene} [{n.group}] {n.name}: {error}"


def report(found: Found, folder: Path) -> None:
    """The summary, printed and beside the scenes."""
    text = summary(found)
    print(text)
    (folder / "summary.txt").write_text(text + "\n", encoding="utf-8")
    assert not any(math.isnan(n.value) for n in found.numbers)


if __name__ == "__main__":
    main()
