"""Time per step of generated decks over decks written by hand for just their scene.

Both decks of a scene read the same system.data and table and run turn by turn; the ratio is the median over the turns
of LAMMPS's own loop times.
"""

import re
import statistics
from collections.abc import Sequence
from pathlib import Path

from validation.doors import Deck, Displace, Engine, Session, read_scene, settings_for, write_deck
from validation.row import at_most
from validation.study import Bench, Lines, Study

HAND = Path(__file__).parent / "hand"
STEPS, ROUNDS, LIMIT = 4_000, 15, 1.05
"""Steps of a turn, turns, and the ratio that was asked for."""
SCENES = ("plate", "plate_neighbours_horizontal", "plate_noise", "plane", "sweep")
"""In HAND, each beside its deck by hand."""
PLACES = tuple(2.0 * step / STEPS for step in range(STEPS))
"""Displacements of load steps that are steps of one run."""
BY_HAND = f"variable row equal step-$(step)\nvariable places vector [{','.join(map(repr, PLACES))}]\n"
"""What such a run by hand begins with."""


def measure(bench: Bench) -> Lines:
    """A row for each scene."""
    words = "LAMMPS loop time of the generated deck over that of a deck by hand"
    return [at_most(f"{words}: {name}", ratio(name, bench.folder / name), LIMIT, "asked for",
                             "median of the turns", "set bound") for name in SCENES]  # fmt: skip


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


def ratio(name: str, folder: Path) -> float:
    """Of a scene, see `over`."""
    scene = read_scene(HAND / f"{name}.toml")
    settings = settings_for(scene)
    deck = Deck(scene, settings)
    write_deck(scene, folder)
    points = settings.forces.table.points if settings.forces.table is not None else 0
    variables = f"variable points index {points}\nvariable dt index {settings.motion.time_step!r}\n"
    load = "fix plate_load plate addforce 0.0 0.0 -0.005\n"
    head = deck.head + (deck.begin("loading") if deck.stepped else load)
    texts = (head, ("" if deck.stepped else variables) + (HAND / f"{name}.lmp").read_text())
    with Engine.session(folder) as first, Engine.session(folder) as second:
        decks = dict(zip((first, second), steps_of(deck), strict=True))
        times: dict[Session, list[float]] = {first: [], second: []}
        for (session, steps), text in zip(decks.items(), texts, strict=True):
            session.execute(text)
            loop_time(session, folder, steps)  # settles into the contact; not counted
        for turn in range(ROUNDS):
            for session in (first, second) if turn % 2 == 0 else (second, first):
                times[session].append(loop_time(session, folder, decks[session]))
    return over(*times.values())


def over(times: Sequence[float], by_hand: Sequence[float]) -> float:
    """Median over the turns of the time of the generated deck over that by hand."""
    return statistics.median(generated / hand for generated, hand in zip(times, by_hand, strict=True))


OVERHEAD = Study(
    "overhead", "Time per step: generated deck over one written by hand", "What do the fragments cost?", measure
)
