"""Time per step of generated decks over decks written by hand for just their scene (asked: within 5 %).

    python validation/speed/deck_overhead.py

Both decks of a scene read the same system.data and table and run turn by turn; the ratio is the median over the turns
of LAMMPS's own loop times. Exit code 1 where a ratio is above LIMIT. The table goes to validation/speed/results too.
"""

from __future__ import annotations

import json
import re
import statistics
import sys
import tempfile
from pathlib import Path

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.deck.steps import Displace
from contact1d.workflow.engine.session import Engine, Session
from contact1d.workflow.runs.campaign import write_deck
from contact1d.workflow.scene import scene_from_dict
from contact1d.workflow.settings.settings import settings_for

HAND = Path(__file__).parent / "hand"
RESULTS = Path(__file__).parent / "results" / "deck_overhead.json"
STEPS = 4_000
ROUNDS = 15
LIMIT = 1.05
BODIES = {
    "particles": 200,
    "spacing": 1.0,
    "profile": {"kind": "parabola", "radius": 1000.0},
    "bulk_stiffness": 0.83,
}
LAW = {"repulsion": {"amplitude": 0.18, "range": 0.13}, "attraction": {"amplitude": 0.09, "range": 0.26}}
TIMED = {"damping": {"coefficient": 0.3}, "plate": {"mass": 200.0, "damping": 100.0}}
LOAD = {"experiment": {"kind": "load", "method": "dynamic", "force": 1.0}}
SCENES = {
    "plate": {"bodies": BODIES, "interaction": LAW} | TIMED | LOAD,
    "plate_neighbours_horizontal": {
        "bodies": BODIES, "interaction": LAW, "neighbours": {"stiffness": 0.3}, "horizontal": {},
    } | TIMED | LOAD,
    "plate_noise": {"bodies": BODIES, "interaction": LAW, "noise": {"temperature": 1e-4, "seed": 1}} | TIMED | LOAD,
    "plane": {"bodies": BODIES | {"lower": "rigid_plane"}} | TIMED | LOAD,
    "sweep": {
        "bodies": BODIES | {"lower": "rigid_plane", "bulk_stiffness": 0.5},
        "experiment": {"kind": "path", "displacements": [2.0]},
    },
}  # fmt: skip


PLACES = tuple(2.0 * row / STEPS for row in range(STEPS))
"""Displacements of rows that are steps of one run."""
BY_HAND = f"variable row equal step-$(step)\nvariable places vector [{','.join(map(repr, PLACES))}]\n"
"""What such a run by hand begins with."""


def steps_of(deck: Deck) -> tuple[str, str]:
    """STEPS steps of the generated deck, and of that by hand."""
    run = f"run {STEPS}\n"
    if not deck.stepped:
        return run, run
    return deck.in_one_run([Displace(place) for place in PLACES]), f"{BY_HAND}run {STEPS} pre no\n"


def loop_time(session: Session, folder: Path, steps: str) -> float:
    """Seconds that LAMMPS reports for STEPS steps."""
    session.execute(f"log loop.log\n{steps}log none")
    return float(re.findall(r"Loop time of (\S+)", (folder / "loop.log").read_text())[-1])


def ratio(name: str, folder: Path) -> tuple[float, float, float]:
    """(generated, by hand) in µs per step and the median of the ratios of each turn."""
    scene = scene_from_dict({"title": name} | SCENES[name])
    settings = settings_for(scene)
    deck = Deck(scene, settings)
    write_deck(scene, folder)
    points = settings.table.points if settings.table is not None else 0
    variables = f"variable points index {points}\nvariable dt index {settings.time_step!r}\n"
    load = "fix plate_load plate addforce 0.0 0.0 -0.005\n"
    steps = steps_of(deck)
    head = deck.head + (deck.begin("loading") if deck.stepped else load)
    before = "" if deck.stepped else variables
    texts = (head, before + (HAND / f"{name}.lmp").read_text())
    times: tuple[list[float], list[float]] = ([], [])
    with Engine.session(folder) as first, Engine.session(folder) as second:
        for session, text in zip((first, second), texts, strict=True):
            session.execute(text)
            loop_time(session, folder, steps[session is second])  # settles into the contact; not counted
        for turn in range(ROUNDS):
            for index in (0, 1) if turn % 2 == 0 else (1, 0):
                times[index].append(loop_time((first, second)[index], folder, steps[index]))
    pairs = [a / b for a, b in zip(*times, strict=True)]
    generated, hand = (1e6 * statistics.median(series) / STEPS for series in times)
    return generated, hand, statistics.median(pairs)


def main() -> int:
    """Print the table; 1 where a generated deck is too slow."""
    print(f"{'scene':<30}{'generated':>12}{'by hand':>12}{'ratio':>8}   (µs per step)")
    rows = []
    for name in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            generated, hand, share = ratio(name, Path(folder))
        rows.append({"scene": name, "generated_us": generated, "by_hand_us": hand, "ratio": share})
        print(f"{name:<30}{generated:>12.2f}{hand:>12.2f}{share:>8.3f}", flush=True)
    RESULTS.write_text(json.dumps({"asked": LIMIT, "rows": rows}, indent=1) + "\n")
    return int(max(row["ratio"] for row in rows) > LIMIT)


if __name__ == "__main__":
    sys.exit(main())
