"""Random edits of scenes: each ends in a deck or in a sentence, never in a traceback.

A scene of the package is read as text and edited one to four times: a number replaced by an extreme or wrong one, a
line taken away, doubled or moved, a character changed. What still is a scene goes on to its settings and its deck; some
of those are run.
"""

from __future__ import annotations

import random
import re
import time
from collections import Counter
from importlib.resources import files
from pathlib import Path

import numpy as np

from contact1d.workflow.deck.deck import Deck
from contact1d.workflow.errors import RunError
from contact1d.workflow.experiments import planned
from contact1d.workflow.judging.figures import Series
from contact1d.workflow.runs.campaign import run
from contact1d.workflow.scene import SceneError, read_scene
from contact1d.workflow.settings.settings import SettingsError, settings_for
from contact1d.workflow.stability.case import Bench, Class, Findings, LateError, at_most, at_most_seconds
from contact1d.workflow.stability.figures import points_figure

NAME = "fuzz"
QUICK, FULL = 2_000, 20_000
EVERY = 100
"""One in so many of the decks is run."""
SEED = 12
SLOW, RUN = 10, 60
"""Seconds for a scene to become a deck or a sentence, and for a run."""
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
VALUES = (
    "0",
    "-1",
    "1e-300",
    "1e300",
    "1e20",
    "1e-6",
    "1e6",
    "nan",
    "inf",
    "-inf",
    "true",
    '"auto"',
    '"x"',
    "[]",
    "{}",
    "3",
    "1e-3",
    "0.5",
    "2.0",
    "1000000",
    "10.0",
    "7",
)
SPOILT = "\"'[]{}=#.,\\\0é\n -"


def measure(bench: Bench, folder: Path) -> Findings:
    """How many scenes end how; one row for each way that must not be."""
    sources = [path.read_text(encoding="utf-8") for path in _scenes()]
    draw = random.Random(SEED)
    ends: Counter[str] = Counter()
    said: dict[str, str] = {}
    count, decks, slowest = FULL if bench.full else QUICK, 0, 0.0
    for _ in range(count):
        path = bench.folder / "scene.toml"
        path.write_text(edited(draw.choice(sources), draw), encoding="utf-8")
        started = time.monotonic()
        end, words = _become(path, bench.folder / "run", decks % EVERY == EVERY - 1)
        slowest = max(slowest, time.monotonic() - started if end != "ran" else 0.0)
        decks += end in ("a deck", "ran")
        ends[end] += 1
        if end not in said:
            said[end] = words
            (bench.folder / f"first_{end.replace(' ', '_')}.toml").write_bytes(path.read_bytes())
    bad = {end: found for end, found in ends.items() if end.startswith("a traceback")}
    worst = "; ".join(f"{found} × {said[end]}" for end, found in bad.items())
    checks = [
        at_most(
            NAME,
            f"tracebacks of {count} random scenes",
            sum(bad.values()),
            0.0,
            "a deck, a result or a sentence",
            worst or "–",
            "set bound",
        ),
        at_most(
            NAME,
            f"of {count} random scenes, those that are neither deck nor sentence after {SLOW} s",
            ends["late"],
            0.0,
            "a deck, a result or a sentence",
            "–",
            "set bound",
        ),
    ]
    names = sorted(ends)
    points_figure(
        folder / f"{NAME}.png",
        [Series(f"{i}: {name}"[:60], np.array([i]), np.array([ends[name]])) for i, name in enumerate(names)],
        ("end", "scenes"),
        log="y",
    )
    return Findings(checks, f"{NAME}.png", "How many random scenes end how")


def edited(text: str, draw: random.Random) -> str:
    """The text of a scene with one to four random edits."""
    for _ in range(draw.randint(1, 4)):
        lines = text.split("\n")
        match draw.randrange(6):
            case 0 | 1 | 2:
                places = list(NUMBER.finditer(text))
                if places:
                    first, last = draw.choice(places).span()
                    text = text[:first] + draw.choice(VALUES) + text[last:]
            case 3:
                del lines[draw.randrange(len(lines))]
                text = "\n".join(lines)
            case 4:
                lines.insert(draw.randrange(len(lines)), draw.choice(lines))
                text = "\n".join(lines)
            case _:
                place = draw.randrange(len(text))
                text = text[:place] + draw.choice(SPOILT) + text[place + draw.randrange(2) :]
    return text


def _become(path: Path, folder: Path, go_on: bool) -> tuple[str, str]:
    """How a scene file ends, in a word, and what was said."""
    try:
        with at_most_seconds(RUN + SLOW if go_on else SLOW):
            scene = read_scene(path)
            settings = settings_for(scene)
            Deck(scene, settings).text(planned(scene, settings))
            if go_on:
                run(scene, folder, figures=False, time_limit=RUN)
                return "ran", ""
    except (SceneError, SettingsError) as error:
        return "a sentence", str(error)
    except RunError as error:
        return "a run refused", error.message
    except LateError:
        return "late", ""
    except Exception as error:  # every other one would reach a person as a traceback
        return f"a traceback: {type(error).__name__}", f"{type(error).__name__}: {str(error)[:80]}"
    return "a deck", ""


def _scenes() -> list[Path]:
    folder = Path(str(files("contact1d.lammps_inputs"))) / "scenes"
    return sorted(folder.glob("*.toml"))


FUZZ = Class(
    NAME,
    "Random edits of scenes",
    "What nobody thought of.",
    measure,
)
