"""Random edits of scenes: each ends in a deck or in a sentence, never in a traceback.

A scene of the package is read as text and edited one to four times: a number replaced by an extreme or wrong one, a
line taken away, doubled or moved, a character changed. What still is a scene goes on to its settings and its deck; some
of those are run.
"""

import random
import re
import warnings
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

from validation import doors
from validation.doors import RunError, SceneError, SettingsError, read_scene
from validation.row import at_most
from validation.study import Bench, LateError, Lines, Study, at_most_seconds

QUICK, FULL = 2_000, 20_000
EVERY = 100
"""One in so many of the decks is run."""
PIECE = 1000
"""Scenes of one seed."""
SLOW, RUN, HANGS = 10, 60, 600
"""Seconds of work for a scene to become a deck or a sentence, of LAMMPS in a run, and of the clock for what hangs."""
NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
VALUES = '0 -1 1e-300 1e300 1e20 1e-6 1e6 nan inf -inf true "auto" "x" [] {} 3 1e-3 0.5 2.0 1000000 10.0 7'
TRACEBACK = "a traceback"


def measure(bench: Bench) -> Lines:
    """How many scenes end how; one row for each way that must not be."""
    count = FULL if bench.full else QUICK
    ends, worst = Counter[str](), dict[str, str]()
    for seed in range(count // PIECE):
        for end, words in _piece(bench.folder, seed):
            ends[end] += 1
            worst.setdefault(end, words)
    bad = {end: number for end, number in ends.items() if end.startswith(TRACEBACK)}
    said = "; ".join(f"{number} × {worst[end]}" for end, number in bad.items()) or "–"
    source, late = "a deck, a result or a sentence", f"neither deck nor sentence after {SLOW} s"
    return [
        at_most(f"tracebacks of {count} random scenes", sum(bad.values()), 0.0, source, said, "set bound"),
        at_most(f"of {count} random scenes, those that are {late}", ends["late"], 0.0, source, evidence="set bound"),
    ]  # fmt: skip


def _piece(folder: Path, seed: int) -> Iterator[tuple[str, str]]:
    """How each of PIECE scenes of one seed ends; those that end in a traceback are kept as files."""
    sources = [path.read_text(encoding="utf-8") for path in sorted(doors.shipped("scenes").glob("*.toml"))]
    draw, decks, path = random.Random(seed), 0, folder / "scene.toml"
    for number in range(PIECE):
        path.write_text(edited(draw.choice(sources), draw), encoding="utf-8")
        end, words = _become(path, folder / "run", decks % EVERY == EVERY - 1)
        decks += end in ("a deck", "ran")
        if end.startswith(TRACEBACK):
            path.rename(folder / f"traceback_{seed}_{number}.toml")
        yield end, words


def edited(text: str, draw: random.Random) -> str:
    """The text of a scene with one to four random edits."""
    for _ in range(draw.randint(1, 4)):
        lines = text.split("\n")
        match draw.randrange(6):
            case 0 | 1 | 2:
                places = list(NUMBER.finditer(text))
                if places:
                    first, last = draw.choice(places).span()
                    text = text[:first] + draw.choice(VALUES.split()) + text[last:]
            case 3:
                del lines[draw.randrange(len(lines))]
                text = "\n".join(lines)
            case 4:
                lines.insert(draw.randrange(len(lines)), draw.choice(lines))
                text = "\n".join(lines)
            case _:
                place = draw.randrange(len(text))
                text = text[:place] + draw.choice("\"'[]{}=#.,\\\0é\n -") + text[place + draw.randrange(2) :]
    return text


def _become(path: Path, folder: Path, go_on: bool) -> tuple[str, str]:
    """How a scene file ends, in a word, and what was said. A warning of a library is a fault, too."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            with at_most_seconds(SLOW, of_processor=True):
                scene = read_scene(path)
                doors.deck_text(scene)
            if go_on:
                with at_most_seconds(HANGS):
                    doors.run(scene, folder, RUN)
                return "ran", ""
    except (SceneError, SettingsError) as error:
        return "a sentence", str(error)
    except RunError as error:
        return "a run refused", error.message
    except LateError:
        return "late", ""
    except Exception as error:  # every other one would reach a person as a traceback
        return f"{TRACEBACK}: {type(error).__name__}", f"{type(error).__name__}: {str(error)[:80]}"
    return "a deck", ""


FUZZ = Study(
    "fuzz",
    "Random edits of scene files",
    "Does every unexpected combination of keys and values give a deck or an error message, within ten seconds?",
    measure,
)
