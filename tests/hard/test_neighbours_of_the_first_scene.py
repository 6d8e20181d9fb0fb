"""Claim: the first scene of docs/effects.md is no trap. Each of its numbers divided and multiplied by three, and each
pair, gives a result, or a message; a remedy that it says was tried gives one.

The reference is the claim itself: what a message says to type is typed, and the run must end with a pull-off force.
"""

import itertools
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from contact1d import Contact1dError, read_scene, run
from tests.scenes import SCENES

SCENE = SCENES / "pull_off.toml"
KEYS = (
    "bodies.particles", "bodies.spacing", "bodies.profile.radius", "bodies.bulk_stiffness",
    "interaction.repulsion.amplitude", "interaction.repulsion.range",
    "interaction.attraction.amplitude", "interaction.attraction.range",
    "neighbours.stiffness", "experiment.preload",
)  # fmt: skip
FACTOR = 3.0
FIRST = re.compile(r"Tried: (.*?) gives a result")


def value(key: str) -> float:
    table: Any = tomllib.loads(SCENE.read_text(encoding="utf-8"))
    for part in key.split("."):
        table = table[part]
    return float(table)


def changed(key: str, factor: float) -> dict[str, float]:
    number = factor * value(key)
    return {key: round(number) if key == "bodies.particles" else number}


def neighbours() -> Iterator[dict[str, float]]:
    factors = (1.0 / FACTOR, FACTOR)
    for key in KEYS:
        yield from (changed(key, factor) for factor in factors)
    for one, other in itertools.combinations(KEYS, 2):
        yield from (changed(one, f) | changed(other, g) for f in factors for g in factors)


def named(change: dict[str, float]) -> str:
    return " ".join(f"{key.split('.', 1)[1]}={number:.4g}" for key, number in change.items())


@pytest.mark.slow
@pytest.mark.parametrize("change", list(neighbours()), ids=named)
def test_neighbour_gives_a_result_or_a_remedy_that_does(change: dict[str, float], tmp_path: Path) -> None:
    scene = read_scene(SCENE).with_(change)
    try:
        found = run(scene, tmp_path / "first", figures=False)
    except Contact1dError as error:
        first = FIRST.search(str(error))
        if first is None:
            assert "Tried without a result" in str(error)
            return
        words = shlex.split(first[1])
        options = list(zip(words[::2], words[1::2], strict=True))
        sets = [text for option, text in options if option == "--set"]
        without = [text for option, text in options if option == "--without"]
        found = run(read_scene(scene, sets, without), tmp_path / "second", figures=False)
    assert found.results.adhesion_force.value > 0.0
